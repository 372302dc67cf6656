//! What the FMU library's linker is told on each platform: for both build scripts that link it, the executable's and
//! this crate's own, so that every way to the library ends in the same kind of file.

/// Arguments for the C compiler that links (for the linker itself with `msvc`), by `CARGO_CFG_TARGET_OS` and
/// `CARGO_CFG_TARGET_ENV`.
pub(crate) fn arguments(system: &str, environment: &str) -> &'static [&'static str] {
    match (system, environment) {
        ("linux", _) => &["-Wl,--build-id=none"],
        // the default install name is the path on the building machine
        ("macos", _) => &["-install_name", "@rpath/bolted_joint.dylib"],
        // no time stamp in the file
        ("windows", "msvc") => &["/Brepro", "/DEBUG:NONE"],
        ("windows", _) => &["-Wl,--no-insert-timestamp"],
        _ => &[],
    }
}
