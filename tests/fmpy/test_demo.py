"""The main job on built-in data, as a user runs it, and what FMPy makes of its FMUs."""

import json
import re
import xml.etree.ElementTree as ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

PUBLISHED = {"stiffness": [[5.73e5, 5.82e3], [5.82e3, 1.29e3]], "damping": [[10.83, -0.83], [-0.83, 0.083]]}


@pytest.fixture(scope="module")
def demo(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    done = run("demo", "-o", folder / "out")
    return folder / "out", done.stdout


def test_it_says_that_the_assembly_is_synthesised(demo):
    assert "NOT measured" in demo[1] and "Table 5.3" in demo[1]


def test_the_published_joint_is_found_within_its_stated_uncertainty(demo):
    joint = json.loads((demo[0] / "m10x16.joint.json").read_text())
    for key in ("stiffness", "damping"):
        found = np.array(joint["joint"][key])
        deviation = np.array(joint["uncertainty"]["standard_deviation"][key])
        exact = np.array(PUBLISHED[key])
        assert (np.abs(found - exact) < 4 * deviation).all()
        assert (deviation < 0.02 * np.abs(exact)).all()
    assert joint["residual"]["relative_rms"] == pytest.approx(0.01, rel=0.05)
    assert {file["role"] for file in joint["provenance"]["inputs"]} == {"study", "substructure a", "assembly"}


def test_coupled_resonances(demo):
    line = next(line for line in demo[1].splitlines() if line.startswith("coupled resonances"))
    found = [float(number) for number in re.findall(r"\d+\.\d", line.split(":+Y:")[1].split("Hz")[0])]
    assert found == pytest.approx([18.35, 114.6, 342.8], abs=0.3)


def test_the_written_study_can_be_identified_again(demo, run, tmp_path):
    output = tmp_path / "again.joint.json"
    run("identify", demo[0] / "study.toml", "-o", output, "--figure", tmp_path / "again.svg")
    assert output.read_bytes() == (demo[0] / "m10x16.joint.json").read_bytes()
    ElementTree.parse(tmp_path / "again.svg")


@pytest.mark.parametrize("name", ["m10x16-element", "m10x16-lap", "pirdayr-ex03-lap"])
def test_the_fmus_are_valid_and_run(demo, name):
    fmu = demo[0] / f"{name}.fmu"
    assert validate_fmu(str(fmu)) == []
    result = fmpy.simulate_fmu(str(fmu), stop_time=5e-3, output_interval=1e-4)
    assert np.isfinite(np.array(result.tolist())).all()


def test_the_exported_lap_has_the_full_matrices(demo):
    joint = json.loads((demo[0] / "m10x16.joint.json").read_text())["joint"]
    description = fmpy.read_model_description(str(demo[0] / "m10x16-lap.fmu"))
    start = {v.name: v.start for v in description.modelVariables}
    assert float(start["joint.k_ytheta"]) == joint["stiffness"][0][1]
    assert float(start["joint.c_thetatheta"]) == joint["damping"][1][1]
