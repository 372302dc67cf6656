//! The text of `SystemStructure.ssd`: components, their connectors, what connects them, and which parameters they start with.

use bolted_joint_assembly::PlacedJoint;
use bolted_joint_dynamics::{Dof, DofKind};

use super::super::Timestamp;
use super::super::description::generation_tool;
use super::super::xml::{Attributes, Document};
use super::parameter_set::{ParameterSet, SSV};
use super::parts::{StructurePart, SystemPoint, Wire};
use super::{Dialect, fmu_path};

const SSD: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
pub(super) const SSC: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
/// Version of SSP.
pub(super) const VERSION: &str = "1.0";

/// What is described.
pub(super) struct System<'a> {
    pub(super) name: &'a str,
    pub(super) components: &'a [Component],
    pub(super) wires: &'a [Wire],
    pub(super) points: &'a [SystemPoint],
    /// The nominal set first.
    pub(super) sets: &'a [ParameterSet],
    pub(super) dialect: Dialect,
    pub(super) stop_s: f64,
    pub(super) date: Timestamp,
}

/// An FMU of the system.
pub(super) struct Component {
    pub(super) name: String,
    connectors: Vec<Connector>,
}

struct Connector {
    name: String,
    is_input: bool,
    unit: &'static str,
}

impl Component {
    /// Loads in, motion out. Ecos sets loads of the user's by their variables, and needs no connectors for that.
    pub(super) fn structure(part: &StructurePart, dialect: Dialect) -> Self {
        let points = part.points().into_iter();
        let own = points.filter(|point| dialect == Dialect::Standard || !point.is_input);
        let mut connectors: Vec<Connector> = own
            .map(|point| Connector {
                name: point.variable,
                is_input: point.is_input,
                unit: point.unit,
            })
            .collect();
        for channel in &part.of_joints {
            connectors.extend(Connector::of_side(&channel.name, channel.letters(), true));
        }
        Self {
            name: part.name.clone(),
            connectors,
        }
    }

    /// Motion of both sides in, loads on them out.
    pub(super) fn joint(joint: &PlacedJoint) -> Self {
        let sides = ["a", "b"].into_iter();
        let connectors = sides.flat_map(|side| {
            let dofs = joint.file.joint.dofs.rows();
            dofs.flat_map(move |dof| Connector::of_side(side, dof, false))
        });
        Self {
            name: joint.name.clone(),
            connectors: connectors.collect(),
        }
    }
}

impl Connector {
    /// Motion, its rate and the load on a degree of freedom.
    fn of_side(side: &str, dof: &Dof, load_is_input: bool) -> [Self; 3] {
        [
            (dof.name, !load_is_input),
            (dof.rate, !load_is_input),
            (dof.load, load_is_input),
        ]
        .map(|(quantity, is_input)| Self {
            name: format!("{side}.{quantity}"),
            is_input,
            unit: unit(dof, quantity),
        })
    }

    fn write(&self, document: &mut Document) {
        let kind = if self.is_input { "input" } else { "output" };
        let attributes = Attributes::new()
            .with("name", &self.name)
            .with("kind", kind);
        document.element("ssd:Connector", attributes, |document| {
            document.empty("ssc:Real", Attributes::new().with("unit", self.unit));
        });
    }
}

/// Unit of a motion, rate or load on a degree of freedom.
pub(super) fn unit(dof: &Dof, quantity: &str) -> &'static str {
    let [motion, rate, load] = match dof.kind {
        DofKind::Translation => ["m", "m/s", "N"],
        DofKind::Rotation => ["rad", "rad/s", "N.m"],
    };
    match quantity {
        _ if quantity == dof.name => motion,
        _ if quantity == dof.rate => rate,
        _ => load,
    }
}

/// Units with their exponents of kg, m, s and rad.
const UNITS: [(&str, [i32; 4]); 6] = [
    ("m", [0, 1, 0, 0]),
    ("m/s", [0, 1, -1, 0]),
    ("rad", [0, 0, 0, 1]),
    ("rad/s", [0, 0, -1, 1]),
    ("N", [1, 1, -2, 0]),
    ("N.m", [1, 2, -2, 0]),
];

pub(super) fn text(system: &System<'_>) -> String {
    let mut document = Document::new();
    let root = Attributes::new()
        .with("xmlns:ssd", SSD)
        .with("xmlns:ssc", SSC)
        .with("xmlns:ssv", SSV)
        .with("version", VERSION)
        .with("name", system.name)
        .with("generationTool", generation_tool())
        .with("generationDateAndTime", system.date);
    document.element("ssd:SystemStructureDescription", root, |document| {
        let name = Attributes::new().with("name", "system");
        document.element("ssd:System", name, |document| content(document, system));
        document.element("ssd:Units", Attributes::new(), |document| {
            for (name, exponents) in UNITS {
                let name = Attributes::new().with("name", name);
                document.element("ssc:Unit", name, |document| {
                    let names = ["kg", "m", "s", "rad"].into_iter().zip(exponents);
                    let base = names
                        .filter(|(_, exponent)| *exponent != 0)
                        .fold(Attributes::new(), |base, (name, exponent)| {
                            base.with(name, exponent)
                        });
                    document.empty("ssc:BaseUnit", base);
                });
            }
        });
        let experiment = Attributes::new()
            .with("startTime", 0)
            .number("stopTime", Some(system.stop_s));
        document.empty("ssd:DefaultExperiment", experiment);
    });
    document.finish()
}

fn content(document: &mut Document, system: &System<'_>) {
    if system.dialect == Dialect::Standard {
        if !system.points.is_empty() {
            document.element("ssd:Connectors", Attributes::new(), |document| {
                for point in system.points {
                    let connector = Connector {
                        name: point.variable.clone(),
                        is_input: point.is_input,
                        unit: point.unit,
                    };
                    connector.write(document);
                }
            });
        }
        if let Some(nominal) = system.sets.first().filter(|set| !set.is_empty()) {
            document.element("ssd:ParameterBindings", Attributes::new(), |document| {
                let source = Attributes::new()
                    .with("type", "application/x-ssp-parameter-set")
                    .with("source", nominal.path());
                document.empty("ssd:ParameterBinding", source);
            });
        }
    }
    document.element("ssd:Elements", Attributes::new(), |document| {
        for component in system.components {
            let attributes = Attributes::new()
                .with("name", &component.name)
                .with("type", "application/x-fmu-sharedlibrary")
                .with("source", fmu_path(&component.name));
            document.element("ssd:Component", attributes, |document| {
                document.element("ssd:Connectors", Attributes::new(), |document| {
                    for connector in &component.connectors {
                        connector.write(document);
                    }
                });
                if system.dialect == Dialect::Ecos {
                    bindings(document, &component.name, system.sets);
                }
            });
        }
    });
    let wires = system.wires.iter().map(|wire| {
        let [[from, output], [to, input]] = [&wire.from, &wire.to];
        let start = Attributes::new()
            .with("startElement", from)
            .with("startConnector", output);
        start.with("endElement", to).with("endConnector", input)
    });
    let points = system
        .points
        .iter()
        .filter(|_| system.dialect == Dialect::Standard);
    // at the border of the system a connection has one element only
    let points = points.map(|point| match point.is_input {
        true => Attributes::new()
            .with("startConnector", &point.variable)
            .with("endElement", &point.component)
            .with("endConnector", &point.variable),
        false => Attributes::new()
            .with("startElement", &point.component)
            .with("startConnector", &point.variable)
            .with("endConnector", &point.variable),
    });
    let connections: Vec<Attributes> = wires.chain(points).collect();
    if !connections.is_empty() {
        document.element("ssd:Connections", Attributes::new(), |document| {
            for connection in connections {
                document.empty("ssd:Connection", connection);
            }
        });
    }
}

/// All parameter sets of a component, within the file.
fn bindings(document: &mut Document, component: &str, sets: &[ParameterSet]) {
    let own: Vec<ParameterSet> = sets.iter().filter_map(|set| set.of(component)).collect();
    if own.is_empty() {
        return;
    }
    document.element("ssd:ParameterBindings", Attributes::new(), |document| {
        for set in own {
            document.element("ssd:ParameterBinding", Attributes::new(), |document| {
                document.element("ssd:ParameterValues", Attributes::new(), |document| {
                    set.write(document, Attributes::new());
                });
            });
        }
    });
}
