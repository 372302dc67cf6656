//! Instantiation: the token, names, options that are not offered.

use std::{ffi::CStr, ptr};

use crate::{
    c,
    importer::{Folder, Kind, Message, Request, TOKEN, start_text, text, vr},
};

/// The one reason why there is no instance.
pub(crate) fn refusal(request: &Request<'_>) -> String {
    match request.instantiate() {
        Ok(_) => panic!("instantiated"),
        Err(log) => {
            let [
                Message {
                    status,
                    category,
                    text,
                },
            ] = log.as_slice()
            else {
                panic!("{log:?}");
            };
            assert_eq!((*status, category.as_str()), (c::ERROR, "logStatusError"));
            assert!(text.starts_with("fmi3InstantiateCoSimulation: "), "{text}");
            text.clone()
        }
    }
}

pub(crate) fn lap() -> String {
    start_text(Kind::Lap, 2, &[])
}

#[test]
fn version() {
    // SAFETY: the library returns a terminated string
    assert_eq!(unsafe { CStr::from_ptr(c::fmi3GetVersion()) }, c"3.0");
}

#[test]
fn another_token_is_refused() {
    let folder = Folder::with_start(&lap());
    let path = text(&folder.0);
    let request = |token| Request {
        token,
        resources: Some(&path),
        ..Request::default()
    };
    let message = refusal(&request(Some("another")));
    assert!(
        message.contains("instantiationToken is \"another\"")
            && message.contains("\"{7f0c-4a} ##1\""),
        "{message}"
    );
    assert!(refusal(&request(None)).contains("argument instantiationToken is a null pointer"));
    assert!(request(Some(TOKEN)).instantiate().is_ok());
}

#[test]
fn instances_need_a_name() {
    let folder = Folder::with_start(&lap());
    let path = text(&folder.0);
    let request = |name| Request {
        name,
        resources: Some(&path),
        ..Request::default()
    };
    assert!(refusal(&request(None)).contains("argument instanceName is a null pointer"));
    assert!(refusal(&request(Some("  "))).contains("argument instanceName is an empty string"));
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
    for (reference, expected) in [
        (vr::TIME, "variable time has no intermediateUpdate"),
        (
            vr::K_YY,
            "variable joint.k_yy has no intermediateUpdate in modelDescription.xml",
        ),
        (vr::A_THETA, "value reference 2 does not exist"),
        (vr::NONE, "value reference 52 does not exist"),
    ] {
        let message = refusal(&request(&path, &[vr::A_F, reference]));
        assert!(message.contains(expected), "{message}");
    }
    let without_callback = Request {
        updated: false,
        ..request(&path, &[vr::A_F])
    };
    let message = refusal(&without_callback);
    assert!(
        message.contains("the callback intermediateUpdate is a null pointer"),
        "{message}"
    );
}

#[test]
fn text_that_is_not_utf_8_is_refused() {
    let mut log: Vec<Message> = Vec::new();
    // SAFETY: strings are terminated, the log outlives the call
    let handle = unsafe {
        c::fmi3InstantiateCoSimulation(
            c"joint".as_ptr(),
            c"\xff".as_ptr(),
            ptr::null(),
            false,
            false,
            false,
            false,
            ptr::null(),
            0,
            (&raw mut log).cast(),
            Some(crate::importer::record),
            None,
        )
    };
    assert!(handle.is_null());
    assert_eq!(
        log[0].text,
        "fmi3InstantiateCoSimulation: argument instantiationToken is not UTF-8"
    );
}

#[test]
fn scheduled_execution_is_refused() {
    let mut log: Vec<Message> = Vec::new();
    // SAFETY: strings are terminated, the log outlives the call
    unsafe {
        let handle = c::fmi3InstantiateScheduledExecution(
            c"joint".as_ptr(),
            c"token".as_ptr(),
            ptr::null(),
            false,
            false,
            (&raw mut log).cast(),
            Some(crate::importer::record),
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

#[test]
fn model_exchange_checks_the_same() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = text(&folder.0);
    let good = || Request {
        resources: Some(&path),
        ..Request::default()
    };
    assert!(good().instantiate_model_exchange().is_ok());
    for (request, expected) in [
        (
            Request {
                name: None,
                ..good()
            },
            "argument instanceName is a null pointer",
        ),
        (
            Request {
                name: Some(" "),
                ..good()
            },
            "argument instanceName is an empty string",
        ),
        (
            Request {
                token: Some("other"),
                ..good()
            },
            "instantiationToken is \"other\"",
        ),
        (
            Request {
                resources: Some("/nowhere"),
                ..good()
            },
            "cannot be read",
        ),
    ] {
        let log = request.instantiate_model_exchange().err().unwrap();
        assert_eq!(log.len(), 1);
        let message = &log[0].text;
        assert!(
            message.starts_with("fmi3InstantiateModelExchange: "),
            "{message}"
        );
        assert!(message.contains(expected), "{message}");
    }
}
