"""Places to a millimetre and gains to a per cent, as a careful laboratory knows them: the budget that studies have by default."""

import json
import subprocess

import numpy as np
from chains import definite
from frames import Rig
from test_as_a_whole import LINES, deviations, found, rows
from test_plan import bolt

CAREFUL = (1e-3, 1e-2, 1e-2)
K, C = bolt()
TRUTH = [own for matrix in (K, C) for own in (matrix[0, 0], matrix[2, 2], matrix[3, 3], matrix[5, 5], matrix[0, 4])]


def off(folder, seed, stiffness, damping):
    rng = np.random.default_rng(seed)
    rig = Rig(stiffness, damping, seed=3)
    none = np.zeros(3)
    errors = [rows(rig, side, rng, none, none, CAREFUL) for side in range(2)]
    rig.write(folder, LINES, 0.01, rng, errors, 'model = "bolt"')


def test_a_bolt_is_found_beside_errors_that_are_larger_than_what_it_says(run, tmp_path):
    """Searches for its ten numbers end in minima far above the noise, or with a motion that is as good as rigid."""
    off(tmp_path, 5, K, C)
    told = found(run, tmp_path)
    assert told["reduced_chi_squared"] < 1.03
    assert np.abs(deviations(told, TRUTH)).max() < 4


def test_a_joint_that_is_no_bolt_is_told_as_such(program, tmp_path):
    """Where all numbers explain the functions nothing is written; where the way there is not found, what is written is not usable.
    Which it is goes with the last digits of the functions."""
    off(tmp_path, 0, definite(3, 2e7), definite(4, 300.0))
    joint = tmp_path / "j.joint.json"
    done = subprocess.run([program, "identify", tmp_path / "study.toml", "-o", joint], capture_output=True, text=True, encoding="utf-8")
    assert "the joint is not what its model says" in done.stderr and "budget.joint" in done.stderr
    assert done.returncode == (3 if joint.exists() else 1), done.stderr
    assert not joint.exists() or json.loads(joint.read_text())["status"]["usable"] is False
