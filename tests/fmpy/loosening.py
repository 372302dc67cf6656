"""A joint over the preload, written down a second time: SciPy's monotone cubics, with the slopes of a matrix made smaller
where they would take it out of the positive semidefinite ones."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator


def bears(matrix, slope, thirds):
    """Largest part of a slope with which the matrix, moved by a third of each gap, has no negative eigenvalue."""

    def is_semidefinite(part):
        scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
        return all(np.linalg.eigvalsh((matrix + part * third * slope) / scale)[0] >= 0 for third in thirds)

    if is_semidefinite(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_semidefinite(middle) else (low, middle)
    return low


class Table:
    """K, C and k3 at a preload, and their derivatives by it."""

    def __init__(self, file):
        table = file["joint"]["over_preload"]
        self.preload = np.array(table["preload"], float)
        self.nominal = table["nominal"]
        self.K, self.C = (self.spline(table[key], True) for key in ("stiffness", "damping"))
        self.k3 = self.spline(table["cubic"], False)

    def spline(self, values, is_matrix):
        values = np.array(values, float)
        slopes = PchipInterpolator(self.preload, values).derivative()(self.preload)
        if is_matrix:
            gaps = np.diff(self.preload) / 3
            for i, matrix in enumerate(values):
                thirds = ([-gaps[i - 1]] if i else []) + ([gaps[i]] if i < len(gaps) else [])
                slopes[i] *= bears(matrix, slopes[i], thirds)
        return CubicHermiteSpline(self.preload, values, slopes)

    def at(self, preload, order=0):
        return self.K(preload, order), self.C(preload, order), self.k3(preload, order)

    def energy(self, preload, r, order=0):
        """Energy stored in the joint's springs, or its derivative by the preload."""
        K, _, k3 = self.at(preload, order)
        return 0.5 * r @ K @ r + 0.25 * np.sum(k3 * r**4)


class LooseningLap:
    """Displacements of a, of b, velocities of a, of b, then the energies supplied, dissipated and taken up by the preload."""

    def __init__(self, file):
        self.table = Table(file)
        both = [file["bodies"]["a"], file["bodies"]["b"]]
        self.m, self.k, self.c = (
            np.concatenate([body[key] for body in both]) for key in ("inertia", "stiffness", "damping")
        )
        self.n = len(self.m) // 2

    def relative(self, state):
        n = self.n
        x, v = state[: 2 * n], state[2 * n : 4 * n]
        return x[:n] - x[n:], v[:n] - v[n:]

    def load_on_b(self, state, preload):
        r, v = self.relative(state)
        K, C, k3 = self.table.at(preload)
        return K @ r + C @ v + k3 * r**3

    def rate(self, state, load, preload, preload_rate=0.0):
        n = self.n
        x, v = state[: 2 * n], state[2 * n : 4 * n]
        r, r_rate = self.relative(state)
        K, C, k3 = self.table.at(preload)
        on_b = K @ r + C @ r_rate + k3 * r**3
        acceleration = (load - self.k * x - self.c * v + np.concatenate([-on_b, on_b])) / self.m
        powers = [
            load @ v,
            self.c @ v**2 + r_rate @ C @ r_rate,
            self.table.energy(preload, r, 1) * preload_rate,
        ]
        return np.concatenate([v, acceleration, powers])

    def energy(self, state, preload):
        n = self.n
        x, v = state[: 2 * n], state[2 * n : 4 * n]
        r, _ = self.relative(state)
        return 0.5 * (self.m @ v**2 + self.k @ x**2) + self.table.energy(preload, r)

    def jump(self, state, before, after):
        """The state after a jump of the preload."""
        r, _ = self.relative(state)
        state = state.copy()
        state[-1] += self.table.energy(after, r) - self.table.energy(before, r)
        return state

    def advance(self, state, step, load, preload, preload_rate=lambda t: 0.0):
        """After `step`, in which load and preload are functions of the time since its beginning."""
        solution = solve_ivp(
            lambda t, y: self.rate(y, load(t), preload(t), preload_rate(t)),
            (0, step), state, method="DOP853", rtol=1e-12, atol=1e-18,
        )
        assert solution.success
        return solution.y[:, -1]

    def frequencies(self, preload):
        """Undamped natural frequencies of small motion, rad/s."""
        n = self.n
        K, _, _ = self.table.at(preload)
        stiffness = np.block([[K, -K], [-K, K]]) + np.diag(self.k)
        root = np.sqrt(np.outer(self.m, self.m))
        return np.sqrt(np.linalg.eigvalsh(stiffness / root))


def start(n):
    return np.zeros(4 * n + 3)
