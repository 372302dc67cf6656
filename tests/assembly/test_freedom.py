"""Assemblies that nothing holds: what is free as a whole is said, and parts free against each other are refused.

The number of free motions is that of the null space of one global stiffness, by NumPy.
"""

import json

import numpy as np
import pytest

# what a beam in a plane, a lever and a clamped beam are made of
BEAM = (
    'beam = {{ length = 0.3, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = "{}" }}\n'
    'points = {{ "1:+Y" = 0.0, "1:+RZ" = 0.0, "2:+Y" = 0.3, "2:+RZ" = 0.3 }}\nmodes = 6'
)


def write(folder, boundaries, joints, head=""):
    """Beams a, b, c of these boundaries; each joint from the end of one to the beginning of the next."""
    names = "abc"[: len(boundaries)]
    text = f'name = "chain"\n{head}\n'
    for name, boundary in zip(names, boundaries):
        text += f"[structures.{name}]\n{BEAM.format(boundary)}\n"
    for place, joint in enumerate(joints):
        dofs = joint["dofs"]
        file = {"format": "bolted-joint/1", "name": "lap", "joint": joint}
        (folder / f"{place}.joint.json").write_text(json.dumps(file))
        point = {"y": "+Y", "theta": "+RZ"}
        sides = [
            f'{side} = {{ structure = "{name}", ' + ", ".join(f'{dof} = "{end}:{point[dof]}"' for dof in dofs) + " }"
            for side, name, end in [("a", names[place], 2), ("b", names[place + 1], 1)]
        ]
        text += f'[[joints]]\nname = "lap{place}"\nfile = "{place}.joint.json"\n' + "\n".join(sides) + "\n"
    last = names[-1]
    text += f'[inputs]\npush = "{last}/2:+Y"\n[outputs]\ntip = "{last}/2:+Y"\n'
    text += '[response]\nkind = "linear"\nfrom = 10\nto = 500\nlines = 20\n'
    path = folder / "chain.toml"
    path.write_text(text)
    return path


def joint(k_y, k_theta, **more):
    return {"dofs": ["y", "theta"], "stiffness": [[k_y, 0.0], [0.0, k_theta]], "damping": [[1.0, 0.0], [0.0, 0.01]], **more}


HINGE = joint(1e6, 0.0)
FIXED = joint(1e6, 1e3)
# the stiffness of a spring at a distance: it has none about a point of its own
LEVER = joint(1e6, 1e4)
LEVER["stiffness"][0][1] = LEVER["stiffness"][1][0] = 1e5
ALONG_Y = {"dofs": ["y"], "stiffness": [[1e6]], "damping": [[1.0]]}
FREE, CLAMPED = "free-free", "fixed-free"


def free_motions(boundaries, joints):
    """Of rigid beams (y and θ at the beginning), by the rank of all that holds them."""
    size = 2 * len(boundaries)
    rows = []
    for place, boundary in enumerate(boundaries):
        if boundary == CLAMPED:
            rows.extend(np.eye(size)[2 * place : 2 * place + 2])
    for place, own in enumerate(joints):
        relative = np.zeros((2, size))
        relative[0, 2 * place : 2 * place + 2] = 1, 0.3
        relative[1, 2 * place + 1] = 1
        relative[:, 2 * place + 2 : 2 * place + 4] = -np.eye(2)
        stiffness = np.zeros((2, 2))
        own_size = len(own["dofs"])
        stiffness[:own_size, :own_size] = own["stiffness"]
        rows.extend(stiffness @ relative)
    rows = np.array([row / np.linalg.norm(row) for row in rows if np.linalg.norm(row) > 0]).reshape(-1, size)
    return size - np.linalg.matrix_rank(rows)


@pytest.mark.parametrize(
    ("boundaries", "joints", "told"),
    [
        ([CLAMPED, FREE], [FIXED], []),
        ([FREE, FREE], [FIXED], ["structures a, b"]),
        ([FREE, FREE, FREE], [FIXED, FIXED], ["structures a, b, c"]),
        ([FREE], [], ["structure a"]),
        ([CLAMPED], [], []),
        ([FREE, FREE], [], ["structure a", "structure b"]),
    ],
)
def test_a_whole_that_nothing_holds_is_told(run, tmp_path, boundaries, joints, told):
    path = write(tmp_path, boundaries, joints)
    done = run("respond", path, "-o", tmp_path / "out.csv", "--json")
    notes = json.loads(done.stdout)["notes"]
    apart = 0 < len(joints) + 1 < len(boundaries)
    count = free_motions(boundaries, joints) // (len(told) or 1)
    free = [note for note in notes if note.startswith("nothing holds")]
    assert [note.split(" holds ")[1].split(":")[0] for note in free] == told
    assert all(f"free in {count} motions" in note for note in free)
    # each is listed once, and none of them grows
    modes = json.loads(done.stdout)["modes"]
    assert sum(mode["frequency_hz"] == 0.0 for mode in modes) == free_motions(boundaries, joints)
    assert all(mode["damping_ratio"] >= 0.0 for mode in modes)
    assert ("no joint connects structure a to the others" in notes) == apart
    assert all(f"note: {note}" in done.stderr for note in notes)


@pytest.mark.parametrize(
    ("boundaries", "joints", "told"),
    [
        ([CLAMPED, FREE], [HINGE], ["joints.0", "structure b moves freely", "while a stands still", "no stiffness in theta"]),
        ([FREE, FREE], [HINGE], ["joints.0", "no stiffness in theta"]),
        ([CLAMPED, FREE], [ALONG_Y], ["joints.0", "structure b moves freely", "no degree of freedom for that (y)"]),
        ([CLAMPED, FREE], [LEVER], ["structure b moves freely", "no stiffness in y, theta"]),
        ([CLAMPED, FREE, FREE], [FIXED, HINGE], ["joints.1", "structure c moves freely", "while b stands still"]),
        ([CLAMPED, FREE, CLAMPED], [HINGE, joint(0.0, 0.0)], ["joints.0", "structure b moves freely"]),
    ],
)
@pytest.mark.parametrize("command", ["export", "respond", "show"])
def test_a_mechanism_is_refused(run, tmp_path, boundaries, joints, told, command):
    assert free_motions(boundaries, joints) > (0 if CLAMPED in boundaries else 2)
    path = write(tmp_path, boundaries, joints)
    out = {"export": ["-o", tmp_path / "x.fmu"], "respond": ["-o", tmp_path / "x.csv"], "show": []}[command]
    done = run(command, path, *out, expect=1)
    assert all(part in done.stderr for part in [*told, "mechanisms = true"])
    assert not list(tmp_path.glob("x.*"))


@pytest.mark.parametrize(
    ("boundaries", "joints"),
    [
        ([CLAMPED, FREE, CLAMPED], [HINGE, HINGE]),
        # a spring that only hardens, and a slider, hold too
        ([CLAMPED, FREE], [joint(1e6, 0.0, cubic=[0.0, 1e9])]),
        ([CLAMPED, FREE], [joint(1e6, 0.0, friction=[{"dof": "theta", "law": "jenkins", "stiffness": 1e3, "slip_force": 1.0}])]),
    ],
)
def test_what_holds_by_other_ways_is_no_mechanism(run, tmp_path, boundaries, joints):
    done = run("export", write(tmp_path, boundaries, joints), "-o", tmp_path / "x.fmu", "--json")
    told = json.loads(done.stdout)
    # these beams have no damping
    assert all("is undamped" in note for note in told["notes"]) and told["warnings"] == []


def test_a_mechanism_may_be_meant(run, tmp_path):
    path = write(tmp_path, [CLAMPED, FREE], [HINGE], "mechanisms = true")
    done = run("export", path, "-o", tmp_path / "x.fmu")
    assert "warning: joint lap0: structure b moves freely" in done.stderr
    assert "nothing holds structures a, b: free in 1 motion," in done.stderr


def test_steps_too_long_for_a_joint_are_refused(run, tmp_path):
    """4096 parts of a step, and no more: what is beyond is said, not cut."""
    text = write(tmp_path, [CLAMPED, FREE], [joint(1e6, 1e3, cubic=[1e20, 0.0])]).read_text()
    history = '[response]\nkind = "history"\nduration = 0.02\nstep = {}\n[response.loads]\npush = {{ amplitude = 1000.0 }}\n'
    for step, code in [(1e-5, 0), (0.02, 1)]:
        path = tmp_path / "history.toml"
        path.write_text(text.split("[response]")[0] + history.format(step))
        done = run("respond", path, "-o", tmp_path / "out.csv", expect=code)
        assert ("4096 parts of a step of 0.02 s are too long" in done.stderr) == bool(code)
