"""Writes the NumPy archives, MATLAB files and tables of this folder: `python generate.py`.

The functions are accelerances of one damped oscillator (m = 2 kg, c = 8 N s/m, k = 8e4 N/m) times the factor of their pair.
"""

import csv
import os
import struct

import numpy as np
import scipy.io
import scipy.sparse

HERE = os.path.dirname(os.path.abspath(__file__))
FREQUENCY = 5.0 + 2.5 * np.arange(7)
RESPONSE = np.array(["11:+Y", "12:-Y", "13:+RZ"])
REFERENCE = np.array(["2:+Y", "3:+Y"])
FACTOR = np.array([[1.0, 0.5], [-2.0, 3.0], [0.25, 7.0]])
GAMMA_SQUARED = 1.0 / (1.0 + 0.01 * np.arange(1, len(FREQUENCY) + 1))


def accelerance(frequency):
    s = 2j * np.pi * frequency
    return s**2 / (2.0 * s**2 + 8.0 * s + 8e4)


def path(name):
    return os.path.join(HERE, name)


def big_endian_mat(arrays):
    """A level 5 file whose numbers are big endian, which SciPy does not write: real, complex and character arrays."""

    def element(number, data):
        return struct.pack(">II", number, len(data)) + data + bytes(-len(data) % 8)

    def numbers(array):
        return element(9, array.astype(">f8").tobytes(order="F"))

    file = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack(">HH", 0x0100, 0x4D49)
    for name, array in arrays.items():
        if array.dtype.kind == "U":
            width = max(map(len, array))
            array, kind = np.array([list(text.ljust(width)) for text in array]), 4
            data = element(4, b"".join(struct.pack(">H", ord(c)) for c in array.ravel(order="F")))
        else:
            array = np.atleast_2d(array)
            kind, data = 6, numbers(array.real) + (numbers(array.imag) if array.dtype.kind == "c" else b"")
        flags = element(6, struct.pack(">II", kind | 0x0800 * (array.dtype.kind == "c"), 0))
        shape = element(5, struct.pack(f">{array.ndim}i", *array.shape))
        file += element(14, flags + shape + element(1, name.encode()) + data)
    return file


def mat_files(matrix, names):
    cells = {**names, "response": RESPONSE.astype(object), "reference": REFERENCE.astype(object)}
    scipy.io.savemat(path("cells.mat"), {"frf": matrix, **cells}, do_compression=True)
    scipy.io.savemat(path("single.mat"), {
        "freq": FREQUENCY, "H": np.moveaxis(matrix, 2, 0).astype("complex64"), "responses": RESPONSE, "references": REFERENCE,
        "quantity": "accelerance", "averages": 10,
        "coherence": np.broadcast_to(GAMMA_SQUARED[:, None, None], (7, 3, 2)).astype("float32"),
    })
    scipy.io.savemat(path("structure.mat"), {"frf": {"values": matrix}, **cells}, do_compression=True)
    scipy.io.savemat(path("beside.mat"), {
        "history": scipy.sparse.coo_matrix(([1.0], ([0], [0])), shape=(10**6, 10**6)), "setup": {"date": "today"}, "empty": [], "frf": matrix, **cells,
    }, do_compression=True)
    with open(path("big_endian.mat"), "wb") as file:
        file.write(big_endian_mat({
            "f": FREQUENCY, "accelerance": matrix[:2], "response": RESPONSE[:2], "reference": REFERENCE,
            "axes": np.array(["response,reference,frequency"]),
        }))


def main():
    matrix = FACTOR[:, :, None] * accelerance(FREQUENCY)
    names = {"frequency": FREQUENCY, "response": RESPONSE, "reference": REFERENCE, "quantity": "accelerance"}
    np.savez(path("stored.npz"), frf=matrix, **names)
    mat_files(matrix, names)
    np.savez_compressed(
        path("frequency_first.npz"), freq=FREQUENCY, H=np.moveaxis(matrix, 2, 0).astype("complex64"), responses=RESPONSE,
        references=REFERENCE, quantity=np.array(["accelerance"]), averages=10,
        coherence=np.broadcast_to(GAMMA_SQUARED[:, None, None], (7, 3, 2)).astype("float32"),
    )
    np.savez_compressed(
        path("fortran_big_endian.npz"), f=FREQUENCY.astype(">f8"), accelerance=np.asfortranarray(matrix[:2]).astype(">c16", order="F"),
        response=RESPONSE[:2].astype(">U6"), reference=REFERENCE.astype("S"), unit="(m/s^2)/N", axes="response,reference,frequency",
    )
    square = {**names, "response": REFERENCE}
    np.savez(path("square.npz"), frf=np.moveaxis(matrix[:2], 2, 0), **square)
    np.savez(path("square_with_axes.npz"), frf=np.moveaxis(matrix[:2], 2, 0), axes="frequency,reference,response", **square)
    np.savez(path("column.npz"), frf=matrix[:, 0], **{**names, "reference": "2:+Y"})
    np.savez(path("pickled.npz"), frf=matrix, **{**names, "response": RESPONSE.astype(object)})
    np.save(path("single.npy"), matrix)
    with open(path("table.csv"), "w", newline="") as file:
        file.write("# averages = 10\n")
        table = csv.writer(file)
        pairs = [(i, j) for i in range(3) for j in range(2)]
        unit = {0: "mm/s^2/N", 1: "mm/s^2/N", 2: "rad/s^2/N"}
        head = ["frequency [Hz]"]
        for i, j in pairs:
            pair = f"{RESPONSE[i]}/{REFERENCE[j]}"
            head += [f"{pair} magnitude [{unit[i]}]", f"{pair} phase [deg]"] if j else [f"{pair} {part} [{unit[i]}]" for part in ("real", "imaginary")]
        table.writerow(head + ["11:+Y/2:+Y coherence"])
        for line, frequency in enumerate(FREQUENCY):
            row = [frequency]
            for i, j in pairs:
                value = matrix[i, j, line] * (1e3 if i < 2 else 1.0)
                row += [abs(value), np.angle(value, deg=True)] if j else [value.real, value.imag]
            table.writerow([repr(float(number)) for number in row + [GAMMA_SQUARED[line]]])


if __name__ == "__main__":
    main()
