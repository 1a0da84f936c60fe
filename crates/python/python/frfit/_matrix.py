"""Matrices of files, and matrices for the compiled part."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import scipy.sparse as sp

from . import _frfit


def read_matrix(path: str | os.PathLike[str]) -> Any:
    """The matrix of a file (Matrix Market, Harwell-Boeing), both triangles, as a ``scipy.sparse.csc_array``.

    The kind of file is told by its content. A pattern has ones for values.

    Raises
    ------
    InputError
        A file that cannot be read: where, what was expected, what was found.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "k.mtx"
    >>> lines = ["%%MatrixMarket matrix coordinate real symmetric", "2 2 3", "1 1 2.0", "2 1 -1.0", "2 2 2.0"]
    >>> _ = path.write_text(chr(10).join(lines) + chr(10))
    >>> read_matrix(path).toarray()
    array([[ 2., -1.],
           [-1.,  2.]])
    """
    found = _frfit.read_matrix(path)
    rows, cols, values = found["rows"], found["cols"], found["values"]
    if found["symmetry"] != "general":
        below = rows != cols
        mirror = values[below]
        if found["symmetry"] == "skew-symmetric":
            mirror = -mirror
        elif found["symmetry"] == "hermitian":
            mirror = mirror.conj()
        rows, cols = np.concatenate([rows, cols[below]]), np.concatenate([cols, rows[below]])
        values = np.concatenate([values, mirror])
    return sp.csc_array((values, (rows, cols)), shape=found["shape"])


def compressed(matrix: Any) -> tuple[Any, Any, Any, Any]:
    """Shape, data, row indices and column pointers: those of the matrix itself where it is CSC and canonical."""
    csc = matrix.tocsc() if sp.issparse(matrix) else sp.csc_array(np.atleast_2d(np.asarray(matrix)))
    if not csc.has_canonical_format:
        csc = csc.copy()
        csc.sum_duplicates()
    kind = np.complex128 if np.iscomplexobj(csc.data) else np.float64
    return csc.shape, np.asarray(csc.data, dtype=kind), csc.indices, csc.indptr
