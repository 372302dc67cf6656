"""A layered beam's first mode as a lap FMU, driven at its resonance by FMPy."""

import json
import pathlib

import fmpy
import numpy as np
import pytest

STUDY = pathlib.Path(__file__).resolve().parents[2] / "examples/kavi-layered-beam/study.toml"
STEP_S = 5e-5


@pytest.fixture(scope="module")
def beam(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("layered-beam")
    run("predict", STUDY, "-o", folder / "beam.joint.json")
    run("export", folder / "beam.joint.json", "-o", folder / "beam.fmu", "--as", "lap")
    return folder


def test_a_free_decay_is_that_of_dry_friction(beam):
    joint = json.loads((beam / "beam.joint.json").read_text())
    [[stiffness]], [[damping]] = joint["joint"]["stiffness"], joint["joint"]["damping"]
    [slider] = joint["joint"]["friction"]
    assert slider["law"] == "jenkins" and damping == 0.0
    [mass] = joint["bodies"]["a"]["inertia"]
    # the first mode of a fixed–fixed beam, 0.93 times as stiff as a solid one
    bending, per_length = 0.93 * 196e9 * 0.04125 * 0.006**3 / 12, 7850 * 0.04125 * 0.006
    omega = (4.730040744862704 / 0.370) ** 2 * np.sqrt(bending / per_length)
    # the joint is a little stiffer, for what the heavy mount gives way
    assert np.sqrt(stiffness / mass) == pytest.approx(omega, rel=1e-4)
    # the friction that this stands for: ζ = 0.012 at 0.1 mm, falling as 1/amplitude; ζ = 4 h w/(2π k w²)
    expected = 0.012 * 1e-4 * np.pi * stiffness / 2
    assert slider["slip_force"] == pytest.approx(expected, rel=2e-3)

    result = fmpy.simulate_fmu(
        str(beam / "beam.fmu"),
        start_values={"a.y": 3e-4},
        output=["a.y", "b.y"],
        stop_time=10 * 2 * np.pi / omega,
        output_interval=STEP_S,
    )
    relative, time = result["a.y"] - result["b.y"], result["time"]
    top = np.flatnonzero((relative[1:-1] > relative[:-2]) & (relative[1:-1] >= relative[2:])) + 1
    # the parabola through three points
    below, middle, above = relative[top - 1], relative[top], relative[top + 1]
    bend = below - 2 * middle + above
    peaks = middle - (above - below) ** 2 / (8 * bend)
    times = time[top] + STEP_S * (below - above) / (2 * bend)
    peaks, times = peaks[peaks > 1.2e-4], times[peaks > 1.2e-4]
    assert len(peaks) > 4
    # the amplitude falls in a straight line, by 4 h/k a cycle, but for the share that sticks
    assert -np.diff(peaks) == pytest.approx(4 * expected / stiffness, rel=0.01)
    assert np.diff(times) == pytest.approx(2 * np.pi / omega, rel=2e-3)
