"""The pages of docs/site: their Python is run, and the page of the package is what its docstrings say."""

from __future__ import annotations

import pathlib
import re
import shlex
import subprocess
import sys

import pytest

WORKSPACE = pathlib.Path(__file__).resolve().parents[3]
PAGES = WORKSPACE / "docs/site/src"
BLOCK = re.compile(r"^```(console|python)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)


def pages_with_python() -> list[str]:
    return sorted(page.name for page in PAGES.glob("*.md") if "```python" in page.read_text(encoding="utf-8"))


def test_there_is_python_on_the_site():
    assert pages_with_python()


@pytest.mark.parametrize("name", pages_with_python())
def test_the_code_of_a_page_runs(name, cli, tmp_path, monkeypatch):
    """From the top to the end in one folder; commands too, whose words crates/cli/tests/book.rs compares."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for language, code in BLOCK.findall((PAGES / name).read_text(encoding="utf-8")):
        if language == "python":
            exec(compile(code, name, "exec"), names)
            continue
        for line in code.splitlines():
            if line.startswith("$ frfit "):
                subprocess.run([cli, *shlex.split(line)[2:]], check=True, capture_output=True)


def test_the_page_of_the_package_is_what_its_docstrings_say():
    made = subprocess.run(
        [sys.executable, WORKSPACE / "crates/python/reference.py"], check=True, capture_output=True, encoding="utf-8"
    )
    page = (PAGES / "python-api.md").read_text(encoding="utf-8")
    assert made.stdout == page, "renew it: python crates/python/reference.py > docs/site/src/python-api.md"
