"""Ecos, a co-simulation engine in C++, through its Python package ecospy."""

import zipfile

import numpy as np
import pytest
import scenario
from instances import both_versions
from joints import LAPS, joint
from reference import Lap

try:
    import ecospy
except ImportError as error:
    pytest.skip(f"ecospy is not installed: {error}", allow_module_level=True)
except OSError as error:
    # its library is linked against Intel's TBB, which no package on PyPI brings in a place where it looks
    pytest.skip(f"ecospy does not load ({error}); on Debian and Ubuntu: apt-get install libtbb12", allow_module_level=True)


@both_versions
def test_a_run_follows_the_reference(export, fmi):
    fmu = export(scenario.FILE, "lap", fmi=fmi)
    with ecospy.EcosSimulationStructure() as structure:
        structure.add_model("lap", str(fmu))
        start = scenario.START | {"a.m": scenario.MASS_KG}
        structure.add_parameter_set("start", {f"lap::{name}": value for name, value in start.items()})
        with ecospy.EcosSimulation(structure=structure, step_size=scenario.STEP_S) as simulation:
            assert simulation.init(parameter_set="start")

            def states():
                return [simulation.get_real(f"lap::{name}") for name in scenario.STATES]

            found = [states()]
            for load in scenario.loads():
                for name, value in zip(scenario.LOADS, load):
                    simulation.set_real(f"lap::{name}", value)
                simulation.step()
                found.append(states())
            simulation.terminate()
    scenario.assert_follows_the_reference(found)


# A lap whose body b hangs on a wall by a second joint, an element: N/m, N.s/m.
WALL_STIFFNESS, WALL_DAMPING = 2e5, 20.0
CONNECTIONS = [
    ("lap", "b.y", "wall", "a.y"),
    ("lap", "b.v", "wall", "a.v"),
    ("wall", "a.F", "lap", "b.F"),
]


def system(folder, export, fmi):
    """The two FMUs and their wiring as an SSP file."""
    wall = joint(["y"], [[WALL_STIFFNESS]], [[WALL_DAMPING]], [0.0])
    fmus = {"lap": export(LAPS["linear-1"], "lap", fmi=fmi), "wall": export(wall, "element", fmi=fmi)}
    components = "".join(
        f"""
      <ssd:Component name="{name}" type="application/x-fmu-sharedlibrary" source="resources/{name}.fmu">
        <ssd:Connectors>{"".join(
            f'<ssd:Connector name="{variable}" kind="{kind}"><ssc:Real/></ssd:Connector>'
            for variable, kind in sorted(connectors(name))
        )}</ssd:Connectors>
      </ssd:Component>"""
        for name in fmus
    )
    connections = "".join(
        f"""
      <ssd:Connection startElement="{a}" startConnector="{x}" endElement="{b}" endConnector="{y}"/>"""
        for a, x, b, y in CONNECTIONS
    )
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<ssd:SystemStructureDescription xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription"
  xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon" version="1.0" name="lap on a wall">
  <ssd:System name="system">
    <ssd:Elements>{components}
    </ssd:Elements>
    <ssd:Connections>{connections}
    </ssd:Connections>
  </ssd:System>
  <ssd:DefaultExperiment startTime="0" stopTime="0.02"/>
</ssd:SystemStructureDescription>
"""
    path = folder / "system.ssp"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", text)
        for name, fmu in fmus.items():
            archive.write(fmu, f"resources/{name}.fmu")
    return path


def connectors(component):
    found = set()
    for a, x, b, y in CONNECTIONS:
        if a == component:
            found.add((x, "output"))
        if b == component:
            found.add((y, "input"))
    return found


def expected_of_the_system(steps, step_s, load_n):
    """DOP853 for the lap; Ecos hands outputs over between steps, so that the wall's load is one step old."""
    lap = Lap(LAPS["linear-1"])
    state = np.zeros(4)
    wall_n = [0.0, 0.0]
    states = [state]
    for _ in range(steps):
        state = lap.held(state, [[load_n, wall_n[0]]], step_s)[-1]
        states.append(state)
        wall_n = [wall_n[1], -WALL_STIFFNESS * state[1] - WALL_DAMPING * state[3]]
    return np.array(states)


@both_versions
def test_a_system_of_two_fmus_follows_the_reference(tmp_path, export, fmi):
    step_s, steps, load_n = 1e-4, 200, 100.0
    path = system(tmp_path, export, fmi)
    with ecospy.EcosSimulation(ssp_path=str(path), step_size=step_s) as simulation:
        simulation.set_real("lap::a.F", load_n)
        assert simulation.init()

        def states():
            return [simulation.get_real(f"lap::{name}") for name in ("a.y", "b.y", "a.v", "b.v")]

        found = [states()]
        for _ in range(steps):
            simulation.set_real("lap::a.F", load_n)
            simulation.step()
            found.append(states())
        simulation.terminate()
    found = np.array(found)
    expected = expected_of_the_system(steps, step_s, load_n)
    error = np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert error.max() < 1e-6, error
    # the wall matters
    alone = Lap(LAPS["linear-1"]).held(np.zeros(4), [[load_n, 0.0]] * steps, step_s)
    assert np.abs(alone - expected).max() > 0.05 * np.abs(expected).max()
