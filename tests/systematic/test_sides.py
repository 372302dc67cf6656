"""Assemblies measured on A's side, across the joint and at the joint itself: functions from one global matrix (rig.py)."""

import subprocess

import numpy as np
import pytest
import rig
from conftest import run
from mistakes import drawn
from rig import Mistakes

POINTS_OF_A = [0.12, 0.19, 0.24]
LABELS_OF_A = ["21:+Y", "22:+Y", "23:+Y"]
LABELS_OF_B = rig.LABELS["C"]
AT_JOINT = ["1:+Y", "1:+RZ"]


def study(
    folder, on_a, on_b, noise=0.0, across=False, budget='"none"', seed=1, left_out_of_a=(), mistakes=None, places=True,
    computed_a=False,
):
    """Files and a study of an assembly at these points; `across` keeps responses of A to loads on B alone. The rows of the
    assembly are its points on B and then on A."""
    wrong = mistakes or Mistakes()
    omega = 2 * np.pi * rig.FREQUENCY
    at = {side: rig.JOINT[side] + wrong.joint_sensor.get(side, 0.0) for side in "AB"}
    said = {**dict(zip(LABELS_OF_B, rig.POINTS)), **dict(zip(LABELS_OF_A, POINTS_OF_A))}
    moved = {label: wrong.point.get(number, 0.0) for number, label in enumerate([*on_b, *on_a])}
    real = {label: x + moved.get(label, 0.0) for label, x in said.items()}

    def dofs(side, labels, own, of_points):
        joint = {f"{own}:+Y": (side, at[side], 0), f"{own}:+RZ": (side, at[side], 1)}
        return {**joint, **{label: (side, of_points[label], 0) for label in labels}}

    def bodies(of_points, scale):
        labels = {"A": LABELS_OF_A, "B": LABELS_OF_B}
        places = {side: [rig.JOINT[side], at[side], *map(of_points.get, labels[side])] for side in "AB"}
        return [rig.Body(side, x, rig.YOUNG * (1 + scale.get(side, 0.0)) ** 2) for side, x in places.items()]

    apart = {"A": dofs("A", LABELS_OF_A, 1, said), "B": dofs("B", LABELS_OF_B, 2, said)}
    together = {**dofs("A", LABELS_OF_A, 1, real), **dofs("B", LABELS_OF_B, 2, real)}
    labels = {"A": list(apart["A"]), "B": list(apart["B"]), "C": [*on_b, *on_a]}
    joint = {**rig.JOINT, "stiffness": rig.STIFFNESS * (1 + 1j * wrong.loss_factor) + 1j * omega[:, None, None] * rig.DAMPING}
    masses = [(side, rig.JOINT[side], kg) for side, kg in wrong.joint_mass.items()]
    alone = dict(zip("AB", bodies(said, {})))
    sets = {side: rig.receptances(omega, [alone[side]], list(apart[side].values())) for side in "AB"}
    wanted = [together[label] for label in labels["C"]]
    sets["C"] = rig.receptances(omega, bodies(real, wrong.frequency), wanted, joint, masses)
    translations = {name: [i for i, label in enumerate(of) if label.endswith("Y")] for name, of in labels.items()}
    sets = rig.measured(sets, omega, wrong, translations, noise, seed)
    for name, z in sets.items():
        kept = [i for i, label in enumerate(labels[name]) if name != "A" or label not in left_out_of_a]
        responses = references = [labels[name][i] for i in kept]
        z = z[np.ix_(range(len(z)), kept, kept)]
        if name == "C" and across:
            responses, references = on_a, on_b
            z = z[:, len(on_b) :, : len(on_b)]
        np.savez(
            folder / f"{name}.npz", frequency=rig.FREQUENCY, frf=z, response=responses, reference=references,
            quantity="receptance", axes="frequency,response,reference",
        )
    stated = f"[noise]\nrelative = {noise}\nfloor = 0\n" if noise else ""

    def positions(labels):
        of_labels = ", ".join(f'"{label}" = {said[label]}' for label in labels)
        return f"points = {{ {of_labels} }}" if places else ""

    measured_a = 'frf = "A.npz"\njoint = { y = "1:+Y", theta = "1:+RZ" }'
    beam = (
        f'beam = {{ length = {rig.LENGTH["A"]}, width = {rig.WIDTH}, height = {rig.HEIGHT}, youngs_modulus = {rig.YOUNG}, '
        f'density = {rig.DENSITY}, poissons_ratio = {rig.POISSON}, loss_factor = {rig.LOSS["A"]}, boundary = "fixed-free" }}\n'
        f'joint = {{ x = {rig.JOINT["A"]} }}'
    )
    path = folder / "study.toml"
    path.write_text(
        f"""method = "frf-decoupling"
name = "sides"
budget = {budget}
[a]
{beam if computed_a else measured_a}
{positions([label for label in on_a if label in said])}
[b]
frf = "B.npz"
joint = {{ y = "2:+Y", theta = "2:+RZ" }}
{positions(on_b)}
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


FULL = "{ gain = 0.01 }"  # with the other limits of a careful laboratory
SIDES = {
    "(3.18)": (LABELS_OF_A, [], False, {}),
    "(3.19) and (3.20)": (LABELS_OF_A, LABELS_OF_B, True, {}),
    "(3.18) to (3.21) at once": (LABELS_OF_A, LABELS_OF_B, False, {}),
    "A computed": (LABELS_OF_A, LABELS_OF_B, False, {"computed_a": True}),
}


@pytest.mark.parametrize("case", SIDES)
def test_intervals_hold_when_everything_is_a_little_wrong(program, tmp_path, case):
    on_a, on_b, across, options = SIDES[case]
    mistakes = drawn(np.random.default_rng(77), {"A": 5, "B": 5, "C": len(on_b) + len(on_a)})
    found = run(program, study(tmp_path, on_a, on_b, noise=0.01, across=across, budget=FULL, mistakes=mistakes, **options))
    assert found.budget is not None and found.whole["usable"], found.stderr
    assert abs(found.z).max() < 3.5, found.z
    noise = np.array(found.budget["standard_deviation_of_noise"])
    assert abs((found.values - rig.TRUTH) / noise).max() > 3
    names = [cause["cause"] for cause in found.budget["causes"]]
    moved = [f"position of {label} on the assembly" for label in [*on_b, *on_a]]
    assert set(moved) <= set(names), names


def test_a_cause_on_the_side_of_a_is_named(program, tmp_path):
    mistakes = Mistakes(point={1: 2e-3})  # of 22:+Y
    found = run(program, study(tmp_path, LABELS_OF_A, [], noise=0.01, budget=FULL, mistakes=mistakes))
    assert found.suspects[0] == "position of 22:+Y on the assembly", found.suspects
    cause = next(cause for cause in found.budget["causes"] if cause["cause"] == found.suspects[0])
    assert cause["value"] == pytest.approx(2e-3, rel=0.2)
    assert abs(found.z).max() < 3.5, found.z


def test_points_on_a_without_places_have_no_cause_of_their_own(program, tmp_path):
    found = run(program, study(tmp_path, LABELS_OF_A, LABELS_OF_B, noise=0.005, budget=FULL, places=False))
    names = [cause["cause"] for cause in found.budget["causes"]]
    assert "gain of the channel 22:+Y of A" in names and not any("position of 2" in name for name in names), names
    assert found.whole["usable"] and abs(found.z).max() < 3.5, found.z


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
