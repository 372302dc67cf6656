//! What may be added to a test: sensors and impacts that the study states, or some that are proposed.

use std::fmt;

use bolted_joint_frf::{Direction, Dof, Sign};
use bolted_joint_space::Axes;
use bolted_joint_virtual_point::{Impact, Sensor, VirtualPointError};
use nalgebra::Vector3;

use crate::chain::part::{Part, Source};

/// DOFs elsewhere on a part that are proposed, at most.
const MOST_ELSEWHERE: usize = 30;

/// Nodes of proposed sensors and impacts: beyond those that anybody has.
const FIRST_NODE: u32 = 9_000_001;

/// A sensor or an impact that may be added.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    /// The interface, or the part, that it would be added to.
    pub(crate) to: String,
    /// Of a sensor or an impact near an interface, m.
    pub(crate) position_m: [f64; 3],
    /// Its key in the study, unless it is proposed.
    pub(crate) key: Option<String>,
    pub(crate) thing: Thing,
}

/// What is added.
#[derive(Clone, Debug)]
pub(crate) enum Thing {
    Sensor(Vec<Dof>, Sensor),
    Impact(Dof, Impact),
    /// Elsewhere on a part.
    Response(Dof),
    Reference(Dof),
}

impl Candidate {
    /// The parts with it; `None` where there is no such interface.
    pub(crate) fn added(&self, parts: &[Part]) -> Option<Vec<Part>> {
        let mut parts = parts.to_vec();
        match &self.thing {
            Thing::Response(dof) => own(&mut parts, &self.to)?.responses.push(*dof),
            Thing::Reference(dof) => own(&mut parts, &self.to)?.references.push(*dof),
            Thing::Sensor(dofs, sensor) => {
                let interface = (parts.iter_mut().flat_map(|part| &mut part.interfaces))
                    .find(|interface| interface.name == self.to)?;
                interface.sensors.push((dofs.clone(), sensor.clone()));
            }
            Thing::Impact(dof, impact) => {
                let interface = (parts.iter_mut().flat_map(|part| &mut part.interfaces))
                    .find(|interface| interface.name == self.to)?;
                interface.impacts.push((*dof, impact.clone()));
            }
        }
        Some(parts)
    }
}

fn own<'p>(parts: &'p mut [Part], name: &str) -> Option<&'p mut Part> {
    parts.iter_mut().find(|part| part.name == name)
}

impl fmt::Display for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let to = &self.to;
        // zero that is added takes the sign of a zero away
        let [x, y, z] = self.position_m.map(|x| (x * 1e6).round() / 1e6 + 0.0);
        match &self.thing {
            Thing::Response(dof) => write!(f, "{to}.responses: {dof}"),
            Thing::Reference(dof) => write!(f, "{to}.references: {dof}"),
            Thing::Sensor(dofs, sensor) => {
                let kind = if sensor.channels() == 3 {
                    "triaxial sensor"
                } else {
                    "sensor"
                };
                match (&self.key, dofs.first()) {
                    (Some(key), Some(dof)) => {
                        write!(
                            f,
                            "{to}.sensors: {kind} {} at ({x}, {y}, {z}) m, {key}",
                            dof.node()
                        )
                    }
                    _ => write!(f, "{to}.sensors: {kind} at ({x}, {y}, {z}) m"),
                }
            }
            Thing::Impact(dof, _) => match &self.key {
                Some(key) => write!(f, "{to}.impacts: {dof} at ({x}, {y}, {z}) m, {key}"),
                None => write!(
                    f,
                    "{to}.impacts: along {} at ({x}, {y}, {z}) m",
                    along(*dof)
                ),
            },
        }
    }
}

fn along(dof: Dof) -> &'static str {
    match dof.direction() {
        Direction::X => "x",
        Direction::Y => "y",
        Direction::Z => "z",
        _ => "an axis of its own",
    }
}

/// Triaxial sensors (in a plane, ones with a single channel) and impacts on the six faces of a cube about each virtual point whose node is in the functions, as far out as
/// the interface is large; an impact across each face and one along it. And DOFs elsewhere that the functions have.
pub(crate) fn proposed(
    parts: &[Part],
    length_m: &dyn Fn(&str) -> f64,
) -> Result<Vec<Candidate>, VirtualPointError> {
    let mut all = Vec::new();
    let mut node = FIRST_NODE;
    let axes = [
        (Vector3::x(), Direction::X),
        (Vector3::y(), Direction::Y),
        (Vector3::z(), Direction::Z),
    ];
    for part in parts {
        for interface in &part.interfaces {
            let has_places = !(interface.sensors.is_empty() || interface.impacts.is_empty());
            if interface.node.is_none() || !has_places {
                continue;
            }
            let length_m = length_m(&interface.name);
            for (n, (axis, _)) in axes.iter().enumerate() {
                for sign in [1.0, -1.0] {
                    let position: Vector3<f64> = axis * (sign * length_m);
                    let position_m = position.into();
                    let candidate = |thing| Candidate {
                        to: interface.name.clone(),
                        position_m,
                        key: None,
                        thing,
                    };
                    let dofs = axes.map(|(_, direction)| Dof::new(node, direction, Sign::Plus));
                    if interface.motions.are_all() {
                        let sensor = Sensor::triaxial(position, &Axes::identity(), [1.0; 3])?;
                        all.push(candidate(Thing::Sensor(dofs.to_vec(), sensor)));
                    }
                    for aside in [0, 1] {
                        let (along, _) = axes[(n + aside) % 3];
                        let dof = dofs[(n + aside) % 3];
                        let impact = Impact::new(position, along, 1.0)?;
                        if !interface.is_moved(&impact)? {
                            continue;
                        }
                        if !interface.motions.are_all() {
                            let sensor = Sensor::uniaxial(position, along, 1.0)?;
                            all.push(candidate(Thing::Sensor(vec![dof], sensor)));
                        }
                        all.push(candidate(Thing::Impact(dof, impact)));
                    }
                    node += 1;
                }
            }
        }
        let [responses, references] = unused(part);
        let elsewhere = |dof: Dof, thing: fn(Dof) -> Thing| Candidate {
            to: part.name.clone(),
            position_m: [0.0; 3],
            key: None,
            thing: thing(dof),
        };
        all.extend(
            responses
                .into_iter()
                .map(|dof| elsewhere(dof, Thing::Response)),
        );
        all.extend(
            references
                .into_iter()
                .map(|dof| elsewhere(dof, Thing::Reference)),
        );
    }
    Ok(all)
}

/// Translations that the functions have, apart from those that are measured: responses, and references.
fn unused(part: &Part) -> [Vec<Dof>; 2] {
    let interfaces = || part.interfaces.iter();
    let nodes: Vec<u32> = interfaces().filter_map(|own| own.node).collect();
    let sensors = interfaces().flat_map(|own| &own.sensors);
    let impacts = interfaces().flat_map(|own| &own.impacts);
    let responding = sensors.flat_map(|(dofs, _)| dofs).chain(&part.responses);
    let loaded = impacts.map(|(dof, _)| dof).chain(&part.references);
    let [of_responses, of_references]: [Vec<Dof>; 2] = match &part.source {
        Source::Modes(modes) => [modes.points().to_vec(), modes.points().to_vec()],
        Source::Functions(set) => {
            let pairs = || set.functions();
            [
                pairs().map(|(response, _, _)| response).collect(),
                pairs().map(|(_, reference, _)| reference).collect(),
            ]
        }
    };
    let free = |mut list: Vec<Dof>, used: Vec<Dof>| {
        list.retain(|dof| {
            let is_near = nodes.contains(&dof.node());
            dof.direction().is_translation() && !is_near && !used.contains(dof)
        });
        list.sort_unstable();
        list.dedup();
        list.truncate(MOST_ELSEWHERE);
        list
    };
    [
        free(of_responses, responding.copied().collect()),
        free(of_references, loaded.copied().collect()),
    ]
}
