"""How long a communication step may be between structures that bend, beside SciPy."""

import json

import numpy as np
import pytest
import small
from beams import RATIO, TwoBeams
from scipy.linalg import block_diag, eigh, expm
from test_respond import C, K, history, write


def modal(mass, stiffness, free):
    squares, shapes = eigh(stiffness, mass)
    squares[:free] = 0
    return np.sqrt(squares), shapes


def radius(omega, damping, relative, stiffness, loss, step, late=False):
    """Spectral radius of one step of x, v in modes, under the load of the joint at its beginning, held."""
    size, dofs, scale = len(omega), len(relative), np.maximum(omega, 1.0)
    whole = np.zeros((2 * size + dofs, 2 * size + dofs))
    whole[:size, size : 2 * size] = np.diag(scale)
    whole[size : 2 * size, :size] = -np.diag(omega**2 / scale)
    whole[size : 2 * size, size : 2 * size] = -np.diag(damping)
    whole[size : 2 * size, 2 * size :] = -relative.T
    propagator = expm(whole * step)[: 2 * size]
    free, by_load = propagator[:, : 2 * size], propagator[:, 2 * size :]
    load = np.hstack([stiffness @ relative / scale, loss @ relative])
    if late:
        return np.abs(np.linalg.eigvals(np.block([[free, by_load], [load, np.zeros((dofs, dofs))]]))).max()
    return np.abs(np.linalg.eigvals(free + by_load @ load)).max()


def said(run, *arguments):
    return json.loads(run("check", *arguments, "--json").stdout)["communication_step"]


def test_the_bound_of_a_small_assembly_is_that_of_a_published_check_case(run, tmp_path):
    found = said(run, small.write(tmp_path, {}))
    assert found["held"] == pytest.approx(1.3173856697e-4, rel=2e-6)
    assert found["estimate"] < found["held"]


def beams_and_bound(elements, ratio_of_damping=1.0):
    beams = TwoBeams(elements)
    (a, shapes_a), (b, shapes_b) = modal(beams.a[0], beams.a[2], 0), modal(beams.b[0], beams.b[2], 2)
    omega = np.concatenate([a, b])
    relative = beams.relative @ block_diag(shapes_a, shapes_b)
    return beams, omega, ratio_of_damping * 2 * RATIO * omega, relative


@pytest.mark.parametrize("late", [False, True])
def test_beams_are_stable_below_the_bound_and_not_above(run, tmp_path, late):
    beams, omega, damping, relative = beams_and_bound((5, 6))
    found = said(run, write(tmp_path, beams, history(1, 0.1, 1), "modes = 500"))
    bound = found["late" if late else "held"]
    for step, is_stable in [(0.995 * bound, True), (1.005 * bound, False)]:
        assert (radius(omega, damping, relative, K, C, step, late) <= 1 + 1e-9) == is_stable
    # shorter than what the joint alone would tell, which is no bound between beams
    least = eigh(C, K, eigvals_only=True)[0]
    assert bound < 0.5 * 2 * least


def test_neighbours_of_a_joint_file_are_those_of_the_assembly(run, tmp_path):
    beams, *_ = beams_and_bound((5, 6))
    path = write(tmp_path, beams, history(1, 0.1, 1), "modes = 500")
    whole = said(run, path)
    sides = [f"a={tmp_path / 'a.npz'}@1:+Y,1:+RZ", f"b={tmp_path / 'b.npz'}@1:+Y,1:+RZ"]
    options = [word for side in sides for word in ("--neighbour", side)]
    for subject in (tmp_path / "m10.joint.json", fmu(run, tmp_path)):
        found = said(run, subject, *options)
        for key in ("held", "late", "end", "estimate"):
            assert found[key] == pytest.approx(whole[key], rel=1e-5), key
    # the points need not be named where there are no others
    assert said(run, tmp_path / "m10.joint.json", *options[:1], f"a={tmp_path / 'a.npz'}", *options[2:]) == found | {
        "suggested": None
    }


def fmu(run, folder):
    run("export", folder / "m10.joint.json", "-o", folder / "m10.fmu")
    return folder / "m10.fmu"


def test_a_side_without_a_structure_does_not_move(run, tmp_path):
    """A rigid mass against the ground: 2c/k or 2m/c, whichever is shorter."""
    for mass, stiffness, damping in [(0.5, 1e6, 10.0), (1e-3, 1e4, 10.0)]:
        np.savez(tmp_path / "m.npz", points=["1:+Y"], M=[[mass]], C=[[0.0]], K=[[0.0]])
        joint = {"dofs": ["y"], "stiffness": [[stiffness]], "damping": [[damping]]}
        path = tmp_path / "j.joint.json"
        path.write_text(json.dumps({"format": "bolted-joint/1", "name": "j", "joint": joint}))
        found = said(run, path, "--neighbour", f"b={tmp_path / 'm.npz'}@1:+Y")
        assert found["held"] == pytest.approx(min(2 * damping / stiffness, 2 * mass / damping), rel=1e-5)


@pytest.mark.parametrize(
    "option, message",
    [
        ("c=a.npz@1:+Y,1:+RZ", "expected a side, a file of modes or of matrices"),
        ("a=a.npz@1:+Y,9:+RZ", "found 9:+RZ, expected a point of the structure: 1:+Y, 1:+RZ"),
        ("a=a.npz@1:+Y", "found 1 points for y, theta at side a"),
        ("a=a.npz@1:+RZ,1:+Y", "found 1:+RZ for y at side a, expected a translation for a translation"),
        ("a=a.npz@1:+Y,1:+Y", "found 1:+Y for theta at side a, expected a translation for a translation"),
        ("a=none.npz@1:+Y,1:+RZ", "none.npz"),
    ],
)
def test_what_is_no_neighbour_is_refused(run, tmp_path, option, message):
    beams, *_ = beams_and_bound((2, 2))
    write(tmp_path, beams, history(1, 0.1, 1), "modes = 500")
    side, rest = option.split("=", 1)
    code = 2 if side == "c" else 1
    done = run("check", tmp_path / "m10.joint.json", "--neighbour", f"{side}={tmp_path / rest}", expect=code)
    assert message in done.stderr, done.stderr
