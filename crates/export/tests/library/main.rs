//! The FMU library as a file: what it shows to the outside, what it asks of a system, and what it must not carry.
//!
//! The library under test is the one that this build embeds. With `BOLTED_JOINT_PLATFORMS` set to a folder that
//! `platforms/build` has filled, `cargo test -p bolted-joint-export --test library -- --ignored` asks the same of the libraries in there.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod documented;
mod flags;
#[cfg(all(
    target_os = "linux",
    target_env = "gnu",
    target_pointer_width = "64",
    any(target_arch = "x86_64", target_arch = "aarch64")
))]
mod old_glibc;
mod shared_library;

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use documented::Documented;
use shared_library::SharedLibrary;

/// Names of all functions of the standards' headers.
const HEADERS: [&str; 2] = [
    include_str!("../../../../tests/data/fmi/fmi2Functions.txt"),
    include_str!("../../../../tests/data/fmi/fmi3Functions.txt"),
];

/// Folder of the workspace, two above this crate's.
fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .unwrap()
}

fn embedded() -> SharedLibrary {
    SharedLibrary::read(Path::new(env!("BOLTED_JOINT_LIBRARY")))
}

/// What docs/platforms.md says of the embedded library, where it is for a platform that is spoken of there.
#[cfg(not(target_env = "musl"))]
fn documented() -> Option<Documented> {
    Documented::read()
        .into_iter()
        .find(|row| row.platform == env!("BOLTED_JOINT_PLATFORM") && row.linker == "any")
}

fn assert_exports(library: &SharedLibrary) {
    let expected: BTreeSet<&str> = HEADERS
        .iter()
        .flat_map(|names| names.lines().filter(|line| !line.starts_with('#')))
        .collect();
    assert_eq!(expected.len(), 44 + 75);
    let exported: BTreeSet<&str> = library.exports.iter().map(String::as_str).collect();
    let missing: Vec<_> = expected.difference(&exported).collect();
    let surplus: Vec<_> = exported.difference(&expected).collect();
    assert!(
        missing.is_empty() && surplus.is_empty(),
        "not exported: {missing:?}; exported, but no function of the standards: {surplus:?}"
    );
    assert_eq!(library.exports.len(), expected.len(), "exported twice");
}

fn assert_needs(library: &SharedLibrary, documented: &Documented) {
    let surplus: Vec<_> = library
        .needed
        .iter()
        .filter(|name| !documented.needed.contains(name))
        .collect();
    assert!(
        surplus.is_empty(),
        "{surplus:?} needed; docs/platforms.md names {:?} alone",
        documented.needed
    );
    assert_eq!(
        library.newest_glibc().map(|(version, _)| version),
        documented.newest_glibc,
        "newest version of the C library's symbols, needed for {:?}, and that of docs/platforms.md: if the standard \
         library or this code has come to use a newer function, see crates/fmu/old_glibc.rs",
        library.newest_glibc().map(|(_, symbols)| symbols)
    );
}

fn assert_hardened(library: &SharedLibrary) {
    assert_eq!(library.weaknesses, Vec::<String>::new());
}

/// Folders of the machine that has built the library, which would be paths of somebody's home in everybody's FMUs.
fn private_folders() -> Vec<String> {
    let build = Path::new(env!("BOLTED_JOINT_LIBRARY"));
    let mut folders = vec![
        workspace().display().to_string(),
        build.parent().unwrap().display().to_string(),
    ];
    for variable in ["HOME", "USERPROFILE", "CARGO_HOME", "RUSTUP_HOME"] {
        folders.extend(env::var(variable).ok());
    }
    folders.retain(|folder| folder.len() > 1);
    folders
}

fn assert_no_private_folder(library: &SharedLibrary) {
    for folder in private_folders() {
        let at = library
            .bytes
            .windows(folder.len())
            .position(|window| window == folder.as_bytes());
        assert_eq!(at, None, "{folder} is in the file at this place");
    }
}

#[test]
fn exactly_the_functions_of_the_standards_headers_are_exported() {
    assert_exports(&embedded());
}

/// The guide speaks of the GNU C library; another one has no versions of symbols.
#[cfg(not(target_env = "musl"))]
#[test]
fn nothing_is_needed_but_what_the_guide_says() {
    let library = embedded();
    match documented() {
        Some(documented) => assert_needs(&library, &documented),
        None => assert!(
            !env!("BOLTED_JOINT_PLATFORM").ends_with("-linux"),
            "docs/platforms.md has no row for the embedded library"
        ),
    }
    assert!(
        library
            .needed
            .iter()
            .all(|name| !name.contains(['/', '\\']) || name.starts_with("/usr/lib/")),
        "{:?}",
        library.needed
    );
}

#[test]
fn the_stack_is_not_executable_and_relocated_data_is_read_only() {
    assert_hardened(&embedded());
}

#[test]
fn no_folder_of_the_building_machine_is_in_the_file() {
    assert_no_private_folder(&embedded());
}

#[test]
#[ignore = "needs BOLTED_JOINT_PLATFORMS, a folder that platforms/build has filled"]
fn the_libraries_of_all_platforms_are_as_the_guide_says() {
    let folder = PathBuf::from(
        env::var_os("BOLTED_JOINT_PLATFORMS")
            .unwrap_or_else(|| panic!("BOLTED_JOINT_PLATFORMS is not set")),
    );
    let documented = Documented::read();
    let mut count = 0;
    for entry in fs::read_dir(&folder).unwrap() {
        let entry = entry.unwrap();
        let platform = entry.file_name().into_string().unwrap();
        if platform.starts_with('.') || !entry.path().is_dir() {
            continue;
        }
        let file = fs::read_dir(entry.path()).unwrap().next().unwrap().unwrap();
        let library = SharedLibrary::read(&file.path());
        println!("{platform}: {}", library.summary());
        // a platform has a row for each way to its library
        let rows: Vec<_> = documented
            .iter()
            .filter(|row| row.platform == platform && row.linker != "any")
            .collect();
        let row = rows
            .iter()
            .find(|row| library.needed.iter().all(|name| row.needed.contains(name)))
            .or(rows.first())
            .unwrap_or_else(|| panic!("docs/platforms.md has no row for {platform}"));
        assert_eq!(library.platform, platform);
        assert_exports(&library);
        assert_needs(&library, row);
        assert_hardened(&library);
        assert_no_private_folder(&library);
        count += 1;
    }
    assert!(count > 0, "{}: no platform's folder", folder.display());
}
