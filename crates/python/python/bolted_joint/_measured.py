"""What a study says was measured on its assemblies, and the study of one assembly with the joint that was found."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._command import BoltedJointError
from ._functions import Functions
from ._joint import Joint
from ._read import together
from ._study import AnyStudy, Study, tables_of
from ._values import place_of

#: What a table of an assembly says of its functions.
_OF_FUNCTIONS = ("frf", "quantity", "units", "averages", "coherence", "repeats")


def functions_of(study: AnyStudy, assembly: int) -> Functions:
    """The functions of one of a study's assemblies as receptances in SI units, with all that the study says of them."""
    tables = tables_of(study)
    table = assemblies(tables)[_place(tables, assembly)]
    return together(
        [one if isinstance(one, Functions) else tables.folder / one for one in _listed(table["frf"])],
        quantity=table.get("quantity"),
        averages=table.get("averages"),
        units=table.get("units"),
        coherence=[tables.folder / path for path in _listed(table.get("coherence", []))],
        # `identify` has told it
        is_quiet=True,
    )


def with_joints(study: AnyStudy, joints: Mapping[str, Joint], assembly: int) -> Study:
    """The study of one of a study's assemblies, with joints in it where it is one of joints in space."""
    tables = tables_of(study)
    table = assemblies(tables)[_place(tables, assembly)]
    if tables.get("method") == "frf-space":
        del tables["assembly"]
        tables["joint"] = _known(tables["joint"], joints)
    else:
        tables["assembly"] = [table]
        # one assembly has one joint, which is that at its torque
        tables["joint"] = {key: value for key, value in tables["joint"].items() if key != "torques"}
    return tables


def with_lines(
    study: AnyStudy, joints: Mapping[str, Joint], assembly: int, frequency_hz: NDArray[np.float64]
) -> Study:
    """As `with_joints`, with functions at these lines, which the assembly is then computed at."""
    tables = with_joints(study, joints, assembly)
    # what states no lines takes those of the functions
    tables.pop("frequency", None)
    measured = functions_of(study, assembly)
    # of an assembly that is computed only the lines are read, not the values
    shape = (len(frequency_hz), len(measured.responses), len(measured.references))
    functions = Functions(frequency_hz, np.ones(shape), measured.responses, measured.references)
    table = assemblies(tables_of(study))[assembly]
    kept = {key: value for key, value in table.items() if key not in _OF_FUNCTIONS}
    with_functions = {**kept, "frf": functions}
    tables["assembly"] = with_functions if tables.get("method") == "frf-space" else [with_functions]
    return tables


def assemblies(tables: Study) -> list[Mapping[str, Any]]:
    """The assemblies of which functions were measured.

    Raises
    ------
    BoltedJointError
        If the study has none.
    """
    found = _listed(tables.get("assembly", []))
    if not found or not all("frf" in table for table in found):
        raise BoltedJointError(
            f"found a study of method \"{tables.get('method')}\" without functions of an assembly, expected one with "
            "the key assembly.frf; details has what was measured"
        )
    return found


def _known(joint: Any, joints: Mapping[str, Joint]) -> list[dict[str, Any]]:
    """The joints of a chain, with the ones that were found in place of those that were sought."""
    places = _listed(joint)
    return [
        dict(table) if "known" in table else {"known": joints[str(number)] if len(joints) > 1 else joints[""]}
        for number, table in enumerate(places, 1)
    ]


def _place(tables: Study, assembly: int) -> int:
    return place_of("assembly", assembly, len(assemblies(tables)))


def _listed(value: Any) -> list[Any]:
    """A list, of one where there is no list."""
    return [value] if isinstance(value, Mapping | Functions | str | os.PathLike) else list(value)
