"""Commands of the command line, called from Python."""

import json
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from html import escape
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from . import _native
from ._words import in_python

_PLATFORMS = Path(__file__).with_name("platforms")

#: How this module is started in a process of its own, which `check` does to run an FMU's library; and FMU libraries for
#: other platforms, where the wheel has them.
PYTHON = (sys.executable, ["-m", "bolted_joint"], str(_PLATFORMS) if _PLATFORMS.is_dir() else None)

_NOT_USABLE = 3

_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")


class BoltedJointError(ValueError):
    """What was given cannot be used; the message says where, what was found and what was expected."""


class NotUsableWarning(UserWarning):
    """The work was done, but its result is not to be relied on; the message says why."""


def native(function: Callable[_Given, _Found], *arguments: _Given.args, **named: _Given.kwargs) -> _Found:
    """What a function of the compiled part gives.

    Raises
    ------
    BoltedJointError
        Where it has come upon a mistake of its own, which nothing that was given should lead to.
    """
    try:
        return function(*arguments, **named)
    except BaseException as error:
        # a mistake in another thread is a RuntimeError; one in this thread an exception without a name to import
        if not isinstance(error, RuntimeError) and type(error).__name__ != "PanicException":
            raise
        raise BoltedJointError(f"internal error: {error}; please report it, and what led to it") from error


def path_of(path: object, argument: str = "path", expected: str = "a path") -> str:
    """A path as an argument; one that begins with a hyphen is no option.

    Raises
    ------
    BoltedJointError
        With the argument's name and what it is `expected` to be, where it is no path.
    """
    if not isinstance(path, str | os.PathLike):
        raise BoltedJointError(f"{argument}: found an object of type {type(path).__name__}, expected {expected}")
    text = os.fspath(path)
    return os.path.join(".", text) if text.startswith("-") else text


def in_words(text: str, shown: Mapping[str, str]) -> str:
    """A text in which the names of files that nobody but this module knows of have others in their place."""
    for hidden, name in shown.items():
        text = text.replace(hidden, name)
    return text


def in_page(page: str, shown: Mapping[str, str]) -> str:
    """As `in_words`, in HTML."""
    return in_words(page, {escape(hidden): escape(name) for hidden, name in shown.items()})


def run(
    arguments: Iterable[str],
    shown: Mapping[str, str] = {},
    *,
    quiet: type[Warning] | None = None,
    stacklevel: int = 3,
    may_find: bool = False,
) -> Any:
    """Runs a command that prints JSON, and gives what it prints.

    Its warnings become Python's, its error an exception.

    Parameters
    ----------
    arguments : iterable of str
        The command's name, and its arguments without ``--json``.
    shown : mapping of str to str
        What messages and JSON show in place of files that nobody but this module knows of.
    quiet : type of warning, optional
        Warnings that are not given: filters of the module `warnings` would be those of all threads.
    stacklevel : int
        How many calls above this one the user's call is.
    may_find : bool
        Whether an error is none where the command has printed what it found.

    Raises
    ------
    BoltedJointError
        With the command line's message, in this module's words.
    KeyboardInterrupt
        At Ctrl-C. Work that takes long then ends by itself.
    """
    command, *rest = arguments
    # before what stands at the end, which may be a command of its own
    exit_code, printed, messages = native(_native.call, [command, "--json", *rest], PYTHON)
    errors = []
    told: list[tuple[str, type[Warning]]] = []
    for message in messages:
        message = in_words(in_python(message), shown)
        if message.startswith("warning: "):
            told.append((message.removeprefix("warning: "), UserWarning))
        else:
            errors.append(message.removeprefix("error: ").rstrip())
    error = "\n".join(errors)
    if exit_code == _NOT_USABLE:
        told.append((error, NotUsableWarning))
    for text, kind in told:
        if quiet is None or not issubclass(kind, quiet):
            warnings.warn(text, kind, stacklevel=stacklevel)
    if exit_code not in (0, _NOT_USABLE) and not (may_find and printed):
        raise BoltedJointError(error)
    return json.loads(in_words(printed, {_inner(hidden): _inner(name) for hidden, name in shown.items()}))


def _inner(text: str) -> str:
    """A text as JSON has it within quotes."""
    return json.dumps(text, ensure_ascii=False)[1:-1]
