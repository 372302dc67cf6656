//! From an assembly to a system of FMUs in one SSP (System Structure and Parameterization 1.0): a structure each, an element for
//! each joint, and what connects them, for those who want the parts.
//!
//! A structure is an assembly without joints. So the parts are made by what makes the whole, and only the wiring is new.

mod draws;
mod parameter_set;
mod parts;
mod ssd;

use bolted_joint_assembly::{AssemblyModel, PlacedJoint};

use super::archive::{Content, File};
use super::assembly::{AssemblyOptions, assembly_fmu};
use super::fmu::{ExportOptions, Exported, fmu_bytes};
use super::package::Packed;
use super::step::StepWish;
use super::{ExportError, FmiVersion, Interface};
pub use draws::DrawnJoint;
use draws::Draws;
use parts::Parts;
use ssd::Component;

/// For whom the system is described.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Dialect {
    /// Whoever follows the standard: inputs and outputs of the assembly are connectors of the system.
    #[default]
    Standard,
    /// Ecos, which takes no connectors of a system, and picks one of the parameter sets of a component by its name.
    Ecos,
}

/// How an assembly is exported as a system.
#[derive(Debug, Clone, PartialEq)]
pub struct SystemOptions {
    /// How its parts are exported.
    pub parts: AssemblyOptions,
    /// For whom.
    pub dialect: Dialect,
    /// How many parameter sets are drawn from the joints' uncertainty.
    pub draws: u32,
    /// The same seed gives the same draws; each has random numbers of its own.
    pub seed: u64,
}

impl SystemOptions {
    /// Whether the element of a joint follows the preload. Draws are of K and C, which one that does has not.
    fn follows(&self, joint: &PlacedJoint) -> bool {
        self.draws == 0 && joint.over_preload.is_some()
    }
}

/// The SSP of an assembly, and what is in it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportedSystem {
    /// Version of the FMI standard that its FMUs follow.
    pub version: FmiVersion,
    /// Name of the assembly.
    pub name: String,
    /// Names of its components, structures first.
    pub components: Vec<String>,
    /// Number of connections, those of the system's connectors among them.
    pub connections: usize,
    /// What was drawn of each joint.
    pub drawn: Vec<DrawnJoint>,
    /// Joints whose elements follow the preload, and the one that they start with, N·m.
    pub following: Vec<(String, f64)>,
    /// Its files.
    pub packed: Packed,
}

/// The SSP of an assembly, of whose file `source_toml` is the text.
///
/// The same file, options and program give the same bytes.
///
/// # Errors
///
/// [`ExportError`]: as [`assembly_fmu`], and names by which the parts cannot be told apart, draws without any uncertainty.
pub fn assembly_system(
    model: &AssemblyModel,
    source_toml: &str,
    options: &SystemOptions,
) -> Result<ExportedSystem, ExportError> {
    if options.parts.extrapolate && !model.joints.iter().any(|own| options.follows(own)) {
        return Err(ExportError::NothingToExtrapolate);
    }
    let of_structures = AssemblyOptions {
        extrapolate: false,
        ..options.parts.clone()
    };
    let parts = Parts::of(model)?;
    let draws = Draws::of(model, options)?;
    let date = options.parts.date;
    let mut files = Vec::new();
    let mut components = Vec::new();
    let mut stop_s: f64 = 0.0;
    for part in &parts.structures {
        let exported = assembly_fmu(&part.model, source_toml, &of_structures)?;
        stop_s = stop_s.max(exported.suggested_stop_s);
        files.push(fmu_file(&part.name, exported.packed.bytes()));
        components.push(Component::structure(part, options.dialect));
    }
    let mut nominal = Vec::new();
    for joint in &model.joints {
        let follows = options.follows(joint);
        let exported = element(joint, follows, &options.parts)?;
        files.push(fmu_file(&joint.name, exported.bytes()));
        components.push(Component::joint(joint));
        let named = exported.parameters.into_iter();
        nominal.extend(named.map(|(name, value)| (joint.name.clone(), name, value)));
    }
    let mut sets = vec![parameter_set::nominal(nominal)];
    sets.extend(draws.sets);
    let following = model.joints.iter().filter(|own| options.follows(own));
    let following = following.filter_map(|own| Some((own.name.clone(), own.table()?.nominal)));
    let following = following.collect();
    let text = ssd::text(&ssd::System {
        name: &model.name,
        components: &components,
        wires: &parts.wires,
        points: &parts.points,
        sets: &sets,
        dialect: options.dialect,
        stop_s,
        date,
    });
    let mut all = vec![File::text("SystemStructure.ssd", text)];
    all.extend(sets.iter().map(|set| set.file(date)));
    all.extend(files);
    let connections = match options.dialect {
        Dialect::Standard => parts.wires.len() + parts.points.len(),
        Dialect::Ecos => parts.wires.len(),
    };
    Ok(ExportedSystem {
        version: options.parts.version,
        name: model.name.clone(),
        components: components.into_iter().map(|own| own.name).collect(),
        connections,
        drawn: draws.joints,
        following,
        packed: Packed::of(all, date)?,
    })
}

fn fmu_file(name: &str, bytes: &[u8]) -> File {
    File {
        path: fmu_path(name),
        content: Content::Archive(bytes.to_vec()),
        executable: false,
    }
}

/// Where the FMU of a component is.
fn fmu_path(name: &str) -> String {
    format!("resources/{name}.fmu")
}

/// The element FMU of a joint, over the preload or at one. No connector of the system leads to the preload: masters that know no start
/// values of connectors would begin with one of zero.
fn element(
    joint: &PlacedJoint,
    follows: bool,
    options: &AssemblyOptions,
) -> Result<Exported, ExportError> {
    let file = if follows { joint.whole() } else { &joint.file };
    let source = file
        .to_json()
        .map_err(|_| bolted_joint_joint::LawError::Invalid {
            problems: file.validate(),
        })?;
    fmu_bytes(
        file,
        &source,
        &ExportOptions {
            interface: Interface::Element,
            version: options.version,
            model_identifier: None,
            step: StepWish::Accurate,
            platforms: options.platforms.clone(),
            preload_n_m: None,
            extrapolate: follows && options.extrapolate,
            allow_active: options.allow_active,
            allow_unusable: options.allow_unusable,
            date: options.date,
        },
    )
}
