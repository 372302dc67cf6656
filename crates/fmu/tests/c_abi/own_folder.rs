//! An importer that gives no resource path: the library finds the FMU that it was loaded from.
#![cfg(unix)]

use std::{
    env,
    ffi::{CString, c_char, c_int, c_void},
    fs, mem, ptr,
};

use bolted_joint_importer::header::{fmi2::*, fmi3::*};

use crate::importer::{Folder, Kind, TOKEN, start_text, text, vr};

unsafe extern "C" {
    fn dlopen(path: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    fn dlclose(library: *mut c_void) -> c_int;
}

const NOW: c_int = 2;

#[test]
fn the_library_finds_its_own_resources() {
    let fmu = Folder::new("Übung");
    let binaries = fmu.0.join("binaries/platform");
    fs::create_dir_all(&binaries).unwrap();
    fs::create_dir_all(fmu.0.join("resources")).unwrap();
    fs::write(
        fmu.0.join("resources/start.txt"),
        start_text(Kind::Element, 1, &[("joint.k_yy", 77.0)]),
    )
    .unwrap();
    // the library that Cargo built beside this test program
    let name = format!(
        "{}bolted_joint{}",
        env::consts::DLL_PREFIX,
        env::consts::DLL_SUFFIX
    );
    let built = env::current_exe().unwrap().with_file_name(name);
    let library = binaries.join("bolted_joint.so");
    fs::copy(&built, &library).unwrap();

    let path = CString::new(text(&library)).unwrap();
    let token = CString::new(TOKEN).unwrap();
    // SAFETY: the functions have the types of the FMI headers
    unsafe {
        let library = dlopen(path.as_ptr(), NOW);
        assert!(!library.is_null());
        macro_rules! function {
            ($name:ident) => {{
                let found = dlsym(library, concat!(stringify!($name), "\0").as_ptr().cast());
                assert!(!found.is_null());
                mem::transmute::<*mut c_void, $name>(found)
            }};
        }
        let (name, token) = (c"joint".as_ptr(), token.as_ptr());
        let (none, nothing) = (ptr::null(), ptr::null_mut());
        let reference = [vr::K_YY];
        let mut value = 0.0;
        for resources in [ptr::null(), c"".as_ptr()] {
            let instance = function!(fmi3InstantiateCoSimulation)(
                name, token, resources, 0, 0, 0, 0, none, 0, nothing, None, None,
            );
            assert!(!instance.is_null());
            let status =
                function!(fmi3GetFloat64)(instance, reference.as_ptr(), 1, &raw mut value, 1);
            assert_eq!((status, mem::take(&mut value)), (0, 77.0));
            function!(fmi3FreeInstance)(instance);
        }
        for (fmu_type, resources) in [(0, ptr::null()), (1, c"".as_ptr())] {
            let instance =
                function!(fmi2Instantiate)(name, fmu_type, token, resources, ptr::null(), 0, 0);
            assert!(!instance.is_null());
            assert_eq!(
                function!(fmi2SetupExperiment)(instance, 0, 0.0, 0.0, 0, 0.0),
                0
            );
            assert_eq!(function!(fmi2EnterInitializationMode)(instance), 0);
            let status = function!(fmi2GetReal)(instance, reference.as_ptr(), 1, &raw mut value);
            assert_eq!((status, mem::take(&mut value)), (0, 77.0));
            function!(fmi2FreeInstance)(instance);
        }
        dlclose(library);
    }
}
