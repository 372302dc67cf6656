"""Coherence of the functions of an interface in space: it tells their noise line by line, so that intervals hold and χ² is known where
nobody states the noise. The functions are H1 estimates of averaged spectra, as an analyser has them."""

import json

import numpy as np
import pytest
from averaged import coloured, measure, of_values, white
from chains import Chain, definite
from frames import Rig

K, C = definite(1, 2e7), definite(2, 300.0)
EXACT = 'budget = "none"\n'
LINES = np.linspace(60, 1800, 40)
TOLD = "the noise that coherence and averages tell"


def identified(run, folder, expect=None):
    done = run("identify", folder / "study.toml", "-o", folder / "j.joint.json", "--json", **({} if expect is None else {"expect": expect}))
    return done.stderr if expect else (json.loads(done.stdout), done.stderr)


def in_deviations(found, truth=(K, C)):
    """Errors of all numbers of K and C in their standard deviations, where these have any."""
    uncertainty = found["joint_file"]["uncertainty"]
    own = uncertainty.get("free_estimate") or found["joint_file"]["joint"]
    errors = []
    for name, true in zip(("stiffness", "damping"), truth):
        deviations = np.array(uncertainty["standard_deviation"][name])
        is_sought = np.triu(deviations > 0)
        errors += list((np.array(own[name]) - true)[is_sought] / deviations[is_sought])
    return np.array(errors)


def rig(folder, more=EXACT):
    Rig(K, C, sensors=3, impacts=9).write(folder, LINES, more=more)


def replaced(folder, old, new):
    study = folder / "study.toml"
    text = study.read_text()
    assert old in text
    study.write_text(text.replace(old, new, 1))


def without(path, *names):
    np.savez(path, **{name: own for name, own in np.load(path).items() if name not in names})


@pytest.mark.parametrize("averages, noise", [(10, coloured(0.03)), (4, white(0.02)), (30, of_values(0.03))],
                         ids=["coloured", "few averages", "in parts of values"])
def test_intervals_hold_and_chi_squared_is_known(run, tmp_path, averages, noise):
    errors, squares = [], []
    for draw in range(2):
        rig(tmp_path)
        measure(tmp_path / "c.npz", noise, averages, np.random.default_rng(50 + draw))
        found, _ = identified(run, tmp_path)
        assert TOLD in found["joint_file"]["uncertainty"]["basis"]
        assert found["usable"], found["reasons_against"]
        errors.append(in_deviations(found))
        squares.append(found["reduced_chi_squared"])
    # 84 numbers of some twenty groups that go together
    assert 0.7 < np.sqrt(np.mean(np.square(errors))) < 1.3 and np.abs(errors).max() < 4
    # 25 920 real numbers, whose variances are told by twenty pairs of degrees of freedom or more
    assert np.abs(np.array(squares) - 1).max() < 0.08


def test_lines_that_are_known_better_count_for_more(run, tmp_path):
    rig(tmp_path)
    measure(tmp_path / "c.npz", coloured(0.03), 10, np.random.default_rng(7))
    deviation = lambda: np.array(identified(run, tmp_path)[0]["joint_file"]["uncertainty"]["standard_deviation"]["stiffness"])
    by_coherence = deviation()
    without(tmp_path / "c.npz", "coherence")
    # noise that is up to twenty times as large at some lines as at others
    assert np.median(deviation() / by_coherence) > 1.5


def test_a_value_that_is_known_badly_is_not_what_the_model_leaves_out(run, tmp_path):
    """With so few averages some are known much worse than others, and their impact seemed to move the interface."""
    Rig(K, C, sensors=3, impacts=9).write(tmp_path, np.linspace(60, 1800, 120), more=EXACT + "frequency = { every = 3 }\n")
    measure(tmp_path / "c.npz", white(0.01), 4, np.random.default_rng(1))
    found, told = identified(run, tmp_path)
    assert "no noise" not in told and found["warnings"] == [] and found["lines"] == 40
    assert abs(found["reduced_chi_squared"] - 1) < 0.08


def test_that_of_the_substructures_takes_part_line_by_line(run, tmp_path):
    rig(tmp_path, EXACT + "[noise]\na = 0.5\nrelative = 0.9\n")
    rng = np.random.default_rng(11)
    for name in "abc":
        measure(tmp_path / f"{name}.npz", coloured(0.01), 10, rng)
    found, told = identified(run, tmp_path)
    assert "noise.a is not used" in told and "noise.relative is not used" in told
    assert "line by line" in found["joint_file"]["uncertainty"]["basis"]
    errors = in_deviations(found)
    assert 0.6 < np.sqrt(np.mean(errors**2)) < 1.4 and np.abs(errors).max() < 4
    assert abs(found["reduced_chi_squared"] - 1) < 0.1


def test_it_may_be_in_a_file_of_its_own(run, tmp_path):
    rig(tmp_path)
    measure(tmp_path / "c.npz", white(0.02), 10, np.random.default_rng(3))
    inside, _ = identified(run, tmp_path)
    everything = dict(np.load(tmp_path / "c.npz"))
    names = {name: everything[name] for name in ("frequency", "response", "reference", "axes", "coherence")}
    np.savez(tmp_path / "coherence.npz", **names)
    without(tmp_path / "c.npz", "coherence", "averages")
    told = 'frf = "c.npz"\ncoherence = "coherence.npz"\n'
    replaced(tmp_path, 'frf = "c.npz"\n', told)
    assert "coherence is not used, since the number of averages is not known; state averages beside frf" in identified(run, tmp_path)[1]
    replaced(tmp_path, told, told + "averages = 10\n")
    beside, _ = identified(run, tmp_path)
    assert beside["joint_file"]["joint"] == inside["joint_file"]["joint"]
    files = [own["file"] for own in beside["joint_file"]["provenance"]["inputs"]]
    assert "coherence.npz" in files


def test_what_cannot_be_is_refused(run, tmp_path):
    cases = [
        (lambda own: own.update(coherence=own["coherence"] + 0.5), "", "c.npz: coherence 100:+X / 150:+X, line 1 (60 Hz): found 1."),
        (lambda own: own.update(coherence=own["coherence"][:, :, :-1]), "", "c.npz"),
        (lambda own: None, "averages = 0.5\n", "assembly.averages"),
        (lambda own: None, 'coherence = "a.npz"\n', "a.npz: found no coherence"),
        (lambda own: None, 'coherence = "none.npz"\n', "none.npz"),
    ]
    for change, more, expected in cases:
        rig(tmp_path)
        measure(tmp_path / "c.npz", white(0.02), 5, np.random.default_rng(3))
        own = dict(np.load(tmp_path / "c.npz"))
        change(own)
        np.savez(tmp_path / "c.npz", **own)
        replaced(tmp_path, 'frf = "c.npz"\n', 'frf = "c.npz"\n' + more)
        assert expected in identified(run, tmp_path, expect=1), expected


def test_that_of_some_functions_is_not_used(run, tmp_path):
    """Of two files one has it."""
    rig(tmp_path)
    measure(tmp_path / "c.npz", white(0.02), 10, np.random.default_rng(3))
    everything = dict(np.load(tmp_path / "c.npz"))
    for name, rows in (("c1", slice(0, 9)), ("c2", slice(9, None))):
        own = {**everything, **{key: everything[key][rows] for key in ("frf", "coherence", "response")}}
        np.savez(tmp_path / f"{name}.npz", **own)
    without(tmp_path / "c2.npz", "coherence")
    replaced(tmp_path, '"c.npz"', '["c1.npz", "c2.npz"]')
    found, told = identified(run, tmp_path)
    assert "assembly: 162 of 324 functions have coherence, and that is not used" in told
    assert found["reduced_chi_squared"] is None


def test_joints_of_a_chain_take_that_of_the_assembly(run, tmp_path):
    diagonal = [[np.diag(np.diag(own)) for own in joint] for joint in ((K, C), (definite(5, 3e7), definite(6, 200.0)))]
    chain = Chain(diagonal)
    measured = [102, 104, 200, 203, 300, 302]
    sought = 'model = "diagonal"\nlength = 0.03'
    chain.write(tmp_path, np.linspace(60, 2500, 40), measured, measured, [sought, sought], more=EXACT)
    rng = np.random.default_rng(5)
    measure(tmp_path / "assembly.npz", coloured(0.01), 8, rng)
    measure(tmp_path / "b.npz", white(1e-9), 8, rng)
    done = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json")
    found = json.loads(done.stdout)
    assert "b: its coherence is not used: chains take the noise of the assembly's functions alone" in done.stderr
    assert abs(found["reduced_chi_squared"] - 1) < 0.05
    joint = json.loads((tmp_path / "j.1.joint.json").read_text())
    assert TOLD in joint["uncertainty"]["basis"]
    errors = in_deviations({"joint_file": joint}, diagonal[0])
    # 12 numbers
    assert len(errors) == 12 and 0.4 < np.sqrt(np.mean(errors**2)) < 1.8
