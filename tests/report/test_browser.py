"""The report as its reader uses it: cursor, zoom, key, saving and print in a headless browser."""

import base64
import cmath
import csv
import io
import json
import math
import re
import struct
import subprocess

import pytest


def number(text):
    """A number as the page shows it: "−1.234 × 10⁻⁵ m/N"."""
    found = re.match(r"(−?[\d.]+)(?: × 10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?", text)
    assert found, text
    power = (found[2] or "0").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(found[1].replace("−", "-")) * 10.0 ** int(power)


def measured(demo):
    """The functions in the demo's universal file: frequency to value, by response and reference."""
    functions = {}
    for block in (demo / "assembly.uff").read_text().split("    -1\n    58\n")[1:]:
        lines = block.split("    -1\n")[0].splitlines()
        record = lines[5].split()
        pair = (int(record[5]), int(record[8]))
        axis = lines[6].split()
        count, first, step = int(axis[1]), float(axis[3]), float(axis[4])
        values = [float(text) for line in lines[11:] for text in line.split()]
        assert len(values) == 2 * count
        functions[pair] = {first + k * step: complex(*values[2 * k : 2 * k + 2]) for k in range(count)}
    return functions


@pytest.mark.parametrize("hz", [20.0, 114.5, 342.75, 500.25])
def test_the_cursor_shows_what_was_measured(drive, demo, hz):
    name, at, read, heads = drive(
        f"point(first, {hz});"
        "const heads = [...first.querySelectorAll('.keys thead th')].slice(1).map((head) => head.textContent);"
        "return [first.querySelector('figcaption b').textContent, at(first), readings(first), heads];"
    )
    assert heads == ["magnitude, m/N", "phase, °", "residual, %"]
    pair = tuple(int(end.split(":")[0]) for end in name.split(" / "))
    at = float(re.fullmatch(r"frequency ([\d.]+) Hz", at)[1])
    assert at == pytest.approx(hz, abs=0.26)
    value = measured(demo)[pair][at]
    magnitude, phase, nothing = read["measured"]
    assert nothing == "" and number(magnitude) == pytest.approx(abs(value), rel=6e-4)
    turn = (number(phase) - math.degrees(cmath.phase(value)) + 180) % 360 - 180
    assert abs(turn) < 0.06
    model = cmath.rect(number(read["regenerated"][0]), math.radians(number(read["regenerated"][1])))
    residual = number(read["residual"][2])
    assert residual == pytest.approx(100 * abs(value - model) / abs(model), abs=0.25)


def test_keys_move_the_cursor_by_lines(drive):
    at = drive(
        "point(first, 100); const found = [at(first)];"
        "for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft']) { press(first, key); found.push(at(first)); }"
        "return found;"
    )
    lines = [number(text.removeprefix("frequency ")) for text in at]
    assert [round((line - lines[0]) / 0.25) for line in lines] == [0, 1, 2, 1]


def test_dragging_zooms_and_a_double_click_ends_it(drive):
    whole, zoomed, at, again = drive(
        "const whole = labels(first); drag(first, 100, 130); const zoomed = labels(first);"
        "point(first, 120); const read = at(first);"
        "first.querySelector('.picture').dispatchEvent(new MouseEvent('dblclick', { bubbles: true }));"
        "return [whole, zoomed, read, labels(first)];"
    )
    assert whole[0]["hz"] <= 50 and whole[-1]["hz"] >= 450
    assert 100 <= zoomed[0]["hz"] <= 105 and 125 <= zoomed[-1]["hz"] <= 130
    # The picture is as wide as before: its ends are those of the drag.
    slope = (zoomed[-1]["x"] - zoomed[0]["x"]) / (zoomed[-1]["hz"] - zoomed[0]["hz"])
    before = (whole[-1]["x"] - whole[0]["x"]) / (whole[-1]["hz"] - whole[0]["hz"])
    assert slope / before == pytest.approx(512 / 30, rel=0.02)
    assert number(at.removeprefix("frequency ")) == pytest.approx(120, abs=0.13)
    assert again == whole


def test_a_zoomed_picture_shows_the_lines_in_the_range(drive):
    dots, ends, strips = drive(
        "drag(first, 100, 130); const svg = drawing(first);"
        "const paths = [...svg.querySelectorAll('g[clip-path] path')].map((path) => path.getAttribute('d'));"
        "const dots = paths.filter((d) => d.includes('h0')).map((d) => d.split('h0').length - 1);"
        "const x = (d) => Number(d.slice(1).split(' ')[0]);"
        "return [dots, [labels(first)[0], labels(first).slice(-1)[0]], svg.querySelectorAll('g[clip-path]').length];"
    )
    assert strips == 3
    # 0.25 Hz apart from 100 to 130 Hz, and a neighbour or two beyond the ends.
    assert len(dots) == 3 and all(119 <= count <= 124 for count in dots), dots
    assert ends[0]["hz"] < ends[1]["hz"]


def test_figures_zoom_together_on_request(drive):
    ranges = drive(
        "press(first, '+'); const alone = [first, second].map((figure) => figure.dataset.range);"
        "document.querySelector('#together').click(); press(first, '+');"
        "const both = [first, second].map((figure) => figure.dataset.range);"
        "press(second, '0'); return [alone, both, [first, second].map((figure) => figure.dataset.range)];"
    )
    alone, both, whole = ranges
    assert alone[0] and not alone[1]
    assert both[0] == both[1] != alone[0]
    assert whole == ["", ""]


PAGES = ["identify", "predict", "update", "respond", "loops"]


@pytest.mark.parametrize("name", PAGES)
def test_every_figure_answers_a_tap_and_zooms_both_ways(drive, pages, name):
    """A tap with a finger reads values that stay; a drag zooms along, one upright zooms up."""
    count, silent = drive(
        "const silent = [];"
        "for (const figure of figures) {"
        "  tap(figure); const read = isRead(figure);"
        "  const [x, to] = [middle(figure), middle(figure) + 60];"
        "  hand(figure, 'pointerdown', x, 70); hand(figure, 'pointermove', to, 71); hand(figure, 'pointerup', to, 71);"
        "  const along = figure.dataset.range && !figure.dataset.up; button(figure, 'whole range').click();"
        "  hand(figure, 'pointerdown', x, 60); hand(figure, 'pointermove', x, 110); hand(figure, 'pointerup', x, 110);"
        "  const up = figure.dataset.up && !figure.dataset.range; button(figure, 'whole range').click();"
        "  if (!read || !along || !up || figure.dataset.up) silent.push([figure.id, read, along, up]);"
        "}"
        "return [figures.length, silent];",
        page=pages[name],
    )
    assert count >= 1 and silent == []


@pytest.mark.parametrize("name", PAGES)
def test_readings_do_not_move_the_picture(drive, pages, name):
    """On a telephone: a finger that taps a figure and then goes exactly along it zooms along, and nothing moves below it."""
    wrong = drive(
        "const wrong = [];"
        "for (const figure of figures) {"
        "  const picture = figure.querySelector('.picture');"
        "  const top = () => picture.getBoundingClientRect().top - figure.getBoundingClientRect().top;"
        "  const box = picture.getBoundingClientRect(), before = top(), moved = [];"
        "  const finger = (kind, share) => {"
        "    const at = { clientX: box.left + share * box.width, clientY: box.top + 80 };"
        "    picture.dispatchEvent(new PointerEvent(kind, { ...at, bubbles: true, button: 0, pointerId: 1, pointerType: 'touch' }));"
        "    moved.push(top() - before); };"
        "  finger('pointerdown', 0.5); finger('pointerup', 0.5); const read = isRead(figure);"
        "  finger('pointerdown', 0.4); finger('pointermove', 0.5); finger('pointermove', 0.6); finger('pointerup', 0.7);"
        "  const { range, up } = figure.dataset; button(figure, 'whole range').click();"
        "  if (!read || !range || up || moved.some((by) => Math.abs(by) > 0.1)) wrong.push([figure.id, read, range, up, moved]);"
        "}"
        "return wrong;",
        page=pages[name],
        width=390,
    )
    assert wrong == []


def test_what_moves_the_page_during_a_drag_is_no_drag(drive):
    """A text above the figure that goes away while the pointer is down."""
    range_, up = drive(
        "const picture = first.querySelector('.picture'), box = picture.getBoundingClientRect();"
        "const text = document.createElement('p'); text.style.height = '40px'; first.before(text);"
        "const y = picture.getBoundingClientRect().top + 100;"
        "const go = (kind, share) => picture.dispatchEvent(new PointerEvent(kind, {"
        "  clientX: box.left + share * box.width, clientY: y, bubbles: true, button: 0, pointerId: 1 }));"
        "go('pointerdown', 0.4); text.remove(); go('pointermove', 0.5); go('pointerup', 0.6);"
        "return [first.dataset.range, first.dataset.up];"
    )
    assert range_ and not up


@pytest.mark.parametrize("widths", [[390, 844, 390], [1200, 400, 1200]])
def test_figures_follow_the_width_of_the_page(drive, widths):
    """A telephone that is turned, and a window that grows again."""
    found = drive(
        "const found = [];"
        f"for (const width of {widths}) {{"
        "  frameElement.style.width = `${width}px`;"
        "  await until(() => Math.abs(drawing(first).viewBox.baseVal.width - first.clientWidth) < 60);"
        "  const [across, column] = [drawing(first), first].map((each) => each.getBoundingClientRect().width);"
        "  const text = drawing(first).querySelector('text').getBoundingClientRect().height;"
        "  found.push([across, column, drawing(first).viewBox.baseVal.width, text]);"
        "}"
        "return found;",
        width=widths[0],
    )
    for across, column, drawn, _ in found:
        assert across == pytest.approx(min(column, 1000), abs=1.5) and drawn == pytest.approx(across, abs=1.5)
    assert found[0] == found[2]


@pytest.fixture(scope="session")
def compared(program, demo, tmp_path_factory):
    """The page of joints beside each other: the second stiffer, and the first with a damping that may be zero."""
    folder = tmp_path_factory.mktemp("compared")
    joint = json.loads((demo / "m10x16.joint.json").read_text(encoding="utf-8"))
    del joint["uncertainty"]["interval_95"]
    (folder / "second.joint.json").write_text(json.dumps(joint), encoding="utf-8")
    joint["joint"]["stiffness"] = [[value / 1.465 for value in row] for row in joint["joint"]["stiffness"]]
    joint["joint"]["damping"][0][1] = joint["joint"]["damping"][1][0] = 2e-4
    (folder / "first.joint.json").write_text(json.dumps(joint), encoding="utf-8")
    files = [folder / "first.joint.json", folder / "second.joint.json"]
    subprocess.run([program, "compare", *files, "--plot", folder / "compare.html"], check=True, capture_output=True, timeout=60)
    return folder / "compare.html"


def test_joints_beside_each_other_are_told_as_elsewhere(compared):
    text = compared.read_text(encoding="utf-8").replace("\u00a0", " ")
    assert "<i>k</i><sub>yy</sub> <small>N/m</small></th>" in text
    assert ">572880(270)</td>" in text and ">0.0002(44)</td>" in text
    assert ">+46.5 % (+" in text
    # A damping that may be zero has no part.
    assert ">– (−133 σ)</td>" in text and "cannot be told from zero" in text
    assert "a probability of less than 10<sup>−10</sup>" in text


def test_a_telephone_shows_what_decides_and_that_there_is_more(drive, compared, pages):
    """390 pixels wide: the difference and the unit are in sight, and a table that goes on fades at its end."""
    script = (
        "const ends = (text) => [...document.querySelectorAll('main th')].filter((cell) => cell.textContent === text)"
        "  .map((cell) => cell.getBoundingClientRect().right);"
        "const boxes = [...document.querySelectorAll('.scroll')].map((box) =>"
        "  [box.scrollWidth > box.clientWidth + 1, getComputedStyle(box).maskImage !== 'none']);"
        "const wide = [...document.querySelectorAll('.scroll')].find((box) => box.scrollWidth > box.clientWidth + 1);"
        "const sides = []; if (wide) for (const left of [0, 1e5]) {"
        "  wide.scrollLeft = left; const seen = () => ['before', 'after'].map((side) => wide.classList.contains(side));"
        "  await until(() => seen()[0] === left > 0); sides.push(seen()); }"
        "return [ends('2 against 1'), ends('Unit'), boxes, sides];"
    )
    difference, _, _, _ = drive(script, page=compared, width=390)
    assert difference and max(difference) <= 390
    _, units, boxes, sides = drive(script, width=390)
    assert units and units[0] <= 390
    assert any(scrolls for scrolls, _ in boxes) and all(scrolls == fades for scrolls, fades in boxes)
    assert sides == [[False, True], [True, False]]


def test_a_box_zooms_both_axes_to_its_corners(drive):
    ends, place = drive(
        "const texts = () => [...drawing(first).querySelectorAll('text')];"
        "const heights = texts().filter((text) => /^10[⁻⁰¹²³⁴-⁹]+$/.test(text.textContent)).map((text) => {"
        "  const box = text.getBoundingClientRect(); return [text.textContent, (box.top + box.bottom) / 2]; });"
        "const [[, high], [, low]] = [heights[1], heights[3]].sort((a, b) => a[1] - b[1]);"
        "const top = first.querySelector('.picture').getBoundingClientRect().top;"
        "const [x, to] = [place(first, 200), place(first, 300)];"
        "hand(first, 'pointerdown', x, high - top); hand(first, 'pointermove', to, low - top);"
        "hand(first, 'pointerup', to, low - top);"
        "return [[first.dataset.range, first.dataset.up], [heights[1][0], heights[3][0]]];"
    )
    along, up = [[float(end) for end in text.split()] for text in ends]
    assert along == pytest.approx([200, 300], rel=0.01)
    powers = sorted(number("1 × " + text) for text in place)
    # A label's middle is within two pixels of its line, and a decade is some forty pixels high.
    assert [math.log10(end / power) for end, power in zip(up, powers)] == pytest.approx([0, 0], abs=0.06)


def test_two_fingers_zoom_about_what_lies_below_them(drive):
    ends = drive(
        "const [x, to] = [place(first, 200), place(first, 300)];"
        "hand(first, 'pointerdown', x, 80, { pointerId: 1 }); hand(first, 'pointerdown', to, 84, { pointerId: 2 });"
        "hand(first, 'pointermove', place(first, 150), 80, { pointerId: 1 });"
        "const ends = labels(first); return [place(first, 200) - place(first, 300), x - to, ends];"
    )
    shown, before, _ = ends
    # From 100 Hz between the fingers to as much over 1.5 times the room.
    assert shown / before == pytest.approx(1.5, rel=0.02)


@pytest.mark.parametrize("name", PAGES)
def test_the_key_is_one_and_hides_curves(drive, pages, name):
    keys, wrong = drive(
        "const wrong = [], keys = [];"
        "const strokes = (figure, colour) => drawing(figure).querySelectorAll(`g[clip-path] [stroke='${colour}']`).length;"
        "for (const figure of figures) {"
        "  const names = [...figure.querySelectorAll('.keys tbody th')].map((cell) => cell.innerHTML);"
        "  keys.push([figure.querySelectorAll('.keys').length, names.length, new Set(names).size]);"
        "  const entry = figure.querySelector('.keys tbody button');"
        "  const colour = entry.querySelector('path').getAttribute('stroke');"
        "  const before = strokes(figure, colour); entry.click(); const hidden = strokes(figure, colour); entry.click();"
        "  if (!(hidden < before && strokes(figure, colour) === before)) wrong.push([figure.id, before, hidden]);"
        "}"
        "return [keys, wrong];",
        page=pages[name],
    )
    assert wrong == []
    assert all(tables == 1 and names == different >= 1 for tables, names, different in keys)


def test_what_is_saved_as_a_table_is_what_was_measured(drive, demo):
    name, text = drive("const file = await saved(first, 'CSV'); return [file.name, await file.blob.text()];")
    assert name.endswith(".csv")
    rows = list(csv.DictReader(io.StringIO(text)))
    exact = measured(demo)[11, 11]
    assert len(rows) == len([hz for hz in exact if 5 <= hz <= 512])
    for row in rows[::97]:
        value = exact[float(row["frequency, Hz"])]
        assert float(row["magnitude, m/N: measured"]) == pytest.approx(abs(value), rel=1e-6)
        turn = (float(row["phase, °: measured"]) - math.degrees(cmath.phase(value)) + 180) % 360 - 180
        assert abs(turn) < 1e-4


def test_a_saved_response_is_the_table_beside_it(drive, pages):
    _, text = drive("const file = await saved(first, 'CSV'); return [file.name, await file.blob.text()];", page=pages["respond"])
    rows = list(csv.DictReader(io.StringIO(text)))
    with (pages["respond"].parent / "respond.csv").open(encoding="utf-8") as file:
        table = [row for row in csv.DictReader(file) if row["lap"] == "Ex.02, 4 N·m" and float(row["level [N]"]) == 10]
    title = "Ex.02, 4 N·m: "
    saved = [row for row in rows if row[f"{title}frequency, Hz: 10 N"]]
    assert len(saved) == len(table) > 100
    for mine, exact in zip(saved, table):
        assert float(mine[f"{title}frequency, Hz: 10 N"]) == pytest.approx(float(exact["frequency [Hz]"]), rel=1e-6)
        assert float(mine[f"{title}b.y amplitude, m: 10 N"]) == pytest.approx(float(exact["b.y amplitude [m]"]), rel=1e-6)


@pytest.mark.parametrize("name", PAGES)
def test_every_picture_can_be_saved(drive, pages, name):
    """Of a still picture too: a PNG twice as large as the picture, white at its corner also on a dark page."""
    files = drive(
        "const files = [], toBlob = HTMLCanvasElement.prototype.toBlob; let corner = null;"
        "HTMLCanvasElement.prototype.toBlob = function (...all) {"
        "  corner = [...this.getContext('2d').getImageData(3, 3, 1, 1).data]; toBlob.apply(this, all); };"
        "for (const figure of [...figures.slice(0, 3), ...document.querySelectorAll('figure.still')]) {"
        "  const file = await saved(figure, 'PNG');"
        "  const bytes = new Uint8Array(await file.blob.arrayBuffer());"
        "  files.push([file.name, btoa(String.fromCharCode(...bytes.slice(0, 24))), corner]);"
        "}"
        "return files;",
        page=pages[name],
        options=["--blink-settings=preferredColorScheme=0"],
    )
    assert files
    for name, head, corner in files:
        head = base64.b64decode(head)
        assert name.endswith(".png") and head.startswith(b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", head[16:24])
        assert width >= 800 and height >= 300
        assert corner == [255, 255, 255, 255]


@pytest.mark.parametrize("name", PAGES)
def test_a_telephone_shows_all_of_it(drive, pages, name):
    """390 pixels wide: nothing beyond the edge but tables that scroll, texts that can be read, labels of tables narrow."""
    width, beyond, smallest, labels, fingers = drive(
        "const width = document.documentElement.scrollWidth;"
        "const beyond = [...document.querySelectorAll('main *')].filter((each) => !each.closest('.scroll, svg'))"
        "  .filter((each) => each.getBoundingClientRect().right > innerWidth + 1).map((each) => each.tagName);"
        "const texts = figures.flatMap((figure) => [...drawing(figure).querySelectorAll('text')]);"
        "const scale = (text) => text.ownerSVGElement.getBoundingClientRect().width / text.ownerSVGElement.viewBox.baseVal.width;"
        "const smallest = Math.min(...texts.map((text) => Number(text.getAttribute('font-size')) * scale(text)));"
        "const labels = [...document.querySelectorAll('main table:not(.keys) th[scope=row]')]"
        "  .filter((cell) => getComputedStyle(cell).display === 'table-cell').map((cell) => cell.getBoundingClientRect().width);"
        "tap(first);"
        "return [width, beyond, smallest, Math.max(0, ...labels), isRead(first)];",
        page=pages[name],
        width=390,
    )
    assert width <= 390 and beyond == []
    assert smallest >= 11
    assert labels <= 0.45 * 390
    assert fingers


@pytest.mark.parametrize("name", PAGES)
@pytest.mark.parametrize("is_dark", [False, True])
def test_figures_have_the_page_s_colours(drive, pages, name, is_dark):
    """The paper is the page's, and curves and texts stand out from it (WCAG 2.2, 1.4.11 and 1.4.3)."""
    found, page, faint = drive(
        "const page = getComputedStyle(document.body).backgroundColor;"
        "const found = figures.map((figure) => getComputedStyle(drawing(figure).querySelector('rect')).fill);"
        "const faint = [];"
        "for (const figure of figures) {"
        "  for (const path of drawing(figure).querySelectorAll('g[clip-path] path:not([stroke-dasharray])')) {"
        "    const own = contrast(getComputedStyle(path).stroke, page); if (own < 2.2) faint.push([path.getAttribute('stroke'), own]); }"
        "  for (const text of drawing(figure).querySelectorAll('text')) {"
        "    const own = contrast(getComputedStyle(text).fill, page); if (own < 4.5) faint.push([text.textContent, own]); }"
        "}"
        "return [found, page, faint];",
        page=pages[name],
        options=["--blink-settings=preferredColorScheme=0"] if is_dark else [],
    )
    assert set(found) == {page} and page == ("rgb(21, 26, 33)" if is_dark else "rgb(255, 255, 255)")
    assert faint == []


@pytest.mark.parametrize("is_dark", [False, True])
def test_measured_dots_stay_visible(drive, is_dark):
    """They stand out from the paper, and are wider than the line over them."""
    contrast, widths = drive(
        "const page = getComputedStyle(document.body).backgroundColor;"
        "const paths = [...drawing(first).querySelectorAll('g[clip-path] path')];"
        "const dots = paths.find((path) => path.getAttribute('d').includes('h0'));"
        "const line = paths.find((path) => path.getAttribute('d').includes('L'));"
        "return [contrast(getComputedStyle(dots).stroke, page), [dots, line].map((path) => Number(path.getAttribute('stroke-width')))];",
        options=["--blink-settings=preferredColorScheme=0"] if is_dark else [],
    )
    assert contrast >= 3 and widths[0] >= 2 * widths[1]


@pytest.mark.parametrize("name", PAGES)
def test_dragging_selects_no_text_and_estimates_come_first(drive, pages, name):
    select, order = drive(
        "const select = figures.map((figure) => getComputedStyle(drawing(figure).querySelector('text')).userSelect);"
        "const place = (query) => [...document.querySelectorAll('main *')].indexOf(document.querySelector(query));"
        "return [select, [place('main table:not(.keys)'), place('figure.chart')]];",
        page=pages[name],
    )
    assert set(select) == {"none"}
    assert 0 <= order[0] < order[1]


@pytest.mark.parametrize("name", ["identify", "respond"])
def test_functions_have_a_phase(drive, pages, name):
    phases = drive(
        "return [...drawing(first).querySelectorAll('text')].filter((text) => text.textContent === 'phase, °').length;", page=pages[name]
    )
    assert phases >= 1


@pytest.mark.parametrize("name", PAGES)
def test_paper_clips_no_table(drive, pages, name):
    """A4 less margins of 14 mm, at 96 pixels an inch."""
    room = (210 - 28) / 25.4 * 96
    clipped = drive(
        "const room = document.documentElement.clientWidth;"
        "return [...document.querySelectorAll('main table, main svg')].filter((each) => each.getBoundingClientRect().right > room + 1)"
        "  .map((each) => [each.tagName, each.textContent.slice(0, 60)]);",
        page=pages[name],
        width=int(room),
        media="print",
    )
    assert clipped == []


# Texts that are on more lines than they have words: a word or a number that is broken.
BROKEN = """
const broken = [];
for (const cell of document.querySelectorAll('main table:not(.keys) :is(th, td):not(.hash, .long)')) {
  const texts = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const node = texts.currentNode;
    for (const { 0: word, index } of node.data.matchAll(/[^\\s\u2010-\u2015…/-]+/g)) {
      const range = document.createRange(); range.setStart(node, index); range.setEnd(node, index + word.length);
      if (new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1) broken.push(word);
    }
  }
}
return broken;
"""


@pytest.mark.parametrize("name", [*PAGES, "compare", "show"])
def test_paper_breaks_no_word_and_no_number(drive, pages, compared, shown, name):
    others = {"compare": compared, "show": shown}
    room = (210 - 28) / 25.4 * 96
    assert drive(BROKEN, page=others.get(name) or pages[name], width=int(room), media="print") == []


@pytest.fixture(scope="session")
def shown(program, demo, tmp_path_factory):
    """The page of what is in files: measured functions, and a joint."""
    page = tmp_path_factory.mktemp("shown") / "show.html"
    files = [demo / "assembly.uff", demo / "m10x16.joint.json"]
    subprocess.run([program, "show", *files, "--plot", page], check=True, capture_output=True, timeout=60)
    return page


def test_it_prints(browser, page, tmp_path):
    printed = tmp_path / "report.pdf"
    browser(page, f"--print-to-pdf={printed}", "--no-pdf-header-footer")
    data = printed.read_bytes()
    assert data.startswith(b"%PDF-")
    # Pages of a document that breaks where it may: as many as the figures need, two or three on each.
    assert 6 <= len(re.findall(rb"/Type\s*/Page\b", data)) <= 16
