"""The wheel alone: an environment with nothing but it and what it asks for."""

import os
import pathlib
import subprocess
import sys
import venv

import pytest

WHEEL = os.environ.get("BOLTED_JOINT_WHEEL")

SCRIPT = """
import sys, bolted_joint
study = bolted_joint.Study.read("demo/study.toml")
study["assembly"]["frf"] = bolted_joint.read("demo/assembly.uff")
found = bolted_joint.identify(study, report=True)
assert "<svg" in found.report_html
fmu = bolted_joint.export(found.joint, "joint.fmu")
assert bolted_joint.check(fmu).sound
assert not any(name.split(".")[0] in ("matplotlib", "fmpy", "dask") for name in sys.modules)
print("done")
"""


@pytest.mark.skipif(WHEEL is None, reason="no wheel was built: run ./test")
def test_from_file_to_fmu_without_anything_else(tmp_path):
    environment = tmp_path / "environment"
    venv.create(environment, with_pip=True)
    folder = environment / ("Scripts" if sys.platform == "win32" else "bin")
    subprocess.run([folder / "python", "-m", "pip", "install", "--quiet", WHEEL], check=True)
    alone = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    alone["PATH"] = str(folder)
    program = folder / "bolted-joint"
    subprocess.run([program, "demo", "-o", "demo"], check=True, cwd=tmp_path, env=alone, capture_output=True)
    done = subprocess.run(
        [folder / "python", "-c", SCRIPT], check=True, cwd=tmp_path, env=alone, capture_output=True, text=True
    )
    assert done.stdout == "done\n"
    wrong = subprocess.run([program, "check", "nowhere.fmu"], cwd=tmp_path, env=alone, capture_output=True, text=True)
    assert wrong.returncode == 1 and "nowhere.fmu: cannot be read" in wrong.stderr
    assert pathlib.Path(WHEEL).stat().st_size < 50e6
