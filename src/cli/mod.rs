//! The command line: arguments become a plan, the plan is run, results go to stdout, messages to stderr.

mod check;
mod demo;
mod error;
mod export;
mod identify;
mod output;
mod progress;
mod table;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::export::Interface;

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
    /// Write an FMU from a joint file
    Export(ExportArguments),
    /// Check a joint file or an FMU
    Check(CheckArguments),
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
    /// Joint file to write
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
    /// Print the findings as JSON
    #[arg(long)]
    json: bool,
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
        Command::Export(arguments) => export::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
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
