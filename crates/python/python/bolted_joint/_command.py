"""Commands of the command line, called from Python."""

import json
import os
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import _native

_PLATFORMS = Path(__file__).with_name("platforms")

#: How this module is started in a process of its own, which `check` does to run an FMU's library; and FMU libraries for
#: other platforms, where the wheel has them.
PYTHON = (sys.executable, ["-m", "bolted_joint"], str(_PLATFORMS) if _PLATFORMS.is_dir() else None)

_NOT_USABLE = 3


class BoltedJointError(ValueError):
    """What was given cannot be used; the message says where, what was found and what was expected."""


class NotUsableWarning(UserWarning):
    """The work was done, but its result is not to be relied on; the message says why."""


def path_of(path: str | os.PathLike[str]) -> str:
    """A path as an argument; one that begins with a hyphen is no option."""
    text = os.fspath(path)
    return os.path.join(".", text) if text.startswith("-") else text


def run(arguments: Iterable[str], hidden: str = "", stacklevel: int = 3) -> Any:
    """Runs a command that prints JSON, and gives what it prints.

    Its warnings become Python's, its error an exception.

    Parameters
    ----------
    arguments : iterable of str
        The command's name, and its arguments without ``--json``.
    hidden : str
        What messages do not show: the folder of files that nobody but this module knows of.
    stacklevel : int
        How many calls above this one the user's call is.

    Raises
    ------
    BoltedJointError
        With the command line's message.
    KeyboardInterrupt
        At Ctrl-C.
    """
    command, *rest = arguments
    # before what stands at the end, which may be a command of its own
    exit_code, printed, messages = _native.call([command, "--json", *rest], PYTHON)
    errors = []
    for message in messages:
        if hidden:
            message = message.replace(hidden, "")
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
