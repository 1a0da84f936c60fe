"""What a user writes, for the type checker: test_types.py runs `mypy --strict` on it, and it runs."""

from __future__ import annotations

import pathlib
import tempfile

import numpy as np

import frfit


def chain(factor: complex | frfit.Law) -> frfit.Model:
    stiffness = np.array([[2.0, -1.0], [-1.0, 1.0]])
    terms = [frfit.Term("springs", stiffness, factor=factor), frfit.Term("mass", 0.01 * np.eye(2), role="mass")]
    return frfit.Model(terms, attached=[frfit.Attached(1, mass=1e-4)])


def main() -> None:
    f = np.linspace(5.0, 60.0, 30)
    exact = frfit.respond(chain(1000 * (1 + 0.03j)), f, load=0, sensors=[0, 1])
    measured = [frfit.Measurement(f, exact[:, k], row=k, quantity="receptance") for k in (0, 1)]
    found: frfit.Identification = frfit.identify(
        chain(frfit.Law.constant(1200.0)),
        measured,
        load=0,
        unknowns=[frfit.Unknown("springs", matrix="springs", varies="smooth")],
        model_error={"frequency": "0.1 %", "shape": 0.01},
        exclude_hz=[20.0, (30.0, 31.0)],
    )
    storage: float = float(found["springs"].storage[found.ok].mean())
    names: tuple[str, ...] = tuple(one.name for one in found.unknowns)
    share: float = found.trusted
    print(storage, names, share, [finding.what for finding in found.findings])

    path = pathlib.Path(tempfile.mkdtemp()) / "frf.uff"
    at = frfit.UffFunction(
        f, exact[:, 1], frfit.UffDof.of("2+Z"), frfit.UffDof.of("1+Z"), ordinate_axis=frfit.UffAxis(8)
    )
    frfit.write_uff(path, at)
    again: list[frfit.Measurement] = frfit.Measurement.from_uff(path, {"2+Z": 1})
    print(again[0].quantity, frfit.read_uff(path).datasets[0].points)

    step = 1 / 512
    force = np.zeros(512)
    force[10:14] = 1.0
    hammered = frfit.frf(frfit.Recording(step, force, 2.0 * force), estimator="h1")
    (sensor,) = hammered.measurements(1, quantity="accelerance")
    print(sensor.row, hammered.averages)


if __name__ == "__main__":
    main()
