"""Three unknowns through every command and from arrays: a factor at each frequency, a constant and a geometric parameter."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from conftest import Chain, same_columns
from test_case import table
from test_case_and_arrays import BOUNDS, LAW, NOMINAL, ROWS, SHARE, F, case_file, measurements

import frfit

MASS, WIDTH = 1.1, 1.3
UNKNOWNS = """
[[identify]]
name = "modulus"
matrix = "springs"
band_hz = [4.0, 110.0]
bounds = { storage = [100.0, 1e4], loss_factor = [0.0, 1.0] }

[[identify]]
name = "density"
matrix = "mass"
varies = "constant"
real = true
bounds = [0.5, 2.0]

[[identify]]
name = "width"
powers = { dashpots = 2 }
nominal = 1.0
bounds = [0.5, 2.0]
"""


@pytest.fixture(scope="module")
def measured():
    """FRFs with noise of a known share, of the chain with a heavier mass and wider dashpots."""
    true = Chain()
    true.mass, true.viscous = MASS * true.mass, WIDTH**2 * true.viscous
    exact = np.array([true.direct(e, f, 0)[list(ROWS)] for e, f in zip(LAW.at(F), F, strict=True)])
    random = np.random.default_rng(11)
    std = 0.1 * SHARE * np.abs(exact)
    noise = random.normal(size=exact.shape) + 1j * random.normal(size=exact.shape)
    return exact + std * noise / np.sqrt(2), std


def identified(chain, measured):
    """All three, from arrays."""
    return frfit.identify(
        chain.model(NOMINAL),
        measurements(*measured, ({}, {})),
        load=0,
        band_hz=(F[0], F[-1]),
        unknowns=[
            frfit.Unknown("modulus", matrix="springs", bounds=BOUNDS),
            frfit.Unknown("density", matrix="mass", varies="constant", real=True, bounds=(0.5, 2.0)),
            frfit.Unknown("width", powers={"dashpots": 2}, nominal=1.0, bounds=(0.5, 2.0)),
        ],
    )


@pytest.fixture(scope="module")
def found(measured):
    return identified(Chain(), measured)


@pytest.fixture(scope="module")
def case(measured, tmp_path_factory):
    """The same as a case file."""
    path = case_file(Chain(), tmp_path_factory.mktemp("three"), *measured, ({}, {}), {})
    before, _ = path.read_text().split("[identify]")
    path.write_text(before + UNKNOWNS)
    return path


def run(cli, *arguments):
    return subprocess.run([cli, *arguments], check=True, capture_output=True, text=True).stdout


def test_arrays_find_all_three(found):
    assert found.explained == "explained" and found.is_trusted and found.not_identifiable == ()
    assert [one.varies for one in found.unknowns] == ["frequency", "constant", "constant"]
    for name, exact in (("density", MASS), ("width", WIDTH)):
        (number,) = found[name].numbers
        # Beyond four deviations is one in 16000.
        assert abs(number.value - exact) < 4 * number.std < 0.05 * exact, number
        assert found[name].real and np.all(found[name].storage == number.value)
    modulus, ok = found["modulus"], found.ok
    assert ok.mean() > 0.9
    off = np.abs(modulus.storage - LAW.at(F).real) / modulus.storage_std
    assert off[ok].max() < 5 and np.median(off[ok]) < 1.5
    with pytest.raises(AttributeError, match="modulus"):
        found.storage


def test_every_command_agrees_with_the_arrays(cli, case, found, tmp_path):
    assert "  sign  " not in run(cli, "check", case)
    wrong = case.with_name("wrong.toml")
    wrong.write_text(case.read_text().replace('file = "1.csv"', 'file = "1.csv"\nscale = -1.0'))
    assert "  sign  " in run(cli, "check", wrong)
    out = tmp_path / "out"
    said = run(cli, "identify", case, "--out", out)
    assert all(name in said for name in ("modulus", "density", "width")), said
    rows, columns = table(out / "identified.csv"), found.columns()
    assert list(rows[0]) == list(columns)
    for name, column in columns.items():
        written = [row[name] for row in rows]
        if name == "status":
            assert written == list(column)
        else:
            # Tables hold the shortest digits that read back as the same number.
            np.testing.assert_array_equal([float(cell) if cell else np.nan for cell in written], column, err_msg=name)
    by_case = frfit.run_case(case)
    np.testing.assert_array_equal(by_case["modulus"].factor, found["modulus"].factor)
    assert by_case["density"].numbers == found["density"].numbers

    chosen = [row for row in table(out / "candidates.csv") if row["verdict"] == "chosen"]
    np.testing.assert_array_equal([float(row["modulus.storage"]) for row in chosen], found["modulus"].storage)

    run(cli, "export", "csv", out / "identified.csv", "-o", tmp_path / "modulus.csv", "--unknown", "modulus")
    exported = table(tmp_path / "modulus.csv")
    storage = [float(row["storage"]) for row in exported if row["storage"][0].isdigit()]
    np.testing.assert_array_equal(storage, found["modulus"].storage[found.ok])

    page = (out / "report.html").read_text()
    assert 'id="plot-modulus-1"' in page and "density and width are known for the whole band" in page
    run(cli, "report", out)
    assert (out / "report.html").read_text() == page


def test_a_matrix_at_several_widths_is_that_of_a_case(case, measured):
    """Dashpots that grow with the square of the width, given at two widths by files and by arrays."""
    chain, widths = Chain(), (0.8, 1.2)
    files = []
    for width in widths:
        files.append(f"dashpots-{width}.mtx")
        matrix = sp.coo_array(width**2 * chain.viscous)
        scipy.io.mmwrite(case.with_name(files[-1]), matrix, symmetry="symmetric", precision=17)
    at = f'at = {{ dimension = "width", powers = [2], values = {list(widths)}, files = {files} }}'.replace("'", '"')
    path = case.with_name("at.toml")
    path.write_text(case.read_text().replace('file = "viscous.mtx"', at).replace("powers = { dashpots = 2 }\n", ""))
    by_case = frfit.run_case(path)

    parts = frfit.powers_of({width: width**2 * chain.viscous for width in widths}, powers=[2])
    assert list(parts) == [2]
    np.testing.assert_allclose(parts[2].toarray(), chain.viscous.toarray(), rtol=1e-15)
    chain.viscous = parts[2]
    same_columns(by_case, identified(chain, measured))


@pytest.mark.parametrize(
    ("matrices", "powers", "error", "message"),
    [
        ({}, None, frfit.InputError, "from 3 to 10 values"),
        ({1.0: 1.0, 2.0: 1.0}, [1, 3], frfit.InputError, "matrices: expected 3 values: one for each of 2 powers"),
        ({1.0: 1.0, 2.0: 2.0, 3.0: 9.0}, None, frfit.InputError, "a polynomial of degree 1 in the dimension"),
        ({1.0: 1.0, 2.0: 2.0, 3.0: 9.0}, [1, 3], frfit.InputError, "powers 1, 3 of the dimension"),
        ({0.0: 1.0, 2.0: 1.0, 3.0: 1.0}, [1, 3], frfit.InputError, "values above 0, each once, found 0"),
        ({1.0: 1.0, 2.0: np.eye(2), 3.0: 1.0}, None, frfit.InputError, "matrices of 1 rows, as at 1, found 2 at 2"),
        ({1.0: 1.0, 2.0: 1j, 3.0: 1.0}, None, frfit.InputError, "real matrices"),
        ({1.0: 1.0, 2.0: [[1.0, 2.0]], 3.0: 1.0}, None, frfit.MatrixError, "matrix 'at 2': expected a square matrix"),
        ({float("inf"): 1.0}, None, frfit.InputError, "finite values of the dimension, found inf"),
        ({1.0: 1.0, 2.0: 1.0}, [13], frfit.InputError, "powers: expected whole numbers from -12 to 12, found 13"),
        ({1.0: 1.0, 2.0: 1.0, 3.0: 1.0}, [1, 1], frfit.InputError, "each once, found [1, 1]"),
        ([1.0], None, frfit.InputError, "a dictionary of values and matrices"),
    ],
)
def test_matrices_without_such_powers_are_refused(matrices, powers, error, message):
    with pytest.raises(error) as refused:
        frfit.powers_of(matrices, powers=powers)
    assert message in str(refused.value)


def test_what_is_wrong_with_an_unknown_is_said(measured):
    with pytest.raises(frfit.InputError, match="one of matrix and powers"):
        frfit.Unknown("modulus")
    with pytest.raises(frfit.InputError, match="the value of a geometric parameter"):
        frfit.Unknown("width", powers={"dashpots": 2})
    with pytest.raises(frfit.InputError, match="other than 0"):
        frfit.Unknown("width", powers={"dashpots": 0}, nominal=1.0)

    def identify(*unknowns, **keys):
        return frfit.identify(
            Chain().model(NOMINAL), measurements(*measured, ({}, {})), load=0, unknowns=unknowns, **keys
        )

    springs = frfit.Unknown("modulus", matrix="springs")
    constant = frfit.Unknown("density", matrix="mass", varies="constant", real=True)
    with pytest.raises(frfit.InputError, match="method: expected nothing here"):
        identify(springs, constant, method="series")
    with pytest.raises(frfit.InputError, match="matrix: expected None beside unknowns"):
        identify(springs, matrix="mass")
    with pytest.raises(frfit.ModelError, match="a name of its own"):
        identify(constant, constant)
    with pytest.raises(frfit.InputError, match="no more unknown than measured"):
        identify(springs, frfit.Unknown("a", matrix="mass"), frfit.Unknown("b", matrix="dashpots"))


def test_one_unknown_is_the_same_either_way(measured):
    keys = {"load": 0, "band_hz": (F[0], F[-1])}
    by_matrix = frfit.identify(
        Chain().model(NOMINAL), measurements(*measured, ({}, {})), matrix="springs", bounds=BOUNDS, **keys
    )
    unknown = frfit.Unknown(matrix="springs", bounds=BOUNDS)
    by_unknown = frfit.identify(
        Chain().model(NOMINAL), measurements(*measured, ({}, {})), unknowns=unknown, **keys
    )
    assert list(by_matrix.columns())[1] == "storage"
    same_columns(by_matrix, by_unknown)
