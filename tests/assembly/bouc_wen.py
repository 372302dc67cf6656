"""Periodic motions of a small assembly with a Bouc-Wen law, by shooting: the constants of crates/assembly/src/harmonic/tests.rs.

Half a period turns the motion into its opposite, so that Newton's method looks for z(T/2) = -z(0). DOP853 of SciPy integrates
the law's own equation, with tolerances of 1e-12, and the fundamentals beside it.
"""

import numpy as np
import small
from scipy.integrate import solve_ivp

STIFFNESS, SLIP_FORCE, LOAD = 2e6, 60.0, 30.0
SIZES = np.array([1e-4, 1e-1, 1e-4, 1e-1, 1.0])


def equation(omega, exponent, beta, gamma):
    def rate(time, state):
        x_a, v_a, x_b, v_b, w = state[:5]
        velocity = v_a - v_b
        v_a, v_b, a_a, a_b = small.rates([x_a, x_b, v_a, v_b], LOAD * np.cos(omega * time), SLIP_FORCE * w)
        against = beta * np.sign(velocity) * np.sign(w) + gamma
        w_rate = STIFFNESS / SLIP_FORCE * velocity * (1 - against * abs(w) ** exponent)
        cosine, sine = np.cos(omega * time), np.sin(omega * time)
        return [v_a, a_a, v_b, a_b, w_rate, x_b * cosine, x_b * sine, x_a * cosine, x_a * sine]

    return rate


def periodic(hertz, *law):
    """Fundamentals of tip and root, and the largest displacement of the tip."""
    half, rate = 0.5 / hertz, equation(2 * np.pi * hertz, *law)

    def after(start, end=half, **options):
        state = np.concatenate([start, np.zeros(4)])
        options = {"rtol": 1e-12, "atol": 1e-16, **options}
        return solve_ivp(rate, (0, end), state, method="DOP853", **options)

    state = after(np.zeros(5), 120 * half, rtol=1e-9, atol=1e-14).y[:5, -1]
    while True:
        residual = after(state).y[:5, -1] + state
        columns = []
        for unit in np.diag(1e-6 * SIZES):
            ends = [after(state + sign * unit).y[:5, -1] + state + sign * unit for sign in (1, -1)]
            columns.append((ends[0] - ends[1]) / 2e-6)
        change = np.linalg.solve(np.array(columns).T / SIZES[:, None], -residual / SIZES)
        state = state + SIZES * change
        if abs(change).max() < 1e-9:
            break
    done = after(state, dense_output=True)
    cosine_b, sine_b, cosine_a, sine_a = 2 / half * done.y[5:, -1]
    largest = abs(done.sol(np.linspace(0, half, 20001))[2]).max()
    return cosine_b - 1j * sine_b, cosine_a - 1j * sine_a, largest


if __name__ == "__main__":
    for law in [(1.6, 0.7, 0.3), (2.0, 0.6, -0.4)]:
        for hertz in (75.0, 90.0, 105.0):
            print(law, hertz, *periodic(hertz, *law))
