//! The element FMU of a joint over the preload.

use bolted_joint_dynamics::{JointLaw, JointOverPreload};

use super::{
    CHECKED_BETWEEN, are_active, check_preload, preload_power, preload_power_change, smaller,
    with_friction,
};
use crate::{
    input_course::InputCourse,
    interface::{
        ElementCalculatedParameters, ElementOverPreloadOutputs, InterfaceType, Values,
        reference as vr,
    },
    models::{
        Model, Outcome, Step,
        element::{
            begin, commit, differentiate, differentiate_memory_outputs, pass_event, rates,
            relative, set_memory_outputs, set_outputs,
        },
        watch::{Watch, finite},
    },
    preload_table::OverPreload,
    refusal::{Active, Reached, Refusal},
};

/// The joint alone, with `D` degrees of freedom.
#[derive(Clone, Debug)]
pub(in crate::models) struct LooseningElement<const D: usize> {
    /// What the start-value file says.
    start: OverPreload<D>,
    /// The joint with the friction among the parameters.
    table: JointOverPreload<D>,
    watch: Watch<D>,
    /// Preload (N·m) whose limits the watch has; `None` before it has any.
    watched_n_m: Option<f64>,
}

impl<const D: usize> LooseningElement<D> {
    pub(in crate::models) fn new(start: OverPreload<D>) -> Self {
        Self {
            table: start.joint.clone(),
            start,
            watch: Watch::default(),
            watched_n_m: None,
        }
    }

    fn law(&self, values: &Values) -> JointLaw<D> {
        self.table.law(values[vr::PRELOAD])
    }

    /// What there is to tell of the inputs at `time_s` (s).
    fn look(&mut self, values: &Values, time_s: f64) -> Option<Reached> {
        let preload_n_m = values[vr::PRELOAD];
        if self.watched_n_m != Some(preload_n_m) {
            let law = self.law(values);
            self.watch.set(&law, finite(law.escape_amplitude()));
            self.watched_n_m = Some(preload_n_m);
        }
        self.watch.look(&relative(values).displacement, time_s)
    }
}

impl<const D: usize> Model for LooseningElement<D> {
    fn prepare(&mut self, values: &Values, _: InterfaceType) -> Result<Option<Active>, Refusal> {
        self.table = with_friction(&self.start, values)?;
        self.watched_n_m = None;
        let samples = self.table.samples_n_m(CHECKED_BETWEEN);
        let laws = samples.map(|preload_n_m| self.table.law(preload_n_m));
        Ok(Active::of(are_active(laws), false))
    }

    fn begin(&self, values: &mut Values) {
        if self.table.has_memory() {
            begin(values, &self.law(values));
        }
    }

    fn commit(&self, values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        match self.table.has_memory() {
            true => commit(values, &self.law(values), time_s),
            false => Ok(()),
        }
    }

    fn pass_event(&self, values: &mut Values) {
        if self.table.has_memory() {
            pass_event(values, &self.law(values));
        }
    }

    fn check_input(&self, input: usize, value: f64) -> Result<(), Refusal> {
        if input == vr::PRELOAD {
            check_preload(&self.table, value, None)
        } else {
            Ok(())
        }
    }

    fn check_states(&mut self, values: &Values) -> Outcome {
        Ok(self.look(values, values[vr::TIME]))
    }

    fn advance(&mut self, values: &mut Values, step: Step, inputs: &InputCourse) -> Outcome {
        if !inputs.is_held() {
            let end_n_m = inputs.value(vr::PRELOAD, values[vr::PRELOAD], step.interval_s);
            check_preload(&self.table, end_n_m, Some(step.time_s + step.interval_s))?;
        }
        self.commit(values, step.time_s)?;
        Ok(self.look(values, step.time_s))
    }

    fn reset(&mut self) {
        self.watch.forget();
    }

    fn calculate_parameters(&self, values: &mut Values) {
        let samples = self.table.samples_n_m(CHECKED_BETWEEN);
        let joint_escape_amplitude = samples.fold([f64::MAX; D], |least, preload_n_m| {
            smaller(
                least,
                finite(self.table.law(preload_n_m).escape_amplitude()),
            )
        });
        ElementCalculatedParameters {
            joint_escape_amplitude,
        }
        .write(values);
    }

    fn differentiate_parameters(&self, _: &Values, change: &mut Values) {
        // the table is what it is
        ElementCalculatedParameters {
            joint_escape_amplitude: [0.0; D],
        }
        .write(change);
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, change: &mut Values) {
        rates::<D>(values, inputs, change);
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let law = self.law(values);
        set_outputs(values, &law);
        ElementOverPreloadOutputs {
            power_preload: preload_power(&self.table, values, &relative(values)),
        }
        .write(values);
        if self.table.has_memory() {
            set_memory_outputs::<D>(values);
        }
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let law_change = self.table.change(values[vr::PRELOAD]);
        let law_change = law_change.times(change[vr::PRELOAD]);
        differentiate([&self.law(values), &law_change], values, change);
        let motions = [values, &*change].map(relative::<D>);
        ElementOverPreloadOutputs {
            power_preload: preload_power_change(
                &self.table,
                [values, &*change],
                motions.each_ref(),
            ),
        }
        .write(change);
        if self.table.has_memory() {
            differentiate_memory_outputs::<D>(values, change);
        }
    }
}
