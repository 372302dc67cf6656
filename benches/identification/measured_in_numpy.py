"""Identification from measured substructures and a measured assembly, all with noise, in NumPy and SciPy, timed.

    cargo bench --bench identification -- against python3
    cargo bench --bench identification -- write-measured lines.bin
    python3 benches/identification/measured_in_numpy.py lines.bin

The errors of the substructures are eliminated line by line: with u₀ as measured, u as corrected and J = ∂H/∂u at u,

    r = y − H(u, θ) − J(u₀ − u),  S = Σ_y + J Σ_u Jᴴ,  u ← u₀ + Σ_u Jᴴ S⁻¹ (r − ∂H/∂θ δθ)

It solves what the program solves: the same sum is lowest, on the lines that the same rule leaves, to the same tolerance.
"""

import sys
import time

import numpy as np
import scipy.linalg

JOINT = [(0, 0), (0, 1), (1, 1)]
POINTS = 3
RELATIVE = 0.01
FEW = 200
# A line is left out where the substructures' errors move the joint's motion by more than this part of it.
MOST_MOVED = 0.5
# Gain that a full step promises, in mean squares of a residual, below which an iteration has come to rest.
NEGLIGIBLE_GAIN = 1e-4
# Steps on few lines from each start, at most.
ROUNDS = 12


def upper(size):
    return np.triu_indices(size)


class Data:
    """Means of reciprocal measurements, flat, by line."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.of_a = np.fromfile(file, "<f8", 6).reshape(2, 3)
            self.of_b = np.fromfile(file, "<f8", 30).reshape(5, 6)
            rows = np.fromfile(file, "<f8").reshape(-1, 1 + 2 * (6 + 21 + 9))
        self.omega = rows[:, 0]
        values = np.ascontiguousarray(rows[:, 1:]).view(complex)
        self.u = values[:, :27]
        whole = values[:, 27:].reshape(-1, POINTS, POINTS)
        self.row, self.column = upper(POINTS)
        is_twice = self.row != self.column
        self.y = 0.5 * (whole + whole.transpose(0, 2, 1))[:, self.row, self.column]
        self.whole = whole
        self.count = np.where(is_twice, 2.0, 1.0)
        self.prepare()

    def prepare(self):
        first, second = zip(upper(3), [index + 3 for index in upper(6)])
        self.p, self.q = np.concatenate(first), np.concatenate(second)
        self.is_twice = self.p != self.q
        share = np.where(self.is_twice, 2.0, 1.0)
        self.variance_u = (RELATIVE * np.abs(self.u)) ** 2 / share

    def at(self, lines):
        some = object.__new__(Data)
        some.__dict__.update(self.__dict__)
        for name in ("omega", "u", "y", "whole", "variance_u"):
            setattr(some, name, getattr(self, name)[lines])
        return some

    def formed(self, u):
        """F = H_jj + H_kk, H_ks and H_ss."""
        a = np.empty((len(u), 3, 3), complex)
        b = np.empty((len(u), 6, 6), complex)
        (i, j), (k, l) = upper(3), upper(6)
        a[:, i, j] = a[:, j, i] = u[:, :6]
        b[:, k, l] = b[:, l, k] = u[:, 6:]
        b = self.of_b @ b @ self.of_b.T
        return self.of_a @ a @ self.of_a.T + b[:, :2, :2], b[:, :2, 2:], b[:, 2:, 2:]


def stiffness(omega, theta):
    joint = np.empty((len(omega), 2, 2), complex)
    for n, (i, j) in enumerate(JOINT):
        joint[:, i, j] = joint[:, j, i] = theta[n] + 1j * omega * theta[3 + n]
    return joint


def linearised(data, u, theta):
    """H, ∂H/∂K* and J."""
    free, transfer, own = data.formed(u)
    joint = stiffness(data.omega, theta)
    q = np.linalg.solve(np.eye(2) + free @ joint, transfer)
    x = joint @ q
    computed = (own - transfer.transpose(0, 2, 1) @ x)[:, data.row, data.column]
    left, right = q[:, :, data.row], q[:, :, data.column]
    by_joint = np.stack(
        [
            -left[:, 0] * right[:, 0],
            -(left[:, 0] * right[:, 1] + left[:, 1] * right[:, 0]),
            -left[:, 1] * right[:, 1],
        ],
        axis=2,
    )
    # How the loads at the joint and at the points act on what was measured: dH = Vᵀ dU V.
    loads = np.concatenate([-x, np.broadcast_to(np.eye(POINTS), (len(u), POINTS, POINTS))], axis=1)
    v = np.concatenate([data.of_a.T @ x, data.of_b.T @ loads], axis=1)
    v_row, v_column = v[:, :, data.row], v[:, :, data.column]
    by_u = v_row[:, data.p] * v_column[:, data.q]
    twice = data.is_twice
    by_u[:, twice] += v_row[:, data.q[twice]] * v_column[:, data.p[twice]]
    return computed, by_joint, by_u.transpose(0, 2, 1)


def variances(data, computed):
    power, measured = np.abs(computed) ** 2, np.abs(data.y) ** 2
    return RELATIVE**2 * np.clip(power, measured / 4, measured * 4) / data.count


class Normal:
    """Normal equations at θ and u."""

    def __init__(self, data, u, theta):
        self.theta, self.u = theta, u
        computed, by_joint, self.by_u = linearised(data, u, theta)
        weighted = self.by_u * data.variance_u[:, None, :]
        covariance = weighted @ self.by_u.conj().transpose(0, 2, 1)
        entries = np.arange(len(data.row))
        covariance[:, entries, entries] += variances(data, computed)
        residual = data.y - computed - (self.by_u @ (data.u - u)[:, :, None])[:, :, 0]
        self.right = np.concatenate([residual[:, :, None], by_joint], axis=2)
        self.solved = np.linalg.solve(covariance, self.right)
        products = self.right.conj().transpose(0, 2, 1) @ self.solved
        self.cost = np.sum(products[:, 0, 0].real)
        # ∂K*/∂k = E, ∂K*/∂c = jωE
        omega = data.omega[:, None]
        by_k = products[:, 1:, 0]
        self.gradient = np.concatenate([by_k.real.sum(0), (omega * by_k.imag).sum(0)])
        products, omega = products[:, 1:, 1:], omega[:, :, None]
        mixed = (omega * products.imag).sum(0)
        self.matrix = np.block(
            [
                [products.real.sum(0), -mixed],
                [mixed, (omega**2 * products.real).sum(0)],
            ]
        )
        self.scale = 1 / np.sqrt(np.diag(self.matrix))
        scaled = self.matrix * self.scale[:, None] * self.scale
        factor = scipy.linalg.cho_factor(scaled, check_finite=False)
        self.step = self.scale * scipy.linalg.cho_solve(factor, self.scale * self.gradient)
        self.gain = self.gradient @ self.step

    def is_settled(self, data):
        return self.gain <= NEGLIGIBLE_GAIN * self.cost / (len(data.omega) * data.count.sum())

    def corrected(self, data, step):
        by = step[None, :3] + 1j * data.omega[:, None] * step[None, 3:]
        left = self.solved[:, :, 0] - (self.solved[:, :, 1:] @ by[:, :, None])[:, :, 0]
        of_line = (self.by_u.conj().transpose(0, 2, 1) @ left[:, :, None])[:, :, 0]
        return data.u + data.variance_u * of_line


def shortened(normal):
    """The step, with no unknown changed by more than half of its size; that of a cross term is that of both its DOFs."""
    size = np.abs(normal.theta)
    for first in (0, 3):
        size[first + 1] = max(size[first + 1], np.sqrt(size[first] * size[first + 2]))
    most = np.max(np.abs(normal.step) / np.maximum(size, normal.scale))
    return normal.step * min(1.0, 0.5 / most)


def roughly(data, theta):
    """Gauss and Newton with the substructures as measured, their errors in the variances alone."""
    normal = Normal(data, data.u, theta)
    for _ in range(ROUNDS):
        normal = Normal(data, data.u, normal.theta + shortened(normal))
        if normal.is_settled(data):
            break
    return normal


def estimate(data, theta):
    """Gauss and Newton, the corrections following each step."""
    normal = Normal(data, data.u, theta)
    for _ in range(40):
        step = shortened(normal)
        normal = Normal(data, normal.corrected(data, step), normal.theta + step)
        if normal.is_settled(data):
            return normal
    raise SystemExit(f"the iteration in NumPy has not come to rest: gain {normal.gain:.3g}")


def steady(data, theta):
    """Lines at which A = (I + F K*)⁻¹ ΔF K* is expected to be small."""
    free, _, _ = data.formed(data.u)
    joint = stiffness(data.omega, theta)
    inverse = np.linalg.inv(np.eye(2) + free @ joint)
    w = np.concatenate([data.of_a, data.of_b[:2]], axis=1)
    change = np.einsum("is,js->sij", w[:, data.p], w[:, data.q])
    change[data.is_twice] += change[data.is_twice].transpose(0, 2, 1)
    acts = np.any(change != 0, axis=(1, 2))
    diagonal = np.sort(np.abs(np.stack([free[:, 0, 0], free[:, 1, 1]])), axis=1)
    own = 1 / diagonal[:, (len(data.omega) - 1) // 2]
    moved = inverse[:, None] @ change[None, acts] @ joint[:, None]
    power = np.sum(np.abs(moved) ** 2 * (own[:, None] / own), axis=(2, 3))
    size = np.sqrt(np.sum(data.variance_u[:, acts] * power, axis=1))
    return np.flatnonzero(size <= max(MOST_MOVED, np.sort(size)[len(size) // 2]))


def median_of_decoupled(data):
    free, transfer, own = data.formed(data.u)
    left = np.linalg.pinv(transfer.transpose(0, 2, 1))
    z_inverse = left @ (own - data.whole) @ left.transpose(0, 2, 1)
    joint = np.linalg.inv(np.linalg.inv(z_inverse) - free)
    values = [0.5 * (joint[:, i, j] + joint[:, j, i]) for i, j in JOINT]
    return np.array([np.median(v.real) for v in values] + [np.median(v.imag / data.omega) for v in values])


def linear(data, theta):
    """X = H_sk⁺ (H_ss − H) is linear in K*: X = K* (H_ks − F X)."""
    free, transfer, own = data.formed(data.u)
    whole = 0.5 * (data.whole + data.whole.transpose(0, 2, 1))
    weight = 1 / np.abs(whole)
    columns = []
    for column in range(POINTS):
        w = weight[:, :, column, None]
        left = transfer.transpose(0, 2, 1) * w
        length = np.linalg.norm(left, axis=1)
        left = left / length[:, None]
        adjoint = left.conj().transpose(0, 2, 1)
        right = adjoint @ ((own - whole)[:, :, column, None] * w)
        columns.append(np.linalg.solve(adjoint @ left, right)[:, :, 0] / length)
    x = np.stack(columns, axis=2)
    w = transfer - free @ x
    for _ in range(6):
        q = np.linalg.solve(np.eye(2) + free @ stiffness(data.omega, theta), transfer)
        target = (q.transpose(0, 2, 1) @ x) * weight
        a, b = q[:, :, :, None], w[:, :, None, :]
        row = np.stack(
            [a[:, 0] * b[:, 0], a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0], a[:, 1] * b[:, 1]],
            axis=3,
        ) * weight[:, :, :, None]
        rows = np.concatenate([row, 1j * data.omega[:, None, None, None] * row], axis=3).reshape(-1, 6)
        real = np.concatenate([rows.real, rows.imag])
        right = np.concatenate([target.real.ravel(), target.imag.ravel()])
        matrix, scale = real.T @ real, 1 / np.linalg.norm(real, axis=0)
        scaled = matrix * scale[:, None] * scale
        theta = scale * scipy.linalg.solve(scaled, scale * (real.T @ right), assume_a="pos")
    return theta


def identify(data):
    few = data.at(slice(None, None, max(len(data.omega) // FEW, 1)))
    first = median_of_decoupled(data)
    starts = [first, linear(few, np.zeros(6)), linear(few, first)]
    trials = [roughly(few, start) for start in starts]
    best = min(trials, key=lambda trial: trial.cost).theta
    used = data.at(steady(data, best))
    normal = estimate(used, best)
    unit = normal.matrix * normal.scale[:, None] * normal.scale
    covariance = 0.5 * np.linalg.inv(unit) * normal.scale[:, None] * normal.scale
    return normal.theta, np.sqrt(np.diag(covariance)), len(used.omega)


def main():
    data = Data(sys.argv[1])
    identify(data)
    times = []
    for _ in range(int(sys.argv[2]) if len(sys.argv) > 2 else 3):
        begun = time.perf_counter()
        theta, deviation, used = identify(data)
        times.append(time.perf_counter() - begun)
    print(*times)
    print(*theta)
    print(*deviation)
    print(used)


main()
