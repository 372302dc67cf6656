"""From profiles, materials and bolts to an FMU that loosens: the example, run by FMPy."""

import json
import pathlib
import shutil

import fmpy
import numpy as np
import pytest

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/predict-four-bolts"
STEP_S = 1e-4


@pytest.fixture(scope="module")
def predicted(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("predict") / "study"
    shutil.copytree(EXAMPLE, folder)
    run("predict", folder / "study.toml", "-o", folder / "four-bolts.joint.json")
    run("export", folder / "four-bolts.joint.json", "-o", folder / "four-bolts.fmu")
    run("check", folder / "four-bolts.fmu")
    return folder


def test_the_force_follows_the_bolts_as_they_loosen(predicted):
    table = json.loads((predicted / "four-bolts.joint.json").read_text())["joint"]["over_preload"]
    stiffness, damping = np.array(table["stiffness"]), np.array(table["damping"])
    torques = np.array(table["preload"])
    # every torque of the table for ten steps, from the highest down, with a motion that does not stop
    order = torques[::-1]
    time = STEP_S * np.arange(10 * len(order) + 1)
    inputs = np.zeros(len(time), dtype=[(name, float) for name in ("time", "preload", "a.y", "a.theta", "a.v", "a.omega")])
    inputs["time"] = time
    inputs["preload"] = np.repeat(order, 10).tolist() + [order[-1]]
    inputs["a.y"], inputs["a.theta"] = 1e-7 * np.sin(900 * time), 2e-6 * np.cos(700 * time)
    inputs["a.v"], inputs["a.omega"] = 0.09e-3 * np.cos(900 * time), -1.4e-3 * np.sin(700 * time)
    result = fmpy.simulate_fmu(
        str(predicted / "four-bolts.fmu"),
        input=inputs,
        output=["b.F", "b.M", "a.F", "preload"],
        stop_time=time[-1],
        output_interval=STEP_S,
    )
    seen = 0
    for row in result[1:]:
        place = int(round(row["time"] / STEP_S))
        # FMPy holds the inputs of a step from its beginning
        held = inputs[place - 1]
        knot = int(np.flatnonzero(torques == held["preload"])[0])
        x, v = np.array([held["a.y"], held["a.theta"]]), np.array([held["a.v"], held["a.omega"]])
        expected = stiffness[knot] @ x + damping[knot] @ v
        scale = np.abs(stiffness[knot]) @ np.abs(x) + np.abs(damping[knot]) @ np.abs(v)
        found = np.array([row["b.F"], row["b.M"]])
        assert (np.abs(found - expected) <= 1e-9 * scale).all(), row["time"]
        assert row["a.F"] == -row["b.F"]
        seen += 1
    assert seen == len(time) - 1
