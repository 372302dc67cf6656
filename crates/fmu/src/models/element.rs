//! The element FMU: a massless joint, motion of both sides in, loads on both sides out; no states but those that laws of the
//! joint have in Model Exchange.
//!
//! Of a joint with memory, the motion between two points at which the importer has completed a step is taken as going
//! straight from one to the next: the joint moves on to the motion that is put in where the next step begins, because only
//! then is it known to stay.

use bolted_joint_dynamics::{
    DOF_AT_REST, Dual, JointLaw, JointMemory, Motion, Number, Polynomial, law::Law,
};

use crate::{
    input_course::InputCourse,
    interface::{
        ElementCalculatedParameters, ElementMemoryIndicators, ElementMemoryOutputs, ElementOutputs,
        InterfaceType, Values, memory, reference as vr, scatter,
    },
    models::{
        Model, Outcome, Step, events, heat_not_finite,
        sides::{A, B, check_laws, is_active, joint_law, joint_linear, joint_polynomials},
        watch::{Watch, finite},
    },
    refusal::{Active, Reached, Refusal},
};

/// The joint alone, with `D` degrees of freedom, and with laws that remember the motion or without.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<const D: usize, const REMEMBERS: bool> {
    /// Law of the parameters in use.
    law: JointLaw<D>,
    watch: Watch<D>,
    /// Relative displacement up to which there is nothing to tell the user.
    quiet: Quiet<D>,
}

impl<const D: usize, const REMEMBERS: bool> Default for Element<D, REMEMBERS> {
    fn default() -> Self {
        Self {
            law: JointLaw::NONE,
            watch: Watch::default(),
            quiet: Quiet::default(),
        }
    }
}

/// A relative displacement of each DOF; unlimited unless told otherwise.
#[derive(Clone, Copy, Debug)]
struct Quiet<const D: usize>([f64; D]);

impl<const D: usize> Default for Quiet<D> {
    fn default() -> Self {
        Self([f64::MAX; D])
    }
}

impl<const D: usize, const REMEMBERS: bool> Element<D, REMEMBERS> {
    /// Whether there is nothing to tell the user of the inputs.
    #[inline]
    fn is_quiet(&self, values: &Values) -> bool {
        let displacement = relative::<D>(values).displacement;
        (0..D).all(|dof| displacement[dof].abs() <= self.quiet.0[dof])
    }

    /// What there is to tell of the inputs at `time_s` (s): nothing is integrated here that could run away, so that the
    /// joint may be opened further than its own springs hold.
    fn look(&mut self, values: &Values, time_s: f64) -> Option<Reached> {
        if self.is_quiet(values) {
            return None;
        }
        let reached = self.watch.look(&relative(values).displacement, time_s);
        self.quiet = Quiet(self.watch.quiet());
        reached
    }
}

impl<const D: usize, const REMEMBERS: bool> Model for Element<D, REMEMBERS> {
    fn prepare(&mut self, values: &Values, _: InterfaceType) -> Result<Option<Active>, Refusal> {
        let law = joint_law::<D>(values);
        check_laws(&law)?;
        self.watch.set(&law, finite(law.escape_amplitude()));
        self.quiet = Quiet(self.watch.quiet());
        self.law = law;
        Ok(Active::of(is_active(&law), false))
    }

    fn begin(&self, values: &mut Values) {
        if REMEMBERS {
            begin(values, &joint_law::<D>(values));
        }
    }

    fn commit(&self, values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        match REMEMBERS {
            true => commit(values, &joint_law::<D>(values), time_s),
            false => Ok(()),
        }
    }

    fn pass_event(&self, values: &mut Values) {
        if REMEMBERS {
            pass_event(values, &joint_law::<D>(values));
        }
    }

    fn check_states(&mut self, values: &Values) -> Outcome {
        Ok(self.look(values, values[vr::TIME]))
    }

    fn advance(&mut self, values: &mut Values, step: Step, _: &InputCourse) -> Outcome {
        if REMEMBERS {
            commit(values, &self.law, step.time_s)?;
        }
        Ok(self.look(values, step.time_s))
    }

    fn advance_steadily(&self, values: &mut Values, time_s: f64, _: f64) -> bool {
        self.is_quiet(values) && (!REMEMBERS || commit(values, &self.law, time_s).is_ok())
    }

    fn reset(&mut self) {
        self.watch.forget();
    }

    fn calculate_parameters(&self, values: &mut Values) {
        let joint_escape_amplitude = finite(joint_law::<D>(values).escape_amplitude());
        ElementCalculatedParameters {
            joint_escape_amplitude,
        }
        .write(values);
    }

    fn differentiate_parameters(&self, values: &Values, change: &mut Values) {
        let [law, law_change] = [values, &*change].map(joint_law::<D>);
        ElementCalculatedParameters {
            joint_escape_amplitude: law.escape_amplitude_tangent(&law_change),
        }
        .write(change);
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, change: &mut Values) {
        rates::<D>(values, inputs, change);
    }

    fn calculate_loads(&self, values: &mut Values, is_prepared: bool) -> bool {
        if !REMEMBERS || values.are_integrated() {
            self.calculate_outputs(values);
            return true;
        }
        match is_prepared {
            true => set_loads(values, &self.law),
            false => set_loads(values, &joint_law::<D>(values)),
        }
        set_memory_outputs::<D>(values);
        false
    }

    fn calculate_outputs(&self, values: &mut Values) {
        if !REMEMBERS {
            forgetful_outputs::<D>(values).write(values);
            return;
        }
        set_outputs(values, &joint_law::<D>(values));
        set_memory_outputs::<D>(values);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let [law, law_change] = [values, &*change].map(joint_law::<D>);
        differentiate([&law, &law_change], values, change);
        if REMEMBERS {
            differentiate_memory_outputs::<D>(values, change);
        }
    }
}

/// Begins to count the heat of a joint that remembers, where initialisation ends.
pub(super) fn begin<const D: usize>(values: &mut Values, law: &JointLaw<D>) {
    let relative = relative::<D>(values);
    values[vr::ENERGY_DISSIPATED] = 0.0;
    values[memory::COMMITTED_TIME] = values[vr::TIME];
    // finite however fast the motion starts, since it is remembered
    values[memory::COMMITTED_POWER] = law.viscous_power(&relative).min(f64::MAX);
    if values.are_integrated() {
        // inner states are where the straight way to where the motion starts leaves them
        values.change_joint(|memory| {
            *memory = [DOF_AT_REST; D];
            law.commit_inner(memory, &relative);
        });
    }
    events::begin(values, law, &relative);
}

/// Moves what the joint remembers on to where the motion is at `time_s` (s), and counts the heat of that way.
pub(super) fn commit<const D: usize>(
    values: &mut Values,
    law: &JointLaw<D>,
    time_s: f64,
) -> Result<(), Refusal> {
    let relative = relative(values);
    // the dampers' heat by the trapezoidal rule
    let power = law.viscous_power(&relative);
    let since_s = time_s - values[memory::COMMITTED_TIME];
    let damped_j = 0.5 * since_s * (power + values[memory::COMMITTED_POWER]);
    let before_j = values[vr::ENERGY_DISSIPATED] + damped_j;
    let slid_j = if before_j.is_finite() {
        values.commit_joint(law, &relative)
    } else {
        None
    };
    values[vr::ENERGY_DISSIPATED] = before_j + slid_j.ok_or(heat_not_finite(time_s))?;
    values[memory::COMMITTED_TIME] = time_s;
    values[memory::COMMITTED_POWER] = power;
    events::look_ahead(values, law, &relative, false);
    Ok(())
}

/// Looks for what may have turned at the present motion, which is committed.
pub(super) fn pass_event<const D: usize>(values: &mut Values, law: &JointLaw<D>) {
    let relative = relative(values);
    events::look_ahead(values, law, &relative, true);
}

/// Writes what is calculated of a joint that remembers.
pub(super) fn set_memory_outputs<const D: usize>(values: &mut Values) {
    // as of the last step
    let energy_dissipated = values[vr::ENERGY_DISSIPATED];
    ElementMemoryOutputs { energy_dissipated }.write(values);
    if let Some(indicators) = events::indicators::<D>(values, &relative(values)) {
        let [joint_turning, joint_ahead] = indicators;
        ElementMemoryIndicators {
            joint_turning,
            joint_ahead,
        }
        .write(values);
    }
}

/// Writes the first-order change of that.
pub(super) fn differentiate_memory_outputs<const D: usize>(values: &Values, change: &mut Values) {
    let energy_dissipated = 0.0;
    ElementMemoryOutputs { energy_dissipated }.write(change);
    let [joint_turning, joint_ahead] = events::change::<D>(values, &relative(change));
    ElementMemoryIndicators {
        joint_turning,
        joint_ahead,
    }
    .write(change);
}

/// Derivatives of the motions with respect to time.
pub(super) fn rates<const D: usize>(values: &Values, inputs: &InputCourse, rates: &mut Values) {
    for side in [A, B] {
        let Motion { velocity, .. } = side.motion::<D>(values);
        let [displacements, velocities] = side.motion_references::<D>();
        // the velocity that is put in is the displacement's derivative, unless another one was given
        side.set_motion(
            rates,
            &Motion {
                displacement: std::array::from_fn(|dof| {
                    inputs.rate(displacements[dof]).unwrap_or(velocity[dof])
                }),
                velocity: velocities.map(|input| inputs.rate(input).unwrap_or(0.0)),
            },
        );
    }
}

/// Writes what is calculated from the law and the motions.
#[inline]
pub(super) fn set_outputs<const D: usize>(values: &mut Values, law: &JointLaw<D>) {
    let relative = relative(values);
    outputs(law, &values.joint_at(law, &relative), &relative, |output| {
        output
    })
    .write(values);
    values.set_inner_rates(law, &relative);
}

/// Writes the loads alone, with the rates of inner states.
#[inline]
fn set_loads<const D: usize>(values: &mut Values, law: &JointLaw<D>) {
    let relative = relative(values);
    let on_b = law.load_on_b_after(values.joint(), &relative);
    // 0 − F is −F but for F = 0, which stays without a sign
    scatter(values, &vr::A_LOAD, &on_b.map(|load| 0.0 - load));
    scatter(values, &vr::B_LOAD, &on_b);
    scatter(values, &vr::JOINT_LOAD, &on_b);
    values.set_inner_rates(law, &relative);
}

/// Writes the first-order change of what is calculated, for a change of the law beside that of the motions.
pub(super) fn differentiate<const D: usize>(
    [law, law_change]: [&JointLaw<D>; 2],
    values: &Values,
    change: &mut Values,
) {
    let law = law.with_change(law_change);
    let relative = relative(values).with_change(&relative(change));
    let of = |output: Dual<1>| output.change[0];
    match values.joint_change_at(change, &law, &relative) {
        None => outputs(&law, values.joint(), &relative, of).write(change),
        Some(memory) => {
            outputs(&law, &memory, &relative, of).write(change);
            values.differentiate_inner(&memory, &law, &relative, change);
        }
    }
}

/// What is calculated, or what `of` makes of it.
#[inline]
fn outputs<const D: usize, N: Number, M: Number + Into<N>>(
    law: &JointLaw<D, N>,
    memory: &JointMemory<D, M>,
    relative: &Motion<D, N>,
    of: impl Fn(N) -> f64,
) -> ElementOutputs<D> {
    let on_b = law.load_on_b_after(memory, relative).map(&of);
    ElementOutputs {
        // 0 − F is −F but for F = 0, which stays without a sign
        a_load: on_b.map(|load| 0.0 - load),
        b_load: on_b,
        joint_load: on_b,
        energy_stored: of(law.stored_energy_after(memory, &relative.displacement)),
        power_dissipated: of(law.dissipated_power_after(memory, relative)),
    }
}

/// What is calculated of a joint that remembers nothing: no other law is looked at, as that takes longer than all the rest.
#[inline]
fn forgetful_outputs<const D: usize>(values: &Values) -> ElementOutputs<D> {
    /// What such laws remember.
    const NOTHING: [f64; 0] = [];
    let (linear, polynomials) = (joint_linear::<D>(values), joint_polynomials::<D>(values));
    let relative = relative::<D>(values);
    let mut load = linear.load(&relative);
    let mut energy_stored = linear.stored_energy(&relative.displacement);
    let mut power_dissipated = linear.dissipated_power(&relative.velocity);
    for (i, polynomial) in polynomials.iter().enumerate() {
        if *polynomial == Polynomial::NONE {
            continue;
        }
        let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
        load[i] += polynomial.load(&NOTHING, r, velocity);
        energy_stored += polynomial.stored_energy(&NOTHING, r);
        power_dissipated += polynomial.dissipated_power(&NOTHING, r, velocity);
    }
    ElementOutputs {
        a_load: load.map(|load| 0.0 - load),
        b_load: load,
        joint_load: load,
        energy_stored,
        power_dissipated,
    }
}

/// Motion of side a as seen from side b.
#[inline]
pub(super) fn relative<const D: usize>(values: &Values) -> Motion<D> {
    A.motion::<D>(values).relative_to(&B.motion(values))
}
