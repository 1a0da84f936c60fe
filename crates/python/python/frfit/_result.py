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


@dataclass(frozen=True)
class OtherExplanation:
    """Faults that would explain the data together."""

    faults: tuple[str, ...]
    """What would be wrong, in words."""
    misfit: float
    """Misfit of ln(measured/model) with them."""
    nats_behind: float
    """By how many nats it is less likely than the best explanation."""


@dataclass(frozen=True)
class Number:
    """A number that holds for the whole band."""

    name: str
    """``storage``, ``loss_factor``, a parameter of a law; ``value`` of a real constant."""
    value: float
    std: float
    """Its standard deviation, all other unknowns free; NaN where the noise is not known, infinite where it is not identifiable."""


@dataclass(frozen=True)
class Direction:
    """A combination of the numbers that hold for the band, in their logarithms."""

    std: float
    """Standard deviation along it: 0.01 is one per cent; infinite where it is not identifiable."""
    weights: dict[str, float]
    """Weights of the coordinates, squares summing to one, the largest first."""


@dataclass(frozen=True, eq=False, repr=False)
class Estimate:
    """What was found of one unknown.

    Arrays have f rows, one a frequency; an unknown that holds for the band has a value in each. Storage moduli, factors and
    corrections are in the unit of the factor (Pa, or 1).
    """

    name: str
    matrices: tuple[str, ...]
    """The terms that it enters."""
    varies: str
    """``frequency``, ``smooth``, ``constant`` or ``law``."""
    law: tuple[str, ...]
    """The laws that were fitted."""
    real: bool
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
    """(f,), standard deviation of ``storage``."""
    loss_factor_std: Real
    """(f,), standard deviation of ``loss_factor``."""
    storage_loss_correlation: Real
    """(f,), their correlation."""
    storage_std_noise: Real
    """(f,), what noise contributes to ``storage_std``; the squares of the three contributions add up to its square."""
    storage_std_model: Real
    """(f,), what errors of the model contribute."""
    storage_std_known_factors: Real
    """(f,), what errors of the factors of known matrices contribute."""
    alternatives: tuple[Complex, ...]
    """f arrays: factors that the data cannot exclude beside the one that is given."""
    numbers: tuple[Number, ...]
    """What holds for the whole band; empty where each frequency has a value of its own."""
    status: str | None
    """Of what holds for the band, in the words of ``identified.csv``; at its bounds it is ``no_root``."""

    @classmethod
    def _of(cls, found: dict[str, Any]) -> Estimate:
        """From what the compiled part gives."""
        for name in ("matrices", "law", "alternatives"):
            found[name] = tuple(found[name])
        found["numbers"] = tuple(Number(*number) for number in found["numbers"])
        return cls(**found)

    def __repr__(self) -> str:
        said = ", ".join(f"{number.name} {number.value:.6g} ± {number.std:.1g}" for number in self.numbers)
        return f"<frfit.Estimate of {self.name}: {said or self.varies}>"


@dataclass(frozen=True, eq=False, repr=False)
class Identification:
    """What was found at each frequency, with its evidence: the columns of ``identified.csv`` and more.

    Arrays have f rows, one a frequency, ascending. What does not exist is NaN; ``status`` says why. ``found["core"]`` is the
    estimate of the unknown of that name; of a single unknown its arrays are here too: ``found.storage``.
    """

    unknowns: tuple[Estimate, ...]
    """In the order in which they were asked for."""
    frequency_hz: Real
    """(f,), Hz."""
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
    """(f,), ``ok`` where the value is trusted, else why it is not: the words of ``identified.csv``."""
    measured_response: Complex
    """(f, sensors), receptance, m/N; scales and delays that were found included."""
    nominal_response: Complex
    """(f, sensors), receptance of the nominal model."""
    updated_response: Complex
    """(f, sensors), receptance of the updated model."""
    sensors: tuple[str, ...]
    """Labels of the sensors."""
    sensor_misfit: Real
    """(sensors,), misfit over what noise leaves; empty where each frequency is answered by itself."""
    sensor_left_out: Flags
    """(sensors,), whether it was left out: it contradicts all others, or shows nothing beside them."""
    sensor_scale: Real
    """(sensors,), the scale that was found; NaN where it was known, or is not identifiable."""
    sensor_scale_std: Real
    """(sensors,), its standard deviation."""
    sensor_delay_s: Real
    """(sensors,), by how much the channel was found to be late, s; NaN as above."""
    sensor_delay_s_std: Real
    """(sensors,), its standard deviation, s."""
    findings: tuple[Finding, ...]
    """What is wrong with the data."""
    other_explanations: tuple[OtherExplanation, ...]
    """What would explain the data as well, or nearly; without a finding the data do not decide between these."""
    laws: Any
    """The laws that were fitted, as in ``law.json``; ``None`` where none was asked for."""
    smooth: dict[str, Any] | None
    """How smooth the factor is, as in ``summary.json``: ``parameters`` that the curve takes for each of its parts,
    ``width_octaves``, ``converged``, frequencies ``unexplained``; ``None`` where it was not asked to be smooth, or no
    curve could be laid."""
    noise: float | None
    """Noise over the assumed standard deviations; ``None`` where it is not known."""
    noise_source: str
    """``given``, ``sensors``, ``scatter`` or ``unknown``."""
    explained: str | None
    """Whether noise is all that is left: ``explained``, ``nearly explained``, ``not explained``, ``untested``."""
    is_trusted: bool
    """Whether all that holds for the band is trusted and the measurements are not contradicted."""
    coordinates: tuple[str, ...]
    """What the rows of ``correlation`` stand for."""
    correlation: Real
    """(k, k), correlation of the k numbers that hold for the band."""
    directions: tuple[Direction, ...]
    """Combinations of them, the least identifiable first."""
    not_identifiable: tuple[str, ...]
    """The combinations that the measurements leave open, in words."""
    profile: Real
    """(points, 2): distance along the least identifiable combination, and how much larger chi squared is there."""
    converged: bool
    """Whether the search settled."""
    starts: int
    """Starts that were followed for several unknowns."""
    agreeing: int
    """How many of them ended at the result."""
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
        for name in ("sensors", "coordinates", "not_identifiable"):
            found[name] = tuple(found[name])
        found["unknowns"] = tuple(Estimate._of(one) for one in found["unknowns"])
        found["directions"] = tuple(Direction(std, dict(weights)) for std, weights in found["directions"])
        found["findings"] = tuple(
            Finding(**{**finding, "sensors": tuple(finding["sensors"])}) for finding in found["findings"]
        )
        found["other_explanations"] = tuple(
            OtherExplanation(tuple(faults), misfit, behind) for faults, misfit, behind in found["other_explanations"]
        )
        return cls(**found)

    def __getitem__(self, name: str) -> Estimate:
        """The estimate of the unknown of this name."""
        for one in self.unknowns:
            if one.name == name:
                return one
        raise KeyError(f"expected one of {', '.join(one.name for one in self.unknowns)}, found {name!r}")

    @property
    def _only(self) -> Estimate:
        """The only unknown."""
        if len(self.unknowns) > 1:
            names = ", ".join(repr(one.name) for one in self.unknowns)
            raise AttributeError(f"there are several unknowns: expected found[name] with one of {names}")
        return self.unknowns[0]

    @property
    def factor(self) -> Complex:
        """(f,), that of the only unknown, as are the arrays below."""
        return self._only.factor

    @property
    def nominal(self) -> Complex:
        """(f,), see :class:`Estimate`."""
        return self._only.nominal

    @property
    def correction(self) -> Complex:
        """(f,), see :class:`Estimate`."""
        return self._only.correction

    @property
    def storage(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.storage

    @property
    def loss_factor(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.loss_factor

    @property
    def storage_std(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.storage_std

    @property
    def loss_factor_std(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.loss_factor_std

    @property
    def storage_loss_correlation(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.storage_loss_correlation

    @property
    def storage_std_noise(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.storage_std_noise

    @property
    def storage_std_model(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.storage_std_model

    @property
    def storage_std_known_factors(self) -> Real:
        """(f,), see :class:`Estimate`."""
        return self._only.storage_std_known_factors

    @property
    def alternatives(self) -> tuple[Complex, ...]:
        """F arrays, see :class:`Estimate`."""
        return self._only.alternatives

    @property
    def matrices(self) -> tuple[str, ...]:
        """The terms that the only unknown enters."""
        return self._only.matrices

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
        statuses = ", ".join(f"{count} {word}" for word, count in zip(words, counts, strict=True))
        names = ", ".join(one.name for one in self.unknowns)
        return f"<frfit.Identification of {names} at {len(self)} frequencies: {statuses}>"

    def columns(self) -> dict[str, Any]:
        """The columns of ``identified.csv``, in their order."""
        columns: dict[str, Any] = {"frequency_hz": self.frequency_hz}
        for prefix, one in self._prefixed():
            columns[f"{prefix}storage"] = one.storage
            columns[f"{prefix}loss_factor"] = one.loss_factor
            columns[f"{prefix}factor_re"] = one.factor.real
            columns[f"{prefix}factor_im"] = one.factor.imag
            columns[f"{prefix}correction_re"] = one.correction.real
            columns[f"{prefix}correction_im"] = one.correction.imag
        for name in (
            "error",
            "spectral_radius",
            "order",
            "candidate_count",
            "status",
            "convergence_radius",
            "required_order",
            "reduction_error",
        ):
            columns[name] = getattr(self, name)
        for prefix, one in self._prefixed():
            columns[f"{prefix}storage_std"] = one.storage_std
            columns[f"{prefix}loss_factor_std"] = one.loss_factor_std
            columns[f"{prefix}storage_loss_correlation"] = one.storage_loss_correlation
            columns[f"{prefix}storage_std_noise"] = one.storage_std_noise
            columns[f"{prefix}storage_std_model"] = one.storage_std_model
            columns[f"{prefix}storage_std_known_factors"] = one.storage_std_known_factors
        columns["chi2"] = self.chi2
        return columns

    def _prefixed(self) -> list[tuple[str, Estimate]]:
        """Each unknown with what its columns begin with: its name and a point where there are several."""
        return [("" if len(self.unknowns) == 1 else f"{one.name}.", one) for one in self.unknowns]

    def to_dataframe(self) -> Any:
        """:meth:`columns` as a ``pandas.DataFrame``; needs pandas."""
        import pandas

        return pandas.DataFrame(self.columns())

    def plot(self, axes: Any = None) -> Any:
        """Storage modulus and loss factor of each unknown over frequency with bars of two standard deviations; needs matplotlib.

        Trusted answers are filled, others hollow and grey. ``axes``: two to draw on for each complex unknown, one for each real
        one. Returns them.
        """
        import matplotlib.pyplot as plt

        panels = []
        for prefix, one in self._prefixed():
            panels.append((one.storage, one.storage_std, one.nominal.real, f"{prefix}storage"))
            if not one.real:
                loss_factor = one.nominal.imag / one.nominal.real
                panels.append((one.loss_factor, one.loss_factor_std, loss_factor, f"{prefix}loss factor"))
        if axes is None:
            _, grid = plt.subplots(len(panels), 1, sharex=True, squeeze=False, layout="constrained")
            axes = grid[:, 0]
        ok = self.ok
        for axis, (values, std, nominal, label) in zip(axes, panels, strict=True):
            bars = np.where(np.isfinite(std), 2 * std, 0.0)
            axis.plot(self.frequency_hz, nominal, "--", color="0.6", label="nominal")
            axis.errorbar(self.frequency_hz[ok], values[ok], bars[ok], fmt=".", color="C0", label="identified")
            axis.plot(self.frequency_hz[~ok], values[~ok], ".", color="0.7", mfc="none", label="not trusted")
            axis.set_ylabel(label)
        axes[-1].set_xlabel("frequency (Hz)")
        axes[0].legend()
        return axes
