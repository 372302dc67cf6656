"""Tables that NumPy writes, in every dress, tell the same joint as the universal file that they were made of."""

import itertools
import re

import numpy as np
import pytest
from conftest import POINTS

PAIRS = list(itertools.product(range(3), range(3)))


def name(pair):
    return f"{POINTS[pair[0]]}/{POINTS[pair[1]]}"


def accelerance(demo):
    return -((2 * np.pi * demo.frequency) ** 2) * demo.values


def complex_columns(demo, path, pairs=PAIRS):
    """Columns as `numpy.savetxt` writes complex numbers, in m/s²/N."""
    values = accelerance(demo)
    columns = np.column_stack([demo.frequency.astype(complex)] + [values[pair] for pair in pairs])
    header = ",".join(["frequency"] + [f"{name(pair)} accelerance complex" for pair in pairs])
    form = ["%.17g"] + ["(%.17g%+.17gj)"] * len(pairs)
    rows = ([line[0].real] + [part for value in line[1:] for part in (value.real, value.imag)] for line in columns)
    with open(path, "w", encoding="utf-8") as file:
        file.write(header + "\nHz" + ",m/s^2/N" * len(pairs) + "\n")
        file.writelines(",".join(form) % tuple(row) + "\n" for row in rows)


def plain_savetxt(demo, path):
    """What `numpy.savetxt` makes of a complex matrix without being asked; the first column is complex then, and is not used."""
    values = np.column_stack([demo.values[pair] for pair in PAIRS])
    header = ";".join(["f"] + [f"{name(pair)} complex [m/N]" for pair in PAIRS])
    with open(path, "w", encoding="utf-8") as file:
        file.write(header + "\n")
        for hz, row in zip(demo.frequency, values):
            file.write(f"{float(hz)!r};")
            np.savetxt(file, row[None, :], delimiter=";")


def decibels(demo, path):
    """dB and degrees with decimal commas, two rows of header, as a German analyser writes."""
    values = accelerance(demo)
    names, units = ["Frequency"], ["Hz"]
    columns = [demo.frequency]
    for pair in PAIRS:
        names += [f"{name(pair)} magnitude accelerance", f"{name(pair)} phase"]
        units += ["dB re 1e-6 mm/s^2/N", "deg"]
        columns += [20 * np.log10(abs(values[pair]) * 1e3 / 1e-6), np.angle(values[pair], deg=True)]
    with open(path, "w", encoding="latin-1") as file:
        file.write("# Prüfstand 3\n" + ";".join(names) + "\n" + ";".join(units) + "\n")
        file.writelines(";".join("%.15g" % x for x in row).replace(".", ",") + "\n" for row in np.column_stack(columns))


def same(found, expected, within):
    for key in ("stiffness", "damping"):
        np.testing.assert_allclose(found["joint"][key], expected["joint"][key], rtol=within)
        deviations = [file["uncertainty"]["standard_deviation"][key] for file in (found, expected)]
        np.testing.assert_allclose(*deviations, rtol=10 * within)


@pytest.mark.parametrize("write", [complex_columns, plain_savetxt, decibels], ids=lambda write: write.__name__)
def test_every_dress_is_the_same_joint(demo, study, write):
    expected, _ = study()
    write(demo, study.folder / "assembly.csv")
    found, _ = study('frf = "assembly.csv"')
    same(found, expected, 1e-7)


def test_a_file_for_each_reference(demo, study, run):
    expected, _ = study()
    for reference in range(3):
        complex_columns(demo, study.folder / f"{reference}.csv", [pair for pair in PAIRS if pair[1] == reference])
    found, _ = study('frf = ["0.csv", "1.csv", "2.csv"]')
    same(found, expected, 1e-7)
    inputs = [one["file"] for one in found["provenance"]["inputs"] if one["role"] == "assembly"]
    assert inputs == ["0.csv", "1.csv", "2.csv"]
    shown = run("show", study.folder / "study.toml").stdout
    assert "assembly.frf[1] = 1.csv: a table" in shown
    _, done = study('frf = ["0.csv", "1.csv", "0.csv"]', expect=1)
    assert "0.csv: has the function 11:+Y / 11:+Y, which" in done.stderr and "remove it from one" in done.stderr
    _, done = study("frf = []", expect=1)
    assert "expected the path of a file" in done.stderr
    _, done = study('frf = ["0.csv", "missing.csv"]', expect=1)
    assert '`assembly.frf`: found "missing.csv", which is not there' in done.stderr


def test_coherence_in_a_file_of_its_own(demo, study, run):
    """σ²/|H|² = (1 − γ²)/(n γ²): the same numbers whether the coherence stands beside the functions or alone."""
    averages, noise = 10, 0.01
    gamma_squared = 1 / (1 + averages * noise**2)
    with_column, alone = study.folder / "with.csv", study.folder / "coherence.csv"
    complex_columns(demo, with_column)
    lines = with_column.read_text(encoding="utf-8").splitlines()
    names = [f"{name(pair)} coherence" for pair in PAIRS]
    more = [names, [""] * 9] + [[repr(gamma_squared)] * 9] * (len(lines) - 2)
    with_column.write_text(
        "# averages = 10\n" + "\n".join(",".join([line, *cells]) for line, cells in zip(lines, more)), encoding="utf-8"
    )
    expected, _ = study('frf = "with.csv"')
    assert "reduced_chi_squared" in expected["residual"]
    frequencies = [f"{hz!r}" for hz in map(float, demo.frequency)]
    rows = [",".join(["f", *names])] + [",".join([hz] + [repr(gamma_squared)] * 9) for hz in frequencies]
    alone.write_text("\n".join(rows), encoding="utf-8")
    found, _ = study('frf = "assembly.uff"\naverages = 10\ncoherence = "coherence.csv"')
    same(found, expected, 1e-7)
    assert found["residual"]["reduced_chi_squared"] == pytest.approx(expected["residual"]["reduced_chi_squared"], rel=1e-6)
    assert "9, and no function" in run("show", alone).stdout
    _, done = study('frf = "coherence.csv"', expect=1)
    assert "coherence.csv: found coherences alone" in done.stderr
    _, done = study('frf = "assembly.uff"\naverages = 10\ncoherence = "assembly.uff"', expect=1)
    assert "assembly.uff: found no coherence" in done.stderr
    alone.write_text("\n".join(rows).replace("/1", "/9"), encoding="utf-8")
    _, done = study('frf = "assembly.uff"\naverages = 10\ncoherence = "coherence.csv"')
    assert "coherence.csv: none of its coherences belongs to a function of" in done.stderr


def test_what_is_wrong_with_a_coherence_is_told_of_its_own_file(demo, study):
    names = [f"{name(pair)} coherence" for pair in PAIRS]
    frequencies = [f"{hz!r}" for hz in map(float, demo.frequency)]

    def write(file, names, lines):
        rows = [",".join(["f", *names])] + [",".join([hz] + ["0.9"] * len(names)) for hz in lines]
        (study.folder / file).write_text("\n".join(rows), encoding="utf-8")

    def told(files, averages="averages = 10\n", expect=1):
        _, done = study(f'frf = "assembly.uff"\n{averages}coherence = {files}', expect=expect)
        return done.stderr

    write("short.csv", names, frequencies[:-1])
    assert re.search(r"short.csv: coherence 1\d:\+Y / 1\d:\+Y: found no value for line", told('"short.csv"'))
    write("all.csv", names, frequencies)
    write("again.csv", names[:1], frequencies)
    assert "again.csv: found two coherences" in told('["all.csv", "again.csv"]')
    other = [one.replace("1", "9") for one in names]
    write("other.csv", other, frequencies)
    warned = told('["all.csv", "other.csv"]', expect=0)
    assert "other.csv: none of its coherences belongs to a function of" in warned and "all.csv: none" not in warned
    warned = told('"all.csv"', averages="", expect=0)
    assert "all.csv: coherence is not used, since the number of averages is not known" in warned


def test_thinned_lines_are_those_of_a_thinned_file(demo, study):
    """Bit for bit what a file tells that holds these lines alone."""
    complex_columns(demo, study.folder / "all.csv")
    lines = (study.folder / "all.csv").read_text(encoding="utf-8").splitlines()
    # two rows of header; lines at 0.25, 0.5 … Hz
    numbers = [(float(line.split(",")[0]), line) for line in lines[2:]]
    inside = [line for hz, line in numbers if 10 <= hz <= 250 or 300 <= hz <= 450]
    (study.folder / "some.csv").write_text("\n".join(lines[:2] + inside[::3]), encoding="utf-8")
    found, done = study('frf = "all.csv"', frequency="bands = [[10, 250], [300, 450]]\nevery = 3")
    expected, _ = study('frf = "some.csv"', frequency="from = 10\nto = 450")
    assert found["joint"] == expected["joint"]
    assert found["residual"]["lines"] == len(inside[::3])
    # no gap between bands is taken for a value that stands out
    assert "outliers" not in found["residual"]
    for frequency, said in [
        ("bands = [[10, 5]]", "ascending and apart"),
        ("every = 0", "`frequency.every`"),
        ("bands = [[600, 700]]", "no line from 600 to 700 Hz"),
    ]:
        _, done = study('frf = "all.csv"', frequency=frequency, expect=1)
        assert said in done.stderr, done.stderr
