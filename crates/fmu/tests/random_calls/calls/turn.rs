//! One turn: an instance, the saved states, and the arguments of the call that is made.

use std::{
    ffi::{CStr, c_char, c_int, c_void},
    ptr,
};

use bolted_joint_importer::header::{DISCARD, OK, WARNING};

use super::{
    arrays::Arguments,
    host::{Host, MODELS, Model},
};
pub(crate) use crate::raw::Interface;
use crate::raw::{FmiVersion, Raw};

/// State of the state machine, in the words of FMI 3.0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode {
    Instantiated,
    /// FMI 2.0: instantiated, and the time span is known.
    SetUp,
    Initialization,
    /// Co-Simulation, between steps.
    Step,
    /// Co-Simulation, at an event.
    StepEvent,
    /// Model Exchange, at an event.
    Event,
    /// Model Exchange, between events.
    ContinuousTime,
    Terminated,
}

/// What is known of when a function is allowed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rule {
    /// Nothing is claimed here.
    Free,
    /// Refused in any other mode.
    Only(&'static [Mode]),
    /// Refused in any other mode, and a call with right arguments succeeds.
    Exactly(&'static [Mode]),
    /// A call with right arguments succeeds in any mode.
    Always,
}

/// A function of the ABI.
pub(crate) struct Function {
    pub(crate) name: &'static str,
    pub(crate) rule: Rule,
    /// Draws the arguments, makes the call, and follows what it does to the mode.
    pub(crate) call: fn(&mut Turn<'_, '_>) -> Outcome,
}

/// A table of functions.
macro_rules! table {
    ($($name:literal $rule:expr => $call:expr;)*) => {
        [$(Function { name: $name, rule: $rule, call: $call }),*]
    };
}
pub(crate) use table;

/// Calls a function that returns a text.
pub(crate) fn text_of(
    function: unsafe extern "C" fn() -> *const c_char,
    expected: &CStr,
) -> Outcome {
    // SAFETY: returns a terminated string
    assert_eq!(unsafe { CStr::from_ptr(function()) }, expected);
    Outcome::NONE
}

/// What came out of a call.
pub(crate) struct Outcome {
    /// The status; `None` if the function returns none.
    pub(crate) status: Option<c_int>,
    /// Numbers that the library has written: finite after success.
    pub(crate) values: Vec<f64>,
}

impl Outcome {
    /// Outcome of a function that returns its results in another way.
    pub(crate) const NONE: Self = Self {
        status: None,
        values: Vec::new(),
    };

    /// Outcome of a function that writes numbers.
    pub(crate) fn with(status: c_int, values: &[f64]) -> Self {
        Self {
            status: Some(status),
            values: values.to_vec(),
        }
    }
}

impl From<c_int> for Outcome {
    fn from(status: c_int) -> Self {
        Self {
            status: Some(status),
            values: Vec::new(),
        }
    }
}

/// A log category of the model descriptions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Category {
    Events,
    Warnings,
    Errors,
}

impl Category {
    const ALL: [Self; 3] = [Self::Events, Self::Warnings, Self::Errors];

    pub(crate) fn name(self) -> &'static CStr {
        match self {
            Self::Events => c"logEvents",
            Self::Warnings => c"logStatusWarning",
            Self::Errors => c"logStatusError",
        }
    }
}

/// Which messages an importer gets: those that it has not switched off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Told {
    pub(crate) events: bool,
    pub(crate) warnings: bool,
    pub(crate) errors: bool,
    /// In the category of errors, but only once that was asked for.
    pub(crate) discards: bool,
}

impl Told {
    /// What is told after an instantiation with this `loggingOn`: errors in any case.
    pub(crate) fn from_the_start(logging_on: bool) -> Self {
        Self {
            events: logging_on,
            warnings: logging_on,
            errors: true,
            discards: logging_on,
        }
    }

    /// Whether a message with this status may come.
    pub(crate) fn allows(self, status: c_int) -> bool {
        match status {
            OK => self.events,
            WARNING => self.warnings,
            DISCARD => self.discards,
            _ => self.errors,
        }
    }
}

/// An instance, and what its importer knows of it.
pub(crate) struct Subject {
    pub(crate) raw: Raw,
    pub(crate) interface: Interface,
    /// Index into [`MODELS`].
    pub(crate) model: usize,
    pub(crate) host: Box<Host>,
    /// Whether the instance has a log callback.
    pub(crate) logs: bool,
    /// What the callback is called for.
    pub(crate) told: Told,
    /// Whether Co-Simulation was instantiated with Event Mode.
    pub(crate) event_mode: bool,
    /// `None` after a call that may have ended the simulation.
    pub(crate) mode: Option<Mode>,
    pub(crate) time_s: f64,
}

impl Subject {
    /// A new instance whose importer knows nothing unusual of it.
    pub(crate) fn new(raw: Raw, interface: Interface, model: usize, host: Box<Host>) -> Self {
        Self {
            raw,
            interface,
            model,
            host,
            logs: true,
            told: Told::from_the_start(true),
            event_mode: false,
            mode: Some(Mode::Instantiated),
            time_s: 0.0,
        }
    }

    /// What is simulated.
    pub(crate) fn model(&self) -> Model {
        MODELS[self.model]
    }

    /// Follows a call that switches these log categories, or all if there are none.
    pub(crate) fn switch_logging(&mut self, categories: &[Category], on: bool) {
        let all = categories.is_empty();
        for category in Category::ALL {
            if all || categories.contains(&category) {
                match category {
                    Category::Events => self.told.events = on,
                    Category::Warnings => self.told.warnings = on,
                    Category::Errors => (self.told.errors, self.told.discards) = (on, on),
                }
            }
        }
    }
}

/// A saved state, and where it comes from.
#[derive(Clone, Copy)]
pub(crate) struct Saved {
    pub(crate) handle: *mut c_void,
    pub(crate) version: FmiVersion,
    pub(crate) interface: Interface,
    pub(crate) model: usize,
    pub(crate) event_mode: bool,
    pub(crate) mode: Option<Mode>,
    pub(crate) time_s: f64,
}

/// Memory that is neither an instance nor a state, though readable.
static FOREIGN: [u64; 64] = [0x1234_5678_9abc_def0; 64];

/// Everything that a call may use.
pub(crate) struct Turn<'t, 'b> {
    pub(crate) subject: &'t mut Subject,
    pub(crate) saved: &'t mut Vec<Saved>,
    pub(crate) a: Arguments<'t, 'b>,
    /// Whether the call was made on the instance, and not on null or on something else.
    pub(crate) reached: bool,
}

impl Turn<'_, '_> {
    /// The instance; of a wild call sometimes null or something else.
    pub(crate) fn instance(&mut self) -> Raw {
        let mut raw = self.subject.raw;
        if self.a.wrong(24) {
            self.reached = false;
            raw.handle = self.not_a_handle();
        }
        raw
    }

    /// Log categories: any, in any order, also twice.
    pub(crate) fn categories(&mut self) -> Vec<Category> {
        let count = self.a.choices.below(4);
        (0..count)
            .map(|_| self.a.choices.pick(&Category::ALL))
            .collect()
    }

    fn not_a_handle(&mut self) -> *mut c_void {
        match self.a.choices.below(4) {
            0 => ptr::null_mut(),
            1 => FOREIGN.as_ptr().cast_mut().cast(),
            2 => FOREIGN.as_ptr().wrapping_byte_add(1).cast_mut().cast(),
            _ => match self.saved.first() {
                // a state is no instance
                Some(state) => state.handle,
                None => ptr::null_mut(),
            },
        }
    }

    /// A saved state of this FMU, or something that must be refused.
    pub(crate) fn state(&mut self) -> *mut c_void {
        let fitting: Vec<Saved> = self.fitting().collect();
        if fitting.is_empty() || self.a.wrong(6) {
            self.a.right = false;
            return match self.a.choices.below(4) {
                0 => ptr::null_mut(),
                1 => FOREIGN.as_ptr().cast_mut().cast(),
                2 => self.subject.raw.handle,
                // possibly of another FMU
                _ => self
                    .saved
                    .last()
                    .map_or(ptr::null_mut(), |state| state.handle),
            };
        }
        self.a.choices.pick(&fitting).handle
    }

    /// States that came from the same FMU, version and interface type.
    fn fitting(&self) -> impl Iterator<Item = Saved> {
        let (version, interface, model) = (
            self.subject.raw.version,
            self.subject.interface,
            self.subject.model,
        );
        let event_mode = self.subject.event_mode;
        self.saved.iter().copied().filter(move |state| {
            (state.version, state.interface, state.model) == (version, interface, model)
                && state.event_mode == event_mode
        })
    }

    /// Notes a state that the library has made; `mode` is that in which it was saved.
    pub(crate) fn keep(&mut self, handle: *mut c_void, mode: Option<Mode>, time_s: f64) {
        self.saved.push(Saved {
            handle,
            version: self.subject.raw.version,
            interface: self.subject.interface,
            model: self.subject.model,
            event_mode: self.subject.event_mode,
            mode,
            time_s,
        });
    }

    /// Value references: mostly from `pool`, of a wild call also unknown ones.
    pub(crate) fn references(&mut self, pool: &[u32]) -> Vec<u32> {
        let count = if self.a.unusual(16) {
            200
        } else {
            self.a.choices.below(5)
        };
        let count = if pool.is_empty() { 0 } else { count };
        (0..count)
            .map(|_| {
                if self.a.wrong(12) {
                    match self.a.choices.below(4) {
                        0 => u32::MAX,
                        1 => self.a.choices.bits() as u32,
                        _ => self.a.choices.below(64) as u32,
                    }
                } else {
                    self.a.choices.pick(pool)
                }
            })
            .collect()
    }

    /// A communication step size or a time ahead, in seconds.
    pub(crate) fn step_size(&mut self) -> f64 {
        if self.a.wrong(3) {
            // so would these as a communication step
            let any = match self.a.choices.any_number() {
                long if (0.1..1e6).contains(&long.abs()) && long != 1.0 => 1e10,
                any => any,
            };
            // 1e10 s are more internal steps than are taken even at a length of 1 s, which any number may be
            self.a.choices.pick(&[0.0, -1e-4, 1e10, 1e-300, any])
        } else {
            self.a.choices.pick(&[1e-4, 3e-5, 2e-5, 1e-3])
        }
    }
}
