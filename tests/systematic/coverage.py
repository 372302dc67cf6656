"""Coverage of intervals over draws of all mistakes at once: `python tests/systematic/coverage.py [DRAWS] [computed]`."""

import os
import pathlib
import sys
import tempfile

import numpy as np
import rig
from conftest import identified
from mistakes import drawn

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(draws, computed_b):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    rows, refused = {"careful": [], "none": []}, 0
    for draw in range(draws):
        mistakes = drawn(np.random.default_rng(100 + draw))
        if computed_b:
            normal = np.random.default_rng(1000 + draw).standard_normal
            mistakes.young, mistakes.density = 0.01 * normal(), 0.005 * normal()
            mistakes.frequency.pop("B")
            mistakes.joint_sensor.pop("B")
        for name, budget in (("careful", None), ("none", '"none"')):
            with tempfile.TemporaryDirectory() as folder:
                found = identified(program, pathlib.Path(folder), mistakes, draw, 0.01, budget, computed_b=computed_b)
            if found.whole["usable"]:
                rows[name].append(found.z)
            if name == "careful":
                refused += not found.whole["usable"]
                print(draw, found.z.round(2), "" if found.whole["usable"] else "refused", flush=True)
    print(f"{draws} draws, {refused} refused: {' '.join(rig.NAMES)}")
    for name, z in rows.items():
        z = np.array(z)
        print(f"{name:8} coverage {np.mean(abs(z) < 1.96, 0).round(2)}  r.m.s. {np.sqrt(np.mean(z**2, 0)).round(2)}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 60, "computed" in sys.argv)
