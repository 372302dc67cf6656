"""Joints of an assembly over the preload of their bolt, an input of the FMU, beside SciPy and the element's FMU."""

import json
import re

import fmpy
import numpy as np
import pytest
import small
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from instances import Slave, both_versions
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

PRELOADS = np.array([4.0, 8.0, 12.0, 20.0])
STIFFNESS = np.array([2e5, 3.2e5, 4e5, 4.4e5])
DAMPING = np.array([60.0, 30.0, 20.0, 18.0])
CUBIC = np.array([2e12, 1.5e12, 1e12, 5e11])
NOMINAL, LOAD = 12.0, 200.0
NAMES = ("root.y", "tip.y", "root.v", "tip.v")
ENERGIES = ("energy.supplied", "energy.dissipated", "energy.preload")

# SciPy has the slopes of Fritsch and Butland too
stiffness, damping, cubic = (PchipInterpolator(PRELOADS, values) for values in (STIFFNESS, DAMPING, CUBIC))


@pytest.fixture
def fmi(request):
    """FMI 2.0 where inputs have derivatives, else 3.0."""
    callspec = getattr(request.node, "callspec", None)
    if callspec and "fmi" in callspec.params:
        return callspec.params["fmi"]
    return "2" if "ramp" in request.node.name else "3"


def write(folder, preload="", friction=None, friction_table=None, **changes):
    """The small assembly, its joint over the preload."""
    table = {
        "preload": list(PRELOADS),
        "nominal": NOMINAL,
        "stiffness": [[[k]] for k in STIFFNESS],
        "damping": [[[c]] for c in DAMPING],
        "cubic": [[k3] for k3 in CUBIC],
        **changes,
        **({"friction": friction_table} if friction_table else {}),
    }
    path = small.write(folder, {})
    joint = {"dofs": ["y"], "over_preload": table, **({"friction": friction} if friction else {})}
    file = folder / "lap.joint.json"
    file.write_text(json.dumps({"format": "bolted-joint/1", "name": "lap", "joint": joint}))
    path.write_text(path.read_text().replace('file = "lap.joint.json"', f'file = "lap.joint.json"\n{preload}'))
    return path


def energy(r, p):
    return stiffness(p) * r**2 / 2 + cubic(p) * r**4 / 4


def rates(load, preload, preload_rate, friction=lambda r, time: 0.0):
    """Of x_a, x_b, v_a, v_b, and of the work, the heat, and the energy by the preload."""

    def of(time, state):
        x_a, x_b, v_a, v_b = state[:4]
        r, v, p = x_a - x_b, v_a - v_b, preload(time)
        extra = stiffness(p) * r + damping(p) * v + cubic(p) * r**3 + friction(r, time)
        force = extra - small.STIFFNESS * r - small.DAMPING * v
        motion = small.rates(state[:4], load(time), force)
        rate = preload_rate(time)
        own = stiffness(p, 1) * r**2 / 2 + cubic(p, 1) * r**4 / 4
        supports = 2 * small.RATIO * small.OMEGA / small.SHAPE**2 * v_a**2
        return [*motion, load(time) * v_b, damping(p) * v**2 + supports, own * rate]

    return of


def integrated(rate, begin, end, state):
    return solve_ivp(rate, (begin, end), state, method="DOP853", rtol=1e-12, atol=1e-18).y[:, -1]


def errors(found, expected):
    """Of each, as a part of its largest magnitude; of the energies of all of them."""
    found, expected = np.array(found), np.array(expected)
    scale = np.abs(expected).max(axis=0)
    scale[4:] = scale[4:].max()
    return np.abs(found - expected).max(axis=0) / scale


def ramp(time):
    return np.clip(20.0 - 16.0 * time / 0.02, 4.0, 20.0)


@pytest.mark.parametrize("step", [2e-5, 1e-4, 1e-3])
def test_a_ramp_is_that_of_scipy(slave, tmp_path, step):
    """Through all of the table, and back to its middle, with the rate told."""
    fmu = slave(write(tmp_path))
    fmu.initialise(**{"lap.preload": 20.0})
    begun = fmu.get("energy.stored")[0]
    rate_of = rates(lambda _: LOAD, ramp, lambda _: -800.0)
    state, found, expected, stored = np.zeros(7), [], [], []
    for place in range(round(0.02 / step)):
        time = place * step
        fmu.set({"push.F": LOAD, "lap.preload": ramp(time)})
        fmu.fmu.setRealInputDerivatives([fmu.reference["lap.preload"]], [1], [-800.0])
        fmu.step(time, step)
        # the knots of the table are at whole milliseconds
        state = integrated(rate_of, time, time + step, state)
        found.append(fmu.get(*NAMES, *ENERGIES))
        expected.append(state)
        stored.append(fmu.get("energy.stored")[0] - begun)
    assert errors(found, expected).max() < 1e-6, errors(found, expected)
    balance = np.array(stored) - np.array(expected)[:, 4:] @ [1, -1, 1]
    scale = np.abs(np.array(expected)[:, 4:]).max()
    assert np.abs(balance).max() < 1e-6 * scale
    assert np.abs(np.array(expected)[:, 6]).max() > 0.01 * scale, "the preload does no work to speak of"


@both_versions
@pytest.mark.parametrize("step", [1e-5, 2e-4])
def test_a_preload_that_jumps_is_that_of_scipy(slave, tmp_path, step):
    """From one within the table to another each two milliseconds, and held meanwhile: steps are prepared for some."""
    fmu = slave(write(tmp_path))
    fmu.initialise(**{"push.F": LOAD})
    state, before = np.zeros(7), NOMINAL
    found, expected = [], []
    count = round(2e-3 / step)
    for level, preload in enumerate([12.0, 5.5, 17.0, 4.0, 9.3, 20.0, 9.3, 4.0]):
        fmu.set({"lap.preload": preload})
        r = state[0] - state[1]
        state[6] += energy(r, preload) - energy(r, before)
        before = preload
        for place in range(level * count, (level + 1) * count):
            fmu.step(place * step, step)
        state = integrated(
            rates(lambda _: LOAD, lambda _, p=preload: p, lambda _: 0.0), level * 2e-3, (level + 1) * 2e-3, state
        )
        found.append(fmu.get(*NAMES, *ENERGIES))
        expected.append(state.copy())
    assert errors(found, expected).max() < 1e-6, errors(found, expected)
    assert np.abs(np.array(expected)[:, 6]).max() > 0.01 * np.abs(np.array(expected)[:, 4:]).max()


@pytest.mark.parametrize("factor, step, count", [(1.0, 1e-3, 40), (1e7, 0.05, 1)])
def test_a_preload_that_stays_leaves_a_linear_joint_exact(slave, tmp_path, factor, step, count):
    """At a preload between those of the table, in steps of a whole period; the stiff joint's step is too long for what it has beyond
    the table's nearest point."""
    fmu = slave(write(tmp_path, cubic=[[0.0]] * 4, stiffness=[[[factor * k]] for k in STIFFNESS]))
    fmu.initialise(**{"push.F": LOAD, "lap.preload": 9.7})
    for place in range(count):
        fmu.step(place * step, step)
    p = 9.7
    k, c = factor * stiffness(p), damping(p)
    mass = np.diag([1 / small.SHAPE**2, small.MASS])
    own = np.array([[1, -1], [-1, 1]])
    a_k, a_c = small.OMEGA**2 / small.SHAPE**2, 2 * small.RATIO * small.OMEGA / small.SHAPE**2
    spring, damper = k * own + np.diag([a_k, 0]), c * own + np.diag([a_c, 0])
    system = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(mass, spring), -np.linalg.solve(mass, damper)]])
    values, vectors = np.linalg.eig(system)
    forced = np.concatenate([np.linalg.solve(spring, [0, LOAD]), [0, 0]])
    expected = forced + (vectors @ (np.exp(values * count * step) * np.linalg.solve(vectors, -forced))).real
    assert np.abs(np.array(fmu.get(*NAMES)) / expected - 1).max() < 1e-7


@both_versions
def test_an_importer_integrates_a_ramp(model, tmp_path):
    fmu = model(write(tmp_path))
    fmu.initialise(**{"push.F": LOAD, "lap.preload": 20.0})
    fmu.enter_continuous_time()

    def rate(time, states):
        fmu.fmu.setTime(time)
        fmu.set_states(states)
        fmu.set({"lap.preload": ramp(time)})
        return fmu.get_rates()

    state, own = np.zeros(7), fmu.get_states()
    found, expected = [], []
    for place in range(20):
        # the knots of the table are at whole milliseconds
        span = (place * 1e-3, (place + 1) * 1e-3)
        own = solve_ivp(rate, span, own, method="DOP853", rtol=1e-10, atol=1e-14).y[:, -1]
        rate(span[1], own)
        found.append(fmu.get(*NAMES, *ENERGIES))
        state = integrated(rates(lambda _: LOAD, ramp, lambda _: -800.0), *span, state)
        expected.append(state)
    assert errors(found, expected).max() < 1e-7, errors(found, expected)


@both_versions
def test_loads_are_those_of_the_element(run, slave, tmp_path):
    """Of the same joint at the same motion and preload; and the energy that both store."""
    fmu = slave(write(tmp_path))
    run("export", tmp_path / "lap.joint.json", "-o", tmp_path / "element.fmu", "--as", "element")
    fmpy.extract(str(tmp_path / "element.fmu"), str(tmp_path / "element"))
    element = Slave(tmp_path / "element")
    element.initialise()
    fmu.initialise(**{"push.F": LOAD})
    for place, preload in enumerate(np.linspace(4, 20, 33)):
        fmu.set({"lap.preload": preload})
        fmu.step(place * 1e-4, 1e-4)
        y_a, y_b, v_a, v_b = fmu.get(*NAMES)
        element.set({"a.y": y_a, "b.y": y_b, "a.v": v_a, "b.v": v_b, "preload": preload})
        found, expected = fmu.get("lap.F")[0], element.get("joint.F")[0]
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-9)
        kinetic = v_a**2 / (2 * small.SHAPE**2) + small.MASS * v_b**2 / 2
        support = small.OMEGA**2 / small.SHAPE**2 * y_a**2 / 2
        stored = element.get("energy.stored")[0] + kinetic + support
        assert fmu.get("energy.stored")[0] == pytest.approx(stored, rel=1e-12)
    element.close()


@both_versions
def test_partial_derivatives_by_the_preload(model, tmp_path):
    fmu = model(write(tmp_path))
    fmu.initialise(**{"push.F": 50.0, "lap.preload": 9.0})
    fmu.enter_continuous_time()
    states = fmu.states()
    point = np.array([1e-4, -2e-4, 0.1, 0.3, 0.0, 0.0])
    assert len(states) == len(point)
    fmu.set_states(point)
    outputs = [v.name for v in fmu.description.modelVariables if v.causality == "output" and v.name not in states]
    unknowns = outputs + [v.variable.name for v in fmu.description.derivatives]
    assert "energy.preload" in unknowns

    def at(preload):
        fmu.set({"lap.preload": preload})
        return np.array(fmu.get(*unknowns))

    step = 1e-4
    expected = (at(9.0 + step) - at(9.0 - step)) / (2 * step)
    at(9.0)
    found = fmu.fmu.getDirectionalDerivative(
        [fmu.reference[name] for name in unknowns], [fmu.reference["lap.preload"]], [1.0]
    )
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-9 * np.abs(expected).max())
    assert np.abs(expected).max() > 0


@both_versions
def test_a_start_counts_no_energy_of_the_preload(slave, tmp_path):
    """While the start values are set, `energy.preload` is zero whatever they are, and so are its derivatives."""
    fmu = slave(write(tmp_path))
    fmu.enter_initialization()
    fmu.set({"modal.q2": 1e-4, "lap.preload": 7.0, "energy.supplied": 0.25})
    assert fmu.get("energy.preload") == [0.0]
    knowns = [fmu.reference[name] for name in ("modal.q2", "lap.preload")]
    for known in knowns:
        assert list(fmu.fmu.getDirectionalDerivative([fmu.reference["energy.preload"]], [known], [1.0])) == [0.0]
    fmu.fmu.exitInitializationMode()
    assert fmu.get("energy.preload")[0] == 0.0


@both_versions
def test_a_state_is_saved_while_the_preload_moves(slave, tmp_path):
    """After steps at one preload, so that the steps' own preparation is part of what is restored."""
    fmu = slave(write(tmp_path))
    fmu.initialise(**{"push.F": LOAD, "lap.preload": 9.0})
    api = fmu.fmu
    names = ("FMUstate", "deSerialize") if fmu.is_fmi2 else ("FMUState", "deserialize")
    get, restore = (getattr(api, f"{verb}{names[0]}") for verb in ("get", "set"))
    write_state, read = getattr(api, f"serialize{names[0]}"), getattr(api, f"{names[1]}{names[0]}")

    def steps(start, count, preload):
        rows = []
        for place in range(start, start + count):
            fmu.set({"lap.preload": preload(place)})
            fmu.step(place * 1e-4, 1e-4)
            rows.append(fmu.get(*NAMES, *ENERGIES))
        return np.array(rows)

    steps(0, 12, lambda _: 9.0)
    state = get()

    def later(place):
        return 9.0 if place < 30 else 6.0 + 0.1 * place

    first = steps(12, 40, later)
    steps(52, 30, lambda _: 15.0)
    restore(state)
    kept = write_state(state)
    assert (steps(12, 40, later) == first).all()
    restore(read(kept))
    assert (steps(12, 40, later) == first).all()


@pytest.mark.parametrize("step", [1e-5, 1e-4])
def test_slip_forces_follow_a_ramp(slave, tmp_path, step):
    """A slider beside the springs slips where less presses; SciPy locates every stick and slip."""
    spring, slip = 1e6, 40.0
    law = {"dof": "y", "law": "jenkins", "stiffness": spring, "slip_force": slip}
    fmu = slave(write(tmp_path, friction=[law]))
    fmu.initialise(**{"lap.preload": 20.0})
    for place in range(round(0.02 / step)):
        time = place * step
        fmu.set({"push.F": LOAD, "lap.preload": ramp(time)})
        fmu.fmu.setRealInputDerivatives([fmu.reference["lap.preload"]], [1], [-800.0])
        fmu.step(time, step)
    expected, turns = with_slider(spring, lambda time: slip * ramp(time) / NOMINAL, -800.0 * slip / NOMINAL)
    assert turns > 3
    found = fmu.get(*NAMES)
    assert np.abs(np.array(found) / expected - 1).max() < 1e-6, (found, expected)


def with_slider(spring, slip, slip_rate):
    time, state, place, direction, turns = 0.0, np.zeros(7), 0.0, 0, 0
    while time < 0.02:

        def friction(r, time, direction=direction, place=place):
            return slip(time) * direction if direction else spring * (r - place)

        def event(time, state, direction=direction, place=place):
            if direction:
                return direction * (state[2] - state[3]) - slip_rate / spring
            return slip(time) - abs(spring * (state[0] - state[1] - place))

        event.terminal, event.direction = True, -1
        # the knots of the table are at whole milliseconds
        end = min(0.02, (np.floor(time / 1e-3 + 1e-9) + 1) * 1e-3)
        rate = rates(lambda _: LOAD, ramp, lambda _: -800.0, friction)
        done = solve_ivp(rate, (time, end), state, method="DOP853", rtol=1e-12, atol=1e-16, events=event)
        time, state = done.t[-1], done.y[:, -1]
        if done.status != 1:
            continue
        turns += 1
        if direction:
            place, direction = state[0] - state[1] - slip(time) * direction / spring, 0
        else:
            direction = int(np.sign(state[0] - state[1] - place))
    return state[:4], turns


@both_versions
def test_the_fmu_is_sound(run, tmp_path, fmi):
    law = {"dof": "y", "law": "jenkins", "stiffness": 1e6, "slip_force": 40.0}
    for number, friction in enumerate([None, [law]]):
        fmu = tmp_path / f"{number}.fmu"
        run("export", write(tmp_path, friction=friction), "-o", fmu, "--fmi", fmi)
        assert validate_fmu(str(fmu)) == []
        told = run("check", fmu).stdout
        assert "no problem found" in told and "saved state" in told
        tolerance = re.search("reference run: met to .*, tolerance ([^ ]+)\n", told).group(1)
        assert float(tolerance) < 1e-5, told
        variables = {own.name: own for own in fmpy.read_model_description(str(fmu)).modelVariables}
        preload = variables["lap.preload"]
        assert (preload.causality, float(preload.start), preload.declaredType.unit) == ("input", NOMINAL, "N.m")


def test_one_preload_can_be_asked_for(run, slave, tmp_path):
    fmu = slave(write(tmp_path, preload="preload = 9.7"))
    assert "lap.preload" not in fmu.reference and "energy.preload" not in fmu.reference
    fmu.initialise(**{"push.F": LOAD})
    for place in range(200):
        fmu.step(place * 1e-4, 1e-4)
    expected = integrated(rates(lambda _: LOAD, lambda _: 9.7, lambda _: 0.0), 0.0, 0.02, np.zeros(7))[:4]
    assert np.abs(np.array(fmu.get(*NAMES)) / expected - 1).max() < 1e-6


def test_preloads_beyond_the_table(run, slave, tmp_path):
    path = write(tmp_path)
    fmu = slave(path)
    fmu.initialise()
    with pytest.raises(FMICallException):
        fmu.set({"lap.preload": 20.5})
    assert any("preload is 20.5 N.m" in message for _, _, message in fmu.messages)
    # an importer that interpolates two equal values may come to the next number
    fmu.set({"lap.preload": np.nextafter(20.0, 21.0)})
    held = slave(path, "--extrapolate")
    held.initialise(**{"push.F": LOAD, "lap.preload": 25.0})
    fmu.set({"push.F": LOAD, "lap.preload": 20.0})
    for place in range(20):
        held.step(place * 1e-4, 1e-4)
        fmu.step(place * 1e-4, 1e-4)
    assert held.get(*NAMES) == pytest.approx(fmu.get(*NAMES), rel=1e-6)
    done = run("export", small.write(tmp_path, {}), "-o", tmp_path / "x.fmu", "--extrapolate", expect=1)
    assert "found no table over the preload" in done.stderr


# of a slider: both change along the table, straight between its preloads
SLIDER = {"stiffness": [5e5, 8e5, 1.2e6, 1.5e6], "slip_force": [15.0, 25.0, 40.0, 70.0]}


def slid(preloads, interval, part=1e-6):
    """Motion and heat at the end of each interval with this preload, by small Runge–Kutta steps and a return map after each."""
    state, slider, heat, all_ = np.zeros(4), 0.0, 0.0, []
    for preload in preloads:
        k, h = (np.interp(preload, PRELOADS, SLIDER[key]) for key in ("stiffness", "slip_force"))
        k0, c0, k3 = float(stiffness(preload)), float(damping(preload)), float(cubic(preload))

        def slip(r):
            """Elongation of the spring, and the load on the slider."""
            elongation = min(max(r - slider, -h / k), h / k)
            return elongation, k * elongation

        def rate(state):
            r, v = state[0] - state[1], state[2] - state[3]
            extra = k0 * r + c0 * v + k3 * r**3 + slip(r)[1]
            return np.array(small.rates(state, LOAD, extra - small.STIFFNESS * r - small.DAMPING * v))

        def moved_on(state, before, load, heat):
            """The slider after a step, and the heat that the spring did not keep."""
            r = state[0] - state[1]
            elongation, now = slip(r)
            work = (load + now) / 2 * (r - before[0] + before[1])
            return r - elongation, heat + work

        # what the new slip force holds no longer slips at once
        r = state[0] - state[1]
        elongation = slip(r)[0]
        heat += k / 2 * ((r - slider) ** 2 - elongation**2)
        slider = r - elongation
        for _ in range(round(interval / part)):
            before, load, stored = state, slip(state[0] - state[1])[1], k / 2 * slip(state[0] - state[1])[0] ** 2
            one = rate(state)
            two = rate(state + part / 2 * one)
            three = rate(state + part / 2 * two)
            four = rate(state + part * three)
            state = state + part / 6 * (one + 2 * two + 2 * three + four)
            slider, heat = moved_on(state, before, load, heat)
            r, (v, v_a) = state[0] - state[1], (state[2] - state[3], state[2])
            heat -= k / 2 * (r - slider) ** 2 - stored
            heat += part * (c0 * v**2 + 2 * small.RATIO * small.OMEGA / small.SHAPE**2 * v_a**2)
        all_.append([*state, heat])
    return np.array(all_)


def test_friction_follows_a_table_of_its_own(slave, tmp_path):
    """The slip force falls while it slides, and its spring softens while it sticks."""
    laws = [
        [{"dof": "y", "law": "jenkins", "stiffness": k, "slip_force": h}] for k, h in zip(*SLIDER.values(), strict=True)
    ]
    fmu = slave(write(tmp_path, friction_table=laws))
    step, preloads = 2e-4, np.concatenate([np.linspace(19.0, 5.0, 60), np.linspace(5.0, 13.0, 40)])
    fmu.initialise(**{"push.F": LOAD, "lap.preload": preloads[0]})
    found, stored = [], fmu.get("energy.stored")[0]
    for place, preload in enumerate(preloads):
        fmu.set({"lap.preload": preload})
        fmu.step(place * step, step)
        found.append(fmu.get(*NAMES, "energy.dissipated"))
    expected = slid(preloads, step)
    found = np.array(found)
    off = np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert off[:4].max() < 1e-4 and off[4] < 2e-3, off
    supplied, dissipated, by_preload = fmu.get(*ENERGIES)
    assert fmu.get("energy.stored")[0] - stored == pytest.approx(supplied - dissipated + by_preload, rel=1e-9)


def test_a_state_that_can_follow_no_preload_is_told(run, tmp_path):
    law = {"dof": "y", "law": "bouc-wen", "slip_force": 40.0, "exponent": 1.5, "beta": 0.7, "gamma": 0.3}
    laws = [[{**law, "stiffness": k}] for k in SLIDER["stiffness"]]
    path = write(tmp_path, friction_table=laws)
    done = run("export", path, "-o", tmp_path / "x.fmu", expect=1)
    assert '"bouc-wen"' in done.stderr and "`preload`" in done.stderr, done.stderr
    assert not (tmp_path / "x.fmu").exists()
