"""Lap and element FMUs for Model Exchange, integrated by FMPy's CVode and by SciPy."""

import fmpy
import numpy as np
import pytest
from instances import both_versions
from joints import LAPS
from reference import Joint, Lap
from scipy.integrate import solve_ivp
from test_derivatives import CASES, assert_equal, found_jacobian, jacobian, parameter_names, per_side, points
from test_derivatives import with_joint_parameters

FREQUENCY_HZ = 130.0


def names(n):
    return per_side(n, "y", "theta") + per_side(n, "v", "omega")


def start(n):
    return np.array([2e-5, 1e-4][:n] + [-1e-5, 3e-4][:n] + [0.02, 0.3][:n] + [0.01, -0.2][:n])


@both_versions
@pytest.mark.parametrize("case", LAPS)
def test_cvode_follows_the_co_simulation(export, case, fmi):
    n = Lap(LAPS[case]).n
    fmu = str(export(LAPS[case], "lap", "--step-size-max", "2e-6", fmi=fmi))
    outputs = names(n) + ["joint.F", "energy.stored"]
    common = {
        "stop_time": 0.02,
        "output_interval": 1e-4,
        "start_values": dict(zip(names(n), start(n))) | {"a.F": 50.0},
        "output": outputs,
    }
    results = [
        fmpy.simulate_fmu(fmu, fmi_type="CoSimulation", **common),
        fmpy.simulate_fmu(fmu, fmi_type="ModelExchange", relative_tolerance=1e-10, **common),
    ]
    stepped, integrated = (np.array([result[name] for name in outputs]) for result in results)
    assert stepped.shape == integrated.shape == (len(outputs), 201)
    scale = np.abs(stepped).max(axis=1, keepdims=True)
    assert (np.abs(integrated - stepped) / scale).max() < 1e-6


@both_versions
@pytest.mark.parametrize("case", LAPS)
def test_a_load_that_varies_need_not_be_held(model, case):
    lap = Lap(LAPS[case])
    n = lap.n
    instance = model(LAPS[case], "lap")
    states = names(n)
    amplitude = np.array([0.0, 4000.0] if n == 1 else [0.0, 0.0, 1000.0, 3.0])
    instance.initialise(**dict(zip(states, start(n))))
    instance.enter_continuous_time()
    # the order of the states is that of the model structure
    order = instance.states()
    assert sorted(order) == sorted(states)
    inputs = [instance.reference[name] for name in per_side(n, "F", "M")]

    def load(time):
        return amplitude * np.sin(2 * np.pi * FREQUENCY_HZ * time)

    def rate(time, y):
        instance.fmu.setTime(time)
        instance.set_by_reference(inputs, load(time))
        instance.set_states(y)
        return instance.get_rates()

    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-16}
    found = solve_ivp(rate, (0, 0.02), instance.get_states(), **options)
    expected = solve_ivp(lambda time, y: lap.rate(y, load(time)), (0, 0.02), start(n), **options)
    assert found.success and expected.success
    end = dict(zip(order, found.y[:, -1]))
    scale = np.abs(expected.y).max(axis=1)
    difference = np.array([end[name] for name in states]) - expected.y[:, -1]
    assert (np.abs(difference) / scale).max() < 1e-8
    instance.fmu.completedIntegratorStep()


@pytest.mark.parametrize("case", CASES)
def test_derivatives_of_the_accelerations(model, case):
    file = LAPS[case]
    n = len(file["joint"]["cubic"])
    inputs = per_side(n, "F", "M")
    knowns = names(n) + inputs + parameter_names(file)
    unknowns = per_side(n, "acceleration", "alpha")
    loads = np.array([30.0, 1.0][:n] + [-20.0, 2.0][:n])
    for values in points(n):

        def accelerations(change):
            lap = Lap(with_joint_parameters(file, lambda name, value: value + change(name)))
            state = values + np.array([change(name) for name in names(n)])
            return lap.rate(state, loads + np.array([change(name) for name in inputs]))[2 * n :]

        instance = model(file, "lap")
        instance.initialise(**dict(zip(names(n) + inputs, [*values, *loads])))
        expected = jacobian(accelerations, knowns)
        assert_equal(found_jacobian(instance, unknowns, knowns), expected)
        instance.enter_continuous_time()
        assert_equal(found_jacobian(instance, unknowns, knowns), expected)


@both_versions
@pytest.mark.parametrize("case", LAPS)
def test_the_element_has_no_states(export, model, case, fmi):
    joint = Joint(LAPS[case])
    file = {key: value for key, value in LAPS[case].items() if key != "bodies"}
    instance = model(file, "element")
    assert instance.states() == []
    instance.initialise()
    instance.enter_continuous_time()
    instance.set({"a.y": 1e-4, "b.v": 0.2})
    unit = np.eye(joint.n)[0]
    load = joint.load_on_b(1e-4 * unit, -0.2 * unit)
    assert instance.get(*["b.F", "b.M"][: joint.n]) == pytest.approx(load, rel=1e-12)
    result = fmpy.simulate_fmu(
        str(export(file, "element", fmi=fmi)),
        fmi_type="ModelExchange",
        stop_time=1e-2,
        output_interval=1e-3,
        start_values={"a.y": 1e-4},
        output=["b.F"],
    )
    assert result["b.F"] == pytest.approx(joint.load_on_b(1e-4 * unit, 0 * unit)[0], rel=1e-12)
