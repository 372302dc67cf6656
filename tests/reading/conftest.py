"""A study on built-in data, whose assembly other programs write again in other formats."""

import json
import shutil
import types

import numpy as np
import pytest
import pyuff

POINTS = ["11:+Y", "12:+Y", "13:+Y"]


@pytest.fixture(scope="session")
def demo(run, tmp_path_factory):
    """The demo's folder, and what pyuff reads in its assembly: frequencies (Hz) and receptances (m/N), response × reference × line."""
    folder = tmp_path_factory.mktemp("demo")
    run("demo", "-o", folder)
    functions = [one for one in pyuff.UFF(str(folder / "assembly.uff")).read_sets() if one["type"] == 58]
    nodes = [11, 12, 13]
    values = np.empty((3, 3, len(functions[0]["x"])), complex)
    for one in functions:
        values[nodes.index(one["rsp_node"]), nodes.index(one["ref_node"])] = one["data"]
    return types.SimpleNamespace(folder=folder, frequency=functions[0]["x"], values=values)


@pytest.fixture
def study(run, demo, tmp_path):
    """Identifies the demo's joint with another `[assembly]`; hands back the joint file and what was printed."""
    for name in ("a-modes.toml", "assembly.uff"):
        shutil.copy(demo.folder / name, tmp_path)
    text = (demo.folder / "study.toml").read_text(encoding="utf-8")

    def identify(assembly='frf = "assembly.uff"', frequency="from = 5\nto = 512", expect=0):
        own = text.replace('frf = "assembly.uff"', assembly).replace("from = 5\nto = 512", frequency)
        own = own.replace(*identify.replace)
        (tmp_path / "study.toml").write_text(own, encoding="utf-8")
        output = tmp_path / "o.joint.json"
        done = run("identify", tmp_path / "study.toml", "--no-rivals", "-o", output, expect=expect)
        return (json.loads(output.read_text(encoding="utf-8")) if output.exists() else None), done

    identify.folder = tmp_path
    identify.replace = ("", "")
    return identify
