"""scipy.optimize.least_squares on direct solves: the core's law, the skins' modulus, the core's density.

Arguments: the folder with task.json and the matrices, and "fit" or "solve" (one direct solve, timed). Prints JSON.
"""

import json
import sys
import time

import numpy as np
import scipy.io
import scipy.optimize
import scipy.sparse as sp
import scipy.sparse.linalg as spla

folder, what = sys.argv[1:]
with open(f"{folder}/task.json") as file:
    task = json.load(file)
core, skins, core_mass, skins_mass = (
    scipy.io.mmread(f"{folder}/{name}.mtx").tocsc() for name in ("core", "skins", "core-mass", "skins-mass")
)
omega = 2 * np.pi * np.array(task["frequency_hz"])
measured = np.array([[complex(*u) for u in row] for row in task["measured"]])
load = np.array([complex(*f) for f in task["load"]])
sensors = np.array([complex(*v) for row in task["sensors"] for v in row]).reshape(len(task["sensors"]), -1)
reference = omega[len(omega) // 2]
solves = 0


def response(theta):
    """Receptance at the sensors, one sparse LU for each frequency."""
    global solves
    e0, e1, alpha = np.exp(theta[0]), np.exp(theta[1]), 1 / (1 + np.exp(-theta[2]))
    modulus = e0 + e1 * (1j * omega / reference) ** alpha
    skins_modulus = np.exp(theta[3]) * (1 + 1j * theta[4])
    density = np.exp(theta[5])
    x = np.empty_like(measured)
    for i, (w, e) in enumerate(zip(omega, modulus)):
        mass = density * core_mass + task["skins_density"] * skins_mass
        stiffness = (e * core + skins_modulus * skins - w**2 * mass).tocsc()
        # the ordering for symmetric patterns: COLAMD takes three times as long here
        factor = spla.splu(stiffness, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        x[i] = sensors @ factor.solve(load)
        solves += 1
    return x


def residuals(theta):
    rest = ((response(theta) - measured) / np.abs(measured)).ravel()
    return np.concatenate([rest.real, rest.imag])


start = np.array(task["start"])
begun = time.process_time()
if what == "solve":
    omega, measured = omega[-1:], measured[-1:]
    response(start)
    print(json.dumps({"seconds": time.process_time() - begun}))
else:
    found = scipy.optimize.least_squares(residuals, start, x_scale="jac", xtol=1e-12, ftol=1e-12, gtol=1e-12)
    seconds = time.process_time() - begun
    print(json.dumps({"theta": list(found.x), "cost": found.cost, "solves": solves, "seconds": seconds}))
