"""Loads of element FMUs against the joint's law."""

import numpy as np
import pytest
from instances import both_versions
from joints import LAPS
from reference import Joint


@both_versions
@pytest.mark.parametrize("case", LAPS)
def test_loads_energy_and_power(slave, case):
    joint = Joint(LAPS[case])
    n = joint.n
    instance = slave(LAPS[case], "element")
    instance.initialise()
    motion = ["y", "theta"][:n], ["v", "omega"][:n]
    generator = np.random.default_rng(5)
    for index in range(50):
        x_a, x_b = generator.normal(scale=[1e-4, 1e-3][:n], size=(2, n))
        v_a, v_b = generator.normal(scale=[0.1, 1.0][:n], size=(2, n))
        values = {}
        for side, x, v in (("a", x_a, v_a), ("b", x_b, v_b)):
            values |= {f"{side}.{name}": value for name, value in zip(motion[0], x)}
            values |= {f"{side}.{name}": value for name, value in zip(motion[1], v)}
        instance.set(values)
        instance.step(index * 1e-3, 1e-3)
        load = joint.load_on_b(x_a - x_b, v_a - v_b)
        scale = np.abs(joint.K) @ np.abs(x_a - x_b) + np.abs(joint.C) @ np.abs(v_a - v_b)
        for sign, names in ((-1, ["a.F", "a.M"]), (1, ["b.F", "b.M"]), (1, ["joint.F", "joint.M"])):
            found = np.array(instance.get(*names[:n]))
            assert (np.abs(found - sign * load) <= 1e-12 * scale).all(), names
        assert instance.get("energy.stored", "power.dissipated") == pytest.approx(
            [joint.energy(x_a - x_b), joint.power(x_a - x_b, v_a - v_b)], rel=1e-12
        )


@both_versions
def test_a_one_dof_element_has_no_rotation(slave):
    instance = slave(LAPS["linear-1"], "element")
    rotational = [name for name in instance.reference if "theta" in name or "omega" in name or name.endswith(".M")]
    assert rotational == []


@both_versions
def test_tunable_parameters_act_at_once(slave):
    instance = slave(LAPS["linear-1"], "element")
    instance.initialise()
    instance.set({"a.y": 1e-4})
    assert instance.get("b.F") == pytest.approx([456.0], rel=1e-14)
    instance.set({"joint.k_yy": 1e6})
    instance.step(0.0, 1e-3)
    assert instance.get("b.F", "a.F") == pytest.approx([100.0, -100.0], rel=1e-14)
