"""What pickles call: compiled objects from their parts."""

from __future__ import annotations

from typing import Any

from . import _frfit
from ._arrays import Complex


def law(kind: str, *parts: Any) -> _frfit.Law:
    """A law by the name of what makes it."""
    made: _frfit.Law = getattr(_frfit.Law, kind)(*parts)
    return made


def model(terms: list[Any], indices: Any, indptr: Any) -> _frfit.Model:
    """A model of the lower triangle of its pattern."""
    return _frfit.restored_model(terms, indices, indptr)


def series(scale: float, nominal: complex, coefficients: Complex, radius: tuple[float, float, bool]) -> _frfit.Series:
    """A series of its coefficients."""
    return _frfit.restored_series(scale, nominal, coefficients, radius)
