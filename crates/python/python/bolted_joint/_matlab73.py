"""Files of MATLAB's ``save -v7.3``, which are HDF5: read by h5py, and handed on as an archive of the same arrays."""

import contextlib
import importlib
import os
import pathlib
import tempfile
from collections.abc import Iterator
from typing import Any

import numpy as np

from ._command import BoltedJointError

_HDF5 = b"\x89HDF\r\n\x1a\n"
# MATLAB writes 512 bytes of its own before the HDF5 file; other programs write none
_OFFSETS = (0, 512)


def is_one(path: str | os.PathLike[str]) -> bool:
    """Whether a file is HDF5."""
    try:
        with open(path, "rb") as file:
            beginning = file.read(max(_OFFSETS) + len(_HDF5))
    except OSError:
        return False
    return any(beginning[offset : offset + len(_HDF5)] == _HDF5 for offset in _OFFSETS)


@contextlib.contextmanager
def archive(path: str | os.PathLike[str]) -> Iterator[pathlib.Path]:
    """The arrays of a file as a NumPy archive, as long as the block runs; DOFs and matrices keep their names."""
    try:
        # by name, since its types are not known to those who check ours
        h5py: Any = importlib.import_module("h5py")
    except ImportError:
        raise BoltedJointError(
            f"{os.fspath(path)}: a MATLAB file of -v7.3 (HDF5) needs h5py: pip install h5py; or save it in MATLAB with '-v7'"
        ) from None
    try:
        with h5py.File(path, "r") as file:
            arrays = {name: _array(file, item) for name, item in file.items() if isinstance(item, h5py.Dataset)}
    except OSError as error:
        raise BoltedJointError(f"{os.fspath(path)}: a damaged HDF5 file ({error}); save or copy it again") from error
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "arrays.npz"
        np.savez(target, **{name: array for name, array in arrays.items() if array is not None})
        yield target


def _array(file: Any, item: Any) -> Any:
    """One array as MATLAB shows it: texts, numbers, or cells of texts; nothing where it is of another kind."""
    if item.attrs.get("MATLAB_empty", 0):
        return None
    kind = item.attrs.get("MATLAB_class", b"")
    kind = kind.decode() if isinstance(kind, bytes) else str(kind)
    value = item[()]
    if kind == "cell":
        texts = [_text(file[reference]) for reference in np.ravel(value, order="F")]
        return None if None in texts else np.array(texts)
    if kind == "char":
        return np.array(_rows(value))
    if not kind:
        return _of_others(value)
    if getattr(value, "dtype", None) is None or value.dtype.kind in "OSV" and value.dtype.names != ("real", "imag"):
        return None
    if value.dtype.names == ("real", "imag"):
        value = value["real"] + 1j * value["imag"]
    # HDF5 has the axes of a matrix in the opposite order
    return np.squeeze(np.transpose(value))


def _of_others(value: Any) -> Any:
    """An array that no MATLAB has written, such as h5py's: axes in their own order, texts as such; else as above."""
    found = np.asarray(value)
    if found.dtype.names == ("real", "imag"):
        return found["real"] + 1j * found["imag"]
    if found.dtype.kind in "OSU":
        texts = [one.decode() if isinstance(one, bytes) else one for one in found.ravel().tolist()]
        is_text = all(isinstance(one, str) for one in texts)
        return np.array(texts).reshape(found.shape) if is_text else None
    return None if found.dtype.kind == "V" else found


def _rows(value: Any) -> list[str]:
    """A matrix of characters as one text for each row; HDF5 has a column for each."""
    characters = np.atleast_2d(np.asarray(value))
    return ["".join(map(chr, column)).strip() for column in characters.T]


def _text(item: Any) -> str | None:
    if item.attrs.get("MATLAB_class", b"char") not in (b"char", "char"):
        return None
    return _rows(item[()])[0]
