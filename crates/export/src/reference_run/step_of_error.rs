//! The longest Runge–Kutta step with which a lap is as near to its exact motion as was asked for.
//!
//! The eigenvalues say how accurate a step is for small motions about rest. What a joint remembers, and stiffness that grows with
//! amplitude, they do not see. So the lap is run under the loads of the reference run, which open the joint until it slips or
//! its nonlinear loads show. Motions with n and with 2n steps between communication points tell the error of n steps.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{Lap, LapLoads};
use bolted_joint_joint::JointFile;

use super::super::fmu::LapFacts;
use super::super::step::{StepChoice, StepSize, rounded_down};
use super::Laws;
use super::lap::{Moment, Plan, System};
use crate::ExportError;

/// Errors that can be asked for.
const LEAST: f64 = 1e-12;
const LARGEST: f64 = 0.1;
/// Steps between two of the 200 communication points at most.
const MOST_STEPS: u32 = 1 << 14;
/// The error of n steps is at most this many times what 2n steps change: with the second order of LuGre's law it is 4/3, with the
/// fourth 16/15.
const OF_DIFFERENCE: f64 = 4.0 / 3.0;

/// The step of `file`'s joint in `lap`, of an accuracy that is `wanted`; `facts` are those with the step that its eigenvalues
/// ask for.
///
/// # Errors
///
/// [`ExportError::ErrorOutOfRange`], [`ExportError::ErrorOutOfReach`] and [`ExportError::ErrorNotMeasured`].
pub(in super::super) fn step_of_error<const D: usize>(
    lap: &Lap<D>,
    file: &JointFile,
    over_preload: Option<&JointFile>,
    facts: &LapFacts,
    wanted: f64,
) -> Result<StepSize, ExportError> {
    if !(LEAST..=LARGEST).contains(&wanted) {
        return Err(ExportError::ErrorOutOfRange { found: wanted });
    }
    let laws = Laws::<D>::of(file, over_preload)?;
    let system = System {
        lap,
        laws: &laws,
        dofs: file.joint.dofs,
    };
    let trials = Trials::new(&system, facts).ok_or(ExportError::ErrorNotMeasured)?;
    let (count, found) = trials.fewest(wanted)?;
    Ok(StepSize {
        longest_s: rounded_down(trials.plan.step_s / f64::from(count.get()), 3),
        choice: StepChoice::Error {
            found,
            of_modes_s: facts.step.longest_s,
        },
        ..facts.step
    })
}

/// Runs of one lap under the same loads with different steps.
struct Trials<'a, const D: usize> {
    system: &'a System<'a, D>,
    plan: Plan,
    levels: Vec<LapLoads<D>>,
    /// Fewest steps between communication points that are stable.
    stable: NonZeroU32,
}

impl<'a, const D: usize> Trials<'a, D> {
    /// `None` where nothing moves, or where a motion does not stay finite.
    fn new(system: &'a System<'a, D>, facts: &LapFacts) -> Option<Self> {
        let plan = Plan::new(facts, system.laws.have_memory())?;
        let limit_s = facts.step.stability_limit_s.unwrap_or(f64::INFINITY);
        // a count at the very limit would be unstable by rounding
        let stable = (1.001 * plan.step_s / limit_s).ceil().max(1.0);
        Some(Self {
            levels: plan.levels(system)?,
            stable: NonZeroU32::new(stable as u32)?,
            plan,
            system,
        })
    }

    /// The fewest steps between communication points whose error is not above `wanted`, and that error.
    fn fewest(&self, wanted: f64) -> Result<(NonZeroU32, f64), ExportError> {
        let mut count = self.stable;
        let mut too_few = None;
        let mut found = self.error(count)?;
        while found > wanted {
            too_few = Some(count);
            let next = count.saturating_mul(NonZeroU32::MIN.saturating_add(1));
            if next.get() > MOST_STEPS {
                return Err(ExportError::ErrorOutOfReach {
                    wanted,
                    reached: found,
                    step_s: self.plan.step_s / f64::from(count.get()),
                });
            }
            count = next;
            found = self.error(count)?;
        }
        let Some(mut too_few) = too_few else {
            return Ok((count, found));
        };
        while count.get() - too_few.get() > (count.get() / 16).max(1) {
            let Some(middle) = NonZeroU32::new(u32::midpoint(too_few.get(), count.get())) else {
                break;
            };
            let of_middle = self.error(middle)?;
            if of_middle > wanted {
                too_few = middle;
            } else {
                (count, found) = (middle, of_middle);
            }
        }
        Ok((count, found))
    }

    /// By how much motions and joint loads with so many steps between communication points are wrong, as a part of their largest
    /// values in the run.
    fn error(&self, count: NonZeroU32) -> Result<f64, ExportError> {
        let twice = count.saturating_mul(NonZeroU32::MIN.saturating_add(1));
        let run = |count| self.plan.states_of(self.system, &self.levels, count);
        let (coarse, fine) = run(count)
            .zip(run(twice))
            .ok_or(ExportError::ErrorNotMeasured)?;
        let channels = |moments: &[Moment<D>]| -> Vec<Vec<f64>> {
            let moments = moments.iter().enumerate();
            moments
                .map(|(step, moment)| self.system.values(step, moment))
                .collect()
        };
        let (coarse, fine) = (channels(&coarse), channels(&fine));
        let of_channel = |channel: usize| {
            let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
            let rows = || coarse.iter().zip(&fine);
            let difference = largest(&mut rows().map(|(c, f)| (c[channel] - f[channel]).abs()));
            let magnitude = largest(&mut rows().map(|(_, f)| f[channel].abs()));
            if magnitude > 0.0 {
                OF_DIFFERENCE * difference / magnitude
            } else {
                0.0
            }
        };
        let channels = fine.first().map_or(0, Vec::len);
        Ok((0..channels).map(of_channel).fold(0.0, f64::max))
    }
}
