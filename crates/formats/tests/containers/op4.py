"""Writes OUTPUT4 files with pyYeti, pyNastran and by hand into a folder, and what is in them as Matrix Market files.

NAME.op4 has the matrices NAME.MATRIX.mtx. What is written by hand is first read by pyYeti to the same numbers.
"""

import struct
import sys
import warnings
from pathlib import Path

import numpy as np
import scipy.io as io
import scipy.sparse as sp
from pyNastran.op4.op4 import OP4 as PyNastran
from pyyeti.nastran import op4 as pyyeti

folder = Path(sys.argv[1])
n = 5
k = np.arange(n)
band = np.diag(2.0 + np.sqrt(k + 2.0)) - np.diag(np.sqrt(k[1:] + 5.0), 1) - np.diag(np.sqrt(k[1:] + 5.0), -1)
gap = np.zeros((7, 4))  # columns of several strings, one of none; no exponents of three digits, for which pyYeti leaves no room
gap[[0, 1, 4, 6], 0] = [1.5, -2.25e-91, 1 / 3, 7e12]
gap[[2, 3], 1] = [-1.0, 1e60]
gap[[0, 6], 3] = [np.pi, -np.e]
MATRICES = {
    "KAA": (6, band),
    "GAP": (2, gap),
    "ZAA": (6, band * (1 + 0.02j)),
    "ZGAP": (2, gap * (0.5 - 1j)),
    "NULL": (2, np.zeros((3, 2))),
}


def expect(name, matrices):
    """The matrices that a file must give."""
    for matrix, value in matrices.items():
        value = value.astype(complex if np.iscomplexobj(value) else float)
        io.mmwrite(folder / f"{name}.{matrix}.mtx", sp.coo_array(value), symmetry="general", precision=17)


def all_of_pyyeti():
    names, forms = list(MATRICES), [form for form, _ in MATRICES.values()]
    values = [value for _, value in MATRICES.values()]
    for sparse in ["dense", "bigmat", "nonbigmat"]:
        for name, options in [
            ("text", {"binary": False, "digits": 16}),
            ("text9", {"binary": False, "digits": 9}),
            ("little", {"binary": True, "endian": "<"}),
            ("big", {"binary": True, "endian": ">"}),
        ]:
            file = f"yeti_{sparse}_{name}"
            pyyeti.write(folder / f"{file}.op4", names, values, sparse=sparse, forms=forms, **options)
            expected = MATRICES
            if name == "text9":  # what is left of ten digits
                expected = pyyeti.load(folder / f"{file}.op4", into="dct", justmatrix=True)
                expected = {key.upper(): (0, value) for key, value in expected.items()}
            expect(file, {key: value for key, (_, value) in expected.items()})


def all_of_pynastran():
    single = {"float64": np.float32, "complex128": np.complex64}
    for precision in ["single", "double"]:
        chosen = MATRICES
        if precision == "single":
            chosen = {
                key: (form, value.astype(single[value.dtype.name]))
                for key, (form, value) in chosen.items()
                if "GAP" not in key  # 1e60
            }
        # Dense text only: its records of binary have no lengths behind them, and several strings of a sparse column
        # are all declared as long as the column (pyNastran 1.4.1).
        file = f"nastran_{precision}"
        PyNastran().write_op4(folder / f"{file}.op4", chosen, precision=precision, is_binary=False)
        expect(file, {key: value for key, (_, value) in chosen.items()})


def by_hand(name, order, wide, bigmat, kind, form, value):
    """Sparse records with integers of 4 or 8 bytes, of any type."""
    integer, size = ("q", 8) if wide else ("i", 4)
    number = "d" if wide or kind in (2, 4) else "f"
    words = struct.calcsize(number) // size * (2 if kind > 2 else 1)
    out = b""

    def record(body):
        return struct.pack(order + "i", len(body)) + body + struct.pack(order + "i", len(body))

    rows, cols = value.shape
    label = name.encode().ljust(4) + b"    "
    label = label[:4].ljust(8) + label[4:].ljust(8) if wide else label
    out += record(struct.pack(order + 4 * integer, cols, -rows if bigmat else rows, form, kind) + label)
    for col in range(cols):
        strings = []
        for row in np.flatnonzero(value[:, col]):
            if strings and strings[-1][0] + len(strings[-1][1]) == row:
                strings[-1][1].append(value[row, col])
            else:
                strings.append((row, [value[row, col]]))
        body = b""
        for row, values in strings:
            length = words * len(values)
            head = [length + 1, row + 1] if bigmat else [row + 1 + 65536 * (length + 1)]
            body += struct.pack(order + len(head) * integer, *head)
            parts = np.array(values).view(float) if kind > 2 else values
            body += struct.pack(order + len(parts) * number, *parts)
        if strings:
            out += record(struct.pack(order + 3 * integer, col + 1, 0, len(body) // size) + body)
    body = struct.pack(order + 3 * integer, cols + 1, 1, 1) + struct.pack(order + number, 1.0)
    return out + record(body)


def all_by_hand():
    small = np.where(abs(gap) < 1e30, gap, -0.375)
    for order, endian in [("<", "little"), (">", "big")]:
        for wide in [False, True]:
            for bigmat in [False, True]:
                file = f"hand_{endian}_{'wide' if wide else 'narrow'}_{'bigmat' if bigmat else 'strings'}"
                values = {
                    "S": (1, small.astype(np.float32).astype(float)),
                    "D": (2, gap),
                    "C": (3, (small * (1 - 2j)).astype(np.complex64).astype(complex)),
                    "Z": (4, gap * (1 - 2j)),
                }
                if wide:  # both precisions are of eight bytes
                    values = {"S": (1, gap), "D": (2, gap), "C": (3, gap * 1j), "Z": (4, gap * (1 - 2j))}
                parts = [by_hand(key, order, wide, bigmat, kind, 2, v) for key, (kind, v) in values.items()]
                (folder / f"{file}.op4").write_bytes(b"".join(parts))
                read = pyyeti.load(folder / f"{file}.op4", into="dct", justmatrix=True)
                for key, (_, value) in values.items():
                    assert np.array_equal(read[key.lower()], value), (file, key)
                expect(file, {key: value for key, (_, value) in values.items()})


def read_ours():
    """Files written by us, beside them what is in them."""
    count = 0
    for file in sorted(folder.glob("ours_*.op4")):
        yeti = pyyeti.load(file, into="dct", justmatrix=True)
        theirs = PyNastran().read_op4(file)
        for path in sorted(folder.glob(f"{file.stem}.*.mtx")):
            name, value = path.name.split(".")[1], io.mmread(path)
            value = value.toarray() if sp.issparse(value) else value
            assert np.array_equal(yeti[name.lower()], value), (path, "pyYeti")
            data = theirs[name].data
            data = data.toarray() if sp.issparse(data) else data
            assert np.array_equal(data, value), (path, "pyNastran")
            count += 1
    print("read", count)


warnings.simplefilter("ignore")
if len(sys.argv) > 2:
    read_ours()
else:
    all_of_pyyeti()
    all_of_pynastran()
    all_by_hand()
    print("written", len(list(folder.glob("*.op4"))))
