"""Studies as dictionaries, with arrays where a file would have paths."""

import contextlib
import copy
import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _native
from ._command import BoltedJointError, in_words, native, path_of
from ._functions import Functions
from ._joint import Joint
from ._read import unit_factors
from ._values import single, within

#: Keys whose texts are paths.
_PATHS = frozenset(_native.path_keys())


class Study(dict[str, Any]):
    """A study as a dictionary that knows the folder its paths are relative to.

    Where a study file has the path of a file of functions or of a joint file, there may be `Functions` or a `Joint`.

    Parameters
    ----------
    tables : mapping, optional
        The study's tables, as its TOML has them.
    folder : path, optional
        What paths in it are relative to; if it is left out, that of the tables where they are a study, else the
        current folder.

    Examples
    --------
    >>> study = Study.read("study.toml")
    >>> study["assembly"]["frf"] = Functions(f, values, ["11:+Y"], ["11:+Y"])
    >>> identify(study).joint.stiffness
    """

    #: What paths are relative to.
    folder: Path

    def __init__(self, tables: Mapping[str, Any] = {}, folder: str | os.PathLike[str] | None = None):
        try:
            super().__init__(tables)
        except (TypeError, ValueError):
            found = f"an object of type {type(tables).__name__}"
            raise BoltedJointError(
                f"tables: found {found}, expected a dictionary; Study.read reads a file"
            ) from None
        if folder is not None:
            path_of(folder, "folder")
        if folder is None:
            folder = tables.folder if isinstance(tables, Study) else "."
        self.folder = Path(folder).resolve()

    def copy(self) -> "Study":
        """The same study once more, in the same folder: what is changed in one is not in the other.

        Tables within tables, lists, arrays and joints are copied; `Functions`, which are not changed once they are
        made, are shared. A copy that shares its tables, as that of a dictionary does, is ``copy.copy(study)``.
        """
        return Study(_copied(self), self.folder)

    def __or__(self, other: Any) -> Any:
        """These tables with those of `other` in their place, in the folder of this study."""
        return Study({**self, **other}, self.folder) if isinstance(other, Mapping) else NotImplemented

    def __ror__(self, other: Any) -> Any:
        """The tables of `other` with these in their place, in the folder of this study."""
        return Study({**other, **self}, self.folder) if isinstance(other, Mapping) else NotImplemented

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Study":
        """Reads a study's file (TOML).

        Raises
        ------
        BoltedJointError
            For what is not TOML, with line and column.
        """
        path_of(path)
        path = Path(path)
        try:
            return cls.parse(path.read_text(encoding="utf-8"), path.parent)
        except (OSError, UnicodeDecodeError, BoltedJointError) as error:
            raise BoltedJointError(f"{path}: {error}") from error

    @classmethod
    def parse(cls, text: str, folder: str | os.PathLike[str] = ".") -> "Study":
        """A study from its text (TOML)."""
        if not isinstance(text, str):
            raise BoltedJointError(f"text: found an object of type {type(text).__name__}, expected a text (TOML)")
        try:
            return cls(json.loads(native(_native.to_json, text)), folder)
        except ValueError as error:
            raise BoltedJointError(str(error)) from error


#: What the functions of this module take for a study.
AnyStudy = str | os.PathLike[str] | Mapping[str, Any]
_A_STUDY = "a path, a dictionary or a Study"


def tables_of(study: AnyStudy) -> Study:
    """A study's tables as a dictionary of its own, with the folder that its paths are relative to."""
    return Study(study) if isinstance(study, Mapping) else Study.read(path_of(study, "study", _A_STUDY))


def settled(study: Mapping[str, Any]) -> Study:
    """A study as it is now: whatever is done to the one that was given, or to the current folder, it stays the same."""
    return tables_of(study).copy()


def _copied(value: Any) -> Any:
    """A value with dictionaries, lists, arrays and joints of its own; functions are not changed once they are made."""
    if isinstance(value, Mapping):
        return {name: _copied(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [_copied(inner) for inner in value]
    if isinstance(value, tuple):
        return tuple(_copied(inner) for inner in value)
    if isinstance(value, np.ndarray):
        return value.copy()
    return Joint(copy.deepcopy(value.data)) if isinstance(value, Joint) else value


@contextlib.contextmanager
def as_file(study: AnyStudy) -> Iterator[tuple[str, dict[str, str]]]:
    """The path of a study's file while the context lasts, and what messages show in place of its folder.

    Where the study is a dictionary, files are made for the time.
    """
    if not isinstance(study, Mapping):
        yield path_of(study, "study", _A_STUDY), {}
        return
    if not study:
        raise BoltedJointError("study: found an empty dictionary, expected the tables of a study, such as method and name")
    folder = Study(study).folder
    with tempfile.TemporaryDirectory(prefix="bolted-joint-") as temporary:
        # a study of a joint in space has no such key
        has_units = study.get("method") != "frf-space"
        tables = _Tables(folder, Path(temporary), has_units).written(study, "study", "study")
        try:
            text = native(_native.to_toml, json.dumps(tables, allow_nan=False))
        except ValueError as error:
            raise BoltedJointError(str(error)) from error
        path = Path(temporary, "study.toml")
        path.write_text(text, encoding="utf-8")
        yield str(path), {temporary + os.sep: ""}


def command_of(path: str, shown: Mapping[str, str]) -> str:
    """The command that a study's file is for."""
    try:
        return native(_native.command_of, path)
    except ValueError as error:
        raise BoltedJointError(in_words(str(error), shown)) from error


class _Tables:
    """Makes of a dictionary's values what TOML has words for; arrays of functions and joints become files."""

    def __init__(self, folder: Path, temporary: Path, has_units: bool):
        self.folder = folder
        self.has_units = has_units
        self.temporary = temporary
        self.names: set[str] = set()

    def written(self, value: Any, key: str, place: str) -> Any:
        """A value as TOML has it; `key` names its file, and `place` says where it is in the dictionary."""
        if isinstance(value, Mapping):
            tables = {
                str(name): self.written(inner, f"{key}.{name}", within(place, name)) for name, inner in value.items()
            }
            _refuse_other_statements(value, place)
            if self.has_units and _are_functions(value.get("frf")):
                tables.setdefault("units", {"length": "m", "force": "N"})
            return tables
        if isinstance(value, Functions):
            # an archive has all pairs of its responses and references
            is_whole = value.measured.all() and (value.coherence is None or not np.isnan(value.coherence).any())
            path = self.new(key, ".npz" if is_whole else ".csv")
            value.save(path)
            return path.name
        if isinstance(value, Joint):
            path = self.new(key, ".joint.json")
            value.save(path)
            return path.name
        if isinstance(value, os.PathLike):
            return str(self.folder / value)
        if isinstance(value, str):
            return self.text(value, key)
        if isinstance(value, np.ndarray | np.generic):
            return self.written(value.tolist(), key, place)
        if isinstance(value, Sequence) and not isinstance(value, bytes | bytearray):
            return [self.written(inner, key, within(place, number)) for number, inner in enumerate(value)]
        return single(value, place)

    def text(self, value: str, key: str) -> str:
        """A text; the whole path if its key is that of a file, and it names one."""
        if key.rsplit(".")[-1] not in _PATHS or not value:
            return value
        path = self.folder / value
        try:
            return str(path) if path.is_file() else value
        except OSError:
            return value

    def new(self, key: str, ending: str) -> Path:
        """A path for a table's file, named after the table."""
        stem = key.removeprefix("study.").removesuffix(".frf").replace(".", "-")
        name, number = stem, 1
        while name in self.names:
            number += 1
            name = f"{stem}-{number}"
        self.names.add(name)
        return self.temporary / (name + ending)


def _refuse_other_statements(table: Mapping[str, Any], place: str) -> None:
    """Refuses what a table says of its functions beside arrays, which say something else of themselves."""
    frf = table.get("frf")
    given = [one for one in (frf if isinstance(frf, list | tuple) else [frf]) if isinstance(one, Functions)]
    if not given:
        return
    units, quantity = table.get("units"), table.get("quantity")
    if isinstance(units, Mapping) and unit_factors(units) != (1.0, 1.0):
        raise BoltedJointError(
            f"{within(place, 'units')}: found {dict(units)} beside Functions in {within(place, 'frf')}, which are in "
            "SI units; leave units out, and turn the values into SI before they become Functions"
        )
    for functions in given:
        if isinstance(quantity, str) and quantity != functions.quantity:
            raise BoltedJointError(
                f"{within(place, 'quantity')}: found {quantity!r} beside Functions in {within(place, 'frf')} whose "
                f"quantity is {functions.quantity!r}; leave quantity out, or make Functions with quantity={quantity!r}"
            )


def _are_functions(value: Any) -> bool:
    """Whether a key has functions as arrays, which are in SI units, and no file's."""
    if isinstance(value, list | tuple):
        return len(value) > 0 and all(isinstance(one, Functions) for one in value)
    return isinstance(value, Functions)
