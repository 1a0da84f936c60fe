"""From a measured response to the factor that reproduces it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Literal

from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import complex_, load_vector, real
from ._model import Model, Progress
from ._result import Identification
from ._several import SeveralIdentification


@dataclass(frozen=True, eq=False)
class Measurement:
    """A measured FRF, and where it was measured.

    Parameters
    ----------
    frequency_hz
        (f,), Hz, ascending.
    response
        (f,), complex: receptance m/N, mobility m/(s N) or accelerance m/(s^2 N).
    row, sign
        Row of the model from 0, and -1 where motion against it counts as positive.
    quantity
        ``"receptance"``, ``"mobility"`` or ``"accelerance"``.
    std
        (f,), standard deviation of the complex value, sqrt(E |dH|^2), in the unit of ``response``.
    coherence, averages
        (f,), and of how many averages: another way to say how well it was measured.
    scale
        What the values are to be multiplied by; ``"unknown"`` is found, beside a known channel or with a law.
    delay_s
        By how much the channel is late, s; ``"unknown"`` as above.
    """

    frequency_hz: ArrayLike
    response: ArrayLike
    row: int
    quantity: Literal["receptance", "mobility", "accelerance"] = "receptance"
    sign: float = 1.0
    std: ArrayLike | None = None
    coherence: ArrayLike | None = None
    averages: int | None = None
    scale: float | Literal["unknown"] = 1.0
    delay_s: float | Literal["unknown"] = 0.0


def _plain(one: Measurement) -> SimpleNamespace:
    """The measurement with plain arrays."""
    return SimpleNamespace(
        row=one.row,
        sign=float(one.sign),
        quantity=one.quantity,
        frequency_hz=real(one.frequency_hz),
        response=complex_(one.response),
        std=None if one.std is None else real(one.std),
        coherence=None if one.coherence is None else real(one.coherence),
        averages=one.averages,
        scale=None if one.scale == "unknown" else float(one.scale),
        delay_s=None if one.delay_s == "unknown" else float(one.delay_s),
    )


def _band(entry: float | tuple[float, float]) -> tuple[float, float]:
    """A line as a band of no width."""
    low, high = entry if isinstance(entry, tuple | list) else (entry, entry)
    return float(low), float(high)


def identify(
    model: Model,
    measurements: Measurement | Sequence[Measurement],
    *,
    load: ArrayLike,
    matrix: str | Sequence[str],
    band_hz: tuple[float, float] | None = None,
    bounds: dict[str, tuple[float, float]] | None = None,
    nominal: Literal["estimate"] | None = None,
    method: Literal["rational", "series", "nelder-mead"] | None = None,
    order: int | None = None,
    selection: Literal["joint", "smallest"] | None = None,
    space: Literal["auto", "full", "subspace"] | None = None,
    varies: Literal["frequency", "smooth", "law"] | None = None,
    law: str | Sequence[str] = (),
    real: bool = False,
    robust: bool | None = None,
    leave_out_hz: Sequence[float | tuple[float, float]] = (),
    most_lines: int | None = None,
    check: bool = True,
    memory_bytes: int | None = None,
    progress: Progress | None = None,
) -> Identification:
    """The unknown factor of ``matrix`` at every measured frequency of the band, and how far to trust it.

    The arguments are the keys of ``[identify]`` in a case file. Ctrl-C is answered at once.

    Parameters
    ----------
    load
        A row (unit force), or the force vector (n,), N.
    matrix
        The name of the term whose factor is unknown, or of several that share it.
    bounds
        ``{"storage": (low, high), "loss_factor": (low, high)}``, storage in the unit of the factor.
    varies
        ``"frequency"``: a factor of its own at each; ``"smooth"``: neighbours help each other; ``"law"``, which is what
        ``law`` alone means too: by a law, the best of ``law`` or without it of all.
    most_lines
        Of more measured frequencies than this those that tell most; the others are ``out_of_band``.
    law
        ``"constant"``, ``"fractional"``, ``"zener"``, ``"maxwell:N"`` or several: fitted to the whole band.
    progress
        Called with (frequencies done, of how many).

    Raises
    ------
    InputError, ModelError, OptionsError, OutsideTableError, ModelMemoryError
        What has to be put right. Numerical trouble is a status of its frequency, never an exception.

    Examples
    --------
    >>> import numpy as np
    >>> from frfit import Term, respond
    >>> K, M = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.diag([0.01, 0.01])
    >>> def springs(k):
    ...     return Model([Term("k", K, factor=k), Term("m", M, role="mass")])
    >>> f = np.linspace(5.0, 120.0, 24)
    >>> u = respond(springs(1000 * (1 + 0.02j)), f, load=0, sensors=[1])[:, 0]
    >>> found = identify(springs(1300.0), Measurement(f, u, row=1), load=0, matrix="k")
    >>> bool(np.allclose(found.factor[found.ok], 1000 * (1 + 0.02j), rtol=1e-6)), found.trusted
    (True, 1.0)
    """
    several = [measurements] if isinstance(measurements, Measurement) else list(measurements)
    bounds = bounds or {}
    if unknown := set(bounds) - {"storage", "loss_factor"}:
        raise TypeError(f"bounds: expected storage or loss_factor, found {sorted(unknown)[0]!r}")
    options = {
        "matrices": [matrix] if isinstance(matrix, str) else list(matrix),
        "band_hz": band_hz,
        "leave_out_hz": [_band(entry) for entry in leave_out_hz],
        "most_lines": most_lines,
        "method": method,
        "selection": selection,
        "space": space,
        "order": order,
        "storage": bounds.get("storage"),
        "loss_factor": bounds.get("loss_factor"),
        "real": real,
        "estimate": nominal == "estimate",
        "robust": robust,
        "varies": varies,
        "laws": [law] if isinstance(law, str) else list(law),
        "check": check,
        "memory_bytes": memory_bytes,
    }
    force = load_vector(load, model.dim)
    found = _frfit.identify(model._model, force, [_plain(one) for one in several], options, progress)
    return Identification._of(found)


def run_case(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    method: str | None = None,
    order: int | None = None,
    band_hz: tuple[float, float] | None = None,
    selection: str | None = None,
    space: str | None = None,
    memory_bytes: int | None = None,
    progress: Progress | None = None,
) -> Identification | SeveralIdentification:
    """What ``frfit identify CASE`` computes: the same numbers, bit for bit.

    A case with ``[[identify]]``, or with one unknown that is constant or a dimension, gives a
    :class:`SeveralIdentification`.

    With ``out`` the files of the command line are written there too, all of them or none. The other arguments stand in
    place of the case file's.

    Raises
    ------
    InputError, OutsideTableError, ModelMemoryError, WriteError
        With the text of the command line.
    """
    found = _frfit.run_case(path, out, method, order, band_hz, selection, space, memory_bytes, progress)
    return SeveralIdentification._of(found) if "unknowns" in found else Identification._of(found)


