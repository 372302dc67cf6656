"""`identify`: a study becomes a joint."""

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._command import BoltedJointError, NotUsableWarning, in_page, run
from ._functions import Functions, lines_of
from ._html import asked
from ._joint import Joint
from ._measured import assemblies, functions_of, with_joints, with_lines
from ._respond import answered, of_step
from ._study import AnyStudy, Study, as_file, settled, tables_of
from ._values import whole

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
    """

    def __init__(self, study: Study, joints: dict[str, Joint], details: dict[str, Any], report_html: str | None):
        self._study = study
        self.joints = joints
        self.details = details
        self._report_html = report_html
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

    @property
    def report_html(self) -> str:
        """The report: one page with everything that was measured, assumed and found.

        Raises
        ------
        BoltedJointError
            If none was asked for: ``identify(..., report=True)``.
        """
        return asked(self._report_html, "report_html", "report", "identify and merge make")

    def measured(self, assembly: int = 0) -> Functions:
        """The functions of the assembly that were measured, as receptances in SI units.

        Parameters
        ----------
        assembly : int
            Which of the study's assemblies, from 0 on.

        Raises
        ------
        BoltedJointError
            If no functions were measured, as for laps; `details` has what was.
        """
        return functions_of(self._study, assembly)

    def regenerated(
        self, step_hz: float | None = None, assembly: int = 0, *, at: Functions | ArrayLike | None = None
    ) -> Functions:
        """The functions that the assembly would have with what was identified, as receptances.

        ``regenerated(at=found.measured())`` has the lines of what was measured: values that may be subtracted.

        Parameters
        ----------
        step_hz : float, optional
            Distance between the lines, Hz; 0.25, or in space that of the measured ones, if it is left out.
        assembly : int
            Which of the study's assemblies, from 0 on. A joint over the preload is taken at its torque.
        at : Functions or array of shape (F,), optional
            In place of `step_hz` the lines, Hz, above 0 and increasing: those of functions, or frequencies themselves.
            Of functions the responses and references count as well: the result has these, in their order.
            Nothing is interpolated. What a study says of lines to use does not count for them. A structure whose
            functions were measured has to have these lines.

        Raises
        ------
        BoltedJointError
            If no functions were measured, as for laps, or if something has no such lines.
        """
        if at is not None:
            return self._at(at, step_hz, assembly)
        study = with_joints(self._study, self.joints, assembly)
        joints = None if study["method"] == "frf-space" else self.joints
        has_lines = joints is not None or any("frf" in part for part in study.values() if isinstance(part, Mapping))
        if step_hz is None and not has_lines:
            # nothing else says where the lines are
            step_hz = float(np.median(np.diff(self.measured().frequency_hz)))
        # that the result is not to be relied on `identify` has told
        response = answered(study, joints, of_step(step_hz), quiet=NotUsableWarning)
        assert isinstance(response, Functions)
        return response

    def _at(self, at: Functions | ArrayLike, step_hz: float | None, assembly: int) -> Functions:
        """The functions that the assembly would have, at these lines."""
        if step_hz is not None:
            raise BoltedJointError(f"at: found it beside step_hz ({step_hz!r}), expected one of them")
        frequency_hz = at.frequency_hz if isinstance(at, Functions) else lines_of("at", at)
        if isinstance(at, Functions):
            # static receptances are measured of nothing
            frequency_hz = frequency_hz[frequency_hz > 0.0]
        if len(frequency_hz) < 2 or frequency_hz[0] <= 0.0:
            found = f"{len(frequency_hz)} lines" + (f" from {frequency_hz[0]:g} Hz on" if len(frequency_hz) else "")
            raise BoltedJointError(f"at: found {found}, expected two lines or more above 0 Hz")
        study = with_lines(self._study, self.joints, assembly, frequency_hz)
        joints = None if study["method"] == "frf-space" else self.joints
        response = answered(study, joints, [], quiet=NotUsableWarning)
        assert isinstance(response, Functions)
        # the same functions in the same order, so that values may be subtracted
        return response.select(at.responses, at.references) if isinstance(at, Functions) else response

    def plot(self, assembly: int = 0, *, most: int = 6) -> "Figure":
        """Draws what was measured and what the identified joint makes of it.

        These are functions of one of the study's assemblies; of laps natural frequencies over the torque, or backbones
        and resonances.

        Parameters
        ----------
        assembly : int
            Which of the study's assemblies, from 0 on.
        most : int
            At most so many functions are drawn, the strongest ones.

        Returns
        -------
        matplotlib.figure.Figure
            A figure that pyplot does not keep.
        """
        from . import _plot

        method = self._study["method"]
        if method == "lap-update":
            return _plot.frequencies(self.details["torques"])
        if method == "lap-response":
            return _plot.runs(self.details["backbones"], self.details["predictions"])
        of = f", assembly {assembly}" if len(assemblies(self._study)) > 1 else ""
        sets = {f"measured{of}": self.measured(assembly), f"identified{of}": self.regenerated(assembly=assembly)}
        return _plot.functions(sets, most)

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
        Seed of the bootstrap, which has to be asked for.
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
    options = repeated(bootstrap, seed)
    # results tell of the study as it was
    given = settled(study) if isinstance(study, Mapping) else study
    with as_file(given) as (path, shown), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        output, page = Path(folder, "identified.joint.json"), Path(folder, "report.html")
        arguments = ["identify", path, "-o", str(output)]
        arguments += options
        if not rivals:
            arguments += ["--no-rivals"]
        if report:
            arguments += ["--report", str(page)]
        shown |= {str(output): "the joint", folder + os.sep: ""}
        details = run(arguments, shown)
        html = in_page(page.read_text(encoding="utf-8"), shown) if report else None
        return found_in(Path(folder), "identified", given, details, html)


def repeated(bootstrap: int | None, seed: int | None) -> list[str]:
    """The options of a bootstrap.

    Raises
    ------
    BoltedJointError
        For a seed without a bootstrap, and for what is no whole number.
    """
    if bootstrap is None:
        if seed is not None:
            raise BoltedJointError(f"seed: found {seed!r} without bootstrap, expected both; nothing else is drawn")
        return []
    options = ["--bootstrap", str(whole("bootstrap", bootstrap, 2))]
    return options if seed is None else [*options, "--seed", str(whole("seed", seed, 0))]


def found_in(folder: Path, stem: str, study: AnyStudy, details: dict[str, Any], html: str | None) -> Identification:
    """The joint files that a command has written into a folder, as `stem`.joint.json or `stem`.BOLT.joint.json."""
    joints = {
        file.name.removeprefix(stem).removesuffix("joint.json").strip("."): Joint.read(file)
        for file in sorted(folder.glob("*.joint.json"))
    }
    return Identification(tables_of(study), joints, details, html)
