"""Several laws of one kind on one degree of freedom, as sliders side by side that stand for a continuum of them."""

import json

import numpy as np
import pytest
from instances import both_versions
from joints import body, changed, joint

K, C = 2e6, 20.0
# stiffness and slip force of each
SLIDERS_Y = [(3e6, 300.0), (1e6, 50.0), (2e6, 400.0), (5e5, 20.0)]
SLIDERS_THETA = [(800.0, 0.5), (300.0, 0.05)]
DAHL_Y = [(4e5, 60.0), (9e5, 30.0)]


def sliders(dof, law, numbers):
    return [{"dof": dof, "law": law, "stiffness": k, "slip_force": h} for k, h in numbers]


JOINT = changed(
    joint(["y", "theta"], [[K, 0.0], [0.0, 900.0]], [[C, 0.0], [0.0, 0.05]], [0.0, 0.0]),
    friction=[
        *sliders("y", "jenkins", SLIDERS_Y[:1]),
        *sliders("theta", "jenkins", SLIDERS_THETA),
        *sliders("y", "dahl", DAHL_Y),
        *sliders("y", "jenkins", SLIDERS_Y[1:]),
    ],
)
PLACES_Y = [f"joint.jenkins{number}_slider_y" for number in ["", "_2", "_3", "_4"]]
PLACES_THETA = [f"joint.jenkins{number}_slider_theta" for number in ["", "_2"]]
DAHL_LOADS = ["joint.dahl_p_y", "joint.dahl_2_p_y"]
H = 1e-4


class Jenkins:
    """Return mapping."""

    def __init__(self, stiffness, slip):
        self.stiffness, self.slip, self.place, self.heat = stiffness, slip, 0.0, 0.0

    @property
    def remembered(self):
        return self.place

    def load(self, r):
        return np.clip(self.stiffness * (r - self.place), -self.slip, self.slip)

    def commit(self, r):
        place = r - self.load(r) / self.stiffness
        self.heat += self.slip * abs(place - self.place)
        self.place = place


class Dahl:
    """1 − s p/h falls by e^(−k|Δr|/h) on a way; its heat is the work less what is stored."""

    def __init__(self, stiffness, slip):
        self.stiffness, self.slip, self.place, self.p, self.heat = stiffness, slip, 0.0, 0.0, 0.0

    @property
    def remembered(self):
        return self.p

    def load(self, r):
        s = np.sign(r - self.place)
        return s * self.slip - (s * self.slip - self.p) * np.exp(-self.stiffness * abs(r - self.place) / self.slip)

    def commit(self, r):
        p, s, k, h = self.load(r), np.sign(r - self.place), self.stiffness, self.slip
        # ∫ p dr with p = s h − (s h − p₀) e^(−k|r|/h)
        work = h * abs(r - self.place) - h / k * (p - self.p) * s
        self.heat += work - 0.5 * (p**2 - self.p**2) / k
        self.place, self.p = r, p


def laws(*kinds):
    return [kind(*numbers) for kind, all in kinds for numbers in all]


def motion(index):
    """Relative motions and velocities of y and theta: tones, so that loops lie in loops."""
    t = H * index
    y = 4e-4 * np.array([np.sin(300 * t) + 0.6 * np.sin(1130 * t + 0.3), 300 * np.cos(300 * t) + 678 * np.cos(1130 * t + 0.3)])
    theta = 3e-3 * np.array([np.sin(410 * t), 410 * np.cos(410 * t)])
    return y, theta


NAMES = ["b.F", "b.M", "energy.stored", "energy.dissipated", *PLACES_Y, *DAHL_LOADS, *PLACES_THETA]


def drive(slave, start, end):
    rows = []
    for index in range(start, end):
        y, theta = motion(index)
        slave.set({"a.y": y[0], "a.v": y[1], "b.theta": -theta[0], "b.omega": -theta[1]})
        rows.append(slave.get(*NAMES))
        slave.step(index * H, H)
    return np.array(rows)


@both_versions
def test_the_load_is_the_sum_of_all(slave):
    instance = slave(JOINT, "element")
    instance.initialise()
    count = 800
    found = drive(instance, 0, count)
    on_y, on_theta = laws((Jenkins, SLIDERS_Y), (Dahl, DAHL_Y)), laws((Jenkins, SLIDERS_THETA))
    damped = before = 0.0
    for index in range(count):
        (y, v), (theta, omega) = motion(index)
        loads_y, loads_theta = [law.load(y) for law in on_y], [law.load(theta) for law in on_theta]
        expected = [K * y + C * v + sum(loads_y), 900.0 * theta + 0.05 * omega + sum(loads_theta)]
        assert found[index, :2] == pytest.approx(expected, rel=1e-12, abs=1e-9)
        springs = 0.5 * (K * y**2 + 900.0 * theta**2)
        stored = springs + sum(0.5 * load**2 / law.stiffness for law, load in zip(on_y + on_theta, loads_y + loads_theta))
        assert found[index, 2] == pytest.approx(stored, rel=1e-12)
        heat = damped + sum(law.heat for law in on_y + on_theta)
        assert found[index, 3] == pytest.approx(heat, rel=1e-11, abs=1e-15)
        # what is remembered is that of the last step
        assert found[index, 4:] == pytest.approx([law.remembered for law in on_y + on_theta], rel=1e-11, abs=1e-16)
        power = C * v**2 + 0.05 * omega**2
        damped += 0.5 * H * (power + before) if index else 0.0
        before = power
        for law, at in [(law, y) for law in on_y] + [(law, theta) for law in on_theta]:
            law.commit(at)
    assert len({law.place for law in on_y[:4]}) == 4 and min(law.heat for law in on_y + on_theta) > 0


@both_versions
def test_a_state_in_the_middle_of_a_loop_goes_on_to_the_bit(slave):
    straight = slave(JOINT, "element")
    straight.initialise()
    expected = drive(straight, 0, 400)
    other = slave(JOINT, "element")
    other.initialise()
    begun = drive(other, 0, 170)
    state = other.fmu.getFMUState()
    written = other.fmu.serializeFMUState(state)
    # a step that is taken back leaves no trace
    other.set({"a.y": 5e-3})
    other.step(170 * H, H)
    assert other.get(PLACES_Y[3])[0] != expected[169, NAMES.index(PLACES_Y[3])]
    other.fmu.setFMUState(state)
    assert np.array_equal(np.concatenate([begun, drive(other, 170, 400)]), expected)
    third = slave(JOINT, "element")
    third.initialise()
    third.fmu.setFMUState(third.fmu.deserializeFMUState(written))
    assert np.array_equal(drive(third, 170, 400), expected[170:])


@both_versions
def test_parameters_of_each_can_be_set(slave):
    """A second slider that is set to nothing is none."""
    instance = slave(JOINT, "element")
    instance.initialise(**{"joint.jenkins_2_k_y": 0.0, "joint.jenkins_2_h_y": 0.0, "joint.dahl_2_h_y": 12.5})
    y = 2e-4
    instance.set({"a.y": y})
    left = [*laws((Jenkins, SLIDERS_Y[:1] + SLIDERS_Y[2:])), Dahl(*DAHL_Y[0]), Dahl(DAHL_Y[1][0], 12.5)]
    assert instance.get("b.F")[0] == pytest.approx(K * y + sum(law.load(y) for law in left), rel=1e-12)
    # the tangent: what sticks, and the springs
    arguments = ([instance.reference["b.F"]], [instance.reference["joint.jenkins_3_k_y"]])
    assert instance.fmu.getDirectionalDerivative(*arguments, [1.0])[0] == pytest.approx(y, rel=1e-12)


OMEGA, FORCE = 0.9, 0.15


def lap(parts):
    bodies = {"a": body([1.0], [0.75], [0.01]), "b": body([1e12], [0.0], [0.0])}
    return changed(joint(["y"], [[0.0]], [[0.0]], [0.0], bodies), friction=sliders("y", "jenkins", parts))


@both_versions
def test_a_lap_of_equal_parts_is_that_of_the_whole(slave):
    """Four sliders of one slip displacement are one; m = 1, k = 0.75, c = 0.01 under F cos ωt."""
    steps = 1600
    size = 2 * np.pi / OMEGA / steps
    instance = slave(lap([(0.25 * part, 0.06 * part) for part in [0.1, 0.4, 0.3, 0.2]]), "lap", "--step-size-max", repr(size))
    instance.initialise()
    for index in range(20 * steps):
        instance.set({"a.F": FORCE * np.cos(OMEGA * (index + 0.5) * size) * np.sinc(OMEGA * size / 2 / np.pi)})
        instance.step(index * size, size)
    y, v = instance.get("a.y", "a.v")
    # DOP853 with located events of sticking and slipping
    assert abs(y + 2.34144094) < 1e-5 and abs(v - 1.27718301) < 1e-5


@both_versions
def test_a_lap_of_different_sliders_against_fine_steps(slave):
    parts = [(0.1, 0.01), (0.08, 0.04), (0.07, 0.1)]
    steps = 200
    size = 2 * np.pi / OMEGA / steps
    instance = slave(lap(parts), "lap", "--step-size-max", repr(size))
    instance.initialise()
    on_y = laws((Jenkins, parts))
    state, fine = np.zeros(2), 25
    work = position = 0.0
    for index in range(3 * steps):
        load = FORCE * np.cos(OMEGA * (index + 0.5) * size)
        instance.set({"a.F": load})
        instance.step(index * size, size)
        moved = instance.get("a.y")[0]
        work += load * (moved - position)
        position = moved

        def rate(at):
            return np.array([at[1], load - 0.75 * at[0] - 0.01 * at[1] - sum(law.load(at[0]) for law in on_y)])

        h = size / fine
        for _ in range(fine):
            k1 = rate(state)
            k2 = rate(state + 0.5 * h * k1)
            k3 = rate(state + 0.5 * h * k2)
            state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(state + h * k3))
            for law in on_y:
                law.commit(state[0])
    y, v, stored, heat = instance.get("a.y", "a.v", "energy.stored", "energy.dissipated")
    assert abs(y - state[0]) < 1e-5 and abs(v - state[1]) < 1e-5
    assert abs(work - stored - heat) < 1e-6 * work


def test_more_than_there_is_room_for_is_refused_with_the_number(run, tmp_path):
    for law, at_most in [("jenkins", 4), ("dahl", 2)]:
        path = tmp_path / "many.joint.json"
        path.write_text(json.dumps(changed(JOINT, friction=sliders("y", law, [(1e6, 100.0)] * (at_most + 1)))))
        said = run("export", path, "-o", tmp_path / "many.fmu", expect=1).stderr
        assert f"friction[{at_most}].law" in said and f'"{law}" number {at_most + 1}' in said
        assert f"expected {at_most} of that kind at the most" in said
        assert not (tmp_path / "many.fmu").exists()


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_the_program_s_own_check_finds_nothing(export, run, interface, fmi):
    given = lap([(0.1, 0.01), (0.08, 0.04), (0.07, 0.1)]) if interface == "lap" else JOINT
    run("check", export(given, interface, fmi=fmi))
