"""Writes the universal files of this folder with pyuff 2.5.8: `python generate.py`.

Every function is the accelerance of one damped oscillator (m = 2 kg, c = 8 N s/m, k = 8e4 N/m) times a factor that tells
the pairs apart, so that a test can compute what must be read.
"""

import os
import struct
import sys
import types
from unittest import mock

import numpy as np
import pyuff

HERE = os.path.dirname(os.path.abspath(__file__))
EVEN = 5.0 + 2.5 * np.arange(13)
UNEVEN = np.array([5.0, 12.5, 20.0, 30.0, 31.5, 31.83, 32.0, 33.0, 50.0, 120.0])


def accelerance(frequency):
    s = 2j * np.pi * frequency
    return s**2 / (2.0 * s**2 + 8.0 * s + 8e4)


def function(frequency, values, even, response, reference, func_type=4, numerator=12, denominator=13):
    # pyuff names record 9 "ordinate" and record 10 "orddenom".
    return {
        "type": 58, "binary": 0, "func_type": func_type, "rsp_node": response[0], "rsp_dir": response[1],
        "ref_node": reference[0], "ref_dir": reference[1], "data": values, "x": frequency,
        "id1": "one oscillator", "abscissa_spacing": int(even), "abscissa_spec_data_type": 18,
        "ordinate_spec_data_type": numerator, "orddenom_spec_data_type": denominator,
        "ord_data_type": 5, "abscissa_min": frequency[0], "abscissa_inc": 2.5 if even else 0.0,
    }


def units(code, description, length, force):
    return {"type": 164, "units_code": code, "units_description": description, "temp_mode": 1, "length": length,
            "force": force, "temp": 1.0, "temp_offset": 0.0}


def write(name, sets, force_double=True):
    path = os.path.join(HERE, name)
    if os.path.exists(path):
        os.remove(path)
    pyuff.UFF(path).write_sets(sets, mode="add", force_double=force_double)


def binary(name, order, ord_data_types=(6, 4), width="d"):
    """Four binary data sets: complex even, complex uneven, real even, real uneven.

    pyuff stores doubles whatever the type says, in the order of the machine, and counts a complex value once. With
    `width` "f" its call that packs a number is made to store singles, as analysers do.
    """
    sets = []
    for ord_data_type, part in zip(ord_data_types, (lambda v: v, np.real)):
        for frequency, even in ((EVEN, True), (UNEVEN, False)):
            one = function(frequency, part(accelerance(frequency)), even, (11, 2), (2, 2))
            sets.append({**one, "binary": 1, "ord_data_type": ord_data_type})
    packing = types.SimpleNamespace(
        pack=lambda form, number: struct.pack(form.replace("d", width), number), unpack=struct.unpack
    )
    with mock.patch.object(sys, "byteorder", order), mock.patch("pyuff.datasets.dataset_58.struct", packing):
        write(name, sets, force_double=False)


def main():
    a = accelerance(EVEN)
    b = accelerance(UNEVEN)
    write("even_double.uff", [units(1, "SI", 1.0, 1.0), function(EVEN, a, True, (11, 2), (2, 2)),
                              function(EVEN, 0.5 * a, True, (12, -2), (2, 2))])
    write("uneven_double.uff", [units(1, "SI", 1.0, 1.0), function(UNEVEN, b, False, (11, 2), (2, 2))])
    write("uneven_single.uff", [function(UNEVEN, b, False, (11, 2), (2, 2))], force_double=False)
    # Millimetres and newtons; translation and rotation; a coherence among them.
    ones = np.ones(len(EVEN))
    write("millimetres.uff", [
        units(9, "mm, N", 1e3, 1.0),
        function(EVEN, 1e3 * a, True, (11, 2), (2, 2)),
        {**function(EVEN, ones, True, (11, 2), (2, 2), func_type=6, numerator=0, denominator=0), "ord_data_type": 2},
        function(EVEN, 2.0 * a, True, (11, 6), (2, 2)),
        function(EVEN, 3e-3 * a, True, (11, 6), (2, 6)),
    ], force_double=False)
    for order in ("little", "big"):
        binary(f"binary_double_{order}.uff", order)
        binary(f"binary_single_{order}.uff", order, ord_data_types=(5, 2), width="f")
    # Doubles under types of single precision, which is what pyuff writes with force_double=False.
    binary("binary_mislabelled.uff", "little", ord_data_types=(5, 2))
    # Coherence before its function, another one without, in one file of mixed forms.
    gamma_squared = 1.0 / (1.0 + 0.01 * np.arange(1, len(EVEN) + 1))
    coherence = function(EVEN, gamma_squared, True, (11, 2), (2, 2), func_type=6, numerator=0, denominator=0)
    write("coherence.uff", [
        {**coherence, "ord_data_type": 4},
        {**function(EVEN, a, True, (11, 2), (2, 2)), "binary": 1},
        function(EVEN, 0.5 * a, True, (12, -2), (2, 2)),
        {**function(EVEN, np.abs(a), True, (11, 2), (11, 2), func_type=2), "binary": 1, "ord_data_type": 4},
        units(1, "SI", 1.0, 1.0),
    ])


def modes():
    """A beam's first two bending shapes at three nodes, with rotations; real ones, and the same as complex ones with modal A."""
    common = {"type": 55, "node_nums": np.array([1, 2, 3]), "load_case": 0, "id1": "shapes"}
    zero = np.zeros(3)
    real, turned = [units(5, "mm, mN", 1e3, 1e3)], [units(1, "SI", 1.0, 1.0)]
    for number, (hz, zeta, y, rz) in enumerate([(12.5, 0.01, [1.0, -0.5, 1.0], [0.1, 0.0, -0.1]), (40.0, 0.005, [1.0, 0.0, -1.0], [0.2, -0.1, 0.2])], 1):
        y, rz, omega = np.array(y), np.array(rz), 2 * np.pi * hz
        real.append({
            **common, "analysis_type": 2, "data_ch": 3, "spec_data_type": 8, "data_type": 2, "n_data_per_node": 6, "mode_n": number,
            "r1": zero, "r2": y, "r3": zero, "r4": zero, "r5": zero, "r6": rz, "freq": hz, "modal_m": 2.0,
            "modal_damp_vis": zeta, "modal_damp_his": 0.0,
        })
        turned.append({
            **common, "analysis_type": 3, "data_ch": 2, "spec_data_type": 8, "data_type": 5, "n_data_per_node": 3, "mode_n": number,
            "r1": 0j * zero, "r2": 1j * y, "r3": 0j * zero, "eig": -zeta * omega + 1j * omega * np.sqrt(1 - zeta**2),
            "modal_a": -2j * omega, "modal_b": 1 + 0j,
        })
    write("modes.unv", real)
    write("complex_modes.unv", turned)


if __name__ == "__main__":
    main()
    modes()
