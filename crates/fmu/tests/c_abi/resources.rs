//! The way to the FMU's resources, in every form in which importers tell it.

use std::fs;

use crate::{
    importer::{Folder, Kind, Request, State, start_text, text, vr},
    raw::{
        BOTH, Fmi2, Fmi3,
        Interface::{CoSimulation, ModelExchange},
    },
};

/// Stiffness of the FMU with these resources, by both versions and interface types.
fn stiffness(resources: &str) -> f64 {
    let mut found = Vec::new();
    for version in BOTH {
        for interface in [CoSimulation, ModelExchange] {
            let request = Request {
                version,
                interface,
                resources: Some(resources),
                ..Request::default()
            };
            let mut instance = request
                .instantiate()
                .unwrap_or_else(|log| panic!("{resources}: {log:?}"));
            instance.go_to(State::Initialization);
            found.extend(instance.get([vr::K_YY]));
        }
    }
    assert_eq!(found, [found[0]; 4]);
    found[0]
}

#[test]
fn resources_are_found_in_all_forms() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[("joint.k_yy", 123.0)]));
    let path = text(&folder.0);
    let escaped = |escape: fn(u8) -> String, keep: fn(u8) -> bool| -> String {
        path.bytes()
            .map(|byte| {
                if byte.is_ascii_alphanumeric() || b"/-._".contains(&byte) || keep(byte) {
                    char::from(byte).to_string()
                } else {
                    escape(byte)
                }
            })
            .collect()
    };
    let lower = |byte| format!("%{byte:02x}");
    let all = escaped(lower, |_| false);
    let upper = escaped(|byte| format!("%{byte:02X}"), |_| false);
    let spaces_kept = escaped(lower, |byte| byte == b' ');
    for form in [
        path.clone(),
        format!("{path}/"),
        format!("file://{all}"),
        format!("file://{all}/"),
        format!("file://{upper}"),
        format!("file:{all}"),
        format!("file:{upper}/"),
        format!("file://localhost{all}/"),
        format!("File://LOCALHOST{all}"),
        format!("file://{spaces_kept}"),
        // not encoded at all, though "100% #1" is in the path
        format!("file://{path}"),
        format!("file:{path}/"),
        // a path that is encoded as if it were a URI
        all.clone(),
    ] {
        assert_eq!(stiffness(&form), 123.0, "{form}");
    }
}

#[test]
fn what_looks_like_an_escape_may_be_a_name() {
    let root = Folder::new("escapes");
    let make = |name: &str, stiffness: f64| {
        let folder = root.0.join(name);
        fs::create_dir_all(&folder).unwrap();
        let start = start_text(Kind::Lap, 1, &[("joint.k_yy", stiffness)]);
        fs::write(folder.join("start.txt"), start).unwrap();
    };
    let parent = text(&root.0);
    let lead_to = |expected: [(&str, f64); 3]| {
        for (location, value) in expected {
            let location = location.replace("PARENT", &parent);
            assert_eq!(stiffness(&location), value, "{location}");
        }
    };
    make("a%20b", 1.0);
    // alone it is found by an importer that encodes, and by one that does not
    let encoded = "file://PARENT/a%2520b";
    lead_to([
        (encoded, 1.0),
        ("file://PARENT/a%20b", 1.0),
        ("PARENT/a%20b", 1.0),
    ]);
    // beside its namesake each form leads where the standard says
    make("a b", 2.0);
    lead_to([
        (encoded, 1.0),
        ("file://PARENT/a%20b", 2.0),
        ("PARENT/a%20b", 1.0),
    ]);
    assert_eq!(stiffness(&format!("{parent}/a b")), 2.0);
}

#[test]
fn resources_that_cannot_be_found_are_named() {
    let folder = Folder::new("empty");
    let path = text(&folder.0);
    for (version, argument) in [(Fmi2, "fmuResourceLocation"), (Fmi3, "resourcePath")] {
        let refusal = |resources| {
            Request {
                version,
                resources,
                ..Request::default()
            }
            .refusal()
        };
        let no_uri = |location| format!("{argument} \"{location}\" is no local file URI");
        for (location, expected) in [
            (path.as_str(), &*format!("{path}/start.txt cannot be read")),
            (
                "file:///no/such/folder",
                "/no/such/folder/start.txt cannot be read",
            ),
            ("file:///a%2", "/a%2/start.txt cannot be read"),
            ("file://server/share", &no_uri("file://server/share")),
            ("file:relative", &no_uri("file:relative")),
            ("http://server/resources", "is no local file URI"),
        ] {
            let message = refusal(Some(location));
            assert!(message.contains(expected), "{message}");
        }
        // the test program is no FMU's library
        for resources in [None, Some("")] {
            let message = refusal(resources);
            assert!(message.contains("resources"), "{message}");
        }
    }
}
