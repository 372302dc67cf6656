"""Tests in a plane: spindle, holder and tool with two motions for each interface; the reference is the whole chain as one beam."""

import json

import numpy as np
import pytest
from planes import Chain, Rig, definite, joint_file

FREQUENCIES = np.linspace(60, 2500, 60)
FIRST = (definite(3, 2e7), definite(4, 300.0))
SECOND = (definite(5, 3e7), definite(6, 200.0))
SOUGHT = 'model = "full"\nlength = 0.03'
KNOWN = 'known = "known.joint.json"'
EVERYWHERE = [102, 103, 201, 202, 301, 303]
OUTSIDE = [102, 103, 301, 303]


def apart(found, expected):
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    return (np.abs(np.array(found) - expected) / scale).max()


def identified(run, folder, expect=0):
    done = run("identify", folder / "study.toml", "-o", folder / "j.joint.json", "--json", expect=expect)
    return json.loads(done.stdout)


@pytest.mark.parametrize("sought", [0, 1])
@pytest.mark.parametrize("dofs", [["y", "rz"], ["y", "theta"]])
def test_the_unknown_joint_comes_back_beside_a_known_one(run, tmp_path, sought, dofs):
    chain = Chain([FIRST, SECOND])
    joint_file(tmp_path / "known.joint.json", *[FIRST, SECOND][1 - sought], dofs)
    tables = [KNOWN, KNOWN]
    tables[sought] = SOUGHT
    chain.write(tmp_path, FREQUENCIES, OUTSIDE, tables)
    joint = identified(run, tmp_path)["joint_file"]["joint"]
    assert joint["dofs"] == ["y", "rz"]
    expected = [FIRST, SECOND][sought]
    assert apart(joint["stiffness"], expected[0]) < 1e-7 and apart(joint["damping"], expected[1]) < 1e-7


def test_with_noise_the_joint_is_in_its_intervals(run, tmp_path):
    chain = Chain([FIRST, SECOND])
    joint_file(tmp_path / "known.joint.json", *FIRST, ["y", "rz"])
    truth = np.concatenate([m[np.triu_indices(2)] for m in SECOND])
    errors = []
    for draw in range(30):
        rng = np.random.default_rng(900 + draw)
        chain.write(tmp_path, FREQUENCIES[::2], EVERYWHERE, [KNOWN, SOUGHT], noise=3e-3, rng=rng)
        unknowns = identified(run, tmp_path)["unknowns"]
        assert [u["name"] for u in unknowns] == ["k_y", "k_y_rz", "k_rz", "c_y", "c_y_rz", "c_rz"]
        errors.append([(u["free"] - t) / u["standard_deviation"] for u, t in zip(unknowns, truth)])
    assert 0.85 < np.sqrt(np.mean(np.square(errors))) < 1.15
    assert np.mean(np.abs(errors) < 1.96) > 0.9


def test_two_unknown_joints_are_told_apart(run, tmp_path):
    Chain([FIRST, SECOND]).write(tmp_path, FREQUENCIES, EVERYWHERE, [SOUGHT, SOUGHT])
    for joint, expected in zip(identified(run, tmp_path)["joints"], (FIRST, SECOND)):
        own = joint["joint_file"]["joint"]
        assert apart(own["stiffness"], expected[0]) < 1e-7 and apart(own["damping"], expected[1]) < 1e-7


def test_a_function_that_is_zero_is_left_out_of_a_chain(run, tmp_path):
    Chain([FIRST, SECOND]).write(tmp_path, FREQUENCIES, EVERYWHERE, [SOUGHT, SOUGHT])
    assembly = dict(np.load(tmp_path / "assembly.npz"))
    assembly["frf"][0, 0] = 0
    np.savez(tmp_path / "assembly.npz", **assembly)
    done = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json")
    assert "assembly: 1 of 36 functions are zero at every line and are left out" in done.stderr, done.stderr
    for joint, expected in zip(json.loads(done.stdout)["joints"], (FIRST, SECOND)):
        assert apart(joint["joint_file"]["joint"]["stiffness"], expected[0]) < 1e-7


def test_the_tool_answers_as_the_whole_beam_does(run, tmp_path):
    chain = Chain([FIRST, SECOND])
    joint_file(tmp_path / "one.joint.json", *FIRST, ["y", "theta"])
    joint_file(tmp_path / "two.joint.json", *SECOND, ["y", "rz"])
    whole = chain.write(tmp_path, FREQUENCIES, [303], ['known = "one.joint.json"', 'known = "two.joint.json"'])
    run("respond", tmp_path / "study.toml", "-o", tmp_path / "tool.csv")
    lines = [line for line in (tmp_path / "tool.csv").read_text().splitlines() if line and line[0].isdigit()]
    found = np.array([[float(x) for x in line.split(",")] for line in lines])
    at = chain.dofs.index("303:+Y")
    expected = whole[:, at, at]
    assert np.abs(found[:, 1] + 1j * found[:, 2] - expected).max() < 1e-9 * np.abs(expected).max()


def test_a_virtual_point_in_the_plane(run, tmp_path):
    """Displacements at four places along x give y and θ; nothing is asked of the four other motions."""
    Rig(*FIRST).write(tmp_path, FREQUENCIES)
    joint = identified(run, tmp_path)["joint_file"]["joint"]
    assert apart(joint["stiffness"], FIRST[0]) < 1e-6 and apart(joint["damping"], FIRST[1]) < 1e-6


def test_errors_of_places_are_in_the_intervals(run, tmp_path):
    truth = np.concatenate([m[np.triu_indices(2)] for m in FIRST])
    inside, alone = [], []
    for draw in range(20):
        rng = np.random.default_rng(300 + draw)
        errors = list(rng.normal(size=4) * 1e-3)
        Rig(*FIRST).write(tmp_path, FREQUENCIES, noise=1e-3, rng=rng, errors=errors)
        unknowns = identified(run, tmp_path)["unknowns"]
        inside += [abs(u["free"] - t) < 1.96 * u["standard_deviation"] for u, t in zip(unknowns, truth)]
        alone += [abs(u["free"] - t) < 1.96 * u["by_noise_alone"] for u, t in zip(unknowns, truth)]
    assert np.mean(inside) > 0.85, (np.mean(inside), np.mean(alone))


def test_a_plan_says_what_tests_would_give(run, tmp_path):
    """Deviations of a plan beside the scatter of tests that are simulated."""
    chain = Chain([FIRST, SECOND])
    joint_file(tmp_path / "known.joint.json", *FIRST, ["y", "rz"])
    noise = 3e-3
    expected = f"expected = {{ stiffness = {SECOND[0].tolist()}, damping = {six(SECOND[1])} }}"
    chain.write(tmp_path, FREQUENCIES[::2], EVERYWHERE, [KNOWN, SOUGHT + "\n" + expected], noise=noise, rng=np.random.default_rng(1),
                more='budget = "none"\n')
    plan = tmp_path / "plan.toml"
    plan.write_text((tmp_path / "study.toml").read_text().replace('frf = "assembly.npz"\n', ""))
    planned = json.loads(run("respond", plan, "--plan", "--json").stdout)["unknowns"]
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(plan.read_text().replace(f"stiffness = {SECOND[0].tolist()}", "stiffness = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"))
    told = run("respond", wrong, "--plan", expect=1).stderr
    assert "joint[1].expected.stiffness" in told and "found 3 rows, expected 2 rows of 2 numbers each, for the motions y, rz" in told, told
    draws = []
    for draw in range(60):
        chain.write(tmp_path, FREQUENCIES[::2], EVERYWHERE, [KNOWN, SOUGHT], noise=noise, rng=np.random.default_rng(5000 + draw))
        draws.append([u["free"] for u in identified(run, tmp_path)["unknowns"]])
    ratio = np.std(draws, axis=0, ddof=1) / [u["standard_deviation"] for u in planned]
    # of 60 draws, to 9 % each
    assert np.all(np.abs(ratio - 1) < 0.28) and abs(ratio.mean() - 1) < 0.12, ratio


def six(matrix):
    whole = np.zeros((6, 6))
    whole[np.ix_([1, 5], [1, 5])] = matrix
    return whole.tolist()


@pytest.mark.parametrize(
    "old, new, fragments",
    [
        ('["y", "rz"]', '["y", "theta"]', ["motions[1]", '"theta"', "x, y, z, rx, ry, rz"]),
        ('["y", "rz"]', "[]", ["motions", "expected 1 or more"]),
        ('["y", "rz"]', '["y", "rz", "y"]', ["motions[2]", "once more"]),
        ('motions = ["y", "rz"]\n', "", ["a.interface", "104:+X", 'motions = ["y", "rz"]']),
        ('["y", "rz"]', '["y", "rz", "z"]', ["a.interface", "104:+Z"]),
        ('model = "full"', 'model = "bolt"\naxis = [0, 0, 1]', ["joint[1]", "bolts", '"full"']),
        ('["y", "rz"]', '["rz"]', ["joint[0].known", "couples rz to other motions"]),
        ("known.joint.json", "coupled.joint.json", ["joint[0].known", "couples y, rz to other motions", "mirror plane"]),
    ],
)
def test_what_is_wrong_is_told_by_its_key(program, tmp_path, old, new, fragments):
    import subprocess

    chain = Chain([FIRST, SECOND])
    joint_file(tmp_path / "known.joint.json", *FIRST, ["y", "rz"])
    coupled = np.diag([1e7, 1e7, 1e7, 1e4, 1e4, 1e4])
    coupled[2, 5] = coupled[5, 2] = 1e5
    joint_file(tmp_path / "coupled.joint.json", coupled, 1e-4 * coupled, ["x", "y", "z", "rx", "ry", "rz"])
    chain.write(tmp_path, FREQUENCIES, EVERYWHERE, [KNOWN, SOUGHT])
    study = tmp_path / "study.toml"
    text = study.read_text()
    assert old in text
    study.write_text(text.replace(old, new))
    done = subprocess.run([program, "identify", study, "-o", tmp_path / "j.joint.json"], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 1 and not (tmp_path / "j.joint.json").exists()
    for fragment in fragments:
        assert fragment in done.stderr, done.stderr


def test_noise_of_the_substructures_is_in_the_intervals(run, tmp_path):
    truth = np.concatenate([m[np.triu_indices(2)] for m in FIRST])
    errors = []
    for draw in range(20):
        rng = np.random.default_rng(100 + draw)
        Rig(*FIRST).write(tmp_path, FREQUENCIES, noise=3e-3, rng=rng, of_sides=(3e-3, 3e-3), budget='budget = "none"\n')
        unknowns = identified(run, tmp_path)["unknowns"]
        errors.append([(u["free"] - t) / u["standard_deviation"] for u, t in zip(unknowns, truth)])
    assert 0.8 < np.sqrt(np.mean(np.square(errors))) < 1.2
    assert np.mean(np.abs(errors) < 1.96) > 0.89


def test_noise_and_errors_of_places_together(run, tmp_path):
    truth = np.concatenate([m[np.triu_indices(2)] for m in FIRST])
    inside = []
    for draw in range(10):
        rng = np.random.default_rng(400 + draw)
        errors = list(rng.normal(size=4) * 1e-3)
        Rig(*FIRST).write(tmp_path, FREQUENCIES[::2], noise=3e-3, rng=rng, errors=errors, of_sides=(3e-3, 3e-3))
        unknowns = identified(run, tmp_path)["unknowns"]
        inside += [abs(u["free"] - t) < 1.96 * u["standard_deviation"] for u, t in zip(unknowns, truth)]
    assert np.mean(inside) > 0.85, np.mean(inside)
