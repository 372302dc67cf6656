"""Laws beside each other for the resonances of the Brake–Reuß beam in docs/theory.md, apart from this program.

    python3 contact_that_closes.py FOLDER

FOLDER has the CSV files of examples/brake-reuss. Frequencies at a phase of −90° are fitted over the amplitude there, with all
runs, and with each left out.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

RUNS = [
    "response-control-1",
    "force-control-1",
    "response-control-2",
    "force-control-2",
    "response-control-4",
    "response-control-5",
    "force-control-4",
    "response-control-7",
    "response-control-8",
]


def resonance(path):
    """Amplitude in units of 100 µm, and Hz."""
    run = np.genfromtxt(path, delimiter=",", names=True)
    hz = run["frequency_hz"]
    amplitude = run["acceleration_m_per_s2"] / (2 * np.pi * hz) ** 2 / 1e-4
    lag = np.unwrap(run["phase_rad"]) + np.pi / 2
    at = np.nonzero((lag[:-1] > 0) & (lag[1:] <= 0))[0][0]
    share = lag[at] / (lag[at] - lag[at + 1])
    return [np.interp(at + share, np.arange(len(hz)), of) for of in (amplitude, hz)]


def closing(a, gap):
    """Share of a spring's stiffness beyond a gap on both sides, at the fundamental."""
    u = np.minimum(gap / a, 1)
    return 1 - 2 / np.pi * (np.arcsin(u) + u * np.sqrt(1 - u**2))


# f of the amplitude a, and starts; slip softens by a power of a between 0 and 1 or so
LAWS = {
    "k3, k5, k7": (lambda p, a: p[0] + p[1] * a**2 + p[2] * a**4 + p[3] * a**6, [[80.4, -0.1, 0.02, 0]]),
    "slip, k3": (lambda p, a: p[0] - p[1] * a ** np.exp(p[2]) + p[3] * a**2, [[80.5, 0.3, -0.3, 0.05]]),
    "k3, a contact that closes": (
        lambda p, a: p[0] - p[1] * a**2 + p[2] * closing(a, p[3]),
        [[80.4, 0.1, 2, gap] for gap in (1.2, 1.4, 1.6)],
    ),
    "slip, a contact that closes": (
        lambda p, a: p[0] - p[1] * a ** np.exp(p[2]) + p[3] * closing(a, p[4]),
        [[80.5, 0.3, -0.3, 1, gap] for gap in (1.2, 1.4, 1.6)],
    ),
}


def fitted(law, starts, amplitude, hz):
    fits = [least_squares(lambda p: law(p, amplitude) - hz, start, max_nfev=4000) for start in starts]
    return min(fits, key=lambda fit: fit.cost)


def main(folder):
    amplitude, hz = np.array([resonance(folder / f"{run}.csv") for run in RUNS]).T
    count = len(hz)
    for name, (law, starts) in LAWS.items():
        fit = fitted(law, starts, amplitude, hz)
        bic = count * np.log(2 * fit.cost / count) + len(fit.x) * np.log(count)
        missed = []
        for run in range(count):
            others = np.arange(count) != run
            left = fitted(law, starts, amplitude[others], hz[others])
            missed.append(law(left.x, amplitude[run : run + 1])[0] - hz[run])
        rms = 1e3 * np.sqrt(2 * fit.cost / count)
        print(f"{name}: {rms:.0f} mHz r.m.s., BIC {bic:.1f}, {np.round(fit.x, 3)}; left out {np.round(missed, 3)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
