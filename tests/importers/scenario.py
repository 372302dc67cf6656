"""One simulation that every importer repeats, and what must come out of it."""

import numpy as np
from joints import LAPS
from reference import Lap

CASE = "hardening-2"
STEP_S = 1e-4
STEPS = 200
FREQUENCY_HZ = 130.0
# Largest difference to DOP853, against the largest value of each state: that of RK4 with the exported step.
TOLERANCE = 1e-6

FILE = LAPS[CASE]
LAP = Lap(FILE)
STATES = ["a.y", "a.theta", "b.y", "b.theta", "a.v", "a.omega", "b.v", "b.omega"]
LOADS = ["a.F", "a.M", "b.F", "b.M"]
START = dict(zip(STATES, [2e-5, 1e-4, -1e-5, 3e-4, 0.02, 0.3, 0.01, -0.2]))
# A parameter that differs from the joint file, so that a run which loses it is found out.
MASS_KG = 0.6


def loads():
    """Loads of each step, held over it: N, N.m."""
    middle = (np.arange(STEPS) + 0.5) * STEP_S
    return np.outer(np.sin(2 * np.pi * FREQUENCY_HZ * middle), [0.0, 0.0, 1000.0, 3.0])


def expected():
    """States at the communication points, by DOP853 from the equations in docs/theory.md."""
    lap = Lap(FILE)
    lap.m = lap.m.copy()
    lap.m[0] = MASS_KG
    return lap.held(np.array(list(START.values())), loads(), STEP_S)


def assert_follows_the_reference(found):
    found, reference = np.array(found), expected()
    assert found.shape == reference.shape
    error = np.abs(found - reference).max(axis=0) / np.abs(reference).max(axis=0)
    assert error.max() < TOLERANCE, error
    # the mass matters: the run with that of the joint file is far away
    other = LAP.held(np.array(list(START.values())), loads(), STEP_S)
    assert np.abs(other - reference).max() > 1e-2 * np.abs(reference).max()
