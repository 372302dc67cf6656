//! An instance of an FMU: made, initialised, stepped and freed.

use std::ffi::{CString, c_void};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::{fmt, ptr};

use crate::error::ImportError;
use crate::header::{
    Opaque, Reference, StatusCode,
    fmi2::{self, CallbackFunctions},
};
use crate::library::{Either, FmiVersion, Functions, Library, Named};
use crate::message::{Listener, Log, Message, Status, log_fmi2, log_fmi3};

// the C library that std links
unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(pointer: *mut c_void);
}

/// How to instantiate.
pub struct Setup<'a> {
    /// Name of the instance, not empty.
    pub name: &'a str,
    /// Instantiation token (FMI 3.0) or GUID (FMI 2.0) of the model description.
    pub token: &'a str,
    /// Folder `resources` of the unpacked FMU, an absolute path.
    pub resources: &'a Path,
    /// Whether the FMU is to log all that it can.
    pub logging: bool,
    /// Called with each message at once.
    pub listener: Option<Listener>,
}

/// What a communication step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Time that was reached, s; of FMI 2.0 the end of the step.
    pub reached_s: f64,
    /// Whether the FMU asks for event handling.
    pub event: bool,
    /// Whether the FMU asks to end the simulation.
    pub terminate: bool,
    /// Whether the FMU returned before the end of the step.
    pub early_return: bool,
}

/// The instance itself; freed when nobody uses it any more.
pub(crate) struct Handle<'l> {
    pub(crate) library: &'l Library,
    pub(crate) pointer: Opaque,
    pub(crate) log: Arc<Log>,
    /// What the library may call until it is freed (FMI 2.0).
    _callbacks: Option<Rc<CallbackFunctions>>,
}

impl Drop for Handle<'_> {
    fn drop(&mut self) {
        // SAFETY: made by this library, and nobody has it any more
        unsafe { self.library.free_instance(self.pointer) };
    }
}

/// An instance for Co-Simulation, freed when it is dropped.
pub struct Instance<'l> {
    pub(crate) handle: Rc<Handle<'l>>,
}

impl fmt::Debug for Instance<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Instance")
            .field("version", &self.handle.library.version())
            .finish_non_exhaustive()
    }
}

impl Library {
    /// A new instance for Co-Simulation.
    ///
    /// # Errors
    ///
    /// [`ImportError::Text`], or [`ImportError::Null`] with what the FMU logged.
    pub fn instantiate(&self, setup: Setup<'_>) -> Result<Instance<'_>, ImportError> {
        let name = terminated("instance name", setup.name)?;
        let token = terminated("token", setup.token)?;
        let log = Arc::new(Log::new(setup.listener));
        let environment = Arc::as_ptr(&log).cast_mut().cast();
        let path = utf8(setup.resources)?;
        let Named {
            name: function,
            function: instantiate,
        } = self.functions.instantiate;
        let (visible, logging) = (0_u8, setup.logging);
        let (pointer, callbacks) = match instantiate {
            Either::Three(instantiate) => {
                let resources = terminated("resource path", &with_separator(path))?;
                let (event_mode_used, early_return_allowed) = (0, 0);
                // SAFETY: the strings are terminated, the log outlives the instance
                let pointer = unsafe {
                    instantiate(
                        name.as_ptr(),
                        token.as_ptr(),
                        resources.as_ptr(),
                        visible,
                        logging.into(),
                        event_mode_used,
                        early_return_allowed,
                        ptr::null(),
                        0,
                        environment,
                        Some(log_fmi3),
                        None,
                    )
                };
                (pointer, None)
            }
            Either::Two(instantiate) => {
                let resources = terminated("resource location", &file_uri(path))?;
                let callbacks = Rc::new(CallbackFunctions {
                    logger: Some(fmi2::variadic(log_fmi2)),
                    allocate_memory: Some(calloc),
                    free_memory: Some(free),
                    step_finished: None,
                    environment,
                });
                // SAFETY: the strings are terminated, log and callbacks outlive the instance
                let pointer = unsafe {
                    instantiate(
                        name.as_ptr(),
                        fmi2::CO_SIMULATION,
                        token.as_ptr(),
                        resources.as_ptr(),
                        Rc::as_ptr(&callbacks),
                        visible.into(),
                        logging.into(),
                    )
                };
                (pointer, Some(callbacks))
            }
        };
        if pointer.is_null() {
            let messages = log.messages();
            return Err(ImportError::Null { function, messages });
        }
        Ok(Instance {
            handle: Rc::new(Handle {
                library: self,
                pointer,
                log,
                _callbacks: callbacks,
            }),
        })
    }
}

impl Instance<'_> {
    /// Everything that the FMU has logged so far.
    #[must_use]
    pub fn messages(&self) -> Vec<Message> {
        self.handle.log.messages()
    }

    /// Version of the standard that the instance is driven by.
    #[must_use]
    pub fn version(&self) -> FmiVersion {
        self.handle.library.version()
    }

    /// Enters Initialization Mode; with FMI 2.0 the experiment is set up before.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`].
    pub fn enter_initialization(
        &mut self,
        start_s: f64,
        stop_s: Option<f64>,
    ) -> Result<(), ImportError> {
        let (defined, stop_s) = (stop_s.is_some(), stop_s.unwrap_or(0.0));
        let instance = self.handle.pointer;
        let Named { name, function } = self.functions().set_time_span;
        // SAFETY: the instance lives
        self.call(name, || unsafe {
            match function {
                Either::Three(enter) => enter(instance, 0, 0.0, start_s, defined.into(), stop_s),
                Either::Two(set_up) => set_up(instance, 0, 0.0, start_s, defined.into(), stop_s),
            }
        })?;
        match self.functions().enter_initialization {
            Some(enter) => self.simply(enter),
            None => Ok(()),
        }
    }

    /// Leaves Initialization Mode.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`].
    pub fn exit_initialization(&mut self) -> Result<(), ImportError> {
        self.simply(self.functions().exit_initialization)
    }

    /// Ends the simulation.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`].
    pub fn terminate(&mut self) -> Result<(), ImportError> {
        self.simply(self.functions().terminate)
    }

    /// Back to the state after instantiation.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`].
    pub fn reset(&mut self) -> Result<(), ImportError> {
        self.simply(self.functions().reset)
    }

    /// Sets one value for each value reference.
    ///
    /// # Errors
    ///
    /// [`ImportError::Count`], [`ImportError::Refused`].
    pub fn set(&mut self, references: &[Reference], values: &[f64]) -> Result<(), ImportError> {
        let Named { name, function } = self.functions().set;
        same_count(name, references, values)?;
        let (instance, count) = (self.handle.pointer, references.len());
        let (references, values) = (references.as_ptr(), values.as_ptr());
        // SAFETY: the instance lives, pointers and counts are those of slices of one length
        self.call(name, || unsafe {
            match function {
                Either::Three(call) => call(instance, references, count, values, count),
                Either::Two(call) => call(instance, references, count, values),
            }
        })
    }

    /// Reads one value for each value reference.
    ///
    /// # Errors
    ///
    /// [`ImportError::Count`], [`ImportError::Refused`].
    pub fn get(&mut self, references: &[Reference], values: &mut [f64]) -> Result<(), ImportError> {
        let Named { name, function } = self.functions().get;
        same_count(name, references, values)?;
        let (instance, count) = (self.handle.pointer, references.len());
        let (references, values) = (references.as_ptr(), values.as_mut_ptr());
        // SAFETY: the instance lives, pointers and counts are those of slices of one length
        self.call(name, || unsafe {
            match function {
                Either::Three(call) => call(instance, references, count, values, count),
                Either::Two(call) => call(instance, references, count, values),
            }
        })
    }

    /// Takes the communication step from `time_s` to `time_s + interval_s`; no earlier state will be restored.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`].
    pub fn step(&mut self, time_s: f64, interval_s: f64) -> Result<Step, ImportError> {
        self.do_step(time_s, interval_s, true)
    }

    /// As [`Instance::step`], but the state before it may be restored later.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`].
    pub fn tentative_step(&mut self, time_s: f64, interval_s: f64) -> Result<Step, ImportError> {
        self.do_step(time_s, interval_s, false)
    }

    fn do_step(
        &mut self,
        time_s: f64,
        interval_s: f64,
        is_final: bool,
    ) -> Result<Step, ImportError> {
        let instance = self.handle.pointer;
        let (mut event, mut terminate, mut early) = (0, 0, 0);
        let mut reached_s = time_s;
        let Named { name, function } = self.functions().do_step;
        // SAFETY: the instance lives, all pointers are to locals
        self.call(name, || unsafe {
            match function {
                Either::Three(step) => step(
                    instance,
                    time_s,
                    interval_s,
                    is_final.into(),
                    &raw mut event,
                    &raw mut terminate,
                    &raw mut early,
                    &raw mut reached_s,
                ),
                Either::Two(step) => {
                    reached_s = time_s + interval_s;
                    step(instance, time_s, interval_s, is_final.into())
                }
            }
        })?;
        Ok(Step {
            reached_s,
            event: event != 0,
            terminate: terminate != 0,
            early_return: early != 0,
        })
    }

    /// Change of each unknown when the knowns change by `seed`, at the present point.
    ///
    /// # Errors
    ///
    /// [`ImportError::Count`], [`ImportError::Refused`].
    pub fn directional_derivative(
        &mut self,
        unknowns: &[Reference],
        knowns: &[Reference],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), ImportError> {
        let Named { name, function } = self.functions().directional_derivative;
        same_count(name, knowns, seed)?;
        same_count(name, unknowns, sensitivity)?;
        let (i, rows, columns) = (self.handle.pointer, unknowns.len(), knowns.len());
        let (unknowns, knowns) = (unknowns.as_ptr(), knowns.as_ptr());
        let (seed, change) = (seed.as_ptr(), sensitivity.as_mut_ptr());
        // SAFETY: the instance lives, pointers and counts are those of slices
        self.call(name, || unsafe {
            match function {
                Either::Three(call) => call(
                    i, unknowns, rows, knowns, columns, seed, columns, change, rows,
                ),
                Either::Two(call) => call(i, unknowns, rows, knowns, columns, seed, change),
            }
        })
    }

    pub(crate) fn functions(&self) -> &Functions {
        &self.handle.library.functions
    }

    /// Calls a function of the instance alone.
    fn simply(
        &self,
        Named { name, function }: Named<unsafe extern "C" fn(Opaque) -> StatusCode>,
    ) -> Result<(), ImportError> {
        // SAFETY: the instance lives
        self.call(name, || unsafe { function(self.handle.pointer) })
    }

    /// Makes a call and turns its status into a result.
    pub(crate) fn call(
        &self,
        function: &'static str,
        body: impl FnOnce() -> StatusCode,
    ) -> Result<(), ImportError> {
        let before = self.handle.log.len();
        let status = Status::of(body());
        if status.is_done() {
            return Ok(());
        }
        Err(ImportError::Refused {
            function,
            status,
            messages: self.handle.log.since(before),
        })
    }
}

fn same_count(
    function: &'static str,
    references: &[Reference],
    values: &[f64],
) -> Result<(), ImportError> {
    if references.len() == values.len() {
        return Ok(());
    }
    Err(ImportError::Count {
        function,
        references: references.len(),
        values: values.len(),
    })
}

fn terminated(argument: &'static str, text: &str) -> Result<CString, ImportError> {
    CString::new(text).map_err(|_| ImportError::Text {
        argument,
        found: text.to_owned(),
    })
}

fn utf8(path: &Path) -> Result<&str, ImportError> {
    path.to_str().ok_or_else(|| ImportError::Text {
        argument: "resource path",
        found: path.to_string_lossy().into_owned(),
    })
}

/// FMI 3.0 (2.3.1): the resource path ends with a file separator.
fn with_separator(path: &str) -> String {
    if path.ends_with(std::path::is_separator) {
        path.to_owned()
    } else {
        format!("{path}{}", std::path::MAIN_SEPARATOR)
    }
}

/// The path as a URI (RFC 3986): FMI 2.0 hands the resources over as one.
fn file_uri(path: &str) -> String {
    let mut uri = String::from("file://");
    // drive letters and network paths of Windows
    if !path.starts_with('/') && !path.starts_with("\\\\") {
        uri.push('/');
    }
    let path = path.strip_prefix("\\\\").unwrap_or(path);
    for byte in path.bytes() {
        match byte {
            b'\\' if cfg!(windows) => uri.push('/'),
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' | b':' => {
                uri.push(char::from(byte));
            }
            other => uri += &format!("%{other:02X}"),
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_uris() {
        assert_eq!(file_uri("/tmp/fmu/resources"), "file:///tmp/fmu/resources");
        // examples of percent-encoding: RFC 3986, 2.1 and 2.5
        assert_eq!(
            file_uri("/tmp/Prüfung 100% #1"),
            "file:///tmp/Pr%C3%BCfung%20100%25%20%231"
        );
    }
}
