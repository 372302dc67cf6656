"""Arguments that are not what is expected are refused by their names in Python."""

import pathlib
import re

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Functions, Joint
from bolted_joint._words import in_python

ROOT = pathlib.Path(__file__).resolve().parents[2]
M10 = ROOT / "tests/data/joint/m10-aluminium.joint.json"
CSV = ROOT / "tests/data/arrays/table.csv"
ONE = Functions([1.0], [1.0], ["1:+Y"], ["1:+Y"])
PLAN = ROOT / "examples/plan-in-space/study.toml"


def test_what_was_identified_stands_for_its_joint(short, tmp_path):
    found = bolted_joint.identify(short)
    assert bolted_joint.check(bolted_joint.export(found, tmp_path / "x.fmu")).sound
    assert bolted_joint.check(found).sound and bolted_joint.show(found).kind == bolted_joint.show(found.joint).kind
    assert bolted_joint.compare(found, found.joint).names == (found.joint.name,) * 2
    assert bolted_joint.convert(found, "nastran", tmp_path / "x.bdf").exists()
    expected = bolted_joint.respond(short, found.joint, step_hz=50).values
    np.testing.assert_array_equal(bolted_joint.respond(short, found, step_hz=50).values, expected)


WRONG = {
    "export a dictionary": (lambda: bolted_joint.export({}, "x.fmu"), r"joint: .* dict, expected a Joint, .* Study\("),
    "check a dictionary": (lambda: bolted_joint.check({}), "what: .* dict, expected a Joint, an Fmu or a path"),
    "show a number": (lambda: bolted_joint.show(5), "what: .* int, expected a path, a Joint or Functions"),
    "compare a dictionary": (lambda: bolted_joint.compare({}, M10), "joints: .* dict, expected a Joint or its file"),
    "identify a joint": (lambda: bolted_joint.identify(Joint.read(M10)), "study: .* Joint, expected a path, a dict"),
    "a joint's path": (lambda: Joint("x.json"), r"data: found the path 'x.json', .*Joint.read\('x.json'\)"),
    "a joint of a list": (lambda: Joint([]), "data: .* list, expected what a joint file holds"),
    "draws of a joint": (lambda: bolted_joint.Draws.read(M10), "format 'bolted-joint/1', expected a file of draws"),
    "read a number": (lambda: bolted_joint.read(5), "path: .* int, expected a path or a list of paths"),
    "read a list of numbers": (lambda: bolted_joint.read([5]), "path: .* int, expected a path or a list of paths"),
    "a joint of a number": (lambda: Joint.read(5), "path: .* int, expected a path"),
    "a study of a number": (lambda: bolted_joint.Study.read(5), "path: .* int, expected a path"),
    "seed alone": (lambda: bolted_joint.identify({}, seed=3), "seed: found 3 without bootstrap, expected both"),
    "bootstrap below 0": (lambda: bolted_joint.identify({}, bootstrap=-3), "bootstrap: found -3, expected a whole"),
    "bootstrap of one": (lambda: bolted_joint.identify({}, bootstrap=1), "bootstrap: found 1, .* number from 2 on"),
    "an empty study": (lambda: bolted_joint.identify({}), "study: found an empty dictionary, expected the tables"),
    "an empty joint": (lambda: Joint({}), r'data: found a dictionary without data\["joint"\], expected what a joint'),
    "a joint of a format": (lambda: Joint({"format": "x"}), r'data: found a dictionary without data\["joint"\]'),
    "a joint without K": (lambda: Joint({"name": "x", "joint": {"dofs": ["y"]}}), r'data\["joint"\]\["stiffness"\]'),
    "functions of a text": (lambda: Functions([1.0], "abc", ["1:Y"], ["1:Y"]), "values: found what is no array of num"),
    "functions over a text": (lambda: Functions("abc", [1.0], ["1:Y"], ["1:Y"]), "frequency_hz: found what is no arr"),
    "bootstrap with a point": (lambda: bolted_joint.identify({}, bootstrap=3.0), "bootstrap: found 3.0, expected"),
    "draws below 0": (lambda: bolted_joint.draw({}, range(-2, 2), bootstrap=4), "numbers: .* expected a range"),
    "add below 0": (lambda: bolted_joint.respond(PLAN, plan=True, add=-1), "add: found -1, expected a whole number"),
    "step": (lambda: bolted_joint.respond(PLAN, step_hz="x"), "step_hz: found 'x', expected a finite number"),
    "noise": (lambda: bolted_joint.respond(PLAN, noise="frff"), "noise: found 'frff', expected one of frf, response"),
    "fmi": (lambda: bolted_joint.export(M10, "x.fmu", fmi=7), "fmi: found 7, expected one of 2, 3"),
    "interface": (lambda: bolted_joint.export(M10, "x.fmu", interface="a"), "interface: .*one of element, lap"),
    "preload": (lambda: bolted_joint.compare(M10, M10, preload_n_m="x"), "preload_n_m: found 'x', expected a finite"),
    "tool": (lambda: bolted_joint.convert(M10, "adams", "x"), "tool: found 'adams', expected one of nastran, abaqus"),
    "units of a text": (lambda: bolted_joint.read(CSV, units="mm"), "units: found 'mm', expected a dictionary such as"),
    "units of a list": (lambda: bolted_joint.read(CSV, units=["mm", "N"]), "units: found .*, expected a dictionary"),
    "units of a number": (lambda: bolted_joint.read(CSV, units=3), "units: found 3, expected a dictionary"),
    "a unit of a list": (lambda: bolted_joint.read(CSV, units={"length": []}), "units.length: found .*, expected one"),
    "quantity": (lambda: bolted_joint.read(CSV, quantity=5), "quantity: found 5, expected one of receptance, mobility"),
    "an array as a quantity": (lambda: ONE.as_quantity(np.zeros(2)), "quantity: found array.*expected one of recep"),
    "an open file": (lambda: bolted_joint.read(CSV.open()), r"path: found an open file \(.*\.csv\), expected its path"),
    "an open coherence": (lambda: bolted_joint.read(CSV, coherence=CSV.open()), "coherence: found an open file"),
    "from": (lambda: ONE.select(from_hz="a"), "from_hz: found 'a', expected a number, or None for no limit"),
    "to": (lambda: ONE.select(to_hz=np.nan), "to_hz: found nan, expected a number, or None for no limit"),
    "responses": (lambda: ONE.select(3), "responses: found 3, expected a text or a list of texts"),
    "rng of a text": (lambda: Joint.read(M10).draw("a"), "rng: .* str, expected a numpy.random.Generator, .* its seed"),
    "rng below 0": (lambda: Joint.read(M10).draw(-1), "rng: found -1, expected a whole number from 0 on"),
    "a table as a joint": (lambda: Joint.read(CSV), r"table\.csv: found a table .*, expected a joint file"),
    "a study as a joint": (lambda: Joint.read(PLAN), r"study\.toml: found a study of .*, expected a joint"),
    "no file as a joint": (lambda: Joint.read("nowhere.json"), r"nowhere\.json: cannot be read: .* of a joint file"),
    "most": (lambda: ONE.plot(most="a"), "most: found 'a', expected a whole number from 1 on"),
    "frequencies": (lambda: Joint.read(M10).dynamic_stiffness("a"), "frequency_hz: found what is no array of numbers"),
    "from in a plot": (lambda: Joint.read(M10).plot(from_hz="a"), "from_hz: found 'a', expected a finite"),
    "one node": (lambda: bolted_joint.convert(M10, "nastran", "x", nodes=5), "nodes: found 5, expected two numbers"),
    "functions to a number": (lambda: ONE.save(5), "path: found an object of type int, expected a path"),
    "a joint to a number": (lambda: Joint.read(M10).save(5), "path: found an object of type int, expected a path"),
    "tables": (lambda: bolted_joint.Study(5), "tables: found an object of type int, expected a dictionary"),
    "tables of a text": (lambda: bolted_joint.Study("a.toml"), "tables: .* str, .*; Study.read reads"),
    "folder": (lambda: bolted_joint.Study({}, 5), "folder: found an object of type int, expected a path"),
    "text": (lambda: bolted_joint.Study.parse(5), "text: found an object of type int, expected a text"),
    "parts": (lambda: bolted_joint.merge(PLAN, 5), "parts: found 5, expected a list of Draws or their files"),
    "parts of a path": (lambda: bolted_joint.merge(PLAN, "a.json"), "parts: found 'a.json', expected a list of Draws"),
    "nodes": (lambda: bolted_joint.convert(M10, "nastran", "x", nodes=(1, -2)), "nodes: found -2, expected a whole"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named_as_python_has_it(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    call, said = WRONG[name]
    with pytest.raises(BoltedJointError, match=said) as refused:
        call()
    assert "--" not in str(refused.value) and "Usage" not in str(refused.value)


def test_messages_of_the_command_line_name_what_python_has(short, tmp_path):
    unusable, over = Joint.read(M10), ROOT / "tests/data/joint/torques.joint.json"
    unusable.data["status"] = {"usable": False, "reasons": ["it rattles"]}
    part = bolted_joint.draw(short, range(2), bootstrap=6)
    for call, said in [
        (lambda: bolted_joint.respond(short), "^joint: found nothing, expected the joint file"),
        (lambda: bolted_joint.respond(short, M10, step_hz=-1), "^step_hz: found -1, expected a positive distance"),
        (lambda: bolted_joint.draw(short, range(15, 25), bootstrap=20), "^numbers: found 15.* bootstrap states"),
        (lambda: bolted_joint.merge(short, [part]), r"expected all of 0\.\.6; make them with `draw`"),
        (lambda: bolted_joint.export(unusable, tmp_path / "x.fmu"), "or insist with unusable=True"),
        (lambda: bolted_joint.convert(over, "nastran", tmp_path / "x.bdf"), "at one preload: preload_n_m=TORQUE"),
        (lambda: bolted_joint.convert(M10, "nastran", tmp_path / "x.bdf", nodes=(7, 7)), "^nodes: found 7,7"),
        (lambda: bolted_joint.compare(CSV, M10), "expected a joint file .*; `show` takes it"),
    ]:
        with pytest.raises(BoltedJointError, match=said) as refused:
            call()
        assert not re.search("--|bolted-joint ", str(refused.value)), refused.value


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        ("extrapolate: found it; leave --extrapolate out", "extrapolate: found it; leave extrapolate=True out"),
        ("--extrapolate: found it, expected none", "extrapolate: found it, expected none"),
        ("--no-rivals: found it", "rivals=False: found it"),
        ("invalid value 'x' for '--step <HZ>'\n\nUsage: bolted-joint respond", "invalid value 'x' for 'step_hz <HZ>'"),
        ("`identify --report` draws them", "`identify(..., report=True)` draws them"),
        ("`bolted-joint respond --plan` says", "`respond(..., plan=True)` says"),
        ("one preload (`export --preload`)", "one preload (`export(..., preload_n_m=...)`)"),
        ("`bolted-joint identify a b.toml -o NAME.joint.json` takes it", "`identify` takes it"),
        ("`--step` at the command line, such as `--step 1`", "`step_hz`, such as `step_hz=1`"),
        # what Python does not have, and names of files
        ("--neighbour: found", "--neighbour: found"),
        ("a/--joint b.csv: found x--joint", "a/--joint b.csv: found x--joint"),
    ],
)
def test_options_and_commands_become_arguments_and_functions(message, expected):
    assert in_python(message) == expected


def test_a_joint_takes_arrays_as_a_study_does(tmp_path):
    stiffness = np.array([[2e6, 1e3], [1e3, 4e2]])
    joint = Joint({
        "format": "bolted-joint/1",
        "name": "of arrays",
        "joint": {"dofs": np.array(["y", "theta"]), "stiffness": stiffness, "damping": 1e-5 * stiffness},
    })
    joint.save(tmp_path / "x.joint.json")
    np.testing.assert_array_equal(Joint.read(tmp_path / "x.joint.json").stiffness, stiffness)
    assert bolted_joint.check(joint).sound and repr(joint) == "<Joint 'of arrays': y, theta>"
    joint.data["joint"]["stiffness"][0, 0] = np.nan
    with pytest.raises(BoltedJointError, match=r'data\["joint"\]\["stiffness"\]\[0\]\[0\]: found nan'):
        joint.save(tmp_path / "x.joint.json")


def test_no_limit_may_be_said(short):
    whole = short["assembly"]["frf"]
    for part in (whole.select(from_hz=None, to_hz=None), whole.select(from_hz=0, to_hz=np.inf)):
        np.testing.assert_array_equal(part.values, whole.values)
    assert whole.select(to_hz=np.float32(100)).frequency_hz[-1] <= 100


def test_a_whole_number_is_the_seed_of_a_draw(demo):
    joint = Joint.read(demo / "m10x16.joint.json")
    expected = joint.draw(np.random.default_rng(3)).stiffness
    for seed in (3, np.int64(3)):
        np.testing.assert_array_equal(joint.draw(seed).stiffness, expected)
    assert joint.draw(4).stiffness[0, 0] != expected[0, 0]


def test_an_assembly_is_a_number(short):
    found = bolted_joint.identify(short)
    assert found.measured(np.int64(0)).responses == found.measured().responses
    for wrong in ("a", 1, -1, True, None, 0.0):
        with pytest.raises(BoltedJointError, match="assembly: found .*, expected a number from 0 to 0"):
            found.measured(wrong)


def test_a_text_that_is_no_path_is_no_files(demo, tmp_path):
    """Files that are called as words of a study are: a key says what is a path, not the folder."""
    study = bolted_joint.Study.read(demo / "study.toml")
    for word in ("y", "theta", "full", "Y", "frf-decoupling"):
        (tmp_path / word).touch()
    (tmp_path / "assembly.uff").write_bytes((demo / "assembly.uff").read_bytes())
    for name in ("a-modes.toml", "b-modes.toml"):
        if (demo / name).exists():
            (tmp_path / name).write_bytes((demo / name).read_bytes())
    found = bolted_joint.identify(bolted_joint.Study(study, tmp_path), rivals=False)
    expected = bolted_joint.identify(study, rivals=False)
    np.testing.assert_array_equal(found.joint.stiffness, expected.joint.stiffness)


def test_whole_numbers_may_be_those_of_numpy(short):
    of_numpy = bolted_joint.identify(short, bootstrap=np.int64(4), seed=np.uint8(2))
    assert of_numpy.joint.data == bolted_joint.identify(short, bootstrap=4, seed=2).joint.data
