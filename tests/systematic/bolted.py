"""Several bolts between the two beams of rig.py: joints drawn at random, and whether the search ends at the global minimum.

The noise of exact data is stated as 1 % all the same: a minimum that leaves less than that must not pass for the best.

    python tests/systematic/bolted.py [DRAWS [BOLTS]]

The likelihood of what is found is computed here, from one global matrix, and compared with that of the joints that made the data.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import mistakes
import numpy as np
import rig
from conftest import entries

SPACING = 0.03
BEYOND = [0.10, 0.13, 0.16, 0.19, 0.215]
# as few as two bolts can do with, far from them
OUTER = [0.185, 0.200, 0.215]
ASSEMBLY_ALONE = "relative = 0.01\nfloor = 0\na = { relative = 0, floor = 0 }\nb = { relative = 0, floor = 0 }\n"
SOFTER = 0.6  # of the second bolt that differs
# Bolts that are nearer to each other move nearly alike: what tells them apart is then less than 1 % of noise on A and B.
APART = 0.08
BETWEEN_AND_BEYOND = [0.055, 0.120, 0.150, 0.185]


class Rig:
    """So many bolts, with points of B between them or all beyond them."""

    def __init__(self, bolts, between=True, points=None, frequency=rig.FREQUENCY, spacing=SPACING):
        self.frequency = np.asarray(frequency, float)
        self.omega = 2 * np.pi * self.frequency
        spacing = min(spacing, 0.09 / max(bolts - 1, 1))
        self.b = 0.015 + spacing * np.arange(bolts)
        self.a = 0.285 - spacing * np.arange(bolts)[::-1]
        inner = list(self.b + spacing / 2) if between else []
        outer = [x for x in BEYOND if x > self.b[-1] + 0.02]
        self.points = np.array(points or (inner + outer)[: 2 * bolts] + [0.221])
        self.names = [f"b{i + 1}" for i in range(bolts)]

    def substructures(self):
        wanted = [("A", x, dof) for x in self.a for dof in (0, 1)]
        a = rig.receptances(self.omega, [rig.Body("A", list(self.a))], wanted)
        wanted = [("B", x, dof) for x in self.b for dof in (0, 1)] + [("B", x, 0) for x in self.points]
        return a, rig.receptances(self.omega, [rig.Body("B", [*self.b, *self.points])], wanted)

    def assembly(self, joints):
        """Each joint is (K, C)."""
        bodies = [rig.Body("A", list(self.a)), rig.Body("B", [*self.b, *self.points])]
        bolts = [
            {"A": a, "B": b, "stiffness": k + 1j * self.omega[:, None, None] * c}
            for a, b, (k, c) in zip(self.a, self.b, joints)
        ]
        return rig.receptances(self.omega, bodies, [("B", x, 0) for x in self.points], bolts)

    def test_data(self, mistakes, joints, noise, seed):
        """Measured functions of A, of B and of the assembly by a laboratory that makes these mistakes, both structures as they are
        believed to be."""
        bolts = range(len(self.a))
        at = {
            side: [x + mistakes.joint_sensor.get((side, bolt), 0.0) for bolt, x in zip(bolts, joints_m)]
            for side, joints_m in (("A", self.a), ("B", self.b))
        }
        points = self.points + np.array([mistakes.point.get(i, 0.0) for i in range(len(self.points))])

        def body(side, nodes, scale=0.0):
            return rig.Body(side, nodes, rig.YOUNG * (1 + scale) ** 2)

        wanted = {side: [(side, x, dof) for x in at[side] for dof in (0, 1)] for side in "AB"}
        wanted["B"] += [("B", x, 0) for x in self.points]
        sets = {
            "A": rig.receptances(self.omega, [body("A", at["A"])], wanted["A"]),
            "B": rig.receptances(self.omega, [body("B", [*at["B"], *self.points])], wanted["B"]),
        }
        together = [
            body("A", list(self.a), mistakes.frequency.get("A", 0.0)),
            body("B", [*self.b, *points], mistakes.frequency.get("B", 0.0)),
        ]
        elements = [
            {"A": a, "B": b, "stiffness": k * (1 + 1j * mistakes.loss_factor) + 1j * self.omega[:, None, None] * c}
            for a, b, (k, c) in zip(self.a, self.b, joints)
        ]
        masses = [(side, (self.a if side == "A" else self.b)[bolt], kg) for (side, bolt), kg in mistakes.joint_mass.items()]
        sets["C"] = rig.receptances(self.omega, together, [("B", x, 0) for x in points], elements, masses)
        count, own = len(self.points), 2 * len(self.a)
        translations = {"A": range(0, own, 2), "B": [*range(0, own, 2), *range(own, own + count)], "C": range(count)}
        return rig.measured(sets, self.omega, mistakes, translations, noise, seed)

    def write(self, folder, sets, noise, bolts="different", budget='"none"'):
        """Archives and a study; its path."""
        labels = {
            side: [f"{first + i}:{axis}" for i in range(len(self.a)) for axis in ("+Y", "+RZ")]
            for side, first in (("A", 1), ("B", 31))
        }
        labels["C"] = [f"{61 + i}:+Y" for i in range(len(self.points))]
        labels["B"] = labels["B"] + labels["C"]
        for name, z in sets.items():
            np.savez(
                folder / f"{name}.npz", frequency=self.frequency, frf=z, response=labels[name], reference=labels[name],
                quantity="receptance", axes="frequency,response,reference",
            )

        def places(side):
            at = self.a if side == "A" else self.b
            of = [
                f'name = "{n}", y = "{y}", theta = "{t}", x = {x:.6f}'
                for n, y, t, x in zip(self.names, labels[side][::2], labels[side][1::2], at)
            ]
            return "[" + ", ".join(f"{{ {one} }}" for one in of) + "]" if len(of) > 1 else f"{{ {of[0].split(', ', 1)[1]} }}"

        positions = ", ".join(f'"{label}" = {x}' for label, x in zip(labels["C"], self.points))
        study = folder / "study.toml"
        study.write_text(
            f"""method = "frf-decoupling"
name = "rig"
{"" if budget is None else f"budget = {budget}"}
[a]
frf = "A.npz"
joint = {places("A")}
[b]
frf = "B.npz"
joint = {places("B")}
points = {{ {positions} }}
[assembly]
frf = "C.npz"
points = {labels["C"]}
[joint]
model = "full"
{f'bolts = "{bolts}"' if len(self.a) > 1 else ""}
[noise]
{noise}
""",
            encoding="utf-8",
        )
        return study

    def misfit(self, measured, joints, relative):
        """−2 ln L of independent errors that are this part of the computed modulus, but for a constant."""
        computed = self.assembly(joints)
        variance = (relative * abs(computed)) ** 2
        return 2 * np.sum(abs(measured - computed) ** 2 / variance + np.log(variance))


def drawn(generator, bolts, equal):
    """Joints from soft to stiff, all the same or up to tenfold apart."""

    def one():
        y, theta = 1.2e6 * 10 ** generator.uniform(-0.5, 0.5), 1.3e3 * 10 ** generator.uniform(-0.5, 0.5)
        coupling = generator.uniform(-0.3, 0.3) * np.sqrt(y * theta)
        k = np.array([[y, coupling], [coupling, theta]])
        return k, k * 10 ** generator.uniform(-5.3, -4.3)

    if equal:
        return [one()] * bolts
    first = one()
    return [first] + [tuple(m * 10 ** generator.uniform(-1, 1) for m in first) for _ in range(bolts - 1)]


def noisy(generator, z, relative):
    parts = generator.standard_normal((2, *z.shape))
    return z * (1 + relative * (parts[0] + 1j * parts[1]) / np.sqrt(2))


def identified(program, study, bolts):
    """Joints, and seconds that it takes."""
    begun = time.perf_counter()
    done = subprocess.run(
        [program, "identify", study, "-o", study.parent / "joint.json", "--json"], capture_output=True, text=True, encoding="utf-8"
    )
    seconds = time.perf_counter() - begun
    assert done.returncode in (0, 3), done.stderr
    whole = json.loads(done.stdout)
    files = [one["joint_file"] for one in whole["bolts"]] if whole["bolts"] else [whole["joint_file"]] * bolts
    return [tuple(np.array(file["joint"][name]) for name in ("stiffness", "damping")) for file in files], seconds, whole


def error(joints, truth):
    """Largest of all entries, relative to the diagonal."""

    def of(found, exact):
        scale = np.sqrt(np.diag(exact))
        return np.max(abs(found - exact) / np.outer(scale, scale))

    return max(of(f, e) for found, exact in zip(joints, truth) for f, e in zip(found, exact))


def draw(program, seed, bolts=2, folder=None):
    """Whether the search ends at the global minimum; what it is and how long it takes."""
    generator = np.random.default_rng(seed)
    equal, exact = seed % 2 == 0, seed // 2 % 2 == 0
    where = ["outer", "between", "beyond"][seed % 3]
    test = Rig(bolts, where == "between", OUTER if where == "outer" and bolts == 2 else None)
    truth = drawn(generator, bolts, equal)
    a, b = test.substructures()
    relative = 0.0 if exact else 0.01
    sets = {"A": a, "B": b, "C": noisy(generator, test.assembly(truth), relative)}
    study = test.write(folder, sets, ASSEMBLY_ALONE)
    found, seconds, whole = identified(program, study, bolts)
    wrong = error(found, truth)
    if exact:
        is_there, excess = wrong < 1e-3, np.nan
    else:
        excess = test.misfit(sets["C"], found, relative) - test.misfit(sets["C"], truth, relative)
        is_there = excess <= 0
    words = f"{'equal' if equal else 'unequal':8}{'exact' if exact else '1 %':6}{where:8}"
    return bool(is_there), f"{words} error {wrong:8.2e} excess {excess:8.1f} {seconds:6.2f} s"


def a_little_wrong(program, folder, draw, budget, kind, is_placed=False):
    """Everything a little wrong with two bolts, but for the places of the sensors if these are right: errors of the unknowns in
    standard deviations, one bolt after the other if they differ; None where the program refuses the joint."""
    test = Rig(2, points=BETWEEN_AND_BEYOND, spacing=APART)
    rows = {"A": 4, "B": 4 + len(test.points), "C": len(test.points)}
    wrong = mistakes.drawn(np.random.default_rng(100 + draw), rows, [(side, bolt) for side in "AB" for bolt in (0, 1)])
    if is_placed:
        wrong.joint_sensor.clear()
        wrong.point.clear()
    joints = [(part * rig.STIFFNESS, part * rig.DAMPING) for part in (1.0, SOFTER if kind == "different" else 1.0)]
    sets = test.test_data(wrong, joints, 0.01, draw)
    study = test.write(folder, sets, "relative = 0.01\nfloor = 0", kind, budget)
    _, _, whole = identified(program, study, 2)
    files = [one["joint_file"] for one in whole["bolts"]] if whole["bolts"] else [whole["joint_file"]]
    return in_deviations(files, joints) if whole["usable"] else None


def in_deviations(files, joints):
    """Errors of the unknowns of each joint file in their standard deviations, one bolt after the other."""
    truth = [np.array([*k[np.triu_indices(2)], *c[np.triu_indices(2)]]) for k, c in joints]
    z = [(entries(file["joint"]) - exact) / entries(file["uncertainty"]["standard_deviation"]) for file, exact in zip(files, truth)]
    return np.concatenate(z)


def near(program, folder, seed, bolts, spacing, budget='"none"', model="full"):
    """Joints of bolts that are near each other, where all functions have noise of 1 %: errors in deviations, and what is said. Of the
    model "translation" the joints have k_yy and c_yy alone."""
    test = Rig(bolts, spacing=spacing)
    joints = drawn(np.random.default_rng(seed), bolts, equal=False)
    if model == "translation":
        joints = [tuple(m * np.diag([1.0, 0.0]) for m in joint) for joint in joints]
    sets = test.test_data(rig.Mistakes(), joints, 0.01, seed)
    study = test.write(folder, sets, "relative = 0.01\nfloor = 0", budget=budget)
    text = study.read_text(encoding="utf-8")
    study.write_text(text.replace('model = "full"', f'model = "{model}"'), encoding="utf-8")
    _, _, whole = identified(program, study, bolts)
    files = [one["joint_file"] for one in whole["bolts"]]
    if model == "translation":
        return np.concatenate([of_translation(file, joint) for file, joint in zip(files, joints)]), whole
    return in_deviations(files, joints), whole


def of_translation(file, joint):
    """Errors of k_yy and c_yy in their standard deviations."""
    deviations = file["uncertainty"]["standard_deviation"]
    names = zip(("stiffness", "damping"), joint)
    return np.array([(file["joint"][name][0][0] - exact[0, 0]) / deviations[name][0][0] for name, exact in names])


def main(draws=24, bolts=2):
    program = os.environ.get("BOLTED_JOINT", pathlib.Path(__file__).resolve().parents[2] / "target/release/bolted-joint")
    there = 0
    for seed in range(draws):
        with tempfile.TemporaryDirectory() as folder:
            is_there, words = draw(program, seed, bolts, pathlib.Path(folder))
        there += is_there
        print(f"{seed:3} {words} {'' if is_there else 'NOT THE MINIMUM'}", flush=True)
    print(f"{there} of {draws} at the global minimum")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
