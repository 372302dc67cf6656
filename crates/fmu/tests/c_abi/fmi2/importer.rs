//! A small importer for FMI 2.0, with the FMU folders of the other one.

use std::{
    ffi::{CStr, CString, c_char, c_int, c_void},
    mem, ptr,
};

use super::c;
use crate::importer::{Folder, Kind, TOKEN, start_text};

/// One log message, as the importer's callback got it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) instance_name: String,
    pub(crate) status: c_int,
    pub(crate) category: String,
    pub(crate) text: String,
}

#[cfg(unix)]
unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> c_int;
}

/// The message as an importer shows it that takes it as a format of `printf`, as the standard says.
#[cfg(unix)]
unsafe fn formatted(message: *const c_char) -> String {
    let mut buffer = vec![0_u8; 1 << 16];
    // SAFETY: the buffer has the size that is told; the library promises a format without conversions
    let length = unsafe { snprintf(buffer.as_mut_ptr().cast(), buffer.len(), message) };
    buffer.truncate(usize::try_from(length).unwrap());
    String::from_utf8(buffer).unwrap()
}

#[cfg(not(unix))]
unsafe fn formatted(message: *const c_char) -> String {
    // SAFETY: the library passes a terminated string
    let message = unsafe { CStr::from_ptr(message) };
    message.to_str().unwrap().replace("%%", "%")
}

/// The importer's log callback: the environment is the list to append to.
unsafe extern "C" fn record(
    environment: *mut c_void,
    instance_name: *const c_char,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the tests pass a list that outlives the instance, and strings come from the library
    unsafe {
        let text = |text: *const c_char| CStr::from_ptr(text).to_str().unwrap().to_owned();
        (*environment.cast::<Vec<Message>>()).push(Message {
            instance_name: text(instance_name),
            status,
            category: text(category),
            text: formatted(message),
        });
    }
}

/// The callback under its C type.
pub(crate) fn recorder() -> c::Logger {
    type Recorder =
        unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);
    // SAFETY: the platforms of the tests hand over the arguments before the dots as if there were no dots; Rust has no
    // stable way to define a function with them
    unsafe { mem::transmute::<Recorder, c::Logger>(record) }
}

/// How to instantiate.
pub(crate) struct Request<'a> {
    pub(crate) name: Option<&'a str>,
    pub(crate) fmu_type: c_int,
    pub(crate) guid: Option<&'a str>,
    pub(crate) resources: Option<&'a str>,
    pub(crate) logging: bool,
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self {
            name: Some("joint"),
            fmu_type: c::CO_SIMULATION,
            guid: Some(TOKEN),
            resources: None,
            logging: true,
        }
    }
}

impl Request<'_> {
    /// The instance, or the messages that say why there is none.
    pub(crate) fn instantiate(&self) -> Result<Instance, Vec<Message>> {
        let texts = [self.name, self.guid, self.resources]
            .map(|text| text.map(|text| CString::new(text).unwrap()));
        let [name, guid, resources] = texts
            .each_ref()
            .map(|text| text.as_ref().map_or(ptr::null(), |text| text.as_ptr()));
        let log: *mut Vec<Message> = Box::into_raw(Box::default());
        let functions = Box::new(c::CallbackFunctions {
            logger: Some(recorder()),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            environment: log.cast(),
        });
        let logging = c_int::from(self.logging);
        // SAFETY: all pointers are to what lives through the call, the log lives until the instance is freed
        let handle = unsafe {
            c::fmi2Instantiate(
                name,
                self.fmu_type,
                guid,
                resources,
                &raw const *functions,
                0,
                logging,
            )
        };
        // the structure is only there during the call
        drop(functions);
        if handle.is_null() {
            // SAFETY: nobody else has the log any more
            return Err(unsafe { *Box::from_raw(log) });
        }
        Ok(Instance { handle, log })
    }
}

/// An instance with its log.
pub(crate) struct Instance {
    pub(crate) handle: *mut c_void,
    log: *mut Vec<Message>,
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: made together, freed together
        unsafe {
            c::fmi2FreeInstance(self.handle);
            drop(Box::from_raw(self.log));
        }
    }
}

/// States of both state machines (FMI 2.0, 3.2.3 and 4.2.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    Instantiated,
    SetUp,
    Initialization,
    Step,
    Event,
    ContinuousTime,
    Terminated,
}

impl State {
    pub(crate) const CO_SIMULATION: [Self; 5] = [
        Self::Instantiated,
        Self::SetUp,
        Self::Initialization,
        Self::Step,
        Self::Terminated,
    ];
    pub(crate) const MODEL_EXCHANGE: [Self; 6] = [
        Self::Instantiated,
        Self::SetUp,
        Self::Initialization,
        Self::Event,
        Self::ContinuousTime,
        Self::Terminated,
    ];

    /// Name in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "Instantiated",
            Self::SetUp => "Instantiated after fmi2SetupExperiment",
            Self::Initialization => "Initialization Mode",
            Self::Step => "Step Mode",
            Self::Event => "Event Mode",
            Self::ContinuousTime => "Continuous-Time Mode",
            Self::Terminated => "Terminated",
        }
    }
}

impl Instance {
    /// Instance in state Instantiated.
    pub(crate) fn new(fmu_type: c_int, kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let folder = Folder::with_start(&start_text(kind, dofs, changes));
        let request = Request {
            fmu_type,
            resources: folder.0.to_str(),
            ..Request::default()
        };
        request.instantiate().unwrap()
    }

    /// Instance in Step Mode at t = 0.
    pub(crate) fn stepping(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let mut instance = Self::new(c::CO_SIMULATION, kind, dofs, changes);
        instance.go_to(State::Step);
        instance
    }

    /// Instance in Continuous-Time Mode at t = 0.
    pub(crate) fn continuous(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let mut instance = Self::new(c::MODEL_EXCHANGE, kind, dofs, changes);
        instance.go_to(State::ContinuousTime);
        instance
    }

    /// From Instantiated to another state, at t = 0.
    pub(crate) fn go_to(&mut self, state: State) {
        if state != State::Instantiated {
            assert_eq!(self.set_up(0.0, None), c::OK);
        }
        if !matches!(state, State::Instantiated | State::SetUp) {
            assert_eq!(self.enter_initialization(), c::OK);
        }
        if !matches!(
            state,
            State::Instantiated | State::SetUp | State::Initialization
        ) {
            assert_eq!(self.exit_initialization(), c::OK);
        }
        match state {
            State::ContinuousTime => {
                assert_eq!(self.new_discrete_states(), c::OK);
                assert_eq!(self.enter_continuous_time(), c::OK);
            }
            State::Terminated => assert_eq!(self.terminate(), c::OK),
            _ => {}
        }
        self.take_log();
    }

    /// All messages since the last call.
    pub(crate) fn take_log(&mut self) -> Vec<Message> {
        // SAFETY: the library writes to the log only during a call
        mem::take(unsafe { &mut *self.log })
    }

    /// Text of the one message with this status since the last call; events are ignored.
    pub(crate) fn message(&mut self, status: c_int) -> String {
        let log = self.take_log();
        let messages: Vec<&Message> = log.iter().filter(|m| m.status != c::OK).collect();
        let [message] = messages.as_slice() else {
            panic!("expected one message, found {log:?}");
        };
        assert_eq!(message.status, status);
        assert_eq!(message.category, "logStatusError");
        assert_eq!(message.instance_name, "joint");
        message.text.clone()
    }

    /// The message of a call that is refused, and that must leave the instance as it was.
    pub(crate) fn refused(&mut self, call: impl FnOnce(&mut Self) -> c_int) -> String {
        let before = self.state_bytes();
        assert_eq!(call(self), c::ERROR);
        assert!(
            self.state_bytes() == before,
            "the call changed the instance"
        );
        self.message(c::ERROR)
    }

    /// All that the instance remembers.
    pub(crate) fn state_bytes(&mut self) -> Vec<u8> {
        let state = self.save();
        let bytes = self.serialize(state);
        self.free_state(state);
        bytes
    }

    pub(crate) fn set_up(&mut self, start_s: f64, stop_s: Option<f64>) -> c_int {
        let (defined, stop_s) = (c_int::from(stop_s.is_some()), stop_s.unwrap_or(f64::NAN));
        // SAFETY: the instance lives
        unsafe { c::fmi2SetupExperiment(self.handle, 1, 1e-6, start_s, defined, stop_s) }
    }

    pub(crate) fn enter_initialization(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2EnterInitializationMode(self.handle) }
    }

    pub(crate) fn exit_initialization(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2ExitInitializationMode(self.handle) }
    }

    pub(crate) fn terminate(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2Terminate(self.handle) }
    }

    pub(crate) fn reset(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2Reset(self.handle) }
    }

    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) -> c_int {
        assert_eq!(references.len(), values.len());
        // SAFETY: pointers and lengths are those of slices
        unsafe {
            c::fmi2SetReal(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_ptr(),
            )
        }
    }

    pub(crate) fn try_get(&mut self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi2GetReal(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
            )
        };
        (status == c::OK).then_some(values).ok_or(status)
    }

    pub(crate) fn get<const N: usize>(&mut self, references: [u32; N]) -> [f64; N] {
        self.try_get(&references).unwrap().try_into().unwrap()
    }

    pub(crate) fn directional(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        assert_eq!(knowns.len(), seed.len());
        let mut sensitivity = vec![f64::NAN; unknowns.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi2GetDirectionalDerivative(
                self.handle,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                sensitivity.as_mut_ptr(),
            )
        };
        (status == c::OK).then_some(sensitivity).ok_or(status)
    }

    pub(crate) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[c_int],
        values: &[f64],
    ) -> c_int {
        // SAFETY: pointers and lengths are those of slices
        unsafe {
            c::fmi2SetRealInputDerivatives(
                self.handle,
                references.as_ptr(),
                references.len(),
                orders.as_ptr(),
                values.as_ptr(),
            )
        }
    }

    pub(crate) fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[c_int],
    ) -> Result<Vec<f64>, c_int> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi2GetRealOutputDerivatives(
                self.handle,
                references.as_ptr(),
                references.len(),
                orders.as_ptr(),
                values.as_mut_ptr(),
            )
        };
        (status == c::OK).then_some(values).ok_or(status)
    }

    pub(crate) fn step(&mut self, t: f64, h: f64) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2DoStep(self.handle, t, h, 1) }
    }

    pub(crate) fn cancel_step(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2CancelStep(self.handle) }
    }

    /// Asks for a status with a function that writes it to one value.
    pub(crate) fn status<T: Copy>(
        &mut self,
        function: unsafe extern "C" fn(*mut c_void, c_int, *mut T) -> c_int,
        kind: c_int,
        mut value: T,
    ) -> Result<T, c_int> {
        // SAFETY: the instance lives, the pointer is to a local
        let status = unsafe { function(self.handle, kind, &raw mut value) };
        (status == c::OK).then_some(value).ok_or(status)
    }

    pub(crate) fn enter_event(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2EnterEventMode(self.handle) }
    }

    pub(crate) fn enter_continuous_time(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2EnterContinuousTimeMode(self.handle) }
    }

    pub(crate) fn new_discrete_states(&mut self) -> c_int {
        let mut info = c::EventInfo {
            new_discrete_states_needed: 7,
            terminate_simulation: 7,
            nominals_changed: 7,
            values_changed: 7,
            next_event_time_defined: 7,
            next_event_time: f64::NAN,
        };
        // SAFETY: the instance lives, the pointer is to a local
        let status = unsafe { c::fmi2NewDiscreteStates(self.handle, &raw mut info) };
        if status == c::OK {
            let nothing = c::EventInfo {
                new_discrete_states_needed: 0,
                terminate_simulation: 0,
                nominals_changed: 0,
                values_changed: 0,
                next_event_time_defined: 0,
                next_event_time: 0.0,
            };
            assert_eq!(info, nothing);
        }
        status
    }

    pub(crate) fn complete_step(&mut self) -> c_int {
        let (mut event, mut end) = (7, 7);
        // SAFETY: the instance lives, all pointers are to locals
        let status =
            unsafe { c::fmi2CompletedIntegratorStep(self.handle, 1, &raw mut event, &raw mut end) };
        assert!(status != c::OK || (event, end) == (0, 0));
        status
    }

    pub(crate) fn set_time(&mut self, time: f64) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi2SetTime(self.handle, time) }
    }

    pub(crate) fn set_states(&mut self, states: &[f64]) -> c_int {
        // SAFETY: the instance lives, pointer and length are those of a slice
        unsafe { c::fmi2SetContinuousStates(self.handle, states.as_ptr(), states.len()) }
    }

    /// Reads an array of this length.
    pub(crate) fn read(
        &mut self,
        function: unsafe extern "C" fn(*mut c_void, *mut f64, usize) -> c_int,
        count: usize,
    ) -> Result<Vec<f64>, c_int> {
        let mut numbers = vec![f64::NAN; count];
        // SAFETY: the instance lives, pointer and length are those of a slice
        let status = unsafe { function(self.handle, numbers.as_mut_ptr(), count) };
        (status == c::OK).then_some(numbers).ok_or(status)
    }

    pub(crate) fn save(&mut self) -> *mut c_void {
        let mut state = ptr::null_mut();
        // SAFETY: the instance lives, the pointer is to a local
        let status = unsafe { c::fmi2GetFMUstate(self.handle, &raw mut state) };
        assert_eq!(status, c::OK);
        assert!(!state.is_null());
        state
    }

    pub(crate) fn restore(&mut self, state: *mut c_void) -> c_int {
        // SAFETY: the instance lives, the tests pass living states
        unsafe { c::fmi2SetFMUstate(self.handle, state) }
    }

    pub(crate) fn free_state(&mut self, mut state: *mut c_void) {
        // SAFETY: the instance lives, the tests pass living states
        let status = unsafe { c::fmi2FreeFMUstate(self.handle, &raw mut state) };
        assert_eq!(status, c::OK);
        assert!(state.is_null());
    }

    pub(crate) fn serialize(&mut self, state: *mut c_void) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: the instance lives, the tests pass living states, pointers are to locals
        unsafe {
            assert_eq!(
                c::fmi2SerializedFMUstateSize(self.handle, state, &raw mut size),
                c::OK
            );
            let mut bytes = vec![0xaa; size];
            assert_eq!(
                c::fmi2SerializeFMUstate(self.handle, state, bytes.as_mut_ptr(), size),
                c::OK
            );
            bytes
        }
    }

    pub(crate) fn deserialize(&mut self, bytes: &[u8]) -> Result<*mut c_void, c_int> {
        let mut state = ptr::null_mut();
        // SAFETY: the instance lives, pointers are to slices and locals
        let status = unsafe {
            c::fmi2DeSerializeFMUstate(self.handle, bytes.as_ptr(), bytes.len(), &raw mut state)
        };
        assert_eq!(state.is_null(), status != c::OK);
        (status == c::OK).then_some(state).ok_or(status)
    }
}

/// The status of a call that gives a result.
pub(crate) fn status_of<T>(result: Result<T, c_int>) -> c_int {
    result.err().unwrap_or(c::OK)
}
