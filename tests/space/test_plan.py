"""Tests in space, planned before they are made: the deviations that are predicted against those of simulated tests, what will
not be determined, and what to add."""

import csv
import json

import numpy as np
import pytest
from chains import Chain, definite, joint_file, plan_study
from frames import Rig, row

FREQUENCIES = np.linspace(60, 1800, 60)
EXACT = 'budget = "none"\n'
K, C = definite(1, 2e7), definite(2, 300.0)
FULL = 'model = "full"'


def planned(run, folder, *more):
    return json.loads(run("respond", folder / "plan.toml", "--plan", "--json", *more).stdout)


def found(run, folder):
    done = run("identify", folder / "study.toml", "-o", folder / "j.joint.json", "--json")
    return json.loads(done.stdout)["unknowns"]


def bolt(k=2e7, z=5e7, t=6e3, r=9e3, c=1e5):
    stiffness = np.diag([k, k, z, t, t, r])
    stiffness[0, 4] = stiffness[4, 0] = c
    stiffness[1, 3] = stiffness[3, 1] = -c
    return stiffness, 2e-5 * stiffness


@pytest.mark.parametrize(
    "budget",
    [
        EXACT,
        "budget = { position = 1e-4, rotation = 1e-3, gain = 1e-3 }\n",
        "budget = { position = 1e-4, rotation = 1e-3, gain = 1e-3, hits = { position = 1e-4, rotation = 1e-3 } }\n",
    ],
)
def test_the_plan_is_what_the_estimate_says_of_itself(run, tmp_path, budget):
    """All 42 deviations, with noise so low that the estimate is at the truth."""
    rig = Rig(K, C, sensors=3, impacts=9)
    lines = FREQUENCIES[::4]
    # with less, deviations follow the rounding of the functions
    noise = 3e-6 if "hits" in budget else 1e-4
    plan_study(rig, tmp_path, lines, FULL, noise, K, C, budget)
    plan = planned(run, tmp_path, "--add", "0")
    rig.write(tmp_path, lines, noise=noise, rng=np.random.default_rng(3), more=budget)
    assert plan["functions"] == 18 * 18 and plan["lines"] == len(lines) and plan["additions"] == []
    for one, other in zip(plan["unknowns"], found(run, tmp_path)):
        assert one["name"] == other["name"]
        assert one["standard_deviation"] == pytest.approx(other["standard_deviation"], rel=0.02)
        assert one["by_noise_alone"] == pytest.approx(other["by_noise_alone"], rel=0.02)


@pytest.mark.long
@pytest.mark.parametrize("noise, draws", [(1e-3, 40), (1e-2, 100)])
def test_simulated_tests_scatter_as_planned(run, tmp_path, noise, draws):
    """Tests with noise, 42 unknowns, sensors and impacts elsewhere on finite elements. The pooled r.m.s. of 40 tests scatters by
    1/√(80 · 42) if no unknowns go together, and by 1/√80 = 11 % if all do: 42 go together in some ten groups. With 1 % of noise
    the functions have other minima, where the joint is wrong by twenty deviations."""
    chain = Chain([(K, C)])
    lines, places = FREQUENCIES[::5], [100, 103, 201, 202]
    alone = chain.receptances(lines)
    chain.receptances = lambda _: alone
    expected = f"expected = {{ stiffness = {K.tolist()}, damping = {C.tolist()} }}"
    errors = []
    for draw in range(draws):
        chain.write(tmp_path, lines, places, places, [FULL + "\nlength = 0.03\n" + expected], noise, np.random.default_rng(500 + draw))
        if draw == 0:
            text = (tmp_path / "study.toml").read_text()
            (tmp_path / "plan.toml").write_text(text.replace('frf = "assembly.npz"', ""))
            plan = planned(run, tmp_path, "--add", "0")["unknowns"]
        errors.append([(u["free"] - p["value"]) / p["standard_deviation"] for u, p in zip(found(run, tmp_path), plan)])
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(1, abs=0.1)
    assert abs(np.mean(errors)) < 0.1
    assert np.abs(errors).max() < 6


def test_simulated_tests_with_a_budget_scatter_as_planned(run, tmp_path):
    """Noise of 1 %, sensors and impacts where the study does not say: 0.2 mm, 2 mrad and 0.2 % off. Ten numbers of a bolt: 30
    tests scatter by about 1/√(60 · 5) = 6 %; 60 others by hand had 1.002."""
    stiffness, damping = bolt(2e6, 5e6, 6e2, 9e2, 1e4)
    rig = Rig(stiffness, damping, sensors=3, impacts=8)
    lines, size = FREQUENCIES[::6], (2e-4, 2e-3, 2e-3)
    budget = "budget = {{ position = {}, rotation = {}, gain = {} }}\n".format(*size)
    plan_study(rig, tmp_path, lines, 'model = "bolt"', 0.01, stiffness, damping, budget)
    plan = planned(run, tmp_path, "--add", "0")["unknowns"]
    # the set-up is most of it
    assert all(u["standard_deviation"] > 1.3 * u["by_noise_alone"] for u in plan[:5])
    errors = []
    for draw in range(30):
        rng = np.random.default_rng(920 + draw)
        rows = [rig.rows(side, (rng, *size)) for side in range(2)]
        rig.write(tmp_path, lines, noise=0.01, rng=rng, rows=rows, model='model = "bolt"', more=budget)
        errors.append([(u["free"] - p["value"]) / p["standard_deviation"] for u, p in zip(found(run, tmp_path), plan)])
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(1, abs=0.15)


def test_noise_of_the_substructures_takes_part_in_the_plan(run, tmp_path):
    """All 42 deviations against those that the estimate states, with noise on everything; what moves too far is left out."""
    soft, own = 0.02 * K, definite(2, 300.0)
    rig = Rig(soft, own, sensors=3, impacts=9)
    lines = np.linspace(60, 1800, 60)
    plan_study(rig, tmp_path, lines, FULL, 1e-3, soft, own, EXACT)
    without = planned(run, tmp_path, "--add", "0")
    text = (tmp_path / "plan.toml").read_text()
    (tmp_path / "plan.toml").write_text(text.replace("relative = 0.001", "relative = 0.001\na = 0.001\nb = 0.001"))
    plan = planned(run, tmp_path, "--add", "0")
    rig.write(tmp_path, lines, noise=1e-3, rng=np.random.default_rng(3), more=EXACT, of_sides=(1e-3, 1e-3))
    for one, other in zip(plan["unknowns"], found(run, tmp_path)):
        assert one["name"] == other["name"]
        assert one["standard_deviation"] == pytest.approx(other["standard_deviation"], rel=0.05)
    ratios = [a["standard_deviation"] / b["standard_deviation"] for a, b in zip(plan["unknowns"], without["unknowns"])]
    assert np.median(ratios) > 1.5


def test_functions_elsewhere_that_do_not_move_the_joint_leave_it_open(run, tmp_path):
    """A is held in every motion but two by its own functions being next to nothing there: no sensor, no motion."""
    stiffness, damping = bolt()
    rig = Rig(stiffness, damping)
    plan_study(rig, tmp_path, FREQUENCIES[::4], 'model = "diagonal"', 0.01, stiffness, damping, EXACT)
    text = (tmp_path / "plan.toml").read_text()
    # one sensor and one impact far out on a, along one axis, and nothing on b: finite elements for both interfaces
    kept = [line for line in text.splitlines() if not line.startswith(("[[", "node", "dof", "position", "direction"))]
    text = "\n".join(kept).replace("interface = 14", 'interface = 14\nresponses = ["11:+X"]\nreferences = ["11:+X"]')
    (tmp_path / "plan.toml").write_text(text)
    plan = planned(run, tmp_path)
    reasons = {u["name"]: u["reason"] for u in plan["unknowns"]}
    assert plan["functions"] == 1 and sum(reason is not None for reason in reasons.values()) >= 6
    assert any("looks like" in reason or "less than their noise" in reason for reason in reasons.values() if reason)
    # what the functions have elsewhere is proposed
    assert plan["additions"][0]["what"].startswith(("a.", "b.")) and plan["additions"][0]["gain"] > 1


def test_motions_that_nothing_reaches_are_named(run, tmp_path):
    """Two bodies of six masses on springs of their own: no motion has to do with another. Sensors and impacts along x and y."""
    lines = FREQUENCIES[::6]
    axes = ["+X", "+Y", "+Z", "+RX", "+RY", "+RZ"]
    mass, spring = np.array([2, 3, 4, 2e-3, 3e-3, 4e-3]), np.array([3e6, 2e6, 1e6, 4e3, 5e3, 6e3])
    omega = 2 * np.pi * lines
    for name, node, k in (("a", 1, spring), ("b", 2, 0.1 * spring)):
        y = np.array([np.diag(1 / (k * (1 + 0.01j) - w**2 * mass)) for w in omega])
        np.savez(tmp_path / f"{name}.npz", frequency=lines, frf=np.moveaxis(y, 0, 2), response=[f"{node}:{a}" for a in axes],
                 reference=[f"{node}:{a}" for a in axes], quantity="receptance", axes="response,reference,frequency")
    at = lambda node: "\n".join(f'responses = ["{node}:+X", "{node}:+Y"]\nreferences = ["{node}:+X"]' for _ in [0])
    # the same motions once more, as points of their own
    for name, node in (("a", 1), ("b", 2)):
        with np.load(tmp_path / f"{name}.npz") as file:
            own = dict(file)
        pick = [0, 1, 2, 3, 4, 5, 0, 1]
        own["frf"] = own["frf"][pick][:, pick]
        own["response"] = own["reference"] = [*own["response"], f"{node}1:+X", f"{node}1:+Y"]
        np.savez(tmp_path / f"{name}.npz", **own)
    (tmp_path / "plan.toml").write_text(
        'method = "frf-space"\nname = "six"\n[noise]\nrelative = 0.01\n'
        f'[a]\nfrf = "a.npz"\ninterface = 1\n{at(11)}\n[b]\nfrf = "b.npz"\ninterface = 2\n{at(21)}\n'
        f'[joint]\nmodel = "diagonal"\nlength = 0.03\nexpected = {{ stiffness = {np.diag(spring).tolist()}, damping = {np.diag(1e-4 * spring).tolist()} }}\n'
    )
    plan = planned(run, tmp_path)
    by_name = {u["name"]: u for u in plan["unknowns"]}
    assert by_name["k_x"]["is_determined"] and by_name["k_x"]["reason"] is None
    assert by_name["k_y"]["reason"] == "no impact moves the joint in y"
    for dof in ("z", "rx", "ry", "rz"):
        for letter in "kc":
            reason = by_name[f"{letter}_{dof}"]["reason"]
            assert reason == f"no motion: no impact moves the joint in {dof}, and no sensor sees it"
    # one impact along y is what tells most
    assert "Y" in plan["additions"][0]["what"] and "references" in plan["additions"][0]["what"]


def test_the_best_one_is_chosen_by_the_determinant_and_then_the_next(run, tmp_path):
    """ln det(I + J P Jᵀ) of every candidate, and of every one beside the best, from Jacobians by NumPy: functions elsewhere on two
    frames, noise in parts of each r.m.s., and of each number nothing known but its size."""
    chain = Chain([(K, C)])
    lines, rows, columns = FREQUENCIES[::9], [103, 201], [103, 202]
    expected = f"expected = {{ stiffness = {K.tolist()}, damping = {C.tolist()} }}"
    chain.write(tmp_path, lines, rows, columns, [FULL + "\nlength = 0.03\n" + expected], 0.01, np.random.default_rng(1))
    text = (tmp_path / "study.toml").read_text().replace('frf = "assembly.npz"', "")
    (tmp_path / "plan.toml").write_text(text)
    plan = planned(run, tmp_path, "--add", "3")

    alone, together = chain.receptances(lines)
    nodes = [node for part in range(2) for node in chain.nodes(part)]
    everything = [f"{node}:+{axis}" for node in nodes for axis in ("X", "Y", "Z", "RX", "RY", "RZ")]
    end = chain.starts[1]
    S = np.zeros((6, len(everything)))
    S[:, end - 6 : end], S[:, end : end + 6] = np.eye(6), -np.eye(6)
    a, b = together @ S.T, S @ together
    upper = list(zip(*np.triu_indices(6)))
    bases = np.zeros((21, 6, 6))
    for n, (i, j) in enumerate(upper):
        bases[n, i, j] = bases[n, j, i] = 1
    size = np.concatenate([[np.sqrt(m[i, i] * m[j, j]) for i, j in upper] for m in (K, C)])
    omega = 2 * np.pi * lines

    def information(responses, references):
        o, i = ([everything.index(dof) for dof in dofs] for dofs in (responses, references))
        jacobian = -np.einsum("lop,kpq,lqi->koil", a[:, o], bases, b[:, :, i])
        jacobian = np.concatenate([jacobian, 1j * omega * jacobian]) * size[:, None, None, None]
        sigma = 0.01 * np.sqrt(np.mean(np.abs(together[:, o][:, :, i]) ** 2, axis=0))
        whitened = (jacobian / sigma[:, :, None]).reshape(42, -1)
        return 2 * (whitened @ whitened.conj().T).real

    def gain(now, then):
        prior = np.eye(42)
        return np.linalg.slogdet(prior + information(*then))[1] - np.linalg.slogdet(prior + information(*now))[1]

    def with_it(now, what):
        table, dof = what.split(": ")
        responses, references = now
        return (responses + [dof], references) if table.endswith("responses") else (responses, references + [dof])

    now = ([f"{node}:+{axis}" for node in rows for axis in "XYZ"], [f"{node}:+{axis}" for node in columns for axis in "XYZ"])
    assert len(plan["ranking"]) > 10
    for one in plan["ranking"]:
        assert one["gain"] == pytest.approx(gain(now, with_it(now, one["what"])), rel=1e-6)
    left = [one["what"] for one in plan["ranking"]]
    for chosen in plan["additions"]:
        gains = {what: gain(now, with_it(now, what)) for what in left}
        best = max(gains, key=gains.get)
        assert chosen["what"] == best and chosen["gain"] == pytest.approx(gains[best], rel=1e-6)
        now = with_it(now, best)
        left.remove(best)


def test_what_to_add_does_what_was_promised(run, tmp_path):
    """The gain is ln det of the information; recomputed here from the deviations of a study that has the candidate."""
    stiffness, damping = bolt()
    rig = Rig(stiffness, damping, sensors=3, impacts=8)
    lines = FREQUENCIES[::9]
    stated = (
        '[candidates]\nsensors = [{ to = "a", node = 170, position = [0.03, 0, 0] }, '
        '{ to = "b", node = 270, position = [0, 0.001, 0] }]\n'
        'impacts = [{ to = "b", dof = "271:-Z", position = [0.02, 0.01, 0] }]\n'
    )
    plan_study(rig, tmp_path, lines, 'model = "bolt"', 0.01, stiffness, damping, EXACT)
    study = tmp_path / "plan.toml"
    text = study.read_text()
    study.write_text(text + stated)
    plan = planned(run, tmp_path, "--add", "3")
    assert len(plan["ranking"]) == 3 and len(plan["additions"]) == 3
    gains = [one["gain"] for one in plan["ranking"]]
    assert gains == sorted(gains, reverse=True) and gains[-1] > 0
    assert plan["additions"][0] == plan["ranking"][0]
    # for one number alone: the deviations with and without the best one, all lines being compared
    best = planned(run, tmp_path, "--for", "c_rz")["additions"][0]
    assert "candidates" in best["what"]
    before = {u["name"]: u["standard_deviation"] for u in plan["unknowns"]}
    index, kind = best["what"].split("candidates.")[1].split("[")[1][0], best["what"].split("candidates.")[1].split("[")[0]
    added = {
        ("sensors", "0"): '[[a.sensors]]\nnode = 170\nposition = [0.03, 0, 0]\n',
        ("sensors", "1"): '[[b.sensors]]\nnode = 270\nposition = [0, 0.001, 0]\n',
        ("impacts", "0"): '[[b.impacts]]\ndof = "271:-Z"\nposition = [0.02, 0.01, 0]\n',
    }[(kind, index)]
    study.write_text(text.replace("[joint]\n", added + "[joint]\n"))
    after = {u["name"]: u["standard_deviation"] for u in planned(run, tmp_path, "--add", "0")["unknowns"]}
    assert 1 - (after["c_rz"] / before["c_rz"]) ** 2 == pytest.approx(best["gain"], rel=0.02)


def test_without_a_list_places_about_the_interfaces_are_proposed(run, tmp_path):
    stiffness, damping = bolt()
    rig = Rig(stiffness, damping, sensors=3, impacts=8)
    plan_study(rig, tmp_path, FREQUENCIES[::9], 'model = "bolt"', 0.01, stiffness, damping)
    joint_file(tmp_path / "known.joint.json", stiffness, damping)
    text = (tmp_path / "plan.toml").read_text()
    (tmp_path / "plan.toml").write_text(text[: text.index("expected")] + 'expected = "known.joint.json"\n')
    out = tmp_path / "plan.csv"
    shown = run("respond", tmp_path / "plan.toml", "--plan", "-o", out).stdout
    assert "add next: " in shown and "  or " in shown
    rows = list(csv.DictReader(out.open(encoding="utf-8")))
    assert [r["unknown"] for r in rows][:5] == ["k_x", "k_z", "k_rx", "k_rz", "k_x_ry"] and len(rows) == 10
    assert float(rows[0]["standard deviation"]) > float(rows[0]["by noise alone"]) > 0


@pytest.mark.parametrize(
    "old, new, fragments",
    [
        ("expected = {", "#", ["joint.expected", "for each motion"]),
        ("[noise]\nrelative = 0.01", "", ["noise.relative", "to be planned"]),
        ("[[a.sensors]]\nnode = 102", "[[b.sensors]]\nnode = 102", ["a", "rank 5", "rotation about the line"]),
        ("direction = [", "direction = [2.0, 0.0, 0.0] # [", ["a.impacts[0]", "unit"]),
        ("[[a.sensors]]\nnode = 100", "[[a.sensors]]\naxes = [[1,0,0],[0,1,0],[0,0,-1]]\nnode = 100", ["a.sensors[0]", "left-handed"]),
        ("interface = 14", "interface = 99", ["a.interface", "motions x, y, z, rx, ry, rz", "frf-decoupling"]),
        ("[joint]", '[candidates]\nsensors = [{ to = "d", node = 1, position = [0, 0, 0] }]\n[joint]', ["candidates.sensors[0].to", "a, b"]),
        ("[joint]", '[candidates]\nimpacts = [{ to = "a", dof = "9:+X", position = [0, 0, 0], direction = [1, 1, 0] }]\n[joint]', ["candidates.impacts[0]", "unit"]),
        ("[joint]", '[assembly]\nresponses = ["777:+X"]\n[joint]', ["assembly", "777:+X", "sensors"]),
    ],
)
def test_what_is_wrong_is_told_by_its_key(run, tmp_path, old, new, fragments):
    stiffness, damping = bolt()
    plan_study(Rig(stiffness, damping, sensors=3), tmp_path, FREQUENCIES[:5], 'model = "bolt"', 0.01, stiffness, damping)
    study = tmp_path / "plan.toml"
    text = study.read_text()
    assert old in text
    study.write_text(text.replace(old, new, 1))
    told = run("respond", study, "--plan", expect=1).stderr
    assert all(fragment in told for fragment in fragments), told


def test_a_candidate_whose_functions_nobody_has_is_named(run, tmp_path):
    """Without the interface's node the functions at a candidate have to be in the file."""
    rig = Rig(K, C)
    rig.write(tmp_path, FREQUENCIES[:5], more=EXACT)
    text = (tmp_path / "study.toml").read_text().replace('[assembly]\nfrf = "c.npz"\n', "[noise]\nrelative = 0.01\n")
    joint_file(tmp_path / "known.joint.json", K, C)
    text += 'expected = "known.joint.json"\n[candidates]\nsensors = [{ to = "a", node = 170, position = [0.03, 0, 0] }]\n'
    (tmp_path / "plan.toml").write_text(text)
    told = run("respond", tmp_path / "plan.toml", "--plan", expect=1).stderr
    assert "candidates.sensors[0]" in told and "170:+X" in told, told


def test_a_structure_in_a_plane_is_refused(run, tmp_path):
    stiffness, damping = bolt()
    plan_study(Rig(stiffness, damping, sensors=3), tmp_path, FREQUENCIES[:5], 'model = "bolt"', 0.01, stiffness, damping)
    with np.load(tmp_path / "b.npz") as file:
        own = dict(file)
    flat = [n for n, dof in enumerate(own["response"]) if dof.split(":")[1] in ("+X", "+Z", "+RY", "+RZ")]
    own["frf"][flat] = 0
    own["frf"][:, flat] = 0
    np.savez(tmp_path / "b.npz", **own)
    told = run("respond", tmp_path / "plan.toml", "--plan", expect=1).stderr
    assert "b.interface" in told and "20:+X, 20:+Z, 20:+RY, 20:+RZ" in told and "frf-decoupling" in told, told


def test_a_sensor_reads_what_the_rigid_interface_does():
    """The reference of the files above: a channel at p along d reads d · (u + θ × p)."""
    p, d = np.array([0.1, -0.2, 0.3]), np.array([0.6, 0, 0.8])
    u, theta = np.array([1.0, 2, 3]), np.array([0.4, 0.5, 0.6])
    assert row(p, d) @ np.concatenate([u, theta]) == pytest.approx(d @ (u + np.cross(theta, p)))
