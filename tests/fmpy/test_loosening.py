"""FMUs of joints over the preload: energy, trajectories against SciPy's DOP853, frequencies against the linear model."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from instances import both_versions
from joints import LOOSENING, TOL_K
from loosening import LooseningLap, Table, start

ENERGIES = ["energy.supplied", "energy.dissipated", "energy.preload"]
STEP = 1e-4
# N, N·m; opens the joint far enough for the cubic term to matter
AMPLITUDE = {1: np.array([1200.0, -700.0]), 2: np.array([300.0, 0.6, -200.0, 0.3])}


def names(n, translation, rotation):
    return [f"{side}.{name}" for side in "ab" for name in (translation, rotation)[:n]]


def states(n):
    return names(n, "y", "theta") + names(n, "v", "omega")


def load(n, time):
    return AMPLITUDE[n] * np.sin(2 * np.pi * np.array([130.0, 310.0, 170.0, 230.0])[: 2 * n] * time)


def ramp(lap, time, duration):
    """From the highest preload of the table to the lowest, smoothly; and its rate."""
    first, last = lap.table.preload[[0, -1]]
    share = time / duration
    preload = last + (first - last) * share**2 * (3 - 2 * share)
    # rounding must not lead beyond the table
    return np.clip(preload, first, last), (first - last) * 6 * share * (1 - share) / duration


def instance_of(slave, case, *options, **values):
    instance = slave(LOOSENING[case], "lap", *options)
    lap = LooseningLap(LOOSENING[case])
    instance.initialise(**values)
    return instance, lap


def errors(found, expected):
    """Largest errors of each state and energy, as a fraction of its largest magnitude; of the energies of all of them."""
    found, expected = np.array(found), np.array(expected)
    scale = np.abs(expected).max(axis=0)
    scale[-3:] = scale[-3:].max()
    return np.abs(found - expected).max(axis=0) / scale


@pytest.mark.parametrize("case", LOOSENING)
def test_a_preload_that_jumps(slave, case):
    """Held over each communication step, as plain importers do: trajectory, energies, and their balance."""
    instance, lap = instance_of(slave, case)
    n, steps = lap.n, 300
    state, before = start(n), lap.table.nominal
    first = instance.get("energy.stored")[0]
    found, expected, balance = [], [], []
    for index in range(steps):
        preload, _ = ramp(lap, index * STEP, steps * STEP)
        loads = load(n, (index + 0.5) * STEP)
        instance.set({"preload": preload, **dict(zip(names(n, "F", "M"), loads))})
        instance.step(index * STEP, STEP)
        state = lap.advance(lap.jump(state, before, preload), STEP, lambda t: loads, lambda t: preload)
        before = preload
        found.append(instance.get(*states(n), *ENERGIES))
        expected.append(state)
        stored, supplied, dissipated, by_preload = instance.get("energy.stored", *ENERGIES)
        balance.append(stored - first - (supplied - dissipated + by_preload))
        assert stored == pytest.approx(lap.energy(state, preload), rel=2e-6)
    assert errors(found, expected).max() < 1e-6, errors(found, expected)
    scale = np.abs(np.array(expected)[:, -3:]).max()
    assert np.abs(expected)[:, -1].max() > 0.005 * scale, "the preload does no work to speak of"
    assert np.abs(balance).max() < 1e-6 * scale


@pytest.mark.parametrize("fmi", ["2"], ids=["fmi2"])
@pytest.mark.parametrize("case", LOOSENING)
def test_a_preload_that_goes_on_within_the_step(slave, case):
    """With the derivatives of FMI 2.0 the Runge-Kutta stages see the preload of their own time."""
    instance, lap = instance_of(slave, case, preload=LOOSENING[case]["joint"]["over_preload"]["preload"][-1])
    n, step, steps = lap.n, 5e-4, 80
    duration = step * steps
    first_preload, last_preload = lap.table.preload[[0, -1]]
    state = start(n)
    first = instance.get("energy.stored")[0]
    loads = AMPLITUDE[n] * 0.5
    found, expected = [], []
    for index in range(steps):
        # the smooth ramp is a cubic: three derivatives tell all of it
        s, width = index / steps, first_preload - last_preload
        derivatives = [
            width * 6 * s * (1 - s) / duration,
            width * (6 - 12 * s) / duration**2,
            width * -12 / duration**3,
        ]
        instance.set({"preload": ramp(lap, index * step, duration)[0], **dict(zip(names(n, "F", "M"), loads))})
        reference = instance.reference["preload"]
        instance.fmu.setRealInputDerivatives([reference] * 3, [1, 2, 3], derivatives)
        instance.step(index * step, step)
        at = lambda t: ramp(lap, index * step + t, duration)
        state = lap.advance(state, step, lambda t: loads, lambda t: at(t)[0], lambda t: at(t)[1])
        found.append(instance.get(*states(n), *ENERGIES))
        expected.append(state)
        stored, supplied, dissipated, by_preload = instance.get("energy.stored", *ENERGIES)
        scale = np.abs(np.array(expected)[:, -3:]).max()
        assert abs(stored - first - supplied + dissipated - by_preload) < 1e-6 * scale
        r, _ = lap.relative(state)
        preload, rate = at(step)
        assert instance.get("power.preload")[0] == pytest.approx(
            lap.table.energy(preload, r, 1) * rate, rel=1e-5, abs=1e-5 * scale / duration
        )
    assert errors(found, expected).max() < 2e-6, errors(found, expected)


@pytest.mark.parametrize("end", ["first", "last"])
def test_the_resonance_is_that_of_the_linear_model(slave, end):
    """Free vibration of the relative motion at both ends of the table: its frequency by the times of its zeros."""
    file = LOOSENING["loosening-1"]
    instance, lap = instance_of(slave, "loosening-1")
    preload = lap.table.preload[0 if end == "first" else -1]
    # the mode of relative motion at small amplitude, so that the cubic term does nothing
    K = lap.table.K(preload)[0, 0]
    stiffness = np.array([[K, -K], [-K, K]]) + np.diag(lap.k)
    values, vectors = np.linalg.eigh(stiffness / np.sqrt(np.outer(lap.m, lap.m)))
    shape = vectors[:, 1] / np.sqrt(lap.m) * 1e-8
    instance = slave(file, "lap")
    instance.initialise(**{"preload": preload, "a.y": shape[0], "b.y": shape[1]})
    step, relative = 2e-5, []
    for index in range(10000):
        a, b = instance.get("a.y", "b.y")
        relative.append(a - b)
        instance.step(index * step, step)
    relative = np.array(relative)
    zeros = np.flatnonzero(np.diff(np.sign(relative)) != 0)
    times = (zeros + relative[zeros] / (relative[zeros] - relative[zeros + 1])) * step
    found = np.pi * (len(times) - 1) / (times[-1] - times[0])
    # damped frequency of the linear model: eigenvalues of the state matrix
    C = lap.table.C(preload)[0, 0]
    damping = np.array([[C, -C], [-C, C]]) + np.diag(lap.c)
    system = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness / lap.m[:, None], -damping / lap.m[:, None]]])
    expected = np.abs(np.linalg.eigvals(system).imag).max()
    assert found == pytest.approx(expected, rel=2e-6)
    low, high = (lap.frequencies(p)[1] for p in lap.table.preload[[0, -1]])
    assert high / low > 1.1, "the two ends would not tell a wrong preload"


@both_versions
@pytest.mark.parametrize("interface", ["lap", "element"])
def test_beyond_the_table(slave, interface):
    file = LOOSENING["loosening-2"]
    instance = slave(file, interface)
    instance.initialise()
    for outside in (9.999, 30.001, -1.0):
        with pytest.raises(FMICallException):
            instance.set({"preload": outside})
        _, category, message = instance.messages[-1]
        assert category == "logStatusError"
        assert f"preload is {outside:g} N.m, expected 10 to 30 N.m" in message, message
        assert instance.get("preload") == [25.0]
    instance.step(0.0, STEP)
    # held at the ends where the export was told so
    free = slave(file, interface, "--extrapolate")
    free.initialise()
    n, position = 2, {"a.y": 1e-4, "a.theta": 2e-3}
    for preload, end in ((5.0, 10.0), (99.0, 30.0)):
        free.set({"preload": preload, **(position if interface == "element" else {})})
        found = free.get("energy.stored")
        free.set({"preload": end})
        assert free.get("energy.stored") == found
    assert n == len(TOL_K)


@pytest.mark.parametrize("fmi", ["2"], ids=["fmi2"])
def test_a_course_that_leaves_the_table_is_refused_and_nothing_moves(slave):
    instance, lap = instance_of(slave, "loosening-1", **{"preload": 2.001, "a.v": 0.1})
    before = instance.get(*states(1), *ENERGIES)
    instance.fmu.setRealInputDerivatives([instance.reference["preload"]], [1], [-50.0])
    with pytest.raises(FMICallException):
        instance.step(0.0, STEP)
    assert "preload is " in instance.messages[-1][2] and "at t = " in instance.messages[-1][2]
    assert instance.get(*states(1), *ENERGIES) == before
    instance.fmu.setRealInputDerivatives([instance.reference["preload"]], [1], [0.0])
    instance.step(0.0, STEP)


@both_versions
@pytest.mark.parametrize("case", LOOSENING)
def test_the_element_follows_the_table(slave, case):
    file = LOOSENING[case]
    table = Table(file)
    n = len(file["joint"]["dofs"])
    instance = slave(file, "element")
    instance.initialise()
    assert instance.get("preload") == [table.nominal]
    r, v = np.array([3e-4, 2e-3][:n]), np.array([0.2, -1.5][:n])
    position = dict(zip(names(n, "y", "theta")[:n], r)) | dict(zip(names(n, "v", "omega")[:n], v))
    for preload in np.linspace(*table.preload[[0, -1]], 37):
        instance.set({"preload": preload, **position})
        K, C, k3 = table.at(preload)
        loads = ["joint.F", "joint.M"][:n]
        assert instance.get(*loads) == pytest.approx(K @ r + C @ v + k3 * r**3, rel=1e-9)
        assert instance.get("energy.stored", "power.dissipated") == pytest.approx(
            [table.energy(preload, r), v @ C @ v], rel=1e-9
        )
        derivative = (
            instance.fmu.getDirectionalDerivative
            if instance.is_fmi2
            else lambda unknowns, knowns, seed: instance.fmu.getDirectionalDerivative(unknowns, knowns, seed)
        )
        unknowns = [instance.reference[name] for name in (*loads, "energy.stored", "power.dissipated")]
        found = derivative(unknowns, [instance.reference["preload"]], [1.0])
        K, C, k3 = table.at(preload, 1)
        expected = [*(K @ r + C @ v + k3 * r**3), table.energy(preload, r, 1), v @ C @ v]
        assert found == pytest.approx(expected, rel=1e-7, abs=1e-9)


@both_versions
@pytest.mark.parametrize("serialised", [False, True])
def test_restart_from_a_saved_state_is_bit_exact(slave, serialised):
    instance, lap = instance_of(slave, "loosening-2")
    n, steps = lap.n, 100

    def go(instance, indices):
        found = []
        for index in indices:
            preload, _ = ramp(lap, index * STEP, steps * STEP)
            instance.set({"preload": preload, **dict(zip(names(n, "F", "M"), load(n, index * STEP)))})
            if instance.is_fmi2:
                instance.fmu.setRealInputDerivatives([instance.reference["preload"]], [1], [-1.0 - index / steps])
            instance.step(index * STEP, STEP)
            found.append(instance.get(*states(n), *ENERGIES, "energy.stored", "power.preload", "joint.F"))
        return found

    go(instance, range(50))
    # with a jump that is not counted by a step yet
    instance.set({"preload": 17.0})
    counted = instance.get("energy.preload")
    state = instance.fmu.getFMUState()
    if serialised:
        saved = instance.fmu.serializeFMUState(state)
    first = go(instance, range(50, 100))
    if serialised:
        instance, _ = instance_of(slave, "loosening-2")
        state = instance.fmu.deserializeFMUState(saved)
    instance.fmu.setFMUState(state)
    assert instance.get("energy.preload") == counted
    assert go(instance, range(50, 100)) == first
    instance.fmu.freeFMUState(state)


@both_versions
def test_model_exchange(model):
    """The importer integrates motion, work and heat; the balance tells the energy by the preload."""
    file = LOOSENING["loosening-1"]
    lap = LooseningLap(file)
    duration = 0.01
    instance = model(file, "lap")
    instance.initialise(**{"preload": lap.table.preload[-1], "a.v": 0.2})
    instance.enter_continuous_time()
    order = instance.states()
    assert order == [*states(1), "energy.supplied", "energy.dissipated"] or set(order) == {
        *states(1), "energy.supplied", "energy.dissipated",
    }
    state = start(1)
    state[2] = 0.2
    place = {name: index for index, name in enumerate([*states(1), *ENERGIES])}

    def rates(t, y):
        instance.fmu.setTime(t)
        instance.set({"preload": ramp(lap, t, duration)[0]})
        instance.set_states(y)
        return instance.get_rates().copy()

    from scipy.integrate import solve_ivp

    found = solve_ivp(
        rates, (0, duration), [state[place[name]] for name in order], method="DOP853", rtol=1e-11, atol=1e-16
    ).y[:, -1]
    rates(duration, found)
    expected = lap.advance(
        state, duration, lambda t: np.zeros(2), lambda t: ramp(lap, t, duration)[0], lambda t: ramp(lap, t, duration)[1]
    )
    assert found == pytest.approx([expected[place[name]] for name in order], rel=1e-7, abs=1e-12)
    assert instance.get("energy.preload")[0] == pytest.approx(expected[-1], rel=1e-7)
