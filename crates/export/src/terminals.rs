//! Terminals of an FMU, one flange a side, and where they stand on its icon.

use bolted_joint_dynamics::DofKind;
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

/// A terminal of one degree of freedom.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub(super) name: String,
    pub(super) kind: DofKind,
    /// Names of its members, and whether each is a load.
    pub(super) members: Vec<(&'static str, bool)>,
}

/// The same for an FMU with these points as terminals.
pub(super) fn of_points(declared: &Declared, points: &[Point]) -> String {
    file(|document| {
        document.element("Terminals", Attributes::new(), |document| {
            for Point {
                name,
                kind,
                members,
            } in points
            {
                let kind = match kind {
                    DofKind::Translation => "_bolted_joint.TranslationalPoint",
                    DofKind::Rotation => "_bolted_joint.RotationalPoint",
                };
                let attributes = Attributes::new()
                    .with("name", name)
                    .with("matchingRule", "plug")
                    .with("terminalKind", kind)
                    .with("description", format!("Point {name}"));
                document.element("Terminal", attributes, |document| {
                    for &member in members {
                        add_member(document, declared, name, member);
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

/// A member of a terminal, if there is such a variable.
fn add_member(
    document: &mut Document,
    declared: &Declared,
    owner: &str,
    (member, is_load): (&'static str, bool),
) {
    let name = format!("{owner}.{member}");
    let Some(variable) = declared.variable(&name) else {
        return;
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

/// The flange of one side: motion, equal on both sides of a connection, and load, whose sum there is zero.
fn terminal(document: &mut Document, declared: &Declared, dofs: DofSet, side: &str, middle: f64) {
    let of_kind = |kind, word| {
        let mut members = dofs.rows();
        if members.any(|dof| dof.kind == kind) {
            word
        } else {
            ""
        }
    };
    let kind = format!(
        "_bolted_joint.{}{}Flange",
        of_kind(DofKind::Translation, "Translational"),
        of_kind(DofKind::Rotation, "Rotational")
    );
    let attributes = Attributes::new()
        .with("name", side)
        .with("matchingRule", "plug")
        .with("terminalKind", kind)
        .with("description", format!("Flange of side {side}"));
    document.element("Terminal", attributes, |document| {
        let displacements = dofs.rows().map(|dof| (dof.name, false));
        let rates = dofs.rows().map(|dof| (dof.rate, false));
        let loads = dofs.rows().map(|dof| (dof.load, true));
        for (member, is_load) in displacements.chain(rates).chain(loads) {
            add_member(document, declared, side, (member, is_load));
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
