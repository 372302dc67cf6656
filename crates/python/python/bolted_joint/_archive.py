"""What archives of `Functions.save` have beside the arrays of any archive: deviations; and SI units."""

import os
import zipfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._functions import Functions

#: Units of a motion by time, of each quantity.
_OVER_TIME = {"receptance": "", "mobility": "/s", "accelerance": "/s^2"}


def unit(quantity: str, response: str, reference: str) -> str:
    """The SI unit of a function, such as ``m/s^2/N``."""
    motion, load = ("rad" if _is_rotation(response) else "m", "(N·m)" if _is_rotation(reference) else "N")
    return f"{motion}{_OVER_TIME[quantity]}/{load}"


def deviation(path: str | os.PathLike[str], functions: "Functions") -> NDArray[np.float64] | None:
    """Standard deviations of the magnitudes of receptances that were read from an archive, where it has them."""
    arrays = _members(path, ("magnitude_deviation", "frequency", "response", "reference", "quantity", "axes"))
    if arrays is None:
        return None
    found, frequency_hz, responses, references = (*arrays[:2], arrays[2].tolist(), arrays[3].tolist())
    # an array of this name that `save` has not written is somebody else's
    of_save = str(arrays[5]) == "frequency,response,reference" and found.shape == (
        len(frequency_hz),
        len(responses),
        len(references),
    )
    if not of_save or set(functions.responses) - set(responses) or set(functions.references) - set(references):
        return None
    power = list(_OVER_TIME).index(str(arrays[4]))
    lines = np.isin(frequency_hz, functions.frequency_hz)
    rows, columns = [responses.index(name) for name in functions.responses], [
        references.index(name) for name in functions.references
    ]
    part: NDArray[np.float64] = found[np.ix_(np.flatnonzero(lines), rows, columns)]
    return part / (2.0 * np.pi * frequency_hz[lines, None, None]) ** power if power else part


def _members(path: str | os.PathLike[str], names: Sequence[str]) -> list[NDArray[Any]] | None:
    """Arrays of an archive; none where one is not there, or there is no archive."""
    if not zipfile.is_zipfile(path):
        return None
    try:
        with np.load(path) as archive:
            return [archive[name] for name in names]
    except (OSError, ValueError, KeyError, zipfile.BadZipFile):
        return None


def _is_rotation(dof: str) -> bool:
    return dof[:-1].upper().endswith("R")
