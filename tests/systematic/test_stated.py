"""What a study states beside a value: its deviation, a mass that is known, an accelerometer; and a ground."""

import numpy as np
import pytest
import rig
from conftest import run
from rig import Mistakes


@pytest.fixture
def stated(program, tmp_path):
    """Identifies the joint of the rig from a study in which texts are replaced."""

    def stated(mistakes, edits, noise=0.01, seed=1, **options):
        sets = rig.test_data(mistakes, noise, seed)
        study = rig.write(tmp_path, sets, noise, spacing=mistakes.spacing, **options)
        text = study.read_text(encoding="utf-8")
        for old, new in edits.items():
            assert old in text, old
            text = text.replace(old, new)
        study.write_text(text, encoding="utf-8")
        return run(program, study)

    return stated


def priors(found):
    return {cause["cause"]: cause["prior"] for cause in found.budget["causes"]}


DEVIATIONS = {
    f"youngs_modulus = {rig.YOUNG}": 'youngs_modulus = "70e9 ± 1.4e9"',
    f"density = {rig.DENSITY}": 'density = "2700 +/- 0.3 %"',
    "x = 0.015": 'x = "0.015 ± 0.0002"',
    '"12:+Y" = 0.2': '"12:+Y" = "0.2 ± 0.1 %"',
    'frf = "A.npz"': 'frf = "A.npz"\naccelerometer_mass = "0 ± 0.0001"',
    'frf = "C.npz"': 'frf = "C.npz"\naccelerometer_mass = "0 ± 0"',
}


def test_a_deviation_beside_a_value_is_its_prior(stated):
    found = stated(Mistakes(), DEVIATIONS, computed_b=True)
    of = priors(found)
    expected = {
        "Young's modulus of B": 0.02,
        "density of B": 0.003,
        "position of the joint on B": 2e-4,
        "position of 12:+Y on the assembly": 2e-4,
        "mass of the accelerometer on A": 1e-4,
        # those beside which nothing stands have the general one
        "position of the joint on A": 5e-4,
        "position of 11:+Y on the assembly": 5e-4,
        "gain of A": 0.01,
    }
    for name, prior in expected.items():
        assert of[name] == pytest.approx(prior, rel=1e-12), name
    assert "mass of the accelerometer on the assembly" not in of
    assert abs(found.z).max() < 4, found.z


def test_without_a_budget_what_has_a_deviation_takes_part_alone(stated):
    found = stated(Mistakes(), DEVIATIONS, computed_b=True, budget='"none"')
    assert sorted(priors(found)) == [
        "Young's modulus of B", "density of B", "mass of the accelerometer on A", "position of 12:+Y on the assembly",
        "position of the joint on B",
    ]
    assert abs(found.z).max() < 4, found.z


def test_a_wider_deviation_widens_the_interval_and_holds_the_truth(stated):
    """Young's modulus of B is 3 % less than stated: too much for one per cent, not for five."""
    mistakes = Mistakes(young=-0.03)
    key = f"youngs_modulus = {rig.YOUNG}"
    narrow = stated(mistakes, {}, computed_b=True)
    wide = stated(mistakes, {key: 'youngs_modulus = "70e9 ± 5 %"'}, computed_b=True)
    contradicted = [cause["cause"] for cause in narrow.budget["causes"] if cause["contradicted"]]
    assert contradicted, narrow.budget["causes"]
    assert not [cause["cause"] for cause in wide.budget["causes"] if cause["contradicted"]]
    assert abs(wide.z).max() < 4, wide.z
    modulus = next(cause for cause in wide.budget["causes"] if cause["cause"] == "Young's modulus of B")
    assert modulus["value"] == pytest.approx(-0.03, abs=4 * modulus["standard_deviation"])


@pytest.mark.parametrize("budget", ['"none"', None])
@pytest.mark.parametrize("computed_b", [False, True])
def test_a_known_mass_at_the_joint_is_taken_into_account(stated, budget, computed_b):
    """A bolt of 30 g on B, 12 g on A: hundreds of deviations if nothing is said of it."""
    mistakes = Mistakes(joint_mass={"A": 0.012, "B": 0.030})
    on_b = "x = 0.015" if computed_b else 'y = "2:+Y"'
    edits = {'y = "1:+Y"': 'y = "1:+Y", mass = "0.012 ± 0.0002"', on_b: f'{on_b}, mass = "0.030 ± 1 %"'}
    quiet = 1e-4
    found = stated(mistakes, edits, noise=quiet, budget=budget, computed_b=computed_b)
    np.testing.assert_allclose(found.values[:3], rig.TRUTH[:3], rtol=0.02)
    assert abs(found.z).max() < 4, found.z
    if budget is None:
        assert priors(found)["mass at the joint on A"] == pytest.approx(2e-4)
        assert priors(found)["mass at the joint on B"] == pytest.approx(3e-4)


def test_a_moment_of_inertia_at_the_joint_is_known_or_estimated(stated):
    """8e-6 kg m² on B, as of a steel block of 30 mm; the rig adds it to the rotation at the joint."""
    mistakes = Mistakes(joint_inertia={"B": 8e-6})
    quiet = 1e-4
    wrong = stated(mistakes, {}, noise=quiet, budget='"none"')
    assert abs(wrong.values[2] / rig.TRUTH[2] - 1) > 0.02, wrong.values
    known = stated(mistakes, {'y = "2:+Y"': 'y = "2:+Y", inertia = 8e-6'}, noise=quiet, budget='"none"')
    np.testing.assert_allclose(known.values[:3], rig.TRUTH[:3], rtol=2e-3)
    budget = '{ joint_inertia = 2e-5 }'
    found = stated(mistakes, {}, noise=quiet, budget=budget)
    cause = next(cause for cause in found.budget["causes"] if cause["cause"] == "moment of inertia at the joint on B")
    assert cause["prior"] == 2e-5
    assert cause["value"] == pytest.approx(8e-6, abs=4 * cause["standard_deviation"])
    assert cause["standard_deviation"] < 1e-5
    assert abs(found.z).max() < 4, found.z


def test_a_known_accelerometer_is_taken_out(stated):
    mistakes = Mistakes(accelerometer={"A": 0.004, "B": 0.004, "C": 0.006})
    quiet = 1e-4
    wrong = stated(mistakes, {}, noise=quiet, budget='"none"')
    edits = {
        'frf = "A.npz"': 'frf = "A.npz"\naccelerometer_mass = 0.004',
        'frf = "B.npz"': 'frf = "B.npz"\naccelerometer_mass = 0.004',
        'frf = "C.npz"': 'frf = "C.npz"\naccelerometer_mass = "0.006 ± 0.00001"',
    }
    right = stated(mistakes, edits, noise=quiet, budget='"none"')
    off = lambda found: abs(found.values[:3] / rig.TRUTH[:3] - 1).max()
    assert off(wrong) > 20 * off(right), (wrong.values, right.values)
    np.testing.assert_allclose(right.values[:3], rig.TRUTH[:3], rtol=5e-3)
    careful = stated(mistakes, edits)
    of = priors(careful)
    assert of["mass of the accelerometer on the assembly"] == 1e-5
    assert of["mass of the accelerometer on A"] == 3e-4
    assert abs(careful.z).max() < 4, careful.z


@pytest.mark.parametrize("budget", ['"none"', None])
def test_a_beam_on_a_spring_to_the_ground(program, tmp_path, budget):
    """B alone on the joint, which holds it to what does not move."""
    omega = 2 * np.pi * rig.FREQUENCY
    nodes = [rig.JOINT["B"], *rig.POINTS]
    points = [("B", x, 0) for x in rig.POINTS]
    wanted = [("B", rig.JOINT["B"], 0), ("B", rig.JOINT["B"], 1), *points]
    held = rig.STIFFNESS + 1j * omega[:, None, None] * rig.DAMPING
    sets = {
        "B": rig.receptances(omega, [rig.Body("B", nodes)], wanted),
        "C": rig.receptances(omega, [rig.Body("B", nodes)], points, ground={"B": rig.JOINT["B"], "stiffness": held}),
    }
    noise = 0.01
    generator = np.random.default_rng(1)
    for name, z in sets.items():
        parts = generator.standard_normal((2, *z.shape))
        sets[name] = z * (1 + noise * (parts[0] + 1j * parts[1]) / np.sqrt(2))
    study = rig.write(tmp_path, sets, noise, budget=budget)
    text = study.read_text(encoding="utf-8")
    start, end = text.index("[a]"), text.index("[b]")
    study.write_text(text[:start] + "[a]\nground = true\n" + text[end:], encoding="utf-8")
    found = run(program, study)
    assert abs(found.z).max() < 4, found.z
    if budget:
        np.testing.assert_allclose(found.values[:3], rig.TRUTH[:3], rtol=0.1)
    else:
        names = [cause["cause"] for cause in found.budget["causes"]]
        assert "mass at the joint on B" in names and "mass at the joint on A" not in names
