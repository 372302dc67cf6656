"""The reference run that every FMU carries, done by FMPy."""

import re
import xml.etree.ElementTree as ElementTree
import zipfile

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv
from joints import LAPS
from reference import Joint, Lap

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"


class Run:
    """What the FMU says about its reference run."""

    def __init__(self, fmu, folder):
        self.fmu = fmu
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(folder)
            self.size = sum(entry.file_size for entry in archive.infolist() if entry.filename.startswith(FOLDER))
        self.folder = folder / FOLDER
        manifest = ElementTree.parse(self.folder / "fmi-ls-manifest.xml").getroot()
        self.related = {related.get("role"): related.get("source") for related in manifest.findall("Related")}
        namespace = "{http://fmi-standard.org/fmi-ls-manifest}"
        self.standard = manifest.get(namespace + "fmi-ls-name")
        experiment = ElementTree.parse(self.folder / self.related["experiment/validation"]).getroot().find("Experiment")
        self.stop, self.step = float(experiment.get("stopTime")), float(experiment.get("stepSize"))
        assert float(experiment.get("startTime")) == 0.0
        self.inputs = read_csv(self.folder / experiment.find("Stimuli").get("source"))
        self.outputs = read_csv(self.folder / experiment.find("References").get("source"))
        text = (folder / "documentation/fmi-ls-ref.txt").read_text(encoding="utf-8")
        self.tolerance = float(re.search(r"^Tolerance: (\S+)$", text, re.MULTILINE).group(1))

    def deviation(self, result):
        """Largest difference at the reference's times, as a fraction of each output's largest magnitude."""
        at = np.searchsorted(result["time"], self.outputs["time"] - 0.25 * self.step)
        assert np.abs(result["time"][at] - self.outputs["time"]).max() < 1e-9 * self.stop
        names = self.outputs.dtype.names[1:]
        return {
            name: np.abs(result[name][at] - self.outputs[name]).max() / np.abs(self.outputs[name]).max()
            for name in names
        }


@pytest.fixture
def reference(export, tmp_path):
    return lambda case, interface, *options: Run(export(LAPS[case], interface, *options), tmp_path)


@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("case", LAPS)
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_co_simulation_meets_the_reference(reference, case, interface, version):
    run = reference(case, interface, "--fmi", version)
    result = fmpy.simulate_fmu(
        str(run.fmu), fmi_type="CoSimulation", stop_time=run.stop, output_interval=run.step,
        input=run.inputs, output=run.outputs.dtype.names[1:],
    )
    deviation = run.deviation(result)
    assert max(deviation.values()) <= run.tolerance, deviation
    # A tolerance that means something: the sixth digit for the lap's own steps, the last ones for the element.
    assert run.tolerance <= (1e-4 if interface == "lap" else 1e-10)


@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("case", ["hardening-1", "softening-2"])
def test_model_exchange_meets_the_reference(reference, case, version):
    run = reference(case, "lap", "--fmi", version)
    result = fmpy.simulate_fmu(
        str(run.fmu), fmi_type="ModelExchange", solver="CVode", relative_tolerance=1e-10, stop_time=run.stop,
        output_interval=run.step, input=run.inputs, output=run.outputs.dtype.names[1:],
    )
    # At an event FMPy writes two rows; nothing jumps there.
    deviation = run.deviation(result)
    # CVode's error adds up over the run: it is not held to the FMU's own.
    assert max(deviation.values()) <= 1e-4, deviation


@pytest.mark.parametrize("case", LAPS)
def test_the_reference_is_the_solution_of_the_equations(reference, case):
    """DOP853 on equations written a second time, so that program and FMU are not only compared with each other."""
    run = reference(case, "lap")
    lap = Lap(LAPS[case])
    levels = run.inputs[::2]
    loads = np.column_stack([levels[name] for name in run.inputs.dtype.names[1:]])
    per_level = round(levels["time"][1] / run.step)
    states = lap.held(np.zeros(4 * lap.n), np.repeat(loads, per_level, axis=0), run.step)
    names = [name for name in run.outputs.dtype.names if name[:2] in ("a.", "b.")]
    order = sorted(names, key=lambda name: name[2:] in ("v", "omega"))
    for column, name in enumerate(order):
        reference = run.outputs[name]
        assert np.abs(states[:, column] - reference).max() <= 1e-8 * np.abs(reference).max(), name


@pytest.mark.parametrize("case", LAPS)
def test_the_references_of_the_element_are_its_law(reference, case):
    run = reference(case, "element")
    joint = Joint(LAPS[case])
    per_side = ["y", "theta"][: joint.n], ["v", "omega"][: joint.n]
    middle = run.inputs[::2]
    difference = [
        np.column_stack([middle[f"a.{name}"] - middle[f"b.{name}"] for name in names]) for names in per_side
    ]
    loads = np.array([joint.load_on_b(r, v) for r, v in zip(*difference)])
    for dof, name in enumerate(["joint.F", "joint.M"][: joint.n]):
        assert run.outputs[name] == pytest.approx(loads[:, dof], rel=1e-9, abs=1e-9 * np.abs(loads[:, dof]).max())


@pytest.mark.parametrize("case", LAPS)
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_every_input_moves_and_every_output_follows(reference, case, interface):
    run = reference(case, interface)
    assert run.standard == "org.fmi-standard.fmi-ls-ref"
    assert run.size <= 200_000
    assert run.outputs.dtype.names == tuple(["time"] + [
        v.name for v in fmpy.read_model_description(str(run.fmu)).modelVariables if v.causality == "output"
    ])
    for table in (run.inputs, run.outputs):
        values = np.column_stack([table[name] for name in table.dtype.names[1:]])
        assert (np.ptp(values, axis=0) > 0).all()
    # No input is a multiple of another: each has its own part in the run.
    values = np.column_stack([run.inputs[name] for name in run.inputs.dtype.names[1:]])
    assert np.linalg.matrix_rank(values / np.abs(values).max(axis=0), tol=1e-2) == values.shape[1]


@pytest.mark.parametrize("pair", [("linear-1", "hardening-1"), ("linear-1", "softening-1"),
                                  ("linear-2", "hardening-2"), ("linear-2", "softening-2")])
def test_the_run_opens_the_joint_far_enough_for_the_cubic_term(export, tmp_path, pair):
    """The run of the cubic joint, given to the linear one, must fail."""
    linear, cubic = (Run(export(LAPS[case], "lap"), tmp_path / case) for case in pair)
    result = fmpy.simulate_fmu(
        str(linear.fmu), stop_time=cubic.stop, output_interval=cubic.step, input=cubic.inputs,
        output=cubic.outputs.dtype.names[1:],
    )
    assert max(cubic.deviation(result).values()) > 100 * cubic.tolerance
