//! From an assembly to one FMU: structures and the joints between them, loads in, motion out.

mod declaration;
mod equations;
mod experiment;
mod maker;
mod names;
mod reference_run;
mod variables;

use std::path::PathBuf;

use bolted_joint_assembly::AssemblyModel;
use bolted_joint_dynamics::Beyond;
use bolted_joint_joint::Passivity;

use super::archive::File;
use super::description::{self, Description};
use super::documentation::{self, AssemblyPage};
use super::identifier::model_identifier;
use super::package::{Packed, packed};
use super::reference_run::ReferenceRun;
use super::start_file::HEADER;
use super::terminals::{self, Point};
use super::token::token;
use super::{ExportError, FmiVersion, Timestamp};
pub(super) use names::check_word;
use variables::List;

/// How an assembly is exported.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyOptions {
    /// Version of the FMI standard.
    pub version: FmiVersion,
    /// Name of the library and of the class that tools make of the FMU; made of the model's name where it is not given.
    pub model_identifier: Option<String>,
    /// Folder with a folder for each further platform, such as `x86_64-windows`, that holds its FMU library.
    pub platforms: Option<PathBuf>,
    /// Whether joints that can feed energy into a simulation are exported all the same.
    pub allow_active: bool,
    /// Whether joints that are not to be relied on, as their files say, are exported all the same.
    pub allow_unusable: bool,
    /// Whether joints over the preload hold the ends of their tables beyond them, instead of refusing such preloads.
    pub extrapolate: bool,
    /// Date in the FMU.
    pub date: Timestamp,
}

/// The FMU of an assembly, and what is in it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportedAssembly {
    /// Version of the FMI standard that it follows.
    pub version: FmiVersion,
    /// Name of its model, which is the assembly's.
    pub model_name: String,
    /// Instantiation token.
    pub token: String,
    /// Number of coordinates of the structures.
    pub coordinates: usize,
    /// Suggested communication step, s.
    pub suggested_step_s: f64,
    /// Suggested end of a simulation, s.
    pub suggested_stop_s: f64,
    /// Its files and libraries.
    pub packed: Packed,
}

/// One line for people.
const SUMMARY: &str = "structures and the bolted joints between them (loads in, motion out)";

/// The FMU of an assembly, of whose file `source_toml` is the text.
///
/// The same file, options and program give the same bytes.
///
/// # Errors
///
/// [`ExportError`]: names that no variable can have, a joint that is active or not to be relied on, libraries that cannot be read.
pub fn assembly_fmu(
    model: &AssemblyModel,
    source_toml: &str,
    options: &AssemblyOptions,
) -> Result<ExportedAssembly, ExportError> {
    names::check(model)?;
    judge(model, options)?;
    let beyond = match options.extrapolate {
        true => Beyond::Held,
        false => Beyond::Refused,
    };
    let assembly = model.equations_over_preload(beyond).map_err(Box::new)?;
    if options.extrapolate && assembly.over_preload().next().is_none() {
        return Err(ExportError::NothingToExtrapolate);
    }
    let list = List::of(model, &assembly);
    let remembers = assembly.laws().any(|laws| laws.have_memory());
    let mut description = Description::listing(
        |tree| {
            let types = declaration::types(&list, tree);
            (types, declaration::variables(&list, tree))
        },
        declaration::unknowns(&list),
        remembers,
    )?;
    description.set_version(options.version);
    description.set_names(&model.name, format!("{}: {SUMMARY}", model.name));
    let identifier = model_identifier(
        options.model_identifier.as_deref(),
        &model.name,
        equations::MODEL,
    )?;
    description.set_identifier(&identifier);
    description.set_about(model.about.as_ref());
    let experiment = experiment::suggested(model, &assembly);
    description.set_experiment(experiment);
    let declared = description.declared()?;
    let of = |place: usize| {
        let reference = declaration::reference(place);
        declared
            .variables
            .iter()
            .find(move |own| own.reference == reference)
    };
    let unit = |place: usize| of(place).map_or_else(String::new, |own| own.unit.clone());
    let nominal = |place: usize| of(place).map_or(1.0, |own| own.nominal);
    let resources = equations::list_lines(&list, unit, nominal)
        + &equations::equation_lines(model, &assembly, options.extrapolate);
    let token = token(&[&description.text()?, &resources]);
    let (xml, declared) = description.finish(&token, options.date)?;
    let mut files = vec![
        File::text(description::FILE, xml),
        File::text(
            "resources/start.txt",
            format!(
                "{HEADER}\nmodel {}\ntoken {token}\n{resources}",
                equations::MODEL
            ),
        ),
        File::text("resources/assembly.toml", source_toml),
    ];
    for joint in &model.joints {
        let file = joint.whole();
        let text = file
            .to_json()
            .map_err(|_| bolted_joint_joint::LawError::Invalid {
                problems: file.validate(),
            })?;
        files.push(File::text(
            &format!("resources/{}.joint.json", joint.name),
            text,
        ));
    }
    let reference_run =
        reference_run::run(model, &assembly, &list, experiment.communication_step_s)?;
    let page = documentation::assembly_html(&AssemblyPage {
        model,
        summary: SUMMARY,
        version: options.version,
        declared: &declared,
        suggested_step_s: experiment.communication_step_s,
        reference_tolerance: reference_run.as_ref().map(ReferenceRun::tolerance),
        token: &token,
        date: options.date,
    });
    files.push(File::text("documentation/index.html", page));
    files.extend(documentation::licences());
    files.push(File::text(
        terminals::FILE,
        terminals::of_points(&declared, &points(model)),
    ));
    if let Some(run) = &reference_run {
        files.extend(run.files(&model.name));
    }
    Ok(ExportedAssembly {
        version: options.version,
        model_name: model.name.clone(),
        token,
        coordinates: assembly.size(),
        suggested_step_s: experiment.communication_step_s,
        suggested_stop_s: experiment.stop_s,
        packed: packed(
            files,
            options.platforms.as_deref(),
            &identifier,
            options.version,
            options.date,
        )?,
    })
}

/// The points of loads and motions, one terminal for each name.
fn points(model: &AssemblyModel) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for channel in model.outputs.iter().chain(&model.inputs) {
        let dof = channel.letters();
        match points.iter_mut().find(|point| point.name == channel.name) {
            Some(point) if point.dofs.contains(&dof) => {}
            Some(point) => point.dofs.push(dof),
            None => points.push(Point {
                name: channel.name.clone(),
                dofs: vec![dof],
            }),
        }
    }
    points
}

/// Refuses joints that are active or not to be relied on, unless the user insists.
fn judge(model: &AssemblyModel, options: &AssemblyOptions) -> Result<(), ExportError> {
    for joint in &model.joints {
        let file = joint.whole();
        let reasons = file.reasons_against();
        if !(reasons.is_empty() || options.allow_unusable) {
            let of_joint = |reason: &String| format!("joint {}: {reason}", joint.name);
            return Err(ExportError::NotUsable {
                reasons: reasons.iter().map(of_joint).collect(),
            });
        }
        let passivity: Passivity = file.passivity();
        if !(passivity.is_passive() || options.allow_active) {
            return Err(ExportError::Active {
                matrices: passivity.active().cloned().collect(),
            });
        }
    }
    Ok(())
}
