//! A small importer: writes an FMU's resources, instantiates it, and keeps what it logs.

use std::{
    ffi::{CStr, CString, c_char, c_int, c_void},
    fs,
    mem::ManuallyDrop,
    path::{Path, PathBuf},
    ptr,
    sync::atomic::{AtomicU32, Ordering},
};

use crate::c;

pub(crate) const TOKEN: &str = "{7f0c-4a} #1";

/// Value references of modelDescription/*.xml that the tests use.
pub(crate) mod vr {
    pub(crate) const TIME: u32 = 0;
    pub(crate) const A_Y: u32 = 1;
    pub(crate) const A_THETA: u32 = 2;
    pub(crate) const A_V: u32 = 3;
    pub(crate) const A_OMEGA: u32 = 4;
    pub(crate) const B_Y: u32 = 5;
    pub(crate) const B_THETA: u32 = 6;
    pub(crate) const B_V: u32 = 7;
    pub(crate) const B_OMEGA: u32 = 8;
    pub(crate) const A_F: u32 = 9;
    pub(crate) const A_M: u32 = 10;
    pub(crate) const B_F: u32 = 11;
    pub(crate) const B_M: u32 = 12;
    pub(crate) const JOINT_F: u32 = 13;
    pub(crate) const JOINT_M: u32 = 14;
    pub(crate) const ENERGY: u32 = 15;
    pub(crate) const POWER: u32 = 16;
    pub(crate) const K_YY: u32 = 17;
    pub(crate) const C_YY: u32 = 20;
    pub(crate) const K3_Y: u32 = 23;
    pub(crate) const A_MASS: u32 = 25;
    pub(crate) const B_C_Y: u32 = 35;
    pub(crate) const STEP_SIZE_MAX: u32 = 37;
    pub(crate) const A_ACCELERATION: u32 = 38;
    pub(crate) const A_ALPHA: u32 = 39;
    pub(crate) const B_ACCELERATION: u32 = 40;
    pub(crate) const B_ALPHA: u32 = 41;
    pub(crate) const NONE: u32 = 42;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Element,
    Lap,
}

/// Parameters of the FMUs with round values, so that expected results can be worked out by hand.
const JOINT: [(&str, f64); 8] = [
    ("joint.k_yy", 4.0e6),
    ("joint.k_ytheta", 1.0e4),
    ("joint.k_thetatheta", 2.0e3),
    ("joint.c_yy", 8.0),
    ("joint.c_ytheta", 0.5),
    ("joint.c_thetatheta", 0.25),
    ("joint.k3_y", 0.0),
    ("joint.k3_theta", 0.0),
];
const BODY: [(&str, f64); 6] = [
    ("m", 2.0),
    ("J", 1e-3),
    ("k_y", 8.0e5),
    ("k_theta", 1.0e3),
    ("c_y", 1.0),
    ("c_theta", 1e-3),
];

/// Text of `start.txt` with some parameters replaced.
pub(crate) fn start_text(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> String {
    let mut parameters: Vec<(String, f64)> = JOINT
        .iter()
        .map(|&(name, value)| (name.to_owned(), value))
        .collect();
    if kind == Kind::Lap {
        for side in ["a", "b"] {
            parameters.extend(
                BODY.iter()
                    .map(|(name, value)| (format!("{side}.{name}"), *value)),
            );
        }
        parameters.push(("step_size_max".to_owned(), 2e-5));
    }
    if dofs == 1 {
        parameters.retain(|(name, _)| !name.ends_with("theta") && !name.ends_with(".J"));
    }
    let model = if kind == Kind::Lap { "lap" } else { "element" };
    let mut text = format!("bolted-joint-start/1\nmodel {model}\ndofs {dofs}\ntoken {TOKEN}\n");
    for (name, value) in parameters {
        let value = changes
            .iter()
            .find(|(changed, _)| *changed == name)
            .map_or(value, |(_, v)| *v);
        text += &format!("{name} {value}\n");
    }
    text
}

/// A folder that is removed when the test ends.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!(
            "bolted joint {} {number} {name}",
            std::process::id()
        ));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Folder with a start-value file.
    pub(crate) fn with_start(text: &str) -> Self {
        let folder = Self::new("Prüfung 100% #1");
        fs::write(folder.0.join("start.txt"), text).unwrap();
        folder
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// One log message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) status: c_int,
    pub(crate) category: String,
    pub(crate) text: String,
}

/// The importer's log callback: the environment is the list to append to.
pub(crate) unsafe extern "C" fn record(
    environment: *mut c_void,
    status: c_int,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the tests pass a list that outlives the instance, and strings come from the library
    unsafe {
        (*environment.cast::<Vec<Message>>()).push(Message {
            status,
            category: CStr::from_ptr(category).to_str().unwrap().to_owned(),
            text: CStr::from_ptr(text).to_str().unwrap().to_owned(),
        });
    }
}

/// What the callback within a communication step is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Update {
    pub(crate) time: f64,
    pub(crate) set: bool,
    pub(crate) get: bool,
    pub(crate) finished: bool,
    pub(crate) can_return_early: bool,
}

/// What the importer does in the callback; it returns the time of an early return.
type Script = Box<dyn FnMut(&mut Instance, Update) -> Option<f64>>;

/// `instanceEnvironment`: the log comes first, where [`record`] looks for it.
#[repr(C)]
#[derive(Default)]
struct Environment {
    log: Vec<Message>,
    handle: Option<*mut c_void>,
    script: Option<Script>,
}

/// The importer's callback within a communication step: runs the script of the environment.
unsafe extern "C" fn update(
    environment: *mut c_void,
    time: f64,
    set: bool,
    get: bool,
    finished: bool,
    can_return_early: bool,
    early_return_requested: *mut bool,
    early_return_time: *mut f64,
) {
    let environment = environment.cast::<Environment>();
    // SAFETY: the tests pass an environment that outlives the instance, the pointers come from the library
    unsafe {
        assert!(!*early_return_requested && *early_return_time == time);
        let Some(mut script) = (*environment).script.take() else {
            return;
        };
        // the instance that called, which is not ours to drop
        let mut instance = ManuallyDrop::new(Instance {
            handle: (*environment).handle.unwrap(),
            environment,
            start_s: 0.0,
        });
        let told = Update {
            time,
            set,
            get,
            finished,
            can_return_early,
        };
        if let Some(at) = script(&mut instance, told) {
            *early_return_requested = true;
            *early_return_time = at;
        }
        (*environment).script = Some(script);
    }
}

/// What a communication step returned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepped {
    pub(crate) status: c_int,
    pub(crate) early: bool,
    pub(crate) last: f64,
}

/// How to instantiate.
pub(crate) struct Request<'a> {
    pub(crate) name: Option<&'a str>,
    pub(crate) token: Option<&'a str>,
    pub(crate) resources: Option<&'a str>,
    pub(crate) logging: bool,
    pub(crate) event_mode: bool,
    pub(crate) early_return: bool,
    /// Whether to give a callback for intermediate updates, and the variables that it will use.
    pub(crate) updated: bool,
    pub(crate) intermediate: &'a [u32],
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self {
            name: Some("joint"),
            token: Some(TOKEN),
            resources: None,
            logging: true,
            event_mode: false,
            early_return: false,
            updated: false,
            intermediate: &[],
        }
    }
}

impl Request<'_> {
    /// The instance, or the messages that say why there is none.
    pub(crate) fn instantiate(&self) -> Result<Instance, Vec<Message>> {
        // SAFETY: all strings are terminated and live through the call, the log lives until the instance is freed
        self.instantiate_by(|[name, token, resources], log| unsafe {
            c::fmi3InstantiateCoSimulation(
                name,
                token,
                resources,
                false,
                self.logging,
                self.event_mode,
                self.early_return,
                self.intermediate.as_ptr(),
                self.intermediate.len(),
                log,
                Some(record),
                self.updated.then_some(update),
            )
        })
    }

    /// The instance for Model Exchange, or the messages that say why there is none.
    pub(crate) fn instantiate_model_exchange(&self) -> Result<Instance, Vec<Message>> {
        // SAFETY: all strings are terminated and live through the call, the log lives until the instance is freed
        self.instantiate_by(|[name, token, resources], log| unsafe {
            c::fmi3InstantiateModelExchange(
                name,
                token,
                resources,
                false,
                self.logging,
                log,
                Some(record),
            )
        })
    }

    fn instantiate_by(
        &self,
        function: impl FnOnce([*const c_char; 3], *mut c_void) -> *mut c_void,
    ) -> Result<Instance, Vec<Message>> {
        let texts = [self.name, self.token, self.resources]
            .map(|text| text.map(|text| CString::new(text).unwrap()));
        let pointers = texts
            .each_ref()
            .map(|text| text.as_ref().map_or(ptr::null(), |text| text.as_ptr()));
        let environment: *mut Environment = Box::into_raw(Box::default());
        let handle = function(pointers, environment.cast());
        if handle.is_null() {
            // SAFETY: nobody else has the environment any more
            return Err(unsafe { Box::from_raw(environment) }.log);
        }
        // SAFETY: the library uses the environment only during a call
        unsafe { (*environment).handle = Some(handle) };
        Ok(Instance {
            handle,
            environment,
            start_s: 0.0,
        })
    }
}

/// An instance with its log.
pub(crate) struct Instance {
    pub(crate) handle: *mut c_void,
    environment: *mut Environment,
    start_s: f64,
}

// SAFETY: FMI instances may be moved between threads
unsafe impl Send for Instance {}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: made together, freed together
        unsafe {
            c::fmi3FreeInstance(self.handle);
            drop(Box::from_raw(self.environment));
        }
    }
}

impl Instance {
    /// Instance in state Instantiated.
    pub(crate) fn new(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let folder = Folder::with_start(&start_text(kind, dofs, changes));
        let request = Request {
            resources: folder.0.to_str(),
            ..Request::default()
        };
        request.instantiate().unwrap()
    }

    /// Instance for Model Exchange in state Instantiated.
    pub(crate) fn exchanging(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let folder = Folder::with_start(&start_text(kind, dofs, changes));
        let request = Request {
            resources: folder.0.to_str(),
            ..Request::default()
        };
        request.instantiate_model_exchange().unwrap()
    }

    /// Instance in Step Mode at t = 0.
    pub(crate) fn stepping(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let mut instance = Self::new(kind, dofs, changes);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        instance
    }

    /// All messages since the last call.
    pub(crate) fn take_log(&mut self) -> Vec<Message> {
        // SAFETY: the library writes to the log only during a call
        std::mem::take(unsafe { &mut (*self.environment).log })
    }

    /// The one error message since the last call; events are ignored.
    pub(crate) fn error(&mut self) -> String {
        let log = self.take_log();
        let errors: Vec<&Message> = log
            .iter()
            .filter(|message| message.status == c::ERROR)
            .collect();
        match errors.as_slice() {
            [error] => {
                assert_eq!(error.category, "logStatusError");
                error.text.clone()
            }
            _ => panic!("expected one error, found {log:?}"),
        }
    }

    /// The message of a call that is refused, and that must leave the instance as it was, mode included.
    pub(crate) fn refused(&mut self, call: impl FnOnce(&mut Self) -> c_int) -> String {
        let before = self.state_bytes();
        assert_eq!(call(self), c::ERROR);
        assert!(
            self.state_bytes() == before,
            "the call changed the instance"
        );
        self.error()
    }

    /// All that the instance remembers: mode, stop time, values.
    pub(crate) fn state_bytes(&mut self) -> Vec<u8> {
        let state = self.save();
        let bytes = self.serialize(state);
        self.free_state(state);
        bytes
    }

    pub(crate) fn enter_initialization(&mut self, start_s: f64, stop_s: Option<f64>) -> c_int {
        self.start_s = start_s;
        // SAFETY: the instance lives
        unsafe {
            c::fmi3EnterInitializationMode(
                self.handle,
                false,
                0.0,
                start_s,
                stop_s.is_some(),
                stop_s.unwrap_or(f64::NAN),
            )
        }
    }

    pub(crate) fn exit_initialization(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi3ExitInitializationMode(self.handle) }
    }

    pub(crate) fn terminate(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi3Terminate(self.handle) }
    }

    pub(crate) fn reset(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi3Reset(self.handle) }
    }

    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) -> c_int {
        // SAFETY: pointers and lengths are those of slices
        unsafe {
            c::fmi3SetFloat64(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_ptr(),
                values.len(),
            )
        }
    }

    pub(crate) fn try_get(&mut self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetFloat64(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
                values.len(),
            )
        };
        if status == c::OK {
            Ok(values)
        } else {
            Err(status)
        }
    }

    pub(crate) fn get<const N: usize>(&mut self, references: [u32; N]) -> [f64; N] {
        self.try_get(&references).unwrap().try_into().unwrap()
    }

    /// Directional derivative, with as many results as there are unknowns.
    pub(crate) fn directional(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        let mut sensitivity = vec![f64::NAN; unknowns.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetDirectionalDerivative(
                self.handle,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                sensitivity.as_mut_ptr(),
                sensitivity.len(),
            )
        };
        (status == c::OK).then_some(sensitivity).ok_or(status)
    }

    /// Adjoint derivative, with as many results as there are knowns.
    pub(crate) fn adjoint(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        let mut sensitivity = vec![f64::NAN; knowns.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetAdjointDerivative(
                self.handle,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                sensitivity.as_mut_ptr(),
                sensitivity.len(),
            )
        };
        (status == c::OK).then_some(sensitivity).ok_or(status)
    }

    /// What to do in the callback within a communication step.
    pub(crate) fn on_update(
        &mut self,
        script: impl FnMut(&mut Instance, Update) -> Option<f64> + 'static,
    ) {
        // SAFETY: the library uses the environment only during a call
        unsafe { (*self.environment).script = Some(Box::new(script)) };
    }

    /// First derivatives of outputs with respect to time.
    pub(crate) fn output_derivatives(&mut self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        let orders = vec![1; references.len()];
        self.derivatives_of_order(references, &orders)
    }

    /// Derivatives of outputs with respect to time.
    pub(crate) fn derivatives_of_order(
        &mut self,
        references: &[u32],
        orders: &[i32],
    ) -> Result<Vec<f64>, c_int> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetOutputDerivatives(
                self.handle,
                references.as_ptr(),
                references.len(),
                orders.as_ptr(),
                values.as_mut_ptr(),
                values.len(),
            )
        };
        (status == c::OK).then_some(values).ok_or(status)
    }

    /// Status of a step that ends where it shall or not at all, and the time that it reached.
    pub(crate) fn step(&mut self, t: f64, h: f64) -> (c_int, f64) {
        let Stepped {
            status,
            early,
            last,
        } = self.do_step(t, h);
        assert!(!early);
        (status, last)
    }

    /// What a step returned.
    pub(crate) fn do_step(&mut self, t: f64, h: f64) -> Stepped {
        let (mut event, mut terminate, mut early, mut last) = (true, true, true, f64::NAN);
        // SAFETY: the instance lives, all pointers are to locals
        let status = unsafe {
            c::fmi3DoStep(
                self.handle,
                t,
                h,
                true,
                &raw mut event,
                &raw mut terminate,
                &raw mut early,
                &raw mut last,
            )
        };
        assert!(!event && !terminate);
        Stepped {
            status,
            early,
            last,
        }
    }

    pub(crate) fn save(&mut self) -> *mut c_void {
        let mut state = ptr::null_mut();
        // SAFETY: the instance lives, the pointer is to a local
        let status = unsafe { c::fmi3GetFMUState(self.handle, &raw mut state) };
        assert_eq!(status, c::OK);
        assert!(!state.is_null());
        state
    }

    pub(crate) fn restore(&mut self, state: *mut c_void) -> c_int {
        // SAFETY: the instance lives, the tests pass living states
        unsafe { c::fmi3SetFMUState(self.handle, state) }
    }

    pub(crate) fn free_state(&mut self, mut state: *mut c_void) {
        // SAFETY: the instance lives, the tests pass living states
        let status = unsafe { c::fmi3FreeFMUState(self.handle, &raw mut state) };
        assert_eq!(status, c::OK);
        assert!(state.is_null());
    }

    pub(crate) fn serialize(&mut self, state: *mut c_void) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: the instance lives, the tests pass living states, pointers are to locals
        unsafe {
            assert_eq!(
                c::fmi3SerializedFMUStateSize(self.handle, state, &raw mut size),
                c::OK
            );
            let mut bytes = vec![0xaa; size];
            assert_eq!(
                c::fmi3SerializeFMUState(self.handle, state, bytes.as_mut_ptr(), size),
                c::OK
            );
            bytes
        }
    }

    pub(crate) fn deserialize(&mut self, bytes: &[u8]) -> Result<*mut c_void, c_int> {
        let mut state = ptr::null_mut();
        // SAFETY: the instance lives, pointers are to slices and locals
        let status = unsafe {
            c::fmi3DeserializeFMUState(self.handle, bytes.as_ptr(), bytes.len(), &raw mut state)
        };
        if status == c::OK {
            assert!(!state.is_null());
            Ok(state)
        } else {
            assert!(state.is_null());
            Err(status)
        }
    }
}

/// The path as text.
pub(crate) fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}
