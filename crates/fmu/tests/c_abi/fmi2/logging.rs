//! The importer's callbacks: what they get, and that they may be missing.

use std::{
    ffi::{CString, c_int, c_void},
    ptr,
};

use super::{
    c,
    importer::{Instance, Request, recorder},
};
use crate::importer::{Folder, Kind, TOKEN, start_text, text, vr};

#[test]
fn messages_have_name_category_and_status() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[("joint.c_yy", -1.0)]));
    let request = Request {
        name: Some("Fuge 50 % – #7"),
        resources: folder.0.to_str(),
        ..Request::default()
    };
    let mut instance = request.instantiate().unwrap();
    assert_eq!(instance.set_up(0.25, None), c::OK);
    assert_eq!(instance.enter_initialization(), c::OK);
    assert_eq!(instance.exit_initialization(), c::WARNING);
    assert_eq!(instance.step(0.25, -1.0), c::ERROR);
    let log = instance.take_log();
    // the name is handed back as it came, text for people is escaped
    assert!(
        log.iter()
            .all(|message| message.instance_name == "Fuge 50 % – #7")
    );
    let found: Vec<_> = log
        .iter()
        .map(|m| (m.status, m.category.as_str(), m.text.as_str()))
        .collect();
    let expected = [
        (
            c::OK,
            "logEvents",
            "fmi2EnterInitializationMode: initialising at t = 0.25 s",
        ),
        (
            c::WARNING,
            "logStatusWarning",
            "fmi2ExitInitializationMode: the joint's damping matrix is not positive semidefinite: the model is active \
             and can feed energy into the simulation",
        ),
        (
            c::ERROR,
            "logStatusError",
            "fmi2DoStep: communicationStepSize is -1, expected a finite number greater than zero",
        ),
    ];
    assert_eq!(found, expected);
}

#[test]
fn percent_signs_are_no_conversions() {
    // the path of the resources has "100% #1" in it, and the token could have anything
    let folder = Folder::with_start("no start file");
    let path = text(&folder.0);
    let log = Request {
        resources: Some(&path),
        ..Request::default()
    }
    .instantiate()
    .err()
    .unwrap();
    assert!(
        log[0].text.contains("Prüfung 100% ##1/start.txt, line 1"),
        "{log:?}"
    );
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = text(&folder.0);
    let request = Request {
        guid: Some("%s%n%1000000d%%"),
        resources: Some(&path),
        ..Request::default()
    };
    let log = request.instantiate().err().unwrap();
    assert!(
        log[0].text.contains("fmuGUID is \"%s%n%1000000d%%\", but"),
        "{log:?}"
    );
}

#[test]
fn categories_switch_messages_on_and_off() {
    let mut instance = Instance::new(c::CO_SIMULATION, Kind::Lap, 1, &[("joint.c_yy", -1.0)]);
    let switch = |instance: &Instance, on: c_int, names: &[&std::ffi::CStr]| {
        let names: Vec<_> = names.iter().map(|name| name.as_ptr()).collect();
        // SAFETY: the instance lives, pointer and length are those of a list
        unsafe { c::fmi2SetDebugLogging(instance.handle, on, names.len(), names.as_ptr()) }
    };
    let statuses = |instance: &mut Instance| -> Vec<c_int> {
        assert_eq!(instance.reset(), c::OK);
        instance.take_log();
        assert_eq!(instance.set_up(0.0, None), c::OK);
        assert_eq!(instance.enter_initialization(), c::OK);
        assert_eq!(instance.exit_initialization(), c::WARNING);
        assert_eq!(instance.step(0.0, 0.0), c::ERROR);
        instance
            .take_log()
            .iter()
            .map(|message| message.status)
            .collect()
    };
    assert_eq!(statuses(&mut instance), [c::OK, c::WARNING, c::ERROR]);
    assert_eq!(switch(&instance, 0, &[]), c::OK);
    assert_eq!(statuses(&mut instance), [0; 0]);
    assert_eq!(switch(&instance, 1, &[c"logStatusWarning"]), c::OK);
    assert_eq!(statuses(&mut instance), [c::WARNING]);
    // any other number than zero is true
    assert_eq!(
        switch(&instance, -1, &[c"logEvents", c"logStatusError"]),
        c::OK
    );
    assert_eq!(switch(&instance, 0, &[c"logStatusWarning"]), c::OK);
    assert_eq!(statuses(&mut instance), [c::OK, c::ERROR]);
    // what goes on without a message is refused all the same
    assert_eq!(switch(&instance, 0, &[c"logStatusError"]), c::OK);
    assert_eq!(statuses(&mut instance), [c::OK]);
    assert_eq!(switch(&instance, 0, &[c"logAll"]), c::ERROR);
    assert_eq!(instance.take_log(), []);
    assert_eq!(switch(&instance, 1, &[]), c::OK);
    assert_eq!(statuses(&mut instance), [c::OK, c::WARNING, c::ERROR]);
    let message = instance.refused(|i| switch(i, 1, &[c"logEvents", c"logAll"]));
    assert!(
        message.contains("log category \"logAll\" does not exist"),
        "{message}"
    );
    // SAFETY: refused before anything is read
    let message =
        instance.refused(|i| unsafe { c::fmi2SetDebugLogging(i.handle, 1, 1, ptr::null()) });
    assert!(
        message.contains("argument categories is a null pointer"),
        "{message}"
    );
}

#[test]
fn errors_are_told_from_the_start() {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[("joint.c_yy", -1.0)]));
    let silent = |fmu_type, guid| {
        let request = Request {
            fmu_type,
            guid: Some(guid),
            resources: folder.0.to_str(),
            logging: false,
            ..Request::default()
        };
        request.instantiate()
    };
    let log = silent(c::CO_SIMULATION, "other").err().unwrap();
    assert_eq!(log.len(), 1);
    assert_eq!(log[0].status, c::ERROR);
    let mut instance = silent(c::CO_SIMULATION, TOKEN).unwrap();
    assert_eq!(instance.set_up(0.0, None), c::OK);
    assert_eq!(instance.enter_initialization(), c::OK);
    assert_eq!(instance.exit_initialization(), c::WARNING);
    assert_eq!(instance.take_log(), []);
    let message = instance.refused(|i| i.step(0.0, 0.0));
    assert!(message.contains("communicationStepSize is 0"), "{message}");
    // a status that there is not, fmi2Discard, is told in debug mode only (2.1.3)
    let status = |instance: &Instance| {
        let mut value = 0;
        // SAFETY: the instance lives, the pointer is to a local
        unsafe { c::fmi2GetIntegerStatus(instance.handle, c::LAST_SUCCESSFUL_TIME, &mut value) }
    };
    assert_eq!(status(&instance), c::DISCARD);
    assert_eq!(instance.take_log(), []);
    // SAFETY: the instance lives
    unsafe { c::fmi2SetDebugLogging(instance.handle, 1, 0, ptr::null()) };
    assert_eq!(status(&instance), c::DISCARD);
    assert!(
        instance
            .message(c::DISCARD)
            .starts_with("fmi2GetIntegerStatus: ")
    );
}

/// Instantiates with these callbacks, makes mistakes, and frees.
unsafe fn be_careless(functions: *const c::CallbackFunctions, logging: c_int) {
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    // SAFETY: all strings are terminated, all pointers are to locals
    unsafe {
        let (name, token, path) = (c"joint".as_ptr(), token.as_ptr(), path.as_ptr());
        assert!(c::fmi2Instantiate(ptr::null(), 1, token, path, functions, 0, logging).is_null());
        assert!(c::fmi2Instantiate(name, 1, path, path, functions, 0, logging).is_null());
        let instance = c::fmi2Instantiate(name, 1, token, path, functions, 1, logging);
        assert!(!instance.is_null());
        assert_eq!(c::fmi2DoStep(instance, 0.0, 1.0, 0), c::ERROR);
        assert_eq!(c::fmi2SetupExperiment(instance, 0, 0.0, 0.0, 0, 0.0), c::OK);
        assert_eq!(c::fmi2EnterInitializationMode(instance), c::OK);
        assert_eq!(
            c::fmi2GetReal(instance, [vr::NONE].as_ptr(), 1, &mut 0.0),
            c::ERROR
        );
        assert_eq!(c::fmi2ExitInitializationMode(instance), c::OK);
        assert_eq!(c::fmi2DoStep(instance, 0.0, 1e-3, 0), c::OK);
        c::fmi2FreeInstance(instance);
    }
}

#[test]
fn callbacks_may_be_missing() {
    let mut functions = c::CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: ptr::null_mut(),
    };
    // SAFETY: the callbacks are null
    unsafe {
        for logging in [0, 1] {
            be_careless(ptr::null(), logging);
            be_careless(&raw const functions, logging);
        }
        // with a logger alone, its environment is what was given
        let mut log: Vec<super::importer::Message> = Vec::new();
        functions.logger = Some(recorder());
        functions.environment = (&raw mut log).cast();
        be_careless(&raw const functions, 1);
        let names: Vec<&str> = log
            .iter()
            .map(|message| message.instance_name.as_str())
            .collect();
        assert_eq!(names, ["", "joint", "joint", "joint", "joint"]);
        // a structure that is not aligned
        log.clear();
        let size = size_of::<c::CallbackFunctions>();
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
    let functions = c::CallbackFunctions {
        logger: None,
        allocate_memory: Some(allocate),
        free_memory: Some(free),
        step_finished: Some(finished),
        environment: ptr::null_mut(),
    };
    // SAFETY: the callbacks can be called
    unsafe { be_careless(&raw const functions, 1) };
}

#[test]
fn a_callback_may_use_and_even_free_the_instance() {
    type Careless = unsafe extern "C" fn(
        *mut c_void,
        *const std::ffi::c_char,
        c_int,
        *const std::ffi::c_char,
        *const std::ffi::c_char,
    );
    unsafe extern "C" fn careless(
        environment: *mut c_void,
        name: *const std::ffi::c_char,
        status: c_int,
        _: *const std::ffi::c_char,
        _: *const std::ffi::c_char,
    ) {
        // SAFETY: the environment is the variable of the test below
        unsafe {
            let instance = environment.cast::<*mut c_void>();
            if status == c::ERROR && !(*instance).is_null() {
                assert_eq!(
                    c::fmi2SetupExperiment(*instance, 0, 0.0, 0.0, 0, 0.0),
                    c::OK
                );
                c::fmi2FreeInstance(*instance);
                *instance = ptr::null_mut();
                // the name is still there
                assert_eq!(std::ffi::CStr::from_ptr(name), c"joint");
            }
        }
    }
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let path = CString::new(text(&folder.0)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    let mut instance: *mut c_void = ptr::null_mut();
    let place = &raw mut instance;
    // SAFETY: as for the recorder; all strings are terminated, all pointers are to locals
    unsafe {
        let functions = c::CallbackFunctions {
            logger: Some(std::mem::transmute::<Careless, c::Logger>(careless)),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            environment: place.cast(),
        };
        let (name, token, path) = (c"joint".as_ptr(), token.as_ptr(), path.as_ptr());
        *place = c::fmi2Instantiate(name, 1, token, path, &raw const functions, 0, 1);
        assert_eq!(c::fmi2DoStep(*place, 0.0, 1.0, 0), c::ERROR);
        assert!((*place).is_null());
    }
}
