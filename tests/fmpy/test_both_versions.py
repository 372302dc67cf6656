"""FMUs of FMI 2 and FMI 3 hold one library and give the same bits. So the long tests of numbers run for one version alone."""

import fmpy
import numpy as np
import pytest
from instances import Model, Slave
from joints import LAPS
from test_friction import BOUC_WEN, DAHL, IWAN, LUGRE, ON_THETA, VALANIS, with_friction
from test_friction_table import ALL as OVER_PRELOAD

H = 1e-4
ON_TWO = with_friction(IWAN, {**ON_THETA, "dof": "theta"}, dofs=("y", "theta"))
JOINTS = {
    **LAPS,
    "friction-1": with_friction(IWAN, VALANIS, DAHL, LUGRE, BOUC_WEN) | {"bodies": LAPS["higher-1"]["bodies"]},
    "friction-2": ON_TWO | {"bodies": LAPS["higher-2"]["bodies"]},
    "friction over the preload": OVER_PRELOAD,
}


def both(export, folder, joint, interface, kind):
    for fmi in ("2", "3"):
        fmpy.extract(str(export(joint, interface, fmi=fmi)), str(folder / fmi))
        instance = kind(folder / fmi)
        yield instance
        instance.close()


def inputs(instance):
    return [v.name for v in instance.description.modelVariables if v.causality == "input" and v.type in ("Real", "Float64")]


def numbers(instance):
    """All variables that both versions have, in an order that does not depend on the version."""
    kinds = ("Real", "Float64")
    names = (v.name for v in instance.description.modelVariables if v.type in kinds and v.causality != "independent")
    return sorted(name for name in names if not name.startswith("der("))


def drive(instance, index):
    """Every input goes its own way: motions and loads of sizes that make the laws of friction slip, preloads within their table."""
    for number, name in enumerate(inputs(instance)):
        wave = np.sin(0.11 * index + number) + 0.6 * np.sin(0.37 * index)
        quantity = name.split(".")[-1]
        size = {"F": 600.0, "M": 1.0, "y": 2e-4, "theta": 2e-3, "v": 0.1, "omega": 1.0}.get(quantity)
        instance.set({name: 5.0 + wave if size is None else size * wave})


def assert_same(found):
    (names, two), (others, three) = found
    assert names == others
    two, three = np.array(two), np.array(three)
    assert np.isfinite(two).all() and (two == three).all()
    assert np.ptp(two, axis=0).max() > 0


@pytest.mark.parametrize("interface", ["element", "lap"])
@pytest.mark.parametrize("case", JOINTS)
def test_steps(export, tmp_path, case, interface):
    found = []
    for instance in both(export, tmp_path, JOINTS[case], interface, Slave):
        names, rows = numbers(instance), []
        instance.initialise()
        for index in range(100):
            drive(instance, index)
            rows.append(instance.get(*names))
            instance.step(index * H, H)
        found.append((names, rows))
    assert_same(found)


@pytest.mark.parametrize("case", JOINTS)
def test_rates_and_derivatives(export, tmp_path, case):
    found = []
    for instance in both(export, tmp_path, JOINTS[case], "lap", Model):
        names, rows = numbers(instance), []
        instance.initialise()
        instance.enter_continuous_time()
        states = instance.states()
        for index in range(100):
            instance.fmu.setTime(index * 1e-6)
            drive(instance, index)
            x, rates = instance.get_states(), instance.get_rates()
            instance.set_states(x + 1e-6 * rates)
            slopes = instance.fmu.getDirectionalDerivative(
                [instance.reference["joint.F"]], [instance.reference[states[0]]], [1.0]
            )
            instance.fmu.completedIntegratorStep()
            rows.append([*x, *rates, *slopes, *instance.get(*names)])
        found.append((names, rows))
    assert_same(found)
