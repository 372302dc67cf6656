"""`draw` and `merge`: a bootstrap or a Monte Carlo simulation in parts, on as many machines as there are."""

import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._command import BoltedJointError, in_page, native, path_of, run
from ._html import table
from ._identify import Identification, found_in, repeated
from ._joint import Joint
from ._predict import Prediction
from ._study import AnyStudy, as_file, command_of, settled


_FORMAT = "bolted-joint-draws/1"


class Draws:
    """Some of the draws of a simulation.

    Parameters
    ----------
    text : str
        What a file of draws holds, format ``bolted-joint-draws/1``.

    Attributes
    ----------
    numbers : range
        Which draws these are.
    results : tuple of str
        Names of the results of a draw.
    values : array of shape (draws, results)
        The results in SI units; NaN where a draw has none.
    """

    def __init__(self, text: str):
        self._text = text
        data = json.loads(text)
        found = data.get("format") if isinstance(data, dict) else None
        if found != _FORMAT:
            said = "no key format" if found is None else f"the format {found!r}"
            raise BoltedJointError(f"found {said}, expected a file of draws (format {_FORMAT!r}) that draw(...) made")
        self.results: tuple[str, ...] = tuple(data["results"])
        none = [np.nan] * len(self.results)
        draws = [draw if isinstance(draw, list) else none for draw in data["draws"]]
        self.numbers = range(data["first"], data["first"] + len(draws))
        self.values: NDArray[np.float64] = np.array(draws, dtype=np.float64)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Draws":
        """Reads a file of draws; `merge` says more of what is wrong with one."""
        path_of(path)
        try:
            return cls(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise BoltedJointError(f"{os.fspath(path)}: {error}") from error

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the file of draws, whole or not at all.

        Parameters
        ----------
        path : path
            The file to write.
        """
        path_of(path)
        native(_native.write_file, path, self._text.encode())

    def __len__(self) -> int:
        return len(self.numbers)

    def __repr__(self) -> str:
        return f"<Draws {self.numbers.start}..{self.numbers.stop} of {', '.join(self.results)}>"

    def _repr_html_(self) -> str:
        made = self.values[~np.isnan(self.values).all(axis=1)]
        rows = []
        for name, values in zip(self.results, made.T, strict=True):
            known = values[~np.isnan(values)]
            deviation = known.std(ddof=1) if len(known) > 1 else np.nan
            ends = np.percentile(known, [2.5, 50.0, 97.5]) if len(known) else [np.nan] * 3
            rows.append((name, f"{deviation:.3g}", *(f"{end:.6g}" for end in ends)))
        caption = f"draws {self.numbers.start} to {self.numbers.stop - 1}, {len(made)} of {len(self)} with results"
        return table(caption, ("result", "std. dev.", "2.5 %", "median", "97.5 %"), rows)


def draw(study: AnyStudy, numbers: range, *, bootstrap: int | None = None, seed: int | None = None) -> Draws:
    """Makes some of the draws of a bootstrap (`identify`) or of a prediction with uncertain values (`predict`).

    Each draw has random numbers of its own: it is the same whichever others are made with it, and on any machine.

    Parameters
    ----------
    study : path, dict or Study
        As for `identify` or `predict`.
    numbers : range
        Which draws to make, such as ``range(1000, 2000)``.
    bootstrap : int, optional
        How many draws all parts of the bootstrap have together. A prediction's study says so itself.
    seed : int, optional
        Seed of the bootstrap.

    Returns
    -------
    Draws

    Raises
    ------
    BoltedJointError
        If the study or its files cannot be used, or has no such draws.
    """
    if not isinstance(numbers, range) or numbers.step != 1 or len(numbers) == 0 or numbers.start < 0:
        raise BoltedJointError(f"numbers: found {numbers!r}, expected a range such as range(0, 1000)")
    with as_file(study) as (path, shown), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        output = Path(folder, "part.draws.json")
        command = command_of(path, shown)
        _want_all_of(command, bootstrap)
        arguments = [command, path, "-o", str(output), "--draws", f"{numbers.start}..{numbers.stop}"]
        arguments += repeated(bootstrap, seed)
        run(arguments, shown | {folder + os.sep: ""})
        return Draws.read(output)


def _want_all_of(command: str, bootstrap: int | None) -> None:
    """Refuses a study that has no draws, and what does not say how many draws there are, or says it twice."""
    if command not in ("identify", "predict"):
        raise BoltedJointError(f"study: found one for {command}, expected one for identify or predict, with draws")
    if command == "identify" and bootstrap is None:
        raise BoltedJointError(
            "bootstrap: found nothing, expected how many draws all parts of the bootstrap have together"
        )
    if command == "predict" and bootstrap is not None:
        raise BoltedJointError(
            f"bootstrap: found {bootstrap!r}, expected nothing: the study of a prediction says how many draws there "
            "are (uncertainty.draws)"
        )


def merge(
    study: AnyStudy,
    parts: Iterable[Draws | str | os.PathLike[str]],
    *,
    rivals: bool = True,
    report: bool = False,
) -> Identification | Prediction:
    """Puts draws together that were made in parts: what one machine would have made, to the bit.

    Parameters
    ----------
    study : path, dict or Study
        The study that the draws were made from.
    parts : iterable of Draws or paths
        The parts in any order; together they have all draws, each once.
    rivals : bool
        Whether the joint model of an identification is compared with others.
    report : bool
        Whether the report is made too.

    Returns
    -------
    Identification or Prediction

    Raises
    ------
    BoltedJointError
        If a part does not belong to the study or to the others, or if draws are there twice or not at all.
    """
    if not isinstance(parts, Iterable) or isinstance(parts, str | os.PathLike | Draws):
        raise BoltedJointError(f"parts: found {parts!r}, expected a list of Draws or their files")
    # results tell of the study as it was
    given = settled(study) if isinstance(study, Mapping) else study
    with as_file(given) as (path, shown), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        command, files = command_of(path, shown), []
        for number, part in enumerate(parts):
            if isinstance(part, Draws):
                file = Path(folder, f"part-{number + 1}.draws.json")
                part.save(file)
                files.append(str(file))
            else:
                files.append(path_of(part, "parts", "Draws or their files"))
        output, page = Path(folder, "merged.joint.json"), Path(folder, "report.html")
        arguments = ["merge", path, *files, "-o", str(output)]
        if not rivals:
            arguments += ["--no-rivals"]
        if report:
            arguments += ["--report", str(page)]
        shown |= {str(output): "the joint", folder + os.sep: ""}
        details: dict[str, Any] = run(arguments, shown)
        html = in_page(page.read_text(encoding="utf-8"), shown) if report else None
        if command == "identify":
            return found_in(Path(folder), "merged", given, details, html)
        return Prediction(Joint.read(output), details, html)
