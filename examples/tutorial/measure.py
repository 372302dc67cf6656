"""Stands in for a laboratory: two aluminium beams with one bolt, measured as new and after 500 load cycles.

Nothing of bolted-joint computes here. Beams are finite elements (cubic, Euler-Bernoulli), the joint is a spring and a
damper between two of their nodes, and all of it is solved as one structure. Every function has 1 % of noise.

    python measure.py [folder]

writes new.csv and after-500.csv. Needs NumPy.
"""

import sys
from pathlib import Path

import numpy as np

WIDTH, HEIGHT, YOUNG, DENSITY = 0.025, 0.006, 70e9, 2700.0
# damping of the material: hysteretic, twice the damping ratio
LOSS = {"a": 0.004, "b": 0.004}
LENGTH = {"a": 0.300, "b": 0.222}
STEP = 0.003
FREQUENCY = np.arange(20.0, 600.5, 2.0)
NOISE = 0.01

#: What nobody in a laboratory knows: the joint as new, and after 500 cycles. N/m, N/rad, N·m/rad and with s.
JOINTS = {
    "new": ([[5.7e5, 5.8e3], [5.8e3, 1290.0]], [[11.0, 0.0], [0.0, 0.08]]),
    "after-500": ([[5.2e5, 5.3e3], [5.3e3, 1230.0]], [[16.0, 0.0], [0.0, 0.11]]),
}


def beam(name):
    """Mass and complex stiffness over w and θ of nodes every three millimetres."""
    count = round(LENGTH[name] / STEP)
    mass, stiffness = np.zeros((2, 2 * count + 2, 2 * count + 2))
    h, area = STEP, WIDTH * HEIGHT
    bending = YOUNG * WIDTH * HEIGHT**3 / 12
    k = bending / h**3 * np.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2], [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]
    )
    m = DENSITY * area * h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2], [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h**2, -22 * h, 4 * h**2]]
    )
    for element in range(count):
        at = slice(2 * element, 2 * element + 4)
        mass[at, at] += m
        stiffness[at, at] += k
    return mass, stiffness * (1 + 1j * LOSS[name])


def w(x):
    """Place of the deflection at x among a beam's coordinates."""
    return 2 * round(x / STEP)


def receptances(mass, stiffness, damping, places):
    """Displacement over force between these places: by the modes would be faster, but one solution a line is plainer."""
    loads = np.zeros((len(mass), len(places)))
    loads[places, range(len(places))] = 1.0
    omega = 2 * np.pi * FREQUENCY
    return np.array([np.linalg.solve(stiffness + 1j * o * damping - o**2 * mass, loads)[places] for o in omega])


def measured(exact, rng):
    """With noise in proportion to each value."""
    real, imaginary = rng.standard_normal((2, *exact.shape))
    return exact * (1 + NOISE * (real + 1j * imaginary) / np.sqrt(2))


def write(path, names, values):
    pairs = [(p, q) for p in range(len(names)) for q in range(len(names))]
    columns = [FREQUENCY]
    head = ["frequency [Hz]"]
    for p, q in pairs:
        head += [f"{names[p]}/{names[q]} receptance {part} [m/N]" for part in ("real", "imaginary")]
        columns += [values[:, p, q].real, values[:, p, q].imag]
    np.savetxt(path, np.column_stack(columns), fmt="%.8g", delimiter=",", header=",".join(head), comments="")


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    rng = np.random.default_rng(500)
    (mass_a, stiffness_a), (mass_b, stiffness_b) = beam("a"), beam("b")
    # a is clamped at its first end
    mass_a, stiffness_a = mass_a[2:, 2:], stiffness_a[2:, 2:]
    size_a, size = len(mass_a), len(mass_a) + len(mass_b)
    mass, stiffness = np.zeros((size, size)), np.zeros((size, size), complex)
    mass[:size_a, :size_a], mass[size_a:, size_a:] = mass_a, mass_b
    stiffness[:size_a, :size_a], stiffness[size_a:, size_a:] = stiffness_a, stiffness_b
    bolt = [w(0.285) - 2, w(0.285) - 1, size_a + w(0.015), size_a + w(0.015) + 1]
    apart = np.hstack([np.eye(2), -np.eye(2)])
    far = [size_a + w(x) for x in (0.192, 0.207, 0.222)]
    for name, (k, c) in JOINTS.items():
        with_bolt, damping = stiffness.copy(), np.zeros((size, size))
        with_bolt[np.ix_(bolt, bolt)] += apart.T @ np.array(k) @ apart
        damping[np.ix_(bolt, bolt)] += apart.T @ np.array(c) @ apart
        exact = receptances(mass, with_bolt, damping, far)
        write(folder / f"{name}.csv", ["11:+Y", "12:+Y", "13:+Y"], measured(exact, rng))


if __name__ == "__main__":
    main()
