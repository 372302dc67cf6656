"""Frequency response functions as arrays."""

import contextlib
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _matlab73, _native
from ._command import BoltedJointError
from ._html import table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_QUANTITIES = ("receptance", "mobility", "accelerance")


class Functions:
    """Frequency response functions of one structure, on one frequency axis.

    Parameters
    ----------
    frequency_hz : array of shape (F,)
        Frequencies, Hz, increasing.
    values : complex array of shape (F, R, P)
        The functions: frequency, response, reference. An axis of length 1 may be missing. NaN on all lines: not
        measured.
    responses : sequence of R str
        DOFs of the responses, such as ``"11:+Y"``.
    references : sequence of P str
        DOFs of the references, where the structure is loaded.
    quantity : {"receptance", "mobility", "accelerance"}
        What is measured per load: displacement (m/N), velocity (m/(s·N)) or acceleration (m/(s²·N)); rad and N·m
        likewise.
    coherence : array of the shape of values, optional
        Ordinary coherence γ².
    averages : float, optional
        Averages behind every function.

    Raises
    ------
    BoltedJointError
        If the shapes do not fit.
    """

    def __init__(
        self,
        frequency_hz: ArrayLike,
        values: ArrayLike,
        responses: Sequence[str],
        references: Sequence[str],
        *,
        quantity: str = "receptance",
        coherence: ArrayLike | None = None,
        averages: float | None = None,
    ):
        self.frequency_hz: NDArray[np.float64] = np.asarray(frequency_hz, dtype=np.float64)
        self.responses: tuple[str, ...] = _names("responses", responses)
        self.references: tuple[str, ...] = _names("references", references)
        if quantity not in _QUANTITIES:
            raise BoltedJointError(f"quantity: found {quantity!r}, expected one of {', '.join(_QUANTITIES)}")
        self.quantity = quantity
        if self.frequency_hz.ndim != 1:
            raise BoltedJointError(
                f"frequency_hz: found an array of shape {self.frequency_hz.shape}, expected one axis"
            )
        shape = (len(self.frequency_hz), len(self.responses), len(self.references))
        self.values: NDArray[np.complex128] = _shaped("values", np.asarray(values, dtype=np.complex128), shape)
        self.coherence: NDArray[np.float64] | None = (
            None if coherence is None else _shaped("coherence", np.asarray(coherence, dtype=np.float64), shape)
        )
        self.averages = averages

    def __len__(self) -> int:
        """How many functions there are."""
        return int(self.measured.sum())

    def __getitem__(self, pair: tuple[str, str]) -> NDArray[np.complex128]:
        """One function over frequency, by its response and its reference."""
        response, reference = pair
        return self.values[:, _index(self.responses, response), _index(self.references, reference)]

    def __repr__(self) -> str:
        return f"<Functions: {len(self)} of {self.quantity}, {len(self.frequency_hz)} lines {self._range()}>"

    @property
    def measured(self) -> NDArray[np.bool_]:
        """Which functions there are: array of shape (R, P)."""
        missing: NDArray[np.bool_] = np.asarray(np.isnan(self.values).all(axis=0))
        return np.logical_not(missing)

    def select(
        self,
        responses: Sequence[str] | None = None,
        references: Sequence[str] | None = None,
        from_hz: float = 0.0,
        to_hz: float = np.inf,
    ) -> "Functions":
        """Some of the functions, on some of the lines."""
        responses = self.responses if responses is None else tuple(responses)
        references = self.references if references is None else tuple(references)
        lines = (self.frequency_hz >= from_hz) & (self.frequency_hz <= to_hz)
        rows = np.array([_index(self.responses, name) for name in responses], dtype=np.intp)
        columns = np.array([_index(self.references, name) for name in references], dtype=np.intp)
        part = np.ix_(np.flatnonzero(lines), rows, columns)
        return Functions(
            self.frequency_hz[lines],
            self.values[part],
            responses,
            references,
            quantity=self.quantity,
            coherence=None if self.coherence is None else self.coherence[part],
            averages=self.averages,
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a file that the command line reads: a NumPy archive (``.npz``), or a table (``.csv``).

        Raises
        ------
        BoltedJointError
            If some function between the responses and the references was not measured, for which an archive has no word.
        """
        if os.fspath(path).endswith(".csv"):
            self._save_table(path)
            return
        for row, column in np.argwhere(~self.measured):
            raise BoltedJointError(
                f"functions: {self.responses[row]}/{self.references[column]} was not measured, expected a function "
                "for each response and reference; a name that ends in .csv writes a table, which may leave some out"
            )
        arrays: dict[str, Any] = {
            "frequency": self.frequency_hz,
            "frf": self.values,
            "response": list(self.responses),
            "reference": list(self.references),
            "axes": "frequency,response,reference",
            "quantity": self.quantity,
        }
        if self.coherence is not None:
            arrays["coherence"] = self.coherence
        if self.averages is not None:
            arrays["averages"] = self.averages
        with open(path, "wb") as file:
            np.savez(file, **arrays)

    def _save_table(self, path: str | os.PathLike[str]) -> None:
        """A table of those functions that were measured; 17 digits tell every number to the bit."""
        names, columns = ["frequency [Hz]"], [self.frequency_hz]
        for row, column in np.argwhere(self.measured):
            pair = f"{self.responses[row]}/{self.references[column]}"
            values = self.values[:, row, column]
            names += [f"{pair} real", f"{pair} imaginary"]
            columns += [values.real, values.imag]
            if self.coherence is not None:
                names.append(f"{pair} coherence")
                columns.append(self.coherence[:, row, column])
        comments = [f"# quantity = {self.quantity}"]
        if self.averages is not None:
            comments.append(f"# averages = {self.averages!r}")
        head = "\n".join([*comments, ",".join(names)])
        np.savetxt(path, np.column_stack(columns), fmt="%.17g", delimiter=",", header=head, comments="", encoding="utf-8")

    def plot(self, **options: Any) -> "Figure":
        """Draws magnitude and phase over frequency; see `bolted_joint._plot.functions`."""
        from . import _plot

        return _plot.functions({"": self}, **options)

    def _range(self) -> str:
        return f"{self.frequency_hz[0]:g} to {self.frequency_hz[-1]:g} Hz" if len(self.frequency_hz) else ""

    def _repr_html_(self) -> str:
        rows = [
            (
                f"{self.responses[row]}/{self.references[column]}",
                f"{np.abs(self.values[:, row, column]).max():.4g}",
                f"{self.frequency_hz[np.abs(self.values[:, row, column]).argmax()]:g}",
            )
            for row, column in np.argwhere(self.measured)
        ]
        return table(
            f"{len(self)} functions, {len(self.frequency_hz)} lines {self._range()}",
            ("response/reference", f"highest {self.quantity}", "at, Hz"),
            rows,
        )


def read(
    path: str | os.PathLike[str], *, quantity: str | None = None, averages: float | None = None
) -> Functions:
    """Reads a file of frequency response functions: universal file, table, NumPy archive or MATLAB file.

    MATLAB files of ``-v7.3`` (HDF5) are read where h5py is installed.

    Parameters
    ----------
    path : path
        The file.
    quantity : {"receptance", "mobility", "accelerance"}, optional
        Takes the place of what the file says or leaves open.
    averages : float, optional
        Averages behind every function, where the file does not state them.

    Returns
    -------
    Functions
        Receptances in SI units.

    Raises
    ------
    BoltedJointError
        With file, line or key for what cannot be read.

    Warns
    -----
    UserWarning
        If the file states no units: SI is assumed.
    """
    import warnings

    with _matlab73.archive(path) if _matlab73.is_one(path) else contextlib.nullcontext(path) as source:
        try:
            curves, coherences, stated, has_units = _native.read_functions(source, quantity, averages)
        except ValueError as error:
            raise BoltedJointError(str(error).replace(os.fspath(source), os.fspath(path))) from error
    if not has_units:
        warnings.warn(f"{os.fspath(path)}: the file states no units; SI is assumed", stacklevel=2)
    if not curves:
        raise BoltedJointError(f"{os.fspath(path)}: found no function, expected at least one")
    frequency_hz = np.frombuffer(curves[0][2])
    responses = list(dict.fromkeys(curve[0] for curve in curves))
    references = list(dict.fromkeys(curve[1] for curve in curves))
    shape = (len(frequency_hz), len(responses), len(references))
    values = np.full(shape, np.nan, dtype=np.complex128)
    for response, reference, axis, numbers in curves:
        if not np.array_equal(np.frombuffer(axis), frequency_hz):
            raise BoltedJointError(
                f"{os.fspath(path)}: found other lines of {response}/{reference} than of "
                f"{curves[0][0]}/{curves[0][1]}, expected one frequency axis"
            )
        place = (slice(None), responses.index(response), references.index(reference))
        values[place] = np.frombuffer(numbers, dtype=np.complex128)
    coherence = None
    if coherences:
        coherence = np.full(shape, np.nan)
        for response, reference, axis, numbers in coherences:
            known = response in responses and reference in references
            if known and np.array_equal(np.frombuffer(axis), frequency_hz):
                place = (slice(None), responses.index(response), references.index(reference))
                coherence[place] = np.frombuffer(numbers)
    return Functions(frequency_hz, values, responses, references, coherence=coherence, averages=stated)


def _names(argument: str, names: Sequence[str]) -> tuple[str, ...]:
    if isinstance(names, str):
        raise BoltedJointError(f'{argument}: found the text {names!r}, expected a list of DOFs such as ["11:+Y"]')
    return tuple(names)


def _index(names: tuple[str, ...], name: str) -> int:
    try:
        return names.index(name)
    except ValueError:
        raise BoltedJointError(f"found {name!r}, expected one of {', '.join(names)}") from None


def _shaped(argument: str, array: NDArray[Any], shape: tuple[int, int, int]) -> NDArray[Any]:
    """The array with all three axes, where only axes of length 1 are missing."""
    squeezed = tuple(length for length in shape if length != 1)
    if array.shape == shape:
        return array
    if tuple(length for length in array.shape if length != 1) == squeezed:
        return array.reshape(shape)
    raise BoltedJointError(
        f"{argument}: found an array of shape {array.shape}, expected {shape}: lines, responses, references"
    )
