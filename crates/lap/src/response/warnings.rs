//! What the reader of a lap model identified from responses should know before using it.

use super::result::LapResponse;
use super::study::{LapResponseStudy, NoiseIs};

/// χ² per degree of freedom from which on a stated noise does not explain the residual.
const TOO_LARGE: f64 = 1.5;
/// The same where no noise was stated, so that a nominal one is compared with: three times its deviations.
const FAR_TOO_LARGE: f64 = 9.0;
/// χ² per degree of freedom below which a stated noise is more than there is.
const TOO_SMALL: f64 = 0.3;
/// Difference of Schwarz's criterion that is strong evidence.
const STRONG: f64 = 10.0;
/// By how much −2 ln L of the passive estimate may be above the free one's by chance: five standard deviations.
const CHANCE: f64 = 25.0;
/// Errors of the resonance of a run left out that are worth a word: frequency in Hz, relative amplitude.
const FREQUENCY_HZ: f64 = 0.1;
const AMPLITUDE: f64 = 0.1;

impl LapResponse {
    /// The warnings.
    #[must_use]
    pub fn warnings(&self, study: &LapResponseStudy) -> Vec<String> {
        let mut warnings = Vec::new();
        let open = self.not_identified();
        if !open.is_empty() {
            warnings.push(format!(
                "{} cannot be identified from these data",
                open.join(", ")
            ));
        }
        warnings.extend(self.of_price());
        warnings.extend(self.of_residual(study));
        let is_of_one = self.fit.values.slider.is_none();
        if is_of_one && self.model.harmonics < study.harmonics && !study.sines.is_empty() {
            warnings.push(format!(
                "the estimate is that of one harmonic: with {} harmonics it did not converge",
                study.harmonics
            ));
        }
        let own = self
            .comparison
            .iter()
            .find(|model| model.terms == self.model.terms);
        let best = self
            .comparison
            .iter()
            .find(|model| model.bic_difference == 0.0);
        if let (Some(own), Some(best)) = (own, best)
            && own.bic_difference > STRONG
        {
            warnings.push(format!(
                "the terms \"{}\" explain the data better than \"{}\": BIC {:.1} lower",
                best.terms, own.terms, own.bic_difference
            ));
        }
        for row in self.predictions.iter().filter(|row| row.left_out) {
            let missed_frequency = row
                .frequency_error_hz()
                .is_none_or(|error| error.abs() > FREQUENCY_HZ);
            let missed_amplitude = row
                .amplitude_error()
                .is_none_or(|error| error.abs() > AMPLITUDE);
            if missed_frequency || missed_amplitude {
                warnings.push(format!(
                    "the resonance of {}, which was left out, is missed by more than {FREQUENCY_HZ} Hz or {} %",
                    row.run,
                    100.0 * AMPLITUDE
                ));
            }
        }
        for row in self.backbones.iter().filter(|row| row.left_out) {
            let missed_damping = row.damping_error.is_some_and(|error| error > AMPLITUDE);
            if row.frequency_error_hz > FREQUENCY_HZ || missed_damping {
                warnings.push(format!(
                    "{}, which was left out, is missed by more than {FREQUENCY_HZ} Hz or {} % of its damping",
                    row.run,
                    100.0 * AMPLITUDE
                ));
            }
        }
        warnings
    }

    /// What it costs that the joint is passive.
    fn of_price(&self) -> Option<String> {
        let free = self.free.as_ref()?;
        let limits: Vec<String> = self
            .fit
            .at_limits
            .iter()
            .map(|at| at.limit.to_string())
            .collect();
        let cause = match self.price > CHANCE {
            true => {
                ", far more than noise explains: the data themselves feed energy; look at the phase and its sign, at what else \
                 drives the structure, and at what the model leaves out"
            }
            false => "",
        };
        Some(format!(
            "the free estimate would feed energy; the joint is the passive one that fits best, which holds {} at zero: χ² per \
             degree of freedom {:.4} in place of {:.4}, −2 ln L higher by {:.1}{cause}",
            limits.join(" and "),
            self.fit.reduced_chi_squared(),
            free.reduced_chi_squared(),
            self.price
        ))
    }

    /// Whether the residual is what the noise should leave; a joint that has to be passive may leave more.
    fn of_residual(&self, study: &LapResponseStudy) -> Option<String> {
        let reduced = self
            .free
            .as_ref()
            .unwrap_or(&self.fit)
            .reduced_chi_squared();
        let times = reduced.sqrt();
        match study.noise_is() {
            NoiseIs::Stated if reduced > TOO_LARGE => Some(format!(
                "the residual is more than the stated noise: χ² per degree of freedom {reduced:.3}; all standard deviations were raised"
            )),
            NoiseIs::Stated if reduced < TOO_SMALL => Some(format!(
                "the residual is much less than the stated noise: χ² per degree of freedom {reduced:.3}; the standard deviations are \
                 those of the stated noise"
            )),
            NoiseIs::OfRecords if reduced > TOO_LARGE => Some(format!(
                "the residual is {times:.1} times what the noise of the decays' records explains: χ² per degree of freedom \
                 {reduced:.3}; all standard deviations were raised, but they hold only if the residual is noise: look at what the model \
                 leaves out"
            )),
            NoiseIs::Nominal if reduced > FAR_TOO_LARGE => Some(format!(
                "the residual is {times:.1} times the noise that is taken where none is stated: χ² per degree of freedom {reduced:.3}; \
                 all standard deviations were raised, but they hold only if the residual is noise: state [noise], or look at the \
                 residual for what the model leaves out"
            )),
            _ => None,
        }
    }
}
