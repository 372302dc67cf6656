"""What FMI tools see before they simulate anything: validity, exported functions, resources, wrong use."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import zipfile

import fmpy
import numpy as np
import pytest
from conftest import ROOT
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from instances import Slave, both_versions
from joints import HARDENING_1, LAPS, LINEAR_1, LINEAR_2, SOFTENING_1, changed


@both_versions
@pytest.mark.parametrize("case", LAPS)
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_the_validator_finds_no_problem(export, case, interface, fmi):
    fmu = export(LAPS[case], interface, fmi=fmi)
    assert validate_fmu(str(fmu)) == []
    description = fmpy.read_model_description(str(fmu), validate=True)
    assert description.fmiVersion == f"{fmi}.0"
    assert description.coSimulation.canGetAndSetFMUstate
    assert description.coSimulation.canSerializeFMUstate
    result = fmpy.simulate_fmu(str(fmu), stop_time=1e-3, output_interval=1e-4)
    assert len(result) == 11


@both_versions
def test_start_values_are_those_of_the_joint_file(export, fmi):
    description = fmpy.read_model_description(str(export(LINEAR_2, "lap", fmi=fmi)))
    start = {v.name: float(v.start) for v in description.modelVariables if v.start is not None}
    assert start["joint.k_yy"] == 5.73e5
    assert start["joint.k_ytheta"] == 5.82e3
    assert start["joint.k_thetatheta"] == 1.29e3
    assert start["joint.c_ytheta"] == -0.83
    assert start["a.m"] == 0.5
    assert start["b.J"] == 1e-4
    assert start["b.k_theta"] == 80.0


@both_versions
def test_units_and_display_units(export, fmi):
    description = fmpy.read_model_description(str(export(LINEAR_2, "lap", fmi=fmi)))
    variables = {v.name: v for v in description.modelVariables}
    displacement = variables["a.y"].declaredType
    assert (displacement.unit, displacement.displayUnit) == ("m", "mm")
    units = {unit.name: unit for unit in description.unitDefinitions}
    newton = units["N"].baseUnit
    assert (newton.kg, newton.m, newton.s) == (1, 1, -2)


def header_functions():
    """Names of all functions that the headers of FMI 2.0 and 3.0, as FMPy ships them, declare."""
    folder = pathlib.Path(fmpy.__file__).parent / "c-code"
    names = set()
    for version, least in ((2, 40), (3, 70)):
        text = (folder / f"fmi{version}Functions.h").read_text()
        found = re.findall(rf"FMI{version}_Export\s+fmi{version}\w+TYPE\s+(fmi{version}\w+)\s*;", text)
        assert len(found) > least, "the header has another form than expected"
        names.update(found)
    return names


@pytest.mark.skipif(shutil.which("nm") is None, reason="nm (binutils) lists the exported functions")
@both_versions
def test_every_function_of_the_headers_is_exported_and_nothing_else(export, tmp_path, fmi):
    fmpy.extract(str(export(LINEAR_1, "lap", fmi=fmi)), str(tmp_path))
    (library,) = (tmp_path / "binaries").glob("*/*")
    listed = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True)
    exported = {line.split()[-1].split("@")[0] for line in listed.stdout.splitlines()}
    assert exported == header_functions()


def test_the_random_calls_reach_every_function_of_the_headers():
    """The harness in crates/fmu has its own table of functions: it must not forget one."""
    folder = ROOT / "crates/fmu/tests/random_calls/calls"
    called = set()
    for file in ("fmi2.rs", "fmi3.rs", "lives.rs", "world.rs"):
        called.update(re.findall(r'"(fmi[23][A-Z]\w+)"', (folder / file).read_text()))
    assert called == header_functions()


def test_same_input_same_bytes_and_no_need_of_anything_beside_the_executable(program, tmp_path):
    alone = tmp_path / "empty folder"
    alone.mkdir()
    executable = shutil.copy(program, alone)
    source = tmp_path / "test.joint.json"
    source.write_text(json.dumps(LINEAR_2))
    environment = {"SOURCE_DATE_EPOCH": "1700000000", "PATH": ""}
    fmus = []
    for name in ("one.fmu", "two.fmu"):
        subprocess.run([executable, "export", source, "-o", tmp_path / name, "--as", "lap"],
                       check=True, capture_output=True, env=environment, cwd=alone)
        fmus.append((tmp_path / name).read_bytes())
    assert fmus[0] == fmus[1]
    assert fmpy.read_model_description(str(tmp_path / "one.fmu")).generationDateAndTime == "2023-11-14T22:13:20Z"
    assert sorted(os.listdir(alone)) == [pathlib.Path(executable).name]


def test_the_archive_holds_what_the_user_may_look_at(export):
    with zipfile.ZipFile(export(LINEAR_2, "lap")) as archive:
        names = archive.namelist()
        assert archive.testzip() is None
        assert json.loads(archive.read("resources/joint.json")) == LINEAR_2
        page = archive.read("documentation/index.html").decode()
    assert "modelDescription.xml" in names
    assert all("\\" not in name and not name.startswith("/") for name in names)
    assert "test joint" in page and "573000" in page.replace(" ", "").replace("\u202f", "").replace("\u2009", "")
    assert "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", page), "the page needs no network"


@both_versions
@pytest.mark.parametrize("folder", ["plain", "with space", "Größe µm – Schraube"])
@pytest.mark.parametrize("ending", ["", os.sep])
def test_resources_are_found_in_any_folder(export, tmp_path, folder, ending, fmi):
    target = tmp_path / folder
    fmpy.extract(str(export(HARDENING_1, "lap", fmi=fmi)), str(target))
    path = target / "resources"
    forms = [str(path)] if fmi == "3" else [path.as_uri(), path.as_uri().replace("file:///", "file:/"), str(path)]
    for form in forms:
        instance = Slave(target, resources=(form + ending).encode())
        instance.initialise()
        assert instance.get("joint.k3_y", "a.m") == [3e12, 2.35]
        instance.fmu.freeInstance()


def refusal(instance, call):
    """The message with which a call is refused."""
    before = len(instance.messages)
    with pytest.raises(FMICallException):
        call()
    messages = [message for _, _, message in instance.messages[before:]]
    assert messages, "a refusal without a message"
    return " ".join(messages)


@both_versions
def test_a_wrong_token_is_refused(export, tmp_path, fmi):
    fmpy.extract(str(export(LINEAR_1, "lap", fmi=fmi)), str(tmp_path))
    text = (tmp_path / "modelDescription.xml").read_text(encoding="utf-8")
    token = fmpy.read_model_description(str(tmp_path)).guid
    (tmp_path / "modelDescription.xml").write_text(text.replace(token, "another"), encoding="utf-8")
    with pytest.raises(Exception):
        Slave(tmp_path)


@both_versions
def test_wrong_use_is_refused_and_changes_nothing(slave):
    instance = slave(LINEAR_1, "lap")
    reference = instance.reference
    fmu = instance.fmu
    assert "DoStep" in refusal(instance, lambda: instance.step(0.0, 1e-3))
    instance.initialise(**{"a.y": 1e-5})
    before = instance.get("a.y", "a.v", "b.y", "b.v")
    for call in (
        lambda: instance.set_by_reference([reference["a.F"]], [float("nan")]),
        lambda: instance.set_by_reference([reference["a.F"]], [float("inf")]),
        lambda: instance.set_by_reference([reference["b.F"], 9999], [1.0, 2.0]),
        lambda: instance.set_by_reference([reference["b.F"], reference["joint.F"]], [1.0, 2.0]),
        lambda: instance.set_by_reference([reference["a.y"]], [1.0]),
        lambda: instance.get_by_reference([9999]),
        lambda: instance.step(0.0, 0.0),
        lambda: instance.step(0.0, -1e-3),
        lambda: instance.step(0.0, float("nan")),
        lambda: instance.step(0.0, float("inf")),
        lambda: instance.step(0.5, 1e-3),
        lambda: fmu.enterInitializationMode(),
    ):
        refusal(instance, call)
        assert instance.get("a.y", "a.v", "b.y", "b.v") == before
        assert instance.get("a.F", "b.F") == [0.0, 0.0]
    instance.step(0.0, 1e-4)
    assert instance.get("a.y") != before[:1]


@both_versions
def test_escape_of_a_softening_joint_is_an_error_not_a_nan(slave):
    instance = slave(SOFTENING_1, "lap")
    instance.initialise(**{"a.v": 20.0, "b.v": -20.0})

    def run():
        for index in range(1000):
            instance.step(index * 1e-5, 1e-5)

    message = refusal(instance, run)
    assert "a.y - b.y" in message and "t = " in message and "softening" in message
    assert np.isfinite(instance.get("a.y", "a.v", "b.y", "b.v", "joint.F", "energy.stored")).all()


@both_versions
def test_a_negative_mass_is_refused_before_any_step(slave):
    instance = slave(LINEAR_1, "lap")
    instance.enter_initialization()
    instance.set({"a.m": -1.0})
    assert "a.m" in refusal(instance, instance.fmu.exitInitializationMode)


@both_versions
def test_reset_restores_the_start_values(slave):
    instance = slave(LINEAR_1, "lap")
    instance.initialise(**{"joint.k_yy": 1e6, "a.y": 1e-4})
    instance.step(0.0, 1e-3)
    instance.fmu.reset()
    instance.initialise()
    assert instance.get("joint.k_yy", "a.y", "b.v") == [4.56e6, 0.0, 0.0]


def test_an_active_joint_is_exported_only_on_request(run, export, tmp_path):
    active = changed(LINEAR_2, damping=[[18.75, 1.20], [1.20, 0.0]])
    source = tmp_path / "active.joint.json"
    source.write_text(json.dumps(active))
    fmu = tmp_path / "active.fmu"
    done = run("export", source, "-o", fmu, expect=1)
    assert "joint.damping" in done.stderr and "-7.6" in done.stderr and "--allow-active" in done.stderr
    assert not fmu.exists()
    run("export", source, "-o", fmu, "--allow-active")
    assert validate_fmu(str(fmu)) == []
