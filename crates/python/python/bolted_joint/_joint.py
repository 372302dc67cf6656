"""Joint files as objects."""

import copy
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._command import BoltedJointError
from ._html import table, with_deviation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MATRICES = {"stiffness": "k", "damping": "c"}


class Joint:
    """A joint, as its file has it.

    Parameters
    ----------
    data : dict
        What the joint file holds, format ``bolted-joint/1``.

    Attributes
    ----------
    data : dict
        All of the file. What is changed there is exported and saved.
    """

    def __init__(self, data: dict[str, Any]):
        self.data = data

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Joint":
        """Reads a joint file; `check` says more of what is wrong with one."""
        try:
            data = json.loads(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise BoltedJointError(f"{os.fspath(path)}: {error}") from error
        if not isinstance(data, dict) or "joint" not in data:
            raise BoltedJointError(f"{os.fspath(path)}: found no key joint, expected a joint file (JSON)")
        return cls(data)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the joint file."""
        Path(path).write_text(json.dumps(self.data, indent=2, allow_nan=False) + "\n", encoding="utf-8")

    @property
    def name(self) -> str:
        """The joint's name."""
        return str(self.data["name"])

    @property
    def dofs(self) -> tuple[str, ...]:
        """Degrees of freedom, such as ``("y", "theta")``."""
        return tuple(self.data["joint"]["dofs"])

    @property
    def stiffness(self) -> NDArray[np.float64]:
        """K over `dofs`, N/m, N/rad and N·m/rad."""
        return np.array(self.data["joint"]["stiffness"], dtype=np.float64)

    @property
    def damping(self) -> NDArray[np.float64]:
        """C over `dofs`, N·s/m, N·s/rad and N·m·s/rad."""
        return np.array(self.data["joint"]["damping"], dtype=np.float64)

    @property
    def stiffness_deviation(self) -> NDArray[np.float64] | None:
        """Standard deviation of each entry of K, if the file states it."""
        return self._uncertain("standard_deviation", "stiffness")

    @property
    def damping_deviation(self) -> NDArray[np.float64] | None:
        """Standard deviation of each entry of C, if the file states it."""
        return self._uncertain("standard_deviation", "damping")

    @property
    def stiffness_interval_95(self) -> NDArray[np.float64] | None:
        """Interval of 95 % of each entry of K: shape (N, N, 2)."""
        return self._uncertain("interval_95", "stiffness")

    @property
    def damping_interval_95(self) -> NDArray[np.float64] | None:
        """Interval of 95 % of each entry of C: shape (N, N, 2)."""
        return self._uncertain("interval_95", "damping")

    @property
    def unknowns(self) -> tuple[str, ...]:
        """Names of the unknowns, in the order of `covariance`."""
        return tuple(self._correlation().get("unknowns", ()))

    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """Covariance of the `unknowns`; none where the file has no correlation, or unknowns that are no entries."""
        places = self._places()
        correlation = self._correlation()
        if places is None or not correlation:
            return None
        deviations = {
            "stiffness": self.stiffness_deviation,
            "damping": self.damping_deviation,
        }
        sizes = np.array([deviations[matrix][place] for matrix, place in places])  # type: ignore[index]
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
        """K + iωC at each frequency (Hz): shape (F, N, N)."""
        omega = 2.0 * np.pi * np.asarray(frequency_hz, dtype=np.float64)
        return self.stiffness + 1j * omega[:, None, None] * self.damping

    def draw(self, rng: np.random.Generator) -> "Joint":
        """A joint drawn from the normal distribution of its unknowns.

        Parameters
        ----------
        rng : numpy.random.Generator
            Where the random numbers come from.

        Raises
        ------
        BoltedJointError
            If the file has no covariance.
        """
        covariance = self.covariance
        places = self._places()
        if covariance is None or places is None:
            raise BoltedJointError(f"{self.name}: found no covariance of the entries of K and C, expected one to draw from")
        change = rng.multivariate_normal(np.zeros(len(covariance)), covariance, method="eigh")
        data = copy.deepcopy(self.data)
        for size, (matrix, (row, column)) in zip(change, places, strict=True):
            entries = data["joint"][matrix]
            entries[row][column] += float(size)
            if row != column:
                entries[column][row] = entries[row][column]
        return Joint(data)

    def plot(self, **options: Any) -> "Figure":
        """Draws K + iωC over frequency; see `bolted_joint._plot.joints`."""
        from . import _plot

        return _plot.joints([self], **options)

    def __repr__(self) -> str:
        return f"<Joint {self.name!r}: {', '.join(self.dofs)}{'' if self.usable else '; not to be relied on'}>"

    def _repr_html_(self) -> str:
        against = "".join(f"; not to be relied on: {reason}" for reason in self.reasons_against)
        return table(self.name + against, ("entry", "K", "C"), self._rows())

    def _rows(self) -> list[tuple[str, str, str]]:
        size = len(self.dofs)
        deviations = [self.stiffness_deviation, self.damping_deviation]
        shown = [
            [
                with_deviation(values[entry], 0.0 if deviation is None else deviation[entry])
                for values, deviation in zip((self.stiffness, self.damping), deviations, strict=True)
            ]
            for entry in zip(*np.triu_indices(size), strict=True)
        ]
        names = [
            f"{self.dofs[row]}, {self.dofs[column]}" for row, column in zip(*np.triu_indices(size), strict=True)
        ]
        return [(name, stiffness, damping) for name, (stiffness, damping) in zip(names, shown, strict=True)]

    def _uncertain(self, what: str, matrix: str) -> NDArray[np.float64] | None:
        entries = self.data.get("uncertainty", {}).get(what)
        return None if entries is None else np.array(entries[matrix], dtype=np.float64)

    def _correlation(self) -> dict[str, Any]:
        found: dict[str, Any] = self.data.get("uncertainty", {}).get("correlation", {})
        return found

    def _places(self) -> list[tuple[str, tuple[int, int]]] | None:
        """Where in K and C each unknown stands; none where one is no entry of its own."""
        names = {}
        for matrix, letter in _MATRICES.items():
            for row, first in enumerate(self.dofs):
                for column, second in enumerate(self.dofs[row:], row):
                    for name in (f"{letter}_{first}{second}", f"{letter}_{first}_{second}"):
                        names[name] = (matrix, (row, column))
        places = [names.get(name) for name in self.unknowns]
        return None if None in places else places  # type: ignore[return-value]
