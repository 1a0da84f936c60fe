"""The other verbs of the command line: what each prints and writes, bit for bit."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import (
    Complex,
    Real,
    callable_,
    flag,
    hints,
    load_vector,
    number,
    only_of_a_case,
    only_of_a_model,
    optional_number,
    optional_pair,
    optional_whole,
    real,
    refuse,
    row,
    several,
    whole,
    word,
    words,
)
from ._errors import OptionsError
from ._frfit import Law
from ._identify import Measurement, Unknown, arguments_of, run_case
from ._model import Model, Progress, model_of, sensors_of
from ._result import Finding, Identification, OtherExplanation
from ._signal import signal_options

_Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Check:
    """What ``frfit check`` finds in the measurements of a case."""

    title: str
    """The title of the case."""
    findings: tuple[Finding, ...]
    """Faults of the data that explain them better than anything else."""
    other_explanations: tuple[OtherExplanation, ...]
    """Faults between which the data do not decide."""
    misfit: float | None
    """Misfit of ln(measured/model) at the likeliest values of the unknowns, after the faults that were found."""
    not_judged: str | None
    """Why the data could not be judged."""
    frequencies: int
    """Frequencies that were looked at."""
    summary: dict[str, Any]
    """What ``frfit check --json`` prints."""

    @property
    def is_clean(self) -> bool:
        """Whether no fault was found, and no other explanation is as likely."""
        return not self.findings and not self.other_explanations

    def __repr__(self) -> str:
        kinds = ", ".join(finding.kind for finding in self.findings) or "nothing found"
        undecided = f", {len(self.other_explanations)} undecided" if self.other_explanations else ""
        return f"<frfit.Check: {kinds}{undecided}>"


@dataclass(frozen=True)
class Sensitivities:
    """What the response of a case depends on, and what its sensors can identify."""

    title: str
    """The title of the case."""
    parameters: tuple[dict[str, Any], ...]
    """Each parameter with ``name``, ``rms`` of ∂ln x/∂ln p over the band, ``std`` (relative) and ``largest``."""
    inseparable: tuple[dict[str, Any], ...]
    """Combinations of parameters that the sensors cannot separate."""
    next_sensor: dict[str, Any] | None
    """Where another sensor would add most; ``None`` without candidates."""
    summary: dict[str, Any]
    """What ``frfit sensitivities --json`` prints."""

    def __repr__(self) -> str:
        return f"<frfit.Sensitivities of {len(self.parameters)} parameters>"


@dataclass(frozen=True)
class LawFit:
    """A law of few parameters that was fitted to a table of a modulus."""

    name: str
    """``constant``, ``fractional``, ``zener`` or ``maxwell:N``."""
    law: Law
    """The law with its parameters."""
    parameters: dict[str, float]
    """Parameters by name."""
    std: dict[str, float]
    """Their standard deviations; NaN where a parameter is not identifiable."""
    bic: float
    """Bayesian information criterion: the least is the best."""
    chi_squared_per_degree_of_freedom: float
    """χ² over degrees of freedom."""


@dataclass(frozen=True)
class LawFits:
    """Laws that were fitted to the same table."""

    fits: tuple[LawFit, ...]
    """One for each law with fewer parameters than there are numbers."""
    best: LawFit
    """That of the least BIC."""
    summary: dict[str, Any]
    """What ``frfit fit --json`` prints: ``law.json``."""

    def __repr__(self) -> str:
        return f"<frfit.LawFits: {self.best.name} of {', '.join(fit.name for fit in self.fits)}>"


@dataclass(frozen=True, eq=False)
class CaseResponse:
    """The response of a case at its nominal factors."""

    title: str
    """The title of the case."""
    frequency_hz: Real
    """(f,)."""
    receptance: Complex
    """(f, sensors), m/N; NaN where the system cannot be solved."""
    sensors: tuple[str, ...]
    """Labels of the sensors."""

    def __repr__(self) -> str:
        count, sensors = self.receptance.shape
        return f"<frfit.CaseResponse: {sensors} sensors, {count} frequencies>"


@hints
def check(
    case: _Path | Model,
    measurements: Measurement | Sequence[Measurement] = (),
    *,
    load: ArrayLike | None = None,
    matrix: str | Sequence[str] = (),
    unknowns: Unknown | Sequence[Unknown] | None = None,
    bounds: Mapping[str, tuple[float, float]] | tuple[float, float] | None = None,
    start: Literal["bounds"] | None = None,
    exclude_hz: Sequence[float | tuple[float, float]] = (),
    band_hz: tuple[float, float] | None = None,
    reduced: _Path | None = None,
    memory_bytes: int | None = None,
) -> Check:
    """Faults of the measurements against the model: what ``frfit check`` finds, from a case file or from arrays. Nothing is written.

    Parameters
    ----------
    case
        The case file, or a model.
    measurements, load, matrix, unknowns, bounds, start, exclude_hz
        Beside a model, as of ``identify``.
    band_hz
        First and last frequency, in place of the case file's.
    reduced
        Reduced model of ``train``, for the same matrices, load and sensors; of a case file only.
    memory_bytes
        Memory that may be used.

    Raises
    ------
    InputError, ModelError, OutsideTableError, ModelMemoryError
        The exception has the message that the command line prints.

    Examples
    --------
    >>> import numpy as np
    >>> from frfit import Measurement, Model, Term, respond
    >>> K, M = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.diag([0.01, 0.01])
    >>> model = Model([Term("k", K, factor=1000 * (1 + 0.02j)), Term("m", M, role="mass")])
    >>> f = np.linspace(5.0, 120.0, 60)
    >>> u = respond(model, f, load=0, sensors=[0, 1])
    >>> wrong = [Measurement(f, -u[:, 0], row=0), Measurement(f, u[:, 1], row=1)]
    >>> [finding.kind for finding in check(model, wrong, load=0, matrix="k").findings]
    ['sign']
    """
    band, limit = optional_pair(band_hz, "band_hz"), optional_whole(memory_bytes, "memory_bytes", 0)
    if isinstance(case, Model):
        only_of_a_case(reduced=reduced)
        if load is None:
            raise refuse("load", "a row, or a value for each row", "none")
        asked = arguments_of(
            case,
            measurements,
            load=load,
            matrix=matrix,
            unknowns=unknowns,
            bounds=bounds,
            start=start,
            exclude_hz=exclude_hz,
            band_hz=band,
            memory_bytes=limit,
        )
        found = _frfit.check_of_arrays(*asked)
    else:
        only_of_a_model(
            measurements=measurements, load=load, matrix=matrix, unknowns=unknowns, bounds=bounds, exclude_hz=exclude_hz
        )
        found = _frfit.check(case, band, reduced, limit)
    findings = tuple(Finding(**{**one, "sensors": tuple(one["sensors"])}) for one in found.pop("findings"))
    others = tuple(
        OtherExplanation(tuple(faults), misfit, behind) for faults, misfit, behind in found.pop("other_explanations")
    )
    summary = json.loads(found.pop("summary"))
    return Check(findings=findings, other_explanations=others, summary=summary, **found)


@hints
def sensitivities(
    case: _Path | Model,
    out: _Path | None = None,
    *,
    frequency_hz: ArrayLike | None = None,
    load: ArrayLike | None = None,
    sensors: Sequence[int] = (),
    signs: Sequence[float] | None = None,
    band_hz: tuple[float, float] | None = None,
    noise: float | None = None,
    candidates: str | Sequence[str | int] = "all",
    reduced: _Path | None = None,
    memory_bytes: int | None = None,
) -> Sensitivities:
    """What the response depends on, and what the sensors can identify: ``frfit sensitivities``, from a case file or from arrays.

    Nothing needs to be measured. Parameters of a model are the factors of its terms.

    Parameters
    ----------
    case
        The case file, or a model.
    out
        Folder for the files of the command line; of a case file only.
    frequency_hz, load, sensors, signs
        Beside a model, as of ``respond``.
    band_hz
        First and last frequency, in place of the case file's.
    noise
        Relative standard deviation of a response; by default that of the files, else 0.01.
    candidates
        Where the next sensor may go: ``"all"``, ``"none"``, or degrees of freedom such as ``"12+Z"``, or rows. Rows count
        from 1 beside a case file and from 0 beside a model.
    reduced
        Reduced model of ``train``, for the same matrices, load and sensors; of a case file only.
    memory_bytes
        Memory that may be used.

    Raises
    ------
    InputError, OptionsError, ModelMemoryError, WriteError
        The exception has the message that the command line prints.
    """
    part = optional_number(noise, "noise")
    if part is not None and not 0.0 < part < float("inf"):
        raise OptionsError(f"noise: expected a number above 0, found {part}")
    limit = optional_whole(memory_bytes, "memory_bytes", 0)
    if isinstance(case, Model):
        only_of_a_case(out=out, band_hz=band_hz, reduced=reduced)
        if load is None or frequency_hz is None:
            raise refuse("load" if load is None else "frequency_hz", "what respond takes, beside a model", "none")
        rows, senses = sensors_of(sensors, signs, case.dim)
        if isinstance(candidates, str):
            places = candidates
        else:
            places = ",".join(str(row(place, "candidates", case.dim) + 1) for place in candidates)
        text = _frfit.sensitivities_of_model(
            model_of(case),
            load_vector(load, case.dim),
            rows,
            senses,
            real(frequency_hz, "frequency_hz"),
            part,
            places,
            limit,
        )
    else:
        only_of_a_model(frequency_hz=frequency_hz, load=load, sensors=sensors)
        places = candidates if isinstance(candidates, str) else ",".join(str(place) for place in candidates)
        text = _frfit.sensitivities(case, out, optional_pair(band_hz, "band_hz"), part, places, reduced, limit)
    summary = json.loads(text)
    return Sensitivities(
        title=summary["title"],
        parameters=tuple(summary.get("parameters", ())),
        inseparable=tuple(summary.get("inseparable", ())),
        next_sensor=summary.get("next_sensor"),
        summary=summary,
    )


@hints
def fit(
    table: _Path,
    out: _Path | None = None,
    *,
    laws: str | Sequence[str] = (),
    where: tuple[str, str] | None = None,
) -> LawFits:
    """What ``frfit fit TABLE`` does: laws of few parameters fitted to a modulus over frequency.

    Parameters
    ----------
    table
        An ``identified.csv``, or a table of dynamic mechanical analysis.
    out
        Folder for ``law.json`` and a figure.
    laws
        ``"constant"``, ``"fractional"``, ``"zener"``, ``"maxwell"`` or ``"maxwell:N"``; by default all are compared.
    where
        A column and a value: only rows with this value in it.

    Raises
    ------
    InputError, OptionsError, WriteError
        The exception has the message that the command line prints.
    """
    only = None if where is None else (word(where[0], "where"), word(where[1], "where"))
    text, found = _frfit.fit(table, words(laws, "laws"), only, out)
    summary = json.loads(text)
    fits = tuple(_law_fit(one, law, names) for one, (law, names) in zip(summary["laws"], found, strict=True))
    best = next((fit for fit in fits if fit.name == summary["best"]), fits[0])
    return LawFits(fits, best, summary)


def _law_fit(one: dict[str, Any], law: Law, names: list[str]) -> LawFit:
    numbers = {name: one["parameters"][name] for name in names}
    return LawFit(
        name=one["law"],
        law=law,
        parameters={name: entry["value"] for name, entry in numbers.items()},
        std={name: float("nan") if entry["std"] is None else entry["std"] for name, entry in numbers.items()},
        bic=one["bic"],
        chi_squared_per_degree_of_freedom=one["chi_squared_per_degree_of_freedom"],
    )


@hints
def export(
    target: Literal["nastran", "abaqus", "ansys", "csv", "json"],
    table: _Path,
    out: _Path | None = None,
    *,
    unit_system: str | None = None,
    poisson: float | None = None,
    density: float | None = None,
    modulus: float | None = None,
    law: _Path | None = None,
    id: int = 1,
    name: str = "FRFIT",
    all_rows: bool = False,
    unknown: str | None = None,
) -> str:
    """The file that ``frfit export TARGET TABLE`` writes, as text; with ``out`` it is written too.

    Parameters
    ----------
    target
        What reads it.
    table
        Table of the modulus, such as ``identified.csv``.
    out
        File to write.
    unit_system
        Units to write, such as ``"mm-t-s"``; by default those of the case that the table came from, else SI.
    poisson
        Poisson's ratio, which a solver needs.
    density
        Density in kg/m³.
    modulus
        Modulus in Pa that the matrix was made with, where the table's factors are relative to it.
    law
        A ``law.json``: values of the best law in it.
    id
        Number of the material (Nastran, Ansys).
    name
        Name of the material (Abaqus).
    all_rows
        Every row with a modulus, not only those that are ok.
    unknown
        Which unknown of a table of several.

    Raises
    ------
    InputError, OptionsError, WriteError
        The exception has the message that the command line prints.
    """
    how = {
        "unit_system": unit_system,
        "poisson": optional_number(poisson, "poisson"),
        "density": optional_number(density, "density"),
        "modulus": optional_number(modulus, "modulus"),
        "law": law,
        "id": whole(id, "id"),
        "name": word(name, "name"),
        "all_rows": flag(all_rows, "all_rows"),
        "unknown": unknown,
    }
    return _frfit.export(word(target, "target"), table, out, how)


@hints
def inspect(path: _Path) -> dict[str, Any]:
    """What ``frfit inspect FILE --json`` prints: what is in a matrix, FRF or table file.

    Raises
    ------
    InputError
        A file that cannot be read, or is of no known kind.
    """
    found: dict[str, Any] = json.loads(_frfit.inspect(path))
    return found


@hints
def natural_frequencies(stiffness: _Path, mass: _Path, count: int = 12) -> dict[str, Any]:
    """What ``frfit inspect K M --modes COUNT --json`` prints: ``natural_frequencies_hz`` and ``rigid_body_modes``.

    Raises
    ------
    InputError
        Files that hold no real symmetric matrices of one size.
    """
    found: dict[str, Any] = json.loads(_frfit.natural_frequencies(stiffness, mass, whole(count, "count")))
    return found


@hints
def convert(
    source: _Path,
    target: _Path,
    *,
    to: str | None = None,
    name: str | None = None,
    record: int | Sequence[int] | None = None,
    columns: Sequence[str] | None = None,
    quantity: str | None = None,
    response: str | None = None,
    reference: str | None = None,
    binary: bool = False,
) -> None:
    """What ``frfit convert INPUT OUTPUT`` does: a matrix or an FRF in another format.

    Parameters
    ----------
    source
        File to read.
    target
        File to write; its ending says the format.
    to
        Ending that says the format in place of that of ``target``.
    name
        Which matrix of a file of several.
    record
        Which FRF of a UFF file, from 1; for a UFF file also several.
    columns
        Names of a table's columns in place of its own; ``"-"`` for one that is not read.
    quantity
        What a table's FRF is: ``"receptance"``, ``"mobility"`` or ``"accelerance"``.
    response
        Measured degree of freedom, such as ``"34+Z"``.
    reference
        Driven degree of freedom, such as ``"12+Z"``.
    binary
        Binary dataset 58b in place of text.

    Raises
    ------
    InputError, OptionsError, WriteError
        The exception has the message that the command line prints.
    """
    how = {
        "to": to,
        "name": name,
        "records": [whole(one, "record") for one in _listed(record)],
        "columns": None if columns is None else words(columns, "columns"),
        "quantity": quantity,
        "response": response,
        "reference": reference,
        "binary": flag(binary, "binary"),
    }
    _frfit.convert(source, target, how)


def _listed(record: int | Sequence[int] | None) -> list[int]:
    if record is None:
        return []
    return several(record, "record", "whole numbers") if isinstance(record, Sequence) else [record]


@hints
def respond_case(
    path: _Path,
    out: _Path | None = None,
    *,
    band_hz: tuple[float, float] | None = None,
    memory_bytes: int | None = None,
    progress: Progress | None = None,
) -> CaseResponse:
    """What ``frfit respond CASE`` computes: the response at the nominal factors; with ``out`` its files too.

    Raises
    ------
    InputError, OutsideTableError, ModelMemoryError, WriteError
        The exception has the message that the command line prints.
    """
    limit = optional_whole(memory_bytes, "memory_bytes", 0)
    found = _frfit.respond_case(path, out, optional_pair(band_hz, "band_hz"), limit, callable_(progress))
    found["sensors"] = tuple(found["sensors"])
    return CaseResponse(**found)


@hints
def frf_of_files(
    records: _Path | Sequence[_Path],
    out: _Path,
    *,
    to: str | None = None,
    force: str | None = None,
    responses: str | Sequence[str] = (),
    force_unit: str | None = None,
    response_unit: str | None = None,
    force_sensitivity: str | None = None,
    response_sensitivity: str | None = None,
    force_dof: str | None = None,
    response_dofs: str | Sequence[str] = (),
    estimator: Literal["h1", "h2", "hv"] = "h1",
    trigger_n: float | None = None,
    pre_trigger_s: float | None = None,
    length_s: float | None = None,
    double_impact: float = 0.1,
    drift: float = 0.05,
    force_window_s: float | None = None,
    exponential_window_s: float | None = None,
    keep: Sequence[int] = (),
) -> dict[str, Any]:
    """What ``frfit frf RECORDS -o FRF`` does: an FRF of the records of a hammer test, written as UFF or table.

    It returns what ``--json`` prints. Channels, units, sensitivities and degrees of freedom are texts as on the command
    line: ``"22.4mV/N"``, ``"g"``, ``"12+Z"``. ``frf`` does the same from arrays.

    Raises
    ------
    InputError, OptionsError, WriteError
        The exception has the message that the command line prints.
    """
    files: list[_Path]
    if isinstance(records, str | os.PathLike):
        files = [records]
    else:
        files = several(records, "records", "paths of files")
    channels = {
        "to": to,
        "force": force,
        "responses": words(responses, "responses"),
        "force_unit": force_unit,
        "response_unit": response_unit,
        "force_sensitivity": force_sensitivity,
        "response_sensitivity": response_sensitivity,
        "force_dof": force_dof,
        "response_dofs": words(response_dofs, "response_dofs"),
    }
    how = signal_options(
        estimator=estimator,
        trigger_n=trigger_n,
        pre_trigger_s=pre_trigger_s,
        length_s=length_s,
        double_impact=number(double_impact, "double_impact"),
        drift=number(drift, "drift"),
        force_window_s=force_window_s,
        exponential_window_s=exponential_window_s,
        keep=keep,
    )
    found: dict[str, Any] = json.loads(_frfit.frf_of_files(files, out, channels, how))
    return found


@hints
def examples() -> dict[str, str]:
    """The examples of ``frfit example``: name and question.

    >>> "rubber-bar" in examples()
    True
    """
    return dict(_frfit.examples())


@hints
def example(name: str, folder: _Path | None = None) -> list[str]:
    """What ``frfit example NAME FOLDER`` does: writes a complete case with a known answer, and returns the names of its files.

    An edited file is not overwritten.

    Raises
    ------
    OptionsError, WriteError
        No such example; a file that is there with other contents.
    """
    return _frfit.example(word(name, "name"), name if folder is None else folder)


@hints
def demo(out: _Path = "frfit-demo") -> Identification:
    """What ``frfit demo`` does: the main job on a rubber bar whose modulus is 50 % off.

    Raises
    ------
    WriteError
        A file that is there with other contents.
    """
    example("rubber-bar", out)
    return run_case(os.path.join(out, "case.toml"), os.path.join(out, "out"))
