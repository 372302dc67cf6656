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
SEPARATE = [('model = "full"', 'model = "full"\ntorques = "separate"')]


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


@pytest.mark.long
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


def errors_of_torques(whole, factors):
    """Error of each unknown in its deviations, torque by torque, ascending."""
    truths = [rig.TRUTH * np.array([factor] * 3 + [1] * 3) for factor in factors]
    return np.array([(values - truth) / deviation for (values, deviation), truth in zip(of_torques(whole), truths)])


def test_a_joint_for_each_torque_has_an_error_budget(program, tmp_path, monkeypatch):
    """Data without mistakes on which the noise of A and B was once read as information: the rotational stiffness came out seven
    deviations off, and with a deviation half as large as that of one torque alone."""
    sets = assemblies(monkeypatch, [Mistakes(), Mistakes()], [1, 0.6], 5)
    whole, stderr = identify(program, tmp_path, sets, torques=[25, 10], edits=SEPARATE, options=["--no-rivals"])
    assert whole["usable"], stderr
    z = errors_of_torques(whole, [0.6, 1])
    assert abs(z).max() < 3, z
    assert whole["budget"]["suspects"] == []
    first, _ = identify(program, tmp_path, {name: of for name, of in sets.items() if name != "C2"})
    (_, deviation), (_, alone) = of_torques(whole)[1], of_common(first)
    ratio = deviation / alone
    # what both torques see of A and B makes each joint a little better known, and bends no less beside it
    assert (ratio < 1.05).all() and ratio[2] > 0.8, ratio
    names = whole["budget"]["unknowns"]
    assert names[2] == "k_thetatheta@25" and names[8] == "k_thetatheta@10"
    # A and B were measured once, whatever the torque
    found = list(causes(whole))
    assert found.count("frequencies of A in the assembly") == 1 and "gain of assembly 2" in found
    at = whole["joint_file"]["uncertainty"]["over_preload"]["at"]
    for place, name in ((0, "k_thetatheta@10"), (1, "k_thetatheta@25")):
        noise = whole["budget"]["standard_deviation_of_noise"][names.index(name)]
        assert at[place]["budget"]["noise_alone"]["stiffness"][1][1] == pytest.approx(noise)


def test_a_cause_of_a_structure_is_common_to_all_torques(program, tmp_path, monkeypatch):
    mistakes = Mistakes(delay={"A": 50e-6})
    sets = assemblies(monkeypatch, [mistakes, mistakes], [1, 0.6], 1)
    whole, stderr = identify(program, tmp_path, sets, torques=[25, 10], edits=SEPARATE, options=["--no-rivals"])
    assert whole["usable"], stderr
    assert "the data contradict the error budget: delay of A is" in stderr
    assert causes(whole)["delay of A"]["value"] == pytest.approx(50e-6, rel=0.15)
    z = errors_of_torques(whole, [0.6, 1])
    assert abs(z).max() < 4, z


def test_assemblies_with_other_points_say_why_no_cause_takes_part(program, tmp_path, monkeypatch):
    sets = assemblies(monkeypatch, [Mistakes(), Mistakes()], [1, 1], 4)
    points = str(rig.LABELS["C"])
    reordered = str(rig.LABELS["C"][::-1])
    edits = [(f'frf = "C2.npz"\npoints = {points}', f'frf = "C2.npz"\npoints = {reordered}')]
    whole, stderr = identify(program, tmp_path, sets, edits=edits)
    assert whole["budget"] is None
    assert "assembly 2 has other points than the first" in stderr
    assert "its deviations are those of noise alone" in stderr


@pytest.mark.long
def test_a_bootstrap_scatters_as_the_budget_says(program, tmp_path, monkeypatch):
    """What was read off of the set-up is drawn anew with the noise. As many draws as these tell a deviation to 11 %, whatever it is:
    the ratio of its estimate to itself has the relative deviation 1/√(2n). Drawing the causes themselves led to scatters that were
    1.2 to 1.9 times what is said."""
    draws = 40
    sets = assemblies(monkeypatch, [Mistakes()], [1], 5)
    whole, _ = identify(program, tmp_path, sets, options=["--bootstrap", str(draws), "--seed", "7", "--no-rivals"])
    record = whole["joint_file"]["uncertainty"]["bootstrap"]
    assert record["drawn"] == "noise-and-set-up" and record["converged"] >= 0.9 * draws
    ratio = entries(record["standard_deviation"]) / of_common(whole)[1]
    bound = 3 / np.sqrt(2 * record["converged"])
    assert (abs(ratio - 1) < bound).all(), (ratio, bound)
    # all six at once; those of an entry's stiffness and damping go together, so that they count as three
    assert abs(np.log(ratio).mean()) < bound / np.sqrt(3), ratio


def test_a_bootstrap_says_whether_causes_are_drawn(program, tmp_path, monkeypatch):
    sets = assemblies(monkeypatch, [Mistakes()], [1], 5)
    plain, _ = identify(program, tmp_path, sets, budget='"none"', options=["--bootstrap", "4", "--no-rivals"])
    assert plain["joint_file"]["uncertainty"]["bootstrap"]["drawn"] == "noise"
