"""Types: a user's script passes `mypy --strict`, and a wrong one does not."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys

import pytest

import frfit

HERE = pathlib.Path(__file__).parent
PACKAGE = pathlib.Path(frfit.__file__).parent

WRONG = """import numpy as np
import frfit
f = np.linspace(1.0, 2.0, 3)
frfit.Measurement(f, f, row="7")
frfit.Measurement(f, f, row=7, quantity="acceleration")
frfit.Measurement(f, f, row=7, colour=3)
frfit.Term("k", np.eye(2), role="damping")
frfit.identify(frfit.Model([]), [], load=0, matrix="k", method="magic")
frfit.identify(frfit.Model([]), [], load=0).storge
frfit.Unknown("a", matrix="k", varies="sometimes")
frfit.read_uff("a").function("b")
x: int = frfit.collect("store")
"""


def checked(script: pathlib.Path, cache: pathlib.Path) -> subprocess.CompletedProcess[str]:
    environment = dict(os.environ)
    if "site-packages" not in PACKAGE.parts:
        environment["MYPYPATH"] = str(PACKAGE.parent)
    # Types of NumPy are followed, its own code is not checked.
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", str(cache), str(script)]
    return subprocess.run(command, capture_output=True, encoding="utf-8", env=environment, cwd=script.parent)


def test_a_users_script_is_typed_strictly(tmp_path, tmp_path_factory):
    pytest.importorskip("mypy")
    script = tmp_path / "script.py"
    script.write_text((HERE / "user_script.py").read_text(encoding="utf-8"), encoding="utf-8")
    cache = tmp_path_factory.mktemp("mypy")
    right = checked(script, cache)
    assert (right.returncode, right.stdout) == (0, ""), right.stdout
    script.write_text(WRONG, encoding="utf-8")
    wrong = checked(script, cache)
    lines = {int(line.split(":")[1]) for line in wrong.stdout.splitlines() if ": error:" in line}
    # Each of them, and nothing else.
    assert lines == set(range(4, WRONG.count("\n") + 1)), wrong.stdout


def test_the_script_runs(capsys):
    names: dict[str, object] = {"__name__": "script"}
    exec(compile((HERE / "user_script.py").read_text(encoding="utf-8"), "user_script.py", "exec"), names)
    names["main"]()  # type: ignore[operator]
    assert "('springs',)" in capsys.readouterr().out


def test_every_public_name_is_in_the_package_and_typed():
    assert (PACKAGE / "py.typed").is_file()
    for name in frfit.__all__:
        assert hasattr(frfit, name), name
    public = {name for name in vars(frfit) if not name.startswith("_")}
    modules = {name for name in public if type(getattr(frfit, name)).__name__ == "module"}
    assert public - modules <= set(frfit.__all__)
