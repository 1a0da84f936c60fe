"""Modes of a case, against the command line and SciPy."""

from __future__ import annotations

import json
import subprocess

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp

import frfit


@pytest.fixture(scope="module")
def plate(cli, tmp_path_factory):
    """The case `two-meshes`, with three sensors."""
    folder = tmp_path_factory.mktemp("plate") / "plate"
    subprocess.run([cli, "example", "two-meshes", folder], check=True, capture_output=True)
    return folder / "case.toml"


def test_modes_are_those_of_the_command_line(cli, plate, tmp_path):
    found = frfit.modes(plate, tmp_path / "out")
    said = subprocess.run([cli, "--json", "modes", plate], check=True, capture_output=True).stdout
    said = json.loads(said)
    own, theirs = said["model"]["modes"], said["measured"]["modes"]
    np.testing.assert_array_equal(found.frequency_hz, [mode["frequency_hz"] for mode in own])
    np.testing.assert_array_equal(found.damping_ratio, [mode["damping_ratio"] for mode in own])
    np.testing.assert_array_equal(found.measured_frequency_hz, [mode["frequency_hz"] for mode in theirs])
    np.testing.assert_array_equal(
        found.measured_damping_ratio_std, [mode["damping_ratio_std"] for mode in theirs]
    )
    pairs = said["measured"]["pairs"]
    assert len(pairs) > 2
    np.testing.assert_array_equal(found.pairs, [[pair["model"] - 1, pair["measured"] - 1] for pair in pairs])
    np.testing.assert_array_equal(found.mac, [np.nan if pair["mac"] is None else pair["mac"] for pair in pairs])
    assert found.stiffness_factor == said["measured"]["stiffness_factor"]
    model, measured = found.pairs.T
    np.testing.assert_allclose(
        found.frequency_difference, found.frequency_hz[model] / found.measured_frequency_hz[measured] - 1
    )
    assert found.measured_shape.shape == (len(theirs), len(found.sensors))
    # The files are those of the command line.
    assert json.loads((tmp_path / "out/modes.json").read_text())["measured"]["pairs"] == pairs
    assert f"{len(own)} of the model" in repr(found)


def test_modes_of_a_chain_are_those_of_scipy(tmp_path):
    n = 5
    stiffness = 1e4 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    mass = np.diag(np.linspace(0.01, 0.02, n))
    for name, matrix in [("K", stiffness), ("M", mass)]:
        sp.save_npz(tmp_path / f"{name}.npz", sp.csc_array(matrix))
    (tmp_path / "case.toml").write_text(
        """
[[matrix]]
name = "springs"
role = "stiffness"
file = "K.npz"
factor = { storage = 1.0, loss_factor = 0.02 }
[[matrix]]
name = "mass"
role = "mass"
file = "M.npz"
[load]
row = 2
[[measurement]]
row = 2
[[measurement]]
row = 5
[respond]
band_hz = [1.0, 1000.0]
points = 10
"""
    )
    found = frfit.modes(tmp_path / "case.toml")
    squares, shapes = scipy.linalg.eigh(stiffness, mass)
    # With the same loss factor everywhere s² = −ω²(1 + iη), of the shapes without damping.
    poles = np.sqrt(-squares * (1 + 0.02j))
    np.testing.assert_allclose(found.frequency_hz, np.abs(poles) / (2 * np.pi), rtol=1e-9)
    np.testing.assert_allclose(found.damping_ratio, np.abs(poles.real) / np.abs(poles), rtol=1e-6)
    np.testing.assert_allclose(np.abs(found.shape), np.abs(shapes[[1, 4]].T), rtol=1e-6, atol=1e-9)
    assert found.pairs.shape == (0, 2) and found.measured_shape.shape == (0, 2)
    assert found.stiffness_factor is None and len(found.comac) == 0


def test_a_band_without_modes_is_refused(plate):
    with pytest.raises(frfit.InputError, match="band"):
        frfit.modes(plate, band_hz=(5.0, 1.0))
