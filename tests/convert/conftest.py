"""A joint as a file for another tool."""

import json

import pytest


@pytest.fixture
def convert(run, tmp_path):
    """Converts a joint (as a dict) and returns the path of the file."""

    def convert(file, tool, name, *options):
        source = tmp_path / "made-up.joint.json"
        source.write_text(json.dumps(file), encoding="utf-8")
        output = tmp_path / name
        run("convert", source, "--to", tool, "-o", output, *options)
        return output

    return convert
