//! The importer's callbacks: what they get, which categories are switched on, and that they may be missing.

use std::{
    ffi::{CStr, CString, c_int, c_void},
    ptr,
};

use bolted_joint_importer::header::{fmi2::*, fmi3::*};

use crate::{
    c,
    importer::{
        Folder, Instance, Kind, Make as _, Message, Request, TOKEN, record_fmi2, start_text, text,
        vr,
    },
    raw::{BOTH, Fmi2, Fmi3, Interface::CoSimulation, call, status_of},
};

/// A lap with a negative damper: it works, with a warning.
const ACTIVE: [(&str, f64); 1] = [("joint.c_yy", -1.0)];

#[test]
fn messages_have_name_category_and_status() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &ACTIVE));
    for (version, prefix) in [(Fmi2, "fmi2"), (Fmi3, "fmi3")] {
        let request = Request {
            version,
            name: Some("Fuge 50 % – #7"),
            ..Request::of(&folder)
        };
        let mut instance = request.instantiate().unwrap();
        c::ok(instance.enter_initialization(0.25, None));
        assert_eq!(instance.exit_initialization(), c::WARNING);
        assert_eq!(instance.step(0.25, -1.0), c::ERROR);
        let expected = [
            (
                c::OK,
                "logEvents",
                "EnterInitializationMode: initialising at t = 0.25 s",
            ),
            (
                c::WARNING,
                "logStatusWarning",
                "ExitInitializationMode: the joint's damping matrix is not positive semidefinite: the model is active \
                 and can feed energy into the simulation",
            ),
            (
                c::ERROR,
                "logStatusError",
                "DoStep: communicationStepSize is -1, expected a finite number greater than zero",
            ),
        ];
        // the name is handed back as it came, text for people is escaped
        let name = (version == Fmi2).then(|| "Fuge 50 % – #7".to_owned());
        let expected = expected.map(|(status, category, text)| Message {
            instance_name: name.clone(),
            status,
            category: category.to_owned(),
            text: format!("{prefix}{text}"),
        });
        assert_eq!(instance.take_log(), expected);
    }
}

#[test]
fn percent_signs_are_no_conversions() {
    for version in BOTH {
        // the path of the resources has "100% #1" in it, and the token could have anything
        let folder = Folder::with_start("no start file");
        let request = Request {
            version,
            ..Request::of(&folder)
        };
        request.refuses("Prüfung 100% ##1/start.txt, line 1");
        let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
        let request = Request {
            token: Some("%s%n%1000000d%%"),
            resources: folder.0.to_str(),
            ..request
        };
        request.refuses(" is \"%s%n%1000000d%%\", but");
    }
}

#[test]
fn categories_switch_messages_on_and_off() {
    for version in BOTH {
        let mut instance = version.instance(CoSimulation, Kind::Lap, 1, &ACTIVE);
        let statuses = |instance: &mut Instance| -> Vec<c_int> {
            c::ok(instance.reset());
            instance.take_log();
            c::ok(instance.enter_initialization(0.0, None));
            assert_eq!(instance.exit_initialization(), c::WARNING);
            // what goes on without a message is refused all the same
            assert_eq!(instance.step(0.0, 0.0), c::ERROR);
            let log = instance.take_log();
            log.iter().map(|message| message.status).collect()
        };
        let [events, warnings, errors] = [c"logEvents", c"logStatusWarning", c"logStatusError"];
        assert_eq!(statuses(&mut instance), [c::OK, c::WARNING, c::ERROR]);
        let switches: [(bool, &[&CStr], &[c_int]); 9] = [
            (false, &[events], &[c::WARNING, c::ERROR]),
            (false, &[], &[]),
            (true, &[warnings], &[c::WARNING]),
            (true, &[events, errors], &[c::OK, c::WARNING, c::ERROR]),
            (false, &[warnings], &[c::OK, c::ERROR]),
            (false, &[errors], &[c::OK]),
            (true, &[warnings, events], &[c::OK, c::WARNING]),
            (true, &[errors], &[c::OK, c::WARNING, c::ERROR]),
            (true, &[], &[c::OK, c::WARNING, c::ERROR]),
        ];
        for (on, categories, expected) in switches {
            c::ok(instance.switch_logging(on, categories));
            assert_eq!(statuses(&mut instance), expected, "{on} {categories:?}");
            // a category that there is not, in silence if errors are off
            let all = [events, c"logAll"];
            for on in [false, true] {
                assert_eq!(instance.switch_logging(on, &all), c::ERROR);
                let told = instance.take_log();
                assert_eq!(told.len(), usize::from(expected.contains(&c::ERROR)));
            }
        }
        // any other number than zero is true
        c::ok(instance.switch_logging(false, &[]));
        let on = call!(
            instance,
            fmi2SetDebugLogging(-1, 0, ptr::null()),
            fmi3SetDebugLogging(2, 0, ptr::null())
        );
        c::ok(on);
        assert_eq!(statuses(&mut instance), [c::OK, c::WARNING, c::ERROR]);
        let names = [events.as_ptr(), ptr::null()];
        let null = "argument categories is a null pointer";
        instance.refused_all(&[
            ("log category \"logAll\" does not exist", &|i| {
                i.switch_logging(true, &[events, c"logAll"])
            }),
            // a category that is null, and no categories
            (null, &|i| {
                let names = names.as_ptr();
                call!(i, fmi2SetDebugLogging | fmi3SetDebugLogging(1, 2, names))
            }),
            (null, &|i| {
                call!(
                    i,
                    fmi2SetDebugLogging | fmi3SetDebugLogging(1, 1, ptr::null())
                )
            }),
        ]);
    }
}

#[test]
fn errors_are_told_from_the_start() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &ACTIVE));
    for version in BOTH {
        let silent = |token| Request {
            version,
            token: Some(token),
            logging: false,
            ..Request::of(&folder)
        };
        silent("other").refusal();
        let mut instance = silent(TOKEN).instantiate().unwrap();
        c::ok(instance.enter_initialization(0.0, None));
        assert_eq!(instance.exit_initialization(), c::WARNING);
        assert_eq!(instance.take_log(), []);
        instance.refuses(|i| i.step(0.0, 0.0), "communicationStepSize is 0");
        if version == Fmi3 {
            continue;
        }
        // a status that there is not, fmi2Discard, is told in debug mode only (2.1.3)
        let ask = |i: &Instance| status_of(i.status(fmi2GetIntegerStatus, LAST_SUCCESSFUL_TIME, 0));
        assert_eq!(ask(&instance), c::DISCARD);
        assert_eq!(instance.take_log(), []);
        c::ok(instance.switch_logging(true, &[]));
        assert_eq!(ask(&instance), c::DISCARD);
        assert!(
            instance
                .message(c::DISCARD)
                .starts_with("fmi2GetIntegerStatus: ")
        );
    }
}

#[test]
fn without_a_callback_nothing_is_logged_and_all_works() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 2, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    for (token, expected) in [(token.as_c_str(), true), (c"wrong", false)] {
        let request = crate::raw::request::Request {
            token: Some(token),
            resources: Some(&path),
            logging: true,
            ..crate::raw::request::Request::NONE
        };
        let instance = request.instantiate();
        assert_eq!(instance.is_some(), expected);
        if let Some(instance) = instance {
            assert_eq!(instance.terminate(), c::ERROR);
            instance.free();
        }
    }
}

/// Instantiates with these callbacks of FMI 2.0, makes mistakes, and frees.
unsafe fn be_careless(functions: *const CallbackFunctions, logging: c_int) {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    // SAFETY: all strings are terminated, all pointers are to locals
    unsafe {
        let (name, token, path) = (c"joint".as_ptr(), token.as_ptr(), path.as_ptr());
        assert!(fmi2Instantiate(ptr::null(), 1, token, path, functions, 0, logging).is_null());
        assert!(fmi2Instantiate(name, 1, path, path, functions, 0, logging).is_null());
        let instance = fmi2Instantiate(name, 1, token, path, functions, 1, logging);
        assert!(!instance.is_null());
        assert_eq!(fmi2DoStep(instance, 0.0, 1.0, 0), c::ERROR);
        c::ok(fmi2SetupExperiment(instance, 0, 0.0, 0.0, 0, 0.0));
        c::ok(fmi2EnterInitializationMode(instance));
        assert_eq!(
            fmi2GetReal(instance, [vr::NONE].as_ptr(), 1, &mut 0.0),
            c::ERROR
        );
        c::ok(fmi2ExitInitializationMode(instance));
        c::ok(fmi2DoStep(instance, 0.0, 1e-3, 0));
        fmi2FreeInstance(instance);
    }
}

/// No callbacks.
const NONE: CallbackFunctions = CallbackFunctions {
    logger: None,
    allocate_memory: None,
    free_memory: None,
    step_finished: None,
    environment: ptr::null_mut(),
};

#[test]
fn callbacks_may_be_missing() {
    let mut log: Vec<Message> = Vec::new();
    let functions = CallbackFunctions {
        logger: Some(variadic(record_fmi2)),
        environment: (&raw mut log).cast(),
        ..NONE
    };
    let none = NONE;
    // SAFETY: the callbacks are null, or can be called with the environment
    unsafe {
        for logging in [0, 1] {
            be_careless(ptr::null(), logging);
            be_careless(&raw const none, logging);
        }
        // with a logger alone, its environment is what was given
        be_careless(&raw const functions, 1);
        let names: Vec<_> = log
            .iter()
            .filter_map(|message| message.instance_name.as_deref())
            .collect();
        assert_eq!(names, ["", "joint", "joint", "joint", "joint"]);
        // a structure that is not aligned
        log.clear();
        let size = size_of::<CallbackFunctions>();
        let mut bytes = vec![0_u8; size + 1];
        let odd = bytes.as_mut_ptr().add(1);
        ptr::copy_nonoverlapping((&raw const functions).cast::<u8>(), odd, size);
        be_careless(odd.cast(), 1);
        assert_eq!(log.len(), 5);
    }
}

#[test]
fn memory_and_step_callbacks_are_left_alone() {
    unsafe extern "C" fn allocate(_: usize, _: usize) -> *mut c_void {
        std::process::abort()
    }
    unsafe extern "C" fn free(_: *mut c_void) {
        std::process::abort()
    }
    unsafe extern "C" fn finished(_: *mut c_void, _: c_int) {
        std::process::abort()
    }
    let functions = CallbackFunctions {
        allocate_memory: Some(allocate),
        free_memory: Some(free),
        step_finished: Some(finished),
        ..NONE
    };
    // SAFETY: the callbacks can be called
    unsafe { be_careless(&raw const functions, 1) };
}

#[test]
fn a_callback_may_use_and_even_free_the_instance() {
    unsafe extern "C" fn careless(
        environment: *mut c_void,
        name: *const std::ffi::c_char,
        status: c_int,
        _: *const std::ffi::c_char,
        _: *const std::ffi::c_char,
        _: *const std::ffi::c_char,
    ) {
        // SAFETY: the environment is the variable of the test below
        unsafe {
            let instance = environment.cast::<*mut c_void>();
            if status == c::ERROR && !(*instance).is_null() {
                c::ok(fmi2SetupExperiment(*instance, 0, 0.0, 0.0, 0, 0.0));
                fmi2FreeInstance(*instance);
                *instance = ptr::null_mut();
                // the name is still there
                assert_eq!(CStr::from_ptr(name), c"joint");
            }
        }
    }
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    let mut instance: *mut c_void = ptr::null_mut();
    let place = &raw mut instance;
    let functions = CallbackFunctions {
        logger: Some(variadic(careless)),
        environment: place.cast(),
        ..NONE
    };
    // SAFETY: all strings are terminated, all pointers are to locals
    unsafe {
        let (name, token, path) = (c"joint".as_ptr(), token.as_ptr(), path.as_ptr());
        *place = fmi2Instantiate(name, 1, token, path, &raw const functions, 0, 1);
        assert_eq!(fmi2DoStep(*place, 0.0, 1.0, 0), c::ERROR);
        assert!((*place).is_null());
    }
}
