//! The command line: arguments become a plan, the plan is run, results go to stdout, messages to stderr.
//!
//! A command is a file, which also says what its arguments are.

mod bolt_files;
mod check;
mod communication_step;
mod compare;
mod convert;
mod demo;
mod draws;
mod error;
mod export;
mod flexible_neighbours;
mod identified_from;
mod identify;
mod init;
mod invocation;
mod kind;
mod merge;
mod named_files;
mod output;
mod predict;
mod progress;
mod reproduce;
mod respond;
mod schema;
mod shell;
mod show;
mod table;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};

use check::{CheckArguments, RunLibraryArguments};
use compare::CompareArguments;
use convert::ConvertArguments;
use demo::DemoArguments;
use export::ExportArguments;
use identify::IdentifyArguments;
use init::InitArguments;
use merge::MergeArguments;
use predict::PredictArguments;
use reproduce::ReproduceArguments;
use respond::RespondArguments;
use shell::{CompletionsArguments, ManArguments};
use show::ShowArguments;

pub use invocation::{Answer, Call, Program};

/// The program's name.
const NAME: &str = "bolted-joint";

/// Turns measurements of a bolted joint into an FMU that any FMI tool can run.
#[derive(Debug, Parser)]
#[command(
    name = NAME,
    version,
    after_help = "Exit codes: 0 done, 1 the input is wrong (the message says where, and what to do), 2 wrong usage, \
                  3 done, but the result is not to be relied on (the message says why)."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Identify a joint from built-in data, write its joint file and FMUs, and draw the fit
    Demo(DemoArguments),
    /// Write a first study from the files of a folder, with comments on what to decide
    Init(InitArguments),
    /// Identify the joint of a study and write its joint file
    Identify(IdentifyArguments),
    /// Predict a joint from surfaces, materials and bolts, before anything is built, and write its joint file
    Predict(PredictArguments),
    /// Put draws together that were made in parts, on one machine or on many
    Merge(MergeArguments),
    /// Write an FMU from a joint file
    Export(ExportArguments),
    /// Tell what is in measurements, studies, joint files, FMUs, modes and assemblies, and draw it
    Show(ShowArguments),
    /// Put joint files beside each other: values, and differences in standard deviations
    Compare(CompareArguments),
    /// Write a joint for Nastran, Abaqus, CalculiX, ANSYS, MATLAB or Modelica
    Convert(ConvertArguments),
    /// Check a joint file, an assembly file, an FMU or a system of FMUs (SSP), and run the FMUs' libraries for a moment
    Check(CheckArguments),
    /// Run the library of an FMU for `check`, in a process of its own
    #[command(name = check::RUN_LIBRARY, hide = true)]
    RunLibrary(RunLibraryArguments),
    /// Compute what a test of a study's assembly would measure, with or without noise, or how laps respond
    Respond(RespondArguments),
    /// Compute published tables anew, of Tol's, Pirdayr's, Tian's or Kavi's, published and obtained values side by side
    Reproduce(ReproduceArguments),
    /// Print what a shell needs to complete commands and options
    Completions(CompletionsArguments),
    /// Write pages for `man`
    Man(ManArguments),
}

/// Runs the command line of this process: results go to standard output, messages to standard error.
#[must_use]
pub fn main() -> ExitCode {
    ExitCode::from(run(Arguments::parse()))
}

/// Runs the command line for a program that is started as `program` and has these arguments; gives the exit code.
#[must_use]
pub fn main_of(program: Program, arguments: Vec<OsString>) -> u8 {
    invocation::printing(program, || match parsed(arguments) {
        Ok(arguments) => run(arguments),
        Err(other) => {
            // as clap does: nobody is left to tell
            let _ = other.print();
            exit_code(&other)
        }
    })
}

/// Runs a command within another program and keeps what it prints.
///
/// Nothing of the process is used but the current folder. What the command writes, it writes.
#[must_use]
pub fn call(call: Call) -> Answer {
    let Call { arguments, program } = call;
    invocation::keeping(program, || match parsed(arguments) {
        Ok(arguments) => run(arguments),
        Err(other) => {
            output::message(&other.to_string());
            exit_code(&other)
        }
    })
}

fn parsed(arguments: Vec<OsString>) -> Result<Arguments, clap::Error> {
    Arguments::try_parse_from([OsString::from(NAME)].into_iter().chain(arguments))
}

fn exit_code(other: &clap::Error) -> u8 {
    u8::try_from(other.exit_code()).unwrap_or(USAGE)
}

/// The exit code for wrong usage.
const USAGE: u8 = 2;

/// Runs a command and gives what the process is to end with.
fn run(arguments: Arguments) -> u8 {
    output::begin();
    let result = match arguments.command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Init(arguments) => init::run(&arguments),
        Command::Identify(arguments) => identify::run(&arguments),
        Command::Predict(arguments) => predict::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Show(arguments) => show::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::RunLibrary(arguments) => check::run_library(&arguments),
        Command::Respond(arguments) => respond::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Completions(arguments) => shell::completions(&arguments, Arguments::command()),
        Command::Man(arguments) => shell::man(&arguments, Arguments::command()),
    };
    match result {
        Ok(()) => 0,
        Err(error) if error.is_closed_output() => 0,
        Err(error) => {
            output::message(&format!("error: {error}"));
            error.exit_code()
        }
    }
}
