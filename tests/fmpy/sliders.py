"""Laws of friction whose parameters stand in a table over the preload, written down a second time.

Parameters are linear between two preloads. A slider's elongation stays while the preload moves: its spring bears the load of its
new stiffness, for which the preload gives the energy, and what it no longer holds slips."""

import numpy as np
from scipy.special import lambertw

PRELOADS = np.array([2.0, 4.0, 6.0, 8.0])


class Slider:
    """What all laws share: `parameters` of each preload, in the order of the keys of `entry`."""

    law: str
    keys: tuple
    table: np.ndarray
    tolerance = 1e-12

    def __init__(self):
        self.place = self.heat = self.work = 0.0
        self.preload = None

    @classmethod
    def entries(cls):
        return [{"dof": "y", "law": cls.law, **dict(zip(cls.keys, map(float, row)))} for row in cls.table]

    def at(self, preload):
        return [np.interp(preload, PRELOADS, column) for column in self.table.T]


class Jenkins(Slider):
    """e = r − x; it slips at h. Stiffness first, then slip force and motion at the same pace: so is the heat of a step."""

    law, keys = "jenkins", ("stiffness", "slip_force")
    table = np.array([[2.2e5, 10.0], [4.2e5, 34.0], [6.1e5, 44.0], [8e5, 60.0]])

    def __init__(self):
        super().__init__()
        self.x = 0.0

    def load(self, r, preload):
        k, h = self.at(preload)
        return np.clip(k * (r - self.x), -h, h)

    def stored(self, r, preload):
        return 0.5 * self.load(r, preload) ** 2 / self.at(preload)[0]

    def springs(self, preload, to):
        """What the elongations here would store at another preload."""
        return 0.5 * self.at(to)[0] * (self.load(self.place, preload) / self.at(preload)[0]) ** 2

    def commit(self, r, preload):
        k, h = self.at(preload)
        before = h if self.preload is None else self.at(self.preload)[1]
        x = r - self.load(r, preload) / k
        if x != self.x:
            s = np.sign(x - self.x)
            slipped = abs(x - self.x)
            first, last = s * k * (self.place - self.x), s * k * (r - self.x)
            if first > before:
                # what a stiffness that has grown loads beyond the slip force slips at once
                at_once = min((first - before) / k, slipped)
                self.heat += 0.5 * (first + before) * at_once + 0.5 * (before + h) * (slipped - at_once)
            else:
                begins = (before - first) / ((before - first) + (last - h))
                self.heat += (h - 0.5 * (1 - begins) * (h - before)) * slipped
        self.x, self.place, self.preload = x, r, preload


class Dahl(Slider):
    """1 − s p/h falls by e^(−k|Δr|/h) on a way, after the preload has gone in place."""

    law, keys = "dahl", ("stiffness", "slip_force")
    table = Jenkins.table
    spring_of = staticmethod(lambda parameters: 0.0)
    tolerance = 1e-10

    def __init__(self):
        super().__init__()
        self.e = 0.0

    def slider(self, preload):
        """k, h and c of what flows."""
        return *self.at(preload), 0.0

    def way(self, r, preload):
        k, h, c = self.slider(preload)
        held = np.clip(k * self.e, -h, h)
        s = np.sign(r - self.place)
        return held, s, self.flown(held, s, abs(r - self.place), k, h, c)

    @staticmethod
    def flown(p, s, length, k, h, c):
        if s == 0:
            return p
        y = 1 - s * p / h
        if c == 0:
            return s * h * (1 - y * np.exp(-k * length / h))
        ratio = c / (1 - c)
        return s * h * (1 - np.real(lambertw(ratio * y * np.exp(ratio * y - k * length / (h * (1 - c))))) / ratio)

    def load(self, r, preload):
        return self.spring_of(self.at(preload)) * r + self.way(r, preload)[2]

    def stored(self, r, preload):
        k = self.slider(preload)[0]
        return 0.5 * self.spring_of(self.at(preload)) * r**2 + 0.5 * self.way(r, preload)[2] ** 2 / k

    def springs(self, preload, to):
        e = self.way(self.place, preload)[2] / self.slider(preload)[0]
        return 0.5 * self.spring_of(self.at(to)) * self.place**2 + 0.5 * self.slider(to)[0] * e**2

    def commit(self, r, preload):
        k, h, c = self.slider(preload)
        held, s, after = self.way(r, preload)
        self.heat += 0.5 * ((k * self.e) ** 2 - held**2) / k
        if s:
            # heat p_m²/E₁ (x − c Δw − (1−c) Δw (1 + (w + w')/2)), x = E₁|Δr|/p_m
            w, v, x = s * held / h, s * after / h, k * abs(r - self.place) / h
            self.heat += h**2 / k * (x - c * (v - w) - (1 - c) * (v - w) * (1 + 0.5 * (w + v)))
        self.e, self.place, self.preload = after / k, r, preload


class Valanis(Dahl):
    """The same beside a spring E_t: E₁ = E₀ − E_t, p_m = σ₀ E₁/E₀, c = κ E₁/(E₀ − κ E_t)."""

    law, keys = "valanis", ("stiffness", "slip_stiffness", "slip_force", "kappa")
    table = np.array([[3e5, 1e5, 20.0, 0.9], [6e5, 1.5e5, 40.0, 0.5], [8e5, 2.5e5, 50.0, 0.6], [1e6, 2e5, 75.0, 0.3]])
    spring_of = staticmethod(lambda parameters: parameters[1])

    def slider(self, preload):
        e0, et, s0, kappa = self.at(preload)
        return e0 - et, s0 * (e0 - et) / e0, kappa * (e0 - et) / (e0 - kappa * et)


class Iwan(Slider):
    """The line e(θ) of the sliders' elongations by its corners: a motion shifts it, and it is cut at ± θ φ_max.

    ∫ q r dk with dk = K_T/(1+β) ((χ+1) θ^χ dθ + β δ(θ−1) dθ), for lines q and r piece by piece. Where φ_max falls the way is
    before the change, else after it."""

    law, keys = "iwan", ("slip_force", "stiffness", "exponent", "ratio")
    table = np.array([[14.0, 2.2e5, -0.5, 0.4], [30.0, 4.3e5, -0.45, 0.3], [45.0, 6.2e5, -0.4, 0.35], [62.0, 8e5, -0.3, 0.2]])
    tolerance = 1e-10

    def __init__(self):
        super().__init__()
        self.theta, self.e = np.array([0.0, 1.0]), np.zeros(2)

    def span(self, preload):
        F, K, chi, beta = self.at(preload)
        return F * (1 + beta) / (K * (beta + (chi + 1) / (chi + 2)))

    def sum(self, theta, q, r, preload):
        _, K, chi, beta = self.at(preload)
        (a, b), p = (theta[:-1], theta[1:]), chi + 1
        slope = [np.diff(values) / np.diff(theta) for values in (q, r)]
        start = [values[:-1] - own * a for values, own in zip((q, r), slope)]
        power = [p / (p + j) * (b ** (p + j) - a ** (p + j)) for j in range(3)]
        spread = start[0] * start[1] * power[0] + slope[0] * slope[1] * power[2]
        spread += (start[0] * slope[1] + start[1] * slope[0]) * power[1]
        return K / (1 + beta) * (spread.sum() + beta * q[-1] * r[-1])

    def cut(self, theta, e, span):
        """The line, with corners where it passes a limit, before and after it is cut."""
        more = []
        for sign in (1, -1):
            beyond = sign * e - span * theta
            passes = np.flatnonzero(beyond[:-1] * beyond[1:] < 0)
            part = beyond[passes] / (beyond[passes] - beyond[passes + 1])
            more.append(theta[passes] + part * np.diff(theta)[passes])
        all_ = np.unique(np.concatenate([theta, *more]))
        whole = np.interp(all_, theta, e)
        return all_, whole, np.clip(whole, -span * all_, span * all_)

    def moved(self, r, preload):
        """The line there, and the heat of the way and of what is let go."""
        before = preload if self.preload is None else self.preload
        falls = self.span(preload) < self.span(before)
        first = before if falls else preload
        span = self.span(first)
        theta, whole, e = self.cut(self.theta, self.e + r - self.place, span)
        heat = self.sum(theta, np.abs(whole - e), span * theta, first)
        if falls:
            theta, whole, e = self.cut(theta, e, self.span(preload))
            heat += 0.5 * self.sum(theta, whole - e, whole + e, preload)
        return theta, e, heat

    def load(self, r, preload):
        theta, e, _ = self.moved(r, preload)
        return self.sum(theta, e, np.ones_like(e), preload)

    def stored(self, r, preload):
        theta, e, _ = self.moved(r, preload)
        return 0.5 * self.sum(theta, e, e, preload)

    def springs(self, preload, to):
        theta, e, _ = self.moved(self.place, preload)
        return 0.5 * self.sum(theta, e, e, to)

    def commit(self, r, preload):
        theta, e, heat = self.moved(r, preload)
        # the corners alone
        slope = np.diff(e) / np.diff(theta)
        bends = np.abs(np.diff(slope)) > 1e-9 * np.abs(slope).max(initial=1e-30)
        keep = np.concatenate([[True], bends, [True]])
        self.theta, self.e, self.place, self.preload = theta[keep], e[keep], r, preload
        self.heat += heat


LAWS = [Jenkins, Dahl, Valanis, Iwan]


def table_of(*laws):
    """`joint.over_preload.friction` with these laws."""
    return [list(rows) for rows in zip(*(law.entries() for law in laws))]
