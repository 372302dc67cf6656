"""The program under test, a report written by it, and a browser to read it with."""

import html
import json
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BROWSERS = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge"]


@pytest.fixture(scope="session")
def program():
    """Path of the executable; BOLTED_JOINT names another one."""
    path = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    assert path.exists(), f"{path} is missing: run `cargo build --release` or ./test"
    return path


@pytest.fixture(scope="session")
def demo(program, tmp_path_factory):
    """Folder with what the demo writes."""
    folder = tmp_path_factory.mktemp("demo")
    subprocess.run([program, "demo", "-o", folder], check=True, capture_output=True, timeout=120)
    return folder


@pytest.fixture(scope="session")
def page(demo):
    """Path of the demo's report."""
    return demo / "m10x16-report.html"


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Opens a page in a headless browser; BOLTED_JOINT_BROWSER names another than those that are looked for."""
    named = os.environ.get("BOLTED_JOINT_BROWSER")
    names = [named] if named else BROWSERS
    path = next(filter(None, map(shutil.which, names)), None)
    if path is None:
        pytest.skip("no Chromium, Chrome or Edge here: the report's script is not tested; install one or name one by BOLTED_JOINT_BROWSER")
    profile = tmp_path_factory.mktemp("profile")

    def browser(page, *options):
        common = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--window-size=1200,900"]
        command = [path, *common, f"--user-data-dir={profile}", *options, page.as_uri()]
        done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=120)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return browser


@pytest.fixture
def drive(browser, page, tmp_path):
    """Runs JavaScript in the report and returns what it returns. `first` and `second` are figures, see `HANDS`."""

    def drive(script):
        text = page.read_text(encoding="utf-8")
        text = text.replace("<body>", "<body><script>window.errors = []; onerror = (m) => errors.push(m);</script>", 1)
        ending = f"<script>{HANDS} report((() => {{ {script} }})());</script></body>"
        copy = tmp_path / "driven.html"
        copy.write_text(text.replace("</body>", ending, 1), encoding="utf-8")
        dom = browser(copy, "--dump-dom")
        result = dom.split('<pre id="result">')[1].split("</pre>")[0]
        result = json.loads(html.unescape(result))
        assert result["errors"] == []
        return result["value"]

    return drive


# What a reader does with hand and eye. Places are found by the labels of the axes, not by the figure's own data.
HANDS = """
const report = (value) => {
  const made = document.createElement("pre");
  made.id = "result";
  made.textContent = JSON.stringify({ value, errors });
  document.body.append(made);
};
const [first, second] = document.querySelectorAll("figure.chart");
const drawing = (figure) =>
  [...figure.querySelectorAll(".picture > svg:not(.overlay)")].find((svg) => svg.style.display !== "none");
// Labels of the frequency axis with their places: the numbers lowest in the picture but for the axis' name.
const labels = (figure) => {
  const texts = [...drawing(figure).querySelectorAll("text")].map((text) => ({
    text: text.textContent, y: text.getBoundingClientRect().top, box: text.getBoundingClientRect() }));
  const lowest = Math.max(...texts.filter((t) => /^[0-9.]+$/.test(t.text)).map((t) => t.y));
  return texts.filter((t) => Math.abs(t.y - lowest) < 1 && /^[0-9.]+$/.test(t.text))
    .map((t) => ({ hz: Number(t.text), x: (t.box.left + t.box.right) / 2 }));
};
const place = (figure, hz) => {
  const all = labels(figure);
  const [a, b] = [all[0], all[all.length - 1]];
  return a.x + ((hz - a.hz) / (b.hz - a.hz)) * (b.x - a.x);
};
const pointer = (figure, kind, hz) => {
  const overlay = figure.querySelector(".overlay");
  const box = overlay.getBoundingClientRect();
  const where = { clientX: place(figure, hz), clientY: box.top + 80, bubbles: true, button: 0, pointerId: 1 };
  overlay.dispatchEvent(new PointerEvent(kind, where));
};
const point = (figure, hz) => pointer(figure, "pointermove", hz);
const drag = (figure, from, to) => {
  // All places are those before the drag: the axis changes at its end.
  pointer(figure, "pointerdown", from);
  pointer(figure, "pointermove", to);
  pointer(figure, "pointerup", to);
};
const press = (figure, key) => figure.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const readings = (figure) => [...figure.querySelectorAll(".keys b")].map((reading) => reading.textContent);
"""
