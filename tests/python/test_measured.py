"""What was measured, beside what the identified joint makes of it: receptances in SI units, whatever the study has."""

import copy
import pathlib

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Functions

ROOT = pathlib.Path(__file__).resolve().parents[2]
MILLIMETRES = {"length": "mm", "force": "N"}

pytestmark = [
    pytest.mark.filterwarnings("ignore:.*no units"),
    pytest.mark.filterwarnings("ignore::bolted_joint.NotUsableWarning"),
]


@pytest.fixture(autouse=True)
def no_window():
    pytest.importorskip("matplotlib").use("Agg")


def with_values(functions, values, **options):
    return Functions(functions.frequency_hz, values, functions.responses, functions.references, **options)


def close(found, expected):
    assert found.quantity == "receptance"
    found = found.select(expected.responses, expected.references)
    np.testing.assert_array_equal(found.frequency_hz, expected.frequency_hz)
    np.testing.assert_allclose(found.values, expected.values, rtol=1e-12)


def test_what_was_identified_stays_what_it_was(short, tmp_path, monkeypatch):
    whole = short["assembly"]["frf"]
    values = 1.0 * whole.values
    given = with_values(whole, values)
    values *= 2.0
    short["assembly"]["frf"] = given
    found = bolted_joint.identify(short)
    short["assembly"]["frf"] = with_values(whole, 3.0 * whole.values)
    short["joint"]["model"] = "diagonal"
    with pytest.warns(UserWarning, match="not identified"):
        other = bolted_joint.identify(short)
    assert other.joint.data["joint"] != found.joint.data["joint"]
    close(found.measured(), whole)
    regenerated = found.regenerated(5)
    # a dictionary whose paths are relative to the current folder
    whole.save(tmp_path / "assembly.csv")
    monkeypatch.chdir(tmp_path)
    tables = {**dict(short), "assembly": {**short["assembly"], "frf": "assembly.csv"}}
    tables["a"] = {**short["a"], "modal": short.folder / short["a"]["modal"]}
    tables["joint"] = {**short["joint"], "model": "full"}
    of_path = bolted_joint.identify(tables)
    monkeypatch.chdir(tmp_path.parent)
    close(of_path.measured(), whole)
    np.testing.assert_allclose(of_path.regenerated(5).values, regenerated.values, rtol=1e-9)
    assert of_path.plot().axes[0].lines


def test_copies_of_a_study_keep_its_folder(short):
    for other in (short.copy(), short | {"name": "other"}, {"name": "other"} | short, bolted_joint.Study(short)):
        assert isinstance(other, bolted_joint.Study) and other.folder == short.folder
    assert (short | {"name": "other"})["name"] == "other" and ({"name": "other"} | short)["name"] == short["name"]
    assert bolted_joint.identify(short.copy()).usable


def test_what_is_changed_in_a_copy_of_a_study_is_not_in_the_study(short):
    short["joint"]["guess"] = bolted_joint.Joint.read(ROOT / "tests/data/joint/m10-aluminium.joint.json")
    short["extra"] = {"list": [{"x": 1}], "pair": (1, {"x": 1}), "array": np.ones(2)}
    whole = short["assembly"]["frf"]
    other = short.copy()
    assert other["assembly"]["frf"] is whole and other["extra"]["pair"] == (1, {"x": 1})
    other["assembly"]["frf"] = "other.uff"
    other["extra"]["list"][0]["x"] = other["extra"]["pair"][1]["x"] = 2
    other["extra"]["array"][:] = 2.0
    other["joint"]["guess"].data["name"] = "other"
    assert short["assembly"]["frf"] is whole and short["joint"]["guess"].name != "other"
    assert short["extra"]["list"] == [{"x": 1}] and short["extra"]["pair"][1] == {"x": 1}
    assert short["extra"]["array"].tolist() == [1.0, 1.0]
    # as Python has it
    shallow, deep = copy.copy(short), copy.deepcopy(short)
    assert shallow["assembly"] is short["assembly"] and deep["assembly"] is not short["assembly"]
    for one in (shallow, deep):
        assert isinstance(one, bolted_joint.Study) and one.folder == short.folder


@pytest.mark.parametrize("kind", ["paths", "functions", "both"])
def test_functions_in_several_files_are_one_measurement(short, tmp_path, kind):
    whole = short["assembly"]["frf"]
    parts = [whole.select(references=[name]) for name in whole.references]
    if kind != "functions":
        for number, part in enumerate(parts):
            part.save(tmp_path / f"{number}.csv")
            parts[number] = tmp_path / f"{number}.csv" if kind == "paths" or number else part
    short["assembly"]["frf"] = parts
    found = bolted_joint.identify(short)
    close(found.measured(), whole)
    labels = [line.get_label() for line in found.plot().axes[0].lines]
    assert "13:+Y/13:+Y measured" in labels and "13:+Y/13:+Y identified" in labels


def test_a_study_in_millimetres_is_measured_in_metres(short, tmp_path):
    whole = short["assembly"]["frf"]
    # receptances of displacements: 1 m/N is 1000 mm/N
    with_values(whole, 1e3 * whole.values).save(tmp_path / "millimetres.csv")
    short["assembly"] |= {"frf": tmp_path / "millimetres.csv", "units": MILLIMETRES}
    of_file = bolted_joint.identify(short)
    close(of_file.measured(), whole)
    # arrays are in SI units
    short["assembly"]["frf"] = with_values(whole, 1e3 * whole.values)
    said = r'study\["assembly"\]\["units"\]: found .*mm.* beside Functions in study\["assembly"\]\["frf"\], .* in SI'
    with pytest.raises(BoltedJointError, match=said):
        bolted_joint.identify(short)
    short["assembly"] |= {"frf": [whole], "units": {"length": "m", "force": "N"}, "quantity": "receptance"}
    of_arrays = bolted_joint.identify(short)
    close(of_arrays.measured(), whole)
    np.testing.assert_allclose(of_arrays.joint.stiffness, of_file.joint.stiffness, rtol=1e-9)
    regenerated = of_file.regenerated()
    lines = np.searchsorted(regenerated.frequency_hz, whole.frequency_hz[whole.frequency_hz <= 512])
    lines = lines[lines < len(regenerated.frequency_hz)]
    ratio = np.abs(regenerated["13:+Y", "13:+Y"][lines]) / np.abs(of_file.measured()["13:+Y", "13:+Y"][: len(lines)])
    assert 0.5 < np.median(ratio) < 2.0


def test_functions_are_regenerated_at_the_lines_of_the_measured_ones(short):
    whole = short["assembly"]["frf"]
    # lines that no step has, of which the study uses some
    some = np.delete(np.arange(len(whole.frequency_hz)), [5, 6, 9])
    uneven = Functions(whole.frequency_hz[some], whole.values[some], whole.responses, whole.references)
    factor = (2j * np.pi * uneven.frequency_hz[:, None, None]) ** 2
    short["assembly"] |= {"frf": with_values(uneven, uneven.values * factor, quantity="accelerance")}
    short["assembly"] |= {"quantity": "accelerance", "averages": 4}
    short["frequency"] = {"from": 20, "to": 400}
    found = bolted_joint.identify(short)
    measured = found.measured()
    regenerated = found.regenerated(at=measured)
    np.testing.assert_array_equal(regenerated.frequency_hz, measured.frequency_hz)
    assert (regenerated.responses, regenerated.references) == (measured.responses, measured.references)
    inside = (measured.frequency_hz >= 20) & (measured.frequency_hz <= 400)
    left = np.abs(measured.values - regenerated.values)[inside]
    assert np.median(left / np.abs(measured.values[inside])) < 0.1
    # what is computed at a line does not depend on the others
    of_steps = found.regenerated(5.0)
    at_steps = found.regenerated(at=of_steps.frequency_hz[3:9].tolist())
    np.testing.assert_allclose(at_steps.values, of_steps.values[3:9], rtol=1e-12)
    for wrong, said in [
        ([3.0], "at: found 1 lines from 3 Hz on, expected two lines or more above 0 Hz"),
        ([0.0, 1.0], "at: found 2 lines from 0 Hz on, expected two"),
        ([3.0, 1.0], "at: found 1 at line 1 after 3, expected frequencies that increase"),
        ("a", "at: found what is no array of numbers"),
    ]:
        with pytest.raises(BoltedJointError, match=said):
            found.regenerated(at=wrong)
    with pytest.raises(BoltedJointError, match=r"at: found it beside step_hz \(2.0\), expected one of them"):
        found.regenerated(2.0, at=measured)


def test_accelerance_is_drawn_as_the_receptance_that_it_is(short):
    whole = short["assembly"]["frf"]
    # A = (iω)² H
    factor = (2j * np.pi * whole.frequency_hz[:, None, None]) ** 2
    accelerance = with_values(whole, whole.values * factor, quantity="accelerance")
    short["assembly"]["frf"] = accelerance
    found = bolted_joint.identify(short)
    close(found.measured(), whole)
    above = found.plot().axes[0]
    assert above.get_ylabel() == "receptance, SI"
    curves = {line.get_label(): line.get_ydata() for line in above.lines}
    np.testing.assert_allclose(curves["13:+Y/13:+Y measured"], np.abs(whole["13:+Y", "13:+Y"]), rtol=1e-12)
    short["assembly"] |= {"quantity": "accelerance"}
    close(bolted_joint.identify(short).measured(), whole)
    # a study and its functions do not contradict each other
    short["assembly"]["frf"] = with_values(whole, accelerance.values)
    with pytest.raises(BoltedJointError, match="found 'accelerance' beside Functions .* is 'receptance'; leave"):
        bolted_joint.identify(short)


def test_each_of_several_assemblies_is_measured_and_regenerated_at_its_torque(short):
    whole, points = short["assembly"]["frf"], short["assembly"]["points"]
    first = bolted_joint.identify(short).joint
    softer = copy.deepcopy(first)
    softer.data["joint"]["stiffness"] = (0.5 * first.stiffness).tolist()
    step_hz = whole.frequency_hz[1] - whole.frequency_hz[0]
    exact = bolted_joint.respond(short, first, step_hz=step_hz, noise="frf")
    other = bolted_joint.respond(short, softer, step_hz=step_hz, noise="frf")
    short["assembly"] = [
        {"frf": exact, "points": points, "torque": 30},
        {"frf": other, "points": points, "torque": 10},
    ]
    short["joint"]["torques"] = "separate"
    found = bolted_joint.identify(short)
    close(found.measured(), exact)
    close(found.measured(1), other)
    for assembly, torque in enumerate((30, 10)):
        alone = copy.deepcopy(short)
        alone["assembly"] = short["assembly"][assembly]
        del alone["joint"]["torques"]
        expected = bolted_joint.respond(alone, found.joint.at_preload(torque), step_hz=5)
        np.testing.assert_array_equal(found.regenerated(5, assembly).values, expected.values)
        at = found.regenerated(assembly=assembly, at=expected.frequency_hz)
        np.testing.assert_array_equal(at.values, expected.values)
    labels = [line.get_label() for line in found.plot(assembly=1).axes[0].lines]
    assert "13:+Y/13:+Y measured, assembly 1" in labels and "13:+Y/13:+Y identified, assembly 1" in labels
    with pytest.raises(BoltedJointError, match="found 2, expected a number from 0 to 1"):
        found.measured(2)


@pytest.mark.filterwarnings("ignore:kN cannot be identified")
def test_of_a_lap_frequencies_are_drawn():
    found = bolted_joint.identify(ROOT / "examples/pirdayr-update/with-a-mass.toml")
    with pytest.raises(BoltedJointError, match='"lap-update" without functions of an assembly'):
        found.measured()
    for options in ({}, {"at": [1, 2]}):
        with pytest.raises(BoltedJointError, match='"lap-update" without functions of an assembly'):
            found.regenerated(**options)
    (axes,) = found.plot().axes
    curves = {line.get_label(): line for line in axes.lines}
    # 639 and 691 rad/s at 2 and 8 N·m, in Table 4
    hertz = curves["mode 1 measured"].get_ydata()
    np.testing.assert_allclose([hertz[0], hertz[-1]], np.array([639, 691]) / (2 * np.pi))
    np.testing.assert_allclose(curves["mode 1 identified"].get_ydata(), hertz, rtol=1e-3)
    assert list(curves["mode 2 measured"].get_xdata()) == [2, 4, 6, 8]


@pytest.mark.filterwarnings("ignore:the residual is")
def test_of_a_backbone_frequencies_and_damping_are_drawn():
    study = {
        "method": "lap-response",
        "name": "flat",
        "model": {"drive": "relative", "response": "relative", "terms": ["k3"], "compare": False},
        "known": {"m": 2.1107},
        "noise": {"frequency": 0.002, "damping": 0.1},
        "backbone": [{"file": ROOT / "tests/data/backbones/brake-reuss-model-flat.csv", "name": "flat"}],
    }
    above, below = bolted_joint.identify(study).plot().axes
    for axes in (above, below):
        assert [line.get_label() for line in axes.lines] == ["flat measured", "flat identified"]
        assert [len(line.get_xdata()) for line in axes.lines] == [23, 23]


@pytest.mark.filterwarnings("ignore:.*impacts")
def test_of_a_joint_in_space_functions_are_regenerated(tmp_path):
    folder = ROOT / "examples/plan-in-space"
    guess = bolted_joint.Joint.read(folder / "guess.joint.json")
    parts = {}
    for side, node, far in [("a", 14, 10), ("b", 20, 23)]:
        elsewhere = [f"{far}:+{axis}" for axis in "XYZ"]
        modes = folder / f"{side}-modes.toml"
        parts[side] = {"modal": modes, "interface": node, "responses": elsewhere, "references": elsewhere}
    frequency = {"from": 60, "to": 1800}
    tables = {"method": "frf-space", "name": "in space", **parts, "joint": {"known": guess}, "frequency": frequency}
    study = bolted_joint.Study(tables)
    functions = bolted_joint.respond(study, step_hz=20)
    study["assembly"] = {"frf": functions}
    study["joint"] = {"model": "full", "length": 0.03}
    study["budget"] = "none"
    found = bolted_joint.identify(study)
    close(found.measured(), functions)
    regenerated = found.regenerated(20)
    for lines in (slice(None), np.r_[0, 2, 5]):
        at = found.regenerated(at=regenerated.frequency_hz[lines])
        np.testing.assert_array_equal(at.values, regenerated.values[lines])
    scale = np.abs(functions.values).max()
    np.testing.assert_allclose(regenerated.values, functions.values, atol=1e-4 * scale)
    assert found.plot().axes[0].lines


@pytest.mark.filterwarnings("ignore:3 response points")
def test_bolts_that_differ_have_a_joint_each():
    beam = {"length": 0.3, "width": 0.025, "height": 0.006, "youngs_modulus": 70e9, "density": 2700,
            "boundary": "fixed-free", "damping_ratio": 0.002}
    joints = {
        name: bolted_joint.Joint({
            "format": "bolted-joint/1",
            "name": name,
            "joint": {"dofs": ["y", "theta"], "stiffness": [[k, 0], [0, 2e-3 * k]], "damping": [[10, 0], [0, 0.1]]},
        })
        for name, k in [("left", 6e5), ("right", 3e5)]
    }
    study = {
        "method": "frf-decoupling",
        "name": "two bolts",
        "budget": "none",
        "a": {"beam": beam, "joint": [{"name": "left", "x": 0.25}, {"name": "right", "x": 0.29}]},
        "b": {
            "beam": beam | {"length": 0.221, "boundary": "free-free"},
            "joint": [{"name": "left", "x": 0.015}, {"name": "right", "x": 0.055}],
            "points": {"11:+Y": 0.12, "12:+Y": 0.16, "13:+Y": 0.221},
        },
        "assembly": {"frf": "not-yet.uff", "points": ["11:+Y", "12:+Y", "13:+Y"]},
        "joint": {"model": "diagonal", "bolts": "different", "rivals": False},
        "frequency": {"from": 5, "to": 800},
    }
    functions = bolted_joint.respond(study, joints, step_hz=4)
    study["assembly"]["frf"] = functions
    study["noise"] = {"relative": 1e-3}
    found = bolted_joint.identify(study)
    assert list(found.joints) == ["left", "right"]
    np.testing.assert_allclose(found.joints["right"].stiffness, joints["right"].stiffness, rtol=1e-3, atol=1.0)
    regenerated = found.regenerated(4)
    np.testing.assert_allclose(regenerated.values, functions.values, atol=1e-4 * np.abs(functions.values).max())
    np.testing.assert_array_equal(found.regenerated(at=functions).values, regenerated.values)
    # in the order of what it is subtracted from, and no more of them
    others = functions.select(functions.responses[::-1], functions.references[:1])
    again = found.regenerated(at=others)
    assert (again.responses, again.references) == (others.responses, others.references)
    np.testing.assert_array_equal(again.values, regenerated.values[:, ::-1, :1])
    assert found.plot().axes[0].lines
