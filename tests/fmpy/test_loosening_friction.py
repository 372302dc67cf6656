"""A bolt that loosens while its joint's slider holds: what it no longer holds slips, and the heat is accounted for."""

import numpy as np
import pytest
from instances import both_versions
from joints import LOOSENING_1, changed
from loosening import LooseningLap, Table

STIFFNESS, SLIP = 8e5, 60.0
FRICTION = [{"dof": "y", "law": "jenkins", "stiffness": STIFFNESS, "slip_force": SLIP}]
JOINT = changed(LOOSENING_1, friction=FRICTION)
H = 1e-4


class Slider:
    """Return mapping with a slip force in proportion to the preload; on a way both change at the same pace."""

    def __init__(self, nominal):
        self.nominal, self.place, self.heat, self.before, self.at = nominal, 0.0, 0.0, None, 0.0

    def limit(self, preload):
        return SLIP * preload / self.nominal

    def load(self, r, preload):
        return np.clip(STIFFNESS * (r - self.place), -self.limit(preload), self.limit(preload))

    def stored(self, r, preload):
        return 0.5 * self.load(r, preload) ** 2 / STIFFNESS

    def commit(self, r, preload):
        now = self.limit(preload)
        before = now if self.before is None else self.before
        place = r - self.load(r, preload) / STIFFNESS
        if place != self.place:
            # from where k |e| = h on, which the slip force has until the end
            s = np.sign(r - place)
            first, last = before - STIFFNESS * s * (self.at - self.place), now - STIFFNESS * s * (r - self.place)
            begins = first / (first - last)
            self.heat += (now - 0.5 * (1 - begins) * (now - before)) * abs(place - self.place)
        self.place, self.before, self.at = place, now, r


@both_versions
def test_an_element_on_a_random_path(slave, fmi):
    """Motion and preload go at random: load, energies and slider are those of the return mapping, and the balance holds."""
    instance = slave(JOINT, "element")
    table, random = Table(JOINT), np.random.default_rng(5)
    instance.initialise()
    slider, count = Slider(table.nominal), 400
    r = 3e-4 * np.cumsum(random.uniform(-1, 1, count)) / 4
    preload = 5 + 3 * np.sin(0.11 * np.arange(count))
    for index in range(count):
        instance.set({"a.y": r[index], "preload": preload[index]})
        K, _, k3 = table.at(preload[index])
        spring = K[0, 0] * r[index] + k3[0] * r[index] ** 3
        load, stored, heat, place = instance.get(
            "b.F", "energy.stored", "energy.dissipated", "joint.jenkins_slider_y"
        )
        assert load == pytest.approx(spring + slider.load(r[index], preload[index]), rel=1e-10)
        energy = table.energy(preload[index], r[index : index + 1]) + slider.stored(r[index], preload[index])
        assert stored == pytest.approx(energy, rel=1e-10)
        assert place == pytest.approx(slider.place, abs=1e-15)
        assert heat == pytest.approx(slider.heat, rel=1e-12, abs=1e-15)
        instance.step(index * H, H)
        slider.commit(r[index], preload[index])


@both_versions
def test_a_bolt_that_loosens_under_a_held_load_lets_go(slave, fmi):
    """The motion is held: all that the slider's spring gives up is heat, and tightening again does not bring it back."""
    instance = slave(JOINT, "element")
    instance.initialise()
    r = 0.5 * SLIP / STIFFNESS
    # N·m, down and up again
    preloads = np.concatenate([np.linspace(8, 2, 601), np.linspace(2, 8, 601)])
    for index, preload in enumerate(preloads):
        instance.set({"a.y": r, "preload": preload})
        instance.step(index * H, H)
    instance.step(len(preloads) * H, H)
    heat, place = instance.get("energy.dissipated", "joint.jenkins_slider_y")
    # from ½ k r² to ½ h²/k at a quarter of the preload
    quarter = 0.25 * SLIP
    assert heat == pytest.approx(0.5 * STIFFNESS * r**2 - 0.5 * quarter**2 / STIFFNESS, rel=1e-9)
    assert place == pytest.approx(r - quarter / STIFFNESS, rel=1e-12)


def loads(time):
    return np.array([700.0, -400.0]) * np.sin(2 * np.pi * np.array([130.0, 170.0]) * time)


def preload_at(time, end):
    share = time / end
    return 8 - 6 * share**2 * (3 - 2 * share)


def reference(lap, end, count):
    """Runge–Kutta in many steps with a commit after each, held over communication steps as the FMU's inputs are."""
    slider = Slider(lap.table.nominal)
    state = np.zeros(4)
    slider.commit(0.0, 8.0)
    found = []
    for index in range(int(round(end / H))):
        preload, load = preload_at(index * H, end), loads((index + 0.5) * H)
        K, C, k3 = (float(np.squeeze(part)) for part in lap.table.at(preload))
        slider.commit(state[0] - state[1], preload)

        def rate(state):
            r, v = state[0] - state[1], state[2] - state[3]
            on_b = K * r + C * v + k3 * r**3 + slider.load(r, preload)
            force = load - lap.k * state[:2] - lap.c * state[2:] + np.array([-on_b, on_b])
            return np.concatenate([state[2:], force / lap.m])

        h = H / count
        for _ in range(count):
            k1 = rate(state)
            k2 = rate(state + 0.5 * h * k1)
            k3_ = rate(state + 0.5 * h * k2)
            k4 = rate(state + h * k3_)
            state = state + h / 6 * (k1 + 2 * k2 + 2 * k3_ + k4)
            slider.commit(state[0] - state[1], preload)
        found.append([*state, slider.heat])
    return np.array(found)


@both_versions
def test_a_lap_that_loosens_and_slips(slave, fmi):
    """Trajectory against fine steps of a second implementation; the balance of all energies; heat that only grows."""
    end = 0.03
    lap = LooseningLap(JOINT)
    instance = slave(JOINT, "lap")
    instance.initialise()
    expected = reference(lap, end, 40)
    names = ["a.y", "b.y", "a.v", "b.v"]
    found, heat, balance = [], [0.0], []
    first = instance.get("energy.stored")[0]
    for index in range(len(expected)):
        instance.set({"preload": preload_at(index * H, end), **dict(zip(["a.F", "b.F"], loads((index + 0.5) * H)))})
        instance.step(index * H, H)
        found.append(instance.get(*names))
        stored, supplied, dissipated, by_preload = instance.get(
            "energy.stored", "energy.supplied", "energy.dissipated", "energy.preload"
        )
        heat.append(dissipated)
        balance.append(stored - first - (supplied - dissipated + by_preload))
    error = np.abs(np.array(found) - expected[:, :4]).max(axis=0) / np.abs(expected[:, :4]).max(axis=0)
    assert error.max() < 1e-4, error
    assert np.all(np.diff(heat) >= 0)
    # the slider takes a good part of the heat
    assert expected[-1, 4] > 0.2 * heat[-1]
    assert np.abs(balance).max() < 1e-4 * heat[-1], np.abs(balance).max() / heat[-1]


@both_versions
def test_in_model_exchange_it_commits_with_the_importer_s_steps(model, fmi):
    """The slider is where the return mapping with the present slip force leaves it after each completed step."""
    instance = model(JOINT, "lap")
    instance.initialise()
    instance.enter_continuous_time()
    slider, r = Slider(8.0), 3e-4
    slider.commit(0.0, 8.0)
    for preload in [8.0, 6.0, 4.0, 2.0, 6.0]:
        instance.set({"preload": preload})
        states = instance.states()
        instance.set_states(np.array([{"a.y": r}.get(name, 0.0) for name in states]))
        load = instance.get("joint.F")[0]
        table = Table(JOINT)
        K, _, k3 = table.at(preload)
        assert load == pytest.approx(K[0, 0] * r + k3[0] * r**3 + slider.load(r, preload), rel=1e-12)
        instance.fmu.completedIntegratorStep()
        slider.commit(r, preload)
        assert instance.get("joint.jenkins_slider_y")[0] == pytest.approx(slider.place, rel=1e-12)
