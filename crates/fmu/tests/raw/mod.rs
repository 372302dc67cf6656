//! The C functions of both versions under one name each, with slices in place of pointers: what the test programs share.
//!
//! The functions come from the library's symbols, which each test program links. A [`Raw`] instance frees nothing.
#![allow(dead_code, unused_imports, reason = "each test program uses a part")]

pub(crate) mod assembly;
pub(crate) mod request;
mod start;

use std::{
    ffi::{CStr, c_int, c_void},
    ptr,
};

pub(crate) use start::{SPACE, start_text};

pub(crate) use bolted_joint_importer::FmiVersion::{self, Three as Fmi3, Two as Fmi2};
use bolted_joint_importer::header::{OK, fmi2::*, fmi3::*};

/// Both versions.
pub(crate) const BOTH: [FmiVersion; 2] = [Fmi2, Fmi3];

/// Who integrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interface {
    CoSimulation,
    ModelExchange,
}

/// An instance, as C knows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Raw {
    pub(crate) version: FmiVersion,
    pub(crate) handle: *mut c_void,
}

/// What a communication step returned; of FMI 2.0 the status alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepped {
    pub(crate) status: c_int,
    pub(crate) early: bool,
    pub(crate) last: f64,
}

/// The status of a call that gives a result.
pub(crate) fn status_of<T>(result: Result<T, c_int>) -> c_int {
    result.err().unwrap_or(OK)
}

/// Calls the function of the instance's version. The two differ in name, and perhaps in arguments.
macro_rules! call {
    ($raw:expr, $two:ident $twos:tt, $three:ident $threes:tt) => {
        match $raw.version {
            Fmi2 => call!(@one $raw, $two $twos),
            Fmi3 => call!(@one $raw, $three $threes),
        }
    };
    ($raw:expr, $two:ident | $three:ident $arguments:tt) => {
        call!($raw, $two $arguments, $three $arguments)
    };
    (@one $raw:expr, $function:ident($($argument:expr),* $(,)?)) => {
        // SAFETY: the tests pass living instances and states, pointers and lengths of slices and locals, and what the
        // functions have to refuse before they look behind a pointer
        unsafe { $function($raw.handle, $($argument),*) }
    };
}
pub(crate) use call;

/// Functions that differ between the versions in their names alone.
macro_rules! alike {
    ($($name:ident($($argument:ident: $type:ty),*) = $two:ident | $three:ident;)*) => {
        impl Raw {
            $(pub(crate) fn $name(self, $($argument: $type),*) -> c_int {
                call!(self, $two | $three($($argument),*))
            })*
        }
    };
}

alike! {
    exit_initialization() = fmi2ExitInitializationMode | fmi3ExitInitializationMode;
    terminate() = fmi2Terminate | fmi3Terminate;
    reset() = fmi2Reset | fmi3Reset;
    enter_event() = fmi2EnterEventMode | fmi3EnterEventMode;
    enter_continuous() = fmi2EnterContinuousTimeMode | fmi3EnterContinuousTimeMode;
    set_time(time: f64) = fmi2SetTime | fmi3SetTime;
    restore(state: *mut c_void) = fmi2SetFMUstate | fmi3SetFMUState;
}

/// Functions that write numbers: those, or the status of a refusal.
macro_rules! numbers {
    ($($name:ident = $two:ident | $three:ident;)*) => {
        impl Raw {
            $(pub(crate) fn $name(self, count: usize) -> Result<Vec<f64>, c_int> {
                written(count, |numbers| call!(self, $two | $three(numbers, count)))
            })*
        }
    };
}

numbers! {
    try_states = fmi2GetContinuousStates | fmi3GetContinuousStates;
    try_derivatives = fmi2GetDerivatives | fmi3GetContinuousStateDerivatives;
    try_nominals = fmi2GetNominalsOfContinuousStates | fmi3GetNominalsOfContinuousStates;
    try_indicators = fmi2GetEventIndicators | fmi3GetEventIndicators;
}

impl Raw {
    pub(crate) fn free(self) {
        call!(self, fmi2FreeInstance | fmi3FreeInstance());
    }

    /// Switches log categories, or all if none is named.
    pub(crate) fn switch_logging(self, on: bool, categories: &[&CStr]) -> c_int {
        let names: Vec<_> = categories.iter().map(|name| name.as_ptr()).collect();
        let (count, names) = (names.len(), names.as_ptr());
        call!(
            self,
            fmi2SetDebugLogging | fmi3SetDebugLogging(on.into(), count, names)
        )
    }

    /// FMI 2.0: tells the time span.
    pub(crate) fn set_up(self, start_s: f64, stop_s: Option<f64>) -> c_int {
        let (defined, stop_s) = (stop_s.is_some().into(), stop_s.unwrap_or(f64::NAN));
        call!(@one self, fmi2SetupExperiment(1, 1e-6, start_s, defined, stop_s))
    }

    /// Starts initialisation; with FMI 2.0 the time span is told before.
    pub(crate) fn enter_initialization(self, start_s: f64, stop_s: Option<f64>) -> c_int {
        let (defined, stop) = (stop_s.is_some().into(), stop_s.unwrap_or(f64::NAN));
        match self.version {
            Fmi2 => match self.set_up(start_s, stop_s) {
                OK => self.enter_set_up(),
                refused => refused,
            },
            Fmi3 => call!(@one self, fmi3EnterInitializationMode(0, 0.0, start_s, defined, stop)),
        }
    }

    /// FMI 2.0: starts initialisation when the time span is known.
    pub(crate) fn enter_set_up(self) -> c_int {
        call!(@one self, fmi2EnterInitializationMode())
    }

    pub(crate) fn set(self, references: &[u32], values: &[f64]) -> c_int {
        assert_eq!(references.len(), values.len());
        let (count, values) = (values.len(), values.as_ptr());
        let references = references.as_ptr();
        call!(
            self,
            fmi2SetReal(references, count, values),
            fmi3SetFloat64(references, count, values, count)
        )
    }

    pub(crate) fn try_get(self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        let count = references.len();
        let references = references.as_ptr();
        written(count, |values| {
            call!(
                self,
                fmi2GetReal(references, count, values),
                fmi3GetFloat64(references, count, values, count)
            )
        })
    }

    pub(crate) fn get<const N: usize>(self, references: [u32; N]) -> [f64; N] {
        self.try_get(&references).unwrap().try_into().unwrap()
    }

    /// Status of a step that ends where it shall, or not at all.
    pub(crate) fn step(self, t: f64, h: f64) -> c_int {
        let stepped = self.do_step(t, h);
        assert!(!stepped.early);
        stepped.status
    }

    /// Status of such a step, and the time that it reached. FMI 2.0 tells that in Step Mode and after termination only.
    pub(crate) fn step_to(self, t: f64, h: f64) -> (c_int, f64) {
        let stepped = self.do_step(t, h);
        assert!(!stepped.early);
        let last = match self.version {
            Fmi2 => self.status(fmi2GetRealStatus, LAST_SUCCESSFUL_TIME, f64::NAN),
            Fmi3 => Ok(stepped.last),
        };
        (stepped.status, last.unwrap())
    }

    /// FMI 2.0: whether the simulation has ended.
    pub(crate) fn has_terminated(self) -> bool {
        match self.status(fmi2GetBooleanStatus, TERMINATED, 7).unwrap() {
            0 => false,
            1 => true,
            other => panic!("{other}"),
        }
    }

    pub(crate) fn do_step(self, t: f64, h: f64) -> Stepped {
        let (mut event, mut end, mut early, mut last) = (7, 7, 7, f64::NAN);
        let (flags, time) = (
            [&raw mut event, &raw mut end, &raw mut early],
            &raw mut last,
        );
        let status = call!(
            self,
            fmi2DoStep(t, h, 1),
            fmi3DoStep(t, h, 1, flags[0], flags[1], flags[2], time)
        );
        assert!(self.version == Fmi2 || (event, end) == (0, 0));
        Stepped {
            status,
            early: self.version == Fmi3 && early != 0,
            last,
        }
    }

    /// FMI 2.0: asks for a status with a function that writes it to one value.
    pub(crate) fn status<T: Copy>(
        self,
        function: unsafe extern "C" fn(*mut c_void, c_int, *mut T) -> c_int,
        kind: c_int,
        mut value: T,
    ) -> Result<T, c_int> {
        let status = call!(@one self, function(kind, &raw mut value));
        (status == OK).then_some(value).ok_or(status)
    }

    /// Directional derivative, with as many results as there are unknowns.
    pub(crate) fn directional(
        self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        let (rows, columns, seeds) = (unknowns.len(), knowns.len(), seed.len());
        assert!(self.version == Fmi3 || columns == seeds);
        let (unknowns, knowns, seed) = (unknowns.as_ptr(), knowns.as_ptr(), seed.as_ptr());
        written(rows, |change| {
            call!(
                self,
                fmi2GetDirectionalDerivative(unknowns, rows, knowns, columns, seed, change),
                fmi3GetDirectionalDerivative(
                    unknowns, rows, knowns, columns, seed, seeds, change, rows
                )
            )
        })
    }

    /// FMI 3.0: adjoint derivative, with as many results as there are knowns.
    pub(crate) fn adjoint(
        self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, c_int> {
        let (rows, columns, seeds) = (unknowns.len(), knowns.len(), seed.len());
        let (unknowns, knowns, seed) = (unknowns.as_ptr(), knowns.as_ptr(), seed.as_ptr());
        written(columns, |sums| {
            call!(@one self, fmi3GetAdjointDerivative(
                unknowns, rows, knowns, columns, seed, seeds, sums, columns
            ))
        })
    }

    /// FMI 2.0: derivatives of inputs with respect to time.
    pub(crate) fn set_input_derivatives(
        self,
        references: &[u32],
        orders: &[c_int],
        values: &[f64],
    ) -> c_int {
        let count = references.len();
        let references = references.as_ptr();
        call!(@one self, fmi2SetRealInputDerivatives(references, count, orders.as_ptr(), values.as_ptr()))
    }

    /// First derivatives of outputs with respect to time.
    pub(crate) fn output_derivatives(self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        self.derivatives_of_order(references, &vec![1; references.len()])
    }

    /// Derivatives of outputs with respect to time.
    pub(crate) fn derivatives_of_order(
        self,
        references: &[u32],
        orders: &[c_int],
    ) -> Result<Vec<f64>, c_int> {
        let (count, orders) = (references.len(), orders.as_ptr());
        let references = references.as_ptr();
        written(count, |values| {
            call!(
                self,
                fmi2GetRealOutputDerivatives(references, count, orders, values),
                fmi3GetOutputDerivatives(references, count, orders, values, count)
            )
        })
    }

    /// Updates discrete states: there are none, so nothing may be said to have changed.
    pub(crate) fn update(self) -> c_int {
        let (mut flags, mut time) = ([7_u8; 5], f64::NAN);
        let mut info = EventInfo {
            new_discrete_states_needed: 7,
            terminate_simulation: 7,
            nominals_of_continuous_states_changed: 7,
            values_of_continuous_states_changed: 7,
            next_event_time_defined: 7,
            next_event_time: f64::NAN,
        };
        let [a, b, c, d, e] = flags.each_mut().map(ptr::from_mut);
        let status = call!(
            self,
            fmi2NewDiscreteStates(&raw mut info),
            fmi3UpdateDiscreteStates(a, b, c, d, e, &raw mut time)
        );
        if status == OK {
            match self.version {
                Fmi2 => assert_eq!(info, EventInfo::default()),
                Fmi3 => assert_eq!((flags, time), ([0; 5], 0.0)),
            }
        }
        status
    }

    /// FMI 3.0: from an event on to communication steps.
    pub(crate) fn enter_step(self) -> c_int {
        call!(@one self, fmi3EnterStepMode())
    }

    pub(crate) fn complete_step(self) -> c_int {
        let (mut event2, mut end2, mut event3, mut end3) = (7, 7, 7, 7);
        let status = call!(
            self,
            fmi2CompletedIntegratorStep(1, &raw mut event2, &raw mut end2),
            fmi3CompletedIntegratorStep(1, &raw mut event3, &raw mut end3)
        );
        let flags = match self.version {
            Fmi2 => (event2, end2),
            Fmi3 => (event3.into(), end3.into()),
        };
        assert!(status != OK || flags == (0, 0));
        status
    }

    pub(crate) fn set_states(self, states: &[f64]) -> c_int {
        let (states, count) = (states.as_ptr(), states.len());
        call!(
            self,
            fmi2SetContinuousStates | fmi3SetContinuousStates(states, count)
        )
    }

    pub(crate) fn states(self, count: usize) -> Vec<f64> {
        self.try_states(count).unwrap()
    }

    pub(crate) fn derivatives(self, count: usize) -> Vec<f64> {
        self.try_derivatives(count).unwrap()
    }

    /// Saves the state in a new one, or in the one that the variable holds.
    pub(crate) fn save_in(self, state: &mut *mut c_void) -> c_int {
        call!(self, fmi2GetFMUstate | fmi3GetFMUState(state))
    }

    pub(crate) fn save(self) -> *mut c_void {
        let mut state = ptr::null_mut();
        assert_eq!(self.save_in(&mut state), OK);
        assert!(!state.is_null());
        state
    }

    pub(crate) fn free_state(self, mut state: *mut c_void) {
        let status = call!(self, fmi2FreeFMUstate | fmi3FreeFMUState(&raw mut state));
        assert_eq!((status, state), (OK, ptr::null_mut()));
    }

    /// Number of bytes of a serialised state.
    pub(crate) fn serialized_size(self, state: *mut c_void) -> usize {
        let mut size = 0;
        let status = call!(
            self,
            fmi2SerializedFMUstateSize | fmi3SerializedFMUStateSize(state, &raw mut size)
        );
        assert_eq!(status, OK);
        size
    }

    pub(crate) fn serialize(self, state: *mut c_void) -> Vec<u8> {
        let size = self.serialized_size(state);
        let mut bytes = vec![0xaa; size];
        let start = bytes.as_mut_ptr();
        let status = call!(
            self,
            fmi2SerializeFMUstate | fmi3SerializeFMUState(state, start, size)
        );
        assert_eq!(status, OK);
        bytes
    }

    /// Makes a state of bytes: a new one, or in place of the one that the variable holds.
    pub(crate) fn deserialize_in(self, bytes: &[u8], state: &mut *mut c_void) -> c_int {
        let (bytes, size) = (bytes.as_ptr(), bytes.len());
        call!(
            self,
            fmi2DeSerializeFMUstate | fmi3DeserializeFMUState(bytes, size, state)
        )
    }

    pub(crate) fn deserialize(self, bytes: &[u8]) -> Result<*mut c_void, c_int> {
        let mut state = ptr::null_mut();
        let status = self.deserialize_in(bytes, &mut state);
        assert_eq!(state.is_null(), status != OK);
        (status == OK).then_some(state).ok_or(status)
    }

    /// All that the instance remembers: mode, stop time, values.
    pub(crate) fn state_bytes(self) -> Vec<u8> {
        let state = self.save();
        let bytes = self.serialize(state);
        self.free_state(state);
        bytes
    }
}

/// Makes the checksum of a serialised state right: the last eight bytes are the FNV-1a hash of all before.
pub(crate) fn seal(bytes: &mut [u8]) {
    let (content, checksum) = bytes.split_last_chunk_mut().unwrap();
    let hash = content
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    *checksum = hash.to_le_bytes();
}

/// Numbers that a function writes.
fn written(count: usize, write: impl FnOnce(*mut f64) -> c_int) -> Result<Vec<f64>, c_int> {
    let mut numbers = vec![f64::NAN; count];
    let status = write(numbers.as_mut_ptr());
    (status == OK).then_some(numbers).ok_or(status)
}
