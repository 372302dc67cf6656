"""Periodic motions of m x'' + c x' + k x + k3 x^3 = F cos(w t) by shooting, independent of harmonic balance.

Writes data/duffing.csv:  python3 shooting.py > data/duffing.csv   (needs NumPy and SciPy)
"""

import numpy as np
from scipy.integrate import solve_ivp

M, C, K = 1.3, 0.4, 52.0
SAMPLES = 512


def rate(t, y, cubic, force, omega):
    """State, and the four derivatives of the state with respect to its start."""
    x, v, px, pv, qx, qv = y
    tangent = K + 3 * cubic * x * x
    return [
        v,
        (force * np.cos(omega * t) - C * v - K * x - cubic * x**3) / M,
        pv,
        (-C * pv - tangent * px) / M,
        qv,
        (-C * qv - tangent * qx) / M,
    ]


def period(start, cubic, force, omega, samples=None):
    span = (0.0, 2 * np.pi / omega)
    y = [start[0], start[1], 1.0, 0.0, 0.0, 1.0]
    return solve_ivp(
        rate, span, y, method="DOP853", rtol=3e-14, atol=1e-16, t_eval=samples, args=(cubic, force, omega)
    ).y


def shoot(start, cubic, force, omega):
    for _ in range(50):
        end = period(start, cubic, force, omega)[:, -1]
        rest = end[:2] - start
        jacobian = np.array([[end[2] - 1, end[4]], [end[3], end[5] - 1]])
        change = np.linalg.solve(jacobian, rest)
        start = start - change
        if np.abs(change).max() < 1e-13 * np.abs(start).max():
            break
    end = period(start, cubic, force, omega)[:, -1]
    multipliers = np.linalg.eigvals([[end[2], end[4]], [end[3], end[5]]])
    times = np.arange(SAMPLES) * (2 * np.pi / omega / SAMPLES)
    x = period(start, cubic, force, omega, times)[0]
    harmonics = 2 / SAMPLES * np.fft.rfft(x)
    return start, harmonics, np.abs(multipliers).max()


def starts(cubic, force, omega):
    """Amplitudes of the one-harmonic formula, and the states that they begin with."""
    # y = X^2: y ((k - w^2 m + 3/4 k3 y)^2 + c^2 w^2) = F^2
    a, b = K - omega**2 * M, 0.75 * cubic
    roots = np.roots([b * b, 2 * a * b, a * a + (C * omega) ** 2, -force**2])
    for y in sorted(r.real for r in roots if abs(r.imag) < 1e-9 * abs(r) and r.real > 0):
        amplitude = force / (a + b * y + 1j * C * omega)
        yield np.array([amplitude.real, -omega * amplitude.imag])


print("cubic,force,omega_rad_s,x_0,v_0,cosine_1,sine_1,cosine_3,sine_3,largest_multiplier")
for cubic, force, omegas in [
    (700.0, 3.0, [3.0, 6.0, 7.5, 8.0, 8.5, 9.0, 14.0]),
    (-300.0, 0.45, [3.5, 5.4, 5.7, 5.85, 6.0, 6.3, 9.0]),
]:
    for omega in omegas:
        for start in starts(cubic, force, omega):
            state, harmonics, multiplier = shoot(start, cubic, force, omega)
            numbers = [cubic, force, omega, *state]
            for order in (1, 3):
                numbers += [harmonics[order].real, -harmonics[order].imag]
            print(",".join(repr(float(number)) for number in [*numbers, multiplier]))
