"""The results of an identification as one HTML page."""

from __future__ import annotations

import os
import pathlib

from . import _frfit


class Report:
    """The page of a folder that ``frfit identify --out`` or ``run_case(case, out)`` has written.

    One file that needs no network: verdict, plots, table, inputs with checksums. It is that of ``frfit report``, byte
    for byte; a notebook shows it as it is.

    Parameters
    ----------
    folder
        The folder with the results.

    Raises
    ------
    InputError
        What is missing in the folder, or is not what this version writes.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = pathlib.Path(folder)
        self.html: str = _frfit.report(folder)

    def save(self, path: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Writes the page, without ``path`` as ``report.html`` beside the results, and returns where."""
        target = self.folder / "report.html" if path is None else pathlib.Path(path)
        target.write_bytes(self.html.encode())
        return target

    def __repr__(self) -> str:
        return f"<frfit.Report of {self.folder}: {len(self.html) / 1e6:.1f} MB>"
