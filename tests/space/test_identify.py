"""Joints in space, identified from functions that an independent generator makes: exact, with noise, with wrong set-ups."""

import json
import re
import subprocess

import numpy as np
import pytest
from frames import LIGHT, STEEL, Frame, Rig, row

LENGTHS = np.array([1, 1, 1, 0.03, 0.03, 0.03])
UPPER = np.triu_indices(6)
FREQUENCIES = np.linspace(60, 1800, 60)
EXACT = 'budget = "none"\n'


def definite(seed, size):
    mixed = np.eye(6) + 0.3 * np.random.default_rng(seed).normal(size=(6, 6))
    return mixed @ mixed.T * np.outer(LENGTHS, LENGTHS) * size


K, C = definite(1, 2e7), definite(2, 300.0)
TRUTH = np.concatenate([K[UPPER], C[UPPER]])


def identified(run, folder, expect=0):
    done = run("identify", folder / "study.toml", "-o", folder / "j.joint.json", "--json", expect=expect)
    return json.loads(done.stdout)


def apart(found, expected):
    """Largest difference beside what couples two motions at most."""
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    return (np.abs(np.array(found) - expected) / scale).max()


def test_exact_functions_give_all_42_numbers(run, tmp_path):
    Rig(K, C).write(tmp_path, FREQUENCIES, more=EXACT)
    found = identified(run, tmp_path)
    assert found["misfits"] == []
    joint = found["joint_file"]["joint"]
    assert joint["dofs"] == ["x", "y", "z", "rx", "ry", "rz"]
    assert apart(joint["stiffness"], K) < 1e-7 and apart(joint["damping"], C) < 1e-7
    # and the FMU has them
    run("export", tmp_path / "j.joint.json", "-o", tmp_path / "j.fmu")
    assert "no problem found" in run("check", tmp_path / "j.fmu").stdout


def test_a_bolt_has_five_numbers(run, tmp_path):
    k, z, t, r, c = 2e7, 5e7, 6e3, 9e3, 1e5
    stiffness = np.diag([k, k, z, t, t, r])
    stiffness[0, 4] = stiffness[4, 0] = c
    stiffness[1, 3] = stiffness[3, 1] = -c
    rig = Rig(stiffness, 2e-5 * stiffness, sensors=3, impacts=9)
    rig.write(tmp_path, FREQUENCIES[::3], more=EXACT, model='model = "bolt"')
    found = identified(run, tmp_path)
    assert [u["name"] for u in found["unknowns"][:5]] == ["k_x", "k_z", "k_rx", "k_rz", "k_x_ry"]
    assert [u["value"] for u in found["unknowns"][:5]] == pytest.approx([k, z, t, r, c], rel=1e-7)
    assert apart(found["joint_file"]["joint"]["stiffness"], stiffness) < 1e-7


def test_an_interface_can_be_a_node(run, tmp_path):
    """Functions of a node with six motions, as finite elements give them, in place of sensors and impacts."""
    rig = Rig(K, C)
    six = np.eye(6)
    functions = rig.functions(FREQUENCIES[::2], [(six, six), (six, six)])
    axes = ["+X", "+Y", "+Z", "+RX", "+RY", "+RZ"]
    names = [[f"{node}:{axis}" for axis in axes] for node in (1, 2)]
    names.append(names[0] + names[1])
    for file, frf, dofs in zip("abc", functions, names):
        np.savez(tmp_path / f"{file}.npz", frequency=FREQUENCIES[::2], frf=frf, response=dofs, reference=dofs,
                 quantity="receptance", axes="response,reference,frequency")
    (tmp_path / "study.toml").write_text(
        'method = "frf-space"\nname = "nodes"\n[a]\nfrf = "a.npz"\ninterface = 1\n[b]\nfrf = "b.npz"\ninterface = 2\n'
        '[assembly]\nfrf = "c.npz"\n[joint]\nmodel = "full"\nlength = 0.03\n'
    )
    joint = identified(run, tmp_path)["joint_file"]["joint"]
    assert apart(joint["stiffness"], K) < 1e-7 and apart(joint["damping"], C) < 1e-7


def scatter(run, folder, draws, write):
    """Errors of all unknowns in standard deviations, and the last result; matrices are passive."""
    errors = []
    for draw in range(draws):
        write(np.random.default_rng(100 + draw))
        found = identified(run, folder)
        errors.append([(u["free"] - t) / u["standard_deviation"] for u, t in zip(found["unknowns"], TRUTH)])
        for key in ("stiffness", "damping"):
            matrix = np.array(found["joint_file"]["joint"][key])
            assert np.linalg.eigvalsh(matrix / np.outer(LENGTHS, LENGTHS))[0] >= 0
    return np.array(errors), found


def test_with_noise_the_errors_are_those_that_are_stated(run, tmp_path):
    """42 unknowns × 12 tests: r.m.s. of the errors and coverage, pooled."""
    rig = Rig(K, C)
    errors, _ = scatter(run, tmp_path, 12, lambda rng: rig.write(tmp_path, FREQUENCIES, noise=0.01, rng=rng, more=EXACT))
    assert 0.85 < np.sqrt(np.mean(errors**2)) < 1.15
    assert 0.92 <= np.mean(np.abs(errors) < 1.96) <= 0.98


def test_small_errors_of_the_set_up_are_in_the_intervals(run, tmp_path):
    """Sensors and impacts 0.1 mm and 1 mrad off, gains by 0.1 %: a hundred times the error of the noise, and stated."""
    rig = Rig(K, C)
    budget = "budget = { position = 1e-4, rotation = 1e-3, gain = 1e-3 }\n"

    def write(rng):
        rows = [rig.rows(side, (rng, 1e-4, 1e-3, 1e-3)) for side in range(2)]
        rig.write(tmp_path, FREQUENCIES[::2], noise=0.002, rng=rng, rows=rows, more=budget)

    errors, _ = scatter(run, tmp_path, 8, write)
    assert "no problem found" in run("check", tmp_path / "j.joint.json").stdout
    assert np.mean(np.abs(errors) < 1.96) >= 0.9
    assert np.sqrt(np.mean(errors**2)) > 0.6


@pytest.mark.long
def test_sensors_a_millimetre_and_a_degree_off_are_in_the_intervals(run, tmp_path):
    """And gains by 1 %: with an exact set-up the search would find nothing; stiffness to 1 % is what is left."""
    rig = Rig(K, C)
    budget = "budget = { position = 1e-3, rotation = 0.01745, gain = 0.01 }\n"

    def write(rng):
        rows = [rig.rows(side, (rng, 1e-3, 0.01745, 0.01)) for side in range(2)]
        rig.write(tmp_path, FREQUENCIES[::2], noise=0.002, rng=rng, rows=rows, more=budget)

    errors, found = scatter(run, tmp_path, 4, write)
    assert np.mean(np.abs(errors) < 1.96) >= 0.9
    assert np.sqrt(np.mean(errors**2)) > 0.6
    deviations = [u["standard_deviation"] for u in found["unknowns"][:21]]
    assert np.median(deviations / np.sqrt(np.outer(np.diag(K), np.diag(K)))[UPPER]) < 0.02
    assert found["budget_used"] < 1.5 and found["misfits"] == []


@pytest.mark.long
@pytest.mark.parametrize("seed, lines", [(3, 30), (4, 30), (4, 60)])
def test_a_bolt_is_found_beside_errors_of_the_set_up(run, tmp_path, seed, lines):
    """Five numbers leave the search less room than 42: from places of the drawing alone it ended in other minima."""
    stiffness = np.diag([2e7, 2e7, 5e7, 6e3, 6e3, 9e3])
    stiffness[0, 4] = stiffness[4, 0] = 1e5
    stiffness[1, 3] = stiffness[3, 1] = -1e5
    rig, rng = Rig(stiffness, 2e-5 * stiffness), np.random.default_rng(seed)
    rows = [rig.rows(side, (rng, 1e-3, 0.01745, 0.01)) for side in range(2)]
    budget = "budget = { position = 1e-3, rotation = 0.01745, gain = 0.01 }\n"
    rig.write(tmp_path, np.linspace(60, 1800, lines), noise=0.01, rng=rng, rows=rows, more=budget, model='model = "bolt"')
    found = identified(run, tmp_path)
    assert 0.95 < found["reduced_chi_squared"] < 1.05
    truth = np.array([2e7, 5e7, 6e3, 9e3, 1e5])
    z = [(u["free"] - t) / u["standard_deviation"] for u, t in zip(found["unknowns"], np.concatenate([truth, 2e-5 * truth]))]
    assert np.abs(z).max() < 3.5, z


def test_a_model_that_is_too_simple_is_told(run, tmp_path):
    """Errors of the set-up make up for what the model leaves out: neither χ² nor the budget shows it."""
    stiffness = np.diag([2e7, 2e7, 5e7, 6e3, 6e3, 9e3])
    budget = "budget = { position = 1e-3, rotation = 0.01745, gain = 0.01 }\n"
    told = []
    for second in (2e7, 2.6e7):
        stiffness[1, 1] = second
        rng = np.random.default_rng(8)
        rig = Rig(stiffness, 2e-5 * stiffness)
        rows = [rig.rows(side, (rng, 1e-3, 0.01745, 0.01)) for side in range(2)]
        rig.write(tmp_path, FREQUENCIES[::3], noise=0.01, rng=rng, rows=rows, more=budget, model='model = "bolt"')
        is_true = second == 2e7
        done = run(
            "identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--report", tmp_path / "r.html", "--json",
            expect=0 if is_true else 3,
        )
        assert json.loads(done.stdout)["reduced_chi_squared"] < 1.1
        told.append("a joint of all numbers would fit better" in done.stderr)
        assert ("the joint is not what its model says" in done.stderr) != is_true
        assert told[-1] == ("a joint of all numbers would fit better" in (tmp_path / "r.html").read_text(encoding="utf-8"))
    assert told == [False, True]


def test_phases_that_are_counted_the_other_way_are_told(run, tmp_path):
    rig, rng = Rig(K, C), np.random.default_rng(4)
    rig.write(tmp_path, FREQUENCIES[::2], noise=0.01, rng=rng, more=EXACT)
    assert "fed energy" not in run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json").stderr
    for file in "abc":
        functions = dict(np.load(tmp_path / f"{file}.npz"))
        np.savez(tmp_path / f"{file}.npz", **functions | {"frf": functions["frf"].conj()})
    report = tmp_path / "r.html"
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--report", report, expect=3).stderr
    for name in ("a", "b"):
        for text in (told, report.read_text(encoding="utf-8")):
            assert f"{name}: 6 of 6 motions of the virtual point answer their own loads as if the structure fed energy" in text
    assert "counted the other way (e^−jωt)" in told and "ask for a joint that feeds energy" in told, told


@pytest.mark.long
def test_noise_on_everything_is_in_the_intervals(run, program, tmp_path):
    """1 % on every value of a and b, and on the assembly: without that of a and b the errors would be many deviations."""
    soft, own = 0.02 * K, definite(2, 300.0)
    rig = Rig(soft, own, sensors=3, impacts=9)
    truth = np.concatenate([soft[UPPER], own[UPPER]])
    errors = []
    for draw in range(4):
        rng = np.random.default_rng(300 + draw)
        rig.write(tmp_path, np.linspace(60, 1800, 120), noise=0.01, rng=rng, more=EXACT, of_sides=(0.01, 0.01))
        found = identified(run, tmp_path)
        assert 0.9 < found["reduced_chi_squared"] < 1.1
        # lines at resonances of a and b are not linear in their noise
        assert 0 < found["substructures"]["lines_left_out"] < 60 and found["substructures"]["moves"] < 0.15
        assert found["lines"] + found["substructures"]["lines_left_out"] == 120
        errors.append([(u["free"] - t) / u["standard_deviation"] for u, t in zip(found["unknowns"], truth)])
    # the errors of one test hang together: of 23 tests by hand 0.946 are held, of a single one 0.81 to 1
    assert 0.75 < np.sqrt(np.mean(np.square(errors))) < 1.25
    assert np.mean(np.abs(errors) < 1.96) >= 0.87
    # their noise is seen where it is not stated
    study = tmp_path / "study.toml"
    stated = study.read_text()
    study.write_text(stated.replace("a = 0.01\nb = 0.01\n", ""))
    found = identified(run, tmp_path)
    assert 0.85 < found["reduced_chi_squared"] < 1.1
    # the same functions, taken as exact, are not explained
    study.write_text(stated.replace("a = 0.01\nb = 0.01\n", "a = 0\nb = 0\n"))
    done = subprocess.run(
        [program, "identify", study, "-o", tmp_path / "j.joint.json", "--json"], capture_output=True, text=True, encoding="utf-8"
    )
    assert done.returncode == 3 and json.loads(done.stdout)["reduced_chi_squared"] > 2


@pytest.mark.long
@pytest.mark.parametrize("set_up, noise", [(False, 3e-3), (False, 0.01), (True, 3e-3)])
def test_noise_that_is_not_stated_is_seen(run, tmp_path, set_up, noise):
    """From line to line, of all functions: a first study states nothing of it."""
    errors = []
    for draw in range(2):
        rng = np.random.default_rng(700 + draw)
        rig = Rig(K, C, seed=700 + draw)
        rows = [rig.rows(side, (rng, 1e-4, 1e-3, 1e-4)) for side in range(2)] if set_up else None
        more = "[budget]\nposition = 1e-4\nrotation = 1e-3\ngain = 1e-4\n" if set_up else EXACT
        rig.write(tmp_path, np.linspace(60, 1800, 200), noise=noise, rng=rng, rows=rows, more=more, of_sides=(noise, noise))
        study = tmp_path / "study.toml"
        stated = f"[noise]\nrelative = {noise}\na = {noise}\nb = {noise}\n"
        assert stated in study.read_text()
        study.write_text(study.read_text().replace(stated, ""))
        done = run("identify", study, "-o", tmp_path / "j.joint.json", "--json")
        found = json.loads(done.stdout)
        shown = re.search(r"the functions show noise from line to line, .* those of b of ([0-9.]+) % of each value", done.stderr)
        assert float(shown[1]) == pytest.approx(100 * noise, rel=0.1)
        assert 0.6 < found["reduced_chi_squared"] < 1.3
        errors.append([(u["free"] - t) / u["standard_deviation"] for u, t in zip(found["unknowns"], TRUTH)])
    assert np.sqrt(np.mean(np.square(errors))) < 1.4 and np.abs(errors).max() < 4


@pytest.mark.parametrize("factor", [20, 0.02])
def test_stiff_and_soft_joints_are_found_beside_noise_and_errors(run, tmp_path, factor):
    """4e8 N/m, which the functions hardly tell from a rigid joint, and 4e5, which they tell at low frequencies alone."""
    rig, rng = Rig(factor * K, 5 * C if factor > 1 else 0.1 * C, sensors=3, impacts=9), np.random.default_rng(401)
    rows = [rig.rows(side, (rng, 1e-3, 0.01, 0.01)) for side in range(2)]
    rig.write(tmp_path, np.linspace(60, 3000, 120), noise=0.005, rng=rng, rows=rows, of_sides=(0.005, 0.005))
    command = "identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json"
    found = json.loads(run(*command, timeout=60).stdout)
    assert 0.95 < found["reduced_chi_squared"] < 1.05
    truth = np.concatenate([rig.K[UPPER], rig.C[UPPER]])
    errors = [(u["free"] - t) / u["standard_deviation"] for u, t in zip(found["unknowns"], truth)]
    assert np.sqrt(np.mean(np.square(errors))) < 1.4 and np.abs(errors).max() < 4


def test_consistency_is_told(run, tmp_path):
    """By the formulas: ρ = ‖F u‖/‖u‖ with u = Y·1, and the coherence of each channel; six impacts agree with anything."""
    rig, rng = Rig(K, C, sensors=3, impacts=9), np.random.default_rng(8)
    rows = [rig.rows(side, (rng, 1e-3, 0.01, 0.01)) for side in range(2)]
    functions = rig.write(tmp_path, FREQUENCIES[::6], noise=0.01, rng=rng, rows=rows)
    done = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json")
    found = json.loads(done.stdout)["consistency"]
    assert [(one["side"], one["of"]) for one in found] == [(side, of) for side in "ab" for of in ("sensors", "impacts")]
    for n, one in enumerate(found):
        side, of_impacts = divmod(n, 2)
        r = rig.rows(side)[of_impacts]
        y = functions[side] if not of_impacts else functions[side].transpose(1, 0, 2)
        u = y.sum(axis=1)
        rigid = r @ np.linalg.pinv(r) @ u
        overall = np.linalg.norm(rigid, axis=0) / np.linalg.norm(u, axis=0)
        own = np.abs(rigid + u) ** 2 / (2 * (np.abs(rigid) ** 2 + np.abs(u) ** 2))
        assert one["overall"] == pytest.approx(overall, rel=1e-9)
        assert [each["coherence"] for each in one["specific"]] == pytest.approx(own.mean(axis=1), rel=1e-9)
        assert one["mean"] == pytest.approx(overall.mean(), rel=1e-9)
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json").stdout
    assert "consistency of the impacts of b" in told


def test_an_exact_set_up_with_a_budget_is_no_other_joint(run, tmp_path):
    """A start leads to a minimum whose residuals are a tenth beyond the noise, and its stiffness 70 % off."""
    Rig(K, C).write(tmp_path, FREQUENCIES[::2], noise=0.01, rng=np.random.default_rng(5))
    assert apart(identified(run, tmp_path)["joint_file"]["joint"]["stiffness"], K) < 0.1


@pytest.mark.parametrize(
    "side, of_impacts, places, factor, key, dofs, says",
    [
        (0, False, slice(3, 6), None, "a.sensors[1]", "101:+X, 101:+Y, 101:+Z", "shifted by"),
        (1, False, 4, -1, "b.sensors[1]", "201:+Y", "gain were -1 times"),
        (1, True, 7, -1, "b.impacts[7]", "257:+X", "gain were -1 times"),
    ],
)
@pytest.mark.long
def test_what_does_not_fit_the_others_is_named(program, tmp_path, side, of_impacts, places, factor, key, dofs, says):
    """A sensor 20 mm from where it is said to be, a channel and a hit with the wrong sign; the same in all files."""
    rig = Rig(K, C)
    rows = [rig.rows(0), rig.rows(1)]
    bad = rows[side][of_impacts]
    if factor is None:
        bad[places] = [row(rig.sides[side][0][1] + [0, 0.02, 0], axis) for axis in np.eye(3)]
    else:
        bad[places] *= factor
    rig.write(tmp_path, FREQUENCIES[::6], noise=0.002, rng=np.random.default_rng(7), rows=rows, more=EXACT)
    command = [program, "identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    # named whether or not anything is found with it
    assert done.returncode in (1, 3), done.stderr
    (warning,) = [line for line in done.stderr.splitlines() if "does not fit the others" in line]
    assert warning.startswith(f"warning: {key} ({dofs}) does not fit the others") and says in warning
    if done.stdout:
        (misfit,) = json.loads(done.stdout)["misfits"]
        assert misfit["key"] == key and ", ".join(misfit["dofs"]) == dofs


@pytest.mark.parametrize(
    "wrong, told",
    [
        ("gain", ["channel 101:+Z", "they are 1.1", "calibration in that test"]),
        ("channels", ["channel 200:+X", "they are those of 202:+X: exchange the two"]),
        ("impact", ["impact 155:+X", "they are 0.8", "calibration in that test"]),
    ],
)
def test_what_is_wrong_in_the_assembly_alone_is_named(program, tmp_path, wrong, told):
    """The parts are well measured: only there a channel has another gain or plug, or a hit another one."""
    Rig(K, C).write(tmp_path, FREQUENCIES[::3], noise=0.01, rng=np.random.default_rng(4), more=EXACT)
    # the noise is not what the study says where a channel is wrong
    study = tmp_path / "study.toml"
    study.write_text(study.read_text().replace("[noise]\nrelative = 0.01\n", ""))
    held = dict(np.load(tmp_path / "c.npz"))
    channels, impacts = held["response"].tolist(), held["reference"].tolist()
    if wrong == "gain":
        held["frf"][channels.index("101:+Z")] *= 1.15
    elif wrong == "channels":
        pair = [channels.index("200:+X"), channels.index("202:+X")]
        held["frf"][pair] = held["frf"][pair[::-1]]
    else:
        held["frf"][:, impacts.index("155:+X")] *= 0.85
    np.savez(tmp_path / "c.npz", **held)
    command = [program, "identify", study, "-o", tmp_path / "j.joint.json"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    warnings = [line for line in done.stderr.splitlines() if "of the assembly leave" in line]
    assert len(warnings) == (2 if wrong == "channels" else 1), done.stderr
    assert all(fragment in warnings[0] for fragment in told), warnings


def test_good_channels_are_not_told_of(run, tmp_path):
    Rig(K, C).write(tmp_path, FREQUENCIES[::3], noise=0.01, rng=np.random.default_rng(5), more=EXACT)
    assert "of the assembly leave" not in run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json").stderr


def test_a_joint_that_nothing_determines_is_unusable(run, tmp_path):
    """The file of the assembly is one of the parts apart."""
    rig = Rig(0 * K, 0 * C)
    rig.write(tmp_path, FREQUENCIES[::3], noise=0.01, rng=np.random.default_rng(6), more=EXACT)
    found = identified(run, tmp_path, expect=3)
    assert any("determine no stiffness" in reason for reason in found["reasons_against"])


@pytest.mark.parametrize(
    "side, of_impacts, pair, keys, dofs",
    [
        (0, False, [1, 5], ["a.sensors[0]", "a.sensors[1]"], ["100:+Y", "101:+Z"]),
        (1, False, [6, 7], ["b.sensors[2]", "b.sensors[2]"], ["202:+X", "202:+Y"]),
        (1, True, [2, 7], ["b.impacts[2]", "b.impacts[7]"], ["252:+X", "257:+X"]),
    ],
)
@pytest.mark.parametrize("budget", [EXACT, "budget = { position = 1e-3, rotation = 0.01745, gain = 0.01 }\n"])
@pytest.mark.long
def test_what_is_exchanged_is_named(program, tmp_path, side, of_impacts, pair, keys, dofs, budget):
    """Two cables in each other's place, or two hits in each other's row; the same in all files."""
    rig, rng = Rig(K, C), np.random.default_rng(9)
    errors = () if budget == EXACT else ((rng, 1e-3, 0.01745, 0.01),)
    rows = [rig.rows(0, *errors), rig.rows(1, *errors)]
    rows[side][of_impacts][pair] = rows[side][of_impacts][pair[::-1]]
    rig.write(tmp_path, FREQUENCIES[::6], noise=0.002, rng=rng, rows=rows, more=budget)
    command = [program, "identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode in (1, 3), done.stderr
    warnings = [line for line in done.stderr.splitlines() if "exchange them" in line]
    assert len(warnings) == 1, done.stderr
    one, other = [f"{key} ({dof})" for key, dof in zip(keys, dofs)]
    assert warnings[0].startswith(f"warning: {one} does not fit the others, nor does {other}, and each would")
    if done.stdout:
        (misfit,) = json.loads(done.stdout)["misfits"]
        assert misfit["exchanged_with"] == {"key": keys[1], "dofs": [dofs[1]]} and misfit["ratio"] is None


@pytest.mark.parametrize(
    "old, new, fragments",
    [
        ("direction = [", "direction = [2.0, 0.0, 0.0] # [", ["a.impacts[0]", "unit"]),
        ("[[a.sensors]]\nnode = 100", "[[a.sensors]]\naxes = [[1,0,0],[0,1,0],[0,0,-1]]\nnode = 100", ["a.sensors[0]"]),
        ("[[a.sensors]]\nnode = 100", "[[a.sensors]]\nnode = 990", ["990:+X"]),
        ("position = [", "position = [27.0, 0, 0] # [", ["a.sensors[0]", "[27.0, 0.0, 0.0]", "millimetres?"]),
        ("length = 0.03", "length = 30", ["joint.length", "found 30", "millimetres?"]),
        ("length = 0.03", "length = -1", ["joint.length", "found -1", "size of the interface"]),
        ('model = "full"', 'model = "two-bolts"', ["joint.line", "direction from one bolt"]),
        ('model = "full"', 'model = "spring"', ["spring", "full"]),
        ('budget = "none"', "budget = { gain = -0.1 }", ["budget.gain", "found -0.1", "exact"]),
        ('budget = "none"', 'budget = "none"\nnoise = { a = 0.01 }', ["noise.a", "without noise.relative"]),
        ('budget = "none"', 'budget = "none"\nnoise = { relative = 0.01, b = -1 }', ["noise.b", "found -1"]),
        ('[a]\nfrf = "a.npz"', '[a]\nfrf = "a.npz"\ninterface = 3', ["a.interface", "beside sensors or impacts"]),
    ],
)
def test_what_is_wrong_is_told_by_its_key(run, tmp_path, old, new, fragments):
    Rig(K, C).write(tmp_path, FREQUENCIES[:5], more=EXACT)
    study = tmp_path / "study.toml"
    text = study.read_text()
    assert old in text
    study.write_text(text.replace(old, new, 1))
    told = run("identify", study, "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert all(fragment in told for fragment in fragments), told
    assert not (tmp_path / "j.joint.json").exists()


@pytest.mark.parametrize("tables, axis, named", [("si", 2, "sensors and impacts"), ("s", 0, "sensors"), ("i", 1, "impacts")])
def test_mirrored_places_are_refused(run, tmp_path, tables, axis, named):
    Rig(K, C).write(tmp_path, FREQUENCIES[:8], noise=0.01, rng=np.random.default_rng(3))
    study = tmp_path / "study.toml"
    lines, table = [], ""
    for line in study.read_text().splitlines():
        table = line if line.startswith("[") else table
        if line.startswith("position") and table[:4] == "[[b." and table[4] in tables:
            place = json.loads(line.split("=")[1])
            place[axis] = -place[axis]
            line = f"position = {place}"
        lines.append(line)
    study.write_text("\n".join(lines))
    told = run("identify", study, "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert f"b: the {named} look mirrored along {'xyz'[axis]}" in told, told


class Straight(Rig):
    """Two straight beams, with sensors and impacts along their axes: many functions are exactly zero."""

    def __init__(self, K, C):
        super().__init__(K, C)
        self.a = Frame([[x, 0, 0] for x in (-0.5, -0.3, -0.1, 0)], STEEL, ground=[3e6, 2e6, 4e6, 3e4, 4e4, 2e4])
        self.b = Frame([[x, 0, 0] for x in (0, 0.15, 0.3)], LIGHT)
        self.at = [18, 0]
        places = 0.02 * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, 1]])
        hits, axes = zip(*[(p, e) for p in places for e in np.eye(3)])
        self.sides = [(places, np.array(hits), np.array(axes))] * 2


def test_functions_that_are_zero_do_not_outweigh_the_others(run, tmp_path):
    stiffness = np.diag([3e7, 2e7, 2e7, 6e3, 9e3, 9e3])
    rig = Straight(stiffness, 2e-5 * stiffness)
    rig.write(tmp_path, FREQUENCIES, more=EXACT)
    done = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", "--json")
    assert " of 576 functions are zero at every line and are left out" in done.stderr, done.stderr
    joint = json.loads(done.stdout)["joint_file"]["joint"]
    assert apart(joint["stiffness"], stiffness) < 1e-7
    # nor with noise, and a budget for errors of the set-up
    rig.write(tmp_path, FREQUENCIES, noise=0.01, rng=np.random.default_rng(1))
    errors = {u["name"]: (u["free"], u["standard_deviation"]) for u in identified(run, tmp_path)["unknowns"]}
    names = ["k_x", "k_y", "k_z", "k_rx", "k_ry", "k_rz"]
    z = [(errors[name][0] - truth) / errors[name][1] for name, truth in zip(names, np.diag(stiffness))]
    assert np.abs(z).max() < 3.5, z


class Flat(Rig):
    """Structures that are computed in the plane of x and y: nothing is in the other motions."""

    def functions(self, frequencies, rows=None):
        rows = rows or [self.rows(0), self.rows(1)]
        for u, f in rows:
            u[:, 2:5], f[:, 2:5] = 0, 0
        return super().functions(frequencies, rows)


@pytest.mark.parametrize("model, motions", [("full", "z, rx, ry"), ("translations", "z")])
def test_six_motions_of_structures_in_a_plane_are_refused(run, tmp_path, model, motions):
    Flat(K, C).write(tmp_path, FREQUENCIES[:20], model=f'model = "{model}"', more=EXACT)
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert f"joint: neither of its structures moves in {motions} where they meet" in told, told
    assert 'motions = ["x", "y", "rz"]' in told, told


def test_a_channel_that_is_not_connected_is_told_of(run, tmp_path):
    Rig(K, C).write(tmp_path, FREQUENCIES[::6], model='model = "diagonal"', more=EXACT, noise=0.01, rng=np.random.default_rng(1))
    functions = dict(np.load(tmp_path / "a.npz"))
    functions["frf"][0] = 0
    np.savez(tmp_path / "a.npz", **functions)
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=3).stderr
    assert "a.sensors[0] (100:+X) does not fit the others, as if the gain were 0 times" in told, told
    assert "% of the functions: the model is not that of the data" in told, told


def test_few_impacts_are_warned_of(run, tmp_path):
    Rig(K, C).write(tmp_path, FREQUENCIES, more=EXACT)
    study = tmp_path / "study.toml"
    first, *others = study.read_text().split("[[a.impacts]]")
    *others, last = others
    rest = last[last.index("[b]") :]
    study.write_text("[[a.impacts]]".join([first, *others[:7]]) + rest)
    told = run("identify", study, "-o", tmp_path / "j.joint.json").stderr
    assert "a: impacts: found 7, 9 to 12 are better" in told and "b: " not in told, told


def test_two_sensors_do_not_see_a_rotation(run, tmp_path):
    Rig(K, C, sensors=2).write(tmp_path, FREQUENCIES[:5], more=EXACT)
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert "rotation" in told and "line through" in told, told
