"""Contacts of rough surfaces over a pressure field in NumPy and SciPy, as one would write it down: what the library is timed against.

python3 fractal_field.py POINTS   prints the shortest of five times and sums over the field as JSON.
"""

import json
import sys
import time

import numpy as np
from scipy.optimize import brentq, newton

D, G, E, NU, H, MU, TAU, A0 = 1.42, 1.21e-8, 1.5e11, 0.28, 1.96e9, 0.15, 2e7, 0.06
LOG = np.log(1.5)


def over(pressure):
    modulus = E / (2 * (1 - NU**2))
    shear = E / (4 * (1 + NU) * (2 - NU))
    psi = brentq(lambda s: s ** (1 - D / 2) - (1 + s ** (-D / 2)) ** (-(2 - D) / D) - (2 - D) / D, 1, 3, xtol=1e-15)
    weight = psi ** (1 - D / 2)
    ac = (2 ** (9 - 2 * D) * (modulus / H) ** 2 * LOG / (9 * np.pi ** (3 - D))) ** (1 / (D - 1)) * G**2
    elastic = 2 ** (4.5 - D) * D / (3 * (3 - 2 * D)) * np.pi ** ((D - 3) / 2) * modulus * np.sqrt(LOG) * G ** (D - 1) * weight
    plastic = D / (2 - D) * H * weight * ac ** (1 - D / 2)
    critical = D / (2 - D) * H * weight * ac / A0
    stiff = pressure > critical
    p = pressure[stiff]

    def rest(u):
        a = np.exp(u)
        return np.log(a ** (D / 2) * (elastic * (a ** (1.5 - D) - ac ** (1.5 - D)) + plastic)) - np.log(p * A0)

    def slope(u):
        a = np.exp(u)
        bracket = elastic * (a ** (1.5 - D) - ac ** (1.5 - D)) + plastic
        return D / 2 + elastic * (1.5 - D) * a ** (1.5 - D) / bracket

    a = np.exp(newton(rest, np.log(ac) + np.log(p / critical), slope, tol=1e-12))
    real = D / (4 - 2 * D) * weight * a ** (D / 2) * (a ** (1 - D / 2) + ac ** (1 - D / 2))
    q = TAU * real / (MU * p * A0)
    springs = D / (np.sqrt(2 * np.pi) * (1 - D)) * weight * a ** (D / 2) * (a ** ((1 - D) / 2) - ac ** ((1 - D) / 2)) / A0
    normal = 4 * modulus * (3 - D) / (3 * (2 - D)) * springs
    tangential = 8 * shear * (1 - q) ** (1 / 3) * springs
    spent = 2 ** (2 - D) * D / (2 - D) * H * G ** (D - 1) * np.sqrt(LOG) * np.pi ** (D / 2 - 1) * weight * a ** (D / 2) * ac ** (2 - D)
    stored = (
        8 / 15 * 2 ** (5.5 - 2 * D) * D / (5 - 3 * D) * np.pi ** (D - 2.5) * modulus * G ** (2 * D - 2) * LOG * weight
        * a ** (D / 2) * (a ** (2.5 - 1.5 * D) - ac ** (2.5 - 1.5 * D))
    )
    h1 = 1 - (1 - q) ** (5 / 3) - 5 * q / 6 * (1 + (1 - q) ** (2 / 3))
    h2 = 0.6 + 0.4 * (1 - q) ** (5 / 3) - (1 - q) ** (2 / 3)
    loss = 1 / (5 / 24 * h2 / h1 - 1)
    return [normal.sum(), tangential.sum(), (spent / stored * normal).sum(), (loss * tangential).sum()]


def main():
    pressure = 1e3 * 2e4 ** (np.arange(int(sys.argv[1])) * 0.6180339887498949 % 1)
    times = []
    for _ in range(5):
        begun = time.perf_counter()
        sums = over(pressure)
        times.append(time.perf_counter() - begun)
    print(json.dumps({"seconds": min(times), "sums": [float(value) for value in sums]}))


main()
