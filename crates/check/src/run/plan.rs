//! Everything that is done in a run, and what its values say.

use super::balance::{BalanceReport, Integral};
use super::comparison::Comparison;
use super::excitation::{Excitation, moved};
use super::names::{References, Sample};
use super::script::Action;
use super::{RunReport, judge};
use crate::Inspection;
use crate::described::Described;
use bolted_joint_export::Interface;
use bolted_joint_joint::Joint;

/// Steps in a span of the coarser and of the finer run.
const STEPS: [usize; 2] = [Integral::SPAN, 2 * Integral::SPAN];

/// Part of the energies below which the tolerance must be, or the balance says nothing.
const MEANINGFUL: f64 = 1e-3;

/// Everything that is done in a run, one part after the other.
pub(super) struct Plan {
    excitation: Excitation,
    references: References,
    pub(super) actions: Vec<Action>,
    /// Directions of the derivatives, if the FMU has them.
    seed: Option<Vec<f64>>,
    has_states: bool,
    comparison: Option<Comparison>,
}

impl Plan {
    pub(super) fn new(
        excitation: Excitation,
        references: References,
        described: &Described,
        comparison: Option<Comparison>,
    ) -> Self {
        let mut actions = Vec::new();
        for steps in STEPS {
            actions.extend(excitation.actions(&references, steps));
        }
        let mut plan = Self {
            seed: described.has_derivatives.then(|| seed(&references)),
            has_states: described.can_save_state,
            excitation,
            references,
            actions,
            comparison,
        };
        plan.add_derivatives();
        plan.add_states();
        if let Some(comparison) = &plan.comparison {
            plan.actions.extend(comparison.actions());
        }
        plan
    }

    fn get(&self) -> Action {
        Action::Get {
            references: self.references.observed(),
        }
    }

    fn add_derivatives(&mut self) {
        let Some(seed) = &self.seed else {
            return;
        };
        self.actions.extend([
            self.excitation.start(&self.references),
            self.get(),
            Action::Derive {
                unknowns: self.references.joint.clone(),
                knowns: moved(&self.references),
                seed: seed.clone(),
            },
        ]);
    }

    /// Step, save, step, restore, step again: twice the same.
    fn add_states(&mut self) {
        if !self.has_states {
            return;
        }
        let interval_s = self.excitation.span_s;
        let step = |index: usize| Action::Step {
            time_s: index as f64 * interval_s,
            interval_s,
            tentative: true,
        };
        let input = |index: usize| match self.excitation.interface {
            Interface::Lap => self.excitation.set_loads(&self.references, 60 + index),
            Interface::Element => self
                .excitation
                .set_motion(&self.references, index as f64 * interval_s),
        };
        let actions = [
            self.excitation.start(&self.references),
            input(0),
            step(0),
            Action::Save,
            input(1),
            step(1),
            self.get(),
            Action::Restore,
            input(1),
            step(1),
            self.get(),
        ];
        self.actions.extend(actions);
    }

    pub(super) fn judge(
        &self,
        inspection: &Inspection,
        joint: &Joint,
        values: &[Vec<f64>],
        report: &mut RunReport,
    ) {
        let mut rest = values;
        let mut balances = Vec::new();
        for steps in STEPS {
            let Some((run, after)) = rest.split_at_checked(self.points(steps)) else {
                return;
            };
            rest = after;
            let samples = judge::samples(&self.references, run);
            if let Some(wrong) = self.start_finding(&samples) {
                report.findings.push(wrong);
                return;
            }
            let step_s = self.excitation.span_s / steps as f64;
            let found = judge::load_finding(joint, inspection.interface, &samples, step_s);
            if let Some(wrong) = found {
                report.findings.push(wrong);
                return;
            }
            balances.extend(judge::balance(&self.excitation, &samples, steps));
        }
        report
            .facts
            .push("loads: those of resources/joint.json at every communication point".to_owned());
        if let [coarse, fine] = balances.as_slice() {
            let balance = judge::refined(coarse, fine, joint.laws_with_memory().next().is_some());
            report.findings.extend(balance_finding(&balance));
            report.balance = Some(balance);
        }
        if let (Some(seed), [at, derived, after @ ..]) = (&self.seed, rest) {
            rest = after;
            if let Some(sample) = self.references.sample(at) {
                match judge::derivative_finding(joint, &sample, seed, derived) {
                    Some(wrong) => report.findings.push(wrong),
                    None => report
                        .facts
                        .push("directional derivatives: those of the joint's law".to_owned()),
                }
            }
        }
        if let (true, [first, second, after @ ..]) = (self.has_states, rest) {
            rest = after;
            let pairs = || first.iter().zip(second);
            if pairs().all(|(one, other)| one.to_bits() == other.to_bits()) {
                report.facts.push(
                    "saved state: the step repeated from it is the same to the last bit".to_owned(),
                );
            } else {
                report.findings.push(format!(
                    "run: found {second:?} after a step from a restored state, expected {first:?} as the first time"
                ));
            }
        }
        if let Some(comparison) = &self.comparison
            && rest.len() == comparison.points()
        {
            match comparison.judge(rest) {
                Ok(met) => report.facts.push(met),
                Err(missed) => report.findings.push(missed),
            }
        }
    }

    /// Motion that is not what it was set to before the first step.
    fn start_finding(&self, samples: &[Sample<'_>]) -> Option<String> {
        let Action::Start { values, .. } = self.excitation.start(&self.references) else {
            return None;
        };
        let first = samples.first()?;
        let found = [first.displacements, first.velocities].concat();
        (found != values).then(|| {
            format!("run: found the motion {found:?} after initialisation, expected {values:?} as it was set")
        })
    }

    /// Communication points of a run with `steps` steps in a span.
    fn points(&self, steps: usize) -> usize {
        self.excitation.step_count(steps) + 1
    }
}

/// Every motion of both sides at once, in different measure.
fn seed(references: &References) -> Vec<f64> {
    (0..moved(references).len())
        .map(|i| 1.0 + 0.37 * i as f64)
        .collect()
}

fn balance_finding(balance: &BalanceReport) -> Option<String> {
    if !balance.is_balanced() {
        return Some(format!(
            "run: found an energy balance that is off by {:.3e} J, expected at most {:.1e} J: {:.6e} J went in, energy.stored \
             changed by {:.6e} J, power.dissipated took {:.6e} J",
            balance.imbalance_j(),
            balance.tolerance_j,
            balance.work_j,
            balance.stored_j,
            balance.dissipated_j
        ));
    }
    (balance.uncertainty_j > MEANINGFUL * balance.scale_j).then(|| {
        format!(
            "run: found an energy balance that is only known to {:.1e} J of {:.1e} J, expected the run to be accurate \
             enough to judge it",
            balance.uncertainty_j, balance.scale_j
        )
    })
}
