"""Exported FMUs, extracted and instantiated."""

import pathlib

import fmpy
import pytest
from instances import Model, Slave  # `Slave` also for tests that import it from here

ROOT = pathlib.Path(__file__).resolve().parents[2]


def opener(export, tmp_path, fmi, kind):
    opened = []

    def open_one(file, interface, *options):
        folder = tmp_path / f"fmu {kind.__name__} {len(opened)}"
        fmpy.extract(str(export(file, interface, *options, fmi=fmi)), str(folder))
        opened.append(kind(folder))
        return opened[-1]

    yield open_one
    for instance in opened:
        instance.fmu.freeInstance()


@pytest.fixture
def slave(export, tmp_path, fmi):
    """Exports a joint and instantiates its FMU for Co-Simulation."""
    yield from opener(export, tmp_path, fmi, Slave)


@pytest.fixture
def model(export, tmp_path, fmi):
    """Exports a joint and instantiates its FMU for Model Exchange."""
    yield from opener(export, tmp_path, fmi, Model)
