"""What archives of `Functions.save` have beside the arrays of any archive: deviations; and SI units."""

import os
import zipfile
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
    found = _member(path, "magnitude_deviation")
    if found is None:
        return None
    with np.load(path) as archive:
        frequency_hz = archive["frequency"]
        responses, references = archive["response"].tolist(), archive["reference"].tolist()
        power = list(_OVER_TIME).index(str(archive["quantity"]))
    lines = np.isin(frequency_hz, functions.frequency_hz)
    rows, columns = [responses.index(name) for name in functions.responses], [
        references.index(name) for name in functions.references
    ]
    part: NDArray[np.float64] = found[np.ix_(np.flatnonzero(lines), rows, columns)]
    return part / (2.0 * np.pi * frequency_hz[lines, None, None]) ** power if power else part


def _member(path: str | os.PathLike[str], name: str) -> NDArray[Any] | None:
    """An array of an archive; none where there is no such array, or no archive."""
    if not zipfile.is_zipfile(path):
        return None
    try:
        with np.load(path) as archive:
            found: NDArray[Any] | None = archive[name] if name in archive.files else None
            return found
    except (OSError, ValueError):
        return None


def _is_rotation(dof: str) -> bool:
    return dof[:-1].upper().endswith("R")
