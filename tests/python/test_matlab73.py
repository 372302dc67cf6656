"""Files of MATLAB's -v7.3 as `hdf5storage`, which others wrote, makes them."""

import sys

import numpy as np
import pytest

import bolted_joint

pytestmark = pytest.mark.filterwarnings("ignore:.*states no units")
FREQUENCY = np.array([10.0, 20.0, 30.0, 40.0])
RESPONSES, REFERENCES = ["11:+Y", "12:-Y", "13:+RZ"], ["2:+Y", "3:+Y"]
# every element another number, so that an exchange of axes is seen
VALUES = (1 + np.arange(24).reshape(3, 2, 4)) * (1e-6 - 2e-7j)


def written(path, **changed):
    hdf5storage = pytest.importorskip("hdf5storage", reason="hdf5storage is not installed")
    arrays = {
        "frequency": FREQUENCY, "frf": VALUES, "quantity": "receptance", "averages": 10.0,
        "response": np.array(RESPONSES, dtype=object), "reference": np.array(REFERENCES, dtype=object),
    }
    arrays.update(changed)
    # it adds to a file that is there
    path.unlink(missing_ok=True)
    hdf5storage.writes({k: v for k, v in arrays.items() if v is not None}, filename=str(path), matlab_compatible=True)
    assert path.read_bytes()[:10] == b"MATLAB 7.3"
    return path


def test_functions_are_those_that_were_saved(tmp_path):
    found = bolted_joint.read(written(tmp_path / "c.mat", notes="in March", structure={"a": 1.0}))
    assert found.responses == tuple(RESPONSES) and found.references == tuple(REFERENCES)
    np.testing.assert_array_equal(found.frequency_hz, FREQUENCY)
    np.testing.assert_array_equal(found.values, np.moveaxis(VALUES, 2, 0))
    assert found.averages == 10


def test_rows_of_characters_and_one_reference(tmp_path):
    path = written(tmp_path / "c.mat", frf=VALUES[:, :1], reference="2:+Y", quantity="accelerance")
    found = bolted_joint.read(path)
    omega = 2 * np.pi * FREQUENCY
    np.testing.assert_allclose(found["12:-Y", "2:+Y"], -VALUES[1, 0] / omega**2, rtol=1e-14)


def test_arrays_of_h5py_keep_their_axes(tmp_path):
    """A file that MATLAB has not written, with plain texts."""
    h5py = pytest.importorskip("h5py", reason="h5py is not installed")
    square = np.moveaxis(VALUES, 2, 0)[:, :2]
    with h5py.File(tmp_path / "c.h5", "w") as file:
        file["frequency"], file["frf"] = FREQUENCY, square
        file["response"], file["reference"] = RESPONSES[:2], REFERENCES
        file["axes"], file["quantity"] = "frequency,response,reference", "receptance"
    found = bolted_joint.read(tmp_path / "c.h5")
    np.testing.assert_array_equal(found.values, square)


def test_what_is_wrong_is_told_with_the_files_own_name(tmp_path):
    for changed, said in [
        ({"frf": None}, "expected frf"), ({"quantity": None}, "neither a quantity nor a unit"), ({"frf": VALUES[:2]}, "shape"),
        ({"response": np.array(["11:+Y", "12", "13:+Y"], dtype=object)}, "12"),
    ]:
        with pytest.raises(bolted_joint.BoltedJointError, match=said) as refused:
            bolted_joint.read(written(tmp_path / "wrong.mat", **changed))
        assert "wrong.mat" in str(refused.value) and "arrays.npz" not in str(refused.value)
    path = written(tmp_path / "cut.mat")
    path.write_bytes(path.read_bytes()[:1500])
    with pytest.raises(bolted_joint.BoltedJointError, match=r"cut\.mat: a damaged HDF5 file"):
        bolted_joint.read(path)


def test_without_h5py_it_says_what_to_install(tmp_path, monkeypatch):
    path = tmp_path / "c.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(512) + b"\x89HDF\r\n\x1a\n")
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(bolted_joint.BoltedJointError, match="c.mat.*pip install h5py"):
        bolted_joint.read(path)
