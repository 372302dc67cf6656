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


@pytest.fixture(scope="session")
def pages(program, demo, tmp_path_factory):
    """A page of each command: identify, predict, update of a lap, respond, and what stands beside the response."""
    folder = tmp_path_factory.mktemp("pages")
    runs = {
        "predict": ["predict", "predict-four-bolts/study.toml", "predict.joint.json"],
        "update": ["identify", "pirdayr-update/study.toml", "update.joint.json"],
        "respond": ["respond", "pirdayr/figure-10.toml", "respond.csv"],
        "loops": ["respond", "friction/loops.toml", "loops.csv"],
    }
    for name, (command, study, output) in runs.items():
        call = [program, command, ROOT / "examples" / study, "-o", folder / output, "--report", folder / f"{name}.html"]
        done = subprocess.run(call, capture_output=True, text=True, encoding="utf-8", timeout=300)
        # 3: written, and not to be relied on.
        assert done.returncode in (0, 3), done.stderr
    return {"identify": demo / "m10x16-report.html"} | {name: folder / f"{name}.html" for name in runs}


@pytest.fixture
def drive(browser, page, tmp_path):
    """Runs JavaScript in a page and returns what it returns, awaited. `first` and `second` are figures, see `HANDS`.

    With a `width` (pixels) the page stands in a frame of that width, as in a telephone; `media` is the one that the page's style
    takes for its own.
    """

    def drive(script, page=page, width=None, media=None, options=()):
        text = page.read_text(encoding="utf-8")
        if media is not None:
            # A rule for another medium is never met, and one for this is always.
            for name in ("print", "screen"):
                text = text.replace(f"@media {name}", f"@media {'all' if name == media else 'not all'}")
        text = text.replace("<body>", "<body><script>window.errors = []; onerror = (m) => errors.push(m);</script>", 1)
        ending = f"<script>{HANDS} (async () => {{ {script} }})().then(report, (e) => {{ errors.push(String(e)); report(null); }});</script></body>"
        copy = tmp_path / "driven.html"
        copy.write_text(text.replace("</body>", ending, 1), encoding="utf-8")
        opened = copy
        if width is not None:
            opened = tmp_path / "frame.html"
            opened.write_text(f'<body style="margin:0"><iframe src="driven.html" style="border:0;width:{width}px;height:800px"></iframe>')
        # The browser's own time can run out before it has decoded a picture, which takes real time: more of it on a busy machine.
        for attempt in range(8):
            budget = f"--virtual-time-budget={30000 << attempt}"
            dom = browser(opened, "--allow-file-access-from-files", budget, *options, "--dump-dom")
            if '<pre id="result">' in dom:
                break
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
  // In a frame the result is read from the page around it.
  (window.top === window ? document : window.top.document).body.append(made);
};
const figures = [...document.querySelectorAll("figure.chart")];
const [first, second] = figures;
const drawing = (figure) => figure.querySelector(".picture > svg:not(.overlay)");
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
const hand = (figure, kind, clientX, down, more = {}) => {
  const picture = figure.querySelector(".picture");
  const clientY = picture.getBoundingClientRect().top + down;
  picture.dispatchEvent(new PointerEvent(kind, { clientX, clientY, bubbles: true, button: 0, pointerId: 1, ...more }));
};
const pointer = (figure, kind, hz) => hand(figure, kind, place(figure, hz), 80);
const point = (figure, hz) => pointer(figure, "pointermove", hz);
const drag = (figure, from, to) => {
  // All places are those before the drag: the axis changes at its end.
  pointer(figure, "pointerdown", from);
  pointer(figure, "pointermove", to);
  pointer(figure, "pointerup", to);
};
const middle = (figure) => {
  const box = figure.querySelector(".picture").getBoundingClientRect();
  return box.left + 0.3 * box.width;
};
const tap = (figure) => {
  for (const kind of ["pointerdown", "pointerup", "pointerleave"]) {
    hand(figure, kind, middle(figure), 80, { pointerType: "touch" });
  }
};
const press = (figure, key) => figure.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const at = (figure) => figure.querySelector(".keys .at").textContent;
// Readings by the names in the key: one for each panel.
const readings = (figure) => Object.fromEntries([...figure.querySelectorAll(".keys tbody tr")].map((row) =>
  [row.querySelector("th").textContent.trim(), [...row.querySelectorAll("td")].map((cell) => cell.textContent)]));
const isRead = (figure) => Object.values(readings(figure)).some((cells) => cells.some((text) => /\\d/.test(text)));
const button = (figure, name) => [...figure.querySelectorAll("button")].find((each) => each.textContent.trim() === name);
// What a click saves: names and contents of files.
const saved = async (figure, name) => {
  const made = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
  const file = await new Promise((resolve) => {
    let blob = null;
    URL.createObjectURL = (given) => made.call(URL, (blob = given));
    HTMLAnchorElement.prototype.click = function () { resolve({ name: this.download, blob }); };
    button(figure, name).click();
  });
  [URL.createObjectURL, HTMLAnchorElement.prototype.click] = [made, click];
  return file;
};
// Waits for what the browser does when it next draws. Loading gives it the real time that this takes: its own clock runs ahead.
const until = async (is) => {
  for (let tries = 0; tries < 300 && !is(); tries += 1) {
    await new Promise((done) => {
      const load = new XMLHttpRequest();
      load.onloadend = () => setTimeout(done, 5);
      load.open("GET", location.href);
      load.send();
    });
  }
};
const luminance = (colour) => {
  const parts = colour.match(/[\\d.]+/g).slice(0, 3).map((part) => part / 255)
    .map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
  return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
};
// By WCAG 2.2: 1 for the same colour, 21 for black on white.
const contrast = (one, other) => {
  const [a, b] = [luminance(one), luminance(other)].sort((x, y) => y - x);
  return (a + 0.05) / (b + 0.05);
};
"""
