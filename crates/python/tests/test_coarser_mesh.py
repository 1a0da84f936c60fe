"""A rod on two meshes of linear elements, measured on a mesh that is much finer."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

import frfit

E, ETA, RHO = 2.0e9, 0.02, 1200.0


def matrices(elements: int) -> tuple[sp.csc_array, sp.csc_array]:
    """Stiffness and mass of a rod of 1 m and 1 m², held at one end."""
    h, ones = 1.0 / elements, np.ones(elements)
    off, end = -ones[1:], np.append(2 * ones[1:], 1.0)
    stiffness = sp.diags_array([off, end, off], offsets=[-1, 0, 1]) / h
    mass = sp.diags_array([ones[1:], 2 * end, ones[1:]], offsets=[-1, 0, 1]) * (h / 6)
    return stiffness.tocsc(), mass.tocsc()


def rod(elements: int, storage: float) -> frfit.Model:
    stiffness, mass = matrices(elements)
    return frfit.Model(
        [
            frfit.Term("rod", stiffness, factor=storage * (1 + 1j * ETA)),
            frfit.Term("mass", mass, role="mass", factor=RHO, storage_std="0.2 %"),
        ]
    )


def middle_and_end(elements: int) -> list[int]:
    return [elements // 2 - 1, elements - 1]


@pytest.fixture(scope="module")
def measured() -> list[frfit.Measurement]:
    f = np.linspace(100.0, 3000.0, 120)
    u = frfit.respond(rod(192, E), f, load=191, sensors=middle_and_end(192))
    noise = np.random.default_rng(3).standard_normal((2, *u.shape)) / np.sqrt(2)
    std = 0.005 * np.abs(u)
    u = u + std * (noise[0] + 1j * noise[1])
    rows = middle_and_end(24)
    return [frfit.Measurement(f, u[:, k], row=rows[k], std=std[:, k]) for k in range(2)]


def identify(measured: list[frfit.Measurement], **options: object) -> frfit.Number:
    found = frfit.identify(rod(24, 1.1 * E), measured, load=23, matrix="rod", varies="constant", **options)
    assert found.is_trusted
    return found["rod"].numbers[0]


def test_a_coarser_mesh_takes_the_error_of_the_mesh_out(measured):
    coarser = frfit.CoarserMesh(rod(12, E), load=11, sensors=middle_and_end(12))
    with_it, alone = identify(measured, coarser_mesh=coarser), identify(measured)
    # Natural frequencies are up to 1.5 % too high: a modulus that takes that up is up to 3 % too low.
    assert abs(with_it.value / E - 1) < 0.005
    # The density is known to 0.2 %, and without the coarser mesh the bar has the 2 % of any stiffness.
    assert abs(with_it.value - E) < 2 * with_it.std
    assert with_it.std < 0.7 * alone.std


def test_another_structure_is_refused(measured):
    def refused(match: str, **changes: object) -> None:
        given = {"model": rod(12, E), "load": 11, "sensors": middle_and_end(12)} | changes
        with pytest.raises(frfit.FrfitError, match=match):
            identify(measured, coarser_mesh=frfit.CoarserMesh(**given))

    refused("sensors: expected the model's 2, found 1", sensors=[11])
    refused("element_ratio: expected a number above 1", element_ratio=0.5)
    stiffness, mass = matrices(12)
    other = frfit.Model([frfit.Term("rod", stiffness, factor=E), frfit.Term("mass", mass, role="mass", factor=1.0)])
    refused('factor of "mass"', model=other)
    with pytest.raises(frfit.InputError, match="coarser_mesh"):
        identify(measured, coarser_mesh=rod(12, E))


def test_what_is_known_of_a_factor_is_read_as_in_a_case(measured):
    def of(**known: object) -> frfit.Model:
        stiffness, mass = matrices(12)
        terms = [
            frfit.Term("rod", stiffness, factor=2e9 * (1 + 0.02j)),
            frfit.Term("mass", mass, role="mass", factor=1200.0, **known),
        ]
        return frfit.Model(terms)

    # Pickled parts are relative of the storage, absolute of the loss factor.
    for std in ("2 %", 24.0):
        storage, loss_factor = of(storage_std=std)._model.__reduce__()[1][0][1][3]
        assert storage == pytest.approx(0.02) and loss_factor is None
    for wrong in (0.0, -1.0, "two", True, float("nan")):
        with pytest.raises(frfit.InputError, match="storage_std"):
            of(storage_std=wrong)
    stiffness, mass = matrices(24)
    rod_of = frfit.Term("rod", stiffness, factor=E, storage_std="1 %")
    unknown = frfit.Model([rod_of, frfit.Term("mass", mass, role="mass", factor=RHO)])
    with pytest.raises(frfit.InputError, match='one of "rod", which is unknown'):
        frfit.identify(unknown, measured, load=23, matrix="rod")
