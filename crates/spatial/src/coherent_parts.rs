//! Noise of substructures whose functions have coherence: it takes the place of what the study states of them, and needs a level of
//! the assembly's noise beside it, since residuals are then of all noise.

use crate::part_noise::{PartNoise, of_assembly, percent};
use crate::problem::Level;
use crate::study::SpatialStudy;

impl SpatialStudy {
    /// With noise that the coherence of substructures tells, of those that have any, in place of what is `stated`.
    pub(crate) fn with_noise_by_coherence(
        mut self,
        have: &[bool],
        stated: [Option<f64>; 2],
    ) -> Self {
        let names = ["a", "b"];
        for (n, name) in names.into_iter().enumerate() {
            if !have.get(n).is_some_and(|has| *has) {
                continue;
            }
            let Some(noise) = PartNoise::of_coherence(&self.problem.sides[n]) else {
                self.assumed.push(format!(
                    "{name}: some of its functions have coherence, and that is not used: it takes the place of noise.{name} where all of \
                     them have it"
                ));
                continue;
            };
            if stated[n].is_some() {
                self.assumed.push(format!(
                    "noise.{name} is not used: the coherence of {name} tells the noise of its functions"
                ));
            }
            self.noise[n] = noise;
        }
        if self.has_noise() && !self.level.is_known() {
            // beside that of the substructures the assembly's is not told by what is left
            match of_assembly(&self.problem).filter(|shown| shown.is_noise) {
                Some(shown) => {
                    self.level = Level::Relative(shown.typical);
                    self.assumed.push(format!(
                        "the assembly's functions show noise of {} of each one's r.m.s. from line to line, which stands beside the noise \
                         that coherence tells of the substructures; noise.relative states another one",
                        percent(shown.typical)
                    ));
                }
                None => {
                    self.noise = [PartNoise::NONE, PartNoise::NONE];
                    self.problem
                        .sides
                        .iter_mut()
                        .for_each(|side| side.noise.clear());
                    self.assumed.push(
                        "coherence of the substructures is not used, since nothing tells the noise of the assembly's functions: state \
                         noise.relative, or coherence of the assembly"
                            .to_owned(),
                    );
                }
            }
        }
        self
    }
}
