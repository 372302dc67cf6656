"""Draws how times and memory grow, from the tables of docs/benchmarks.md: docs/images/growth.svg.

    python3 benches/growth.py

It needs matplotlib.
"""

import pathlib
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parents[1]
ASSEMBLY, EVERYTHING = "noise on the assembly", "noise on everything"


def tables(text):
    """Each table of a page: its header, and its rows of numbers."""
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        header, _, *rows = [[cell.strip() for cell in line.strip("|\n ").split("|")] for line in block.splitlines()]
        yield header, rows


def number(cell):
    return float(cell.replace(",", "").removesuffix("s"))


def short(count):
    return f"{count / 1000:.0f} k" if count >= 1000 else f"{count:.0f}"


def main():
    growth, in_space = [], None
    for header, rows in tables((ROOT / "docs/benchmarks.md").read_text(encoding="utf-8")):
        if header[:3] == ["lines", "points", "bolts"]:
            growth.append([[number(cell) for cell in row] for row in rows])
        elif header[0] == "N":
            in_space = [[number(cell) for cell in row[1:]] for row in [header, *rows]]
    first, of_bolts = growth
    plt.rcParams |= {"font.size": 9, "svg.hashsalt": "growth", "axes.grid": True, "grid.alpha": 0.3}
    figure, axes = plt.subplots(1, 4, figsize=(11, 3), layout="constrained")
    panels = [
        ("lines; 3 points, 1 bolt", 0, [row for row in first if row[1:3] == [3, 1]]),
        ("points; 3,000 lines, 1 bolt", 1, [row for row in first if (row[0], row[2]) == (3000, 1)]),
        ("bolts; 2,000 lines, 6 points", 2, [row for row in first if row[:3] == [2000, 6, 1]] + [row for row in of_bolts if row[:2] == [2000, 6]]),
    ]
    for axis, (label, column, rows) in zip(axes, panels):
        rows.sort(key=lambda row: row[column])
        for name, value, marker in ((ASSEMBLY, 3, "o-"), (EVERYTHING, 4, "s-")):
            axis.loglog([row[column] for row in rows], [row[value] for row in rows], marker, markersize=4, label=name)
        axis.set(xlabel=label, ylabel="identification, s")
        ticks = sorted({row[column] for row in rows})
        axis.set_xticks(ticks, [short(tick) for tick in ticks])
        axis.minorticks_off()
    axes[0].legend(fontsize=7)
    count, micros, kilobytes = in_space
    axes[3].loglog(count, micros, "o-", markersize=4, label="time, µs")
    axes[3].loglog(count, kilobytes, "s-", markersize=4, label="results, kB")
    axes[3].set(xlabel="DOFs of the joints, N", ylabel="a line in space")
    axes[3].set_xticks(count[::2], [short(n) for n in count[::2]])
    axes[3].minorticks_off()
    axes[3].legend(fontsize=7)
    figure.savefig(ROOT / "docs/images/growth.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
