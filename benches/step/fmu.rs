//! The embedded FMU library as an importer uses it: loaded at run time, called through function pointers.

use std::{
    error::Error,
    ffi::{CStr, CString, c_char, c_int, c_void},
    fs, ptr,
};

use bolted_joint::export::embedded_library;

use crate::start_file::TOKEN;

const OK: c_int = 0;

type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);
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
    Option<LogMessage>,
    Option<unsafe extern "C" fn()>,
) -> *mut c_void;
type EnterInitialization = unsafe extern "C" fn(*mut c_void, bool, f64, f64, bool, f64) -> c_int;
type ExitInitialization = unsafe extern "C" fn(*mut c_void) -> c_int;
type Free = unsafe extern "C" fn(*mut c_void);
type Set = unsafe extern "C" fn(*mut c_void, *const u32, usize, *const f64, usize) -> c_int;
type Get = unsafe extern "C" fn(*mut c_void, *const u32, usize, *mut f64, usize) -> c_int;
type DoStep = unsafe extern "C" fn(
    *mut c_void,
    f64,
    f64,
    bool,
    *mut bool,
    *mut bool,
    *mut bool,
    *mut f64,
) -> c_int;

/// The loaded library and its functions.
pub(crate) struct Library {
    instantiate: Instantiate,
    enter_initialization: EnterInitialization,
    exit_initialization: ExitInitialization,
    free: Free,
    set: Set,
    get: Get,
    do_step: DoStep,
    /// Keeps the functions where they are.
    _library: libloading::Library,
    /// Is deleted last.
    _file: tempfile::TempPath,
}

impl Library {
    /// Loads the file that the executable embeds.
    pub(crate) fn load() -> Result<Self, Box<dyn Error>> {
        let file = tempfile::NamedTempFile::new()?;
        fs::write(file.path(), embedded_library()?)?;
        // SAFETY: the library runs no code when it is loaded, and the types above are those of fmi3FunctionTypes.h
        unsafe {
            let library = libloading::Library::new(file.path())?;
            Ok(Self {
                instantiate: *library.get("fmi3InstantiateCoSimulation")?,
                enter_initialization: *library.get("fmi3EnterInitializationMode")?,
                exit_initialization: *library.get("fmi3ExitInitializationMode")?,
                free: *library.get("fmi3FreeInstance")?,
                set: *library.get("fmi3SetFloat64")?,
                get: *library.get("fmi3GetFloat64")?,
                do_step: *library.get("fmi3DoStep")?,
                _library: library,
                _file: file.into_temp_path(),
            })
        }
    }
}

/// An instance in Step Mode.
pub(crate) struct Fmu<'a> {
    library: &'a Library,
    handle: *mut c_void,
    time_s: f64,
    /// All statuses so far, combined.
    status: c_int,
}

/// Resources of an FMU in a folder of their own.
pub(crate) struct Resources {
    path: CString,
    _folder: tempfile::TempDir,
}

impl Resources {
    /// Writes the start-value file.
    pub(crate) fn with(start_file: &str) -> Result<Self, Box<dyn Error>> {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("start.txt"), start_file)?;
        let path = folder
            .path()
            .to_str()
            .ok_or("the temporary folder is not UTF-8")?;
        Ok(Self {
            path: CString::new(path)?,
            _folder: folder,
        })
    }
}

impl<'a> Fmu<'a> {
    /// Instance of the FMU with these resources.
    pub(crate) fn instantiate(
        library: &'a Library,
        resources: &Resources,
    ) -> Result<Self, Box<dyn Error>> {
        let token = CString::new(TOKEN)?;
        // SAFETY: all strings are terminated and live through the call, the callback is callable at any time
        let handle = unsafe {
            (library.instantiate)(
                c"benchmark".as_ptr(),
                token.as_ptr(),
                resources.path.as_ptr(),
                false,
                false,
                false,
                false,
                ptr::null(),
                0,
                ptr::null_mut(),
                Some(log),
                None,
            )
        };
        if handle.is_null() {
            return Err("the FMU cannot be instantiated".into());
        }
        Ok(Self {
            library,
            handle,
            time_s: 0.0,
            status: OK,
        })
    }

    /// Instance of the FMU with this start-value file, initialised at t = 0.
    pub(crate) fn start(library: &'a Library, start_file: &str) -> Result<Self, Box<dyn Error>> {
        let fmu = Self::instantiate(library, &Resources::with(start_file)?)?;
        // SAFETY: the instance lives
        let statuses = unsafe {
            [
                (library.enter_initialization)(fmu.handle, false, 0.0, 0.0, false, 0.0),
                (library.exit_initialization)(fmu.handle),
            ]
        };
        if statuses == [OK; 2] {
            Ok(fmu)
        } else {
            Err("the FMU cannot be initialised".into())
        }
    }

    /// Sets as many variables as there are value references.
    #[inline]
    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) {
        // SAFETY: the instance lives, pointers and lengths are those of slices
        self.status |= unsafe {
            (self.library.set)(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_ptr(),
                values.len(),
            )
        };
    }

    /// Reads as many variables as there are value references.
    #[inline]
    pub(crate) fn get(&mut self, references: &[u32], values: &mut [f64]) {
        // SAFETY: the instance lives, pointers and lengths are those of slices
        self.status |= unsafe {
            (self.library.get)(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
                values.len(),
            )
        };
    }

    /// Takes a communication step.
    #[inline]
    pub(crate) fn step(&mut self, interval_s: f64) {
        let (mut event, mut terminate, mut early) = (false, false, false);
        // SAFETY: the instance lives, all pointers are to locals or to a field
        self.status |= unsafe {
            (self.library.do_step)(
                self.handle,
                self.time_s,
                interval_s,
                true,
                &raw mut event,
                &raw mut terminate,
                &raw mut early,
                &raw mut self.time_s,
            )
        };
    }

    /// Whether any call was not answered with fmi3OK.
    pub(crate) fn has_failed(&self) -> bool {
        self.status != OK
    }
}

impl Drop for Fmu<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance lives until here
        unsafe { (self.library.free)(self.handle) };
    }
}

/// Passes the FMU's errors on.
unsafe extern "C" fn log(_: *mut c_void, _: c_int, _: *const c_char, message: *const c_char) {
    // SAFETY: the library gives a terminated string
    eprintln!("{}", unsafe { CStr::from_ptr(message) }.to_string_lossy());
}
