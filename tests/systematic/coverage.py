"""Coverage of intervals over draws of all mistakes at once: `python tests/systematic/coverage.py [DRAWS] [computed | two | alike] [placed]`.

With `computed` B is computed and its material wrong; `two` has two bolts that differ, `alike` two that are the same. With two bolts
`placed` puts all sensors where they are said to be.
"""

import os
import pathlib
import sys
import tempfile

import bolted
import numpy as np
import rig
from conftest import identified
from mistakes import drawn

ROOT = pathlib.Path(__file__).resolve().parents[2]


def of_one_bolt(program, folder, draw, budget, computed_b):
    """Errors of the unknowns in standard deviations; None where the program refuses the joint."""
    mistakes = drawn(np.random.default_rng(100 + draw))
    if computed_b:
        normal = np.random.default_rng(1000 + draw).standard_normal
        mistakes.young, mistakes.density = 0.01 * normal(), 0.005 * normal()
        mistakes.frequency.pop("B")
        mistakes.joint_sensor.pop("B")
    found = identified(program, folder, mistakes, draw, 0.01, budget, computed_b=computed_b)
    return found.z if found.whole["usable"] else None


def main(draws, kind, is_placed):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    rows, refused = {"careful": [], "none": []}, 0
    for draw in range(draws):
        for name, budget in (("careful", None), ("none", '"none"')):
            if kind in ("two", "alike") and budget:
                continue  # no estimate comes near such data
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                if kind in ("two", "alike"):
                    z = bolted.a_little_wrong(program, folder, draw, budget, "different" if kind == "two" else "alike", is_placed)
                else:
                    z = of_one_bolt(program, folder, draw, budget, kind == "computed")
            if z is not None:
                rows[name].append(z)
            if name == "careful":
                refused += z is None
                print(draw, "refused" if z is None else z.round(2), flush=True)
    print(f"{draws} draws, {refused} refused: {' '.join(rig.NAMES)}")
    for name, z in rows.items():
        if not z:
            continue
        z = np.array(z)
        print(f"{name:8} coverage {np.mean(abs(z) < 1.96, 0).round(2)}  r.m.s. {np.sqrt(np.mean(z**2, 0)).round(2)}")


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if not word.isdigit()]
    main(next((int(word) for word in sys.argv[1:] if word.isdigit()), 60), words[0] if words else "", "placed" in words)
