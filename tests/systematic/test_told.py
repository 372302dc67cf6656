"""What is said of studies and measurements that are sound, and of mistakes that are seen before or beside the fit."""

import pathlib
import shutil
import subprocess

import numpy as np
import pytest
import pyuff
import rig
from rig import Mistakes


def run(program, study, *more):
    command = [program, "identify", study.name, "-o", "o.joint.json", *more]
    return subprocess.run(command, cwd=study.parent, capture_output=True, text=True, check=False)


def data(noise=0.01, seed=1, mistakes=None):
    return rig.test_data(mistakes or Mistakes(), noise, seed)


def edit(study, old, new):
    text = study.read_text(encoding="utf-8")
    assert text.count(old) == 1
    study.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.parametrize("budget", ['"none"', None])
def test_a_rotation_by_differences_is_told_without_a_budget_too(program, tmp_path, budget):
    """What is lost is s/3EI whatever the budget says (Taylor; docs/methods.md)."""
    study = rig.write(tmp_path, data(mistakes=Mistakes(spacing=0.015)), 0.01, budget=budget, spacing=0.015)
    told = run(program, study, "--no-rivals").stderr
    assert "the rotation of A is a central difference" in told
    assert "the rotation of B is a central difference" in told
    study = rig.write(tmp_path, data(mistakes=Mistakes(spacing=0.015)), 0.01, budget=budget, spacing=0.015, section=True)
    assert "central difference" not in run(program, study, "--no-rivals").stderr


def test_an_assembly_that_is_a_part_is_refused(program, tmp_path):
    sets = data()
    study = rig.write(tmp_path, sets, 0.01)
    edit(study, 'frf = "C.npz"', 'frf = "B.npz"')
    done = run(program, study)
    assert done.returncode == 1
    assert "found the functions of B at 11:+Y" in done.stderr and "B.npz is a file of B, too" in done.stderr
    study = rig.write(tmp_path, {**sets, "C": sets["B"][:, 2:, 2:]}, 0.01)
    done = run(program, study)
    assert done.returncode == 1
    assert "C.npz: found the functions of B at 11:+Y, line by line" in done.stderr


def test_a_response_has_the_lines_of_what_was_measured(program, tmp_path):
    study = rig.write(tmp_path, data(), 0.01, budget='"none"')
    assert run(program, study, "--no-rivals").returncode == 0

    def respond(*more):
        command = [program, "respond", study.name, "--joint", "o.joint.json", "-o", "r.csv", *more]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)

    done = respond()
    assert done.returncode == 0, done.stderr
    lines = (tmp_path / "r.csv").read_text(encoding="utf-8").splitlines()
    numbers = [line.split(",")[0] for line in lines if line[0].isdigit()]
    np.testing.assert_allclose(np.array(numbers, float), rig.FREQUENCY)
    study = rig.write(tmp_path, data(), 0.01, computed_b=True)
    edit(study, 'frf = "A.npz"\njoint = { y = "1:+Y", theta = "1:+RZ" }', "ground = true")
    edit(study, 'frf = "C.npz"', 'frf = "later.npz"')
    done = respond()
    assert done.returncode == 1
    assert "[frequency]: found nothing" in done.stderr and "such as from = 10 and to = 500" in done.stderr


EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "tol-m10x16"


def test_a_passive_joint_far_from_what_the_functions_ask_for_is_refused(program, tmp_path):
    """Phases of the assembly that are counted the other way: damping that feeds energy would need another stiffness, 22,000 N·m/rad
    for 1,290. No noise is stated that would say that nothing fits."""
    shutil.copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    sets = [one for one in pyuff.UFF(str(EXAMPLE / "assembly.uff")).read_sets() if one["type"] == 58]
    for one in sets:
        one["data"] = one["data"].conj()
    (tmp_path / "assembly.uff").unlink()
    pyuff.UFF(str(tmp_path / "assembly.uff")).write_sets(sets)
    done = run(program, tmp_path / "study.toml", "--no-rivals")
    assert done.returncode == 3, done.stderr
    assert "the functions ask for a joint that feeds energy: k_thetatheta of the passive one is " in done.stderr, done.stderr
