"""Frames of beams in space (Euler and Bernoulli, two planes of bending, torsion, extension), tests on them, and their assembly
by a joint: nothing of the program under test."""

import numpy as np

AXES = "XYZ"


def cross(r):
    """[r]× with [r]× b = r × b."""
    x, y, z = r
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def beam(start, end, section):
    """Stiffness and consistent mass (12 × 12) of a beam between two points; section: E, G, rho, A, Iy, Iz, J."""
    E, G, rho, A, Iy, Iz, J = section
    along = np.subtract(end, start)
    L = np.linalg.norm(along)
    ex = along / L
    helper = np.eye(3)[np.argmin(np.abs(ex))]
    ey = np.cross(helper, ex)
    ey /= np.linalg.norm(ey)
    turn = np.array([ex, ey, np.cross(ex, ey)])
    K, M = np.zeros((12, 12)), np.zeros((12, 12))

    def put(matrix, dofs, block):
        matrix[np.ix_(dofs, dofs)] += block

    for dofs, k, m in (([0, 6], E * A, rho * A), ([3, 9], G * J, rho * (Iy + Iz))):
        put(K, dofs, k / L * np.array([[1, -1], [-1, 1]]))
        put(M, dofs, m * L / 6 * np.array([[2, 1], [1, 2]]))
    stiff = np.array([[12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2], [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2]])
    heavy = np.array([[156, 22 * L, 54, -13 * L], [22 * L, 4 * L**2, 13 * L, -3 * L**2], [54, 13 * L, 156, -22 * L], [-13 * L, -3 * L**2, -22 * L, 4 * L**2]])
    # y with rz; z with ry, whose slope is −dz/dx
    for dofs, I, sign in (([1, 5, 7, 11], Iz, 1.0), ([2, 4, 8, 10], Iy, -1.0)):
        flip = np.diag([1.0, sign, 1.0, sign])
        put(K, dofs, E * I / L**3 * flip @ stiff @ flip)
        put(M, dofs, rho * A * L / 420 * flip @ heavy @ flip)
    T = np.kron(np.eye(4), turn)
    return T.T @ K @ T, T.T @ M @ T


class Frame:
    """A chain of points joined by beams; `ground` holds the first point by springs."""

    def __init__(self, points, section, loss=2e-6, mass_damping=4.0, ground=None):
        n = 6 * len(points)
        self.K, self.M = np.zeros((n, n)), np.zeros((n, n))
        for i in range(len(points) - 1):
            k, m = beam(points[i], points[i + 1], section)
            dofs = np.arange(6 * i, 6 * i + 12)
            self.K[np.ix_(dofs, dofs)] += k
            self.M[np.ix_(dofs, dofs)] += m
        if ground is not None:
            self.K[:6, :6] += np.diag(ground)
        self.C = loss * self.K + mass_damping * self.M

    def receptance(self, frequency, K=0.0, C=0.0):
        s = 2j * np.pi * frequency
        return np.linalg.inv(self.K + K + s * (self.C + C) + s**2 * self.M)


def row(position, direction):
    """What a channel at a place on the rigid interface reads of the six motions of its point."""
    return np.concatenate([direction, np.cross(position, direction)])


STEEL = (2.1e11, 8e10, 7850.0, 6e-4, 2e-8, 8e-8, 6e-8)
LIGHT = (7e10, 2.7e10, 2700.0, 4e-4, 1e-8, 3e-8, 2e-8)


class Rig:
    """Two frames, sensors and impacts near the ends that the joint connects, and the assembly."""

    def __init__(self, K, C, seed=1, sensors=4, impacts=12):
        rng = np.random.default_rng(seed)
        a = [[-0.5, 0.1, 0.2], [-0.35, 0.15, 0.05], [-0.2, 0.02, 0.1], [-0.08, 0.05, 0.0], [0, 0, 0]]
        b = [[0, 0, 0], [0.12, 0.03, -0.05], [0.2, 0.2, 0.0], [0.3, 0.22, 0.12]]
        self.a = Frame(a, STEEL, ground=[3e6, 2e6, 4e6, 3e4, 4e4, 2e4])
        self.b = Frame(b, LIGHT)
        self.at = [6 * len(a) - 6, 0]
        self.K, self.C = np.asarray(K, float), np.asarray(C, float)
        self.sides = []
        for side in range(2):
            places = rng.uniform(-0.03, 0.03, size=(sensors, 3))
            hits = rng.uniform(-0.03, 0.03, size=(impacts, 3))
            directions = rng.normal(size=(impacts, 3))
            directions /= np.linalg.norm(directions, axis=1)[:, None]
            self.sides.append((places, hits, directions))

    def rows(self, side, errors=None):
        """R_u and R_f; `errors` are those of positions (m) and directions (rad), and of gains, which the study does not know."""
        places, hits, directions = self.sides[side]
        u = np.array([row(p, e) for p in places for e in np.eye(3)])
        f = np.array([row(p, d) for p, d in zip(hits, directions)])
        if errors is None:
            return u, f
        rng, position, rotation, gain = errors
        turned = lambda d, angle: d + np.cross(angle, d)
        u, f = [], []
        for p in places:
            q, angle = p + rng.normal(size=3) * position, rng.normal(size=3) * rotation
            u += [(1 + rng.normal() * gain) * row(q, turned(e, angle)) for e in np.eye(3)]
        for p, d in zip(hits, directions):
            q, angle = p + rng.normal(size=3) * position, rng.normal(size=3) * rotation
            f.append((1 + rng.normal() * gain) * row(q, turned(d, angle)))
        return np.array(u), np.array(f)

    def functions(self, frequencies, rows=None):
        """Functions of a, of b and of the assembly, each channels × impacts × lines."""
        rows = rows or [self.rows(0), self.rows(1)]
        (ua, fa), (ub, fb) = rows
        na = len(self.a.K)
        all_a, all_b, all_c = [], [], []
        R_u = np.zeros((len(ua) + len(ub), na + len(self.b.K)))
        R_f = np.zeros((len(fa) + len(fb), na + len(self.b.K)))
        R_u[: len(ua), self.at[0] : self.at[0] + 6], R_u[len(ua) :, na : na + 6] = ua, ub
        R_f[: len(fa), self.at[0] : self.at[0] + 6], R_f[len(fa) :, na : na + 6] = fa, fb
        S = np.zeros((6, na + len(self.b.K)))
        S[:, self.at[0] : self.at[0] + 6], S[:, na : na + 6] = np.eye(6), -np.eye(6)
        both = Frame([[0, 0, 0]], STEEL)
        for name in "KCM":
            a, b = getattr(self.a, name), getattr(self.b, name)
            setattr(both, name, np.block([[a, np.zeros((len(a), len(b)))], [np.zeros((len(b), len(a))), b]]))
        for f in frequencies:
            ya, yb = self.a.receptance(f), self.b.receptance(f)
            i = slice(self.at[0], self.at[0] + 6)
            all_a.append(ua @ ya[i, i] @ fa.T)
            all_b.append(ub @ yb[:6, :6] @ fb.T)
            all_c.append(R_u @ both.receptance(f, S.T @ self.K @ S, S.T @ self.C @ S) @ R_f.T)
        return [np.moveaxis(np.array(x), 0, 2) for x in (all_a, all_b, all_c)]

    def names(self, side):
        """DOFs of the channels and of the impacts."""
        places, hits, _ = self.sides[side]
        first = 100 * (side + 1)
        return (
            [f"{first + n}:+{axis}" for n in range(len(places)) for axis in AXES],
            [f"{first + 50 + n}:+X" for n in range(len(hits))],
        )

    def write(self, folder, frequencies, noise=0.0, rng=None, rows=None, model='model = "full"', more="", of_sides=(0.0, 0.0)):
        """The files of a test and its study; noise on the assembly in parts of each function's r.m.s., on the substructures in
        parts of each value."""
        functions = self.functions(frequencies, rows)
        for n, own in enumerate([*of_sides, noise]):
            if own:
                c = functions[n]
                size = np.abs(c) if n < 2 else np.sqrt(np.mean(np.abs(c) ** 2, axis=2, keepdims=True))
                functions[n] = c + own * size * (rng.normal(size=c.shape) + 1j * rng.normal(size=c.shape)) / np.sqrt(2)
        names = [self.names(0), self.names(1)]
        names.append(tuple(names[0][n] + names[1][n] for n in range(2)))
        for file, frf, (response, reference) in zip("abc", functions, names):
            np.savez(folder / f"{file}.npz", frequency=frequencies, frf=frf, response=response, reference=reference, quantity="receptance", unit="m/N",
                     axes="response,reference,frequency")
        text = 'method = "frf-space"\nname = "rig"\n' + more
        if noise:
            text += f"[noise]\nrelative = {noise}\n"
            text += "".join(f"{name} = {own}\n" for name, own in zip("ab", of_sides) if own)
        for side, name in enumerate("ab"):
            places, hits, directions = self.sides[side]
            text += f'[{name}]\nfrf = "{name}.npz"\n'
            for n, p in enumerate(places):
                text += f"[[{name}.sensors]]\nnode = {100 * (side + 1) + n}\nposition = {p.tolist()}\n"
            for dof, p, d in zip(names[side][1], hits, directions):
                text += f'[[{name}.impacts]]\ndof = "{dof}"\nposition = {p.tolist()}\ndirection = {d.tolist()}\n'
        text += f'[assembly]\nfrf = "c.npz"\n[joint]\n{model}\nlength = 0.03\n'
        (folder / "study.toml").write_text(text)
        return functions
