"""What several tests share."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
import scipy.sparse as sp

import frfit

WORKSPACE = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def cli() -> pathlib.Path:
    """The command line of the same sources: FRFIT_CLI, as `cargo xtask test` sets it."""
    named = os.environ.get("FRFIT_CLI")
    found = pathlib.Path(named) if named else WORKSPACE / "target/debug/frfit"
    if not found.is_file():
        pytest.skip("no binary frfit: set FRFIT_CLI, or build it")
    return found


@pytest.fixture(scope="session")
def rubber_bar(cli: pathlib.Path, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The complete case `rubber-bar`, its modulus known."""
    folder = tmp_path_factory.mktemp("rubber") / "bar"
    subprocess.run([cli, "example", "rubber-bar", folder], check=True, capture_output=True)
    return folder / "case.toml"


@pytest.fixture(scope="session")
def sandwich(cli: pathlib.Path, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The folder of the complete case `sandwich`."""
    folder = tmp_path_factory.mktemp("sandwich") / "s"
    subprocess.run([cli, "example", "sandwich", folder], check=True, capture_output=True)
    return folder


def same_columns(ours: frfit.Identification, theirs: frfit.Identification) -> None:
    """Bit for bit."""
    for name, column in ours.columns().items():
        np.testing.assert_array_equal(column, theirs.columns()[name], err_msg=name)


class Chain:
    """Masses on springs: stiffness, mass and viscous matrices as SciPy has them."""

    def __init__(self, n: int = 12) -> None:
        ones = np.ones(n)
        self.n = n
        self.stiffness = sp.diags_array([2 * ones, -ones[1:], -ones[1:]], offsets=[0, 1, -1], format="csc")
        self.mass = sp.csc_array(np.diag(np.linspace(0.01, 0.02, n)))
        self.viscous = sp.csc_array(np.diag(0.02 * ones))

    def model(self, factor: complex | frfit.Law) -> frfit.Model:
        return frfit.Model(
            [
                frfit.Term("springs", self.stiffness, factor=factor),
                frfit.Term("dashpots", self.viscous, role="viscous"),
                frfit.Term("mass", self.mass, role="mass"),
            ]
        )

    def direct(self, factor: complex, f: float, load: int) -> np.ndarray:
        """The response by SciPy's sparse LU: the independent oracle."""
        omega = 2 * np.pi * f
        dynamic = factor * self.stiffness + 1j * omega * self.viscous - omega**2 * self.mass
        force = np.zeros(self.n, dtype=complex)
        force[load] = 1.0
        return sp.linalg.spsolve(dynamic.tocsc(), force)


@pytest.fixture
def chain() -> Chain:
    return Chain()


def measured_chain(frequency_hz: np.ndarray) -> list[frfit.Measurement]:
    """A chain of stiffness 1000 and loss factor 0.03, with 1 % of noise."""
    exact = frfit.respond(Chain().model(1000 * (1 + 0.03j)), frequency_hz, load=0, sensors=[6, 11])
    random = np.random.default_rng(3)
    std = 0.01 * np.abs(exact)
    exact = exact + std * (random.normal(size=exact.shape) + 1j * random.normal(size=exact.shape)) / np.sqrt(2)
    return [frfit.Measurement(frequency_hz, exact[:, k], row, std=std[:, k]) for k, row in enumerate((6, 11))]


def copied(case: pathlib.Path, to: pathlib.Path) -> pathlib.Path:
    """The case in a folder of its own."""
    shutil.copytree(case.parent, to)
    return to / case.name
