"""Layers that stand for joints: equations as printed, solved and fitted by SciPy, and sums over contacts by quadrature.

Writes data/layers.csv and data/layer_fits.csv:  python3 layer_references.py   (needs NumPy and SciPy)
"""

from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, least_squares

DATA = Path(__file__).parent / "data"
E1, E2, NU1, NU2, H, BETA_F = 2.1e11, 1.1e11, 0.3, 0.26, 1.96e9, 0.3
SURFACES = [(1.15, 1e-10), (1.42, 1.21e-8), (1.4999999, 1e-9), (1.5, 1e-9), (1.5000001, 1e-9), (1.6, 3e-9), (1.85, 2e-8)]
LOADS = [1.0001, 1.5, 30.0, 2e4]  # times the critical one


def pair(e1, nu1, e2, nu2):
    modulus = 1 / ((1 - nu1**2) / e1 + (1 - nu2**2) / e2)
    shear = 1 / (2 * (2 - nu1) * (1 + nu1) / e1 + 2 * (2 - nu2) * (1 + nu2) / e2)
    return modulus, shear


def critical_area(d, g, hardness, modulus):
    return g**2 / (0.5 * hardness / modulus) ** (2 / (d - 1))


def load(d, g, hardness, modulus, ac, al):
    """(13)"""
    if d == 1.5:
        elastic = np.sqrt(np.pi * g) * modulus * al**0.75 * np.log(al / ac)
    else:
        elastic = 4 * np.sqrt(np.pi) * d / (3 * (3 - 2 * d)) * modulus * g ** (d - 1) * al ** (d / 2) * (al ** (1.5 - d) - ac ** (1.5 - d))
    return elastic + d / (2 - d) * hardness * al ** (d / 2) * ac ** (1 - d / 2)


def largest(d, g, hardness, modulus, force):
    ac = critical_area(d, g, hardness, modulus)
    rest = lambda x: np.log(load(d, g, hardness, modulus, ac, ac * np.exp(x)) / force)
    return ac, ac * np.exp(brentq(rest, 0, 60, xtol=1e-14, rtol=1e-14))


def moduli(d, g, modulus, shear, ac, al, beta_f):
    """(1) and (12)"""
    young = 2 * d / (3 * np.pi**2) * modulus * g ** (1 - d) * al ** (d / 2) * (ac**-0.5 - al**-0.5)
    return young, 16 / np.pi * np.cbrt(1 - beta_f) * shear * ((al / ac) ** (d / 2) - 1)


def sums(d, g, hardness, modulus, shear, ac, al):
    """Load, real area, E and G_x of the contacts by quadrature over ln a."""
    number = lambda a: d / 2 * (al / a) ** (d / 2)  # for each d ln a
    force = lambda a: 4 * np.sqrt(np.pi) / 3 * modulus * g ** (d - 1) * a ** ((3 - d) / 2)
    # dσ/dε of a Hertzian contact with σ = f/(πRδ) and ε = δ/R, by a step along the imaginary axis
    radius = lambda a: a ** (d / 2) / (np.pi**2 * g ** (d - 1))
    depth = lambda a: g ** (d - 1) * a ** ((2 - d) / 2)

    def young(a):
        stress = lambda strain: 4 / 3 * modulus * np.sqrt(strain) / np.pi
        strain = depth(a) / radius(a)
        return stress(strain + 1e-30j).imag / 1e-30

    over = lambda f, low, high: quad(lambda t: f(np.exp(t)) * number(np.exp(t)), low, high, epsabs=0, epsrel=1e-12, limit=500)[0]
    lo, mid, hi = np.log(ac) - 28 / (1 - d / 2), np.log(ac), np.log(al)
    return [
        over(force, mid, hi) + over(lambda a: hardness * a, lo, mid),
        over(lambda a: a, lo, mid) + over(lambda a: a, mid, hi),
        over(young, mid, hi),
        16 / np.pi * np.cbrt(1 - BETA_F) * shear * over(lambda a: 1.0, mid, hi),
    ]


def layers():
    modulus, shear = pair(E1, NU1, E2, NU2)
    yield "dimension,roughness,critical_area,critical_real_area,load,real_area,young,shear,load_sum,area_sum,young_sum,shear_sum"
    for d, g in SURFACES:
        ac = critical_area(d, g, H, modulus)
        least = d / (2 - d) * H * ac
        for factor in LOADS:
            force = factor * least
            _, al = largest(d, g, H, modulus, force)
            real = d / (2 - d)
            values = [d, g, ac, real * ac, force, real * al, *moduli(d, g, modulus, shear, ac, al, BETA_F)]
            values += sums(d, g, H, modulus, shear, ac, al)
            yield ",".join(repr(float(value)) for value in values)


# Table I, and what it needs beside: grey cast iron, eleven M24 bolts with nut factor 0.2, no tangential load.
TORQUE = np.array([45.0, 90.0, 135.0])
YOUNG = 1e9 * np.array([0.352, 0.541, 0.885])
SHEAR = YOUNG / (2 * (1 + np.array([0.23, 0.25, 0.26])))
FORCE = 11 * TORQUE / (0.2 * 0.024)
IRON = (1.1e11, 0.26)


def residuals(unknowns, free):
    d, margin = unknowns
    modulus, shear = pair(*IRON, *IRON)
    g = np.sqrt(FORCE[0] / (d / (2 - d) * H * critical_area(d, 1.0, H, modulus))) * np.exp(-np.exp(margin))
    rest = []
    for force, young, known in zip(FORCE, YOUNG, SHEAR):
        ac, al = largest(d, g, H, modulus, force)
        e, s = moduli(d, g, modulus, shear, ac, al, 0.0)
        rest.append([np.log(e / young), np.log(s / known)])
    rest = np.array(rest)
    if free:
        rest -= rest.mean(axis=0)
    return rest.ravel(), g


def fits():
    yield "free,dimension,roughness,log_residual"
    for free in (0, 1):
        best = None
        for d in (1.06, 1.2, 1.4, 1.6, 1.8, 1.93):
            for margin in (-14.0, -10.0, -6.0, -3.0, 0.0, 1.5, 3.0):
                bounds = ([1.05, np.log(1e-7)], [1.95, np.log(25)])
                found = least_squares(
                    lambda u: residuals(u, free)[0], [d, margin], bounds=bounds, xtol=1e-14, ftol=1e-14, gtol=1e-14, x_scale=[0.1, 1.0]
                )
                if best is None or found.cost < best.cost:
                    best = found
        rest, g = residuals(best.x, free)
        yield ",".join(repr(float(value)) for value in [free, best.x[0], g, np.sqrt(np.mean(rest**2))])


(DATA / "layers.csv").write_text("\n".join(layers()) + "\n")
(DATA / "layer_fits.csv").write_text("\n".join(fits()) + "\n")
