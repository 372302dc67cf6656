"""The one FMU of a whole assembly, beside one global matrix and SciPy."""

import numpy as np
import pytest
from beams import TwoBeams
from instances import both_versions
from scipy.linalg import eigh, expm
from test_respond import C, K, history, respond, write


@pytest.fixture(scope="module")
def beams():
    return TwoBeams((16, 18))


def exact(beams, loads, step):
    """Motion of the tip of the linear assembly under held loads, in the modes of the joined beams.

    In the nodes' own coordinates the exponential has eight digits only.
    """
    mass, damping, stiffness = beams.joined(K, C)
    squares, shapes = eigh(stiffness, mass)
    omega, tip = np.sqrt(squares), beams.tip @ shapes
    size = len(omega)
    whole = np.zeros((2 * size + 1, 2 * size + 1))
    # of ω q and q̇
    whole[:size, size : 2 * size] = np.diag(omega)
    whole[size : 2 * size, :size] = -np.diag(omega)
    whole[size : 2 * size, size : 2 * size] = -shapes.T @ damping @ shapes
    whole[size : 2 * size, 2 * size] = tip
    propagator = expm(whole * step)
    state, motion = np.zeros(2 * size), []
    for load in loads:
        state = (propagator @ np.concatenate([state, [load]]))[: 2 * size]
        motion.append([tip @ (state[:size] / omega), tip @ state[size:]])
    return np.array(motion)


@both_versions
@pytest.mark.parametrize("step", [1e-5, 1e-3])
def test_a_linear_assembly_is_right_at_any_step(slave, tmp_path, beams, step):
    count = 40
    loads = 30 * np.sin(2 * np.pi * 210.0 * step * np.arange(count))
    fmu = slave(write(tmp_path, beams, history(1, 0.1, 1), "modes = 500"))
    fmu.initialise()
    found = []
    for place, load in enumerate(loads):
        fmu.set({"push.F": load})
        fmu.step(place * step, step)
        found.append(fmu.get("tip.y", "tip.v", "energy.supplied", "energy.dissipated", "energy.stored"))
    found = np.array(found)
    expected = exact(beams, loads, step)
    for column, error in [(0, 1e-8), (1, 1e-7)]:
        assert np.abs(found[:, column] - expected[:, column]).max() < error * np.abs(expected[:, column]).max()
    supplied, dissipated, stored = found[:, 2:].T
    assert np.abs(supplied - stored - dissipated).max() < 1e-9 * stored.max()


@both_versions
@pytest.mark.parametrize("cubic", [0.0, 4e15])
def test_the_fmu_is_the_history_of_respond(run, slave, tmp_path, beams, cubic):
    path = write(tmp_path, beams, history(2e-3, 4e-5, 700.0).replace(", frequency = 700.0", ""), "modes = 10", cubic)
    _, _, rows = respond(run, path)
    fmu = slave(path)
    fmu.initialise(**{"push.F": 30.0})
    for place, row in enumerate(rows):
        if place > 0:
            fmu.step((place - 1) * 4e-5, 4e-5)
        found = fmu.get("tip.y", "tip.v", "energy.stored", "energy.supplied", "energy.dissipated")
        scale = np.abs(rows[:, 2:]).max(axis=0)
        assert (np.abs(found - row[2:]) <= 1e-12 * scale).all()


def written(fmu):
    api = fmu.fmu
    if fmu.is_fmi2:
        return api.serializeFMUstate(api.getFMUstate())
    return api.serializeFMUState(api.getFMUState())


def take(fmu, kept):
    api = fmu.fmu
    if fmu.is_fmi2:
        api.setFMUstate(api.deSerializeFMUstate(kept))
    else:
        api.setFMUState(api.deserializeFMUState(kept))


@both_versions
@pytest.mark.parametrize("step", [2e-5, 1 / 30000])
def test_states_that_are_read_leave_no_trace(slave, tmp_path, beams, step):
    """The library tells them where they are asked for, and goes on in its own coordinates; the joint is not linear."""
    path = write(tmp_path, beams, history(1, 0.1, 1), "modes = 30", 4e15)
    curious, silent, restored = slave(path), slave(path), slave(path)
    states = [v.name for v in curious.description.modelVariables if v.name.startswith("modal.")]
    assert len(states) > 100
    told = [*states, "energy.supplied", "energy.dissipated"]
    seen = ["tip.y", "tip.v", "energy.stored", *told]
    for fmu in (curious, silent):
        fmu.initialise(**{"push.F": 30.0})
    outputs = []
    for place in range(60):
        for fmu in (curious, silent):
            fmu.step(place * step, step)
        outputs.append(curious.get("tip.y", "tip.v"))
        curious.get(*told)
        assert silent.get("tip.y", "tip.v") == outputs[-1]
        if place == 30:
            # in bytes, to an instance that has never taken a step
            restored.initialise()
            kept = written(curious)
            assert written(silent) == kept
            take(restored, kept)
            assert restored.get(*seen) == curious.get(*seen)
        if place > 30:
            restored.step(place * step, step)
    found = curious.get(*seen)
    assert np.abs(found).max() > 0
    assert silent.get(*seen) == found and restored.get(*seen) == found
