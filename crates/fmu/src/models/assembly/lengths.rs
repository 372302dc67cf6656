//! What steps of the lengths need that came last: preparing a length takes far longer than a step.
//!
//! Importers that subtract times give lengths that differ in their last digits. So lengths are prepared with nine digits, and what
//! is left over is a first-order step of its own: its error is the square of at most 5·10⁻⁹ of a step. A length that has no more
//! digits leaves nothing over.
//!
//! What is propagated exactly has the stiffness and damping of one preload of each joint over the preload. A step takes that at
//! which the joint has stayed for some steps; while the preload moves, the nearest one of the table, of which there are few.

use bolted_joint_dynamics::assembly::{AssemblySteps, TOLERANCE};

use super::places::Place;
use crate::{models::Step, refusal::Refusal};

/// So many lengths are kept: that of the steps, and a few of what is left over where they end or where events are.
const KEPT: usize = 4;

/// Lengths that are prepared, the latest one last.
#[derive(Debug, Default)]
pub(super) struct Lengths {
    prepared: Vec<Prepared>,
    /// The latest length, and that with nine digits, s.
    latest_s: [f64; 2],
}

/// One length.
#[derive(Debug)]
struct Prepared {
    steps: AssemblySteps,
    /// The preloads about which it is, N·m.
    about_n_m: Vec<f64>,
}

impl Lengths {
    /// What this step needs in this place; its length may be another by the last digits.
    pub(super) fn of(&mut self, place: &Place, step: Step) -> Result<&mut AssemblySteps, Refusal> {
        let [latest_s, mut rounded_s] = self.latest_s;
        if latest_s != step.interval_s {
            rounded_s = with_nine_digits(step.interval_s);
            self.latest_s = [step.interval_s, rounded_s];
        }
        let mut known = self.prepared.iter();
        let is_it =
            |own: &Prepared| own.steps.length_s() == rounded_s && own.about_n_m == place.about_n_m;
        match known.position(is_it) {
            Some(place) if place + 1 == self.prepared.len() => {}
            Some(place) => {
                let own = self.prepared.remove(place);
                self.prepared.push(own);
            }
            None => {
                let steps = AssemblySteps::within(&place.coordinates, rounded_s, TOLERANCE);
                let steps = steps.ok_or(Refusal::GrowsWithinStep {
                    interval_s: step.interval_s,
                    time_s: step.time_s,
                })?;
                if self.prepared.len() == KEPT {
                    self.prepared.remove(0);
                }
                let about_n_m = place.about_n_m.clone();
                self.prepared.push(Prepared { steps, about_n_m });
            }
        }
        let latest = self.prepared.last_mut().ok_or(Refusal::Internal)?;
        Ok(&mut latest.steps)
    }
}

/// The nearest number of nine decimal digits.
fn with_nine_digits(number: f64) -> f64 {
    let rounded = format!("{number:.8e}").parse::<f64>();
    // the largest numbers round up to infinity
    rounded
        .ok()
        .filter(|rounded| rounded.is_finite() && *rounded > 0.0)
        .unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::with_nine_digits;

    #[test]
    fn decimal_lengths_stay_what_they_are() {
        for length_s in [1e-5, 2.5e-6, 1e-3, 0.000_123_456_789, 5e-324, f64::MAX] {
            let rounded = with_nine_digits(length_s);
            assert!((rounded / length_s - 1.0).abs() < 5e-9, "{length_s}");
            assert!(rounded == length_s || length_s == f64::MAX);
        }
        // as importers come by a step of 1e-5 s after a second
        assert_eq!(with_nine_digits((1.0 + 1e-5) - 1.0), 1e-5);
    }
}
