"""What an identification of several unknowns found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import Complex, Flags, Real


@dataclass(frozen=True)
class Number:
    """A number that holds for the whole band."""

    name: str
    """``storage``, ``loss_factor``, a parameter of a law; ``value`` of a real constant."""
    value: float
    std: float
    """Its standard deviation, all other unknowns free; NaN or infinite where nothing tells it."""


@dataclass(frozen=True, eq=False, repr=False)
class Unknown:
    """One of several unknowns."""

    name: str
    varies: str
    """``frequency``, ``constant``, or ``law`` and its name."""
    is_real: bool
    value: Complex
    """(f,), in the unit of the case; the same at every frequency where it is constant."""
    nominal: Complex
    """(f,), where the search began."""
    storage_std: Real
    """(f,), standard deviation of the real part."""
    loss_factor_std: Real
    """(f,), standard deviation of the loss factor; NaN of a real one."""
    storage_loss_correlation: Real
    """(f,), their correlation."""
    numbers: tuple[Number, ...]
    """What holds for the whole band; empty where each frequency has a value of its own."""
    status: str | None
    """Of what holds for the band: ``ok``, ``no_root`` (at its bounds), ``not_identifiable``, ``unexplained`` or ``failed``."""

    @property
    def storage(self) -> Real:
        """(f,), the real part."""
        return self.value.real

    @property
    def loss_factor(self) -> Real:
        """(f,), imaginary over real part."""
        return self.value.imag / self.value.real

    def __repr__(self) -> str:
        told = ", ".join(f"{number.name} {number.value:.6g} ± {number.std:.1g}" for number in self.numbers)
        return f"<frfit.Unknown {self.name}: {told or self.varies}>"


@dataclass(frozen=True)
class Direction:
    """A combination of the numbers that hold for the band, in their logarithms."""

    std: float
    """Standard deviation along it: 0.01 is one per cent; infinite where nothing tells it."""
    weights: dict[str, float]
    """Weights of the coordinates, squares summing to one, the largest first."""


@dataclass(frozen=True, eq=False, repr=False)
class SeveralIdentification:
    """What several unknowns are, and how they hang together: the columns of ``identified.csv`` and more.

    Arrays have f rows, one a frequency, ascending. What does not exist is NaN; ``status`` says why.
    """

    frequency_hz: Real
    """(f,), Hz."""
    unknowns: tuple[Unknown, ...]
    """In the order of the case."""
    status: NDArray[np.str_]
    """(f,), of what the frequency has of its own; where all unknowns hold for the band, whether they explain it."""
    error: Real
    """(f,), norm of the misfit over that of the measured responses."""
    chi2: Real
    """(f,), what the sensors leave unexplained over what noise leaves: about 1."""
    reduction_error: Real
    """(f,), estimated relative error of the reduced model's response."""
    measured_response: Complex
    """(f, sensors), receptance, m/N."""
    nominal_response: Complex
    """(f, sensors), receptance of the nominal model."""
    updated_response: Complex
    """(f, sensors), receptance of the updated model."""
    coordinates: tuple[str, ...]
    """What the rows of ``correlation`` stand for."""
    correlation: Real
    """(k, k), correlation of the k numbers that hold for the band."""
    directions: tuple[Direction, ...]
    """Combinations of them, the one that is told worst first."""
    not_told: tuple[str, ...]
    """What the measurements cannot tell, in words."""
    profile: Real
    """(points, 2): distance along the direction that is told worst, and how much larger chi squared is there."""
    sensors: tuple[str, ...]
    """Labels of the sensors."""
    noise: float | None
    """Noise over the assumed deviations; ``None`` where nothing tells it."""
    noise_source: str
    """``given``, ``sensors`` or ``unknown``."""
    explained: str | None
    """Whether noise is all that is left: ``explained``, ``nearly explained``, ``not explained``, ``untested``."""
    is_trusted: bool
    """Whether all that holds for the band is trusted and the measurements are not contradicted."""
    converged: bool
    """Whether the search settled."""
    starts: int
    """Starts that were followed."""
    agreeing: int
    """How many of them ended at the answer."""
    subspace_size: int
    """Vectors of the reduced model."""
    factorisations: int
    """Factorisations of an n x n matrix."""
    solves: int
    """Right-hand sides solved with them."""
    seconds: float
    """Wall-clock time of the identification."""
    title: str
    """The title of the case."""

    @classmethod
    def _of(cls, found: dict[str, Any]) -> SeveralIdentification:
        """From what the compiled part gives."""
        found["status"] = np.array(found["status"], dtype=np.str_)
        for name in ("coordinates", "not_told", "sensors"):
            found[name] = tuple(found[name])
        found["unknowns"] = tuple(
            Unknown(**{**one, "numbers": tuple(Number(*number) for number in one["numbers"])})
            for one in found["unknowns"]
        )
        found["directions"] = tuple(Direction(std, dict(weights)) for std, weights in found["directions"])
        return cls(**found)

    def __getitem__(self, name: str) -> Unknown:
        """The unknown of this name."""
        for one in self.unknowns:
            if one.name == name:
                return one
        raise KeyError(f"expected one of {', '.join(one.name for one in self.unknowns)}, found {name!r}")

    @property
    def ok(self) -> Flags:
        """(f,), where the answer is trusted."""
        trusted: Flags = self.status == "ok"
        return trusted

    def __len__(self) -> int:
        return len(self.frequency_hz)

    def __repr__(self) -> str:
        words, counts = np.unique(self.status, return_counts=True)
        told = ", ".join(f"{count} {word}" for word, count in zip(words, counts, strict=True))
        names = ", ".join(one.name for one in self.unknowns)
        return f"<frfit.SeveralIdentification of {names} at {len(self)} frequencies: {told}>"

    def columns(self) -> dict[str, Any]:
        """The columns of ``identified.csv``, in their order."""
        columns: dict[str, Any] = {
            "frequency_hz": self.frequency_hz,
            "status": self.status,
            "error": self.error,
            "chi2": self.chi2,
            "reduction_error": self.reduction_error,
        }
        for one in self.unknowns:
            if one.is_real:
                parts = {"value": one.storage, "std": one.storage_std}
            else:
                parts = {
                    "storage": one.storage,
                    "loss_factor": one.loss_factor,
                    "storage_std": one.storage_std,
                    "loss_factor_std": one.loss_factor_std,
                    "storage_loss_correlation": one.storage_loss_correlation,
                }
            columns.update({f"{one.name}.{part}": values for part, values in parts.items()})
        return columns

    def to_dataframe(self) -> Any:
        """:meth:`columns` as a ``pandas.DataFrame``; needs pandas."""
        import pandas

        return pandas.DataFrame(self.columns())

    def plot(self, axes: Any = None) -> Any:
        """The real part of each unknown over frequency with bars of two standard deviations; needs matplotlib.

        Trusted answers are filled, others hollow and grey. ``axes``: one for each unknown. Returns them.
        """
        import matplotlib.pyplot as plt

        if axes is None:
            _, grid = plt.subplots(len(self.unknowns), 1, sharex=True, squeeze=False, layout="constrained")
            axes = grid[:, 0]
        ok = self.ok
        for axis, one in zip(axes, self.unknowns, strict=True):
            bars = np.where(np.isfinite(one.storage_std), 2 * one.storage_std, 0.0)
            axis.plot(self.frequency_hz, one.nominal.real, "--", color="0.6", label="nominal")
            axis.errorbar(self.frequency_hz[ok], one.storage[ok], bars[ok], fmt=".", color="C0", label="identified")
            axis.plot(self.frequency_hz[~ok], one.storage[~ok], ".", color="0.7", mfc="none", label="not trusted")
            axis.set_ylabel(one.name)
        axes[-1].set_xlabel("frequency (Hz)")
        axes[0].legend()
        return axes
