//! Sizes that no bolted joint has: numbers that nothing contradicts, and that are most likely in another unit than their column.

use std::f64::consts::TAU;

use super::backbone::BackboneRun;
use super::data::{SineRun, Use};
use super::model::ResponseUnknown;
use super::result::LapResponse;
use super::slip::GRAVITY;
use super::study::LapResponseStudy;

/// Amplitude of an acceleration, in g, that no test of a joint reaches.
const MOST_G: f64 = 1000.0;
/// Displacement of a joint, m, and the frequency, Hz, from which on it is too large.
const MOST_M: f64 = 0.01;
const FROM_HZ: f64 = 20.0;
/// Resonance of the relative motion, Hz, below which nothing bolted is.
const LEAST_HZ: f64 = 1.0;
/// Masses of bodies that are bolted, kg, and the stiffness, N/m, below which so light ones are none.
const MASSES_KG: std::ops::Range<f64> = 0.01..1e5;
const LEAST_N_PER_M: f64 = 1e4;

/// One amplitude of a run: m, and rad/s.
type Amplitude = (f64, f64);

/// What is too large or too slow in the data themselves.
pub(super) fn of_data(study: &LapResponseStudy) -> Vec<String> {
    let sines = study.sines.iter().map(|run| {
        let lines = run.lines.iter();
        let amplitudes: Vec<Amplitude> = lines
            .map(|line| (line.displacement_m, line.omega))
            .collect();
        (&run.name, amplitudes)
    });
    let curves = study.backbones.iter().map(|run| {
        let points = run.lines.iter();
        let amplitudes: Vec<Amplitude> = points
            .map(|point| (point.amplitude_m, point.omega))
            .collect();
        (&run.name, amplitudes)
    });
    let large = sines
        .chain(curves)
        .filter_map(|(name, amplitudes)| Some(format!("{name}: {}", too_large(&amplitudes)?)));
    large.chain(too_slow(&study.backbones)).collect()
}

fn too_large(amplitudes: &[Amplitude]) -> Option<String> {
    let in_g = |&(amplitude_m, omega): &Amplitude| amplitude_m * omega * omega / GRAVITY;
    let most = amplitudes
        .iter()
        .max_by(|one, other| in_g(one).total_cmp(&in_g(other)))?;
    let hz = |omega: f64| omega / TAU;
    if in_g(most) > MOST_G {
        return Some(format!(
            "an amplitude of {:.2e} m at {:.1} Hz is {:.0} g, and no test of a joint has more than {MOST_G} g: is the response in mm, \
             µm or g, or the time in ms?",
            most.0,
            hz(most.1),
            in_g(most)
        ));
    }
    let fast = amplitudes.iter().filter(|(_, omega)| hz(*omega) > FROM_HZ);
    let (amplitude_m, omega) = fast.max_by(|one, other| one.0.total_cmp(&other.0))?;
    (*amplitude_m > MOST_M).then(|| {
        format!(
            "an amplitude of {:.0} mm at {:.1} Hz is more than the {:.0} mm that a bolted joint moves at most: is the response in mm?",
            1e3 * amplitude_m,
            hz(*omega),
            1e3 * MOST_M
        )
    })
}

/// Curves and decays that resonate too low.
fn too_slow(curves: &[BackboneRun]) -> Vec<String> {
    let told = curves.iter().filter_map(|run| {
        let lowest = run.lines.iter().map(|point| point.omega / TAU);
        let hz = lowest.reduce(f64::min).filter(|hz| *hz < LEAST_HZ)?;
        let unit = match run.recorded.is_some() {
            true => "the time in ms, or the number of the sample?",
            false => "the frequency in kHz?",
        };
        Some(format!(
            "{}: {}, and no bolted joint is that soft: is {unit}",
            run.name,
            resonance(hz)
        ))
    });
    told.collect()
}

fn resonance(hz: f64) -> String {
    format!("a resonance at {hz:.2e} Hz is below {LEAST_HZ} Hz")
}

impl LapResponse {
    /// What is too small or too large in what was identified.
    pub(super) fn of_sizes(&self, study: &LapResponseStudy) -> Vec<String> {
        let mut told = Vec::new();
        let values = &self.fit.values;
        let is_fitted = |run: &SineRun| run.used_for == Use::Fit;
        let hz = (2.0 * values.relative_stiffness() / values.mass).sqrt() / TAU;
        if study.sines.iter().any(is_fitted) && hz < LEAST_HZ {
            told.push(format!(
                "{}, and no bolted joint is that soft: is the frequency in kHz?",
                resonance(hz)
            ));
        }
        let mut estimates = self.estimates.iter();
        let mass = estimates.find(|own| own.unknown == ResponseUnknown::Mass);
        let Some(mass) = mass.filter(|own| own.is_identified) else {
            return told;
        };
        let stiffness = values.relative_stiffness();
        if mass.value < MASSES_KG.start && stiffness < LEAST_N_PER_M {
            told.push(format!(
                "m = {:.2e} kg beside a stiffness of {stiffness:.2e} N/m, and nothing bolted is both so light and so soft: are the \
                 forces in kN, or the responses in mm?",
                mass.value
            ));
        }
        if mass.value > MASSES_KG.end {
            told.push(format!(
                "m = {:.2e} kg, and bodies that are bolted have {:.0e} kg at most: are the forces in mN?",
                mass.value, MASSES_KG.end
            ));
        }
        told
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ω²x/g, at 93 Hz: 0.1 m are 3482 g; 3e-4 m at 100 Hz are 12 g.
    #[test]
    fn what_no_joint_does_is_told_and_what_joints_do_is_not() {
        let omega = |hz: f64| TAU * hz;
        let told = too_large(&[(1e-4, omega(112.0)), (0.1, omega(93.0))]).unwrap();
        assert!(told.contains("at 93.0 Hz is 3482 g"), "{told}");
        let told = too_large(&[(0.015, omega(30.0))]).unwrap();
        assert!(told.contains("15 mm at 30.0 Hz"), "{told}");
        for good in [
            (3e-4, omega(100.0)),
            // an isolator
            (0.03, omega(5.0)),
            // a pendulum's shock
            (1e-4, omega(1500.0)),
        ] {
            assert_eq!(too_large(&[good]), None);
        }
    }
}
