//! An importer that gives no resource path: the library finds the FMU that it was loaded from.
#![cfg(unix)]

use std::{
    env,
    ffi::{CString, c_char, c_int, c_void},
    fs, mem, ptr,
};

use crate::importer::{Folder, Kind, TOKEN, start_text, text, vr};

unsafe extern "C" {
    fn dlopen(path: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    fn dlclose(library: *mut c_void) -> c_int;
}

const NOW: c_int = 2;

type Instantiate = unsafe extern "C" fn(
    *const c_char,
    *const c_char,
    *const c_char,
    bool,
    bool,
    bool,
    bool,
    *const u32,
    usize,
    *mut c_void,
    *const c_void,
    *const c_void,
) -> *mut c_void;
type Instantiate2 = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const c_void,
    c_int,
    c_int,
) -> *mut c_void;
type SetUp2 = unsafe extern "C" fn(*mut c_void, c_int, f64, f64, c_int, f64) -> c_int;
type Enter2 = unsafe extern "C" fn(*mut c_void) -> c_int;
type Get2 = unsafe extern "C" fn(*mut c_void, *const u32, usize, *mut f64) -> c_int;
type Free = unsafe extern "C" fn(*mut c_void);
type Get = unsafe extern "C" fn(*mut c_void, *const u32, usize, *mut f64, usize) -> c_int;

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
        let instantiate: Instantiate =
            mem::transmute(dlsym(library, c"fmi3InstantiateCoSimulation".as_ptr()));
        let free: Free = mem::transmute(dlsym(library, c"fmi3FreeInstance".as_ptr()));
        let get: Get = mem::transmute(dlsym(library, c"fmi3GetFloat64".as_ptr()));
        for resources in [ptr::null(), c"".as_ptr()] {
            let instance = instantiate(
                c"joint".as_ptr(),
                token.as_ptr(),
                resources,
                false,
                false,
                false,
                false,
                ptr::null(),
                0,
                ptr::null_mut(),
                ptr::null(),
                ptr::null(),
            );
            assert!(!instance.is_null());
            let mut value = 0.0;
            assert_eq!(get(instance, [vr::K_YY].as_ptr(), 1, &raw mut value, 1), 0);
            assert_eq!(value, 77.0);
            free(instance);
        }
        let instantiate: Instantiate2 = mem::transmute(dlsym(library, c"fmi2Instantiate".as_ptr()));
        let free: Free = mem::transmute(dlsym(library, c"fmi2FreeInstance".as_ptr()));
        let set_up: SetUp2 = mem::transmute(dlsym(library, c"fmi2SetupExperiment".as_ptr()));
        let enter: Enter2 = mem::transmute(dlsym(library, c"fmi2EnterInitializationMode".as_ptr()));
        let get: Get2 = mem::transmute(dlsym(library, c"fmi2GetReal".as_ptr()));
        for (fmu_type, resources) in [(0, ptr::null()), (1, c"".as_ptr())] {
            let token = token.as_ptr();
            let name = c"joint".as_ptr();
            let instance = instantiate(name, fmu_type, token, resources, ptr::null(), 0, 0);
            assert!(!instance.is_null());
            assert_eq!(set_up(instance, 0, 0.0, 0.0, 0, 0.0), 0);
            assert_eq!(enter(instance), 0);
            let mut value = 0.0;
            assert_eq!(get(instance, [vr::K_YY].as_ptr(), 1, &raw mut value), 0);
            assert_eq!(value, 77.0);
            free(instance);
        }
        dlclose(library);
    }
}
