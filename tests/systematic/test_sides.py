"""Assemblies measured on A's side, across the joint and at the joint itself: functions from one global matrix (rig.py)."""

import subprocess

import numpy as np
import pytest
import rig
from conftest import run

POINTS_OF_A = [0.12, 0.19, 0.24]
LABELS_OF_A = ["21:+Y", "22:+Y", "23:+Y"]
LABELS_OF_B = rig.LABELS["C"]
AT_JOINT = ["1:+Y", "1:+RZ"]


def study(folder, on_a, on_b, noise=0.0, across=False, budget='"none"', seed=1, left_out_of_a=()):
    """Files and a study of an assembly at these points; `across` keeps responses of A to loads on B alone."""
    omega = 2 * np.pi * rig.FREQUENCY
    of_a = {"1:+Y": (rig.JOINT["A"], 0), "1:+RZ": (rig.JOINT["A"], 1), **{n: (x, 0) for n, x in zip(LABELS_OF_A, POINTS_OF_A)}}
    of_b = {"2:+Y": (rig.JOINT["B"], 0), "2:+RZ": (rig.JOINT["B"], 1), **{n: (x, 0) for n, x in zip(LABELS_OF_B, rig.POINTS)}}
    a, b = rig.Body("A", [rig.JOINT["A"], *POINTS_OF_A]), rig.Body("B", [rig.JOINT["B"], *rig.POINTS])
    joint = {**rig.JOINT, "stiffness": rig.STIFFNESS + 1j * omega[:, None, None] * rig.DAMPING}
    places = [("A", *of_a[n]) for n in on_a] + [("B", *of_b[n]) for n in on_b]
    sets = {
        "A": (list(of_a), rig.receptances(omega, [a], [("A", *of) for of in of_a.values()])),
        "B": (list(of_b), rig.receptances(omega, [b], [("B", *of) for of in of_b.values()])),
        "C": ([*on_a, *on_b], rig.receptances(omega, [a, b], places, joint)),
    }
    generator = np.random.default_rng(seed)
    for name, (labels, z) in sets.items():
        parts = generator.standard_normal((2, *z.shape))
        z = z * (1 + noise * (parts[0] + 1j * parts[1]) / np.sqrt(2))
        if name == "C" and across:
            responses, references = on_a, on_b
            z = z[:, : len(on_a), len(on_a) :]
            np.savez(
                folder / "C.npz", frequency=rig.FREQUENCY, frf=z, response=responses, reference=references, quantity="receptance",
                axes="frequency,response,reference",
            )
            continue
        chosen = [i for i, label in enumerate(labels) if name != "A" or label not in left_out_of_a]
        labels = [labels[i] for i in chosen]
        np.savez(
            folder / f"{name}.npz", frequency=rig.FREQUENCY, frf=z[np.ix_(range(len(z)), chosen, chosen)], response=labels,
            reference=labels, quantity="receptance", axes="frequency,response,reference",
        )
    stated = f"[noise]\nrelative = {noise}\nfloor = 0\n" if noise else ""
    path = folder / "study.toml"
    path.write_text(
        f"""method = "frf-decoupling"
name = "sides"
budget = {budget}
[a]
frf = "A.npz"
joint = {{ y = "1:+Y", theta = "1:+RZ" }}
[b]
frf = "B.npz"
joint = {{ y = "2:+Y", theta = "2:+RZ" }}
[assembly]
frf = "C.npz"
points = {on_b}
points_on_a = {on_a}
[joint]
model = "full"
rivals = false
{stated}""",
        encoding="utf-8",
    )
    return path


CASES = {
    "(3.18)": (LABELS_OF_A, [], False),
    "(3.18), at the joint": (AT_JOINT, [], False),
    "(3.19) and (3.20)": (LABELS_OF_A, LABELS_OF_B, True),
    "(3.18) to (3.21) at once": (LABELS_OF_A, LABELS_OF_B, False),
}


@pytest.mark.parametrize("equation", CASES)
def test_exact_functions_give_the_joint(program, tmp_path, equation):
    on_a, on_b, across = CASES[equation]
    path = study(tmp_path, on_a, on_b, across=across)
    done = subprocess.run([program, "identify", path, "-o", tmp_path / "j.json"], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    assert f"decoupled by {equation.split(',')[0]}" in done.stdout, done.stdout
    found = run(program, path)
    np.testing.assert_allclose(found.values, rig.TRUTH, rtol=1e-6)


@pytest.mark.parametrize("equation", ["(3.18)", "(3.19) and (3.20)", "(3.18) to (3.21) at once"])
def test_noise_on_everything_leaves_errors_within_the_intervals(program, tmp_path, equation):
    on_a, on_b, across = CASES[equation]
    found = run(program, study(tmp_path, on_a, on_b, noise=0.005, across=across))
    assert abs(found.z).max() < 3.5, found.z
    assert (found.deviation[[0, 2]] < 0.1 * rig.TRUTH[[0, 2]]).all(), found.deviation / rig.TRUTH


def test_points_on_both_sides_tell_more_than_those_of_one(program, tmp_path):
    both = run(program, study(tmp_path, LABELS_OF_A, LABELS_OF_B, noise=0.005))
    alone = run(program, study(tmp_path, [], LABELS_OF_B, noise=0.005))
    assert (both.deviation < alone.deviation).all(), both.deviation / alone.deviation


def test_the_budget_says_why_it_takes_no_part(program, tmp_path):
    found = run(program, study(tmp_path, LABELS_OF_A, LABELS_OF_B, noise=0.005, budget="{ gain = 0.01 }"))
    assert found.budget is None
    assert "assembly 1 was measured at points of A" in found.stderr


@pytest.mark.parametrize(
    ("on_a", "on_b", "left_out", "words"),
    [
        ([], [], (), "assembly.points"),
        (LABELS_OF_A, [], ("23:+Y",), "23:+Y"),
        (LABELS_OF_A, ["21:+Y"], (), "twice"),
    ],
)
def test_points_that_do_not_suffice_are_refused(program, tmp_path, on_a, on_b, left_out, words):
    path = study(tmp_path, on_a or LABELS_OF_A, LABELS_OF_B, left_out_of_a=left_out)
    text = path.read_text(encoding="utf-8")
    text = text.replace(f"points = {LABELS_OF_B}", f"points = {on_b}").replace(f"points_on_a = {LABELS_OF_A}", f"points_on_a = {on_a}")
    path.write_text(text, encoding="utf-8")
    done = subprocess.run([program, "identify", path, "-o", tmp_path / "j.json"], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode not in (0, 3) and words in done.stderr, done.stderr
