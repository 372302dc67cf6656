"""Trajectories of lap FMUs against SciPy's DOP853."""

import fmpy
import numpy as np
import pytest
from instances import Slave, both_versions
from joints import LAPS, changed
from reference import HIGHER, Lap
from scipy.integrate import trapezoid

STEP = 1e-4
STEPS = 300
# Loads that open the joint far enough for the cubic term to matter: N, N·m.
AMPLITUDE = {1: np.array([0.0, 4000.0]), 2: np.array([0.0, 0.0, 1000.0, 3.0])}
FREQUENCY_HZ = 130.0


def names(lap, quantity_y, quantity_theta):
    per_side = [quantity_y] if lap.n == 1 else [quantity_y, quantity_theta]
    return [f"{side}.{quantity}" for side in "ab" for quantity in per_side]


def loads(lap):
    middle = (np.arange(STEPS) + 0.5) * STEP
    return np.outer(np.sin(2 * np.pi * FREQUENCY_HZ * middle), AMPLITUDE[lap.n])


def simulated(instance, lap, applied):
    """States at the communication points."""
    outputs = names(lap, "y", "theta") + names(lap, "v", "omega")
    inputs = names(lap, "F", "M")
    states = [instance.get(*outputs)]
    for index, load in enumerate(applied):
        instance.set(dict(zip(inputs, load)))
        instance.step(index * STEP, STEP)
        states.append(instance.get(*outputs))
    return np.array(states)


@pytest.mark.parametrize("case", LAPS)
def test_trajectory(slave, case):
    lap = Lap(LAPS[case])
    applied = loads(lap)
    expected = lap.held(np.zeros(4 * lap.n), applied, STEP)
    instance = slave(LAPS[case], "lap")
    instance.initialise()
    found = simulated(instance, lap, applied)
    error = np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert error.max() < 1e-6, error


@pytest.mark.parametrize("pair", [("linear-1", "hardening-1"), ("linear-1", "softening-1"),
                                  ("linear-2", "hardening-2"), ("linear-2", "softening-2"),
                                  ("linear-1", "higher-1"), ("linear-2", "higher-2")])
def test_the_loads_make_the_cubic_term_matter(pair):
    """Otherwise the trajectories above would not tell a wrong cubic term."""
    linear, cubic = (Lap(LAPS[case]) for case in pair)
    start = np.zeros(4 * linear.n)
    applied = loads(linear)
    difference = linear.held(start, applied, STEP) - cubic.held(start, applied, STEP)
    assert np.abs(difference).max() > 1e-3 * np.abs(cubic.held(start, applied, STEP)).max()


@pytest.mark.parametrize("key", HIGHER)
@pytest.mark.parametrize("case", ["higher-1", "higher-2"])
def test_the_loads_make_every_term_of_higher_order_matter(case, key):
    full = LAPS[case]
    without = {name: terms for name, terms in full["joint"]["higher"].items() if name != key}
    laps = [Lap(full), Lap(changed(full, higher=without))]
    found = [lap.held(np.zeros(4 * lap.n), loads(lap), STEP) for lap in laps]
    assert np.abs(found[0] - found[1]).max() > 1e-4 * np.abs(found[0]).max()


@pytest.mark.parametrize("case", ["higher-1", "higher-2"])
def test_both_versions_give_the_same_bits(export, tmp_path, case):
    lap = Lap(LAPS[case])
    found = []
    for fmi in ("2", "3"):
        folder = tmp_path / fmi
        fmpy.extract(str(export(LAPS[case], "lap", fmi=fmi)), str(folder))
        instance = Slave(folder)
        instance.initialise()
        found.append(simulated(instance, lap, loads(lap)))
        instance.close()
    assert (found[0] == found[1]).all() and np.abs(found[0]).max() > 0


@both_versions
@pytest.mark.parametrize("case", LAPS)
def test_initial_state_outputs_and_energy(slave, case):
    lap = Lap(LAPS[case])
    n = lap.n
    start = np.array([2e-5, 1e-4][:n] + [-1e-5, 3e-4][:n] + [0.02, 0.3][:n] + [0.01, -0.2][:n])
    instance = slave(LAPS[case], "lap")
    instance.initialise(**dict(zip(names(lap, "y", "theta") + names(lap, "v", "omega"), start)))
    joint = ["joint.F", "joint.M"][:n]
    assert instance.get(*joint) == pytest.approx(lap.load_on_b(start), rel=1e-12)
    assert instance.get("energy.stored", "power.dissipated") == pytest.approx(
        [lap.energy(start), lap.power(start)], rel=1e-12
    )
    # Free motion: what the dampers took is what is missing from the energy (trapezoidal rule over fine steps).
    step = 2e-6
    energy, power = [], []
    for index in range(1000):
        stored, dissipated = instance.get("energy.stored", "power.dissipated")
        energy.append(stored)
        power.append(dissipated)
        instance.step(index * step, step)
    lost = trapezoid(power, dx=step)
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=2e-4)


@pytest.mark.parametrize("case", LAPS)
def test_one_step_of_1_ms_is_fifty_of_20_us(slave, case):
    lap = Lap(LAPS[case])
    n = lap.n
    load = dict(zip(names(lap, "F", "M"), AMPLITUDE[n] * 0.1))
    ends = []
    for count in (1, 50):
        instance = slave(LAPS[case], "lap", "--step-size-max", "2e-5")
        instance.initialise()
        instance.set(load)
        for index in range(count):
            instance.step(index * 1e-3 / count, 1e-3 / count)
        ends.append(np.array(instance.get(*names(lap, "y", "theta"), *names(lap, "v", "omega"))))
    assert np.abs(ends[1] / ends[0] - 1).max() < 1e-12


@both_versions
@pytest.mark.parametrize("case", ["hardening-1", "softening-2"])
@pytest.mark.parametrize("serialised", [False, True])
def test_restart_from_a_saved_state_is_bit_exact(slave, case, serialised):
    lap = Lap(LAPS[case])
    applied = loads(lap)
    inputs = names(lap, "F", "M")
    outputs = names(lap, "y", "theta") + names(lap, "v", "omega") + ["joint.F", "energy.stored"]

    def go_on(instance):
        found = []
        for index in range(50, 100):
            instance.set(dict(zip(inputs, applied[index])))
            instance.step(index * STEP, STEP)
            found.append(instance.get(*outputs))
        return found

    instance = slave(LAPS[case], "lap")
    instance.initialise()
    simulated(instance, lap, applied[:50])
    state = instance.fmu.getFMUState()
    if serialised:
        saved = instance.fmu.serializeFMUState(state)
    first = go_on(instance)
    if serialised:
        # Another instance of the same FMU takes the state up.
        instance = slave(LAPS[case], "lap")
        instance.initialise()
        state = instance.fmu.deserializeFMUState(saved)
    instance.fmu.setFMUState(state)
    assert go_on(instance) == first
    instance.fmu.freeFMUState(state)
