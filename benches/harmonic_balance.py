"""The same curve as benches/response.rs in NumPy: harmonic balance of the relative motion of a lap, followed by arc length.

    python3 harmonic_balance.py '{"lap": …}' REPETITIONS

prints the fastest of the repetitions in seconds, the number of points, and ω, a1, b1 of each as JSON. Transforms, forces and
Jacobians are array operations over all samples and harmonics at once; what remains in Python is the sequence of steps.
"""

import json
import sys
import time

import numpy as np


class Lap:
    def __init__(self, m, c, k, k12, c12, k3, highest):
        self.m, self.c, self.k = (np.asarray(x, float) for x in (m, c, k))
        self.k12, self.c12, self.k3 = k12, c12, k3
        samples = 4 * highest + 1
        tau = 2 * np.pi * np.arange(samples) / samples
        h = np.arange(1, highest + 1)
        self.h = h
        self.size = 2 * highest + 1
        # columns: constant, then cosine and sine of each harmonic
        self.synthesis = np.ones((samples, self.size))
        self.synthesis[:, 1::2] = np.cos(np.outer(tau, h))
        self.synthesis[:, 2::2] = np.sin(np.outer(tau, h))
        self.analysis = 2 / samples * self.synthesis.T
        self.analysis[0] /= 2
        self.cosines = np.arange(1, self.size, 2)
        self.sines = np.arange(2, self.size, 2)
        self.all_orders = np.concatenate([[0], h])

    def linear(self, omega):
        """z + K + jΩC of each harmonic, its derivative, and the condensed unit load (F on a, −F on b) with its derivative."""
        w = self.all_orders * omega
        z = self.k[:, None] + 1j * w * self.c[:, None] - w**2 * self.m[:, None]
        dz = 1j * self.all_orders * self.c[:, None] - 2 * w * self.all_orders * self.m[:, None]
        total = z[0] + z[1]
        value = z[0] * z[1] / total + self.k12 + 1j * w * self.c12
        change = (z[1] ** 2 * dz[0] + z[0] ** 2 * dz[1]) / total**2 + 1j * self.all_orders * self.c12
        return value, change

    def real(self, x):
        """Complex amplitudes as coefficients."""
        q = np.empty(self.size)
        q[0] = x[0].real
        q[1::2] = x[1:].real
        q[2::2] = -x[1:].imag
        return q

    def evaluate(self, q, omega, force):
        z, dz = self.linear(omega)
        x = np.concatenate([[q[0] + 0j], q[1::2] - 1j * q[2::2]])
        r = self.synthesis @ q
        residual = self.real(z * x) + self.analysis @ (self.k3 * r**3)
        # F on a and −F on b: (z_b F + z_a F)/(z_a + z_b) = F
        residual[1] -= force
        jacobian = (self.analysis * (3 * self.k3 * r**2)) @ self.synthesis
        jacobian[0, 0] += z[0].real
        jacobian[self.cosines, self.cosines] += z[1:].real
        jacobian[self.sines, self.sines] += z[1:].real
        jacobian[self.cosines, self.sines] += z[1:].imag
        jacobian[self.sines, self.cosines] -= z[1:].imag
        return residual, jacobian, self.real(dz * x)


def follow(lap, omegas, force, longest, first=0.02):
    """Predictor along the tangent, corrector across it; lengths relative to the motion and to a tenth of the range."""
    n = lap.size
    omega_scale = 0.1 * (omegas[1] - omegas[0])
    stiffness = lap.k12 + lap.k[0] * lap.k[1] / (lap.k[0] + lap.k[1])
    matrix = np.zeros((n + 1, n + 1))
    rest = np.zeros(n + 1)
    unit = np.zeros(n + 1)
    unit[n] = 1

    def assemble(u, amplitude):
        residual, jacobian, by_omega = lap.evaluate(u[:n], u[n], force)
        matrix[:n, :n] = jacobian / stiffness
        matrix[:n, n] = by_omega * (omega_scale / (stiffness * amplitude))
        rest[:n] = residual / (stiffness * amplitude)

    u = np.zeros(n + 1)
    u[n] = omegas[0]
    for _ in range(50):
        assemble(u, 1.0)
        change = np.linalg.solve(matrix[:n, :n], rest[:n])
        u[:n] -= change
        if np.abs(change).max() < 1e-9 * np.linalg.norm(u[:n]):
            break
    amplitude = np.linalg.norm(u[:n])
    assemble(u, amplitude)
    matrix[n] = unit
    tangent = np.linalg.solve(matrix, unit)
    tangent /= np.linalg.norm(tangent)
    length = first
    points = [u]
    while True:
        scale = np.full(n + 1, amplitude)
        scale[n] = omega_scale
        predicted = u + length * scale * tangent
        trial = predicted.copy()
        converged = False
        last = np.inf
        for iteration in range(1, 9):
            assemble(trial, amplitude)
            matrix[n] = tangent
            rest[n] = tangent @ ((trial - predicted) / scale)
            change = np.linalg.solve(matrix, rest)
            size = np.abs(change).max()
            if size > 4 or size > 2 * last:
                break
            trial -= scale * change
            last = size
            if size <= 1e-9:
                converged = True
                break
        if converged:
            ahead = np.linalg.solve(matrix, unit)
            ahead /= np.linalg.norm(ahead)
            converged = ahead @ tangent >= 0.95
        if not converged:
            length *= 0.5
            if length < 1e-9:
                raise RuntimeError("stuck")
            continue
        u = trial
        amplitude = np.linalg.norm(u[:n])
        ahead[:n] *= scale[0] / amplitude
        tangent = ahead / np.linalg.norm(ahead)
        points.append(u)
        if not omegas[0] <= u[n] <= omegas[1]:
            return points[:-1]
        length = min(length * min(max(3 / iteration, 0.5), 1.5), longest)


def main():
    case, repetitions = json.loads(sys.argv[1]), int(sys.argv[2])
    lap = Lap(**case["lap"], highest=case["highest"])
    arguments = (lap, case["omega"], case["force"], case["longest"])
    times = []
    for _ in range(repetitions):
        begun = time.perf_counter()
        points = follow(*arguments)
        times.append(time.perf_counter() - begun)
    curve = [[u[-1], u[1], u[2]] for u in points]
    print(json.dumps({"seconds": min(times), "curve": curve}))


main()
