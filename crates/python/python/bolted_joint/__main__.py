"""The command line, from the wheel: ``bolted-joint`` and ``python -m bolted_joint``."""

import signal
import sys

from . import _native
from ._command import PYTHON


def main() -> int:
    """Runs the command line with the arguments of this process and gives its exit code."""
    # there is nothing of Python's to end in an orderly way
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main(sys.argv[1:], PYTHON)


if __name__ == "__main__":
    sys.exit(main())
