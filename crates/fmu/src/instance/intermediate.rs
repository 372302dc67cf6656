//! Communication steps in which the importer takes part: it reads outputs after each internal step, sets inputs within
//! it, and may end the communication step early (FMI 3.0, 4.2.1.2).
//!
//! The caller takes turns between [`Instance::proceed`] and the importer's callback, so that no reference to the
//! instance is alive while the callback has the word.

use super::Instance;
use crate::{
    input_course::InputCourse,
    interface::{InterfaceType, Values, reference::TIME},
    mode::Mode,
    models::Step,
    refusal::{Active, NotIntermediate, Reached, Refusal, Warning},
};

/// What the importer may do with variables within a communication step.
#[derive(Clone, Debug)]
pub(super) struct Access {
    /// Variables that the importer has said it would use, by value reference; empty where it has said none.
    required: Vec<bool>,
    /// The importer may read now.
    get: bool,
    /// The importer may set inputs now.
    set: bool,
}

impl Access {
    /// Nothing required, nothing allowed.
    pub(super) const NONE: Self = Self {
        required: Vec::new(),
        get: false,
        set: false,
    };

    fn requires(&self, index: usize) -> bool {
        self.required.get(index) == Some(&true)
    }
}

/// What the importer's callback is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Update {
    /// Time that the call is for, s.
    pub(crate) time_s: f64,
    /// Whether inputs may be set.
    pub(crate) set_requested: bool,
    /// Whether variables may be read.
    pub(crate) get_allowed: bool,
    /// Whether an internal step has been completed.
    pub(crate) step_finished: bool,
}

/// A communication step under way.
#[derive(Clone, Debug)]
pub(crate) struct IntermediateStep {
    start_s: f64,
    end_s: f64,
    /// Where to stop: the end, or earlier if the importer has asked for that.
    target_s: f64,
    early_return_allowed: bool,
    /// Length of the communication step and of a full internal step, s; how many of these have been taken.
    interval_s: f64,
    length_s: f64,
    taken: u32,
    count: u32,
    is_steady: bool,
    active: Option<Active>,
    reached: Option<Reached>,
    turn: Turn,
    /// Length for which inputs were asked, s, and values at its beginning and its middle.
    asked_s: f64,
    present: Values,
    middle: Values,
    /// To go back to if the step fails.
    values_before: Values,
    inputs_before: InputCourse,
}

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    /// To ask for the inputs at the middle of the internal step.
    AskMiddle,
    /// To ask for the inputs at its end.
    AskEnd,
    /// To take it.
    Take,
}

impl Instance {
    /// The importer will use these variables within communication steps.
    pub(crate) fn require_intermediate(&mut self, references: &[u32]) -> Result<(), Refusal> {
        for &reference in references {
            let (index, _) = self.known(reference)?;
            self.check_offered(index)?;
            let required = &mut self.access.required;
            required.resize(self.roles.len(), false);
            if let Some(required) = required.get_mut(index) {
                *required = true;
            }
        }
        Ok(())
    }

    /// Begins a communication step in which the importer takes part.
    pub(crate) fn begin_step(
        &mut self,
        current_s: f64,
        interval_s: f64,
        early_return_allowed: bool,
    ) -> Result<IntermediateStep, Refusal> {
        let end_s = self.end_of_step(current_s, interval_s)?;
        let active = if self.parameters_changed {
            self.prepare_model()?
        } else {
            None
        };
        let count = self.model.internal_steps(interval_s)?;
        Ok(IntermediateStep {
            start_s: current_s,
            end_s,
            target_s: end_s,
            early_return_allowed,
            interval_s,
            length_s: interval_s / f64::from(count.get()),
            taken: 0,
            count: count.get(),
            is_steady: self.pace.followed_by(interval_s).is_steady(),
            active,
            reached: None,
            turn: self.first_turn(),
            asked_s: 0.0,
            present: self.values.clone(),
            middle: self.values.clone(),
            values_before: self.values.clone(),
            inputs_before: self.inputs.clone(),
        })
    }

    /// Goes on to the next call of the importer's callback; `None` at the end of the communication step.
    ///
    /// After a refusal the instance is as it was at the beginning of the step.
    pub(crate) fn proceed(
        &mut self,
        step: &mut IntermediateStep,
    ) -> Result<Option<Update>, Refusal> {
        let update = self.next_update(step);
        match &update {
            Ok(Some(update)) => {
                self.access.get = update.get_allowed;
                self.access.set = update.set_requested;
                self.mode = Mode::IntermediateUpdate;
            }
            Ok(None) => {}
            Err(_) => self.abandon(step),
        }
        update
    }

    /// The callback has returned, with the time at which the communication step shall end if it is to end early.
    ///
    /// After a refusal the instance is as it was at the beginning of the step.
    pub(crate) fn resume(
        &mut self,
        step: &mut IntermediateStep,
        early_return_s: Option<f64>,
    ) -> Result<(), Refusal> {
        // only a defect of the library can have led elsewhere
        let outcome = if self.mode == Mode::IntermediateUpdate {
            early_return_s.map_or(Ok(()), |time_s| step.shorten(self.time_s(), time_s))
        } else {
            Err(Refusal::Internal)
        };
        self.mode = Mode::Step;
        if outcome.is_err() {
            self.abandon(step);
        }
        outcome
    }

    /// Ends the communication step; tells whether that is early.
    pub(crate) fn finish_step(&mut self, step: &IntermediateStep) -> (bool, Option<Warning>) {
        let reached_s = self.time_s();
        let early = reached_s < step.end_s;
        let interval_s = if early {
            reached_s - step.start_s
        } else {
            step.interval_s
        };
        self.pace = self.pace.followed_by(interval_s);
        self.parameters_changed = false;
        if !self.asks_for_inputs() {
            self.inputs.end();
        }
        (early, Warning::of(step.active, step.reached))
    }

    /// Back to the beginning of the step.
    fn abandon(&mut self, step: &IntermediateStep) {
        self.values.clone_from(&step.values_before);
        self.inputs.clone_from(&step.inputs_before);
        self.model.restored(&self.values);
        self.outputs_stale = true;
    }

    fn next_update(&mut self, step: &mut IntermediateStep) -> Result<Option<Update>, Refusal> {
        let now_s = self.time_s();
        if now_s >= step.target_s {
            return Ok(None);
        }
        let asked = |time_s| Update {
            time_s,
            set_requested: true,
            get_allowed: false,
            step_finished: false,
        };
        match step.turn {
            Turn::AskMiddle => {
                (step.asked_s, _) = step.internal_step(now_s);
                step.present.clone_from(&self.values);
                step.turn = Turn::AskEnd;
                Ok(Some(asked(now_s + 0.5 * step.asked_s)))
            }
            Turn::AskEnd => {
                step.middle.clone_from(&self.values);
                step.turn = Turn::Take;
                let (_, reached_s) = step.internal_step(now_s);
                Ok(Some(asked(reached_s)))
            }
            Turn::Take => {
                let asks = self.asks_for_inputs();
                if asks {
                    self.fit_inputs(step);
                }
                self.take_internal_step(step)?;
                if asks {
                    self.inputs.end();
                }
                step.turn = self.first_turn();
                Ok(Some(Update {
                    time_s: self.time_s(),
                    set_requested: asks,
                    get_allowed: true,
                    step_finished: true,
                }))
            }
        }
    }

    /// Takes an internal step.
    fn take_internal_step(&mut self, step: &mut IntermediateStep) -> Result<(), Refusal> {
        let now_s = self.time_s();
        let (length_s, reached_s) = step.internal_step(now_s);
        let reached = self.advance(Step {
            time_s: now_s,
            interval_s: length_s,
            is_steady: step.is_steady && length_s == step.length_s,
        })?;
        step.reached = step.reached.or(reached);
        step.taken += 1;
        self.values[TIME] = reached_s;
        Ok(())
    }

    /// Lets the inputs take the course that the importer has told for the internal step to come.
    fn fit_inputs(&mut self, step: &IntermediateStep) {
        let end = self.values.clone();
        self.set_inputs(&step.present);
        let mut inputs = InputCourse::held(self.identity.variables.listed_inputs());
        for (index, variable) in self.identity.variables.iter() {
            if variable.role.is_input() && self.access.requires(index) {
                let course = [step.present[index], step.middle[index], end[index]];
                inputs.fit(index, course, step.asked_s);
            }
        }
        self.inputs = inputs;
    }

    fn first_turn(&self) -> Turn {
        if self.asks_for_inputs() {
            Turn::AskMiddle
        } else {
            Turn::Take
        }
    }

    /// Whether the importer has said that it would set inputs within a communication step.
    fn asks_for_inputs(&self) -> bool {
        let inputs = self.identity.variables.iter();
        inputs
            .filter(|(_, variable)| variable.role.is_input())
            .any(|(index, _)| self.access.requires(index))
    }

    /// Refuses what the importer must not read within a communication step.
    #[cold]
    pub(super) fn check_readable(&self, references: &[u32]) -> Result<(), Refusal> {
        self.check_access(references, |index| {
            if !self.access.get {
                return Some(NotIntermediate::NoGet);
            }
            // Importers that have named no variable read what is offered, as the FMI project's own example does.
            let names_none = self.access.required.is_empty();
            let readable = names_none || self.access.requires(index);
            (!readable).then_some(NotIntermediate::NotRequired)
        })
    }

    /// Refuses what the importer must not set within a communication step.
    #[cold]
    pub(super) fn check_settable(&self, references: &[u32]) -> Result<(), Refusal> {
        self.check_access(references, |index| {
            if !self.access.requires(index) {
                return Some(NotIntermediate::NotRequired);
            }
            (!self.access.set).then_some(NotIntermediate::NoSet)
        })
    }

    fn check_access(
        &self,
        references: &[u32],
        reason: impl Fn(usize) -> Option<NotIntermediate>,
    ) -> Result<(), Refusal> {
        for &reference in references {
            let (index, _) = self.known(reference)?;
            self.check_offered(index)?;
            if let Some(reason) = reason(index) {
                let name = self.name(index);
                return Err(Refusal::NotIntermediate { name, reason });
            }
        }
        Ok(())
    }

    fn check_offered(&self, index: usize) -> Result<(), Refusal> {
        let variable = self.identity.variables.get(index);
        if self.interface_type() == InterfaceType::CoSimulation
            && variable.is_some_and(|variable| variable.intermediate)
        {
            return Ok(());
        }
        Err(Refusal::NotIntermediate {
            name: self.name(index),
            reason: NotIntermediate::NotOffered,
        })
    }
}

impl IntermediateStep {
    /// Length of the internal step that begins at `now_s`, and its end, s; the last one goes only as far as it shall.
    fn internal_step(&self, now_s: f64) -> (f64, f64) {
        let next = self.taken + 1;
        let next_s = if next < self.count {
            self.start_s + self.length_s * f64::from(next)
        } else {
            self.end_s
        };
        // what rounding leaves over is no step of its own
        let is_last = self.target_s - next_s < 1e-10 * self.length_s;
        if is_last && self.target_s < self.end_s {
            (self.target_s - now_s, self.target_s)
        } else {
            (self.length_s, next_s)
        }
    }

    /// Lets the step end at `time_s`, or now if that has passed.
    fn shorten(&mut self, now_s: f64, time_s: f64) -> Result<(), Refusal> {
        if !self.early_return_allowed {
            return Err(Refusal::EarlyReturnNotAllowed);
        }
        let rounding_s = 1e-6 * self.length_s;
        let within = self.start_s - rounding_s..=self.end_s + rounding_s;
        if !within.contains(&time_s) {
            return Err(Refusal::EarlyReturnTime {
                found_s: time_s,
                start_s: self.start_s,
                end_s: self.end_s,
            });
        }
        self.target_s = time_s.clamp(now_s, self.end_s);
        Ok(())
    }
}
