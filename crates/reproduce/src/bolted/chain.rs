//! Tables 5.3 to 5.6 and 5.9: initial estimates, update, regeneration at points that were not used.

use crate::draws::{Repetition, rows};
use crate::error::ReproduceError;
use crate::outcome::{Row, Spread};
use bolted_joint_identify::{
    Amplitudes, JointMatrices, JointModel, Lines, TwoStep, update_in_two_steps,
};

use super::bolts::Bolt;
use super::structures::{self, joint};
use super::update;

impl Bolt {
    /// Initial estimates, update, regeneration at points that were not used.
    pub(crate) fn chain(&self, draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
        let truth = joint(self.updated);
        let lines = self.lines()?;
        let modes = structures::resonances_hz(&lines, &truth)?;
        let used = structures::measured_at(&lines, &self.used);
        let mut found = self.initial_estimates(&lines, &used, &modes, draws)?;
        let start = joint(self.initial);

        let once = |amplitudes| update_in_two_steps(&used, JointModel::Full, &start, amplitudes);
        let squares = once(Amplitudes::Squared)?;
        found.extend(self.updated_rows("updated on squares, no noise", &squares));
        found.extend(self.regenerated("squares, no noise", &lines, &[squares.joint])?);
        let logarithms = once(Amplitudes::Logarithmic)?;
        found.extend(self.updated_rows("updated on logarithms, no noise", &logarithms));
        let rested = update::until_rest(&used, &start)?;
        let case = "updated on logarithms, repeated, no noise";
        found.extend(self.updated_rows(case, &rested.last));
        let rounds = Spread::exact(rested.rounds as f64);
        found.push(Row::computed(case, "rounds", "1", Some(rounds)));
        // Where the published start does not lead to the joint, noise around another answer would tell nothing.
        let (case, start_with_noise) = if is_close(&rested.last.joint, &truth) {
            ("updated on logarithms, repeated, 1 % noise", start.clone())
        } else {
            (
                "updated on logarithms, repeated, 1 % noise, from 3 % off",
                JointMatrices {
                    stiffness: &truth.stiffness * 1.03,
                    damping: truth.damping.clone(),
                },
            )
        };
        let joints = update::with_noise(draws, &used, &start_with_noise)?;
        found.extend(rows(
            case,
            JointModel::Full,
            Some(&truth),
            &self.updated,
            &joints,
        ));
        found.extend(self.regenerated("logarithms, 1 % noise", &lines, &joints)?);

        found.push(first_resonance_share(&used, &modes));
        let of_start = structures::resonances_hz(&lines, &start)?;
        found.extend(Row::resonances(
            "resonances, initial estimates",
            &[],
            &of_start,
        ));
        found.extend(Row::resonances(
            "resonances, updated joint",
            &self.resonances_hz,
            &modes,
        ));
        Ok(found)
    }

    /// A joint that an update without noise found, and what of the sum it leaves.
    fn updated_rows(&self, case: &str, update: &TwoStep) -> Vec<Row> {
        let truth = joint(self.updated);
        let mut found = rows(
            case,
            JointModel::Full,
            Some(&truth),
            &self.updated,
            std::slice::from_ref(&update.joint),
        );
        let [_, _, left] = update.objective;
        found.push(Row::computed(
            case,
            "sum left",
            "1",
            Some(Spread::exact(left)),
        ));
        found
    }

    /// How far the receptances of the identified joints are from the true ones at the drive points.
    fn regenerated(
        &self,
        name: &str,
        lines: &Lines,
        found: &[JointMatrices],
    ) -> Result<Vec<Row>, ReproduceError> {
        let mut deviations = [const { Vec::new() }; 3];
        for joint in found {
            let of_joint = structures::deviations_percent(lines, joint)?;
            for (deviations, deviation) in deviations.iter_mut().zip(of_joint) {
                deviations.push(deviation);
            }
        }
        let case = format!("regenerated ({name}), r.m.s. deviation");
        let row = |(point, deviations): (usize, &Vec<f64>)| {
            let unused = if self.used.contains(&point) {
                ""
            } else {
                ", not used"
            };
            let quantity = format!("{}s{unused}", point + 1);
            Row::computed(&case, &quantity, "%", Spread::of(deviations))
        };
        Ok(deviations.iter().enumerate().map(row).collect())
    }
}

/// Whether the stiffnesses are the same to a thousandth.
fn is_close(found: &JointMatrices, exact: &JointMatrices) -> bool {
    let mut pairs = found.stiffness.iter().zip(&exact.stiffness);
    pairs.all(|(found, exact)| (found / exact - 1.0).abs() < 1e-3)
}

/// The part of Σ|H|⁴ that lies below the geometric mean of the first two resonances.
fn first_resonance_share(lines: &Lines, modes_hz: &[f64]) -> Row {
    let between_hz = match modes_hz {
        [first, second, ..] => (first * second).sqrt(),
        _ => f64::INFINITY,
    };
    let (mut first, mut all) = (0.0, 0.0);
    for (&hz, assembly) in lines.frequency_hz.iter().zip(&lines.assembly) {
        let sum: f64 = assembly.iter().map(|h| h.norm_sqr().powi(2)).sum();
        all += sum;
        if hz < between_hz {
            first += sum;
        }
    }
    let percent = Spread::exact(100.0 * first / all);
    Row::computed("part of Σ|H|⁴", "first resonance", "%", Some(percent))
}
