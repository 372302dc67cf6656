//! Turns `modelDescription/*.xml` into the library's tables of variables.

use std::{env, fs, path::Path, process::ExitCode};

use bolted_joint_interface::Interfaces;

fn main() -> ExitCode {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../modelDescription");
    for file in Interfaces::FILES {
        println!("cargo:rerun-if-changed={}", folder.join(file).display());
    }
    match write_tables(&folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn write_tables(folder: &Path) -> Result<(), String> {
    let interfaces =
        Interfaces::read(folder).map_err(|error| format!("modelDescription: {error}"))?;
    let out = env::var("OUT_DIR").map_err(|error| format!("OUT_DIR: {error}"))?;
    let path = Path::new(&out).join("interface.rs");
    fs::write(&path, interfaces.to_rust()).map_err(|error| format!("{}: {error}", path.display()))
}
