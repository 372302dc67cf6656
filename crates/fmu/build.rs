//! Writes the library's tables of variables, and tells the linker what it must know.

use std::{env, fs, path::Path, process::ExitCode};

use bolted_joint_interface::Interfaces;

#[path = "linking.rs"]
mod linking;

fn main() -> ExitCode {
    match write_tables().and_then(|()| pass_linker_arguments()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn write_tables() -> Result<(), String> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=linking.rs");
    let interfaces = Interfaces::present().map_err(|error| format!("modelDescription: {error}"))?;
    let out = variable("OUT_DIR")?;
    let path = Path::new(&out).join("interface.rs");
    fs::write(&path, interfaces.to_rust()).map_err(|error| format!("{}: {error}", path.display()))
}

fn pass_linker_arguments() -> Result<(), String> {
    let system = variable("CARGO_CFG_TARGET_OS")?;
    let environment = variable("CARGO_CFG_TARGET_ENV")?;
    for argument in linking::arguments(&system, &environment) {
        println!("cargo:rustc-cdylib-link-arg={argument}");
    }
    Ok(())
}

fn variable(name: &str) -> Result<String, String> {
    env::var(name).map_err(|error| format!("{name}: {error}"))
}
