"""The program under test, and FMUs exported by it."""

import json
import os
import pathlib
import subprocess

import fmpy
import pytest
from fmpy.fmi3 import FMU3Slave

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program():
    """Path of the executable; BOLTED_JOINT names another one."""
    path = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    assert path.exists(), f"{path} is missing: run `cargo build --release` or ./test"
    return path


@pytest.fixture(scope="session")
def run(program):
    """Runs the program and returns what it said."""

    def run(*arguments, expect=0, **options):
        done = subprocess.run(
            [program, *map(str, arguments)], capture_output=True, text=True, encoding="utf-8", **options
        )
        assert done.returncode == expect, f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
        return done

    return run


@pytest.fixture(scope="session")
def export(run, tmp_path_factory):
    """Exports a joint (as a dict) and returns the path of the FMU."""

    def export(file, interface, *options):
        folder = tmp_path_factory.mktemp("fmu")
        source = folder / "test.joint.json"
        source.write_text(json.dumps(file), encoding="utf-8")
        fmu = folder / "test.fmu"
        run("export", source, "-o", fmu, "--as", interface, *options)
        return fmu

    return export


class Slave:
    """An FMI 3.0 co-simulation instance with access by variable names."""

    def __init__(self, folder, resources=None):
        """`resources` is passed to the FMU as its resource path, where FMPy would pass its own."""
        self.description = fmpy.read_model_description(str(folder))
        self.reference = {v.name: v.valueReference for v in self.description.modelVariables}
        self.messages = []
        self.fmu = FMU3Slave(
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="test",
        )
        if resources is not None:
            instantiate = self.fmu.fmi3InstantiateCoSimulation
            self.fmu.fmi3InstantiateCoSimulation = lambda name, token, _, *others: instantiate(
                name, token, resources, *others
            )
        self.fmu.instantiate(loggingOn=True, logMessage=self.log)

    def log(self, environment, status, category, message):
        self.messages.append((status, category.decode(), message.decode()))

    def initialise(self, **values):
        self.fmu.enterInitializationMode()
        if values:
            self.set(values)
        self.fmu.exitInitializationMode()

    def set(self, values):
        self.fmu.setFloat64([self.reference[name] for name in values], list(values.values()))

    def get(self, *names):
        return self.fmu.getFloat64([self.reference[name] for name in names])

    def step(self, time, size):
        return self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


@pytest.fixture
def slave(export, tmp_path):
    """Exports a joint and instantiates its FMU."""
    opened = []

    def slave(file, interface, *options):
        folder = tmp_path / f"fmu {len(opened)}"
        fmpy.extract(str(export(file, interface, *options)), str(folder))
        instance = Slave(folder)
        opened.append(instance)
        return instance

    yield slave
    for instance in opened:
        instance.fmu.freeInstance()
