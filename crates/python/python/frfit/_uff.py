"""Universal files (UFF 58 and 58b)."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import Complex, Real, complex_, real


@dataclass(frozen=True)
class UffDof:
    """Node and direction: 1, 2, 3 for X, Y, Z, 4, 5, 6 for rotations, negative against the axis, 0 for a scalar."""

    node: int = 0
    direction: int = 0
    entity: str = ""


@dataclass(frozen=True)
class UffAxis:
    """What an axis shows, by the number of the format (8 displacement, 12 acceleration, 13 force, 18 frequency)."""

    quantity: int = 0
    label: str = ""
    unit: str = ""


@dataclass(frozen=True)
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


@dataclass(frozen=True, eq=False)
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
        self._file = _frfit.UffFile(path, np.asarray(mapped))
        self._summaries: tuple[UffSummary, ...] | None = None

    def __len__(self) -> int:
        return len(self._file)

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
        found: dict[str, Any] = self._file.function(index)

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


def read_uff(path: str | os.PathLike[str]) -> Uff:
    """The datasets of a universal file, found but not read.

    Raises
    ------
    InputError
        A file that is none: where, what was expected, what was found.

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


def write_uff(
    path: str | os.PathLike[str], functions: UffFunction | Sequence[UffFunction], *, binary: bool = False
) -> None:
    """Writes functions as datasets 58 (text), or 58b (binary, exact in double precision): all of them, or nothing."""
    several = [functions] if isinstance(functions, UffFunction) else list(functions)

    def plain(one: UffFunction) -> dict[str, Any]:
        axes = (one.abscissa_axis, one.ordinate_axis, one.denominator_axis)
        values: Real | Complex = complex_(one.values) if np.iscomplexobj(one.values) else real(one.values)
        return {
            "id": [*one.id, *[""] * 5][:5],
            "function_type": one.function_type,
            "response_dof": (one.response_dof.entity, one.response_dof.node, one.response_dof.direction),
            "reference_dof": (one.reference_dof.entity, one.reference_dof.node, one.reference_dof.direction),
            "double_precision": one.double_precision,
            "load_case": one.load_case,
            "z_value": float(one.z_value),
            "even": one.even,
            "axes": [(axis.quantity, axis.label, axis.unit) for axis in axes],
            "abscissa": real(one.abscissa),
            "values": values,
        }

    _frfit.write_uff(path, [plain(one) for one in several], binary)
