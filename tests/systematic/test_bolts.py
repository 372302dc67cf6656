"""Several bolts between beams that are exact (bolted.py), on the real program."""

import bolted
import numpy as np
import pytest


@pytest.mark.parametrize("seed", [0, 1, 3, 4, 6, 8, 12])
def test_two_bolts_that_may_differ_end_at_the_global_minimum(program, tmp_path, seed):
    is_there, words = bolted.draw(program, seed, folder=tmp_path)
    assert is_there, words


@pytest.mark.parametrize(("bolts", "kind"), [(5, "different"), (6, "alike"), (8, "alike")])
def test_more_than_four_bolts_have_joints(program, tmp_path, bolts, kind):
    """Points between all bolts: exact data determine every joint."""
    test = bolted.Rig(bolts, frequency=np.arange(20.0, 2000.0, 40.0))
    truth = bolted.drawn(np.random.default_rng(bolts), bolts, equal=kind == "alike")
    a, b = test.substructures()
    study = test.write(tmp_path, {"A": a, "B": b, "C": test.assembly(truth)}, bolted.ASSEMBLY_ALONE, bolts=kind)
    found, _, _ = bolted.identified(program, study, bolts)
    assert bolted.error(found, truth) < 1e-3
