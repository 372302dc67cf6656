"""The files of an FMU against the schemas of the standard, as FMPy ships them, and FMI 2.0 against FMPy's validation."""

import pathlib
import zipfile

import fmpy
import pytest
from fmpy.validation import validate_fmu
from joints import LAPS, LINEAR_1, LINEAR_2
from lxml import etree

SCHEMAS = pathlib.Path(fmpy.__file__).parent / "schema"


def schema(name):
    return etree.XMLSchema(etree.parse(str(SCHEMAS / name)))


@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("case", ["linear-1", "hardening-2"])
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_every_file_is_valid_under_its_schema(export, case, interface, version):
    fmu = export(LAPS[case], interface, "--fmi", version)
    with zipfile.ZipFile(fmu) as archive:
        for entry, xsd in [
            ("modelDescription.xml", f"fmi{version}/fmi{version}ModelDescription.xsd"),
            ("terminalsAndIcons/terminalsAndIcons.xml", "fmi3/fmi3TerminalsAndIcons.xsd"),
        ]:
            schema(xsd).assertValid(etree.fromstring(archive.read(entry)))
        # The schema for manifests requires its three attributes of any layered standard.
        manifest = etree.fromstring(archive.read("extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml"))
        namespace = "{http://fmi-standard.org/fmi-ls-manifest}"
        declared = etree.parse(str(SCHEMAS / "fmi3/fmi3LayeredStandardManifest.xsd")).getroot()
        names = {attribute.get("name") for attribute in declared.findall("{*}attribute")}
        assert names == {"fmi-ls-name", "fmi-ls-version", "fmi-ls-description"}
        assert all(manifest.get(namespace + name) for name in names)
        for related in manifest.findall("Related"):
            path = pathlib.PurePosixPath("extra/org.fmi-standard.fmi-ls-ref") / related.get("source")
            parts = []
            for part in path.parts:
                parts = parts[:-1] if part == ".." else [*parts, part]
            assert "/".join(parts) in archive.namelist()


@pytest.mark.parametrize("case", LAPS)
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_fmi_2_is_valid_and_runs(export, case, interface):
    fmu = export(LAPS[case], interface, "--fmi", "2")
    assert validate_fmu(str(fmu)) == []
    description = fmpy.read_model_description(str(fmu), validate=True)
    assert description.fmiVersion == "2.0"
    co_simulation = description.coSimulation
    assert co_simulation.canHandleVariableCommunicationStepSize
    assert co_simulation.canInterpolateInputs
    assert co_simulation.maxOutputDerivativeOrder == 1
    assert co_simulation.providesDirectionalDerivative
    for kind in ("CoSimulation", "ModelExchange"):
        result = fmpy.simulate_fmu(str(fmu), fmi_type=kind, stop_time=1e-3, output_interval=1e-4)
        assert result["time"][-1] == pytest.approx(1e-3)


@pytest.mark.parametrize("file", [LINEAR_1, LINEAR_2], ids=["one", "two"])
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_both_versions_have_the_same_interface(export, file, interface):
    two, three = (
        fmpy.read_model_description(str(export(file, interface, "--fmi", version))) for version in "23"
    )
    def of(description):
        return [
            (v.name, v.valueReference, v.causality, v.variability, v.initial, v.start and float(v.start),
             v.declaredType.unit, v.declaredType.displayUnit, v.derivative and v.derivative.name)
            for v in description.modelVariables
            if v.causality != "independent"  # FMI 2.0 needs no variable for the time
        ]
    assert of(two) == of(three)
    for unknowns in ("outputs", "derivatives", "initialUnknowns"):
        # The parameters among the knowns, which FMI 2.0 lists at initialisation only, are compared in the Rust tests.
        first, second = (
            [
                (u.variable.name, [v.name for v in u.dependencies if v.causality != "parameter"])
                for u in getattr(description, unknowns)
            ]
            for description in (two, three)
        )
        assert first == second
