"""Places to a millimetre and gains to a per cent, as a careful laboratory knows them: the budget that studies have by default."""

import numpy as np
from frames import Rig
from test_as_a_whole import LINES, deviations, found, rows
from test_plan import bolt

CAREFUL = (1e-3, 1e-2, 1e-2)
K, C = bolt()
TRUTH = [own for matrix in (K, C) for own in (matrix[0, 0], matrix[2, 2], matrix[3, 3], matrix[5, 5], matrix[0, 4])]


def test_a_bolt_is_found_beside_errors_that_are_larger_than_what_it_says(run, tmp_path):
    """Searches for its ten numbers end in minima far above the noise, or with a motion that is as good as rigid."""
    rng = np.random.default_rng(5)
    rig = Rig(K, C, seed=3)
    none = np.zeros(3)
    errors = [rows(rig, side, rng, none, none, CAREFUL) for side in range(2)]
    rig.write(tmp_path, LINES, 0.01, rng, errors, 'model = "bolt"')
    told = found(run, tmp_path)
    assert told["reduced_chi_squared"] < 1.03
    assert np.abs(deviations(told, TRUTH)).max() < 4
