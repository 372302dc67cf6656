"""A bolt that loosens and is tightened at random while its joint moves at random: all laws of friction, against formulas."""

import numpy as np
import pytest
from instances import both_versions
from joints import LOOSENING_1, changed
from loosening import Table
from scipy.special import lambertw

H = 1e-4
NOMINAL = Table(LOOSENING_1).nominal
STIFFNESS, SLIP = 8e5, 60.0


class Dahl:
    """1 − s p/h falls by e^(−k|Δr|/h) on a way. What a lower preload does not hold goes before it."""

    entry = {"law": "dahl", "stiffness": STIFFNESS, "slip_force": SLIP}
    spring = 0.0
    tolerance = 1e-10

    def __init__(self):
        self.place = self.p = self.heat = 0.0

    def way(self, r, share):
        limit = share * SLIP
        held = np.clip(self.p, -limit, limit)
        s = np.sign(r - self.place)
        return held, s, self.flown(held, s, abs(r - self.place), limit)

    def flown(self, p, s, length, limit):
        return s * limit - (s * limit - p) * np.exp(-STIFFNESS * length / limit)

    def load(self, r, share):
        return self.way(r, share)[2]

    def stored(self, r, share):
        return 0.5 * self.load(r, share) ** 2 / STIFFNESS

    def work(self, held, s, after, length, limit):
        # ∫ p dr with p = s h − (s h − p₀) e^(−k|r|/h)
        return limit * length - limit / STIFFNESS * (after - held) * s

    def commit(self, r, share):
        held, s, after = self.way(r, share)
        energy = [0.5 * p**2 / STIFFNESS for p in (self.p, held, after)]
        self.heat += energy[0] - energy[1]
        self.heat += self.work(held, s, after, abs(r - self.place), share * SLIP) - (energy[2] - energy[1])
        self.place, self.p = r, after


class Valanis(Dahl):
    """The same with dp/dx = E₁ (1 − s w)/(1 − c s w): y' = W(r y e^(r y − E₁|Δx|/(p_m (1−c))))/r, y = 1 − s w, r = c/(1−c)."""

    E0, ET, KAPPA = STIFFNESS * 1.25, STIFFNESS * 0.25, 0.6
    SIGMA0 = SLIP * 1.25
    entry = {"law": "valanis", "stiffness": E0, "slip_stiffness": ET, "slip_force": SIGMA0, "kappa": KAPPA}
    spring = ET

    def flown(self, p, s, length, limit):
        c = self.KAPPA * STIFFNESS / (self.E0 - self.KAPPA * self.ET)
        ratio, y = c / (1 - c), 1 - s * p / limit
        after = np.real(lambertw(ratio * y * np.exp(ratio * y - STIFFNESS * length / (limit * (1 - c))))) / ratio
        return s * limit * (1 - after) if s else p

    def work(self, held, s, after, length, limit):
        # heat p_m²/E₁ (1−c) ∫ w²/(1−w) dw, ∫ = −ℓ − Δw (1 + (w + w')/2), ℓ = ln(y'/y) = (c (y − y') − E₁|Δx|/p_m)/(1−c)
        c = self.KAPPA * STIFFNESS / (self.E0 - self.KAPPA * self.ET)
        w, v, x = s * held / limit, s * after / limit, STIFFNESS * length / limit
        heat = x - c * (v - w) - (1 - c) * (v - w) * (1 + 0.5 * (w + v)) if s else 0.0
        return heat * limit**2 / STIFFNESS + 0.5 * (after**2 - held**2) / STIFFNESS


class BoucWen(Dahl):
    """With n = 1 both branches are exponentials: dw/dx = 1 − (β+γ) w where the load resists, 1 + (β−γ) |w| where it helps."""

    BETA, GAMMA = 0.7, 0.3
    entry = {"law": "bouc-wen", "stiffness": STIFFNESS, "slip_force": SLIP, "exponent": 1.0, "beta": BETA, "gamma": GAMMA}
    tolerance = 1e-9

    def flown(self, p, s, length, limit):
        if s == 0:
            return p
        w, x = s * p / limit, STIFFNESS * length / limit
        q, b = self.BETA + self.GAMMA, self.BETA - self.GAMMA
        if w < 0:
            whole = np.log1p(-b * w) / b
            if x < whole:
                return s * limit * -((np.exp(b * (whole - x)) - 1) / b)
            w, x = 0.0, x - whole
        return s * limit * (1 / q - (1 / q - w) * np.exp(-q * x))

    def work(self, held, s, after, length, limit):
        # on a branch f/F_y = 1/q − (1/q − w) e^(−q x), and likewise unloading; x in F_y/k
        q, b = self.BETA + self.GAMMA, self.BETA - self.GAMMA
        w, v, x = s * held / limit, s * after / limit, STIFFNESS * length / limit
        work = 0.0
        if w < 0:
            part = min(x, np.log1p(-b * w) / b)
            end = min(v, 0.0)
            # dw/dx = 1 − b w: ∫ w dx = (x − Δw)/b
            work += (part - (end - w)) / b
            w, x = end, x - part
        work += (x - (v - w)) / q
        return work * limit**2 / STIFFNESS


class Iwan:
    """As many sliders as the law is derived from, followed one by one."""

    CHI, BETA, COUNT = -0.4, 0.3, 4_000
    entry = {"law": "iwan", "slip_force": SLIP, "stiffness": STIFFNESS, "exponent": CHI, "ratio": BETA}
    spring = 0.0
    tolerance = 1e-6

    def __init__(self):
        p, edge = self.CHI + 1, np.linspace(0, 1, self.COUNT + 1) ** 3
        below = self.BETA + p / (p + 1)
        span, whole = SLIP * (1 + self.BETA) / (STIFFNESS * below), STIFFNESS / (1 + self.BETA)
        k, moment = np.diff(edge**p), p / (p + 1) * np.diff(edge ** (p + 1))
        self.k = whole * np.append(k, self.BETA)
        self.strength = span * np.append(moment / k, 1.0)
        self.e, self.place, self.share, self.heat = np.zeros(self.COUNT + 1), 0.0, None, 0.0

    def trial(self, r, share):
        return np.clip(self.e + r - self.place, -share * self.strength, share * self.strength)

    def load(self, r, share):
        return self.k @ self.trial(r, share)

    def stored(self, r, share):
        return 0.5 * self.k @ self.trial(r, share) ** 2

    def commit(self, r, share):
        """A preload that rises does so before the way, one that falls after it."""
        limit = max(share, self.share or share) * self.strength
        trial = self.e + r - self.place
        held = np.clip(trial, -limit, limit)
        self.heat += self.k @ (limit * np.abs(trial - held))
        after = np.clip(held, -share * self.strength, share * self.strength)
        self.heat += 0.5 * self.k @ (held**2 - after**2)
        self.e, self.place, self.share = after, r, share


LAWS = [Dahl, Valanis, BoucWen, Iwan]


def joint_with(*entries):
    return changed(LOOSENING_1, friction=[{"dof": "y", **entry} for entry in entries])


def course(count, seed):
    """Motions and preloads at random; now and then one of them rests."""
    random = np.random.default_rng(seed)
    r = 3e-4 * np.cumsum(random.uniform(-1, 1, count)) / 4
    preload = 5 + 2.9 * np.sin(0.11 * np.arange(count)) * np.repeat(random.uniform(0.3, 1, count // 10 + 1), 10)[:count]
    for index in range(1, count):
        if index % 5 == 2:
            r[index] = r[index - 1]
        if index % 7 == 3:
            preload[index] = preload[index - 1]
    return r, preload


@both_versions
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.entry["law"])
def test_an_element_on_a_random_path(slave, fmi, law):
    instance = slave(joint_with(law.entry), "element")
    table, own, count = Table(LOOSENING_1), law(), 250
    instance.initialise()
    heats = []
    for index, (r, preload) in enumerate(zip(*course(count, 11))):
        share = preload / NOMINAL
        instance.set({"a.y": r, "preload": preload})
        K, _, k3 = table.at(preload)
        load, stored, heat = instance.get("b.F", "energy.stored", "energy.dissipated")
        expected = (K[0, 0] + own.spring) * r + k3[0] * r**3 + own.load(r, share)
        assert load == pytest.approx(expected, rel=1e-10, abs=law.tolerance * SLIP)
        springs = table.energy(preload, np.array([r])) + 0.5 * own.spring * r**2
        assert stored == pytest.approx(springs + own.stored(r, share), rel=law.tolerance, abs=1e-12)
        assert heat == pytest.approx(own.heat, rel=100 * law.tolerance, abs=1e-9 * SLIP**2 / STIFFNESS)
        instance.step(index * H, H)
        own.commit(r, share)
        heats.append(heat)
    assert np.all(np.diff(heats) >= 0) and heats[-1] > 0


ENTRIES = [law.entry for law in LAWS] + [
    {"law": "jenkins", "stiffness": STIFFNESS, "slip_force": SLIP},
    {"law": "jenkins", "stiffness": 0.3 * STIFFNESS, "slip_force": 0.1 * SLIP},
    {
        "law": "lugre",
        "stiffness": STIFFNESS,
        "bristle_damping": 40.0,
        "damping": 30.0,
        "slip_force": SLIP,
        "static_force": 1.5 * SLIP,
        "stribeck_velocity": 1e-2,
    },
]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry["law"])
def test_what_goes_in_place_is_what_the_springs_give_up(slave, fmi, entry):
    """The motion is held while the preload goes at random: the heat is what is stored less, and none where it rises."""
    instance = slave(joint_with(entry), "element")
    table, random = Table(LOOSENING_1), np.random.default_rng(3)
    instance.initialise()
    time = 0.0

    def step(r, preload):
        nonlocal time
        instance.set({"a.y": r, "preload": preload})
        instance.step(time, H)
        time += H
        # the next step commits it
        stored, heat = instance.get("energy.stored", "energy.dissipated")
        return stored - table.energy(preload, np.array([r])), heat

    for r in [0.0, 2.2e-4, -0.7e-4, 1.1e-4]:
        step(r, NOMINAL)
    held, heat = step(r, NOMINAL)
    lowest, let_go = NOMINAL, 0.0
    for preload in np.append(random.uniform(2, 8, 12), [2.0, 2.0]):
        stored, heat_before = step(r, preload)
        after, heat_now = step(r, preload)
        assert after == pytest.approx(stored, rel=1e-12)
        change = heat_now - heat
        assert change == pytest.approx(held - after, abs=1e-12 * SLIP**2 / STIFFNESS)
        assert change >= 0 and (preload < lowest or change < 1e-15)
        lowest, held, heat, let_go = min(lowest, preload), after, heat_now, let_go + change
    assert let_go > 1e-5


@both_versions
def test_a_state_in_the_middle_goes_on_to_the_bit(slave, fmi):
    """All laws on one degree of freedom, two of some kinds; saved, serialised and taken back while the preload changes."""
    names = ["b.F", "energy.stored", "energy.dissipated", "joint.iwan_reversal_y", "joint.iwan_2_reversal_y"]
    joint = joint_with(*ENTRIES, {**Iwan.entry, "exponent": 0.2})
    r, preload = course(200, 4)

    def drive(instance, start, end):
        rows = []
        for index in range(start, end):
            instance.set({"a.y": r[index], "preload": preload[index]})
            rows.append(instance.get(*names))
            instance.step(index * H, H)
        return np.array(rows)

    whole, other, third = [slave(joint, "element") for _ in range(3)]
    for instance in (whole, other, third):
        instance.initialise()
    expected = drive(whole, 0, 200)
    begun = drive(other, 0, 90)
    state = other.fmu.getFMUState()
    written = other.fmu.serializeFMUState(state)
    other.set({"a.y": 1e-3, "preload": 2.0})
    other.step(90 * H, H)
    other.fmu.setFMUState(state)
    assert np.array_equal(np.concatenate([begun, drive(other, 90, 200)]), expected)
    third.fmu.setFMUState(third.fmu.deserializeFMUState(written))
    assert np.array_equal(drive(third, 90, 200), expected[90:])


@both_versions
@pytest.mark.parametrize("law", [Iwan, Valanis], ids=lambda law: law.entry["law"])
def test_a_lap_balances_while_its_bolt_loosens(slave, fmi, law):
    instance = slave(joint_with(law.entry), "lap")
    instance.initialise()
    count, end = 600, 0.06
    first, heat, balance = instance.get("energy.stored")[0], [0.0], []
    random = np.random.default_rng(8)
    noise = np.repeat(random.uniform(-0.5, 0.5, count // 20), 20)
    for index in range(count):
        share = index / count
        instance.set({
            "preload": np.clip(8 - 5 * share + noise[index], 2, 8),
            "a.F": 700 * np.sin(2 * np.pi * 130 * index * H),
            "b.F": -400 * np.sin(2 * np.pi * 170 * index * H),
        })
        instance.step(index * end / count, end / count)
        stored, supplied, dissipated, by_preload = instance.get(
            "energy.stored", "energy.supplied", "energy.dissipated", "energy.preload"
        )
        heat.append(dissipated)
        balance.append(stored - first - (supplied - dissipated + by_preload))
    assert np.all(np.diff(heat) >= 0)
    assert np.abs(balance).max() < 1e-5 * heat[-1], np.abs(balance).max() / heat[-1]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry["law"])
def test_derivatives_by_the_preload_are_those_of_differences(slave, fmi, entry):
    instance = slave(joint_with(entry), "element")
    instance.initialise()
    for index, (r, preload) in enumerate([(2e-4, 8.0), (-1e-4, 5.0), (0.5e-4, 6.0)]):
        instance.set({"a.y": r, "preload": preload})
        instance.step(index * H, H)
    r, preload, step = 3e-4, 5.5, 1e-5
    loads = []
    for at in (preload + step, preload - step, preload):
        instance.set({"a.y": r, "preload": at})
        loads.append(instance.get("b.F")[0])
    arguments = ([instance.reference["b.F"]], [instance.reference["preload"]])
    found = instance.fmu.getDirectionalDerivative(*arguments, [1.0])[0]
    assert found == pytest.approx((loads[0] - loads[1]) / (2 * step), rel=1e-6)


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_the_program_s_own_check_finds_nothing(export, run, interface, fmi):
    run("check", export(joint_with(*ENTRIES), interface, fmi=fmi))
