"""Functions as arrays: what is read, what is refused."""

import os
import pathlib
import re
import warnings
import zipfile

import numpy as np
import pytest

import bolted_joint
from bolted_joint import BoltedJointError, Functions, _native

ROOT = pathlib.Path(__file__).resolve().parents[2]
F = np.array([1.0, 2.0, 4.0])
H = np.arange(12).reshape(3, 2, 2) * (1.0 + 0.5j) + 1.0
NAMES = ["1:+Y", "2:+Y"]


def with_one(wrong):
    """Values of which one is wrong."""
    values = H.copy()
    values[1, 0, 1] = wrong
    return values


def test_what_is_saved_is_read_to_the_bit(tmp_path):
    coherence = np.full(H.shape, 0.75)
    Functions(F, H, NAMES, NAMES, coherence=coherence, averages=16).save(tmp_path / "a.npz")
    read = bolted_joint.read(tmp_path / "a.npz")
    np.testing.assert_array_equal(read.values, H)
    np.testing.assert_array_equal(read.frequency_hz, F)
    np.testing.assert_array_equal(read.coherence, coherence)
    assert (read.responses, read.references, read.averages) == (tuple(NAMES), tuple(NAMES), 16)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("quantity", ["receptance", "mobility", "accelerance"])
@pytest.mark.parametrize("ending", ["npz", "csv"])
def test_a_file_says_its_units_and_how_far_magnitudes_are_known(tmp_path, quantity, ending):
    names = ["1:+Y", "1:+RZ"]
    functions = Functions(F, H, names, names, quantity=quantity)
    functions.magnitude_deviation = 0.1 * np.abs(H)
    functions.save(tmp_path / f"a.{ending}")
    read = bolted_joint.read(tmp_path / f"a.{ending}")
    expected = functions.as_quantity("receptance")
    np.testing.assert_allclose(read.values, expected.values, rtol=1e-14)
    # of a quantity that is differentiated in time, deviations are so too
    np.testing.assert_allclose(expected.magnitude_deviation, 0.1 * np.abs(expected.values), rtol=1e-14)
    if ending == "npz":
        np.testing.assert_allclose(read.magnitude_deviation, expected.magnitude_deviation, rtol=1e-14)
    part = functions.select("1:+RZ", "1:+Y", to_hz=2.0)
    assert (part.responses, part.references) == (("1:+RZ",), ("1:+Y",))
    np.testing.assert_array_equal(part.magnitude_deviation, functions.magnitude_deviation[:2, 1:, :1])
    with pytest.raises(BoltedJointError, match=r"a\.uff: found the ending '\.uff', expected \.npz .* or \.csv"):
        functions.save(tmp_path / "a.uff")
    translations = functions.select("1:+Y", "1:+Y")
    translations.save(tmp_path / f"b.{ending}")
    # the command line reads them too
    *_, units_are_stated = _native.read_functions(tmp_path / f"b.{ending}")
    assert units_are_stated


def test_averages_are_numbers_from_one_on(tmp_path):
    functions = Functions(F, H, NAMES, NAMES, averages=np.int64(16))
    for path in (tmp_path / "a.npz", tmp_path / "a.csv"):
        functions.save(path)
        assert bolted_joint.read(path).averages == 16
        assert bolted_joint.read(path, averages=np.int64(4)).averages in (4, 16)
    for wrong in (0, -1, np.nan, np.inf, "16", True):
        with pytest.raises(BoltedJointError, match="averages: found .*, expected a finite number from 1 on"):
            Functions(F, H, NAMES, NAMES, averages=wrong)


def test_masked_entries_are_not_used(tmp_path):
    mask = np.zeros(H.shape, bool)
    mask[:, 0, 1] = True
    coherence = np.ma.array(np.ones(H.shape), mask=mask)
    functions = Functions(F, np.ma.array(H, mask=mask), NAMES, NAMES, coherence=coherence)
    assert functions.measured.tolist() == [[True, False], [True, True]]
    assert np.isnan(functions.coherence[:, 0, 1]).all() and functions.coherence[0, 0, 0] == 1.0
    with pytest.raises(BoltedJointError, match="frequency_hz: found masked entries"):
        Functions(np.ma.array(F, mask=[True, False, False]), H, NAMES, NAMES)


def test_functions_are_found_by_their_names():
    values = H.copy()
    values[:, 0, 1] = np.nan
    functions = Functions(F, values, NAMES, NAMES)
    assert list(functions) == list(functions.keys()) == [("1:+Y", "1:+Y"), ("2:+Y", "1:+Y"), ("2:+Y", "2:+Y")]
    assert ("2:+Y", "1:+Y") in functions and ("1:+Y", "2:+Y") not in functions and "1:+Y" not in functions
    with pytest.raises(BoltedJointError, match="found '1:.*expected a response and a reference"):
        functions["1:+Y"]
    with pytest.raises(BoltedJointError, match=r"found '3:\+Y', expected one of 1:\+Y, 2:\+Y"):
        functions.select("3:+Y")


def test_accelerance_is_read_as_receptance(tmp_path):
    Functions(F, H, NAMES, NAMES, quantity="accelerance").save(tmp_path / "a.npz")
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
        (([1.0, 4.0, 2.0], H, NAMES, NAMES), "frequency_hz: found 2 at line 2 after 4, .* increase; sort the l"),
        (([1.0, 2.0, 2.0], H, NAMES, NAMES), "frequency_hz: found 2 at line 2 after 2, expected .* increase"),
        (([1.0, np.nan, 2.0], H, NAMES, NAMES), "frequency_hz: found nan at line 1, expected finite frequencies in Hz"),
        (([1.0, 2.0, np.inf], H, NAMES, NAMES), "frequency_hz: found inf at line 2, expected finite frequencies in Hz"),
        (([-1.0, 2.0, 4.0], H, NAMES, NAMES), "frequency_hz: found -1.0 at line 0, expected .* from 0 on"),
        ((F, H, NAMES, ["1:+Y", "1:Y"]), "references: found '1:Y' twice, expected each DOF once"),
        ((F, H, ["2:rz", " 2:+RZ"], NAMES), r"responses: found ' 2:\+RZ' twice, expected each DOF once"),
        ((F, H, [("1", "Y"), "2:+Y"], NAMES), r"responses: found \('1', 'Y'\), expected NODE:DIRECTION such"),
        ((F, H, [1, 2], NAMES), "responses: found 1, expected NODE:DIRECTION"),
        ((F, H, ["1", "2:+Y"], NAMES), "responses: found '1', expected NODE:DIRECTION"),
        ((F, H, NAMES, ["1:+W", "2:+Y"]), r"references: found '1:\+W', expected NODE:DIRECTION"),
        ((F, H, 5, NAMES), "responses: found 5, expected a list of DOFs"),
        ((F, H, [], NAMES), r"\(3, 2, 2\), expected \(3, 0, 2\): .*; responses and references need a name for each"),
        ((F, with_one(np.nan), NAMES, NAMES), r"values: found .nan.* at line 1 \(2 Hz\) of 1:\+Y/2:\+Y, expected"),
        ((F, with_one(np.inf), NAMES, NAMES), r"values: found .inf.* at line 1 \(2 Hz\) of 1:\+Y/2:\+Y, .* leave"),
    ],
)
def test_arrays_that_are_no_functions_are_refused(arguments, said):
    with pytest.raises(BoltedJointError, match=said) as refused:
        Functions(*arguments)
    # no file that nobody has made
    assert not re.search(r"npz|\barray [a-z]+:", str(refused.value))


def test_no_function_is_no_file(short, tmp_path):
    none = short["assembly"]["frf"].select(from_hz=1e9)
    short["assembly"]["frf"] = none
    path = tmp_path / "a.csv"
    for call in (lambda: bolted_joint.identify(short), lambda: bolted_joint.show(none), lambda: none.save(path)):
        with pytest.raises(BoltedJointError, match="functions: found 0 lines, .* expected one function on one line"):
            call()


def test_coherence_is_a_part():
    for wrong in (1.5, -0.1, np.inf):
        with pytest.raises(BoltedJointError, match=r"coherence: found .* at line 0 \(1 Hz\) .* γ² from 0 to 1"):
            Functions(F, H, NAMES, NAMES, coherence=np.full(H.shape, wrong))


@pytest.mark.parametrize("names", [["1:y", "1:-RZ"], ["7:0", " 8:-x "], ["1:+Y", "1:-Y"]])
def test_degrees_of_freedom_are_those_of_files(tmp_path, names):
    functions = Functions(F, H, names, np.array(names))
    functions.save(tmp_path / "a.npz")
    # the command line takes them too
    assert len(bolted_joint.read(tmp_path / "a.npz")) == 4


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


@pytest.mark.parametrize("quantity", ["receptance", "mobility", "accelerance"])
def test_functions_become_another_quantity(quantity):
    functions = Functions(F, H, NAMES, NAMES, quantity=quantity, averages=4, coherence=np.full(H.shape, 0.5))
    order = ["receptance", "mobility", "accelerance"]
    for other in order:
        turned = functions.as_quantity(other)
        power = order.index(other) - order.index(quantity)
        np.testing.assert_allclose(turned.values, H * (2j * np.pi * F[:, None, None]) ** power, rtol=1e-14)
        assert (turned.quantity, turned.averages) == (other, 4)
    with pytest.raises(BoltedJointError, match="'inertance'"):
        functions.as_quantity("inertance")
    # of an accelerance at 0 Hz there is no receptance
    at_rest = Functions([0.0, 1.0], H[:2], NAMES, NAMES, quantity="accelerance").as_quantity("receptance")
    assert at_rest.frequency_hz.tolist() == [1.0]


def table_of(path, names, unit="", part="receptance"):
    """A table with two lines, where one function after the other has 1 + 2i, 3 + 4i and so on."""
    heads = ["frequency [Hz]"]
    for name in names:
        heads += [f"{name} {part} real{unit}", f"{name} {part} imaginary{unit}"]
    numbers = ",".join(str(number + 1) for number in range(2 * len(names)))
    path.write_text("\n".join([",".join(heads), f"1,{numbers}", f"2,{numbers}"]) + "\n", encoding="utf-8")
    return path


MILLIMETRES = {"length": "mm", "force": "N"}


def test_units_are_those_that_are_stated(tmp_path):
    pairs = ["1:+Y/1:+Y", "1:+RZ/1:+Y", "1:+Y/1:+RZ", "1:+RZ/1:+RZ"]
    silent = table_of(tmp_path / "silent.csv", pairs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read = bolted_joint.read(silent, units={"length": "mm", "force": "kN"})
    # m/N, rad/N, m/(N·m) and rad/(N·m) in mm/kN, rad/kN, mm/(kN·mm) and rad/(kN·mm)
    expected = {pairs[0]: (1 + 2j) * 1e-6, pairs[1]: (3 + 4j) * 1e-3, pairs[2]: (5 + 6j) * 1e-3, pairs[3]: 7 + 8j}
    for pair, value in expected.items():
        np.testing.assert_allclose(read[tuple(pair.split("/"))], value, rtol=1e-12)
    with pytest.raises(BoltedJointError, match="units.length: found 'furlong', expected one of m, cm, mm"):
        bolted_joint.read(silent, units={"length": "furlong", "force": "N"})


@pytest.mark.parametrize("unit", ["m/N", "mm/N", "(mm)/N", "mm/kN", "in/lbf"])
def test_units_take_the_place_of_the_files_own(tmp_path, unit):
    path = table_of(tmp_path / "stated.csv", ["1:+Y/1:+Y"], f" [{unit}]")
    read = bolted_joint.read(path, units={"length": "mm", "force": "N"})
    np.testing.assert_allclose(read.values.ravel(), (1 + 2j) * 1e-3, rtol=1e-12)


def test_units_take_the_place_of_data_set_164():
    path = ROOT / "tests/data/uff/millimetres.uff"
    as_stated = bolted_joint.read(path)
    np.testing.assert_allclose(bolted_joint.read(path, units=MILLIMETRES).values, as_stated.values, rtol=1e-12)
    metres = bolted_joint.read(path, units={"length": "m", "force": "N"})
    ratio = metres["11:+Y", "2:+Y"] / as_stated["11:+Y", "2:+Y"]
    np.testing.assert_allclose(ratio, 1e3, rtol=1e-12)


def test_units_beside_those_that_differ_from_function_to_function_are_refused(tmp_path):
    path = tmp_path / "mixed.csv"
    path.write_text(
        "frequency [Hz],1:+Y/1:+Y real [m/N],1:+Y/1:+Y imaginary [m/N],"
        "2:+Y/1:+Y real [mm/N],2:+Y/1:+Y imaginary [mm/N]\n1,1,2,3,4\n",
        encoding="utf-8",
    )
    with pytest.raises(BoltedJointError, match=r"mixed\.csv: units: found units beside .*m/N.*mm/N.*expected none"):
        bolted_joint.read(path, units=MILLIMETRES)


def test_several_files_are_read_as_one(tmp_path):
    first = table_of(tmp_path / "1.csv", ["1:+Y/1:+Y", "2:+Y/1:+Y"], " [m/N]")
    second = table_of(tmp_path / "2.csv", ["1:+Y/2:+Y"], " [m/N]")
    read = bolted_joint.read([first, second])
    assert (read.responses, read.references, len(read)) == (("1:+Y", "2:+Y"), ("1:+Y", "2:+Y"), 3)
    assert read["1:+Y", "2:+Y"].tolist() == [1 + 2j] * 2 and read.measured.tolist() == [[True, True], [True, False]]
    with pytest.raises(BoltedJointError, match=r"1\.csv, .*found 1:\+Y/1:\+Y twice"):
        bolted_joint.read([first, first])
    with pytest.raises(BoltedJointError, match="path: found an empty list"):
        bolted_joint.read([])


def test_coherence_may_be_in_a_file_of_its_own(tmp_path):
    functions = table_of(tmp_path / "frf.csv", ["1:+Y/1:+Y", "2:+Y/1:+Y"], " [m/N]")
    (tmp_path / "coherence.csv").write_text(
        "# averages = 8\nfrequency [Hz],2:-Y/1:+Y coherence,9:+Y/1:+Y coherence\n1,0.5,0.1\n2,0.25,0.1\n",
        encoding="utf-8",
    )
    read = bolted_joint.read(functions, coherence=tmp_path / "coherence.csv")
    # whatever the signs of its DOFs
    assert read.coherence[:, 1, 0].tolist() == [0.5, 0.25] and np.isnan(read.coherence[:, 0, 0]).all()
    assert read.averages == 8
    with pytest.raises(BoltedJointError, match=r"frf\.csv: found no coherence"):
        bolted_joint.read(functions, coherence=[functions])


@pytest.mark.filterwarnings("error::numpy.exceptions.ComplexWarning")
@pytest.mark.parametrize("ending", ["npz", "csv"])
def test_coherence_is_kept_where_a_line_at_0_hz_is_left_out(tmp_path, ending):
    """As analysers export accelerances: a receptance has no value there."""
    frequency = np.array([0.0, 1.0, 2.0])
    coherence = np.arange(12).reshape(H.shape) / 12.0
    Functions(frequency, H, NAMES, NAMES, quantity="accelerance", coherence=coherence).save(tmp_path / f"a.{ending}")
    read = bolted_joint.read(tmp_path / f"a.{ending}")
    np.testing.assert_array_equal(read.frequency_hz, frequency[1:])
    np.testing.assert_array_equal(read.coherence, coherence[1:])
    beside = bolted_joint.read(tmp_path / f"a.{ending}", coherence=tmp_path / f"a.{ending}")
    np.testing.assert_array_equal(beside.coherence, coherence[1:])


@pytest.mark.filterwarnings("ignore")
def test_what_does_not_belong_to_the_functions_is_refused(tmp_path):
    def written(name, frequency=F, names=NAMES, **more):
        Functions(frequency, H, names, NAMES, **more).save(tmp_path / name)
        return tmp_path / name

    gamma = np.full(H.shape, 0.5)
    own = written("own.npz", averages=10)
    others = written("others.npz", names=["3:+Y", "4:+Y"], averages=1000)
    lines = written("lines.npz", frequency=F + 0.5, coherence=gamma)
    strange = written("strange.npz", names=["3:+Y", "4:+Y"], coherence=gamma)
    for arguments, named, said in [
        (([own, others],), {}, "others.npz: found 1000 averages, and 10 before it"),
        ((own,), {"coherence": lines}, "at other lines than the function"),
        ((own,), {"coherence": strange}, "strange.npz: coherence: found that of 3:+Y/1:+Y and of no function"),
        ((own,), {"units": {"length": "mm", "force": "N", "mass": "t"}}, "units: found the key 'mass'"),
    ]:
        with pytest.raises(BoltedJointError, match=re.escape(said)):
            bolted_joint.read(*arguments, **named)
    assert bolted_joint.read([own, others], averages=20).averages == 20


@pytest.mark.filterwarnings("ignore")
def test_coherence_of_some_functions_goes_into_a_table(tmp_path):
    coherence = np.full(H.shape, 0.5)
    coherence[:, 0, 1] = np.nan
    functions = Functions(F, H, NAMES, NAMES, coherence=coherence)
    with pytest.raises(BoltedJointError, match="coherence for some of them only"):
        functions.save(tmp_path / "a.npz")
    functions.save(tmp_path / "a.csv")
    np.testing.assert_array_equal(bolted_joint.read(tmp_path / "a.csv").coherence, coherence)
    coherence[0, 1, 1] = np.nan
    with pytest.raises(BoltedJointError, match="coherence: found NaN at some lines of 2:.Y/2:.Y"):
        Functions(F, H, NAMES, NAMES, coherence=coherence)


def test_units_of_an_archive_are_honoured(tmp_path):
    """Whoever wrote it: one for all, or one for each function."""
    arrays = {"frequency": F, "frf": H, "response": ["1:+Y", "1:+RZ"], "reference": ["2:+Y", "2:+RZ"]}
    arrays |= {"axes": "frequency,response,reference", "quantity": "receptance"}
    units = [["mm/N", "mm/(N·m)"], ["rad/kN", "rad/(N·m)"]]
    factors = np.array([[1e-3, 1e-3], [1e-3, 1.0]])
    for order in ("C", "F"):
        np.savez(tmp_path / "a.npz", **arrays, units=np.array(units, order=order))
        read = bolted_joint.read(tmp_path / "a.npz")
        np.testing.assert_allclose(read.values, H * factors, rtol=1e-14)
    of_one = {**arrays, "response": ["1:+Y", "3:+Y"], "reference": ["2:+Y", "4:+Y"]}
    np.savez(tmp_path / "a.npz", **of_one, units="mm/N")
    np.testing.assert_allclose(bolted_joint.read(tmp_path / "a.npz").values, 1e-3 * H, rtol=1e-14)
    np.savez(tmp_path / "a.npz", **arrays, units=units[0])
    with pytest.raises(BoltedJointError, match=re.escape("array units: found shape [2], expected one unit, or 2 × 2")):
        bolted_joint.read(tmp_path / "a.npz")


@pytest.mark.filterwarnings("ignore")
def test_other_arrays_of_an_archive_are_not_looked_at(tmp_path):
    arrays = {"freq": F, "frf": H, "response": NAMES, "reference": [b"1:+Y", b"2:+Y"], "axes": "frequency,response,reference"}
    for beside in ({}, {"magnitude_deviation": np.ones(3)}, {"magnitude_deviation": np.ones(H.shape)}):
        np.savez(tmp_path / "a.npz", **arrays, quantity="receptance", **beside)
        read = bolted_joint.read(tmp_path / "a.npz")
        np.testing.assert_array_equal(read.values, H)
        assert read.magnitude_deviation is None


@pytest.mark.filterwarnings("ignore")
def test_a_damaged_archive_is_refused(tmp_path):
    """One bit of the numbers, which nothing but the archive's sum tells."""
    Functions(F, H, NAMES, NAMES).save(tmp_path / "a.npz")
    data = bytearray((tmp_path / "a.npz").read_bytes())
    place = data.index(H.astype(complex).tobytes()) + 21
    data[place] ^= 4
    (tmp_path / "a.npz").write_bytes(data)
    with pytest.raises(BoltedJointError, match="array frf: found damaged data"):
        bolted_joint.read(tmp_path / "a.npz")


def test_a_workbook_is_told_from_an_archive(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("[Content_Types].xml", "<x/>")
    with pytest.raises(BoltedJointError, match="a workbook of Excel.*save the sheet as CSV"):
        bolted_joint.read(tmp_path / "a.npz")


def test_a_dof_may_be_written_without_its_sign():
    functions = Functions(F, H, NAMES, NAMES)
    np.testing.assert_array_equal(functions["2:y", "1:Y"], H[:, 1, 0])
    assert functions.select("2:Y").responses == ("2:+Y",)


def test_numbers_that_would_lose_something_are_refused():
    for frequency, values in [(F + 1j, H), (F > 1, H), (F, H.real > 0)]:
        with pytest.raises(BoltedJointError, match="found what is no array of numbers"):
            Functions(frequency, values, NAMES, NAMES)


@pytest.mark.parametrize("ending", ["npz", "csv"])
def test_a_file_is_replaced_and_never_half_written(tmp_path, ending):
    path, old = tmp_path / f"a.{ending}", tmp_path / f"old.{ending}"
    path.write_bytes(b"as it was")
    os.link(path, old)
    Functions(F, H, NAMES, NAMES).save(path)
    # whoever has the old file open still has it whole
    assert old.read_bytes() == b"as it was"
    assert len(bolted_joint.read(path)) == 4
    assert sorted(own.name for own in tmp_path.iterdir()) == [path.name, old.name]
    with pytest.raises(FileNotFoundError, match=f"missing.*a.{ending}"):
        Functions(F, H, NAMES, NAMES).save(tmp_path / "missing" / f"a.{ending}")
