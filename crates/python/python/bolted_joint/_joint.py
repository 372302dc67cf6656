"""Joint files as objects."""

import copy
import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._command import BoltedJointError, native, path_of, run
from ._html import table, with_deviation
from ._values import array_of, checked, number, plain, whole, within

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MATRICES = {"stiffness": "k", "damping": "c"}

#: A matrix, where in the table of a joint over the preload it stands, row and column.
_Place = tuple[str, int | None, int, int]


class Joint:
    """A joint, as its file has it.

    A joint over the preload has matrices at each of its `preloads`; `at_preload` gives the joint at one of them.

    Parameters
    ----------
    data : dict
        What the joint file holds, format ``bolted-joint/1``. Arrays of NumPy may stand for lists.

    Raises
    ------
    BoltedJointError
        If it is none of these; `check` tells more of one that is.

    Attributes
    ----------
    data : dict
        All of the file. What is changed there is exported and saved.
    """

    def __init__(self, data: dict[str, Any]):
        if isinstance(data, str | os.PathLike):
            path = os.fspath(data)
            raise BoltedJointError(
                f"data: found the path {path!r}, expected a dictionary; Joint.read({path!r}) reads a file"
            )
        if not isinstance(data, Mapping):
            raise BoltedJointError(
                f"data: found an object of type {type(data).__name__}, expected what a joint file holds: a dictionary"
            )
        if missing := _missing(data):
            raise BoltedJointError(
                f"data: found a dictionary without {missing}, expected what a joint file holds, such as "
                '{"format": "bolted-joint/1", "name": "mine", "joint": {"dofs": ["y"], "stiffness": [[1e6]], "damping": [[5]]}}'
            )
        self.data = data

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Joint":
        """Reads a joint file; `check` says more of what is wrong with one."""
        path_of(path)
        try:
            data = json.loads(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            # the command line knows files of other kinds, and raises an error that says which this one is
            run(["compare", path_of(path), path_of(path)], quiet=Warning)
            raise BoltedJointError(f"{os.fspath(path)}: {error}, expected a joint file (JSON)") from error
        if not isinstance(data, dict) or "joint" not in data:
            raise BoltedJointError(f"{os.fspath(path)}: found no key joint, expected a joint file (JSON)")
        try:
            return cls(data)
        except BoltedJointError as error:
            raise BoltedJointError(f"{os.fspath(path)}: {error}") from error

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the joint file, whole or not at all.

        Parameters
        ----------
        path : path
            The file to write, such as ``NAME.joint.json``.

        Raises
        ------
        BoltedJointError
            With the key of a value that the file has no word for, such as NaN; or if the path is none.
        """
        path_of(path)
        data = checked(plain(self.data), "data")
        text = json.dumps(data, indent=2, allow_nan=False) + "\n"
        native(_native.write_file, path, text.encode())

    @property
    def name(self) -> str:
        """The joint's name."""
        return str(self.data["name"])

    @property
    def dofs(self) -> tuple[str, ...]:
        """Degrees of freedom, such as ``("y", "theta")``."""
        return tuple(self.data["joint"]["dofs"])

    @property
    def preloads(self) -> tuple[float, ...]:
        """Preloads of its table, N·m, of a joint over the preload; none of another joint."""
        return tuple(float(preload) for preload in self._table().get("preload", ()))

    @property
    def nominal_preload(self) -> float | None:
        """Preload that a joint over the preload has unless another is named, N·m; none of another joint."""
        table = self._table()
        return float(table["nominal"]) if table else None

    def at_preload(self, preload_n_m: float | None = None) -> "Joint":
        """The joint at one preload, of a joint over the preload.

        Parameters
        ----------
        preload_n_m : float, optional
            The preload, N·m, within the table; between its `preloads` the joint is interpolated. The nominal one if it
            is left out.

        Returns
        -------
        Joint
            A joint with one K and one C, whose name tells the preload. A joint that does not depend on the preload is
            as it was where none is given.

        Raises
        ------
        BoltedJointError
            If the joint has no such preload.
        """
        if not self.preloads and preload_n_m is None:
            return Joint(copy.deepcopy(self.data))
        preload = self.nominal_preload if preload_n_m is None else number("preload_n_m", preload_n_m)
        with tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
            given, fmu = Path(folder, "given.joint.json"), Path(folder, "frozen.fmu")
            self.save(given)
            arguments = ["export", str(given), "-o", str(fmu), "--preload", repr(preload)]
            # what is wrong with the joint is told where it is used
            run([*arguments, "--allow-active", "--unusable"], {str(given): self.name}, quiet=Warning)
            with zipfile.ZipFile(fmu) as archive:
                return Joint(json.loads(archive.read("resources/joint.json")))

    @property
    def stiffness(self) -> NDArray[np.float64]:
        """K over `dofs`, N/m, N/rad and N·m/rad; of a joint over the preload see `at_preload`."""
        self._want_one("stiffness")
        return np.array(self.data["joint"]["stiffness"], dtype=np.float64)

    @property
    def damping(self) -> NDArray[np.float64]:
        """C over `dofs`, N·s/m, N·s/rad and N·m·s/rad; of a joint over the preload see `at_preload`."""
        self._want_one("damping")
        return np.array(self.data["joint"]["damping"], dtype=np.float64)

    @property
    def stiffness_deviation(self) -> NDArray[np.float64] | None:
        """Standard deviation of each entry of K, if the file states it."""
        return self._uncertain("stiffness_deviation", "standard_deviation", "stiffness")

    @property
    def damping_deviation(self) -> NDArray[np.float64] | None:
        """Standard deviation of each entry of C, if the file states it."""
        return self._uncertain("damping_deviation", "standard_deviation", "damping")

    @property
    def stiffness_interval_95(self) -> NDArray[np.float64] | None:
        """Interval of 95 % of each entry of K: shape (N, N, 2)."""
        return self._uncertain("stiffness_interval_95", "interval_95", "stiffness")

    @property
    def damping_interval_95(self) -> NDArray[np.float64] | None:
        """Interval of 95 % of each entry of C: shape (N, N, 2)."""
        return self._uncertain("damping_interval_95", "interval_95", "damping")

    @property
    def unknowns(self) -> tuple[str, ...]:
        """Names of the unknowns, in the order of `covariance`; over the preload such as ``"k_yy@10"`` at 10 N·m."""
        return tuple(self._correlation().get("unknowns", ()))

    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """Covariance of the `unknowns`; none where the file has no correlation, or unknowns that are no entries."""
        places = self._places()
        correlation = self._correlation()
        if places is None or not correlation:
            return None
        sizes = np.array([self._deviations(entry)[matrix][row][column] for matrix, entry, row, column in places])
        return np.outer(sizes, sizes) * np.array(correlation["matrix"], dtype=np.float64)

    @property
    def usable(self) -> bool:
        """Whether the joint may be relied on; `reasons_against` says why not."""
        return bool(self.data.get("status", {}).get("usable", True))

    @property
    def reasons_against(self) -> tuple[str, ...]:
        """Why the joint is not to be relied on."""
        return tuple(self.data.get("status", {}).get("reasons", ()))

    def dynamic_stiffness(self, frequency_hz: ArrayLike) -> NDArray[np.complex128]:
        """K + iωC at each frequency.

        Parameters
        ----------
        frequency_hz : float or array of shape (F,)
            Frequencies, Hz.

        Returns
        -------
        complex array of shape (N, N) or (F, N, N)
            N/m, N/rad and N·m/rad; of one number the one matrix.

        Raises
        ------
        BoltedJointError
            For an array of another shape, or a joint over the preload.
        """
        omega = 2.0 * np.pi * array_of("frequency_hz", frequency_hz, np.float64)
        if omega.ndim > 1:
            raise BoltedJointError(
                f"frequency_hz: found an array of shape {omega.shape}, expected a number or an array of one axis"
            )
        return self.stiffness + 1j * omega[..., None, None] * self.damping

    def draw(self, rng: np.random.Generator | int) -> "Joint":
        """A joint drawn from the normal distribution of its unknowns, those at all preloads at once.

        Parameters
        ----------
        rng : numpy.random.Generator or int
            Where the random numbers come from. A whole number is the seed of a generator of its own: the same one draws
            the same joint.

        Raises
        ------
        BoltedJointError
            If `rng` is neither, or the file has no covariance, or one of zeros, as that of a joint with friction alone.
        """
        generator = _generator(rng)
        covariance = self.covariance
        places = self._places()
        if covariance is None or not covariance.any():
            found = "no covariance" if covariance is None else "a covariance of zeros"
            laws = ", ".join(dict.fromkeys(law["law"] for _, law in self._friction()))
            if laws:
                raise BoltedJointError(
                    f"{self.name}: found {found} of the entries of K and C, and friction ({laws}), whose uncertainty is "
                    "not in the covariance; expected one to draw from; draw the parameters of the friction from what is "
                    "known of them, and set them in data"
                )
            if covariance is not None:
                raise BoltedJointError(
                    f"{self.name}: found a covariance of zeros, expected one to draw from: each draw would be the joint"
                )
        if covariance is None or places is None:
            at = " at all preloads" if self.preloads else ""
            raise BoltedJointError(
                f"{self.name}: found no covariance of the entries of K and C{at}, expected one to draw from"
            )
        change = generator.multivariate_normal(np.zeros(len(covariance)), covariance, method="eigh")
        data = copy.deepcopy(self.data)
        for size, (matrix, entry, row, column) in zip(change, places, strict=True):
            joint = data["joint"]
            entries = joint[matrix] if entry is None else joint["over_preload"][matrix][entry]
            entries[row][column] += float(size)
            if row != column:
                entries[column][row] = entries[row][column]
        return Joint(data)

    def plot(
        self, from_hz: float | None = None, to_hz: float | None = None, preload_n_m: float | None = None
    ) -> "Figure":
        """Draws K + iωC over frequency, over the preload at each of its `preloads`.

        Of a joint that has friction alone loops of load over displacement are drawn, unless frequencies are given.

        Parameters
        ----------
        from_hz, to_hz : float, optional
            First and last frequency, Hz; if they are left out 1 Hz, and that up to which the joint was observed, or
            1000 Hz.
        preload_n_m : float, optional
            Preload at which a joint over the preload is drawn, N·m; at those of its table if it is left out, of which
            at most six are drawn.

        Returns
        -------
        matplotlib.figure.Figure
            A figure that pyplot does not keep.
        """
        from . import _plot

        if from_hz is None and to_hz is None and self._has_friction_alone():
            from ._loops import loops_of

            loops = loops_of(self if preload_n_m is None else self.at_preload(preload_n_m))
            if loops is not None:
                return _plot.response(loops, "load")
        first = 1.0 if from_hz is None else number("from_hz", from_hz, 0.0)
        last = None if to_hz is None else number("to_hz", to_hz, 0.0)
        return _plot.joints([self], first, last, preload_n_m)

    def __repr__(self) -> str:
        over = f"; at preloads of {_listed(self.preloads)} N·m" if self.preloads else ""
        return f"<Joint {self.name!r}: {', '.join(self.dofs)}{over}{'' if self.usable else '; not to be relied on'}>"

    def _repr_html_(self) -> str:
        against = "".join(f"; not to be relied on: {reason}" for reason in self.reasons_against)
        if not self.preloads:
            rows = self._rows(None) + [row for _, row in self._laws()]
            return table(self.name + against, ("entry", "K", "C"), rows)
        over = f"; over the preload, nominally {self.nominal_preload:g} N·m"
        laws = self._laws()
        rows = [
            (f"{preload:g}", *row)
            for entry, preload in enumerate(self.preloads)
            for row in [*self._rows(entry), *(row for at, row in laws if at == entry)]
        ]
        rows += [(f"{self.nominal_preload:g}", *row) for at, row in laws if at is None]
        return table(self.name + over + against, ("preload, N·m", "entry", "K", "C"), rows)

    def _rows(self, entry: int | None) -> list[tuple[str, ...]]:
        """Entries of the upper triangles, of those at a place in the table of preloads if there is one."""
        joint = self.data["joint"] if entry is None else self._table()
        deviations = self._deviations(entry)
        shown: list[tuple[str, ...]] = []
        for row, first in enumerate(self.dofs):
            for column, second in enumerate(self.dofs[row:], row):
                cells = []
                for matrix in _MATRICES:
                    values = joint[matrix] if entry is None else joint[matrix][entry]
                    deviation = deviations[matrix][row][column] if deviations else 0.0
                    cells.append(with_deviation(values[row][column], deviation))
                shown.append((f"{first}, {second}", *cells))
        return shown

    def _friction(self) -> list[tuple[int | None, dict[str, Any]]]:
        """Laws that remember, beside K and C, each with its place in the table of preloads if there is one."""
        tables = self._table().get("friction") or ()
        found: list[tuple[int | None, dict[str, Any]]] = []
        found += [(entry, law) for entry, laws in enumerate(tables) for law in laws]
        # beside a table of preloads these are stated at the nominal one
        return found or [(None, law) for law in self.data["joint"].get("friction") or ()]

    def _has_friction_alone(self) -> bool:
        """Whether K and C are zero and laws that remember are all that there is."""
        of = self._table() or self.data["joint"]
        return bool(self._friction()) and not any(np.any(of.get(matrix, 0.0)) for matrix in _MATRICES)

    def _laws(self) -> list[tuple[int | None, tuple[str, ...]]]:
        """Rows of the laws that remember, with their places in the table of preloads."""
        return [
            (
                entry,
                (
                    f"{law['dof']}, {law['law']}",
                    "; ".join(
                        f"{key} {with_deviation(value, known.get(key, 0.0))}"
                        for key, value in law.items()
                        if key not in ("dof", "law")
                    ),
                    "",
                ),
            )
            for (entry, law), known in zip(self._friction(), self._friction_deviations(), strict=True)
        ]

    def _friction_deviations(self) -> list[dict[str, Any]]:
        """Standard deviations of the numbers of each law; nothing of a law where none are known."""
        found: list[dict[str, Any]] = []
        places: dict[int | None, int] = {}
        for entry, _ in self._friction():
            number = places[entry] = places.get(entry, -1) + 1
            laws = self._deviations(entry).get("friction") or ()
            found.append(laws[number] if number < len(laws) else {})
        return found

    def _table(self) -> dict[str, Any]:
        """The table of a joint over the preload; nothing of another joint."""
        found: dict[str, Any] = self.data["joint"].get("over_preload") or {}
        return found

    def _want_one(self, name: str) -> None:
        """Refuses a joint over the preload where one matrix is asked for."""
        if self.preloads:
            raise BoltedJointError(
                f"{self.name}: found {name} over the preload (at {_listed(self.preloads)} N·m), expected that at one "
                f"preload: at_preload({self.nominal_preload:g}).{name}"
            )

    def _uncertain(self, name: str, what: str, matrix: str) -> NDArray[np.float64] | None:
        self._want_one(name)
        entries = self.data.get("uncertainty", {}).get(what)
        return None if entries is None else np.array(entries[matrix], dtype=np.float64)

    def _deviations(self, entry: int | None) -> dict[str, Any]:
        """Standard deviations of both matrices, of those at a place in the table of preloads if there is one."""
        uncertainty: dict[str, Any] = self.data.get("uncertainty") or {}
        if entry is not None:
            table = uncertainty.get("over_preload")
            if table is None:
                # what is stated of such a joint alone is that of its nominal preload
                return uncertainty.get("standard_deviation", {}) if self._is_nominal(entry) else {}
            uncertainty = table["at"][entry]
        found: dict[str, Any] = uncertainty.get("standard_deviation", {})
        return found

    def _is_nominal(self, entry: int) -> bool:
        return self.preloads[entry] == self.nominal_preload

    def _correlation(self) -> dict[str, Any]:
        uncertainty = self.data.get("uncertainty", {})
        if self.preloads:
            uncertainty = uncertainty.get("over_preload", {})
        found: dict[str, Any] = uncertainty.get("correlation", {})
        return found

    def _places(self) -> list[_Place] | None:
        """Where in K and C each unknown stands; none where one is no entry of its own."""
        at: list[tuple[int | None, str]] = [
            (entry, f"@{np.format_float_positional(preload, trim='-')}") for entry, preload in enumerate(self.preloads)
        ]
        names: dict[str, _Place] = {}
        for matrix, letter in _MATRICES.items():
            for row, first in enumerate(self.dofs):
                for column, second in enumerate(self.dofs[row:], row):
                    for name in (f"{letter}_{first}{second}", f"{letter}_{first}_{second}"):
                        for entry, ending in at or [(None, "")]:
                            names[name + ending] = (matrix, entry, row, column)
        places = [names.get(name) for name in self.unknowns]
        return None if None in places else places  # type: ignore[return-value]


class HasJoint(Protocol):
    """What was identified or predicted."""

    @property
    def joint(self) -> Joint:
        """The joint."""


#: What is taken for a joint that is at hand.
AJoint = Joint | HasJoint


def joint_of(what: Any) -> Any:
    """The joint of what was identified or predicted; anything else as it is."""
    return what if isinstance(what, Joint) or not isinstance(getattr(what, "joint", None), Joint) else what.joint


def _missing(data: Mapping[str, Any]) -> str | None:
    """The place of the first key that no joint is without, and that is not there."""
    joint = data.get("joint")
    if not isinstance(joint, Mapping):
        return within("data", "joint")
    matrices = () if joint.get("over_preload") is not None else tuple(_MATRICES)
    wanted = [(("name",), data), *((("joint", key), joint) for key in ("dofs", *matrices))]
    for keys, table in wanted:
        if table.get(keys[-1]) is None:
            place = "data"
            for key in keys:
                place = within(place, key)
            return place
    return None


def _generator(rng: Any) -> np.random.Generator:
    """The generator, or one whose seed is the whole number."""
    if isinstance(rng, np.random.Generator):
        return rng
    if isinstance(rng, int | np.integer):
        return np.random.default_rng(whole("rng", rng, 0))
    raise BoltedJointError(
        f"rng: found an object of type {type(rng).__name__}, expected a numpy.random.Generator, such as "
        "numpy.random.default_rng(1), or a whole number as its seed"
    )


def _short(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, int | float) else str(value)


def _listed(preloads: tuple[float, ...]) -> str:
    return ", ".join(f"{preload:g}" for preload in preloads)
