"""Chains of frames with joints between them, and planned tests on them; from frames.py alone, nothing of the program under test."""

import json

import numpy as np
from frames import AXES, LIGHT, STEEL, Frame

SIX = [f"+{axis}" for axis in AXES] + [f"+R{axis}" for axis in AXES]


LENGTHS = np.array([1, 1, 1, 0.03, 0.03, 0.03])


def definite(seed, size):
    """A matrix of a joint without any symmetry."""
    mixed = np.eye(6) + 0.3 * np.random.default_rng(seed).normal(size=(6, 6))
    return mixed @ mixed.T * np.outer(LENGTHS, LENGTHS) * size


def names(node):
    """The six motions of a node."""
    return [f"{node}:{axis}" for axis in SIX]


def joint_file(path, K, C, **more):
    dofs = ["x", "y", "z", "rx", "ry", "rz"]
    joint = {"dofs": dofs, "stiffness": np.asarray(K).tolist(), "damping": np.asarray(C).tolist()}
    path.write_text(json.dumps({"format": "bolted-joint/1", "name": "known", "joint": joint, **more}))


class Chain:
    """Parts a, b, c …: the last point of each is joined to the first point of the next one."""

    def __init__(self, joints, light=False):
        inner = LIGHT
        if light:
            E, G, rho, *section = LIGHT
            inner = (E * 1e4, G * 1e4, rho * 1e-4, *section)
        a = [[-0.5, 0.1, 0.2], [-0.35, 0.15, 0.05], [-0.2, 0.02, 0.1], [-0.08, 0.05, 0.0], [0, 0, 0]]
        b = [[0, 0, 0], [0.06, 0.02, -0.03], [0.1, 0.05, 0.02], [0.16, 0.01, 0.01]]
        c = [[0, 0, 0], [0.05, 0.01, 0.02], [0.12, -0.03, 0.0], [0.2, 0.02, 0.04]]
        points = [a, b, c, c][: len(joints) + 1]
        sections = [STEEL, inner, LIGHT, LIGHT]
        ground = [[3e6, 2e6, 4e6, 3e4, 4e4, 2e4], None, None, None]
        self.parts = [Frame(p, s, ground=g) for p, s, g in zip(points, sections, ground)]
        self.joints = [tuple(np.asarray(x, float) for x in joint) for joint in joints]
        self.starts = np.cumsum([0] + [len(part.K) for part in self.parts])

    def nodes(self, part):
        """Numbers of a part's points."""
        return [100 * (part + 1) + n for n in range(len(self.parts[part].K) // 6)]

    def receptances(self, frequencies):
        """Of each part, and of the assembly as one frame, lines × DOFs × DOFs."""
        alone = [np.array([part.receptance(f) for f in frequencies]) for part in self.parts]
        n = self.starts[-1]
        K, C, M = (np.zeros((n, n)) for _ in range(3))
        for start, part in zip(self.starts, self.parts):
            own = slice(start, start + len(part.K))
            K[own, own], C[own, own], M[own, own] = part.K, part.C, part.M
        for number, (k, c) in enumerate(self.joints):
            S = np.zeros((6, n))
            end = self.starts[number + 1]
            S[:, end - 6 : end], S[:, end : end + 6] = np.eye(6), -np.eye(6)
            K, C = K + S.T @ k @ S, C + S.T @ c @ S
        s = 2j * np.pi * np.asarray(frequencies)
        together = np.array([np.linalg.inv(K + x * C + x**2 * M) for x in s])
        return alone, together

    def write(self, folder, frequencies, measured, hit, joints, noise=0.0, rng=None, more=""):
        """Files of all parts with every motion of their points, of the assembly between translations of some points, and the
        study. `joints` are the tables [[joint]]."""
        alone, together = self.receptances(frequencies)
        dofs = [sum((names(node) for node in self.nodes(part)), []) for part in range(len(self.parts))]

        def save(name, values, response, reference):
            values = np.moveaxis(values, 0, 2)
            np.savez(folder / name, frequency=frequencies, frf=values, response=response, reference=reference,
                     quantity="receptance", axes="response,reference,frequency")

        for letter, values, own in zip("abcd", alone, dofs):
            save(f"{letter}.npz", values, own, own)
        everything = sum(dofs, [])
        wanted = lambda nodes: [everything.index(f"{node}:+{axis}") for node in nodes for axis in AXES]
        rows, columns = wanted(measured), wanted(hit)
        values = together[:, rows][:, :, columns]
        if noise:
            rms = np.sqrt(np.mean(np.abs(values) ** 2, axis=0))
            values = values + noise * rms * (rng.normal(size=values.shape) + 1j * rng.normal(size=values.shape)) / np.sqrt(2)
        save("assembly.npz", values, [everything[i] for i in rows], [everything[i] for i in columns])
        text = 'method = "frf-space"\nname = "chain"\n' + more
        if noise:
            text += f"[noise]\nrelative = {noise}\n"
        for part, letter in enumerate("abcd"[: len(self.parts)]):
            own = self.nodes(part)
            of = lambda nodes: [f"{node}:+{axis}" for node in nodes if node in own for axis in AXES]
            text += f'[{letter}]\nfrf = "{letter}.npz"\ninterface = {own[-1] if part == 0 else own[0]}\n'
            text += f"responses = {json.dumps(of(measured))}\nreferences = {json.dumps(of(hit))}\n"
            if 0 < part < len(self.parts) - 1:
                text += f"far = {{ interface = {own[-1]} }}\n"
        text += '[assembly]\nfrf = "assembly.npz"\n' + "".join(f"[[joint]]\n{joint}\n" for joint in joints)
        (folder / "study.toml").write_text(text)
        return everything, together


def plan_study(rig, folder, frequencies, model, noise, K, C, more="", expected=None):
    """The study of a test on a rig of frames.py that is not made yet: functions of the interfaces' nodes, and where sensors and
    impacts will be. Every part has every motion of its points."""
    for side, (name, frame) in enumerate(zip("ab", (rig.a, rig.b))):
        values = np.moveaxis(np.array([frame.receptance(f) for f in frequencies]), 0, 2)
        dofs = sum((names(10 * (side + 1) + n) for n in range(len(frame.K) // 6)), [])
        np.savez(folder / f"{name}.npz", frequency=frequencies, frf=values, response=dofs, reference=dofs,
                 quantity="receptance", axes="response,reference,frequency")
    text = f'method = "frf-space"\nname = "plan"\n{more}[noise]\nrelative = {noise}\n'
    for side, name in enumerate("ab"):
        places, hits, directions = rig.sides[side]
        node = 14 if side == 0 else 20
        text += f'[{name}]\nfrf = "{name}.npz"\ninterface = {node}\n'
        for n, p in enumerate(places):
            text += f"[[{name}.sensors]]\nnode = {100 * (side + 1) + n}\nposition = {p.tolist()}\n"
        for dof, p, d in zip(rig.names(side)[1], hits, directions):
            text += f'[[{name}.impacts]]\ndof = "{dof}"\nposition = {p.tolist()}\ndirection = {d.tolist()}\n'
    text += f"[joint]\n{model}\nlength = 0.03\n"
    expected = expected or f"{{ stiffness = {np.asarray(K).tolist()}, damping = {np.asarray(C).tolist()} }}"
    (folder / "plan.toml").write_text(text + f"expected = {expected}\n")
