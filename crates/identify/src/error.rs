//! What can be wrong with a study and with the data that it names.

use std::path::PathBuf;

use thiserror::Error;

use bolted_joint_frf::structure::{SingularAssembly, StructureError};
use bolted_joint_frf::{Dof, FrfError};
use bolted_joint_study::StudyError;

use super::model::JointModel;

/// Why a joint cannot be identified.
#[derive(Debug, Error)]
pub enum IdentifyError {
    /// An accelerometer cannot be taken out.
    #[error(
        "{}: found no function of {point} at {point}, expected it: `accelerometer_mass` = {mass_kg} kg is taken out of what was \
         measured at {point} with it; measure it, or leave the mass to `budget.accelerometer_mass`",
        path.display()
    )]
    NoDrivePoint {
        /// The file.
        path: PathBuf,
        /// The response.
        point: Dof,
        /// The mass, kg.
        mass_kg: f64,
    },
    /// A structure cannot be computed with the mass that is known to be at the joint.
    #[error(
        "with the mass at the joint a substructure has an undamped resonance at or above {frequency_hz} Hz, where it has no finite \
         response; give it damping, or leave that line out with [frequency]"
    )]
    SingularWithMass {
        /// A line, Hz.
        frequency_hz: f64,
    },
    /// The functions of the assembly are those of one of its substructures.
    #[error(
        "{}: found the functions of {substructure} at {point}{}, expected those of both structures bolted together: name the file that was \
         measured on the assembly",
        path.display(),
        match file {
            Some(file) => format!(", as {} is a file of {substructure}, too", file.display()),
            None => ", line by line".to_owned(),
        }
    )]
    AssemblyIsSubstructure {
        /// File of the assembly's functions.
        path: PathBuf,
        /// The file that is named for both.
        file: Option<PathBuf>,
        /// A or B.
        substructure: char,
        /// A point that both have.
        point: Dof,
    },
    /// A file without the functions that are asked for, which is named for something else, too.
    #[error("{source}; the study names this file for {}: is it meant for both?", roles.join(" and for "))]
    NamedTwice {
        /// What is wrong with it.
        source: Box<FrfError>,
        /// What it is named for.
        roles: Vec<&'static str>,
    },
    /// The study cannot be used, or a file that it names cannot be read.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A universal file cannot be used.
    #[error(transparent)]
    Frf(#[from] FrfError),
    /// Modal data cannot be used.
    #[error(transparent)]
    Modal(#[from] StructureError),
    /// A function is not in the file of functions, and its modes do not have it either.
    #[error("{frf}; nor do the modes have it: {modal}")]
    NeitherMeasuredNorModal {
        /// What the file of functions lacks.
        frf: Box<IdentifyError>,
        /// What the modes lack.
        modal: Box<StructureError>,
    },
    /// Two files have different frequency axes.
    #[error(
        "{} and {} have different frequencies within {from_hz} to {to_hz} Hz: line {line} of the band is at {first} in the \
         first and {second} in the second; expected the same lines in both, so export them with the same analyser settings",
        first_path.display(),
        second_path.display()
    )]
    DifferingAxes {
        /// The file that sets the axis.
        first_path: PathBuf,
        /// The file that differs.
        second_path: PathBuf,
        /// Lower end of the band, Hz.
        from_hz: f64,
        /// Upper end of the band, Hz.
        to_hz: f64,
        /// First line that differs, from 1.
        line: usize,
        /// Frequency there in the first file, or that it has ended.
        first: String,
        /// Frequency there in the second file, or that it has ended.
        second: String,
    },
    /// Fewer lines than unknowns need.
    #[error(
        "{}: found {found} line(s) from {from_hz} to {to_hz} Hz, expected at least {needed} for joint model \"{model}\" from \
         {functions} function(s); widen `frequency` in the study or measure with finer lines",
        path.display()
    )]
    TooFewLines {
        /// File of the assembly's functions.
        path: PathBuf,
        /// Lines found in the band.
        found: usize,
        /// Lowest frequency of them, Hz.
        from_hz: f64,
        /// Highest frequency of them, Hz.
        to_hz: f64,
        /// Lines needed.
        needed: usize,
        /// Joint model.
        model: JointModel,
        /// Measured functions.
        functions: usize,
    },
    /// Each torque is to have its joint, but there are not several.
    #[error(
        "found torques {found_n_m:?} N·m of {assemblies} assemblies, expected one of each assembly and at least two different ones, for \
         each torque to have a joint of its own"
    )]
    Torques {
        /// Assemblies.
        assemblies: usize,
        /// Torques given, N·m.
        found_n_m: Vec<f64>,
    },
    /// The computed receptances have no finite value at some line.
    #[error(transparent)]
    Singular(#[from] SingularAssembly),
    /// No start led anywhere.
    #[error(
        "no estimate was found from any of {starts} starts: the receptances at the points {points} do not depend on the joint \
         within the frequency range; choose a wider range or other points"
    )]
    NoEstimate {
        /// How many starts were tried.
        starts: usize,
        /// The points.
        points: String,
    },
}
