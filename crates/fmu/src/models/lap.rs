//! The lap FMU: two supported bodies and the joint between them, loads in, motion out, integrated by RK4.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{
    Defect, Lap, LapIntegrator, LapLoads, LapPropagator, LapState, Motion, STABILITY_LIMIT_REAL,
    substeps,
};

use crate::{
    input_course::InputCourse,
    interface::{Dofs, InterfaceType, Kind, Values, Variable, Variables, reference as vr},
    models::{
        CommunicationStep, Model,
        sides::{A, B, Side, is_active, joint_law, set_joint_load},
    },
    refusal::{Active, Refusal},
};

/// Most Runge–Kutta steps in one communication step: about a minute's work.
pub(crate) const SUBSTEPS_MAX: u32 = 1_000_000_000;

/// Runge–Kutta steps in a communication step from which preparing for that one step alone is quicker than taking them.
const STEPS_WORTH_PREPARING: u32 = 256;

/// Runge–Kutta steps after which it is checked whether a softening joint still holds: a tenth of the fastest period where
/// the export has chosen the step. Checking after every one takes half as long again.
const STEPS_BETWEEN_CHECKS: NonZeroU32 = NonZeroU32::new(8).unwrap();

/// Two bodies and the joint between them, with `D` degrees of freedom a side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LapModel<const D: usize> {
    /// What the parameters give; `None` before they are first taken into use.
    prepared: Option<Prepared<D>>,
}

#[derive(Clone, Copy, Debug)]
struct Prepared<const D: usize> {
    integrator: LapIntegrator<D>,
    step_size_max_s: f64,
    /// Relative displacement that a softening joint holds at most; the largest number where it always holds.
    amplitude: [f64; D],
    /// Whether the joint holds only so far.
    softens: bool,
    /// What the latest length of a communication step gives; `None` before the first one.
    interval: Option<Interval<D>>,
}

/// One length of communication steps.
#[derive(Clone, Copy, Debug)]
struct Interval<const D: usize> {
    length_s: f64,
    /// Runge–Kutta steps that it takes.
    count: NonZeroU32,
    propagation: Propagation<D>,
}

/// Whether one product can take the place of the Runge–Kutta steps.
#[derive(Clone, Copy, Debug)]
enum Propagation<const D: usize> {
    /// Nobody has asked yet.
    Unknown,
    /// It cannot: the equations are not linear, or a mode grows past all bounds.
    Impossible,
    /// It can.
    Possible(LapPropagator<D>),
}

impl<const D: usize> Model for LapModel<D> {
    fn prepare(
        &mut self,
        values: &Values,
        interface_type: InterfaceType,
    ) -> Result<Option<Active>, Refusal> {
        let lap = lap::<D>(values);
        match lap.defect() {
            Some(Defect::Inertia { on_a, dof, value }) => {
                let side = if on_a { A } else { B };
                let variable = side.inertia.get(dof).copied().and_then(variable);
                return Err(Refusal::Inertia {
                    name: variable.map_or("", |variable| variable.name),
                    unit: variable.map_or("", |variable| variable.unit),
                    found: value,
                });
            }
            Some(Defect::NotFinite) => return Err(Refusal::NotUsable),
            None => {}
        }
        let step_size_max_s = values[vr::STEP_SIZE_MAX];
        if interface_type == InterfaceType::CoSimulation {
            check_step(&lap, step_size_max_s)?;
        }
        let limits = lap.escape_amplitude();
        self.prepared = Some(Prepared {
            integrator: LapIntegrator::new(&lap),
            step_size_max_s,
            amplitude: limits.map(|limit| limit.unwrap_or(f64::MAX)),
            softens: limits.iter().any(Option::is_some),
            interval: None,
        });
        let [joint_stiffness, joint_damping] = is_active(&lap.joint);
        let supports = [&lap.a, &lap.b]
            .iter()
            .flat_map(|body| body.stiffness.iter().chain(&body.damping))
            .any(|&coefficient| coefficient < 0.0);
        Ok(Active {
            joint_stiffness,
            joint_damping,
            supports,
        }
        .warning())
    }

    fn check_states(&self, values: &Values) -> Result<(), Refusal> {
        let prepared = self.prepared.as_ref().ok_or(Refusal::NotUsable)?;
        let state = state(values);
        if prepared.holds(&state) {
            Ok(())
        } else {
            Err(prepared.fault(&state, values[vr::TIME]))
        }
    }

    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal> {
        let prepared = self.prepared.as_ref().ok_or(Refusal::NotUsable)?;
        count(interval_s, prepared.step_size_max_s)
    }

    fn advance(
        &mut self,
        values: &mut Values,
        step: CommunicationStep,
        inputs: &InputCourse,
    ) -> Result<(), Refusal> {
        let prepared = self.prepared.as_mut().ok_or(Refusal::NotUsable)?;
        let start = state::<D>(values);
        let loads = Loads {
            start: loads(values),
            course: inputs,
        };
        let end = if inputs.is_held() {
            prepared.advance(&start, &loads.start, step)?
        } else {
            prepared.advance_along(&start, &loads, step)?
        };
        if !prepared.holds(&end) {
            return Err(prepared.explain(&start, &loads, step));
        }
        A.set_motion(values, &end.a);
        B.set_motion(values, &end.b);
        Ok(())
    }

    fn advance_steadily(&self, values: &mut Values, interval_s: f64) -> bool {
        let Some(prepared) = &self.prepared else {
            return false;
        };
        let (start, loads) = (state(values), loads(values));
        match prepared.steady_end(&start, &loads, interval_s) {
            Some(end) if prepared.holds(&end) => {
                A.set_motion(values, &end.a);
                B.set_motion(values, &end.b);
                true
            }
            _ => false,
        }
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, rates: &mut Values) {
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

    fn calculate_outputs(&self, values: &mut Values) {
        let lap = lap::<D>(values);
        let state = state::<D>(values);
        let on_b = lap.joint.load_on_b(&state.a.relative_to(&state.b));
        set_joint_load(values, &on_b);
        values[vr::ENERGY_STORED] = lap.stored_energy(&state);
        values[vr::POWER_DISSIPATED] = lap.dissipated_power(&state);
        let [of_a, of_b] = lap.accelerations(&state, &loads(values));
        A.set_acceleration(values, &of_a);
        B.set_acceleration(values, &of_b);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let [lap, lap_change] = [values, &*change].map(lap::<D>);
        let [state, state_change] = [values, &*change].map(state::<D>);
        let [relative, relative_change] =
            [&state, &state_change].map(|state| state.a.relative_to(&state.b));
        let on_b = lap
            .joint
            .load_on_b_tangent(&lap_change.joint, &relative, &relative_change);
        set_joint_load(change, &on_b);
        change[vr::ENERGY_STORED] = lap.stored_energy_tangent(&lap_change, &state, &state_change);
        change[vr::POWER_DISSIPATED] =
            lap.dissipated_power_tangent(&lap_change, &state, &state_change);
        let [of_a, of_b] = lap.accelerations_tangent(
            &lap_change,
            [&state, &state_change],
            [&loads(values), &loads(change)],
        );
        A.set_acceleration(change, &of_a);
        B.set_acceleration(change, &of_b);
    }
}

/// The loads over a step.
struct Loads<'a, const D: usize> {
    /// At its beginning.
    start: LapLoads<D>,
    /// How they go on.
    course: &'a InputCourse,
}

impl<const D: usize> Loads<'_, D> {
    /// Loads `after_s` (s) from the beginning.
    fn after(&self, after_s: f64) -> LapLoads<D> {
        let of_side = |side: Side, start: &[f64; D]| {
            let inputs = side.load_references::<D>();
            std::array::from_fn(|dof| self.course.value(inputs[dof], start[dof], after_s))
        };
        LapLoads {
            a: of_side(A, &self.start.a),
            b: of_side(B, &self.start.b),
        }
    }

    /// Loads at the stages of the Runge–Kutta step of `length_s` (s) that has the number `index`, from 0.
    fn at_stages(&self, index: u32, length_s: f64) -> [LapLoads<D>; 3] {
        [0.0, 0.5, 1.0].map(|part| self.after((f64::from(index) + part) * length_s))
    }
}

impl<const D: usize> Prepared<D> {
    /// State at the end of the step, by one product where that is possible and worth its preparation.
    #[inline]
    fn advance(
        &mut self,
        start: &LapState<D>,
        loads: &LapLoads<D>,
        step: CommunicationStep,
    ) -> Result<LapState<D>, Refusal> {
        let length_s = step.interval_s;
        let interval = match &mut self.interval {
            Some(interval) if interval.length_s == length_s => interval,
            interval => interval.insert(Interval {
                length_s,
                count: count(length_s, self.step_size_max_s)?,
                propagation: Propagation::Unknown,
            }),
        };
        let count = interval.count;
        if step.is_steady || count.get() >= STEPS_WORTH_PREPARING {
            if let Propagation::Unknown = interval.propagation {
                interval.propagation = propagation(&self.integrator, length_s, count);
            }
            if let Propagation::Possible(propagator) = &interval.propagation {
                return Ok(propagator.advance(start, loads));
            }
        }
        if self.softens && count > STEPS_BETWEEN_CHECKS {
            return Ok(self.stepped_while_held(start, loads, length_s, count));
        }
        Ok(stepped(&self.integrator, start, loads, length_s, count))
    }

    /// State after the Runge–Kutta steps under held loads, or, of a softening joint, at the first check that finds it
    /// torn: what a load brings back from there cannot become whole again.
    fn stepped_while_held(
        &self,
        start: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        count: NonZeroU32,
    ) -> LapState<D> {
        let length_s = interval_s / f64::from(count.get());
        let mut state = *start;
        let mut rest = count.get();
        while rest > 0 {
            // so many steps have the length of one to the last bit, because it is a power of two
            let next = if rest >= STEPS_BETWEEN_CHECKS.get() {
                STEPS_BETWEEN_CHECKS
            } else {
                NonZeroU32::MIN
            };
            let span_s = length_s * f64::from(next.get());
            state = stepped(&self.integrator, &state, loads, span_s, next);
            if !self.holds(&state) {
                break;
            }
            rest -= next.get();
        }
        state
    }

    /// State at the end of one of many equal steps, if all is prepared for it.
    #[inline]
    fn steady_end(
        &self,
        start: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
    ) -> Option<LapState<D>> {
        let interval = self.interval.as_ref()?;
        if interval.length_s != interval_s {
            return None;
        }
        match &interval.propagation {
            Propagation::Unknown => None,
            Propagation::Possible(propagator) => Some(propagator.advance(start, loads)),
            Propagation::Impossible if self.softens && interval.count > STEPS_BETWEEN_CHECKS => {
                None
            }
            Propagation::Impossible => {
                Some(
                    self.integrator
                        .advance(start, loads, interval_s, interval.count),
                )
            }
        }
    }

    /// State at the end of the step under loads that change, by Runge–Kutta steps.
    #[cold]
    fn advance_along(
        &self,
        start: &LapState<D>,
        loads: &Loads<'_, D>,
        step: CommunicationStep,
    ) -> Result<LapState<D>, Refusal> {
        let count = count(step.interval_s, self.step_size_max_s)?.get();
        let length_s = step.interval_s / f64::from(count);
        let mut state = *start;
        for index in 0..count {
            let loads = loads.at_stages(index, length_s);
            state = self.integrator.step_with_loads(&state, &loads, length_s);
            if !self.holds(&state) {
                break;
            }
        }
        Ok(state)
    }

    /// Whether the state is finite and the joint holds.
    #[inline]
    fn holds(&self, state: &LapState<D>) -> bool {
        let relative = state.a.relative_to(&state.b);
        let mut sum = 0.0;
        let mut holds = true;
        for dof in 0..D {
            sum += state.a.displacement[dof].abs() + state.b.displacement[dof].abs();
            sum += state.a.velocity[dof].abs() + state.b.velocity[dof].abs();
            // a comparison with NaN is false
            holds &= relative.displacement[dof].abs() <= self.amplitude[dof];
        }
        holds && sum <= f64::MAX
    }

    /// Goes through a failed step again, one Runge–Kutta step at a time, to say what failed first, and when.
    #[cold]
    fn explain(
        &self,
        start: &LapState<D>,
        loads: &Loads<'_, D>,
        step: CommunicationStep,
    ) -> Refusal {
        let count = count(step.interval_s, self.step_size_max_s).map_or(1, NonZeroU32::get);
        let length_s = step.interval_s / f64::from(count);
        let mut state = *start;
        let mut time_s = step.time_s;
        for index in 0..count {
            let loads = loads.at_stages(index, length_s);
            state = self.integrator.step_with_loads(&state, &loads, length_s);
            time_s = step.time_s + length_s * f64::from(index + 1);
            if !self.holds(&state) {
                break;
            }
        }
        self.fault(&state, time_s)
    }

    fn fault(&self, state: &LapState<D>, time_s: f64) -> Refusal {
        for (side, motion) in [(A, &state.a), (B, &state.b)] {
            let numbers = motion.displacement.iter().chain(&motion.velocity);
            let references = side.motion_references::<D>();
            for (&reference, number) in references.iter().flatten().zip(numbers) {
                if !number.is_finite() {
                    return Refusal::StateNotFinite {
                        name: name(reference),
                        time_s,
                    };
                }
            }
        }
        let relative = state.a.relative_to(&state.b);
        for dof in 0..D {
            if relative.displacement[dof].abs() > self.amplitude[dof] {
                return Refusal::Escape {
                    a: name(A.displacement[dof]),
                    b: name(B.displacement[dof]),
                    unit: variable(A.displacement[dof]).map_or("", |variable| variable.unit),
                    relative: relative.displacement[dof],
                    amplitude: self.amplitude[dof],
                    time_s,
                };
            }
        }
        // only a sum overflowed, or rounding hid the fault from the single steps
        Refusal::StateNotFinite {
            name: name(A.displacement[0]),
            time_s,
        }
    }
}

/// The Runge–Kutta steps where time does not matter.
#[cold]
fn stepped<const D: usize>(
    integrator: &LapIntegrator<D>,
    start: &LapState<D>,
    loads: &LapLoads<D>,
    interval_s: f64,
    count: NonZeroU32,
) -> LapState<D> {
    integrator.advance(start, loads, interval_s, count)
}

/// Whether Runge–Kutta steps of this length follow the lap.
fn check_step<const D: usize>(lap: &Lap<D>, step_size_max_s: f64) -> Result<(), Refusal> {
    if !(step_size_max_s.is_finite() && step_size_max_s > 0.0) {
        return Err(Refusal::StepSizeMax {
            found_s: step_size_max_s,
        });
    }
    let spectrum = lap.spectrum().ok_or(Refusal::NotUsable)?;
    if spectrum.is_stable_with(step_size_max_s) {
        return Ok(());
    }
    // on the whole left half plane RK4 is stable for |hλ| up to about 2.6; stay clear of that
    let advised_s = 0.9 * STABILITY_LIMIT_REAL / spectrum.largest_modulus();
    Err(Refusal::UnstableStep {
        step_s: step_size_max_s,
        advised_s,
    })
}

/// Number of Runge–Kutta steps in a communication step.
#[cold]
fn count(interval_s: f64, step_size_max_s: f64) -> Result<NonZeroU32, Refusal> {
    // n = ⌈H/h_max⌉
    substeps(interval_s, step_size_max_s)
        .filter(|count| count.get() <= SUBSTEPS_MAX)
        .ok_or(Refusal::TooManySubsteps {
            interval_s,
            step_size_max_s,
        })
}

#[cold]
fn propagation<const D: usize>(
    integrator: &LapIntegrator<D>,
    interval_s: f64,
    count: NonZeroU32,
) -> Propagation<D> {
    LapPropagator::new(integrator, interval_s, count)
        .map_or(Propagation::Impossible, Propagation::Possible)
}

fn lap<const D: usize>(values: &Values) -> Lap<D> {
    Lap {
        joint: joint_law(values),
        a: A.body(values),
        b: B.body(values),
    }
}

#[inline]
fn state<const D: usize>(values: &Values) -> LapState<D> {
    LapState {
        a: A.motion(values),
        b: B.motion(values),
    }
}

#[inline]
fn loads<const D: usize>(values: &Values) -> LapLoads<D> {
    LapLoads {
        a: A.load(values),
        b: B.load(values),
    }
}

fn variable(reference: usize) -> Option<&'static Variable> {
    Variables {
        kind: Kind::Lap,
        dofs: Dofs::Two,
    }
    .get(reference)
}

fn name(reference: usize) -> &'static str {
    variable(reference).map_or("", |variable| variable.name)
}
