"""The XML files against the schemas of the standards, as FMPy ships them, and against rules that no schema has."""

import pathlib
import zipfile

import fmpy
import pytest
from instances import both_versions
from joints import LAPS
from lxml import etree

FOLDER = pathlib.Path(fmpy.__file__).parent / "schema"
XS = "{http://www.w3.org/2001/XMLSchema}"


def schema(version, name):
    return etree.XMLSchema(etree.parse(FOLDER / f"fmi{version}" / f"fmi{version}{name}.xsd"))


def check(version, path, root):
    """Checks a file inside an FMU by the schema for its place."""
    if path == "modelDescription.xml":
        schema(version, "ModelDescription").assertValid(root)
    elif path == "terminalsAndIcons/terminalsAndIcons.xml":
        schema(3, "TerminalsAndIcons").assertValid(root)
    elif path.startswith("extra/") and path.endswith("/fmi-ls-manifest.xml"):
        # the schema leaves the root element to each layered standard, and declares what it must say
        declared = etree.parse(FOLDER / "fmi3/fmi3LayeredStandardManifest.xsd").getroot()
        namespace = declared.get("targetNamespace")
        names = {f"{{{namespace}}}{attribute.get('name')}" for attribute in declared.findall(f"{XS}attribute")}
        assert len(names) == 3
        assert names <= set(root.attrib)
        assert root.get(f"{{{namespace}}}fmi-ls-name") == path.split("/")[1]
    else:
        raise AssertionError(f"{path}: no schema is known for it")


def xml_files(fmu):
    with zipfile.ZipFile(fmu) as archive:
        return {name: etree.fromstring(archive.read(name)) for name in archive.namelist() if name.endswith(".xml")}


@both_versions
@pytest.mark.parametrize("case", LAPS)
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_every_xml_file_is_valid(export, case, interface, fmi):
    files = xml_files(export(LAPS[case], interface, fmi=fmi))
    assert "modelDescription.xml" in files
    for path, root in files.items():
        check(fmi, path, root)


@both_versions
def test_the_schemas_would_refuse_a_misspelt_element(export, fmi):
    root = xml_files(export(LAPS["linear-1"], "lap", fmi=fmi))["modelDescription.xml"]
    root.find("ModelStructure").tag = "ModelStructures"
    assert not schema(fmi, "ModelDescription").validate(root)


def declared_attributes(version):
    """Attributes of the two interface types, as the schema declares them (groups and extensions followed)."""
    folder = FOLDER / f"fmi{version}"
    roots = [etree.parse(path).getroot() for path in folder.glob("*.xsd")]
    named = {}
    for root in roots:
        for kind in ("complexType", "attributeGroup"):
            for element in root.iter(f"{XS}{kind}"):
                if element.get("name"):
                    named[element.get("name")] = element

    def attributes(element):
        found = {attribute.get("name") for attribute in element.iter(f"{XS}attribute")}
        for reference in [*element.iter(f"{XS}extension"), *element.iter(f"{XS}attributeGroup")]:
            name = reference.get("base") or reference.get("ref")
            if name in named:
                found |= attributes(named[name])
        return found

    declared = {}
    for root in roots:
        for element in root.iter(f"{XS}element"):
            if element.get("name") in ("CoSimulation", "ModelExchange"):
                source = named.get(element.get("type"), element)
                declared[element.get("name")] = attributes(source)
    return declared


@both_versions
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_every_capability_is_one_of_the_standard(export, interface, fmi):
    """The schema of FMI 3.0 lets attributes of any name through."""
    declared = declared_attributes(fmi)
    assert "canGetAndSetFMU" + ("s" if fmi == "2" else "S") + "tate" in declared["CoSimulation"]
    root = xml_files(export(LAPS["linear-2"], interface, fmi=fmi))["modelDescription.xml"]
    for kind in ("CoSimulation", "ModelExchange"):
        (element,) = root.findall(kind)
        assert set(element.attrib) - {"modelIdentifier"}
        assert set(element.attrib) <= declared[kind]


@both_versions
@pytest.mark.parametrize("case", LAPS)
@pytest.mark.parametrize("interface", ["element", "lap"])
def test_start_values_are_within_their_bounds(export, case, interface, fmi):
    description = fmpy.read_model_description(str(export(LAPS[case], interface, fmi=fmi)))
    bounded = 0
    for variable in description.modelVariables:
        declared = variable.declaredType
        least = variable.min if variable.min is not None else declared and declared.min
        most = variable.max if variable.max is not None else declared and declared.max
        if variable.start is None:
            continue
        bounded += least is not None
        assert least is None or float(variable.start) >= float(least), variable.name
        assert most is None or float(variable.start) <= float(most), variable.name
    if interface == "lap":
        assert bounded > 0, "masses have a lower bound"
