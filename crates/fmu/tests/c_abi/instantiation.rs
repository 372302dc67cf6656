//! Instantiation: resources in every form, the token, the start-value file, options that are not offered, logging.

use std::{ffi::CStr, fs, ptr};

use crate::{
    c,
    importer::{Folder, Instance, Kind, Message, Request, TOKEN, start_text, text, vr},
};

/// The one reason why there is no instance.
fn refusal(request: &Request<'_>) -> String {
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

fn refusal_of_start(start: &str) -> String {
    let folder = Folder::with_start(start);
    let path = text(&folder.0);
    let message = refusal(&Request {
        resources: Some(&path),
        ..Request::default()
    });
    // a '#' in a log message starts a reference to a variable: literal ones are doubled
    assert!(message.contains("Prüfung 100% ##1/start.txt"), "{message}");
    message
}

fn lap() -> String {
    start_text(Kind::Lap, 2, &[])
}

#[test]
fn version() {
    // SAFETY: the library returns a terminated string
    assert_eq!(unsafe { CStr::from_ptr(c::fmi3GetVersion()) }, c"3.0");
}

#[test]
fn resource_paths_in_all_forms() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[("joint.k_yy", 123.0)]));
    let path = text(&folder.0);
    let escaped: String = path
        .bytes()
        .map(|byte| match byte {
            b'/' | b'-' | b'.' | b'0'..=b'9' | b'A'..=b'Z' | b'a'..=b'z' => {
                char::from(byte).to_string()
            }
            other => format!("%{other:02X}"),
        })
        .collect();
    for form in [
        path.clone(),
        format!("{path}/"),
        format!("file://{escaped}"),
        format!("file://{escaped}/"),
        format!("file:{escaped}/"),
        format!("file://localhost{escaped}/"),
    ] {
        let request = Request {
            resources: Some(&form),
            ..Request::default()
        };
        let mut instance = request.instantiate().unwrap();
        assert_eq!(instance.get([vr::K_YY]), [123.0], "{form}");
    }
}

#[test]
fn carriage_returns_are_accepted() {
    let folder = Folder::with_start(&lap().replace('\n', "\r\n"));
    let path = text(&folder.0);
    let request = Request {
        resources: Some(&path),
        ..Request::default()
    };
    assert_eq!(request.instantiate().unwrap().get([vr::A_MASS]), [2.0]);
}

#[test]
fn missing_resources_are_named() {
    let folder = Folder::new("empty");
    let path = text(&folder.0);
    let message = refusal(&Request {
        resources: Some(&path),
        ..Request::default()
    });
    assert!(
        message.contains(&path) && message.contains("start.txt cannot be read"),
        "{message}"
    );
    let message = refusal(&Request {
        resources: Some("file://server/share"),
        ..Request::default()
    });
    assert!(message.contains("no local file URI"), "{message}");
    // the test program is no FMU's library
    for resources in [None, Some("")] {
        let message = refusal(&Request {
            resources,
            ..Request::default()
        });
        assert!(message.contains("resources"), "{message}");
    }
}

#[test]
fn start_files_that_are_not_text_or_too_long_are_refused() {
    let folder = Folder::new("binary");
    let path = text(&folder.0);
    fs::write(folder.0.join("start.txt"), [0xff, 0xfe, 0, 1]).unwrap();
    let message = refusal(&Request {
        resources: Some(&path),
        ..Request::default()
    });
    assert!(message.contains("cannot be read"), "{message}");
    fs::write(folder.0.join("start.txt"), "x".repeat(3 << 20)).unwrap();
    let message = refusal(&Request {
        resources: Some(&path),
        ..Request::default()
    });
    assert!(
        message.contains("line 1") && message.len() < 1000,
        "{message}"
    );
}

#[test]
fn start_files_with_a_fault_are_refused_by_line() {
    for (from, to, line, expected) in [
        (
            "bolted-joint-start/1",
            "bolted-joint-start/2",
            1,
            "found \"bolted-joint-start/2\", expected the header",
        ),
        (
            "model lap",
            "model beam",
            2,
            "found \"model beam\", expected \"model element\" or \"model lap\"",
        ),
        (
            "dofs 2",
            "dofs 3",
            3,
            "found \"dofs 3\", expected \"dofs 1\" or \"dofs 2\"",
        ),
        (
            "token {",
            "tocken {",
            4,
            "found \"tocken {7f0c-4a} ##1\", expected \"token\" and the instantiation token",
        ),
        (
            "joint.k_yy 4000000",
            "joint.k_yy",
            5,
            "found \"joint.k_yy\", expected the name of a parameter, a space and a number",
        ),
        (
            "joint.k_yy 4000000",
            "",
            5,
            "found \"\", expected the name of a parameter",
        ),
        (
            "joint.k_yy 4000000",
            "joint.k_xx 4000000",
            5,
            "\"joint.k_xx\" is not a parameter of this FMU",
        ),
        (
            "joint.k_yy 4000000",
            "a.y 0",
            5,
            "\"a.y\" is not a parameter of this FMU",
        ),
        (
            "joint.k_ytheta 10000",
            "joint.k_yy 10000",
            6,
            "parameter joint.k_yy is given a second time",
        ),
        (
            "joint.k_yy 4000000",
            "joint.k_yy inf",
            5,
            "parameter joint.k_yy is \"inf\", expected a finite number",
        ),
        (
            "joint.k_yy 4000000",
            "joint.k_yy NaN",
            5,
            "parameter joint.k_yy is \"NaN\", expected a finite number",
        ),
        (
            "joint.k_yy 4000000",
            "joint.k_yy 1e999",
            5,
            "parameter joint.k_yy is \"1e999\", expected a finite number",
        ),
        (
            "joint.k_yy 4000000",
            "joint.k_yy 4 N/m",
            5,
            "parameter joint.k_yy is \"4 N/m\", expected a finite number",
        ),
        (
            "step_size_max 0.00002\n",
            "",
            24,
            "the file ends without parameter step_size_max",
        ),
    ] {
        let start = lap();
        assert!(start.contains(from), "{from} in {start}");
        let message = refusal_of_start(&start.replacen(from, to, 1));
        assert!(
            message.contains(&format!("line {line}: {expected}")),
            "{message}"
        );
    }
    let message = refusal_of_start("");
    assert!(message.contains("line 1: found \"\""), "{message}");
}

#[test]
fn rotational_parameters_belong_to_two_degrees_of_freedom_only() {
    let message = refusal_of_start(&lap().replace("dofs 2", "dofs 1"));
    assert!(
        message.contains("line 6: \"joint.k_ytheta\" is not a parameter"),
        "{message}"
    );
    let message = refusal_of_start(&start_text(Kind::Lap, 1, &[]).replace("dofs 1", "dofs 2"));
    assert!(
        message.contains("the file ends without parameter joint.k_ytheta"),
        "{message}"
    );
    let message = refusal_of_start(&lap().replace("model lap", "model element"));
    assert!(message.contains("\"a.m\" is not a parameter"), "{message}");
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
        (vr::NONE, "value reference 42 does not exist"),
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
fn without_a_callback_nothing_is_logged_and_all_works() {
    let folder = Folder::with_start(&lap());
    let path = std::ffi::CString::new(text(&folder.0)).unwrap();
    let token = std::ffi::CString::new(TOKEN).unwrap();
    for (token, expected) in [(token.as_c_str(), true), (c"wrong", false)] {
        // SAFETY: strings are terminated; the instance is freed once
        unsafe {
            let handle = c::fmi3InstantiateCoSimulation(
                c"joint".as_ptr(),
                token.as_ptr(),
                path.as_ptr(),
                false,
                true,
                false,
                false,
                ptr::null(),
                0,
                ptr::null_mut(),
                None,
                None,
            );
            assert_eq!(!handle.is_null(), expected);
            if !handle.is_null() {
                assert_eq!(c::fmi3Terminate(handle), c::ERROR);
            }
            c::fmi3FreeInstance(handle);
        }
    }
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

#[test]
fn logging_follows_the_categories() {
    let mut instance = Instance::new(Kind::Lap, 1, &[("joint.c_yy", -1.0)]);
    let switch = |instance: &Instance, on, categories: &[&CStr]| {
        let pointers: Vec<_> = categories.iter().map(|name| name.as_ptr()).collect();
        // SAFETY: the instance lives, the names are terminated
        unsafe { c::fmi3SetDebugLogging(instance.handle, on, pointers.len(), pointers.as_ptr()) }
    };
    let run = |instance: &mut Instance| {
        assert_eq!(instance.reset(), c::OK);
        instance.take_log();
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        // the damper is negative: the instance works, with a warning
        assert_eq!(instance.exit_initialization(), c::WARNING);
        instance
            .take_log()
            .into_iter()
            .map(|message| message.category)
            .collect::<Vec<_>>()
    };
    assert_eq!(run(&mut instance), ["logEvents", "logStatusWarning"]);
    assert_eq!(switch(&instance, false, &[c"logEvents"]), c::OK);
    assert_eq!(run(&mut instance), ["logStatusWarning"]);
    assert_eq!(switch(&instance, false, &[]), c::OK);
    assert_eq!(run(&mut instance), [] as [&str; 0]);
    // errors, too; the call is refused all the same
    assert_eq!(instance.exit_initialization(), c::ERROR);
    assert_eq!(switch(&instance, true, &[c"logEverything"]), c::ERROR);
    assert_eq!(instance.take_log(), []);
    assert_eq!(
        switch(&instance, true, &[c"logStatusWarning", c"logEvents"]),
        c::OK
    );
    assert_eq!(run(&mut instance), ["logEvents", "logStatusWarning"]);
    assert_eq!(instance.exit_initialization(), c::ERROR);
    assert_eq!(instance.take_log(), []);
    assert_eq!(switch(&instance, true, &[c"logStatusError"]), c::OK);
    assert_eq!(instance.exit_initialization(), c::ERROR);
    assert!(instance.error().starts_with("fmi3ExitInitializationMode: "));
    assert_eq!(switch(&instance, true, &[c"logEverything"]), c::ERROR);
    assert!(
        instance
            .error()
            .contains("log category \"logEverything\" does not exist")
    );
    // a category that is null
    let categories = [c"logEvents".as_ptr(), ptr::null()];
    // SAFETY: the instance lives, the array has the length that is told
    let status = unsafe { c::fmi3SetDebugLogging(instance.handle, true, 2, categories.as_ptr()) };
    assert_eq!(status, c::ERROR);
    assert!(
        instance
            .error()
            .contains("argument categories is a null pointer")
    );
    // SAFETY: the instance lives
    let status = unsafe { c::fmi3SetDebugLogging(instance.handle, true, 2, ptr::null()) };
    assert_eq!(status, c::ERROR);
    assert!(
        instance
            .error()
            .contains("argument categories is a null pointer")
    );
}
