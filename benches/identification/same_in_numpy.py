"""The identification of `cargo bench --bench identification` by the same algorithm in NumPy and SciPy, timed.

    cargo bench --bench identification -- against python3
    cargo bench --bench identification -- write lines.bin
    python3 benches/identification/same_in_numpy.py lines.bin
"""

import sys
import time

import numpy as np
import scipy.linalg

ENTRIES = [(0, 0), (0, 1), (1, 1)]
PLACES = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
RELATIVE = 0.01


def read(path):
    rows = np.fromfile(path, "<f8").reshape(-1, 1 + 2 * (4 + 6 + 9 + 9))
    values = rows[:, 1:].copy().view(complex)
    shapes = [(2, 2), (2, 3), (3, 3), (3, 3)]
    blocks, at = [], 0
    for shape in shapes:
        size = shape[0] * shape[1]
        blocks.append(values[:, at : at + size].reshape(-1, *shape))
        at += size
    return rows[:, 0], *blocks


class Data:
    def __init__(self, omega, free, transfer, own, assembly, stride=1):
        self.omega, self.free = omega[::stride], free[::stride]
        self.transfer = transfer[::stride]
        p, q = np.array(PLACES).T
        self.p, self.q = p, q
        both = assembly[::stride]
        self.measured = 0.5 * (both[:, p, q] + both[:, q, p])
        self.count = np.where(p == q, 1.0, 2.0)
        self.scatter = np.where(p == q, 0.0, 0.5 * np.abs(both[:, p, q] - both[:, q, p]) ** 2)
        self.own = own[::stride][:, p, q]


def stiffness(data, theta):
    k, c = theta[:3], theta[3:]
    joint = np.empty((len(data.omega), 2, 2), complex)
    for n, (i, j) in enumerate(ENTRIES):
        joint[:, i, j] = joint[:, j, i] = k[n] + 1j * data.omega * c[n]
    return joint


def linearised(data, theta):
    joint = stiffness(data, theta)
    q = np.linalg.solve(np.eye(2) + data.free @ joint, data.transfer)
    x = joint @ q
    computed = data.own - np.einsum("lie,lie->le", data.transfer[:, :, data.p], x[:, :, data.q])
    left, right = q[:, :, data.p], q[:, :, data.q]
    by = np.stack(
        [
            -(left[:, 0] * right[:, 0]),
            -(left[:, 0] * right[:, 1] + left[:, 1] * right[:, 0]),
            -(left[:, 1] * right[:, 1]),
        ],
        axis=-1,
    )
    return computed, by


class Model:
    """The receptances at theta, computed once, however often they are weighted."""

    def __init__(self, data, theta):
        self.theta = theta
        self.computed, by = linearised(data, theta)
        rows = np.concatenate([by, 1j * data.omega[:, None, None] * by], axis=-1).reshape(-1, 6)
        self.rows = np.stack([rows.real, rows.imag])
        self.residual = data.measured - self.computed


class Normal:
    """Normal equations of a model with given variances."""

    def __init__(self, data, model, variance):
        weight = np.sqrt(data.count / variance)
        self.residual = model.residual * weight
        rows = (model.rows * weight.reshape(1, -1, 1)).reshape(-1, 6)
        flat = np.concatenate([self.residual.real.ravel(), self.residual.imag.ravel()])
        self.cost = flat @ flat + np.sum(data.scatter / variance)
        self.matrix = rows.T @ rows
        self.gradient = rows.T @ flat
        self.scale = 1.0 / np.sqrt(np.diag(self.matrix))

    def step(self, damping):
        system = self.matrix * self.scale[:, None] * self.scale + damping * np.eye(6)
        factor = scipy.linalg.cho_factor(system, check_finite=False)
        right = self.gradient * self.scale
        return self.scale * scipy.linalg.cho_solve(factor, right, check_finite=False)

    def is_settled(self, theta, negligible):
        full = self.step(1e-12)
        size = np.maximum(np.maximum(np.abs(theta), np.abs(theta + full)), self.scale)
        return full @ self.gradient <= negligible * self.cost or np.max(np.abs(full) / size) < 1e-10


def levenberg_marquardt(data, variance, model, negligible, damping):
    normal = Normal(data, model, variance)
    for _ in range(100):
        if normal.is_settled(model.theta, negligible):
            break
        trial = Model(data, model.theta + normal.step(damping))
        following = Normal(data, trial, variance)
        if following.cost <= normal.cost:
            model, normal, damping = trial, following, max(0.01 * damping, 1e-15)
        else:
            damping *= 10
            if damping > 1e12:
                break
    return model, normal, min(damping, 1e-3)


def follow(data, variance, model):
    """Full steps near the minimum, the variances following each."""
    normal = Normal(data, model, variance)
    while True:
        step = normal.step(1e-12)
        promise = step @ normal.gradient / normal.cost
        if normal.is_settled(model.theta, 1e-13):
            return variance, model, normal, True
        if promise >= 1e-3:
            return variance, model, normal, False
        following = Model(data, model.theta + step)
        renewed = (RELATIVE * np.abs(following.computed)) ** 2
        after = Normal(data, following, renewed)
        if not after.step(1e-12) @ after.gradient / after.cost <= 0.1 * promise:
            return variance, model, normal, False
        variance, model, normal = renewed, following, after


def estimate(data, theta):
    model, damping = Model(data, theta), 1e-3
    variance = (RELATIVE * np.abs(model.computed)) ** 2
    for renewal in range(20):
        variance, model, normal, has_settled = follow(data, variance, model)
        if has_settled:
            return model.theta, normal
        before = model.theta
        negligible = 1e-6 if renewal == 0 else 1e-13
        model, normal, damping = levenberg_marquardt(data, variance, model, negligible, damping)
        variance = (RELATIVE * np.abs(model.computed)) ** 2
        change = np.abs(model.theta - before)
        deviation = normal.scale * np.sqrt(normal.cost / data.count.sum() / len(data.omega))
        size = np.maximum(np.maximum(np.abs(before), np.abs(model.theta)), normal.scale)
        if renewal > 0 and (np.max(change / size) < 1e-8 or np.max(change / deviation) < 1e-5):
            break
    return model.theta, Normal(data, model, variance)


def linear(data, theta):
    full = np.empty((len(data.omega), 3, 3), complex)
    own = np.empty_like(full)
    full[:, data.p, data.q] = full[:, data.q, data.p] = data.measured
    own[:, data.p, data.q] = own[:, data.q, data.p] = data.own
    h = np.swapaxes(data.transfer, 1, 2)
    weight = 1 / np.abs(full)
    columns = []
    for column in range(3):
        w = weight[:, :, column, None]
        left = h * w
        length = np.linalg.norm(left, axis=1)
        left = left / length[:, None]
        gram = np.swapaxes(left.conj(), 1, 2) @ left
        right = np.swapaxes(left.conj(), 1, 2) @ ((own - full)[:, :, column, None] * w)
        columns.append(np.linalg.solve(gram, right)[:, :, 0] / length)
    x = np.stack(columns, axis=-1)
    w = data.transfer - data.free @ x
    for _ in range(6):
        q = np.linalg.solve(np.eye(2) + data.free @ stiffness(data, theta), data.transfer)
        target = np.einsum("lip,lic->lpc", q, x) * weight
        row = np.stack(
            [
                q[:, 0, :, None] * w[:, 0, None],
                q[:, 0, :, None] * w[:, 1, None] + q[:, 1, :, None] * w[:, 0, None],
                q[:, 1, :, None] * w[:, 1, None],
            ],
            axis=-1,
        ) * weight[..., None]
        rows = np.concatenate([row, 1j * data.omega[:, None, None, None] * row], axis=-1)
        rows = rows.reshape(-1, 6)
        real = np.concatenate([rows.real, rows.imag])
        right = np.concatenate([target.real.ravel(), target.imag.ravel()])
        matrix = real.T @ real
        scale = 1.0 / np.sqrt(np.diag(matrix))
        factor = scipy.linalg.cho_factor(matrix * scale[:, None] * scale, check_finite=False)
        theta = scale * scipy.linalg.cho_solve(factor, real.T @ right * scale, check_finite=False)
    return theta


def decoupled_median(omega, free, transfer, own, assembly):
    """(3.21) line by line by least squares, then the median over the lines."""
    left = np.linalg.pinv(np.swapaxes(transfer, 1, 2))
    z_inverse = left @ (own - assembly) @ np.swapaxes(left, 1, 2)
    joint = np.linalg.inv(np.linalg.inv(z_inverse) - free)
    values = [0.5 * (joint[:, i, j] + joint[:, j, i]) for i, j in ENTRIES]
    return np.array([np.median(v.real) for v in values] + [np.median(v.imag / omega) for v in values])


def identify(lines):
    data = Data(*lines)
    thinned = Data(*lines, stride=max(len(lines[0]) // 200, 1))
    first = decoupled_median(*lines)
    starts = [first, linear(thinned, np.zeros(6)), linear(thinned, first)]
    trials = [estimate(thinned, start) for start in starts]
    best = min(trials, key=lambda trial: trial[1].cost)[0]
    theta, normal = estimate(data, best)
    scale = normal.scale
    unit = normal.matrix * scale[:, None] * scale
    covariance = 0.5 * np.linalg.inv(unit) * scale[:, None] * scale
    z = normal.residual
    correlation = np.sum((z[:-1].conj() * z[1:]).real) / np.sum(np.abs(z) ** 2)
    return theta, np.sqrt(np.diag(covariance)), correlation


def main():
    lines = read(sys.argv[1])
    identify(lines)
    times = []
    for _ in range(10):
        begun = time.perf_counter()
        theta, deviation, correlation = identify(lines)
        times.append(time.perf_counter() - begun)
    if "--seconds" in sys.argv:
        print(*times)
        return
    for value, sigma in zip(theta, deviation):
        print(f"{value:14.6g} ± {sigma:.2g}")
    print(f"correlation of neighbouring lines {correlation:.3f}")
    print(f"{len(lines[0])} lines: {1e3 * np.median(times):.1f} ms (fastest {1e3 * min(times):.1f} ms)")


main()
