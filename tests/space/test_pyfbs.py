"""The same joint by pyFBS: its virtual point transformation and inverse substructuring on the same files."""

import pathlib
import subprocess
import sys

import numpy as np
import pytest
from frames import Rig
from test_identify import EXACT, FREQUENCIES, C, K, apart, identified

pytest.importorskip("pandas", reason="pandas is not installed")
pytest.importorskip("pyfbs.interface", reason="pyFBS is not installed")
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "benches/space/with_pyfbs.py"


def test_its_interface_matrices_have_the_same_joint(run, tmp_path):
    Rig(K, C).write(tmp_path, FREQUENCIES, more=EXACT)
    joint = identified(run, tmp_path)["joint_file"]["joint"]
    subprocess.run([sys.executable, SCRIPT, tmp_path], check=True, capture_output=True)
    theirs = np.load(tmp_path / "with_pyfbs.npz")
    for own, found in ((joint["stiffness"], theirs["stiffness"]), (joint["damping"], theirs["damping"])):
        assert apart(own, 0.5 * (found + found.T)) < 1e-8
