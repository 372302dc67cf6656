//! Instantiation: versions, the token, names, types, options that are not offered.

use std::{
    ffi::{CStr, CString, c_int},
    ptr,
};

use bolted_joint_importer::header::{fmi2::*, fmi3::*};

use crate::{
    importer::{Folder, Kind, Message, Request, TOKEN, record, record_fmi2, start_text, text, vr},
    raw::{
        BOTH, Fmi2, Fmi3, FmiVersion,
        Interface::{CoSimulation, ModelExchange},
    },
    rows::{reference, rows},
};

#[test]
fn versions_of_the_headers() {
    // SAFETY: the library returns terminated strings
    unsafe {
        assert_eq!(CStr::from_ptr(fmi2GetTypesPlatform()), c"default");
        assert_eq!(CStr::from_ptr(fmi2GetVersion()), c"2.0");
        assert_eq!(CStr::from_ptr(fmi3GetVersion()), c"3.0");
    }
}

#[test]
fn name_token_and_resources_are_checked() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 2, &[]));
    let path = text(&folder.0);
    for version in BOTH {
        let argument = match version {
            Fmi2 => "fmuGUID",
            Fmi3 => "instantiationToken",
        };
        for interface in [CoSimulation, ModelExchange] {
            let good = Request {
                version,
                interface,
                resources: Some(&path),
                ..Request::default()
            };
            assert!(good.instantiate().is_ok());
            for (name, expected) in [
                (None, "argument instanceName is a null pointer"),
                (Some(""), "argument instanceName is an empty string"),
                (Some(" \t"), "argument instanceName is an empty string"),
            ] {
                Request { name, ..good }.refuses(expected);
            }
            let expected = format!("argument {argument} is a null pointer");
            let token = None;
            Request { token, ..good }.refuses(&expected);
            for other in ["", "another", "{7f0c-4a}", "7f0c-4a} #1", "{{7f0c-4a} #1}"] {
                let token = Some(other);
                // a literal '#' is doubled
                let [other, own] = [other, TOKEN].map(|token| token.replace('#', "##"));
                let expected =
                    format!("{argument} is \"{other}\", but the FMU's resources have \"{own}\"");
                Request { token, ..good }.refuses(&expected);
            }
            let resources = Some("/nowhere");
            Request { resources, ..good }.refuses("cannot be read");
        }
    }
}

#[test]
fn required_intermediate_variables_are_checked() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = text(&folder.0);
    fn request<'a>(path: &'a str, intermediate: &'a [u32]) -> Request<'a> {
        Request {
            resources: Some(path),
            updated: true,
            intermediate,
            ..Request::default()
        }
    }
    let offered = [
        vr::A_Y,
        vr::B_V,
        vr::A_F,
        vr::JOINT_F,
        vr::ENERGY,
        vr::A_ACCELERATION,
    ];
    assert!(request(&path, &offered).instantiate().is_ok());
    const REFUSED: &str = "
        time       | variable time has no intermediateUpdate
        joint.k_yy | variable joint.k_yy has no intermediateUpdate in modelDescription.xml
        2          | value reference 2 does not exist
        52         | value reference 52 does not exist
    ";
    for [name, expected] in rows(REFUSED) {
        request(&path, &[vr::A_F, reference(name)]).refuses(expected);
    }
    let without_callback = Request {
        updated: false,
        ..request(&path, &[vr::A_F])
    };
    without_callback.refuses("the callback intermediateUpdate is a null pointer");
}

/// Tries to instantiate with texts that need not be UTF-8, and a type; the messages.
fn messages(
    version: FmiVersion,
    [name, token, resources]: [&CStr; 3],
    fmu_type: c_int,
) -> Vec<Message> {
    let mut log: Vec<Message> = Vec::new();
    let environment = (&raw mut log).cast();
    let [name, token, resources] = [name, token, resources].map(CStr::as_ptr);
    let functions = CallbackFunctions {
        logger: Some(variadic(record_fmi2)),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment,
    };
    // SAFETY: strings are terminated, the log outlives the call
    let handle = unsafe {
        match version {
            Fmi2 => fmi2Instantiate(name, fmu_type, token, resources, &raw const functions, 0, 1),
            Fmi3 => fmi3InstantiateCoSimulation(
                name,
                token,
                resources,
                0,
                0,
                0,
                0,
                ptr::null(),
                0,
                environment,
                Some(record),
                None,
            ),
        }
    };
    assert!(handle.is_null());
    log
}

#[test]
fn text_that_is_not_utf8_is_refused() {
    let folder = Folder::with_start(&start_text(Kind::Element, 1, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    let (name, bad) = (c"joint", c"\xff\xfe");
    // the name as FMI 2.0 hands it back would be no text either
    for (version, texts, argument) in [
        (Fmi2, [name, bad, &path], "fmuGUID"),
        (Fmi2, [name, &token, bad], "fmuResourceLocation"),
        (Fmi3, [bad, &token, &path], "instanceName"),
        (Fmi3, [name, bad, &path], "instantiationToken"),
        (Fmi3, [name, &token, bad], "resourcePath"),
    ] {
        let log = messages(version, texts, CO_SIMULATION);
        let expected = format!("argument {argument} is not UTF-8");
        assert!(log[0].text.contains(&expected), "{log:?}");
    }
    // SAFETY: the strings are terminated, nobody wants messages
    let instance = unsafe {
        fmi2Instantiate(
            bad.as_ptr(),
            1,
            token.as_ptr(),
            path.as_ptr(),
            ptr::null(),
            0,
            1,
        )
    };
    assert!(instance.is_null());
}

#[test]
fn other_types_of_fmus_are_refused() {
    let folder = Folder::with_start(&start_text(Kind::Element, 1, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    for fmu_type in [2, -1, c_int::MAX] {
        let log = messages(Fmi2, [c"joint", &token, &path], fmu_type);
        let expected = format!("fmuType is {fmu_type}, expected 0 (fmi2ModelExchange) or 1");
        assert!(log[0].text.contains(&expected), "{log:?}");
    }
}

#[test]
fn scheduled_execution_is_refused() {
    let mut log: Vec<Message> = Vec::new();
    // SAFETY: strings are terminated, the log outlives the call
    unsafe {
        let handle = fmi3InstantiateScheduledExecution(
            c"joint".as_ptr(),
            c"token".as_ptr(),
            ptr::null(),
            0,
            0,
            (&raw mut log).cast(),
            Some(record),
            None,
            None,
            None,
        );
        assert!(handle.is_null());
    }
    assert_eq!(log.len(), 1);
    assert!(
        log[0]
            .text
            .starts_with("fmi3InstantiateScheduledExecution: is not provided"),
        "{log:?}"
    );
}
