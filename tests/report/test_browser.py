"""The report as its reader uses it: cursor, zoom and print in a headless browser."""

import cmath
import math
import re

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
    shown = drive(f"point(first, {hz}); return [first.querySelector('figcaption b').textContent, ...readings(first)];")
    name, at, magnitude, regenerated, phase, regenerated_phase, residual = shown
    pair = tuple(int(end.split(":")[0]) for end in name.split(" / "))
    assert number(at) == pytest.approx(hz, abs=0.26) and at.endswith(" Hz")
    value = measured(demo)[pair][number(at)]
    assert magnitude.endswith(" m/N") and phase.endswith(" °") and residual.endswith(" %")
    assert number(magnitude) == pytest.approx(abs(value), rel=6e-4)
    turn = (number(phase) - math.degrees(cmath.phase(value)) + 180) % 360 - 180
    assert abs(turn) < 0.06
    model = cmath.rect(number(regenerated), math.radians(number(regenerated_phase)))
    assert number(residual) == pytest.approx(100 * abs(value - model) / abs(model), abs=0.25)


def test_keys_move_the_cursor_by_lines(drive):
    at = drive(
        "point(first, 100); const at = [readings(first)[0]];"
        "for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft']) { press(first, key); at.push(readings(first)[0]); }"
        "return at;"
    )
    lines = [number(text) for text in at]
    assert [round((line - lines[0]) / 0.25) for line in lines] == [0, 1, 2, 1]


def test_dragging_zooms_and_a_double_click_ends_it(drive):
    whole, zoomed, at, again = drive(
        "const whole = labels(first); drag(first, 100, 130); const zoomed = labels(first);"
        "point(first, 120); const at = readings(first);"
        "first.querySelector('.overlay').dispatchEvent(new MouseEvent('dblclick', { bubbles: true }));"
        "return [whole, zoomed, at, labels(first)];"
    )
    assert whole[0]["hz"] <= 50 and whole[-1]["hz"] >= 450
    assert 100 <= zoomed[0]["hz"] <= 105 and 125 <= zoomed[-1]["hz"] <= 130
    # The picture is as wide as before: its ends are those of the drag.
    slope = (zoomed[-1]["x"] - zoomed[0]["x"]) / (zoomed[-1]["hz"] - zoomed[0]["hz"])
    before = (whole[-1]["x"] - whole[0]["x"]) / (whole[-1]["hz"] - whole[0]["hz"])
    assert slope / before == pytest.approx(512 / 30, rel=0.02)
    assert number(at[0]) == pytest.approx(120, abs=0.13)
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


def test_every_figure_answers(drive):
    count, without = drive(
        "const all = [...document.querySelectorAll('figure.chart')];"
        "all.forEach((figure) => { point(figure, 200); drag(figure, 150, 250); point(figure, 200); });"
        "const silent = all.filter((figure) => readings(figure).some((text) => text === '') || !figure.dataset.range);"
        "return [all.length, silent.map((figure) => figure.id)];"
    )
    assert count >= 15 and without == []


def test_it_prints(browser, page, tmp_path):
    printed = tmp_path / "report.pdf"
    browser(page, f"--print-to-pdf={printed}", "--no-pdf-header-footer")
    data = printed.read_bytes()
    assert data.startswith(b"%PDF-")
    # Pages of a document that breaks where it may: as many as the figures need, two or three on each.
    assert 6 <= len(re.findall(rb"/Type\s*/Page\b", data)) <= 16
