"""Arrays as SciPy and NumPy save them, under the names that people give them."""

import json
import shutil

import numpy as np
import pytest
import pyuff
import scipy.io
from conftest import POINTS


def save(path, arrays):
    if path.suffix == ".npz":
        np.savez(path, **arrays)
    else:
        scipy.io.savemat(path, {
            name: np.array(value, dtype=object) if isinstance(value, list) else value for name, value in arrays.items()
        })


def usual(demo, **changed):
    """The demo's receptances, frequency first."""
    arrays = {
        "freq": demo.frequency, "H": np.moveaxis(demo.values, 2, 0), "response": POINTS, "reference": POINTS,
        "quantity": "receptance", "unit": "m/N", "axes": "frequency,response,reference",
    }
    arrays.update(changed)
    return {name: value for name, value in arrays.items() if value is not None}


def renamed(arrays, **names):
    return {names.get(name, name): value for name, value in arrays.items()}


NAMES = {
    "frequency and FRF": {"freq": "Frequency", "H": "FRF"},
    "f and H1": {"freq": "f", "H": "H1", "response": "outputs", "reference": "inputs"},
    "freqs and an unknown name": {"freq": "freqs", "H": "measured_in_march"},
    "FREQ_HZ and Receptance": {"freq": "FREQ_HZ", "H": "Receptance", "quantity": None, "axes": "AXES"},
}


@pytest.mark.parametrize("ending", ["npz", "mat"])
@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES)
def test_usual_names_are_the_same_joint(demo, study, run, names, ending):
    expected, _ = study()
    path = study.folder / f"c.{ending}"
    arrays = usual(demo, **{name: None for name, new in names.items() if new is None})
    # beside what is not ours
    arrays["notes"] = "measured in March"
    arrays["temperature"] = np.array([20.5])
    save(path, renamed(arrays, **{name: new for name, new in names.items() if new}))
    found, _ = study(f'frf = "c.{ending}"')
    # pyuff has read all digits of the universal file
    np.testing.assert_allclose(found["joint"]["stiffness"], expected["joint"]["stiffness"], rtol=1e-9)
    shown = json.loads(run("show", "--json", path).stdout)[0]
    assert f"functions from {names['H']}" in shown["facts"]["arrays"][0]
    assert f"frequencies from {names['freq']}" in shown["facts"]["arrays"][0]


@pytest.mark.parametrize("ending", ["npz", "mat"])
def test_coherence_alone(demo, study, run, ending):
    # what is left of ten averages, one of which the function takes
    gamma = np.full(demo.values.shape, 1 / (1 + 9 * 0.01**2))
    path = study.folder / f"coherence.{ending}"
    save(path, usual(demo, H=None, quantity=None, unit=None, coh=np.moveaxis(gamma, 2, 0), n_averages=10))
    found, _ = study(f'frf = "assembly.uff"\ncoherence = "coherence.{ending}"')
    assert 0.9 < found["residual"]["reduced_chi_squared"] < 1.1
    assert "9, and no function" in run("show", path).stdout


@pytest.mark.parametrize("ending", ["npz", "mat"])
def test_what_is_ambiguous_or_missing_is_named(demo, run, tmp_path, ending):
    def refused(arrays, *said):
        path = tmp_path / f"bad.{ending}"
        save(path, arrays)
        done = run("show", path, expect=1)
        for part in (path.name, *said):
            assert part in done.stderr, done.stderr

    arrays = usual(demo)
    refused({**arrays, "FRF": arrays["H"]}, "both ", "H", "FRF", "one of them")
    refused({**arrays, "frequencies": arrays["freq"]}, "both ", "freq", "frequencies")
    others = renamed(arrays, H="march")
    refused({**others, "april": others["march"]}, "several complex arrays", "march", "april", "named frf")
    refused(renamed({**arrays, "H": arrays["H"].real}, H="march"), "found the arrays", "march", "the matrix of functions")
    refused(renamed(arrays, freq="omega"), "omega", "expected frequency (Hz)")
    refused(renamed(arrays, response="nodes"), "nodes", "expected response, degrees of freedom")
    for nameless, found in [(np.array([1, 2, 3]), "numbers"), (np.array([]), "no entry"), (np.array([], "U4"), "no entry")]:
        refused(usual(demo, response=nameless), f"array response: found {found}", '"11:+Y" for each, a node and a direction')
    refused(usual(demo, response=["11", "12", "13"]), "array response, entry 1: ", "NODE:DIRECTION")
    refused(usual(demo, axes=None), "which is either")
    refused(usual(demo, response=["11:+Y", "11:+Y", "12:+Y"]), "twice")
    refused(usual(demo, H=arrays["H"][:-1]), "shape")


def test_fields_of_a_structure_get_the_command_that_frees_them(demo, run, tmp_path):
    path = tmp_path / "structure.mat"
    scipy.io.savemat(path, {"data": {"freq": demo.frequency, "H": demo.values}})
    done = run("show", path, expect=1)
    assert "structure.mat" in done.stderr and "'-struct'" in done.stderr


def test_newer_matlab_files_are_told_how_to_be_saved(run, tmp_path):
    path = tmp_path / "newer.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM" + bytes(384) + b"\x89HDF\r\n\x1a\n")
    done = run("show", path, expect=1)
    for part in ("newer.mat", "HDF5", "'-v7'", "Python module"):
        assert part in done.stderr


def test_numpy_reads_what_respond_computes(demo, run, tmp_path):
    """The archive has the values that pyuff finds in the universal file, to the last digit that one shows."""
    command = ["respond", demo.folder / "study.toml", "--joint", demo.folder / "m10x16.joint.json", "--step", "5"]
    for ending in ("npz", "uff"):
        run(*command, "-o", tmp_path / f"c.{ending}")
    # from 5 to 512 Hz
    with np.load(tmp_path / "c.npz") as archive:
        found = dict(archive)
    assert found["axes"].item() == "frequency,response,reference"
    assert found["quantity"].item() == "receptance"
    assert found["description"].item().startswith(b"computed, not measured: M10x16")
    assert found["response"].tolist() == found["reference"].tolist() == POINTS
    assert found["unit"].tolist() == [["m/N"] * 3] * 3
    functions = [one for one in pyuff.UFF(str(tmp_path / "c.uff")).read_sets() if one["type"] == 58]
    assert len(functions) == 9
    for one in functions:
        np.testing.assert_allclose(found["frequency"], one["x"], rtol=1e-9)
        own = found["frf"][:, one["rsp_node"] - 11, one["ref_node"] - 11]
        np.testing.assert_allclose(own, one["data"], rtol=1e-11)
    # what was computed may be computed anew, into the study that it was computed for
    study = (demo.folder / "study.toml").read_text(encoding="utf-8").replace("assembly.uff", "c.npz")
    for name in ("a-modes.toml", "m10x16.joint.json"):
        shutil.copy(demo.folder / name, tmp_path)
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    again = ["respond", tmp_path / "study.toml", "--joint", tmp_path / "m10x16.joint.json", "-o", tmp_path / "c.npz"]
    run(*again)
    # what was measured may not
    np.savez(tmp_path / "c.npz", **usual(demo))
    assert "it would be lost" in run(*again, expect=1).stderr
    refused = run(*command, "-o", tmp_path / "c.mat", expect=1).stderr
    assert "expected a name that ends in .csv, .uff, .unv or .npz" in refused


MISSPELT = {
    "frequency": ({"freq": "frequncy"}, "found `frequncy`, did you mean `frequency`?"),
    "responses": ({"response": "respnse"}, "found `respnse`, did you mean `response`?"),
    "references": ({"reference": "refernces"}, "found `refernces`, did you mean `references`?"),
}


@pytest.mark.parametrize("ending", ["npz", "mat"])
@pytest.mark.parametrize(("names", "meant"), MISSPELT.values(), ids=MISSPELT)
def test_a_misspelt_name_gets_the_one_that_was_meant(demo, study, names, meant, ending):
    save(study.folder / f"c.{ending}", renamed(usual(demo), **names))
    _, done = study(f'frf = "c.{ending}"', expect=1)
    assert done.stderr.rstrip().endswith(meant)


OPTIONAL = {
    "quantity": ("quantitiy", "receptance"),
    "unit": ("uint", "m/N"),
    "axes": ("axis", "response,reference,frequency"),
    "averages": ("avarages", 10.0),
    "coherence": ("coherance", None),
}


@pytest.mark.parametrize("ending", ["npz", "mat"])
@pytest.mark.parametrize(("meant", "own"), OPTIONAL.items(), ids=OPTIONAL)
def test_a_misspelt_array_that_may_be_left_out_is_told(demo, study, meant, own, ending):
    """Without a word the functions would be another quantity, in other units, or have another noise."""
    name, value = own
    arrays = usual(demo)
    arrays.pop(meant, None)
    arrays[name] = np.ones(arrays["H"].shape) if value is None else value
    save(study.folder / f"c.{ending}", arrays)
    _, done = study(f'frf = "c.{ending}"\nquantity = "receptance"', expect=1)
    assert f"array {name}: " in done.stderr and f"did you mean `{meant}`?" in done.stderr


@pytest.mark.parametrize("ending", ["npz", "mat"])
def test_arrays_of_other_kinds_may_have_any_name(demo, study, ending):
    # near names, but no text, no number and no matrix of this size
    others = {"quantities": np.ones(3), "average": np.ones(2), "coherances": np.ones(4), "date": "May", "unity": np.eye(2)}
    save(study.folder / f"c.{ending}", usual(demo, quantity=None, unit=None) | others)
    study(f'frf = "c.{ending}"\nquantity = "receptance"')


def test_a_misspelt_quantity_gets_the_one_that_was_meant(demo, study):
    save(study.folder / "c.npz", usual(demo, quantity="receptence"))
    _, done = study('frf = "c.npz"', expect=1)
    assert 'array quantity: found "receptence"' in done.stderr and "did you mean `receptance`?" in done.stderr
