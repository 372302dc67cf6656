"""The Python module as the wheel has it, and what the command line writes on built-in data."""

import subprocess
import sys

import pytest

bolted_joint = pytest.importorskip("bolted_joint", reason="the wheel is not installed: run ./test")


@pytest.fixture(scope="session")
def demo(tmp_path_factory):
    """What `demo` writes: a study with measured functions, and its joint."""
    folder = tmp_path_factory.mktemp("demo")
    subprocess.run([sys.executable, "-m", "bolted_joint", "demo", "-o", folder], check=True, capture_output=True)
    return folder


@pytest.fixture
def short(demo):
    """The demo's study as a dictionary, with 16 lines."""
    study = bolted_joint.Study.read(demo / "study.toml")
    functions = bolted_joint.read(demo / "assembly.uff")
    lines = slice(None, None, 128)
    study["assembly"]["frf"] = bolted_joint.Functions(
        functions.frequency_hz[lines], functions.values[lines], functions.responses, functions.references
    )
    study["joint"]["rivals"] = False
    return study
