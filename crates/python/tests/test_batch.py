"""Reduced models that are trained once, and the runs of a plan: the same bits wherever they are done."""

from __future__ import annotations

import csv
import json
import math
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import frfit
import frfit.distributed

BANDS = ["[300.0, 400.0]", "[300.0, 390.0]", "[300.0, 380.0]"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, sandwich: Path) -> Path:
    """A plan of three runs beside a case, and a reduced model for them."""
    folder = tmp_path_factory.mktemp("batch")
    for file in sandwich.iterdir():
        if file.is_file():
            (folder / file.name).write_bytes(file.read_bytes())
    text = (folder / "case.toml").read_text()
    assert "band_hz = [20.0, 1000.0]" in text
    (folder / "case.toml").write_text(text.replace("band_hz = [20.0, 1000.0]", "band_hz = [300.0, 400.0]"))
    with (folder / "plan.csv").open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["case", "specimen", "identify.band_hz"])
        rows.writerows(["case.toml", f"beam {k}", band] for k, band in enumerate(BANDS))
    trained = frfit.train(folder / "case.toml", folder / "model.frfit")
    assert trained.vectors > 10 and trained.factorisations >= 1
    return folder


def tables(store: Path) -> dict[str, bytes]:
    return {run.name: (run / "identified.csv").read_bytes() for run in (store / "runs").iterdir()}


def test_runs_are_the_same_at_once_and_in_other_processes(folder: Path) -> None:
    plan, reduced = folder / "plan.csv", folder / "model.frfit"
    at_once = frfit.batch(plan, folder / "whole", reduced=reduced)
    assert (at_once.rows, at_once.done, at_once.failed) == (3, 3, [])
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        shared = frfit.distributed.map(executor, plan, folder / "shares", reduced=reduced, shares=2)
    assert (shared.rows, shared.done, shared.kept) == (3, 3, 0)
    assert tables(folder / "whole") == tables(folder / "shares")
    again = frfit.batch(plan, folder / "shares", reduced=reduced)
    assert (again.done, again.kept) == (0, 3)
    status = frfit.batch_status(plan, folder / "shares", reduced=reduced)
    assert (status.done, status.failed, status.missing) == (3, 0, 0)
    # Another training would be another run.
    assert frfit.batch_status(plan, folder / "shares").missing == 3


def test_a_table_of_all_runs(folder: Path) -> None:
    frfit.batch(folder / "plan.csv", folder / "table", reduced=folder / "model.frfit", jobs=1)
    table = frfit.collect(folder / "table")
    assert table["specimen"] == ["beam 0", "beam 1", "beam 2"]
    assert table["verdict"] == ["explained"] * 3
    lines = frfit.collect(folder / "table", lines=True)
    of_first = [k for k, name in enumerate(lines["specimen"]) if name == "beam 0"]
    assert len(of_first) == table["lines"][0]
    storage = [lines["storage"][k] for k in of_first]
    assert math.isclose(float(np.median(np.array(storage, dtype=float))), float(table["storage"][0]), rel_tol=1e-12)


def test_a_kept_model_saves_the_training(folder: Path) -> None:
    case, reduced = folder / "case.toml", folder / "model.frfit"
    fresh = frfit.run_case(case)
    kept = frfit.run_case(case, reduced=reduced, keep_reduced=folder / "more.frfit")
    assert np.array_equal(fresh.factor, kept.factor)
    frfit.run_case(case, folder / "out", reduced=folder / "more.frfit")
    counts = json.loads((folder / "out" / "summary.json").read_text())["counts"]
    assert (counts["factorisations"], counts["solves"]) == (0, 0)
    # NumPy opens the file.
    arrays = np.load(folder / "more.frfit")
    assert arrays["vectors"].shape[1] == arrays["weight"].shape[0]


def test_what_cannot_be_is_refused(folder: Path) -> None:
    with pytest.raises(frfit.InputError, match="another load|another matrix|sensors|another kind"):
        frfit.run_case(folder / "case.toml", reduced=folder / "frf.uff")
    with pytest.raises(frfit.OptionsError, match="shard"):
        frfit.batch(folder / "plan.csv", folder / "none", shard=(3, 2))
    (folder / "wrong.csv").write_text("case,measurement.1.file\ncase.toml,none.uff\n")
    failed = frfit.batch(folder / "wrong.csv", folder / "failed").failed
    assert failed[0][0] == 1 and "none.uff" in failed[0][1]


def test_workers_of_dask_have_the_same_bits(folder: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
    plan, reduced = folder / "plan.csv", folder / "model.frfit"
    frfit.batch(plan, folder / "here", reduced=reduced)
    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        there = frfit.distributed.map(client, plan, folder / "there", reduced=reduced, shares=3)
    assert there.done == 3
    assert tables(folder / "here") == tables(folder / "there")
