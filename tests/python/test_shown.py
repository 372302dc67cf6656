"""What notebooks show of results, and what is said of values that no file has a word for."""

import json
import pathlib
import re
import threading
import time
import warnings

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Joint

ROOT = pathlib.Path(__file__).resolve().parents[2]
M10 = ROOT / "tests/data/joint/m10-aluminium.joint.json"


def test_the_version_is_the_command_lines(run):
    assert run("--version").stdout.split() == ["bolted-joint", bolted_joint.__version__]


def test_fmus_and_checks_are_tables(tmp_path):
    fmu = bolted_joint.export(M10, tmp_path / "joint.fmu")
    html = fmu._repr_html_()
    assert "joint.fmu" in html and "element, FMI 3.0" in html and fmu.details["token"] in html
    checked = bolted_joint.check(fmu)
    html = checked._repr_html_()
    assert "<caption>sound</caption>" in html and "terminals: a, b" in html
    wrong = bolted_joint.Checked({"sound": False, "facts": [], "findings": ["it is <broken>"]})
    assert "not sound" in wrong._repr_html_() and "it is &lt;broken&gt;" in wrong._repr_html_()


def test_what_is_wrong_is_found_and_what_cannot_be_read_is_refused(tmp_path):
    joint = Joint.read(M10)
    joint.data["joint"]["stiffness"][0][0] = -1.0
    found = bolted_joint.check(joint)
    assert not found.sound and found.usable
    assert "joint.stiffness is active" in found.findings[0] and "is active" in repr(found)
    joint = Joint.read(M10)
    joint.data["status"] = {"usable": False, "reasons": ["it rattles"]}
    with pytest.warns(bolted_joint.NotUsableWarning, match=f"^{joint.name}: not to be relied on"):
        found = bolted_joint.check(joint)
    assert found.sound and not found.usable and "it rattles" in found._repr_html_()
    cut_off = tmp_path / "cut-off.joint.json"
    cut_off.write_text("{", encoding="utf-8")
    with pytest.raises(BoltedJointError, match="cut off"):
        bolted_joint.check(cut_off)


def test_no_text_names_a_folder_that_is_gone(tmp_path, short):
    joint = Joint.read(M10)
    hidden = "bolted-joint-[a-z0-9_]{8}"
    assert not re.search(hidden, json.dumps(bolted_joint.check(joint).details))
    compared = bolted_joint.compare(joint, joint, page=True)
    assert not re.search(hidden, compared.page_html + json.dumps(compared.details)) and joint.name in compared.page_html
    with pytest.raises(BoltedJointError) as refused:
        bolted_joint.respond(short, Joint({**joint.data, "format": "other"}))
    assert joint.name in str(refused.value) and not re.search(hidden, str(refused.value))
    short["b"]["beam"] |= {"length": 0.30, "density": 1350}
    with pytest.warns(UserWarning) as told:
        found = bolted_joint.identify(short)
    texts = [str(one.message) for one in told]
    assert any(text.startswith("the joint: not to be relied on") for text in texts)
    assert not any(re.search(hidden, text) for text in [*texts, json.dumps(found.details)])


def test_warnings_are_those_of_the_user_in_all_threads(short):
    joint = Joint.read(ROOT / "tests/data/joint/torques.joint.json")
    found = bolted_joint.identify(short, rivals=False)

    def work():
        for _ in range(4):
            joint.at_preload(12)
            found.measured()
            found.regenerated(50)

    before = list(warnings.filters)
    threads = [threading.Thread(target=work) for _ in range(4)]
    changed = []
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        changed.append(list(warnings.filters) != before)
        time.sleep(1e-4)
    assert not any(changed) and list(warnings.filters) == before


def test_draws_are_a_table_of_their_percentiles(short):
    draws = bolted_joint.draw(short, range(6), bootstrap=6)
    html = draws._repr_html_()
    median = np.median(draws.values[:, 0])
    assert "draws 0 to 5, 6 of 6 with results" in html and f"<td>{median:.6g}</td>" in html
    # a draw that came to nothing has no part in it
    draws.values[3] = np.nan
    assert "5 of 6 with results" in draws._repr_html_() and "nan" not in draws._repr_html_()
    draws.values[:] = np.nan
    assert "0 of 6 with results" in draws._repr_html_()


def test_a_comparison_is_drawn_with_intervals():
    pytest.importorskip("matplotlib").use("Agg")
    joint = Joint.read(M10)
    found = bolted_joint.compare(joint, joint)
    panels = found.plot().axes
    assert [axes.get_title() for axes in panels][:2] == ["k_yy, N/m", "k_ytheta, N/rad"] and len(panels) == 6
    for drawn in panels[0].containers:
        (segment,) = drawn[2][0].get_segments()
        # 1.96 standard deviations to either side
        half = 1.96 * joint.stiffness_deviation[0, 0]
        np.testing.assert_allclose(segment[:, 1], joint.stiffness[0, 0] + np.array([-half, half]))


@pytest.mark.filterwarnings("ignore:the polynomial pressure")
def test_predictions_are_drawn_by_their_kind():
    pytest.importorskip("matplotlib").use("Agg")
    beam = bolted_joint.predict(ROOT / "examples/kavi-layered-beam/study.toml")
    (axes,) = beam.plot().axes
    assert axes.get_ylabel() == "damping ratio" and axes.lines[0].get_label().startswith("mode 1, 217")
    # the calibration: 1.2 % at 0.1 mm
    assert (axes.lines[0].get_xdata()[0], axes.lines[0].get_ydata()[0]) == (1e-4, 0.012)
    assert "y, jenkins" in beam._repr_html_() and "slip_force" in beam._repr_html_()
    study = bolted_joint.Study.read(ROOT / "examples/predict-microslip/study.toml")
    study["uncertainty"]["draws"] = 200
    slipping = bolted_joint.predict(study)
    (axes,) = slipping.plot().axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("relative.y, m", "load, N") and len(axes.lines) == 3
    law = slipping.joint.data["joint"]["friction"][0]
    assert len(slipping.joint.plot().axes[0].lines) == 3
    with pytest.raises(BoltedJointError, match=r"of zeros .* friction \(iwan\), whose uncertainty is not in"):
        slipping.joint.draw(np.random.default_rng(1))
    # at twice the displacement that the spring would have, all slips
    assert np.abs(axes.lines[2].get_ydata()).max() == pytest.approx(law["slip_force"], rel=1e-6)


@pytest.mark.parametrize(
    ("study", "said"),
    [
        ({"a": {"beam": {"length": float("nan")}}}, r'study\["a"\]\["beam"\]\["length"\]: found nan, expected'),
        ({"assembly": [{}, {"torque": None}]}, r'study\["assembly"\]\[1\]\["torque"\]: found None.*leave the key out'),
        ({"bounds": {"k": np.array([1.0, np.inf])}}, r'study\["bounds"\]\["k"\]\[1\]: found inf, expected'),
        ({"known": {"m": {1.0}}}, r'study\["known"\]\["m"\]: found an object of type set, expected a text'),
        ({"known": {"m": 1 + 2j}}, r'study\["known"\]\["m"\]: found an object of type complex'),
    ],
    ids=["nan", "None", "in an array", "set", "complex"],
)
def test_a_value_that_no_study_has_is_named_by_its_place(study, said):
    for function in (bolted_joint.identify, bolted_joint.predict):
        with pytest.raises(BoltedJointError, match=said):
            function({"method": "frf-decoupling", **study})


def test_a_value_that_no_joint_file_has_is_named_by_its_place(tmp_path):
    joint = Joint.read(M10)
    joint.data["joint"]["stiffness"][1][0] = float("nan")
    said = r'data\["joint"\]\["stiffness"\]\[1\]\[0\]: found nan, expected a finite number'
    with pytest.raises(BoltedJointError, match=said):
        joint.save(tmp_path / "x.joint.json")
    with pytest.raises(BoltedJointError, match=said):
        bolted_joint.export(joint, tmp_path / "x.fmu")
