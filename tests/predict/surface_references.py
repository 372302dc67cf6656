"""Writes data/welch.csv: power spectral densities of SciPy for the tests of surface.rs.

Run with SciPy installed: python surface_references.py
"""

from pathlib import Path

import numpy as np
from scipy.signal import welch

CASES = [
    ("hann", 256, 128, "constant"),
    ("hann", 255, 100, "linear"),
    ("blackman", 300, 0, False),
    ("hann", 1000, 500, "linear"),
]
STEP_M = 5e-7


def heights():
    """Waves, a slope and numbers without order, the same in any language."""
    i = np.arange(1000)
    return 1e-6 * (np.sin(0.37 * i) + 0.3 * np.cos(1.91 * i + 0.2) + 0.01 * i + (i * 7919 % 1013) / 1013)


def main():
    lines = ["# scipy.signal.welch, written by surface_references.py: case,frequency_per_m,density_m3"]
    for number, (window, segment, overlap, detrend) in enumerate(CASES):
        frequency, density = welch(
            heights(), fs=1 / STEP_M, window=window, nperseg=segment, noverlap=overlap, detrend=detrend
        )
        lines += [f"{number},{f!r},{s!r}" for f, s in zip(frequency.tolist(), density.tolist())]
    (Path(__file__).parent / "data" / "welch.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
