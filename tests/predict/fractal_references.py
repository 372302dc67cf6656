"""Contact of rough surfaces by the printed formulas, with their branches, in 60 decimal digits.

Writes data/fractal.csv:  python3 fractal_references.py > data/fractal.csv   (needs mpmath)
"""

from mpmath import cbrt, findroot, log, mp, mpf, pi, sqrt

mp.dps = 60
GAMMA = mpf("1.5")

SURFACES = [
    # D, G
    ("1.2", "1e-9"),
    ("1.42", "1.21e-8"),
    ("1.42", "1e-9"),
    ("1.499999999", "1e-9"),
    ("1.5", "1e-9"),
    ("1.500000001", "1e-9"),
    ("1.6", "2e-9"),
    ("1.666666665666666600", "2e-9"),
    ("1.666666666666666740681534975010", "2e-9"),  # 5/3 as a double
    ("1.666666667666666600", "2e-9"),
    ("1.9", "1e-8"),
]
E1, E2, NU1, NU2, H, MU, TAU, A0 = "1.5e11", "7e10", "0.28", "0.33", "1.2e9", "0.2", "4e6", "0.02"
PRESSURES = ["1e2", "1e4", "3e5", "2e6", "2.1e7", "4.3e7"]
NAMES = (
    "dimension,roughness,pressure,psi,critical_area,largest_area,real_area_fraction,normal,tangential,"
    "elastic_energy,plastic_energy,normal_loss,tangential_loss,tangential_loss_pi,friction_ratio"
)


def number(text):
    """The double nearest to a decimal number, exactly."""
    return mpf(float(text))


def contact(d, g, p):
    e1, e2, nu1, nu2, hardness, mu, tau, area = map(number, (E1, E2, NU1, NU2, H, MU, TAU, A0))
    modulus = 1 / ((1 - nu1**2) / e1 + (1 - nu2**2) / e2)
    shear = 1 / (2 * (2 - nu1) * (1 + nu1) / e1 + 2 * (2 - nu2) * (1 + nu2) / e2)
    psi = findroot(
        lambda s: s ** ((2 - d) / 2) - (1 + s ** (-d / 2)) ** (-(2 - d) / d) - (2 - d) / d, (mpf("1.5"), mpf(3)), solver="anderson"
    )
    weight = psi ** ((2 - d) / 2)
    root = sqrt(log(GAMMA))
    rough = g ** (d - 1)
    critical = (2 ** (9 - 2 * d) * (modulus / hardness) ** 2 * log(GAMMA) / (9 * pi ** (3 - d))) ** (1 / (d - 1)) * g**2

    def load(a):
        if a <= critical:
            return d / (2 - d) * hardness * weight * a
        if d == mpf("1.5"):
            bracket = log(a / critical) / 2
        else:
            bracket = (a ** (mpf(3) / 2 - d) - critical ** (mpf(3) / 2 - d)) / (3 - 2 * d)
        elastic = 2 ** ((9 - 2 * d) / 2) * d / 3 * pi ** ((d - 3) / 2) * modulus * root * rough * weight * a ** (d / 2) * bracket
        return elastic + d / (2 - d) * hardness * weight * a ** (d / 2) * critical ** ((2 - d) / 2)

    low, high = log(critical) - 60, log(area) + 5
    for _ in range(230):
        middle = (low + high) / 2
        low, high = (middle, high) if load(mp.e**middle) < p * area else (low, middle)
    a = mp.e ** ((low + high) / 2)
    flowing = min(a, critical)
    spent = 2 ** (2 - d) * d / (2 - d) * hardness * rough * root * pi ** ((d - 2) / 2) * weight * a ** (d / 2) * flowing ** (2 - d)
    if a <= critical:
        real = d / (2 - d) * weight * a
        normal = tangential = stored = loss = mpf(0)
    else:
        real = d / (4 - 2 * d) * weight * a ** (d / 2) * (a ** ((2 - d) / 2) + critical ** ((2 - d) / 2))
        springs = weight * a ** (d / 2) * (a ** ((1 - d) / 2) - critical ** ((1 - d) / 2))
        normal = 4 * modulus * (3 - d) * d / (3 * sqrt(2 * pi) * (1 - d) * (2 - d)) * springs
        tangential = 8 * shear * d / (sqrt(2 * pi) * (1 - d)) * springs
        bracket = (a ** ((5 - 3 * d) / 2) - critical ** ((5 - 3 * d) / 2)) / (5 - 3 * d)
        stored = (
            mpf(8) / 15 * 2 ** ((11 - 4 * d) / 2) * d * pi ** (d - mpf(5) / 2) * modulus * rough**2 * log(GAMMA) * weight * a ** (d / 2)
        ) * bracket
        loss = spent / stored
    q = tau * real / (mu * p * area)
    h1 = 1 - cbrt(1 - q) ** 5 - 5 * q / 6 * (1 + cbrt(1 - q) ** 2)
    h2 = mpf(3) / 5 + mpf(2) / 5 * cbrt(1 - q) ** 5 - cbrt(1 - q) ** 2
    slip = [1 / (5 * c / 24 * h2 / h1 - 1) if normal else mpf(0) for c in (1, pi)]
    per_area = [real / area, normal / area, tangential * cbrt(1 - q) / area, stored / area, spent / area]
    return [psi, critical, a, *per_area, loss, *slip, q]


print(NAMES)
for dimension, roughness in SURFACES:
    for pressure in PRESSURES:
        inputs = [number(text) for text in (dimension, roughness, pressure)]
        print(",".join(repr(float(value)) for value in [*inputs, *contact(*inputs)]))
