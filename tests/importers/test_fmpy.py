"""FMPy's `simulate_fmu`, which drives FMUs as users of FMPy do, with an input file."""

import fmpy
import numpy as np
import pytest
import scenario
from fmpy.util import read_csv, write_csv
from instances import both_versions


@pytest.fixture(scope="module")
def input_file(tmp_path_factory):
    """A CSV file with the loads as steps: two rows at each jump, as FMPy reads discontinuities."""
    rows = []
    for index, load in enumerate(scenario.loads()):
        rows.append((index * scenario.STEP_S, *load))
        rows.append(((index + 1) * scenario.STEP_S, *load))
    table = np.array(rows, dtype=[(name, float) for name in ["time", *scenario.LOADS]])
    path = tmp_path_factory.mktemp("input") / "loads.csv"
    write_csv(str(path), table)
    return path


@both_versions
@pytest.mark.parametrize("interface_type", ["CoSimulation", "ModelExchange"])
def test_a_run_with_an_input_file_follows_the_reference(export, input_file, fmi, interface_type):
    fmu = export(scenario.FILE, "lap", fmi=fmi)
    result = fmpy.simulate_fmu(
        str(fmu),
        fmi_type=interface_type,
        input=read_csv(str(input_file)),
        start_values=scenario.START | {"a.m": scenario.MASS_KG},
        output=scenario.STATES,
        stop_time=scenario.STEPS * scenario.STEP_S,
        output_interval=scenario.STEP_S,
        relative_tolerance=1e-10,
        # CVode cannot step over jumps of the loads: FMPy ends its steps there
        set_stop_time=True,
    )
    times = np.arange(scenario.STEPS + 1) * scenario.STEP_S
    # at events Model Exchange reports a point twice: the last one is that after the event
    last = [np.flatnonzero(np.isclose(result["time"], time, rtol=0, atol=1e-9))[-1] for time in times]
    found = np.array([result[name][last] for name in scenario.STATES]).T
    scenario.assert_follows_the_reference(found)
