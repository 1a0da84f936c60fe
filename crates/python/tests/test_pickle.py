"""Pickles and copies of everything that the package hands over."""

from __future__ import annotations

import copy
import dataclasses
import pickle

import numpy as np
import pytest
import scipy.sparse as sp

import frfit

F = np.linspace(4.0, 110.0, 24)
TRUE = 1000 * (1 + 0.03j)
PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)

WAYS = [lambda one, p=p: pickle.loads(pickle.dumps(one, protocol=p)) for p in PROTOCOLS] + [copy.copy, copy.deepcopy]
IDS = [f"protocol {p}" for p in PROTOCOLS] + ["copy", "deepcopy"]
every_way = pytest.mark.parametrize("again", WAYS, ids=IDS)

LAWS = [
    frfit.Law.constant(3 - 4j),
    frfit.Law.complex_modulus(2e11, 0.01),
    frfit.Law.fractional(8.14e5, 7.31e4, 0.528),
    frfit.Law.zener(1e5, 1e7, 1e-3, 0.6),
    frfit.Law.maxwell(1e5, [(2e5, 1e-2), (3e5, 1e-3)]),
    frfit.Law.table([1.0, 50.0, 200.0], [1 + 0.1j, 2 + 0.2j, 2.5]),
]


def same(a: object, b: object, where: str = "") -> None:
    """Whether two have the same type and the same numbers, bit by bit, in whatever they are made of."""
    assert type(a) is type(b), where
    if isinstance(a, np.ndarray):
        assert a.dtype == b.dtype, where
        np.testing.assert_array_equal(a, b, err_msg=where)
    elif dataclasses.is_dataclass(a):
        for field in dataclasses.fields(a):
            same(getattr(a, field.name), getattr(b, field.name), f"{where}.{field.name}")
    elif isinstance(a, (tuple, list)):
        assert len(a) == len(b), where
        for k, (one, other) in enumerate(zip(a, b, strict=True)):
            same(one, other, f"{where}[{k}]")
    elif sp.issparse(a):
        np.testing.assert_array_equal(a.toarray(), b.toarray(), err_msg=where)
    elif isinstance(a, float):
        np.testing.assert_equal(a, b, err_msg=where)
    else:
        assert a == b, where


@every_way
@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_laws(law, again):
    got = again(law)
    assert got == law and repr(got) == repr(law)
    f = np.linspace(1.0, 200.0, 7)
    np.testing.assert_array_equal(got.at(f), law.at(f))


@every_way
@pytest.mark.parametrize("is_complex", [False, True])
def test_models(chain, again, is_complex):
    stiffness = chain.stiffness * (1 + 0.01j) if is_complex else chain.stiffness
    # An entry that rounding made unsymmetric: what the model made of it is what is kept.
    mass = chain.mass.toarray()
    mass[0, 1], mass[1, 0] = 1e-3, 1e-3 * (1 + 4e-14)
    model = frfit.Model(
        [
            frfit.Term("springs", stiffness, factor=frfit.Law.fractional(900.0, 20.0, 0.5)),
            frfit.Term("dashpots", chain.viscous, role="viscous"),
            frfit.Term("mass", mass, role="mass", factor=2.0),
        ]
    )
    got = again(model)
    assert (got.dim, got.names, repr(got)) == (model.dim, model.names, repr(model))
    at = {"load": 0, "sensors": [3, 11]}
    np.testing.assert_array_equal(frfit.respond(got, F, **at), frfit.respond(model, F, **at))


def test_pickles_of_models_are_arrays(chain):
    n = 20_000
    ones = np.ones(n)
    k = sp.diags_array([2 * ones, -ones[1:], -ones[1:]], offsets=[0, 1, -1], format="csc")
    model = frfit.Model([frfit.Term("k", k), frfit.Term("m", sp.eye_array(n, format="csc"), role="mass")])
    # 2n entries of the lower triangle: a row of 4 bytes and two values of 8, and n pointers of 8.
    assert len(pickle.dumps(model)) < (2 * (4 + 16) + 8) * n + 4096


def measured(chain, rows=(6, 11)):
    x = frfit.respond(chain.model(TRUE), F, load=0, sensors=list(rows))
    return [frfit.Measurement(F, x[:, k], row=row, std=np.abs(x[:, k]) * 1e-3) for k, row in enumerate(rows)]


@every_way
def test_measurements_and_terms(chain, again):
    same(again(measured(chain)), measured(chain))
    term = frfit.Term("springs", chain.stiffness, factor=LAWS[2])
    same(again(term), term)
    recording = frfit.Recording(1e-3, np.ones(8), np.ones((2, 8)))
    same(again(recording), recording)


@every_way
def test_results(chain, again, tmp_path):
    found = frfit.identify(chain.model(1200.0), measured(chain), load=0, matrix="springs", law="constant")
    same(again(found), found)
    series = frfit.series(chain.model(TRUE), 20.0, load=0, sensors=[1, 2], matrix="springs", order=8)
    got = again(series)
    for name in ("order", "scale", "nominal", "coefficients"):
        same(getattr(got, name), getattr(series, name), name)
    same(got.respond(30 - 2j), series.respond(30 - 2j))
    same(got.spectral_radius(30 - 2j), series.spectral_radius(30 - 2j))
    t = np.arange(2048) / 2048
    force = np.where((t > 0.01) & (t < 0.013), np.sin(np.pi * (t - 0.01) / 0.003), 0.0)
    hammered = frfit.frf(frfit.Recording(1 / 2048, force, 2.0 * force))
    same(again(hammered), hammered)
    path = tmp_path / "f.uff"
    frfit.write_uff(path, frfit.UffFunction(F, F * 1j, response_dof=frfit.UffDof(3, 1)))
    file = frfit.read_uff(path)
    same(again(file).function(0), file.function(0))
    assert again(file).datasets == file.datasets


@every_way
def test_results_of_a_case_with_several_unknowns(again):
    # As `run_case` makes one: what it is made of is plain, and none of it is left behind.
    number = frfit.Number("storage", 1.0, 0.1)
    one = {field.name: F for field in dataclasses.fields(frfit.Estimate)}
    one = frfit.Estimate(**{**one, "name": "E", "varies": "constant", "numbers": (number,), "status": "ok"})
    values = {field.name: F for field in dataclasses.fields(frfit.Identification)}
    found = frfit.Identification(**{**values, "unknowns": (one,), "directions": (frfit.Direction(1.0, {"E": 1.0}),)})
    same(again(found), found)


@every_way
def test_exceptions_keep_what_they_know(again, chain):
    with pytest.raises(frfit.InputError) as caught:
        frfit.identify(chain.model(TRUE), measured(chain), load=0, matrix="springs", method="magic")
    got = again(caught.value)
    assert type(got) is frfit.InputError and str(got) == str(caught.value)
    assert (got.key, got.expected, got.found) == ("method", caught.value.expected, '"magic"')


def test_no_part_of_a_pickle_is_believed(chain):
    rebuild, (terms, indices, indptr) = chain.model(TRUE)._model.__reduce__()
    for rows, ends in ((indices[:-1], indptr), (indices + 40, indptr), (indices, indptr[::-1]), (-indices, indptr)):
        with pytest.raises(frfit.MatrixError):
            rebuild(terms, np.ascontiguousarray(rows), np.ascontiguousarray(ends))
    rebuild, parts = frfit.series(chain.model(TRUE), 20.0, load=0, sensors=[1], matrix="springs").__reduce__()
    with pytest.raises(frfit.InputError, match="coefficients"):
        rebuild(parts[0], parts[1], np.zeros((0, 0), dtype=complex), parts[3])
