"""Work that takes long shows its progress, and only to a reader at a terminal."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest

pty = pytest.importorskip("pty", reason="no terminals of this kind on this system")

ROOT = pathlib.Path(__file__).resolve().parents[2]
# of a large file
SIZE = 500_000_000
# Nothing is told in the first second: work has to take longer than that on any machine.
LONG_S = 3.0


def long_enough(work, sizes):
    """What `work` returns for the first size with which it takes long, or the last one."""
    for size in sizes:
        begin = time.monotonic()
        found = work(size)
        if time.monotonic() - begin > LONG_S:
            break
    return size, found


@pytest.fixture(scope="module")
def command(program, demo, tmp_path_factory):
    output = tmp_path_factory.mktemp("progress") / "o.joint.json"
    return lambda draws: [program, "identify", demo / "study.toml", "-o", output, "--bootstrap", str(draws)]


def seen_by_a_terminal(command):
    """What a command writes to a terminal's stderr, and the lines of it."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=theirs)
    os.close(theirs)
    seen = b""
    while True:
        try:
            part = os.read(ours, 65536)
        except OSError:  # Linux: nobody has the other end open any more
            break
        if not part:
            break
        seen += part
    os.close(ours)
    assert process.wait() == 0
    return seen, seen.decode()


# The line is cleared, and the cursor may go up to the line before it; the demo's study is warned of then.
GONE = re.compile(rb"\x1b\[2K(\x1b\[1A)?(warning: the rotation of [^#]*)?$")
BYTES = {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9}


def without_warnings(stderr):
    """The lines beside what the demo's study is warned of."""
    return [line for line in stderr.splitlines() if not line.startswith("warning: the rotation of ")]


def test_a_terminal_sees_a_bar_that_goes_away(command):
    draws, (seen, text) = long_enough(lambda draws: seen_by_a_terminal(command(draws)), [400, 1600, 6400])
    counts = [int(count) for count in re.findall(rf"identifying \[#*-*\] (\d+) of {draws}, \S+ left", text)]
    assert len(counts) > 3 and counts == sorted(counts)
    assert 0 < counts[0] < counts[-1] <= draws
    assert GONE.search(seen)


def test_a_file_sees_nothing(command):
    done = subprocess.run(command(800), capture_output=True, check=True)
    assert without_warnings(done.stderr.decode()) == []
    assert b"#" not in done.stdout


@pytest.fixture(scope="module")
def large(program, demo, tmp_path_factory):
    """The demo's study, its assembly after so many bytes of another binary data set, which take no room on the disk."""
    return lambda size: of_size(size, program, demo, tmp_path_factory.mktemp("large"))


def of_size(size, program, demo, folder):
    for name in ["study.toml", "a-modes.toml"]:
        (folder / name).write_bytes((demo / name).read_bytes())
    with open(folder / "assembly.uff", "wb") as file:
        file.write(b"    -1\n  2414b     1     2\n")
        file.seek(size, os.SEEK_CUR)
        file.write(b"    -1\n" + (demo / "assembly.uff").read_bytes())
    return [program, "identify", folder / "study.toml", "-o", folder / "o.joint.json"]


@pytest.mark.long
def test_a_terminal_sees_how_much_of_a_large_file_is_read(large, demo):
    size, (seen, text) = long_enough(lambda size: seen_by_a_terminal(large(size)), [SIZE, 4 * SIZE, 16 * SIZE])
    parts = re.findall(r"assembly.uff \[(#*)(-*)\] ([\d.]+) (k?M?G?B) of [\d.]+ [MG]B, \S+ left", text)
    assert len(parts) > 3
    sizes = [float(size) * BYTES[unit] for _, _, size, unit in parts]
    # The file is read for its functions, then for its hash.
    passes = 1 + sum(after < before for before, after in zip(sizes, sizes[1:]))
    assert passes <= 2
    for (done, left, _, _), read in zip(parts, sizes):
        length = len(done) + len(left)
        assert abs(len(done) / length - read / size) <= 2 / length
    assert GONE.search(seen)


def test_a_large_file_is_not_held(large, demo):
    """Its functions are those of the demo's file, and the memory is that of the demo, not of 0.5 GB."""
    large = large(SIZE)
    child = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)\n"
    child += "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
    done = subprocess.run([sys.executable, "-c", child, *large], capture_output=True, check=True, text=True)
    assert without_warnings(done.stderr) == []
    peak = int(done.stdout) / (1 if sys.platform == "darwin" else 1 / 1024)
    assert peak < 200e6
    mine, theirs = (json.loads(path.read_text())["joint"] for path in [large[-1], demo / "m10x16.joint.json"])
    assert mine == theirs


# What the line of work says beside the time that has passed: steps with what is done of them, and how long the rest takes.
STEP = r"{work} … [\dsmh]+, (?:[^\r\x1b]*; )?{name} (\d+) of (at most )?(\d+)(, \S+ left)?"


def steps_seen(command, work, name):
    """Pieces that were done of a step, of how many, and whether the time that is left was told."""
    return steps_in(seen_by_a_terminal(command), work, name)


def steps_in(seen, work, name):
    """The same in what a terminal has seen."""
    _, text = seen
    # the line is gone at the end
    assert f"{work} …" not in text.rsplit("\x1b[2K", 1)[1]
    found = [(int(done), int(count), bool(left)) for done, _, count, left in re.findall(STEP.format(work=work, name=name), text)]
    assert found, text[-2000:]
    assert all(0 <= done <= count for done, count, _ in found)
    return found


@pytest.mark.long
def test_a_plan_counts_candidates(program, tmp_path):
    study = ROOT / "examples/plan-in-space/study.toml"
    found = steps_seen([program, "respond", study, "--plan", "--add", "6", "--step", "0.05"], "planning", "candidates")
    counts = {count for _, count, _ in found}
    assert len(counts) == 1
    # told as soon as one is done
    assert all(left == (done > 0) for done, _, left in found)
    assert [done for done, _, _ in found] == sorted(done for done, _, _ in found)


@pytest.mark.long
def test_laws_of_a_lap_are_counted(program, tmp_path):
    """Of x (k + ¾ k₃ x² − M ω² + jωc) = F on a grid of amplitudes, with noise: all laws are compared."""
    def write(count):
        random = np.random.default_rng(2)
        rows = []
        for hz in np.linspace(100, 125, count):
            omega, amplitude = 2 * np.pi * hz, 10 ** random.uniform(-6, -4)
            force = amplitude * (5e5 + 0.75 * 2e11 * amplitude**2 - omega**2 + 8j * omega)
            phase = -np.degrees(np.angle(force)) + random.normal()
            rows.append([hz, abs(force), amplitude * (1 + 0.01 * random.normal()), phase])
        head = "frequency_hz,force_n,displacement_m,phase_deg"
        np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header=head, comments="")

    (tmp_path / "study.toml").write_text(
        'method = "lap-response"\nname = "x"\n[model]\ndrive = "relative"\nresponse = "relative"\n[[sine]]\nfile = "run.csv"\n',
        encoding="utf-8",
    )
    command = [program, "identify", tmp_path / "study.toml", "-o", tmp_path / "o.joint.json"]

    def work(count):
        write(count)
        return seen_by_a_terminal(command)

    _, seen = long_enough(work, [2400, 4800, 9600, 19200])
    found = steps_in(seen, "identifying", "laws")
    assert {count for _, count, _ in found} == {18}
    assert all(left == (done > 0) for done, _, left in found)
    assert len({done for done, _, _ in found}) > 2


@pytest.mark.long
def test_steps_to_a_joint_are_told_without_draws(program, demo, tmp_path):
    for file in ("study.toml", "a-modes.toml"):
        shutil.copy(demo / file, tmp_path)
    study = (tmp_path / "study.toml").read_text(encoding="utf-8").replace("assembly.uff", "c.npz")
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")

    def work(step_hz):
        joint = ["--joint", demo / "m10x16.joint.json", "--step", step_hz]
        command = [program, "respond", demo / "study.toml", *joint, "-o", tmp_path / "c.npz", "noise", "frf"]
        subprocess.run(command, check=True, capture_output=True)
        begin = time.monotonic()
        seen = seen_by_a_terminal([program, "identify", tmp_path / "study.toml", "-o", tmp_path / "o.joint.json"])
        return time.monotonic() - begin, seen

    for step_hz in ("0.01", "0.003", "0.001"):
        took_s, (_, text) = work(step_hz)
        if took_s > LONG_S:
            break
    steps = ("functions at the lines", "values that noise", "decoupling", "searches", "the best at all lines", "other joint models")
    seen = [step for step in steps if re.search(rf"identifying … \w+, {step}", text)]
    assert len(seen) >= 2, text[-2000:]
    # a search ends where more starts are not needed, so that nobody knows how long it takes
    assert not re.search(r"searches \d+ of at most \d+, ", text)
