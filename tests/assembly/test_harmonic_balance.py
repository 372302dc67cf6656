"""Periodic motions of an assembly with a joint that is not linear, beside describing functions, NumPy and SciPy."""

import csv
import json

import numpy as np
import pytest
import small
from scipy.integrate import solve_ivp

SLIDER = {"friction": [{"dof": "y", "law": "jenkins", "stiffness": 2e6, "slip_force": 60.0}]}
LOAD = 100.0


def respond(run, tmp_path, joint, response):
    path = small.write(tmp_path, joint, f"[response]\n{response}")
    run("respond", path, "-o", tmp_path / "x.csv")
    with open(tmp_path / "x.csv", newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array(rows[1:], dtype=float)


def forced(run, tmp_path, joint, extra="", load=LOAD, ends=(60, 400)):
    """Frequencies (Hz) and phasors of root and tip, and the largest displacements."""
    text = f'kind = "harmonic-balance"\nfrom = {ends[0]}\nto = {ends[1]}\nloads.push.amplitude = {load}\n{extra}'
    headings, rows = respond(run, tmp_path, joint, text)
    place = {name: next(i for i, own in enumerate(headings) if own.startswith(name)) for name in ("root", "tip")}
    phasors = [rows[:, place[name]] + 1j * rows[:, place[name] + 1] for name in ("root", "tip")]
    return rows[:, 0], *phasors, rows[:, place["tip"] + 2]


def impedances(omega, ratio=0.0):
    """Of both bodies without the joint, with the damping of a mode's own taken away."""
    own = 1 / small.SHAPE**2
    a = own * (small.OMEGA**2 - omega**2 + 1j * omega * (2 * small.RATIO * small.OMEGA - 2 * ratio * omega))
    return a, small.MASS * (-(omega**2) - 2j * ratio * omega**2)


def of_cubic(amplitude):
    return 0.75 * 1e12 * amplitude**2


def of_slider(amplitude, k=2e6, slip=60.0):
    """Jenkins' describing function."""
    ratio = np.clip(slip / (k * amplitude), 0, 1)
    angle = np.arccos(1 - 2 * ratio)
    return k / np.pi * (angle - np.sin(2 * angle) / 2) + 4j * slip / (np.pi * amplitude) * (1 - ratio)


def test_the_check_case(run, tmp_path):
    """r = tip − root, with the harmonics 1, 3, 5 and 7."""
    hz, root, tip, _ = forced(run, tmp_path, {"cubic": [1e12]}, ends=(100, 101))
    assert hz[0] == pytest.approx(100)
    expected = -3.5334742648e-4 - 5.8697670137e-5j
    assert abs((tip - root)[0] / expected - 1) < 1e-9


@pytest.mark.parametrize(("joint", "law", "error"), [({"cubic": [1e12]}, of_cubic, 1e-8), (SLIDER, of_slider, 1e-8)])
def test_the_curve_of_one_harmonic_is_that_of_the_describing_function(run, tmp_path, joint, law, error):
    """At every point, beyond folds too."""
    hz, root, tip, largest = forced(run, tmp_path, joint, "harmonics = 1")
    omega = 2 * np.pi * hz
    a, b = impedances(omega)
    r = root - tip
    joined = small.STIFFNESS + 1j * omega * small.DAMPING + law(np.abs(r))
    scale = np.abs(joined * r) + LOAD
    assert (np.abs(a * root + joined * r) < error * scale).all()
    assert (np.abs(b * tip - joined * r - LOAD) < error * scale).all()
    assert largest == pytest.approx(np.abs(tip), rel=1e-10)
    assert hz[-1] == pytest.approx(400) and len(hz) > 30
    if law is of_cubic:
        assert (np.diff(hz) < 0).any(), "the curve has no fold"


def test_the_largest_displacement_is_that_of_the_motion(run, tmp_path):
    """After the transient has died away, by SciPy."""
    hz, _, _, largest = forced(run, tmp_path, {"cubic": [1e12]}, "harmonics = 15", ends=(75, 76))
    omega = 2 * np.pi * hz[0]

    def rate(time, state):
        return small.rates(state, LOAD * np.cos(omega * time), 1e12 * (state[0] - state[1]) ** 3)

    period = 1 / hz[0]
    done = solve_ivp(rate, (0, 80 * period), np.zeros(4), method="DOP853", rtol=1e-11, atol=1e-15, dense_output=True)
    # −7.45 1/s of the slowest mode
    last = done.sol(np.linspace(79, 80, 20001) * period)[1]
    before = done.sol(np.linspace(78, 79, 20001) * period)[1]
    drift = np.abs(last - before).max()
    assert largest[0] == pytest.approx(np.abs(last - last.mean()).max(), abs=3 * drift + 1e-6 * np.abs(last).max())


@pytest.mark.parametrize(("joint", "law", "error"), [({"cubic": [1e12]}, of_cubic, 1e-8), (SLIDER, of_slider, 1e-8)])
@pytest.mark.parametrize("mode", [1, 2])
def test_a_nonlinear_mode_of_one_harmonic(run, tmp_path, joint, law, error, mode):
    """Its frequency and damping ratio over the amplitude of the tip."""
    text = f'kind = "backbone"\nmode = {mode}\nof = "tip"\namplitude = [1e-7, 1e-3]\nharmonics = 1'
    _, rows = respond(run, tmp_path, joint, text)
    amplitude, hz, ratio = rows.T
    assert amplitude[[0, -1]] == pytest.approx([1e-7, 1e-3])
    omega = 2 * np.pi * hz
    a, b = impedances(omega, ratio)
    root = -b / a * amplitude
    r = root - amplitude
    joined = small.STIFFNESS + 1j * omega * small.DAMPING + law(np.abs(r))
    assert (np.abs(b * amplitude - joined * r) < error * np.abs(joined * r)).all()
    if law is of_cubic:
        # of the linear assembly, as published beside the check case
        expected = [545.917 / (2 * np.pi), 1310.715 / (2 * np.pi)][mode - 1]
        assert hz[0] == pytest.approx(expected, rel=1e-4)
        assert hz[-1] > hz[0]


@pytest.mark.parametrize(
    ("joint", "response", "told"),
    [
        ({}, 'kind = "backbone"\nof = "tip"\namplitude = [1e-6, 1e-4]', "all linear"),
        ({"cubic": [1e12]}, 'kind = "backbone"\nof = "top"\namplitude = [1e-6, 1e-4]', "one of the outputs: root, tip"),
        ({"cubic": [1e12]}, 'kind = "backbone"\nof = "tip"\namplitude = [0, 1]', "two amplitudes"),
        ({"cubic": [1e12]}, 'kind = "backbone"\nof = "tip"\namplitude = [1e-6, 1e-4]\nmode = 9', "expected 1 to 2"),
        ({"cubic": [1e12]}, 'kind = "harmonic-balance"\nfrom = 60\nto = 80', "a table for an input"),
        ({"cubic": [1e12]}, 'kind = "harmonic-balance"\nfrom = 60\nto = 80\nstep = 1', 'with kind = "history" only'),
        ({"cubic": [1e12]}, 'kind = "linear"\nfrom = 60\nto = 80\nharmonics = 3', 'kind = "harmonic-balance" or'),
    ],
)
def test_what_cannot_be_balanced_is_told(run, tmp_path, joint, response, told):
    path = small.write(tmp_path, joint, f"[response]\n{response}")
    done = run("respond", path, "-o", tmp_path / "x.csv", expect=1)
    assert told in done.stderr
    assert not (tmp_path / "x.csv").exists()


def test_a_law_that_depends_on_the_rate_is_told(run, tmp_path):
    law = {
        "dof": "y",
        "law": "lugre",
        "stiffness": 1e6,
        "bristle_damping": 10.0,
        "damping": 5.0,
        "slip_force": 20.0,
        "static_force": 25.0,
        "stribeck_velocity": 0.01,
    }
    response = '[response]\nkind = "harmonic-balance"\nfrom = 60\nto = 80\nloads.push.amplitude = 1'
    path = small.write(tmp_path, {"friction": [law]}, response)
    done = run("respond", path, "-o", tmp_path / "x.csv", expect=1)
    assert "found the law lugre" in done.stderr


# Cases of others, whose numbers are public: a wall holds what they fix to the ground, and gives way by a femtometre per
# newton.

CHAIN = """name = "chain"
[structures.chain]
matrices = "chain.npz"
[structures.wall]
matrices = "wall.npz"
{joints}
[inputs]
push = "chain/1:+Y"
[outputs]
one = "chain/1:+Y"
{outputs}
[response]
{response}
"""


def chain(run, folder, matrices, joints, response):
    """Rows of the answer of a chain of masses, with joints between two of its places, 0 for the wall."""
    mass, damping, stiffness = (np.array(own, dtype=float) for own in matrices)
    points = [f"{place + 1}:+Y" for place in range(len(mass))]
    np.savez(folder / "chain.npz", M=mass, C=damping, K=stiffness, points=points)
    np.savez(folder / "wall.npz", M=[[1.0]], K=[[1e15]], points=["0:+Y"])
    tables = ""
    for number, (one, other, own) in enumerate(joints):
        whole = {"dofs": ["y"], "stiffness": [[0.0]], "damping": [[0.0]], **own}
        text = json.dumps({"format": "bolted-joint/1", "name": "law", "joint": whole})
        (folder / f"{number}.joint.json").write_text(text)
        sides = [
            f'{side} = {{ structure = "{"chain" if place else "wall"}", y = "{place}:+Y" }}'
            for side, place in [("a", one), ("b", other)]
        ]
        tables += f'[[joints]]\nfile = "{number}.joint.json"\n' + "\n".join(sides) + "\n"
    outputs = "" if len(mass) == 1 else 'two = "chain/2:+Y"'
    path = folder / "chain.toml"
    path.write_text(CHAIN.format(joints=tables, response=response, outputs=outputs))
    run("respond", path, "-o", folder / "chain.csv")
    with open(folder / "chain.csv", newline="") as file:
        return np.array(list(csv.reader(file))[1:], dtype=float)


def balanced(matrices, directions, cubics, load, omega, start, harmonics=7):
    """Odd harmonics of all coordinates, complex, by Newton's method from the fundamentals `start`."""
    mass, damping, stiffness = (np.array(own, dtype=float) for own in matrices)
    orders, size = np.arange(1, harmonics + 1, 2), len(mass)
    angle = 2 * np.pi * np.arange(512) / 512
    wave = np.exp(1j * np.outer(angle, orders))

    def residual(numbers):
        q = (numbers[::2] + 1j * numbers[1::2]).reshape(len(orders), size)
        motion = (wave @ q).real
        force = sum(c * np.outer((motion @ d) ** 3, d) for d, c in zip(directions, cubics))
        harmonic = 2 / len(angle) * wave.conj().T @ force
        own = [(stiffness - (k * omega) ** 2 * mass + 1j * k * omega * damping) @ q[i] for i, k in enumerate(orders)]
        rest = np.array(own) + harmonic
        rest[0] -= load
        return np.column_stack([rest.ravel().real, rest.ravel().imag]).ravel()

    q = np.zeros((len(orders), size), dtype=complex)
    q[0] = start
    numbers = np.column_stack([q.ravel().real, q.ravel().imag]).ravel()
    for _ in range(30):
        value = residual(numbers)
        columns = [(residual(numbers + step) - residual(numbers - step)) / 2e-6 for step in 1e-6 * np.eye(len(numbers))]
        change = np.linalg.solve(np.array(columns).T, value)
        numbers -= change
        if np.abs(change).max() < 1e-12:
            break
    return (numbers[::2] + 1j * numbers[1::2]).reshape(len(orders), size)


def test_nlvib_s_two_masses_with_cubic_springs(run, tmp_path):
    """NLvib 1.3, example 02 (Krack and Gross, Harmonic Balance for Nonlinear Vibration Problems, 2019), H = 7."""
    matrices = (np.diag([1, 0.05]), [[0.015, -0.013], [-0.013, 0.013]], [[1.0453, -0.0453], [-0.0453, 0.0453]])
    ends = np.array([0.8, 1.4]) / (2 * np.pi)
    response = f'kind = "harmonic-balance"\nfrom = {ends[0]}\nto = {ends[1]}\nloads.push.amplitude = 0.11'
    rows = chain(run, tmp_path, matrices, [(1, 0, {"cubic": [1.0]}), (1, 2, {"cubic": [0.0042]})], response)
    assert rows[[0, -1], 0] == pytest.approx(ends)
    # two resonances, of which the second folds back
    assert (np.diff(rows[:, 0]) < 0).any()
    for row in rows[:: len(rows) // 25]:
        found = np.array([row[1] + 1j * row[2], row[4] + 1j * row[5]])
        directions, load = [np.array([1, 0]), np.array([1, -1])], np.array([0.11, 0])
        expected = balanced(matrices, directions, [1.0, 0.0042], load, 2 * np.pi * row[0], found)[0]
        assert np.abs(found - expected).max() < 1e-7 * np.abs(expected).max()


def test_nlvib_s_nonlinear_mode_of_two_masses(run, tmp_path):
    """Example 04, after Kerschen, Peeters, Golinval and Vakakis (2009): k3 = 0.5 from the first mass to the ground."""
    stiffness = np.array([[2.0, -1.0], [-1.0, 2.0]])
    matrices = (np.eye(2), np.zeros((2, 2)), stiffness)
    limits = {1: (1.0, np.sqrt(2)), 2: (np.sqrt(3), None)}
    for mode, (small_motion, large_motion) in limits.items():
        response = f'kind = "backbone"\nmode = {mode}\nof = "two"\namplitude = [1e-3, {4 if mode == 1 else 1}]'
        amplitude, hz, ratio = chain(run, tmp_path, matrices, [(1, 0, {"cubic": [0.5]})], response).T
        omega = 2 * np.pi * hz
        assert omega[0] == pytest.approx(small_motion, rel=1e-5)
        assert (np.diff(omega) > 0).all() and np.abs(ratio).max() < 1e-9
        if large_motion:
            # the first mass comes to rest
            assert omega[-1] < large_motion and omega[-1] > 1.2
        for a, own in list(zip(amplitude, omega))[:: len(amplitude) // 8]:
            # (2 − ω²) a = q of the first mass for the fundamental; a mode is forced motion without a force
            start = np.array([(2 - own**2) * a, a])
            q = balanced(matrices, [np.array([1, 0])], [0.5], np.zeros(2), own, start)
            assert abs(q[0, 1]) == pytest.approx(a, rel=1e-5)


def test_tmdsimpy_s_modes_of_one_mass(run, tmp_path):
    """Its tests/test_epmc.py: a cubic spring, and a Jenkins element whose frequency goes from √1.25 to 1."""
    matrices = ([[1.0]], [[0.01]], [[1.0]])
    response = 'kind = "backbone"\nof = "one"\namplitude = [1e-2, 1e2]\nharmonics = 1'
    amplitude, hz, ratio = chain(run, tmp_path, matrices, [(1, 0, {"cubic": [1.0]})], response).T
    assert 2 * np.pi * hz == pytest.approx(np.sqrt(1 + 0.75 * amplitude**2), rel=1e-8)
    assert ratio == pytest.approx(0.01 / (2 * 2 * np.pi * hz), rel=1e-6)
    law = {"friction": [{"dof": "y", "law": "jenkins", "stiffness": 0.25, "slip_force": 0.2}]}
    response = 'kind = "backbone"\nof = "one"\namplitude = [1e-2, 1e5]\nharmonics = 3'
    amplitude, hz, _ = chain(run, tmp_path, matrices, [(1, 0, law)], response).T
    assert 2 * np.pi * hz[0] == pytest.approx(np.sqrt(1.25), abs=1e-10)
    assert 2 * np.pi * hz[-1] == pytest.approx(1.0, abs=1e-7)
