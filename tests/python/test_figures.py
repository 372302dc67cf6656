"""Figures by Matplotlib: that they show what was measured and found."""

import pickle
import warnings

import numpy as np
import pytest

import bolted_joint

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


def test_pyplot_keeps_no_figure(demo):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    joint = bolted_joint.Joint.read(demo / "m10x16.joint.json")
    functions = bolted_joint.read(demo / "assembly.uff")
    open_before = pyplot.get_fignums()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figures = [joint.plot() for _ in range(25)]
    assert isinstance(functions.plot(most=2), matplotlib.figure.Figure) and pyplot.get_fignums() == open_before
    assert figures[0]._repr_png_().startswith(b"\x89PNG") and pickle.loads(pickle.dumps(figures[0])).axes
    # a notebook makes one picture of it
    formatter = pytest.importorskip("IPython.core.interactiveshell").DisplayFormatter()
    data, _ = formatter.format(figures[0])
    assert "image/png" in data


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
