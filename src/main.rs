//! The command line of bolted-joint; everything it does is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    bolted_joint::cli::main()
}
