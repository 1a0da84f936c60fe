"""scipy.optimize.least_squares on direct solves: the core's law, the skins' modulus, the core's density.

Arguments: the folder with task.json and the matrices, and what to do: "differences" fits with least_squares' own slopes, "slopes" with
exact ones from one factorisation for all of them, "solve" times one factorisation with its solve. Prints JSON.
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
factorisations = 0


def response(theta, with_slopes=False):
    """Receptance at the sensors, and its slopes by theta: one sparse LU for each frequency."""
    global factorisations
    e0, e1, alpha = np.exp(theta[0]), np.exp(theta[1]), 1 / (1 + np.exp(-theta[2]))
    power = (1j * omega / reference) ** alpha
    modulus = e0 + e1 * power
    skins_modulus = np.exp(theta[3]) * (1 + 1j * theta[4])
    density = np.exp(theta[5])
    of_theta = [
        e0 * np.ones_like(power),
        e1 * power,
        e1 * power * np.log(1j * omega / reference) * alpha * (1 - alpha),
    ]
    x = np.empty_like(measured)
    slopes = np.empty((*measured.shape, 6), dtype=complex)
    for i, (w, e) in enumerate(zip(omega, modulus)):
        mass = density * core_mass + task["skins_density"] * skins_mass
        stiffness = (e * core + skins_modulus * skins - w**2 * mass).tocsc()
        # the ordering for symmetric patterns: COLAMD takes three times as long here
        factor = spla.splu(stiffness, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        factorisations += 1
        y = factor.solve(load)
        x[i] = sensors @ y
        if with_slopes:
            of_core, of_skins, of_mass = (
                -(sensors @ factor.solve(change))
                for change in (core @ y, skins @ y, -(w**2) * density * (core_mass @ y))
            )
            for k, of in enumerate(of_theta):
                slopes[i, :, k] = of_core * of[i]
            slopes[i, :, 3] = of_skins * skins_modulus
            slopes[i, :, 4] = of_skins * 1j * np.exp(theta[3])
            slopes[i, :, 5] = of_mass
    return x, slopes


def parts(values):
    """Real parts above imaginary parts, relative to what was measured."""
    rest = values.reshape(measured.size, -1) / np.abs(measured).reshape(-1, 1)
    return np.concatenate([rest.real, rest.imag])


def residuals(theta):
    return parts(response(theta)[0] - measured).ravel()


def jacobian(theta):
    return parts(response(theta, with_slopes=True)[1])


start = np.array(task["start"])
begun = time.process_time()
if what == "solve":
    omega, measured = omega[-1:], measured[-1:]
    response(start)
    print(json.dumps({"seconds": time.process_time() - begun}))
else:
    slopes = jacobian if what == "slopes" else "2-point"
    found = scipy.optimize.least_squares(
        residuals, start, slopes, x_scale="jac", xtol=1e-12, ftol=1e-12, gtol=1e-12
    )
    seconds = time.process_time() - begun
    print(json.dumps({"theta": list(found.x), "factorisations": factorisations, "seconds": seconds}))
