//! Why a joint file cannot be exported.

use std::io;
use std::path::PathBuf;

use bolted_joint_files::whole_file::advice;
use thiserror::Error;

use bolted_joint_files::DateError;
use bolted_joint_joint::{LawError, MatrixPassivity};

/// Why a joint file cannot be exported.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The joint can feed energy into a simulation.
    #[error(
        "{}; expected K and C positive semidefinite, or the joint can feed energy into a simulation that then blows up; \
         use an estimate that is constrained to be passive, or insist with --allow-active",
        lines(matrices)
    )]
    Active {
        /// The matrices that are not positive semidefinite.
        matrices: Vec<MatrixPassivity>,
    },
    /// Whoever found the joint says that it is not to be relied on.
    #[error(
        "the joint is not to be relied on: {}; mend that and identify it again, or insist with --unusable",
        reasons.join("; ")
    )]
    NotUsable {
        /// Why, a line each.
        reasons: Vec<String>,
    },
    /// The joint file contradicts itself, has no such preload, or does not give the equations of this FMU.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Extrapolation is asked for where there is no table in the FMU.
    #[error(
        "extrapolation: found no table over the preload to go beyond, expected a joint with joint.over_preload and no --preload; \
         leave --extrapolate out"
    )]
    NothingToExtrapolate,
    /// A step size was given for the FMU that takes no steps.
    #[error(
        "step size: found {found_s:?} s for the element, expected none: the element has no states and takes no steps; \
         leave it out, or export as lap"
    )]
    StepOfElement {
        /// The step size, s.
        found_s: f64,
    },
    /// An error of the steps was given for the FMU that takes no steps.
    #[error(
        "--step-error: found {found:?} for the element, expected none: the element has no states and takes no steps; \
         leave it out, or export as lap"
    )]
    ErrorOfElement {
        /// The error, as a part of the largest values.
        found: f64,
    },
    /// An error of the steps that no step can have.
    #[error(
        "--step-error: found {found:?}, expected a number from 1e-12 to 0.1: the part of their largest values that motions and \
         joint loads may be wrong by; leave it out for an accurate step"
    )]
    ErrorOutOfRange {
        /// The error.
        found: f64,
    },
    /// No step is short enough for the error that was asked for.
    #[error(
        "--step-error: found {wanted:?}, but steps of {step_s:.2e} s still have an error of {reached:.1e}; expected at least that, \
         or a shorter step by --step-size-max"
    )]
    ErrorOutOfReach {
        /// The error, as a part of the largest values.
        wanted: f64,
        /// What was reached.
        reached: f64,
        /// The shortest step that was tried, s.
        step_s: f64,
    },
    /// A motion that would show the error of the steps does not stay finite.
    #[error(
        "--step-error: the lap's motion under loads that open the joint does not stay finite, or nothing opens it, so that no \
         error can be measured; give a step by --step-size-max"
    )]
    ErrorNotMeasured,
    /// A step size that is not positive and finite.
    #[error(
        "step size: found {found_s:?} s, expected a finite number of seconds greater than zero; leave --step-size-max out for an accurate one"
    )]
    StepNotPositive {
        /// The step size, s.
        found_s: f64,
    },
    /// A step size with which the Runge–Kutta method is unstable.
    #[error(
        "step size: found {found_s:?} s, with which RK4 is unstable: the model's largest eigenvalue is \
         |λ| = {largest_modulus:.4e} 1/s; expected at most {limit_s:?} s, or none for a step that is also accurate"
    )]
    StepUnstable {
        /// The step size, s.
        found_s: f64,
        /// Largest |λ|, 1/s.
        largest_modulus: f64,
        /// Longest stable step, s.
        limit_s: f64,
    },
    /// The eigenvalues of the lap model cannot be found.
    #[error(
        "the eigenvalues of the lap model cannot be computed; \
         check the orders of magnitude of joint and bodies in the joint file, or give a step size"
    )]
    NoSpectrum,
    /// The environment variable for reproducible dates is malformed.
    #[error(transparent)]
    Date(#[from] DateError),
    /// The folder of libraries cannot be read.
    #[error("{}: cannot be read: {source}; give a folder with one folder for each platform, such as x86_64-windows", path.display())]
    UnreadablePlatforms {
        /// Path of the folder or file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The folder of libraries holds none.
    #[error("{}: found no platform's folder, expected at least one, such as x86_64-windows", path.display())]
    NoPlatforms {
        /// Path of the folder.
        path: PathBuf,
    },
    /// A folder that is not named after a platform.
    #[error(
        "{}: is not the name of a platform in FMI 3.0, expected one of {} followed by one of {}, \
         such as x86_64-windows; rename or remove the folder",
        path.display(),
        architectures.join(", "),
        systems.join(", ")
    )]
    UnknownPlatform {
        /// Path of the folder.
        path: PathBuf,
        /// Known architectures.
        architectures: Vec<&'static str>,
        /// Known systems, with the dash before them.
        systems: Vec<&'static str>,
    },
    /// A platform's folder without its library.
    #[error("{}: not found, expected the FMU library of that platform; build it, or remove the folder", path.display())]
    NoLibrary {
        /// Path of the library.
        path: PathBuf,
    },
    /// A library in another platform's format.
    #[error("{}: is not a shared library of that platform, expected one in {format} format", path.display())]
    NotALibrary {
        /// Path of the library.
        path: PathBuf,
        /// Format of shared libraries on that platform.
        format: &'static str,
    },
    /// A parameter of the FMU that the joint file has no value for. A mistake in this program.
    #[error(
        "parameter {variable} of the model description has no counterpart in the joint file; please report this"
    )]
    NoValue {
        /// Name of the variable.
        variable: String,
    },
    /// An input or output of the FMU that the reference run computes nothing for. A mistake in this program.
    #[error(
        "{variable} of the model description is nothing that the reference run computes; please report this"
    )]
    NotComputed {
        /// Name of the variable.
        variable: String,
    },
    /// The assembly gives no equations.
    #[error(transparent)]
    Assembly(#[from] Box<bolted_joint_assembly::AssemblyError>),
    /// A name of an assembly that no variable of an FMU can have.
    #[error(
        "`{key}`: found {found:?}, expected a word of letters, digits and _ that does not begin with a digit and is none of \
         {taken}, since the FMU's variables are named by it; give it another name"
    )]
    NotAWord {
        /// Key in the assembly file.
        key: String,
        /// The name.
        found: String,
        /// Words that the FMU uses itself.
        taken: String,
    },
    /// Two variables of an assembly's FMU that have one name.
    #[error(
        "`{one}` and `{other}`: both give the FMU a variable {variable}, expected different names; rename one of them"
    )]
    SameName {
        /// The variable.
        variable: String,
        /// Key that gives it.
        one: String,
        /// The other.
        other: String,
    },
    /// A name that no library can have.
    #[error(
        "model identifier: found {found:?}, expected letters, digits and underscores with no digit in front, 128 at most, and no word of C or C++, such as Bolt_M10; \
         leave --model-identifier out for one that is made of the name"
    )]
    NotAnIdentifier {
        /// The name.
        found: String,
    },
    /// A name by which the parts of an assembly cannot be told apart.
    #[error("`{key}`: found {found}, expected {expected}")]
    Part {
        /// Key in the assembly file.
        key: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Draws are asked for where nothing is uncertain.
    #[error(
        "draws: found no standard deviation above zero in the files of the joints {}, expected `uncertainty` in one of them at least, \
         as `identify` writes it; leave --draws out",
        joints.join(", ")
    )]
    NothingToDraw {
        /// Names of the joints.
        joints: Vec<String>,
    },
    /// A joint whose deviations are so large that draws of it are hardly ever passive.
    #[error(
        "draws: of the joint {joint}, {tries} draws in a row can feed energy into a simulation, expected deviations with which it mostly \
         cannot; take a joint that is known better, or insist with --allow-active"
    )]
    NeverPassive {
        /// Name of the joint.
        joint: String,
        /// Draws that were made.
        tries: usize,
    },
    /// The model description cannot be read or written. A mistake in this program.
    #[error("model description: {0}; please report this")]
    Description(#[from] fmi_schema::Error),
    /// The model description that came out breaks the rules. A mistake in this program.
    #[error("model description as exported: {0}; please report this")]
    Interface(Box<bolted_joint_interface::InterfaceError>),
    /// The archive cannot be made.
    #[error("the FMU's archive cannot be made: {0}")]
    Archive(#[from] zip::result::ZipError),
    /// The FMU cannot be written.
    #[error("{}: cannot be written: {source}; {}", path.display(), advice(source))]
    Unwritable {
        /// Path of the FMU.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
}

fn lines<T: ToString>(items: &[T]) -> String {
    let lines: Vec<String> = items.iter().map(T::to_string).collect();
    lines.join("\n  ")
}
