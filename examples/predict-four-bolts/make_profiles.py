"""Makes the profiles of this example: Gaussian heights with the spectrum of a fractal surface (needs NumPy).

They stand for measured ones, which are tables of the same form. Each surface has three, of D and G as in SURFACES.
"""

import pathlib

import numpy as np

POINTS, STEP_M = 4096, 1e-6
GAMMA = 1.5
SURFACES = {"a": (1.42, 8e-9), "b": (1.45, 1.2e-8)}
TRACES = 3


def profile(dimension, roughness_m, generator):
    """Heights (m) whose one-sided spectral density is G^(2(D−1)) f^(2D−5)/(2 ln γ), f in cycles per metre.

    Made eight times as long and cut, so that it is not periodic and has longer waves than it is long.
    """
    points = 8 * POINTS
    frequency = np.fft.rfftfreq(points, STEP_M)[1:]
    density = roughness_m ** (2 * (dimension - 1)) * frequency ** (2 * dimension - 5) / (2 * np.log(GAMMA))
    # variance of a line's real and imaginary part: S df/4 of the two-sided amplitude, times the length of the transform
    deviation = 0.5 * points * np.sqrt(density * frequency[0])
    lines = deviation * (generator.standard_normal(len(density)) + 1j * generator.standard_normal(len(density)))
    return np.fft.irfft(np.concatenate([[0], lines]), points)[3 * POINTS : 4 * POINTS]


def main():
    generator = np.random.default_rng(20)
    folder = pathlib.Path(__file__).parent
    for surface, (dimension, roughness_m) in SURFACES.items():
        for trace in range(1, TRACES + 1):
            height = profile(dimension, roughness_m, generator)
            height -= height.mean()
            rows = [f"{1e6 * STEP_M * k:.0f},{1e6 * z:.4f}" for k, z in enumerate(height)]
            text = f"# synthetic, not measured: D = {dimension}, G = {roughness_m} m\ndistance_um,height_um\n" + "\n".join(rows) + "\n"
            (folder / f"{surface}-{trace}.csv").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
