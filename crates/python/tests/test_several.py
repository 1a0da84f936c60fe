"""Several unknowns, and the page of results: the same as the command line."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest
from test_case import table

import frfit


@pytest.fixture(scope="module")
def added_mass(cli, tmp_path_factory):
    """The complete case `added-mass`: a mass and a complex modulus, one number for the band each."""
    folder = tmp_path_factory.mktemp("mass") / "mass"
    subprocess.run([cli, "example", "added-mass", folder], check=True, capture_output=True)
    return folder / "case.toml"


@pytest.fixture(scope="module")
def found(added_mass):
    return frfit.run_case(added_mass)


def test_numbers_are_those_of_the_command_line_bit_by_bit(cli, added_mass, found, tmp_path):
    out = tmp_path / "out"
    subprocess.run([cli, "identify", added_mass, "--out", out], check=True, capture_output=True)
    rows = table(out / "identified.csv")
    columns = found.columns()
    assert len(rows) == len(found) > 100
    assert list(rows[0]) == list(columns)
    for name, column in columns.items():
        written = [row[name] for row in rows]
        if name == "status":
            assert written == list(column)
        else:
            # Tables hold the shortest digits that read back as the same number.
            read = np.array([float(cell) if cell else np.nan for cell in written])
            np.testing.assert_array_equal(read, column, err_msg=name)


def test_the_values_are_within_their_bars(found):
    mass, beam = found["component"], found["beam"]
    assert found.is_trusted and found.converged and found.ok.all() and found.explained == "explained"
    assert found.not_identifiable == ()
    for one, exact in [(mass, [0.065]), (beam, [6.9e10, 0.003])]:
        assert one.status == "ok" and len(one.numbers) == len(exact)
        for number, truth in zip(one.numbers, exact, strict=True):
            # The noise of the example is the same each time; beyond three deviations are 3 of 1000.
            assert abs(number.value - truth) < 3 * number.std < 0.02 * truth, number
    assert mass.real and np.all(mass.factor.imag == 0) and np.isnan(mass.loss_factor_std).all()
    with pytest.raises(KeyError, match="component, beam"):
        found["bean"]
    with pytest.raises(AttributeError, match=r"expected found\[name\] with one of 'component', 'beam'"):
        found.storage


def test_correlation_and_directions_belong_to_the_coordinates(found):
    assert found.coordinates == ("component", "beam storage", "beam loss_factor")
    assert found.correlation.shape == (3, 3)
    np.testing.assert_allclose(np.diag(found.correlation), 1.0, rtol=1e-12)
    np.testing.assert_allclose(found.correlation, found.correlation.T, atol=1e-12)
    stds = [direction.std for direction in found.directions]
    assert stds == sorted(stds, reverse=True)
    for direction in found.directions:
        assert set(direction.weights) <= set(found.coordinates)
        assert sum(weight**2 for weight in direction.weights.values()) == pytest.approx(1.0)
    # Chi squared grows with the square: the profile of a problem that is nearly linear. It has the
    # noise alone, while standard deviations also hold errors of the model.
    distance, chi2 = found.profile.T
    curvature = chi2[distance != 0.0] / distance[distance != 0.0] ** 2
    np.testing.assert_allclose(curvature, curvature[0], rtol=0.02)
    assert 1.0 / stds[0] ** 2 <= curvature[0] <= 3.0 / stds[0] ** 2


def test_responses_explain_the_measurements(found):
    off = np.linalg.norm(found.updated_response - found.measured_response, axis=1)
    off /= np.linalg.norm(found.measured_response, axis=1)
    np.testing.assert_allclose(off, found.error, rtol=1e-6)


def test_table_and_picture(found):
    pandas = pytest.importorskip("pandas")
    frame = found.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and list(frame) == list(found.columns())
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert len(found.plot()) == 3
    assert "component" in repr(found) and "component" in repr(found["component"])


def test_options_of_one_unknown_are_refused(added_mass):
    with pytest.raises(frfit.InputError, match="--method"):
        frfit.run_case(added_mass, method="series")


def test_the_report_is_that_of_the_command_line(cli, added_mass, tmp_path):
    out = tmp_path / "out"
    frfit.run_case(added_mass, out)
    page = (out / "report.html").read_bytes()
    report = frfit.Report(out)
    assert report.html.encode() == page
    (out / "report.html").unlink()
    assert report.save() == out / "report.html" and (out / "report.html").read_bytes() == page
    subprocess.run([cli, "report", out], check=True, capture_output=True)
    assert (out / "report.html").read_bytes() == page
    assert report.save(tmp_path / "elsewhere.html").read_bytes() == page
    with pytest.raises(frfit.InputError, match="expected a folder with the results"):
        frfit.Report(tmp_path / "nowhere")
