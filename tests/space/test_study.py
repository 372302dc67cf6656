"""What a study in space may say of its files and its set-up, and what is refused before anything is computed."""

import json

import numpy as np
import pytest
from planes import Chain, Rig, definite

FREQUENCIES = np.linspace(60, 2500, 60)
TRUTH = (definite(3, 2e7), definite(4, 300.0))
SECOND = (definite(5, 3e7), definite(6, 200.0))
SOUGHT = 'model = "full"\nlength = 0.03'
EVERYWHERE = [102, 103, 201, 202, 301, 303]


def apart(found, expected):
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    return (np.abs(np.array(found) - expected) / scale).max()


def identified(run, folder):
    return run("identify", folder / "study.toml", "-o", folder / "j.joint.json", "--json")


def replaced(folder, *pairs):
    study = folder / "study.toml"
    text = study.read_text()
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    study.write_text(text)


def in_other_units(path):
    """A file of accelerances in mm/s²/N that says nothing of it."""
    data = dict(np.load(path))
    omega = 2 * np.pi * data["frequency"]
    data["frf"] = -data["frf"] * omega**2 * 1e3
    del data["quantity"]
    np.savez(path, **data)


STATED = 'quantity = "accelerance"\nunits = { length = "mm", force = "N" }\n'


@pytest.mark.parametrize("name", "abc")
def test_the_study_says_what_a_file_does_not(run, tmp_path, name):
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, budget='budget = "none"\n')
    in_other_units(tmp_path / f"{name}.npz")
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert "neither a quantity nor a unit" in told and 'quantity = "accelerance" beside frf' in told
    replaced(tmp_path, (f'frf = "{name}.npz"\n', f'frf = "{name}.npz"\n{STATED}'))
    done = identified(run, tmp_path)
    joint = json.loads(done.stdout)["joint_file"]["joint"]
    assert apart(joint["stiffness"], TRUTH[0]) < 1e-6 and apart(joint["damping"], TRUTH[1]) < 1e-6
    # of the others nobody says in what they are
    for other in "abc":
        is_told = f"{other}.npz: states no units, so SI units are assumed; state units beside frf" in done.stderr
        assert is_told == (other != name), done.stderr


def test_a_part_of_a_chain_takes_them_as_well(run, tmp_path):
    Chain([TRUTH, SECOND]).write(tmp_path, FREQUENCIES, EVERYWHERE, [SOUGHT, SOUGHT])
    data = dict(np.load(tmp_path / "b.npz"))
    np.savez(tmp_path / "b.npz", **{**data, "frf": -data["frf"] * (2 * np.pi * data["frequency"]) ** 2})
    replaced(tmp_path, ('frf = "b.npz"\n', 'frf = "b.npz"\nquantity = "accelerance"\n'))
    done = identified(run, tmp_path)
    for joint, expected in zip(json.loads(done.stdout)["joints"], (TRUTH, SECOND)):
        assert apart(joint["joint_file"]["joint"]["stiffness"], expected[0]) < 1e-6
    assert "assembly.npz: states no units" in done.stderr


@pytest.mark.parametrize(
    "pairs, fragments",
    [
        ([('frf = "a.npz"\n', 'frf = "a.npz"\nunits = { length = "parsec", force = "N" }\n')], ["`a.units`", "parsec", '"mm"']),
        ([('frf = "c.npz"\n', 'units = { length = "mm", force = "N" }\n')], ["`assembly"]),
        ([('"1001:+Y"', '"1000:+Y"')], ["`a.sensors[1]`", "1000:+Y", "`a.sensors[0]` has 1000:+Y", "a point of its own for each sensor"]),
        ([('"1001:+Y"', '"1000:-Y"')], ["`a.sensors[1]`", "1000:-Y, where `a.sensors[0]` has 1000:+Y"]),
        ([('"2052:+Y"', '"2050:+Y"')], ["`b.impacts[2]`", "`b.impacts[0]` has 2050:+Y", "a point of its own for each impact"]),
        ([('"2052:+Y"', '"1050:+Y"')], ["`b.impacts[2]`", "`a.impacts[0]` has 1050:+Y"]),
        ([("[joint]", "[frequency]\nfrom = 60\nto = 90\n[joint]")], ["`frequency`: found 1 line that all files have, at 60", "at least 2 lines"]),
        ([("[joint]", "[frequency]\nevery = 100\n[joint]")], ["`frequency`: found 1 line", "every"]),
        ([("[joint]", "[budget]\nposition = 1\n[joint]")], ["`budget.position`: found 1", "0.060 m from one sensor", "millimetres"]),
        ([("[joint]", "[budget]\nposition = 0.1\n[joint]")], ["`budget.position`: found 0.1", "millimetres"]),
        ([("[joint]", "[budget]\nposition = \"good\"\n[joint]")], ["a standard deviation or \"exact\""]),
        ([("[joint]", "[budget]\ngain = -1\n[joint]")], ["`budget.gain`: found -1", "\"exact\""]),
        ([("[joint]", "[budget]\nhits = { position = 1 }\n[joint]")], ["`budget.hits.position`: found 1", "millimetres"]),
        ([("[joint]", "[budget]\nhits = { rotation = -1 }\n[joint]")], ["`budget.hits.rotation`: found -1", "\"exact\""]),
        ([("[joint]", "[budget]\nsensors = { position = 1 }\n[joint]")], ["`budget.sensors.position`: found 1", "millimetres"]),
        ([("[joint]", "[budget]\nsensors = { rotation = -1 }\n[joint]")], ["`budget.sensors.rotation`: found -1", "\"exact\""]),
        ([("[joint]", "[budget]\nhits = 1e-3\n[joint]")], ["hits = 1e-3", "a table with position and rotation"]),
        ([("[joint]", "[budget]\nhits = { gain = 0.01 }\n[joint]")], ["`gain`", "position"]),
        ([('motions = ["y", "rz"]', "motions = []")], ["`motions`: found an empty list, expected 1 or more"]),
    ],
)
def test_what_is_wrong_is_told_by_its_key(run, tmp_path, pairs, fragments):
    Rig(*TRUTH).write(tmp_path, FREQUENCIES)
    replaced(tmp_path, *pairs)
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1, timeout=20).stderr
    for fragment in fragments:
        assert fragment in told, told
    assert not (tmp_path / "j.joint.json").exists()


def test_several_joints_have_no_report(run, tmp_path):
    Chain([TRUTH, SECOND]).write(tmp_path, FREQUENCIES, EVERYWHERE, [SOUGHT, SOUGHT])
    for option, name in (("--report", "r.html"), ("--figure", "f.svg")):
        told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", option, tmp_path / name, expect=1).stderr
        assert f"{option}: found it with 2 joints that are sought" in told, told
    assert not list(tmp_path.glob("*.joint.json"))


def test_nothing_sought_is_told_with_the_study(run, tmp_path):
    Chain([TRUTH, SECOND]).write(tmp_path, FREQUENCIES, EVERYWHERE, [SOUGHT, SOUGHT])
    joint = {"dofs": ["y", "rz"], "stiffness": TRUTH[0].tolist(), "damping": TRUTH[1].tolist()}
    (tmp_path / "known.json").write_text(json.dumps({"format": "bolted-joint/1", "name": "known", "joint": joint}))
    replaced(tmp_path, (SOUGHT, 'known = "known.json"'), (SOUGHT, 'known = "known.json"'))
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert "study.toml: `joint`: found every one known" in told, told


@pytest.mark.parametrize("exact", ['"exact"', "0"])
def test_a_part_of_the_budget_may_be_exact(run, tmp_path, exact):
    """Deviations are those of the rest: smaller than with all of it, larger than with none."""
    deviations = {}
    budgets = {
        "none": 'budget = "none"\n',
        "all exact": f"budget = {{ gain = {exact}, position = {exact}, rotation = {exact} }}\n",
        "gains": f"budget = {{ gain = 0.01, position = {exact} }}\n",
        "both": "budget = { gain = 0.01, position = 1e-3 }\n",
    }
    for name, budget in budgets.items():
        rng = np.random.default_rng(8)
        Rig(*TRUTH).write(tmp_path, FREQUENCIES, noise=1e-3, rng=rng, budget=budget)
        found = json.loads(identified(run, tmp_path).stdout)
        assert (found["budget_used"] is None) == (name in ("none", "all exact"))
        deviations[name] = np.array([one["standard_deviation"] for one in found["unknowns"]])
    assert np.array_equal(deviations["all exact"], deviations["none"])
    assert np.all(deviations["gains"] > deviations["none"])
    assert np.all(deviations["both"] > 0.98 * deviations["gains"]) and np.median(deviations["both"] / deviations["gains"]) > 1.1


def test_errors_that_are_exact_are_not_counted(run, tmp_path):
    """Squares of errors over the number of those that there may be: of five gains, and not of the positions beside them."""
    rng = np.random.default_rng(9)
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, noise=1e-3, rng=rng, budget='budget = { gain = 0.01, position = "exact", rotation = 0 }\n')
    found = json.loads(identified(run, tmp_path).stdout)
    pulls = [one["pull"] for one in found["errors"] if one["change"].startswith("gain")]
    exact = [one["value"] for one in found["errors"] if one["change"] in "xyz"]
    assert found["budget_used"] == pytest.approx(np.mean(np.square(pulls)), rel=1e-3)
    assert np.abs(exact).max() < 1e-7


def test_noise_in_per_cent_is_told(run, tmp_path):
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, noise=1e-2, rng=np.random.default_rng(3))
    assert "noise.relative: the stated noise" not in identified(run, tmp_path).stderr
    replaced(tmp_path, ("relative = 0.01", "relative = 1"))
    done = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--report", tmp_path / "r.html")
    for told in (done.stderr, (tmp_path / "r.html").read_text()):
        assert "noise.relative: the stated noise, 100 % of each function, is 1" in told, told
        assert "times as large as what the fit leaves" in told and "0.01 for 1 %" in told


def test_a_plan_has_no_signs_before_zeros(run, tmp_path):
    expected = "expected = { stiffness = [[2e7, 0], [0, 3e3]], damping = [[300, 0], [0, 0.1]] }"
    Chain([TRUTH]).write(tmp_path, FREQUENCIES, [102, 103, 201, 202], [SOUGHT + "\n" + expected])
    replaced(tmp_path, ('frf = "assembly.npz"\n', ""), ("[assembly]", "[noise]\nrelative = 0.01\n[assembly]"))
    told = run("respond", tmp_path / "study.toml", "--plan", "--add", "3").stdout
    assert " -0 " not in told and "-0," not in told and "e-2" not in told, told


@pytest.mark.parametrize(
    "key, models",
    [
        ("bolts = 4", '"bolt-circle" alone'),
        ("axis = [0.0, 0.0, 1.0]", '"bolt" or "two-bolts" or "bolt-circle" or "bolts" alone'),
        ("positions = [[0.01, 0.0, 0.0]]", '"bolts" alone'),
        ("twisted = true", '"bolt" or "two-bolts" or "bolt-circle" alone'),
    ],
)
def test_a_key_of_another_model_is_refused(run, tmp_path, key, models):
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, budget='budget = "none"\n')
    replaced(tmp_path, (SOUGHT, f"{SOUGHT}\n{key}"))
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert f'joint.{key.split()[0]}`: found it beside model = "full"' in told and models in told, told


def test_channels_that_the_assembly_does_not_have_are_told(run, tmp_path):
    """Renamed in one file: its functions would be left out in silence."""
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, budget='budget = "none"\n')
    held = dict(np.load(tmp_path / "c.npz"))
    first = held["response"][0]
    node = first.split(":")[0]
    held["response"] = [name.replace(f"{node}:", "977:") for name in held["response"].tolist()]
    np.savez(tmp_path / "c.npz", **held)
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json").stderr
    assert f"no function with the responses {node}:" in told and "its nodes 977 are of no part" in told, told


def test_frequencies_of_other_digits_are_the_same(run, tmp_path):
    """Six digits, as text files have them; one that is another is named."""
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, budget='budget = "none"\n')
    held = dict(np.load(tmp_path / "b.npz"))
    for place, other, is_same in [(7, 5e-6, True), (7, 1e-4, False)]:
        frequency = held["frequency"].copy()
        frequency[place] *= 1 + other
        np.savez(tmp_path / "b.npz", **{**held, "frequency": frequency})
        told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=0 if is_same else 1).stderr
        assert is_same or "the first that differs is" in told, told


TOLD = "`frequency`: found to 9000 Hz, but the lines of all files that are used go from 60 to 2500 Hz only"


def test_a_range_beyond_the_data_is_told(run, tmp_path):
    Rig(*TRUTH).write(tmp_path, FREQUENCIES, budget='budget = "none"\nfrequency = { to = 9000 }\n')
    done = identified(run, tmp_path)
    assert TOLD in done.stderr and any(TOLD in warning for warning in json.loads(done.stdout)["warnings"])
    # less than a line
    replaced(tmp_path, ("to = 9000", "to = 2520"))
    assert "`frequency`" not in identified(run, tmp_path).stderr


def test_a_range_beyond_the_data_of_a_chain_is_told(run, tmp_path):
    Chain([TRUTH, SECOND]).write(tmp_path, FREQUENCIES, EVERYWHERE, [SOUGHT, SOUGHT], more="frequency = { to = 9000 }\n")
    done = identified(run, tmp_path)
    assert TOLD in done.stderr and any(TOLD in warning for warning in json.loads(done.stdout)["warnings"])
