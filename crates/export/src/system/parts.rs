//! What an assembly is cut into: structures with the points at which the joints take hold, and what connects the two.

use std::collections::BTreeSet;

use bolted_joint_assembly::{AssemblyModel, Channel, Place, PlacedJoint};
use bolted_joint_dynamics::Dof;

use super::super::ExportError;
use super::super::assembly::check_word;

/// A structure as an assembly without joints.
pub(super) struct StructurePart {
    pub(super) name: String,
    pub(super) model: AssemblyModel,
    /// Which of its channels are the user's; the others are for joints.
    pub(super) own_inputs: Vec<Channel>,
    pub(super) own_outputs: Vec<Channel>,
    pub(super) of_joints: Vec<Channel>,
}

/// A connection from an output to an input: components, and their variables.
pub(super) struct Wire {
    pub(super) from: [String; 2],
    pub(super) to: [String; 2],
}

/// A variable of a component that is one of the system.
pub(super) struct SystemPoint {
    pub(super) component: String,
    pub(super) variable: String,
    pub(super) unit: &'static str,
    pub(super) is_input: bool,
}

/// The parts.
pub(super) struct Parts {
    pub(super) structures: Vec<StructurePart>,
    pub(super) wires: Vec<Wire>,
    pub(super) points: Vec<SystemPoint>,
}

/// The sides of a joint.
const SIDES: [&str; 2] = ["a", "b"];

impl Parts {
    pub(super) fn of(model: &AssemblyModel) -> Result<Self, ExportError> {
        let mut structures = (0..model.structures.len())
            .map(|place| StructurePart::of(model, place))
            .collect::<Result<Vec<_>, _>>()?;
        let mut wires = Vec::new();
        for joint in &model.joints {
            if let Some(same) = structures.iter().find(|part| part.name == joint.name) {
                return Err(ExportError::Part {
                    key: format!("joints: name = \"{}\"", joint.name),
                    found: format!("the name of the structure {} again", same.name),
                    expected:
                        "a name that no structure has, since both become components of one system"
                            .to_owned(),
                });
            }
            for (side, places) in SIDES.into_iter().zip(&joint.places) {
                let ends = Ends::of(joint, side, places);
                for (dof, channel) in joint.file.joint.dofs.rows().zip(ends.channels) {
                    let Some(part) = structures.get_mut(channel.place.structure) else {
                        continue;
                    };
                    part.check_free(&channel.name, joint)?;
                    let own = channel.letters();
                    let at = |quantity: &str| {
                        [part.name.clone(), format!("{}.{quantity}", channel.name)]
                    };
                    let of_joint =
                        |quantity: &str| [joint.name.clone(), format!("{side}.{quantity}")];
                    wires.extend([
                        Wire {
                            from: at(own.name),
                            to: of_joint(dof.name),
                        },
                        Wire {
                            from: at(own.rate),
                            to: of_joint(dof.rate),
                        },
                        Wire {
                            from: of_joint(dof.load),
                            to: at(own.load),
                        },
                    ]);
                    part.add(channel);
                }
            }
        }
        let points = structures.iter().flat_map(StructurePart::points).collect();
        Ok(Self {
            structures,
            wires,
            points,
        })
    }
}

/// Where one side of a joint takes hold: a channel for each of its degrees of freedom.
struct Ends {
    channels: Vec<Channel>,
}

impl Ends {
    /// All have one name, unless two of them would then have the same letters.
    fn of(joint: &PlacedJoint, side: &str, places: &[Place]) -> Self {
        let mut used = BTreeSet::new();
        let channels = joint
            .file
            .joint
            .dofs
            .rows()
            .zip(places)
            .map(|(dof, place)| {
                let mut channel = Channel {
                    name: format!("{}_{side}", joint.name),
                    place: place.clone(),
                };
                if !used.insert(channel.letters().name) {
                    channel.name = format!("{}_{side}_{}", joint.name, dof.name);
                }
                channel
            });
        Self {
            channels: channels.collect(),
        }
    }
}

impl StructurePart {
    fn of(model: &AssemblyModel, place: usize) -> Result<Self, ExportError> {
        let structure = model.structures[place].clone();
        let name = structure.name.clone();
        check_word(&format!("structures.{name}"), &name)?;
        let of = |channels: &[Channel]| -> Vec<Channel> {
            let own = channels.iter().filter(|own| own.place.structure == place);
            own.map(|own| Channel {
                name: own.name.clone(),
                place: Place {
                    structure: 0,
                    dof: own.place.dof,
                },
            })
            .collect()
        };
        let (inputs, outputs) = (of(&model.inputs), of(&model.outputs));
        Ok(Self {
            model: AssemblyModel {
                path: model.path.clone(),
                name: format!("{}: {name}", model.name),
                about: model.about.clone(),
                structures: vec![structure],
                joints: Vec::new(),
                inputs: inputs.clone(),
                outputs: outputs.clone(),
                response: None,
                warnings: Vec::new(),
                notes: Vec::new(),
            },
            name,
            own_inputs: inputs,
            own_outputs: outputs,
            of_joints: Vec::new(),
        })
    }

    /// Refuses a name of the user's that the joint needs here.
    fn check_free(&self, name: &str, joint: &PlacedJoint) -> Result<(), ExportError> {
        for (table, channels) in [("inputs", &self.own_inputs), ("outputs", &self.own_outputs)] {
            if channels.iter().any(|own| own.name == name) {
                return Err(ExportError::Part {
                    key: format!("{table}.{name}"),
                    found: format!(
                        "the name of the point at which the joint {} takes hold of structure {}",
                        joint.name, self.name
                    ),
                    expected: "another name".to_owned(),
                });
            }
        }
        Ok(())
    }

    fn add(&mut self, channel: Channel) {
        let own = Channel {
            place: Place {
                structure: 0,
                dof: channel.place.dof,
            },
            ..channel
        };
        self.model.inputs.push(own.clone());
        self.model.outputs.push(own.clone());
        self.of_joints.push(own);
    }

    pub(super) fn points(&self) -> Vec<SystemPoint> {
        let point = |channel: &Channel, dof: &Dof, quantity: &str, is_input| SystemPoint {
            component: self.name.clone(),
            variable: format!("{}.{quantity}", channel.name),
            unit: super::ssd::unit(dof, quantity),
            is_input,
        };
        let mut points = Vec::new();
        for channel in &self.own_inputs {
            let dof = channel.letters();
            points.push(point(channel, dof, dof.load, true));
        }
        for channel in &self.own_outputs {
            let dof = channel.letters();
            points
                .extend([dof.name, dof.rate].map(|quantity| point(channel, dof, quantity, false)));
        }
        points
    }
}
