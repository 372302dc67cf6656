//! An instance with its log, from its making to where a test wants it.

use std::{ffi::c_int, mem, ops::Deref};

use super::callbacks::Environment;
use super::{Folder, Kind, Message, Request, Update, start_text};
use crate::{
    c,
    raw::{Fmi2, Fmi3, FmiVersion, Interface, Raw},
};

/// An instance with its log.
pub(crate) struct Instance {
    pub(crate) raw: Raw,
    pub(super) environment: *mut Environment,
}

// SAFETY: FMI instances may be moved between threads
unsafe impl Send for Instance {}

impl Deref for Instance {
    type Target = Raw;

    fn deref(&self) -> &Raw {
        &self.raw
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        self.raw.free();
        // SAFETY: made together, freed together
        drop(unsafe { Box::from_raw(self.environment) });
    }
}

/// States of the state machines (FMI 2.0, 3.2.3 and 4.2.4; FMI 3.0, 2.3, 3.2.1 and 4.2.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    Instantiated,
    /// FMI 2.0: the time span is known.
    SetUp,
    Initialization,
    /// An event: in Model Exchange, and in Co-Simulation of FMI 3.0 if the importer handles events.
    Event,
    /// Co-Simulation: between steps.
    Step,
    /// Model Exchange: between events.
    Continuous,
    Terminated,
}

impl State {
    pub(crate) const ALL: &[Self] = &[
        Self::Instantiated,
        Self::SetUp,
        Self::Initialization,
        Self::Event,
        Self::Step,
        Self::Continuous,
        Self::Terminated,
    ];

    /// Whether instances of this version and interface type can be in it.
    pub(crate) fn is_of(self, version: FmiVersion, interface: Interface) -> bool {
        match self {
            Self::SetUp => version == Fmi2,
            Self::Event | Self::Continuous => interface == Interface::ModelExchange,
            Self::Step => interface == Interface::CoSimulation,
            Self::Instantiated | Self::Initialization | Self::Terminated => true,
        }
    }

    /// Name in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "Instantiated",
            Self::SetUp => "Instantiated after fmi2SetupExperiment",
            Self::Initialization => "Initialization Mode",
            Self::Event => "Event Mode",
            Self::Step => "Step Mode",
            Self::Continuous => "Continuous-Time Mode",
            Self::Terminated => "Terminated",
        }
    }
}

/// Makes instances of a version.
pub(crate) trait Make: Sized {
    fn version(self) -> FmiVersion;

    /// Instance in state Instantiated.
    fn instance(
        self,
        interface: Interface,
        kind: Kind,
        dofs: u8,
        changes: &[(&str, f64)],
    ) -> Instance {
        let folder = Folder::with_start(&start_text(kind, dofs, changes));
        let request = Request {
            version: self.version(),
            interface,
            resources: folder.0.to_str(),
            ..Request::default()
        };
        request.instantiate().unwrap()
    }

    /// Instance in Step Mode at t = 0.
    fn stepping(self, kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Instance {
        let mut instance = self.instance(Interface::CoSimulation, kind, dofs, changes);
        instance.go_to(State::Step);
        instance
    }

    /// Instance in Continuous-Time Mode at t = 0.
    fn continuous(self, kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Instance {
        let mut instance = self.instance(Interface::ModelExchange, kind, dofs, changes);
        instance.go_to(State::Continuous);
        instance
    }
}

impl Make for FmiVersion {
    fn version(self) -> FmiVersion {
        self
    }
}

/// Instances of FMI 3.0.
impl Instance {
    /// Instance for Co-Simulation in state Instantiated.
    pub(crate) fn new(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        Fmi3.instance(Interface::CoSimulation, kind, dofs, changes)
    }

    /// Instance in Step Mode at t = 0.
    pub(crate) fn stepping(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        Fmi3.stepping(kind, dofs, changes)
    }
}

impl Instance {
    /// Goes through initialisation, in which nothing is to be said.
    #[track_caller]
    pub(crate) fn initialize(&self, start_s: f64, stop_s: Option<f64>) {
        c::ok(self.enter_initialization(start_s, stop_s));
        c::ok(self.exit_initialization());
    }

    /// From Instantiated to another state, at t = 0.
    pub(crate) fn go_to(&mut self, state: State) {
        use State::{Continuous, Event, Instantiated, SetUp, Step, Terminated};
        match state {
            Instantiated => {}
            SetUp => c::ok(self.set_up(0.0, None)),
            _ => c::ok(self.enter_initialization(0.0, None)),
        }
        if matches!(state, Event | Step | Continuous | Terminated) {
            c::ok(self.exit_initialization());
        }
        if state == Continuous {
            c::ok(self.update());
            c::ok(self.enter_continuous());
        }
        if state == Terminated {
            c::ok(self.terminate());
        }
        self.take_log();
    }

    /// All messages since the last call.
    pub(crate) fn take_log(&mut self) -> Vec<Message> {
        // SAFETY: the library writes to the log only during a call
        mem::take(unsafe { &mut (*self.environment).log })
    }

    /// The one error message since the last call; events and warnings are ignored.
    pub(crate) fn error(&mut self) -> String {
        self.message_among(c::ERROR, c::ERROR)
    }

    /// Text of the one message with this status since the last call; events alone are ignored.
    pub(crate) fn message(&mut self, status: c_int) -> String {
        self.message_among(c::WARNING, status)
    }

    fn message_among(&mut self, least: c_int, status: c_int) -> String {
        let log = self.take_log();
        let messages: Vec<_> = log.iter().filter(|m| m.status >= least).collect();
        let [message] = messages.as_slice() else {
            panic!("expected one message, found {log:?}");
        };
        assert_eq!(message.status, status);
        assert_eq!(message.category, "logStatusError");
        let name = (self.version == Fmi2).then_some("joint");
        assert_eq!(message.instance_name.as_deref(), name);
        message.text.clone()
    }

    /// The message of a call that is refused, and that must leave the instance as it was, mode included.
    pub(crate) fn refused(&mut self, call: impl FnOnce(Raw) -> c_int) -> String {
        let before = self.state_bytes();
        assert_eq!(call(self.raw), c::ERROR);
        assert!(
            self.state_bytes() == before,
            "the call changed the instance"
        );
        self.message(c::ERROR)
    }

    /// The call is refused in the words that are expected of it.
    #[track_caller]
    pub(crate) fn refuses(&mut self, call: impl FnOnce(Raw) -> c_int, expected: impl AsRef<str>) {
        let (message, expected) = (self.refused(call), expected.as_ref());
        assert!(message.contains(expected), "{message}, not {expected}");
    }

    /// Each call is refused in the words that are expected of it.
    #[track_caller]
    pub(crate) fn refused_all(&mut self, calls: &[(&str, &dyn Fn(Raw) -> c_int)]) {
        for (expected, call) in calls {
            self.refuses(call, expected);
        }
    }

    /// What to do in the callback within a communication step.
    pub(crate) fn on_update(
        &mut self,
        script: impl FnMut(&mut Instance, Update) -> Option<f64> + 'static,
    ) {
        // SAFETY: the library uses the environment only during a call
        unsafe { (*self.environment).script = Some(Box::new(script)) };
    }
}
