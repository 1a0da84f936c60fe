"""What results are turned into: data frames, xarray's sets, pictures, reports."""

from __future__ import annotations

import dataclasses
import sys

import numpy as np
import pytest
from conftest import Chain, measured_chain

import frfit

F = np.linspace(4.0, 110.0, 30)


@pytest.fixture(scope="module")
def measured():
    return measured_chain(F)


@pytest.fixture(scope="module")
def one(measured):
    return frfit.identify(Chain().model(1200.0), measured, load=0, matrix="springs", check=False, exclude_hz=[(45.0, 60.0)])


@pytest.fixture(scope="module")
def several(measured):
    unknowns = [
        frfit.Unknown(matrix="springs", bounds={"storage": (100.0, 1e4), "loss_factor": (0.0, 1.0)}),
        frfit.Unknown("density", matrix="mass", varies="constant", real=True, bounds=(0.5, 2.0)),
    ]
    return frfit.identify(Chain().model(1200.0), measured, load=0, unknowns=unknowns, check=False)


def test_a_long_frame_has_a_row_for_each_unknown_and_frequency(several):
    pytest.importorskip("pandas")
    long = several.to_dataframe("long")
    assert len(long) == 2 * len(several) and list(long["unknown"].unique()) == ["springs", "density"]
    names = [field.name for field in dataclasses.fields(frfit.Estimate)]
    table = several.to_dataframe()
    for unknown in several.unknowns:
        rows = long[long["unknown"] == unknown.name]
        np.testing.assert_array_equal(rows["frequency_hz"], several.frequency_hz)
        np.testing.assert_array_equal(rows["status"], several.status)
        for name in set(long.columns) & set(names) - {"status"}:
            np.testing.assert_array_equal(rows[name], getattr(unknown, name), err_msg=name)
        # What the table has of an unknown, the long frame has too.
        for name in ("storage", "loss_factor", "storage_std", "storage_std_noise", "storage_std_known_factors"):
            np.testing.assert_array_equal(rows[name], table[f"{unknown.name}.{name}"])
    assert {"nominal", "factor", "correction", "alternative_count"} <= set(long.columns)


def test_a_frame_of_numbers_has_what_holds_for_the_band(several, one):
    pytest.importorskip("pandas")
    frame = several.to_dataframe("numbers")
    (number,) = several["density"].numbers
    assert frame.to_dict("records") == [
        {"unknown": "density", "number": number.name, "value": number.value, "std": number.std, "status": "ok"}
    ]
    assert len(one.to_dataframe("numbers")) == 0
    with pytest.raises(frfit.InputError, match=r'kind: expected "table", "long" or "numbers", found "lang" \("long" is nearest\)'):
        one.to_dataframe("lang")


def test_a_dataset_has_units_and_coordinates(one, several):
    pytest.importorskip("xarray")
    data = several.to_xarray(units={"springs": "N/m", "density": "1"})
    assert dict(data.sizes) == {"unknown": 2, "frequency": len(F), "sensor": 2}
    assert data.frequency.attrs["units"] == "Hz" and data.measured_response.attrs["units"] == "m/N"
    assert data.storage.attrs["units"] == "by unknown: N/m, 1" and data.loss_factor.attrs["units"] == "1"
    np.testing.assert_array_equal(data.storage.sel(unknown="density"), several["density"].storage)
    np.testing.assert_array_equal(data.factor.sel(unknown="springs"), several["springs"].factor)
    np.testing.assert_array_equal(data.status, several.status)
    np.testing.assert_array_equal(data.updated_response, several.updated_response)
    single = one.to_xarray("N/m")
    assert single.storage.dims == ("frequency",) and single.storage.attrs["units"] == "N/m"
    assert str(single.unknown.item()) == "springs" and list(single.sensor.values) == list(one.sensors)
    assert one.to_xarray().storage.attrs["units"] == "unit of the factor"
    trusted = single.storage.where(single.status == "ok", drop=True)
    np.testing.assert_array_equal(trusted, one.storage[one.ok])
    with pytest.raises(frfit.InputError, match=r'units: expected .*, found "spring" \("springs" is nearest\)'):
        several.to_xarray({"spring": "N/m"})


@pytest.mark.parametrize(("module", "call"), [("xarray", "to_xarray"), ("pandas", "to_dataframe"), ("matplotlib", "plot")])
def test_a_missing_package_is_named(one, monkeypatch, module, call):
    for name in [name for name in sys.modules if name.partition(".")[0] == module]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ModuleNotFoundError, match=f"{call} needs {module}: pip install {module}"):
        getattr(one, call)()


def drawn(axis, kind):
    return [line for line in axis.lines if line.get_linestyle() == kind]


def test_a_picture_has_units_bars_and_statuses(one):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    bad = one.status.copy()
    bad[5], bad[6], bad[20] = "ambiguous", "ambiguous", "unexplained"
    axes = dataclasses.replace(one, status=bad.astype("U20")).plot(units="N/m")
    assert [axis.get_ylabel() for axis in axes] == ["storage (N/m)", "loss factor (1)"]
    assert axes[1].get_xlabel() == "frequency (Hz)" and axes[0].get_xlabel() == ""
    labels = axes[0].get_legend_handles_labels()[1]
    assert {"nominal", "ok, ±2σ", "ambiguous", "unexplained", "not trusted"} == set(labels)
    # Bars of two standard deviations at the trusted values, and only there.
    (bars,) = axes[0].containers
    trusted = (bad == "ok") & one.ok
    ends = np.array([segment[:, 1] for segment in bars[2][0].get_segments()])
    np.testing.assert_allclose(ends[:, 1] - ends[:, 0], 4 * one.storage_std[trusted], rtol=1e-9)
    # Grey bands: two of what is not trusted, and one of what was left out.
    bands = [patch for patch in axes[0].patches if patch.get_alpha() is None]
    assert len(bands) == 3
    within = bands[0].get_x(), bands[0].get_x() + bands[0].get_width()
    np.testing.assert_allclose(within, ((F[4] + F[5]) / 2, (F[6] + F[7]) / 2))
    low, high = axes[0].get_ylim()
    assert low < np.min(one.storage[trusted]) and np.max(one.storage[trusted]) < 1200.0 < high
    matplotlib.pyplot.close("all")


def test_a_picture_of_several_has_a_panel_for_each_part(several):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = several.plot(units={"springs": "N/m", "density": "1"})
    assert [axis.get_ylabel() for axis in axes] == ["springs.storage (N/m)", "springs.loss factor (1)", "density (1)"]
    (band,) = axes[2].collections
    (number,) = several["density"].numbers
    heights = band.get_paths()[0].vertices[:, 1]
    np.testing.assert_allclose([heights.min(), heights.max()], [number.value - 2 * number.std, number.value + 2 * number.std])
    figure, own = matplotlib.pyplot.subplots(3)
    assert several.plot(own) is own and own[0].get_ylabel() == "springs.storage (unit of the factor)"
    with pytest.raises(frfit.InputError, match="axes: expected 3, .* found 2 axes"):
        several.plot(own[:2])
    matplotlib.pyplot.close("all")


def test_results_without_trusted_values_can_be_shown(one):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    nothing = np.full(len(one), np.nan)
    estimate = dataclasses.replace(one.unknowns[0], storage=nothing, loss_factor=nothing, storage_std=nothing)
    failed = dataclasses.replace(one, status=np.full(len(one), "failed"), unknowns=(estimate,), noise=None, explained=None)
    assert len(failed.plot()) == 2
    assert "30 failed" in repr(failed) and "storage none" in repr(failed) and "noise not known" in failed._repr_html_()
    matplotlib.pyplot.close("all")


def test_a_report_needs_the_files(one, rubber_bar, tmp_path):
    with pytest.raises(frfit.InputError, match=r"report: expected results with a folder, as run_case\(case, out\) writes them"):
        one.report()
    found = frfit.run_case(rubber_bar, tmp_path / "out", band_hz=(100.0, 300.0))
    page = found.report(tmp_path / "page.html")
    assert found.folder == tmp_path / "out" and isinstance(page, frfit.Report)
    assert (tmp_path / "page.html").read_bytes() == (tmp_path / "out/report.html").read_bytes()
    # A result of files has units of its own; without a folder there is none.
    assert frfit.run_case(rubber_bar, band_hz=(100.0, 300.0)).folder is None


def test_measurements_of_a_hammer_test_are_ready(chain):
    t = np.arange(2048) / 2048
    force = np.where((t > 0.01) & (t < 0.013), np.sin(np.pi * (t - 0.01) / 0.003), 0.0)
    noise = 1e-3 * np.random.default_rng(1).normal(size=(3, 2, 2048))
    records = [frfit.Recording(1 / 2048, force, np.stack([force, -force]) + one) for one in noise]
    found = frfit.frf(records, exponential_window_s=0.5)
    first, second = found.measurements([3, 7], quantity="accelerance", signs=[1, -1], band_hz=(10.0, 200.0))
    inside = (found.frequency_hz >= 10.0) & (found.frequency_hz <= 200.0)
    np.testing.assert_array_equal(first.frequency_hz, found.frequency_hz[inside])
    np.testing.assert_array_equal(second.response, found.response[1, inside])
    assert found.std is not None
    np.testing.assert_array_equal(second.std, found.std[1, inside])
    assert (second.row, second.sign, second.decay_per_s) == (7, -1.0, found.decay_per_s) and found.decay_per_s > 0
    for options, match in (
        ({"rows": 3}, "rows: expected 2, one for each sensor, found 1"),
        ({"rows": [3, 4], "signs": [1]}, "signs: expected 2"),
        ({"rows": [3, 4], "band_hz": (2000.0, 3000.0)}, "band_hz: expected a band with frequencies of"),
        ({"rows": [3, -1]}, "rows: expected a row"),
    ):
        with pytest.raises(frfit.InputError, match=match):
            found.measurements(**{"quantity": "accelerance", **options})
