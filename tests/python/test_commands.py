"""The module does what the command line does, to the bit and in the same words."""

import json
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import bolted_joint

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"


def without_origin(data):
    """A joint file without the files that it was made from."""
    return {key: value for key, value in data.items() if key != "provenance"}


@pytest.mark.parametrize(
    ("study", "places"),
    [("tol-m10x16/study.toml", [""]), ("pirdayr-update/with-a-mass.toml", [".2Nm", ".4Nm", ".6Nm", ".8Nm"])],
    ids=["functions", "frequencies"],
)
@pytest.mark.filterwarnings("ignore:kN cannot be identified")
def test_identify_writes_what_the_command_line_writes(run, tmp_path, study, places):
    path = EXAMPLES / study
    run("identify", path, "-o", tmp_path / "name.joint.json")
    found = bolted_joint.identify(path)
    assert list(found.joints) == [place.strip(".") for place in places]
    for place, joint in zip(places, found.joints.values(), strict=True):
        assert joint.data == json.loads((tmp_path / f"name{place}.joint.json").read_text(encoding="utf-8"))


def test_arrays_give_the_same_bits_as_files(demo):
    of_file = bolted_joint.identify(demo / "study.toml")
    study = bolted_joint.Study.read(demo / "study.toml")
    study["assembly"]["frf"] = bolted_joint.read(demo / "assembly.uff")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # the published test has its rotation by differences, whatever gives its functions
        warnings.filterwarnings("ignore", "the rotation of A is a central difference")
        of_arrays = bolted_joint.identify(study)
    assert without_origin(of_arrays.joint.data) == without_origin(of_file.joint.data)
    inputs = of_arrays.joint.data["provenance"]["inputs"]
    assert [entry["file"] for entry in inputs if entry["role"] == "assembly"] == ["assembly.npz"]


def test_the_joint_has_the_numbers_of_its_file(demo):
    joint = bolted_joint.identify(demo / "study.toml").joint
    data = json.loads((demo / "m10x16.joint.json").read_text(encoding="utf-8"))
    assert joint.dofs == ("y", "theta")
    np.testing.assert_array_equal(joint.stiffness, data["joint"]["stiffness"])
    np.testing.assert_array_equal(joint.damping, data["joint"]["damping"])
    deviations = data["uncertainty"]["standard_deviation"]
    np.testing.assert_array_equal(joint.stiffness_deviation, deviations["stiffness"])
    # k_yy, k_ytheta, k_thetatheta, c_yy, c_ytheta, c_thetatheta
    sizes = [deviations[matrix][row][column] for matrix in ("stiffness", "damping") for row, column in ((0, 0), (0, 1), (1, 1))]
    np.testing.assert_allclose(np.sqrt(np.diag(joint.covariance)), sizes, rtol=1e-14)
    np.testing.assert_allclose(
        joint.covariance[0, 1] / (sizes[0] * sizes[1]), data["uncertainty"]["correlation"]["matrix"][0][1], rtol=1e-14
    )


def test_draws_of_a_joint_scatter_as_its_covariance_says(demo):
    joint = bolted_joint.Joint.read(demo / "m10x16.joint.json")
    rng = np.random.default_rng(7)
    drawn = np.array([draw.stiffness for draw in (joint.draw(rng) for _ in range(2000))])
    assert np.array_equal(drawn[:, 0, 1], drawn[:, 1, 0])
    found = np.cov(np.stack([drawn[:, 0, 0], drawn[:, 0, 1], drawn[:, 1, 1]]))
    stated = joint.covariance[:3, :3]
    scale = np.sqrt(np.outer(np.diag(stated), np.diag(stated)))
    # a covariance of 2000 draws has a relative deviation of at most √(2/2000) = 3.2 %
    np.testing.assert_allclose(found / scale, stated / scale, atol=4 * np.sqrt(2 / 2000))


def test_respond_gives_the_functions_of_the_command_line(run, demo, tmp_path):
    joint = bolted_joint.Joint.read(demo / "m10x16.joint.json")
    responses = bolted_joint.respond(demo / "study.toml", joint, step_hz=2.0)
    output = tmp_path / "responses.csv"
    run("respond", demo / "study.toml", "--joint", demo / "m10x16.joint.json", "--step", "2", "-o", output)
    table = np.genfromtxt(output, delimiter=",", skip_header=1)
    np.testing.assert_array_equal(responses.frequency_hz, table[:, 0])
    np.testing.assert_array_equal(responses["11:+Y", "12:+Y"], table[:, 3] + 1j * table[:, 4])


@pytest.mark.filterwarnings("ignore:the polynomial pressure")
def test_predict_export_and_check(run, tmp_path):
    study = EXAMPLES / "kavi-layered-beam/study.toml"
    output = tmp_path / "predicted.joint.json"
    run("predict", study, "-o", output)
    predicted = bolted_joint.predict(study)
    assert predicted.joint.data == json.loads(output.read_text(encoding="utf-8"))
    joint = bolted_joint.Joint.read(EXAMPLES / "pirdayr-ex03/pirdayr-ex03.joint.json")
    fmu = bolted_joint.export(joint, tmp_path / "lap.fmu", interface="lap", fmi=2)
    checked = bolted_joint.check(fmu)
    assert checked.sound and checked.details["run"] is not None


def test_a_mistake_is_an_exception_with_the_words_of_the_command_line(run, demo, tmp_path):
    study = tmp_path / "study.toml"
    text = (demo / "study.toml").read_text(encoding="utf-8").replace("to = 512", "to = 1")
    for name in ("a-modes.toml", "assembly.uff"):
        (tmp_path / name).write_bytes((demo / name).read_bytes())
    study.write_text(text, encoding="utf-8")
    with pytest.raises(bolted_joint.BoltedJointError) as error:
        bolted_joint.identify(study)
    of_command_line = run("identify", study, "-o", tmp_path / "x.joint.json", expect=1)
    assert f"error: {error.value}" == of_command_line.stderr.strip()
    with pytest.raises(bolted_joint.BoltedJointError) as error:
        bolted_joint.identify(tmp_path / "nowhere.toml")
    of_command_line = run("identify", tmp_path / "nowhere.toml", "-o", tmp_path / "x.joint.json", expect=1)
    assert f"error: {error.value}" == of_command_line.stderr.strip()


def test_a_mistake_in_a_dictionary_names_no_file_that_nobody_knows(short):
    short["joint"]["model"] = "ful"
    with pytest.raises(bolted_joint.BoltedJointError, match=r"^study\.toml: .*\n(.*\n)*.*ful"):
        bolted_joint.identify(short)
    with pytest.raises(bolted_joint.BoltedJointError, match="null|None|unit"):
        bolted_joint.identify({"method": None})


@pytest.mark.filterwarnings("ignore:what the joint leaves")
def test_a_result_that_is_not_to_be_relied_on_says_so(demo):
    study = bolted_joint.Study.read(demo / "study.toml")
    study["b"]["beam"]["length"] = 0.30
    study["b"]["beam"]["density"] = 1350
    with pytest.warns(bolted_joint.NotUsableWarning):
        found = bolted_joint.identify(study)
    assert not found.usable and found.reasons_against and not found.joint.usable


class PanicException(BaseException):
    """As the compiled part raises it in the thread of the call."""


@pytest.mark.parametrize("kind", [RuntimeError, PanicException])
def test_a_mistake_of_the_modules_own_is_its_exception(demo, monkeypatch, kind):
    def broken(*_):
        raise kind("out of bounds")

    names = ("call", "read_functions", "to_json", "to_toml", "command_of")
    for name in names:
        monkeypatch.setattr(bolted_joint._native, name, broken)
    calls = (
        lambda: bolted_joint.identify(demo / "study.toml"),
        lambda: bolted_joint.read(demo / "assembly.uff"),
        lambda: bolted_joint.Study.parse("x = 1"),
        lambda: bolted_joint.identify({"x": 1}),
        lambda: bolted_joint.draw(demo / "study.toml", range(2), bootstrap=2),
    )
    for call in calls:
        with pytest.raises(bolted_joint.BoltedJointError, match="internal error: out of bounds; please report") as told:
            call()
        assert isinstance(told.value.__context__, kind) or isinstance(told.value.__cause__.__cause__, kind)


def test_other_threads_run_meanwhile(demo):
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    bolted_joint.identify(demo / "study.toml")
    during = counted[0] - before
    done.set()
    thread.join()
    assert during > 10


def work_and_tell(queue, study):
    queue.put(bolted_joint.identify(study).usable)


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
@pytest.mark.filterwarnings("ignore:.*fork")
def test_processes_of_all_kinds_compute_after_their_parent(demo, method):
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip("no such processes here")
    bolted_joint.identify(demo / "study.toml")
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    child = context.Process(target=work_and_tell, args=(queue, demo / "study.toml"))
    child.start()
    try:
        told = queue.get(timeout=60)
    finally:
        child.kill()
        child.join()
    assert told is True


def interrupted(script, timeout):
    """What a script prints that says that it has begun, and then gets Ctrl-C."""
    # what runs in the background of a shell ignores the signal, and its children do
    child = subprocess.Popen(
        [sys.executable, "-c", script],
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    try:
        assert child.stdout.readline() == "begun\n"
        time.sleep(1.0)
        child.send_signal(2)
        return child.communicate(timeout=timeout)[0]
    finally:
        child.kill()


@pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is a signal where there are signals")
def test_control_c_ends_a_long_call_at_once(demo):
    script = (
        "import bolted_joint\n"
        "print('begun', flush=True)\n"
        "try:\n"
        f"    bolted_joint.identify({str(demo / 'study.toml')!r}, bootstrap=1_000_000)\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted', flush=True)\n"
    )
    assert interrupted(script, 20) == "interrupted\n"


@pytest.mark.skipif(not pathlib.Path("/proc/self/task").exists(), reason="threads are counted in /proc")
def test_work_that_is_given_up_ends(demo):
    script = (
        "import bolted_joint, os, time\n"
        "threads = lambda: len(os.listdir('/proc/self/task'))\n"
        "before = threads()\n"
        "print('begun', flush=True)\n"
        "try:\n"
        f"    bolted_joint.identify({str(demo / 'study.toml')!r}, bootstrap=1_000_000)\n"
        "except KeyboardInterrupt:\n"
        "    during, end = threads(), time.monotonic() + 20\n"
        "    while threads() > before and time.monotonic() < end:\n"
        "        time.sleep(0.01)\n"
        "    print(during > before, threads() - before, flush=True)\n"
    )
    assert interrupted(script, 40) == "True 0\n"


@pytest.mark.skipif(not pathlib.Path("/proc/self/statm").exists(), reason="memory is read from /proc")
def test_a_thousand_identifications_leak_nothing(short):
    def resident_bytes():
        pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    for _ in range(100):
        bolted_joint.identify(short)
    before = resident_bytes()
    for _ in range(1000):
        bolted_joint.identify(short)
    # a kilobyte each would be a megabyte
    assert resident_bytes() - before < 4e6
