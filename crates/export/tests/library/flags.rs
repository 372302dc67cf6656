//! The two ways to the library, `build.rs` and the profile that `platforms/build` takes, with the same compiler flags.

use std::fs;

use toml::{Table, Value};

/// Keys of the profile, with the flags of `build.rs` that mean the same.
fn keys() -> [(&'static str, Value, &'static str); 7] {
    [
        ("opt-level", Value::Integer(3), "\"-Copt-level=3\""),
        ("codegen-units", Value::Integer(1), "\"-Ccodegen-units=1\""),
        ("panic", "unwind".into(), "\"-Cpanic=unwind\""),
        ("lto", "fat".into(), "\"-Clto=fat\""),
        ("strip", "symbols".into(), "\"-Cstrip=symbols\""),
        ("debug", Value::Boolean(false), "\"-Cdebuginfo=0\""),
        (
            "debug-assertions",
            Value::Boolean(false),
            "\"-Cdebug-assertions=no\"",
        ),
    ]
}

#[test]
fn the_profile_of_the_other_platforms_is_what_the_embedded_library_is_compiled_with() {
    let root = super::workspace();
    let manifest: Table = fs::read_to_string(root.join("Cargo.toml"))
        .unwrap()
        .parse()
        .unwrap();
    let mut profile = manifest["profile"]["fmu"].as_table().unwrap().clone();
    assert_eq!(profile.remove("inherits"), Some("release".into()));
    let script = fs::read_to_string(root.join("crates/export/build.rs")).unwrap();
    for (key, value, flag) in keys() {
        assert_eq!(profile.remove(key), Some(value), "{key}");
        assert!(script.contains(flag), "build.rs does not pass {flag}");
    }
    assert!(
        profile.is_empty(),
        "without a flag in build.rs: {profile:?}"
    );
    let flags = script.matches("\"-C").count();
    // besides: metadata and bitcode, which leave no trace in the file, and what platforms need
    let others = [
        "-Cmetadata=",
        "-Cembed-bitcode=",
        "-Clinker=",
        "-Clink-arg=",
        "-Ctarget-feature=",
    ];
    let known: usize = others
        .iter()
        .map(|flag| script.matches(&format!("\"{flag}")).count())
        .sum();
    assert_eq!(flags, keys().len() + known, "flags of build.rs");
}
