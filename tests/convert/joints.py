"""Joints that the tests convert, and what their matrices must be."""

import numpy as np

DOFS = ["x", "y", "z", "rx", "ry", "rz"]


def joint(dofs, stiffness, damping, **more):
    """A joint file as a dict."""
    return {
        "format": "bolted-joint/1",
        "name": "made up",
        "joint": {"dofs": dofs, "stiffness": np.asarray(stiffness).tolist(), "damping": np.asarray(damping).tolist(), **more},
    }


def diagonal():
    """Six motions that know nothing of each other."""
    k = np.diag([1.1e7, 2.3e7, 3.1e7, 4.7e3, 5.3e3, 6.1e3])
    return joint(DOFS, k, 1.7e-5 * k)


def coupled():
    """Six motions, every pair coupled, positive definite."""
    random = np.random.default_rng(7)
    scale = np.diag([3e3, 5e3, 4e3, 60.0, 70.0, 80.0])
    root = np.eye(6) + 0.2 * random.standard_normal((6, 6))
    k = scale @ root @ root.T @ scale
    k = 0.5 * (k + k.T)
    root = np.eye(6) + 0.2 * random.standard_normal((6, 6))
    c = 1e-6 * scale @ root @ root.T @ scale
    return joint(DOFS, k, 0.5 * (c + c.T))


def planar():
    """A joint in a plane: along y and about z."""
    return joint(["y", "theta"], [[5.73e5, 5.82e3], [5.82e3, 1.29e3]], [[10.83, -0.83], [-0.83, 0.083]])


def in_six(file):
    """K and C of a joint over the six motions of a node."""
    places = [5 if name == "theta" else DOFS.index(name) for name in file["joint"]["dofs"]]
    matrices = []
    for key in ("stiffness", "damping"):
        matrix = np.zeros((6, 6))
        matrix[np.ix_(places, places)] = file["joint"][key]
        matrices.append(matrix)
    return matrices


def of_both(matrix):
    """[[M, −M], [−M, M]] over the motions of sides a and b."""
    return np.block([[matrix, -matrix], [-matrix, matrix]])
