"""Coverage of the joints of two torques when everything is a little wrong at once: `python tests/systematic/several.py [DRAWS]`.

A and B are measured once, and their mistakes are the same at both torques, as are the places of the sensors; gains, delay and
accelerometer are each assembly's own.
"""

import dataclasses
import os
import pathlib
import sys
import tempfile
import time

import numpy as np
import pytest
import rig
from mistakes import drawn
from test_several import SEPARATE, assemblies, errors_of_torques, identify

ROOT = pathlib.Path(__file__).resolve().parents[2]
FACTORS = [1, 0.6]


def at_two_torques(draw):
    """Mistakes in the assemblies of both torques."""
    first, other = drawn(np.random.default_rng(500 + draw)), drawn(np.random.default_rng(9000 + draw))
    own = {name: {**getattr(first, name), "C": getattr(other, name)["C"]} for name in ("gain", "delay", "accelerometer")}
    channel = {**first.channel, **{place: gain for place, gain in other.channel.items() if place[0] == "C"}}
    return [first, dataclasses.replace(first, **own, channel=channel)]


def main(draws):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    rows, refused = [], 0
    for draw in range(draws):
        with pytest.MonkeyPatch.context() as monkeypatch, tempfile.TemporaryDirectory() as folder:
            sets = assemblies(monkeypatch, at_two_torques(draw), FACTORS, draw)
            begun = time.perf_counter()
            whole, _ = identify(
                program, pathlib.Path(folder), sets, torques=[25, 10], edits=SEPARATE, options=["--no-rivals"]
            )
            seconds = time.perf_counter() - begun
        if not whole["usable"]:
            refused += 1
            print(draw, f"{seconds:.1f} s refused", flush=True)
            continue
        rows.append(errors_of_torques(whole, FACTORS[::-1]).ravel())
        print(draw, f"{seconds:.1f} s", rows[-1].round(2), flush=True)
    z = np.array(rows)
    print(f"{draws} draws, {refused} refused: {' '.join(rig.NAMES)} at 10 and at 25 N·m")
    print(f"coverage {np.mean(abs(z) < 1.96, 0).round(2)}  r.m.s. {np.sqrt(np.mean(z**2, 0)).round(2)}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if sys.argv[1:] else 24)
