"""`show`, `compare` and `convert`: a look at files, joints beside each other, joints for other tools."""

import contextlib
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ._command import BoltedJointError, in_page, path_of, run
from ._functions import Functions
from ._html import asked, table
from ._joint import AJoint, Joint, joint_of
from ._study import Study, as_file
from ._values import number, one_of, whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Tools that joints are converted for.
Tool = Literal["nastran", "abaqus", "calculix", "ansys", "matlab", "modelica"]

#: Units of what is written for programs of finite elements.
Units = Literal["si", "mm"]

#: What `show` tells of.
Shown = str | os.PathLike[str] | AJoint | Functions | Study


class Look:
    """What is in a file.

    Attributes
    ----------
    kind : str
        What it is.
    facts : dict of str to list of str
        What is in it, in words.
    warnings, reasons_against : tuple of str
        What looks wrong, and why a joint is not to be relied on.
    details : dict
        The same as numbers.
    """

    def __init__(self, data: dict[str, Any], page_html: str | None):
        self.file = str(data["file"])
        self.kind = str(data["kind"])
        self.facts: dict[str, list[str]] = data["facts"]
        self.warnings: tuple[str, ...] = tuple(data["warnings"])
        self.reasons_against: tuple[str, ...] = tuple(data["reasons_against"])
        self.details: dict[str, Any] = data["details"]
        self._page_html = page_html

    @property
    def page_html(self) -> str:
        """The page with its pictures.

        Raises
        ------
        BoltedJointError
            If none was asked for: ``show(..., page=True)``.
        """
        return asked(self._page_html, "page_html", "page", "show makes")

    def __repr__(self) -> str:
        lines = [f"{self.file}: {self.kind}"]
        for label, facts in self.facts.items():
            lines += [f"  {label if number == 0 else '':<14}{fact}" for number, fact in enumerate(facts)]
        lines += [f"  {'warning':<14}{warning}" for warning in self.warnings]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        rows = [(label, "; ".join(facts)) for label, facts in self.facts.items()]
        rows += [("warning", warning) for warning in self.warnings]
        return table(f"{self.file}: {self.kind}", ("", ""), rows)


def show(what: Shown, *, page: bool = False) -> Look:
    """Tells what is in measured functions, modes, matrices, a study, an assembly, a joint, draws or an FMU.

    Parameters
    ----------
    what : path, Joint, Functions or Study
        What to look at.
    page : bool
        Whether the page with its pictures is made too.

    Returns
    -------
    Look

    Raises
    ------
    BoltedJointError
        If it is none of these, or cannot be read.
    """
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="bolted-joint-"))
        shown = {folder + os.sep: ""}
        what = joint_of(what)
        if isinstance(what, Functions):
            path = str(Path(folder, "functions.npz" if what.measured.all() else "functions.csv"))
            what.save(path)
        elif isinstance(what, Joint):
            path = str(Path(folder, "given.joint.json"))
            what.save(path)
        elif isinstance(what, Study):
            path, hidden = stack.enter_context(as_file(what))
            shown |= hidden
        else:
            path = path_of(what, "what", "a path, a Joint or Functions, or a Study(...)")
        drawing = Path(folder, "page.html")
        arguments = ["show", path, *(["--plot", str(drawing)] if page else [])]
        data = run(arguments, shown)[0]
        return Look(data, in_page(drawing.read_text(encoding="utf-8"), shown) if page else None)


class Comparison:
    """Joints beside each other.

    Attributes
    ----------
    names : tuple of str
        What the joints are called.
    rows : tuple of str
        Names of the numbers, such as ``"k_yy"``.
    values, standard_deviations : array of shape (numbers, joints)
        The numbers in SI units, and their standard deviations; NaN where a file states none.
    deviations : array of shape (numbers, joints - 1)
        Differences from the first joint in standard deviations of the difference; NaN where nothing tells.
    together : list
        For each other joint χ² of all unknowns together, how many they are, and the probability that chance exceeds it.
    notes : tuple of str
        What else differs.
    details : dict
        All that ``bolted-joint compare --json`` prints.
    """

    def __init__(self, names: Sequence[str], details: dict[str, Any], page_html: str | None):
        rows = details["rows"]
        self.names = tuple(names)
        self.rows: tuple[str, ...] = tuple(row["name"] for row in rows)
        self.values = _numbers(rows, "values")
        self.standard_deviations = _numbers(rows, "standard_deviations")
        self.deviations = _numbers(rows, "deviations")
        self.together: list[dict[str, Any] | None] = details["together"]
        self.notes: tuple[str, ...] = tuple(details["notes"])
        self.details = details
        self._page_html = page_html

    @property
    def page_html(self) -> str:
        """The page with its picture.

        Raises
        ------
        BoltedJointError
            If none was asked for: ``compare(..., page=True)``.
        """
        return asked(self._page_html, "page_html", "page", "compare makes")

    def plot(self) -> "Figure":
        """Draws the numbers with their intervals of 95 %.

        Returns
        -------
        matplotlib.figure.Figure
            A figure that pyplot does not keep.
        """
        from . import _plot

        return _plot.comparison(self)

    def __repr__(self) -> str:
        return f"<Comparison of {', '.join(self.names)}>"

    def _repr_html_(self) -> str:
        from ._html import with_deviation

        rows = [
            (
                f"{name}, {row['unit']}",
                *(
                    with_deviation(value, 0.0 if np.isnan(deviation) else deviation)
                    for value, deviation in zip(values, deviations, strict=True)
                ),
                *("" if np.isnan(own) else f"{own:+.1f}" for own in differences),
            )
            for name, row, values, deviations, differences in zip(
                self.rows, self.details["rows"], self.values, self.standard_deviations, self.deviations, strict=True
            )
        ]
        header = ("", *self.names, *(f"{name}: difference in std. dev." for name in self.names[1:]))
        return table("Joints beside each other", header, rows)


def compare(
    *joints: AJoint | str | os.PathLike[str], preload_n_m: float | None = None, page: bool = False
) -> Comparison:
    """Puts joints beside each other: values, and differences from the first in standard deviations.

    Parameters
    ----------
    *joints : Joint or path
        At least two.
    preload_n_m : float, optional
        Preload at which joints over the preload are compared, N·m.
    page : bool
        Whether the page with its picture is made too.

    Returns
    -------
    Comparison

    Raises
    ------
    BoltedJointError
        If the joints are not of one kind.
    """
    given: list[Any] = [joint_of(joint) for joint in joints]
    if len(given) < 2:
        raise BoltedJointError(f"joints: found {len(given)}, expected at least two")
    with tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        files = (Path(folder, f"joint-{number}.joint.json") for number in range(1, len(given) + 1))
        paths = [_joint_file(joint, file, "joints") for joint, file in zip(given, files, strict=True)]
        drawing = Path(folder, "page.html")
        arguments = ["compare", *paths]
        if preload_n_m is not None:
            arguments += ["--preload", repr(number("preload_n_m", preload_n_m))]
        if page:
            arguments += ["--plot", str(drawing)]
        names = [joint.name if isinstance(joint, Joint) else os.fspath(joint) for joint in given]
        shown = {path: name for path, name, joint in zip(paths, names, given, strict=True) if isinstance(joint, Joint)}
        shown[folder + os.sep] = ""
        details = run(arguments, shown)
        return Comparison(names, details, in_page(drawing.read_text(encoding="utf-8"), shown) if page else None)


def convert(
    joint: AJoint | Study | str | os.PathLike[str],
    tool: Tool,
    path: str | os.PathLike[str],
    *,
    nodes: tuple[int, int] | None = None,
    rotation_nodes: tuple[int, int] | None = None,
    first_number: int | None = None,
    preload_n_m: float | None = None,
    at_rest: bool = False,
    units: Units | None = None,
) -> Path:
    """Writes a joint for another tool.

    Parameters
    ----------
    joint : Joint, Study or path
        The joint, or its file; for Modelica also an assembly, as a `Study` or its file.
    tool : {"nastran", "abaqus", "calculix", "ansys", "matlab", "modelica"}
        The tool.
    path : path
        The file to write; a function of MATLAB and a package of Modelica get its name.
    nodes : pair of int, optional
        Nodes on sides a and b, for programs of finite elements; 1 and 2 if they are left out.
    rotation_nodes : pair of int, optional
        Nodes whose displacements are the rotations of sides a and b, for CalculiX; 3 and 4 if they are left out.
    first_number : int, optional
        First of free numbers for elements, properties and auxiliary nodes; 1001 if it is left out.
    preload_n_m : float, optional
        Preload at which a joint over the preload is taken, N·m.
    at_rest : bool
        Take the joint of small motion about rest: sliders stick, terms of higher order vanish.
    units : {"si", "mm"}, optional
        Units of the numbers, for programs of finite elements: N, m, kg and s, which they are if it is left out, or N, mm, t and s.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    BoltedJointError
        If the tool has no word for the joint.
    """
    with contextlib.ExitStack() as stack:
        joint = joint_of(joint)
        if isinstance(joint, Study):
            given, shown = stack.enter_context(as_file(joint))
        else:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="bolted-joint-"))
            given = _joint_file(joint, Path(folder, "given.joint.json"), "joint")
            shown = {given: joint.name if isinstance(joint, Joint) else given}
        arguments = ["convert", given, "--to", one_of("tool", tool, get_args(Tool)), "-o", path_of(path)]
        if nodes is not None:
            arguments += ["--nodes", _pair("nodes", nodes)]
        if rotation_nodes is not None:
            arguments += ["--rotation-nodes", _pair("rotation_nodes", rotation_nodes)]
        if first_number is not None:
            arguments += ["--first-number", str(whole("first_number", first_number, 1))]
        if preload_n_m is not None:
            arguments += ["--preload", repr(number("preload_n_m", preload_n_m))]
        if at_rest:
            arguments += ["--at-rest"]
        if units is not None:
            arguments += ["--units", one_of("units", units, get_args(Units))]
        run(arguments, shown)
    return Path(path)


def _joint_file(joint: object, path: Path, argument: str) -> str:
    if not isinstance(joint, Joint):
        return path_of(joint, argument, "a Joint or its file")
    joint.save(path)
    return str(path)


def _pair(argument: str, nodes: Sequence[int]) -> str:
    if not isinstance(nodes, Sequence | np.ndarray) or isinstance(nodes, str) or len(nodes) != 2:
        raise BoltedJointError(f"{argument}: found {nodes!r}, expected two numbers: those of sides a and b")
    return ",".join(str(whole(argument, node, 1)) for node in nodes)


def _numbers(rows: list[dict[str, Any]], key: str) -> NDArray[np.float64]:
    return np.array([[np.nan if own is None else own for own in row[key]] for row in rows], dtype=np.float64)
