"""Masters that couple a stiff joint: explicit ones diverge where implicit ones, by the FMU's derivatives or saved states, hold."""

import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from joints import HARDENING_1, HARDENING_2, LINEAR_1, changed, joint
from reference import Joint, Lap
from scipy.integrate import solve_ivp

# Masses and moments of inertia beside the joint: light, so that the joint between them is stiff.
INERTIA = {
    1: {"a": [0.12], "b": [0.05]},
    2: {"a": [0.12, 9e-6], "b": [0.05, 4e-6]},
}
JOINTS = {1: joint(["y"], [[4.56e6]], [[54.0]], [3e15]), 2: changed(HARDENING_2, cubic=[5e14, 4e9])}
JOINTS[2] = {key: value for key, value in JOINTS[2].items() if key != "bodies"}
STEP = 1e-4
STEPS = 100
# what a residual relative to the motion may keep of rounding
ROUNDING = 1e-11


class Coupled:
    """An instance of either version of the standard, by names."""

    def __init__(self, folder):
        description = fmpy.read_model_description(str(folder))
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.version = description.fmiVersion[0]
        slave = {"2": FMU2Slave, "3": FMU3Slave}[self.version]
        self.fmu = slave(
            guid=description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="coupled",
        )
        self.fmu.instantiate()

    def references(self, names):
        return [self.reference[name] for name in names]

    def initialise(self, names=(), values=()):
        if self.version == "2":
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.set(names, values)
        self.fmu.exitInitializationMode()

    def set(self, names, values):
        write = self.fmu.setReal if self.version == "2" else self.fmu.setFloat64
        write(self.references(names), [float(value) for value in values])

    def get(self, names):
        read = self.fmu.getReal if self.version == "2" else self.fmu.getFloat64
        return np.array(read(self.references(names)))

    def derivative(self, unknowns, knowns, seed):
        return np.array(
            self.fmu.getDirectionalDerivative(
                self.references(unknowns), self.references(knowns), [float(value) for value in seed]
            )
        )

    def step(self, time, size):
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def save(self):
        return self.fmu.getFMUstate() if self.version == "2" else self.fmu.getFMUState()

    def restore(self, state):
        self.fmu.setFMUstate(state) if self.version == "2" else self.fmu.setFMUState(state)

    def forget(self, state):
        self.fmu.freeFMUstate(state) if self.version == "2" else self.fmu.freeFMUState(state)


@pytest.fixture(params=["2", "3"])
def coupled(request, run, export, tmp_path):
    """Exports a joint in one version of the standard and instantiates its FMU."""
    opened = []

    def coupled(file, interface):
        about_fmi = run("export", "--help").stdout.partition("--fmi")[2].partition("--step-size-max")[0]
        if f"- {request.param}:" not in about_fmi:
            pytest.skip(f"this program does not write FMI {request.param}")
        folder = tmp_path / f"fmu {len(opened)}"
        fmpy.extract(str(export(file, interface, "--fmi", request.param)), str(folder))
        instance = Coupled(folder)
        opened.append(instance)
        return instance

    yield coupled
    for instance in opened:
        instance.fmu.freeInstance()


class Masses:
    """Free bodies at both sides of the joint under loads of their own; coordinates a then b."""

    def __init__(self, n):
        self.n = n
        self.inertia = np.array(INERTIA[n]["a"] + INERTIA[n]["b"])
        self.displacements = [f"{side}.{name}" for side in "ab" for name in ("y", "theta")[:n]]
        self.velocities = [f"{side}.{name}" for side in "ab" for name in ("v", "omega")[:n]]
        self.loads = [f"{side}.{name}" for side in "ab" for name in ("F", "M")[:n]]
        self.motion = self.displacements + self.velocities
        # apart and moving, so far that the cubic term is as large as the linear one
        self.start = np.concatenate([[4e-5, 6e-4][:n], np.zeros(n), [0.05, 1.0][:n], np.zeros(n)])

    def external(self, time):
        amplitude = np.array([300.0, 0.5][: self.n] + [-200.0, 0.2][: self.n])
        return amplitude * np.sin(2 * np.pi * 300.0 * time)

    def exact(self, file, times):
        law = Joint(file)
        n = self.n

        def rate(time, state):
            x, v = state[: 2 * n], state[2 * n :]
            on_b = law.load_on_b(x[:n] - x[n:], v[:n] - v[n:])
            return np.concatenate([v, (self.external(time) + np.concatenate([-on_b, on_b])) / self.inertia])

        solution = solve_ivp(
            rate, (0, times[-1]), self.start, method="Radau", t_eval=times, rtol=1e-10, atol=1e-13
        )
        assert solution.success
        return solution.y.T


def loads_at(element, masses, x, v):
    element.set(masses.motion, np.concatenate([x, v]))
    return element.get(masses.loads)


def explicit(element, masses, step, steps):
    """The joint's load held over the step, the masses integrated exactly under it."""
    x, v = np.split(masses.start, 2)
    for index in range(steps):
        a = (masses.external(index * step) + loads_at(element, masses, x, v)) / masses.inertia
        element.step(index * step, step)
        x, v = x + step * v + 0.5 * step**2 * a, v + step * a
        if np.abs(x).max() > 1.0:
            break
    return np.abs(x).max()


def at_rest(norms):
    """Whether nothing but rounding is left: how much that is depends on the processor and on how far the masses are."""
    return len(norms) > 1 and norms[-1] < ROUNDING and norms[-1] > 0.5 * norms[-2]


def implicit(element, masses, step, steps):
    """Trapezoidal rule on the masses, Newton on their new velocities; also the residuals of each step."""
    size = 2 * masses.n
    x, v = np.split(masses.start, 2)
    states, residuals = [masses.start], []
    a = (masses.external(0.0) + loads_at(element, masses, x, v)) / masses.inertia
    for index in range(steps):
        external = masses.external((index + 1) * step)
        x_new, v_new, norms = x + step * v, v.copy(), []
        for _ in range(30):
            x_new = x + 0.5 * step * (v + v_new)
            a_new = (external + loads_at(element, masses, x_new, v_new)) / masses.inertia
            residual = v_new - v - 0.5 * step * (a + a_new)
            scale = np.abs(v_new) + np.abs(v) + 0.5 * step * (np.abs(a) + np.abs(a_new))
            norms.append(np.abs(residual / scale.max()).max())
            if norms[-1] < 2e-13 or at_rest(norms):
                break
            # d residual / d v_new, with x_new moving by half a step's worth
            columns = []
            for unit in np.eye(size):
                seed = np.concatenate([0.5 * step * unit, unit])
                change = element.derivative(masses.loads, masses.motion, seed)
                columns.append(unit - 0.5 * step * change / masses.inertia)
            correction = np.linalg.solve(np.array(columns).T, residual)
            v_new = v_new - correction
        else:
            raise AssertionError(f"Newton does not converge at step {index}: {norms}")
        element.step(index * step, step)
        x, v, a = x_new, v_new, a_new
        states.append(np.concatenate([x, v]))
        residuals.append(norms)
    return np.array(states), residuals


@pytest.mark.parametrize("n", [1, 2])
def test_newton_holds_where_explicit_coupling_diverges(coupled, n):
    masses = Masses(n)
    element = coupled(JOINTS[n], "element")
    element.initialise()
    assert explicit(element, masses, STEP, STEPS) > 1.0
    element = coupled(JOINTS[n], "element")
    element.initialise()
    states, residuals = implicit(element, masses, STEP, STEPS)
    exact = masses.exact(JOINTS[n], np.arange(STEPS + 1) * STEP)
    # the relative motion neither grows nor is it lost
    relative = states[:, :n] - states[:, n : 2 * n]
    bound = np.abs(exact[:, :n] - exact[:, n : 2 * n]).max(axis=0)
    assert (np.abs(relative).max(axis=0) < 3 * bound).all()
    assert max(len(norms) for norms in residuals) <= 9


@pytest.mark.parametrize("n", [1, 2])
def test_newton_converges_quadratically(coupled, n):
    masses = Masses(n)
    element = coupled(JOINTS[n], "element")
    element.initialise()
    _, residuals = implicit(element, masses, STEP, STEPS)
    orders = []
    for norms in residuals:
        for before, middle, after in zip(norms, norms[1:], norms[2:]):
            # within reach of convergence, above rounding
            if before < 0.1 and middle < 1e-2 * before and after > 2e-13 and not at_rest([middle, after]):
                orders.append(np.log(after / middle) / np.log(middle / before))
    assert len(orders) > 10, "the joint is not nonlinear enough to tell"
    # 1 would be linear convergence; where the motion goes, and so how soon 2 is reached, depends on the last bits of a processor
    assert 1.6 < np.median(orders) < 2.2


@pytest.mark.parametrize("n", [1, 2])
def test_the_implicit_master_converges_to_the_exact_solution(coupled, n):
    masses = Masses(n)
    duration = 5e-4
    errors = []
    for steps in (500, 1000):
        element = coupled(JOINTS[n], "element")
        element.initialise()
        states, _ = implicit(element, masses, duration / steps, steps)
        exact = masses.exact(JOINTS[n], np.linspace(0, duration, steps + 1))
        errors.append((np.abs(states - exact).max(axis=0) / np.abs(exact).max(axis=0)).max())
    # second order
    assert errors[1] < 2e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


# A mass on a stiff spring beside body b of a lap: the importer has the mass and the spring.
MASS, STIFFNESS, DAMPING = 0.4, 5e6, 20.0
LAP_STEP = 1.5e-4


def lap_with_mass(file, duration, start):
    """State of the lap, then displacement and velocity of the mass, at the end."""
    lap = Lap(file)

    def rate(_, state):
        x, v = state[:2], state[2:4]
        load = STIFFNESS * (state[4] - x[1]) + DAMPING * (state[5] - v[1])
        return np.concatenate([lap.rate(state[:4], np.array([0.0, load])), [state[5], -load / MASS]])

    solution = solve_ivp(rate, (0, duration), start, method="DOP853", rtol=1e-11, atol=1e-16)
    assert solution.success
    return solution.y[:, -1]


def mass_after(y, v, load, step):
    """The mass under the held opposite of the load on b."""
    a = -load / MASS
    return y + step * v + 0.5 * step**2 * a, v + step * a


def spring(y, v, body):
    return STIFFNESS * (y - body[0]) + DAMPING * (v - body[1])


def coupled_lap(lap, step, steps, start, is_implicit):
    """Lap and mass under a load that is held over each step: that of its beginning, or the mean of both ends."""
    names = ["a.y", "b.y", "a.v", "b.v"]
    lap.initialise(names, start[:4])
    y, v = start[4:]
    body = lap.get(["b.y", "b.v"])
    most = 0
    for index in range(steps):
        time, before = index * step, spring(y, v, body)

        def mismatch(load):
            """Steps from the saved state under `load`: the mean of the spring's load at both ends, less `load`."""
            lap.restore(state)
            lap.set(["b.F"], [load])
            lap.step(time, step)
            return 0.5 * (before + spring(*mass_after(y, v, load, step), lap.get(["b.y", "b.v"]))) - load

        if is_implicit:
            state = lap.save()
            # secant iteration, each trial from the state at the beginning of the step
            load, other = before, before + 1e-3 * (abs(before) + 1.0)
            found, found_other = mismatch(load), mismatch(other)
            trials = 2
            while abs(found_other) > 1e-11 * (abs(before) + 1.0) and found != found_other and trials < 20:
                load, other, found = other, other - found_other * (other - load) / (found_other - found), found_other
                found_other = mismatch(other)
                trials += 1
            most = max(most, trials)
            load = other
            lap.forget(state)
        else:
            load = before
            lap.set(["b.F"], [load])
            lap.step(time, step)
        y, v = mass_after(y, v, load, step)
        body = lap.get(["b.y", "b.v"])
        if np.abs(body).max() > 1e3:
            break
    return np.concatenate([lap.get(names), [y, v]]), most


@pytest.mark.parametrize("file", [LINEAR_1, HARDENING_1], ids=["linear", "hardening"])
def test_steps_repeated_from_saved_states_hold_where_explicit_coupling_diverges(coupled, file):
    start = np.array([2e-5, -1e-5, 0.0, 0.0, 3e-5, 0.0])
    end, _ = coupled_lap(coupled(file, "lap"), LAP_STEP, 2000, start, is_implicit=False)
    assert np.abs(end[:2]).max() > 100 * np.abs(start).max()
    end, trials = coupled_lap(coupled(file, "lap"), LAP_STEP, 2000, start, is_implicit=True)
    assert np.abs(end[:2]).max() < 5e-5
    assert trials < 8
    # and they agree with the coupled equations, to the second order of the held mean
    errors = []
    duration = 30 * LAP_STEP
    exact = lap_with_mass(file, duration, start)
    for steps in (600, 1200):
        end, _ = coupled_lap(coupled(file, "lap"), duration / steps, steps, start, is_implicit=True)
        errors.append(np.abs((end - exact) / np.abs(exact).max(initial=0, where=np.arange(6) < 2)).max())
    assert errors[1] < errors[0]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
