"""A joint in space by pyFBS's virtual point transformation and decoupling, line by line, from the files of a study.

    python3 benches/space/with_pyfbs.py FOLDER

FOLDER has study.toml with sensors and impacts on both sides, and the NPZ files that it names; `tests/space/frames.py` writes
such folders. What is printed: times, and K as the median of the lines. pyFBS 1.0.7, which is imported as `pyfbs`.
"""

import pathlib
import sys
import time
import tomllib

import numpy as np
import pandas as pd
from pyfbs.interface import VPT

folder = pathlib.Path(sys.argv[1])
started = time.perf_counter()
study = tomllib.loads((folder / "study.toml").read_text())
names = ["Position_1", "Position_2", "Position_3", "Direction_1", "Direction_2", "Direction_3"]


def frame(rows, descriptions=None, quantity="Acceleration"):
    table = pd.DataFrame([[*place, *direction] for place, direction in rows], columns=names)
    table["Grouping"], table["Quantity"] = 1, quantity
    table["Description"] = descriptions or "point"
    return table


def receptance(side):
    """The transformations of a substructure, and its virtual point's receptance, lines × 6 × 6."""
    channels = frame([(s["position"], e) for s in side["sensors"] for e in np.eye(3)])
    impacts = frame([(i["position"], i["direction"]) for i in side["impacts"]], quantity="Force")
    at = [((0, 0, 0), (0, 0, 0))] * 6
    motions = frame(at, ["ux", "uy", "uz", "rx", "ry", "rz"])
    loads = frame(at, ["fx", "fy", "fz", "mx", "my", "mz"], "Force")
    point = VPT(channels, impacts, motions, loads)
    data = np.load(folder / side["frf"])
    point.apply_vpt(data["frequency"], np.moveaxis(data["frf"], 2, 0))
    return point, point.frf


def block(a, b):
    return np.block([[a, np.zeros((a.shape[0], b.shape[1]))], [np.zeros((b.shape[0], a.shape[1])), b]])


(a, y_a), (b, y_b) = receptance(study["a"]), receptance(study["b"])
assembly = np.load(folder / study["assembly"]["frf"])
omega = 2 * np.pi * assembly["frequency"]
y_c = block(a.tu, b.tu) @ np.moveaxis(assembly["frf"], 2, 0) @ block(a.tf, b.tf)
transformed = time.perf_counter()

# inverse substructuring: the dynamic stiffness of the assembly less that of its parts is [[D, −D], [−D, D]]
z = np.linalg.inv(y_c)
d = -0.5 * (z[:, :6, 6:] + z[:, 6:, :6])
stiffness = np.median(d.real, axis=0)
damping = np.median(d.imag / omega[:, None, None], axis=0)
done = time.perf_counter()
print(f"read and transformed {transformed - started:.2f} s, decoupled {done - transformed:.2f} s")
np.savez(folder / "with_pyfbs.npz", a=y_a, b=y_b, c=y_c, stiffness=stiffness, damping=damping)
print(np.round(0.5 * (stiffness + stiffness.T), 1))
