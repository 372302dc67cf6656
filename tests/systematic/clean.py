"""What the program says of data without mistakes: `python tests/systematic/clean.py [DRAWS]`.

False alarms, and the quantile of the consistency over eight bands that its distribution has to have: 52 to 66 for 100 draws.
"""

import os
import pathlib
import sys
import tempfile

import numpy as np
from conftest import identified
from rig import Mistakes

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(draws):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    consistency, largest, alarms, contradicted, warned = {2: [], 8: []}, [], 0, 0, 0
    for draw in range(draws):
        with tempfile.TemporaryDirectory() as folder:
            found = identified(program, pathlib.Path(folder), Mistakes(), 5000 + draw, 0.01)
        budget = found.budget
        for of in budget["consistency"]:
            consistency[of["bands"]].append(of["q"])
        largest.append(max(one["chi_squared_drop"] for one in budget["scores"]))
        alarms += bool(budget["suspects"])
        contradicted += any(cause["contradicted"] for cause in budget["causes"])
        warned += any("bands of the range do not agree" in line for line in found.stderr.splitlines())
        print(draw, [round(of["q"], 1) for of in budget["consistency"]], round(largest[-1], 1), found.suspects, flush=True)
    for bands, q in consistency.items():
        print(f"Q over {bands} bands: median {np.median(q):.1f}, 95 % quantile {np.quantile(q, 0.95):.1f}")
    print(f"largest score: median {np.median(largest):.1f}, 95 % quantile {np.quantile(largest, 0.95):.1f}")
    print(f"{draws} draws: {alarms} with suspects, {contradicted} contradict a prior, {warned} warn that bands do not agree")


if __name__ == "__main__":
    main(int(sys.argv[1]) if sys.argv[1:] else 100)
