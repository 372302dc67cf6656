"""The lines that the README and the guide tell a user to copy, run as they stand."""

import re
import shlex
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT


def blocks(document, language):
    text = (ROOT / document).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)


@pytest.fixture(scope="module")
def workplace(run, program, tmp_path_factory):
    """A folder with the examples and the demo's FMUs, in which the README's commands were run in their order."""
    folder = tmp_path_factory.mktemp("readme")
    shutil.copytree(ROOT / "examples", folder / "examples")
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    commands = re.findall(r"^bolted-joint (.*)$", text, flags=re.MULTILINE)
    assert [command.split()[0] for command in commands] == ["identify", "export", "check"]
    # a demo replaces nothing that is there
    run("demo", "-o", folder, cwd=folder)
    for command in commands:
        run(*shlex.split(command), cwd=folder)
    return folder


@pytest.mark.parametrize("document, count", [("README.md", 1), ("docs/fmi.md", 3)])
def test_the_examples_run_as_they_stand(workplace, document, count):
    examples = blocks(document, "python")
    assert len(examples) == count
    for example in examples:
        done = subprocess.run([sys.executable, "-c", example], cwd=workplace, capture_output=True, text=True)
        assert done.returncode == 0, f"{example}\n{done.stderr}"


def test_the_readmes_example_prints_and_draws_the_force_of_the_joint_without_a_warning(workplace):
    (example,) = blocks("README.md", "python")
    picture = workplace / "force.png"
    picture.unlink(missing_ok=True)
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", example], cwd=workplace, capture_output=True, text=True, check=True
    )
    assert done.stderr == ""
    # FMPy's own warnings go to standard output
    (line,) = done.stdout.splitlines()
    force = float(re.search(r"([0-9.]+) N", line).group(1))
    # |K + jωC| · 10 µm at 100 Hz with the joint of Tol's Table 5.3
    assert force == pytest.approx(abs(5.73e5 + 2j * 3.14159 * 100 * 10.83) * 1e-5, rel=0.01)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_the_readme_names_the_packages_that_its_example_imports():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    named = set(re.search(r"`pip install ([^`]*)`", text).group(1).split())
    (example,) = blocks("README.md", "python")
    imported = set(re.findall(r"^(?:import|from) (\w+)", example, flags=re.MULTILINE))
    # FMPy brings NumPy
    assert imported == named | {"numpy"}


def test_the_documented_study_is_the_example(workplace):
    (documented,) = blocks("docs/file-formats.md", "toml")[:1]
    example = (ROOT / "examples/tol-m10x16/study.toml").read_text(encoding="utf-8")
    without_comment = example.split("\n", 1)[1]
    assert documented.strip() == without_comment.strip()
