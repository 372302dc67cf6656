"""The wheel alone: an environment with nothing but it and what it asks for; then beside other packages."""

import os
import pathlib
import subprocess
import sys
import sysconfig
import venv

import pytest

NOTEBOOK = pathlib.Path(__file__).resolve().parents[2] / "examples/python/measurement-to-fmu.ipynb"
WHEEL = os.environ.get("BOLTED_JOINT_WHEEL")

ALONE = """
import sys, bolted_joint
study = bolted_joint.Study.read("demo/study.toml")
study["assembly"]["frf"] = bolted_joint.read("demo/assembly.uff")
found = bolted_joint.identify(study, report=True)
assert "<svg" in found.report_html
look = bolted_joint.show(found.joint, page=True)
assert "<svg" in look.page_html and "stiffness" in repr(look)
fmu = bolted_joint.export(found.joint, "joint.fmu", interface="lap")
assert bolted_joint.check(fmu).sound
assert "lap" in repr(bolted_joint.show(fmu))
assert not any(name.split(".")[0] in ("matplotlib", "fmpy", "dask") for name in sys.modules)
print("done")
"""

IN_FMPY = """
import bolted_joint, fmpy, numpy as np
joint = bolted_joint.Joint.read("demo/m10x16.joint.json")
# a force of 10 N on body b of two free ones of 12.15 g, which the joint holds together
force = np.array([(0.0, 10.0), (1e-3, 10.0)], dtype=[("time", float), ("b.F", float)])
result = fmpy.simulate_fmu("joint.fmu", stop_time=1e-3, output_interval=1e-5, input=force, output=["a.v", "b.v"])
momentum = 0.01215 * (result["a.v"][-1] + result["b.v"][-1])
assert abs(momentum / (10.0 * 1e-3) - 1.0) < 1e-9, momentum
print(bolted_joint.__file__)
"""

IN_A_NOTEBOOK = """
import sys, nbclient, nbformat
notebook = nbformat.read(sys.argv[1], as_version=4)
where = nbformat.v4.new_code_cell("import bolted_joint; print(bolted_joint.__file__)")
notebook.cells.append(where)
nbclient.NotebookClient(notebook, timeout=120).execute()
print(notebook.cells[-1].outputs[-1]["text"])
"""


class Environment:
    """A virtual environment with the wheel, and a folder to work in."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = folder / "environment"
        venv.create(self.environment, with_pip=True)
        self.programs = self.environment / ("Scripts" if sys.platform == "win32" else "bin")
        subprocess.run([self.programs / "python", "-m", "pip", "install", "--quiet", WHEEL], check=True)
        self.variables = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        self.variables |= {"PATH": str(self.programs), "MPLBACKEND": "Agg"}

    def run(self, *arguments, check=True):
        """Runs one of its programs."""
        program, *rest = arguments
        options = {"cwd": self.folder, "env": self.variables, "capture_output": True, "text": True}
        return subprocess.run([self.programs / program, *rest], check=check, **options)

    def borrow(self, package):
        """Lets it have the packages of the environment that runs the tests, after its own; nothing is downloaded."""
        pytest.importorskip(package)
        prefix = str(self.environment)
        own = sysconfig.get_path("purelib", vars={"base": prefix, "platbase": prefix})
        lent = {sysconfig.get_path(kind) for kind in ("purelib", "platlib")}
        pathlib.Path(own, "borrowed.pth").write_text("\n".join(sorted(lent)) + "\n", encoding="utf-8")


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    if WHEEL is None:
        pytest.skip("no wheel was built: run ./test")
    made = Environment(tmp_path_factory.mktemp("clean"))
    made.run("bolted-joint", "demo", "-o", "demo")
    # before anything is borrowed
    made.printed = made.run("python", "-c", ALONE).stdout
    return made


def test_from_file_to_fmu_without_anything_else(environment):
    assert environment.printed == "done\n"
    wrong = environment.run("bolted-joint", "check", "nowhere.fmu", check=False)
    assert wrong.returncode == 1 and "nowhere.fmu: cannot be read" in wrong.stderr
    shown = environment.run("bolted-joint", "show", "demo/m10x16.joint.json", "joint.fmu").stdout
    assert "stiffness" in shown and "joint.fmu" in shown
    assert pathlib.Path(WHEEL).stat().st_size < 50e6


def test_its_fmu_runs_in_fmpy(environment):
    environment.borrow("fmpy")
    printed = environment.run("python", "-c", IN_FMPY).stdout
    assert str(environment.environment) in printed


def test_the_notebook_runs_beside_it(environment):
    for package in ("nbclient", "nbformat", "ipykernel", "matplotlib", "fmpy"):
        environment.borrow(package)
    printed = environment.run("python", "-c", IN_A_NOTEBOOK, NOTEBOOK).stdout
    assert str(environment.environment) in printed
