"""The report as a file: complete in itself, well-formed, small, and in agreement with the joint file."""

import html.parser
import json
import re

VOID = {"meta", "br", "hr", "img", "input", "link", "col", "wbr"}


class Structure(html.parser.HTMLParser):
    """Checks that elements close in order and that identifiers are unique; SVG may close at once."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.names, self.links = [], [], set(), []

    def attributes(self, tag, attributes):
        self.names.add(tag)
        keys = [key for key, _ in attributes]
        assert len(keys) == len(set(keys)), (tag, keys)
        self.ids += [value for key, value in attributes if key == "id"]
        self.links += [value for key, value in attributes if key in {"src", "href", "action", "srcset", "data"}]

    def handle_starttag(self, tag, attributes):
        self.attributes(tag, attributes)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.attributes(tag, attributes)
        assert "svg" in self.open, tag

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.getpos(), self.open)
        self.open.pop()


def structure(page):
    parser = Structure()
    parser.feed(page.read_text(encoding="utf-8"))
    parser.close()
    return parser


def test_it_is_well_formed(page):
    found = structure(page)
    assert found.open == []
    assert len(found.ids) == len(set(found.ids))
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_it_needs_no_network(page):
    found = structure(page)
    assert found.links == []
    assert not found.names & {"link", "iframe", "img", "object", "embed"}
    text = page.read_text(encoding="utf-8")
    assert set(re.findall(r"https?://[^\"'\s<)]+", text)) <= {"http://www.w3.org/2000/svg"}
    assert "@import" not in text and not re.search(r"url\((?!#)", text)
    assert "fetch(" not in text and "XMLHttpRequest" not in text


def test_it_is_small(page):
    assert page.stat().st_size < 2_000_000


def test_it_agrees_with_the_joint_file(page, demo):
    joint = json.loads((demo / "m10x16.joint.json").read_text(encoding="utf-8"))
    text = page.read_text(encoding="utf-8")
    table = text.split("<h2>Identified parameters</h2>")[1].split("</table>")[0]
    rows = re.findall(r"<tr><th scope=\"row\">.*?</tr>", table)
    places = [(key, i, j) for key in ("stiffness", "damping") for i, j in [(0, 0), (0, 1), (1, 1)]]
    assert len(rows) == len(places)

    def number(cell):
        mantissa, _, power = cell.partition(" × 10<sup>")
        power = power.removesuffix("</sup>") or "0"
        return float(mantissa.replace("−", "-")) * 10.0 ** int(power.replace("−", "-"))

    def with_deviation(cell):
        """A value and its deviation: 6.223(96) is 6.223 and 0.096, 27300(6100) is 27300 and 6100."""
        value, bracket, rest = re.fullmatch(r"([−\d.]+)\(([\d.]+)\)(.*)", cell).groups()
        decimals = 0 if "." in bracket else len(value.partition(".")[2])
        return number(value + rest), number(bracket + rest) / 10.0**decimals

    for row, (key, i, j) in zip(rows, places):
        estimate, interval, _ = re.findall(r"<td class=\"number\">(.*?)</td>", row)
        exact = joint["uncertainty"]["standard_deviation"][key][i][j]
        value, deviation = with_deviation(estimate)
        assert abs(value - joint["joint"][key][i][j]) <= 0.06 * exact
        assert abs(deviation / exact - 1) < 0.06
        for end, shown in zip(joint["uncertainty"]["interval_95"][key][i][j], interval.split(" … ")):
            assert abs(number(shown) - end) <= 0.06 * exact
    for file in joint["provenance"]["inputs"]:
        assert file["sha256"] in text and file["file"] in text
