"""Where the converter is: `cargo build --example frf_to_uff` makes it."""

import pathlib

import pytest


def pytest_addoption(parser):
    parser.addoption("--converter", default="target/debug/examples/frf_to_uff", help="the example frf_to_uff, built")


@pytest.fixture(scope="session")
def converter(request):
    path = pathlib.Path(request.config.getoption("--converter")).resolve()
    if not path.exists():
        pytest.fail(f"{path} is not there: cargo build --example frf_to_uff, then give --converter")
    return path
