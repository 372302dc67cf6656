//! What is done with the FMU of an assembly, and what its values say.

use super::RunReport;
use super::comparison::Comparison;
use super::script::Action;
use crate::described::Described;

/// Steps under a load before a state is saved, and after it.
const STEPS: usize = 20;
/// Load, N and N·m.
const LOAD: f64 = 1.0;
/// Part of the largest energy by which the balance may be off: the joints' laws are integrated to a ten-millionth.
const BALANCED: f64 = 1e-5;
/// Communication step (s) where none is suggested.
const USUAL_STEP_S: f64 = 1e-4;

/// Stored, supplied and dissipated energy.
const ENERGIES: [&str; 3] = ["energy.stored", "energy.supplied", "energy.dissipated"];

/// Everything that is done, one part after the other.
pub(super) struct AssemblyPlan {
    pub(super) actions: Vec<Action>,
    comparison: Option<Comparison>,
}

impl AssemblyPlan {
    /// `None` where a variable is missing, which the inspection tells of.
    pub(super) fn new(
        described: &Described,
        step_s: Option<f64>,
        comparison: Option<Comparison>,
    ) -> Option<Self> {
        let interval_s = step_s.unwrap_or(USUAL_STEP_S);
        let reference = |name: &str| Some(described.variable(name)?.reference);
        let energies = ENERGIES.map(reference);
        let [Some(stored), Some(supplied), Some(dissipated)] = energies else {
            return None;
        };
        let of = |causality: &str| -> Vec<u32> {
            let all = described.variables.iter();
            let own = all.filter(|own| own.causality == causality);
            own.map(|own| own.reference).collect()
        };
        // preloads stay at their start, which is within their tables
        let preloads: Vec<u32> = described
            .variables
            .iter()
            .filter(|own| own.name.ends_with(".preload"))
            .map(|own| own.reference)
            .collect();
        let (mut inputs, outputs) = (of("input"), of("output"));
        inputs.retain(|reference| !preloads.contains(reference));
        let load = |place: usize| LOAD * (1.0 + 0.3 * place as f64);
        let mut actions = vec![Action::Start {
            values: (0..inputs.len()).map(load).collect(),
            references: inputs,
        }];
        let step = |place: usize| Action::Step {
            time_s: place as f64 * interval_s,
            interval_s,
            tentative: true,
        };
        actions.extend((0..STEPS).map(step));
        actions.push(Action::Get {
            references: vec![stored, supplied, dissipated],
        });
        let get = || Action::Get {
            references: outputs.clone(),
        };
        let again = || (STEPS..STEPS + 3).map(step).chain([get()]);
        actions.push(Action::Save);
        actions.extend(again());
        actions.push(Action::Restore);
        actions.extend(again());
        if let Some(comparison) = &comparison {
            actions.extend(comparison.actions());
        }
        Some(Self {
            actions,
            comparison,
        })
    }

    pub(super) fn judge(&self, values: &[Vec<f64>], report: &mut RunReport) {
        let [energies, first, second, rest @ ..] = values else {
            return;
        };
        if let [stored, supplied, dissipated] = energies.as_slice() {
            let off = supplied - dissipated - stored;
            let scale = stored.abs().max(supplied.abs()).max(dissipated.abs());
            // false for NaN
            if off.abs() <= BALANCED * scale {
                report.facts.push(format!(
                    "energy: {supplied:.3e} J in, {stored:.3e} J stored, {dissipated:.3e} J dissipated; off by {off:.0e} J"
                ));
            } else {
                report.findings.push(format!(
                    "run: found an energy balance that is off by {off:.3e} J, expected at most {:.1e} J",
                    BALANCED * scale
                ));
            }
        }
        let pairs = || first.iter().zip(second);
        if pairs().all(|(one, other)| one.to_bits() == other.to_bits()) {
            let fact = "saved state: the steps repeated from it are the same to the last bit";
            report.facts.push(fact.to_owned());
        } else {
            report.findings.push(format!(
                "run: found {second:?} after steps from a restored state, expected {first:?} as the first time"
            ));
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
}
