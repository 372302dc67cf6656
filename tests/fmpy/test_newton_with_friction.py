"""A master with Newton's method beside joints that remember: trial steps that are given up leave no trace in the FMU.

The same master goes on with the law written down a second time, whose derivatives are differences."""

import numpy as np
import pytest
from joints import LOOSENING_1
from loosening import Table
from sliders import LAWS
from test_friction_table import of_laws
from test_newton import STEP, Masses, coupled, implicit

STEPS = 100
PRELOAD = LOOSENING_1["joint"]["over_preload"]["nominal"]


class Pushed(Masses):
    """Under loads that make the joint slip."""

    def external(self, time):
        return 5.0 * super().external(time)


class Written:
    """The joint as the master sees an FMU: a law of friction beside springs and dampers of the table."""

    def __init__(self, law):
        self.law = law
        self.K, self.C, self.k3 = (np.ravel(values)[0] for values in Table(LOOSENING_1).at(PRELOAD))
        self.motion = np.zeros(4)

    def set(self, _, values):
        self.motion = np.array(values)

    def relative(self, motion):
        return motion[0] - motion[1], motion[2] - motion[3]

    def loads(self, motion):
        r, v = self.relative(motion)
        on_b = self.K * r + self.C * v + self.k3 * r**3 + self.law.load(r, PRELOAD)
        return np.array([-on_b, on_b])

    def get(self, _):
        return self.loads(self.motion)

    def derivative(self, _unknowns, _knowns, seed):
        part = 1e-10 / np.abs(seed).max()
        return (self.loads(self.motion + part * seed) - self.loads(self.motion - part * seed)) / (2 * part)

    def step(self, _time, _size):
        r, _ = self.relative(self.motion)
        self.law.commit(r, PRELOAD)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_it_is_the_motion_of_the_law_as_it_is_written(coupled, law):
    masses = Pushed(1)
    element = coupled(of_laws(law), "element")
    element.initialise()
    states, residuals = implicit(element, masses, STEP, STEPS)
    written = law()
    expected, _ = implicit(Written(written), masses, STEP, STEPS)
    assert np.abs(states - expected).max(axis=0) == pytest.approx(0, abs=1e-7 * np.abs(expected).max(axis=0).min())
    assert max(len(norms) for norms in residuals) <= 12
    # trials were given up, and what slipped was counted once
    assert sum(len(norms) > 2 for norms in residuals) > STEPS / 2
    (heat,) = element.get(["energy.dissipated"])
    assert written.heat > 1e-3 and heat > written.heat * (1 - 1e-6)
