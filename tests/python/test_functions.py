"""Functions as arrays: what is read, what is refused."""

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Functions

F = np.array([1.0, 2.0, 4.0])
H = np.arange(12).reshape(3, 2, 2) * (1.0 + 0.5j) + 1.0
NAMES = ["1:+Y", "2:+Y"]


def test_what_is_saved_is_read_to_the_bit(tmp_path):
    coherence = np.full(H.shape, 0.75)
    Functions(F, H, NAMES, NAMES, coherence=coherence, averages=16).save(tmp_path / "a.npz")
    with pytest.warns(UserWarning, match="SI is assumed"):
        read = bolted_joint.read(tmp_path / "a.npz")
    np.testing.assert_array_equal(read.values, H)
    np.testing.assert_array_equal(read.frequency_hz, F)
    np.testing.assert_array_equal(read.coherence, coherence)
    assert (read.responses, read.references, read.averages) == (tuple(NAMES), tuple(NAMES), 16)


def test_accelerance_is_read_as_receptance(tmp_path):
    Functions(F, H, NAMES, NAMES, quantity="accelerance").save(tmp_path / "a.npz")
    with pytest.warns(UserWarning, match="SI is assumed"):
        read = bolted_joint.read(tmp_path / "a.npz")
    # H = A / (iω)²
    expected = H / (2j * np.pi * F[:, None, None]) ** 2
    np.testing.assert_allclose(read.values, expected, rtol=1e-14)


def test_what_another_program_wrote_is_read(demo):
    pyuff = pytest.importorskip("pyuff")
    read = bolted_joint.read(demo / "assembly.uff")
    sets = [one for one in pyuff.UFF(str(demo / "assembly.uff")).read_sets() if one["type"] == 58]
    assert len(read) == len(sets)
    for one in sets:
        response, reference = (f"{one[f'{role}_node']}:+Y" for role in ("rsp", "ref"))
        np.testing.assert_allclose(read[response, reference], one["data"], rtol=1e-12)


def test_functions_that_were_not_measured_are_told(tmp_path):
    (tmp_path / "a.csv").write_text(
        "frequency [Hz],1:+Y/1:+Y receptance real [m/N],1:+Y/1:+Y receptance imaginary [m/N],"
        "2:+Y/2:+Y receptance real [m/N],2:+Y/2:+Y receptance imaginary [m/N]\n1,2,3,4,5\n",
        encoding="utf-8",
    )
    read = bolted_joint.read(tmp_path / "a.csv")
    assert read.measured.tolist() == [[True, False], [False, True]]
    assert len(read) == 2
    with pytest.raises(BoltedJointError, match=r"1:\+Y/2:\+Y was not measured"):
        read.save(tmp_path / "b.npz")
    part = read.select(["2:+Y"], ["2:+Y"])
    assert part["2:+Y", "2:+Y"].tolist() == [4 + 5j]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((F, H[:2], NAMES, NAMES), r"shape \(2, 2, 2\), expected \(3, 2, 2\)"),
        ((F, H, NAMES[0], NAMES), "expected a list of DOFs"),
        (([F], H, NAMES, NAMES), "expected one axis"),
    ],
    ids=["lines", "one text", "axes"],
)
def test_shapes_that_do_not_fit_are_refused(arguments, said):
    with pytest.raises(BoltedJointError, match=said):
        Functions(*arguments)


def test_unknown_quantities_files_and_names_are_refused(tmp_path):
    with pytest.raises(BoltedJointError, match="'inertance', expected one of receptance"):
        Functions(F, H, NAMES, NAMES, quantity="inertance")
    with pytest.raises(BoltedJointError, match="nowhere.uff"):
        bolted_joint.read(tmp_path / "nowhere.uff")
    with pytest.raises(BoltedJointError, match=r"found '3:\+Y', expected one of 1:\+Y, 2:\+Y"):
        Functions(F, H, NAMES, NAMES)["3:+Y", "1:+Y"]


def test_an_axis_of_length_one_may_be_missing():
    assert Functions(F, H[:, :, 0], NAMES, NAMES[:1]).values.shape == (3, 2, 1)


def test_tables_for_notebooks_escape_what_they_show():
    html = bolted_joint.Joint(
        {"name": "<b>", "joint": {"dofs": ["y"], "stiffness": [[5.0e5]], "damping": [[1.0]]}}
    )._repr_html_()
    assert "&lt;b&gt;" in html and "<b>" not in html


@pytest.mark.parametrize(
    ("value", "deviation", "text"),
    [
        (572877.7, 269.57, "5.7288(27)e+05"),
        (-0.8332913, 0.0044221, "-8.333(44)e-01"),
        (1.0, 0.0, "1"),
        (1.0, 3.0, "1.0(30)e+00"),
        (1.0, 300.0, "1 ± 3e+02"),
        (9.9996, 0.02, "10.000(20)e+00"),
    ],
)
def test_digits_follow_the_deviation(value, deviation, text):
    from bolted_joint._html import with_deviation

    assert with_deviation(value, deviation) == text
