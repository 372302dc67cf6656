"""Draws in parts, in this process and on a cluster: the same as at once, to the bit."""

import importlib.util
import pathlib
import pickle
import warnings

import numpy as np
import pytest

import bolted_joint

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples/python"
FOUR_BOLTS = ROOT / "tests/data/studies/four-bolts.toml"


def test_parts_of_a_bootstrap_are_the_whole(short, tmp_path):
    whole = bolted_joint.identify(short, bootstrap=12, seed=4)
    parts = [bolted_joint.draw(short, numbers, bootstrap=12, seed=4) for numbers in (range(7, 12), range(7))]
    assert parts[0].numbers == range(7, 12) and len(parts[1]) == 7
    assert parts[0].results == ("k_yy", "k_ytheta", "k_thetatheta", "c_yy", "c_ytheta", "c_thetatheta")
    draws = np.concatenate([parts[1].values, parts[0].values])
    scatter = whole.joint.data["uncertainty"]["bootstrap"]
    # NumPy's standard deviation and percentiles of the draws are those of the joint file
    np.testing.assert_allclose(
        draws.std(axis=0, ddof=1)[[0, 2]], np.diag(scatter["standard_deviation"]["stiffness"]), rtol=1e-9
    )
    parts[0].save(tmp_path / "part.json")
    assert pickle.loads(pickle.dumps(parts[1])).values.tobytes() == parts[1].values.tobytes()
    merged = bolted_joint.merge(short, [tmp_path / "part.json", parts[1]], report=True)
    assert merged.joint.data == whole.joint.data
    assert "12 draws of noise" in merged.report_html


def test_parts_of_a_prediction_are_the_whole():
    study = bolted_joint.Study.read(FOUR_BOLTS)
    study["contact"]["friction"] = "0.3 ± 0.05"
    study["uncertainty"] = {"draws": 300, "seed": 2}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole = bolted_joint.predict(study)
        merged = bolted_joint.merge(study, [bolted_joint.draw(study, own) for own in (range(100), range(100, 300))])
    assert merged.joint.data == whole.joint.data
    assert merged.details["uncertainty"] == whole.details["uncertainty"]


def test_draws_that_do_not_belong_together_are_refused(short):
    parts = [bolted_joint.draw(short, range(first, first + 2), bootstrap=6) for first in (0, 2)]
    with pytest.raises(bolted_joint.BoltedJointError, match=r"^found no file with the draws 4\.\.6"):
        bolted_joint.merge(short, parts)
    with pytest.raises(bolted_joint.BoltedJointError, match=r"the draws 0\.\.2, which"):
        bolted_joint.merge(short, [*parts, parts[0]])
    last = bolted_joint.draw(short, range(4, 6), bootstrap=6)
    short["frequency"]["from"] = 60
    with pytest.raises(bolted_joint.BoltedJointError, match=r"with the file study\.toml"):
        bolted_joint.merge(short, [*parts, last])
    with pytest.raises(bolted_joint.BoltedJointError, match="expected a range"):
        bolted_joint.draw(short, range(0, 6, 2), bootstrap=6)
    with pytest.raises(bolted_joint.BoltedJointError, match="bootstrap: found nothing, expected how many draws"):
        bolted_joint.draw(short, range(2))
    with pytest.raises(bolted_joint.BoltedJointError, match=r"bootstrap: found 4, .*uncertainty\.draws"):
        bolted_joint.draw(FOUR_BOLTS, range(2), bootstrap=4)
    with pytest.raises(bolted_joint.BoltedJointError, match="study: found one for respond, expected one for identify"):
        bolted_joint.draw({"method": "respond"}, range(2))


@pytest.mark.filterwarnings("ignore")
def test_two_workers_make_the_draws_of_one_machine(short):
    study = bolted_joint.Study.read(FOUR_BOLTS)
    study["contact"]["friction"] = "0.3 ± 0.05"
    study["uncertainty"] = {"draws": 20, "seed": 2}
    distributed = pytest.importorskip("dask.distributed")
    spec = importlib.util.spec_from_file_location("shards", EXAMPLES / "shards.py")
    shards = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(shards)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            client.upload_file(str(EXAMPLES / "shards.py"))
            found = shards.bootstrap(client, short, draws=10, parts=3, seed=9)
            predicted = shards.monte_carlo(client, study, parts=3)
            workers = len(client.scheduler_info()["workers"])
    assert workers == 2
    assert found.joint.data == bolted_joint.identify(short, bootstrap=10, seed=9).joint.data
    whole = bolted_joint.predict(study)
    assert predicted.joint.data == whole.joint.data
    assert predicted.details["uncertainty"] == whole.details["uncertainty"]
