"""Commands of the command line, called from Python."""

import json
import os
import sys
import warnings
from collections.abc import Iterable
from typing import Any

from . import _native

#: How this module is started in a process of its own, which `check` does to run an FMU's library.
PYTHON = (sys.executable, ["-m", "bolted_joint"])

_NOT_USABLE = 3


class BoltedJointError(ValueError):
    """What was given cannot be used; the message says where, what was found and what was expected."""


class NotUsableWarning(UserWarning):
    """The work was done, but its result is not to be relied on; the message says why."""


def path_of(path: str | os.PathLike[str]) -> str:
    """A path as an argument; one that begins with a hyphen is no option."""
    text = os.fspath(path)
    return os.path.join(".", text) if text.startswith("-") else text


def run(arguments: Iterable[str], stacklevel: int = 3) -> Any:
    """Runs a command that prints JSON, and gives what it prints.

    Its warnings become Python's, its error an exception.

    Parameters
    ----------
    arguments : iterable of str
        The command's name, and its arguments without ``--json``.
    stacklevel : int
        How many calls above this one the user's call is.

    Raises
    ------
    BoltedJointError
        With the command line's message.
    KeyboardInterrupt
        At Ctrl-C.
    """
    exit_code, printed, messages = _native.call([*arguments, "--json"], PYTHON)
    errors = []
    for message in messages:
        if message.startswith("warning: "):
            warnings.warn(message.removeprefix("warning: "), UserWarning, stacklevel=stacklevel)
        else:
            errors.append(message.removeprefix("error: ").rstrip())
    error = "\n".join(errors)
    if exit_code == _NOT_USABLE:
        warnings.warn(error, NotUsableWarning, stacklevel=stacklevel)
    elif exit_code != 0:
        raise BoltedJointError(error)
    return json.loads(printed)
