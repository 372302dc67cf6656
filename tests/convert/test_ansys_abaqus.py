"""ANSYS commands and Abaqus decks, taken apart here: no reader of springs and matrices that others wrote is at hand.

CalculiX reads the springs of Abaqus, so that it solves with those of an uncoupled joint.
"""

import re
import shutil

import joints
import numpy as np
import pytest
import test_calculix


def ansys(text):
    """K and C over both nodes from COMBIN14 and MATRIX27, after the ANSYS Element Reference."""
    kinds, options, constants, elements, current = {}, {}, {}, [], {}
    for line in text.splitlines():
        words = line.split("!")[0].strip().split(",")
        match words:
            case ["ET", number, kind]:
                kinds[number] = kind
            case ["KEYOPT", number, key, value]:
                options[number, key] = value
            case ["R", number, *values]:
                last = constants.setdefault(number, [])
                last += map(float, values)
            case ["RMORE", *values]:
                last += map(float, values)
            case ["TYPE" | "REAL" as what, number]:
                current[what] = number
            case ["E", a, b]:
                elements.append((current["TYPE"], current["REAL"], a, b))
            case [""]:
                pass
            case _:
                raise AssertionError(line)
    k, c = np.zeros((12, 12)), np.zeros((12, 12))
    for kind, real, a, b in elements:
        assert (a, b) == ("1", "2")
        if kinds[kind] == "COMBIN14":
            place = int(options[kind, "2"]) - 1
            spring = np.zeros((6, 6))
            spring[place, place] = 1
            k += constants[real][0] * joints.of_both(spring)
            c += constants[real][1] * joints.of_both(spring)
        else:
            matrix = np.zeros((12, 12))
            matrix[np.triu_indices(12)] = constants[real]
            matrix += np.triu(matrix, 1).T
            {"4": k, "5": c}[options[kind, "3"]][:] += matrix
    return k, c


@pytest.mark.parametrize("file", [joints.diagonal(), joints.planar(), joints.coupled()], ids=["diagonal", "planar", "coupled"])
def test_ansys_elements_add_up_to_the_joint(convert, file):
    text = convert(file, "ansys", "joint.mac").read_text(encoding="ascii")
    for found, expected in zip(ansys(text), map(joints.of_both, joints.in_six(file))):
        np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_an_abaqus_connector_has_the_upper_triangles(convert):
    file = joints.coupled()
    text = convert(file, "abaqus", "joint.inp").read_text(encoding="ascii")
    assert "*CONNECTOR SECTION, ELSET=JOINT, BEHAVIOR=JOINT_BEHAVIOR\nBUSHING,\n" in text
    for keyword, expected in zip(("ELASTICITY", "DAMPING"), joints.in_six(file)):
        data = re.search(rf"^\*CONNECTOR {keyword}\n((?:[^*].*\n)+)", text, re.M).group(1)
        lines = [[float(value) for value in line.split(",")] for line in data.splitlines()]
        assert [len(line) for line in lines] == [8, 8, 5]
        found = np.zeros((6, 6))
        values = iter(sum(lines, []))
        for column in range(6):
            for row in range(column + 1):
                found[row, column] = found[column, row] = next(values)
        np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="ccx is not installed (Debian: calculix-ccx)")
def test_calculix_solves_with_the_springs_of_abaqus(convert, tmp_path):
    file = joints.joint(["x", "y", "z"], np.diag([1e6, 2e6, 3e6]), np.zeros((3, 3)))
    include = convert(file, "abaqus", "joint.inp").name
    printed = test_calculix.solve(tmp_path, include, ["*STEP", "*FREQUENCY", "12", "*END STEP"])
    rows = re.findall(r"^\s+\d+((?:\s+[-+.\dE]+){4})$", printed, re.M)
    mass, _, stiffness = test_calculix.equations(file)
    expected = np.sqrt(test_calculix.scipy.linalg.eigh(stiffness, mass, eigvals_only=True)) / (2 * np.pi)
    np.testing.assert_allclose([float(row.split()[2]) for row in rows[:12]], expected, rtol=1e-6)
