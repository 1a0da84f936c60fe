"""Case files: the same numbers and the same words as the command line."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest
from conftest import copied

import frfit


def table(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


@pytest.mark.parametrize("options", [["--method", "rational"], ["--method", "series", "--order", "12"]])
def test_numbers_are_those_of_the_command_line_bit_by_bit(cli, rubber_bar, tmp_path, options):
    out = tmp_path / "out"
    subprocess.run([cli, "identify", rubber_bar, "--out", out, *options], check=True, capture_output=True)
    words = dict(zip(options[::2], options[1::2], strict=True))
    order = int(words["--order"]) if "--order" in words else None
    found = frfit.run_case(rubber_bar, method=words.get("--method"), order=order)
    rows = table(out / "identified.csv")
    assert len(rows) == len(found) > 10
    columns = found.columns()
    assert list(rows[0]) == list(columns)
    for name, column in columns.items():
        written = [row[name] for row in rows]
        if name == "status":
            assert written == list(column)
        else:
            # Tables hold the shortest digits that read back as the same number.
            read = np.array([float(cell) if cell else np.nan for cell in written])
            np.testing.assert_array_equal(read, column.astype(float), err_msg=name)


def test_files_are_those_of_the_command_line(cli, rubber_bar, tmp_path):
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    frfit.run_case(rubber_bar, ours)
    subprocess.run([cli, "identify", rubber_bar, "--out", theirs], check=True, capture_output=True)
    assert sorted(p.name for p in ours.iterdir()) == sorted(p.name for p in theirs.iterdir())
    for name in ["identified.csv", "candidates.csv", "response.csv"]:
        assert (ours / name).read_bytes() == (theirs / name).read_bytes()


def test_arrays_give_the_numbers_of_the_case_file(rubber_bar):
    """The example's own files, read here and handed over as arrays."""
    case = frfit.run_case(rubber_bar)
    tomllib = pytest.importorskip("tomllib")
    toml = tomllib.loads(rubber_bar.read_text())
    folder = rubber_bar.parent

    def factor(value):
        if not isinstance(value, dict):
            return value
        return frfit.Law.fractional(value["e0"], value["e1"], value["alpha"])

    model = frfit.Model(
        [
            frfit.Term(one["name"], frfit.read_matrix(folder / one["file"]), one["role"], factor(one["factor"]))
            for one in toml["matrix"]
        ]
    )
    force = np.zeros(model.dim, dtype=complex)
    for row in table(folder / toml["load"]["file"]):
        force[int(row["row"]) - 1] = float(row["re"]) + 1j * float(row["im"])
    (entry,) = toml["measurement"]
    (function,) = frfit.read_uff(folder / entry["file"]).functions()
    quantity = {8: "receptance", 11: "mobility", 12: "accelerance"}[function.ordinate_axis.quantity]
    wanted = toml["identify"]
    found = frfit.identify(
        model,
        frfit.Measurement(function.abscissa, function.values, row=entry["row"] - 1, quantity=quantity),
        load=force,
        matrix=wanted["matrix"],
        band_hz=tuple(wanted["band_hz"]),
        bounds={key: tuple(pair) for key, pair in wanted["bounds"].items()},
        method=wanted.get("method"),
        order=wanted.get("order"),
        selection=wanted.get("selection"),
    )
    np.testing.assert_array_equal(found.factor, case.factor)
    np.testing.assert_array_equal(found.updated_response, case.updated_response)
    np.testing.assert_array_equal(found.status, case.status)


def test_errors_have_the_words_of_the_command_line(cli, rubber_bar, tmp_path):
    case = copied(rubber_bar, tmp_path / "broken")
    case.write_text(case.read_text().replace("band_hz", "band_hertz"))
    run = subprocess.run([cli, "identify", case, "--out", tmp_path / "out"], capture_output=True, text=True)
    assert run.returncode == 2
    with pytest.raises(frfit.InputError) as caught:
        frfit.run_case(case)
    assert str(caught.value) in run.stderr
    assert caught.value.line is not None and caught.value.file == str(case)
    with pytest.raises(frfit.InputError, match="expected a case file, found none"):
        frfit.run_case(tmp_path / "nothing.toml")
    with pytest.raises(frfit.ModelMemoryError, match="degrees of freedom: expected"):
        frfit.run_case(rubber_bar, memory_bytes=10)
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(frfit.WriteError, match="expected to write here"):
        frfit.run_case(rubber_bar, blocked / "out")


def test_progress_counts_up_to_all_frequencies(rubber_bar):
    seen = []
    found = frfit.run_case(rubber_bar, method="series", progress=lambda done, total: seen.append((done, total)))
    assert seen and all(0 <= done <= total <= len(found) for done, total in seen)


def test_what_the_callback_raises_ends_the_work(rubber_bar):
    def enough(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        frfit.run_case(rubber_bar, method="nelder-mead", order=200, progress=enough)


def long_work():
    """A model whose response takes far longer than the second in which Ctrl-C is answered."""
    n = 70
    eye, ones = np.eye(n), np.ones(n - 1)
    line = 2 * eye - np.diag(ones, 1) - np.diag(ones, -1)
    import scipy.sparse as sp

    k = sp.csc_array(sp.kron(sp.csc_array(line), sp.eye_array(n)) + sp.kron(sp.eye_array(n), sp.csc_array(line)))
    mass = sp.eye_array(n * n, format="csc")
    model = frfit.Model([frfit.Term("k", k, factor=1 + 0.01j), frfit.Term("m", mass, role="mass")])
    return model, np.linspace(0.01, 0.2, 20000)


@pytest.fixture
def interruptible():
    """Ctrl-C interrupts, also where a shell started the tests in the background and so ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_is_answered_within_a_second_and_the_model_stays_usable():
    model, f = long_work()
    before = frfit.respond(model, f[:2], load=0, sensors=[5])
    pressed = []

    def press():
        time.sleep(0.5)
        pressed.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=press).start()
    with pytest.raises(KeyboardInterrupt):
        frfit.respond(model, f, load=0, sensors=[5])
    assert time.perf_counter() - pressed[0] < 1.0
    start = time.perf_counter()
    np.testing.assert_array_equal(frfit.respond(model, f[:2], load=0, sensors=[5]), before)
    # What was cancelled does not go on with 20000 frequencies, minutes of work, before anybody else gets a turn.
    assert time.perf_counter() - start < 10.0


def test_other_threads_of_python_run_meanwhile():
    model, f = long_work()
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.01)

    thread = threading.Thread(target=tick)
    thread.start()
    frfit.respond(model, f[:40], load=0, sensors=[5])
    done.set()
    thread.join()
    # With the GIL held there would be one tick before and one after.
    assert len(ticks) > 5
