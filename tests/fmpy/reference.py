"""The lap model and the joint element, written down a second time from the equations in docs/theory.md."""

import numpy as np
from scipy.integrate import solve_ivp


HIGHER = ("quintic", "septic", "damping_quadratic", "damping_quartic")


class Joint:
    """load on b = K r + C dr/dt + k3 r^3 + k5 r^5 + k7 r^7 + (c2 r^2 + c4 r^4) dr/dt with r = x_a - x_b"""

    def __init__(self, file):
        self.K = np.array(file["joint"]["stiffness"])
        self.C = np.array(file["joint"]["damping"])
        self.k3 = np.array(file["joint"]["cubic"])
        self.n = len(self.k3)
        higher = file["joint"].get("higher", {})
        self.k5, self.k7, self.c2, self.c4 = (np.array(higher.get(key, [0.0] * self.n)) for key in HIGHER)

    def load_on_b(self, r, v):
        springs = self.K @ r + self.k3 * r**3 + self.k5 * r**5 + self.k7 * r**7
        return springs + self.C @ v + (self.c2 * r**2 + self.c4 * r**4) * v

    def energy(self, r):
        return 0.5 * r @ self.K @ r + np.sum(self.k3 * r**4 / 4 + self.k5 * r**6 / 6 + self.k7 * r**8 / 8)

    def power(self, r, v):
        return v @ self.C @ v + np.sum((self.c2 * r**2 + self.c4 * r**4) * v**2)


class Lap:
    """State: displacements of a, of b, velocities of a, of b."""

    def __init__(self, file):
        self.joint = Joint(file)
        self.n = self.joint.n
        both = [file["bodies"]["a"], file["bodies"]["b"]]
        self.m, self.k, self.c = (
            np.concatenate([body[key] for body in both]) for key in ("inertia", "stiffness", "damping")
        )

    def split(self, state):
        n = self.n
        return state[: 2 * n], state[2 * n :]

    def load_on_b(self, state):
        x, v = self.split(state)
        n = self.n
        return self.joint.load_on_b(x[:n] - x[n:], v[:n] - v[n:])

    def rate(self, state, load):
        x, v = self.split(state)
        on_b = self.load_on_b(state)
        joint = np.concatenate([-on_b, on_b])
        return np.concatenate([v, (load - self.k * x - self.c * v + joint) / self.m])

    def energy(self, state):
        x, v = self.split(state)
        n = self.n
        return 0.5 * (self.m @ v**2 + self.k @ x**2) + self.joint.energy(x[:n] - x[n:])

    def power(self, state):
        x, v = self.split(state)
        n = self.n
        return self.c @ v**2 + self.joint.power(x[:n] - x[n:], v[:n] - v[n:])

    def held(self, state, loads, step):
        """States after each communication step, the load of each step held over it."""
        states = [state]
        for load in loads:
            solution = solve_ivp(
                lambda t, y: self.rate(y, load), (0, step), states[-1], method="DOP853", rtol=1e-12, atol=1e-18
            )
            assert solution.success
            states.append(solution.y[:, -1])
        return np.array(states)
