"""The bounds on the communication step that `check` gives, against the coupled simulation itself."""

import json

import fmpy
import numpy as np
import pytest
from conftest import ROOT, Slave
from joints import LINEAR_1, LINEAR_2, TOL_C, TOL_K, body, joint

STEPS = 3000

# Joint, inertias at a and at b (None is fixed): from a bound by the delay of the load to one by the damper.
ELEMENTS = {
    "delay": (joint(["y"], [[1e6]], [[300.0]], [0.0]), [1.0], [2.0]),
    "damper": (joint(["y"], [[1e4]], [[700.0]], [0.0]), [1.4], [None]),
    "cubic at rest": (joint(["y"], [[1e6]], [[300.0]], [-1e9]), [0.5], [0.5]),
    "rotation": (joint(["y", "theta"], TOL_K, TOL_C, [0.0, 0.0]), [0.01215, 9.477e-7], [0.01215, 9.477e-7]),
    "coupled": (joint(["y", "theta"], TOL_K, TOL_C, [0.0, 0.0]), [0.05, 3e-5], [None, 8e-5]),
}
MASTERS = ["held", "late", "semi_implicit"]


def option(name, a, b):
    return [name, ",".join("fixed" if value is None else repr(value) for value in (a, b))]


@pytest.fixture
def bound(run, export):
    """What `check --json` says about the communication step of an FMU."""

    def bound(fmu, *options):
        return json.loads(run("check", fmu, "--json", *options).stdout)["communication_step"]

    return bound


def growth(sizes):
    """Factor by which the motion grows from one step to the next, from the largest in each half of the run."""
    half = len(sizes) // 2
    return np.max(sizes[half:]) / np.max(sizes[:half])


def coupled_element(folder, n, mobility, master, step):
    """Size of the relative motion at each communication point."""
    element = Slave(folder)
    element.initialise()
    displacements = [f"{side}.{name}" for side in "ab" for name in ("y", "theta")[:n]]
    velocities = [f"{side}.{name}" for side in "ab" for name in ("v", "omega")[:n]]
    loads = [f"{side}.{name}" for side in "ab" for name in ("F", "M")[:n]]
    # only what moves is off its rest
    moves = mobility > 0
    x = moves * np.tile([1e-9, 1e-7][:n], 2) * np.repeat([1.0, -0.3], n)
    v = np.zeros(2 * n)
    before, sizes = np.zeros(2 * n), []
    for index in range(STEPS):
        element.set(dict(zip(displacements + velocities, np.concatenate([x, v]))))
        now = np.array(element.get(*loads))
        load = before if master == "late" else now
        before = now
        if master == "semi_implicit":
            v = v + step * mobility * load
            x = x + step * v
        else:
            x, v = x + step * v + 0.5 * step**2 * mobility * load, v + step * mobility * load
        element.step(index * step, step)
        relative = np.concatenate([(x[:n] - x[n:]) / [1e-9, 1e-7][:n], (v[:n] - v[n:]) * step / [1e-9, 1e-7][:n]])
        sizes.append(np.abs(relative).max())
        if sizes[-1] > 1e3:
            break
    element.close()
    return sizes


@pytest.mark.parametrize("master", MASTERS)
@pytest.mark.parametrize("case", ELEMENTS)
def test_an_element_is_stable_up_to_its_bound(export, bound, tmp_path, case, master):
    file, a, b = ELEMENTS[case]
    n = len(a)
    fmu = export(file, "element")
    options = option("--neighbour-mass", a[0], b[0])
    if n == 2:
        options += option("--neighbour-inertia", a[1], b[1])
    limit = bound(fmu, *options)[master]
    fmpy.extract(str(fmu), str(tmp_path))
    mobility = np.array([0.0 if value is None else 1.0 / value for value in a + b])
    assert growth(coupled_element(tmp_path, n, mobility, master, 0.98 * limit)) < 0.9
    sizes = coupled_element(tmp_path, n, mobility, master, 1.02 * limit)
    assert sizes[-1] > 1e3 or growth(sizes) > 1.1


def coupled_lap(folder, stiffness, damping, step):
    """Size of the lap's motion with springs and dampers to ground, their loads held over each step."""
    lap = Slave(folder)
    lap.initialise(**{"a.y": 1e-6, "b.y": -3e-7})
    sizes = []
    for index in range(20 * STEPS):
        y_a, y_b, v_a, v_b = lap.get("a.y", "b.y", "a.v", "b.v")
        lap.set({"a.F": -stiffness[0] * y_a - damping[0] * v_a, "b.F": -stiffness[1] * y_b - damping[1] * v_b})
        lap.step(index * step, step)
        sizes.append(max(abs(y_a), abs(y_b)) / 1e-6)
        if sizes[-1] > 1e3:
            break
    lap.close()
    return sizes


# Supports with more damping, so that growth shows before long.
DAMPED_BODIES = {"a": body([2.35], [10.56e5], [60.0]), "b": body([1.9], [8.82e5], [40.0])}
DAMPED_1 = joint(["y"], [[4.56e6]], [[54.0]], [0.0], DAMPED_BODIES)


@pytest.mark.parametrize("file, stiffness, damping", [
    (DAMPED_1, (1e5, 0.0), (0.0, 0.0)),
    (LINEAR_1, (4e5, 2e5), (30.0, 0.0)),
    (LINEAR_2, (1e5, 0.0), (20.0, 0.0)),
], ids=["spring", "springs and damper", "rotation"])
def test_a_lap_is_stable_up_to_its_bound(export, bound, tmp_path, file, stiffness, damping):
    fmu = export(file, "lap")
    options = option("--neighbour-stiffness", *stiffness) + option("--neighbour-damping", *damping)
    limit = bound(fmu, *options)["held"]
    fmpy.extract(str(fmu), str(tmp_path))
    assert growth(coupled_lap(tmp_path, stiffness, damping, 0.95 * limit)) < 0.9
    sizes = coupled_lap(tmp_path, stiffness, damping, 1.05 * limit)
    assert sizes[-1] > 1e3 or growth(sizes) > 1.1


def test_the_table_of_the_guide_is_what_check_says(export, bound):
    fmu = export(joint(["y", "theta"], TOL_K, TOL_C, [0.0, 0.0]), "element")
    guide = (ROOT / "docs/communication-step.md").read_text(encoding="utf-8")
    rows = guide.partition("| mass, kg | inertia, kg·m² |")[2].partition("\n\n")[0].splitlines()[2:]
    assert len(rows) == 4
    for row in rows:
        mass, inertia, *bounds = [cell.strip() for cell in row.strip("|").split("|")]
        found = bound(fmu, "--neighbour-mass", mass, "--neighbour-inertia", inertia)
        assert [float(value) for value in bounds] == pytest.approx([found[master] for master in MASTERS], rel=5e-4)
