"""The checks of Renault's FMU Manipulation Toolbox: schema, and rules that no schema expresses."""

import logging
import zipfile

import pytest
from instances import both_versions
from joints import LAPS

operations = pytest.importorskip("fmu_manipulation_toolbox.operations")
checker = pytest.importorskip("fmu_manipulation_toolbox.checker")


def complaints(fmu, caplog):
    caplog.clear()
    with caplog.at_level(logging.WARNING), operations.FMU(str(fmu)) as opened:
        for check in checker.get_checkers():
            opened.apply_operation(check())
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


@both_versions
@pytest.mark.parametrize("case", ["hardening-1", "linear-2"])
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_the_checks_find_nothing(export, caplog, case, interface, fmi):
    assert complaints(export(LAPS[case], interface, fmi=fmi), caplog) == []


@both_versions
def test_the_checks_would_find_a_variable_that_is_listed_nowhere(export, caplog, tmp_path, fmi):
    fmu = export(LAPS["linear-1"], "element", fmi=fmi)
    damaged = tmp_path / "damaged.fmu"
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(damaged, "w") as target:
        for item in source.infolist():
            content = source.read(item)
            if item.filename == "modelDescription.xml":
                content = content.replace(b'causality="input"', b'causality="output"', 1)
            target.writestr(item, content)
    assert any("is not listed" in message for message in complaints(damaged, caplog))
