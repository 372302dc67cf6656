"""How far a softening joint holds: the calculated parameter, the warning before it, and the error beyond."""

import sys

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from instances import both_versions
from joints import HIGHER_2, LINEAR_1, SOFTENING_1, SOFTENING_2, changed
from numpy.polynomial import Polynomial
from reference import HIGHER

NONE = sys.float_info.max

ONE = {
    "cubic": SOFTENING_1,
    "first of two roots": changed(SOFTENING_1, higher={"quintic": [1.7e17]}),
    "stiffened in time": changed(SOFTENING_1, higher={"quintic": [1e18]}),
    "seventh order": changed(SOFTENING_1, cubic=[3e12], higher={"quintic": [-4e17], "septic": [-5e23]}),
    "linear": LINEAR_1,
}
TWO = {
    "cubic": SOFTENING_2,
    "higher": HIGHER_2,
    "softens late": changed(SOFTENING_2, cubic=[2e10, 1e5], higher={"quintic": [-1e16, -4e8], "septic": [0.0, 1e12]}),
    "other folds": changed(SOFTENING_2, cubic=[-2e9, -1e6], higher={"quintic": [-1e12, -1e8]}),
}


def secants(file, supports):
    """Secant stiffness of each DOF as a polynomial of its displacement squared."""
    joint = file["joint"]
    n = len(joint["cubic"])
    higher = joint.get("higher", {})
    quintic, septic = (higher.get(key, [0.0] * n) for key in HIGHER[:2])
    stiffness = np.array(joint["stiffness"])
    if supports:
        k_a, k_b = (np.array(file["bodies"][side]["stiffness"]) for side in "ab")
        stiffness = stiffness + np.diag(k_a * k_b / (k_a + k_b))
    each = [Polynomial([stiffness[i, i], joint["cubic"][i], quintic[i], septic[i]]) for i in range(n)]
    return each, stiffness[0, -1] if n > 1 else 0.0


def first_positive_root(polynomial):
    """Of a polynomial with coefficients of very different magnitudes, by its companion matrix."""
    polynomial = polynomial.trim()
    # scaled so that the coefficients at both ends have one magnitude
    degree = polynomial.degree()
    if degree < 1:
        return np.inf
    scale = abs(polynomial.coef[0] / polynomial.coef[-1]) ** (1 / degree)
    roots = scale * Polynomial(polynomial.coef * scale ** np.arange(degree + 1)).roots()
    real = roots[(abs(roots.imag) < 1e-9 * abs(roots)) & (roots.real > 0)].real
    return real.min(initial=np.inf)


def amplitudes(file, supports):
    each, coupling = secants(file, supports)
    u = Polynomial([0, 1])
    found = []
    for i, own in enumerate(each):
        if (own.coef[1:] >= 0).all():
            found.append(NONE)
            continue
        if not coupling:
            squared = first_positive_root(own)
        else:
            other = each[1 - i]
            squared_of_own = u * other**2 / coupling**2
            end = min(
                first_positive_root(own(squared_of_own) * other - coupling**2),
                first_positive_root(other + 2 * u * other.deriv()),
            )
            squared = squared_of_own(end) if np.isfinite(end) else np.inf
        found.append(np.sqrt(squared) if np.isfinite(squared) else NONE)
    return found


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("case", [*ONE, *(f"{case} with rotation" for case in TWO)])
def test_the_amplitude_is_the_first_root(slave, case, interface):
    file = ONE.get(case) or TWO[case.removesuffix(" with rotation")]
    names = ["joint.escape_amplitude_y", "joint.escape_amplitude_theta"][: len(file["joint"]["cubic"])]
    instance = slave(file, interface)
    variables = {variable.name: variable for variable in instance.description.modelVariables}
    for name in names:
        assert variables[name].causality == "calculatedParameter" and variables[name].start is None
    expected = amplitudes(file, interface == "lap")
    instance.enter_initialization()
    assert instance.get(*names) == pytest.approx(expected, rel=1e-9)
    instance.fmu.exitInitializationMode()
    assert instance.get(*names) == pytest.approx(expected, rel=1e-9)
    assert np.isfinite(instance.get(*names)).all()


def test_the_cases_differ():
    """Otherwise the comparison above would prove little."""
    escapes = {case: amplitudes(file, True)[0] for case, file in ONE.items()}
    assert escapes["stiffened in time"] == escapes["linear"] == NONE
    assert len(set(escapes.values())) == 4
    k, k_s = 4.56e6, 10.56e5 * 8.82e5 / (10.56e5 + 8.82e5)
    assert escapes["cubic"] == pytest.approx(np.sqrt((k + k_s) / 2e12), rel=1e-12)
    # the first of two
    assert escapes["first of two roots"] ** 2 < 2e12 / (2 * 1.7e17) < np.inf
    assert all(amplitude < 1 for file in TWO.values() for amplitude in amplitudes(file, True)[:1])


def warnings(instance):
    return [text for status, category, text in instance.messages if category == "logStatusWarning"]


@both_versions
@pytest.mark.parametrize("case", ["cubic", "first of two roots"])
def test_a_lap_warns_once_and_then_fails(slave, case):
    instance = slave(ONE[case], "lap")
    [amplitude] = amplitudes(ONE[case], True)
    instance.initialise()
    past, failed = [], None
    step = 1e-5
    for index in range(100_000):
        # a load that goes with the motion makes the swing grow
        v_a, v_b = instance.get("a.v", "b.v")
        load = 400.0 if v_a >= v_b else -400.0
        instance.set({"a.F": load, "b.F": -load})
        told = len(warnings(instance))
        try:
            instance.step(index * step, step)
        except FMICallException:
            failed = index
            break
        a, b = instance.get("a.y", "b.y")
        assert abs(a - b) <= amplitude
        if abs(a - b) > 0.8 * amplitude:
            past.append((index, len(warnings(instance)) - told))
    assert failed is not None and len(past) > 10
    assert [new for _, new in past] == [1] + [0] * (len(past) - 1)
    [warning] = warnings(instance)
    assert "80 per cent of joint.escape_amplitude_y" in warning and "a.y - b.y" in warning
    assert "softening joint no longer holds" in instance.messages[-1][2]


@both_versions
def test_the_importer_s_solver_is_told_once_too(model):
    instance = model(ONE["cubic"], "lap")
    [amplitude] = amplitudes(ONE["cubic"], True)
    instance.initialise()
    instance.enter_continuous_time()
    for part, told in [(0.79, 0), (0.81, 1), (0.1, 1), (0.9, 1), (0.999, 1)]:
        instance.set_states([part * amplitude if name == "a.y" else 0.0 for name in instance.states()])
        instance.fmu.completedIntegratorStep()
        assert len(warnings(instance)) == told
    instance.set_states([1.001 * amplitude if name == "a.y" else 0.0 for name in instance.states()])
    with pytest.raises(FMICallException):
        instance.fmu.completedIntegratorStep()


@both_versions
def test_an_element_warns_once_and_goes_on(slave):
    instance = slave(ONE["cubic"], "element")
    [amplitude] = amplitudes(ONE["cubic"], False)
    instance.initialise()
    for index, (part, told) in enumerate([(0.79, 0), (0.81, 1), (1.5, 1), (0.5, 1), (0.9, 1)]):
        instance.set({"b.y": part * amplitude})
        instance.step(index * 1e-3, 1e-3)
        assert len(warnings(instance)) == told
        r = -part * amplitude
        assert instance.get("joint.F") == pytest.approx([4.56e6 * r - 2e12 * r**3], rel=1e-12)


@both_versions
def test_the_amplitude_follows_a_parameter(slave):
    instance = slave(ONE["cubic"], "lap")
    [amplitude] = amplitudes(ONE["cubic"], True)
    instance.enter_initialization()
    instance.set({"joint.k3_y": -8e12})
    assert instance.get("joint.escape_amplitude_y") == pytest.approx([amplitude / 2], rel=1e-12)
    # dr/dk3 = −r/(2 k3), exact in Initialization Mode
    references = [instance.reference[name] for name in ("joint.escape_amplitude_y", "joint.k3_y")]
    found = instance.fmu.getDirectionalDerivative(references[:1], references[1:], [1.0])
    assert list(found) == pytest.approx([amplitude / 2 / 16e12], rel=1e-12)
    instance.fmu.exitInitializationMode()
