"""The notebook and the ensemble of assemblies run."""

import importlib.util
import pathlib

import numpy as np
import pytest

import bolted_joint

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples/python"


def largest_relative_motion(joint, force_n, pulse_s, step_s):
    """Of two free bodies of 12.15 g and 0.9477 kg·mm² under a force on one: r̈ = −2 M⁻¹ (K r + C ṙ) − M⁻¹ f."""
    linalg = pytest.importorskip("scipy.linalg")
    inverse = np.diag([1.0 / 0.01215, 1.0 / 9.477e-7])
    system = np.zeros((5, 5))
    system[:2, 2:4] = np.eye(2)
    system[2:4, :2] = -2.0 * inverse @ joint.stiffness
    system[2:4, 2:4] = -2.0 * inverse @ joint.damping
    system[2:4, 4] = -inverse @ [force_n, 0.0]
    step = linalg.expm(system * step_s)
    state, largest = np.array([0.0, 0.0, 0.0, 0.0, 1.0]), 0.0
    for _ in range(round(pulse_s / step_s)):
        state = step @ state
        largest = max(largest, abs(state[0]))
    return largest


def test_the_notebook_runs_to_its_end(demo):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(EXAMPLES / "measurement-to-fmu.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=120).execute()
    last = float(notebook.cells[-1].outputs[-1]["data"]["text/plain"])
    # the largest motion is within the pulse
    joint = bolted_joint.Joint.read(demo / "m10x16.joint.json")
    assert last == pytest.approx(largest_relative_motion(joint, 10.0, 5e-4, 1e-5), rel=1e-9)
    identified = next(cell for cell in notebook.cells if "identify(study)" in cell.source)
    shown = identified.outputs[-1]["data"]["text/html"]
    assert "5.7" in shown and "theta, theta" in shown


def test_an_ensemble_of_assemblies_on_two_workers_equals_one_after_the_other(demo):
    distributed = pytest.importorskip("dask.distributed")
    pytest.importorskip("fmpy")
    spec = importlib.util.spec_from_file_location("ensemble", EXAMPLES / "ensemble.py")
    ensemble = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(ensemble)
    two_beams = EXAMPLES.parent / "two-beams/beams.toml"
    joint = demo / "m10x16.joint.json"
    assembly = ensemble.assembly_with(two_beams, {"lap": joint})
    assembly["response"]["duration"] = 0.01
    assembly["response"]["loads"]["push"]["until"] = 0.005
    draws = 4
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            client.upload_file(str(EXAMPLES / "ensemble.py"))
            time, motions = ensemble.ensemble(client, assembly, draws)
    assert motions.shape == (draws, 101) and time[-1] == pytest.approx(0.01)
    one_by_one = np.array([ensemble.response(assembly, number)[1] for number in range(draws)])
    np.testing.assert_array_equal(motions, one_by_one)
    # the FMU moves as the assembly file does; loads are straight between two rows there, here held for a tenth of them
    exact = bolted_joint.respond(ensemble.drawn(assembly, 3))
    np.testing.assert_allclose(motions[3], exact["tip"], atol=0.03 * np.abs(exact["tip"]).max())
    low, middle, high = ensemble.percentiles(motions)
    assert (low <= middle).all() and (middle <= high).all() and len(np.unique(motions[:, -1])) == draws
    np.testing.assert_array_equal(middle, np.median(motions, axis=0))
    # the stiffness is known to 0.05 %, and the beams are softer than the joint
    spread = (high - low).max() / np.abs(middle).max()
    assert 1e-8 < spread < 5e-4
    with pytest.raises(SystemExit, match="found no joint nut, expected one of lap"):
        ensemble.assembly_with(two_beams, {"nut": joint})
    with pytest.raises(SystemExit, match="found no joint with a covariance"):
        ensemble.assembly_with(two_beams, {})
