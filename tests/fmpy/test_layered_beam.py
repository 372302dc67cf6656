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


@pytest.mark.parametrize("amplitude_m", [1e-4, 2e-4, 3e-4])
def test_the_resonance_has_the_frequency_and_the_damping_of_the_mode(beam, amplitude_m):
    """c + c2 r² + c4 r⁴ over a cycle of amplitude X takes the energy of c_eq = c + c2 X²/4 + c4 X⁴/8: F = c_eq ω X."""
    joint = json.loads((beam / "beam.joint.json").read_text())
    [[stiffness]], [[damping]] = joint["joint"]["stiffness"], joint["joint"]["damping"]
    [c2], [c4] = (joint["joint"]["higher"][f"damping_{name}"] for name in ("quadratic", "quartic"))
    [mass] = joint["bodies"]["a"]["inertia"]
    # the first mode of a fixed–fixed beam, 0.93 times as stiff as a solid one
    bending, per_length = 0.93 * 196e9 * 0.04125 * 0.006**3 / 12, 7850 * 0.04125 * 0.006
    omega = (4.730040744862704 / 0.370) ** 2 * np.sqrt(bending / per_length)
    # the joint is a little stiffer, for what the heavy mount gives way
    assert np.sqrt(stiffness / mass) == pytest.approx(omega, rel=1e-4)
    equivalent = damping + c2 * amplitude_m**2 / 4 + c4 * amplitude_m**4 / 8
    # the friction that this stands for: ζ = 0.012 at 0.1 mm, falling as 1/amplitude
    friction = 2 * 0.012 * (1e-4 / amplitude_m) * omega * mass
    assert equivalent == pytest.approx(friction, rel=0.26)

    # the amplitude grows with the least of d(c_eq X)/dX on its way: after so long a thousandth is missing
    way = np.linspace(0, amplitude_m, 100)
    slope = damping + 3 / 4 * c2 * way**2 + 5 / 8 * c4 * way**4
    duration_s = 7 * 2 * mass / slope.min()
    time = STEP_S * np.arange(int(duration_s / STEP_S) + 1)
    inputs = np.zeros(len(time), dtype=[("time", float), ("a.F", float)])
    inputs["time"] = time
    # FMPy holds the input of a step: its middle counts
    inputs["a.F"] = equivalent * omega * amplitude_m * np.sin(omega * (time + STEP_S / 2))
    result = fmpy.simulate_fmu(
        str(beam / "beam.fmu"),
        input=inputs,
        output=["a.y", "b.y"],
        stop_time=time[-1],
        output_interval=STEP_S,
    )
    last = result["time"] > time[-1] - 20 * 2 * np.pi / omega
    relative, phase = result["a.y"][last] - result["b.y"][last], omega * result["time"][last]
    waves = np.column_stack([np.sin(phase), np.cos(phase), np.ones(len(phase))])
    (sine, cosine, _), *_ = np.linalg.lstsq(waves, relative, rcond=None)
    assert np.hypot(sine, cosine) == pytest.approx(amplitude_m, rel=0.01)
    # a quarter of a cycle behind the force
    assert abs(sine) < 0.1 * abs(cosine) and cosine < 0
