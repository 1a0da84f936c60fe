"""Matrices of files, and matrices for the compiled part."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import scipy.sparse as sp

from . import _frfit


def read_matrix(path: str | os.PathLike[str], name: str | None = None) -> Any:
    """A matrix of a file, both triangles, as a ``scipy.sparse.csc_array``.

    The kind of file is told by its content: Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran (DMIG, OUTPUT4),
    NumPy, MATLAB. A pattern has ones for values. Rows are in the order of the file: where files name their rows, and in
    different orders, :func:`run_case` brings them to one, and this function does not.

    Parameters
    ----------
    name
        Which matrix of a file of several.

    Raises
    ------
    InputError
        A file that cannot be read: where, what was expected, what was found. Several matrices and no ``name``, or none
        of that name: what there is.

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
    found = _frfit.read_matrix(path, name)
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
