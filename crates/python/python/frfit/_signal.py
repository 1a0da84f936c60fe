"""From the records of a hammer test to a frequency response function."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import Complex, Real, real


@dataclass(frozen=True, eq=False)
class Recording:
    """Channels sampled at the same instants.

    ``step_s``: sampling interval, s. ``force``: (samples,), N. ``responses``: (samples,) or (sensors, samples), m, m/s or
    m/s^2.
    """

    step_s: float
    force: ArrayLike
    responses: ArrayLike


@dataclass(frozen=True)
class Hit:
    """A hit that was found: samples ``first`` to ``end`` of a recording, and what speaks against it."""

    recording: int
    first: int
    end: int
    peak_n: float
    contact_s: float
    kept: bool
    faults: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class MeasuredFrf:
    """The FRF of every sensor, with how sure it is.

    ``frequency_hz`` (f,); ``response`` (sensors, f), response over force; ``coherence`` and ``std`` (sensors, f), ``None`` for a
    single hit, ``std`` that of the complex value; ``force`` (f,), rms of the force's transform, N s.
    """

    frequency_hz: Real
    response: Complex
    coherence: Real | None
    std: Real | None
    force: Real
    averages: int
    hits: tuple[Hit, ...]


def frf(
    recordings: Recording | Sequence[Recording],
    *,
    estimator: Literal["h1", "h2", "hv"] = "h1",
    trigger_n: float | None = None,
    pre_trigger_s: float | None = None,
    length_s: float | None = None,
    double_hit: float = 0.1,
    drift: float = 0.05,
    force_window_s: float | None = None,
    exponential_window_s: float | None = None,
    keep: Sequence[int] = (),
) -> MeasuredFrf:
    """Hits, FRF, coherence and standard deviation from the records of one hammer.

    Several recordings are triggered captures of one hit each; a single one may hold many. ``keep`` names hits (from 1)
    that are averaged whatever is wrong with them.

    Raises
    ------
    SignalError
        No hit without fault, recordings that do not fit together.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(2048) / 2048
    >>> force = np.where((t > 0.01) & (t < 0.013), np.sin(np.pi * (t - 0.01) / 0.003), 0.0)
    >>> found = frf(Recording(1 / 2048, force, 2.0 * force))     # a response in proportion
    >>> bool(np.allclose(found.response, 2.0)), found.averages
    (True, 1)
    """
    several = [recordings] if isinstance(recordings, Recording) else list(recordings)
    plain = [
        SimpleNamespace(
            step_s=float(one.step_s),
            force=real(one.force),
            responses=np.atleast_2d(np.asarray(one.responses, dtype=np.float64)),
        )
        for one in several
    ]
    how = {
        "estimator": estimator,
        "trigger_n": trigger_n,
        "pre_trigger_s": pre_trigger_s,
        "length_s": length_s,
        "double_hit": double_hit,
        "drift": drift,
        "force_window_s": force_window_s,
        "exponential_window_s": exponential_window_s,
        "keep": list(keep),
    }
    found = _frfit.frf(plain, how)
    hits = tuple(Hit(**{**hit, "faults": tuple(hit["faults"])}) for hit in found.pop("hits"))
    return MeasuredFrf(hits=hits, **found)
