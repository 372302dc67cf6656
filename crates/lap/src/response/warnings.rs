//! What the reader of a lap model identified from responses should know before using it.

use super::result::LapResponse;
use super::study::LapResponseStudy;

/// χ² per degree of freedom from which on a stated noise does not explain the residual.
const TOO_LARGE: f64 = 1.5;
/// The same where no noise was stated, so that a nominal one is compared with: three times its deviations.
const FAR_TOO_LARGE: f64 = 9.0;
/// χ² per degree of freedom below which a stated noise is more than there is.
const TOO_SMALL: f64 = 0.3;
/// Difference of Schwarz's criterion that is strong evidence.
const STRONG: f64 = 10.0;
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
        let reduced = self.fit.chi_squared / self.fit.degrees_of_freedom.max(1) as f64;
        if study.noise.is_stated && reduced > TOO_LARGE {
            warnings.push(format!(
                "the residual is more than the stated noise: χ² per degree of freedom {reduced:.3}; all standard deviations were raised"
            ));
        }
        if !study.noise.is_stated && reduced > FAR_TOO_LARGE {
            warnings.push(format!(
                "the residual is {:.1} times the noise that is taken where none is stated: χ² per degree of freedom {reduced:.3}; all \
                 standard deviations were raised, but they hold only if the residual is noise: state [noise], or look at the residual for \
                 what the model leaves out",
                reduced.sqrt()
            ));
        }
        if study.noise.is_stated && reduced < TOO_SMALL {
            warnings.push(format!(
                "the residual is much less than the stated noise: χ² per degree of freedom {reduced:.3}; the standard deviations are \
                 those of the stated noise"
            ));
        }
        let is_of_one = self.fit.values.slider.is_none();
        if is_of_one && self.model.harmonics < study.harmonics && !study.sines.is_empty() {
            warnings.push(format!(
                "the estimate is that of one harmonic: with {} harmonics it did not converge",
                study.harmonics
            ));
        }
        for (name, value) in [
            ("k", self.fit.values.support_stiffness),
            ("c", self.fit.values.support_damping),
        ] {
            if value < 0.0 {
                warnings.push(format!(
                    "{name} of the supports came out as {value:.3e}, which no passive support has; the joint file holds zero"
                ));
            }
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
            let why_not = match best.is_passive {
                true => "",
                false => {
                    ", but that joint would feed energy within the amplitudes that were fitted"
                }
            };
            warnings.push(format!(
                "the terms \"{}\" explain the data better than \"{}\": BIC {:.1} lower{why_not}",
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
}
