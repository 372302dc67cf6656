"""Joints whose laws remember: Iwan's, Valanis', Dahl's, LuGre and Bouc-Wen, in FMUs of both versions and both interfaces."""

import json

import numpy as np
import pytest
from instances import both_versions
from joints import body, changed, joint
from test_friction_over_preload import Dahl, Valanis

K, C, H = 2e6, 20.0, 1e-4
IWAN = {"law": "iwan", "slip_force": 4000.0, "stiffness": 1.5e7, "exponent": -0.3, "ratio": 0.5}
ON_THETA = {"law": "iwan", "slip_force": 0.9, "stiffness": 800.0, "exponent": 0.2, "ratio": 0.1}

VALANIS = {"law": "valanis", "stiffness": 1.5e7, "slip_stiffness": 1e6, "slip_force": 3000.0, "kappa": 0.7}
DAHL = {"law": "dahl", "stiffness": 1e7, "slip_force": 2000.0}
LUGRE = {
    "law": "lugre",
    "stiffness": 1e7,
    "bristle_damping": 100.0,
    "damping": 60.0,
    "slip_force": 2000.0,
    "static_force": 3000.0,
    "stribeck_velocity": 0.05,
}
BOUC_WEN = {"law": "bouc-wen", "stiffness": 1e7, "slip_force": 2000.0, "exponent": 1.5, "beta": 0.8, "gamma": -0.3}

# A random walk, and after each step of it: load, heat since the start, and the latest reversal that is remembered. Made with 30
# digits (mpmath) by a stack of reversal points over Segalman's virgin curve, which agrees with 40,000 sliders to 1e-9.
WALK = [
    (-0.0002576, -2820.157468618834, 0.06971321676246361, 0.0),
    (-0.0003418, -3438.7392347244813, 0.14960491507400764, 0.0),
    (-0.0003064, -2929.748805691514, 0.14970591454966747, -0.0003418),
    (-0.0003536, -3515.4632665809236, 0.1641644479349825, 0.0),
    (-0.0003063, -2841.9854448147685, 0.16438531725374594, -0.0003536),
    (-0.0002917, -2643.8721591988747, 0.16462108910482248, -0.0003536),
    (0.0005516, 4000.0, 1.0732095962673176, 0.0),
    (-0.0003685, -4000.0, 1.830974994964662, 0.0005516),
    (-0.0004757, -4000.0, 2.259774994964662, 0.0005516),
    (-0.0002872, -1550.363840413665, 2.269008167879955, -0.0004757),
    (-0.0002741, -1399.5843721087608, 2.270844666555771, -0.0004757),
    (-0.0003711, -2732.4556030819253, 2.2723803227440897, -0.0002741),
    (-0.0003349, -2212.3174125709975, 2.2724876039019515, -0.0003711),
    (0.0002962, 3427.4324463069042, 2.678206739061113, -0.0004757),
    (-0.0002902, -2766.9960538249247, 2.875964714851092, 0.0002962),
    (-3.946e-05, 380.36146024990273, 2.8959133914519466, -0.0002902),
    (8.501e-06, 887.0845549356611, 2.907964667697078, -0.0002902),
    (0.000158, 2308.5693565253314, 2.971680664509742, -0.0002902),
    (0.000215, 2791.7371096791926, 3.008204256343389, -0.0002902),
    (0.000199, 2557.442823721546, 3.0082160904169584, 0.000215),
    (-6.184e-05, -634.5979819534662, 3.034267483021665, 0.000215),
    (-0.0002191, -2159.460882299372, 3.0960059176725507, 0.000215),
    (-0.0002154, -2104.4343048734113, 3.096006144740045, -0.0002191),
    (-0.0001532, -1234.2619792907158, 3.096546673154812, -0.0002191),
    (-2.328e-05, 374.69250970351635, 3.106239421032661, -0.0002191),
    (-0.0001337, -1129.382065644007, 3.108418330657307, -2.328e-05),
    (-0.0001267, -1025.7815649888917, 3.1084196005733795, -0.0001337),
    (0.000273, 3251.9758966377776, 3.2332628971752975, -0.0002902),
    (-0.000349, -3190.1094308148404, 3.4688096111753777, 0.0002962),
    (-0.0005542, -4000.0, 3.942202393521721, 0.0),
    (-0.0005409, -3804.667290933091, 3.942209578239978, -0.0005542),
    (-0.000671, -4000.0, 4.409416762958235, 0.0),
    (-0.000684, -4000.0, 4.461416762958235, 0.0),
    (-0.0006038, -2885.3898623488535, 4.462335690156802, -0.000684),
]


def with_friction(*laws, dofs=("y",)):
    """A joint with these laws, each on the DOF that it names, else on y."""
    stiffness, damping = {1: ([[K]], [[C]]), 2: ([[K, 1e3], [1e3, 900.0]], [[C, 0.1], [0.1, 0.05]])}[len(dofs)]
    return changed(
        joint(list(dofs), stiffness, damping, [0.0] * len(dofs)),
        friction=[{"dof": "y", **law} for law in laws],
    )


def motions(count, amplitude=4e-4):
    """Relative displacement and velocity at the communication points: two tones, so that loops lie in loops."""
    t = H * np.arange(count)
    r = amplitude * (np.sin(300 * t) + 0.6 * np.sin(1130 * t + 0.3))
    v = amplitude * (300 * np.cos(300 * t) + 0.6 * 1130 * np.cos(1130 * t + 0.3))
    return t, r, v


def drive(slave, start, end, outputs):
    """Outputs at the communication points from `start` to `end`, each followed by a step."""
    t, r, v = motions(end)
    rows = []
    for index in range(start, end):
        slave.set({"a.y": 0.25 * r[index], "a.v": 0.25 * v[index], "b.y": -0.75 * r[index], "b.v": -0.75 * v[index]})
        rows.append(slave.get(*outputs))
        slave.step(t[index], H)
    return np.array(rows)


@both_versions
def test_a_random_walk_of_iwan_s_law_is_that_of_the_reversal_stack(slave):
    instance = slave(changed(with_friction(IWAN), damping=[[0.0]]), "element")
    instance.initialise()
    for index, (u, load, heat, reversal) in enumerate(WALK):
        instance.set({"a.y": u})
        # trials leave no trace
        instance.set({"a.y": -2 * u})
        instance.get("b.F")
        instance.set({"a.y": u})
        found = instance.get("b.F")[0] - K * u
        assert abs(found - load) < 1e-12 * 4000 + 1e-15 * abs(K * u), index
        instance.step(index * H, H)
        found = instance.get("b.F", "energy.dissipated", "joint.iwan_reversal_y")
        assert abs(found[0] - K * u - load) < 1e-12 * 4000 + 1e-15 * abs(K * u), index
        assert found[1] == pytest.approx(heat, rel=1e-12, abs=1e-15), index
        assert found[2] == reversal, index


@both_versions
def test_in_model_exchange_too_the_walk_is_that_of_the_reversal_stack(model):
    instance = model(changed(with_friction(IWAN), damping=[[0.0]]), "element")
    instance.initialise()
    instance.enter_continuous_time()
    for index, (u, load, _, reversal) in enumerate(WALK):
        # trials leave no trace
        for trial in (u, -2 * u, u):
            instance.set({"a.y": trial})
            found = instance.get("b.F")[0] - K * trial
        assert abs(found - load) < 1e-12 * 4000 + 1e-15 * abs(K * u), index
        instance.fmu.setTime((index + 1) * H)
        instance.fmu.completedIntegratorStep()
        found = instance.get("b.F", "joint.iwan_reversal_y")
        assert abs(found[0] - K * u - load) < 1e-12 * 4000 + 1e-15 * abs(K * u), index
        assert found[1] == reversal, index


@both_versions
@pytest.mark.parametrize("law", [Dahl, Valanis], ids=lambda law: law.entry["law"])
def test_in_model_exchange_an_element_on_a_random_path(model, law):
    """The closed forms of each way, committed where the importer has completed a step. The laws whose loads are states are in
    test_friction_exchange.py."""
    instance, own = model(with_friction(law.entry), "element"), law()
    instance.initialise()
    instance.enter_continuous_time()
    random = np.random.default_rng(5)
    for index, u in enumerate(3e-4 * np.cumsum(random.uniform(-1, 1, 300)) / 4):
        for trial in (u, -u, u):
            instance.set({"a.y": trial})
            found = instance.get("b.F")[0]
            expected = (K + own.spring) * trial + own.load(trial, 1.0)
            assert found == pytest.approx(expected, rel=1e-12, abs=1e-12 * own.entry["slip_force"]), index
        instance.fmu.setTime((index + 1) * H)
        instance.fmu.completedIntegratorStep()
        own.commit(u, 1.0)


def test_the_tangent_of_iwan_s_law_is_that_of_the_trial(slave):
    instance = slave(with_friction(IWAN), "element")
    instance.initialise()

    def tangent():
        arguments = ([instance.reference["b.F"]], [instance.reference["a.y"]])
        return instance.fmu.getDirectionalDerivative(*arguments, [1.0])[0]

    for index, (u, *_) in enumerate(WALK):
        instance.set({"a.y": u})
        found, step = tangent(), 1e-6 * 4.4e-4
        at = []
        for side in (step, -step):
            instance.set({"a.y": u + side})
            at.append(instance.get("b.F")[0])
        instance.set({"a.y": u})
        assert found == pytest.approx((at[0] - at[1]) / (2 * step), rel=1e-3), index
        instance.step(index * H, H)


ALL = [
    pytest.param([IWAN], id="iwan"),
    pytest.param([VALANIS], id="valanis"),
    pytest.param([DAHL], id="dahl"),
    pytest.param([LUGRE], id="lugre"),
    pytest.param([BOUC_WEN], id="bouc-wen"),
    pytest.param([IWAN, VALANIS, DAHL, LUGRE, BOUC_WEN], id="all"),
]


def alone(law):
    """The law with no joint beside it."""
    return changed(with_friction(law), stiffness=[[0.0]], damping=[[0.0]])


def move(instance, path, velocity=None):
    """Goes from point to point, the way to each at this speed where one is given; returns the heat after each."""
    heat, at, time = [], 0.0, 0.0
    for y in path:
        if velocity is not None:
            instance.set({"a.y": at, "a.v": np.sign(y - at) * velocity})
            instance.step(time, H)
            time += H
            instance.set({"a.v": np.sign(y - at) * velocity})
        instance.set({"a.y": y})
        instance.step(time, H)
        heat.append(instance.get("energy.dissipated")[0])
        at, time = y, time + H
    return np.array(heat)


@both_versions
@pytest.mark.parametrize(
    "kappa, tip, cycle, after",
    [
        # with 30 digits from the equation of the steady loop, and by steps with Lambert's W
        (0.0, 4.3514457315547, 0.032971085368906, -3.4657448972292),
        (0.5, 4.6483770884788, 0.027032458230425, -3.896051151761),
        (0.9, 5.07125928497, 0.018574814300601, -4.4697512831095),
        (0.99, 5.1, 0.018, -4.5),
    ],
)
def test_valanis_loops_are_those_of_the_closed_form(slave, kappa, tip, cycle, after):
    law = {"law": "valanis", "stiffness": 1000.0, "slip_stiffness": 100.0, "slip_force": 5.0, "kappa": kappa}
    instance = slave(alone(law), "element")
    instance.initialise()
    move(instance, [4e-3, 6e-3, -2e-3, 3e-3, -6e-3])
    assert instance.get("joint.valanis_p_y")[0] == pytest.approx(after, rel=1e-12)
    instance.fmu.reset()
    instance.initialise()
    heat = move(instance, [6e-3, -6e-3] * 60 + [6e-3])
    assert instance.get("b.F")[0] == pytest.approx(tip, rel=1e-12)
    assert heat[-1] - heat[-3] == pytest.approx(cycle, rel=1e-11)


@both_versions
def test_dahl_loops_are_those_of_the_closed_form(slave):
    instance = slave(alone({"law": "dahl", "stiffness": 1e5, "slip_force": 2.0}), "element")
    instance.initialise()
    heat = move(instance, [5e-5, -5e-5] * 40 + [5e-5])
    # F_m = F_c tanh(σ₀X/F_c), D = 4 F_c (X − F_m/σ₀)
    load = 2.0 * np.tanh(2.5)
    assert instance.get("b.F")[0] == pytest.approx(load, rel=1e-12)
    assert heat[-1] - heat[-3] == pytest.approx(8.0 * (5e-5 - load / 1e5), rel=1e-11)


@both_versions
def test_lugre_slides_and_gets_there_as_the_closed_forms_say(slave):
    law = {"stiffness": 1e5, "bristle_damping": 316.22776601683796, "slip_force": 1.0, "static_force": 1.5}
    law = {"law": "lugre", **law, "damping": 160.0, "stribeck_velocity": 1e-3}
    instance = slave(alone(law), "element")
    for velocity, deflection in [(1e-4, 2.97010049456189e-7), (1e-3, 2.65008182456761e-6), (1e-2, 9.50212931632136e-6)]:
        instance.initialise()
        move(instance, np.linspace(0, 3e-3 * velocity, 8)[1:], velocity)
        assert instance.get("joint.lugre_z_y")[0] == pytest.approx(deflection, rel=1e-12)
        instance.set({"a.y": 1.0})
        slip = 1 + 0.5 * np.exp(-((velocity / 1e-3) ** 2))
        assert instance.get("b.F")[0] == pytest.approx(slip + 160.0 * velocity, rel=1e-12)
        instance.fmu.reset()


@both_versions
@pytest.mark.parametrize(
    "exponent, beta, gamma, tip, cycle",
    [
        # with 14 digits from hypergeometric functions (mpmath)
        (1.0, 0.6, 0.4, 0.73202144188549, 0.68095622771471),
        (2.0, 0.5, 0.5, 0.82565886174634, 0.46308783649238),
        (1.5, 0.8, -0.3, 0.987082735703, 0.77576353358281),
        (3.0, 0.9, 0.1, 0.89563583370348, 0.60466440873172),
    ],
)
def test_bouc_wen_loops_are_those_of_the_closed_form(slave, exponent, beta, gamma, tip, cycle):
    law = {"stiffness": 1.0, "slip_force": 1.0, "exponent": exponent, "beta": beta, "gamma": gamma}
    instance = slave(alone({"law": "bouc-wen", **law}), "element")
    instance.initialise()
    heat = move(instance, [1.0, -1.0] * 80 + [1.0])
    assert instance.get("b.F")[0] == pytest.approx(tip, rel=1e-11)
    assert heat[-1] - heat[-3] == pytest.approx(cycle, rel=1e-10)


@both_versions
@pytest.mark.parametrize("laws", ALL)
def test_a_state_in_the_middle_of_a_loop_goes_on_to_the_bit(slave, laws):
    file = with_friction(*laws, {"dof": "theta", **ON_THETA}, dofs=("y", "theta"))
    straight = slave(file, "element")
    straight.initialise()
    remembered = [name for name in straight.reference if name.endswith(("_reversal_y", "_p_y", "_z_y"))]
    assert remembered
    outputs = ("b.F", "b.M", "energy.stored", "energy.dissipated", "power.dissipated", *remembered)
    expected = drive(straight, 0, 400, outputs)
    other = slave(file, "element")
    other.initialise()
    begun = drive(other, 0, 170, outputs)
    state = other.fmu.getFMUState()
    written = other.fmu.serializeFMUState(state)
    # a step that is taken back leaves no trace
    for y in (5e-3, -4e-3, 1e-4):
        other.set({"a.y": y, "b.y": -y})
        other.step(170 * H, H) if y == 5e-3 else other.get("b.F")
    assert other.get("energy.dissipated")[0] != expected[169, 3]
    other.fmu.setFMUState(state)
    resumed = drive(other, 170, 400, outputs)
    assert np.array_equal(np.concatenate([begun, resumed]), expected)
    third = slave(file, "element")
    third.initialise()
    third.fmu.setFMUState(third.fmu.deserializeFMUState(written))
    assert np.array_equal(drive(third, 170, 400, outputs), expected[170:])


@pytest.mark.parametrize("laws", ALL)
def test_work_is_what_is_stored_and_the_heat(slave, laws):
    instance = slave(changed(with_friction(*laws), damping=[[0.0]]), "element")
    instance.initialise()
    count = 6000
    t = 0.1 * H * np.arange(count)
    r = 2e-4 * (np.sin(300 * t) + 0.6 * np.sin(1130 * t))
    v = 2e-4 * (300 * np.cos(300 * t) + 0.6 * 1130 * np.cos(1130 * t))
    work, before = 0.0, None
    for index in range(count):
        instance.set({"a.y": r[index], "a.v": v[index]})
        load = instance.get("b.F")[0]
        if before is not None:
            work += 0.5 * (load + before) * (r[index] - r[index - 1])
        before = load
        instance.step(0.1 * H * index, 0.1 * H)
    # what is committed is that of the last motion, before which the work ends
    stored, heat = instance.get("energy.stored", "energy.dissipated")
    assert heat > 0.1 * stored
    assert work == pytest.approx(stored + heat, rel=2e-4)


@pytest.mark.parametrize("laws", ALL)
def test_model_exchange_commits_completed_steps_alone(slave, model, laws):
    """The importer's Runge–Kutta steps with a commit after each are those of the library, but for its cuts where the joint turns."""
    file = with_friction(*laws)
    file["bodies"] = {"a": body([1.0], [5e6], [50.0]), "b": body([1e9], [0.0], [0.0])}
    size = 1e-6
    inner = slave(file, "lap", "--step-size-max", repr(size))
    outer = model(file, "lap", "--step-size-max", repr(size))
    force = 3000.0
    inner.initialise(**{"a.F": force})
    outer.initialise(**{"a.F": force})
    outer.enter_continuous_time()
    x = outer.get_states()

    def rate(at):
        outer.set_states(at)
        return outer.get_rates()

    for index in range(3000):
        k1 = rate(x)
        k2 = rate(x + size / 2 * k1)
        k3 = rate(x + size / 2 * k2)
        k4 = rate(x + size * k3)
        x = x + size / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        outer.fmu.setTime((index + 1) * size)
        outer.set_states(x)
        outer.fmu.completedIntegratorStep()
        inner.step(index * size, size)
    names = ("a.y", "a.v", "joint.F", "energy.stored")
    assert outer.get(*names) == pytest.approx(inner.get(*names), rel=2e-5)
    # the importer integrates the power of slipping; the library knows the heat of each way
    heat = outer.states().index("energy.dissipated")
    assert x[heat] == pytest.approx(inner.get("energy.dissipated")[0], rel=1e-2)


@pytest.mark.parametrize(
    "law, fragments",
    [
        ({**IWAN, "exponent": -1.0}, ["friction[0].exponent: found -1.0", "above -1"]),
        ({**IWAN, "ratio": -0.1}, ["friction[0].ratio: found -0.1", "zero or more"]),
        ({**IWAN, "slip_force": 0.0}, ["friction[0].slip_force: found 0.0", "above 0"]),
        ({**VALANIS, "kappa": 1.2}, ["friction[0].kappa: found 1.2", "0 to 1"]),
        ({**DAHL, "slip_force": 0.0}, ["friction[0].slip_force: found 0.0", "above 0"]),
        ({**LUGRE, "damping": 49.0}, ["friction[0].damping: found 49.0", "50.0 or more", "gives energy"]),
        ({**BOUC_WEN, "gamma": 0.81}, ["friction[0].gamma: found 0.81", "-0.8 to 0.8", "gives energy"]),
    ],
)
def test_parameters_outside_of_a_law_are_refused_by_key_value_and_bound(run, tmp_path, law, fragments):
    path = tmp_path / "wrong.joint.json"
    path.write_text(json.dumps(with_friction(law)))
    said = run("export", path, "-o", tmp_path / "wrong.fmu", expect=1).stderr
    assert all(fragment in said for fragment in fragments), said
    assert not (tmp_path / "wrong.fmu").exists()


@both_versions
def test_parameters_outside_of_a_law_are_refused_by_the_fmu(slave):
    instance = slave(with_friction(IWAN), "element")
    instance.enter_initialization()
    instance.set({"joint.iwan_chi_y": -1.5})
    with pytest.raises(Exception, match="Initialization"):
        instance.fmu.exitInitializationMode()
    assert "joint.iwan_chi_y is -1.5, expected a number above -1" in instance.messages[-1][2]


@pytest.mark.parametrize("laws", ALL)
@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_the_program_s_own_check_finds_nothing(export, run, interface, fmi, laws):
    file = with_friction(*laws, {"dof": "theta", **ON_THETA}, dofs=("y", "theta"))
    if interface == "lap":
        sides = body([1.41, 0.01], [8.24e5, 100.0], [0.78, 0.01])
        file["bodies"] = {"a": sides, "b": sides}
    told = run("check", export(file, interface, fmi=fmi)).stdout
    assert "reference run: met" in told, told
