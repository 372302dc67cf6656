"""Frequency response functions as arrays."""

import io
import os
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._archive import unit
from ._command import BoltedJointError, native, path_of
from ._html import table
from ._values import array_of, limit, listed, number, one_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Each is the one before it, differentiated by time.
QUANTITIES = ("receptance", "mobility", "accelerance")

#: What coherence may be below 0 or above 1 by rounding, as files have it.
_ROUNDING = 1e-5

#: A node, and a direction as all files have it: a scalar has no sign.
_DOF = re.compile(r"\s*[0-9]{1,10}:([+-]?R?[XYZ]|0)\s*", re.IGNORECASE | re.ASCII)


class Functions:
    """Frequency response functions of one structure, on one frequency axis.

    Arrays are copied. What is made of functions takes it that they are not changed afterwards.

    Parameters
    ----------
    frequency_hz : array of shape (F,)
        Frequencies, Hz, from 0 on and increasing.
    values : complex array of shape (F, R, P)
        The functions: frequency, response, reference. An axis of length 1 may be missing. NaN on all lines: not
        measured. Masked entries become NaN.
    responses : sequence of R str
        DOFs of the responses, such as ``"11:+Y"``, each once.
    references : sequence of P str
        DOFs of the references, where the structure is loaded.
    quantity : {"receptance", "mobility", "accelerance"}
        What is measured per load: displacement (m/N), velocity (m/(s·N)) or acceleration (m/(s²·N)); rad and N·m
        likewise.
    coherence : array of the shape of values, optional
        Ordinary coherence γ². NaN on all lines of a function: not known.
    averages : float, optional
        Averages behind every function, 1 or more.

    Attributes
    ----------
    magnitude_deviation : array of the shape of values, or None
        Standard deviations of the magnitudes, where `respond` was asked for them.

    Raises
    ------
    BoltedJointError
        If frequencies do not increase, DOFs are not such as ``"11:+Y"`` or stand there twice, values are not finite on
        some lines of a function only, the shapes do not fit, or averages are no number from 1 on.
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
        self.frequency_hz: NDArray[np.float64] = lines_of("frequency_hz", frequency_hz)
        self.responses: tuple[str, ...] = _names("responses", responses)
        self.references: tuple[str, ...] = _names("references", references)
        _known_quantity(quantity)
        self.quantity = quantity
        shape = (len(self.frequency_hz), len(self.responses), len(self.references))
        self.values: NDArray[np.complex128] = _shaped("values", _unmasked("values", values, np.complex128), shape)
        self.coherence: NDArray[np.float64] | None = (
            None if coherence is None else _shaped("coherence", _unmasked("coherence", coherence, np.float64), shape)
        )
        self.averages: float | None = None if averages is None else number("averages", averages, 1.0)
        self._want_numbers()
        self.magnitude_deviation: NDArray[np.float64] | None = None

    def _want_numbers(self) -> None:
        """Refuses values that no file may have, in words of the arrays: a file would be named that nobody knows of."""
        wrong = ~np.isfinite(self.values) & (self.measured | np.isinf(self.values).any(axis=0))
        for line, row, column in np.argwhere(wrong)[:1]:
            raise BoltedJointError(
                f"values: found {self.values[line, row, column]} at line {line} ({self.frequency_hz[line]:g} Hz) of "
                f"{self.responses[row]}/{self.references[column]}, expected finite numbers, or NaN on all lines of a "
                "function that was not measured; leave the line out of all arrays"
            )
        coherence = np.full((0, 0, 0), np.nan) if self.coherence is None else self.coherence
        some = np.isnan(coherence).any(axis=0) & ~np.isnan(coherence).all(axis=0)
        for row, column in np.argwhere(some)[:1]:
            raise BoltedJointError(
                f"coherence: found NaN at some lines of {self.responses[row]}/{self.references[column]}, expected γ² from 0 to 1, "
                "or NaN on all lines of a function without it"
            )
        for line, row, column in np.argwhere((coherence < -_ROUNDING) | (coherence > 1.0 + _ROUNDING))[:1]:
            raise BoltedJointError(
                f"coherence: found {coherence[line, row, column]} at line {line} ({self.frequency_hz[line]:g} Hz) of "
                f"{self.responses[row]}/{self.references[column]}, expected γ² from 0 to 1"
            )

    def __len__(self) -> int:
        """How many functions there are."""
        return int(self.measured.sum())

    def __iter__(self) -> Iterator[tuple[str, str]]:
        """Response and reference of each function that was measured."""
        return iter(self.keys())

    def __contains__(self, pair: object) -> bool:
        """Whether a function was measured, by its response and its reference."""
        return pair in self.keys()

    def keys(self) -> tuple[tuple[str, str], ...]:
        """Response and reference of each function that was measured."""
        return tuple((self.responses[row], self.references[column]) for row, column in np.argwhere(self.measured))

    def __getitem__(self, pair: tuple[str, str] | str) -> NDArray[np.complex128]:
        """One function over frequency, by its response and its reference: ``["11:+Y", "2:+Y"]``."""
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise BoltedJointError(f'found {pair!r}, expected a response and a reference such as ["11:+Y", "2:+Y"]')
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
        responses: Sequence[str] | str | None = None,
        references: Sequence[str] | str | None = None,
        from_hz: float | None = None,
        to_hz: float | None = None,
    ) -> "Functions":
        """Some of the functions, on some of the lines.

        Parameters
        ----------
        responses, references : sequence of str, or str
            Their DOFs, or one DOF; all if they are left out.
        from_hz, to_hz : float, optional
            First and last frequency, Hz; no limit where one is left out or None.

        Raises
        ------
        BoltedJointError
            If there is no such DOF, or a limit is no number.
        """
        responses = self.responses if responses is None else listed("responses", responses)
        references = self.references if references is None else listed("references", references)
        first, last = limit("from_hz", from_hz, -np.inf), limit("to_hz", to_hz, np.inf)
        lines = (self.frequency_hz >= first) & (self.frequency_hz <= last)
        rows = np.array([_index(self.responses, name) for name in responses], dtype=np.intp)
        columns = np.array([_index(self.references, name) for name in references], dtype=np.intp)
        part = np.ix_(np.flatnonzero(lines), rows, columns)
        found = Functions(
            self.frequency_hz[lines],
            self.values[part],
            [self.responses[row] for row in rows],
            [self.references[column] for column in columns],
            quantity=self.quantity,
            coherence=None if self.coherence is None else self.coherence[part],
            averages=self.averages,
        )
        if self.magnitude_deviation is not None:
            found.magnitude_deviation = self.magnitude_deviation[part]
        return found

    def as_quantity(self, quantity: str) -> "Functions":
        """The same functions as another quantity.

        Parameters
        ----------
        quantity : {"receptance", "mobility", "accelerance"}
            What is asked for. A line at 0 Hz is left out where that divides by the frequency.
        """
        _known_quantity(quantity)
        power = QUANTITIES.index(quantity) - QUANTITIES.index(self.quantity)
        if power == 0:
            return self
        lines = self.frequency_hz > 0.0 if power < 0 else np.full(self.frequency_hz.shape, True)
        differentiated = (2j * np.pi * self.frequency_hz[lines]) ** power
        found = self._with(self.values[lines] * differentiated[:, None, None], lines=lines, quantity=quantity)
        if self.magnitude_deviation is not None:
            found.magnitude_deviation = self.magnitude_deviation[lines] * np.abs(differentiated)[:, None, None]
        return found

    def _with(
        self, values: NDArray[np.complex128], *, lines: NDArray[np.bool_] | None = None, quantity: str | None = None
    ) -> "Functions":
        """These functions with other values, on some of the lines."""
        of = slice(None) if lines is None else lines
        return Functions(
            self.frequency_hz[of],
            values,
            self.responses,
            self.references,
            quantity=quantity or self.quantity,
            coherence=None if self.coherence is None else self.coherence[of],
            averages=self.averages,
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a file that the command line reads: a NumPy archive (``.npz``), or a table (``.csv``).

        It is written whole or not at all. Both kinds state SI units. An archive has `magnitude_deviation` too, for `read` alone.

        Parameters
        ----------
        path : path
            The file to write; its ending says which kind.

        Raises
        ------
        BoltedJointError
            If the path ends otherwise, if there is no function, or if some function between the responses and the
            references was not measured, for which an archive has no word.
        """
        path_of(path)
        ending = os.path.splitext(path)[1].lower()
        if ending not in (".npz", ".csv"):
            raise BoltedJointError(
                f"{os.fspath(path)}: found the ending {ending!r}, expected .npz (NumPy archive) or .csv (table)"
            )
        if not self.measured.any():
            found = f"{len(self.frequency_hz)} lines, none of a function that was measured"
            raise BoltedJointError(f"functions: found {found}, expected one function on one line at least")
        if ending == ".csv":
            self._save_table(path)
            return
        for row, column in np.argwhere(~self.measured):
            raise BoltedJointError(
                f"functions: {self.responses[row]}/{self.references[column]} was not measured, expected a function "
                "for each response and reference; a name that ends in .csv writes a table, which may leave some out"
            )
        if self.coherence is not None and np.isnan(self.coherence).any():
            raise BoltedJointError(
                "functions: found coherence for some of them only, expected it for all; a name that ends in .csv writes a "
                "table, which may leave some out"
            )
        arrays: dict[str, Any] = {
            "frequency": self.frequency_hz,
            "frf": self.values,
            "response": list(self.responses),
            "reference": list(self.references),
            "axes": "frequency,response,reference",
            "quantity": self.quantity,
            "units": [[unit(self.quantity, *pair) for pair in row] for row in self._pairs()],
        }
        if self.magnitude_deviation is not None:
            arrays["magnitude_deviation"] = self.magnitude_deviation
        if self.coherence is not None:
            arrays["coherence"] = self.coherence
        if self.averages is not None:
            arrays["averages"] = self.averages
        archive = io.BytesIO()
        np.savez(archive, **arrays)
        native(_native.write_file, path, archive.getvalue())

    def _pairs(self) -> list[list[tuple[str, str]]]:
        return [[(response, reference) for reference in self.references] for response in self.responses]

    def _save_table(self, path: str | os.PathLike[str]) -> None:
        """A table of those functions that were measured; 17 digits tell every number to the bit."""
        names, columns = ["frequency [Hz]"], [self.frequency_hz]
        for row, column in np.argwhere(self.measured):
            pair = f"{self.responses[row]}/{self.references[column]}"
            values = self.values[:, row, column]
            label = unit(self.quantity, self.responses[row], self.references[column])
            names += [f"{pair} real [{label}]", f"{pair} imaginary [{label}]"]
            columns += [values.real, values.imag]
            if self.coherence is not None and not np.isnan(self.coherence[:, row, column]).all():
                names.append(f"{pair} coherence")
                columns.append(self.coherence[:, row, column])
        comments = [f"# quantity = {self.quantity}"]
        if self.averages is not None:
            comments.append(f"# averages = {self.averages!r}")
        head = "\n".join([*comments, ",".join(names)])
        table = np.column_stack(columns)
        text = io.StringIO()
        np.savetxt(text, table, fmt="%.17g", delimiter=",", header=head, comments="")
        native(_native.write_file, path, text.getvalue().encode())

    def plot(self, *, most: int = 6) -> "Figure":
        """Draws magnitude and phase over frequency.

        Parameters
        ----------
        most : int
            At most so many functions are drawn, the strongest ones.

        Returns
        -------
        matplotlib.figure.Figure
            A figure that pyplot does not keep.
        """
        from . import _plot

        return _plot.functions({"": self}, most)

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


def _known_quantity(quantity: str) -> None:
    one_of("quantity", quantity, QUANTITIES)


def _names(argument: str, names: Sequence[str]) -> tuple[str, ...]:
    if isinstance(names, str):
        raise BoltedJointError(f'{argument}: found the text {names!r}, expected a list of DOFs such as ["11:+Y"]')
    try:
        # those of NumPy become Python's
        found = tuple(str(name) if isinstance(name, str) else name for name in names)
    except TypeError:
        raise BoltedJointError(f'{argument}: found {names!r}, expected a list of DOFs such as ["11:+Y"]') from None
    known = set()
    for name in found:
        if not isinstance(name, str) or not _DOF.fullmatch(name):
            raise BoltedJointError(
                f'{argument}: found {name!r}, expected NODE:DIRECTION such as "11:+Y": a number, and X, Y, Z, RX, RY '
                "or RZ with its sign"
            )
        dof = _dof(name)
        if dof in known:
            raise BoltedJointError(f"{argument}: found {name!r} twice, expected each DOF once")
        known.add(dof)
    return found


def lines_of(argument: str, frequency_hz: ArrayLike) -> NDArray[np.float64]:
    """Frequencies of lines in an array of their own, Hz.

    Raises
    ------
    BoltedJointError
        With the argument's name, where they are no finite numbers from 0 on that increase.
    """
    if np.ma.is_masked(frequency_hz):
        raise BoltedJointError(f"{argument}: found masked entries, expected a number for each line")
    found = array_of(argument, frequency_hz, np.float64)
    if found.ndim != 1:
        raise BoltedJointError(f"{argument}: found an array of shape {found.shape}, expected one axis")
    for line in np.flatnonzero(~(np.isfinite(found) & (found >= 0.0)))[:1]:
        raise BoltedJointError(
            f"{argument}: found {found[line]} at line {line}, expected finite frequencies in Hz from 0 on"
        )
    for line in np.flatnonzero(np.diff(found) <= 0.0)[:1] + 1:
        raise BoltedJointError(
            f"{argument}: found {found[line]:.17g} at line {line} after {found[line - 1]:.17g}, expected frequencies "
            "that increase; sort the lines of all arrays, such as by numpy.unique(frequency_hz, return_index=True)[1]"
        )
    return found


def _dof(name: str) -> tuple[int, str]:
    """Node and direction of a DOF, however it is written: 2:y is 2:+Y."""
    node, direction = name.strip().upper().split(":")
    return int(node), direction.removeprefix("+")


def _index(names: tuple[str, ...], name: str) -> int:
    if isinstance(name, str) and _DOF.fullmatch(name):
        for place, known in enumerate(names):
            if _dof(known) == _dof(name):
                return place
    raise BoltedJointError(f"found {name!r}, expected one of {', '.join(names)}")


def _unmasked(argument: str, values: ArrayLike, kind: Any) -> NDArray[Any]:
    """Values in an array of their own, with NaN where they are masked."""
    found = array_of(argument, values, kind)
    if isinstance(values, np.ma.MaskedArray):
        found[np.ma.getmaskarray(values)] = np.nan
    return found


def _shaped(argument: str, array: NDArray[Any], shape: tuple[int, int, int]) -> NDArray[Any]:
    """The array with all three axes, where only axes of length 1 are missing."""
    squeezed = tuple(length for length in shape if length != 1)
    if array.shape == shape:
        return array
    if tuple(length for length in array.shape if length != 1) == squeezed:
        return array.reshape(shape)
    wanted = f"{argument}: found an array of shape {array.shape}, expected {shape}: lines, responses, references"
    named = "; responses and references need a name for each, such as \"11:+Y\"" if array.shape[:1] == shape[:1] else ""
    raise BoltedJointError(wanted + named)
