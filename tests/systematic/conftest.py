"""Identification of a joint from data of a laboratory that makes mistakes."""

import dataclasses
import json
import subprocess

import numpy as np
import pytest
import rig


@dataclasses.dataclass
class Result:
    """What the program says of a joint."""

    values: np.ndarray
    deviation: np.ndarray
    budget: dict
    whole: dict
    stderr: str

    @property
    def z(self):
        """Error of each unknown in standard deviations."""
        return (self.values - rig.TRUTH) / self.deviation

    @property
    def suspects(self):
        return [suspect["cause"] for suspect in self.budget["suspects"]] if self.budget else []

    def rank(self, cause):
        """Place of a cause in what stands out and then in what a single step says of the others; those that the program calls
        alike, with drops of chi squared within 15 %, share one. 99 if it is in neither."""
        if not self.budget:
            return 99
        for before, group in ((0, self.budget["suspects"]), (len(self.suspects), self.budget["scores"])):
            drops = {one["cause"]: one["chi_squared_drop"] for one in group}
            if cause in drops:
                above = [name for name, drop in drops.items() if drop > 1.15 * drops[cause] and (not before or name not in self.suspects)]
                return 1 + before + len(above)
        return 99


def entries(matrices):
    stiffness, damping = np.array(matrices["stiffness"]), np.array(matrices["damping"])
    return np.array([*stiffness[np.triu_indices(2)], *damping[np.triu_indices(2)]])


@pytest.fixture
def identify(program, tmp_path):
    """Identifies the joint of the rig with these mistakes; options go to `rig.write`."""

    def identify(mistakes, seed=1, noise=0.01, budget=None, **options):
        return identified(program, tmp_path, mistakes, seed, noise, budget, **options)

    return identify


def identified(program, folder, mistakes, seed, noise, budget=None, **options):
    sets = rig.test_data(mistakes, noise, seed)
    study = rig.write(folder, sets, noise, budget=budget, spacing=mistakes.spacing, **options)
    return run(program, study)


def run(program, study):
    """What the program finds in a study."""
    done = subprocess.run(
        [program, "identify", study, "-o", study.parent / "joint.json", "--json"], capture_output=True, text=True, encoding="utf-8"
    )
    assert done.returncode in (0, 3), done.stderr
    whole = json.loads(done.stdout)
    file = whole["joint_file"]
    return Result(
        values=entries(file["joint"]),
        deviation=entries(file["uncertainty"]["standard_deviation"]),
        budget=whole["budget"],
        whole=whole,
        stderr=done.stderr,
    )
