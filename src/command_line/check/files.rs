//! `check` of joint files and assembly files.

use std::path::Path;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::export::Interface;
use bolted_joint::joint::{JointFile, MatrixPassivity};
use bolted_joint::study::StudyText;
use bolted_joint_dynamics::with_dofs;
use serde_json::Map;

use super::{CheckArguments, Report};
use crate::command_line::communication_step::communication_step;
use crate::command_line::error::CliError;
use crate::command_line::flexible_neighbours::of_assembly;
use crate::command_line::named_files::check_named;
use crate::command_line::output::warn;
use crate::command_line::table::number;

/// A joint file: its joint, and the communication steps that were asked for.
pub(super) fn joint(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    let file = JointFile::read(path)?;
    let passivity = file.passivity();
    let mut facts = vec![
        format!("name: {}", file.name),
        format!("degrees of freedom: {}", file.joint.dofs),
    ];
    facts.extend(passivity.matrices.iter().map(ToString::to_string));
    if !file.joint.friction.is_empty() {
        let laws = file.joint.friction.iter();
        let laws = laws.map(|own| format!("{} on {}", own.law.name, own.dof.name));
        let laws: Vec<String> = laws.collect();
        facts.push(format!(
            "friction: {}, passive with their parameters",
            laws.join(", ")
        ));
    }
    // what a simulation does with the joint is told of the whole table, all of which an FMU may come to
    let joints = over_its_preloads(path, &file)?;
    if let Some(table) = &file.joint.over_preload {
        let preloads: Vec<String> = table.preload.iter().map(f64::to_string).collect();
        facts.push(format!(
            "preloads: {} N·m, nominal {} N·m",
            preloads.join(", "),
            table.nominal
        ));
    }
    if file.bodies.is_some() {
        facts.push(with_dofs!(file.joint.dofs.size(), D => lap_fact::<D>(&joints)));
    }
    let findings = passivity.active().map(MatrixPassivity::finding).collect();
    let mut details = Map::new();
    let neighbours = &arguments.neighbours;
    if let Some(step) = communication_step(&joints, Interface::Element, neighbours, None, None)? {
        facts.extend(step.facts);
        details.insert("communication_step".to_owned(), step.details);
    }
    Ok(Report {
        kind: "joint file".to_owned(),
        facts,
        reasons_against: file.reasons_against().to_vec(),
        findings,
        messages: Vec::new(),
        details,
    })
}

/// An assembly file: what it has, and how its parts would bear explicit coupling.
pub(super) fn assembly(path: &Path, arguments: &CheckArguments) -> Result<Report, CliError> {
    arguments
        .neighbours
        .refuse("an assembly file, which has the neighbours of its joints")?;
    let text = StudyText::read(path)?;
    check_named(&text, &[])?;
    let model = AssemblyModel::of(&text)?;
    warn(&model.warnings);
    let names = |all: &mut dyn Iterator<Item = &String>| {
        all.map(String::as_str).collect::<Vec<_>>().join(", ")
    };
    let mut facts = vec![
        format!("name: {}", model.name),
        format!(
            "structures: {}, with {} coordinates",
            names(&mut model.structures.iter().map(|own| &own.name)),
            model.size()
        ),
        match model.joints.is_empty() {
            true => "joints: none".to_owned(),
            false => format!(
                "joints: {}",
                names(&mut model.joints.iter().map(|own| &own.name))
            ),
        },
    ];
    facts.extend(model.notes.iter().cloned());
    let (mut findings, mut reasons_against) = (Vec::new(), Vec::new());
    for joint in &model.joints {
        let name = &joint.name;
        let passivity = joint.file.passivity();
        let active = passivity.active();
        findings.extend(active.map(|matrix| format!("joint {name}: {}", matrix.finding())));
        reasons_against.extend(
            joint
                .file
                .reasons_against()
                .iter()
                .map(|reason| format!("joint {name}: {reason}")),
        );
    }
    facts.push("as one FMU: exact for the linear part at any communication step".to_owned());
    let mut details = Map::new();
    if model.joints.is_empty() {
        facts.push(
            "communication step: there is no joint to couple, so that none is bounded".to_owned(),
        );
    } else {
        let step = of_assembly(&model)?;
        facts.extend(
            step.facts
                .into_iter()
                .map(|fact| format!("as structures and elements (SSP): {fact}")),
        );
        details.insert("communication_step".to_owned(), step.details);
    }
    Ok(Report {
        kind: "assembly file".to_owned(),
        facts,
        reasons_against,
        findings,
        messages: Vec::new(),
        details,
    })
}

/// The joint, or one over the preload at each preload that is judged.
pub(super) fn over_its_preloads(path: &Path, file: &JointFile) -> Result<Vec<JointFile>, CliError> {
    file.over_its_preloads()
        .map_err(|source| CliError::Preload {
            path: path.to_owned(),
            source,
        })
}

/// How fast the lap model with these bodies is, at the preload where it is fastest.
fn lap_fact<const D: usize>(joints: &[JointFile]) -> String {
    let fastest = joints
        .iter()
        .filter_map(|joint| joint.lap::<D>().ok()?.spectrum())
        .filter_map(|spectrum| Some((spectrum.largest_modulus(), spectrum.accurate_step_s()?)))
        .max_by(|one, other| one.0.total_cmp(&other.0));
    match fastest {
        Some((modulus, step_s)) => format!(
            "as lap: |λ|max = {} 1/s, so RK4 steps of {} s",
            number(modulus, 4),
            number(step_s, 3)
        ),
        None => "as lap: nothing moves by itself".to_owned(),
    }
}
