"""`read`: files of frequency response functions as arrays."""

import contextlib
import os
import re
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _archive, _matlab73, _native
from ._command import BoltedJointError, native, path_of, run
from ._functions import QUANTITIES, Functions
from ._values import number, one_of

#: SI units in one unit, by the names that studies and files have for them.
_LENGTHS = {
    **dict.fromkeys(("m", "M"), 1.0),
    **dict.fromkeys(("cm", "CM"), 1e-2),
    **dict.fromkeys(("mm", "MM"), 1e-3),
    **dict.fromkeys(("um", "µm", "μm"), 1e-6),
    **dict.fromkeys(("in", "inch", "IN"), 0.0254),
    **dict.fromkeys(("ft", "FT"), 0.3048),
    "mil": 2.54e-5,
}
_FORCES = {
    **dict.fromkeys(("N", "n"), 1.0),
    **dict.fromkeys(("kN", "KN"), 1e3),
    "mN": 1e-3,
    **dict.fromkeys(("lbf", "lb", "LBF", "LB"), 0.45359237 * 9.80665),
    **dict.fromkeys(("kgf", "KGF"), 9.80665),
}


def read(
    path: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    quantity: str | None = None,
    averages: float | None = None,
    units: Mapping[str, str] | None = None,
    coherence: str | os.PathLike[str] | Iterable[str | os.PathLike[str]] | None = None,
) -> Functions:
    """Reads frequency response functions: universal files, tables, NumPy archives or MATLAB files.

    MATLAB files of ``-v7.3`` (HDF5) are read where h5py is installed.

    Parameters
    ----------
    path : path, or list of paths
        The file; or several, such as one for each reference, with the same lines and other functions.
    quantity : {"receptance", "mobility", "accelerance"}, optional
        Takes the place of what the files say or leave open.
    averages : float, optional
        Averages behind every function, where the files do not state them.
    units : mapping, optional
        Units of the functions, such as ``{"length": "mm", "force": "N"}``; takes the place of what the files say or
        leave open.
    coherence : path, or list of paths, optional
        Files with the coherence of these functions.

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
        If a file states no units and `units` is left out: SI is assumed.
    """
    paths = _paths("path", path)
    beside = [] if coherence is None else _paths("coherence", coherence)
    return together(paths, quantity=quantity, averages=averages, units=units, coherence=beside)


def together(
    sources: Sequence[Functions | str | os.PathLike[str]],
    *,
    quantity: str | None = None,
    averages: float | None = None,
    units: Mapping[str, str] | None = None,
    coherence: Sequence[str | os.PathLike[str]] = (),
    is_quiet: bool = False,
) -> Functions:
    """As `read`, of files and of functions that are arrays already; of units that are not stated it may be quiet."""
    factors = None if units is None else unit_factors(units)
    quantity = None if quantity is None else one_of("quantity", quantity, QUANTITIES)
    averages = None if averages is None else number("averages", averages, 1.0)
    curves: list[_Curve] = []
    coherences: list[_Curve] = []
    stated = averages
    for source in sources:
        if isinstance(source, Functions):
            found = _curves_of(source, quantity, factors)
        else:
            found = _curves(source, quantity, averages, factors)
            if not (found.units_are_stated or is_quiet):
                message = f"{os.fspath(source)}: the file states no units; SI is assumed"
                warnings.warn(message, stacklevel=3)
            if not found.functions:
                raise BoltedJointError(f"{os.fspath(source)}: found no function, expected at least one")
        curves += found.functions
        coherences += found.coherences
        stated = _one_number(stated, found.averages, averages, source)
    for path in coherence:
        found = _curves(path, quantity, averages, None)
        if not found.coherences:
            raise BoltedJointError(f"{os.fspath(path)}: found no coherence, expected at least one")
        known = {_unsigned(*curve[:2]) for curve in curves}
        if not any(_unsigned(*curve[:2]) in known for curve in found.coherences):
            of = "/".join(found.coherences[0][:2])
            raise BoltedJointError(
                f"{os.fspath(path)}: coherence: found that of {of} and of no function that was read, expected the same DOFs"
            )
        coherences += found.coherences
        stated = _one_number(stated, found.averages, averages, path)
    names = ", ".join("functions" if isinstance(one, Functions) else os.fspath(one) for one in sources)
    functions = _of_curves(names, curves, coherences, stated)
    if len(sources) == 1 and not isinstance(sources[0], Functions) and quantity is None and units is None:
        functions.magnitude_deviation = _archive.deviation(sources[0], functions)
    return functions


def _one_number(
    before: float | None, found: float | None, given: float | None, source: Functions | str | os.PathLike[str]
) -> float | None:
    """Averages of all files, which agree where no number takes the place of theirs."""
    if before is not None and found is not None and before != found and given is None:
        name = "functions" if isinstance(source, Functions) else os.fspath(source)
        raise BoltedJointError(
            f"{name}: found {found:g} averages, and {before:g} before it, expected one number; state it by averages"
        )
    return found if before is None else before


#: Response, reference, frequencies and values, as they come from a file.
_Curve = tuple[str, str, NDArray[np.float64], NDArray[Any]]


class _Curves(NamedTuple):
    """What a file has."""

    functions: list[_Curve]
    coherences: list[_Curve]
    averages: float | None
    units_are_stated: bool


def _curves(
    path: str | os.PathLike[str], quantity: str | None, averages: float | None, units: tuple[float, float] | None
) -> _Curves:
    """Functions of one file; by `units` where they are given, else by those that the file states."""
    with _matlab73.archive(path) if _matlab73.is_one(path) else contextlib.nullcontext(path) as source:
        try:
            read, read_coherences, stated, has_units = native(
                _native.read_functions, source, quantity, averages
            )
        except ValueError as error:
            raise BoltedJointError(str(error).replace(os.fspath(source), os.fspath(path))) from error
        of_file = (1.0, 1.0)
        if units is not None and has_units and read:
            of_file = _stated_units(source, path)
    curves: list[_Curve] = []
    for response, reference, axis, numbers in read:
        values = np.frombuffer(numbers, np.complex128)
        if units is not None:
            values = values * (_to_si(response, reference, units) / _to_si(response, reference, of_file))
        curves.append((response, reference, np.frombuffer(axis), values))
    coherences: list[_Curve] = [
        (response, reference, np.frombuffer(axis), np.frombuffer(numbers))
        for response, reference, axis, numbers in read_coherences
    ]
    return _Curves(curves, coherences, stated, has_units or units is not None)


def _curves_of(functions: Functions, quantity: str | None, units: tuple[float, float] | None) -> _Curves:
    """Functions that are arrays, in SI units or in `units`; `quantity` takes the place of their own."""
    given = functions._with(functions.values, quantity=quantity).as_quantity("receptance")
    curves: list[_Curve] = []
    coherences: list[_Curve] = []
    for row, column in np.argwhere(given.measured):
        response, reference = given.responses[row], given.references[column]
        factor = 1.0 if units is None else _to_si(response, reference, units)
        curves.append((response, reference, given.frequency_hz, factor * given.values[:, row, column]))
        if given.coherence is not None:
            coherences.append((response, reference, given.frequency_hz, given.coherence[:, row, column]))
    return _Curves(curves, coherences, functions.averages, True)


def _stated_units(source: str | os.PathLike[str], path: str | os.PathLike[str]) -> tuple[float, float]:
    """SI units in the length and the force that a file states, where it states one of each."""
    told: list[str] = run(["show", path_of(source)], quiet=Warning)[0]["facts"]["units"]
    statements = [one for one in told if not one.startswith("understood as ")]
    lengths, forces = set(), set()
    for statement in statements:
        found = _SYSTEM.fullmatch(statement) or _LABEL.fullmatch(statement)
        units = {} if found is None else found.groupdict()
        motions = [units.get("motion") or "", units.get("arm") or "rad"]
        lengths |= {_motion(unit) for unit in motions if unit != "rad"}
        forces.add(_FORCES.get(units.get("force") or ""))
    if None in lengths | forces or len(lengths) > 1 or len(forces) != 1:
        raise BoltedJointError(
            f"{os.fspath(path)}: units: found units beside a file that states its own ({'; '.join(statements)}), "
            "expected none; leave them out, or take those of the file out of it"
        )
    return next(iter(lengths), None) or 1.0, next(iter(forces)) or 1.0


#: What `show` tells of the units of a file: length and force, or the unit of functions such as ``mm/s^2/(N·m)``.
_SYSTEM = re.compile(r"data set 164: (?P<motion>\S+), (?P<force>\S+)")
_LABEL = re.compile(
    r'"\(?(?P<motion>[^/()"]+)(?:/s(?:\^?2|²)?)?\)?/\(?(?P<force>[^\W_]+)(?:[·*](?P<arm>[^\W_]+))?\)?" in the file'
)


def _motion(unit: str) -> float | None:
    """SI units in a unit of length, or of acceleration by gravity."""
    return 9.80665 if unit == "g" else _LENGTHS.get(unit)


def _of_curves(
    files: str, curves: list[_Curve], coherences: list[_Curve], averages: float | None
) -> Functions:
    """The functions of one measurement, each with its coherence: that of the same DOFs, whatever their signs."""
    frequency_hz = curves[0][2]
    responses = list(dict.fromkeys(curve[0] for curve in curves))
    references = list(dict.fromkeys(curve[1] for curve in curves))
    shape = (len(frequency_hz), len(responses), len(references))
    values = np.full(shape, np.nan, dtype=np.complex128)
    of_coherence = np.full(shape, np.nan)
    places: dict[tuple[str, str], tuple[slice, int, int]] = {}
    for response, reference, axis, numbers in curves:
        if not np.array_equal(axis, frequency_hz):
            raise BoltedJointError(
                f"{files}: found other lines of {response}/{reference} than of "
                f"{curves[0][0]}/{curves[0][1]}, expected one frequency axis"
            )
        place = (slice(None), responses.index(response), references.index(reference))
        if not np.isnan(values[place]).all():
            raise BoltedJointError(
                f"{files}: found {response}/{reference} twice, expected each function once; leave one of the files out"
            )
        values[place] = numbers
        places[_unsigned(response, reference)] = place
    for response, reference, axis, numbers in coherences:
        at = places.get(_unsigned(response, reference))
        if at is None:
            continue
        # a function may have fewer lines: a receptance has none at 0 Hz that was measured as another quantity
        lines = np.searchsorted(axis, frequency_hz)
        if lines.max(initial=0) >= len(axis) or not np.array_equal(axis[lines], frequency_hz):
            raise BoltedJointError(
                f"{files}: found the coherence of {response}/{reference} at other lines than the function, expected it at "
                "these; leave one of them out"
            )
        of_coherence[at] = numbers[lines]
    coherence = of_coherence if coherences else None
    return Functions(frequency_hz, values, responses, references, coherence=coherence, averages=averages)


def unit_factors(units: Mapping[str, str]) -> tuple[float, float]:
    """SI units in the length and in the force that a study names."""
    if not isinstance(units, Mapping):
        expected = 'a dictionary such as {"length": "mm", "force": "N"}'
        raise BoltedJointError(f"units: found {units!r}, expected {expected}")
    for key in units:
        if key not in ("length", "force"):
            raise BoltedJointError(f"units: found the key {key!r}, expected length and force")
    found = []
    for key, known, names in [
        ("length", _LENGTHS, "m, cm, mm, um, in, ft, mil"),
        ("force", _FORCES, "N, kN, mN, lbf, kgf"),
    ]:
        name = units.get(key)
        if not isinstance(name, str) or name not in known:
            raise BoltedJointError(f"units.{key}: found {name!r}, expected one of {names}")
        found.append(known[name])
    length, force = found
    return length, force


def _to_si(response: str, reference: str, factors: tuple[float, float]) -> float:
    """SI units in one unit of a receptance: a motion is a length or rad, a load a force or a moment."""
    length, force = factors
    motion = 1.0 if _is_rotation(response) else length
    return motion / (force * length if _is_rotation(reference) else force)


def _is_rotation(dof: str) -> bool:
    return re.search(r":[+-]?R[XYZ]$", dof, re.IGNORECASE) is not None


def _unsigned(response: str, reference: str) -> tuple[str, str]:
    return re.sub(r":[+-]", ":", response), re.sub(r":[+-]", ":", reference)


def _paths(
    argument: str, paths: str | os.PathLike[str] | Iterable[str | os.PathLike[str]]
) -> list[str | os.PathLike[str]]:
    # an open file is iterable: its lines would be taken for paths
    if hasattr(paths, "read"):
        raise BoltedJointError(
            f"{argument}: found an open file ({getattr(paths, 'name', type(paths).__name__)}), expected its path"
        )
    found = list(paths) if isinstance(paths, Iterable) and not isinstance(paths, str | os.PathLike) else [paths]
    for path in found:
        path_of(path, argument, "a path or a list of paths")
    if not found:
        raise BoltedJointError(f"{argument}: found an empty list, expected at least one file")
    return found
