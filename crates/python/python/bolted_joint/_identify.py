"""`identify`: a study becomes a joint."""

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._command import run
from ._functions import Functions, read
from ._joint import Joint
from ._respond import respond
from ._study import AnyStudy, Study, as_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Identification:
    """What was identified.

    Attributes
    ----------
    joints : dict of str to Joint
        The joint of each bolt; of one joint for all, under ``""``.
    usable : bool
        Whether the result may be relied on.
    reasons_against : tuple of str
        Why not.
    details : dict
        All that ``bolted-joint identify --json`` prints: models compared, budget, lines used.
    report_html : str
        The report: one page with everything that was measured, assumed and found. Empty where none was asked for.
    """

    def __init__(self, study: AnyStudy, joints: dict[str, Joint], details: dict[str, Any], report_html: str):
        self._study = study
        self.joints = joints
        self.details = details
        self.report_html = report_html
        first = next(iter(joints.values()))
        self.usable = bool(details.get("usable", first.usable))
        self.reasons_against: tuple[str, ...] = tuple(details.get("reasons_against", first.reasons_against))

    @property
    def joint(self) -> Joint:
        """The joint, where there is one for all bolts.

        Raises
        ------
        ValueError
            Where bolts have joints of their own; `joints` has them.
        """
        if len(self.joints) != 1:
            raise ValueError(f"found joints of {', '.join(self.joints)}; take one of them from joints")
        return next(iter(self.joints.values()))

    def measured(self) -> Functions:
        """The functions of the assembly that were measured, as receptances."""
        study = self._study if isinstance(self._study, dict) else Study.read(self._study)  # type: ignore[arg-type]
        functions = study["assembly"]["frf"]
        if isinstance(functions, Functions):
            return functions
        folder = study.folder if isinstance(study, Study) else Path()
        return read(folder / functions)

    def regenerated(self, step_hz: float | None = None) -> Functions:
        """The functions that the assembly would have with the identified joint; needs one joint for all bolts."""
        return respond(self._study, self.joint, step_hz=step_hz)

    def plot(self, **options: Any) -> "Figure":
        """Draws the measured functions and those of the identified joint; see `bolted_joint._plot.functions`."""
        from . import _plot

        measured, regenerated = self.measured(), self.regenerated()
        return _plot.functions({"measured": measured, "identified": regenerated}, **options)

    def __repr__(self) -> str:
        return f"<Identification: {', '.join(repr(joint) for joint in self.joints.values())}>"

    def _repr_html_(self) -> str:
        return "".join(joint._repr_html_() for joint in self.joints.values())


def identify(
    study: AnyStudy,
    *,
    bootstrap: int | None = None,
    seed: int | None = None,
    rivals: bool = True,
    report: bool = False,
) -> Identification:
    """Identifies the joint of a study.

    Parameters
    ----------
    study : path, dict or Study
        What was measured, on which points, and which joint model to identify. A path names a study file (TOML). A
        dictionary has the same tables, with `Functions` in place of a file's path where they are at hand.
    bootstrap : int, optional
        Repeat the estimate on so many data sets drawn from the fitted model.
    seed : int, optional
        Seed of the bootstrap.
    rivals : bool
        Whether the joint model is compared with others.
    report : bool
        Whether the report is made too.

    Returns
    -------
    Identification

    Raises
    ------
    BoltedJointError
        If the study or its files cannot be used.

    Warns
    -----
    NotUsableWarning
        If the result is not to be relied on.
    """
    with as_file(study) as (path, hidden), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        output, page = Path(folder, "identified.joint.json"), Path(folder, "report.html")
        arguments = ["identify", path, "-o", str(output)]
        if bootstrap is not None:
            arguments += ["--bootstrap", str(bootstrap)]
        if seed is not None:
            arguments += ["--seed", str(seed)]
        if not rivals:
            arguments += ["--no-rivals"]
        if report:
            arguments += ["--report", str(page)]
        details = run(arguments, hidden)
        html = page.read_text(encoding="utf-8") if report else ""
        return found_in(Path(folder), "identified", study, details, html)


def found_in(folder: Path, stem: str, study: AnyStudy, details: dict[str, Any], html: str) -> Identification:
    """The joint files that a command has written into a folder, as `stem`.joint.json or `stem`.BOLT.joint.json."""
    joints = {
        file.name.removeprefix(stem).removesuffix("joint.json").strip("."): Joint.read(file)
        for file in sorted(folder.glob("*.joint.json"))
    }
    return Identification(study, joints, details, html)
