"""Tests in a plane: beams along x that bend along y, in a chain, from the matrices of frames.py; nothing of the program under test."""

import json

import numpy as np
from frames import LIGHT, STEEL, Frame

LENGTHS = np.array([1, 0.03])


def definite(seed, size):
    """A joint in y and θ without any symmetry."""
    mixed = np.eye(2) + 0.3 * np.random.default_rng(seed).normal(size=(2, 2))
    return mixed @ mixed.T * np.outer(LENGTHS, LENGTHS) * size


class Line:
    """What of a straight beam along x moves along y and turns about z: two motions for each point."""

    def __init__(self, places, section, ground=None):
        whole = Frame([[x, 0, 0] for x in places], section)
        own = np.sort(np.concatenate([6 * np.arange(len(places)) + 1, 6 * np.arange(len(places)) + 5]))
        self.K, self.C, self.M = (getattr(whole, name)[np.ix_(own, own)] for name in "KCM")
        if ground is not None:
            self.K[:2, :2] += np.diag(ground)

    def receptance(self, frequency):
        s = 2j * np.pi * frequency
        return np.linalg.inv(self.K + s * self.C + s**2 * self.M)


class Chain:
    """Spindle, holder and tool: the last point of each is joined to the first point of the next one."""

    def __init__(self, joints):
        places = [[-0.4, -0.25, -0.15, -0.05, 0], [0, 0.05, 0.09, 0.14], [0, 0.04, 0.1, 0.16]]
        grounds = [[3e6, 4e4], None, None]
        self.parts = [Line(*own) for own in zip(places, (STEEL, STEEL, LIGHT), grounds)][: len(joints) + 1]
        self.joints = joints
        self.starts = np.cumsum([0] + [len(part.K) for part in self.parts])
        self.dofs = [
            f"{100 * (part + 1) + n}:{motion}" for part, line in enumerate(self.parts) for n in range(len(line.K) // 2) for motion in ("+Y", "+RZ")
        ]

    def ends(self, part):
        """Numbers of the first and of the last point of a part."""
        return 100 * (part + 1), 100 * (part + 1) + len(self.parts[part].K) // 2 - 1

    def together(self, frequencies):
        """The assembly as one structure, lines × DOFs × DOFs."""
        n = self.starts[-1]
        K, C, M = (np.zeros((n, n)) for _ in range(3))
        for start, part in zip(self.starts, self.parts):
            own = slice(start, start + len(part.K))
            K[own, own], C[own, own], M[own, own] = part.K, part.C, part.M
        for number, (k, c) in enumerate(self.joints):
            S = np.zeros((2, n))
            end = self.starts[number + 1]
            S[:, end - 2 : end], S[:, end : end + 2] = np.eye(2), -np.eye(2)
            K, C = K + S.T @ k @ S, C + S.T @ c @ S
        s = 2j * np.pi * np.asarray(frequencies)
        return np.array([np.linalg.inv(K + x * C + x**2 * M) for x in s])

    def write(self, folder, frequencies, measured, tables, noise=0.0, rng=None, more=""):
        """Files of the parts, of the assembly between displacements at some points, and the study."""
        for part, (letter, line) in enumerate(zip("abc", self.parts)):
            own = self.dofs[self.starts[part] : self.starts[part + 1]]
            save(folder, letter, frequencies, np.array([line.receptance(f) for f in frequencies]), own, own)
        whole = self.together(frequencies)
        at = [self.dofs.index(f"{node}:+Y") for node in measured]
        values = noisy(whole[:, at][:, :, at], noise, rng)
        names = [self.dofs[i] for i in at]
        save(folder, "assembly", frequencies, values, names, names)
        text = 'method = "frf-space"\nname = "chain"\nmotions = ["y", "rz"]\n' + more
        if noise:
            text += f"[noise]\nrelative = {noise}\n"
        for part, letter in enumerate("abc"[: len(self.parts)]):
            first, last = self.ends(part)
            own = json.dumps([f"{node}:+Y" for node in measured if first <= node <= last])
            text += f'[{letter}]\nfrf = "{letter}.npz"\ninterface = {last if part == 0 else first}\n'
            text += f"responses = {own}\nreferences = {own}\n"
            if 0 < part < len(self.parts) - 1:
                text += f"far = {{ interface = {last} }}\n"
        text += '[assembly]\nfrf = "assembly.npz"\n' + "".join(f"[[joint]]\n{joint}\n" for joint in tables)
        (folder / "study.toml").write_text(text)
        return whole


def save(folder, name, frequencies, values, responses, references):
    np.savez(folder / f"{name}.npz", frequency=frequencies, frf=np.moveaxis(values, 0, 2), response=responses, reference=references,
             quantity="receptance", axes="response,reference,frequency")


def noisy(values, noise, rng):
    if not noise:
        return values
    rms = np.sqrt(np.mean(np.abs(values) ** 2, axis=0))
    return values + noise * rms * (rng.normal(size=values.shape) + 1j * rng.normal(size=values.shape)) / np.sqrt(2)


def joint_file(path, K, C, dofs):
    joint = {"dofs": dofs, "stiffness": np.asarray(K).tolist(), "damping": np.asarray(C).tolist()}
    path.write_text(json.dumps({"format": "bolted-joint/1", "name": "known", "joint": joint}))


class Rig:
    """Two beams whose ends have sensors and impacts along y near the joint, at places along x: what the rotation comes from."""

    SENSORS = [-0.03, -0.01, 0.01, 0.03]
    IMPACTS = [-0.025, 0.0, 0.025]

    def __init__(self, K, C):
        self.chain = Chain([(K, C)])

    def write(self, folder, frequencies, noise=0.0, rng=None, errors=None, budget="", of_sides=(0.0, 0.0)):
        """`errors` (m) are where the first sensors are beside the places that the study states."""
        parts = self.chain.parts
        whole = self.chain.together(frequencies)
        na = len(parts[0].K)
        ends = [[na - 2, na - 1], [na, na + 1]]
        rows = [np.array([[1, x + (errors or [0.0] * 4)[n]] for n, x in enumerate(self.SENSORS)]), np.array([[1, x] for x in self.SENSORS])]
        hits = np.array([[1, x] for x in self.IMPACTS])
        text = f'method = "frf-space"\nname = "rig"\nmotions = ["y", "rz"]\n{budget}'
        if noise:
            text += f"[noise]\nrelative = {noise}\n" + "".join(f"{name} = {own}\n" for name, own in zip("ab", of_sides) if own)
        names = []
        for side, (name, part) in enumerate(zip("ab", parts)):
            own = slice(na - 2, na) if side == 0 else slice(0, 2)
            Y = np.array([part.receptance(f)[own, own] for f in frequencies])
            responses = [f"{1000 * (side + 1) + n}:+Y" for n in range(4)]
            references = [f"{1000 * (side + 1) + 50 + n}:+Y" for n in range(3)]
            names.append((responses, references))
            Y = rows[side] @ Y @ hits.T
            if of_sides[side]:
                Y = Y * (1 + of_sides[side] * (rng.normal(size=Y.shape) + 1j * rng.normal(size=Y.shape)) / np.sqrt(2))
            save(folder, name, frequencies, Y, responses, references)
            text += f'[{name}]\nfrf = "{name}.npz"\n'
            text += "".join(f'[[{name}.sensors]]\ndof = "{dof}"\nposition = [{x}, 0, 0]\n' for dof, x in zip(responses, self.SENSORS))
            text += "".join(f'[[{name}.impacts]]\ndof = "{dof}"\nposition = [{x}, 0, 0]\n' for dof, x in zip(references, self.IMPACTS))
        R_u, R_f = np.zeros((8, whole.shape[1])), np.zeros((6, whole.shape[1]))
        for side in range(2):
            R_u[4 * side : 4 * side + 4, ends[side]] = rows[side]
            R_f[3 * side : 3 * side + 3, ends[side]] = hits
        values = noisy(R_u @ whole @ R_f.T, noise, rng)
        save(folder, "c", frequencies, values, *[names[0][n] + names[1][n] for n in range(2)])
        text += '[assembly]\nfrf = "c.npz"\n[joint]\nmodel = "full"\nlength = 0.03\n'
        (folder / "study.toml").write_text(text)
