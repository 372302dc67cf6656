"""`show`, `compare`, `convert`, FMUs of assemblies, and functions of which some pairs were not measured."""

import json
import pathlib
import pickle

import numpy as np
import pytest

import bolted_joint

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def test_show_tells_what_the_command_line_tells(run, demo):
    look = bolted_joint.show(demo / "assembly.uff", page=True)
    told = json.loads(run("show", demo / "assembly.uff", "--json").stdout)[0]
    assert look.kind == told["kind"] and look.facts == told["facts"] and look.details == told["details"]
    assert "<svg" in look.page_html and "11:+Y" in repr(look)
    functions = bolted_joint.read(demo / "assembly.uff")
    of_arrays = bolted_joint.show(functions)
    assert of_arrays.facts["responses"] == look.facts["responses"]
    joint = bolted_joint.show(bolted_joint.Joint.read(demo / "m10x16.joint.json"))
    assert joint.file == "given.joint.json" and "<table>" in joint._repr_html_()
    with pytest.raises(bolted_joint.BoltedJointError, match="expected measured functions"):
        bolted_joint.show(demo)


def test_compare_gives_differences_in_deviations(demo):
    joint = bolted_joint.Joint.read(demo / "m10x16.joint.json")
    softer = bolted_joint.Joint(json.loads(json.dumps(joint.data)))
    softer.data["joint"]["stiffness"][0][0] *= 0.99
    found = bolted_joint.compare(joint, softer, page=True)
    place = found.rows.index("k_yy")
    sigma = joint.stiffness_deviation[0, 0]
    # d/√(σ² + σ²)
    assert found.deviations[place, 0] == pytest.approx(-0.01 * joint.stiffness[0, 0] / (np.sqrt(2) * sigma), rel=1e-9)
    assert found.values[place].tolist() == [joint.stiffness[0, 0], softer.stiffness[0, 0]]
    assert found.together[0]["unknowns"] == 6 and found.together[0]["probability"] < 1e-6
    assert "<svg" in found.page_html and "k_yy" in found._repr_html_()
    with pytest.raises(bolted_joint.BoltedJointError, match="found 1, expected at least two"):
        bolted_joint.compare(joint)


def test_pages_that_nobody_asked_for_say_how_to_ask(short, demo):
    joint = demo / "m10x16.joint.json"
    found = bolted_joint.identify(short)
    for what, page, said in [
        (found, "report_html", "identify and merge make it with report=True"),
        (bolted_joint.predict(EXAMPLES / "predict-four-bolts/study.toml"), "report_html", "predict and merge make it with report=True"),
        (bolted_joint.show(joint), "page_html", "show makes it with page=True"),
        (bolted_joint.compare(joint, joint), "page_html", "compare makes it with page=True"),
    ]:
        with pytest.raises(bolted_joint.BoltedJointError, match=f"^{page}: found none.*{said}$"):
            getattr(what, page)
    assert "<svg" in bolted_joint.identify(short, report=True).report_html
    # results go to other processes without a page
    assert pickle.loads(pickle.dumps(found)).usable == found.usable


def test_convert_writes_what_the_command_line_writes(run, demo, tmp_path):
    joint = demo / "m10x16.joint.json"
    run("convert", joint, "--to", "nastran", "-o", tmp_path / "a.bdf", "--nodes", "7,9")
    path = bolted_joint.convert(bolted_joint.Joint.read(joint), "nastran", tmp_path / "b.bdf", nodes=(7, 9))

    def cards(text):
        return [line for line in text.splitlines() if not line.startswith("$")]

    assert cards(path.read_text()) == cards((tmp_path / "a.bdf").read_text()) != []
    run("convert", joint, "--to", "nastran", "-o", tmp_path / "mm.bdf", "--units", "mm")
    path = bolted_joint.convert(joint, "nastran", tmp_path / "mm_too.bdf", units="mm")
    assert cards(path.read_text()) == cards((tmp_path / "mm.bdf").read_text()) != cards((tmp_path / "a.bdf").read_text())
    with pytest.raises(bolted_joint.BoltedJointError, match="units"):
        bolted_joint.convert(joint, "matlab", tmp_path / "m10.m", units="mm")
    with pytest.raises(bolted_joint.BoltedJointError, match="'gmsh'"):
        bolted_joint.convert(joint, "gmsh", tmp_path / "c")


def test_an_assembly_may_be_a_study(run, tmp_path):
    study = bolted_joint.Study.read(EXAMPLES / "two-beams/beams.toml")
    look = bolted_joint.show(study)
    assert look.kind == bolted_joint.show(EXAMPLES / "two-beams/beams.toml").kind == "assembly of structures and joints"
    assert bolted_joint.check(study).sound
    run("convert", EXAMPLES / "two-beams/beams.toml", "--to", "modelica", "-o", tmp_path / "beams.mo")
    expected = (tmp_path / "beams.mo").read_text()
    assert bolted_joint.convert(study, "modelica", tmp_path / "beams.mo").read_text() == expected
    with pytest.raises(bolted_joint.BoltedJointError, match="modelica: an assembly is converted for Modelica alone"):
        bolted_joint.convert(study, "nastran", tmp_path / "beams.bdf")


def test_an_assembly_becomes_an_fmu(demo, tmp_path):
    beam = {"length": 0.3, "width": 0.025, "height": 0.006, "youngs_modulus": 70e9, "density": 2700,
            "boundary": "free-free", "damping_ratio": 0.002}
    ends = {"1:+Y": 0.0, "1:+RZ": 0.0, "12:+Y": 0.3}
    assembly = bolted_joint.Study({
        "name": "two beams",
        "structures": {"a": {"beam": beam, "points": ends, "modes": 6}, "b": {"beam": beam, "points": ends, "modes": 6}},
        "joints": [{
            "file": bolted_joint.Joint.read(demo / "m10x16.joint.json"), "name": "bolt",
            "a": {"structure": "a", "y": "1:+Y", "theta": "1:+RZ"},
            "b": {"structure": "b", "y": "1:+Y", "theta": "1:+RZ"},
        }],
        "inputs": {"push": "b/12:+Y"},
        "outputs": {"tip": "b/12:+Y"},
    })
    fmu = bolted_joint.export(assembly, tmp_path / "assembly.fmu")
    assert bolted_joint.check(fmu).sound
    fmpy = pytest.importorskip("fmpy")
    names = [variable.name for variable in fmpy.read_model_description(str(fmu.path)).modelVariables]
    assert "push.F" in names and "tip.y" in names
    with pytest.raises(bolted_joint.BoltedJointError, match="it is for a joint file"):
        bolted_joint.export(assembly, tmp_path / "x.fmu", interface="lap")


@pytest.mark.filterwarnings("ignore:not identified")
def test_functions_with_pairs_that_were_not_measured_go_into_a_study(demo, tmp_path):
    functions = bolted_joint.read(demo / "assembly.uff").select(to_hz=150)
    values = functions.values.copy()
    values[:, 1, 0] = np.nan
    values[:, 2, 1] = np.nan
    part = bolted_joint.Functions(functions.frequency_hz, values, functions.responses, functions.references)
    study = bolted_joint.Study.read(demo / "study.toml")
    study["joint"]["rivals"] = False
    study["frequency"]["to"] = 150
    study["assembly"]["frf"] = part
    of_arrays = bolted_joint.identify(study)
    told = {(own["response"], own["reference"]) for own in of_arrays.joint.data["residual"]["functions"]}
    names = functions.responses
    assert len(told) == 7 and (names[1], names[0]) not in told and (names[2], names[1]) not in told
    # a universal file that another program wrote, with the same functions
    pyuff = pytest.importorskip("pyuff")
    sets = [one for one in pyuff.UFF(str(demo / "assembly.uff")).read_sets() if one["type"] != 58 or
            (f"{one['rsp_node']}:+Y", f"{one['ref_node']}:+Y") in told]
    pyuff.UFF(str(tmp_path / "part.uff")).write_sets(sets)
    study["assembly"]["frf"] = tmp_path / "part.uff"
    of_file = bolted_joint.identify(study)
    np.testing.assert_allclose(of_arrays.joint.stiffness, of_file.joint.stiffness, rtol=1e-6)
    # a table tells every number to the bit
    part.save(tmp_path / "part.csv")
    read = bolted_joint.read(tmp_path / "part.csv")
    assert read.select(names, names).values[:, part.measured].tobytes() == values[:, part.measured].tobytes()
    assert len(part) == 7
