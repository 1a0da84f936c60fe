"""Natural frequencies, damping and shapes, of the model and of what was measured."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _frfit
from ._arrays import (
    Complex,
    Flags,
    Real,
    hints,
    load_vector,
    only_of_a_case,
    only_of_a_model,
    optional_pair,
    optional_whole,
    refuse,
)
from ._identify import Measurement, Unknown, arguments_of
from ._model import Model, model_of, sensors_of
from ._shown import html_list, html_of, html_table


@dataclass(frozen=True, eq=False, repr=False)
class Modes:
    """Modes of the model and of the measurements, and which is which.

    Arrays have n rows, one a mode of the model up to the end of the band; k rows, one a mode of the measurements; or p rows, one a
    pair of both. What does not exist is NaN. Without measurements k and p are 0.
    """

    frequency_hz: Real
    """(n,), natural frequencies of the model, |s|/2π, ascending."""
    damping_ratio: Real
    """(n,), −Re s/|s|: half of a loss factor."""
    is_rigid_body: Flags
    """(n,), whether a mode has no stiffness."""
    shape: Complex
    """(n, sensors), what each sensor shows of the mode; without damping of unit modal mass."""
    measured_frequency_hz: Real
    """(k,), natural frequencies of what was measured, from a rational fit of all responses together."""
    measured_frequency_std_hz: Real
    """(k,), standard deviations."""
    measured_damping_ratio: Real
    """(k,), as of the model."""
    measured_damping_ratio_std: Real
    """(k,), standard deviations."""
    measured_shape: Complex
    """(k, sensors), residues of the receptances."""
    pairs: NDArray[np.int64]
    """(p, 2), rows of the model's mode and of the measured one."""
    frequency_difference: Real
    """(p,), that of the model over the measured one, less one."""
    mac: Real
    """(p,), modal assurance criterion between the sensors; NaN of a single sensor."""
    is_crossing: Flags
    """(p,), whether the pair is out of the order of frequencies."""
    stiffness_factor: float | None
    """The factor on the stiffness that may be off with which the frequencies of the pairs agree best."""
    sensors: tuple[str, ...]
    """Labels of the sensors."""
    frac: Real
    """(sensors,), frequency response assurance criterion of measured response and model."""
    comac: Real
    """(sensors,), coordinate modal assurance criterion; empty with fewer than two pairs."""
    line_hz: Real
    """Frequencies of the lines of the measurements."""
    csac: Real
    """Cross signature assurance criterion at each line; NaN of a single sensor."""
    csf: Real
    """Cross signature scale factor at each line."""
    title: str
    """The title of the case."""

    def __repr__(self) -> str:
        lines = [f"<frfit.Modes: {self._said()}"]
        lines += [f"  {' '.join(cells)}" for cells in self._rows(5)]
        more = len(self.pairs) or len(self.frequency_hz)
        if more > 5:
            lines.append(f"  and {more - 5} more")
        return "\n".join(lines) + ">"

    def _said(self) -> str:
        counts = f"{len(self.frequency_hz)} of the model, {len(self.measured_frequency_hz)} measured"
        return f"{counts}, {len(self.pairs)} pairs"

    def _rows(self, most: int) -> list[tuple[str, ...]]:
        """Pairs, or without measurements modes of the model, in words."""
        if len(self.pairs) == 0:
            modes = zip(self.frequency_hz[:most], self.damping_ratio[:most], strict=True)
            return [(f"{hertz:.6g} Hz", f"damping {100 * ratio:.3g} %") for hertz, ratio in modes]
        rows: list[tuple[str, ...]] = []
        for (model, measured), off, mac in zip(self.pairs, self.frequency_difference, self.mac, strict=True):
            hertz, other = self.frequency_hz[model], self.measured_frequency_hz[measured]
            agreement = f"MAC {mac:.3f}" if np.isfinite(mac) else "MAC none"
            rows.append((f"{hertz:.6g} Hz", f"(measured {other:.6g} Hz, {100 * off:+.2f} %)", agreement))
        return rows[:most]

    def _repr_html_(self) -> str:
        """What a notebook shows: a table of the pairs, or without measurements of the modes."""
        lines = [self.title] if self.title else []
        if self.stiffness_factor is not None:
            lines.append(f"frequencies agree best with the stiffness times {self.stiffness_factor:.4g}")
        if len(self.pairs) == 0:
            modes = list(zip(self.frequency_hz, self.damping_ratio, strict=True))[:_ROWS]
            table = html_table(
                ("mode", "frequency (Hz)", "damping ratio (%)"),
                [(k, f"{hertz:.6g}", f"{100 * ratio:.3g}") for k, (hertz, ratio) in enumerate(modes, 1)],
            )
        else:
            rows = []
            for (model, measured), off, mac in zip(self.pairs, self.frequency_difference, self.mac, strict=True):
                hertz = (self.frequency_hz[model], self.measured_frequency_hz[measured])
                damping = (self.damping_ratio[model], self.measured_damping_ratio[measured])
                cells = [*(f"{one:.6g}" for one in hertz), f"{100 * off:+.2f}"]
                rows.append((*cells, *(f"{100 * one:.3g}" for one in damping), f"{mac:.3f}"))
            head = ("model (Hz)", "measured (Hz)", "difference (%)", "damping (%)", "measured (%)", "MAC")
            table = html_table(head, rows[:_ROWS])
        return html_of(f"Modes: {self._said()}", html_list(lines), table)


_ROWS = 40
"""Rows of a table."""


@hints
def modes(
    case: str | os.PathLike[str] | Model,
    out: str | os.PathLike[str] | None = None,
    *,
    measurements: Measurement | Sequence[Measurement] = (),
    load: ArrayLike | None = None,
    sensors: Sequence[int] = (),
    signs: Sequence[float] | None = None,
    matrix: str | Sequence[str] = (),
    unknowns: Unknown | Sequence[Unknown] | None = None,
    band_hz: tuple[float, float] | None = None,
    identified: str | os.PathLike[str] | None = None,
    reduced: str | os.PathLike[str] | None = None,
    max_order: int | None = None,
    memory_bytes: int | None = None,
) -> Modes:
    """Natural frequencies, damping and shapes of model and measurement, paired: ``frfit modes``, from a case file or from arrays.

    Parameters
    ----------
    case
        The case file, or a model.
    out
        Folder for the files of the command line, all of them or none; of a case file only.
    measurements, load
        Beside a model: what was measured, and a row (unit force) or the force vector (n,).
    sensors, signs
        Beside a model without measurements: rows at which its shapes are shown, and the sense that is positive.
    matrix, unknowns
        Beside measurements: what is unknown, as of ``identify``; modes are paired with its factor free.
    band_hz
        First and last frequency, in place of the case file's; needed of a model without measurements.
    identified
        ``identified.csv`` of an identification of this case: the model is taken at the values found there.
    reduced
        Reduced model of ``train``, for the same matrices, load and sensors; of a case file only.
    max_order
        The largest order of the stabilisation diagram; three for each mode are enough.
    memory_bytes
        Memory that may be used.

    Raises
    ------
    InputError, ModelError, OutsideTableError, ModelMemoryError, WriteError
        The exception has the message that the command line prints.
    """
    band = optional_pair(band_hz, "band_hz")
    largest = optional_whole(max_order, "max_order", 2)
    limit = optional_whole(memory_bytes, "memory_bytes", 0)
    if not isinstance(case, Model):
        only_of_a_model(measurements=measurements, load=load, sensors=sensors, matrix=matrix, unknowns=unknowns)
        found = _frfit.modes(case, out, band, identified, reduced, largest, limit)
    else:
        only_of_a_case(out=out, identified=identified, reduced=reduced)
        if load is None:
            raise refuse("load", "a row, or a value for each row", "none")
        if isinstance(measurements, Measurement) or len(measurements) > 0:
            asked = arguments_of(
                case,
                measurements,
                load=load,
                matrix=matrix,
                unknowns=unknowns,
                band_hz=band,
                memory_bytes=limit,
            )
            found = _frfit.modes_of_arrays(*asked, largest)
        else:
            if band is None:
                raise refuse("band_hz", "first and last frequency, Hz", "none")
            rows, senses = sensors_of(sensors, signs, case.dim)
            found = _frfit.modes_of_model(
                model_of(case), load_vector(load, case.dim), rows, senses, band, limit
            )
    for name in ("is_rigid_body", "is_crossing"):
        found[name] = np.array(found[name], dtype=np.bool_)
    found["pairs"] = found["pairs"].astype(np.int64)
    found["sensors"] = tuple(found["sensors"])
    return Modes(**found)
