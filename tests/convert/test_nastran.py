"""Nastran decks, read by pyNastran."""

import joints
import numpy as np
import pytest

# pyNastran 1.4.1 asks for a name that NumPy 2.4 has no more
if not hasattr(np, "in1d"):
    np.in1d = np.isin
bdf = pytest.importorskip("pyNastran.bdf.bdf", reason="pyNastran is not installed")


def read(path):
    grids = "GRID,11,,0.,0.,0.\nGRID,12,,0.,0.,0.\n"
    deck = path.with_suffix(".bdf")
    deck.write_text(grids + path.read_text(encoding="ascii"), encoding="ascii")
    model = bdf.BDF(debug=None)
    model.read_bdf(str(deck), punch=True)
    return model


def test_an_uncoupled_joint_is_a_bush(convert):
    file = joints.diagonal()
    model = read(convert(file, "nastran", "bush.nas", "--nodes", "11,12", "--first-number", "500"))
    [element], [bush] = model.elements.values(), model.properties.values()
    assert (element.type, list(element.node_ids), element.Pid(), element.Cid()) == ("CBUSH", [11, 12], 500, 0)
    k, c = joints.in_six(file)
    np.testing.assert_allclose(bush.Ki, np.diag(k), rtol=1e-9)
    np.testing.assert_allclose(bush.Bi, np.diag(c), rtol=1e-9)
    assert not model.dmig


def test_numbers_for_a_model_in_millimetres(convert):
    """N/mm and N·mm/rad; what couples both is N/rad in any of them."""
    file = joints.diagonal()
    path = convert(file, "nastran", "bush.nas", "--nodes", "11,12", "--units", "mm")
    [bush] = read(path).properties.values()
    factors = [1e-3] * 3 + [1e3] * 3
    for found, expected in zip((bush.Ki, bush.Bi), joints.in_six(file)):
        np.testing.assert_allclose(found, np.diag(expected) * factors, rtol=1e-9)
    assert "Units: N, mm, rad, s, t;" in path.read_text(encoding="ascii")


@pytest.mark.parametrize("file", [joints.planar(), joints.coupled()], ids=["planar", "in space"])
def test_a_coupled_joint_is_two_matrices(convert, file):
    model = read(convert(file, "nastran", "dmig.nas", "--nodes", "11,12", "--first-number", "500"))
    assert not model.elements
    for name, expected in zip(("KBJ500", "CBJ500"), map(joints.of_both, joints.in_six(file))):
        matrix, rows, columns = model.dmig[name].get_matrix(is_sparse=False, apply_symmetry=True)
        found = np.zeros((12, 12))
        place = lambda key: {11: 0, 12: 6}[key[0]] + key[1] - 1
        for i, row in rows.items():
            for j, column in columns.items():
                found[place(row), place(column)] = matrix[i, j]
        np.testing.assert_allclose(found, expected, rtol=1e-9, err_msg=name)
