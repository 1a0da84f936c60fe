"""From the records of a hammer test to a frequency response function."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import (
    Complex,
    Real,
    hints,
    hints_of,
    number,
    numbers,
    one_of,
    optional_number,
    pair,
    real,
    refuse,
    row,
    several,
    shown,
    sign,
    whole,
)
from ._shown import counted, span

if TYPE_CHECKING:
    from ._identify import Measurement, Quantity


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class Recording:
    """Channels sampled at the same instants.

    ``step_s``: sampling interval, s. ``force``: (samples,), N. ``responses``: (samples,) or (sensors, samples), m, m/s or
    m/s^2.
    """

    step_s: float
    force: ArrayLike
    responses: ArrayLike

    def __post_init__(self) -> None:
        _plain(self)

    def __repr__(self) -> str:
        samples = np.asarray(self.force).size
        sensors = np.atleast_2d(np.asarray(self.responses)).shape[0]
        peak = float(np.max(np.abs(np.asarray(self.force)), initial=0.0))
        said = f"{samples} samples of {self.step_s:g} s, {counted(sensors, 'sensor')}, force up to {peak:.4g} N"
        return f"<frfit.Recording of {said}>"


def _plain(one: Any) -> SimpleNamespace:
    """The recording with plain arrays."""
    if not isinstance(one, Recording):
        raise refuse("recordings", "a Recording or several", shown(one))
    step_s, force = number(one.step_s, "step_s"), real(one.force, "force")
    if not (np.isfinite(step_s) and step_s > 0.0):
        raise refuse("step_s", "a finite time above 0 s", shown(one.step_s))
    responses = np.atleast_2d(np.asarray(numbers(one.responses, "responses"), dtype=np.float64))
    if responses.ndim != 2 or responses.shape[1] != force.size:
        found = f"an array of {' x '.join(map(str, responses.shape))}"
        raise refuse("responses", f"{force.size} samples of each sensor, as force has", found)
    for name, values in (("force", force), ("responses", responses)):
        if not np.isfinite(values).all():
            raise refuse(name, "finite numbers", shown(float(values[~np.isfinite(values)][0])))
    return SimpleNamespace(step_s=step_s, force=force, responses=responses)


def _impact(value: Any) -> int:
    found = whole(value, "keep", "numbers of impacts, from 1")
    if found < 1:
        raise refuse("keep", "numbers of impacts, from 1", str(found))
    return found


@dataclass(frozen=True)
class Impact:
    """An impact that was found in a recording, and what speaks against it."""

    recording: int
    """Its recording, from 0."""
    first: int
    """Its first sample, from 0."""
    end: int
    """The sample after its last one."""
    peak_n: float
    """Largest force, N."""
    contact_s: float
    """How long the hammer touched the structure, s."""
    kept: bool
    """Whether it is in the average."""
    faults: tuple[str, ...]
    """What is wrong with it, in words."""


@dataclass(frozen=True, eq=False, repr=False)
class MeasuredFrf:
    """The FRF of every sensor, with its coherence and standard deviation."""

    frequency_hz: Real
    """(f,), Hz."""
    response: Complex
    """(sensors, f), response over force."""
    coherence: Real | None
    """(sensors, f); ``None`` for a single impact."""
    std: Real | None
    """(sensors, f), standard deviation of the complex response; ``None`` for a single impact."""
    force: Real
    """(f,), rms of the force's transform, N s."""
    averages: int
    """How many impacts are averaged."""
    impacts: tuple[Impact, ...]
    """All impacts that were found."""
    decay_per_s: float = 0.0
    """Decay rate of the exponential window, 1/s, for :class:`Measurement`."""

    def __repr__(self) -> str:
        parts = [f"{counted(len(self.response), 'sensor')}, {len(self.frequency_hz)} frequencies, {span(self.frequency_hz)}"]
        parts.append(f"{self.averages} of {counted(len(self.impacts), 'impact')}")
        if self.coherence is not None:
            parts.append(f"coherence {np.median(self.coherence):.4g} (median)")
        if self.decay_per_s:
            parts.append(f"decay_per_s {self.decay_per_s:g}")
        return f"<frfit.MeasuredFrf of {', '.join(parts)}>"

    def measurements(
        self,
        rows: int | Sequence[int],
        *,
        quantity: Quantity,
        signs: Sequence[float] | None = None,
        band_hz: tuple[float, float] | None = None,
    ) -> list[Measurement]:
        """A :class:`Measurement` of each sensor, with its standard deviation and the decay of the window.

        ``rows``: the row of the model of each sensor, from 0. ``quantity``: what the sensors measure, ``"accelerance"`` of
        accelerometers in m/s^2 and a hammer in N. ``signs``: -1 for a sensor whose motion against the row counts as positive.
        ``band_hz``: first and last of the frequencies that are taken.
        """
        from ._identify import Measurement

        listed = [rows] if np.ndim(rows) == 0 else several(rows, "rows", "a row for each sensor")
        if len(listed) != len(self.response):
            raise refuse("rows", f"{len(self.response)}, one for each sensor", str(len(listed)))
        senses = [1.0] * len(listed) if signs is None else [sign(one, "signs") for one in signs]
        if len(senses) != len(listed):
            raise refuse("signs", f"{len(listed)}, one for each sensor", str(len(senses)))
        low, high = (-np.inf, np.inf) if band_hz is None else pair(band_hz, "band_hz")
        inside = (self.frequency_hz >= low) & (self.frequency_hz <= high)
        if not inside.any():
            raise refuse("band_hz", f"a band with frequencies of {span(self.frequency_hz)}", f"({low:g}, {high:g})")
        return [
            Measurement(
                self.frequency_hz[inside],
                self.response[k, inside],
                row(at, "rows"),
                quantity,
                sign=senses[k],
                std=None if self.std is None else self.std[k, inside],
                decay_per_s=self.decay_per_s,
                window="none",
            )
            for k, at in enumerate(listed)
        ]


@hints
def frf(
    recordings: Recording | Sequence[Recording],
    *,
    estimator: Literal["h1", "h2", "hv"] = "h1",
    trigger_n: float | None = None,
    pre_trigger_s: float | None = None,
    length_s: float | None = None,
    double_impact: float = 0.1,
    drift: float = 0.05,
    force_window_s: float | None = None,
    exponential_window_s: float | None = None,
    keep: Sequence[int] = (),
) -> MeasuredFrf:
    """Impacts, FRF, coherence and standard deviation from the records of one hammer.

    Several recordings are triggered captures of one impact each; a single one may hold many. ``keep`` names impacts (from 1)
    that are averaged whatever is wrong with them.

    Raises
    ------
    SignalError
        No impact without fault, recordings that do not fit together.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(2048) / 2048
    >>> force = np.where((t > 0.01) & (t < 0.013), np.sin(np.pi * (t - 0.01) / 0.003), 0.0)
    >>> found = frf(Recording(1 / 2048, force, 2.0 * force))     # a response in proportion
    >>> bool(np.allclose(found.response, 2.0)), found.averages
    (True, 1)
    """
    expected = "a Recording or several"
    one = isinstance(recordings, Recording)
    plain = [_plain(each) for each in ([recordings] if one else several(recordings, "recordings", expected))]
    how = signal_options(
        estimator=estimator,
        trigger_n=trigger_n,
        pre_trigger_s=pre_trigger_s,
        length_s=length_s,
        double_impact=double_impact,
        drift=drift,
        force_window_s=force_window_s,
        exponential_window_s=exponential_window_s,
        keep=keep,
    )
    found = _frfit.frf(plain, how)
    impacts = tuple(Impact(**{**impact, "faults": tuple(impact["faults"])}) for impact in found.pop("impacts"))
    return MeasuredFrf(impacts=impacts, **found)


def signal_options(
    *,
    estimator: str,
    trigger_n: float | None,
    pre_trigger_s: float | None,
    length_s: float | None,
    double_impact: float,
    drift: float,
    force_window_s: float | None,
    exponential_window_s: float | None,
    keep: Sequence[int],
) -> dict[str, Any]:
    """The options of an FRF, checked."""
    return {
        "estimator": one_of(estimator, "estimator", ("h1", "h2", "hv")),
        "trigger_n": optional_number(trigger_n, "trigger_n"),
        "pre_trigger_s": optional_number(pre_trigger_s, "pre_trigger_s"),
        "length_s": optional_number(length_s, "length_s"),
        "double_impact": number(double_impact, "double_impact"),
        "drift": number(drift, "drift"),
        "force_window_s": optional_number(force_window_s, "force_window_s"),
        "exponential_window_s": optional_number(exponential_window_s, "exponential_window_s"),
        "keep": [_impact(impact) for impact in several(keep, "keep", "numbers of impacts, from 1")],
    }
