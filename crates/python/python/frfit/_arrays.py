"""What the compiled part takes: one-dimensional arrays of float64 and complex128, copied only where they are not."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real: TypeAlias = NDArray[np.float64]
Complex: TypeAlias = NDArray[np.complex128]
Whole: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]


def real(values: ArrayLike) -> Real:
    """A vector of float64."""
    return np.atleast_1d(np.asarray(values, dtype=np.float64)).ravel()


def complex_(values: ArrayLike) -> Complex:
    """A vector of complex128."""
    return np.atleast_1d(np.asarray(values, dtype=np.complex128)).ravel()


def load_vector(load: ArrayLike, dim: int) -> Complex:
    """A unit force where `load` is one whole number (a row from 0), else `load` itself."""
    array: NDArray[Any] = np.asarray(load)
    if array.ndim == 0 and np.issubdtype(array.dtype, np.integer):
        row = int(array)
        if not 0 <= row < dim:
            raise IndexError(f"load: expected a row from 0 to {dim - 1}, found {row}")
        force = np.zeros(dim, dtype=np.complex128)
        force[row] = 1.0
        return force
    return complex_(array)
