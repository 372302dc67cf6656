//! Tables 5.3 to 5.6 and 5.9: initial estimates, update, regeneration at points that were not used.

use crate::identify::{Amplitudes, JointMatrices, JointModel, Lines, update_in_two_steps};
use crate::reproduce::draws::{Draws, polluted, rows};
use crate::reproduce::error::ReproduceError;
use crate::reproduce::outcome::{Reproduction, Row, Spread};
use crate::respond::{Generator, Pollution};

use super::bolts::{self, Bolt, LEVEL};
use super::frequency_row;
use super::structures::{self, joint};

pub(in crate::reproduce) fn m10x16_chain(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    let mut found = bolts::m10x16().chain(draws)?;
    found.not_given.push(
        "the measured modes 112.5 and 344 Hz of Table 5.2 are not those of the synthesised assembly; see table 5.2".to_owned(),
    );
    Ok(found)
}

pub(in crate::reproduce) fn m8x16_chain(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    let mut found = bolts::m8x16().chain(draws)?;
    found.differences.push(
        "The published damping matrix (c_Fθ = 1.20 beside c_Mθ = 0) is indefinite: this joint is active."
            .to_owned(),
    );
    Ok(found)
}

pub(in crate::reproduce) fn m10x35_chain(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    bolts::m10x35().chain(draws)
}

pub(in crate::reproduce) fn m8x35_chain(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    bolts::m8x35().chain(draws)
}

pub(in crate::reproduce) fn m6x30_chain(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    bolts::m6x30().chain(draws)
}

impl Bolt {
    /// Initial estimates, update, regeneration at points that were not used.
    fn chain(&self, draws: &Draws) -> Result<Reproduction, ReproduceError> {
        let truth = joint(self.updated);
        let lines = self.lines()?;
        let modes = structures::resonances_hz(&lines, &truth)?;
        let used = structures::measured_at(&lines, self.used);
        let mut found = self.initial_estimates(&lines, &used, &modes, draws)?;
        let start = joint(self.initial);
        let noise = Pollution::Frf { level: LEVEL }.checked()?;
        let noisy = |generator: &mut Generator| Lines {
            assembly: polluted(&used.assembly, &noise, generator),
            ..used.clone()
        };
        for (name, amplitudes) in [
            ("squares", Amplitudes::Squared),
            ("logarithms", Amplitudes::Logarithmic),
        ] {
            let exact = [update_in_two_steps(
                &used,
                JointModel::Full,
                &start,
                amplitudes,
            )?];
            let joints = exact.each_ref().map(|update| update.joint.clone());
            let case = format!("updated on {name}, no noise");
            let mut own = rows(
                &case,
                JointModel::Full,
                Some(&truth),
                &self.updated,
                &joints,
            );
            own.push(Row {
                case,
                quantity: "sum left".to_owned(),
                unit: "1",
                truth: None,
                published: None,
                obtained: Some(Spread::exact(exact[0].objective[2])),
            });
            found.extend(own);
            let updated = draws.joints(|generator| {
                let noisy = noisy(generator);
                let update = update_in_two_steps(&noisy, JointModel::Full, &start, amplitudes);
                Some(update.ok()?.joint)
            });
            let case = format!("updated on {name}, 1 % noise");
            found.extend(rows(
                &case,
                JointModel::Full,
                Some(&truth),
                &self.updated,
                &updated,
            ));
            found.extend(self.regenerated(name, &lines, &updated)?);
        }
        for (index, &hz) in modes.iter().enumerate() {
            let published = self
                .resonances_hz
                .iter()
                .find(|(number, _)| *number == index + 1);
            found.push(frequency_row(
                "coupled resonances",
                index,
                published.map(|p| p.1),
                hz,
            ));
        }
        Ok(Reproduction {
            table: self.table,
            conditions: vec![
                "A: modes of Appendix A without residuals, central difference; B: computed with every mode; assembly: synthesised from the published updated joint (\"true\")".to_owned(),
                "initial estimates at the third mode, k_thetatheta and c_thetatheta at the second; update from the published initial estimates".to_owned(),
                format!("FRF pollution {} %; lines {} Hz apart up to 512 Hz", 100.0 * LEVEL, 0.25),
            ],
            rows: found,
            differences: vec![
                "Initial estimates: near a resonance one point, or three with noise, tell one number of the joint; the published ones are this rank-one answer, not the joint.".to_owned(),
                "Update: the sum of squared amplitudes is ruled by the first resonance; from the published initial estimates it comes to rest at another joint that leaves next to nothing of the sum, even with exact data. MATLAB's own path to the published joint cannot be told. The same steps on logarithms are beside it.".to_owned(),
            ],
            not_given: vec![
                "the measured receptances of the assembly, and their noise".to_owned(),
                "residuals between points 1 to 3: Appendix A has those of one load only, and a difference between points would take them for rotation".to_owned(),
            ],
        })
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
            let assembly = lines.regenerated(joint)?;
            for (point, deviations) in deviations.iter_mut().enumerate() {
                let place = (point, point);
                deviations.push(
                    100.0
                        * structures::relative_rms(
                            &structures::function(&assembly, place),
                            &structures::function(&lines.assembly, place),
                        ),
                );
            }
        }
        Ok(deviations
            .iter()
            .enumerate()
            .map(|(point, deviations)| Row {
                case: format!("regenerated ({name}), r.m.s. deviation"),
                quantity: if self.used.contains(&point) {
                    format!("{}s", point + 1)
                } else {
                    format!("{}s, not used", point + 1)
                },
                unit: "%",
                truth: None,
                published: None,
                obtained: Spread::of(deviations),
            })
            .collect())
    }
}
