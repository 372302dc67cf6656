"""Figures by Matplotlib: that they show what was measured and found."""

import numpy as np
import pytest

import bolted_joint

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


def test_measured_and_identified_functions_are_drawn(demo, tmp_path):
    found = bolted_joint.identify(demo / "study.toml")
    figure = found.plot()
    above, below = figure.axes
    curves = {line.get_label(): line for line in above.lines}
    measured = bolted_joint.read(demo / "assembly.uff")
    # the tip of the beam moves most
    curve = curves["13:+Y/13:+Y measured"]
    np.testing.assert_array_equal(curve.get_ydata(), np.abs(measured["13:+Y", "13:+Y"]))
    assert "13:+Y/13:+Y identified" in curves
    assert above.get_ylabel() == "receptance, SI" and below.get_xlabel() == "frequency, Hz"
    figure.savefig(tmp_path / "functions.png")
    joint = found.joint.plot()
    assert [axes.get_title() for axes in joint.axes] == ["y", "theta"]
    joint.savefig(tmp_path / "joint.png")
