"""The notebooks: stored without outputs, and in the long tier run from their top to their end."""

from __future__ import annotations

import json
import os
import pathlib

import pytest

import frfit

NOTEBOOKS = sorted((pathlib.Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))
SECONDS = 60
"""What one may take on a computer that has nothing else to do; a busy one gets ten times as long."""


def test_there_are_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["batch-of-specimens", "impacts-to-moduli", "plate-from-scikit-fem"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_outputs(path):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(code) > 5 and notebook["nbformat"] == 4
    for cell in code:
        assert cell["outputs"] == [] and cell["execution_count"] is None
        compile("".join(cell["source"]), path.name, "exec")
    # One sentence that says what it is, in the first cell.
    assert "".join(notebook["cells"][0]["source"]).startswith("# ")


@pytest.mark.skipif("FRFIT_LONG" not in os.environ, reason="the long tier: FRFIT_LONG=1")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed")
    pytest.importorskip("matplotlib")
    if "scikit-fem" in path.stem:
        pytest.importorskip("skfem", reason="scikit-fem is not installed")
    if "batch" in path.stem:
        pytest.importorskip("pandas")
    # The kernel is a process of its own, which has to find this package.
    package = str(pathlib.Path(frfit.__file__).parents[1])
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([package, os.environ.get("PYTHONPATH", "")]))
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(
        notebook,
        timeout=10 * SECONDS,
        startup_timeout=10 * SECONDS,
        kernel_name="python3",
        resources={"metadata": {"path": str(tmp_path)}},
    ).execute()
    shown = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert not any(output.output_type == "error" for output in shown)
    pictures = [output for output in shown if "image/png" in output.get("data", {})]
    pages = [output for output in shown if "text/html" in output.get("data", {})]
    assert pictures and pages
