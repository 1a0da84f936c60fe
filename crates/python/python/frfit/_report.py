"""The results of an identification as one HTML page."""

from __future__ import annotations

import os
import pathlib

from . import _frfit
from ._shown import escaped

_LARGEST = 8_000_000
"""Characters of a page that a notebook shows as it is; the scripts of the plots are 1.5 million of them."""


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

    def _repr_html_(self) -> str:
        """The page in a frame of its own; of a large one a link to the file."""
        if len(self.html) > _LARGEST:
            saved = self.folder / "report.html"
            said = f"{len(self.html) / 1e6:.1f} MB, too large for a notebook"
            if not saved.is_file():
                return f"<p>The report has {said}: write it with <code>.save()</code>.</p>"
            return f'<p>The report has {said}: <a href="{escaped(saved.resolve().as_uri())}">{escaped(saved)}</a></p>'
        style = "width:100%;height:640px;border:1px solid #ccc"
        return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{escaped(self.html)}"></iframe>'

    def __repr__(self) -> str:
        return f"<frfit.Report of {self.folder}: {len(self.html) / 1e6:.1f} MB>"
