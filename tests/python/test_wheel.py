"""What the wheel says of itself."""

import email
import os
import pathlib
import zipfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LICENCES = ["LICENSE-APACHE", "LICENSE-MIT"]
WHEEL = os.environ.get("BOLTED_JOINT_WHEEL")


@pytest.mark.parametrize("name", LICENCES)
def test_licences_are_those_of_the_project(name):
    assert (ROOT / "crates/python" / name).read_bytes() == (ROOT / name).read_bytes()


@pytest.mark.skipif(WHEEL is None, reason="no wheel was built: run ./test")
def test_the_wheel_has_a_description_and_licences():
    with zipfile.ZipFile(WHEEL) as archive:
        names = archive.namelist()
        folder = next(name for name in names if name.endswith(".dist-info/METADATA")).removesuffix("METADATA")
        metadata = email.message_from_bytes(archive.read(f"{folder}METADATA"))
        for name in LICENCES:
            assert archive.read(f"{folder}licenses/{name}") == (ROOT / name).read_bytes()
    assert sorted(metadata.get_all("License-File")) == LICENCES
    assert metadata["License-Expression"] == "MIT OR Apache-2.0"
    assert metadata["Description-Content-Type"].startswith("text/markdown")
    assert "Turns measurements of a bolted joint into an FMU" in metadata.get_payload(decode=True).decode()
    assert "substructuring" in metadata["Keywords"]
