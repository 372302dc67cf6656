"""Two beams, a joint and a laboratory that makes mistakes: data for the error budget that owe nothing to the program.

Beams are exact (Timoshenko, or Euler-Bernoulli without shear and rotary inertia): the dynamic stiffness of each piece follows from
the matrix exponential of its four first-order equations. Damping is hysteretic. The joint is an element between two nodes of one
global matrix. Nothing here couples receptances.

A is clamped at x = 0 and has the joint at 0.285 m of 0.300 m; B is free, has the joint at 0.015 m of 0.221 m and the points of
the assembly at 0.185, 0.200 and 0.215 m.
"""

import dataclasses

import numpy as np

WIDTH, HEIGHT = 0.025, 0.006
AREA, INERTIA = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12
YOUNG, DENSITY, POISSON, SHEAR = 70e9, 2700.0, 0.33, 5 / 6
LOSS = {"A": 6e-3, "B": 2e-3}
LENGTH = {"A": 0.300, "B": 0.221}
JOINT = {"A": 0.285, "B": 0.015}
POINTS = np.array([0.185, 0.200, 0.215])
FREQUENCY = np.arange(10.0, 1000.5, 4.0)

STIFFNESS = np.array([[1.2e6, 6e3], [6e3, 1.3e3]])
DAMPING = np.array([[12.0, 0.15], [0.15, 0.09]])
NAMES = ["k_yy", "k_ytheta", "k_thetatheta", "c_yy", "c_ytheta", "c_thetatheta"]
TRUTH = np.array([STIFFNESS[0, 0], STIFFNESS[0, 1], STIFFNESS[1, 1], DAMPING[0, 0], DAMPING[0, 1], DAMPING[1, 1]])


def piece(omega, length, young, density, timoshenko):
    """Dynamic stiffness of a piece of beam between (w, θ) at its ends, at each ω: 4 × 4."""
    # d/dx (w, θ, M, Q) with Q' = −ρAω²w, M' = −Q − ρIω²θ, θ' = M/EI, w' = θ + Q/κGA
    system = np.zeros((len(omega), 4, 4), complex)
    system[:, 0, 1] = 1
    system[:, 1, 2] = 1 / (young * INERTIA)
    system[:, 2, 3] = -1
    system[:, 3, 0] = -density * AREA * omega**2
    if timoshenko:
        system[:, 0, 3] = 1 / (SHEAR * AREA * young / (2 * (1 + POISSON)))
        system[:, 2, 1] = -density * INERTIA * omega**2
    values, vectors = np.linalg.eig(system)
    transfer = vectors @ (np.exp(values * length)[..., None] * np.linalg.inv(vectors))
    # (w, θ) and (Q, M) at the far end from those at the near one
    order = [0, 1, 3, 2]
    transfer = transfer[:, order][:, :, order]
    uu, uf, fu, ff = transfer[:, :2, :2], transfer[:, :2, 2:], transfer[:, 2:, :2], transfer[:, 2:, 2:]
    inverse = np.linalg.inv(uf)
    stiffness = np.empty((len(omega), 4, 4), complex)
    stiffness[:, :2, :2] = inverse @ uu
    stiffness[:, :2, 2:] = -inverse
    stiffness[:, 2:, :2] = fu - ff @ inverse @ uu
    stiffness[:, 2:, 2:] = ff @ inverse
    return stiffness


@dataclasses.dataclass
class Body:
    """A beam with nodes at these positions."""

    name: str
    nodes: list
    young: float = YOUNG
    density: float = DENSITY
    timoshenko: bool = True

    def __post_init__(self):
        ends = [0.0, LENGTH[self.name]]
        # pieces short enough for exponentials of moderate size
        fill = np.linspace(*ends, 5)
        near = [x for x in fill[1:-1] if min(abs(x - np.array(self.nodes + ends))) > 1e-3]
        self.x = np.unique(np.round(np.array(self.nodes + ends + near), 12))

    def node(self, x):
        return int(np.argmin(abs(self.x - x)))

    def dynamic_stiffness(self, omega):
        young = self.young * (1 + 1j * LOSS[self.name])
        size = 2 * len(self.x)
        whole = np.zeros((len(omega), size, size), complex)
        for i, length in enumerate(np.diff(self.x)):
            whole[:, 2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += piece(omega, length, young, self.density, self.timoshenko)
        return whole


def receptances(omega, bodies, wanted, joint=None, masses=(), inertias=(), ground=None):
    """Receptances between `wanted` (body, x, 0 for w or 1 for θ); `joint` is the dynamic stiffness between the bodies' joints, or a
    list of them, `masses` are (body, x, kg), `inertias` (body, x, kg m²). `ground` holds B to what does not move."""
    sizes = [2 * len(body.x) for body in bodies]
    first = {body.name: start for body, start in zip(bodies, np.cumsum([0] + sizes[:-1]))}
    by_name = {body.name: body for body in bodies}
    whole = np.zeros((len(omega), sum(sizes), sum(sizes)), complex)

    def place(body, x, dof):
        return first[body] + 2 * by_name[body].node(x) + dof

    for body, size in zip(bodies, sizes):
        start = first[body.name]
        whole[:, start : start + size, start : start + size] = body.dynamic_stiffness(omega)
    for body, x, kg in masses:
        at = place(body, x, 0)
        whole[:, at, at] -= omega**2 * kg
    for body, x, inertia in inertias:
        at = place(body, x, 1)
        whole[:, at, at] -= omega**2 * inertia
    if ground:
        held = [place("B", ground["B"], dof) for dof in (0, 1)]
        whole[np.ix_(range(len(omega)), held, held)] += ground["stiffness"]
    for bolt in [joint] if isinstance(joint, dict) else joint or []:
        a = [place("A", bolt["A"], dof) for dof in (0, 1)]
        b = [place("B", bolt["B"], dof) for dof in (0, 1)]
        for rows, columns, sign in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
            whole[np.ix_(range(len(omega)), rows, columns)] += sign * bolt["stiffness"]
    clamped = [place("A", 0.0, dof) for dof in (0, 1)] if "A" in by_name else []
    free = [i for i in range(sum(sizes)) if i not in clamped]
    columns = [free.index(place(*dof)) for dof in wanted]
    right = np.zeros((len(free), len(columns)), complex)
    right[columns, range(len(columns))] = 1
    whole = whole[np.ix_(range(len(omega)), free, free)]
    solved = np.linalg.solve(whole, np.broadcast_to(right, (len(omega), *right.shape)))
    return solved[:, columns]


@dataclasses.dataclass
class Mistakes:
    """What the laboratory does not know; SI units."""

    gain: dict = dataclasses.field(default_factory=dict)  # set: relative
    channel: dict = dataclasses.field(default_factory=dict)  # (set, row): relative
    delay: dict = dataclasses.field(default_factory=dict)  # set: s
    phase: dict = dataclasses.field(default_factory=dict)  # set: rad
    accelerometer: dict = dataclasses.field(default_factory=dict)  # set: kg, moving from response to response
    joint_sensor: dict = dataclasses.field(default_factory=dict)  # A or B, with several bolts (A or B, bolt): m
    point: dict = dataclasses.field(default_factory=dict)  # point: m
    frequency: dict = dataclasses.field(default_factory=dict)  # A or B: relative, in the assembly
    young: float = 0.0  # of B as it is over what is believed
    density: float = 0.0
    joint_mass: dict = dataclasses.field(default_factory=dict)  # A or B, with several bolts (A or B, bolt): kg
    joint_inertia: dict = dataclasses.field(default_factory=dict)  # A or B: kg m²
    loss_factor: float = 0.0
    hysteretic_only: bool = False
    spacing: float = 0.0  # of the rotation by central differences


def loaded(z, omega, kg, rows):
    """What is measured at each response with a mass there: exact."""
    z = z.copy()
    for row in rows:
        z[:, row] /= (1 - omega**2 * kg * z[:, row, row])[:, None]
    return z


def test_data(mistakes, noise, seed, frequency=FREQUENCY, timoshenko=True):
    """Measured functions of A (y, θ), of B (y, θ, points) and of the assembly (points): line, response, reference. With a spacing,
    A and B have the translations at three points for y and θ."""
    omega = 2 * np.pi * np.asarray(frequency)
    at = {side: JOINT[side] + mistakes.joint_sensor.get(side, 0.0) for side in "AB"}
    points = POINTS + np.array([mistakes.point.get(i, 0.0) for i in range(3)])
    believed = YOUNG, DENSITY
    real_b = YOUNG * (1 + mistakes.young), DENSITY * (1 + mistakes.density)

    def body(side, nodes, young, density, scale=0.0):
        return Body(side, nodes, young * (1 + scale) ** 2, density, timoshenko)

    sets = {}
    if mistakes.spacing:
        s = mistakes.spacing
        near = [[at[side] - s, at[side], at[side] + s] for side in "AB"]
        wanted = [("A", x, 0) for x in near[0]]
        sets["A"] = receptances(omega, [body("A", near[0], *believed)], wanted)
        wanted = [("B", x, 0) for x in [*near[1], *POINTS]]
        sets["B"] = receptances(omega, [body("B", near[1] + list(POINTS), *real_b)], wanted)
    else:
        wanted = [("A", at["A"], 0), ("A", at["A"], 1)]
        sets["A"] = receptances(omega, [body("A", [at["A"]], *believed)], wanted)
        wanted = [("B", at["B"], 0), ("B", at["B"], 1)] + [("B", x, 0) for x in POINTS]
        sets["B"] = receptances(omega, [body("B", [at["B"], *POINTS], *real_b)], wanted)
    damping = np.zeros((2, 2)) if mistakes.hysteretic_only else DAMPING
    stiffness = STIFFNESS * (1 + 1j * mistakes.loss_factor) + 1j * omega[:, None, None] * damping
    together = [
        body("A", [JOINT["A"]], *believed, mistakes.frequency.get("A", 0.0)),
        body("B", [JOINT["B"], *points], *real_b, mistakes.frequency.get("B", 0.0)),
    ]
    masses = [(side, JOINT[side], kg) for side, kg in mistakes.joint_mass.items()]
    inertias = [(side, JOINT[side], inertia) for side, inertia in mistakes.joint_inertia.items()]
    joint = {**JOINT, "stiffness": stiffness}
    sets["C"] = receptances(omega, together, [("B", x, 0) for x in points], joint, masses, inertias)
    translations = {"A": [0], "B": [0, 2, 3, 4], "C": [0, 1, 2]}
    if mistakes.spacing:
        translations = {name: range(z.shape[1]) for name, z in sets.items()}
    return measured(sets, omega, mistakes, translations, noise, seed)


def measured(sets, omega, mistakes, translations, noise, seed):
    """What sensors and channels make of receptances; `translations` are the rows of a set with an accelerometer."""
    generator = np.random.default_rng(seed)
    for name, z in sets.items():
        z = loaded(z, omega, mistakes.accelerometer.get(name, 0.0), translations[name])
        z = z * (1 + mistakes.gain.get(name, 0.0))
        z = z * np.exp(1j * (mistakes.phase.get(name, 0.0) - omega * mistakes.delay.get(name, 0.0)))[:, None, None]
        for (of, row), gain in mistakes.channel.items():
            if of == name:
                z[:, row] *= 1 + gain
        parts = generator.standard_normal((2, *z.shape))
        sets[name] = z * (1 + noise * (parts[0] + 1j * parts[1]) / np.sqrt(2))
    return sets


DIFFERENCE_LABELS = {"A": ["3:+Y", "1:+Y", "4:+Y"], "B": ["5:+Y", "2:+Y", "6:+Y", "11:+Y", "12:+Y", "13:+Y"]}
LABELS = {
    "A": ["1:+Y", "1:+RZ"],
    "B": ["2:+Y", "2:+RZ", "11:+Y", "12:+Y", "13:+Y"],
    "C": ["11:+Y", "12:+Y", "13:+Y"],
}


def write(folder, sets, noise, frequency=FREQUENCY, budget=None, computed_b=False, timoshenko=True, spacing=0.0, section=False):
    """Archives of the sets and a study of them; its path."""
    labels = {**LABELS, **DIFFERENCE_LABELS} if spacing else LABELS
    for name, z in sets.items():
        np.savez(
            folder / f"{name}.npz", frequency=frequency, frf=z, response=labels[name], reference=labels[name],
            quantity="receptance", axes="frequency,response,reference",
        )
    positions = ", ".join(f'"{label}" = {x}' for label, x in zip(LABELS["C"], POINTS))
    rotation = {side: f'"{labels[side][1]}"' for side in "AB"}
    if spacing:
        rotation = {side: f"{{ points = {labels[side][:3]}, spacing = {spacing} }}" for side in "AB"}
    size = f"{{ width = {WIDTH}, height = {HEIGHT}, youngs_modulus = {YOUNG}, poissons_ratio = {POISSON} }}"
    cut = f"section = {size}" if section else ""
    theory = f", poissons_ratio = {POISSON}" if timoshenko else ', theory = "euler-bernoulli"'
    b = (
        f'beam = {{ length = {LENGTH["B"]}, width = {WIDTH}, height = {HEIGHT}, youngs_modulus = {YOUNG}, density = {DENSITY}, '
        f'boundary = "free-free", loss_factor = {LOSS["B"]}{theory} }}\n'
        f'joint = {{ x = {JOINT["B"]} }}\npoints = {{ {positions} }}'
        if computed_b
        else f'frf = "B.npz"\njoint = {{ y = "2:+Y", theta = {rotation["B"]} }}\n{cut}\npoints = {{ {positions} }}'
    )
    study = folder / "study.toml"
    study.write_text(
        f"""method = "frf-decoupling"
name = "rig"
{"" if budget is None else f"budget = {budget}"}
[a]
frf = "A.npz"
joint = {{ y = "1:+Y", theta = {rotation["A"]} }}
{cut}
[b]
{b}
[assembly]
frf = "C.npz"
points = {LABELS["C"]}
[joint]
model = "full"
[noise]
relative = {noise}
floor = 0
""",
        encoding="utf-8",
    )
    return study
