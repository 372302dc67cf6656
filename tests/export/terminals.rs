//! Flanges and pictures.

use bolted_joint::export::{FmiVersion, Interface};
use bolted_joint_testing::{begins, ends};

use crate::xml::{Element, elements, named};
use crate::{bytes, export_as, text};

/// A terminal of one degree of freedom: side, degree of freedom, kind, and of each member its name, variable and kind.
type Flange = (String, String, String, Vec<[String; 3]>);

fn flanges(xml: &str) -> Vec<Flange> {
    let (mut side, mut flanges): (String, Vec<Flange>) = (String::new(), Vec::new());
    for element in elements(xml) {
        match &*element.name {
            "Terminal" => {
                assert_eq!(element.get("matchingRule"), Some("plug"));
                let [name, kind] =
                    ["name", "terminalKind"].map(|own| element.get(own).unwrap().to_owned());
                match kind.as_str() {
                    "_bolted_joint.Flange" => side = name,
                    _ => flanges.push((side.clone(), name, kind, Vec::new())),
                }
            }
            "TerminalMemberVariable" => {
                let member = ["memberName", "variableName", "variableKind"]
                    .map(|attribute| element.get(attribute).unwrap().to_owned());
                flanges.last_mut().unwrap().3.push(member);
            }
            _ => {}
        }
    }
    flanges
}

#[test]
fn each_degree_of_freedom_has_a_flange_and_an_element_fits_a_lap() {
    // names of Modelica's Flange (s, f; phi, tau), Mass (v) and Inertia (w)
    let translation = ("y", "Translational", [("s", "y"), ("v", "v"), ("f", "F")]);
    let rotation = (
        "theta",
        "Rotational",
        [("phi", "theta"), ("w", "omega"), ("tau", "M")],
    );
    for (name, dofs) in [
        (
            "m10-aluminium.joint.json",
            [translation, rotation].as_slice(),
        ),
        ("pirdayr-ex03.joint.json", &[translation]),
    ] {
        for version in [FmiVersion::V2, FmiVersion::V3] {
            let (element, _) = export_as(name, Interface::Element, version).unwrap();
            let xml = text(&element, "terminalsAndIcons/terminalsAndIcons.xml").unwrap();
            assert!(xml.contains("<fmiTerminalsAndIcons fmiVersion=\"3.0\">"));
            let description = text(&element, "modelDescription.xml").unwrap();
            let tag = match version {
                FmiVersion::V2 => "ScalarVariable",
                FmiVersion::V3 => "Float64",
            };
            let variables = named(&description, tag);
            let causality = |name: &str| -> String {
                let mut variables = variables.iter();
                let found = variables.find(|e: &&Element| e.get("name") == Some(name));
                found.unwrap().get("causality").unwrap().to_owned()
            };
            let expected = ["a", "b"]
                .iter()
                .flat_map(|side| dofs.iter().map(move |dof| (side, dof)));
            let flanges = flanges(&xml);
            assert_eq!(flanges.len(), 2 * dofs.len());
            for (found, (side, (dof, domain, members))) in flanges.iter().zip(expected) {
                assert_eq!((&*found.0, &*found.1), (*side, *dof));
                assert_eq!(
                    found.2,
                    format!("Modelica.Mechanics.{domain}.Interfaces.Flange")
                );
                assert_eq!(found.3.len(), 3);
                for ([member, variable, kind], (name, quantity)) in found.3.iter().zip(members) {
                    assert_eq!(
                        (&**member, &**variable),
                        (*name, &*format!("{side}.{quantity}"))
                    );
                    // Motion is taken from the neighbour, the load on the neighbour is given out.
                    let expected = match *name {
                        "f" | "tau" => ("output", "outflow"),
                        _ => ("input", "signal"),
                    };
                    assert_eq!((&*causality(variable), &**kind), expected, "{variable}");
                }
            }
        }
    }
    // What an element takes the lap gives, and the other way round, under the same names.
    let [element, lap] = [Interface::Element, Interface::Lap].map(|interface| {
        let (fmu, _) = export_as("pirdayr-ex03.joint.json", interface, FmiVersion::V3).unwrap();
        flanges(&text(&fmu, "terminalsAndIcons/terminalsAndIcons.xml").unwrap())
    });
    for (element, lap) in element.iter().zip(&lap) {
        assert_eq!(
            (&element.0, &element.1, &element.2),
            (&lap.0, &lap.1, &lap.2)
        );
        for ([member, _, kind], [other, _, other_kind]) in element.3.iter().zip(&lap.3) {
            assert_eq!(member, other);
            let is_load = kind == "outflow";
            let expected = if is_load { "inflow" } else { "signal" };
            assert_eq!(other_kind, expected, "{member}");
        }
    }
}

/// Width and height of a PNG: its header chunk is the first.
fn size(png: &[u8]) -> [u32; 2] {
    assert_eq!(png[..16], *b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR");
    [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().unwrap()))
}

#[test]
fn pictures_are_where_the_standard_wants_them() {
    for interface in [Interface::Element, Interface::Lap] {
        let [two, three] = [FmiVersion::V2, FmiVersion::V3].map(|version| {
            let exported = export_as("pirdayr-ex03.joint.json", interface, version);
            exported.unwrap().0
        });
        let icon = bytes(&two, "model.png").unwrap();
        assert_eq!(size(&icon), [100, 100]);
        assert!(bytes(&three, "model.png").is_err());
        for fmu in [&two, &three] {
            assert_eq!(bytes(fmu, "terminalsAndIcons/icon.png").unwrap(), icon);
            let [width, height] = size(&bytes(fmu, "documentation/diagram.png").unwrap());
            assert!(width > 600 && height > 100);
            let terminals = text(fmu, "terminalsAndIcons/terminalsAndIcons.xml").unwrap();
            for place in named(&terminals, "TerminalGraphicalRepresentation") {
                let name = place.get("iconBaseName").unwrap();
                size(&bytes(fmu, &format!("terminalsAndIcons/{name}.png")).unwrap());
            }
            for drawing in [
                "terminalsAndIcons/icon.svg",
                "terminalsAndIcons/flange_a.svg",
                "terminalsAndIcons/flange_b.svg",
                "documentation/diagram.svg",
            ] {
                let svg = text(fmu, drawing).unwrap();
                begins(&svg, "<svg xmlns=\"http://www.w3.org/2000/svg\"");
                ends(svg.trim_end(), "</svg>");
                assert!(!svg.contains("href"), "{drawing}");
            }
        }
    }
}
