"""CalculiX solves two bodies with a converted joint between them; SciPy solves the same equations."""

import re
import shutil
import subprocess

import joints
import numpy as np
import pytest
import scipy.linalg

CCX = shutil.which("ccx")
pytestmark = pytest.mark.skipif(CCX is None, reason="ccx is not installed (Debian: calculix-ccx)")

MASS, INERTIA = [1.3, 0.7], [2e-3, 9e-4]
SUPPORT, TURN_SUPPORT = [4e5, 9e4], [310.0, 120.0]


def solve(folder, include, step):
    """Runs a model of two bodies on springs, nodes 1 and 2 with rotations 3 and 4, and returns what ccx printed."""
    lines = ["*NODE, NSET=ALL"] + [f"{node}, 0., 0., 0." for node in (1, 2, 3, 4)]
    for node, (mass, support) in enumerate(zip(MASS + INERTIA, SUPPORT + TURN_SUPPORT), 1):
        lines += [f"*ELEMENT, TYPE=MASS, ELSET=M{node}", f"{node}, {node}", f"*MASS, ELSET=M{node}", repr(mass)]
        for dof in (1, 2, 3):
            element = 10 * node + dof
            lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=S{element}", f"{element}, {node}"]
            lines += [f"*SPRING, ELSET=S{element}", str(dof), repr(support)]
    # the eigensolver wants more coordinates than modes: masses on springs so stiff that their modes come last
    for node in range(50, 80):
        lines += ["*NODE", f"{node}, 0., 0., 0.", f"*ELEMENT, TYPE=MASS, ELSET=M{node}", f"{node}, {node}"]
        lines += [f"*MASS, ELSET=M{node}", "1."]
        for dof in (1, 2, 3):
            element = 10 * node + dof
            lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=S{element}", f"{element}, {node}"]
            lines += [f"*SPRING, ELSET=S{element}", str(dof), "1.E12"]
    (folder / "model.inp").write_text("\n".join(lines + [f"*INCLUDE, INPUT={include}"] + step) + "\n")
    done = subprocess.run([CCX, "model"], cwd=folder, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "*ERROR" not in done.stdout, done.stdout
    return (folder / "model.dat").read_text()


def equations(file):
    """M, C, K of both bodies: six motions of a, then those of b."""
    k, c = map(joints.of_both, joints.in_six(file))
    of = lambda values, turns: np.repeat([values[0], turns[0], values[1], turns[1]], 3)
    return np.diag(of(MASS, INERTIA)), c, k + np.diag(of(SUPPORT, TURN_SUPPORT))


@pytest.mark.parametrize("file", [joints.diagonal(), joints.planar(), joints.coupled()], ids=["diagonal", "planar", "coupled"])
def test_frequencies_are_those_of_the_equations(convert, tmp_path, file):
    include = convert(file, "calculix", "joint.inp").name
    printed = solve(tmp_path, include, ["*STEP", "*FREQUENCY", "12", "*END STEP"])
    rows = re.findall(r"^\s+\d+((?:\s+[-+.\dE]+){4})$", printed, re.M)
    # mode number, eigenvalue (rad/s)², rad/time, cycles/time
    found = np.array([float(row.split()[2]) for row in rows[:12]])
    mass, _, stiffness = equations(file)
    expected = np.sqrt(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)) / (2 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_a_model_in_millimetres_has_the_same_frequencies(convert, tmp_path, monkeypatch):
    """Masses in t, supports in N/mm and N·mm/rad, inertias in t·mm²: nothing of the solution has a length."""
    file = joints.planar()
    include = convert(file, "calculix", "joint.inp", "--units", "mm").name
    scaled = {"MASS": 1e-3, "INERTIA": 1e3, "SUPPORT": 1e-3, "TURN_SUPPORT": 1e3}
    mass, _, stiffness = equations(file)
    for name, factor in scaled.items():
        monkeypatch.setitem(globals(), name, [factor * value for value in globals()[name]])
    printed = solve(tmp_path, include, ["*STEP", "*FREQUENCY", "12", "*END STEP"])
    rows = re.findall(r"^\s+\d+((?:\s+[-+.\dE]+){4})$", printed, re.M)
    found = np.array([float(row.split()[2]) for row in rows[:12]])
    expected = np.sqrt(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)) / (2 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
