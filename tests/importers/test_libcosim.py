"""libcosim, the co-simulation engine of the Open Simulation Platform, through libcosimpy. It knows FMI 2.0 only."""

import json
import re
import subprocess
import sys

import pytest
import scenario

pytest.importorskip("libcosimpy", reason="libcosimpy is not installed: it has wheels for x86-64 Linux and Windows alone")

# In a process of its own: libcosim writes its log to the standard output, which is read below.
PROGRAM = """
import json, pathlib, sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

task = json.load(sys.stdin)
execution = CosimExecution.from_step_size(round(task["step_s"] * 1e9))
slave = execution.add_local_slave(CosimLocalSlave(task["fmu"], "lap"))
reference = {v.name.decode(): v.reference for v in execution.slave_variables(slave)}
observer = CosimObserver.create_last_value()
assert execution.add_observer(observer)
manipulator = CosimManipulator.create_override()
assert execution.add_manipulator(manipulator)
for name, value in task["start"].items():
    assert execution.real_initial_value(slave, reference[name], value)
states = [reference[name] for name in task["states"]]
loads = [reference[name] for name in task["inputs"]]
found = []
for load in task["loads"]:
    assert manipulator.slave_real_values(slave, loads, load)
    assert execution.step()
    found.append(list(observer.last_real_values(slave, states)))
pathlib.Path(task["result"]).write_text(json.dumps(found))
"""


@pytest.fixture(scope="module")
def done(export, tmp_path_factory):
    result = tmp_path_factory.mktemp("libcosim") / "states.json"
    task = {
        "result": str(result),
        "fmu": str(export(scenario.FILE, "lap", fmi="2")),
        "step_s": scenario.STEP_S,
        "start": scenario.START | {"a.m": scenario.MASS_KG},
        "states": scenario.STATES,
        "inputs": scenario.LOADS,
        "loads": scenario.loads().tolist(),
    }
    done = subprocess.run([sys.executable, "-c", PROGRAM], input=json.dumps(task), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(result.read_text()), done.stdout + done.stderr


def test_a_run_follows_the_reference(done):
    # libcosim reports the states after each step
    scenario.assert_follows_the_reference([list(scenario.START.values()), *done[0]])


def test_nothing_is_wrong_with_the_fmu(done):
    """The FMI Library inside libcosim says of `time` that it needs a start value, which FMI 2.0, 2.2.7, forbids."""
    assert "fmi2EnterInitializationMode: initialising at t = 0 s" in done[1], "the log is not where it was"
    errors = re.findall(r"\[(?:error|warning|fatal)\] +(.*)", done[1])
    assert set(errors) <= {
        "[FMI Library: FMI2XML] Start attribute is required for this causality, variability and initial combination"
    }
    assert len(errors) <= 2, errors
