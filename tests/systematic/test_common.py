"""What all sets have in common, and what is only guessed: a delay, the damping of a computed beam, the spacing of a difference."""

import numpy as np
import pytest
import rig
from conftest import identified, run
from rig import Mistakes
from test_slips import identified as slipped


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_delay_of_all_sets_is_in_the_interval_of_damping(identify, seed):
    """It equals a change of C by K τ, and no data show it."""
    delays = {name: 10e-6 for name in "ABC"}
    found = identify(Mistakes(delay=delays), seed=seed)
    assert abs(found.z).max() < 3.5, found.z
    assert "delay of all sets" in [cause["cause"] for cause in found.budget["causes"]]
    assert "delay of all sets" not in found.suspects
    exact = identify(Mistakes(delay=delays), seed=seed, budget='{ common_delay = "exact", delay = "exact" }')
    assert abs(exact.z[3]) > 3, exact.z


@pytest.mark.parametrize("factor", [2.0, 4.0])
def test_a_beam_with_another_damping_than_stated_is_named(program, tmp_path, factor):
    sets = rig.test_data(Mistakes(), 0.01, 1)
    study = rig.write(tmp_path, sets, 0.01, computed_b=True)
    text = study.read_text(encoding="utf-8")
    stated = f"loss_factor = {rig.LOSS['B']}"
    assert stated in text
    study.write_text(text.replace(stated, f"loss_factor = {factor * rig.LOSS['B']}"), encoding="utf-8")
    found = run(program, study)
    assert abs(found.z).max() < 4, found.z
    assert "damping of B" in found.suspects[:3], found.suspects
    (own,) = [cause for cause in found.budget["causes"] if cause["cause"] == "damping of B"]
    assert abs((1 + own["value"]) * factor - 1) < 0.25, own


def test_a_spacing_that_is_wrong_is_in_the_interval(program, tmp_path):
    """0.2 mm of 15 mm: the rotation is 1.3 % too small."""
    sets = rig.test_data(Mistakes(spacing=0.015), 0.01, 2)
    study = rig.write(tmp_path, sets, 0.01, spacing=0.0152, section=True)
    found = run(program, study)
    names = [cause["cause"] for cause in found.budget["causes"]]
    for side in "AB":
        assert f"spacing of the points of {side} that its rotation is of" in names
    assert abs(found.z[:3]).max() < 4, found.z
    right = identified(program, tmp_path, Mistakes(spacing=0.015), 2, 0.01, section=True)
    assert abs(right.z[:3]).max() < 4, right.z


@pytest.mark.parametrize("sets_turned", ["C", "ABC"])
def test_phases_that_are_counted_the_other_way_are_of_no_use(program, tmp_path, sets_turned):
    """The passive joint that is nearest may have the right stiffness: its damping is nothing."""
    sets = rig.test_data(Mistakes(), 0.005, 4)
    for name in sets_turned:
        sets[name] = np.conj(sets[name])
    done, found = slipped(program, tmp_path, sets)
    assert done.returncode == 3 and not found["usable"], done.stderr
    assert "are counted the other way (e^−jωt)" in done.stderr
