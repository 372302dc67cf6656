"""`respond`: what a test of the assembly would measure with a joint, and how laps and whole assemblies answer."""

import csv
import os
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from ._command import BoltedJointError, path_of, run
from ._functions import Functions
from ._html import table
from ._joint import AJoint, Joint, joint_of
from ._read import together
from ._study import AnyStudy, as_file
from ._values import listed, number, one_of, whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: What `respond` takes for joints: one for all bolts, or one for each by its name.
AnyJoint = AJoint | str | os.PathLike[str] | Mapping[str, Joint]


class Response:
    """How laps or an assembly answer: the table that the command line writes, as an array.

    ``response["tip"]`` is a column; ``response.complex("tip/push receptance")`` a function that the table has as real
    and imaginary part.

    Attributes
    ----------
    columns : tuple of str
        Names of the columns, such as ``"frequency"`` or ``"b.y amplitude"``.
    units : tuple of str
        Their units; empty for plain numbers.
    values : array of shape (rows, columns)
        The numbers; NaN where there is none.
    laps : array of shape (rows,)
        Names of the laps that rows are of; empty texts of an assembly, which has none.
    details : dict
        All that ``bolted-joint respond --json`` prints.
    """

    def __init__(
        self,
        columns: Sequence[str],
        units: Sequence[str],
        values: NDArray[np.float64],
        laps: NDArray[np.str_],
        details: dict[str, Any],
    ):
        self.columns = tuple(columns)
        self.units = tuple(units)
        self.values = values
        self.laps = laps
        self.details = details

    @classmethod
    def of_table(cls, path: Path, details: dict[str, Any]) -> "Response":
        """The table in a file that the command line has written."""
        with path.open(encoding="utf-8", newline="") as file:
            heads, *rows = csv.reader(file)
        first = 1 if heads[0] == "lap" else 0
        found = [re.fullmatch(r"(.*?)(?: \[([^\]]*)\])?", head) for head in heads[first:]]
        named = [(one[1], one[2] or "") for one in found if one is not None]
        numbers = [[float(cell) if cell else np.nan for cell in row[first:]] for row in rows]
        laps = np.array([row[0] if first else "" for row in rows], dtype=np.str_)
        values = np.array(numbers, dtype=np.float64).reshape(len(rows), len(named))
        return cls([name for name, _ in named], [unit for _, unit in named], values, laps, details)

    def __len__(self) -> int:
        """How many rows there are."""
        return len(self.values)

    def __iter__(self) -> Iterator[str]:
        """The names of the columns."""
        return iter(self.columns)

    def __contains__(self, column: object) -> bool:
        """Whether there is a column of this name."""
        return column in self.columns

    def keys(self) -> tuple[str, ...]:
        """The names of the columns."""
        return self.columns

    def __getitem__(self, column: str | tuple[str, str]) -> NDArray[np.float64]:
        """A column by its name."""
        if not isinstance(column, str) or column not in self.columns:
            raise BoltedJointError(f"found {column!r}, expected one of {', '.join(self.columns)}")
        values: NDArray[np.float64] = self.values[:, self.columns.index(column)]
        return values

    def complex(self, name: str) -> NDArray[np.complex128]:
        """A complex number in each row, of which the table has ``NAME real`` and ``NAME imaginary``.

        Parameters
        ----------
        name : str
            The name of both columns, without ``real``.

        Returns
        -------
        ndarray of complex, shape (rows,)
            In the columns' unit.
        """
        return self[f"{name} real"] + 1j * self[f"{name} imaginary"]

    def select(self, lap: str | None = None, level: float | None = None) -> "Response":
        """The rows of one lap, or of one level, or of both.

        Parameters
        ----------
        lap : str, optional
            The lap's name; all laps if it is left out.
        level : float, optional
            A value of the column ``level``; all levels if it is left out.

        Returns
        -------
        Response
            The same columns, with these rows.

        Raises
        ------
        BoltedJointError
            If there is no such lap or level.
        """
        rows = np.full(len(self), True)
        if lap is not None:
            if lap not in self.laps:
                names = ", ".join(dict.fromkeys(self.laps.tolist()))
                raise BoltedJointError(f"lap: found {lap!r}, expected one of {names}")
            rows &= self.laps == lap
        if level is not None:
            levels = self["level"]
            if level not in levels:
                given = ", ".join(f"{one:g}" for one in dict.fromkeys(levels.tolist()))
                raise BoltedJointError(f"level: found {level}, expected one of {given}")
            rows &= levels == level
        return Response(self.columns, self.units, self.values[rows], self.laps[rows], self.details)

    def plot(self, up: str | None = None, across: str | None = None) -> "Figure":
        """Draws one column over another, a curve for each lap and level.

        Parameters
        ----------
        up, across : str, optional
            Columns; of a complex number its name, without ``real``, for the magnitude. If they are left out, the first
            column that is no level, and the one after it that is no load over time.

        Returns
        -------
        matplotlib.figure.Figure
            A figure that pyplot does not keep.
        """
        from . import _plot

        return _plot.response(self, up, across)

    def __repr__(self) -> str:
        return f"<Response: {len(self)} rows of {', '.join(self.columns)}>"

    def _repr_html_(self) -> str:
        rows = [
            (name, unit, *(f"{end:.4g}" for end in (np.nanmin(column), np.nanmax(column))))
            for name, unit, column in zip(self.columns, self.units, self.values.T, strict=True)
            if not np.isnan(column).all()
        ]
        laps = [name for name in dict.fromkeys(self.laps.tolist()) if name]
        of = f" of {', '.join(laps)}" if laps else ""
        return table(f"{len(self)} rows{of}", ("column", "unit", "lowest", "highest"), rows)


class Plan:
    """How well a test will determine its joints, before it is made.

    Attributes
    ----------
    unknowns : tuple of str
        Names of the numbers, such as ``"k_x"``.
    joints : tuple of str
        Which joint each is of.
    values, standard_deviations : array of shape (unknowns,)
        What they are taken to be, and their standard deviations in SI units.
    by_noise_alone : array of shape (unknowns,)
        Standard deviations if sensors and impacts were where they are said to be.
    determined : array of bool of shape (unknowns,)
        Whether the test will determine them.
    additions : tuple of str
        What to add to the test, the best first.
    details : dict
        All that ``bolted-joint respond --plan --json`` prints: also why a number is not determined, and other
        candidates.
    """

    def __init__(self, details: dict[str, Any]):
        unknowns = details["unknowns"]
        self.unknowns: tuple[str, ...] = tuple(one["name"] for one in unknowns)
        self.joints: tuple[str, ...] = tuple(one["joint"] for one in unknowns)
        self.values = _numbers(unknowns, "value")
        self.standard_deviations = _numbers(unknowns, "standard_deviation")
        self.by_noise_alone = _numbers(unknowns, "by_noise_alone")
        self.determined: NDArray[np.bool_] = np.array([bool(one["is_determined"]) for one in unknowns])
        self.additions: tuple[str, ...] = tuple(one["what"] for one in details["additions"])
        self.details = details

    def __repr__(self) -> str:
        return f"<Plan: {int(self.determined.sum())} of {len(self.unknowns)} numbers will be determined>"

    def _repr_html_(self) -> str:
        rows = [
            (one["joint"], one["name"], f"{one['value']:.4g}", *_precision(one)) for one in self.details["unknowns"]
        ]
        said = f"{int(self.determined.sum())} of {len(self.unknowns)} numbers will be determined"
        heads = ("joint", "number", "taken to be", "std. dev.", "by noise alone", "why not")
        return table(said + "".join(f"; add {what}" for what in self.additions), heads, rows)


@overload
def respond(
    study: AnyStudy,
    joint: AnyJoint,
    *,
    step_hz: float | None = None,
    noise: str | None = None,
    noise_level: float = 0.01,
    noise_samples: int | None = None,
    seed: int = 1,
    deviations: bool = False,
    report: str | os.PathLike[str] | None = None,
) -> Functions: ...


@overload
def respond(
    study: AnyStudy,
    joint: None = None,
    *,
    plan: Literal[True],
    add: int | None = None,
    wanted: Sequence[str] | str = (),
    step_hz: float | None = None,
) -> Plan: ...


@overload
def respond(
    study: AnyStudy,
    joint: AnyJoint | None = None,
    *,
    step_hz: float | None = None,
    noise: str | None = None,
    noise_level: float = 0.01,
    noise_samples: int | None = None,
    seed: int = 1,
    deviations: bool = False,
    report: str | os.PathLike[str] | None = None,
) -> Functions | Response: ...


def respond(
    study: AnyStudy,
    joint: AnyJoint | None = None,
    *,
    step_hz: float | None = None,
    noise: str | None = None,
    noise_level: float = 0.01,
    noise_samples: int | None = None,
    seed: int = 1,
    deviations: bool = False,
    report: str | os.PathLike[str] | None = None,
    plan: bool = False,
    add: int | None = None,
    wanted: Sequence[str] | str = (),
) -> Functions | Response | Plan:
    """What a test of an assembly would measure, how laps or a whole assembly answer, or what a test will tell.

    Parameters
    ----------
    study : path, dict or Study
        The study of an assembly, as for `identify`, whose measured functions need not exist; one of method ``respond``,
        which names laps and what is done to them; or an assembly file with a table ``response``.
    joint : Joint, path or mapping of str to Joint, optional
        The joint that the assembly of a study of method ``frf-decoupling`` is to have; of bolts that differ that of
        each by its name. Other studies name their joints themselves: there may be a `Joint` where a file has a path.
    step_hz : float, optional
        Distance between the lines of functions, Hz; 0.25 if it is left out.
    noise : {"frf", "response"}, optional
        How noise gets into the functions of a study of method ``frf-decoupling``: each value is multiplied by a random
        factor, or responses and forces of a harmonic test at each line have white noise.
    noise_level : float
        Standard deviation of the factor, or as a fraction of the highest response.
    noise_samples : int, optional
        Samples of each harmonic test of ``"response"``; 4096 if it is left out.
    seed : int
        Seed of the noise.
    deviations : bool
        Whether functions of an assembly in space have `Functions.magnitude_deviation`, from those of the joints.
    report : path, optional
        A picture to write, of laps, of an assembly or of one in space: a name that ends in .svg or .html.
    plan : bool
        Whether to tell how well the test of a study of method ``frf-space`` will determine its joints.
    add : int, optional
        How many sensors or impacts are added to the planned test, one after the other.
    wanted : sequence of str, or str
        Numbers for which they are chosen, such as ``["k_x", "c_rz"]``; all if it is empty.

    Returns
    -------
    Functions, Response or Plan
        Receptances of a study of an assembly; the table of laps or of an assembly file; what is told of a planned test.

    Raises
    ------
    BoltedJointError
        If study or joint cannot be used.
    """
    options = of_step(step_hz)
    if report is not None:
        options += ["--report", path_of(report, "report")]
    if add is not None:
        options += ["--add", str(whole("add", add, 0))]
    if wanted:
        options += ["--for", ",".join(listed("wanted", wanted))]
    if noise is not None:
        options += ["noise", one_of("noise", noise, ("frf", "response"))]
        options += ["--level", repr(number("noise_level", noise_level))]
        if noise_samples is not None:
            options += ["--samples", str(whole("noise_samples", noise_samples, 1))]
        options += ["--seed", str(whole("seed", seed, 0))]
    return answered(study, joint, options, plan=plan, deviations=deviations)


def of_step(step_hz: float | None) -> list[str]:
    """The option of a distance between lines, Hz."""
    return [] if step_hz is None else ["--step", repr(number("step_hz", step_hz))]


def answered(
    study: AnyStudy,
    joint: AnyJoint | None,
    options: Sequence[str],
    *,
    plan: bool = False,
    deviations: bool = False,
    quiet: type[Warning] | None = None,
) -> Functions | Response | Plan:
    """What the command prints or writes with these options, without warnings of one type."""
    with as_file(study) as (path, shown), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        shown[folder + os.sep] = ""
        output, beside = Path(folder, "responses.csv"), Path(folder, "deviations.csv")
        arguments = ["respond", path]
        arguments += ["--plan"] if plan else ["-o", str(output)]
        if joint is not None:
            arguments += ["--joint", _joint_file(joint, Path(folder), shown)]
        if deviations:
            arguments += ["--deviations", str(beside)]
        details: dict[str, Any] = run([*arguments, *options], shown, quiet=quiet, stacklevel=4)
        if plan:
            return Plan(details)
        if "functions" not in details:
            return Response.of_table(output, details)
        functions = together([output])
        if deviations:
            functions.magnitude_deviation = _beside(functions, Response.of_table(beside, details))
        return functions


def _joint_file(joint: AnyJoint, folder: Path, shown: dict[str, str]) -> str:
    """The file of a joint, or the name that those of several bolts have in common."""
    if isinstance(joint, str | os.PathLike):
        return path_of(joint)
    joint = joint_of(joint)
    joints = {"": joint} if isinstance(joint, Joint) else joint
    if not isinstance(joints, Mapping) or not all(isinstance(one, Joint) for one in joints.values()):
        raise BoltedJointError(
            f"joint: found {type(joint).__name__}, expected a Joint, its file, or a dictionary with that of each bolt"
        )
    names = {}
    for bolt, one in joints.items():
        file = folder / f"given{'.' if bolt else ''}{bolt}.joint.json"
        one.save(file)
        names[str(file)] = one.name
    others = dict(shown)
    shown.clear()
    # a joint's name stands before the folder that its file is in
    shown.update(names | others)
    return str(folder / "given.joint.json")


def _beside(functions: Functions, deviations: Response) -> NDArray[np.float64]:
    found = np.full(functions.values.shape, np.nan)
    for row, response in enumerate(functions.responses):
        for column, reference in enumerate(functions.references):
            name = f"{response}/{reference} standard deviation of the magnitude"
            if name in deviations.columns:
                found[:, row, column] = deviations[name]
    return found


def _numbers(unknowns: list[dict[str, Any]], key: str) -> NDArray[np.float64]:
    return np.array([np.nan if one[key] is None else one[key] for one in unknowns], dtype=np.float64)


def _precision(unknown: dict[str, Any]) -> tuple[str, str, str]:
    if not unknown["is_determined"]:
        return "", "", unknown["reason"] or "not determined"
    return f"{unknown['standard_deviation']:.2g}", f"{unknown['by_noise_alone']:.2g}", ""
