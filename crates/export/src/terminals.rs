//! Terminals of an FMU, one flange a side, and where they stand on its icon.

use bolted_joint_dynamics::{Dof, DofKind};
use bolted_joint_interface::{Interface as Declared, Role};

use super::xml::{Attributes, Document, number};
use bolted_joint_joint::DofSet;

/// Path in the FMU.
pub(super) const FILE: &str = "terminalsAndIcons/terminalsAndIcons.xml";

/// Half the width and height of the icon, and of a flange upon it; 0.1 mm each.
const ICON: f64 = 100.0;
const FLANGE: f64 = 10.0;

/// The colour of connections between flanges, that of the flanges themselves.
const CONNECTION_RGB: &str = "31 122 61";

/// The text of `terminalsAndIcons.xml`, the same for FMI 2.0, which takes it over from 3.0.
pub(super) fn terminals_and_icons(declared: &Declared, dofs: DofSet) -> String {
    file(|document| {
        document.element("GraphicalRepresentation", Attributes::new(), |document| {
            let system =
                extent(-ICON, -ICON, ICON, ICON).with("suggestedScalingFactorTo_mm", number(0.1));
            document.empty("CoordinateSystem", system);
            document.empty("Icon", extent(-ICON, -ICON, ICON, ICON));
        });
        document.element("Terminals", Attributes::new(), |document| {
            for (side, middle) in [("a", -ICON), ("b", ICON)] {
                terminal(document, declared, dofs, side, middle);
            }
        });
    })
}

/// A named point of a structure: a terminal for each of its degrees of freedom.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub(super) name: String,
    pub(super) dofs: Vec<&'static Dof>,
}

/// The same for an FMU with these points as terminals.
pub(super) fn of_points(declared: &Declared, points: &[Point]) -> String {
    file(|document| {
        document.element("Terminals", Attributes::new(), |document| {
            for Point { name, dofs } in points {
                let plug = |name: &str, kind, description: String| {
                    Attributes::new()
                        .with("name", name)
                        .with("matchingRule", "plug")
                        .with("terminalKind", kind)
                        .with("description", description)
                };
                if let [dof] = dofs.as_slice() {
                    let attributes = plug(name, kind_of(dof.kind), format!("Point {name}"));
                    document.element("Terminal", attributes, |document| {
                        add_members(document, declared, name, dof);
                    });
                    continue;
                }
                let attributes = plug(name, "_bolted_joint.Flange", format!("Point {name}"));
                document.element("Terminal", attributes, |document| {
                    for dof in dofs {
                        let description = format!("Point {name}, degree of freedom {}", dof.name);
                        let attributes = plug(dof.name, kind_of(dof.kind), description);
                        document.element("Terminal", attributes, |document| {
                            add_members(document, declared, name, dof);
                        });
                    }
                });
            }
        });
    })
}

fn file(content: impl FnOnce(&mut Document)) -> String {
    let mut document = Document::new();
    let root = Attributes::new().with("fmiVersion", "3.0");
    document.element("fmiTerminalsAndIcons", root, content);
    document.finish()
}

/// Kind of a terminal of one degree of freedom, after the connector whose names its members have.
fn kind_of(kind: DofKind) -> &'static str {
    match kind {
        DofKind::Translation => "Modelica.Mechanics.Translational.Interfaces.Flange",
        DofKind::Rotation => "Modelica.Mechanics.Rotational.Interfaces.Flange",
    }
}

/// Names of motion, rate and load in Modelica's flanges; these have no rate, whose name is that of Modelica's masses and inertias.
fn members_of(kind: DofKind) -> [&'static str; 3] {
    match kind {
        DofKind::Translation => ["s", "v", "f"],
        DofKind::Rotation => ["phi", "w", "tau"],
    }
}

/// Motion, rate and load of a degree of freedom, as far as there are such variables.
fn add_members(document: &mut Document, declared: &Declared, owner: &str, dof: &Dof) {
    let quantities = [(dof.name, false), (dof.rate, false), (dof.load, true)];
    for ((quantity, is_load), member) in quantities.into_iter().zip(members_of(dof.kind)) {
        let name = format!("{owner}.{quantity}");
        let Some(variable) = declared.variable(&name) else {
            continue;
        };
        // Loads are counted as acting on the body: those of lap and structures flow in, those that the element puts on its
        // neighbours flow out.
        let kind = match (is_load, variable.role) {
            (true, Role::Input) => "inflow",
            (true, _) => "outflow",
            (false, _) => "signal",
        };
        let attributes = Attributes::new()
            .with("variableName", &name)
            .with("memberName", member)
            .with("variableKind", kind);
        document.empty("TerminalMemberVariable", attributes);
    }
}

/// The flange of one side: for each degree of freedom a terminal with motion, equal on both sides of a connection, and load,
/// whose sum there is zero.
fn terminal(document: &mut Document, declared: &Declared, dofs: DofSet, side: &str, middle: f64) {
    let attributes = Attributes::new()
        .with("name", side)
        .with("matchingRule", "plug")
        .with("terminalKind", "_bolted_joint.Flange")
        .with("description", format!("Flange of side {side}"));
    document.element("Terminal", attributes, |document| {
        for dof in dofs.rows() {
            let attributes = Attributes::new()
                .with("name", dof.name)
                .with("matchingRule", "plug")
                .with("terminalKind", kind_of(dof.kind))
                .with(
                    "description",
                    format!("Side {side}, degree of freedom {}", dof.name),
                );
            document.element("Terminal", attributes, |document| {
                add_members(document, declared, side, dof);
            });
        }
        let place = extent(middle - FLANGE, -FLANGE, middle + FLANGE, FLANGE)
            .with("defaultConnectionColor", CONNECTION_RGB)
            .with("defaultConnectionStrokeSize", 1)
            .with("iconBaseName", format!("flange_{side}"));
        document.empty("TerminalGraphicalRepresentation", place);
    });
}

fn extent(x1: f64, y1: f64, x2: f64, y2: f64) -> Attributes {
    Attributes::new()
        .number("x1", Some(x1))
        .number("y1", Some(y1))
        .number("x2", Some(x2))
        .number("y2", Some(y2))
}
