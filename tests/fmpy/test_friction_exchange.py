"""Joints that remember, in Model Exchange: inner states that FMPy's CVode integrates, and turns and corners that it places."""

import fmpy
import numpy as np
import pytest
from instances import both_versions, pointer
from joints import body, changed, joint
from scipy.integrate import solve_ivp
from test_friction import BOUC_WEN, IWAN, LUGRE, VALANIS, with_friction

LAWS = {"lugre": LUGRE, "bouc-wen": BOUC_WEN}
STATE = {"lugre": "joint.lugre_z_y", "bouc-wen": "joint.bouc_wen_p_y"}
RATE = {"lugre": "joint.lugre_zdot_y", "bouc-wen": "joint.bouc_wen_pdot_y"}
# N/m, N·s/m of the joint's linear law in with_friction
K, C = 2e6, 20.0
inner = pytest.mark.parametrize("name", LAWS)


def rate_of(law, s, v):
    """Rate of the inner state, from the laws' own equations."""
    if law["law"] == "lugre":
        g = law["slip_force"] + (law["static_force"] - law["slip_force"]) * np.exp(-((v / law["stribeck_velocity"]) ** 2))
        return v - law["stiffness"] * abs(v) * s / g
    w = s / law["slip_force"]
    shape = law["beta"] * np.sign(v * w) + law["gamma"]
    return law["stiffness"] * (1 - shape * abs(w) ** law["exponent"]) * v


def load_of(law, s, v):
    """Load of the law alone."""
    if law["law"] == "lugre":
        return law["stiffness"] * s + law["bristle_damping"] * rate_of(law, s, v) + law["damping"] * v
    return s


def heat_of(law, s, v):
    """Power that it turns into heat: what it takes less what its spring takes."""
    stored = law["stiffness"] * s * rate_of(law, s, v) if law["law"] == "lugre" else s * rate_of(law, s, v) / law["stiffness"]
    return load_of(law, s, v) * v - stored


def path(t):
    """A smooth path with loops in loops, and its velocity."""
    random = np.random.default_rng(3)
    r = v = 0.0
    for omega, phase, size in zip([300, 731, 1130, 1873], random.uniform(0, 6, 4), [3e-4, 2e-4, 1e-4, 5e-5]):
        r = r + size * (np.sin(omega * t + phase) - np.sin(phase))
        v = v + size * omega * np.cos(omega * t + phase)
    return r, v


@inner
def test_an_importer_integrates_the_inner_state_along_a_random_path(model, name, fmi):
    """SciPy is the importer: FMPy's CVode holds inputs from one output point to the next."""
    law, end = LAWS[name], 0.012
    instance = model(with_friction(law), "element")
    instance.initialise(**{"a.v": path(0.0)[1]})
    instance.enter_continuous_time()
    assert instance.states() == [STATE[name]]

    def at(t, y):
        instance.fmu.setTime(t)
        r, v = path(t)
        instance.set({"a.y": 0.75 * r, "a.v": 0.75 * v, "b.y": -0.25 * r, "b.v": -0.25 * v})
        instance.set_states(y)
        return instance.get_rates()

    def rate(t, y):
        v = path(t)[1]
        return [rate_of(law, y[0], v), heat_of(law, y[0], v) + C * v * v]

    times = np.linspace(0, end, 601)
    # where the velocity changes its sign the rates are not smooth: short steps
    options = {"rtol": 1e-10, "atol": 1e-16, "max_step": 1e-5}
    states = solve_ivp(at, (0, end), [0.0], "DOP853", t_eval=times, **options).y.T
    expected = solve_ivp(rate, (0, end), [0.0, 0.0], "Radau" if name == "lugre" else "DOP853", t_eval=times, **options).y
    outputs = ["b.F", STATE[name], "energy.stored", "power.dissipated", "energy.dissipated"]
    found = []
    for t, y in zip(times, states):
        at(t, y)
        instance.fmu.completedIntegratorStep()
        found.append(instance.get(*outputs))
    r, v = path(times)
    s = expected[0]
    spring = law["stiffness"] * s**2 / 2 if name == "lugre" else s**2 / law["stiffness"] / 2
    power = [rate(t, y)[1] for t, y in zip(times, expected.T)]
    for output, values, wanted, tolerance in zip(
        outputs,
        np.array(found).T,
        [K * r + C * v + load_of(law, s, v), s, K * r * r / 2 + spring, power, expected[1]],
        # the element counts its heat from step to step
        [1e-6, 1e-6, 1e-6, 1e-6, 1e-3],
    ):
        assert np.abs(values - wanted).max() < tolerance * np.abs(wanted).max(), output


def lap(law, dofs=("y",)):
    bodies = {"a": body([1.0], [5e6], [50.0]), "b": body([1e9], [0.0], [0.0])}
    return {**with_friction(law), "bodies": bodies}


@inner
def test_cvode_integrates_the_inner_state_of_a_lap(export, name, fmi):
    law, force, end = LAWS[name], 6000.0, 0.008
    outputs = ["a.y", "a.v", STATE[name], "energy.dissipated", "energy.stored"]
    result = fmpy.simulate_fmu(
        str(export(lap(law), "lap", fmi=fmi)),
        fmi_type="ModelExchange", stop_time=end, output_interval=1e-4, relative_tolerance=1e-10,
        start_values={"a.F": force}, output=outputs,
    )

    def rate(_, y):
        r, v, s, _ = y
        of_joint = K * r + C * v + load_of(law, s, v)
        return [v, force - of_joint - 5e6 * r - 50 * v, rate_of(law, s, v), heat_of(law, s, v) + (C + 50) * v * v]

    expected = solve_ivp(rate, (0, end), [0.0] * 4, "DOP853", t_eval=result["time"], rtol=1e-10, atol=1e-15, max_step=1e-5).y
    for output, wanted in zip(outputs, expected):
        assert np.abs(result[output] - wanted).max() < 1e-6 * np.abs(wanted).max(), output
    balance = force * result["a.y"] - result["energy.stored"] - result["energy.dissipated"]
    assert np.abs(balance).max() < 1e-6 * result["energy.dissipated"][-1]


def partial(instance, unknown, known):
    found = instance.fmu.getDirectionalDerivative([instance.reference[unknown]], [instance.reference[known]], [1.0])
    return found[0]


# another of the same kind, which slips earlier
SECOND = {
    "lugre": {**LUGRE, "stiffness": 0.4 * LUGRE["stiffness"], "slip_force": 0.3 * LUGRE["slip_force"],
              "static_force": 0.3 * LUGRE["static_force"]},
    "bouc-wen": {**BOUC_WEN, "stiffness": 0.4 * BOUC_WEN["stiffness"], "slip_force": 0.3 * BOUC_WEN["slip_force"], "exponent": 2.0},
}


def numbered(symbol):
    """The variable of the second law: `joint.lugre_z_y` and `joint.lugre_2_z_y`."""
    law = "bouc_wen" if "bouc_wen" in symbol else "lugre"
    return symbol.replace(law, f"{law}_2")


@inner
def test_two_laws_of_a_kind_have_an_inner_state_each(export, model, name, fmi):
    laws = [LAWS[name], SECOND[name]]
    both = changed(lap(laws[0]), friction=[{"dof": "y", **law} for law in laws])
    states, rates = [STATE[name], numbered(STATE[name])], [RATE[name], numbered(RATE[name])]
    instance = model(both, "element")
    instance.initialise()
    instance.enter_continuous_time()
    assert instance.states() == states
    at, v = ([3e-5, -1e-5] if name == "lugre" else [200.0, -70.0]), 0.03
    instance.set({"a.y": 1e-4, "a.v": v})
    instance.set_states(np.array(at))
    assert instance.get(*states) == at
    expected = [rate_of(law, s, v) for law, s in zip(laws, at)]
    assert list(instance.get_rates()) == pytest.approx(expected, rel=1e-13)
    assert instance.get(*rates) == pytest.approx(expected, rel=1e-13)
    load = K * 1e-4 + C * v + sum(load_of(law, s, v) for law, s in zip(laws, at))
    assert instance.get("b.F")[0] == pytest.approx(load, rel=1e-13)
    # each rate by its own state, and by no other
    for i, rate in enumerate(rates):
        for j, state in enumerate(states):
            step = 1e-6 * abs(at[j])
            ends = [rate_of(laws[i], at[i] + (side if i == j else 0.0), v) for side in (step, -step)]
            difference = (ends[0] - ends[1]) / (2 * step)
            assert partial(instance, rate, state) == pytest.approx(difference, rel=1e-6, abs=0.0), (rate, state)

    force, end = 6000.0, 0.008
    outputs = ["a.y", "a.v", *states, "energy.dissipated"]
    result = fmpy.simulate_fmu(
        str(export(both, "lap", fmi=fmi)),
        fmi_type="ModelExchange", stop_time=end, output_interval=1e-4, relative_tolerance=1e-10,
        start_values={"a.F": force}, output=outputs,
    )

    def rate(_, y):
        r, v, *s, _ = y
        pairs = list(zip(laws, s))
        of_joint = K * r + C * v + sum(load_of(*pair, v) for pair in pairs)
        heat = sum(heat_of(*pair, v) for pair in pairs) + (C + 50) * v * v
        return [v, force - of_joint - 5e6 * r - 50 * v, *(rate_of(*pair, v) for pair in pairs), heat]

    expected = solve_ivp(rate, (0, end), [0.0] * 5, "DOP853", t_eval=result["time"], rtol=1e-10, atol=1e-15, max_step=1e-5).y
    for output, wanted in zip(outputs, expected):
        assert np.abs(result[output] - wanted).max() < 1e-6 * np.abs(wanted).max(), output


@pytest.mark.parametrize("interface", ["element", "lap"])
@inner
def test_derivatives_are_differences_also_by_the_inner_state(model, name, interface, fmi):
    law = LAWS[name]
    instance = model(lap(law), interface)
    instance.initialise()
    instance.enter_continuous_time()
    assert instance.states()[-1] == STATE[name]
    assert instance.description.numberOfEventIndicators == 0
    state = 1.2e-4 if name == "lugre" else 900.0
    at = {"a.y": 1.3e-4, "a.v": 0.04, "b.y": -4e-5, "b.v": -0.01, STATE[name]: state}
    parameters = [f"joint.{symbol}_y" for symbol in
                  (["lugre_s0", "lugre_s1", "lugre_fs", "lugre_vs"] if name == "lugre" else
                   ["bouc_wen_k", "bouc_wen_h", "bouc_wen_n", "bouc_wen_gamma"])]
    size = dict(zip(parameters, instance.get(*parameters)))
    joint_load = ["joint.F", "energy.stored", "power.dissipated", RATE[name]]
    unknowns = joint_load + (["b.F"] if interface == "element" else ["a.acceleration", "b.acceleration"])

    def set_at(change={}):
        now = {name: value + change.get(name, 0.0) for name, value in at.items()}
        states = instance.states()
        instance.set({name: value for name, value in now.items() if name not in states})
        instance.set_states(np.array([now.get(name, 0.0) for name in states]))

    set_at()
    assert instance.get_states()[-1] == state
    assert instance.get_rates()[-1] == pytest.approx(rate_of(law, state, 0.05), rel=1e-13)
    found = {(u, k): partial(instance, u, k) for u in unknowns for k in [*at, *parameters]}
    if fmi == "3":
        knowns = [*at, *parameters]
        for unknown in unknowns:
            arguments = [instance.reference[unknown]], [instance.reference[k] for k in knowns], [1.0]
            adjoint = instance.fmu.getAdjointDerivative(*arguments, nSensitivity=len(knowns))
            assert adjoint == pytest.approx([found[unknown, k] for k in knowns], rel=1e-14)
    for known in at:
        step = 1e-6 * abs(at[known])
        ends = []
        for side in (step, -step):
            set_at({known: side})
            ends.append(np.array(instance.get(*unknowns)))
        differences = (ends[0] - ends[1]) / (2 * step)
        for unknown, difference in zip(unknowns, differences):
            assert found[unknown, known] == pytest.approx(difference, rel=1e-6, abs=1e-8 * abs(ends[0]).max() / abs(at[known]))
    # the inner state stays what it is while parameters change; those are tuned at events
    instance.fmu.enterEventMode()
    for known in parameters:
        step, ends = 1e-6 * abs(size[known]), []
        for side in (step, -step):
            instance.set({known: size[known] + side})
            ends.append(np.array(instance.get(*unknowns)))
        instance.set({known: size[known]})
        differences = (ends[0] - ends[1]) / (2 * step)
        for unknown, difference in zip(unknowns, differences):
            expected = pytest.approx(difference, rel=1e-5, abs=1e-7 * abs(ends[0]).max() / abs(size[known]))
            assert found[unknown, known] == expected, (unknown, known)


@both_versions
@inner
def test_the_inner_state_is_a_state_of_the_fmu(model, name, fmi):
    instance = model(with_friction(LAWS[name]), "element")
    instance.enter_initialization()
    instance.set({"a.y": 1e-5, "a.v": 0.3})
    started = instance.get(STATE[name])[0]
    # straight to where the motion starts
    assert started == pytest.approx(1e-5 * (1.0 if name == "lugre" else 1e7), rel=0.1)
    instance.fmu.exitInitializationMode()
    instance.enter_continuous_time()
    assert instance.states() == [STATE[name]] and instance.get_states() == [started]
    nominal = np.empty(1)
    instance.fmu.getNominalsOfContinuousStates(pointer(nominal), 1)
    assert nominal[0] == (1e-4 if name == "lugre" else 100.0)
    state = 2e-5 if name == "lugre" else 77.0
    instance.set_states(np.array([state]))
    saved = instance.fmu.getFMUState()
    written = instance.fmu.serializeFMUState(saved)
    expected = [*instance.get("b.F", "energy.stored", STATE[name]), *instance.get_rates()]
    instance.set_states(np.array([-state]))
    instance.set({"a.y": 3e-5})
    instance.fmu.completedIntegratorStep()
    assert instance.get("b.F")[0] != expected[0]
    instance.fmu.setFMUState(saved)
    assert [*instance.get("b.F", "energy.stored", STATE[name]), *instance.get_rates()] == expected
    instance.set_states(np.array([-state]))
    instance.fmu.setFMUState(instance.fmu.deserializeFMUState(written))
    assert [*instance.get("b.F", "energy.stored", STATE[name]), *instance.get_rates()] == expected


# m = 1 with a slider, pushed by a load that is held; the joint slips and sticks.
FORCE, STIFFNESS, DAMPING = 1.5, 1.0, 0.02
JENKINS = {"law": "jenkins", "stiffness": 2.0, "slip_force": 0.5}
SOFT_IWAN = {"law": "iwan", "slip_force": 1.0, "stiffness": 2.0, "exponent": -0.3, "ratio": 0.5}


def oscillator(law):
    bodies = {"a": body([1.0], [STIFFNESS], [DAMPING]), "b": body([1e12], [0.0], [0.0])}
    return changed(joint(["y"], [[0.0]], [[0.0]], [0.0], bodies), friction=[{"dof": "y", **law}])


def jenkins_in_scipy(times):
    """Displacement and velocity with sticking, slipping and turning located."""
    k, h = JENKINS["stiffness"], JENKINS["slip_force"]
    t, y, slider, sign, found = 0.0, np.zeros(2), 0.0, 0, np.zeros((len(times), 2))

    def rate(_, y):
        load = k * (y[0] - slider) if sign == 0 else sign * h
        return [y[1], FORCE - STIFFNESS * y[0] - DAMPING * y[1] - load]

    def slips(_, y):
        return h - k * abs(y[0] - slider) if sign == 0 else 1.0

    def turns(_, y):
        return sign * y[1] if sign else 1.0

    slips.terminal = turns.terminal = True
    slips.direction = turns.direction = -1
    while t < times[-1]:
        part = solve_ivp(rate, (t, times[-1]), y, "DOP853", rtol=1e-12, atol=1e-14, events=[slips, turns], dense_output=True)
        within = (times >= t) & (times <= part.t[-1])
        found[within] = part.sol(times[within]).T if within.any() else found[within]
        t, y = part.t[-1], part.y[:, -1]
        if sign == 0:
            sign = int(np.sign(y[0] - slider)) if part.t_events[0].size else 0
        elif part.t_events[1].size:
            slider, sign = y[0] - sign * h / k, 0
    return found


def simulated(fmu, tolerance, end, places_events=True, points=100, **more):
    description = fmpy.read_model_description(fmu)
    assert description.numberOfEventIndicators == 2
    if not places_events:
        description.numberOfEventIndicators = 0
        description.eventIndicators = []
    return fmpy.simulate_fmu(
        fmu, fmi_type="ModelExchange", model_description=description, stop_time=end, output_interval=end / points,
        relative_tolerance=tolerance, start_values={"a.F": FORCE}, output=["a.y", "a.v", "energy.dissipated", "energy.stored"],
        **more,
    )


@both_versions
def test_cvode_places_what_slips_and_turns(export, fmi):
    fmu, end = str(export(oscillator(JENKINS), "lap", fmi=fmi)), 30.0

    def error(*arguments, **options):
        result = simulated(fmu, *arguments, **options)
        expected = jenkins_in_scipy(result["time"])
        found = np.array([result["a.y"], result["a.v"]]).T
        return np.abs(found - expected).max() / np.abs(expected).max()

    errors = np.array([error(tolerance, end) for tolerance in (1e-5, 1e-7, 1e-9)])
    assert np.all(errors[1:] < 0.1 * errors[:-1]) and errors[-1] < 1e-7, errors
    # without events what counts is how often a step is completed: FMPy says so at each output point alone
    without = np.array([error(1e-9, end, places_events=False, points=points) for points in (100, 400, 1600)])
    assert np.all(without[1:] < 0.4 * without[:-1]) and without[-1] < 1e-4, without


@both_versions
@pytest.mark.parametrize("law", [JENKINS, SOFT_IWAN], ids=lambda law: law["law"])
def test_events_do_not_chatter_at_rest(export, law, fmi):
    fmu, end = str(export(oscillator(law), "lap", fmi=fmi)), 2000.0
    result = simulated(fmu, 1e-6, end, points=4000, record_events=True)
    # at rest at the end, where the joint holds what its spring and support bear
    assert np.abs(result["a.v"][-1]) < 1e-6
    t = result["time"]
    events = t[1:][np.diff(t) == 0]
    assert len(events) > 100 and events[-1] < 0.75 * end
    # a half cycle takes π/√3 at least, and has a turn, a slip and the closing of a loop at most
    assert np.max([np.sum((events >= at) & (events < at + 2 * np.pi)) for at in np.arange(0, end, 2 * np.pi)]) <= 4 * np.sqrt(3) * 3
    assert len(events) < 4 * np.sqrt(3) * 3 * end / (2 * np.pi)
