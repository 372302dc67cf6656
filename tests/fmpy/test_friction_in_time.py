"""Laps whose joint slips, against SciPy: each law by its differential equation or its virgin curve, the turns located."""

import numpy as np
import pytest
from joints import body, changed, joint
from scipy.integrate import solve_ivp

# m = 1, k = 0.75, c = 0.01 under a load that begins at once; the other body does not move
FORCE, END, POINTS = 0.25, 40.0, 8
STIFFNESS, DAMPING = 0.75, 0.01

IWAN = {"law": "iwan", "slip_force": 0.1, "stiffness": 0.25, "exponent": -0.3, "ratio": 0.5}
VALANIS = {"law": "valanis", "stiffness": 0.3, "slip_stiffness": 0.05, "slip_force": 0.06, "kappa": 0.7}
DAHL = {"law": "dahl", "stiffness": 0.25, "slip_force": 0.06}
BOUC_WEN = {"law": "bouc-wen", "stiffness": 0.25, "slip_force": 0.06, "exponent": 1.5, "beta": 0.6, "gamma": -0.2}
LUGRE = {
    "law": "lugre",
    "stiffness": 0.5,
    "bristle_damping": 0.05,
    "damping": 0.05,
    "slip_force": 0.05,
    "static_force": 0.08,
    "stribeck_velocity": 0.1,
}


class Stack:
    """Iwan's law by its reversal points over Segalman's virgin curve."""

    def __init__(self, law):
        slip, stuck, chi, beta = (law[key] for key in ("slip_force", "stiffness", "exponent", "ratio"))
        g = beta + (chi + 1) / (chi + 2)
        self.slip, self.stuck, self.chi = slip, stuck, chi
        self.span = slip * (1 + beta) / (stuck * g)
        self.density = slip * (chi + 1) / (self.span ** (chi + 2) * g)
        self.points, self.place, self.direction = [], 0.0, 0

    def virgin(self, u):
        x = min(abs(u), self.span)
        load = self.stuck * x - self.density * x ** (self.chi + 2) / ((self.chi + 1) * (self.chi + 2))
        return np.copysign(self.slip if abs(u) >= self.span else load, u)

    def after(self, u):
        points, direction = list(self.points), np.sign(u - self.place)
        if direction and self.direction and direction != self.direction:
            points.append(self.place)
        while len(points) >= 2 and direction * (u - points[-2]) >= 0:
            del points[-2:]
        if len(points) == 1 and direction * (u + points[0]) >= 0:
            points.clear()
        return points, direction or self.direction

    def load(self, u):
        points, _ = self.after(u)
        if not points:
            return self.virgin(u)
        ways = np.diff([*points, u])
        return self.virgin(points[0]) + sum(2 * self.virgin(way / 2) for way in ways)

    def turn(self, u):
        self.points, self.direction = self.after(u)
        self.place = u


def flow(stiffness, limit, sharpness):
    """dp/dx of a slider that flows (Valanis, Dahl)."""

    def rate(p, v):
        w = p * np.sign(v) / limit
        return stiffness * (1 - w) / (1 - sharpness * w) * v

    return rate


def equation(law):
    """Load by displacement, velocity and inner state, and the rate of that state."""
    value = law.get
    if law["law"] == "lugre":
        s0, s1, s2 = value("stiffness"), value("bristle_damping"), value("damping")
        fc, fs, vs = value("slip_force"), value("static_force"), value("stribeck_velocity")

        def rate(z, v):
            return v - s0 * abs(v) * z / (fc + (fs - fc) * np.exp(-((v / vs) ** 2)))

        return (lambda u, v, z: s0 * z + s1 * rate(z, v) + s2 * v), rate
    if law["law"] == "bouc-wen":
        k, yielding, n = value("stiffness"), value("slip_force"), value("exponent")
        beta, gamma = value("beta"), value("gamma")

        def rate(p, v):
            w = p / yielding
            return k * (1 - (beta * np.sign(v * w) + gamma) * abs(w) ** n) * v

        return (lambda u, v, p: p), rate
    if law["law"] == "dahl":
        return (lambda u, v, p: p), flow(value("stiffness"), value("slip_force"), 0.0)
    e0, et, s0, kappa = (value(key) for key in ("stiffness", "slip_stiffness", "slip_force", "kappa"))
    e1 = e0 - et
    return (lambda u, v, p: et * u + p), flow(e1, s0 * e1 / e0, kappa * e1 / (e0 - kappa * et))


def in_scipy(law, times):
    """Displacement and velocity at these times."""
    stack = Stack(law) if law["law"] == "iwan" else None
    load, inner = (None, None) if stack else equation(law)

    def rate(t, y):
        u, v, p = y
        of_law = stack.load(u) if stack else load(u, v, p)
        return [v, FORCE - DAMPING * v - STIFFNESS * u - of_law, 0.0 if stack else inner(p, v)]

    def turn(_, y):
        return y[1]

    turn.terminal = True
    t, y, found = 0.0, np.zeros(3), np.zeros((len(times), 2))
    while t < times[-1]:
        # away from the turn where it begins, so that it is not found again
        turn.direction = -np.sign(rate(t, y)[1])
        part = solve_ivp(
            rate, (t, times[-1]), y, "DOP853", rtol=1e-11, atol=1e-13, events=turn, dense_output=True, max_step=0.2
        )
        within = (times >= t) & (times <= part.t[-1])
        if within.any():
            found[within] = part.sol(times[within])[:2].T
        t, y = part.t[-1], part.y[:, -1]
        if stack:
            stack.turn(y[0])
    return found


def lap_and_motion(law):
    """A lap with this law, and how SciPy moves it at the points."""
    bodies = {"a": body([1.0], [STIFFNESS], [DAMPING]), "b": body([1e12], [0.0], [0.0])}
    file = changed(joint(["y"], [[0.0]], [[0.0]], [0.0], bodies), friction=[{"dof": "y", **law}])
    return file, in_scipy(law, END * np.arange(1, POINTS + 1) / POINTS)


each_law = pytest.mark.parametrize("law", [IWAN, VALANIS, DAHL, BOUC_WEN, LUGRE], ids=lambda law: law["law"])


@each_law
def test_a_lap_follows_the_located_turns(slave, law):
    file, expected = lap_and_motion(law)
    errors = []
    for steps in (100, 400):
        size = END / POINTS / steps
        instance = slave(file, "lap", "--step-size-max", repr(size))
        instance.initialise(**{"a.F": FORCE})
        found = []
        for index in range(POINTS * steps):
            instance.step(index * size, size)
            if (index + 1) % steps == 0:
                found.append(instance.get("a.y", "a.v"))
        errors.append(np.abs(np.array(found) - expected).max() / np.abs(expected).max())
    order = np.log(errors[0] / errors[1]) / np.log(4)
    # steps are cut where the joint turns; LuGre's law is stepped at the mean velocity
    most, least_order = (1e-6, 1.8) if law["law"] == "lugre" else (3e-8, 2.2)
    assert errors[1] < most
    assert order > least_order


@each_law
def test_its_steps_are_as_accurate_as_was_asked_for(slave, law):
    file, expected = lap_and_motion(law)
    for wanted in (1e-3, 1e-5, 1e-7):
        instance = slave(file, "lap", "--step-error", repr(wanted))
        instance.initialise(**{"a.F": FORCE})
        found = []
        for index in range(POINTS):
            instance.step(index * END / POINTS, END / POINTS)
            found.append(instance.get("a.y", "a.v"))
        error = (np.abs(np.array(found) - expected).max(axis=0) / np.abs(expected).max(axis=0)).max()
        assert error < wanted
