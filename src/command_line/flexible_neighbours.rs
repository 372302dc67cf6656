//! The part of `check` that says how long a communication step may be between structures that bend.

use std::path::PathBuf;
use std::str::FromStr;

use serde_json::{Value, json};

use bolted_joint::assembly::{AssemblyModel, ModalForm};
use bolted_joint::cosimulation::{Flexible, LoadOfStep, StepBound};
use bolted_joint::frf::Dof;
use bolted_joint::joint::JointFile;
use bolted_joint_dynamics::DofKind;

use super::communication_step::{CommunicationStep, advice, seconds, told};
use super::error::CliError;
use super::output::warn;

/// A structure beside the joint, and where the joint takes hold of it.
#[derive(Clone, Debug)]
pub(super) struct Neighbour {
    is_b: bool,
    file: PathBuf,
    points: Vec<Dof>,
}

/// `a=modes.toml@2:+Y,2:+RZ`
impl FromStr for Neighbour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            "expected a side, a file of modes or of matrices, and a point for each degree of freedom of the joint, such as \
             a=modes.toml@2:+Y,2:+RZ"
                .to_owned()
        };
        let (side, rest) = text.split_once('=').ok_or_else(expected)?;
        let is_b = match side {
            "a" => false,
            "b" => true,
            _ => return Err(expected()),
        };
        let (file, points) = match rest.rsplit_once('@') {
            Some((file, points)) => (file, points),
            None => (rest, ""),
        };
        let points = points.split(',').filter(|point| !point.is_empty());
        let points = points.map(|point| {
            let found = |_| format!("found the point {point:?}; {}", expected());
            point.parse::<Dof>().map_err(found)
        });
        Ok(Self {
            is_b,
            file: file.into(),
            points: points.collect::<Result<_, _>>()?,
        })
    }
}

/// The bounds between these structures; a side without one does not move.
pub(super) fn of_neighbours(
    joints: &[JointFile],
    neighbours: &[Neighbour],
    amplitude: Option<&[f64]>,
    suggested_s: Option<f64>,
) -> Result<CommunicationStep, CliError> {
    let mut sides: [Option<(ModalForm, Vec<Dof>)>; 2] = [None, None];
    for own in neighbours {
        let side = &mut sides[usize::from(own.is_b)];
        if side.is_some() {
            return Err(CliError::option(
                "--neighbour",
                "two structures on one side",
                "one structure for a side",
            ));
        }
        let (form, warnings) = ModalForm::read(&own.file)?;
        warn(&warnings);
        // where the file has no other points than the joint's, they need not be named
        let points = match own.points.is_empty() {
            true => form.points.clone(),
            false => own.points.clone(),
        };
        if let Some(joint) = joints.first() {
            ensure_fitting(own, &points, joint)?;
        }
        *side = Some((form, points));
    }
    let sides = sides.each_ref().map(|side| {
        side.as_ref()
            .map(|(form, points)| (form, points.as_slice()))
    });
    let mut all = Vec::new();
    for file in joints {
        all.extend(Flexible::between(&file.joint, sides, amplitude).map_err(CliError::Coupling)?);
    }
    Ok(told_of(&all, suggested_s))
}

/// Refuses points that cannot be what a joint's degrees of freedom take hold of.
fn ensure_fitting(own: &Neighbour, points: &[Dof], joint: &JointFile) -> Result<(), CliError> {
    let side = if own.is_b { "b" } else { "a" };
    let refuse = |found: String, expected: &'static str| {
        let found = format!("{found} at side {side}");
        Err(CliError::option("--neighbour", found, expected))
    };
    let dofs = joint.joint.dofs;
    if points.len() != dofs.rows().count() {
        let names: Vec<&str> = dofs.rows().map(|dof| dof.name).collect();
        return refuse(
            format!("{} points for {}", points.len(), names.join(", ")),
            "a point for each degree of freedom of the joint",
        );
    }
    for (place, (point, dof)) in points.iter().zip(dofs.rows()).enumerate() {
        let is_rotation = dof.kind == DofKind::Rotation;
        if point.direction().is_rotation() != is_rotation {
            return refuse(
                format!("{point} for {}", dof.name),
                "a translation for a translation and a rotation for a rotation, in the order of the joint's degrees of freedom",
            );
        }
        if points[..place].contains(point) {
            return refuse(
                format!("{point} twice"),
                "a point for each degree of freedom of the joint",
            );
        }
    }
    Ok(())
}

/// The bounds of a whole assembly, if its structures and joints are taken apart.
pub(super) fn of_assembly(model: &AssemblyModel) -> Result<CommunicationStep, CliError> {
    Ok(told_of(&[Flexible::of(model)?], None))
}

fn told_of(all: &[Flexible], suggested_s: Option<f64>) -> CommunicationStep {
    let mut facts = Vec::new();
    let mut details = json!({ "interface": "element", "suggested": suggested_s });
    let mut held = StepBound::Nothing;
    for load in LoadOfStep::BOUNDED {
        let bounds = all.iter().map(|own| own.bound(load));
        let bound = bounds.fold(StepBound::Nothing, StepBound::min);
        let (key, how) = match load {
            LoadOfStep::Late => ("late", "the same with the load one step late"),
            LoadOfStep::End => ("end", "load of the end of the step, implicit"),
            LoadOfStep::Held | LoadOfStep::Mean => {
                ("held", "load held over the step, structures exact")
            }
        };
        if load == LoadOfStep::Held {
            held = bound;
        }
        details[key] = seconds(bound);
        facts.push(format!("communication step: {how}: {}", told(bound)));
    }
    facts.push(
        "communication step: load of the mean motion of the step, implicit: stable at any step, as joint and structures are passive"
            .to_owned(),
    );
    let estimate_s = all.iter().filter_map(Flexible::estimate_s).reduce(f64::min);
    details["estimate"] = estimate_s.map_or(Value::Null, |step_s| json!(step_s));
    facts.push(
        "communication step: the bounds are those of the spectral radius of an exact step, for small motion about rest unless \
         --amplitude says more"
            .to_owned(),
    );
    facts.push(advice(
        held,
        suggested_s,
        "export the whole assembly as one FMU, or couple it implicitly, as examples/stiff-master does",
    ));
    CommunicationStep { facts, details }
}
