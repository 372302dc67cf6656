"""A joint with an elastic slider (Jenkins element): loops, heat, memory that is saved and taken back, and its lap against located events."""

import json

import numpy as np
import pytest
from instances import both_versions
from joints import body, changed, joint

K, C = 2e6, 20.0
STIFFNESS, SLIP = 3e6, 300.0
ELEMENT = changed(
    joint(["y"], [[K]], [[C]], [0.0]),
    friction=[{"dof": "y", "law": "jenkins", "stiffness": STIFFNESS, "slip_force": SLIP}],
)
BOTH = changed(
    joint(["y", "theta"], [[K, 1e3], [1e3, 900.0]], [[C, 0.1], [0.1, 0.05]], [0.0, 0.0]),
    friction=[
        {"dof": "theta", "law": "jenkins", "stiffness": 800.0, "slip_force": 0.5},
        {"dof": "y", "law": "jenkins", "stiffness": STIFFNESS, "slip_force": SLIP},
    ],
)
H = 1e-4


class Slider:
    """Return mapping as in the literature, on one relative displacement."""

    def __init__(self, stiffness, slip):
        self.stiffness, self.slip, self.place, self.heat = stiffness, slip, 0.0, 0.0

    def trial(self, r):
        elongation = r - self.place
        limit = self.slip / self.stiffness
        return self.stiffness * np.clip(elongation, -limit, limit), abs(elongation) <= limit

    def commit(self, r):
        limit = self.slip / self.stiffness
        elongation = np.clip(r - self.place, -limit, limit)
        self.heat += self.slip * abs(r - elongation - self.place)
        self.place = r - elongation


def motions(count, amplitude=4e-4):
    """Displacement and velocity of both sides at the communication points: two tones, so that loops lie in loops."""
    t = H * np.arange(count)
    r = amplitude * (np.sin(300 * t) + 0.6 * np.sin(1130 * t + 0.3))
    v = amplitude * (300 * np.cos(300 * t) + 0.6 * 1130 * np.cos(1130 * t + 0.3))
    return t, r, v


def drive(slave, start, end, outputs=("b.F", "joint.jenkins_slider_y", "energy.dissipated")):
    """Outputs at the communication points from `start` to `end`, each followed by a step."""
    t, r, v = motions(end)
    rows = []
    for index in range(start, end):
        slave.set({"a.y": 0.25 * r[index], "a.v": 0.25 * v[index], "b.y": -0.75 * r[index], "b.v": -0.75 * v[index]})
        rows.append(slave.get(*outputs))
        slave.step(t[index], H)
    return np.array(rows)


@both_versions
def test_the_loops_are_those_of_the_return_mapping(slave):
    instance = slave(ELEMENT, "element")
    instance.initialise()
    count = 1500
    found = drive(instance, 0, count)
    _, r, v = motions(count)
    slider = Slider(STIFFNESS, SLIP)
    slipped = 0
    damped = before = 0.0
    for index in range(count):
        load, sticks = slider.trial(r[index])
        slipped += not sticks
        expected = K * r[index] + C * v[index] + load
        assert found[index, 0] == pytest.approx(expected, rel=1e-12, abs=1e-9)
        # what is remembered is that of the last step
        assert found[index, 1] == pytest.approx(slider.place, rel=1e-12, abs=1e-18)
        assert found[index, 2] == pytest.approx(slider.heat + damped, rel=1e-11, abs=1e-15)
        power = C * v[index] ** 2
        damped += 0.5 * H * (power + before) if index else 0.0
        before = power
        slider.commit(r[index])
    assert 50 < slipped < count - 50


@both_versions
def test_a_cycle_costs_what_the_closed_form_says(slave):
    instance = slave(changed(ELEMENT, damping=[[0.0]]), "element")
    instance.initialise()
    amplitude = 3e-4
    path = amplitude * np.concatenate([np.linspace(0, 1, 26), *[np.linspace(1, -1, 51)[1:], np.linspace(-1, 1, 51)[1:]] * 3])
    heat = []
    for index, y in enumerate(path):
        instance.set({"a.y": y})
        instance.step(H * index, H)
        heat.append(instance.get("energy.dissipated")[0])
    # D = 4 h (U − h/k)
    expected = 4 * SLIP * (amplitude - SLIP / STIFFNESS)
    assert np.diff(heat[25::100]) == pytest.approx([expected] * 3, rel=1e-12)


@both_versions
def test_a_state_in_the_middle_of_a_loop_goes_on_to_the_bit(slave):
    straight = slave(BOTH, "element")
    straight.initialise()
    outputs = ("b.F", "b.M", "joint.jenkins_slider_y", "joint.jenkins_slider_theta", "energy.stored", "energy.dissipated")
    expected = drive(straight, 0, 400, outputs)
    other = slave(BOTH, "element")
    other.initialise()
    begun = drive(other, 0, 170, outputs)
    state = other.fmu.getFMUState()
    written = other.fmu.serializeFMUState(state)
    # a step that is taken back leaves no trace
    other.set({"a.y": 5e-3, "b.y": -5e-3})
    other.step(170 * H, H)
    assert other.get("joint.jenkins_slider_y")[0] != expected[169, 2]
    other.fmu.setFMUState(state)
    resumed = drive(other, 170, 400, outputs)
    assert np.array_equal(np.concatenate([begun, resumed]), expected)
    third = slave(BOTH, "element")
    third.initialise()
    third.fmu.setFMUState(third.fmu.deserializeFMUState(written))
    assert np.array_equal(drive(third, 170, 400, outputs), expected[170:])


@both_versions
def test_derivatives_are_the_tangent_of_the_trial(slave):
    instance = slave(ELEMENT, "element")
    instance.initialise()

    def tangent():
        arguments = ([instance.reference["b.F"]], [instance.reference["a.y"]])
        function = instance.fmu.getDirectionalDerivative
        return function(*arguments, [1.0])[0]

    instance.set({"a.y": 0.5 * SLIP / STIFFNESS})
    assert tangent() == K + STIFFNESS
    instance.set({"a.y": 2.5 * SLIP / STIFFNESS})
    assert tangent() == K
    # nothing was committed by looking
    instance.set({"a.y": 0.5 * SLIP / STIFFNESS})
    assert tangent() == K + STIFFNESS


# m = 1, k = 0.75, c = 0.01 with an elastic slider under F cos ωt; the other body does not move.
OMEGA, FORCE = 0.9, 0.15
LAP = changed(
    joint(["y"], [[0.0]], [[0.0]], [0.0], {"a": body([1.0], [0.75], [0.01]), "b": body([1e12], [0.0], [0.0])}),
    friction=[{"dof": "y", "law": "jenkins", "stiffness": 0.25, "slip_force": 0.06}],
)


@both_versions
@pytest.mark.parametrize("steps, tolerance, imbalance", [(200, 5e-4, 1e-7), (1600, 1e-5, 1e-9)])
def test_a_lap_follows_the_located_events(slave, steps, tolerance, imbalance):
    size = 2 * np.pi / OMEGA / steps
    instance = slave(LAP, "lap", "--step-size-max", repr(size))
    instance.initialise()
    work = position = 0.0
    for index in range(20 * steps):
        # the mean over a step in which the load is held
        load = FORCE * np.cos(OMEGA * (index + 0.5) * size) * np.sinc(OMEGA * size / 2 / np.pi)
        instance.set({"a.F": load})
        instance.step(index * size, size)
        moved = instance.get("a.y")[0]
        work += load * (moved - position)
        position = moved
    y, v, stored, heat = instance.get("a.y", "a.v", "energy.stored", "energy.dissipated")
    # DOP853 with located events of sticking and slipping
    assert abs(y + 2.34144094) < tolerance and abs(v - 1.27718301) < tolerance
    assert abs(work - stored - heat) < imbalance * work


@both_versions
def test_model_exchange_commits_completed_steps_alone(slave, model):
    """The importer's Runge–Kutta steps with a commit after each are those of the library, but for its cuts where the joint turns."""
    steps = 400
    size = 2 * np.pi / OMEGA / steps
    inner = slave(LAP, "lap", "--step-size-max", repr(size))
    outer = model(LAP, "lap", "--step-size-max", repr(size))
    inner.initialise(**{"a.F": FORCE})
    outer.initialise(**{"a.F": FORCE})
    outer.enter_continuous_time()
    x = outer.get_states()
    heat = outer.states().index("energy.dissipated")

    def rate(at):
        outer.set_states(at)
        return outer.get_rates()

    for index in range(2 * steps):
        k1 = rate(x)
        k2 = rate(x + size / 2 * k1)
        k3 = rate(x + size / 2 * k2)
        k4 = rate(x + size * k3)
        x = x + size / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        outer.fmu.setTime((index + 1) * size)
        outer.set_states(x)
        outer.fmu.completedIntegratorStep()
        inner.step(index * size, size)
    names = ("a.y", "a.v", "joint.jenkins_slider_y", "joint.F")
    assert outer.get(*names) == pytest.approx(inner.get(*names), rel=3e-4)
    assert abs(outer.get("joint.jenkins_slider_y")[0]) > 0.05
    # the importer integrates the power of slipping; the library knows the heat of each way
    assert x[heat] == pytest.approx(inner.get("energy.dissipated")[0], rel=1e-2)


@pytest.mark.parametrize(
    "entry, message",
    [
        ({"law": "coulomb"}, "jenkins"),
        ({"dof": "z"}, "joint.dofs"),
        ({"slip_force": -1.0}, "slip_force"),
        ({"stiffness": None}, "stiffness"),
        ({"exponent": 0.5}, "exponent"),
    ],
)
def test_wrong_entries_are_refused_by_name(run, tmp_path, entry, message):
    first = {key: value for key, value in {**ELEMENT["joint"]["friction"][0], **entry}.items() if value is not None}
    path = tmp_path / "wrong.joint.json"
    path.write_text(json.dumps(changed(ELEMENT, friction=[first])))
    said = run("export", path, "-o", tmp_path / "wrong.fmu", expect=1).stderr
    assert "friction[0]" in said and message in said
    assert not (tmp_path / "wrong.fmu").exists()


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_the_program_s_own_check_finds_nothing(export, run, interface, fmi):
    run("check", export(LAP if interface == "lap" else BOTH, interface, fmi=fmi))
