//! The command line: arguments become a plan, the plan is run, results go to stdout, messages to stderr.
//!
//! A command is a file, which also says what its arguments are.
#![forbid(unsafe_code)]

mod bolt_files;
mod check;
mod communication_step;
mod demo;
mod error;
mod export;
mod identified_from;
mod identify;
mod output;
mod predict;
mod progress;
mod reproduce;
mod respond;
mod table;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use check::{CheckArguments, RunLibraryArguments};
use demo::DemoArguments;
use export::ExportArguments;
use identify::IdentifyArguments;
use predict::PredictArguments;
use reproduce::ReproduceArguments;
use respond::RespondArguments;

/// Turns measurements of a bolted joint into an FMU that any FMI tool can run.
#[derive(Debug, Parser)]
#[command(
    name = "bolted-joint",
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
    /// Compute published tables anew, of Tol's, Pirdayr's, Tian's or Kavi's, published and obtained values side by side
    Reproduce(ReproduceArguments),
}

fn main() -> ExitCode {
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
            ExitCode::from(error.exit_code())
        }
    }
}
