//! Instantiation: versions, GUID, type, resource locations in every form.

use std::{
    ffi::{CStr, c_int},
    fs, ptr,
};

use super::{
    c,
    importer::{Message, Request, State},
};
use crate::importer::{Folder, Kind, TOKEN, start_text, text, vr};

/// The one reason why there is no instance.
fn refusal(request: &Request<'_>) -> String {
    let Err(log) = request.instantiate() else {
        panic!("instantiated");
    };
    let [message] = log.as_slice() else {
        panic!("{log:?}");
    };
    let Message {
        instance_name,
        status,
        category,
        text,
    } = message;
    assert_eq!((*status, category.as_str()), (c::ERROR, "logStatusError"));
    assert_eq!(instance_name, request.name.unwrap_or(""));
    assert!(text.starts_with("fmi2Instantiate: "), "{text}");
    text.clone()
}

#[test]
fn versions_of_the_headers() {
    // SAFETY: the library returns terminated strings
    unsafe {
        assert_eq!(CStr::from_ptr(c::fmi2GetTypesPlatform()), c"default");
        assert_eq!(CStr::from_ptr(c::fmi2GetVersion()), c"2.0");
    }
}

#[test]
fn resource_locations_in_all_forms() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[("joint.k_yy", 123.0)]));
    let path = text(&folder.0);
    let escaped = |keep: fn(u8) -> bool| -> String {
        path.bytes()
            .map(|byte| {
                if byte.is_ascii_alphanumeric() || b"/-._".contains(&byte) || keep(byte) {
                    char::from(byte).to_string()
                } else {
                    format!("%{byte:02x}")
                }
            })
            .collect()
    };
    let all = escaped(|_| false);
    let spaces_kept = escaped(|byte| byte == b' ');
    for form in [
        format!("file://{all}"),
        format!("file://{all}/"),
        format!("file:{all}"),
        format!("file://localhost{all}/"),
        format!("File://LOCALHOST{all}"),
        format!("file://{spaces_kept}"),
        // not encoded at all, though "100% #1" is in the path
        format!("file://{path}"),
        format!("file:{path}/"),
        path.clone(),
        format!("{path}/"),
        // a path that is encoded as if it were a URI
        all.clone(),
    ] {
        for fmu_type in [c::CO_SIMULATION, c::MODEL_EXCHANGE] {
            let request = Request {
                fmu_type,
                resources: Some(&form),
                ..Request::default()
            };
            let mut instance = request
                .instantiate()
                .unwrap_or_else(|log| panic!("{form}: {log:?}"));
            assert_eq!(instance.set_up(0.0, None), c::OK);
            assert_eq!(instance.enter_initialization(), c::OK);
            assert_eq!(instance.get([vr::K_YY]), [123.0], "{form}");
        }
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
    let stiffness = |location: String| {
        let request = Request {
            resources: Some(&location),
            ..Request::default()
        };
        let mut instance = request.instantiate().unwrap();
        instance.go_to(State::Initialization);
        instance.get([vr::K_YY])[0]
    };
    let parent = text(&root.0);
    make("a%20b", 1.0);
    // alone it is found by an importer that encodes, and by one that does not
    assert_eq!(stiffness(format!("file://{parent}/a%2520b")), 1.0);
    assert_eq!(stiffness(format!("file://{parent}/a%20b")), 1.0);
    assert_eq!(stiffness(format!("{parent}/a%20b")), 1.0);
    // beside its namesake each form leads where the standard says
    make("a b", 2.0);
    assert_eq!(stiffness(format!("file://{parent}/a%2520b")), 1.0);
    assert_eq!(stiffness(format!("file://{parent}/a%20b")), 2.0);
    assert_eq!(stiffness(format!("{parent}/a%20b")), 1.0);
    assert_eq!(stiffness(format!("{parent}/a b")), 2.0);
}

#[test]
fn resources_that_cannot_be_found_are_named() {
    let folder = Folder::new("empty");
    let path = text(&folder.0);
    for (location, expected) in [
        (path.as_str(), "start.txt cannot be read"),
        (
            "file:///no/such/folder",
            "/no/such/folder/start.txt cannot be read",
        ),
        ("file:///a%2", "/a%2/start.txt cannot be read"),
        (
            "file://server/share",
            "fmuResourceLocation \"file://server/share\" is no local file URI",
        ),
        (
            "file:relative",
            "fmuResourceLocation \"file:relative\" is no local file URI",
        ),
        ("http://server/resources", "is no local file URI"),
    ] {
        let message = refusal(&Request {
            resources: Some(location),
            ..Request::default()
        });
        assert!(message.contains(expected), "{message}");
    }
    // the test program is no FMU's library
    for resources in [None, Some("")] {
        let message = refusal(&Request {
            resources,
            ..Request::default()
        });
        assert!(message.contains("resources"), "{message}");
    }
    fs::write(
        folder.0.join("start.txt"),
        "bolted-joint-start/1\nmodel spring\n",
    )
    .unwrap();
    let message = refusal(&Request {
        resources: Some(&path),
        ..Request::default()
    });
    assert!(
        message.contains("start.txt, line 2: found \"model spring\""),
        "{message}"
    );
}

#[test]
fn name_guid_and_type_are_checked() {
    let folder = Folder::with_start(&start_text(Kind::Element, 1, &[]));
    let path = text(&folder.0);
    let with = |name, guid, fmu_type| {
        refusal(&Request {
            name,
            guid,
            fmu_type,
            resources: Some(&path),
            ..Request::default()
        })
    };
    let (name, guid, co) = (Some("joint"), Some(TOKEN), c::CO_SIMULATION);
    assert!(with(None, guid, co).contains("argument instanceName is a null pointer"));
    assert!(with(Some(""), guid, co).contains("argument instanceName is an empty string"));
    assert!(with(Some(" \t"), guid, co).contains("argument instanceName is an empty string"));
    assert!(with(name, None, co).contains("argument fmuGUID is a null pointer"));
    for other in ["", "{7f0c-4a}", "7f0c-4a} #1", "{{7f0c-4a} #1}"] {
        let message = with(name, Some(other), co);
        assert!(
            message.contains(&format!("fmuGUID is \"{}\", but", other.replace('#', "##"))),
            "{message}"
        );
    }
    for fmu_type in [2, -1, c_int::MAX] {
        let message = with(name, guid, fmu_type);
        let expected = format!("fmuType is {fmu_type}, expected 0 (fmi2ModelExchange) or 1");
        assert!(message.contains(&expected), "{message}");
    }
}

#[test]
fn text_that_is_not_utf8_is_refused() {
    let folder = Folder::with_start(&start_text(Kind::Element, 1, &[]));
    let path = std::ffi::CString::new(text(&folder.0)).unwrap();
    let token = std::ffi::CString::new(TOKEN).unwrap();
    let bad = c"\xff\xfe".as_ptr();
    let (name, guid, path) = (c"joint".as_ptr(), token.as_ptr(), path.as_ptr());
    for [name, guid, path] in [[bad, guid, path], [name, bad, path], [name, guid, bad]] {
        // SAFETY: the strings are terminated, nobody wants messages
        let instance = unsafe { c::fmi2Instantiate(name, 1, guid, path, ptr::null(), 0, 1) };
        assert!(instance.is_null());
    }
}
