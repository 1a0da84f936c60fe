"""Natural frequencies, damping and shapes, of the model and of what was measured."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _frfit
from ._arrays import Complex, Flags, Real, optional_pair, optional_whole


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
        said = f"{len(self.frequency_hz)} of the model, {len(self.measured_frequency_hz)} measured, {len(self.pairs)} pairs"
        return f"<frfit.Modes: {said}>"


def modes(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    band_hz: tuple[float, float] | None = None,
    identified: str | os.PathLike[str] | None = None,
    max_order: int | None = None,
    memory_bytes: int | None = None,
) -> Modes:
    """What ``frfit modes CASE`` computes: natural frequencies, damping and shapes of model and measurement, paired.

    With ``out`` the files of the command line are written there too, all of them or none.

    Parameters
    ----------
    path
        The case file.
    out
        Folder for the results.
    band_hz
        First and last frequency, in place of the case file's.
    identified
        ``identified.csv`` of an identification of this case: the model is taken at the values found there.
    max_order
        The largest order of the stabilisation diagram; three for each mode are enough.
    memory_bytes
        Memory that may be used.

    Raises
    ------
    InputError, OutsideTableError, ModelMemoryError, WriteError
        With the text of the command line.
    """
    found = _frfit.modes(
        path,
        out,
        optional_pair(band_hz, "band_hz"),
        identified,
        optional_whole(max_order, "max_order", 2),
        optional_whole(memory_bytes, "memory_bytes", 0),
    )
    for name in ("is_rigid_body", "is_crossing"):
        found[name] = np.array(found[name], dtype=np.bool_)
    found["pairs"] = found["pairs"].astype(np.int64)
    found["sensors"] = tuple(found["sensors"])
    return Modes(**found)
