"""A master for stiff loops: structures and joints of an SSP, coupled implicitly over each communication step.

Explicit masters read the joint's load and hold it over the step. Between flexible structures that is stable only for
steps of 1e-8 s. Here the load of a step is the one that the joint gives for the motion to which that load leads:

    f = F((d0 + d1)/2, (d1 - d0)/H)      force = "mean"
    f = F(d1, v1)                        force = "end"

with the motion d0 of the joint's points at the beginning of the step, and d1, v1 at its end under the held load f.
Newton's method solves for f. Its Jacobian has two parts: the joints' partial derivatives, from the FMUs' directional
derivatives, and what a load does to the motion at the end, from trial steps that are taken back. Where a full Newton step
does not bring the residual down, a half of it is tried, a quarter, and so on.

With the mean, the work of f on the joint's points is f (d1 - d0): what the springs take up and the dampers turn into heat.
So the energy of structures and joint does not grow at any step, if the joint is passive and linear. The end force is not
that harmless: see docs/wiring.md.

    bolted-joint export ../two-beams/beams.toml -o beams.ssp
    python stiff_master.py beams.ssp --stop 0.02 --step 1e-4 --load push.F=20 -o motion.csv

Needs fmpy. FMUs of FMI 2.0 and 3.0.
"""

import argparse
import csv
import shutil
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.ssp.ssd import read_ssd, read_ssv

# The rate that goes with each motion.
RATES = {"y": "v", "theta": "omega", "x": "vx", "z": "vz", "rx": "wx", "ry": "wy", "rz": "wz"}
TOLERANCE = 1e-10
ITERATIONS, HALVINGS = 30, 20


class NotConverged(Exception):
    """Newton's method found no load for a step."""


class Fmu:
    """One component, of either version of FMI, by the names of its variables."""

    def __init__(self, name, file):
        self.description = description = read_model_description(str(file))
        self.folder = extract(str(file))
        self.reference = {own.name: own.valueReference for own in description.modelVariables}
        self.is_3 = description.fmiVersion.startswith("3")
        kind = FMU3Slave if self.is_3 else FMU2Slave
        self.fmu = kind(
            guid=description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate()
        if not self.is_3:
            self.fmu.setupExperiment(startTime=0.0)

    def initialise(self):
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, names, values):
        call = self.fmu.setFloat64 if self.is_3 else self.fmu.setReal
        call([self.reference[name] for name in names], [float(value) for value in values])

    def get(self, names):
        call = self.fmu.getFloat64 if self.is_3 else self.fmu.getReal
        return np.array(call([self.reference[name] for name in names]))

    def derivatives(self, unknowns, knowns):
        """Partial derivatives: a row for each unknown, a column for each known."""
        rows = [self.reference[name] for name in unknowns]
        columns = [
            self.fmu.getDirectionalDerivative(rows, [self.reference[name]], [1.0]) for name in knowns
        ]
        return np.array(columns).T

    def step(self, time, size):
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def saved(self):
        return self.fmu.getFMUState()

    def take_back(self, state):
        self.fmu.setFMUState(state)

    def forget(self, state):
        self.fmu.freeFMUState(state)

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def answers_at_once(self, outputs):
        """Whether one of these outputs follows an input without a step: so do those of a joint, and none of a structure."""
        inputs = {own.name for own in self.description.modelVariables if own.causality == "input"}
        asked = [own for own in self.description.outputs if own.variable.name in outputs]
        return any(own.dependencies is None or inputs & {on.name for on in own.dependencies} for own in asked)


class System:
    """The FMUs of an SSP and their wiring."""

    def __init__(self, ssp, parameters=None):
        described = read_ssd(str(ssp))
        self.fmus = {}
        with TemporaryDirectory() as folder:
            with zipfile.ZipFile(ssp) as archive:
                archive.extractall(folder)
            for component in described.system.elements:
                self.fmus[component.name] = Fmu(component.name, Path(folder, component.source))
        if parameters is not None:
            self.start_with(read_ssv(str(ssp), f"resources/{parameters}.ssv"))
        for fmu in self.fmus.values():
            fmu.initialise()
        wired = {name: set() for name in self.fmus}
        for wire in described.system.connections:
            if wire.startElement is not None:
                wired[wire.startElement].add(wire.startConnector)
        joints = {name for name, fmu in self.fmus.items() if fmu.answers_at_once(wired[name])}
        self.joints = [self.fmus[name] for name in joints]
        self.structures = [fmu for name, fmu in self.fmus.items() if name not in joints]
        # motions: structure, its output, joint, its input; loads: joint, its output, structure, its input
        self.motions, self.loads, self.inputs, self.outputs = [], [], {}, {}
        for wire in described.system.connections:
            start, end = (wire.startElement, wire.startConnector), (wire.endElement, wire.endConnector)
            if start[0] is None:
                self.inputs[start[1]] = end
            elif end[0] is None:
                self.outputs[end[1]] = start
            elif end[0] in joints:
                self.motions.append((start, end))
            else:
                self.loads.append((start, end))
        displacements = [(start, end) for start, end in self.motions if end[1].split(".")[1] in RATES]
        rates = dict((end, start) for start, end in self.motions)
        self.displacements = displacements
        self.rates = []
        for _, (joint, name) in displacements:
            side, motion = name.split(".")
            own = next(rate for rate in (f"{side}.{RATES[motion]}", f"{side}.v{motion}") if (joint, rate) in rates)
            self.rates.append((rates[joint, own], (joint, own)))

    def start_with(self, values):
        for own in values.parameters:
            component, variable = own.name.split(".", 1)
            self.fmus[component].set([variable], [own.value])

    def motion(self, wires):
        """What the structures give to these wires."""
        return np.array([self.fmus[start[0]].get([start[1]])[0] for start, _ in wires])

    def load(self, displacement, rate):
        """What the joints give for a motion."""
        for wires, values in [(self.displacements, displacement), (self.rates, rate)]:
            for (_, (joint, name)), value in zip(wires, values):
                self.fmus[joint].set([name], [value])
        return np.array([self.fmus[start[0]].get([start[1]])[0] for start, _ in self.loads])

    def slopes(self):
        """Partial derivatives of the joints' loads by displacements and by rates, for the motion that they have seen last."""
        parts = []
        for wires in (self.displacements, self.rates):
            slope = np.zeros((len(self.loads), len(wires)))
            for name, fmu in self.fmus.items():
                rows = [place for place, (start, _) in enumerate(self.loads) if start[0] == name]
                columns = [place for place, (_, end) in enumerate(wires) if end[0] == name]
                if rows and columns:
                    slope[np.ix_(rows, columns)] = fmu.derivatives(
                        [self.loads[place][0][1] for place in rows], [wires[place][1][1] for place in columns]
                    )
            parts.append(slope)
        return parts

    def try_step(self, states, time, size, loads):
        """Steps the structures from their saved states under these loads; displacements and rates at the end."""
        for fmu, state in zip(self.structures, states):
            fmu.take_back(state)
        for (_, (structure, name)), value in zip(self.loads, loads):
            self.fmus[structure].set([name], [value])
        for fmu in self.structures:
            fmu.step(time, size)
        return self.motion(self.displacements), self.motion(self.rates)

    def receptance(self, states, time, size):
        """Change of displacements and rates at the end of a step by each load: two matrices."""
        count = len(self.loads)
        still = self.try_step(states, time, size, np.zeros(count))
        moved = [self.try_step(states, time, size, row) for row in np.eye(count)]
        return [np.array([own[part] - still[part] for own in moved]).T for part in (0, 1)]

    def close(self):
        for fmu in self.fmus.values():
            fmu.close()


class Master:
    """Newton's method on the loads of the joints, step by step."""

    def __init__(self, system, step_s, force="mean"):
        if force not in ("mean", "end"):
            raise ValueError(f"force: found {force!r}, expected 'mean' or 'end'")
        self.system, self.step_s, self.force = system, step_s, force
        self.time = 0.0
        self.loads = np.zeros(len(system.loads))
        self.by_load = None
        self.iterations = []

    def residual(self, states, before, loads):
        """Loads less what the joints give for the motion to which these loads lead; that motion at the end of the step."""
        displacement, rate = self.system.try_step(states, self.time, self.step_s, loads)
        if self.force == "mean":
            seen = 0.5 * (before + displacement), (displacement - before) / self.step_s
        else:
            seen = displacement, rate
        return loads - self.system.load(*seen), displacement, rate

    def jacobian(self):
        """Partial derivatives of the residual by the loads."""
        by_displacement, by_rate = self.system.slopes()
        displacement, rate = self.by_load
        if self.force == "mean":
            seen = 0.5 * displacement, displacement / self.step_s
        else:
            seen = displacement, rate
        return np.eye(len(self.loads)) - by_displacement @ seen[0] - by_rate @ seen[1]

    def step(self, inputs):
        """One communication step; `inputs` are the loads from outside (by name), functions of time."""
        system, middle = self.system, self.time + 0.5 * self.step_s
        for name, load in inputs.items():
            component, variable = system.inputs[name]
            system.fmus[component].set([variable], [load(middle)])
        before = system.motion(system.displacements)
        states = [fmu.saved() for fmu in system.structures]
        try:
            if self.by_load is None:
                # of linear structures it is the same in every step
                self.by_load = system.receptance(states, self.time, self.step_s)
            displacement, rate = self.newton(states, before)
        finally:
            for fmu, state in zip(system.structures, states):
                fmu.forget(state)
        # the joints remember what they have seen when their step begins: where the motion has come to
        system.load(displacement, rate)
        for fmu in system.joints:
            fmu.step(self.time, self.step_s)
        self.time += self.step_s

    def newton(self, states, before):
        residual, *motion = self.residual(states, before, self.loads)
        for iteration in range(ITERATIONS):
            if np.abs(residual).max(initial=0.0) <= TOLERANCE * max(np.abs(self.loads).max(initial=0.0), 1e-6):
                self.iterations.append(iteration)
                return motion
            change = np.linalg.solve(self.jacobian(), residual)
            for halving in range(HALVINGS):
                loads = self.loads - change * 0.5**halving
                trial, *motion = self.residual(states, before, loads)
                if np.abs(trial).max() < np.abs(residual).max():
                    break
            else:
                break
            self.loads, residual = loads, trial
        raise NotConverged(
            f"at {self.time:g} s: the loads of the joints are off by {np.abs(residual).max():g} N or N.m after "
            f"{iteration + 1} iterations; take a shorter step than {self.step_s:g} s"
        )


def simulate(ssp, stop_s, step_s, loads=None, force="mean", parameters=None):
    """Runs an SSP that `bolted-joint export` wrote; `loads` are functions of time by the names of the system's inputs.

    Returns an array with `time` and the system's outputs, and the number of Newton's iterations in each step.
    """
    system = System(ssp, parameters)
    try:
        unknown = set(loads or {}) - set(system.inputs)
        if unknown:
            raise ValueError(f"loads: found {', '.join(sorted(unknown))}, expected some of {', '.join(system.inputs)}")
        master = Master(system, step_s, force)
        wires = [(start, None) for start in system.outputs.values()]
        rows = [(0.0, *system.motion(wires))]
        for _ in range(round(stop_s / step_s)):
            master.step(loads or {})
            rows.append((master.time, *system.motion(wires)))
    finally:
        system.close()
    return np.array(rows, dtype=[("time", float), *((name, float) for name in system.outputs)]), master.iterations


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("ssp", type=Path)
    arguments.add_argument("--stop", type=float, required=True, metavar="SECONDS")
    arguments.add_argument("--step", type=float, required=True, metavar="SECONDS")
    arguments.add_argument("--load", action="append", default=[], metavar="NAME=VALUE", help="a held load, N or N.m")
    arguments.add_argument("--force", choices=["mean", "end"], default="mean")
    arguments.add_argument("--parameters", metavar="SET", help="a parameter set of the SSP, such as draw-1")
    arguments.add_argument("-o", "--output", type=Path, required=True, help="CSV file")
    given = arguments.parse_args()
    held = dict(own.split("=") for own in given.load)
    loads = {name: (lambda time, value=float(value): value) for name, value in held.items()}
    motion, iterations = simulate(given.ssp, given.stop, given.step, loads, given.force, given.parameters)
    with open(given.output, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(motion.dtype.names)
        writer.writerows(motion)
    print(f"{len(iterations)} steps of {given.step:g} s, {sum(iterations)} iterations, {max(iterations)} at most")


if __name__ == "__main__":
    main()
