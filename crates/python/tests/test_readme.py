"""The README's example, as it stands."""

from __future__ import annotations

import pathlib
import re

import numpy as np


def test_the_example_runs_and_finds_the_truth(capsys):
    readme = pathlib.Path(__file__).parents[1] / "README.md"
    (code,) = re.findall(r"```python\n(.*?)```", readme.read_text(), flags=re.DOTALL)
    names: dict[str, object] = {}
    exec(compile(code, str(readme), "exec"), names)
    found = names["found"]
    assert found.trusted > 0.9
    np.testing.assert_allclose(found.factor[found.ok], 1000 * (1 + 0.03j), rtol=1e-5)
    assert "ok" in capsys.readouterr().out
