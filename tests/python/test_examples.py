"""The notebook and the ensemble run."""

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


def test_an_ensemble_on_two_workers_equals_one_after_the_other(demo):
    distributed = pytest.importorskip("dask.distributed")
    pytest.importorskip("fmpy")
    spec = importlib.util.spec_from_file_location("ensemble", EXAMPLES / "ensemble.py")
    ensemble = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(ensemble)
    joint = bolted_joint.Joint.read(demo / "m10x16.joint.json")
    draws = 4
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            client.upload_file(str(EXAMPLES / "ensemble.py"))
            motions = ensemble.ensemble(client, joint, draws)
    one_by_one = np.array([ensemble.response(joint, number) for number in range(draws)])
    np.testing.assert_array_equal(motions, one_by_one)
    # draws differ, by about what a deviation of 0.05 % of the stiffness lets expect
    spread = np.abs(motions).max(axis=1).std() / np.abs(motions).max()
    assert 1e-6 < spread < 1e-2
