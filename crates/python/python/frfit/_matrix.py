"""Matrices of files, and matrices for the compiled part."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp

from . import _frfit
from ._arrays import hints, number, refuse, several, shown, whole
from ._errors import MatrixError


def read_matrix(path: str | os.PathLike[str], name: str | None = None) -> Any:
    """A matrix of a file, both triangles, as a ``scipy.sparse.csc_array``.

    The kind of file is recognised by its content: Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran (DMIG, OUTPUT4),
    NumPy, MATLAB. A pattern has ones for values. Rows are in the order of the file: where files name their rows, and in
    different orders, :func:`run_case` brings them to one, and this function does not.

    frfit refuses a compressed file (``.npz``, ``.mat``) whose contents exceed a limit. The limit is 16 times the file size
    + 1 MB for dense arrays, not counting zeros. It is 128 times + 1 MB for sparse ones. Save a larger file uncompressed.

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
    if found["symmetry"] == "general":
        return sp.csc_array((values, (rows, cols)), shape=found["shape"])
    mirrored = {"symmetric": np.asarray, "skew-symmetric": np.negative, "hermitian": np.conj}[found["symmetry"]]
    return _whole(rows, cols, values, found["shape"], mirrored)


@hints
def powers_of(matrices: Mapping[float, Any], powers: Sequence[int] | None = None) -> dict[int, Any]:
    """A matrix that depends on a dimension, as a sum of its powers: K(p) = sum of p**q K_q.

    As ``at`` of a matrix in a case file. The parts become terms of a model, and the dimension an :class:`Unknown` with
    their powers. The sum goes through the matrices at all values but the middle one, which it has to meet to 1e-6 of
    its largest entry.

    Parameters
    ----------
    matrices
        The matrix at each value of the dimension: real, symmetric, all of one size. One value more than there are
        powers; 3 to 10 values without ``powers``.
    powers
        The powers of the dimension in the matrix; without them 0, 1, 2 and so on. A solid's stiffness has
        -1, 0 and 1 of its thickness, a plate's 1 and 3, a mass 1.

    Returns
    -------
    dict
        K_q by its power q, a ``scipy.sparse.csc_array`` each; powers whose part is rounding are left out.

    Raises
    ------
    MatrixError
        A matrix that is not square, symmetric or finite.
    InputError
        Too few values, one twice, or a matrix at the middle value that the sum does not meet.

    Examples
    --------
    A plate with K = h K_1 + h**3 K_3, assembled at three thicknesses:

    >>> import numpy as np
    >>> k1, k3 = np.diag([4.0, 9.0]), np.array([[2.0, -1.0], [-1.0, 2.0]])
    >>> parts = powers_of({h: h * k1 + h**3 * k3 for h in (1.0, 2.0, 3.0)}, powers=[1, 3])
    >>> {power: part.toarray().round(9).tolist() for power, part in parts.items()}
    {1: [[4.0, 0.0], [0.0, 9.0]], 3: [[2.0, -1.0], [-1.0, 2.0]]}
    """
    if not isinstance(matrices, Mapping):
        raise refuse("matrices", "a dictionary of values and matrices", shown(matrices))
    plain = []
    for value, matrix in matrices.items():
        p = number(value, "matrices", "a value of the dimension")
        if not np.isfinite(p):
            raise refuse("matrices", "finite values of the dimension", shown(value))
        name = f"at {p:g}"
        glanced_at(matrix, name)
        plain.append((p, name, *compressed(matrix, name)))
    wanted = None
    if powers is not None:
        wanted = [whole(power, "powers") for power in several(powers, "powers", "a sequence of whole numbers")]
        for power in wanted:
            if abs(power) > 12:
                raise refuse("powers", "whole numbers from -12 to 12", str(power))
    parts = _frfit.powers_of(plain, wanted)
    size = plain[0][2]
    return {power: _whole(rows, cols, values, size) for power, (rows, cols, values) in parts}


def _whole(rows: Any, cols: Any, values: Any, shape: Any, mirrored: Any = np.asarray) -> Any:
    """A matrix of one of its triangles; ``mirrored`` makes the values of the other one."""
    below = rows != cols
    rows, cols = np.concatenate([rows, cols[below]]), np.concatenate([cols, rows[below]])
    values = np.concatenate([values, mirrored(values[below])])
    return sp.csc_array((values, (rows, cols)), shape=shape)


def compressed(matrix: Any, name: str) -> tuple[Any, Any, Any, Any]:
    """Shape, data, row indices and column pointers: those of the matrix itself where it is CSC and canonical.

    SciPy converts without a look at the indices: where they point outside, it reads and writes there. So they are
    checked before anything else is done with them.

    Raises
    ------
    MatrixError
        Arrays that contradict each other, or what is no number.
    """
    if sp.issparse(matrix):
        if matrix.ndim != 2:
            raise _refused(name, "rows and columns", f"{matrix.ndim} dimension(s)")
        kind = matrix.dtype.kind
        if kind not in "iufc":
            raise _refused(name, "real or complex numbers", f"a matrix of {matrix.dtype}")
        try:
            csc = _canonical(matrix, name)
        except MatrixError:
            raise
        except Exception as error:
            # Whatever SciPy says of arrays of other kinds than it makes itself.
            found = f"one that SciPy cannot convert: {error}"
            raise _refused(name, f"a sound matrix of format {matrix.format}", found) from error
    else:
        try:
            array = np.asarray(matrix)
        except (TypeError, ValueError):
            raise _refused(name, "an array of numbers", shown(matrix)) from None
        if array.dtype.kind not in "iufc":
            raise _refused(name, "real or complex numbers", f"an array of {array.dtype}")
        if array.ndim > 2:
            raise _refused(name, "rows and columns", f"{array.ndim} dimensions")
        csc = sp.csc_array(np.atleast_2d(array))
    kind = np.complex128 if np.iscomplexobj(csc.data) else np.float64
    return csc.shape, np.asarray(csc.data, dtype=kind), _indices(csc.indices), _indices(csc.indptr)


def glanced_at(matrix: Any, name: str) -> None:
    """Refuses what costs nothing to see: no numbers, not square, values that are not finite.

    Raises
    ------
    MatrixError
        The first of them.
    """
    if sp.issparse(matrix):
        kind, shape, values = matrix.dtype.kind, matrix.shape, getattr(matrix, "data", None)
        # Lists and dictionaries have their values in objects.
        values = values if isinstance(values, np.ndarray) and values.dtype.kind in "fc" else None
        named = f"a matrix of {matrix.dtype}"
    else:
        try:
            array = np.asarray(matrix)
        except (TypeError, ValueError):
            raise _refused(name, "an array of numbers", shown(matrix)) from None
        kind, shape, named = array.dtype.kind, np.atleast_2d(array).shape, f"an array of {array.dtype}"
        values = array if kind in "fc" else None
    if kind not in "iufc":
        raise _refused(name, "real or complex numbers", named)
    if len(shape) != 2:
        raise _refused(name, "rows and columns", f"{len(shape)} dimensions")
    if shape[0] != shape[1] or shape[0] == 0:
        raise _refused(name, "a square matrix", " x ".join(map(str, shape)))
    if values is not None and not np.isfinite(values).all():
        raise _refused(name, "finite values", shown(values[~np.isfinite(values)].flat[0].item()))


def described(matrix: Any) -> str:
    """Size and kind of a matrix."""
    kind = f"{matrix.format}, {matrix.nnz} entries" if sp.issparse(matrix) else "dense"
    return f"{' x '.join(map(str, np.atleast_2d(matrix).shape if not sp.issparse(matrix) else matrix.shape))} ({kind})"


def _indices(array: Any) -> Any:
    """Indices of the two kinds that the compiled part takes."""
    return array if array.dtype in (np.int32, np.int64) else array.astype(np.int64)


def _canonical(matrix: Any, name: str) -> Any:
    """Sound compressed columns, sorted, each position once."""
    if matrix.format not in _SOUND:
        # Lists and dictionaries: SciPy makes compressed rows or positions of them without a look at the numbers.
        matrix = matrix.tocsr() if matrix.format == "lil" else matrix.tocoo()
    _SOUND[matrix.format](matrix, name)
    csc = matrix.tocsc()
    _compressed(csc, name)
    # The same arrays in another matrix: what this one remembers of itself may not hold any more.
    csc = sp.csc_array((csc.data, csc.indices, csc.indptr), shape=csc.shape)
    if not csc.has_canonical_format:
        csc = csc.copy()
        csc.sum_duplicates()
    return csc


def _refused(name: str, expected: str, found: str) -> MatrixError:
    return MatrixError(f"matrix {name!r}: expected {expected}, found {found}")


def _vector(array: Any, what: str, name: str, kinds: str = "iu") -> Any:
    array = np.asarray(array)
    if array.ndim != 1 or array.dtype.kind not in kinds:
        expected = "whole numbers" if kinds == "iu" else "numbers"
        raise _refused(name, f"{what} in a vector of {expected}", f"{array.ndim} dimension(s) of {array.dtype}")
    return array


def _within(array: Any, end: int, what: str, name: str) -> None:
    if array.size and (array.min() < 0 or array.max() >= end):
        outside = array.min() if array.min() < 0 else array.max()
        raise _refused(name, f"{what} from 0 to {end - 1}", str(outside))


def _pointers(indptr: Any, indices: Any, count: int, major: int, name: str) -> None:
    """Of compressed rows or columns: behind the last pointer arrays may be longer, as SciPy has them."""
    if indptr.shape != (major + 1,):
        raise _refused(name, f"indptr of {major + 1} numbers", str(indptr.size))
    if indptr[0] != 0 or (indptr[1:] < indptr[:-1]).any():
        raise _refused(name, "indptr that ascends from 0", "one that does not")
    last = int(indptr[-1])
    if last > min(indices.size, count):
        raise _refused(name, f"indptr that ends at the {min(indices.size, count)} entries that are there", str(last))


def _compressed(matrix: Any, name: str) -> None:
    indices, indptr = _vector(matrix.indices, "indices", name), _vector(matrix.indptr, "indptr", name)
    data = _vector(matrix.data, "data", name, "iufc")
    major, minor = matrix.shape if matrix.format == "csr" else matrix.shape[::-1]
    _pointers(indptr, indices, data.size, major, name)
    _within(indices[: int(indptr[-1])], minor, "indices", name)


def _blocks(matrix: Any, name: str) -> None:
    indices, indptr = _vector(matrix.indices, "indices", name), _vector(matrix.indptr, "indptr", name)
    data = np.asarray(matrix.data)
    blocks = data.shape[1:]
    if data.ndim != 3 or 0 in blocks or any(size % block for size, block in zip(matrix.shape, blocks, strict=True)):
        raise _refused(name, "data of blocks that fill the matrix", f"an array of {' x '.join(map(str, data.shape))}")
    _pointers(indptr, indices, data.shape[0], matrix.shape[0] // blocks[0], name)
    _within(indices[: int(indptr[-1])], matrix.shape[1] // blocks[1], "indices", name)


def _coordinates(matrix: Any, name: str) -> None:
    rows, cols = _vector(matrix.row, "rows", name), _vector(matrix.col, "columns", name)
    data = _vector(matrix.data, "data", name, "iufc")
    if not rows.size == cols.size == data.size:
        found = f"{rows.size} rows, {cols.size} columns, {data.size} values"
        raise _refused(name, "as many rows as columns as values", found)
    _within(rows, matrix.shape[0], "rows", name)
    _within(cols, matrix.shape[1], "columns", name)


def _diagonals(matrix: Any, name: str) -> None:
    offsets, data = _vector(matrix.offsets, "offsets", name), np.asarray(matrix.data)
    if data.ndim != 2 or data.shape[0] != offsets.size or np.unique(offsets).size != offsets.size:
        found = f"{offsets.size} offsets and an array of {' x '.join(map(str, data.shape))}"
        raise _refused(name, "one row of data for each of different offsets", found)


_SOUND = {"csr": _compressed, "csc": _compressed, "bsr": _blocks, "coo": _coordinates, "dia": _diagonals}
