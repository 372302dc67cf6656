//! The FMU's own reference run, done and compared.

use super::script::Action;
use crate::described::Described;
use crate::reference::ReferenceRun;

/// A reference run with the value references of its variables.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comparison {
    run: ReferenceRun,
    inputs: Vec<u32>,
    outputs: Vec<u32>,
}

impl Comparison {
    /// The error is the name of a variable that does not exist.
    pub(super) fn new(run: ReferenceRun, described: &Described) -> Result<Self, String> {
        let references = |names: &[String]| -> Result<Vec<u32>, String> {
            names
                .iter()
                .map(|name| {
                    let variable = described.variable(name);
                    variable.map(|found| found.reference).ok_or_else(|| {
                        format!("reference run: found variable {name}, expected one of the model description")
                    })
                })
                .collect()
        };
        Ok(Self {
            inputs: references(&run.inputs.names)?,
            outputs: references(&run.outputs.names)?,
            run,
        })
    }

    pub(super) fn actions(&self) -> Vec<Action> {
        let get = || Action::Get {
            references: self.outputs.clone(),
        };
        let step_s = self.run.step_s;
        // a little late, so that rounding does not miss a step of the inputs
        let inputs = |index: usize| {
            let values = self.run.inputs.from((index as f64 + 0.25) * step_s);
            values.unwrap_or_default().to_vec()
        };
        let mut actions = vec![
            Action::Start {
                references: self.inputs.clone(),
                values: inputs(0),
            },
            get(),
        ];
        for index in 0..self.run.steps {
            actions.extend([
                Action::Set {
                    references: self.inputs.clone(),
                    values: inputs(index),
                },
                Action::Step {
                    time_s: index as f64 * step_s,
                    interval_s: step_s,
                    tentative: false,
                },
                get(),
            ]);
        }
        actions
    }

    /// What was met, in words, or what was not.
    pub(super) fn judge(&self, found: &[Vec<f64>]) -> Result<String, String> {
        let mut worst = 0.0_f64;
        for (column, name) in self.run.outputs.names.iter().enumerate() {
            let rows = &self.run.outputs.rows;
            let largest = rows.iter().fold(0.0_f64, |largest, (_, values)| {
                largest.max(values[column].abs())
            });
            for (time_s, values) in rows {
                let index = (time_s / self.run.step_s).round() as usize;
                let Some(value) = found.get(index).and_then(|values| values.get(column)) else {
                    return Err(format!(
                        "reference run: found outputs at t = {time_s:?} s, expected none after the stop time"
                    ));
                };
                let off = (value - values[column]).abs();
                // false for NaN
                let is_met = off <= self.run.tolerance * largest;
                if !is_met {
                    return Err(format!(
                        "reference run: found {name} = {value:?} at t = {time_s:?} s, expected {:?} within {:.1e}",
                        values[column],
                        self.run.tolerance * largest
                    ));
                }
                if largest > 0.0 {
                    worst = worst.max(off / largest);
                }
            }
        }
        Ok(format!(
            "reference run: met to {worst:.0e} of each output's largest magnitude, tolerance {:.0e}",
            self.run.tolerance
        ))
    }

    /// Communication points of the run.
    pub(super) fn points(&self) -> usize {
        self.run.steps + 1
    }
}
