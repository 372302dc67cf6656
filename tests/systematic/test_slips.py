"""Slips that no error bar covers: named, and the joint is not to be used."""

import json
import subprocess

import numpy as np
import pytest
import rig

GRAVITY = 9.80665


def multiplied(name, factor):
    return lambda sets: {**sets, name: sets[name] * factor}


def reversed_sign(name, rows, columns):
    def change(sets):
        changed = sets[name].copy()
        changed[:, rows] *= -1
        changed[:, :, columns] *= -1
        return {**sets, name: changed}

    return change


def exchanged(sets, columns_too):
    order = [2, 1, 0]
    changed = sets["C"][:, order]
    return {**sets, "C": changed[:, :, order] if columns_too else changed}


OMEGA = 2 * np.pi * rig.FREQUENCY[:, None, None]
SLIPS = {
    "A in millimetres": (multiplied("A", 1e3), ["functions of A have to be multiplied by 0.0010 (motions in mm?)"]),
    "assembly in g": (multiplied("C", 1 / GRAVITY), ["functions of the assembly have to be multiplied by 9.8066 (accelerations in g?)"]),
    "B with the wrong sign": (multiplied("B", -1), ["all functions of B have the wrong sign"]),
    "a response reversed": (reversed_sign("C", [1], []), ["the responses at 12:+Y have the wrong sign"]),
    "a point reversed": (reversed_sign("C", [0], [0]), ["the direction of 11:+Y is reversed"]),
    "responses exchanged": (lambda sets: exchanged(sets, False), ["the responses at 11:+Y and 13:+Y are exchanged"]),
    "points exchanged": (lambda sets: exchanged(sets, True), ["the points 11:+Y and 13:+Y are exchanged"]),
    # one of the two rotations, and no test can tell which
    "a rotation reversed": (reversed_sign("A", [1], [1]), ["the rotation at the joint of A has the wrong sign", "the rotation at the joint of B has the wrong sign"]),
    "accelerance": (lambda sets: {**sets, "C": -(OMEGA**2) * sets["C"]}, ["functions of the assembly are accelerance where the study has receptance"]),
}


def identified(program, folder, sets, is_stated=True):
    study = rig.write(folder, sets, 0.01)
    if not is_stated:
        text = study.read_text(encoding="utf-8")
        study.write_text(text[: text.index("[noise]")], encoding="utf-8")
    done = subprocess.run(
        [program, "identify", study, "-o", folder / "joint.json", "--json"], capture_output=True, text=True, encoding="utf-8"
    )
    return done, json.loads(done.stdout)


@pytest.mark.parametrize("is_stated", [True, False], ids=["noise stated", "noise not stated"])
@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_named_and_the_joint_is_refused(program, tmp_path, name, is_stated):
    change, words = SLIPS[name]
    done, found = identified(program, tmp_path, change(rig.test_data(rig.Mistakes(), 0.01, seed=3)), is_stated)
    reasons = " ".join(found["reasons_against"])
    for wanted in words:
        assert wanted in reasons
    assert done.returncode == 3
    assert found["joint_file"]["status"]["usable"] is False


def test_sound_data_are_not_suspected(program, tmp_path):
    done, found = identified(program, tmp_path, rig.test_data(rig.Mistakes(), 0.01, seed=3))
    assert done.returncode == 0 and found["reasons_against"] == []
    assert "reciprocal" not in done.stderr and "drive point" not in done.stderr
    assert "no load at the joint" not in done.stderr and "stiffer" not in done.stderr


def test_before_any_fit_a_reversed_response_breaks_reciprocity(program, tmp_path):
    change, _ = SLIPS["a response reversed"]
    done, _ = identified(program, tmp_path, change(rig.test_data(rig.Mistakes(), 0.01, seed=3)))
    assert "the function from 12:+Y to 11:+Y has the opposite sign of that from 11:+Y to 12:+Y" in done.stderr
    assert "the drive point at 12:+Y feeds energy into the structure" in done.stderr


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("a point reversed", "no load at the joint makes these functions of those of B"),
        ("assembly in g", "the assembly is stiffer at 11:+Y, 12:+Y, 13:+Y than A and B would be with a rigid joint"),
    ],
)
def test_before_any_fit_an_assembly_of_other_structures_is_told(program, tmp_path, name, words):
    change, _ = SLIPS[name]
    done, _ = identified(program, tmp_path, change(rig.test_data(rig.Mistakes(), 0.01, seed=3)))
    assert words in done.stderr
