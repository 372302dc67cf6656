"""Work that takes long shows its progress, and only to a reader at a terminal."""

import os
import subprocess

import pytest

pty = pytest.importorskip("pty", reason="no terminals of this kind on this system")

DRAWS = 600


@pytest.fixture(scope="module")
def command(program, demo, tmp_path_factory):
    output = tmp_path_factory.mktemp("progress") / "o.joint.json"
    return [program, "identify", demo / "study.toml", "-o", output, "--bootstrap", str(DRAWS)]


def test_a_terminal_sees_a_bar_that_goes_away(command):
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
    assert process.wait() == 0
    lines = [line for line in seen.decode().split("\r") if line.strip()]
    counts = [int(line.split("] ")[1].split(" of ")[0]) for line in lines if line.startswith("[")]
    assert len(counts) > 3 and counts == sorted(counts)
    assert 0 < counts[0] < counts[-1] <= DRAWS
    assert all(f" of {DRAWS}, " in line for line in lines if line.startswith("["))
    assert seen.endswith(b" \r")


def test_a_file_sees_nothing(command):
    done = subprocess.run(command, capture_output=True, check=True)
    assert done.stderr == b""
    assert b"#" not in done.stdout
