"""Universal files (UFF 58 and 58b)."""

from __future__ import annotations

import mmap
import os
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import (
    Complex,
    Real,
    complex_,
    flag,
    hints,
    hints_of,
    number,
    optional_pair,
    real,
    refuse,
    several,
    shown,
    whole,
    word,
)
from ._errors import InputError
from ._shown import counted, some, span

_AXES = ("X", "Y", "Z", "RX", "RY", "RZ")
_NAME = re.compile(r"(\d+)([+-])(RX|RY|RZ|X|Y|Z)", flags=re.IGNORECASE)


@hints_of
@dataclass(frozen=True)
class UffDof:
    """Node and direction: 1, 2, 3 for X, Y, Z, 4, 5, 6 for rotations, negative against the axis, 0 for a scalar."""

    node: int = 0
    direction: int = 0
    entity: str = ""

    @classmethod
    def of(cls, name: str) -> UffDof:
        """The degree of freedom of a name such as ``"34+Z"`` or ``"7-RX"``, as case files have it."""
        found = _NAME.fullmatch(word(name, "name").strip())
        if not found:
            raise refuse("name", "a node, a sign and a direction such as 12+Z or 7-RX", shown(name))
        axis = _AXES.index(found[3].upper()) + 1
        return cls(int(found[1]), axis if found[2] == "+" else -axis)

    @property
    def name(self) -> str:
        """The name, such as ``"34+Z"``; of a scalar the node alone."""
        axis = abs(self.direction)
        if not 1 <= axis <= 6:
            return str(self.node)
        return f"{self.node}{'+' if self.direction > 0 else '-'}{_AXES[axis - 1]}"


@hints_of
@dataclass(frozen=True)
class UffAxis:
    """What an axis shows, by the number of the format (8 displacement, 12 acceleration, 13 force, 18 frequency)."""

    quantity: int = 0
    label: str = ""
    unit: str = ""


@dataclass(frozen=True, repr=False)
class UffSummary:
    """A dataset in a few words; what is no function has its number and line only."""

    dataset: int
    line: int
    binary: bool
    is_function: bool
    id: str = ""
    function_type: str = ""
    response_dof: str = ""
    reference_dof: str = ""
    points: int = 0
    even: bool = False
    range: tuple[float, float] | None = None
    data_type: str = ""
    quantities: tuple[str, str, str] = ("", "", "")
    units: tuple[str, str, str] = ("", "", "")

    def __repr__(self) -> str:
        if not self.is_function:
            return f"<frfit.UffSummary of dataset {self.dataset} in line {self.line}>"
        dofs = f"{self.response_dof} over {self.reference_dof}"
        quantity = self.quantities[1]
        band = "" if self.range is None else f", {span(self.range, self.units[0])}"
        return f"<frfit.UffSummary of {self.function_type} {dofs}, {quantity}: {counted(self.points, 'point')}{band}>"


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class UffFunction:
    """A function: ``abscissa`` (points,) in the unit of its axis, ``values`` (points,) real or complex.

    ``even``: (first abscissa, step) where the abscissa is not stored point by point. ``function_type`` 4 is an FRF.
    """

    abscissa: ArrayLike
    values: ArrayLike
    response_dof: UffDof = UffDof()
    reference_dof: UffDof = UffDof()
    function_type: int = 4
    id: tuple[str, ...] = ()
    even: tuple[float, float] | None = None
    abscissa_axis: UffAxis = UffAxis(18)
    ordinate_axis: UffAxis = UffAxis()
    denominator_axis: UffAxis = UffAxis()
    double_precision: bool = True
    load_case: int = 0
    z_value: float = 0.0
    missing_points: int = field(default=0)

    def __repr__(self) -> str:
        values = np.asarray(self.values)
        kind = "complex" if np.iscomplexobj(values) else "real"
        missing = f", {self.missing_points} missing" if self.missing_points else ""
        dofs = f"{self.response_dof.name} over {self.reference_dof.name}"
        said = f"{counted(values.size, 'value')} from {span(self.abscissa, self.abscissa_axis.unit)}{missing}"
        return f"<frfit.UffFunction of type {self.function_type}, {dofs}: {kind}, {said}>"


class Uff:
    """A universal file, mapped into memory: listed without being read, functions read when they are asked for.

    The file must not change while this is alive.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        try:
            size = os.path.getsize(path)
            empty = np.zeros(0, dtype=np.uint8)
            mapped = np.memmap(path, dtype=np.uint8, mode="r") if size > 0 else empty
        except OSError:
            # The words for a file that is not there are the reader's.
            _frfit.readable(path)
            raise
        self._path = os.path.abspath(path)
        self._file = _frfit.UffFile(path, np.asarray(mapped))
        self._summaries: tuple[UffSummary, ...] | None = None

    def __reduce__(self) -> tuple[type[Uff], tuple[str | bytes]]:
        """Pickled as where it is: whoever unpickles it maps the file anew."""
        return Uff, (self._path,)

    def __len__(self) -> int:
        return len(self._file)

    def __repr__(self) -> str:
        functions = sum(dataset.is_function for dataset in self.datasets)
        return f"<frfit.Uff {self._path!r}: {counted(len(self), 'dataset')}, {counted(functions, 'function')}>"

    @property
    def datasets(self) -> tuple[UffSummary, ...]:
        """Every dataset of the file in a few words; of a function only the header is read."""
        if self._summaries is None:

            def fixed(found: dict[str, Any]) -> dict[str, Any]:
                return {key: tuple(value) if isinstance(value, list) else value for key, value in found.items()}

            self._summaries = tuple(UffSummary(**fixed(found)) for found in self._file.summaries())
        return self._summaries

    def function(self, index: int) -> UffFunction:
        """The function at this place among :attr:`datasets`, from 0."""
        place = whole(index, "index")
        if place < 0:
            raise refuse("index", "a whole number from 0", str(place))
        found: dict[str, Any] = self._file.function(place)

        def dof(key: str) -> UffDof:
            entity, node, direction = found.pop(key)
            return UffDof(node, direction, entity)

        axes = [UffAxis(*axis) for axis in found.pop("axes")]
        return UffFunction(
            response_dof=dof("response_dof"),
            reference_dof=dof("reference_dof"),
            id=tuple(found.pop("id")),
            abscissa_axis=axes[0],
            ordinate_axis=axes[1],
            denominator_axis=axes[2],
            **found,
        )

    def functions(self) -> Iterator[UffFunction]:
        """All functions, one after the other."""
        for index, dataset in enumerate(self.datasets):
            if dataset.is_function:
                yield self.function(index)


@hints
def read_uff(path: str | os.PathLike[str]) -> Uff:
    """The datasets of a universal file, found but not read.

    Raises
    ------
    InputError
        A file that is no universal file: where, what was expected, what was found.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "frf.uff"
    >>> write_uff(path, [UffFunction([10.0, 20.0], [1 + 2j, 3j], response_dof=UffDof(34, 3))])
    >>> file = read_uff(path)
    >>> file.datasets[0].response_dof, file.datasets[0].range
    ('34+Z', (10.0, 20.0))
    >>> file.function(0).values
    array([1.+2.j, 0.+3.j])
    """
    return Uff(path)


@hints
def write_uff(
    path: str | os.PathLike[str], functions: UffFunction | Sequence[UffFunction], *, binary: bool = False
) -> None:
    """Writes functions as datasets 58 (text), or 58b (binary, exact in double precision): all of them, or nothing."""
    expected = "a UffFunction or several"
    found = [functions] if isinstance(functions, UffFunction) else several(functions, "functions", expected)

    def dof(at: UffDof, key: str) -> tuple[str, int, int]:
        if not isinstance(at, UffDof):
            raise refuse(key, "a UffDof", shown(at))
        node, direction = whole(at.node, f"{key}.node"), whole(at.direction, f"{key}.direction")
        return word(at.entity, f"{key}.entity"), node, direction

    def axis(of: UffAxis, key: str) -> tuple[int, str, str]:
        if not isinstance(of, UffAxis):
            raise refuse(key, "a UffAxis", shown(of))
        label, unit = word(of.label, f"{key}.label"), word(of.unit, f"{key}.unit")
        return whole(of.quantity, f"{key}.quantity"), label, unit

    def plain(one: UffFunction) -> dict[str, Any]:
        if not isinstance(one, UffFunction):
            raise refuse("functions", expected, shown(one))
        values: Real | Complex = complex_(one.values, "values")
        if not np.iscomplexobj(one.values):
            values = real(one.values, "values")
        lines = [word(line, "id") for line in several(one.id, "id", "up to five lines of text")]
        return {
            "id": [*lines, *[""] * 5][:5],
            "function_type": whole(one.function_type, "function_type"),
            "response_dof": dof(one.response_dof, "response_dof"),
            "reference_dof": dof(one.reference_dof, "reference_dof"),
            "double_precision": flag(one.double_precision, "double_precision"),
            "load_case": whole(one.load_case, "load_case"),
            "z_value": number(one.z_value, "z_value"),
            "even": optional_pair(one.even, "even"),
            "axes": [
                axis(one.abscissa_axis, "abscissa_axis"),
                axis(one.ordinate_axis, "ordinate_axis"),
                axis(one.denominator_axis, "denominator_axis"),
            ],
            "abscissa": real(one.abscissa, "abscissa"),
            "values": values,
        }

    _frfit.write_uff(path, [plain(one) for one in found], flag(binary, "binary"))


_FRF, _COHERENCE, _GENERAL = 4, 6, 0
"""Types of functions."""

_STD_LABEL = "Standard deviation"
"""The label of a function that is the standard deviation of an FRF: the format has no type for it."""

_QUANTITY = {8: "receptance", 11: "mobility", 12: "accelerance"}
_OVER_FORCE = (0, 1, 9, 13)
"""A force, or a denominator that says nothing."""

_GRAVITY = 9.80665
_INCH = 0.0254

# Units of labels, in SI units: the words of the reader of case files.
_UNITS = dict.fromkeys(("N", "Newton", "Newtons", "newton", "newtons", "m/s^2", "m/s²", "m/s2", "m/s/s", "m/s", "m"), 1.0)
_UNITS |= dict.fromkeys(("mN", "mm/s^2", "mm/s²", "mm/s", "mm"), 1e-3)
_UNITS |= dict.fromkeys(("um/s", "µm/s", "um", "µm"), 1e-6)
_UNITS |= dict.fromkeys(("g", "gn", "g_n", "kgf"), _GRAVITY)
_UNITS |= dict.fromkeys(("in/s^2", "in/s", "in"), _INCH)
_UNITS |= {"kN": 1e3, "lbf": 0.45359237 * _GRAVITY, "mg": 1e-3 * _GRAVITY}


@dataclass(frozen=True, eq=False)
class FrfOfFile:
    """An FRF of a universal file as a case file gets it, and what the file says about it."""

    frequency_hz: Real
    response: Complex
    std: Real | None
    coherence: Real | None
    quantity: str | None
    ordinate: str
    sign: float
    decay_per_s: float | None


def frfs_of(path: str | os.PathLike[str], names: Sequence[str], driven_at: Any = None) -> dict[str, FrfOfFile]:
    """The FRFs whose responses have these names, in the order of the names: values in SI units, with their noise."""
    file = Uff(path)
    where = os.fspath(path)

    def refused(expected: str, found: str, line: int | None = None) -> InputError:
        place = f"{where}, line {line}" if line else where
        error = InputError(f"{place}: expected {expected}, found {found}")
        error.file, error.line, error.expected, error.found = where, line, expected, found
        return error

    force = None if driven_at is None else _dof(driven_at, "driven_at")
    frfs: list[tuple[int, UffSummary]] = []
    others: list[tuple[int, UffSummary]] = []
    for index, summary in enumerate(file.datasets):
        if summary.is_function:
            (frfs if summary.function_type == _name_of(_FRF) else others).append((index, summary))
    if not frfs:
        expected = "a frequency response function (dataset 58 of function type 4)"
        raise refused(expected, f"none, and {counted(len(others), 'function')} of other types")
    found = {}
    for name in names:
        wanted = _dof(name, "dofs")
        fitting = [one for one in frfs if _same(one[1].response_dof, wanted)]
        if force is not None:
            fitting = [one for one in fitting if _same(one[1].reference_dof, force)]
        if len(fitting) != 1:
            listed = some((f"{one.response_dof}/{one.reference_dof}" for _, one in frfs), 8)
            said = "several, and driven_at says not which" if force is None else "several driven there"
            over = "" if force is None else f" over {force.name}"
            raise refused(
                f"one frequency response function of {wanted.name}{over}",
                f"{'none' if not fitting else said} among {counted(len(frfs), 'record')}: {listed}",
            )
        index, summary = fitting[0]
        found[name] = _frf_of_file(file, index, summary, others, wanted, refused)
    return found


def _name_of(function_type: int) -> str:
    """The words of the compiled part for a type."""
    return {_FRF: "frequency response function", _COHERENCE: "coherence", _GENERAL: "general or unknown"}[function_type]


def _dof(name: Any, key: str) -> UffDof:
    if isinstance(name, UffDof):
        return name
    try:
        return UffDof.of(name)
    except InputError as error:
        raise refuse(key, error.expected, error.found) from None


def _same(there: str, wanted: UffDof) -> bool:
    """Whether a degree of freedom of a summary is the wanted one."""
    return there == wanted.name


def _frf_of_file(
    file: Uff,
    index: int,
    summary: UffSummary,
    others: Sequence[tuple[int, UffSummary]],
    wanted: UffDof,
    refused: Callable[..., InputError],
) -> FrfOfFile:
    frf, line = file.function(index), summary.line
    axis = frf.abscissa_axis
    if axis.quantity not in (0, 1, 18):
        raise refused("an abscissa in Hz", summary.quantities[0], line)
    if "rad" in axis.unit.lower():
        raise refused("an abscissa in Hz", f'the unit "{axis.unit}"', line)
    if frf.missing_points:
        there = summary.points - frf.missing_points
        raise refused(f"{summary.points} points, as the header says", str(there), line)
    if not np.iscomplexobj(frf.values):
        raise refused("complex values of an FRF", "real ones", line)
    frequency_hz, response = real(frf.abscissa, "abscissa"), complex_(frf.values, "values")

    def companion(function_type: int, label: str | None, expected: str, most: float) -> Real | None:
        """The one real function between the same degrees of freedom at the same frequencies; none of several."""
        fitting = []
        for at, other in others:
            own = (_name_of(function_type), summary.response_dof, summary.reference_dof)
            if (other.function_type, other.response_dof, other.reference_dof) != own:
                continue
            function = file.function(at)
            if label is not None and function.ordinate_axis.label != label:
                continue
            if np.iscomplexobj(function.values):
                raise refused(f"{expected}, real", "complex ones", other.line)
            values = real(function.values, "values")
            if not np.array_equal(real(function.abscissa, "abscissa"), frequency_hz):
                continue
            # Written so that NaN fails too.
            wrong = values[~((values >= 0.0) & (values <= most))]
            if wrong.size:
                raise refused(expected, str(wrong[0]), other.line)
            fitting.append(values)
        return fitting[0] if len(fitting) == 1 else None

    std = companion(_GENERAL, _STD_LABEL, "standard deviations from 0 on", np.finfo(float).max)
    coherence = companion(_COHERENCE, None, "coherences from 0 to 1", 1.0)
    factor = _to_si(file, frf, refused)
    if factor != 1.0:
        response, std = response * factor, None if std is None else std * factor
    over_force = frf.denominator_axis.quantity in _OVER_FORCE
    return FrfOfFile(
        frequency_hz=frequency_hz,
        response=response,
        std=std,
        coherence=coherence,
        quantity=_QUANTITY.get(frf.ordinate_axis.quantity) if over_force else None,
        ordinate=f"{summary.quantities[1]} over {summary.quantities[2]}",
        sign=1.0 if wanted.direction >= 0 else -1.0,
        decay_per_s=_decay(frf, refused, line),
    )


def _decay(frf: UffFunction, refused: Callable[..., InputError], line: int) -> float | None:
    """What the ID lines say about an exponential window."""
    for text in frf.id:
        said = re.fullmatch(r"\s*decay_per_s\s*=\s*(.*?)\s*", text)
        if not said:
            continue
        try:
            value = float(said[1])
        except ValueError:
            value = -1.0
        if not 0.0 <= value < np.inf:
            raise refused("decay_per_s = a number of 1/s from 0 on in an ID line", f'"{text.strip()}"', line)
        return value
    return None


_DATASET_164 = re.compile(rb"^    -1[ \t\r]*\n(?:[ \t\r]*\n)*[ ]{3}164[ \t\r]*\n[^\n]*\n([^\n]*)", flags=re.MULTILINE)


def _to_si(file: Uff, frf: UffFunction, refused: Callable[..., InputError]) -> float:
    """What the values of an FRF are multiplied by to be in SI units, as dataset 164 says; 1 without one."""
    lines = [dataset.line for dataset in file.datasets if dataset.dataset == 164]
    if not lines:
        return 1.0
    with open(file._path, "rb") as opened, mmap.mmap(opened.fileno(), 0, access=mmap.ACCESS_READ) as content:
        texts = [found[1].decode("ascii", "replace") for found in _DATASET_164.finditer(content)]
    if len(texts) != len(lines):
        raise refused("units (dataset 164) where the datasets begin", f"{len(texts)} of {len(lines)}", lines[0])
    said: dict[float, int] = {}
    for text, line in zip(texts, lines, strict=True):
        numbers = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?", text)
        if len(numbers) < 2:
            raise refused("unit factors of length and force", f'"{text.strip()}"', line)
        length, force = (float(one.upper().replace("D", "E")) for one in numbers[:2])
        if not (0.0 < length < np.inf and 0.0 < force < np.inf):
            raise refused("unit factors above 0", f"{length} of length and {force} of force", line)
        # An angle is in rad, and a moment in force times length. SI is the value over the factor.
        of_length = 1.0 if abs(frf.response_dof.direction) > 3 else length
        of_force = force * length if abs(frf.reference_dof.direction) > 3 else force
        factor = of_force / of_length
        if abs(factor - 1.0) > 1e-6:
            for axis, of_file in ((frf.ordinate_axis, of_length), (frf.denominator_axis, of_force)):
                unit = _UNITS.get(axis.unit.strip().replace("\u03bc", "\u00b5"))
                if unit is not None and abs(unit * of_file - 1.0) > 1e-6:
                    expected = f'units of the file (dataset 164) that agree with the label "{axis.unit}"'
                    raise refused(expected, f"unit factors {length} of length and {force} of force", line)
        said[factor] = line
    if len(said) > 1:
        first, second = list(said.values())[:2]
        raise refused("the same units throughout the file", f"other ones than in line {first}", second)
    (factor,) = said
    # Factors that are 1 but for rounding are 1.
    return factor if abs(factor - 1.0) > 1e-6 else 1.0
