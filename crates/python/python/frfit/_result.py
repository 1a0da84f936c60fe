"""What an identification found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import Complex, Flags, Real, Whole


@dataclass(frozen=True)
class Finding:
    """Something that is wrong with the data, as ``frfit check`` says it."""

    kind: str
    sensors: tuple[str, ...]
    what: str
    evidence: str
    change: str


@dataclass(frozen=True, eq=False, repr=False)
class Identification:
    """One answer a frequency, with its evidence: the columns of ``identified.csv`` and more.

    Arrays have f rows, one a frequency, ascending. What does not exist is NaN; ``status`` says why. Storage moduli, factors and
    corrections are in the unit of the factor (Pa, or 1).
    """

    frequency_hz: Real
    """(f,), Hz."""
    factor: Complex
    """(f,), the identified factor E' (1 + i eta)."""
    nominal: Complex
    """(f,), the nominal factor."""
    correction: Complex
    """(f,), factor - nominal."""
    storage: Real
    """(f,), E', the factor's real part."""
    loss_factor: Real
    """(f,), eta."""
    storage_std: Real
    """(f,), standard deviation of ``storage`` from the noise of the measurement."""
    loss_factor_std: Real
    """(f,), standard deviation of ``loss_factor``."""
    storage_loss_correlation: Real
    """(f,), their correlation."""
    chi2: Real
    """(f,), what the sensors leave unexplained over what noise leaves: about 1."""
    error: Real
    """(f,), norm of the misfit over that of the measured responses."""
    spectral_radius: Real
    """(f,), below 1 where the series converges at the answer."""
    convergence_radius: Real
    """(f,), how far the nominal is from the nearest pole, over the nominal."""
    required_order: Real
    """(f,), terms that the series would need for 1e-6."""
    reduction_error: Real
    """(f,), estimated relative error of the reduced model's response."""
    order: Whole
    """(f,), order of the series or of the rational response."""
    candidate_count: Whole
    """(f,), admissible solutions."""
    status: NDArray[np.str_]
    """(f,), ``ok``, ``ambiguous``, ``no_root``, ``not_identifiable``, ``unexplained``, ``diverged``, ``failed`` or
    ``out_of_band``."""
    alternatives: tuple[Complex, ...]
    """f arrays: factors that the data cannot exclude beside the one that is given."""
    measured_response: Complex
    """(f, sensors), receptance, m/N; scales and delays that were found included."""
    nominal_response: Complex
    """(f, sensors), receptance of the nominal model."""
    updated_response: Complex
    """(f, sensors), receptance of the updated model."""
    matrices: tuple[str, ...]
    """The terms that share the factor."""
    sensors: tuple[str, ...]
    """Labels of the sensors."""
    sensor_misfit: Real
    """(sensors,), misfit over what noise leaves; empty where each frequency is answered by itself."""
    sensor_left_out: Flags
    """(sensors,), whether it contradicts all others and was left out."""
    sensor_scale: Real
    """(sensors,), the scale that was found; NaN where it was known, or the data do not tell it."""
    sensor_scale_std: Real
    """(sensors,), its standard deviation."""
    sensor_delay_s: Real
    """(sensors,), by how much the channel was found to be late, s; NaN as above."""
    sensor_delay_s_std: Real
    """(sensors,), its standard deviation, s."""
    findings: tuple[Finding, ...]
    """What is wrong with the data."""
    laws: Any
    """The laws that were fitted, as in ``law.json``; ``None`` where none was asked for."""
    smooth: dict[str, Any] | None
    """How smooth the factor is, as in ``summary.json``: ``parameters`` that the curve takes for each of its parts,
    ``width_octaves``, ``converged``, frequencies ``unexplained``; ``None`` where it was not asked to be smooth, or no
    curve could be laid."""
    noise: float | None
    """Noise over the assumed deviations; ``None`` where nothing tells it."""
    noise_source: str
    """``given``, ``sensors``, ``scatter`` or ``unknown``."""
    explained: str | None
    """Whether noise is all that is left: ``explained``, ``nearly explained``, ``not explained``, ``untested``."""
    explored: int
    """Frequencies at which all solutions were looked for."""
    subspace_size: int | None
    """Vectors of the reduced model; ``None`` where the full one answered."""
    factorisations: int
    """Factorisations of an n x n matrix."""
    solves: int
    """Right-hand sides solved with them."""
    seconds: float
    """Wall-clock time of the identification."""
    title: str
    """The title of the case."""

    @classmethod
    def _of(cls, found: dict[str, Any]) -> Identification:
        """From what the compiled part gives."""
        found["status"] = np.array(found["status"], dtype=np.str_)
        for name in ("alternatives", "matrices", "sensors"):
            found[name] = tuple(found[name])
        found["findings"] = tuple(
            Finding(**{**finding, "sensors": tuple(finding["sensors"])}) for finding in found["findings"]
        )
        return cls(**found)

    @property
    def ok(self) -> Flags:
        """(f,), where the answer is trusted."""
        trusted: Flags = self.status == "ok"
        return trusted

    @property
    def trusted(self) -> float:
        """Share of the band, but for what was left out, whose answer is trusted."""
        asked = self.status != "out_of_band"
        return float(self.ok[asked].mean()) if asked.any() else 0.0

    def __len__(self) -> int:
        return len(self.frequency_hz)

    def __repr__(self) -> str:
        words, counts = np.unique(self.status, return_counts=True)
        told = ", ".join(f"{count} {word}" for word, count in zip(words, counts, strict=True))
        return f"<frfit.Identification of {', '.join(self.matrices)} at {len(self)} frequencies: {told}>"

    def columns(self) -> dict[str, Any]:
        """The columns of ``identified.csv``, in their order."""
        return {
            "frequency_hz": self.frequency_hz,
            "storage": self.storage,
            "loss_factor": self.loss_factor,
            "factor_re": self.factor.real,
            "factor_im": self.factor.imag,
            "correction_re": self.correction.real,
            "correction_im": self.correction.imag,
            "error": self.error,
            "spectral_radius": self.spectral_radius,
            "order": self.order,
            "candidate_count": self.candidate_count,
            "status": self.status,
            "convergence_radius": self.convergence_radius,
            "required_order": self.required_order,
            "reduction_error": self.reduction_error,
            "storage_std": self.storage_std,
            "loss_factor_std": self.loss_factor_std,
            "storage_loss_correlation": self.storage_loss_correlation,
            "chi2": self.chi2,
        }

    def to_dataframe(self) -> Any:
        """:meth:`columns` as a ``pandas.DataFrame``; needs pandas."""
        import pandas

        return pandas.DataFrame(self.columns())

    def plot(self, axes: Any = None) -> Any:
        """Storage modulus and loss factor over frequency with bars of two standard deviations; needs matplotlib.

        Trusted answers are filled, others hollow and grey. ``axes``: two to draw on. Returns both.
        """
        import matplotlib.pyplot as plt

        if axes is None:
            _, axes = plt.subplots(2, 1, sharex=True, layout="constrained")
        columns = (
            (self.storage, self.storage_std, self.nominal.real, "storage"),
            (self.loss_factor, self.loss_factor_std, self.nominal.imag / self.nominal.real, "loss factor"),
        )
        for axis, (values, std, nominal, label) in zip(axes, columns, strict=True):
            bars = 2 * np.nan_to_num(std)
            ok = self.ok
            axis.plot(self.frequency_hz, nominal, "--", color="0.6", label="nominal")
            axis.errorbar(self.frequency_hz[ok], values[ok], bars[ok], fmt=".", color="C0", label="identified")
            axis.plot(self.frequency_hz[~ok], values[~ok], ".", color="0.7", mfc="none", label="not trusted")
            axis.set_ylabel(label)
        axes[-1].set_xlabel("frequency (Hz)")
        axes[0].legend()
        return axes


