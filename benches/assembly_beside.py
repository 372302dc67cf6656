"""How fast an assembly's FMU is beside the same system in parts, and beside SciPy; and its nonlinear mode beside NumPy.

    BOLTED_JOINT=target/release/bolted-joint .venv/bin/python benches/assembly_beside.py

Two beams of 20 modes each, clamped–free and free–free, with a cubic joint in w between their ends, and 30 N at 700 Hz
on the free end. In parts: an FMU of each beam and one of the joint as element, in FMPy, Jacobi's way, at the largest
step of 1, 2 and 5 times a power of ten that stays bounded. SciPy: `solve_ivp` (DOP853, and Radau with its Jacobian) on the
equations of all modes, its tolerance loosened as far as its error is that of the FMU. Full harmonic balance: all 40
coordinates, harmonics 1, 3, 5 and 7, at the same amplitudes.
"""

import csv
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import fmpy
import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "fmpy"))
from instances import Slave  # noqa: E402

PROGRAM = os.environ.get("BOLTED_JOINT", "target/release/bolted-joint")
K, C, CUBIC, LOAD, HZ = 5.73e5, 10.83, 4e15, 30.0, 700.0
STEP, COUNT = 1e-4, 40
JOINT = {"dofs": ["y"], "stiffness": [[K]], "damping": [[C]], "cubic": [CUBIC]}


def beam(name, boundary, points):
    names = ", ".join(f'"{key}" = {place}' for key, place in points.items())
    return (
        f"[structures.{name}]\nmodes = 20\npoints = {{ {names} }}\nbeam = {{ length = 0.3, width = 0.03, "
        f'height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = "{boundary}", damping_ratio = 0.005 }}\n'
    )


A = beam("a", "fixed-free", {"1:+Y": 0.3})
B = beam("b", "free-free", {"1:+Y": 0.0, "2:+Y": 0.3})


def export(folder, name, text):
    path = folder / f"{name}.toml"
    path.write_text(f'name = "{name}"\nmechanisms = true\n{text}')
    fmu = folder / f"{name}.fmu"
    subprocess.run([PROGRAM, "export", path, "-o", fmu], check=True, capture_output=True)
    return unpacked(folder, fmu)


def unpacked(folder, fmu):
    fmpy.extract(str(fmu), str(folder / fmu.stem))
    instance = Slave(folder / fmu.stem)
    instance.initialise()
    return instance


def whole(folder, response=""):
    sides = "".join(f'{side} = {{ structure = "{side}", y = "1:+Y" }}\n' for side in "ab")
    joint = f'[[joints]]\nfile = "lap.joint.json"\n{sides}'
    return f'{A}{B}{joint}[inputs]\npush = "b/2:+Y"\n[outputs]\ntip = "b/2:+Y"\n{response}'


def load(time_s):
    return LOAD * np.sin(2 * np.pi * HZ * time_s)


def equations(folder):
    """Frequencies, damping, load and relative motion of the FMU's own coordinates, from its start-value file."""
    lines = iter((folder / "whole" / "resources" / "start.txt").read_text().splitlines())
    for line in lines:
        if line.startswith("coordinates"):
            break
    omega = np.array(next(lines).split(), float)
    count = int(next(lines).split()[1])
    damping = np.zeros((len(omega),) * 2)
    for _ in range(count):
        i, j, value = next(lines).split()
        damping[int(i), int(j)] = damping[int(j), int(i)] = float(value)
    rows = {}
    for line in lines:
        if line.split()[0] in ("loads", "motions", "joint"):
            rows[line.split()[0]] = np.array(next(lines).split(), float)
    return omega, damping, rows["loads"], rows["motions"], rows["joint"]


def timed(work, repetitions=3):
    best, value = np.inf, None
    for _ in range(repetitions):
        begin = time.perf_counter()
        value = work()
        best = min(best, time.perf_counter() - begin)
    return best, value


def by_fmu(folder):
    instance = export(folder, "whole", whole(folder))

    def run():
        instance.fmu.reset()
        instance.initialise()
        # prepares the length
        instance.step(0.0, STEP)
        push, tip = [instance.reference["push.F"]], [instance.reference["tip.y"]]
        found = []
        begin = time.perf_counter()
        for place in range(1, COUNT + 1):
            instance.set_by_reference(push, [load(place * STEP)])
            instance.step(place * STEP, STEP)
            found.append(instance.get_by_reference(tip)[0])
        return (time.perf_counter() - begin) / COUNT, found

    runs = [run() for _ in range(5)]
    return min(own for own, _ in runs), runs[0][1]


def in_parts(folder):
    (folder / "lap.json").write_text(json.dumps({"format": "bolted-joint/1", "name": "lap", "joint": JOINT}))
    a = export(folder, "a", f'{A}[inputs]\njoint = "a/1:+Y"\n[outputs]\nend = "a/1:+Y"\n')
    places = '[inputs]\njoint = "b/1:+Y"\npush = "b/2:+Y"\n[outputs]\nend = "b/1:+Y"\ntip = "b/2:+Y"\n'
    b = export(folder, "b", B + places)
    command = [PROGRAM, "export", folder / "lap.json", "-o", folder / "lap.fmu", "--as", "element"]
    subprocess.run(command, check=True, capture_output=True)
    lap = unpacked(folder, folder / "lap.fmu")
    of = {own: [own.reference[name] for name in ("end.y", "end.v")] for own in (a, b)}
    motion = [lap.reference[name] for name in ("a.y", "a.v", "b.y", "b.v")]
    loads = [lap.reference["a.F"], lap.reference["b.F"]]

    def run(step, duration):
        for own in (a, b, lap):
            own.fmu.reset()
            own.initialise()
        count = round(duration / step)
        largest = 0.0
        begin = time.perf_counter()
        for place in range(count):
            now = place * step
            lap.set_by_reference(motion, [*a.get_by_reference(of[a]), *b.get_by_reference(of[b])])
            on_a, on_b = lap.get_by_reference(loads)
            a.set_by_reference([a.reference["joint.F"]], [on_a])
            b.set_by_reference([b.reference["joint.F"], b.reference["push.F"]], [on_b, load(now)])
            for own in (a, b, lap):
                own.step(now, step)
            largest = max(largest, abs(on_b))
            if not largest < 1e6:
                return None
        return (time.perf_counter() - begin) / count * STEP / step

    for step in (1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7, 1e-7):
        try:
            spent = run(step, 3e-3)
        except Exception:  # noqa: BLE001 the FMU refuses a motion that is no longer finite
            spent = None
        if spent is not None:
            return step, spent
    return None


def by_scipy(folder, found):
    omega, damping, push, tip, relative = equations(folder)
    n = len(omega)
    stiffness = np.diag(omega**2) + K * np.outer(relative, relative)
    damping = damping + C * np.outer(relative, relative)
    rest = np.zeros(2 * n)
    matrix = np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -damping]])

    def integrated(method, rtol, count):
        state, rows = rest, []
        for place in range(count + 1):
            force = load(place * STEP) if place else 0.0

            def rate(_, y, force=force):
                r = relative @ y[:n]
                out = matrix @ y
                out[n:] += push * force - relative * (CUBIC * r**3)
                return out

            def jacobian(_, y):
                own = matrix.copy()
                own[n:, :n] -= 3 * CUBIC * (relative @ y[:n]) ** 2 * np.outer(relative, relative)
                return own

            options = {"jac": jacobian} if method == "Radau" else {}
            options |= {"method": method, "rtol": rtol, "atol": rtol * 1e-5}
            done = solve_ivp(rate, (place * STEP, (place + 1) * STEP), state, **options)
            state = done.y[:, -1]
            if place:
                rows.append(tip @ state[:n])
        return np.array(rows)

    exact = integrated("DOP853", 1e-11, COUNT)
    scale = np.abs(exact).max()
    own = np.abs(np.array(found) - exact).max() / scale
    print(f"error of the FMU over {COUNT} steps: {own:.1e} of the motion")
    for method in ("DOP853", "Radau"):
        for exponent in range(3, 12):
            spent, rows = timed(lambda: integrated(method, 10.0**-exponent, COUNT), 1)
            error = np.abs(rows - exact).max() / scale
            if error <= max(own, 1e-8):
                yield method, 10.0**-exponent, error, spent / (COUNT + 1)
                break


def nonlinear_mode(folder):
    response = '[response]\nkind = "backbone"\nmode = 2\nof = "tip"\namplitude = [1e-6, 1e-4]\n'
    path = folder / "mode.toml"
    path.write_text(f'name = "mode"\nmechanisms = true\n{whole(folder, response)}')
    command = [PROGRAM, "respond", path, "-o", folder / "mode.csv"]
    spent, _ = timed(lambda: subprocess.run(command, check=True, capture_output=True))
    with open(folder / "mode.csv", newline="") as file:
        rows = np.array(list(csv.reader(file))[1:], dtype=float)
    return spent, rows


def full_balance(folder, rows):
    """The same points by Newton's method on all coordinates, each from the one before."""
    omega, damping, _, tip, relative = equations(folder)
    n = len(omega)
    stiffness = np.diag(omega**2) + K * np.outer(relative, relative)
    damping = damping + C * np.outer(relative, relative)
    orders = np.array([1, 3, 5, 7])
    samples = 96
    tau = 2 * np.pi * np.arange(samples) / samples
    waves = np.empty((samples, 8))
    waves[:, ::2], waves[:, 1::2] = np.cos(np.outer(tau, orders)), np.sin(np.outer(tau, orders))
    analysis = 2 / samples * waves.T
    size = 8 * n

    def linear(w, ratio):
        whole = np.zeros((size, size))
        for i, k in enumerate(orders):
            z = stiffness - (k * w) ** 2 * np.eye(n)
            c = k * w * (damping - 2 * ratio * w * np.eye(n))
            own = slice(2 * i * n, (2 * i + 1) * n)
            other = slice((2 * i + 1) * n, (2 * i + 2) * n)
            whole[own, own], whole[other, other], whole[own, other], whole[other, own] = z, z, c, -c
        return whole

    pick = np.zeros((8, size))
    for i in range(8):
        pick[i, i * n : (i + 1) * n] = relative

    def solved(unknowns, amplitude):
        for iteration in range(1, 30):
            q, w, ratio = unknowns[:size], unknowns[size], unknowns[size + 1]
            whole = linear(w, ratio)
            r = waves @ (pick @ q)
            balance = whole @ q + pick.T @ (analysis @ (CUBIC * r**3))
            residual = np.concatenate([balance, [tip @ q[:n] - amplitude, tip @ q[n : 2 * n]]])
            jacobian = np.zeros((size + 2, size + 2))
            jacobian[:size, :size] = whole + pick.T @ ((analysis * (3 * CUBIC * r**2)) @ waves) @ pick
            for column, (dw, dz) in enumerate([(1e-6 * w, 0), (0, 1e-6)]):
                jacobian[:size, size + column] = (linear(w + dw, ratio + dz) @ q - whole @ q) / (dw + dz)
            jacobian[size, :n] = tip
            jacobian[size + 1, n : 2 * n] = tip
            change = np.linalg.solve(jacobian, residual)
            unknowns = unknowns - change
            scale = np.concatenate([np.full(size, amplitude), [w, 1]])
            if np.abs(change / scale).max() < 1e-9:
                break
        return unknowns

    values, vectors = np.linalg.eigh(stiffness)
    place = np.argsort(np.abs(np.sqrt(np.maximum(values, 0)) - 2 * np.pi * rows[0, 1]))[0]
    shape = vectors[:, place] / (tip @ vectors[:, place])
    unknowns = np.zeros(size + 2)
    unknowns[:n] = shape * rows[0, 0]
    unknowns[size], unknowns[size + 1] = 2 * np.pi * rows[0, 1], rows[0, 2]
    begin = time.perf_counter()
    found = []
    last = rows[0, 0]
    for amplitude in rows[:, 0]:
        unknowns[:size] *= amplitude / last
        last = amplitude
        unknowns = solved(unknowns, amplitude)
        found.append([unknowns[size] / (2 * np.pi), unknowns[size + 1]])
    return time.perf_counter() - begin, np.array(found)


def main():
    with tempfile.TemporaryDirectory() as own:
        folder = Path(own)
        lap = {"format": "bolted-joint/1", "name": "lap", "joint": JOINT}
        (folder / "lap.joint.json").write_text(json.dumps(lap))
        spent, found = by_fmu(folder)
        print(f"one FMU: {spent * 1e6:.0f} µs per step of {STEP} s")
        step, parts = in_parts(folder)
        print(f"in parts, at {step} s: {parts * 1e6:.0f} µs, {parts / spent:.0f} times as long")
        for method, rtol, error, beside in by_scipy(folder, found):
            times = f"{beside * 1e6:.0f} µs, {beside / spent:.0f} times as long"
            print(f"SciPy {method}, rtol {rtol:.0e}, error {error:.1e}: {times}")
        spent, rows = nonlinear_mode(folder)
        beside, full = full_balance(folder, rows)
        off = np.abs(full / rows[:, 1:] - 1).max(axis=0)
        times = f"NumPy {beside:.2f} s, {beside / spent:.0f} times as long"
        print(f"nonlinear mode, {len(rows)} points: {spent:.3f} s; {times}")
        print(f"frequency and damping ratio differ by {off[0]:.0e} and {off[1]:.0e}")


if __name__ == "__main__":
    main()
