"""Whole assemblies beside one global matrix, which has neither modes nor joints of its own."""

import csv
import json

import numpy as np
import pytest
from beams import RATIO, TwoBeams
from scipy.integrate import solve_ivp
from scipy.linalg import eigh, expm

K = np.array([[5.73e5, 5.82e3], [5.82e3, 1.29e3]])
C = np.array([[10.83, -0.83], [-0.83, 0.083]])


@pytest.fixture(scope="module")
def beams():
    # of few elements, whose highest frequencies leave the lowest their digits
    return TwoBeams((16, 18))


def names(size, named):
    points = [""] * size
    for place, name in named.items():
        points[place] = name
    return points


def write(folder, beams, response, modes="", cubic=0.0):
    """Both beams as matrices of a finite-element program."""
    size_a, size_b = beams.size_a, beams.size - beams.size_a
    for name, (mass, damping, stiffness), named in [
        ("a", beams.a, {size_a - 2: "1:+Y", size_a - 1: "1:+RZ"}),
        ("b", beams.b, {0: "1:+Y", 1: "1:+RZ", size_b - 2: "12:+Y"}),
    ]:
        np.savez(folder / f"{name}.npz", M=mass, C=damping, K=stiffness, points=names(len(mass), named))
    sources = {name: f'matrices = "{name}.npz"\n{modes}' for name in "ab"}
    return assembly(folder, sources, response, cubic)


def joint_file(folder, cubic=0.0):
    joint = {"dofs": ["y", "theta"], "stiffness": K.tolist(), "damping": C.tolist(), "cubic": [cubic, 0.0]}
    file = {"format": "bolted-joint/1", "name": "lap of two beams", "joint": joint}
    (folder / "m10.joint.json").write_text(json.dumps(file))


def assembly(folder, sources, response, cubic=0.0):
    joint_file(folder, cubic)
    text = f"""
name = "two beams"
[structures.a]
{sources["a"]}
[structures.b]
{sources["b"]}
[[joints]]
file = "m10.joint.json"
a = {{ structure = "a", y = "1:+Y", theta = "1:+RZ" }}
b = {{ structure = "b", y = "1:+Y", theta = "1:+RZ" }}
[inputs]
push = "b/12:+Y"
[outputs]
tip = "b/12:+Y"
[response]
{response}
"""
    path = folder / "beams.toml"
    path.write_text(text)
    return path


def respond(run, path, expect=0):
    table = path.parent / "out.csv"
    done = run("respond", path, "-o", table, "--json", expect=expect)
    rows = list(csv.reader(table.open(encoding="utf-8")))
    return json.loads(done.stdout), rows[0], np.array(rows[1:], float)


def receptances(beams, frequencies):
    mass, damping, stiffness = beams.joined(K, C)

    def receptance(omega):
        return beams.tip @ np.linalg.solve(stiffness + 1j * omega * damping - omega**2 * mass, beams.tip)

    return np.array([receptance(omega) for omega in 2 * np.pi * frequencies])


LINEAR = 'kind = "linear"\nfrom = 20\nto = 4000\nlines = 120'


@pytest.mark.parametrize(("modes", "tolerance"), [("", 1e-7), ("modes = 10", 1e-6), ("modes = 500", 1e-9)])
def test_receptances_are_those_of_the_global_matrix(run, tmp_path, beams, modes, tolerance):
    told, heading, rows = respond(run, write(tmp_path, beams, LINEAR, modes))
    assert heading == ["frequency [Hz]", "tip/push receptance real [m/N]", "tip/push receptance imaginary [m/N]"]
    expected = receptances(beams, rows[:, 0])
    error = np.abs(rows[:, 1] + 1j * rows[:, 2] - expected).max() / np.abs(expected).max()
    assert error < tolerance
    assert [own["free"] for own in told["structures"]] == [0, 2]


def test_modes_are_those_of_the_global_matrix(run, tmp_path, beams):
    mass, damping, stiffness = beams.joined(K, C)
    size = beams.size
    inverse = np.linalg.inv(mass)
    system = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ stiffness, -inverse @ damping]])
    values = np.linalg.eigvals(system)
    values = sorted(values[values.imag > 1], key=abs)[:8]
    told, _, _ = respond(run, write(tmp_path, beams, 'kind = "modes"'))
    for value, mode in zip(values, told["modes"]):
        assert mode["frequency_hz"] == pytest.approx(abs(value) / 2 / np.pi, rel=1e-7)
        assert mode["damping_ratio"] == pytest.approx(-value.real / abs(value), rel=1e-4)


def test_a_computed_beam_is_that_of_other_finite_elements(run, tmp_path):
    beam = (
        'beam = {{ length = {}, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, '
        'boundary = "{}", theory = "euler-bernoulli", damping_ratio = 0.005 }}\npoints = {{ {} }}'
    )
    sources = {
        "a": beam.format(0.300, "fixed-free", '"1:+Y" = 0.3, "1:+RZ" = 0.3'),
        "b": beam.format(0.335, "free-free", '"1:+Y" = 0.0, "1:+RZ" = 0.0, "12:+Y" = 0.335'),
    }
    _, _, rows = respond(run, assembly(tmp_path, sources, LINEAR.replace("4000", "1500")))
    expected = receptances(TwoBeams(), rows[:, 0])
    error = np.abs(rows[:, 1] + 1j * rows[:, 2] - expected).max() / np.abs(expected).max()
    # both have errors of their elements, which grow with the frequency
    assert error < 1e-4


def history(duration, step, frequency):
    load = f"push = {{ amplitude = 30.0, frequency = {frequency} }}"
    return f'kind = "history"\nduration = {duration}\nstep = {step}\n[response.loads]\n{load}'


def straight(time, step, frequency):
    """The load between the rows of a table."""
    before = np.floor(time / step + 1e-9) * step
    part = (time - before) / step
    at = lambda t: 30 * np.sin(2 * np.pi * frequency * t)
    return (1 - part) * at(before) + part * at(before + step)


@pytest.mark.parametrize("step", [1e-5, 1e-3])
def test_a_linear_assembly_is_right_at_any_step(run, tmp_path, beams, step):
    frequency = 210.0
    count = 40
    _, heading, rows = respond(run, write(tmp_path, beams, history(count * step, step, frequency), "modes = 500"))
    assert heading[:4] == ["time [s]", "push [N]", "tip [m]", "tip rate [m/s]"]
    mass, damping, stiffness = beams.joined(K, C)
    size = beams.size
    inverse = np.linalg.inv(mass)
    whole = np.zeros((2 * size + 2, 2 * size + 2))
    whole[:size, size : 2 * size] = np.eye(size)
    whole[size : 2 * size, :size] = -inverse @ stiffness
    whole[size : 2 * size, size : 2 * size] = -inverse @ damping
    whole[size : 2 * size, 2 * size] = inverse @ beams.tip
    whole[2 * size, 2 * size + 1] = 1 / step
    # of displacements and rates of one size
    scale = np.concatenate([np.full(size, 1e4), np.ones(size + 2)])
    propagator = expm(whole * step * scale[:, None] / scale[None, :]) * scale[None, :] / scale[:, None]
    state, expected = np.zeros(2 * size), [[0.0, 0.0]]
    loads = 30 * np.sin(2 * np.pi * frequency * step * np.arange(count + 1))
    for now, then in zip(loads, loads[1:]):
        state = (propagator @ np.concatenate([state, [now, then - now]]))[: 2 * size]
        expected.append([state[size - 2], state[2 * size - 2]])
    expected = np.array(expected)
    for column, error in [(0, 1e-8), (1, 1e-7)]:
        assert np.abs(rows[:, 2 + column] - expected[:, column]).max() < error * np.abs(expected[:, column]).max()
    stored, supplied, dissipated = rows[:, 4:7].T
    assert np.abs(supplied - stored - dissipated).max() < 1e-9 * stored.max()


def test_a_cubic_joint_is_followed_by_modes_of_a_file(run, tmp_path, beams):
    frequency, step, duration, cubic = 700.0, 4e-5, 2e-3, 4e15
    sources, omegas, shapes, ratios = {}, [], [], []
    for name, (mass, _, stiffness), places in [
        ("a", beams.a, {"1:+Y": beams.size_a - 2, "1:+RZ": beams.size_a - 1}),
        ("b", beams.b, {"1:+Y": 0, "1:+RZ": 1, "12:+Y": beams.size - beams.size_a - 2}),
    ]:
        squares, all_shapes = eigh(stiffness, mass)
        free = 2 if name == "b" else 0
        kept = slice(free, 20)
        own = np.sqrt(squares[kept])
        text = "points = [" + ", ".join(f'"{point}"' for point in places) + "]\n"
        for omega, shape in zip(own, all_shapes[:, kept].T):
            entries = ", ".join(f"[{float(shape[place])!r}, 0.0]" for place in places.values())
            hz = float(omega / 2 / np.pi)
            text += f"[[mode]]\nfrequency_hz = {hz!r}\ndamping_ratio = {RATIO}\nshape = [{entries}]\n"
        # motions of a free body stand in the residuals of masses: −LA/ω²
        rigid = all_shapes[:, :free][list(places.values())]
        for place, point in enumerate(places):
            if free:
                lower = (rigid @ rigid[place]).tolist()
                text += f'[[residual]]\nreference = "{point}"\nupper = {[0.0] * len(places)}\nlower = {lower}\n'
        (tmp_path / f"{name}.toml").write_text(text)
        sources[name] = f'modal = "{name}.toml"'
        rows = all_shapes[list(places.values())][:, : 20]
        omegas.append(np.concatenate([np.zeros(free), own]))
        ratios.append(2 * RATIO * omegas[-1])
        shapes.append(dict(zip(places, rows)))
    omega, damping = np.concatenate(omegas), np.concatenate(ratios)
    at_a, at_b = (lambda point: np.concatenate([shapes[0][point], np.zeros(20)])), (
        lambda point: np.concatenate([np.zeros(20), shapes[1][point]])
    )
    relative = np.array([at_a(point) - at_b(point) for point in ("1:+Y", "1:+RZ")])
    tip = at_b("12:+Y")

    def rate(time, state):
        q, v = state[:40], state[40:]
        r, s = relative @ q, relative @ v
        force = K @ r + C @ s + np.array([cubic * r[0] ** 3, 0])
        load = tip * straight(time, step, frequency) - relative.T @ force
        return np.concatenate([v, load - omega**2 * q - damping * v])

    state, expected = np.zeros(80), [0.0]
    for n in range(round(duration / step)):
        done = solve_ivp(rate, (n * step, (n + 1) * step), state, method="DOP853", rtol=1e-10, atol=1e-14)
        state = done.y[:, -1]
        expected.append(tip @ state[:40])
    told, _, rows = respond(run, assembly(tmp_path, sources, history(duration, step, frequency), cubic))
    assert [own["free"] for own in told["structures"]] == [0, 2]
    assert np.abs(rows[:, 2] - expected).max() < 1e-6 * np.abs(expected).max()
    stored, supplied, dissipated = rows[-1, 4:7]
    assert supplied - stored - dissipated == pytest.approx(0, abs=1e-6 * rows[:, 4].max())


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            ('structure = "a", y', 'structure = "c", y'),
            '`joints.0.a.structure`: found "c", expected one of the structures: a, b',
        ),
        (
            ('y = "1:+Y", theta = "1:+RZ" }\nb', 'y = "7:+Y", theta = "1:+RZ" }\nb'),
            "expected a point of structure a: 1:+Y, 1:+RZ",
        ),
        (('theta = "1:+RZ" }\nb', 'theta = "1:+Y" }\nb'), "`joints.0.a.theta`: found 1:+Y, expected a rotation"),
        (('b = { structure = "b"', 'b = { structure = "a"'), "a joint between a place and itself"),
        (
            ('push = "b/12:+Y"', 'push = "b12:+Y"'),
            '`inputs.push`: found "b12:+Y", expected a structure, a slash and a point',
        ),
        (('matrices = "a.npz"', 'matrices = "missing.npz"'), "missing.npz"),
        (('matrices = "a.npz"', 'matrices = "wide.npz"'), "array K: found shape [2, 2], expected 3 × 3"),
        (('matrices = "a.npz"', 'matrices = "skew.npz"'), "expected a symmetric matrix"),
        (('matrices = "a.npz"', 'matrices = "soft.npz"'), "a stiffness that is not negative in any motion"),
        (('matrices = "a.npz"', 'matrices = "massless.npz"'), "the mass matrix is not positive definite"),
        (('matrices = "a.npz"', 'matrices = "damped.npz"'), "array D: found a matrix of 3 × 3, and no array C"),
        (
            ('kind = "linear"', 'kind = "linear"\nduration = 1'),
            '`response.duration`: found it, expected it with kind = "history" only',
        ),
        (("to = 4000", "to = 4"), "`response.to`: found 4, expected a frequency above `from`, 20 Hz"),
    ],
)
def test_what_is_wrong_is_told(run, tmp_path, beams, change, told):
    path = write(tmp_path, beams, LINEAR)
    points = ["1:+Y", "1:+RZ", ""]
    unit = np.eye(3)
    for name, matrices in {
        "wide": {"M": unit, "K": np.eye(2)},
        "skew": {"M": unit, "K": unit + np.triu(unit[::-1], 1)},
        "soft": {"M": unit, "K": np.diag([1.0, 2.0, -0.5])},
        "massless": {"M": np.diag([1.0, 1.0, 0.0]), "K": unit},
        "damped": {"M": unit, "K": unit, "D": unit},
    }.items():
        np.savez(tmp_path / f"{name}.npz", points=points, **matrices)
    text = path.read_text()
    assert change[0] in text
    path.write_text(text.replace(*change, 1))
    done = run("respond", path, "-o", tmp_path / "out.csv", expect=1)
    assert told in done.stderr
    assert not (tmp_path / "out.csv").exists()


def test_an_active_joint_is_not_to_be_relied_on(run, tmp_path, beams):
    path = write(tmp_path, beams, LINEAR)
    file = json.loads((tmp_path / "m10.joint.json").read_text())
    file["joint"]["stiffness"] = [[5.73e5, 5e4], [5e4, 1.29e3]]
    (tmp_path / "m10.joint.json").write_text(json.dumps(file))
    done = run("respond", path, "-o", tmp_path / "out.csv", expect=3)
    assert "joint.stiffness is active" in done.stderr and "may grow without bounds" in done.stderr


def test_loads_and_motions_have_any_name(run, tmp_path, beams):
    path = write(tmp_path, beams, LINEAR)
    path.write_text(path.read_text().replace('tip = "b/', 'frf = "b/').replace('push = "b/', 'modal = "b/'))
    _, heading, _ = respond(run, path)
    assert heading[1].startswith("frf/modal")


@pytest.mark.parametrize(
    ("points", "told"),
    [
        ('"1:+Y" = 0.0, "1:+RZ" = 0.0, "12:+X" = 0.3', "`structures.b.points.12:+X`: found X beside 1:+Y"),
        ('"1:+Y" = 0.0, "1:+RZ" = 0.1, "12:+Y" = 0.3', "`structures.b.points.1:+RZ`: found 0.1 m, and 0 m for 1:+Y"),
    ],
)
def test_a_beam_bends_in_one_plane(run, tmp_path, points, told):
    beam = (
        'beam = {{ length = 0.335, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = "{}" }}\n'
        'points = {{ {} }}'
    )
    sources = {"a": beam.format("fixed-free", '"1:+Y" = 0.3, "1:+RZ" = 0.3'), "b": beam.format("free-free", points)}
    done = run("respond", assembly(tmp_path, sources, LINEAR), "-o", tmp_path / "out.csv", expect=1)
    assert told in done.stderr, done.stderr


def test_what_nothing_damps_is_told(run, tmp_path, beams):
    path = write(tmp_path, beams, LINEAR)
    with np.load(tmp_path / "a.npz") as file:
        rest = {name: file[name] for name in ("M", "K", "points")}
    np.savez(tmp_path / "a.npz", **rest)
    told, _, _ = respond(run, path)
    assert told["notes"] == ["structures.a is undamped: the file has no array C, or a C of zeros"]


@pytest.mark.parametrize(
    ("course", "told"),
    [
        (history(0.01, 1e-4, 2600.0), "`response.loads.push.frequency`: found 2600, expected at most 2500 Hz"),
        (history(0.01, 0.02, 10.0), "`response.step`: found 0.02, expected no more than response.duration, 0.01 s"),
        (history(0.01, 1e-4, 10.0).replace(" }", ", until = -3 }"), "`response.loads.push.until`: found -3, expected a time in s"),
    ],
)
def test_loads_that_rows_cannot_show_are_refused(run, tmp_path, beams, course, told):
    done = run("respond", write(tmp_path, beams, course), "-o", tmp_path / "out.csv", expect=1)
    assert told in done.stderr, done.stderr
