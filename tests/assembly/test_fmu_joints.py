"""The FMU of a small assembly with joints that are not linear: beside SciPy, saved in motion, differentiated."""

import fmpy
import numpy as np
import pytest
import small
from fmpy.validation import validate_fmu
from instances import both_versions
from scipy.integrate import solve_ivp

CUBIC = {"cubic": [1e12]}
SLIDER = {"friction": [{"dof": "y", "law": "jenkins", "stiffness": 2e6, "slip_force": 60.0}]}
LUGRE = {
    "dof": "y",
    "law": "lugre",
    "stiffness": 2e6,
    "bristle_damping": 100.0,
    "damping": 40.0,
    "slip_force": 60.0,
    "static_force": 80.0,
    "stribeck_velocity": 0.05,
}
INNER = {
    "friction": [
        {
            "dof": "y",
            "law": "bouc-wen",
            "stiffness": 2e6,
            "slip_force": 60.0,
            "exponent": 1.5,
            "beta": 0.7,
            "gamma": 0.3,
        }
    ]
}


def stepped(fmu, load, step, count, names=("root.y", "tip.y", "root.v", "tip.v"), start=0):
    fmu.set({"push.F": load})
    rows = []
    for place in range(start, start + count):
        fmu.step(place * step, step)
        rows.append(fmu.get(*names))
    return np.array(rows)


@both_versions
@pytest.mark.parametrize("step", [1e-5, 5e-4])
def test_a_cubic_joint_is_that_of_scipy(slave, tmp_path, step):
    fmu = slave(small.write(tmp_path, CUBIC))
    fmu.initialise()
    count = round(0.02 / step)
    found = stepped(fmu, 200.0, step, count)
    expected = small.with_cubic(step * np.arange(1, count + 1), 200.0, 1e12)
    assert (np.abs(found - expected).max(axis=0) < 1e-6 * np.abs(expected).max(axis=0)).all()


@pytest.mark.parametrize("step", [1e-5, 1e-4])
def test_a_slider_is_that_of_scipy(slave, tmp_path, step):
    fmu = slave(small.write(tmp_path, SLIDER))
    fmu.initialise()
    found = stepped(fmu, 200.0, step, round(0.02 / step))[-1]
    expected, turns = small.with_slider(0.02, 200.0, 2e6, 60.0)
    assert turns > 3
    assert np.abs(found / expected - 1).max() < 1e-6
    energies = fmu.get("energy.supplied", "energy.dissipated", "energy.stored")
    assert energies[0] - energies[1] - energies[2] == pytest.approx(0, abs=1e-8 * energies[0])
    [load, friction] = fmu.get("lap.F", "lap.jenkins_slider_y")
    assert np.isfinite(load) and friction != 0


IWAN = {"dof": "y", "law": "iwan", "stiffness": 2e6, "slip_force": 60.0, "exponent": -0.4, "ratio": 0.3}


@pytest.mark.parametrize("joint", [SLIDER, {"friction": [IWAN]}], ids=["slider", "iwan"])
def test_the_power_that_is_lost_is_the_rate_of_what_was(slave, tmp_path, joint):
    """The motion that outputs follow from is summed up otherwise than that of the step: its rounding turns nothing."""
    fmu = slave(small.write(tmp_path, joint))
    fmu.initialise()
    step = 1e-5
    found = stepped(fmu, 200.0, step, 2000, ("power.dissipated", "energy.dissipated"))
    powers, energies = found.T
    integral = step * (powers[1:] + powers[:-1]).sum() / 2
    assert integral == pytest.approx(energies[-1] - energies[0], rel=5e-3)


@pytest.mark.parametrize("step", [1e-4, 5e-4])
def test_bristles_are_those_of_scipy(slave, tmp_path, step):
    """LuGre's law alone knows time, and is of second order: errors of many short parts add up."""
    fmu = slave(small.write(tmp_path, {"friction": [LUGRE]}))
    fmu.initialise()
    found = stepped(fmu, 200.0, step, round(0.02 / step))[-1]
    expected, turns = small.with_lugre(0.02, 200.0, LUGRE)
    assert turns > 3
    assert np.abs(found / expected - 1).max() < 1e-5
    energies = fmu.get("energy.supplied", "energy.dissipated", "energy.stored")
    assert energies[0] - energies[1] - energies[2] == pytest.approx(0, abs=1e-5 * energies[0])


@both_versions
@pytest.mark.parametrize("joint", [CUBIC, INNER], ids=["cubic", "inner state"])
def test_an_importer_integrates_the_same(slave, model, tmp_path, joint):
    path = small.write(tmp_path, joint)
    fmu = slave(path)
    fmu.initialise()
    names = ("root.y", "tip.y", "root.v", "tip.v", "energy.supplied", "energy.dissipated")
    expected = stepped(fmu, 200.0, 2.5e-6, 2000, names)[-1]
    exchange = model(path)
    exchange.initialise(**{"push.F": 200.0})
    exchange.enter_continuous_time()

    def rate(time, states):
        exchange.fmu.setTime(time)
        exchange.set_states(states)
        return exchange.get_rates()

    done = solve_ivp(rate, (0, 5e-3), exchange.get_states(), method="DOP853", rtol=1e-10, atol=1e-13)
    exchange.set_states(done.y[:, -1])
    found = exchange.get(*names)
    # Between DOP853 at 1e-8 and at 1e-12 lie 1.5e-8; 250 steps of the FMU err by 1e-8, and each halving takes a sixteenth of it,
    # so that 2,000 leave 4e-12: what is left is the integrator's.
    assert np.abs(np.array(found) / expected - 1).max() < 1e-7


def test_an_importer_is_told_where_a_slider_turns(run, tmp_path):
    path = small.write(tmp_path, SLIDER)
    fmu = tmp_path / "x.fmu"
    run("export", path, "-o", fmu)
    inputs = np.array([(0.0, 200.0), (0.02, 200.0)], dtype=[("time", float), ("push.F", float)])
    result = fmpy.simulate_fmu(
        str(fmu),
        fmi_type="ModelExchange",
        stop_time=0.02,
        output_interval=1e-3,
        relative_tolerance=1e-8,
        input=inputs,
        output=["root.y", "tip.y"],
    )
    expected, _ = small.with_slider(0.02, 200.0, 2e6, 60.0)
    # the error follows the tolerance: 3e-4 at 1e-5, 1.2e-5 at 1e-6, 2.5e-6 at 1e-7, 4.7e-7 at 1e-8, 4.5e-8 at 1e-9
    assert [result["root.y"][-1], result["tip.y"][-1]] == pytest.approx(expected[:2], rel=2e-6)


@both_versions
@pytest.mark.parametrize("joint", [CUBIC, SLIDER, INNER], ids=["cubic", "slider", "inner state"])
def test_a_state_is_saved_in_motion(slave, tmp_path, joint):
    fmu = slave(small.write(tmp_path, joint))
    fmu.initialise()
    stepped(fmu, 200.0, 1e-4, 37)
    api = fmu.fmu
    if fmu.is_fmi2:
        get, restore, write, read = api.getFMUstate, api.setFMUstate, api.serializeFMUstate, api.deSerializeFMUstate
    else:
        get, restore, write, read = api.getFMUState, api.setFMUState, api.serializeFMUState, api.deserializeFMUState
    state = get()
    first = stepped(fmu, -300.0, 1e-4, 25, start=37)
    restore(state)
    assert (stepped(fmu, -300.0, 1e-4, 25, start=37) == first).all()
    restore(state)
    kept = write(state)
    stepped(fmu, 900.0, 1e-4, 3, start=37)
    other = read(kept)
    restore(other)
    assert (stepped(fmu, -300.0, 1e-4, 25, start=37) == first).all()


@pytest.mark.parametrize("joint", [CUBIC, INNER], ids=["cubic", "inner state"])
def test_partial_derivatives_are_those_of_differences(model, tmp_path, joint):
    fmu = model(small.write(tmp_path, joint))
    fmu.initialise(**{"push.F": 50.0})
    fmu.enter_continuous_time()
    states = fmu.states()
    generator = np.random.default_rng(3)
    sizes = {"q": 1e-4, "v": 0.1}
    typical = np.array([sizes.get(name.split(".")[1][0], 1e-3 if "energy" in name else 20.0) for name in states])
    point, seed = (generator.normal(size=len(states)) * typical for _ in range(2))
    outputs = [v.name for v in fmu.description.modelVariables if v.causality == "output" and v.name not in states]
    unknowns = outputs + [v.variable.name for v in fmu.description.derivatives]

    def at(part):
        fmu.set_states(point + part * seed)
        fmu.set({"push.F": 50.0 + 7.0 * part})
        return np.array(fmu.get(*unknowns))

    step = 1e-5
    expected = (at(step) - at(-step)) / (2 * step)
    at(0.0)
    found = fmu.fmu.getDirectionalDerivative(
        [fmu.reference[name] for name in unknowns],
        [fmu.reference[name] for name in [*states, "push.F"]],
        [*seed, 7.0],
    )
    scale = np.abs(expected).max()
    assert np.abs(found - expected).max() < 1e-6 * scale
    assert np.abs(found / np.where(expected == 0, 1, expected) - (expected != 0)).max() < 1e-4


def test_loads_may_be_cubic_in_time(slave, tmp_path):
    """Of FMI 2.0: one step along three derivatives is a hundred with those that they have become."""

    def after(count):
        fmu = slave(small.write(tmp_path, {}))
        fmu.initialise(**{"push.F": 10.0})
        step = 1e-3 / count
        load = np.array([10.0, 3e4, -8e7, 5e11])
        for place in range(count):
            time = place * step
            powers = np.array([1, time, time**2 / 2, time**3 / 6])
            now = [powers[: 4 - order] @ load[order:] for order in range(4)]
            fmu.set({"push.F": now[0]})
            references = [fmu.reference["push.F"]] * 3
            fmu.fmu.setRealInputDerivatives(references, [1, 2, 3], now[1:])
            fmu.step(time, step)
        return np.array(fmu.get("root.y", "tip.y", "root.v", "tip.v", "energy.supplied"))

    assert np.abs(after(1) / after(100) - 1).max() < 1e-9


@pytest.fixture
def fmi(request):
    """FMI 2.0 where loads have derivatives, else 3.0."""
    callspec = getattr(request.node, "callspec", None)
    if callspec and "fmi" in callspec.params:
        return callspec.params["fmi"]
    return "2" if "cubic_in_time" in request.node.name else "3"


@both_versions
def test_the_fmu_is_sound(run, tmp_path, fmi):
    for number, joint in enumerate([{}, CUBIC, SLIDER, INNER]):
        path = small.write(tmp_path, joint)
        fmu = tmp_path / f"{number}.fmu"
        run("export", path, "-o", fmu, "--fmi", fmi)
        assert validate_fmu(str(fmu)) == []
        told = run("check", fmu).stdout
        assert "no problem found" in told and "reference run: met" in told and "saved state" in told
        assert "terminals: root, tip, push" in told


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (('name = "lap"', 'name = "the lap"'), 'found "the lap", expected a word of letters, digits and _'),
        (("push =", "energy ="), 'found "energy", expected a word'),
        (('name = "lap"', 'name = "push"'), "both give the FMU a variable push.F, expected different names"),
    ],
)
def test_names_that_no_variable_can_have_are_told(run, tmp_path, change, told):
    path = small.write(tmp_path, {})
    path.write_text(path.read_text().replace(*change, 1))
    done = run("export", path, "-o", tmp_path / "x.fmu", expect=1)
    assert told in done.stderr
    assert not (tmp_path / "x.fmu").exists()


def test_joints_are_judged(run, tmp_path):
    path = small.write(tmp_path, {"stiffness": [[-1.0]]})
    done = run("export", path, "-o", tmp_path / "x.fmu", expect=1)
    assert "expected K and C positive semidefinite" in done.stderr
    run("export", path, "-o", tmp_path / "x.fmu", "--allow-active")
    done = run("export", path, "-o", tmp_path / "x.fmu", "--as", "lap", expect=1)
    assert "--as" in done.stderr
