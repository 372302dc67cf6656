"""How far a response is known, from how far the joint is known: an ensemble of FMUs on a Dask cluster.

Each draw of the joint, from the covariance in its file, becomes an FMU of two bodies, which FMPy runs. Draws are numbered
and each has random numbers of its own: the same on one machine and on a hundred.

    python ensemble.py m10x16.joint.json --draws 40

Needs bolted-joint, fmpy and dask[distributed].
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

import bolted_joint

SEED = 1
FORCE_N, PULSE_S, STOP_S, STEP_S = 10.0, 5e-4, 5e-3, 1e-5


def response(joint, number):
    """Relative motion over time, m, of draw `number` of the joint under a pulse of force."""
    from fmpy import simulate_fmu

    drawn = joint.draw(np.random.default_rng([SEED, number]))
    drawn.data["name"] = f"{joint.name}, draw {number}"
    pulse = np.array(
        [(0.0, FORCE_N), (PULSE_S, FORCE_N), (PULSE_S, 0.0), (STOP_S, 0.0)], dtype=[("time", float), ("b.F", float)]
    )
    with tempfile.TemporaryDirectory() as folder:
        fmu = bolted_joint.export(drawn, Path(folder, "drawn.fmu"), interface="lap")
        result = simulate_fmu(
            str(fmu.path), stop_time=STOP_S, output_interval=STEP_S, input=pulse, output=["a.y", "b.y"]
        )
    return result["b.y"] - result["a.y"]


def ensemble(client, joint, draws):
    """Relative motion over time of so many draws, in their order: array of shape (draws, times)."""
    return np.array(client.gather(client.map(response, [joint] * draws, range(draws))))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("joint", help="joint file with bodies")
    arguments.add_argument("--draws", type=int, default=40)
    arguments.add_argument("--scheduler", help="address of a Dask scheduler [default: two workers here]")
    given = arguments.parse_args()

    from dask.distributed import Client

    with Client(given.scheduler) if given.scheduler else Client(n_workers=2, threads_per_worker=1) as client:
        motions = ensemble(client, bolted_joint.Joint.read(given.joint), given.draws)
    peaks = np.abs(motions).max(axis=1)
    low, middle, high = np.percentile(peaks, [2.5, 50.0, 97.5])
    print(f"peak of the relative motion over {given.draws} draws: {middle:.4g} m, 95 % within {low:.4g} to {high:.4g} m")


if __name__ == "__main__":
    main()
