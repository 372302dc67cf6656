"""Backbones of a relative motion with noise, and the joints that fit them best with SciPy, free and passive."""

import pathlib

import numpy as np
from scipy.optimize import least_squares, minimize

MASS = 1.0
LARGEST_M = 3e-4
FARTHEST = LARGEST_M**2
NOISE = 1e-4, 0.03
# k12, c12, k3, c2, c4
SCALE = np.array([5e5, 1.0, 1e11, 1 / FARTHEST, 1 / FARTHEST**2])
CASES = {
    "dips": (3, [1, 3.2, -2, -16, 20]),
    "fades": (1, [1, 2, -2, -2, 0]),
    "feeds": (1, [1, 2, -2, -4, 0]),
}


def stiffness_and_damping(x, amplitude):
    k, c, k3, c2, c4 = x * SCALE
    # describing functions of one harmonic
    return k + 0.75 * k3 * amplitude**2, c + 0.25 * c2 * amplitude**2 + 0.125 * c4 * amplitude**4


def made(path, seed, truth):
    random = np.random.default_rng(seed)
    amplitude = LARGEST_M * np.arange(1, 25) / 24
    stiffness, damping = stiffness_and_damping(truth, amplitude)
    omega = np.sqrt(stiffness / MASS)
    hz = omega / 2 / np.pi * np.exp(NOISE[0] * random.standard_normal(24))
    ratio = damping / (2 * MASS * omega) * np.exp(NOISE[1] * random.standard_normal(24))
    rows = [f"{row[0]:.9e},{row[1]:.9e},{row[2]:.9e}" for row in zip(hz, amplitude, ratio)]
    path.write_text("frequency_hz,displacement_m,damping_ratio\n" + "\n".join(rows) + "\n")


def residuals(x, data):
    hz, amplitude, ratio = data.T
    omega = 2 * np.pi * hz
    stiffness, damping = stiffness_and_damping(x, amplitude)
    of_frequency = np.log(omega) - 0.5 * np.log(np.maximum(stiffness, 1e-12) / MASS)
    of_ratio = np.log(ratio) - np.log(np.maximum(damping, 1e-12) / (2 * MASS * omega))
    return np.concatenate([of_frequency / NOISE[0], of_ratio / NOISE[1]])


def places(x):
    """u/U of the ends, and about the minimum between."""
    dip = -x[3] / 2 / x[4] if x[4] > 0 else -1
    return np.array([0, 1] + ([dip - 1e-5, dip, dip + 1e-5] if 0 < dip < 1 else []))


def passive(data, start):
    x = np.array(start)
    at = np.linspace(0, 1, 2001)
    for _ in range(30):
        limit = {"type": "ineq", "fun": lambda x, at=at: x[1] + x[3] * at + x[4] * at**2}
        found = minimize(
            lambda x: np.sum(residuals(x, data) ** 2), x, method="SLSQP",
            constraints=[limit], options={"maxiter": 2000, "ftol": 1e-15},
        )
        x, at = found.x, places(found.x)
    return found


if __name__ == "__main__":
    for name, (seed, truth) in CASES.items():
        path = pathlib.Path(__file__).with_name(f"damping-that-{name}.csv")
        made(path, seed, np.array(truth))
        data = np.loadtxt(path, delimiter=",", skiprows=1)
        free = least_squares(residuals, truth, args=(data,), xtol=1e-15, ftol=1e-15, gtol=1e-15)
        starts = [[1, 1, -2, 0, 0], [1, 2, -2, -1, 1], truth]
        best = min((passive(data, start) for start in starts), key=lambda found: found.fun)
        print(f"{name}: free {2 * free.cost:.8f}, passive {best.fun:.8f}")
        print("  ", ", ".join(f"{value:.9e}" for value in best.x * SCALE))
