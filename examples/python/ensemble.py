"""How far the response of an assembly is known, from how far its joints are: an ensemble of FMUs on a Dask cluster.

Each draw of the joints, from the covariances in their files, becomes an FMU of the whole assembly, which FMPy runs
under the loads of the assembly file. Draws are numbered and each has random numbers of its own: the same on one machine
and on a hundred.

    bolted-joint demo -o demo
    python ensemble.py ../two-beams/beams.toml --joint lap=demo/m10x16.joint.json --draws 40 -o tip.csv

`--joint` gives a joint of the assembly another file: that of the two beams says nothing of how far it is known. Workers
on other machines need the assembly's files at the same paths. Needs bolted-joint, fmpy and dask[distributed].
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

import bolted_joint

SEED = 1
PERCENTILES = (2.5, 50.0, 97.5)
#: Communication steps of the FMU in a step of the assembly file's response, over which loads are held.
SUBSTEPS = 10


def assembly_with(path, files):
    """An assembly file as a dictionary with its joints in it, some of them from other files than the assembly's."""
    assembly = bolted_joint.Study.read(path)
    if assembly.get("response", {}).get("kind") != "history":
        raise SystemExit(f"{path}: found no motion over time, expected a table [response] with kind = \"history\"")
    names = [joint.get("name", f"joint{number}") for number, joint in enumerate(assembly["joints"], 1)]
    for name in files.keys() - set(names):
        raise SystemExit(f"--joint: found no joint {name}, expected one of {', '.join(names)}")
    for name, joint in zip(names, assembly["joints"]):
        joint["file"] = bolted_joint.Joint.read(files.get(name, assembly.folder / joint["file"]))
    if all(joint["file"].covariance is None for joint in assembly["joints"]):
        raise SystemExit(f"{path}: found no joint with a covariance, expected one to draw from; see --joint")
    return assembly


def drawn(assembly, number):
    """Draw `number` of an assembly: its joints drawn, those of which nothing is known but their values as they are."""
    rng = np.random.default_rng([SEED, number])
    joints = [
        {**joint, "file": joint["file"] if joint["file"].covariance is None else joint["file"].draw(rng)}
        for joint in assembly["joints"]
    ]
    return bolted_joint.Study({**assembly, "joints": joints}, assembly.folder)


def loads(assembly, inputs):
    """The loads of the assembly file's response over time, as FMPy takes them."""
    response = assembly["response"]
    time = np.arange(0.0, response["duration"] + 0.5 * response["step"], response["step"] / SUBSTEPS)
    signals = np.zeros(len(time), dtype=[("time", float), *((variable, float) for variable in inputs)])
    signals["time"] = time
    for variable in inputs:
        load = response["loads"].get(variable.partition(".")[0], {"amplitude": 0.0})
        shape = np.sin(2.0 * np.pi * load["frequency"] * time) if "frequency" in load else 1.0
        signals[variable] = load["amplitude"] * shape * (time <= load.get("until", np.inf))
    return signals


def response(assembly, number):
    """Motion of the assembly's first output over time, of draw `number`: array of shape (2, times)."""
    from fmpy import read_model_description, simulate_fmu

    output = next(iter(assembly["outputs"]))
    with tempfile.TemporaryDirectory() as folder:
        fmu = bolted_joint.export(drawn(assembly, number), Path(folder, "drawn.fmu"))
        variables = read_model_description(str(fmu.path)).modelVariables
        names = [own.name for own in variables if own.causality == "input"]
        inputs = [name for name in names if name.partition(".")[0] in assembly["inputs"]]
        motion = next(own.name for own in variables if own.name.startswith(f"{output}."))
        result = simulate_fmu(
            str(fmu.path),
            stop_time=assembly["response"]["duration"],
            output_interval=assembly["response"]["step"] / SUBSTEPS,
            input=loads(assembly, inputs),
            output=[motion],
        )
    return np.array([result["time"], result[motion]])[:, ::SUBSTEPS]


def ensemble(client, assembly, draws):
    """Times, and the motion over time of so many draws in their order: array of shape (draws, times)."""
    found = np.array(client.gather(client.map(response, [assembly] * draws, range(draws))))
    return found[0, 0], found[:, 1]


def percentiles(motions):
    """Percentiles of the motion at each time: array of shape (percentiles, times)."""
    return np.percentile(motions, PERCENTILES, axis=0)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("assembly", help="assembly file with a response of kind history")
    arguments.add_argument("--joint", action="append", default=[], metavar="NAME=FILE", help="another file of a joint")
    arguments.add_argument("--draws", type=int, default=40)
    arguments.add_argument("-o", "--output", help="table to write: percentiles of the motion over time (CSV)")
    arguments.add_argument("--scheduler", help="address of a Dask scheduler [default: two workers here]")
    given = arguments.parse_args()

    from dask.distributed import Client

    assembly = assembly_with(given.assembly, dict(own.split("=", 1) for own in given.joint))
    with Client(given.scheduler) if given.scheduler else Client(n_workers=2, threads_per_worker=1) as client:
        time, motions = ensemble(client, assembly, given.draws)
    low, middle, high = percentiles(motions)
    if given.output:
        names = ["time [s]", *(f"{percent:g} %" for percent in PERCENTILES)]
        rows = np.column_stack([time, low, middle, high])
        np.savetxt(given.output, rows, delimiter=",", header=",".join(names), comments="", fmt="%.9g")
    widest = np.argmax(high - low)
    print(
        f"{next(iter(assembly['outputs']))} of {given.draws} draws: at most {np.abs(middle).max():.4g} in the middle; "
        f"95 % are within {high[widest] - low[widest]:.2g} of each other, at {time[widest]:.4g} s where that is widest"
    )


if __name__ == "__main__":
    main()
