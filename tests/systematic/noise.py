"""Noise as it is: floors of each function's own size, their Cramér-Rao bound, and coverage of the program's intervals.

`python tests/systematic/noise.py [DRAWS]` prints error over bound and coverage for several kinds of noise and of studies.
"""

import os
import pathlib
import sys
import tempfile

import numpy as np
import rig
from conftest import run

ROOT = pathlib.Path(__file__).resolve().parents[2]


def circular(generator, shape):
    parts = generator.standard_normal((2, *shape))
    return (parts[0] + 1j * parts[1]) / np.sqrt(2)


def deviations(exact, relative, floor):
    """Standard deviation of each value; `floor` is the part of each function's own median that noise has everywhere."""
    median = {name: np.median(abs(z), axis=0) for name, z in exact.items()}
    return {name: np.sqrt((relative * abs(z)) ** 2 + (floor * median[name]) ** 2) for name, z in exact.items()}


def drawn(exact, deviation, seed):
    generator = np.random.default_rng(seed)
    return {name: z + deviation[name] * circular(generator, z.shape) for name, z in exact.items()}


def assembled(a, b, omega, unknowns):
    """The assembly at the points (rows and columns 2 and up of B), by Tol 3.17."""
    k, c = unknowns[:3], unknowns[3:]
    entries = k + 1j * omega[:, None] * c
    stiffness = np.stack([entries[:, [0, 1]], entries[:, [1, 2]]], axis=1)
    loop = a + b[:, :2, :2] + np.linalg.inv(stiffness)
    return b[:, 2:, 2:] - b[:, 2:, :2] @ np.linalg.solve(loop, b[:, :2, 2:])


def bound(exact, deviation, frequency=rig.FREQUENCY):
    """Cramér-Rao bound of the standard deviations: the structures' true receptances are unknowns beside the joint."""
    omega = 2 * np.pi * np.asarray(frequency)
    a, b = exact["A"], exact["B"]
    upper = np.triu_indices(3)

    def outputs(a, b, unknowns):
        whole = assembled(a, b, omega, unknowns)
        return whole[:, upper[0], upper[1]]

    def merged(name):
        """Variance of the mean of the two directions of an entry."""
        variance = deviation[name] ** 2
        mean = (variance + variance.transpose(0, 2, 1)) / 4
        for i in range(mean.shape[1]):
            mean[:, i, i] = variance[:, i, i]
        return mean

    centre = outputs(a, b, rig.TRUTH)
    by_unknown = []
    for i, value in enumerate(rig.TRUTH):
        step = np.zeros(6)
        step[i] = 1e-5 * value
        by_unknown.append((outputs(a, b, rig.TRUTH + step) - outputs(a, b, rig.TRUTH - step)) / (2 * step[i]))
    by_unknown = np.stack(by_unknown, -1)
    of_c = merged("C")[:, upper[0], upper[1]]
    covariance = np.zeros((len(omega), 6, 6), complex)
    covariance[:, range(6), range(6)] = of_c
    for name, z in (("A", a), ("B", b)):
        variance = merged(name)
        for p in range(z.shape[1]):
            for q in range(p, z.shape[1]):
                moved = z.copy()
                step = 1e-6 * np.median(abs(z[:, p, q]))
                moved[:, p, q] += step
                if p != q:
                    moved[:, q, p] += step
                pair = {"A": a, "B": b, name: moved}
                column = (outputs(pair["A"], pair["B"], rig.TRUTH) - centre) / step
                covariance += variance[:, p, q, None, None] * column[:, :, None] * column[:, None, :].conj()
    information = 2 * np.real(np.einsum("nei,nef,nfj->ij", by_unknown.conj(), np.linalg.inv(covariance), by_unknown))
    scale = 1 / np.sqrt(np.diag(information))
    return np.sqrt(np.diag(np.linalg.inv(information * np.outer(scale, scale)))) * scale


def study_with(folder, sets, noise_table, computed_b=False):
    """A study of these sets without error budget, with this text in place of the table of noise."""
    study = rig.write(folder, sets, 0.01, budget='"none"', computed_b=computed_b)
    text = study.read_text(encoding="utf-8")
    study.write_text(text[: text.index("[noise]")] + noise_table, encoding="utf-8")
    return study


def main(draws, only):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    exact = rig.test_data(rig.Mistakes(), 0.0, 0)
    cases = {
        "floor 1 %, nothing stated": (0.0, 0.01, ""),
        "floor 1 %, relative = 0 stated": (0.0, 0.01, "[noise]\nrelative = 0\n"),
        "1 % and floor 1 %, nothing stated": (0.01, 0.01, ""),
        "1 %, nothing stated": (0.01, 0.0, ""),
        "floor 0.1 %, nothing stated": (0.0, 0.001, ""),
    }
    for name, (relative, floor, table) in cases.items():
        if only and only not in name:
            continue
        deviation = deviations(exact, relative, floor)
        least = bound(exact, deviation)
        errors, z, unusable, warnings = [], [], 0, 0
        for draw in range(draws):
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                found = run(program, study_with(folder, drawn(exact, deviation, draw), table))
            errors.append((found.values - rig.TRUTH) / least)
            z.append(found.z)
            unusable += not found.whole["usable"]
            warnings += bool(found.whole["warnings"])
        errors, z = np.array(errors), np.array(z)
        print(f"{name}: {draws} draws, {unusable} not to be relied on, {warnings} with warnings; bound {least}")
        print(f"   error over bound {np.sqrt(np.mean(errors**2, 0)).round(2)}   coverage {np.mean(abs(z) < 1.96, 0).round(2)} "
              f"all {np.mean(abs(z) < 1.96):.3f}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40, sys.argv[2] if len(sys.argv) > 2 else "")
