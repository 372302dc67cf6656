"""The curves of benches/friction.rs by tmdsimpy (https://github.com/tmd-lab/tmdsimpy), if it can be imported.

    python3 friction_balance.py '{"mass": …}'

prints seconds and the amplitude of the fundamental at each frequency as JSON: harmonic balance of one mass on a spring beside
Iwan's law, from frequency to frequency, each from the response before, by Newton's method on tmdsimpy's residual and Jacobian.
"""

import json
import sys
import time

import numpy as np
from tmdsimpy.nlforces.vector_iwan4 import VectorIwan4
from tmdsimpy.vibration_system import VibrationSystem


def curve(case, sliders, samples):
    h = np.arange(1, case["highest"] + 1)
    system = VibrationSystem(
        np.array([[case["mass"]]]), np.array([[case["stiffness"]]]), np.array([[case["damping"]]])
    )
    one = np.array([[1.0]])
    slip_force, stuck, exponent, ratio = case["iwan"]
    system.add_nl_force(
        VectorIwan4(one, one, stuck, slip_force, exponent, ratio, Nsliders=sliders)
    )
    force = np.zeros(2 * len(h))
    force[0] = case["force"]
    unknown = np.zeros(len(force) + 1)
    amplitudes = []
    begun = time.perf_counter()
    for omega in np.linspace(*case["omega"], case["points"]):
        unknown[-1] = omega
        for _ in range(60):
            residual, jacobian, _ = system.hbm_res(unknown, force, h, Nt=samples)
            step = np.linalg.solve(jacobian, residual)
            unknown[:-1] -= step
            if np.abs(step).max() < 1e-9 * np.abs(unknown[:-1]).max():
                break
        amplitudes.append(float(np.hypot(unknown[0], unknown[1])))
    return time.perf_counter() - begun, amplitudes


if __name__ == "__main__":
    case = json.loads(sys.argv[1])
    runs = []
    for sliders, samples in case["discretisations"]:
        seconds, amplitudes = curve(case, sliders, samples)
        runs.append(
            {
                "sliders": sliders,
                "samples": samples,
                "seconds": seconds,
                "amplitudes": amplitudes,
            }
        )
    json.dump(runs, sys.stdout)
