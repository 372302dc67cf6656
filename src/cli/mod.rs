//! The command line: arguments become a plan, the plan is run, results go to stdout, messages to stderr.

mod bolt_files;
mod check;
mod communication_step;
mod demo;
mod error;
mod export;
mod identified_from;
mod identify;
mod lap;
mod output;
mod predict;
mod progress;
mod reproduce;
mod reproduce_kavi;
mod reproduce_pirdayr;
mod reproduce_tian;
mod respond;
mod respond_lap;
mod table;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::export::{self as fmu, Interface};

/// Turns measurements of a bolted joint into an FMU that any FMI tool can run.
#[derive(Debug, Parser)]
#[command(
    name = "bolted-joint",
    version,
    after_help = "Exit codes: 0 done, 1 the input is wrong (the message says where, and what to do), 2 wrong usage."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Identify a joint from built-in data, write its joint file and FMUs, and draw the fit
    Demo(DemoArguments),
    /// Identify the joint of a study and write its joint file
    Identify(IdentifyArguments),
    /// Predict a joint from surfaces, materials and bolts, before anything is built, and write its joint file
    Predict(PredictArguments),
    /// Write an FMU from a joint file
    Export(ExportArguments),
    /// Check a joint file or an FMU, and run the FMU's library for a moment
    Check(CheckArguments),
    /// Run the library of an FMU for `check`, in a process of its own
    #[command(name = check::RUN_LIBRARY, hide = true)]
    RunLibrary(RunLibraryArguments),
    /// Compute what a test of a study's assembly would measure, with or without noise, or how laps respond
    Respond(RespondArguments),
    /// Compute the published tables of Tol's thesis, of Pirdayr's or Tian's paper or of Kavi's thesis anew, published and obtained values
    /// side by side
    Reproduce(ReproduceArguments),
}

/// `demo`
#[derive(Debug, Args)]
struct DemoArguments {
    /// Folder for everything that is written; it is made if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "bolted-joint-demo")]
    output: PathBuf,
    /// Seed of the measurement noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Relative standard deviation of the measurement noise
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.01,
        allow_hyphen_values = true
    )]
    noise: f64,
}

/// `identify`
#[derive(Debug, Args)]
struct IdentifyArguments {
    /// The study: what was measured, on which points, and which joint model to identify (TOML)
    study: PathBuf,
    /// Joint file to write; NAME.BOLT.joint.json for each bolt where bolts have different joints
    #[arg(short, long, value_name = "NAME.joint.json")]
    output: PathBuf,
    /// Also draw measured and regenerated FRFs
    #[arg(long, value_name = "NAME.svg")]
    figure: Option<PathBuf>,
    /// Also write a report: one page with everything that was measured, assumed and found
    #[arg(long, value_name = "NAME.html")]
    report: Option<PathBuf>,
    /// Repeat the estimate on so many data sets drawn from the fitted model
    #[arg(long, value_name = "DRAWS", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    bootstrap: Option<u32>,
    /// Seed of the bootstrap [default: 1]
    #[arg(long, requires = "bootstrap")]
    seed: Option<u64>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// `predict`
#[derive(Debug, Args)]
struct PredictArguments {
    /// The study: surfaces, materials, bolts and the model to take (TOML)
    study: PathBuf,
    /// Joint file to write
    #[arg(short, long, value_name = "NAME.joint.json")]
    output: PathBuf,
    /// Also write a report: one page with assumptions, surfaces, pressure, stiffness and damping
    #[arg(long, value_name = "NAME.html")]
    report: Option<PathBuf>,
    /// Also write the 6×6 stiffness and damping of the interface as a table
    #[arg(long, value_name = "NAME.csv")]
    matrix_csv: Option<PathBuf>,
    /// Also write them as an ANSYS macro of MATRIX27 elements between two nodes
    #[arg(long, value_name = "NAME.mac")]
    matrix27: Option<PathBuf>,
    /// Also write pressure, stiffness and damping of each element of the interface
    #[arg(long, value_name = "NAME.csv")]
    field_csv: Option<PathBuf>,
    /// Also write the virtual layer's material (method virtual-material): a table, or a card for Abaqus or ANSYS
    #[arg(long, value_name = "NAME.csv|NAME.inp|NAME.mac")]
    material_card: Option<PathBuf>,
    /// Also write frequencies and damping over the amplitude (method layered-beam)
    #[arg(long, value_name = "NAME.csv")]
    damping_csv: Option<PathBuf>,
    /// Also draw damping over the amplitude (method layered-beam)
    #[arg(long, value_name = "NAME.svg")]
    figure: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// `export`
#[derive(Debug, Args)]
struct ExportArguments {
    /// Joint file (JSON)
    joint_file: PathBuf,
    /// FMU to write
    #[arg(short, long, value_name = "NAME.fmu")]
    output: PathBuf,
    /// Interface of the FMU
    #[arg(
        long = "as",
        value_enum,
        value_name = "INTERFACE",
        default_value = "element"
    )]
    interface: InterfaceArgument,
    /// Version of the FMI standard
    #[arg(long, value_enum, value_name = "VERSION", default_value = "3")]
    fmi: FmiVersion,
    /// Longest Runge–Kutta step of a lap FMU, s [default: from its fastest mode]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    step_size_max: Option<f64>,
    /// Preload at which a joint over the preload is frozen, N·m [default: the FMU has the preload as an input]
    #[arg(long, value_name = "TORQUE", allow_hyphen_values = true)]
    preload: Option<f64>,
    /// Hold a joint over the preload beyond the ends of its table, where its FMU else refuses the preload
    #[arg(long, conflicts_with = "preload")]
    extrapolate: bool,
    /// Folder with libraries for other platforms: DIR/<platform>/bolted_joint.{so,dll,dylib}
    #[arg(long, value_name = "DIR")]
    platforms: Option<PathBuf>,
    /// Export a joint that can feed energy into a simulation
    #[arg(long)]
    allow_active: bool,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
}

/// `check`
#[derive(Debug, Args)]
struct CheckArguments {
    /// Joint file or FMU
    file: PathBuf,
    /// Only look into the FMU: run none of its code. Without this its library is run, in a process of its own
    #[arg(long)]
    no_run: bool,
    #[command(flatten)]
    neighbours: communication_step::NeighbourArguments,
    /// Print the findings as JSON
    #[arg(long)]
    json: bool,
}

/// The child process of `check`
#[derive(Debug, Args)]
struct RunLibraryArguments {
    /// What to do
    script: PathBuf,
    /// What was done
    journal: PathBuf,
}

/// `respond`
#[derive(Debug, Args)]
struct RespondArguments {
    /// The study (TOML): of the assembly that a test is for, whose file need not exist yet, or of method `respond`, which names
    /// laps and what is done to them
    study: PathBuf,
    /// The joint that the assembly is to have (joint file); NAME.BOLT.joint.json of each bolt where they differ
    #[arg(long, value_name = "NAME.joint.json")]
    joint: Option<PathBuf>,
    /// File to write: a table or, of an assembly, a universal file
    #[arg(short, long, value_name = "NAME.csv|NAME.uff")]
    output: PathBuf,
    /// Distance between the lines of an assembly, Hz [default: 0.25]
    #[arg(long, value_name = "HZ", allow_hyphen_values = true)]
    step: Option<f64>,
    /// Also draw the response of laps
    #[arg(long, value_name = "NAME.svg|NAME.html")]
    report: Option<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
    #[command(subcommand)]
    noise: Option<RespondNoise>,
}

#[derive(Debug, Subcommand)]
enum RespondNoise {
    /// Give the functions the noise of a measurement
    Noise(NoiseArguments),
}

#[derive(Debug, Args)]
struct NoiseArguments {
    /// How the noise gets into the functions
    #[arg(value_enum)]
    procedure: NoiseProcedure,
    /// Standard deviation: of the factor, or as a fraction of the highest response
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.01,
        allow_hyphen_values = true
    )]
    level: f64,
    /// Samples of each harmonic test, for `response`
    #[arg(long, value_name = "NUMBER", default_value_t = 4096)]
    samples: u32,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum NoiseProcedure {
    /// Every value times a real normal factor of mean one
    Frf,
    /// White noise on response and force of a harmonic test at each line
    Response,
}

/// `reproduce`
#[derive(Debug, Args)]
#[command(after_help = reproduce::names())]
struct ReproduceArguments {
    /// Tables, such as 4.6, or steps of chapter 5, such as m10x16 [default: all]; or `pirdayr` or `tian` for the tables of their papers,
    /// or `kavi` for the specimens of his thesis
    tables: Vec<reproduce::Source>,
    /// Draws of the noise, for mean and spread
    #[arg(long, value_name = "NUMBER", default_value_t = 100)]
    draws: u32,
    /// Seed of the draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Samples of each harmonic test in response pollution, which the thesis does not give; may be given several times
    #[arg(long, value_name = "NUMBER", default_values_t = [4096, 16_777_216])]
    samples: Vec<u32>,
    /// Print the tables as JSON
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print the tables as a document in Markdown
    #[arg(long)]
    markdown: bool,
    /// Also draw damping over what is varied, for `kavi`
    #[arg(long, value_name = "NAME.svg")]
    figure: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum InterfaceArgument {
    /// The massless joint between two structures: motion in, force out
    Element,
    /// Two supported bodies and the joint between them: loads in, motion out
    Lap,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum FmiVersion {
    /// FMI 3.0
    #[value(name = "3")]
    Three,
    /// FMI 2.0
    #[value(name = "2")]
    Two,
}

impl From<FmiVersion> for fmu::FmiVersion {
    fn from(argument: FmiVersion) -> Self {
        match argument {
            FmiVersion::Three => Self::V3,
            FmiVersion::Two => Self::V2,
        }
    }
}

impl From<InterfaceArgument> for Interface {
    fn from(argument: InterfaceArgument) -> Self {
        match argument {
            InterfaceArgument::Element => Self::Element,
            InterfaceArgument::Lap => Self::Lap,
        }
    }
}

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Identify(arguments) => identify::run(&arguments),
        Command::Predict(arguments) => predict::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::RunLibrary(arguments) => check::run_library(&arguments),
        Command::Respond(arguments) => respond::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is_closed_output() => ExitCode::SUCCESS,
        Err(error) => {
            output::message(&format!("error: {error}"));
            ExitCode::from(1)
        }
    }
}
