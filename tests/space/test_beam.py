"""Beams in space that the program computes, against an independent generator of frames, as a substructure of a joint."""

import numpy as np
import pytest
from chains import definite, names
from frames import STEEL, Frame
from scipy.linalg import eigh
from test_identify import apart, identified

E, G, RHO = 7e10, 7e10 / 2.6, 2700.0
WIDTH, HEIGHT = 0.02, 0.012
# J of this rectangle: a b³ (1/3 − 0.21 b/a (1 − b⁴/12a⁴)), to 1e-3 (Roark, table 10.1)
ROARK = WIDTH * HEIGHT**3 * (1 / 3 - 0.21 * HEIGHT / WIDTH * (1 - HEIGHT**4 / (12 * WIDTH**4)))
ZETA = 0.002
LINES = np.linspace(60, 1800, 40)


def series():
    """J of the rectangle, by Saint-Venant's series."""
    n = np.arange(1, 200, 2)
    part = np.sum(np.tanh(n * np.pi * WIDTH / (2 * HEIGHT)) / n**5)
    return WIDTH * HEIGHT**3 / 3 * (1 - 192 * HEIGHT / (np.pi**5 * WIDTH) * part)


def rectangle(points, count):
    """The frame of as many equal elements, with a damping ratio for all elastic modes."""
    ends = [np.array(p, float) for p in points]
    line = [ends[0]]
    for start, end in zip(ends, ends[1:]):
        line += [start + (end - start) * n / count for n in range(1, count + 1)]
    # of a beam along x frames.py has the section's y along −z
    A, Iy, Iz = WIDTH * HEIGHT, HEIGHT * WIDTH**3 / 12, WIDTH * HEIGHT**3 / 12
    return [p.tolist() for p in line], (E, G, RHO, A, Iy, Iz, series())


class Damped(Frame):
    """With C = M Φ diag(2ζω) Φᵀ M."""

    def __init__(self, points, section):
        super().__init__(points, section)
        squares, shapes = eigh(self.K, self.M)
        omega = np.sqrt(np.maximum(squares, 0))
        omega[:6] = 0
        self.C = self.M @ shapes @ np.diag(2 * ZETA * omega) @ shapes.T @ self.M


def test_saint_venants_series_is_roarks():
    assert series() == pytest.approx(ROARK, rel=2e-3)


def test_a_computed_beam_carries_a_joint(run, tmp_path):
    """B is a beam along x that is nowhere measured; the joint comes back from functions on A and at B's far end."""
    K, C = definite(3, 2e6), definite(4, 60.0)
    points, section = rectangle([[0, 0, 0], [0.3, 0, 0]], 40)
    b = Damped(points, section)
    a = Frame([[-0.5, 0.1, 0.2], [-0.35, 0.15, 0.05], [-0.2, 0.02, 0.1], [0, 0, 0]], STEEL, ground=[3e6, 2e6, 4e6, 3e4, 4e4, 2e4])
    na, nb = len(a.K), len(b.K)
    S = np.zeros((6, na + nb))
    S[:, na - 6 : na], S[:, na : na + 6] = np.eye(6), -np.eye(6)
    whole = {}
    for name in "KCM":
        one, other = getattr(a, name), getattr(b, name)
        whole[name] = np.block([[one, np.zeros((na, nb))], [np.zeros((nb, na)), other]])
    places = list(range(na - 6, na)) + list(range(na + nb - 6, na + nb))
    alone = np.array([a.receptance(f)[-6:, -6:] for f in LINES])
    together = []
    for f in LINES:
        s = 2j * np.pi * f
        dynamic = whole["K"] + S.T @ K @ S + s * (whole["C"] + S.T @ C @ S) + s**2 * whole["M"]
        together.append(np.linalg.inv(dynamic)[np.ix_(places, places)])

    def save(name, values, dofs):
        np.savez(tmp_path / name, frequency=LINES, frf=np.moveaxis(np.array(values), 0, 2), response=dofs, reference=dofs,
                 quantity="receptance", axes="response,reference,frequency")

    save("a.npz", alone, names(10))
    save("c.npz", together, names(10) + names(21))
    (tmp_path / "study.toml").write_text(f"""
method = "frf-space"
name = "computed"
budget = "none"
[a]
frf = "a.npz"
interface = 10
[b]
interface = 20
responses = {names(21)}
references = {names(21)}
[b.beam]
points = [{{ node = 20, position = [0, 0, 0] }}, {{ node = 21, position = [0.3, 0, 0] }}]
width = {WIDTH}
height = {HEIGHT}
height_along = [0, 0, 1]
youngs_modulus = {E}
density = {RHO}
theory = "euler-bernoulli"
damping_ratio = {ZETA}
[assembly]
frf = "c.npz"
[joint]
model = "full"
length = 0.03
""")
    joint = identified(run, tmp_path)["joint_file"]["joint"]
    assert apart(joint["stiffness"], K) < 1e-6 and apart(joint["damping"], C) < 1e-5


@pytest.mark.parametrize(
    "old, new, fragments",
    [
        ("height_along = [0, 0, 1]", "height_along = [1, 0, 0]", ["beam.height_along", "across"]),
        ("width = 0.02", "width = -0.02", ["beam.width", "-0.02", "positive"]),
        ("width = 0.02", "width = 20", ["beam.width", "found 20", "millimetres?"]),
        ("youngs_modulus = 7e10", "youngs_modulus = 70", ["beam.youngs_modulus", "found 70", "GPa"]),
        ("interface = 20", "interface = 22", ["b.interface", "22:+X"]),
        ('[b.beam]', 'frf = "a.npz"\n[b.beam]', ["`b`", "several of frf, modal and beam"]),
        ("damping_ratio = 0.002", "damping_ratio = 2", ["damping_ratio", "2"]),
        ("node = 21", "node = 20", ["beam.points", "node 20 twice"]),
        ('model = "full"\nlength = 0.03', 'model = "bolt"\nlength = 0.03\n[budget]\njoint = {}', ["budget.joint", "is a node", "on both sides"]),
    ],
)
def test_what_is_wrong_with_a_beam_is_told(run, tmp_path, old, new, fragments):
    dofs = names(10)
    values = np.moveaxis(np.array([np.eye(6) * (1e-6 - 1e-8j) for _ in LINES]), 0, 2)
    np.savez(tmp_path / "a.npz", frequency=LINES, frf=values, response=dofs, reference=dofs, quantity="receptance",
             axes="response,reference,frequency")
    text = """
method = "frf-space"
name = "computed"
[a]
frf = "a.npz"
interface = 10
[b]
interface = 20
[b.beam]
points = [{ node = 20, position = [0, 0, 0] }, { node = 21, position = [0.3, 0, 0] }]
width = 0.02
height = 0.012
height_along = [0, 0, 1]
youngs_modulus = 7e10
density = 2700
damping_ratio = 0.002
[assembly]
frf = "a.npz"
[joint]
model = "full"
length = 0.03
"""
    assert old in text
    (tmp_path / "study.toml").write_text(text.replace(old, new, 1))
    told = run("identify", tmp_path / "study.toml", "-o", tmp_path / "j.joint.json", expect=1).stderr
    assert all(fragment in told for fragment in fragments), told
