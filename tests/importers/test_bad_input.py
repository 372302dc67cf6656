"""FMU folders that are damaged: one host process meets them all, and must live on in silence."""

import json
import os
import pathlib
import shutil
import subprocess
import sys

import fmpy
import pytest
from joints import HARDENING_2, LINEAR_1

HOST = pathlib.Path(__file__).with_name("host.py")
POSIX = pytest.mark.skipif(os.name != "posix", reason="permissions as POSIX has them")


def truncated(kept):
    def damage(folder, _):
        start = folder / "resources/start.txt"
        content = start.read_bytes()
        start.write_bytes(content[: int(kept * (len(content) - 2))])

    return damage


def filled_with(content):
    return lambda folder, _: (folder / "resources/start.txt").write_bytes(content)


def replaced_by_a_folder(folder, _):
    (folder / "resources/start.txt").unlink()
    (folder / "resources/start.txt").mkdir()


def replaced_by_that_of_another_fmu(folder, other):
    shutil.copy(other / "resources/start.txt", folder / "resources/start.txt")


# What is done to the folder, what the host passes, and what the message must name.
REFUSED = {
    "no resources": (lambda folder, _: shutil.rmtree(folder / "resources"), {}, ["start.txt"]),
    "resource path that does not exist": (None, {"resources": "/nowhere/at all"}, ["/nowhere/at all"]),
    "start file truncated to nothing": (truncated(0.0), {}, ["start.txt, line 1", "export the FMU again"]),
    "start file truncated in its head": (truncated(0.1), {}, ["start.txt, line ", "export the FMU again"]),
    "start file truncated in its middle": (truncated(0.6), {}, ["start.txt, line ", "export the FMU again"]),
    "start file without its end": (truncated(0.99), {}, ["start.txt, line ", "export the FMU again"]),
    "start file of another FMU": (replaced_by_that_of_another_fmu, {}, []),
    "start file that is a program": (filled_with(b"\x7fELF\x02\x01\x01" + bytes(1000)), {}, ["start.txt"]),
    "start file that is no text": (filled_with(b"\xff\xfe\xfd"), {}, ["start.txt"]),
    "start file that is XML": (filled_with(b"<?xml version='1.0'?>\n"), {}, ["start.txt, line 1"]),
    "start file that is a folder": (replaced_by_a_folder, {}, ["start.txt"]),
    "wrong token": (None, {"token": "another"}, ["another"]),
    "start file that may not be read": (
        lambda folder, _: (folder / "resources/start.txt").chmod(0),
        {},
        ["start.txt", "ermission denied"],
    ),
}


def make_read_only(folder, _):
    for path in [folder, *folder.rglob("*")]:
        path.chmod(0o555 if path.is_dir() else 0o444)


ACCEPTED = {
    "as it was exported": (None, {}),
    "in a folder that may not be written to": (make_read_only, {}),
}


@pytest.fixture(scope="module", params=["2", "3"], ids=["fmi2", "fmi3"])
def visited(request, export, tmp_path_factory):
    """What the host found in each folder, by case, and the process that it was."""
    root = tmp_path_factory.mktemp("damaged")
    sound, other = root / "sound", root / "other"
    fmpy.extract(str(export(LINEAR_1, "lap", fmi=request.param)), str(sound))
    fmpy.extract(str(export(HARDENING_2, "lap", fmi=request.param)), str(other))
    tasks = {}
    for case, (damage, task, *_) in (REFUSED | ACCEPTED).items():
        folder = root / case
        shutil.copytree(sound, folder)
        if damage:
            damage(folder, other)
        tasks[case] = {"folder": str(folder)} | task
    before = contents(root / "in a folder that may not be written to")
    result = root / "result.json"
    job = json.dumps({"sound": str(sound), "result": str(result), "tasks": tasks})
    environment = os.environ | {"PYTHONPATH": str(HOST.parents[1] / "fmpy")}
    done = subprocess.run([sys.executable, HOST], input=job, capture_output=True, text=True, env=environment)
    after = contents(root / "in a folder that may not be written to")
    for path in root.rglob("*"):
        path.chmod(0o755)
    assert done.returncode == 0, done.stderr
    return json.loads(result.read_text()), done, before == after


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("case", REFUSED)
def test_instantiation_is_refused_with_a_reason_and_the_host_lives_on(visited, case):
    if case == "start file that may not be read" and os.name != "posix":
        pytest.skip("permissions as POSIX has them")
    found = visited[0][case]
    assert not found["instantiated"]
    errors = [message for status, _, message in found["messages"] if status >= 3]
    categories = {category for status, category, _ in found["messages"] if status >= 3}
    assert len(errors) == 1, found["messages"]
    assert categories == {"logStatusError"}
    assert "Instantiate" in errors[0]
    for text in REFUSED[case][2]:
        assert text in errors[0], errors[0]
    assert found["sound one ran"]


@pytest.mark.parametrize("case", ACCEPTED)
def test_instantiation_succeeds(visited, case):
    assert visited[0][case]["instantiated"], visited[0][case]["messages"]


@POSIX
def test_nothing_was_written_into_the_folder(visited):
    assert visited[2]


def test_the_library_says_nothing_outside_its_log(visited):
    """Neither for the refusals nor for wrong calls; the host itself is silent too."""
    assert (visited[1].stdout, visited[1].stderr) == ("", "")
