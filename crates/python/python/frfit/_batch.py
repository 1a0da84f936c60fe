"""Reduced models that are trained once, and many runs by one plan."""

from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass

from . import _frfit
from ._arrays import callable_, flag, hints, optional_pair, optional_whole, whole
from ._errors import OptionsError
from ._model import Progress
from ._shown import html_list, html_of, html_table

_Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Trained:
    """A reduced model that was trained and written."""

    vectors: int
    """Its size."""
    factorisations: int
    """Factorisations of the training."""
    solves: int
    """Solves of the training."""
    bytes: int
    """Size of the file."""
    seconds: float
    """How long the training took."""


@dataclass(frozen=True, repr=False)
class Batch:
    """What was done of a plan."""

    rows: int
    """Rows of the share."""
    kept: int
    """Runs that were there already."""
    done: int
    """Runs that were done."""
    left_failed: int
    """Runs that failed before and were not tried again."""
    failed: list[tuple[int, str]]
    """Row (from 1) and reason of each run that failed."""
    seconds: float
    """How long it took."""

    def __repr__(self) -> str:
        counts = f"{self.rows} rows, {self.done} done, {self.kept} kept, {len(self.failed)} failed"
        lines = [f"<frfit.Batch: {counts} in {self.seconds:.3g} s"]
        if self.left_failed:
            lines.append(f"  {self.left_failed} failed before and were not tried again")
        lines += [f"  row {row}: {_short(reason)}" for row, reason in self.failed[:3]]
        if len(self.failed) > 3:
            lines.append(f"  and {len(self.failed) - 3} more")
        return "\n".join(lines) + ">"

    def _repr_html_(self) -> str:
        """What a notebook shows: counts, and the first runs that failed."""
        counts = [f"{self.rows} rows, {self.done} done, {self.kept} kept, {self.left_failed} left, {self.seconds:.3g} s"]
        if not self.failed:
            return html_of("Batch", html_list(counts))
        if len(self.failed) > 20:
            counts.append(f"the first 20 of {len(self.failed)} that failed:")
        failed = html_table(("row", "why it failed"), [(row, _short(why)) for row, why in self.failed[:20]])
        return html_of("Batch", html_list(counts), failed)


def _short(reason: str) -> str:
    """A reason in one line."""
    line = " ".join(reason.split())
    return line if len(line) <= 160 else f"{line[:157]}..."


@dataclass(frozen=True)
class BatchStatus:
    """How far a batch has come."""

    rows: int
    """Rows of the plan."""
    done: int
    """Runs that are done."""
    failed: int
    """Runs that failed."""

    @property
    def missing(self) -> int:
        """Runs that were not tried yet, or were ended."""
        return self.rows - self.done - self.failed


@hints
def train(
    path: _Path,
    out: _Path,
    *,
    band_hz: tuple[float, float] | None = None,
    reduced: _Path | None = None,
    memory_bytes: int | None = None,
) -> Trained:
    """What ``frfit train CASE`` does: trains the reduced model of a case and writes it, for ``reduced=`` of other runs.

    The case needs no measured FRFs: it is trained at the frequencies of ``[respond]``, or over the band.

    Raises
    ------
    InputError, OutsideTableError, ModelMemoryError, WriteError
        The exception has the message that the command line prints.
    """
    band = optional_pair(band_hz, "band_hz")
    return Trained(**_frfit.train(path, out, band, reduced, optional_whole(memory_bytes, "memory_bytes", 0)))


@hints
def batch(
    plan: _Path,
    out: _Path,
    *,
    reduced: _Path | None = None,
    shard: tuple[int, int] = (1, 1),
    jobs: int | None = None,
    retry_failed: bool = False,
    memory_bytes: int | None = None,
    progress: Progress | None = None,
) -> Batch:
    """What ``frfit batch PLAN`` does: the runs of a plan that are missing in a folder of results.

    ``shard=(i, n)`` is the i-th of n shares, from 1. Each of ``jobs`` runs at a time has one thread; by default there are as many as cores.

    Raises
    ------
    InputError, WriteError
        The exception has the message that the command line prints. A run that fails is in ``failed`` of what is returned.
    """
    index, count = whole(shard[0], "shard"), whole(shard[1], "shard")
    if not 1 <= index <= count:
        raise OptionsError(f"shard: expected (i, n) with 1 <= i <= n, found ({index}, {count})")
    limit = optional_whole(memory_bytes, "memory_bytes", 0)
    at_a_time = optional_whole(jobs, "jobs", 1)
    done = _frfit.batch(
        plan, out, reduced, (index, count), at_a_time, flag(retry_failed, "retry_failed"), limit, callable_(progress)
    )
    return Batch(**done)


@hints
def batch_status(plan: _Path, out: _Path, *, reduced: _Path | None = None) -> BatchStatus:
    """What ``frfit batch status PLAN`` says."""
    return BatchStatus(*_frfit.batch_status(plan, out, reduced))


@hints
def collect(store: _Path, *, lines: bool = False) -> dict[str, list[str | float]]:
    """What ``frfit batch collect STORE`` writes: the columns of one table of all runs.

    A row is a run, or with ``lines`` a line of a run. ``pandas.DataFrame(frfit.collect(store))`` is a data frame; numbers are floats, and an empty cell of a column of numbers is NaN.
    """
    rows = csv.reader(io.StringIO(_frfit.batch_table(store, flag(lines, "lines"))))
    names = next(rows)
    return {name: _column(list(cells)) for name, cells in zip(names, zip(*rows), strict=True)}


def _column(cells: list[str]) -> list[str | float]:
    try:
        numbers: list[str | float] = [float(cell) if cell else float("nan") for cell in cells]
    except ValueError:
        return list(cells)
    return numbers if any(cells) else list(cells)
