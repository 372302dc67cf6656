//! Whether damping that does not grow with the frequency would explain the functions better: a loss factor of the joint, as contact and
//! friction have it.
//!
//! A joint of viscous dampers C that is measured over many frequencies is then too weak at low ones and too strong at high ones, and
//! asks for a joint that feeds energy in a direction that hardly moves.

use crate::further::{Further, Score};

/// χ² by which a loss factor explains more than noise would.
const BEYOND: f64 = 36.0;

/// A loss factor that is larger is another error.
const MOST: f64 = 1.0;

/// Whether a loss factor of the joint explains more than noise does.
pub(crate) fn is_lossy(scores: &[(Further, Score)]) -> bool {
    loss(scores).is_some()
}

fn loss(scores: &[(Further, Score)]) -> Option<&Score> {
    let mut own = scores.iter().filter(|(one, _)| *one == Further::LossFactor);
    let (_, score) = own.next()?;
    Some(score).filter(|own| own.gain > BEYOND && (0.0..MOST).contains(&own.value))
}

/// What it would be, in a sentence.
pub(crate) fn warning(scores: &[(Further, Score)]) -> Option<String> {
    let Score {
        value,
        deviation,
        gain,
        ..
    } = loss(scores)?;
    Some(format!(
        "damping of the joint that does not grow with the frequency would fit better: with a loss factor of about {value:.4} ± \
         {deviation:.1e} χ² falls by {gain:.0}; C stands for such damping near one frequency alone, so identify it over a narrow range \
         ([frequency] from, to)"
    ))
}
