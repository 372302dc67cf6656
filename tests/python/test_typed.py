"""The module's types are those that it states."""

import inspect
import pathlib
import re
import subprocess
import sys

import pytest

import bolted_joint


EXAMPLES = """
import numpy as np
import bolted_joint
from bolted_joint import Functions, Identification, Joint, Response, Study

def first(study: Study, found: Identification, assembly: Study, maybe: Joint | None) -> None:
    study["assembly"]["frf"] = Functions(np.ones(5), np.ones((5, 1, 1)), ["11:+Y"], ["11:+Y"], averages=np.float64(2))
    found.plot(most=3).savefig("found.png")
    found.joint.plot(to_hz=100.0)
    print(found.joint.dynamic_stiffness(10.0), found.measured().select("11:+Y"), bolted_joint.check(found).usable)
    bolted_joint.check(bolted_joint.export(found.joint, "joint.fmu")).sound
    assembly["joints"][0]["file"] = found.joint
    tip = bolted_joint.respond(assembly)["tip"]
    print(tip.max(), bolted_joint.respond(study, maybe), bolted_joint.respond(study, noise="frf"))
    with_report: Functions = bolted_joint.respond(study, found.joint, report="x.svg", deviations=True)
    print(with_report["11:+Y", "11:+Y"], (study | {"name": "other"}), study.copy().folder)
    print(bolted_joint.respond(study, plan=True, add=2, wanted="k_x").additions)
    print(bolted_joint.compare(found, "x.json").values)
"""


def test_a_strict_checker_finds_nothing_in_what_users_write(tmp_path):
    pytest.importorskip("mypy")
    script = tmp_path / "script.py"
    script.write_text(EXAMPLES, encoding="utf-8")
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", script],
        capture_output=True,
        text=True,
        check=False,
    )
    assert checked.returncode == 0, checked.stdout


WRONG = """
import bolted_joint

bolted_joint.export("x.joint.json", "x.fmu", fmi=1)
bolted_joint.convert("x.joint.json", "adams", "x.txt")
"""


def test_a_strict_checker_finds_words_that_there_are_not(tmp_path):
    pytest.importorskip("mypy")
    script = tmp_path / "script.py"
    script.write_text(WRONG, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", script]
    checked = subprocess.run(command, capture_output=True, text=True, check=False)
    assert checked.returncode == 1
    assert [line.split(":")[1] for line in checked.stdout.splitlines() if ": error:" in line] == ["4", "5"]


def test_public_words_name_no_private_module():
    for name in bolted_joint.__all__:
        public = getattr(bolted_joint, name)
        for inner in (public, *(vars(public).values() if isinstance(public, type) else ())):
            assert "bolted_joint._" not in (getattr(inner, "__doc__", None) or ""), (name, inner)


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


def public_functions():
    """All functions and methods that users may call, with their names."""
    for name in bolted_joint.__all__:
        value = getattr(bolted_joint, name)
        if inspect.isfunction(value):
            yield name, value
        elif inspect.isclass(value):
            for method, function in vars(value).items():
                if not method.startswith("_") and inspect.isfunction(function):
                    yield f"{name}.{method}", function


@pytest.mark.parametrize(("name", "function"), public_functions(), ids=lambda own: own if isinstance(own, str) else "")
def test_documentation_names_every_parameter_and_no_other(name, function):
    parameters = [own for own in inspect.signature(function).parameters if own not in ("self", "cls")]
    section = re.search(r"Parameters\n-+\n(.*?)(?:\n\n[A-Z]\w+\n-+|\Z)", inspect.getdoc(function), re.DOTALL)
    lines = section[1].splitlines() if section else []
    named = [re.match(r"(\*{0,2}\w[\w, ]*?) :", line) for line in lines if not line.startswith(" ")]
    documented = [one.strip("* ") for found in named if found for one in found[1].split(",")]
    assert documented == parameters
