"""Universal files of FRFs with frfit and with pyuff: the same values, and how long each takes.

    python crates/python/benches/against_pyuff.py [--megabytes 1000] [--binary] [--read 20]

pyuff lists the records when it opens a file; `--read` of them are then read with both and compared, in text to the digits of
the format.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import tempfile
import time

import numpy as np
import pyuff

import frfit

POINTS = 16384


def write(path: pathlib.Path, megabytes: float, binary: bool) -> int:
    """One FRF, again and again."""
    random = np.random.default_rng(0)
    values = random.normal(size=POINTS) + 1j * random.normal(size=POINTS)
    one = frfit.UffFunction(
        np.arange(POINTS) * 0.5, values, even=(0.0, 0.5), response_dof=frfit.UffDof(34, 3), id=("bench",)
    )
    frfit.write_uff(path, one, binary=binary)
    record = path.read_bytes()
    count = max(1, round(megabytes * 1e6 / len(record)))
    with path.open("wb") as out:
        for _ in range(count):
            out.write(record)
    return count


def timed(call):
    start = time.perf_counter()
    result = call()
    return result, time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--megabytes", type=float, default=1000.0)
    parser.add_argument("--binary", action="store_true")
    parser.add_argument("--read", type=int, default=20)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "large.uff"
        count = write(path, arguments.megabytes, arguments.binary)
        kind = "58b" if arguments.binary else "58"
        print(f"{os.path.getsize(path) / 1e6:.0f} MB, {count} functions ({kind}) of {POINTS} points")
        path.read_bytes()  # in the page cache for both
        read = np.linspace(0, count - 1, min(arguments.read, count)).astype(int)

        def ours_listed():
            file = frfit.read_uff(path)
            assert len(file.datasets) == count
            return file

        ours, list_ours = timed(ours_listed)
        mine, read_ours = timed(lambda: [ours.function(int(index)) for index in read])

        def theirs_listed():
            file = pyuff.UFF(str(path))
            assert len(file.get_set_types()) == count
            return file

        theirs, list_theirs = timed(theirs_listed)
        other, read_theirs = timed(lambda: [theirs.read_sets(int(index)) for index in read])
        for a, b in zip(mine, other, strict=True):
            np.testing.assert_allclose(a.values, b["data"], rtol=1e-14)
            np.testing.assert_allclose(a.abscissa, b["x"], rtol=1e-6)
        print("|                     | frfit (s) | pyuff (s) | times |")
        print("|---------------------|-----------|-----------|-------|")
        for name, a, b in [
            ("list all records", list_ours, list_theirs),
            (f"read {len(read)} of them", read_ours, read_theirs),
            ("both", list_ours + read_ours, list_theirs + read_theirs),
        ]:
            print(f"| {name:<19} | {a:9.3f} | {b:9.3f} | {b / a:5.1f} |")


if __name__ == "__main__":
    main()
