"""Arrays that are written as a case give the numbers of the arrays, and everything that works on files."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest
import scipy.sparse as sp
from conftest import Chain, same_columns
from test_case_and_arrays import BOUNDS, F, LAW, NOMINAL, ROWS, UNKNOWN, WINDOW, measurements, records
from test_coarser_mesh import E, measured, middle_and_end, rod

import frfit

__all__ = ["measured"]


def same(ours: frfit.Identification, theirs: frfit.Identification) -> None:
    """Numbers of the band too."""
    assert len(ours) > 0
    same_columns(ours, theirs)
    for one, other in zip(ours.unknowns, theirs.unknowns, strict=True):
        assert [(a.value, a.std) for a in one.numbers] == [(b.value, b.std) for b in other.numbers]
    assert (ours.smooth, ours.laws) == (theirs.smooth, theirs.laws)


@pytest.mark.parametrize(
    ("channels", "keys"),
    [
        (({}, {}), {"varies": "frequency", "exclude_hz": [20.0, (30.0, 34.0)], "max_lines": 20}),
        (({}, {}), {"varies": "smooth", "model_error": {"frequency": 0.005, "shape": "2 %"}}),
        (({}, {}), {"law": ("fractional", "maxwell:2"), "reject_outliers": False}),
        (({}, {}), {"method": "series", "order": 12, "selection": "smallest", "reduction": "full"}),
        (({}, {}), {"start": "bounds", "model_error": "none", "check": False}),
        ((WINDOW, WINDOW), {}),
        (({}, UNKNOWN), {}),
    ],
    ids=["lines", "smooth", "laws", "series", "bounds", "window", "unknown channel"],
)
def test_the_case_has_the_numbers_of_the_arrays(chain: Chain, tmp_path, channels, keys):
    values, std = records(chain)
    given = chain.model(NOMINAL), measurements(values, std, channels)
    options = {"load": 0, "matrix": "springs", "band_hz": (F[0], F[26]), "bounds": BOUNDS, **keys}
    case = frfit.save_case(tmp_path / "case", *given, **options)
    same(frfit.identify(*given, **options), frfit.run_case(case))


def test_several_unknowns_and_a_dimension(chain: Chain, tmp_path):
    values, std = records(chain)
    unknowns = [
        frfit.Unknown("springs", matrix="springs", varies="law", law="fractional", bounds=BOUNDS),
        frfit.Unknown("dashpots", matrix="dashpots", varies="constant", real=True, bounds=(0.1, 10.0)),
        frfit.Unknown("size", powers={"mass": 1}, nominal=1.02, bounds=(0.8, 1.25)),
    ]
    given = chain.model(NOMINAL), measurements(values, std, ({}, {}))
    case = frfit.save_case(tmp_path, *given, load=0, unknowns=unknowns, title='Chain "12"')
    found = frfit.run_case(case, tmp_path / "out")
    same(frfit.identify(*given, load=0, unknowns=unknowns), found)
    page = found.report().html
    assert "Chain &quot;12&quot;" in page and "dashpots" in page


def test_factors_loads_and_names_are_those_of_the_arrays(chain: Chain, tmp_path):
    table = frfit.Law.table([1.0, 50.0, 200.0], [1000 + 50j, 1100 + 60j, 1200 + 90j])
    more = frfit.Law.maxwell(1.0, [(0.5, 0.01), (0.25, 0.001)])
    model = frfit.Model(
        [
            frfit.Term("springs", chain.stiffness, factor=LAW),
            frfit.Term("known", sp.eye_array(chain.n, format="csc"), factor=table, storage_std="3 %", loss_factor_std=0.02),
            frfit.Term("dashpots", chain.viscous * (1 + 0.5j), role="viscous", factor=more),
            frfit.Term("mass", chain.mass, role="mass", factor=frfit.Law.zener(1.0, 1.0, 0.1, 0.5)),
        ],
        attached=frfit.Attached(3, mass=0.002, stiffness=5.0),
    )
    load = np.zeros(chain.n, dtype=complex)
    load[[1, 4]] = 0.5, -0.25 + 0.1j
    receptance = frfit.respond(model, F, load=load, sensors=ROWS, signs=[1.0, -1.0])
    measured = [
        frfit.Measurement(F, receptance[:, 0], ROWS[0], coherence=np.full(F.size, 0.9), averages=5),
        frfit.Measurement(F, receptance[:, 1], ROWS[1], sign=-1.0, scale=2.0, delay_s=1e-4),
    ]
    for folder, dofs in (("rows", None), ("names", {"9+Z": ROWS[1], "8+RX": ROWS[0]})):
        case = frfit.save_case(tmp_path / folder, model, measured, load=load, matrix="springs", dofs=dofs)
        text = case.read_text()
        assert ('dof = "9-Z"' in text and 'dof = "8+RX"' in text) == (dofs is not None)
        # A row has no sense, so that its values are turned round.
        sign = 1.0 if dofs else -1.0
        np.testing.assert_array_equal(
            np.loadtxt(case.parent / "frf-2.csv", delimiter=",", skiprows=1),
            np.column_stack([F, sign * receptance[:, 1].real, sign * receptance[:, 1].imag]),
        )
        same(
            frfit.identify(model, measured, load=load, matrix="springs"),
            frfit.run_case(case),
        )


def test_a_coarser_mesh_goes_along(measured, tmp_path):
    coarser = frfit.CoarserMesh(rod(12, E), load=11, sensors=middle_and_end(12), signs=[1.0, 1.0], element_ratio=2.0)
    options = {"load": 23, "matrix": "rod", "varies": "constant", "coarser_mesh": coarser}
    model = rod(24, 1.1 * E)
    case = frfit.save_case(tmp_path, model, measured, **options)
    ours, theirs = frfit.identify(model, measured, **options)["rod"], frfit.run_case(case)["rod"]
    # The last bit of a loss factor's part is another.
    np.testing.assert_allclose(
        [(one.value, one.std) for one in ours.numbers],
        [(one.value, one.std) for one in theirs.numbers],
        rtol=1e-9,
    )


def test_a_batch_of_arrays(chain: Chain, tmp_path):
    values, std = records(chain)
    given = chain.model(NOMINAL), measurements(values, std, ({}, {}))
    case = frfit.save_case(tmp_path / "case", *given, load=0, matrix="springs", law="fractional")
    plan = tmp_path / "plan.csv"
    plan.write_text("case\ncase/case.toml\n")
    done = frfit.batch(plan, tmp_path / "store")
    assert (done.done, done.failed) == (1, [])
    assert case == tmp_path / "case" / "case.toml"


def test_nothing_is_overwritten_and_what_a_case_cannot_have_is_refused(chain: Chain, tmp_path: pathlib.Path):
    values, std = records(chain)
    given = chain.model(NOMINAL), measurements(values, std, ({}, {}))
    (tmp_path / "case.toml").write_text("mine")
    with pytest.raises(frfit.InputError, match="folder: expected a new or empty folder, found files in"):
        frfit.save_case(tmp_path, *given, load=0, matrix="springs")
    assert (tmp_path / "case.toml").read_text() == "mine"
    for name, dofs in (("text", {"tip": 3}), ("twice", {"1+X": 3, "2+X": 3})):
        with pytest.raises(frfit.InputError, match="dofs: expected"):
            frfit.save_case(tmp_path / name, *given, load=0, matrix="springs", dofs=dofs)
    with pytest.raises(frfit.InputError, match="'springs'.factor: expected a factor with a real part"):
        frfit.save_case(tmp_path / "imaginary", chain.model(3j), given[1], load=0, matrix="springs")
    assert [path.name for path in tmp_path.iterdir()] == ["case.toml"]
