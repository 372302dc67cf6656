"""What JSON and TOML have words for, and the place of what they have none for."""

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

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


def within(place: str, name: object) -> str:
    """The place of a key within a dictionary, or of a number within a list."""
    return f"{place}[{name if isinstance(name, int) else json.dumps(str(name), ensure_ascii=False)}]"
