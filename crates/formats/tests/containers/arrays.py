"""Writes NumPy, SciPy and MATLAB files into a folder, and what is in them as Matrix Market files.

FILE.npz has the matrices FILE.MATRIX.mtx; the name of a matrix without one is empty. With a second argument: what is in
that file of MATLAB.
"""

import sys
from pathlib import Path

import numpy as np
import scipy.io as io
import scipy.sparse as sp

folder = Path(sys.argv[1])
n = 6
k = np.arange(n)
band = np.diag(2.0 + np.sqrt(k + 2.0)) - np.diag(np.sqrt(k[1:] + 5.0), 1) - np.diag(np.sqrt(k[1:] + 5.0), -1)
wide = np.zeros((4, 6))
wide[[0, 3, 2, 1], [5, 0, 2, 2]] = [1 / 3, -1e300, 5e-324, -np.pi]
whole = np.array([[1, 0, -7], [2**31 - 1, 0, 3]])


def expect(file, matrices):
    """The matrices that a file must give."""
    for matrix, value in matrices.items():
        value = value.toarray() if sp.issparse(value) else value
        value = value.astype(complex if np.iscomplexobj(value) else float)
        io.mmwrite(folder / f"{file}.{matrix}.mtx", sp.coo_array(value), symmetry="general", precision=17)


def dense():
    types = ["<f8", ">f8", "<f4", ">c16", "<c8", "<i4", ">i8", "|i1", "<u2", "|b1"]
    for number, kind in enumerate(types):
        source = whole % 100 if np.dtype(kind).kind in "iub" else band * (1 - 2j if "c" in kind else 1)
        for order in "CF":
            value = np.asarray(source, dtype=kind, order=order)
            np.save(folder / f"dense{number}{order}.npy", value)
            expect(f"dense{number}{order}", {"": value})
    named = {"K": band, "M": np.eye(n) * 0.1, "W": wide, "Z": np.asfortranarray(wide * 1j)}
    for write in [np.savez, np.savez_compressed]:
        write(folder / f"{write.__name__}.npz", **named)
        expect(write.__name__, named)


def sparse():
    for name, value in [("band", band), ("wide", wide), ("complex", wide * (1 - 1j)), ("single", band.astype(np.float32))]:
        for kind in ["csr", "csc", "coo", "bsr", "dia"]:
            blocks = {"blocksize": (2, 3)} if kind == "bsr" else {}
            made = getattr(sp, f"{kind}_array")(sp.csr_array(value), **blocks) if blocks else sp.csr_array(value).asformat(kind)
            for compressed in [True, False]:
                file = f"sparse_{name}_{kind}{'_plain' * (not compressed)}"
                sp.save_npz(folder / f"{file}.npz", made, compressed=compressed)
                expect(file, {"": made})
    # Twice the same entry, long indices, and numbers of another kind.
    twice = sp.coo_matrix((np.array([1, 2, 4]), (np.array([0, 0, 1], dtype=np.int64), [1, 1, 0])), shape=(2, 3))
    sp.save_npz(folder / "sparse_twice.npz", twice)
    expect("sparse_twice", {"": twice})


def matlab():
    named = {
        "K": sp.csc_matrix(band),
        "full": band,
        "wide": sp.csc_matrix(wide),
        "Z": sp.csc_matrix(wide * (2 - 1j)),
        "Zfull": wide * 1j,
        "single": band.astype(np.float32),
        "whole": whole,
        "bytes": np.array([[1, 2], [0, 255]], dtype=np.uint8),
        "doubles": np.array([[1.0, 0.0], [200.0, -3.0]]),
        "flags": np.array([[True, False]]),
        "empty": np.zeros((0, 3)),
        "nothing": sp.csc_matrix((3, 2)),
    }
    structure = {"K": sp.csc_matrix(band), "M": wide, "long_name_of_a_matrix_in_a_structure": whole}
    expected = named | {f"model.{key}": value for key, value in structure.items()}
    for compressed in [True, False]:
        file = f"matlab{'_packed' * compressed}"
        content = named | {"model": structure}
        io.savemat(folder / f"{file}.mat", content, do_compression=compressed, long_field_names=True)
        expect(file, expected)


def read_ours():
    """Files written by us, beside them what is in them."""
    count = 0
    for path in sorted(folder.glob("ours.*.mtx")):
        name = path.name.split(".")[1]
        for found in (sp.load_npz(folder / f"ours.{name}.npz"), io.loadmat(folder / "ours.mat")[name]):
            assert sp.issparse(found) and np.array_equal(found.toarray(), io.mmread(path).toarray()), path
            count += 1
    print("read", count)


if len(sys.argv) > 2 and sys.argv[2] == "ours":
    read_ours()
    sys.exit()
if len(sys.argv) > 2:
    (folder / "real.mat").write_bytes(Path(sys.argv[2]).read_bytes())
    expect("real", {key: value for key, value in io.loadmat(sys.argv[2]).items() if not key.startswith("__")})
else:
    dense()
    sparse()
    matlab()
print("written", *(len(list(folder.glob(f"*.{ending}"))) for ending in ["npy", "npz", "mat"]))
