"""The example of the package's README and of the project's, as it stands."""

from __future__ import annotations

import pathlib
import re

import numpy as np
import pytest

HERE = pathlib.Path(__file__)


@pytest.mark.parametrize("readme", [HERE.parents[1] / "README.md", HERE.parents[3] / "README.md"])
def test_the_example_runs_and_finds_the_truth(readme, capsys):
    (code,) = re.findall(r"```python\n(.*?)```", readme.read_text(), flags=re.DOTALL)
    names: dict[str, object] = {}
    exec(compile(code, str(readme), "exec"), names)
    found = names["found"]
    assert found.trusted > 0.9
    np.testing.assert_allclose(found.factor[found.ok], 1000 * (1 + 0.03j), rtol=1e-5)
    # The first line counts the answers by their status.
    count = re.search(r"\b(\d+) ok\b", capsys.readouterr().out.splitlines()[0])
    assert count and int(count[1]) == np.count_nonzero(found.ok) > 180
