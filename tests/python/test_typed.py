"""The module's types are those that it states."""

import pathlib
import subprocess
import sys

import pytest

import bolted_joint


def test_a_strict_checker_finds_nothing():
    pytest.importorskip("mypy")
    package = pathlib.Path(bolted_joint.__file__).parent
    assert (package / "py.typed").exists()
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", "-p", "bolted_joint"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert checked.returncode == 0, checked.stdout
