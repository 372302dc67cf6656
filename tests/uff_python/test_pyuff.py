"""pyuff reads what is written here, and what pyuff writes is read here: every variant of data set 58, there and back.

    cargo build --example frf_to_uff
    pytest tests/uff_python --converter target/debug/examples/frf_to_uff
"""

import itertools
import subprocess
import sys
import types
import struct
from unittest import mock

import numpy as np
import pytest
import pyuff

EVEN = 5.0 + 2.5 * np.arange(401)
UNEVEN = np.geomspace(5.0, 1000.0, 401)
# response and reference as (node, direction); a point with rotations and both signs among them
PAIRS = [((11, 2), (2, 2)), ((12, -2), (2, 2)), ((11, 6), (2, -6)), ((4294967, 1), (3, 5))]


def receptance(frequency, pair):
    s = 2j * np.pi * frequency
    return (1 + pair) / (2.0 * s**2 + 8.0 * s + 8e4)


def pyuff_file(path, even, complex_values, single, binary, byte_order):
    """Receptances, by pyuff; where it always stores doubles in the machine's order, its packing is turned to the wanted form."""
    frequency = EVEN if even else UNEVEN
    sets = []
    for index, (response, reference) in enumerate(PAIRS):
        values = receptance(frequency, index)
        sets.append({
            "type": 58, "binary": int(binary), "func_type": 4, "rsp_node": response[0], "rsp_dir": response[1],
            "ref_node": reference[0], "ref_dir": reference[1], "data": values if complex_values else values.real, "x": frequency,
            "id1": "Prüfstand", "abscissa_spacing": int(even), "abscissa_spec_data_type": 18, "ordinate_spec_data_type": 8,
            "orddenom_spec_data_type": 13, "ord_data_type": (5 if single else 6) if complex_values else (2 if single else 4),
        })
    form = "f" if single else "d"
    packing = types.SimpleNamespace(pack=lambda f, x: struct.pack(f.replace("d", form), x), unpack=struct.unpack)
    with mock.patch.object(sys, "byteorder", byte_order), mock.patch("pyuff.datasets.dataset_58.struct", packing):
        pyuff.UFF(str(path)).write_sets(sets, mode="add", force_double=False)


VARIANTS = [
    (even, complex_values, single, binary, order)
    for even, complex_values, single, binary in itertools.product([True, False], repeat=4)
    for order in (["little", "big"] if binary else ["little"])
]


@pytest.mark.parametrize("out", ["ascii", "little", "big"])
@pytest.mark.parametrize("variant", VARIANTS, ids=lambda v: "-".join(
    [("uneven", "even")[v[0]], ("real", "complex")[v[1]], ("double", "single")[v[2]], ("ascii", v[4])[v[3]]]))
def test_there_and_back(converter, tmp_path, variant, out):
    even, complex_values, single, binary, byte_order = variant
    source, target = tmp_path / "pyuff.uff", tmp_path / "ours.uff"
    pyuff_file(source, even, complex_values, single, binary, byte_order)
    subprocess.run([converter, source, target, *([] if out == "ascii" else [out])], check=True)
    back = pyuff.UFF(str(target))
    assert list(back.get_set_types()) == [164] + 4 * [58]
    frequency = EVEN if even else UNEVEN
    found = {((s["rsp_node"], s["rsp_dir"]), (s["ref_node"], s["ref_dir"])): s for s in back.read_sets() if s["type"] == 58}
    assert set(found) == set(PAIRS)
    # single precision has 6 printed or 7.2 stored digits, pyuff prints 11 digits of a double and 5 of any frequency;
    # back again our own ASCII has 12 and more
    values_within = (6e-6 if not binary else 1.2e-7) if single else (1e-11 if not binary or out == "ascii" else 0.0)
    frequency_within = 0.0 if even else (6e-6 if not binary else 6e-8 if single else 1e-9 if out == "ascii" else 0.0)
    for index, pair in enumerate(PAIRS):
        one = found[pair]
        assert one["binary"] == int(out != "ascii")
        expected = receptance(frequency, index)
        expected = expected if complex_values else expected.real + 0j
        np.testing.assert_allclose(one["x"], frequency, rtol=frequency_within + 1e-15)
        np.testing.assert_allclose(one["data"].real, expected.real, rtol=values_within, atol=1e-22)
        np.testing.assert_allclose(one["data"].imag, expected.imag, rtol=values_within, atol=1e-22)
        assert (one["ordinate_axis_units_lab"], one["orddenom_axis_units_lab"]) in {("m", "N"), ("rad", "N.m"), ("m", "N.m")}
