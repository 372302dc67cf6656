"""The example's master for stiff loops, where masters that hold the load over a step need steps of 1e-8 s."""

import sys
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from scipy.linalg import block_diag, eigh, expm

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests/assembly"), str(ROOT / "examples/stiff-master")]
from beams import RATIO, TwoBeams  # noqa: E402
from stiff_master import NotConverged, simulate  # noqa: E402
from test_respond import C, K, history, write  # noqa: E402

LOAD_N = 20.0
STOP_S = 5e-3
CUBIC = 4e15


@pytest.fixture(scope="module")
def beams():
    """All modes of a coarse mesh, so that no residual vectors stand for any."""
    return TwoBeams((8, 9))


@pytest.fixture(scope="module", params=[0.0, CUBIC], ids=["linear", "hardening"])
def exported(request, tmp_path_factory, run, beams):
    """The SSP, and the motion of the one FMU under a held load."""
    folder = tmp_path_factory.mktemp("beams")
    path = write(folder, beams, history(1, 0.1, 1), "modes = 500", request.param)
    for name in ("whole.fmu", "parts.ssp", "parts3.ssp"):
        run("export", path, "-o", folder / name, "--fmi", "3" if "3" in name else "2")
    whole = fmpy.simulate_fmu(
        str(folder / "whole.fmu"), stop_time=STOP_S, output_interval=1e-5, start_values={"push.F": LOAD_N},
        fmi_type="CoSimulation",
    )
    return folder / "parts.ssp", whole, request.param


def held(time):
    return LOAD_N


def error(motion, whole):
    expected = np.interp(motion["time"], whole["time"], whole["tip.y"])
    return np.abs(motion["tip.y"] - expected).max() / np.abs(expected).max()


def test_it_is_the_one_fmu_and_of_second_order(exported):
    ssp, whole, cubic = exported
    found = {}
    for step in [4e-5, 2e-5, 1e-5]:
        motion, iterations = simulate(ssp, STOP_S, step, {"push.F": held})
        found[step] = error(motion, whole)
        # one of a linear joint, up to the tolerance of Newton's method; a few of a hardening one
        assert max(iterations) <= (2 if cubic == 0 else 5)
    assert found[1e-5] < 1e-4
    assert found[4e-5] / found[1e-5] > 8, found


def test_it_is_stable_at_steps_a_hundred_thousand_times_those_of_explicit_masters(exported):
    ssp, whole, _ = exported
    static = np.abs(whole["tip.y"]).max()
    for step in [1e-3, 1e-4]:
        motion, _ = simulate(ssp, 500 * step, step, {"push.F": held})
        # the load does no more work than it does on the way to its largest deflection
        assert np.abs(motion["tip.y"]).max() < 20 * static
    # FMPy's own master, with a step a thousand times shorter
    with np.errstate(all="ignore"):
        blown = np.inf
        try:
            rows = simulate_ssp(str(ssp), stop_time=2e-4, step_size=1e-6, input={"push.F": held})
            blown = np.abs(rows["tip.y"]).max()
        except Exception as refused:  # the FMUs refuse numbers that are no longer finite
            assert "finite" in str(refused) or "fmi2" in str(refused)
    assert not blown < 1e3 * static


def test_fmus_of_fmi_3_give_the_same(exported):
    ssp, _, _ = exported
    one, _ = simulate(ssp, 1e-3, 1e-4, {"push.F": held})
    other, _ = simulate(ssp.parent / "parts3.ssp", 1e-3, 1e-4, {"push.F": held})
    assert np.abs(one["tip.y"] - other["tip.y"]).max() < 1e-9 * np.abs(one["tip.y"]).max()


def growth(beams, step_s, force):
    """Spectral radius of one step of the linear assembly, from the exact propagators of the two beams alone."""
    parts = []
    for mass, _, stiffness in (beams.a, beams.b):
        squares, shapes = eigh(stiffness, mass)
        squares[squares < 1e-6 * squares[-1] * 1e-6] = 0
        parts.append((np.sqrt(squares), shapes))
    parts[1][0][:2] = 0
    omega = np.concatenate([own for own, _ in parts])
    relative = beams.relative @ block_diag(*(own for _, own in parts))
    size, scale = len(omega), np.maximum(omega, 1.0)
    whole = np.zeros((2 * size + 2, 2 * size + 2))
    whole[:size, size : 2 * size] = np.diag(scale)
    whole[size : 2 * size, :size] = -np.diag(omega**2 / scale)
    whole[size : 2 * size, size : 2 * size] = -np.diag(2 * RATIO * omega)
    whole[size : 2 * size, 2 * size :] = -relative.T
    propagator = expm(whole * step_s)
    free, by_load = propagator[: 2 * size, : 2 * size], propagator[: 2 * size, 2 * size :]
    r = np.hstack([relative / scale, np.zeros_like(relative)])
    v = np.hstack([np.zeros_like(relative), relative])
    if force == "mean":
        after, before = K @ r / 2 + C @ r / step_s, K @ r / 2 - C @ r / step_s
    else:
        after, before = K @ r + C @ v, np.zeros_like(r)
    step = np.linalg.solve(np.eye(2 * size) - by_load @ after, free + by_load @ before)
    return np.abs(np.linalg.eigvals(step)).max()


def test_the_mean_force_is_stable_at_any_step_and_the_end_force_is_not(beams):
    steps = np.geomspace(1e-7, 1e-1, 61)
    assert max(growth(beams, step, "mean") for step in steps) < 1 + 1e-9
    assert max(growth(beams, step, "end") for step in steps) > 1.01


def test_the_end_force_grows_where_its_bound_says(exported, beams):
    ssp, _, cubic = exported
    if cubic != 0:
        pytest.skip("the bound is that of a linear joint")
    steps = np.geomspace(1e-6, 1e-3, 31)
    radii = np.array([growth(beams, step, "end") for step in steps])
    unstable, stable = steps[radii.argmax()], steps[np.flatnonzero(radii < 1)[-1]]
    assert radii.max() > 1.01
    # under a pulse, then free
    def pulse(time):
        return LOAD_N if time < 5 * unstable else 0.0

    count = int(np.log(1e6) / np.log(radii.max())) + 10
    try:
        motion, _ = simulate(ssp, count * unstable, unstable, {"push.F": pulse}, force="end")
        assert np.abs(motion["tip.y"][-1]) > 1e2 * np.abs(motion["tip.y"][:10]).max()
    except NotConverged as stopped:
        assert "take a shorter step" in str(stopped)
    motion, _ = simulate(ssp, 200 * stable, stable, {"push.F": held}, force="end")
    assert np.isfinite(motion["tip.y"]).all()


def test_loads_that_it_does_not_have_are_refused(exported):
    with pytest.raises(ValueError, match="found pull.F, expected some of push.F"):
        simulate(exported[0], 1e-3, 1e-4, {"pull.F": held})
