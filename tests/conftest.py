"""The program under test, and FMUs exported by it."""

import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]


def pytest_configure(config):
    config.addinivalue_line("markers", "long: takes long, so it begins first")


def pytest_collection_modifyitems(items):
    """Tests run side by side: at the end none shall be left that takes long."""
    items.sort(key=lambda item: item.get_closest_marker("long") is None)


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
    """Exports a joint (as a dict) for a version of FMI and returns the path of the FMU."""

    def export(file, interface, *options, fmi="3", name="test"):
        folder = tmp_path_factory.mktemp("fmu")
        source = folder / f"{name}.joint.json"
        source.write_text(json.dumps(file), encoding="utf-8")
        fmu = folder / f"{name}.fmu"
        version = [] if "--fmi" in options else ["--fmi", fmi]
        run("export", source, "-o", fmu, "--as", interface, *version, *options)
        return fmu

    return export


@pytest.fixture
def fmi():
    """Version of FMI; tests marked with `both_versions` run for 2 and 3."""
    return "3"
