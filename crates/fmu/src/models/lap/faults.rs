//! Why a lap cannot be stepped, or why a step of it has failed.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{Defect, Lap, LapState, STABILITY_LIMIT_REAL};

use super::{
    loads::Loads,
    prepared::{Prepared, is_within},
    way::Way as _,
};
use crate::{
    models::{
        Step,
        sides::{A, B, name, unit},
    },
    refusal::Refusal,
};

/// Whether the parameters give equations of motion.
pub(in crate::models) fn check_parameters<const D: usize>(lap: &Lap<D>) -> Result<(), Refusal> {
    match lap.defect() {
        Some(Defect::Inertia { on_a, dof, value }) => {
            let side = if on_a { A } else { B };
            let reference = side.inertia.get(dof).copied();
            Err(Refusal::Inertia {
                name: reference.map_or("", name).into(),
                unit: reference.map_or("", unit).into(),
                found: value,
            })
        }
        Some(Defect::NotFinite) => Err(Refusal::NotUsable),
        None => Ok(()),
    }
}

/// Whether Runge–Kutta steps of this length follow the lap.
pub(in crate::models) fn check_step<const D: usize>(
    lap: &Lap<D>,
    step_size_max_s: f64,
) -> Result<(), Refusal> {
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

impl<const D: usize> Prepared<D> {
    /// Goes through a failed step again, one Runge–Kutta step at a time, to say what failed first, and when.
    #[cold]
    pub(super) fn explain(&self, start: &LapState<D>, loads: &Loads<'_, D>, step: Step) -> Refusal {
        let count = self
            .internal_steps(step.interval_s)
            .map_or(1, NonZeroU32::get);
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
        fault(&state, &self.amplitude, time_s)
    }
}

/// Refuses a state that is not finite, or of a joint that does not hold up to this relative displacement.
#[inline]
pub(in crate::models) fn check_held<const D: usize>(
    state: &LapState<D>,
    amplitude: &[f64; D],
    time_s: f64,
) -> Result<(), Refusal> {
    if is_within(amplitude, state) {
        Ok(())
    } else {
        Err(fault(state, amplitude, time_s))
    }
}

/// What is wrong with this state of a joint that holds up to this relative displacement.
#[cold]
fn fault<const D: usize>(state: &LapState<D>, amplitude: &[f64; D], time_s: f64) -> Refusal {
    for (side, motion) in [(A, &state.a), (B, &state.b)] {
        let numbers = motion.displacement.iter().chain(&motion.velocity);
        let references = side.motion_references::<D>();
        for (&reference, number) in references.iter().flatten().zip(numbers) {
            if !number.is_finite() {
                return Refusal::StateNotFinite {
                    name: name(reference).into(),
                    time_s,
                };
            }
        }
    }
    let relative = state.a.relative_to(&state.b);
    for dof in 0..D {
        if relative.displacement[dof].abs() > amplitude[dof] {
            return Refusal::Escape {
                a: name(A.displacement[dof]),
                b: name(B.displacement[dof]),
                unit: unit(A.displacement[dof]).into(),
                relative: relative.displacement[dof],
                amplitude: amplitude[dof],
                time_s,
            };
        }
    }
    // only a sum overflowed, or rounding hid the fault from the single steps
    Refusal::StateNotFinite {
        name: name(A.displacement[0]).into(),
        time_s,
    }
}
