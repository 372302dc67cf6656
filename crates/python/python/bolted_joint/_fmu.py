"""`export` and `check`: from a joint to an FMU, and whether it is what it should be."""

import contextlib
import os
import tempfile
from pathlib import Path
from typing import Any, Literal

from ._command import BoltedJointError, path_of, run
from ._html import table
from ._joint import AJoint, Joint, joint_of
from ._study import Study, as_file
from ._values import number, one_of


class Fmu:
    """An FMU that was written.

    Attributes
    ----------
    path : pathlib.Path
        Where it lies.
    details : dict
        All that ``bolted-joint export --json`` prints.
    """

    def __init__(self, path: Path, details: dict[str, Any]):
        self.path = path
        self.details = details

    def __fspath__(self) -> str:
        return str(self.path)

    def __str__(self) -> str:
        return str(self.path)

    def __repr__(self) -> str:
        return f"<Fmu {str(self.path)!r}>"

    def _repr_html_(self) -> str:
        rows = [
            ("model", str(self.details["model_name"])),
            ("interface", f"{self.details['interface']}, FMI {self.details['fmi_version']}"),
            ("platforms", ", ".join(self.details["platforms"])),
            ("token", str(self.details["token"])),
        ]
        return table(str(self.path), ("", ""), rows)


def export(
    joint: AJoint | Study | str | os.PathLike[str],
    path: str | os.PathLike[str],
    *,
    interface: Literal["element", "lap"] | None = None,
    fmi: Literal[2, 3] = 3,
    step_size_max_s: float | None = None,
    step_error: float | None = None,
    preload_n_m: float | None = None,
    extrapolate: bool = False,
    platforms: str | os.PathLike[str] | None = None,
    allow_active: bool = False,
    unusable: bool = False,
) -> Fmu:
    """Writes an FMU from a joint, or from a whole assembly.

    Parameters
    ----------
    joint : Joint, Study or path
        The joint, what was identified or predicted with it, or its file; or an assembly: its file, or its tables as a
        `Study`, which may have a `Joint` where a file has the path of one.
    path : path
        The FMU to write.
    interface : {"element", "lap"}, optional
        Of a joint: the massless joint between two structures (motion in, force out; this is the default), or two bodies
        with the joint between them.
    fmi : {3, 2}
        Version of the FMI standard.
    step_size_max_s : float, optional
        Longest Runge–Kutta step of a lap, s.
    step_error : float, optional
        Part of their largest values that motions and joint loads of a lap may be wrong by; in place of ``step_size_max_s``.
    preload_n_m : float, optional
        Preload at which a joint over the preload is frozen, N·m.
    extrapolate : bool
        Hold a joint over the preload beyond the ends of its table.
    platforms : path, optional
        Folder with libraries for other platforms.
    allow_active, unusable : bool
        Export a joint that can feed energy into a simulation, or one that is not to be relied on.

    Returns
    -------
    Fmu

    Raises
    ------
    BoltedJointError
        If the joint cannot be exported.
    """
    with contextlib.ExitStack() as stack:
        shown: dict[str, str] = {}
        joint = joint_of(joint)
        if isinstance(joint, Joint):
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="bolted-joint-"))
            given = os.path.join(folder, "given.joint.json")
            joint.save(given)
            shown = {given: joint.name}
        elif isinstance(joint, Study):
            given, shown = stack.enter_context(as_file(joint))
        else:
            given = path_of(joint, "joint", "a Joint, its file, an assembly's file, or a Study(...) of an assembly")
        arguments = ["export", given, "-o", path_of(path), "--fmi", str(one_of("fmi", fmi, (2, 3)))]
        if interface is not None:
            arguments += ["--as", one_of("interface", interface, ("element", "lap"))]
        for option, argument, value in [
            ("--step-size-max", "step_size_max_s", step_size_max_s),
            ("--step-error", "step_error", step_error),
            ("--preload", "preload_n_m", preload_n_m),
        ]:
            if value is not None:
                arguments += [option, repr(number(argument, value))]
        if platforms is not None:
            arguments += ["--platforms", path_of(platforms, "platforms")]
        for option, asked in [
            ("--extrapolate", extrapolate),
            ("--allow-active", allow_active),
            ("--unusable", unusable),
        ]:
            if asked:
                arguments.append(option)
        return Fmu(Path(path), run(arguments, shown))


class Checked:
    """What was looked at, and what is wrong with it.

    Attributes
    ----------
    sound : bool
        Whether nothing is wrong.
    usable : bool
        Whether the joint may be relied on; `reasons_against` says why not.
    reasons_against : tuple of str
        Why the joint is not to be relied on.
    facts, findings : tuple of str
        What it is, and what is wrong with it.
    details : dict
        All that ``bolted-joint check --json`` prints.
    """

    def __init__(self, details: dict[str, Any]):
        self.details = details
        self.sound = bool(details["sound"])
        self.usable = bool(details.get("usable", True))
        self.reasons_against: tuple[str, ...] = tuple(details.get("reasons_against", ()))
        self.facts: tuple[str, ...] = tuple(details["facts"])
        self.findings: tuple[str, ...] = tuple(details["findings"])

    def __repr__(self) -> str:
        against = "".join(f"; not to be relied on: {reason}" for reason in self.reasons_against)
        return f"<Checked: {'sound' if self.sound else '; '.join(self.findings)}{against}>"

    def _repr_html_(self) -> str:
        rows = [("wrong", finding) for finding in self.findings]
        rows += [("not to be relied on", reason) for reason in self.reasons_against]
        rows += [("", fact) for fact in self.facts]
        return table("sound" if self.sound else "not sound", ("", ""), rows)


def check(what: AJoint | Study | Fmu | str | os.PathLike[str], *, run_library: bool = True) -> Checked:
    """Checks a joint, an FMU or a system of FMUs (SSP), and runs the FMU's library for a moment in a process of its own.

    Parameters
    ----------
    what : Joint, Study, Fmu or path
        What to check; also what was identified or predicted, of which it is the joint, and an assembly as a `Study`.
    run_library : bool
        Whether the FMU's library is run.

    Returns
    -------
    Checked
        What is wrong with it stands in `Checked.findings`, and `Checked.sound` is then false.

    Raises
    ------
    BoltedJointError
        If it cannot be read.

    Warns
    -----
    NotUsableWarning
        If the joint is not to be relied on.
    """
    with contextlib.ExitStack() as stack:
        shown: dict[str, str] = {}
        what = joint_of(what)
        if isinstance(what, Joint):
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="bolted-joint-"))
            path = str(Path(folder, "given.joint.json"))
            what.save(path)
            shown[path] = what.name
        elif isinstance(what, Study):
            path, shown = stack.enter_context(as_file(what))
        else:
            path = path_of(what, "what", "a Joint, an Fmu or a path, or a Study(...) of an assembly")
        return Checked(run(["check", path, *([] if run_library else ["--no-run"])], shown, may_find=True))


__all__ = ["BoltedJointError", "Checked", "Fmu", "check", "export"]
