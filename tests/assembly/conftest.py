"""Assemblies as FMUs, extracted and instantiated."""

import fmpy
import pytest
from instances import Model, Slave


def opener(run, tmp_path, fmi, kind):
    opened = []

    def open_one(path, *options):
        number = len(opened)
        fmu = tmp_path / f"{path.stem}-{kind.__name__}-{number}.fmu"
        run("export", path, "-o", fmu, "--fmi", fmi, *options)
        folder = tmp_path / f"fmu {kind.__name__} {number}"
        fmpy.extract(str(fmu), str(folder))
        opened.append(kind(folder))
        return opened[-1]

    yield open_one
    for instance in opened:
        instance.fmu.freeInstance()


@pytest.fixture
def slave(run, tmp_path, fmi):
    """Exports an assembly file and instantiates its FMU for Co-Simulation."""
    yield from opener(run, tmp_path, fmi, Slave)


@pytest.fixture
def model(run, tmp_path, fmi):
    """Exports an assembly file and instantiates its FMU for Model Exchange."""
    yield from opener(run, tmp_path, fmi, Model)
