"""MATLAB functions, run by Octave."""

import shutil
import subprocess

import joints
import numpy as np
import pytest

OCTAVE = shutil.which("octave-cli")
pytestmark = pytest.mark.skipif(OCTAVE is None, reason="octave-cli is not installed (Debian: octave)")


def evaluated(path, relative, rate):
    """Loads on b for a course of motions, with the memory handed on."""
    calls = "".join(
        f"[f, m] = {path.stem}({list(r)}', {list(v)}', m); printf('%.17g ', f); printf('\\n');\n"
        for r, v in zip(relative.tolist(), rate.tolist())
    )
    done = subprocess.run(
        [OCTAVE, "--no-init-file", "--eval", f"m = [];\n{calls}"], cwd=path.parent, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return np.array([[float(value) for value in line.split()] for line in done.stdout.splitlines()])


def motions(count):
    random = np.random.default_rng(3)
    return 1e-5 * random.standard_normal((9, count)), 1e-2 * random.standard_normal((9, count))


@pytest.mark.parametrize("file", [joints.planar(), joints.coupled()], ids=["planar", "in space"])
def test_a_linear_joint_gives_its_load(convert, file):
    own = file["joint"]
    relative, rate = motions(len(own["dofs"]))
    found = evaluated(convert(file, "matlab", "linear.m"), relative, rate)
    expected = relative @ np.array(own["stiffness"]) + rate @ np.array(own["damping"])
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-15)


def test_terms_and_sliders_give_their_load(convert):
    k, c, k3, c2, ks, h = 2e6, 30.0, 4e15, 6e9, 1.5e6, 12.0
    slider = {"dof": "y", "law": "jenkins", "stiffness": ks, "slip_force": h}
    file = joints.joint(["y"], [[k]], [[c]], cubic=[k3], higher={"damping_quadratic": [c2]}, friction=[slider])
    relative, rate = motions(1)
    found = evaluated(convert(file, "matlab", "sliding.m"), relative, rate)
    place, expected = 0.0, []
    for r, v in zip(relative[:, 0], rate[:, 0]):
        # sticks while |k (r − s)| ≤ h
        load = np.clip(ks * (r - place), -h, h)
        place = r - load / ks
        expected.append([k * r + c * v + k3 * r**3 + c2 * r**2 * v + load])
    assert max(abs(relative[:, 0])) * ks > 2 * h, "slips"
    np.testing.assert_allclose(found, expected, rtol=1e-12)
