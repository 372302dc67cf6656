//! The program: the command line, and nothing else.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    bolted_joint::command_line::main()
}
