"""The report of a joint in space: complete, in agreement with what the command tells, and readable in a browser."""

import json
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
from test_page import structure

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "space"))
from frames import Rig

LENGTHS = np.array([1, 1, 1, 0.03, 0.03, 0.03])


@pytest.fixture(scope="module")
def space(program, tmp_path_factory):
    """Folder with a study, its report and its figure; and what the command tells."""
    folder = tmp_path_factory.mktemp("space")
    mixed = np.eye(6) + 0.3 * np.random.default_rng(1).normal(size=(6, 6))
    stiffness = mixed @ mixed.T * np.outer(LENGTHS, LENGTHS)
    rig, rng = Rig(2e7 * stiffness, 300 * stiffness, sensors=3, impacts=9), np.random.default_rng(2)
    rows = [rig.rows(side, (rng, 1e-4, 1e-3, 1e-3)) for side in range(2)]
    budget = "budget = { position = 1e-4, rotation = 1e-3, gain = 1e-3 }\n"
    rig.write(folder, np.linspace(60, 1800, 30), noise=0.002, rng=rng, rows=rows, more=budget)
    files = ["-o", folder / "j.joint.json", "--report", folder / "r.html", "--figure", folder / "f.svg", "--json"]
    done = subprocess.run([program, "identify", folder / "study.toml", *files], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    return folder, json.loads(done.stdout)


def plain(text):
    """What a reader sees, numbers as Python reads them."""
    text = re.sub(r"<script.*?</script>", " ", text, flags=re.S)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", text).replace("−", "-"))


def test_it_is_complete_in_itself(space):
    folder, _ = space
    found = structure(folder / "r.html")
    assert found.open == [] and len(found.ids) == len(set(found.ids))
    assert all(link.startswith("#") for link in found.links)
    text = (folder / "r.html").read_text(encoding="utf-8")
    assert set(re.findall(r"https?://[^\"'\s<)]+", text)) <= {"http://www.w3.org/2000/svg"}
    assert "NaN" not in plain(text) and "inf" not in plain(text).split()
    assert (folder / "f.svg").read_text(encoding="utf-8").startswith("<svg")


def test_its_blocks_hold_the_matrices(space):
    folder, found = space
    text = (folder / "r.html").read_text(encoding="utf-8")
    cells = re.findall(r'title="([kc]_[a-z_]+)">\(?([^<()]+)\)?<br>', text)
    # 6 + 6 + 9 of each matrix, in their units times a power of a thousand
    assert len(cells) == 42 and len(dict(cells)) == 42
    for unknown in found["unknowns"]:
        shown = float(dict(cells)[unknown["name"]].replace("−", "-"))
        power = round(np.log10(abs(unknown["value"] / shown)) / 3)
        assert abs(shown * 1000.0**power - unknown["value"]) <= 0.1 * unknown["standard_deviation"]


def test_axes_indicators_pulls_and_functions_are_told(space):
    folder, found = space
    text = plain((folder / "r.html").read_text(encoding="utf-8"))
    stiffness = np.array(found["joint_file"]["joint"]["stiffness"])
    first = np.linalg.eigvalsh(stiffness[:3, :3])[0]
    (along,) = re.findall(r"along ([\d.]+) [\d.]+ 10 6 N/m", text)[:1]
    assert float(along) * 1e6 == pytest.approx(first, rel=0.01)
    for one in found["consistency"]:
        for each in one["specific"]:
            assert f"{each['dof']}: {each['coherence']:.3f}" in text
    largest = max(found["errors"], key=lambda error: abs(error["pull"]))
    assert re.search(rf"{re.escape(largest['key'])} .{{5,70}} {largest['pull']:.1f} ", text)
    assert text.count("residual") >= 8 and "The free estimate" in text and "Provenance" in text


def test_a_browser_shows_it(space, browser, tmp_path):
    """Its script runs, nothing is wider than the page, and it prints."""
    folder, _ = space
    text = (folder / "r.html").read_text(encoding="utf-8")
    told = """<script>const pre = document.createElement("pre"); pre.id = "told";
    pre.textContent = [document.querySelectorAll(".overlay").length, document.documentElement.scrollWidth - innerWidth].join(" ");
    document.body.append(pre);</script></body>"""
    copy = tmp_path / "told.html"
    copy.write_text(text.replace("</body>", told, 1), encoding="utf-8")
    overlays, beyond = map(int, re.search(r'<pre id="told">(\S+) (\S+)</pre>', browser(copy, "--dump-dom")).groups())
    assert overlays >= 9 and beyond <= 0
    browser(folder / "r.html", f"--print-to-pdf={tmp_path / 'r.pdf'}")
    assert (tmp_path / "r.pdf").read_bytes().startswith(b"%PDF")
