"""What tools insist on beyond the schemas: names, dates, steps, magnitudes, and derivatives where nothing changes."""

import copy
import json
import math
import re
import zipfile
from ctypes import POINTER, c_double
from decimal import Decimal

import fmpy
import numpy as np
import pytest
from instances import both_versions
from joints import LAPS, LOOSENING_1, joint

ABOUT = {"author": "A. Author, Example Ltd.", "version": "1.2", "license": "CC-BY-4.0", "copyright": "© 2026 <Example>"}
PLAIN = joint(["y"], [[5e7]], [[300.0]], [0.0])


def described(fmu):
    return fmpy.read_model_description(str(fmu))


def named(file, name):
    return copy.deepcopy(file) | {"name": name}


@both_versions
@pytest.mark.parametrize(
    "name, options, identifier",
    [
        ("M10x16 A2-70, dry", [], "M10x16_A2_70_dry_element"),
        ("8.8", [], "joint_8_8_element"),
        ("anything", ["--model-identifier", "Bolt_7"], "Bolt_7"),
    ],
)
def test_the_library_is_named_after_the_joint(export, tmp_path, fmi, name, options, identifier):
    fmu = export(named(PLAIN, name), "element", *options, fmi=fmi)
    description = described(fmu)
    assert description.coSimulation.modelIdentifier == description.modelExchange.modelIdentifier == identifier
    with zipfile.ZipFile(fmu) as archive:
        libraries = [own for own in archive.namelist() if own.startswith("binaries/")]
    assert libraries and all(re.fullmatch(rf"binaries/[^/]+/{identifier}\.(so|dll|dylib)", own) for own in libraries)
    # and it is found under that name
    result = fmpy.simulate_fmu(str(fmu), stop_time=1e-3, output_interval=1e-4, start_values={"a.y": 1e-5}, output=["b.F"])
    assert result["b.F"][-1] == pytest.approx(5e7 * 1e-5)


def test_a_name_that_no_library_can_have_is_refused(run, tmp_path):
    path = tmp_path / "j.joint.json"
    path.write_text(json.dumps(PLAIN))
    for name in ("7bolts", "a b", "größe", ""):
        done = run("export", path, "-o", tmp_path / "j.fmu", "--model-identifier", name, expect=1)
        assert "expected letters, digits and underscores" in done.stderr
    assert not (tmp_path / "j.fmu").exists()


@both_versions
def test_two_joints_in_one_process_have_two_libraries(export, fmi):
    one, other = (export(named(PLAIN, name), "element", fmi=fmi) for name in ("one", "two"))
    assert described(one).coSimulation.modelIdentifier != described(other).coSimulation.modelIdentifier


@both_versions
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_author_and_licence_are_those_of_the_joint_file(export, run, fmi, interface):
    fmu = export(LAPS["linear-1"] | {"about": ABOUT}, interface, fmi=fmi)
    found = described(fmu)
    for key, text in ABOUT.items():
        assert getattr(found, key) == text, key
    run("check", fmu)
    plain = described(export(LAPS["linear-1"], interface, fmi=fmi))
    assert plain.author is None and plain.license is None


def test_an_author_of_two_lines_is_refused(run, tmp_path):
    path = tmp_path / "j.joint.json"
    path.write_text(json.dumps(PLAIN | {"about": {"author": "one\ntwo"}}))
    done = run("export", path, "-o", tmp_path / "j.fmu", expect=1)
    assert "about.author: found \"one\\ntwo\", expected one line of text" in done.stderr
    path.write_text(json.dumps(PLAIN | {"about": {"writer": "one"}}))
    done = run("export", path, "-o", tmp_path / "j.fmu", expect=1)
    assert "writer" in done.stderr


@both_versions
@pytest.mark.parametrize("case", [*LAPS, "identified"])
def test_the_suggested_step_divides_the_stop_time_in_decimal(export, fmi, case):
    if case == "identified":
        validity = {"frequency_hz": [5.0, 515.4]}
        fmus = [export(PLAIN | {"validity": validity}, "element", fmi=fmi)]
    else:
        fmus = [export(LAPS[case], "lap", fmi=fmi)]
    for fmu in fmus:
        with zipfile.ZipFile(fmu) as archive:
            text = archive.read("modelDescription.xml").decode()
        (found,) = re.findall(r"<DefaultExperiment [^>]*>", text)
        step, stop = (Decimal(re.search(rf'{key}="([^"]+)"', found)[1]) for key in ("stepSize", "stopTime"))
        assert stop % step == 0 and stop / step >= 10, found


@pytest.mark.parametrize("interface", ["element", "lap"])
def test_no_variable_is_called_time_in_fmi_2(export, interface):
    fmu = export(LAPS["hardening-2"], interface, fmi="2")
    names = {own.name for own in described(fmu).modelVariables}
    assert "time" not in names and "a.y" in names
    causalities = {own.causality for own in described(fmu).modelVariables}
    assert "independent" not in causalities
    # a tool that has a time of its own still gets it in FMI 3.0
    three = described(export(LAPS["hardening-2"], interface, fmi="3"))
    assert [own.name for own in three.modelVariables if own.causality == "independent"] == ["time"]


@both_versions
def test_energy_by_the_preload_does_not_change_before_the_start(slave, model, fmi):
    start = LOOSENING_1["joint"]["over_preload"]["nominal"]
    for open_one in (slave, model):
        instance = open_one(LOOSENING_1, "lap")
        instance.enter_initialization()
        own = [instance.reference["energy.preload"]]
        for values in ({"a.y": 1e-4}, {"preload": 0.9 * start}):
            instance.set(values)
            assert instance.get("energy.preload") == [0.0]
            for by in ("a.y", "preload", "energy.supplied"):
                found = instance.fmu.getDirectionalDerivative(own, [instance.reference[by]], [1.0])
                assert found == [0.0], by
        instance.fmu.exitInitializationMode()
        assert instance.get("energy.preload") == [0.0]


def nominal(variable):
    own = variable.nominal or (variable.declaredType and variable.declaredType.nominal)
    return float(own)


@both_versions
@pytest.mark.parametrize("factor", [1.0, 1e4, 1e-4])
def test_nominal_values_are_those_of_the_joint(export, fmi, factor):
    stiffness, damping = 3.3e6 * factor, 40.0 * factor
    description = described(export(joint(["y"], [[stiffness]], [[damping]], [0.0]), "element", fmi=fmi))
    found = {own.name: nominal(own) for own in description.modelVariables if own.name in
             ("joint.k_yy", "joint.c_yy", "a.F", "energy.stored", "a.y")}
    motion = 1e-4
    for name, size in [
        ("joint.k_yy", stiffness), ("joint.c_yy", damping), ("a.F", stiffness * motion),
        ("energy.stored", 0.5 * stiffness * motion**2), ("a.y", motion),
    ]:
        assert found[name] == pytest.approx(10.0 ** math.floor(math.log10(size) + 1e-12)), name


@both_versions
def test_states_of_a_lap_have_the_nominal_values_that_the_library_tells(model, fmi):
    instance = model(LAPS["hardening-2"], "lap")
    instance.initialise()
    instance.enter_continuous_time()
    states = [own.variable.derivative for own in instance.description.derivatives]
    found = np.empty(len(states))
    instance.fmu.getNominalsOfContinuousStates(found.ctypes.data_as(POINTER(c_double)), len(states))
    assert [nominal(own) for own in states] == list(found)
