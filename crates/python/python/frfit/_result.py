"""What an identification found."""

from __future__ import annotations

import importlib
import os
import pathlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._arrays import Complex, Flags, Real, Whole, one_of, refuse, shown, word
from ._report import Report
from ._shown import counted, html_list, html_of, html_table, some, span, typical, with_std

_EVERY_LINE = (
    "factor",
    "nominal",
    "correction",
    "storage",
    "loss_factor",
    "storage_std",
    "loss_factor_std",
    "storage_loss_correlation",
    "storage_std_noise",
    "storage_std_model",
    "storage_std_known_factors",
)
"""The arrays of an estimate with a number at each frequency."""


@dataclass(frozen=True, repr=False)
class Finding:
    """Something that is wrong with the data, as ``frfit check`` says it."""

    kind: str
    """``sign``, ``factor``, ``quantity``, ``conjugated``, ``delay``, ``response_dof``, ``load_dof``, ``axis``, ``nominal``,
    ``mesh`` or ``no_signal``."""
    sensors: tuple[str, ...]
    """Labels of the sensors that it concerns: as ``sensors`` of an :class:`Identification`. Empty where it concerns none."""
    what: str
    """What is wrong, in words."""
    evidence: str
    """The numbers that speak for it."""
    change: str
    """What to change."""

    def __repr__(self) -> str:
        return f"<frfit.Finding of {some(self.sensors) or 'the band'}: {self.what}>"


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
    """A constant or a law parameter: one number for the whole band."""

    name: str
    """``storage``, ``loss_factor``, a parameter of a law; ``value`` of a real constant."""
    value: float
    std: float
    """Its standard deviation, all other unknowns free; NaN where the noise is not known, infinite where it is not identifiable."""


@dataclass(frozen=True, repr=False)
class Direction:
    """A combination of constants and law parameters, in their logarithms."""

    std: float
    """Standard deviation along it: 0.01 is one per cent; infinite where it is not identifiable."""
    weights: dict[str, float]
    """Weights of the coordinates, squares summing to one, the largest first."""

    def __repr__(self) -> str:
        weights = some((f"{weight:+.2f} {name}" for name, weight in self.weights.items()), 4)
        return f"<frfit.Direction with std {self.std:.2g}: {weights}>"


@dataclass(frozen=True, eq=False, repr=False)
class Estimate:
    """What was found of one unknown.

    Arrays have f rows, one a frequency; a constant or a law has a value in each. Storage moduli, factors and
    corrections are in the unit of the factor (Pa, or 1).
    """

    name: str
    """Its name, that of the term unless another one was given."""
    matrices: tuple[str, ...]
    """The terms that it enters."""
    varies: str
    """``frequency``, ``smooth``, ``constant`` or ``law``."""
    law: tuple[str, ...]
    """The laws that were fitted."""
    real: bool
    """Whether it is real."""
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
    """Constants and law parameters; empty where each frequency has a value of its own."""
    status: str | None
    """Status of a constant or law; ``no_root`` at its bounds."""

    @classmethod
    def _of(cls, found: dict[str, Any]) -> Estimate:
        """From what the compiled part gives."""
        for name in ("matrices", "law", "alternatives"):
            found[name] = tuple(found[name])
        found["numbers"] = tuple(Number(*number) for number in found["numbers"])
        return cls(**found)

    def _said(self, where: Flags) -> str:
        """The numbers that matter: those of the band, or medians of the frequencies that are trusted."""
        if self.numbers:
            return some((f"{number.name} {with_std(number.value, number.std)}" for number in self.numbers), 8)
        return ", ".join(f"{name} {value}" for name, value in self._typical(where))

    def _typical(self, where: Flags) -> list[tuple[str, str]]:
        """Names and medians of what varies over the band."""
        curves = [("storage", self.storage, self.storage_std)]
        if not self.real:
            curves.append(("loss_factor", self.loss_factor, self.loss_factor_std))
        return [(name, with_std(*typical(values, stds, where))) for name, values, stds in curves]

    def __repr__(self) -> str:
        kind = "median of " if not self.numbers else ""
        status = "" if self.status is None else f" ({self.status})"
        found = np.isfinite(self.storage)
        return f"<frfit.Estimate of {self.name}, {self.varies}: {kind}{self._said(found)}{status}>"



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
    """(f,), misfit per degree of freedom over the noise: about 1 for a right model."""
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
    """Labels of the sensors. Of arrays ``row 4`` is index 4 of the matrices, from 0. Of a case file it is the name of the degree
    of freedom, or ``row 5`` with rows from 1, as the file counts them."""
    sensor_misfit: Real
    """(sensors,), misfit over what noise leaves; empty where each frequency is identified independently of the others."""
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
    ``width_octaves``, ``converged``, frequencies left out as ``outliers``. ``None`` where the factor was not to be
    smooth, or where no curve fits."""
    noise: float | None
    """Noise over the assumed standard deviations; ``None`` where it is not known."""
    noise_source: str
    """``given``, ``sensors``, ``scatter`` or ``unknown``."""
    explained: str | None
    """Whether noise explains the residual: ``explained``, ``nearly explained``, ``not explained``, ``untested``."""
    is_trusted: bool
    """Whether all constants and law parameters are trusted and the measurements are not contradicted."""
    coordinates: tuple[str, ...]
    """What the rows of ``correlation`` stand for; in ``scale of measurement 1`` measurements are counted from 1."""
    correlation: Real
    """(k, k), correlation of the k constants and law parameters."""
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
    search_about: tuple[float, ...]
    """Factors on the nominal values, one for each unknown, about which was searched, where natural frequencies had shown that the nominal values are far off; else empty."""
    explored: int
    """Frequencies at which all solutions were searched."""
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
    folder: pathlib.Path | None = None
    """Where ``run_case`` wrote the files; ``None`` where it wrote none, and of arrays."""

    @classmethod
    def _of(cls, found: dict[str, Any], folder: pathlib.Path | None = None) -> Identification:
        """From what the compiled part gives."""
        found["status"] = np.array(found["status"], dtype=np.str_)
        for name in ("sensors", "coordinates", "not_identifiable", "search_about"):
            found[name] = tuple(found[name])
        found["unknowns"] = tuple(Estimate._of(one) for one in found["unknowns"])
        found["directions"] = tuple(Direction(std, dict(weights)) for std, weights in found["directions"])
        found["findings"] = tuple(
            Finding(**{**finding, "sensors": tuple(finding["sensors"])}) for finding in found["findings"]
        )
        found["other_explanations"] = tuple(
            OtherExplanation(tuple(faults), misfit, behind) for faults, misfit, behind in found["other_explanations"]
        )
        return cls(**found, folder=folder)

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

    def _counts(self) -> dict[str, int]:
        """How many frequencies have which status, the trusted ones first."""
        words, counts = np.unique(self.status, return_counts=True)
        listed = sorted(zip(words.tolist(), counts.tolist(), strict=True), key=lambda one: (one[0] != "ok", -one[1]))
        return dict(listed)

    def _statuses(self) -> str:
        """The same in words."""
        return ", ".join(f"{count} {word}" for word, count in self._counts().items())

    def _verdict(self) -> str:
        """Whether the model explains the band, in words."""
        explained = self.explained or "not tested"
        noise = f"noise {self.noise:.2f} times the assumed" if self.noise is not None else "noise not known"
        parts = [explained, noise, f"{100 * self.trusted:.0f} % of the band trusted"]
        if self.findings:
            parts.append(counted(len(self.findings), "finding"))
        if self.not_identifiable:
            parts.append(f"not identifiable: {some(self.not_identifiable, 2)}")
        return ", ".join(parts)

    def _where(self) -> Flags:
        """Frequencies whose values stand for the others: the trusted ones, else all."""
        ok = self.ok
        return ok if ok.any() else np.ones_like(ok)

    def __repr__(self) -> str:
        names = some(one.name for one in self.unknowns)
        lines = [f"<frfit.Identification of {names} at {len(self)} frequencies: {self._statuses()}"]
        lines.append(f"  {span(self.frequency_hz)}, {counted(len(self.sensors), 'sensor')}; {self._verdict()}")
        for one in self.unknowns[:_SHOWN]:
            kind = "" if one.numbers else "median "
            lines.append(f"  {one.name} ({one.varies}): {kind}{one._said(self._where())}")
        if len(self.unknowns) > _SHOWN:
            lines.append(f"  and {len(self.unknowns) - _SHOWN} more")
        return "\n".join(lines) + ">"

    def _repr_html_(self) -> str:
        """What a notebook shows: statuses, verdict and a table of the unknowns."""
        rows = []
        for one in self.unknowns:
            if one.numbers:
                rows += [
                    (one.name, one.varies, number.name, with_std(number.value, number.std), one.status or "")
                    for number in one.numbers
                ]
                continue
            rows += [(one.name, one.varies, name, f"{value} (median)", "") for name, value in one._typical(self._where())]
        title = f"Identification of {some(one.name for one in self.unknowns)}"
        head = f"{len(self)} frequencies, {span(self.frequency_hz)}, {counted(len(self.sensors), 'sensor')}: {self._statuses()}"
        lines = [head, self._verdict(), *(finding.what for finding in self.findings[:_SHOWN])]
        table = html_table(("unknown", "varies", "number", "value ± std", "status"), rows[:_ROWS])
        return html_of(title, html_list(lines), table)

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

    def to_dataframe(self, kind: Literal["table", "long", "numbers"] = "table") -> Any:
        """A ``pandas.DataFrame`` of the results; needs pandas.

        With ``kind="table"`` it has the :meth:`columns`, a row at each frequency. With ``"long"`` it has a row for each unknown
        and frequency, and all arrays of an :class:`Estimate`, also those that ``identified.csv`` does not have. With
        ``"numbers"`` it has a row for each constant and law parameter.
        """
        kinds = ("table", "long", "numbers")
        one_of(kind, "kind", kinds)
        pandas = _imported("pandas", "to_dataframe")
        if kind == "table":
            return pandas.DataFrame(self.columns())
        if kind == "numbers":
            rows = [(one.name, number.name, number.value, number.std) for one in self.unknowns for number in one.numbers]
            frame = pandas.DataFrame(rows, columns=["unknown", "number", "value", "std"])
            frame["status"] = [one.status for one in self.unknowns for _ in one.numbers]
            return frame
        parts = []
        for one in self.unknowns:
            columns: dict[str, Any] = {"unknown": one.name, "frequency_hz": self.frequency_hz, "status": self.status}
            columns |= {name: getattr(one, name) for name in _EVERY_LINE}
            columns["alternative_count"] = np.array([len(rivals) for rivals in one.alternatives], dtype=np.int64)
            parts.append(pandas.DataFrame(columns))
        return pandas.concat(parts, ignore_index=True)

    def to_xarray(self, units: str | Mapping[str, str] | None = None) -> Any:
        """An ``xarray.Dataset`` of the arrays over frequency, with units; needs xarray.

        Coordinates are ``frequency`` (Hz), ``sensor`` and ``unknown``; of a single unknown the last is no dimension. ``units``
        are those of the factors: a text, or of several unknowns a dictionary by their names.
        """
        xarray = _imported("xarray", "to_xarray")
        of = self._units(units)
        names = [one.name for one in self.unknowns]
        said = [of[name] or "unit of the factor" for name in names]
        of_all = said[0] if len(set(said)) == 1 else f"by unknown: {', '.join(said)}"
        units_of = {"loss_factor": "1", "loss_factor_std": "1", "storage_loss_correlation": "1"}
        arrays: dict[str, Any] = {}
        for name in _EVERY_LINE:
            stacked = np.array([getattr(one, name) for one in self.unknowns])
            arrays[name] = (("unknown", "frequency"), stacked, {"units": units_of.get(name, of_all)})
        for name in ("chi2", "error", "spectral_radius", "convergence_radius", "required_order", "reduction_error"):
            arrays[name] = ("frequency", getattr(self, name), {"units": "1"})
        for name in ("order", "candidate_count", "status"):
            arrays[name] = ("frequency", getattr(self, name))
        for name in ("measured_response", "nominal_response", "updated_response"):
            arrays[name] = (("frequency", "sensor"), getattr(self, name), {"units": "m/N"})
        hertz = ("frequency", self.frequency_hz, {"units": "Hz", "long_name": "frequency"})
        coordinates = {"frequency": hertz, "sensor": list(self.sensors), "unknown": names}
        about = {"title": self.title, "explained": self.explained or "", "trusted": self.trusted}
        found = xarray.Dataset(arrays, coordinates, about)
        return found.isel(unknown=0) if len(names) == 1 else found

    def _units(self, units: str | Mapping[str, str] | None) -> dict[str, str]:
        """The unit of each unknown; empty where nobody says it."""
        names = [one.name for one in self.unknowns]
        if units is None or isinstance(units, str):
            return dict.fromkeys(names, units or "")
        if not isinstance(units, Mapping):
            raise refuse("units", "a text, or a dictionary by the names of the unknowns", shown(units))
        for name in units:
            one_of(name, "units", names)
        return {name: word(units.get(name, ""), f"units[{name!r}]") for name in names}

    def plot(self, axes: Any = None, *, units: str | Mapping[str, str] | None = None) -> Any:
        """Storage modulus and loss factor of each unknown over frequency with bars of two standard deviations; needs matplotlib.

        Trusted values are filled. Others are hollow, with the mark of their status, over a grey band. A constant or a law
        is a line in a band of two standard deviations. The vertical axis spans the trusted and the nominal values: others may
        lie outside of it.
        ``axes``: two to draw on for each complex unknown, one for each real one. ``units`` of the factors are for the labels: a
        text, or of several unknowns a dictionary by their names. Returns the axes.
        """
        plt = _imported("matplotlib.pyplot", "plot")
        of = self._units(units)
        panels = []
        for prefix, one in self._prefixed():
            unit = of[one.name] or "unit of the factor"
            label = one.name if one.real else f"{prefix}storage"
            panels.append((one, one.storage, one.storage_std, one.nominal.real, f"{label} ({unit})"))
            if not one.real:
                with np.errstate(invalid="ignore", divide="ignore"):
                    loss_factor = one.nominal.imag / one.nominal.real
                panels.append((one, one.loss_factor, one.loss_factor_std, loss_factor, f"{prefix}loss factor (1)"))
        if axes is None:
            size = (6.4, max(4.8, 1.9 * len(panels)))
            _, grid = plt.subplots(len(panels), 1, sharex=True, squeeze=False, layout="constrained", figsize=size)
            axes = grid[:, 0]
        listed = list(np.ravel(np.asarray(axes, dtype=object)))
        if len(listed) != len(panels):
            found = counted(len(listed), "axis", "axes")
            raise refuse("axes", f"{len(panels)}, two for each complex unknown and one for each real one", found)
        for axis, (one, values, std, nominal, label) in zip(listed, panels, strict=True):
            self._draw(axis, one, values, std, nominal)
            axis.set_ylabel(label)
        listed[-1].set_xlabel("frequency (Hz)")
        listed[0].legend(fontsize="small")
        return axes

    def _draw(self, axis: Any, one: Estimate, values: Real, std: Real, nominal: Real) -> None:
        """One panel."""
        f, ok = self.frequency_hz, self.ok
        bars = np.where(np.isfinite(std), 2 * std, 0.0)
        axis.plot(f, nominal, "--", color="0.6", label="nominal")
        if one.numbers:
            axis.fill_between(f, values - bars, values + bars, color="C0", alpha=0.25, linewidth=0, label="±2σ")
            axis.plot(f, values, color="C0", label="identified")
        else:
            axis.errorbar(f[ok], values[ok], bars[ok], fmt=".", color="C0", label="ok, ±2σ")
            for status in self._counts():
                there = self.status == status
                if status == "ok":
                    continue
                mark = _MARKS.get(status, ".")
                label = status if np.isfinite(values[there]).any() else None
                axis.plot(f[there], values[there], mark, color="0.5", mfc="none", markersize=4, label=label)
        for k, (first, last) in enumerate(_runs(~ok)):
            # Half way to the neighbours.
            low = f[first] if first == 0 else (f[first - 1] + f[first]) / 2
            high = f[last] if last + 1 == len(f) else (f[last] + f[last + 1]) / 2
            axis.axvspan(low, high, color="0.92", zorder=0, linewidth=0, label="not trusted" if k == 0 else None)
        seen = np.concatenate([(values - bars)[ok], (values + bars)[ok], nominal])
        seen = seen[np.isfinite(seen)]
        if ok.any() and seen.size and (margin := 0.08 * float(np.ptp(seen))) > 0:
            axis.set_ylim(float(seen.min()) - margin, float(seen.max()) + margin)

    def report(self, path: str | os.PathLike[str] | None = None) -> Report:
        """The HTML page of results that ``run_case(case, out)`` wrote; with ``path`` it is written there too.

        Results of arrays, and of ``run_case`` without a folder, have no files: an :class:`InputError`. :func:`save_case` makes a
        case of arrays.
        """
        if self.folder is None:
            raise refuse("report", "results with a folder, as run_case(case, out) writes them", "results without files")
        page = Report(self.folder)
        if path is not None:
            page.save(path)
        return page


_SHOWN, _ROWS = 6, 24
"""How many unknowns and findings are named, and how many rows a table has."""

_MARKS = {
    "ambiguous": "D",
    "unexplained": "x",
    "not_identifiable": "v",
    "no_root": "s",
    "failed": "+",
    "diverged": "^",
}


def _runs(flags: Flags) -> list[tuple[int, int]]:
    """First and last of each run of flags that are set."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return [(int(first), int(end) - 1) for first, end in zip(edges[::2], edges[1::2], strict=True)]


def _imported(module: str, user: str) -> Any:
    """A module that is only needed here."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        name = module.partition(".")[0]
        if error.name not in (module, name):
            raise
        raise ModuleNotFoundError(f"{user} needs {name}: pip install {name}", name=name) from None
