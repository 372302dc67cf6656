"""Joints over the preload: what they show, and which matrix is taken where one is asked for."""

import pathlib
import re

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Joint

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOUR_BOLTS = ROOT / "examples/predict-four-bolts/study.toml"
TABLE = ROOT / "tests/data/joint/torques.joint.json"


@pytest.fixture(scope="module")
def predicted():
    return bolted_joint.predict(FOUR_BOLTS)


def test_a_joint_over_the_preload_shows_its_matrices_at_each_preload(predicted):
    table = predicted.joint.data["joint"]["over_preload"]
    assert predicted.joint.preloads == tuple(table["preload"]) == (4.0, 8.0, 12.0, 16.0)
    assert predicted.joint.nominal_preload == 12.0
    html = predicted._repr_html_()
    assert "nominally 12 N·m" in html and "preload, N·m" in html
    # 2.2368e9 N/m at 4 N·m, 8.12300e9 N/m at 16 N·m, with standard deviations of 0.335e9 and 1.27e9
    assert "<td>4</td><td>y, y</td><td>2.24(34)e+09</td>" in html
    assert "<td>16</td><td>y, y</td><td>8.1(13)e+09</td>" in html
    assert "preloads of 4, 8, 12, 16 N·m" in repr(predicted)
    # deviations of another preload than the nominal one are not those of the nominal one
    alone = Joint(dict(predicted.joint.data))
    alone.data["uncertainty"] = {
        key: value for key, value in alone.data["uncertainty"].items() if key != "over_preload"
    }
    assert "<td>4</td><td>y, y</td><td>2.23679e+09</td>" in alone._repr_html_()
    assert "<td>12</td><td>y, y</td><td>6.22(96)e+09</td>" in alone._repr_html_()


def test_one_matrix_is_that_at_one_preload():
    joint = Joint.read(TABLE)
    for name in ("stiffness", "damping", "stiffness_deviation", "damping_interval_95"):
        with pytest.raises(BoltedJointError, match=rf"at 10, 15, 25 N·m.*at_preload\(15\)\.{name}"):
            getattr(joint, name)
    table = joint.data["joint"]["over_preload"]
    stated = joint.data["uncertainty"]["over_preload"]["at"]
    for place, preload in enumerate(joint.preloads):
        at = joint.at_preload(preload)
        assert at.preloads == () and f"at {preload:g} N·m" in at.name
        np.testing.assert_array_equal(at.stiffness, table["stiffness"][place])
        np.testing.assert_array_equal(at.damping, table["damping"][place])
        deviations = stated[place]["standard_deviation"]["stiffness"]
        np.testing.assert_array_equal(at.stiffness_deviation, deviations)
    # the nominal one
    np.testing.assert_array_equal(joint.at_preload().stiffness, table["stiffness"][1])
    between = joint.at_preload(12.0)
    assert table["stiffness"][0][0][0] < between.stiffness[0, 0] < table["stiffness"][1][0][0]
    assert between.dynamic_stiffness([10.0]).shape == (1, 2, 2)
    np.testing.assert_array_equal(between.dynamic_stiffness(10.0), between.dynamic_stiffness([10.0])[0])
    with pytest.raises(BoltedJointError, match=r"frequency_hz: found an array of shape \(1, 1\)"):
        between.dynamic_stiffness([[10.0]])
    with pytest.raises(BoltedJointError, match=r"found 30\.0 N·m, expected 10\.0 to 25\.0 N·m"):
        joint.at_preload(30)
    constant = Joint.read(ROOT / "tests/data/joint/m10-aluminium.joint.json")
    assert constant.preloads == () and constant.nominal_preload is None
    assert constant.at_preload().data == constant.data
    with pytest.raises(BoltedJointError, match="does not depend on the preload"):
        constant.at_preload(10)


def test_draws_scatter_at_all_preloads_as_the_covariance_says(predicted):
    joint = predicted.joint
    assert joint.unknowns[0] == "k_yy@4" and len(joint.unknowns) == 24
    covariance = joint.covariance
    at = joint.data["uncertainty"]["over_preload"]["at"]
    assert np.sqrt(covariance[0, 0]) == pytest.approx(at[0]["standard_deviation"]["stiffness"][0][0], rel=1e-12)
    assert np.sqrt(covariance[-1, -1]) == pytest.approx(at[3]["standard_deviation"]["damping"][1][1], rel=1e-12)
    rng = np.random.default_rng(5)
    drawn = np.array([joint.draw(rng).data["joint"]["over_preload"]["stiffness"] for _ in range(2000)])
    # the stiffnesses at 4 and 16 N·m go together: unknowns 0 and 18
    found = np.corrcoef(drawn[:, 0, 0, 0], drawn[:, 3, 0, 0])[0, 1]
    stated = joint.data["uncertainty"]["over_preload"]["correlation"]["matrix"][0][18]
    assert found == pytest.approx(stated, abs=0.01) and stated > 0.9
    with pytest.raises(BoltedJointError, match="no covariance .* at all preloads"):
        Joint.read(TABLE).draw(rng)


@pytest.mark.filterwarnings("error")
def test_friction_is_shown_at_each_preload():
    pytest.importorskip("matplotlib").use("Agg")
    study = bolted_joint.Study.read(ROOT / "examples/predict-microslip/over-torque.toml")
    study["uncertainty"] = {"draws": 20}
    predicted = bolted_joint.predict(study)
    html = predicted._repr_html_()
    laws = predicted.joint.data["joint"]["over_preload"]["friction"]
    for preload, (law,) in zip(predicted.joint.preloads, laws, strict=True):
        # digits by deviation: 4.00(40)e+03
        shown = re.search(rf"<td>{preload:g}</td><td>y, iwan</td><td>slip_force ([^;]+);", html)
        value = float(re.sub(r"\(\d+\)", "", shown.group(1)))
        assert value == pytest.approx(law["slip_force"], rel=0.01)
    for figure in (predicted.plot(), predicted.joint.plot()):
        (axes,) = figure.axes
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("relative.y, m", "load, N")
        highest = {line.get_label(): np.abs(line.get_ydata()).max() for line in axes.lines}
        # at twice the displacement that the spring would have, all slips
        at = [f"at {preload} N·m" for preload in (10, 20, 40)]
        found = [max(load for name, load in highest.items() if own in name) for own in at]
        np.testing.assert_allclose(found, [law["slip_force"] for (law,) in laws], rtol=1e-2)
    with pytest.raises(BoltedJointError, match="whose uncertainty is not in the covariance"):
        predicted.joint.draw(np.random.default_rng(1))


def test_it_is_drawn_at_its_preloads_or_at_one(predicted):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    table = predicted.joint.data["joint"]["over_preload"]
    for figure in (predicted.plot(), predicted.joint.plot()):
        curves = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
        for place, preload in enumerate(table["preload"]):
            stiffness = curves[f"{predicted.joint.name}, at {preload:g} N·m: K"]
            assert set(stiffness) == {table["stiffness"][place][0][0]}
    one = predicted.joint.plot(preload_n_m=8.0).axes[0].lines
    assert [line.get_label() for line in one] == [f"{predicted.joint.name}, at 8 N·m: K", "ωC"]
