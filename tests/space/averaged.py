"""Functions as an analyser estimates them: H1 of spectra with a random input, averaged, and the coherence of the same averages. Of
numpy alone, nothing of the program under test."""

import numpy as np


def complex_normal(rng, shape):
    """E|x|² = 1."""
    return (rng.normal(size=shape) + 1j * rng.normal(size=shape)) / np.sqrt(2)


def measured(H, noise, averages, rng):
    """H1 and γ² of channels × impacts × lines: y = H x + n with x of spectral density 1, the same for all channels of an impact, and
    `noise` the r.m.s. of n at each line, of the shape of H or of one that broadcasts to it."""
    xx = np.zeros((1, *H.shape[1:]))
    yx, yy = np.zeros(H.shape, complex), np.zeros(H.shape)
    for _ in range(averages):
        x = complex_normal(rng, xx.shape)
        y = H * x + noise * complex_normal(rng, H.shape)
        xx += np.abs(x) ** 2
        yx += y * x.conj()
        yy += np.abs(y) ** 2
    return yx / xx, np.abs(yx) ** 2 / (xx * yy)


def measure(path, noise, averages, rng):
    """A file of exact functions as they would be measured; `noise` of the values."""
    everything = dict(np.load(path))
    H = everything["frf"]
    everything["frf"], gamma_squared = measured(H, noise(H), averages, rng)
    np.savez(path, **everything, coherence=gamma_squared, averages=averages)


def white(part):
    """Noise of the same density at all lines, in parts of the r.m.s. of each function."""
    return lambda H: part * np.sqrt(np.mean(np.abs(H) ** 2, axis=2, keepdims=True))


def coloured(part):
    """The same with a density that is twenty times as large (r.m.s.) at some lines as at others."""

    def noise(H):
        along = np.linspace(0, 1, H.shape[2])
        return white(part)(H) * np.exp(1.5 * np.sin(2 * np.pi * along))

    return noise


def of_values(part):
    """Noise in parts of each value."""
    return lambda H: part * np.abs(H)
