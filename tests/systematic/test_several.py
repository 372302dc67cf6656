"""Several assemblies of the same structures with the error budget: one joint in all of them, or one for each torque."""

import json
import subprocess

import numpy as np
import pytest
import rig
from conftest import entries
from mistakes import drawn
from rig import Mistakes

NOISE = 0.01


def assemblies(monkeypatch, mistakes, factors, seed):
    """A and B measured once, and an assembly for each factor that the joint's stiffness has; each with mistakes of its own."""
    sets = rig.test_data(mistakes[0], NOISE, seed)
    stiffness = rig.STIFFNESS
    for number, (own, factor) in enumerate(zip(mistakes, factors)):
        monkeypatch.setattr(rig, "STIFFNESS", factor * stiffness)
        sets[f"C{number + 1}"] = rig.test_data(own, NOISE, 1000 * seed + number)["C"]
    monkeypatch.setattr(rig, "STIFFNESS", stiffness)
    return sets


def identify(program, folder, sets, torques=None, budget=None, edits=(), options=()):
    names = [name for name in sets if name.startswith("C") and name != "C"]
    labels = rig.LABELS["C"]
    study = rig.write(folder, {name: sets[name] for name in "ABC"}, NOISE, budget=budget)
    tables = ""
    for number, name in enumerate(names):
        np.savez(
            folder / f"{name}.npz", frequency=rig.FREQUENCY, frf=sets[name], response=labels, reference=labels,
            quantity="receptance", axes="frequency,response,reference",
        )
        torque = f"torque = {torques[number]}\n" if torques else ""
        tables += f'[[assembly]]\nfrf = "{name}.npz"\npoints = {labels}\n{torque}'
    text = study.read_text(encoding="utf-8")
    start, end = text.index("[assembly]"), text.index("[joint]")
    text = text[:start] + tables + text[end:]
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    study.write_text(text, encoding="utf-8")
    done = subprocess.run(
        [program, "identify", study, "-o", folder / "joint.json", "--json", *options],
        capture_output=True, text=True, encoding="utf-8",
    )
    assert done.returncode in (0, 3), done.stderr
    return json.loads(done.stdout), done.stderr


def of_common(whole):
    file = whole["joint_file"]
    return entries(file["joint"]), entries(file["uncertainty"]["standard_deviation"])


def of_torques(whole):
    file = whole["joint_file"]
    table, at = file["joint"]["over_preload"], file["uncertainty"]["over_preload"]["at"]
    return [
        (entries({"stiffness": k, "damping": c}), entries(uncertainty["standard_deviation"]))
        for k, c, uncertainty in zip(table["stiffness"], table["damping"], at)
    ]


def causes(whole):
    return {cause["cause"]: cause for cause in whole["budget"]["causes"]}


def test_two_assemblies_have_gains_of_their_own_and_structures_in_common(program, tmp_path, monkeypatch):
    mistakes = [Mistakes(gain={"C": 0.035}), Mistakes()]
    sets = assemblies(monkeypatch, mistakes, [1, 1], 1)
    whole, stderr = identify(program, tmp_path, sets)
    assert "take no part" not in stderr, stderr
    values, deviation = of_common(whole)
    z = (values - rig.TRUTH) / deviation
    assert abs(z).max() < 4, z
    found = causes(whole)
    # of gains only differences can be told: one that all sets have in common is a change of the joint
    first, second = found["gain of the assembly"], found["gain of assembly 2"]
    assert first["value"] - second["value"] == pytest.approx(0.035, abs=0.004)
    names = list(found)
    assert names.count("frequencies of A in the assembly") == 1 and names.count("position of 12:+Y on the assembly") == 1
    # by noise alone the truth is far outside
    plain, _ = identify(program, tmp_path, sets, budget='"none"')
    values, deviation = of_common(plain)
    assert abs((values - rig.TRUTH) / deviation).max() > 4


def test_a_second_assembly_makes_the_interval_shorter_but_not_by_noise_alone(program, tmp_path, monkeypatch):
    sets = assemblies(monkeypatch, [Mistakes(), Mistakes()], [1, 1], 2)
    both, _ = identify(program, tmp_path, sets)
    first, _ = identify(program, tmp_path, {name: of for name, of in sets.items() if name != "C2"})
    (_, two), (_, one) = of_common(both), of_common(first)
    assert (two < 1.02 * one).all(), two / one
    noise = np.array(both["budget"]["standard_deviation_of_noise"])
    # what both have in common does not average out
    assert (two[:3] > 1.5 * noise[:3]).all(), two / noise


def test_intervals_of_two_assemblies_hold_when_everything_is_a_little_wrong(program, tmp_path, monkeypatch):
    all_z = []
    for seed in range(3):
        mistakes = drawn(np.random.default_rng(500 + seed))
        sets = assemblies(monkeypatch, [mistakes, mistakes], [1, 1], 10 + seed)
        whole, _ = identify(program, tmp_path, sets, options=["--no-rivals"])
        values, deviation = of_common(whole)
        all_z.append((values - rig.TRUTH) / deviation)
    z = np.array(all_z)
    assert np.mean(abs(z) < 1.96) > 0.7, z
    assert abs(z).max() < 5, z


def test_a_joint_for_each_torque_says_why_no_cause_takes_part(program, tmp_path, monkeypatch):
    sets = assemblies(monkeypatch, [Mistakes(), Mistakes()], [1, 0.6], 3)
    separate = [('model = "full"', 'model = "full"\ntorques = "separate"')]
    whole, stderr = identify(program, tmp_path, sets, torques=[25, 10], edits=separate)
    assert whole["budget"] is None
    assert "each torque has a joint of its own" in stderr and "its deviations are those of noise alone" in stderr
    # ascending torques
    for (values, deviation), factor in zip(of_torques(whole), [0.6, 1]):
        truth = rig.TRUTH * np.array([factor] * 3 + [1] * 3)
        assert abs((values - truth) / deviation).max() < 4


def test_assemblies_with_other_points_say_why_no_cause_takes_part(program, tmp_path, monkeypatch):
    sets = assemblies(monkeypatch, [Mistakes(), Mistakes()], [1, 1], 4)
    points = str(rig.LABELS["C"])
    reordered = str(rig.LABELS["C"][::-1])
    edits = [(f'frf = "C2.npz"\npoints = {points}', f'frf = "C2.npz"\npoints = {reordered}')]
    whole, stderr = identify(program, tmp_path, sets, edits=edits)
    assert whole["budget"] is None
    assert "assembly 2 has other points than the first" in stderr
    assert "its deviations are those of noise alone" in stderr


def test_a_bootstrap_beside_the_budget_says_what_it_is(program, tmp_path, monkeypatch):
    sets = assemblies(monkeypatch, [Mistakes()], [1], 5)
    whole, stderr = identify(program, tmp_path, sets, options=["--bootstrap", "20"])
    assert "the bootstrap draws noise alone" in stderr
    drawn_alone = entries(whole["joint_file"]["uncertainty"]["bootstrap"]["standard_deviation"])
    noise = np.array(whole["budget"]["standard_deviation_of_noise"])
    assert (drawn_alone < 2 * noise).all() and (drawn_alone > 0.5 * noise).all(), drawn_alone / noise
