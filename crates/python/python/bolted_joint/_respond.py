"""`respond`: what a test of the assembly would measure with a joint."""

import tempfile
from pathlib import Path

from ._command import BoltedJointError, run
from ._functions import Functions, read
from ._joint import Joint
from ._study import AnyStudy, as_file


def respond(study: AnyStudy, joint: Joint, *, step_hz: float | None = None) -> Functions:
    """The functions of a study's assembly if its joint were this one.

    Parameters
    ----------
    study : path, dict or Study
        The study of an assembly, as for `identify`; its measured functions need not exist.
    joint : Joint
        The joint that the assembly is to have.
    step_hz : float, optional
        Distance between the lines, Hz; 0.25 if it is left out.

    Returns
    -------
    Functions
        Receptances.

    Raises
    ------
    BoltedJointError
        If study or joint cannot be used.
    """
    if not isinstance(joint, Joint):
        raise BoltedJointError(f"joint: found {type(joint).__name__}, expected a Joint; Joint.read(path) reads one")
    with as_file(study) as (path, hidden), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        given, output = Path(folder, "given.joint.json"), Path(folder, "responses.csv")
        joint.save(given)
        arguments = ["respond", path, "--joint", str(given), "-o", str(output)]
        if step_hz is not None:
            arguments += ["--step", repr(float(step_hz))]
        run(arguments, hidden)
        return read(output)
