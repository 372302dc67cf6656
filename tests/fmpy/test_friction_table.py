"""Friction of which more than the slip force depends on the preload: a table of all parameters, and a bolt that loosens."""

import numpy as np
import pytest
from instances import both_versions
from joints import LOOSENING_1, changed
from loosening import LooseningLap, Table
from sliders import LAWS, PRELOADS, Iwan, Jenkins, Valanis, table_of

H = 1e-4
LUGRE = [
    {
        "dof": "y", "law": "lugre", "stiffness": k, "bristle_damping": 40.0, "damping": 30.0, "slip_force": h,
        "static_force": 1.5 * h, "stribeck_velocity": 1e-2,
    }
    for k, h in Jenkins.table
]
BOUC_WEN = [
    {"dof": "y", "law": "bouc-wen", "stiffness": 8e5, "slip_force": h, "exponent": n, "beta": 0.7, "gamma": 0.3}
    for (_, h), n in zip(Jenkins.table, [1.0, 1.2, 1.5, 1.3])
]


def with_table(friction):
    table = {**LOOSENING_1["joint"]["over_preload"], "friction": friction}
    assert table["preload"] == PRELOADS.tolist()
    return changed(LOOSENING_1, over_preload=table)


def of_laws(*laws):
    return with_table(table_of(*laws))


ALL = with_table([[*own, z, w] for own, z, w in zip(table_of(*LAWS), LUGRE, BOUC_WEN)])


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
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_an_element_on_a_random_path(slave, fmi, law):
    instance = slave(of_laws(law), "element")
    table, own, count = Table(LOOSENING_1), law(), 250
    instance.initialise()
    heats, scale = [], 60.0
    for index, (r, preload) in enumerate(zip(*course(count, 11))):
        instance.set({"a.y": r, "preload": preload})
        K, _, k3 = table.at(preload)
        load, stored, heat = instance.get("b.F", "energy.stored", "energy.dissipated")
        assert load == pytest.approx(K[0, 0] * r + k3[0] * r**3 + own.load(r, preload), rel=law.tolerance, abs=law.tolerance * scale)
        springs = table.energy(preload, np.array([r]))
        energy = law.tolerance * 1e-3 * scale
        assert stored == pytest.approx(springs + own.stored(r, preload), rel=law.tolerance, abs=energy)
        assert heat == pytest.approx(own.heat, rel=law.tolerance, abs=energy)
        instance.step(index * H, H)
        own.commit(r, preload)
        heats.append(heat)
    assert np.all(np.diff(heats) >= 0) and heats[-1] > 1e-3


@both_versions
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_in_place_springs_give_up_heat_and_what_the_preload_does(slave, fmi, law):
    """The motion is held while the preload goes at random: what is stored changes by the preload's work, less the heat."""
    instance = slave(of_laws(law), "element")
    table, random, own = Table(LOOSENING_1), np.random.default_rng(3), law()
    instance.initialise()
    time = 0.0

    def step(r, preload):
        nonlocal time
        instance.set({"a.y": r, "preload": preload})
        instance.step(time, H)
        time += H
        own.commit(r, preload)
        stored, heat = instance.get("energy.stored", "energy.dissipated")
        return stored - table.energy(preload, np.array([r])), heat

    for r in [0.0, 2.2e-4, -0.7e-4, 1.1e-4]:
        stored, heat = step(r, 8.0)
    let_go = 0.0
    for preload in np.append(random.uniform(2, 8, 12), [2.0, 8.0]):
        by_preload = own.springs(own.preload, preload) - own.springs(own.preload, own.preload)
        after, now = step(r, preload)
        assert now - heat >= 0
        assert after - stored == pytest.approx(by_preload - (now - heat), abs=1e-14)
        let_go += now - heat
        stored, heat = after, now
    assert let_go > 1e-5


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
@pytest.mark.parametrize("preload", [2.0, 5.0, 8.0])
def test_at_each_preload_it_is_what_is_exported_there(slave, fmi, law, preload):
    """At a preload that stays the FMU is the one of `--preload`: passive, as that is."""
    moving = slave(of_laws(law), "element")
    held = slave(of_laws(law), "element", "--preload", str(preload))
    moving.initialise(preload=preload)
    held.initialise()
    for index, r in enumerate(course(120, 2)[0]):
        for instance in (moving, held):
            instance.set({"a.y": r})
        names = ["b.F", "energy.stored", "energy.dissipated", "power.dissipated"]
        expected = held.get(*names)
        assert moving.get(*names) == pytest.approx(expected, rel=1e-11, abs=1e-13)
        for instance in (moving, held):
            instance.step(index * H, H)


@both_versions
def test_it_has_no_parameters_of_friction(slave, fmi):
    instance = slave(ALL, "element")
    names = set(instance.reference)
    assert {"preload", "joint.jenkins_slider_y", "joint.iwan_reversal_y", "joint.lugre_z_y"} <= names
    assert not [name for name in names if name.startswith(("joint.jenkins_k", "joint.iwan_h", "joint.lugre_s0"))]


@both_versions
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_a_state_in_the_middle_goes_on_to_the_bit(slave, fmi, interface):
    names = ["joint.F", "energy.stored", "energy.dissipated", "joint.iwan_reversal_y", "joint.valanis_p_y"]
    r, preload = course(200, 4)
    is_lap = interface == "lap"

    def drive(instance, start, end):
        rows = []
        for index in range(start, end):
            motion = {"a.F": 3e6 * r[index]} if is_lap else {"a.y": r[index]}
            instance.set({**motion, "preload": preload[index]})
            rows.append(instance.get(*names))
            instance.step(index * H, H)
        return np.array(rows)

    whole, other, third = [slave(ALL, interface) for _ in range(3)]
    for instance in (whole, other, third):
        instance.initialise()
    expected = drive(whole, 0, 200)
    begun = drive(other, 0, 90)
    state = other.fmu.getFMUState()
    written = other.fmu.serializeFMUState(state)
    other.set({"a.F" if is_lap else "a.y": 1e-3, "preload": 2.0})
    other.step(90 * H, H)
    other.fmu.setFMUState(state)
    assert np.array_equal(np.concatenate([begun, drive(other, 90, 200)]), expected)
    third.fmu.setFMUState(third.fmu.deserializeFMUState(written))
    assert np.array_equal(drive(third, 90, 200), expected[90:])


@pytest.mark.parametrize("law", [Jenkins, Iwan, Valanis], ids=lambda law: law.law)
@pytest.mark.parametrize("course_of_preload", ["held", "moving"])
def test_a_lap_balances_while_its_bolt_loosens(slave, fmi, law, course_of_preload):
    instance = slave(of_laws(law), "lap")
    instance.initialise()
    count, end = 600, 0.06
    first, heat, balance, taken = instance.get("energy.stored")[0], [0.0], [], []
    random = np.random.default_rng(8)
    noise = np.repeat(random.uniform(-0.5, 0.5, count // 20), 20)
    moving = course_of_preload == "moving" and instance.is_fmi2
    for index in range(count):
        share = index / count
        preload = np.clip(8 - 5 * share + noise[index], 2.1, 8) if not moving else 7.5 - 5 * share
        instance.set({
            "preload": preload,
            "a.F": 700 * np.sin(2 * np.pi * 130 * index * H),
            "b.F": -400 * np.sin(2 * np.pi * 170 * index * H),
        })
        if moving:
            instance.fmu.setRealInputDerivatives([instance.reference["preload"]], [1], [-5 / end])
        instance.step(index * end / count, end / count)
        stored, supplied, dissipated, by_preload = instance.get(
            "energy.stored", "energy.supplied", "energy.dissipated", "energy.preload"
        )
        heat.append(dissipated)
        taken.append(by_preload)
        balance.append(stored - first - (supplied - dissipated + by_preload))
    assert np.all(np.diff(heat) >= 0)
    # corners of a Jenkins element, and heat of a way on which the preload moves, are as exact as the steps are short
    part = 1e-7 if not moving and law is not Jenkins else 1e-4
    assert np.abs(balance).max() < part * heat[-1], np.abs(balance).max() / heat[-1]
    # what the springs of friction give back to a bolt that loosens is far more than that
    assert taken[-1] < -1e-2 * heat[-1]


def reference(law, lap, end, count):
    """Runge–Kutta in many steps with a commit after each; inputs are held over communication steps."""
    slider = law()
    state, found, given = np.zeros(4), [], 0.0
    slider.commit(0.0, 8.0)
    for index in range(int(round(end / H))):
        preload, load = preload_at(index * H, end), loads((index + 0.5) * H)
        K, C, k3 = (float(np.squeeze(part)) for part in lap.table.at(preload))
        given += slider.springs(slider.preload, preload) - slider.springs(slider.preload, slider.preload)
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
        found.append(state)
    return np.array(found), slider.heat, given


def loads(time):
    return np.array([700.0, -400.0]) * np.sin(2 * np.pi * np.array([130.0, 170.0]) * time)


def preload_at(time, end):
    share = time / end
    return 8 - 5.9 * share**2 * (3 - 2 * share)


@pytest.mark.parametrize("law", [Jenkins, Iwan], ids=lambda law: law.law)
def test_a_lap_that_loosens(slave, fmi, law):
    """Trajectory against fine steps of a second implementation."""
    end, joint = 0.03, of_laws(law)
    expected, heat, given = reference(law, LooseningLap(joint), end, 16)
    assert heat > 0 > given
    instance = slave(joint, "lap")
    instance.initialise()
    found = []
    for index in range(len(expected)):
        instance.set({"preload": preload_at(index * H, end), **dict(zip(["a.F", "b.F"], loads((index + 0.5) * H)))})
        instance.step(index * H, H)
        found.append(instance.get("a.y", "b.y", "a.v", "b.v"))
    error = np.abs(np.array(found) - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert error.max() < 1e-4, error


@both_versions
@pytest.mark.parametrize("law", [Jenkins, Iwan, Valanis], ids=lambda law: law.law)
def test_in_model_exchange_it_commits_with_the_importer_s_steps(model, fmi, law):
    instance = model(of_laws(law), "lap")
    instance.initialise()
    instance.enter_continuous_time()
    slider, table = law(), Table(LOOSENING_1)
    slider.commit(0.0, 8.0)
    for index, (r, preload) in enumerate(zip([3e-4, 3e-4, 1e-4, 2e-4, 2e-4, 0.0], [8.0, 6.0, 4.0, 2.1, 6.0, 7.0])):
        instance.set({"preload": preload})
        states = instance.states()
        instance.set_states(np.array([{"a.y": r}.get(name, 0.0) for name in states]))
        load, by_preload, stored = instance.get("joint.F", "energy.preload", "energy.stored")
        K, _, k3 = table.at(preload)
        # the integrator's heat of what slides is not in the states that are set: what is left is all the preload's
        own = table.energy(preload, np.array([r])) + slider.stored(r, preload) + 0.5 * BODY_A * r**2
        assert load == pytest.approx(K[0, 0] * r + k3[0] * r**3 + slider.load(r, preload), rel=1e-10)
        assert stored == pytest.approx(own, rel=1e-10)
        assert by_preload == pytest.approx(stored, rel=1e-10)
        instance.fmu.completedIntegratorStep()
        slider.commit(r, preload)


BODY_A = LOOSENING_1["bodies"]["a"]["stiffness"][0]


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("law", [*LAWS, None], ids=lambda law: law.law if law else "all")
def test_derivatives_are_those_of_differences(slave, fmi, interface, law):
    """By the preload and by the motion, of loads and energies, after a way of some points."""
    joint = of_laws(law) if law else ALL
    instance = slave(joint, interface)
    instance.initialise()
    place = "a.F" if interface == "lap" else "a.y"
    size = 3e6 if interface == "lap" else 1.0
    for index, (r, preload) in enumerate([(2e-4, 8.0), (-1e-4, 5.0), (0.5e-4, 6.0)]):
        instance.set({place: size * r, "preload": preload})
        instance.step(index * H, H)
    at, step = {"preload": 5.5}, {"preload": 1e-5}
    if interface == "element":
        at["a.y"], step["a.y"] = 3e-4, 1e-9
    outputs = ["joint.F", "energy.stored"] + (["energy.preload"] if interface == "lap" else [])
    for name in at:
        values = []
        for sign in (1, -1, 0):
            instance.set({other: value + (sign * step[name] if other == name else 0.0) for other, value in at.items()})
            values.append(np.array(instance.get(*outputs)))
        arguments = ([instance.reference[output] for output in outputs], [instance.reference[name]])
        found = instance.fmu.getDirectionalDerivative(*arguments, [1.0])
        expected = (values[0] - values[1]) / (2 * step[name])
        scale = np.abs(values[2]) / at[name]
        error = np.abs(np.array(found) - expected)
        assert np.all(error < 1e-6 * (np.abs(expected) + scale)), (name, found, expected)


@pytest.mark.parametrize("fmi", ["2"])
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_power_of_a_preload_that_moves(slave, fmi, law):
    """½ Σ (dk/dp) e² ṗ beside that of the springs, and its derivatives by motion and preload."""
    instance = slave(of_laws(law), "element")
    instance.initialise()
    slider, table = law(), Table(LOOSENING_1)
    for index, (r, preload) in enumerate([(2e-4, 8.0), (-1e-4, 5.0), (0.5e-4, 6.4)]):
        instance.set({"a.y": r, "preload": preload})
        instance.step(index * H, H)
        slider.commit(r, preload)
    rate, step = -30.0, 1e-4
    instance.fmu.setRealInputDerivatives([instance.reference["preload"]], [1], [rate])
    instance.set({"preload": preload})
    slope = (slider.springs(preload, preload + step) - slider.springs(preload, preload - step)) / (2 * step)
    expected = rate * (slope + table.energy(preload, np.array([r]), 1))
    assert instance.get("power.preload")[0] == pytest.approx(expected, rel=1e-7)
    # away from where it has just slipped
    r -= 1e-5
    for name, at, by in [("a.y", r, 1e-9), ("preload", preload, 1e-5)]:
        instance.set({"a.y": r})
        values = []
        for sign in (1, -1, 0):
            instance.set({name: at + sign * by})
            values.append(instance.get("power.preload")[0])
        arguments = ([instance.reference["power.preload"]], [instance.reference[name]])
        found = instance.fmu.getDirectionalDerivative(*arguments, [1.0])[0]
        difference = (values[0] - values[1]) / (2 * by)
        assert found == pytest.approx(difference, rel=1e-5, abs=1e-5 * abs(values[2] / at))


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_the_program_s_own_check_finds_nothing(export, run, interface, fmi):
    run("check", export(ALL, interface, fmi=fmi))
