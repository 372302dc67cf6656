//! The part of `check` that says how long a communication step may be between given neighbours.

use bolted_joint_dynamics::{DofKind, with_dofs};
use clap::Args;
use serde_json::{Value, json};

use bolted_joint::cosimulation::{
    CouplingError, Inertia, Master, Neighbours, Restraint, StepBound, element_bound, lap_bound,
};
use bolted_joint::export::Interface;
use bolted_joint::joint::{DofSet, JointFile};

use super::error::CliError;
use super::flexible_neighbours::{Neighbour, of_neighbours};
use super::table::number;

/// What is beside the joint
#[derive(Debug, Args)]
#[command(next_help_heading = "Communication step of explicit coupling")]
pub(super) struct NeighbourArguments {
    /// Masses of the parts at sides a and b of an element, kg; `fixed` for one that does not move
    #[arg(long, value_name = "A,B", value_parser = inertia_pair)]
    neighbour_mass: Option<[Inertia; 2]>,
    /// Moments of inertia of these parts, kg·m²; for joints with rotation
    #[arg(long, value_name = "A,B", value_parser = inertia_pair, requires = "neighbour_mass")]
    neighbour_inertia: Option<[Inertia; 2]>,
    /// Stiffness to ground that is attached to bodies a and b of a lap, N/m
    #[arg(long, value_name = "A,B", value_parser = number_pair, conflicts_with = "neighbour_mass")]
    neighbour_stiffness: Option<[f64; 2]>,
    /// Damping to ground that is attached to bodies a and b of a lap, N·s/m
    #[arg(long, value_name = "A,B", value_parser = number_pair, conflicts_with = "neighbour_mass")]
    neighbour_damping: Option<[f64; 2]>,
    /// Structure beside an element, from a file of modes or matrices: SIDE=FILE@POINTS, with a point for each degree of freedom
    /// of the joint, such as a=modes.toml@2:+Y,2:+RZ; once for each side, and a side without one does not move
    #[arg(long, value_name = "SIDE=FILE@POINTS", conflicts_with_all = ["neighbour_mass", "neighbour_stiffness", "neighbour_damping"])]
    neighbour: Vec<Neighbour>,
    /// Amplitude of the relative motion, for nonlinear joints: m, and rad where there is rotation [default: rest]
    #[arg(long, value_name = "Y[,THETA]", value_delimiter = ',')]
    amplitude: Option<Vec<f64>>,
}

impl NeighbourArguments {
    /// Refuses neighbours of what has none to be given.
    pub(super) fn refuse(&self, found: &'static str) -> Result<(), CliError> {
        for (option, given) in [
            ("--neighbour", !self.neighbour.is_empty()),
            ("--neighbour-mass", self.neighbour_mass.is_some()),
            ("--neighbour-stiffness", self.neighbour_stiffness.is_some()),
            ("--neighbour-damping", self.neighbour_damping.is_some()),
            ("--amplitude", self.amplitude.is_some()),
        ] {
            if given {
                return Err(CliError::option(option, found, "a joint file or its FMU"));
            }
        }
        Ok(())
    }
}

/// The neighbours and what they mean for the step, for people and for machines.
pub(super) struct CommunicationStep {
    pub(super) facts: Vec<String>,
    pub(super) details: Value,
}

/// The bounds that were asked for; `None` where no neighbour was given.
///
/// `joints` are one joint, or one at several preloads, of which the bound is the shortest. `step_size_max_s` is that of a lap, `suggested_s` the communication step of the FMU's default experiment.
pub(super) fn communication_step(
    joints: &[JointFile],
    interface: Interface,
    arguments: &NeighbourArguments,
    step_size_max_s: Option<f64>,
    suggested_s: Option<f64>,
) -> Result<Option<CommunicationStep>, CliError> {
    let restrained =
        arguments.neighbour_stiffness.is_some() || arguments.neighbour_damping.is_some();
    if !arguments.neighbour.is_empty() {
        return match interface {
            Interface::Element => {
                let amplitude = arguments.amplitude.as_deref();
                of_neighbours(joints, &arguments.neighbour, amplitude, suggested_s).map(Some)
            }
            Interface::Lap => Err(CliError::option(
                "--neighbour",
                "a lap, which gives motion and takes loads, as a structure does",
                "an element; for a lap give --neighbour-stiffness for what is attached by a spring",
            )),
        };
    }
    match (interface, arguments.neighbour_mass, restrained) {
        (_, None, false) => match arguments.amplitude {
            None => Ok(None),
            Some(_) => Err(CliError::option(
                "--amplitude",
                "no neighbour",
                "--neighbour, --neighbour-mass or --neighbour-stiffness with it",
            )),
        },
        (Interface::Element, Some(mass), _) => {
            let dofs = joints
                .first()
                .map_or(DofSet::TRANSLATION, |file| file.joint.dofs);
            let neighbours = neighbours(dofs, mass, arguments.neighbour_inertia)?;
            of_element(joints, &neighbours, arguments, suggested_s).map(Some)
        }
        (Interface::Lap, None, true) => {
            of_lap(joints, arguments, step_size_max_s, suggested_s).map(Some)
        }
        (Interface::Element, None, true) => Err(CliError::option(
            "--neighbour-stiffness, --neighbour-damping",
            "an element, which takes motion",
            "a lap; give --neighbour-mass for an element",
        )),
        (Interface::Lap, Some(_), _) => Err(CliError::option(
            "--neighbour-mass",
            "a lap, which gives motion and takes loads, as a mass does",
            "an element; add rigidly attached masses to `bodies` of the joint file, and give \
                       --neighbour-stiffness for what is attached by a spring",
        )),
    }
}

fn neighbours(
    dofs: DofSet,
    mass: [Inertia; 2],
    inertia: Option<[Inertia; 2]>,
) -> Result<Neighbours, CliError> {
    let turns = dofs.rows().any(|dof| dof.kind == DofKind::Rotation);
    let inertia = match inertia {
        Some(inertia) if turns => inertia,
        // no row asks for it
        None if !turns => mass,
        None => {
            return Err(CliError::option(
                "--neighbour-inertia",
                "none",
                "the moments of inertia of both neighbours, as the joint has rotation; `fixed,fixed` if they do not turn",
            ));
        }
        Some(_) => {
            return Err(CliError::option(
                "--neighbour-inertia",
                "a joint without rotation",
                "--neighbour-mass alone",
            ));
        }
    };
    let side = |side: usize| {
        let rows = dofs.rows().map(|dof| match dof.kind {
            DofKind::Translation => mass[side],
            DofKind::Rotation => inertia[side],
        });
        rows.collect()
    };
    Ok(Neighbours {
        a: side(0),
        b: side(1),
    })
}

fn of_element(
    joints: &[JointFile],
    neighbours: &Neighbours,
    arguments: &NeighbourArguments,
    suggested_s: Option<f64>,
) -> Result<CommunicationStep, CliError> {
    let amplitude = arguments.amplitude.as_deref();
    let mut facts = Vec::new();
    let mut details = json!({ "interface": "element", "suggested": suggested_s });
    let mut held = StepBound::Nothing;
    for master in Master::ALL {
        let bound = shortest(joints, |file| {
            element_bound(&file.joint, neighbours, master, amplitude)
        })?;
        let (key, how) = match master {
            Master::Held => ("held", "load held over the step, neighbours exact"),
            Master::Late => ("late", "the same with the load one step late"),
            Master::SemiImplicit => ("semi_implicit", "neighbours by semi-implicit Euler"),
        };
        if master == Master::Held {
            held = bound;
        }
        details[key] = seconds(bound);
        facts.push(format!("communication step: {how}: {}", told(bound)));
    }
    facts.extend(about(joints, amplitude));
    facts.push(advice(
        held,
        suggested_s,
        "couple it implicitly, with the FMU's directional derivatives, or export the joint as lap",
    ));
    Ok(CommunicationStep { facts, details })
}

fn of_lap(
    joints: &[JointFile],
    arguments: &NeighbourArguments,
    step_size_max_s: Option<f64>,
    suggested_s: Option<f64>,
) -> Result<CommunicationStep, CliError> {
    let dofs = joints.first().map_or(0, |file| file.joint.dofs.count());
    let (stiffness, damping) = (
        arguments.neighbour_stiffness.unwrap_or_default(),
        arguments.neighbour_damping.unwrap_or_default(),
    );
    let restraint = |side: usize| {
        // in translation; nothing resists the rotation
        let mut restraint = Restraint {
            stiffness: vec![0.0; dofs],
            damping: vec![0.0; dofs],
        };
        restraint.stiffness[0] = stiffness[side];
        restraint.damping[0] = damping[side];
        restraint
    };
    let restraints = [&restraint(0), &restraint(1)];
    let longest_s = step_size_max_s.unwrap_or(f64::INFINITY);
    let amplitude = arguments.amplitude.as_deref();
    let bound = shortest(
        joints,
        |file| with_dofs!(file.joint.dofs.size(), D => lap_bound::<D>(file, restraints, longest_s, amplitude)),
    )?;
    let mut facts = vec![
            format!(
                "communication step: loads of the attached springs and dampers held over the step: {}",
                told(bound)
            ),
            "communication step: loads that do not depend on the motion need no bound; held, they are late by half a step"
                .to_owned(),
    ];
    facts.extend(about(joints, amplitude));
    facts.push(advice(
        bound,
        suggested_s,
        "make the attached stiffness part of `bodies` in the joint file, or repeat steps from saved states until \
         load and motion agree",
    ));
    Ok(CommunicationStep {
        facts,
        details: json!({ "interface": "lap", "suggested": suggested_s, "held": seconds(bound) }),
    })
}

fn refusal(refused: CouplingError) -> CliError {
    CliError::Coupling(refused)
}

/// Infinity is no number of JSON.
pub(super) fn seconds(bound: StepBound) -> Value {
    let seconds = bound.seconds();
    if seconds.is_finite() {
        json!(seconds)
    } else {
        Value::Null
    }
}

pub(super) fn told(bound: StepBound) -> String {
    match bound {
        StepBound::Below(seconds) => format!("stable below {} s", number(seconds, 4)),
        StepBound::Never => "unstable for every step, as nothing damps it".to_owned(),
        StepBound::NotBelow(seconds) => {
            format!("stable up to {} s at least", number(seconds, 2))
        }
        StepBound::Nothing => "no bound, as nothing moves".to_owned(),
    }
}

/// The shortest of the bounds.
fn shortest(
    joints: &[JointFile],
    bound: impl Fn(&JointFile) -> Result<StepBound, CouplingError>,
) -> Result<StepBound, CliError> {
    joints
        .iter()
        .try_fold(StepBound::Nothing, |shortest, file| {
            Ok(shortest.min(bound(file).map_err(refusal)?))
        })
}

/// What the tangent was taken at.
fn about(joints: &[JointFile], amplitude: Option<&[f64]>) -> Vec<String> {
    let mut facts = vec![about_amplitude(joints, amplitude)];
    if joints.len() > 1 {
        facts.push(
            "communication step: the shortest bound over the whole table of preloads".to_owned(),
        );
    }
    facts
}

fn about_amplitude(joints: &[JointFile], amplitude: Option<&[f64]>) -> String {
    let is_linear = joints.iter().all(|file| file.joint.is_linear());
    match amplitude {
        _ if is_linear => {
            "communication step: the joint is linear, the bound holds for any amplitude".to_owned()
        }
        None => {
            "communication step: for small motion about rest; give --amplitude for this nonlinear joint"
                .to_owned()
        }
        Some(amplitude) => format!(
            "communication step: with the joint's tangent stiffness and damping from rest up to the relative motion {amplitude:?}"
        ),
    }
}

/// What to do where the bound is too short.
pub(super) fn advice(bound: StepBound, suggested_s: Option<f64>, otherwise: &str) -> String {
    let bound_s = bound.seconds();
    if !bound_s.is_finite() {
        return "communication step: choose it by the accuracy that you want".to_owned();
    }
    let too_long = suggested_s
        .filter(|&suggested_s| suggested_s >= bound_s)
        .map_or_else(String::new, |suggested_s| {
            format!(
                "the step of {} s that the FMU suggests is too long; ",
                number(suggested_s, 2)
            )
        });
    if bound_s == 0.0 {
        return format!("communication step: {too_long}{otherwise}");
    }
    format!(
        "communication step: {too_long}for accuracy take a tenth, {} s; if that is too short, {otherwise}",
        number(0.1 * bound_s, 2)
    )
}

fn inertia_pair(text: &str) -> Result<[Inertia; 2], String> {
    pair(text, |part| match part {
        "fixed" => Some(Inertia::Fixed),
        number => Some(Inertia::Free(
            positive(number).filter(|&value| value > 0.0)?,
        )),
    })
    .ok_or_else(|| {
        "expected two values greater than zero, or `fixed`, such as 1.4,2.0 or 0.35,fixed"
            .to_owned()
    })
}

fn number_pair(text: &str) -> Result<[f64; 2], String> {
    pair(text, positive)
        .ok_or_else(|| "expected two values of zero or more, such as 1e5,0".to_owned())
}

fn pair<T>(text: &str, parse: impl Fn(&str) -> Option<T>) -> Option<[T; 2]> {
    let (a, b) = text.split_once(',')?;
    Some([parse(a.trim())?, parse(b.trim())?])
}

/// A finite number that is not negative.
fn positive(text: &str) -> Option<f64> {
    let value: f64 = text.parse().ok()?;
    (value.is_finite() && value >= 0.0).then_some(value)
}
