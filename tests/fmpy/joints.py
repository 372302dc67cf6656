"""Joint files that the tests export."""

import copy


def joint(dofs, stiffness, damping, cubic, bodies=None, name="test joint"):
    file = {
        "format": "bolted-joint/1",
        "name": name,
        "joint": {"dofs": dofs, "stiffness": stiffness, "damping": damping, "cubic": cubic},
    }
    if bodies:
        file["bodies"] = bodies
    return file


def body(inertia, stiffness, damping):
    return {"inertia": inertia, "stiffness": stiffness, "damping": damping}


# Pirdayr, Table 3, Ex.03; the two bodies are made to differ so that nothing hides behind the symmetry.
ONE_DOF_BODIES = {
    "a": body([2.35], [10.56e5], [1.39]),
    "b": body([1.90], [8.82e5], [1.24]),
}
LINEAR_1 = joint(["y"], [[4.56e6]], [[54.0]], [0.0], ONE_DOF_BODIES)
HARDENING_1 = joint(["y"], [[4.56e6]], [[54.0]], [3e12], ONE_DOF_BODIES)
SOFTENING_1 = joint(["y"], [[4.56e6]], [[54.0]], [-2e12], ONE_DOF_BODIES)

# Tol, Table 5.3 (updated), between two larger bodies on supports.
TWO_DOF_BODIES = {
    "a": body([0.5, 2e-4], [2e5, 50.0], [3.0, 0.004]),
    "b": body([0.3, 1e-4], [1e5, 80.0], [2.0, 0.002]),
}
TOL_K = [[5.73e5, 5.82e3], [5.82e3, 1.29e3]]
TOL_C = [[10.83, -0.83], [-0.83, 0.083]]
LINEAR_2 = joint(["y", "theta"], TOL_K, TOL_C, [0.0, 0.0], TWO_DOF_BODIES)
HARDENING_2 = joint(["y", "theta"], TOL_K, TOL_C, [5e11, 4e5], TWO_DOF_BODIES)
SOFTENING_2 = joint(["y", "theta"], TOL_K, TOL_C, [-2e10, -1e5], TWO_DOF_BODIES)

# A joint that softens first and stiffens further out, and whose damping grows; and one that does all at once.
HIGHER_1 = joint(["y"], [[4.56e6]], [[54.0]], [-2e12], ONE_DOF_BODIES)
HIGHER_1["joint"]["higher"] = {
    "quintic": [1e18],
    "septic": [2e23],
    "damping_quadratic": [5e7],
    "damping_quartic": [2e13],
    "amplitude": [1.2e-3],
}
HIGHER_2 = joint(["y", "theta"], TOL_K, TOL_C, [2e11, -1e5], TWO_DOF_BODIES)
HIGHER_2["joint"]["higher"] = {
    "quintic": [1e17, 5e8],
    "septic": [-2e22, 1e11],
    "damping_quadratic": [5e6, 20.0],
    "damping_quartic": [-1e12, 3e4],
    "amplitude": [2e-3, 0.05],
}

def over_preload(dofs, preload, nominal, stiffness, damping, cubic, bodies, name="test joint over the preload"):
    table = {"preload": preload, "nominal": nominal, "stiffness": stiffness, "damping": damping, "cubic": cubic}
    return {
        "format": "bolted-joint/1",
        "name": name,
        "joint": {"dofs": dofs, "over_preload": table},
        "bodies": bodies,
    }


# Pirdayr, Table 3, all torques; the cubic terms are made large enough to matter.
LOOSENING_1 = over_preload(
    ["y"], [2, 4, 6, 8], 8, [[[2.6e6]], [[3.0e6]], [[3.3e6]], [[3.6e6]]], [[[34.0]], [[38.0]], [[54.0]], [[69.0]]],
    [[4e12], [2e12], [2e12], [-1e12]], ONE_DOF_BODIES,
)
# The direction of K turns so much that the slopes of its entries have to be made smaller.
LOOSENING_2 = over_preload(
    ["y", "theta"], [10, 15, 20, 30], 25,
    [
        [[1e5, 1e3], [1e3, 9e2]],
        [[3.0e5, 1.6e4], [1.6e4, 9.2e2]],
        [[5.73e5, 1.8e4], [1.8e4, 1.29e3]],
        [[5.9e5, 1.9e4], [1.9e4, 1.6e3]],
    ],
    [[[15.0, -0.2], [-0.2, 0.1]], [[12.0, -0.6], [-0.6, 0.09]], [TOL_C[0], TOL_C[1]], [[9.0, -0.7], [-0.7, 0.08]]],
    [[5e11, 4e5], [1e11, 3e5], [0.0, 3e5], [0.0, 0.0]], TWO_DOF_BODIES,
)
LOOSENING = {"loosening-1": LOOSENING_1, "loosening-2": LOOSENING_2}

LAPS = {
    "linear-1": LINEAR_1,
    "hardening-1": HARDENING_1,
    "softening-1": SOFTENING_1,
    "linear-2": LINEAR_2,
    "hardening-2": HARDENING_2,
    "softening-2": SOFTENING_2,
    "higher-1": HIGHER_1,
    "higher-2": HIGHER_2,
}


def changed(file, **joint_entries):
    """A copy of a joint file with other entries of `joint`."""
    copied = copy.deepcopy(file)
    copied["joint"].update(joint_entries)
    return copied
