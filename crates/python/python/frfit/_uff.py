"""Universal files (UFF 58 and 58b)."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
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
        """Pickled as its path; unpickling maps the file again."""
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


_FRF = "frequency response function"
"""The word for its type."""


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

    def refused(expected: str, found: str) -> InputError:
        error = InputError(f"{where}: expected {expected}, found {found}")
        error.file, error.line, error.expected, error.found = where, None, expected, found
        return error

    force = None if driven_at is None else _dof(driven_at, "driven_at")
    functions = [dataset for dataset in file.datasets if dataset.is_function]
    frfs = [function for function in functions if function.function_type == _FRF]
    if not frfs:
        expected = "a frequency response function (dataset 58 of function type 4)"
        raise refused(expected, f"none, and {counted(len(functions), 'function')} of other types")

    def between(response: str, reference: str | None) -> list[int]:
        return [
            record
            for record, one in enumerate(frfs, 1)
            if one.response_dof == response and reference in (None, one.reference_dof)
        ]

    wanted = {name: _dof(name, "dofs") for name in names}
    chosen = []
    for dof in wanted.values():
        fitting = between(dof.name, None if force is None else force.name)
        if not fitting and force is not None:
            # A hammer that moves: by reciprocity that FRF is the same.
            fitting = between(force.name, dof.name)
        if len(fitting) != 1:
            listed = some((f"{one.response_dof}/{one.reference_dof}" for one in frfs), 8)
            said = "several, and driven_at says not which" if force is None else "several driven there"
            over = "" if force is None else f" over {force.name}"
            raise refused(
                f"one frequency response function of {dof.name}{over}",
                f"{'none' if not fitting else said} among {counted(len(frfs), 'record')}: {listed}",
            )
        chosen += fitting
    found = {}
    for (name, dof), record, read in zip(wanted.items(), chosen, file._file.frfs(chosen), strict=True):
        quantities = frfs[record - 1].quantities
        ordinate = f"{quantities[1]} over {quantities[2]}"
        found[name] = FrfOfFile(**read, ordinate=ordinate, sign=1.0 if dof.direction >= 0 else -1.0)
    return found


def _dof(name: Any, key: str) -> UffDof:
    if isinstance(name, UffDof):
        return name
    try:
        return UffDof.of(name)
    except InputError as error:
        raise refuse(key, error.expected, error.found) from None
