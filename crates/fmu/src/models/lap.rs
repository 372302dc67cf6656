//! The lap FMU: two supported bodies and the joint between them, loads in, motion out, integrated by RK4.

pub(super) mod faults;
pub(super) mod loads;
pub(super) mod prepared;
pub(super) mod way;

use std::num::NonZeroU32;

use bolted_joint_dynamics::{Dual, JointMemory, Lap, LapLoads, LapState, Motion, Number};

use crate::{
    input_course::InputCourse,
    interface::{
        InterfaceType, LapCalculatedParameters, LapMemoryIndicators, LapOutputs, Values,
        reference as vr,
    },
    models::{
        Model, Outcome, Step, events,
        sides::{A, B, check_laws, is_active},
        watch::{Watch, finite},
    },
    refusal::{Active, Refusal},
};
use faults::{check_held, check_parameters, check_step};
use way::{Way, lap, loads, state};

/// Two bodies and the joint between them, with `D` degrees of freedom a side, that go their `Way` through a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct LapModel<const D: usize, W> {
    /// What the parameters give; `None` before they are first taken into use.
    way: Option<W>,
    watch: Watch<D>,
}

impl<const D: usize, W> Default for LapModel<D, W> {
    fn default() -> Self {
        Self {
            way: None,
            watch: Watch::default(),
        }
    }
}

impl<const D: usize, W: Way<D>> Model for LapModel<D, W> {
    fn prepare(
        &mut self,
        values: &Values,
        interface_type: InterfaceType,
    ) -> Result<Option<Active>, Refusal> {
        let lap = lap::<D>(values);
        check_parameters(&lap)?;
        check_laws(&lap.joint)?;
        let step_size_max_s = values[vr::STEP_SIZE_MAX];
        if interface_type == InterfaceType::CoSimulation {
            check_step(&lap, step_size_max_s)?;
        }
        let escape = lap.escape_amplitude();
        self.watch.set(&lap.joint, finite(escape));
        self.way = Some(W::new(&lap, step_size_max_s, escape, self.watch.quiet()));
        Ok(Active::of(is_active(&lap.joint), lap.has_active_support()))
    }

    fn begin(&self, values: &mut Values) {
        W::begin(values);
    }

    fn commit(&self, values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        W::commit(values, time_s)
    }

    fn pass_event(&self, values: &mut Values) {
        W::pass_event(values);
    }

    fn check_states(&mut self, values: &Values) -> Outcome {
        let way = self.way.as_mut().ok_or(Refusal::NotUsable)?;
        let (state, time_s) = (state(values), values[vr::TIME]);
        check_held(&state, way.hold(), time_s)?;
        Ok(way.look(&mut self.watch, &state, time_s))
    }

    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal> {
        let way = self.way.as_ref().ok_or(Refusal::NotUsable)?;
        way.internal_steps(interval_s)
    }

    fn advance(&mut self, values: &mut Values, step: Step, inputs: &InputCourse) -> Outcome {
        let way = self.way.as_mut().ok_or(Refusal::NotUsable)?;
        way.advance(&mut self.watch, values, step, inputs)
    }

    fn advance_steadily(&self, values: &mut Values, _: f64, interval_s: f64) -> bool {
        match &self.way {
            Some(way) => way.advance_steadily(values, interval_s),
            None => false,
        }
    }

    fn reset(&mut self) {
        self.watch.forget();
    }

    fn calculate_parameters(&self, values: &mut Values) {
        let joint_escape_amplitude = finite(lap::<D>(values).escape_amplitude());
        LapCalculatedParameters {
            joint_escape_amplitude,
        }
        .write(values);
    }

    fn differentiate_parameters(&self, values: &Values, change: &mut Values) {
        let [lap, lap_change] = [values, &*change].map(lap::<D>);
        LapCalculatedParameters {
            joint_escape_amplitude: lap.escape_amplitude_tangent(&lap_change),
        }
        .write(change);
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, change: &mut Values) {
        rates::<D>(values, inputs, change);
        W::add_rates(values, change);
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let lap = lap::<D>(values);
        let state = state::<D>(values);
        set_outputs(values, &lap, &state);
        W::set_indicators(values);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let [lap, lap_change] = [values, &*change].map(lap::<D>);
        differentiate([&lap, &lap_change], values, change);
        W::differentiate_indicators(values, change);
    }
}

/// Derivatives of states and loads with respect to time, of which the accelerations are among `values`.
pub(super) fn rates<const D: usize>(values: &Values, inputs: &InputCourse, rates: &mut Values) {
    for side in [A, B] {
        // ẋ = v, v̇ as calculated from the equations of motion
        let Motion { velocity, .. } = side.motion::<D>(values);
        side.set_motion(
            rates,
            &Motion {
                displacement: velocity,
                velocity: side.acceleration(values),
            },
        );
        let of_loads = side.load_references::<D>();
        side.set_load(
            rates,
            &of_loads.map(|load| inputs.rate(load).unwrap_or(0.0)),
        );
    }
}

/// Writes what is calculated from the bodies, the joint and their state.
#[inline]
pub(super) fn set_outputs<const D: usize>(values: &mut Values, lap: &Lap<D>, state: &LapState<D>) {
    let loads = loads(values);
    let relative = state.relative();
    let memory = values.joint_at(&lap.joint, &relative);
    outputs(lap, &memory, (state, &loads), |output| output).write(values);
    values.set_inner_rates(&lap.joint, &relative);
}

/// Writes the first-order change of what is calculated, for a change of bodies and joint beside that of the other variables.
pub(super) fn differentiate<const D: usize>(
    [lap, lap_change]: [&Lap<D>; 2],
    values: &Values,
    change: &mut Values,
) {
    let lap = lap.with_change(lap_change);
    let state = state(values).with_change(&state(change));
    let loads = loads(values).with_change(&loads(change));
    let relative = state.relative();
    let of = |output: Dual<1>| output.change[0];
    match values.joint_change_at(change, &lap.joint, &relative) {
        None => outputs(&lap, values.joint(), (&state, &loads), of).write(change),
        Some(memory) => {
            outputs(&lap, &memory, (&state, &loads), of).write(change);
            values.differentiate_inner(&memory, &lap.joint, &relative, change);
        }
    }
}

/// Writes the event indicators of a joint that remembers.
pub(super) fn set_indicators<const D: usize>(values: &mut Values) {
    if let Some(indicators) = events::indicators::<D>(values, &state(values).relative()) {
        let [joint_turning, joint_ahead] = indicators;
        LapMemoryIndicators {
            joint_turning,
            joint_ahead,
        }
        .write(values);
    }
}

/// Writes the first-order change of the event indicators of a joint that remembers.
pub(super) fn differentiate_indicators<const D: usize>(values: &Values, change: &mut Values) {
    let [joint_turning, joint_ahead] = events::change::<D>(values, &state(change).relative());
    LapMemoryIndicators {
        joint_turning,
        joint_ahead,
    }
    .write(change);
}

/// What is calculated, or what `of` makes of it.
#[inline]
fn outputs<const D: usize, N: Number, M: Number + Into<N>>(
    lap: &Lap<D, N>,
    memory: &JointMemory<D, M>,
    (state, loads): (&LapState<D, N>, &LapLoads<D, N>),
    of: impl Fn(N) -> f64,
) -> LapOutputs<D> {
    let [a_acceleration, b_acceleration] = lap
        .accelerations(memory, state, loads)
        .map(|accelerations| accelerations.map(&of));
    LapOutputs {
        joint_load: lap
            .joint
            .load_on_b_after(memory, &state.relative())
            .map(&of),
        energy_stored: of(lap.stored_energy(memory, state)),
        power_dissipated: of(lap.dissipated_power(memory, state)),
        a_acceleration,
        b_acceleration,
    }
}
