"""Partial derivatives of the FMUs against complex steps through the equations of reference.py."""

import copy
import zipfile
from xml.etree import ElementTree

import numpy as np
import pytest
from instances import both_versions
from joints import LAPS
from reference import HIGHER, Joint, Lap

STEP = 1e-30  # imaginary: no difference is taken, so that nothing cancels
CASES = [case for case in LAPS if not case.startswith("linear")]


def points(n):
    """Displacements of a, of b, velocities of a, of b."""
    generator = np.random.default_rng(11)
    scales = np.repeat([[1e-4, 1e-3][:n], [0.1, 1.0][:n]], [2, 2], axis=0).ravel()
    return generator.normal(size=(5, 4 * n)) * scales


def per_side(n, of_y, of_theta):
    return [f"{side}.{name}" for side in "ab" for name in (of_y, of_theta)[:n]]


def with_joint_parameters(file, value_of):
    """The joint file with entries replaced by value_of(name, entry), which may be complex."""
    file = copy.deepcopy(file)
    dofs = ["y", "theta"][: len(file["joint"]["cubic"])]
    for key, letter in (("stiffness", "k"), ("damping", "c")):
        for i, row in enumerate(dofs):
            for j, column in enumerate(dofs):
                name = f"joint.{letter}_{dofs[min(i, j)]}{dofs[max(i, j)]}"
                file["joint"][key][i][j] = value_of(name, file["joint"][key][i][j])
    for i, dof in enumerate(dofs):
        file["joint"]["cubic"][i] = value_of(f"joint.k3_{dof}", file["joint"]["cubic"][i])
    higher = file["joint"].setdefault("higher", {})
    for key, letter in zip(HIGHER, ("k5", "k7", "c2", "c4")):
        given = higher.get(key, [0.0] * len(dofs))
        higher[key] = [value_of(f"joint.{letter}_{dof}", entry) for dof, entry in zip(dofs, given)]
    for side, body in file.get("bodies", {}).items():
        for i, dof in enumerate(dofs):
            for key, name in (("inertia", "mJ"[i]), ("stiffness", f"k_{dof}"), ("damping", f"c_{dof}")):
                body[key][i] = value_of(f"{side}.{name}", body[key][i])
    return file


def parameter_names(file):
    names = []
    with_joint_parameters(file, lambda name, value: names.append(name) or value)
    return list(dict.fromkeys(names))


def jacobian(outputs, knowns):
    """Columns of d outputs / d knowns; `outputs` takes a function from name to the change of that variable."""
    columns = []
    for known in knowns:
        columns.append(np.imag(outputs(lambda name: 1j * STEP if name == known else 0.0)) / STEP)
    return np.array(columns).T


def found_jacobian(instance, unknowns, knowns):
    unknowns = [instance.reference[name] for name in unknowns]
    columns = [
        instance.fmu.getDirectionalDerivative(unknowns, [instance.reference[known]], [1.0]) for known in knowns
    ]
    forward = np.array(columns).T
    if instance.is_fmi2:
        return forward  # FMI 2.0 has no adjoint derivatives
    references = [instance.reference[known] for known in knowns]
    rows = []
    for row in range(len(unknowns)):
        seed = [float(row == other) for other in range(len(unknowns))]
        # FMPy takes the number of unknowns for the number of results if it is not told
        rows.append(instance.fmu.getAdjointDerivative(unknowns, references, seed, nSensitivity=len(knowns)))
    assert (np.array(rows) == forward).all()
    return forward


def assert_equal(found, expected):
    # each entry against the largest of its kind (row and column have units)
    scale = np.abs(expected) + 1e-3 * np.abs(expected).max(axis=1, keepdims=True) * (expected != 0)
    assert (np.abs(found - expected) <= 1e-12 * scale).all(), np.abs(found - expected) / (scale + (scale == 0))


@both_versions
@pytest.mark.parametrize("case", CASES)
def test_element(slave, case):
    file = {key: value for key, value in LAPS[case].items() if key != "bodies"}
    n = len(file["joint"]["cubic"])
    instance = slave(file, "element")
    motion = per_side(n, "y", "theta") + per_side(n, "v", "omega")
    knowns = motion + parameter_names(file)
    unknowns = [f"{side}.{name}" for side in ("a", "b", "joint") for name in ("F", "M")[:n]]
    unknowns += ["energy.stored", "power.dissipated"]
    instance.initialise()
    for values in points(n):

        def outputs(change):
            joint = Joint(with_joint_parameters(file, lambda name, value: value + change(name)))
            state = values + np.array([change(name) for name in motion])
            r, v = state[:n] - state[n : 2 * n], state[2 * n : 3 * n] - state[3 * n :]
            load = joint.load_on_b(r, v)
            return np.concatenate([-load, load, load, [joint.energy(r), joint.power(r, v)]])

        instance.set(dict(zip(motion, values)))
        assert_equal(found_jacobian(instance, unknowns, knowns), jacobian(outputs, knowns))


@pytest.mark.parametrize("case", CASES)
def test_lap(slave, case):
    file = LAPS[case]
    n = len(file["joint"]["cubic"])
    states = per_side(n, "y", "theta") + per_side(n, "v", "omega")
    knowns = states + per_side(n, "F", "M") + parameter_names(file)
    unknowns = ["joint.F", "joint.M"][:n] + ["energy.stored", "power.dissipated"]
    for values in points(n):

        def outputs(change):
            lap = Lap(with_joint_parameters(file, lambda name, value: value + change(name)))
            state = values + np.array([change(name) for name in states])
            return np.concatenate([lap.load_on_b(state), [lap.energy(state), lap.power(state)]])

        expected = jacobian(outputs, knowns)
        instance = slave(file, "lap")
        instance.enter_initialization()
        instance.set(dict(zip(states, values)))
        assert_equal(found_jacobian(instance, unknowns, knowns), expected)
        instance.fmu.exitInitializationMode()
        assert_equal(found_jacobian(instance, unknowns, knowns), expected)


@pytest.mark.parametrize("interface", ["element", "lap"])
def test_the_capability_is_declared(export, interface):
    with zipfile.ZipFile(export(LAPS["linear-2"], interface)) as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    (declared,) = root.findall("CoSimulation")
    assert declared.get("providesDirectionalDerivatives") == "true"
    assert declared.get("providesAdjointDerivatives") == "true"
