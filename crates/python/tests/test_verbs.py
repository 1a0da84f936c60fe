"""Every verb of the command line has its call, and both give the same: what is printed as JSON, and the files, bit for bit."""

from __future__ import annotations

import json
import pathlib
import re
import subprocess
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import frfit


@pytest.fixture(scope="module")
def said(cli: pathlib.Path) -> Any:
    """What a command prints as JSON."""

    def run(*words: object) -> Any:
        done = subprocess.run([cli, "--json", *map(str, words)], check=True, capture_output=True, text=True)
        return json.loads(done.stdout)

    return run


def same_files(a: pathlib.Path, b: pathlib.Path) -> None:
    """Both folders have the same files, but for what says when and how long, and where."""
    names = {path.relative_to(a) for path in a.rglob("*") if path.is_file()}
    assert names and names == {path.relative_to(b) for path in b.rglob("*") if path.is_file()}
    for name in names:
        if name.suffix == ".json" or name.name == "report.html":
            continue
        assert (a / name).read_bytes() == (b / name).read_bytes(), name


def timeless(value: Any) -> Any:
    """Without seconds."""
    if isinstance(value, dict):
        return {key: timeless(one) for key, one in value.items() if key != "seconds"}
    return [timeless(one) for one in value] if isinstance(value, list) else value


def test_every_verb_has_a_call(cli: pathlib.Path) -> None:
    text = subprocess.run([cli, "--help"], check=True, capture_output=True, text=True).stdout
    verbs = set(re.findall(r"^  ([a-z]+) ", text, flags=re.MULTILINE)) - {"help", "completions", "man"}
    calls = {"identify": "run_case", "respond": "respond_case", "frf": "frf_of_files", "report": "Report"}
    assert len(verbs) >= 15
    assert not [verb for verb in verbs if not callable(getattr(frfit, calls.get(verb, verb), None))]


def test_check(rubber_bar: pathlib.Path, said: Any, tmp_path: pathlib.Path) -> None:
    wrong = tmp_path / "case.toml"
    text = rubber_bar.read_text().replace("row = 76", "row = 76\nscale = -1.0")
    for name in ("K.mtx", "M.mtx", "force.csv", "frf.uff"):
        text = text.replace(f'"{name}"', json.dumps(str(rubber_bar.parent / name)))
    wrong.write_text(text)
    for case in (rubber_bar, wrong):
        found = frfit.check(case)
        assert found.summary == said("check", case)
        assert found.is_clean == (case == rubber_bar)
    assert [finding.kind for finding in found.findings] == ["sign"] and "sign" in repr(found)


def test_sensitivities(rubber_bar: pathlib.Path, said: Any, tmp_path: pathlib.Path) -> None:
    found = frfit.sensitivities(rubber_bar, tmp_path / "a", noise=0.02, candidates=[12, 50])
    command = said("sensitivities", rubber_bar, "--out", tmp_path / "b", "--noise", 0.02, "--candidates", "12,50")
    assert timeless(found.summary) == timeless(command)
    assert {one["name"] for one in found.parameters} == {"rubber", "rubber loss factor", "mass"}
    same_files(tmp_path / "a", tmp_path / "b")
    with pytest.raises(frfit.OptionsError, match="candidates: expected all, none, or degrees of freedom"):
        frfit.sensitivities(rubber_bar, candidates="12+Q")


def test_fit_and_export(rubber_bar: pathlib.Path, said: Any, cli: pathlib.Path, tmp_path: pathlib.Path) -> None:
    results = tmp_path / "results"
    frfit.run_case(rubber_bar, results)
    table = results / "identified.csv"
    fits = frfit.fit(table, tmp_path / "a", laws=["fractional", "constant"])
    command = said("fit", table, "--law", "fractional,constant", "--out", tmp_path / "b")
    assert fits.summary == command and fits.best.name == "fractional"
    same_files(tmp_path / "a", tmp_path / "b")
    # The truth of the example.
    assert abs(fits.best.parameters["e0"] / 8.14e5 - 1) < 1e-6
    truth = frfit.Law.fractional(8.14e5, 7.31e4, 0.528)
    np.testing.assert_allclose(fits.best.law.at([20.0, 700.0]), truth.at([20.0, 700.0]), rtol=1e-6)
    for target in ("nastran", "abaqus", "ansys", "csv", "json"):
        law = tmp_path / "a" / "law.json"
        text = frfit.export(target, table, tmp_path / "python", poisson=0.45, law=law)
        assert (tmp_path / "python").read_text() == text
        words = ["export", target, table, "-o", tmp_path / "command", "--poisson", "0.45", "--law", law]
        subprocess.run([cli, *words], check=True, capture_output=True)
        assert (tmp_path / "command").read_text() == text
    with pytest.raises(frfit.OptionsError, match="target"):
        frfit.export("patran", table)
    page = frfit.Report(results)
    page.save(tmp_path / "page.html")
    said("report", results)
    assert (tmp_path / "page.html").read_bytes() == (results / "report.html").read_bytes()


def test_files(rubber_bar: pathlib.Path, said: Any, cli: pathlib.Path, tmp_path: pathlib.Path) -> None:
    folder = rubber_bar.parent
    for name in ("K.mtx", "frf.uff", "force.csv"):
        assert frfit.inspect(folder / name) == said("inspect", folder / name)
    words = [cli, "--json", "inspect", folder / "K.mtx", folder / "M.mtx", "--modes", "5"]
    last = subprocess.run(words, check=True, capture_output=True, text=True).stdout.splitlines()[-1]
    found = frfit.natural_frequencies(folder / "K.mtx", folder / "M.mtx", 5)
    assert found == json.loads(last) and found["rigid_body_modes"] == 1
    for source, target, how in (("K.mtx", "K.rsa", {}), ("frf.uff", "frf.csv", {"record": 1})):
        frfit.convert(folder / source, tmp_path / f"python-{target}", **how)
        options = [str(word) for name, value in how.items() for word in (f"--{name}", value)]
        command = [cli, "convert", folder / source, tmp_path / f"command-{target}", *options]
        subprocess.run(command, check=True, capture_output=True)
        assert (tmp_path / f"python-{target}").read_bytes() == (tmp_path / f"command-{target}").read_bytes()


def test_respond(rubber_bar: pathlib.Path, said: Any, tmp_path: pathlib.Path) -> None:
    found = frfit.respond_case(rubber_bar, tmp_path / "a", band_hz=(100.0, 300.0))
    said("respond", rubber_bar, "--out", tmp_path / "b", "--band", "100:300")
    same_files(tmp_path / "a", tmp_path / "b")
    assert found.receptance.shape == (len(found.frequency_hz), 1) and found.sensors == ("row 76",)
    again = frfit.respond_case(rubber_bar, band_hz=(100.0, 300.0))
    np.testing.assert_array_equal(found.receptance, again.receptance)


def test_identify_train_and_modes(rubber_bar: pathlib.Path, said: Any, tmp_path: pathlib.Path) -> None:
    frfit.run_case(rubber_bar, tmp_path / "a")
    said("identify", rubber_bar, "--out", tmp_path / "b")
    same_files(tmp_path / "a", tmp_path / "b")
    trained = frfit.train(rubber_bar, tmp_path / "a.frfit")
    command = said("train", rubber_bar, "-o", tmp_path / "b.frfit")
    assert (trained.vectors, trained.factorisations) == (command["vectors"], command["factorisations"])
    assert (tmp_path / "a.frfit").read_bytes() == (tmp_path / "b.frfit").read_bytes()
    found = frfit.modes(rubber_bar, tmp_path / "c")
    command = said("modes", rubber_bar, "--out", tmp_path / "d")
    same_files(tmp_path / "c", tmp_path / "d")
    kept = frfit.modes(rubber_bar, reduced=tmp_path / "a.frfit")
    np.testing.assert_allclose(kept.frequency_hz, found.frequency_hz, rtol=1e-8)
    ranked = frfit.sensitivities(rubber_bar, reduced=tmp_path / "a.frfit", candidates="none")
    assert ranked.summary["counts"]["solves"] < frfit.sensitivities(rubber_bar, candidates="none").summary["counts"]["solves"]
    modes = [mode["frequency_hz"] for mode in command["model"]["modes"]]
    assert list(found.frequency_hz) == modes[: len(found.frequency_hz)]


def test_records_of_a_hammer_test(said: Any, tmp_path: pathlib.Path) -> None:
    frfit.example("hammer-bar", tmp_path)
    records = next(path for path in tmp_path.iterdir() if path.suffix in (".csv", ".lvm", ".uff") and "record" in path.name)
    found = frfit.frf_of_files(records, tmp_path / "a.uff", estimator="hv")
    command = said("frf", records, "-o", tmp_path / "b.uff", "--estimator", "hv")
    assert (tmp_path / "a.uff").read_bytes() == (tmp_path / "b.uff").read_bytes()
    assert found["impacts"] == command["impacts"]
    with pytest.raises(frfit.OptionsError, match="response_unit"):
        frfit.frf_of_files(records, tmp_path / "c.uff", response_unit="furlong")


def test_examples_and_the_demo(said: Any, tmp_path: pathlib.Path) -> None:
    listed = said("example")
    assert frfit.examples() == {one["name"]: one["summary"] for one in listed}
    names = frfit.example("density", tmp_path / "a")
    assert names == said("example", "density", tmp_path / "b")["files"]
    same_files(tmp_path / "a", tmp_path / "b")
    # What somebody edited stays.
    case = tmp_path / "a" / "case.toml"
    case.write_text(case.read_text() + "# mine\n")
    with pytest.raises(frfit.WriteError, match="an edited file is not overwritten"):
        frfit.example("density", tmp_path / "a")
    assert case.read_text().endswith("# mine\n")
    with pytest.raises(frfit.OptionsError):
        frfit.example("no-such-example", tmp_path)
    found = frfit.demo(tmp_path / "demo")
    said("demo", "--out", tmp_path / "command")
    same_files(tmp_path / "demo", tmp_path / "command")
    assert found.trusted == 1.0


def test_check_and_modes_of_arrays_are_those_of_a_case(tmp_path: pathlib.Path) -> None:
    """A chain of masses, in files and in arrays."""
    n = 12
    ones = np.ones(n)
    stiffness = sp.diags_array([2 * ones, -ones[1:], -ones[1:]], offsets=[0, 1, -1], format="csc")
    mass = sp.diags_array([0.01 * ones], offsets=[0], format="csc")
    sp.save_npz(tmp_path / "K.npz", stiffness)
    sp.save_npz(tmp_path / "M.npz", mass)

    def model(k: complex) -> frfit.Model:
        return frfit.Model([frfit.Term("springs", stiffness, factor=k), frfit.Term("mass", mass, role="mass")])

    f = np.linspace(2.0, 60.0, 120)
    exact = frfit.respond(model(1000 * (1 + 0.03j)), f, load=0, sensors=[4, 9])
    noise = np.random.default_rng(2).normal(size=(2, *exact.shape))
    u = exact * (1 + 0.003 * (noise[0] + 1j * noise[1]))
    u[:, 1] *= -1.0
    lines = []
    for k, row in enumerate((4, 9)):
        table = np.column_stack([f, u[:, k].real, u[:, k].imag])
        text = "\n".join(",".join(repr(float(x)) for x in line) for line in table)
        (tmp_path / f"{row}.csv").write_text(f"frequency_hz,re,im\n{text}\n")
        lines.append(f'[[measurement]]\nfile = "{row}.csv"\nrow = {row + 1}\nquantity = "receptance"\n')
    case = tmp_path / "case.toml"
    case.write_text(
        'title = "chain"\n'
        '[[matrix]]\nname = "springs"\nrole = "stiffness"\nfile = "K.npz"\nfactor = { storage = 1200.0, loss_factor = 0.0 }\n'
        '[[matrix]]\nname = "mass"\nrole = "mass"\nfile = "M.npz"\n'
        "[load]\nrow = 1\n" + "".join(lines) + '[identify]\nmatrix = "springs"\nband_hz = [2.0, 60.0]\n'
    )
    measured = [frfit.Measurement(f, u[:, k], row=row) for k, row in enumerate((4, 9))]
    # Beyond some 35 Hz the "mesh" of a chain is too coarse.
    of_case = frfit.check(case, band_hz=(2.0, 30.0))
    of_arrays = frfit.check(model(1200.0), measured, load=0, matrix="springs", band_hz=(2.0, 30.0))
    assert [finding.kind for finding in of_arrays.findings] == ["sign"]
    # The same, but for indices from 0 in place of numbers from 1.
    (one,), (other,) = of_arrays.summary["findings"], of_case.summary["findings"]
    assert (one.pop("sensors"), other.pop("sensors")) == (["row 9"], ["row 10"])
    assert one.pop("change") == "sign of measurements[1] (or of load): the opposite one"
    assert "[[measurement]] 2" in other.pop("change")
    assert one == other and of_arrays.misfit == of_case.misfit

    right = [measured[0], frfit.Measurement(f, -u[:, 1], row=9)]
    (tmp_path / "9.csv").write_text(
        "frequency_hz,re,im\n"
        + "".join(f"{a!r},{b!r},{c!r}\n" for a, b, c in zip(f.tolist(), (-u[:, 1].real).tolist(), (-u[:, 1].imag).tolist()))
    )
    modes, again = frfit.modes(case), frfit.modes(model(1200.0), measurements=right, load=0, matrix="springs", band_hz=(2.0, 60.0))
    for name in ("frequency_hz", "measured_frequency_hz", "measured_frequency_std_hz", "pairs", "mac", "frac"):
        np.testing.assert_array_equal(getattr(modes, name), getattr(again, name), err_msg=name)
    assert len(modes.pairs) >= 5
    assert (modes.sensors, again.sensors) == (("row 5", "row 10"), ("row 4", "row 9"))
    # Of the model alone: a closed form.
    alone = frfit.modes(model(1000.0), load=0, sensors=[4], band_hz=(1.0, 120.0))
    exactly = np.sqrt(4 * 1000.0 / 0.01) * np.sin(np.arange(1, n + 1) * np.pi / (2 * (n + 1))) / (2 * np.pi)
    np.testing.assert_allclose(alone.frequency_hz, exactly[exactly <= 120.0], rtol=1e-9)

    ranked = frfit.sensitivities(model(1200.0), frequency_hz=f, load=0, sensors=[4, 9], noise=0.01, candidates=[0, 5])
    of_file = frfit.sensitivities(case, noise=0.01, candidates=[1, 6])
    # Rows count from 0 beside arrays and from 1 in a case.
    in_case = json.loads(json.dumps(ranked.parameters).replace('"row 9"', '"row 10"').replace('"row 4"', '"row 5"'))
    assert in_case == list(of_file.parameters)
    assert ranked.next_sensor is not None and of_file.next_sensor is not None
    best, theirs = ranked.next_sensor["best"], of_file.next_sensor["best"]
    assert [place["row"] + 1 for place in best] == [place["row"] for place in theirs]
    assert [place["dof"] for place in best] == [f"row {place['row']}" for place in best]
    assert [place["after"] for place in best] == [place["after"] for place in theirs]


def test_what_does_not_go_together_is_refused(rubber_bar: pathlib.Path) -> None:
    with pytest.raises(frfit.InputError, match="load: expected nothing beside a case file"):
        frfit.check(rubber_bar, load=0)
    model = frfit.Model([frfit.Term("k", np.eye(2), factor=1e3), frfit.Term("m", np.eye(2), role="mass")])
    with pytest.raises(frfit.InputError, match="band_hz: expected first and last frequency"):
        frfit.modes(model, load=0, sensors=[0])
    with pytest.raises(frfit.InputError, match="load: expected a row"):
        frfit.check(model)
