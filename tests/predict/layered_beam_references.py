"""References for layered beams: roots and shapes in 40 digits by mpmath, finite elements by SciPy, integrals by quadrature.

Shares nothing with the program under test. Needs mpmath, numpy and scipy; writes data/layered_beam.json.
"""

import json
from pathlib import Path

import numpy as np
from mpmath import cos, cosh, diff, findroot, mp, mpf, nstr, pi, quad, sin, sinh, sqrt
from scipy.linalg import eigh

MODES = [1, 2, 3, 4, 5, 6, 10, 40]
POINTS = [mpf(k) / 16 for k in (0, 1, 3, 5, 8, 11, 14, 16)]


def shapes():
    """λ, and φ and φ' at POINTS, normalised to ∫φ² = 1, of each boundary and mode."""
    out = {}
    for name in ("fixed-fixed", "free-free", "fixed-free", "fixed-pinned", "pinned-pinned"):
        rows = []
        for mode in MODES:
            # as many digits as cancel in cosh and sinh, and forty more
            mp.dps = 40 + int(1.5 * mode)
            if name in ("fixed-fixed", "free-free"):
                root = findroot(lambda x: cos(x) - 1 / cosh(x), (mode + mpf(1) / 2) * pi)
                sigma = (cosh(root) - cos(root)) / (sinh(root) - sin(root))
                sign = -1 if name == "fixed-fixed" else 1
            elif name == "fixed-free":
                root = findroot(lambda x: cos(x) + 1 / cosh(x), (mode - mpf(1) / 2) * pi)
                sigma = (sinh(root) - sin(root)) / (cosh(root) + cos(root))
                sign = -1
            elif name == "fixed-pinned":
                root = findroot(lambda x: sin(x) - cos(x) * sinh(x) / cosh(x), (mode + mpf(1) / 4) * pi)
                sigma = cosh(root) / sinh(root)
                sign = -1
            else:
                root, sigma, sign = mode * pi, None, None

            def phi(x):
                if sigma is None:
                    return sqrt(2) * sin(root * x)
                return cosh(root * x) + sign * cos(root * x) - sigma * (sinh(root * x) + sign * sin(root * x))

            rows.append({
                "mode": mode,
                "lambda": float(nstr(root, 20)),
                "norm": float(quad(lambda x: phi(x) ** 2, [mpf(k) / (2 * mode) for k in range(2 * mode + 1)])) if mode < 7 else 1.0,
                "deflection": [float(phi(x)) for x in POINTS],
                "slope": [float(diff(phi, x)) for x in POINTS],
            })
        out[name] = rows
    mp.dps = 30
    return out


def normal_forces():
    """N/P by quadrature of the polynomial over the ring."""
    constants = {
        1.0: (["1.45e-6", "-5.80e-5", "6.04e-4", "3.09e-3", "-9.58e-2", "5.38e-1"], "4.125"),
        1.5: (["-1.74e-7", "1.40e-5", "-4.59e-4", "8.17e-3", "-8.77e-2", "4.88e-1"], "5"),
        2.0: (["-7.42e-8", "7.45e-6", "-2.98e-4", "6.22e-3", "-7.46e-2", "4.60e-1"], "5.6"),
    }
    out = {}
    for ratio, (coefficients, rim) in constants.items():
        def pressure(rho):
            return sum(mpf(a) * rho ** (10 - 2 * i) for i, a in enumerate(coefficients))

        # σ_s = P/(2.0625 π R²):  N/P = ∫ 2πρ p/σ_s dρ/(2.0625 π)
        out[ratio] = float(quad(lambda rho: 2 * rho * pressure(rho), [1, mpf(rim)]) / mpf("2.0625"))
    return out


def matrices(length, bending, mass, elements):
    """Global stiffness and mass of equal Euler-Bernoulli elements."""
    l = length / elements
    k = bending / l**3 * np.array([[12, 6 * l, -12, 6 * l], [6 * l, 4 * l * l, -6 * l, 2 * l * l],
                                   [-12, -6 * l, 12, -6 * l], [6 * l, 2 * l * l, -6 * l, 4 * l * l]])
    m = mass * l / 420 * np.array([[156, 22 * l, 54, -13 * l], [22 * l, 4 * l * l, 13 * l, -3 * l * l],
                                   [54, 13 * l, 156, -22 * l], [-13 * l, -3 * l * l, -22 * l, 4 * l * l]])
    size = 2 * (elements + 1)
    stiffness, inertia = np.zeros((size, size)), np.zeros((size, size))
    for e in range(elements):
        at = slice(2 * e, 2 * e + 4)
        stiffness[at, at] += k
        inertia[at, at] += m
    return stiffness, inertia


HELD = {
    "fixed-fixed": lambda last: [0, 1, last, last + 1],
    "fixed-pinned": lambda last: [0, 1, last],
    "pinned-pinned": lambda last: [0, last],
    "fixed-free": lambda last: [0, 1],
    "free-fixed": lambda last: [last, last + 1],
    "free-free": lambda last: [],
}


def elements():
    """Two beams, one of unlike layers: frequencies, modal mass and damping ratio at the driven node, static stiffness there."""
    cases = []
    beams = [
        # Kavi's specimen 2
        {"length": 0.43, "width": 0.04125, "layers": [[0.003, 196e9, 7850], [0.003, 196e9, 7850]], "ratio": 1.0,
         "diameter": 0.008},
        # aluminium on steel on aluminium, softened by its joints
        {"length": 0.6, "width": 0.05, "layers": [[0.003, 70e9, 2700], [0.002, 200e9, 7800], [0.003, 70e9, 2700]],
         "ratio": 0.92, "diameter": 0.006},
    ]
    forces = normal_forces()
    count = 120
    for beam in beams:
        # bending stiffness of the bonded section, by integration over its height: ∫E(z − z̄)² dA
        face = np.concatenate([[0], np.cumsum([layer[0] for layer in beam["layers"]])])
        moment = lambda power, z0: sum(layer[1] * beam["width"] * ((b - z0) ** (power + 1) - (a - z0) ** (power + 1)) / (power + 1)
                                       for layer, a, b in zip(beam["layers"], face, face[1:]))
        neutral = moment(1, 0.0) / moment(0, 0.0)
        bending = beam["ratio"] * moment(2, neutral)
        mass = beam["width"] * sum(layer[0] * layer[2] for layer in beam["layers"])
        # fasteners on nodes
        nodes = [13, 40, 66, 93, 107]
        positions = [beam["length"] * node / count for node in nodes]
        tension = 100e6 * np.pi * (beam["diameter"] / 2) ** 2
        lever = 0.0
        for a, b in zip(beam["layers"], beam["layers"][1:]):
            ratio = max(a[0], b[0]) / min(a[0], b[0])
            lever += forces[round(ratio, 6)] * tension * (a[0] + b[0]) / 2
        stiffness, inertia = matrices(beam["length"], bending, mass, count)
        for boundary, held in HELD.items():
            free = [dof for dof in range(2 * (count + 1)) if dof not in held(2 * count)]
            k, m = stiffness[np.ix_(free, free)], inertia[np.ix_(free, free)]
            squared, vectors = eigh(k, m)
            rigid = 2 if boundary == "free-free" else 0
            full = np.zeros((2 * (count + 1), 4))
            full[free] = vectors[:, rigid:rigid + 4]
            drive = 47
            modes = []
            for column in range(4):
                shape = full[:, column] / full[2 * drive, column]
                slopes = sum(abs(shape[2 * node + 1]) for node in nodes)
                amplitude = 2e-4
                d = shape * amplitude
                # ζ = E_f/(4π E_n), E_f = 2 α'μ N (h1 + h2) Y, E_n = ½ dᵀKd with α'μ = 0.004
                dissipated = 2 * 0.004 * lever * slopes * amplitude
                stored = 0.5 * d @ stiffness @ d
                modes.append({
                    "frequency_hz": float(np.sqrt(squared[rigid + column]) / (2 * np.pi)),
                    "mass_kg": float(shape @ inertia @ shape),
                    "damping_ratio": float(dissipated / (4 * np.pi * stored)),
                })
            static = None
            if not rigid:
                load = np.zeros(len(free))
                load[free.index(2 * drive)] = 1.0
                static = float(1 / np.linalg.solve(k, load)[free.index(2 * drive)])
            cases.append({**beam, "boundary": boundary, "positions": positions, "drive_point": beam["length"] * drive / count,
                          "bending": float(bending), "mass_per_length": float(mass), "modes": modes,
                          "static_stiffness": static, "amplitude": 2e-4, "alpha_mu": 0.004})
    return cases


if __name__ == "__main__":
    found = {
        "points": [float(x) for x in POINTS],
        "shapes": shapes(),
        "normal_forces": [[ratio, force] for ratio, force in normal_forces().items()],
        "elements": elements(),
    }
    path = Path(__file__).parent / "data" / "layered_beam.json"
    path.write_text(json.dumps(found, indent=1) + "\n")
