"""An assembly as a system of FMUs: SSP files in FMPy and in Ecos, beside the one FMU of the whole."""

import json
import sys
import zipfile
from xml.etree import ElementTree
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd, read_ssv
from lxml import etree

sys.path.append(str(Path(__file__).resolve().parents[1] / "assembly"))
import small  # noqa: E402

SSP = "http://ssp-standard.org/SSP1/"
SCHEMAS = Path(fmpy.__file__).parent / "ssp" / "schema"
LOAD_N = 10.0
STOP_S = 2e-3

DEVIATIONS = {
    "uncertainty": {
        "standard_deviation": {"stiffness": [[2e4, 0.0], [0.0, 100.0]], "damping": [[1.0, 0.0], [0.0, 0.01]]},
        "basis": "made for this test",
        "correlation": {
            "unknowns": ["k_yy", "k_thetatheta", "c_yy", "c_thetatheta"],
            "matrix": [[1, 0.8, -0.3, 0], [0.8, 1, 0, 0], [-0.3, 0, 1, 0.5], [0, 0, 0.5, 1]],
        },
    }
}
PLANE = {"stiffness": [[4e5, 0.0], [0.0, 1e3]], "damping": [[20.0, 0.0], [0.0, 0.1]], "dofs": ["y", "theta"]}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The small assembly with a hardening joint, as one FMU and as systems."""
    return tmp_path_factory.mktemp("ssp")


@pytest.fixture(scope="module")
def whole(folder, run):
    """Motion of the one FMU under a held load, over the times of a small step."""
    path = small.write(folder, {"cubic": [1e12]})
    run("export", path, "-o", folder / "small.fmu", "--fmi", "2")
    result = fmpy.simulate_fmu(
        str(folder / "small.fmu"), stop_time=STOP_S, output_interval=1e-5, start_values={"push.F": LOAD_N},
        fmi_type="CoSimulation",
    )
    return path, result


def system(run, path, name, *options):
    ssp = path.parent / name
    run("export", path, "-o", ssp, *options)
    return ssp


def off(times, found, result, name):
    expected = np.interp(times, result["time"], result[name])
    return np.abs(found - expected).max() / np.abs(expected).max()


def test_every_file_of_it_is_valid(run, whole):
    path, _ = whole
    for options in [(), ("--ssp-for", "ecos"), ("--fmi", "3")]:
        ssp = system(run, path, "valid.ssp", *options)
        with zipfile.ZipFile(ssp) as archive:
            names = archive.namelist()
            assert sorted(names) == sorted(
                ["SystemStructure.ssd", "resources/nominal.ssv"] + [f"resources/{own}.fmu" for own in ("a", "b", "lap")]
            )
            for name, schema in [
                ("SystemStructure.ssd", "SystemStructureDescription"),
                ("resources/nominal.ssv", "SystemStructureParameterValues"),
            ]:
                root = etree.fromstring(archive.read(name))
                etree.XMLSchema(etree.parse(SCHEMAS / f"{schema}.xsd")).assertValid(root)
        described = read_ssd(str(ssp))
        assert described.version == "1.0"
        with zipfile.ZipFile(ssp) as archive:
            archive.extractall(path.parent / "valid")
        for component in described.system.elements:
            fmu = str(path.parent / "valid" / component.source)
            assert fmpy.validation.validate_fmu(fmu) == []
            known = {variable.name: variable for variable in fmpy.read_model_description(fmu).modelVariables}
            for connector in component.connectors:
                assert known[connector.name].causality == connector.kind


def test_fmpy_runs_it_as_the_one_fmu(run, whole):
    path, result = whole
    ssp = system(run, path, "fmpy.ssp")
    errors = []
    for step in [4e-6, 2e-6]:
        rows = simulate_ssp(
            str(ssp), stop_time=STOP_S, step_size=step, input={"push.F": lambda time: LOAD_N},
            parameter_set=read_ssv(str(ssp), "resources/nominal.ssv"),
        )
        errors.append([off(rows["time"][:-1] + step, rows[f"{name}.y"][1:], result, f"{name}.y") for name in ("tip", "root")])
    # FMPy hands values over one step late: an error of the first order
    errors = np.array(errors)
    assert errors[-1].max() < 0.02
    assert np.abs(errors[0] / errors[1] - 2).max() < 0.1, errors


def test_ecos_runs_it_as_the_one_fmu(run, whole):
    ecospy = pytest.importorskip("ecospy", exc_type=(ImportError, OSError))
    path, result = whole
    ssp = system(run, path, "ecos.ssp", "--ssp-for", "ecos")
    found = []
    for step in [4e-6, 2e-6]:
        with ecospy.EcosSimulation(ssp_path=str(ssp), step_size=step) as simulation:
            simulation.set_real("b::push.F", LOAD_N)
            assert simulation.init(parameter_set="nominal")
            rows = []
            for _ in range(round(STOP_S / step)):
                simulation.step()
                rows.append([simulation.get_real("b::tip.y"), simulation.get_real("a::root.y")])
            simulation.terminate()
        rows = np.array(rows)
        times = step * np.arange(1, len(rows) + 1)
        found.append([off(times, rows[:, column], result, name) for column, name in [(0, "tip.y"), (1, "root.y")]])
    found = np.array(found)
    assert found[-1].max() < 0.02
    assert np.abs(found[0] / found[1] - 2).max() < 0.1, found


def over_preload(folder, preload=""):
    """The small assembly with a joint that softens as its bolt loosens, and the FMU of the whole."""
    path = small.write(folder, {})
    table = {
        "preload": [4.0, 8.0, 12.0], "nominal": 12.0, "stiffness": [[[1e5]], [[2e5]], [[4e5]]], "damping": [[[20.0]]] * 3,
    }
    file = {"format": "bolted-joint/1", "name": "lap", "joint": {"dofs": ["y"], "over_preload": table}}
    (folder / "lap.joint.json").write_text(json.dumps(file))
    path.write_text(path.read_text().replace('file = "lap.joint.json"', f'file = "lap.joint.json"\n{preload}'))
    return path


def test_fmpy_starts_at_the_preload_of_a_parameter_set(run, tmp_path):
    path = over_preload(tmp_path)
    run("export", path, "-o", tmp_path / "small.fmu", "--fmi", "2")
    ssp = system(run, path, "moving.ssp")
    assert run("check", ssp).returncode == 0
    nominal = read_ssv(str(ssp), "resources/nominal.ssv")
    (preload,) = [own for own in nominal.parameters if own.name == "lap.preload"]
    assert float(preload.value) == 12.0
    for preload_n_m in (12.0, 6.0):
        preload.value = preload_n_m
        result = fmpy.simulate_fmu(
            str(tmp_path / "small.fmu"), stop_time=STOP_S, output_interval=1e-5, fmi_type="CoSimulation",
            start_values={"push.F": LOAD_N, "lap.preload": preload_n_m},
        )
        errors = []
        for step in [4e-6, 2e-6]:
            rows = simulate_ssp(
                str(ssp), stop_time=STOP_S, step_size=step, input={"push.F": lambda time: LOAD_N}, parameter_set=nominal
            )
            errors.append(off(rows["time"][:-1] + step, rows["tip.y"][1:], result, "tip.y"))
        assert errors[1] < 0.02 and abs(errors[0] / errors[1] - 2) < 0.1, (preload_n_m, errors)


def test_ecos_moves_a_preload_as_in_the_one_fmu(run, tmp_path):
    ecospy = pytest.importorskip("ecospy", exc_type=(ImportError, OSError))
    path = over_preload(tmp_path)
    loosening = lambda time: 12.0 - 6.0 * time / STOP_S  # noqa: E731
    run("export", path, "-o", tmp_path / "small.fmu", "--fmi", "2")
    times = np.linspace(0, STOP_S, 2001)
    course = [(time, LOAD_N, loosening(time)) for time in times]
    result = fmpy.simulate_fmu(
        str(tmp_path / "small.fmu"), stop_time=STOP_S, output_interval=times[1], fmi_type="CoSimulation",
        input=np.array(course, dtype=[("time", float), ("push.F", float), ("lap.preload", float)]),
    )
    stays = fmpy.simulate_fmu(
        str(tmp_path / "small.fmu"), stop_time=STOP_S, output_interval=times[1], start_values={"push.F": LOAD_N},
        fmi_type="CoSimulation",
    )
    assert off(stays["time"], stays["tip.y"], result, "tip.y") > 0.1
    ssp = system(run, path, "ecos.ssp", "--ssp-for", "ecos")
    errors = []
    for step in [4e-6, 2e-6]:
        with ecospy.EcosSimulation(ssp_path=str(ssp), step_size=step) as simulation:
            simulation.set_real("b::push.F", LOAD_N)
            assert simulation.init(parameter_set="nominal")
            rows = []
            for count in range(round(STOP_S / step)):
                simulation.set_real("lap::preload", loosening(step * count))
                simulation.step()
                rows.append(simulation.get_real("b::tip.y"))
            simulation.terminate()
        errors.append(off(step * np.arange(1, len(rows) + 1), np.array(rows), result, "tip.y"))
    assert errors[1] < 0.02 and abs(errors[0] / errors[1] - 2) < 0.1, errors


def test_at_one_preload_there_are_parameters_instead(run, tmp_path):
    at_one = values(system(run, over_preload(tmp_path, "preload = 8.0"), "one.ssp"), "nominal")
    assert at_one["lap.joint.k_yy"] == 2e5 and "lap.preload" not in at_one
    done = run("export", over_preload(tmp_path), "-o", tmp_path / "moving.ssp", "--extrapolate")
    assert "joint lap: its FMU follows the preload, the input `preload`, which starts with 12 N·m" in done.stderr
    assert values(tmp_path / "moving.ssp", "nominal") == {"lap.preload": 12.0}
    done = run("export", tmp_path / "small.toml", "-o", tmp_path / "x.ssp", "--extrapolate", "--draws", 3, expect=1)
    assert "--extrapolate" in done.stderr and "at one preload each" in done.stderr
    over_preload(tmp_path, "preload = 8.0")
    done = run("export", tmp_path / "small.toml", "-o", tmp_path / "x.ssp", "--extrapolate", expect=1)
    assert "leave --extrapolate out" in done.stderr


def values(ssp, name):
    return {own.name: float(own.value) for own in read_ssv(str(ssp), f"resources/{name}.ssv").parameters}


def all_draws(ssp):
    """The values of all draws, in their order; FMPy's reader would open the archive and the schema for each."""
    with zipfile.ZipFile(ssp) as archive:
        names = sorted(name for name in archive.namelist() if name.startswith("resources/draw-"))
        roots = [ElementTree.fromstring(archive.read(name)) for name in names]
    parameters = [[own for own in root.iter() if own.tag.endswith("}Parameter")] for root in roots]
    return [{own.get("name"): float(own[0].get("value")) for own in of_set} for of_set in parameters]


def uncertain(folder):
    """Two beams with a joint whose file has deviations and correlations."""
    lap = {"format": "bolted-joint/1", "name": "lap", "joint": PLANE, **DEVIATIONS}
    (folder / "lap.joint.json").write_text(json.dumps(lap))
    beam = "{ length = 0.3, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = \"free-free\" }"
    path = folder / "beams.toml"
    path.write_text(
        f"""name = "beams"
[structures.left]
beam = {beam}
points = {{ "1:+Y" = 0.3, "1:+RZ" = 0.3 }}
modes = 4
[structures.right]
beam = {beam}
points = {{ "1:+Y" = 0.0, "1:+RZ" = 0.0, "2:+Y" = 0.3 }}
modes = 4
[[joints]]
name = "lap"
file = "lap.joint.json"
a = {{ structure = "left", y = "1:+Y", theta = "1:+RZ" }}
b = {{ structure = "right", y = "1:+Y", theta = "1:+RZ" }}
[inputs]
push = "right/2:+Y"
[outputs]
tip = "right/2:+Y"
"""
    )
    return path


@pytest.mark.long
def test_draws_have_the_deviations_and_correlations_of_the_file(run, tmp_path):
    ssp = system(run, uncertain(tmp_path), "drawn.ssp", "--draws", 2000, "--seed", 3)
    names = ["lap.joint.k_yy", "lap.joint.k_thetatheta", "lap.joint.c_yy", "lap.joint.c_thetatheta"]
    sets = all_draws(ssp)
    assert len(sets) == 2000 and sets[1234] == values(ssp, "draw-1235")
    assert all(set(own) == set(names) for own in sets)
    drawn = np.array([[own[name] for name in names] for own in sets])
    nominal = values(ssp, "nominal")
    mean = np.array([nominal[name] for name in names])
    assert list(mean) == [4e5, 1e3, 20.0, 0.1]
    sizes = np.array([2e4, 100.0, 1.0, 0.01])
    # of 2000 draws a mean has 1/√2000 of a deviation, a deviation 1/√4000 of itself; four times that
    assert np.abs((drawn.mean(axis=0) - mean) / sizes).max() < 4 / np.sqrt(2000)
    assert np.abs(drawn.std(axis=0) / sizes - 1).max() < 4 / np.sqrt(4000)
    stated = np.array(DEVIATIONS["uncertainty"]["correlation"]["matrix"])
    assert np.abs(np.corrcoef(drawn.T) - stated).max() < 4 / np.sqrt(2000)


def test_a_seed_gives_the_same_draws_however_many(run, tmp_path):
    path = uncertain(tmp_path)
    few = system(run, path, "few.ssp", "--draws", 9, "--seed", 5)
    fewer = system(run, path, "fewer.ssp", "--draws", 3, "--seed", 5)
    other = system(run, path, "other.ssp", "--draws", 3, "--seed", 6)
    for number in range(1, 4):
        assert values(few, f"draw-{number}") == values(fewer, f"draw-{number}")
        assert values(few, f"draw-{number}") != values(other, f"draw-{number}")


def test_a_draw_is_the_fmu_of_that_joint(run, tmp_path):
    """In both tools the set reaches the element: its load is that of the drawn stiffness."""
    ecospy = pytest.importorskip("ecospy", exc_type=(ImportError, OSError))
    path = uncertain(tmp_path)
    ssp = system(run, path, "drawn.ssp", "--draws", 3)
    drawn = values(ssp, "draw-2")
    rows = simulate_ssp(
        str(ssp), stop_time=1e-5, step_size=1e-6, input={"push.F": lambda time: 100.0},
        parameter_set=read_ssv(str(ssp), "resources/draw-2.ssv"),
    )
    last = {name.split(".", 1)[1] if name.startswith("lap.") else name: rows[name] for name in rows.dtype.names}
    # the element answers at once to what it was given at the beginning of the step
    def load(motion):
        relative = [motion[f"a.{own}"] - motion[f"b.{own}"] for own in ("y", "v")]
        return drawn["lap.joint.k_yy"] * relative[0] + drawn["lap.joint.c_yy"] * relative[1]

    before = {name: last[name][-2] for name in ("a.y", "b.y", "a.v", "b.v")}
    assert last["b.F"][-1] == pytest.approx(load(before), rel=1e-9)
    assert load(before) != 0
    ecos = system(run, path, "ecos.ssp", "--draws", 3, "--ssp-for", "ecos")
    with ecospy.EcosSimulation(ssp_path=str(ecos), step_size=1e-6) as simulation:
        assert simulation.init(parameter_set="draw-2")
        for name, value in drawn.items():
            assert simulation.get_real(name.replace("lap.", "lap::", 1)) == value
        simulation.terminate()


@pytest.mark.parametrize(
    "change, message",
    [
        (("[structures.left]", "[structures.lap]"), "`joints: name = \"lap\"`: found the name of the structure lap again"),
        (("push =", "lap_b ="), "`inputs.lap_b`: found the name of the point at which the joint lap takes hold of structure right"),
        (("structures.left]", "structures.\"left one\"]"), "`structures.left one`: found \"left one\", expected a word"),
    ],
)
def test_what_cannot_be_told_apart_is_refused(run, tmp_path, change, message):
    path = uncertain(tmp_path)
    text = path.read_text()
    assert change[0] in text
    name = change[1].split("structures.")[-1].strip('[]"') if "structures" in change[1] else "left"
    path.write_text(text.replace(*change).replace('structure = "left"', f'structure = "{name}"'))
    done = run("export", path, "-o", tmp_path / "x.ssp", expect=1)
    assert message in done.stderr, done.stderr
    assert not (tmp_path / "x.ssp").exists()


def test_options_of_systems_are_refused_elsewhere(run, whole):
    path, _ = whole
    folder = path.parent
    for file, output in [(path, "x.fmu"), (folder / "lap.joint.json", "y.fmu")]:
        done = run("export", file, "-o", folder / output, "--draws", 3, expect=1)
        assert "--draws" in done.stderr
    done = run("export", path, "-o", folder / "x.ssp", "--draws", 3, expect=1)
    assert "found no standard deviation above zero" in done.stderr
    done = run("export", path, "-o", folder / "x.ssp", "--seed", 3, expect=1)
    assert "--seed" in done.stderr
