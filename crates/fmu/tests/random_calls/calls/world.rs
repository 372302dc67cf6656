//! A few instances and saved states, and what must hold after each call on them.
//!
//! * A call that the mode of the instance does not allow is refused; some calls with right arguments succeed.
//! * A refused call logs exactly one reason, which begins with the function's name; a successful one logs none. No
//!   message comes of a kind that was switched off.
//! * A refused call leaves the instance as it was, its mode included; only a simulation that has failed ends.
//! * No number that a successful call hands over is NaN or infinite.
//! * Everything that was made can be freed.

use std::collections::BTreeMap;

use bolted_joint_importer::header::{DISCARD, ERROR, OK, PENDING, WARNING};

use super::{
    arrays::Arguments,
    choices::Choices,
    fmi2, fmi3,
    forged::{forge, go_on_from},
    lives,
    turn::{Function, Mode, Outcome, Rule, Saved, Subject, Told, Turn},
};
use crate::raw::{Fmi2, Fmi3};

/// Most instances at a time.
const INSTANCES: usize = 4;
/// Most saved states at a time.
const STATES: usize = 12;

/// How often each function was called, and how it answered.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    /// By function: successes, warnings, refusals.
    pub(crate) by_function: BTreeMap<&'static str, [u64; 3]>,
    /// Simulations that failed.
    pub(crate) failures: u64,
    /// States that the library never wrote and yet accepted.
    pub(crate) forged: u64,
    /// Intermediate updates.
    pub(crate) updates: u64,
    /// Refusals after errors were switched off.
    pub(crate) silent: u64,
    /// Depends on every status and every bit of every result, in their order.
    pub(crate) digest: u64,
}

impl Tally {
    /// Number of calls.
    pub(crate) fn calls(&self) -> u64 {
        self.by_function.values().flatten().sum()
    }

    /// Adds what another world has seen.
    pub(crate) fn add(&mut self, other: &Self) {
        for (name, counts) in &other.by_function {
            let sum = self.by_function.entry(name).or_default();
            for (sum, count) in sum.iter_mut().zip(counts) {
                *sum += count;
            }
        }
        self.failures += other.failures;
        self.forged += other.forged;
        self.updates += other.updates;
        self.silent += other.silent;
        self.mix(other.digest);
    }

    fn mix(&mut self, bits: u64) {
        // FNV-1a over 64-bit words
        self.digest = (self.digest ^ bits).wrapping_mul(0x0000_0100_0000_01b3);
    }

    fn note(&mut self, function: &'static str, outcome: &Outcome) {
        let kind = match outcome.status {
            None | Some(OK) => 0,
            Some(WARNING) => 1,
            Some(_) => 2,
        };
        self.by_function.entry(function).or_default()[kind] += 1;
        self.mix(kind as u64);
        for value in &outcome.values {
            self.mix(value.to_bits());
        }
    }
}

/// Instances and saved states.
#[derive(Default)]
pub(crate) struct World {
    subjects: Vec<Subject>,
    saved: Vec<Saved>,
    tally: Tally,
    trace: bool,
}

impl World {
    /// An empty world; prints each call if `trace`, to find what a crash came from.
    pub(crate) fn new(trace: bool) -> Self {
        Self {
            trace,
            ..Self::default()
        }
    }

    /// Makes calls as long as there is something to decide from, and frees everything.
    pub(crate) fn exhaust(mut self, mut choices: Choices<'_>) -> Tally {
        while !choices.ended() {
            self.turn(&mut choices);
        }
        self.finish()
    }

    /// Makes one call, with some calls around it that observe.
    pub(crate) fn turn(&mut self, choices: &mut Choices<'_>) {
        if self.subjects.is_empty()
            || (self.subjects.len() < INSTANCES && choices.one_in(16))
            || choices.one_in(256)
        {
            self.instantiate(choices);
            return;
        }
        let index = choices.below(self.subjects.len());
        if choices.one_in(200) {
            self.free_instance(index);
            return;
        }
        if choices.one_in(64) {
            self.forge(index, choices);
            return;
        }
        if self.saved.len() == STATES {
            self.free_state(0);
        }
        let function = draw_function(&self.subjects[index], choices);
        let observe = choices.one_in(4) || may_end(function.name);
        let subject = &mut self.subjects[index];
        if self.trace {
            eprintln!("{index}: {} in {:?}", function.name, subject.mode);
        }
        let before = observe.then(|| subject.raw.state_bytes());
        let mode = subject.mode;
        subject.host.messages.clear();
        let (outcome, right, is_the_instance) = {
            let mut turn = Turn {
                subject,
                saved: &mut self.saved,
                a: Arguments::new(choices),
                reached: true,
            };
            let outcome = (function.call)(&mut turn);
            let reached = turn.reached;
            (outcome, turn.a.right, reached)
        };
        self.tally.note(function.name, &outcome);
        if self.trace {
            eprintln!("    {:?} {:?}", outcome.status, subject.host.messages);
        }
        judge(function, subject, mode, &outcome, right, is_the_instance);
        self.tally.silent += u64::from(is_refused(&outcome) && !subject.told.errors);
        if let Some(before) = before
            && is_refused(&outcome)
            && subject.raw.state_bytes() != before
        {
            assert!(
                may_end(function.name),
                "{}: refused, but the instance has changed",
                function.name
            );
            self.tally.failures += 1;
            subject.mode = Some(Mode::Terminated);
        }
        let observed_values = observed_values(subject);
        for value in &observed_values {
            self.tally.mix(value.to_bits());
        }
    }

    /// Frees everything.
    pub(crate) fn finish(mut self) -> Tally {
        while !self.subjects.is_empty() {
            self.free_instance(0);
        }
        assert!(self.saved.is_empty());
        self.tally
    }

    fn instantiate(&mut self, choices: &mut Choices<'_>) {
        if self.subjects.len() == INSTANCES {
            self.free_instance(0);
        }
        let version = if choices.one_in(2) { Fmi2 } else { Fmi3 };
        let (name, subject) = lives::instantiate(version, choices);
        let made = Outcome::from(if subject.is_some() { OK } else { ERROR });
        if self.trace {
            eprintln!("{name}: {:?}", made.status);
        }
        self.tally.note(name, &made);
        self.subjects.extend(subject);
    }

    fn forge(&mut self, index: usize, choices: &mut Choices<'_>) {
        let subject = &mut self.subjects[index];
        let mut bytes = subject.raw.state_bytes();
        forge(&mut bytes, choices);
        let values = go_on_from(subject, &bytes);
        if self.trace {
            eprintln!("{index}: forged state: {values:?}");
        }
        self.tally.forged += u64::from(!values.is_empty());
        for value in values {
            self.tally.mix(value.to_bits());
        }
    }

    fn free_instance(&mut self, index: usize) {
        let subject = self.subjects.remove(index);
        // states may outlive the instance that made them: another one of the same version frees them
        let raw = subject.raw;
        let heirs = |version| {
            self.subjects
                .iter()
                .any(|other| other.raw.version == version)
        };
        if !heirs(raw.version) {
            let (orphans, kept) = std::mem::take(&mut self.saved)
                .into_iter()
                .partition(|state| state.version == raw.version);
            self.saved = kept;
            for state in orphans as Vec<Saved> {
                raw.free_state(state.handle);
            }
        }
        raw.free();
        let name = match raw.version {
            Fmi2 => "fmi2FreeInstance",
            Fmi3 => "fmi3FreeInstance",
        };
        self.tally.note(name, &Outcome::NONE);
        self.tally.updates += subject.host.updates;
        assert_eq!(subject.host.faults, [""; 0]);
    }

    fn free_state(&mut self, index: usize) {
        let state = self.saved.remove(index);
        let by = self
            .subjects
            .iter()
            .find(|subject| subject.raw.version == state.version)
            .expect("states go with the last instance of their version");
        by.raw.free_state(state.handle);
    }
}

/// What would make sense next, or any function at all.
fn draw_function(subject: &Subject, choices: &mut Choices<'_>) -> &'static Function {
    let (functions, sensible): (&'static [Function], &[&str]) = match subject.raw.version {
        Fmi2 => (&fmi2::FUNCTIONS, fmi2::sensible(subject.mode)),
        Fmi3 => (&fmi3::FUNCTIONS, fmi3::sensible(subject.mode)),
    };
    if choices.one_in(3) {
        return &functions[choices.below(functions.len())];
    }
    let name = choices.pick(sensible);
    functions
        .iter()
        .find(|function| function.name == name)
        .expect("sensible functions are in the table")
}

/// Whether a refusal may mean that the simulation has failed and ended.
fn may_end(function: &str) -> bool {
    function.ends_with("DoStep") || function.ends_with("CompletedIntegratorStep")
}

fn is_refused(outcome: &Outcome) -> bool {
    !matches!(outcome.status, None | Some(OK | WARNING))
}

fn judge(
    function: &Function,
    subject: &mut Subject,
    mode: Option<Mode>,
    outcome: &Outcome,
    right: bool,
    is_the_instance: bool,
) {
    let name = function.name;
    assert_eq!(subject.host.faults, [""; 0], "{name}");
    let Some(status) = outcome.status else {
        return;
    };
    assert!((OK..PENDING).contains(&status), "{name}: status {status}");
    let refused = is_refused(outcome);
    if !refused {
        assert!(
            outcome.values.iter().all(|value| value.is_finite()),
            "{name}: {:?}",
            outcome.values
        );
    }
    let messages = &subject.host.messages;
    let reasons: Vec<&String> = messages
        .iter()
        .filter(|(status, _)| *status >= DISCARD)
        .map(|(_, text)| text)
        .collect();
    if subject.logs && is_the_instance {
        // an instantiation asks for itself what is told
        let told = if name.contains("Instantiate") {
            Told::from_the_start(true)
        } else {
            subject.told
        };
        assert!(
            messages.iter().all(|(status, _)| told.allows(*status)),
            "{name}: {messages:?}, though {told:?}"
        );
        let expected = usize::from(refused && told.allows(status));
        assert_eq!(reasons.len(), expected, "{name}: {messages:?}");
        assert!(
            reasons.iter().all(|text| text.starts_with(name)),
            "{name}: {messages:?}"
        );
    } else {
        assert_eq!(messages, &[], "{name}");
    }
    let Some(mode) = mode else {
        return;
    };
    let (allowed, succeeds) = match function.rule {
        Rule::Free => (true, false),
        Rule::Only(modes) => (modes.contains(&mode), false),
        Rule::Exactly(modes) => (modes.contains(&mode), modes.contains(&mode)),
        Rule::Always => (true, true),
    };
    assert!(
        allowed || refused,
        "{name} is accepted in {mode:?}, with status {status}"
    );
    assert!(
        !(succeeds && right && refused),
        "{name} with right arguments is refused in {mode:?}: {messages:?}"
    );
}

/// Time and states: readable in every mode, and never anything but finite.
fn observed_values(subject: &Subject) -> Vec<f64> {
    let values = lives::values(subject);
    assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
    values
}
