//! Logging: the categories, and instances without a callback.

use std::{ffi::CStr, ptr};

use crate::{
    c,
    importer::{Folder, Instance, Kind, TOKEN, text},
    instantiation::lap,
};

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
