"""Random joints, structures and test set-ups without noise: stiffness over decades, damping, sets of DOFs, one or two bolts."""

import json
import subprocess

import numpy as np
import rig


def stiffness_and_damping(generator, model):
    translation = 10 ** generator.uniform(4.5, 8)
    rotation = translation * 10 ** generator.uniform(-4, -2.5)
    coupling = generator.uniform(-0.6, 0.6) * np.sqrt(translation * rotation) if model == "full" else 0.0
    stiffness = np.array([[translation, coupling], [coupling, rotation]])
    if model == "translation":
        stiffness[1, 1] = 0.0
    return stiffness, 10 ** generator.uniform(-6, -4) * stiffness


def write(folder, seed):
    """Data and a study of them; its path, and the stiffness of the first bolt's joint."""
    generator = np.random.default_rng(seed)
    length = {"A": generator.uniform(0.2, 0.5), "B": generator.uniform(0.15, 0.5)}
    loss = {side: 10 ** generator.uniform(-3.5, -1.5) for side in "AB"}
    bolts = 2 if generator.random() < 0.35 else 1
    model = str(generator.choice(["full", "diagonal", "translation"]))
    has_rotation = model != "translation" or generator.random() < 0.3
    gap = generator.uniform(0.02, 0.05)
    at = {
        "A": [length["A"] - 0.01 - gap * bolt for bolt in range(bolts)],
        "B": [0.01 + gap * bolt for bolt in range(bolts)],
    }
    first = generator.uniform(0.5, 0.7) * length["B"]
    points = np.linspace(first, 0.97 * length["B"], int(generator.integers(2, 4)))
    frequency = np.linspace(10, generator.choice([500.0, 1000.0, 2000.0]), int(generator.integers(80, 500)))
    omega = 2 * np.pi * frequency
    alike = generator.random() < 0.5
    joints = [stiffness_and_damping(generator, model) for _ in range(bolts)]
    if alike:
        joints = [joints[0]] * bolts
    before = dict(rig.LENGTH), dict(rig.LOSS)
    try:
        rig.LENGTH.update(length)
        rig.LOSS.update(loss)
        a, b = rig.Body("A", at["A"]), rig.Body("B", [*at["B"], *points])
        dofs = (0, 1) if has_rotation else (0,)
        own = {side: [(side, x, dof) for x in at[side] for dof in dofs] for side in "AB"}
        along = [("B", x, 0) for x in points]
        springs = [
            {"A": xa, "B": xb, "stiffness": stiffness + 1j * omega[:, None, None] * damping}
            for xa, xb, (stiffness, damping) in zip(at["A"], at["B"], joints)
        ]
        sets = {
            "A": rig.receptances(omega, [a], own["A"]),
            "B": rig.receptances(omega, [b], own["B"] + along),
            "C": rig.receptances(omega, [a, b], along, springs),
        }
    finally:
        rig.LENGTH.update(before[0])
        rig.LOSS.update(before[1])
    directions = ("Y", "RZ") if has_rotation else ("Y",)
    of_points = [f"{11 + point}:+Y" for point in range(len(points))]
    labels = {
        "A": [f"{1 + bolt}:+{direction}" for bolt in range(bolts) for direction in directions],
        "B": [f"{5 + bolt}:+{direction}" for bolt in range(bolts) for direction in directions] + of_points,
        "C": of_points,
    }
    for name, z in sets.items():
        np.savez(
            folder / f"{name}.npz", frequency=frequency, frf=z, response=labels[name], reference=labels[name],
            quantity="receptance", axes="frequency,response,reference",
        )

    def places(number):
        theta = ', theta = "{0}:+RZ"' if has_rotation else ""
        name = ', name = "bolt-{0}"' if bolts > 1 else ""
        all_of = [
            f'{{ y = "{number + bolt}:+Y"{theta.format(number + bolt)}{name.format(bolt + 1)} }}' for bolt in range(bolts)
        ]
        return all_of[0] if bolts == 1 else f"[{', '.join(all_of)}]"

    kind = f'bolts = "{"alike" if alike else "different"}"\n' if bolts > 1 else ""
    study = folder / "study.toml"
    study.write_text(
        f"""method = "frf-decoupling"
name = "random"
budget = "none"
[a]
frf = "A.npz"
joint = {places(1)}
[b]
frf = "B.npz"
joint = {places(5)}
[assembly]
frf = "C.npz"
points = {json.dumps(of_points)}
[joint]
model = "{model}"
{kind}""",
        encoding="utf-8",
    )
    return study, joints[0][0]


def identified(program, study):
    command = [program, "identify", study, "-o", study.parent / "joint.json", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode in (0, 3), done.stderr
    return json.loads(done.stdout)


def first_joint(whole):
    return (whole.get("joint_file") or whole["bolts"][0]["joint_file"])["joint"]


def is_expected(warning):
    """What is true of these studies, beside any alarm."""
    return "states no units" in warning or "determine the joint there" in warning
