"""What JSON and TOML have words for, and the place of what they have none for."""

import json
import math
import operator
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._command import BoltedJointError


def checked(value: Any, place: str) -> Any:
    """A value, if JSON has words for all that is in it.

    Parameters
    ----------
    value : mapping, sequence, text, number, bool or None
        What is to be written.
    place : str
        Where it is, as Python has it: ``data["joint"]``.

    Raises
    ------
    BoltedJointError
        With the place of the first value that is no finite number, or of another kind.
    """
    if isinstance(value, Mapping):
        for name, inner in value.items():
            checked(inner, within(place, name))
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes | bytearray):
        for number, inner in enumerate(value):
            checked(inner, within(place, number))
    elif value is not None:
        single(value, place)
    return value


def plain(value: Any) -> Any:
    """A value with lists and numbers in place of NumPy's."""
    if isinstance(value, Mapping):
        return {name: plain(inner) for name, inner in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str | bytes | bytearray):
        return [plain(inner) for inner in value]
    return value


def single(value: Any, place: str) -> Any:
    """A value that is no table and no list, if files of all kinds have a word for it; else as `checked`."""
    if value is None:
        raise BoltedJointError(f"{place}: found None, expected a value; leave the key out where there is none")
    if isinstance(value, float) and not math.isfinite(value):
        raise BoltedJointError(f"{place}: found {value}, expected a finite number; correct it, or leave the key out")
    if not isinstance(value, str | bool | int | float):
        expected = "a text, a number, true or false, or a list or a dictionary of these"
        raise BoltedJointError(f"{place}: found an object of type {type(value).__name__}, expected {expected}")
    return value


def array_of(argument: str, values: ArrayLike, kind: Any) -> NDArray[Any]:
    """An array of its own.

    Raises
    ------
    BoltedJointError
        With the argument's name, where values are no numbers or no array.
    """
    try:
        found = np.array(values)
        # NumPy would drop imaginary parts, and take true for 1
        if found.dtype.kind == "b" or found.dtype.kind == "c" and np.dtype(kind).kind != "c":
            raise TypeError(f"{found.dtype.name} values")
        return np.array(values, dtype=kind)
    except (ValueError, TypeError) as error:
        expected = "complex or real numbers" if np.dtype(kind).kind == "c" else "real numbers"
        raise BoltedJointError(f"{argument}: found what is no array of numbers ({error}), expected {expected}") from error


def whole(argument: str, value: Any, least: int) -> int:
    """An argument that is a whole number, `least` or more, of Python or of NumPy.

    Raises
    ------
    BoltedJointError
        With the argument's name for another value.
    """
    try:
        if isinstance(value, bool):
            raise TypeError
        found = operator.index(value)
    except TypeError:
        raise BoltedJointError(f"{argument}: found {value!r}, expected a whole number from {least} on") from None
    if found < least:
        raise BoltedJointError(f"{argument}: found {found}, expected a whole number from {least} on")
    return found


def _real(value: Any) -> float:
    """A number of Python or of NumPy; NaN for what is none."""
    try:
        return math.nan if isinstance(value, str | bytes | bool) else float(value)
    except (TypeError, ValueError):
        return math.nan


def number(argument: str, value: Any, least: float = -math.inf) -> float:
    """An argument that is a finite number, `least` or more, of Python or of NumPy; errors as of `whole`."""
    found = _real(value)
    if not (math.isfinite(found) and found >= least):
        expected = "a finite number" if least == -math.inf else f"a finite number from {least:g} on"
        raise BoltedJointError(f"{argument}: found {value!r}, expected {expected}")
    return found


def limit(argument: str, value: Any, none: float) -> float:
    """An argument that is an end of a range, which may be infinite; `none` where it is None. Errors as of `whole`."""
    if value is None:
        return none
    found = _real(value)
    if math.isnan(found):
        raise BoltedJointError(f"{argument}: found {value!r}, expected a number, or None for no limit")
    return found


def place_of(argument: str, value: Any, count: int) -> int:
    """An argument that is a number from 0 to `count` - 1; errors as of `whole`."""
    try:
        if isinstance(value, bool):
            raise TypeError
        found = operator.index(value)
    except TypeError:
        found = -1
    if not 0 <= found < count:
        raise BoltedJointError(f"{argument}: found {value!r}, expected a number from 0 to {count - 1}")
    return found


def one_of(argument: str, value: Any, known: Sequence[Any]) -> Any:
    """An argument that is one of some words or numbers; errors as of `whole`."""
    # an array has no one truth
    if isinstance(value, np.ndarray) or value not in known:
        raise BoltedJointError(f"{argument}: found {value!r}, expected one of {', '.join(map(str, known))}")
    return value


def listed(argument: str, value: Any) -> tuple[str, ...]:
    """An argument that is a list of texts; a text alone is one of them."""
    try:
        found = (value,) if isinstance(value, str) else tuple(value)
    except TypeError:
        raise BoltedJointError(f"{argument}: found {value!r}, expected a text or a list of texts") from None
    for one in found:
        if not isinstance(one, str):
            raise BoltedJointError(f"{argument}: found {one!r}, expected texts")
    return found


def within(place: str, name: object) -> str:
    """The place of a key within a dictionary, or of a number within a list."""
    return f"{place}[{name if isinstance(name, int) else json.dumps(str(name), ensure_ascii=False)}]"
