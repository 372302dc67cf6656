"""`respond` takes what the command line takes, and gives its tables as arrays."""

import json
import pathlib

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Joint

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def table(path):
    """Names and numbers of a table that the command line has written."""
    names = path.read_text(encoding="utf-8").splitlines()[0].split(",")
    return names, np.genfromtxt(path, delimiter=",", skip_header=1, encoding="utf-8")


def test_an_assembly_file_answers_as_at_the_command_line(run, tmp_path):
    run("respond", EXAMPLES / "two-beams/beams.toml", "-o", tmp_path / "history.csv")
    names, numbers = table(tmp_path / "history.csv")
    response = bolted_joint.respond(EXAMPLES / "two-beams/beams.toml")
    assert [f"{name} [{unit}]" if unit else name for name, unit in zip(response.columns, response.units)] == names
    np.testing.assert_array_equal(response.values, numbers)
    np.testing.assert_array_equal(response["tip"], numbers[:, names.index("tip [m]")])
    assert len(response) == 501 and response.details["modes"][0]["frequency_hz"] == pytest.approx(12.08, abs=0.01)
    assert "energy stored" in repr(response) and "<td>tip</td><td>m</td>" in response._repr_html_()
    assert list(response) == list(response.keys()) == list(response.columns) and "tip" in response
    assert "tap" not in response and set(dict(response)) == set(response.columns)
    with pytest.raises(BoltedJointError, match="found 'tap', expected one of time, push, tip"):
        response["tap"]


def test_receptances_of_an_assembly_are_complex():
    study = bolted_joint.Study.read(EXAMPLES / "two-beams/beams.toml")
    # the joint itself in place of its file
    study["joints"][0]["file"] = Joint.read(EXAMPLES / "two-beams/lap.joint.json")
    study["response"] = {"kind": "linear", "from": 5, "to": 300, "lines": 10}
    response = bolted_joint.respond(study)
    receptance = response.complex("tip/push receptance")
    np.testing.assert_array_equal(receptance.real, response["tip/push receptance real"])
    np.testing.assert_array_equal(receptance.imag, response["tip/push receptance imaginary"])
    assert np.iscomplexobj(receptance) and response["frequency"].tolist() == pytest.approx(np.linspace(5, 300, 10))


def test_laps_answer_level_by_level(run, tmp_path):
    study = EXAMPLES / "friction/loops.toml"
    run("respond", study, "-o", tmp_path / "loops.csv")
    _, numbers = table(tmp_path / "loops.csv")
    response = bolted_joint.respond(study, report=tmp_path / "loops.svg")
    np.testing.assert_array_equal(response.values, numbers[:, 1:])
    assert "<svg" in (tmp_path / "loops.svg").read_text(encoding="utf-8")
    assert list(dict.fromkeys(response.laps)) == ["Iwan", "Jenkins"]
    part = response.select("Jenkins", 3e-4)
    assert len(part) == 513 and set(part["level"]) == {3e-4} and set(part.laps) == {"Jenkins"}
    # what a cycle turns into heat is the area of its loop
    load, motion = part["load"], part["relative.y"]
    area = np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(motion))
    assert part["heat"][-1] == pytest.approx(abs(area), rel=1e-3)
    with pytest.raises(BoltedJointError, match="lap: found 'LuGre', expected one of Iwan, Jenkins"):
        response.select("LuGre")
    with pytest.raises(BoltedJointError, match=r"level: found 1, expected one of 0\.0001, 0\.0003, 0\.0006"):
        response.select(level=1)


def test_an_assembly_in_space_has_functions_with_deviations(run, tmp_path):
    study = EXAMPLES / "tool-point/study.toml"
    run("respond", study, "--step", "50", "-o", tmp_path / "a.csv", "--deviations", tmp_path / "b.csv")
    _, numbers = table(tmp_path / "a.csv")
    names, deviations = table(tmp_path / "b.csv")
    functions = bolted_joint.respond(study, step_hz=50, deviations=True)
    np.testing.assert_array_equal(functions["31:+Y", "31:+Y"], numbers[:, 3] + 1j * numbers[:, 4])
    assert names[2] == "31:+Y/31:+Y standard deviation of the magnitude"
    np.testing.assert_array_equal(functions.magnitude_deviation[:, 1, 0], deviations[:, 2])
    assert bolted_joint.respond(study, step_hz=50).magnitude_deviation is None


@pytest.mark.filterwarnings("ignore:.*impacts")
def test_a_test_is_planned(run):
    study = EXAMPLES / "plan-in-space/study.toml"
    options = ["--step", "50", "--add", "2", "--for", "k_x,c_rz"]
    told = json.loads(run("respond", study, "--plan", *options, "--json").stdout)
    plan = bolted_joint.respond(study, plan=True, step_hz=50, add=2, wanted=["k_x", "c_rz"])
    assert plan.details == told
    assert plan.unknowns == tuple(one["name"] for one in told["unknowns"]) and set(plan.joints) == {"joint"}
    assert plan.standard_deviations.tolist() == [one["standard_deviation"] for one in told["unknowns"]]
    # at lines 50 Hz apart, one number stays open
    (place,) = np.flatnonzero(~plan.determined)
    assert told["unknowns"][place]["reason"] in (html := plan._repr_html_()) and len(plan.additions) == 2
    assert "41 of 42 numbers will be determined" in html and "add " in html and "<td>k_x</td><td>2e+07</td>" in html


@pytest.mark.filterwarnings("ignore:.*impacts")
def test_one_number_may_be_wanted_by_its_name():
    study = EXAMPLES / "plan-in-space/study.toml"
    plans = [bolted_joint.respond(study, plan=True, step_hz=100, add=1, wanted=own) for own in ("k_x", ["k_x"])]
    assert plans[0].additions == plans[1].additions and len(plans[0].additions) == 1


def test_noise_is_that_of_the_command_line(run, demo, tmp_path):
    joint = demo / "m10x16.joint.json"
    run("respond", demo / "study.toml", "--joint", joint, "--step", "8", "-o", tmp_path / "noise.csv",
        "noise", "response", "--level", "0.02", "--samples", "256", "--seed", "5")
    _, numbers = table(tmp_path / "noise.csv")
    # a joint's file in place of the joint
    options = {"noise": "response", "noise_level": 0.02, "noise_samples": 256, "seed": 5}
    functions = bolted_joint.respond(demo / "study.toml", joint, step_hz=8, **options)
    np.testing.assert_array_equal(functions["11:+Y", "11:+Y"], numbers[:, 1] + 1j * numbers[:, 2])
    with pytest.raises(BoltedJointError, match="joint: found int, expected a Joint, its file, or a dictionary"):
        bolted_joint.respond(demo / "study.toml", 5)
    with pytest.raises(BoltedJointError, match="^joint: found nothing, expected the joint file"):
        bolted_joint.respond(demo / "study.toml")


def test_responses_are_drawn():
    pytest.importorskip("matplotlib").use("Agg")
    (axes,) = bolted_joint.respond(EXAMPLES / "friction/loops.toml").plot("load").axes
    assert [line.get_label() for line in axes.lines][:2] == ["Iwan, 0.0001 m", "Iwan, 0.0003 m"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("relative.y, m", "load, N")
    study = bolted_joint.Study.read(EXAMPLES / "two-beams/beams.toml")
    assert bolted_joint.respond(study).plot().axes[0].get_ylabel() == "tip, m"
    study["response"] = {"kind": "linear", "from": 5, "to": 300, "lines": 10}
    response = bolted_joint.respond(study)
    (axes,) = response.plot().axes
    assert axes.get_ylabel() == "|tip/push receptance|, m/N"
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), np.abs(response.complex("tip/push receptance")))
