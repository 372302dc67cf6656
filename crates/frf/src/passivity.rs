//! What a function of a drive point must be whatever the structure: a force and the motion that it causes take up energy.

use num_complex::Complex64;

/// A drive point whose imaginary parts are positive on balance, by this part of their sum, feeds energy instead of taking it up.
const ACTIVE: f64 = 0.5;

/// Whether the receptance of a drive point is that of a structure that feeds energy: Im H ≤ 0 where it dissipates, e^{jωt} taken.
/// Each line counts the same.
#[must_use]
pub fn feeds_energy(drive_point: &[Complex64]) -> bool {
    let parts = drive_point.iter().map(|h| h.im / h.norm());
    let parts: Vec<f64> = parts.filter(|part| part.is_finite()).collect();
    let sizes: f64 = parts.iter().map(|part| part.abs()).sum();
    parts.iter().sum::<f64>() > ACTIVE * sizes
}

/// Whether the phase rises through the resonances, as it does with e^{−jωt}, whatever the function's sign.
#[must_use]
pub fn turns_backwards(function: &[Complex64]) -> bool {
    // Im(H_{k+1} H_k*) < 0 where the phase falls
    let turns = function
        .windows(2)
        .map(|pair| (pair[1] * pair[0].conj()).im);
    turns.sum::<f64>() > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resonance(line: usize) -> Complex64 {
        let ratio = line as f64 / 50.0;
        Complex64::new(1.0 - ratio * ratio, 0.02 * ratio).inv()
    }

    #[test]
    fn a_drive_point_that_feeds_energy_is_told_from_one_that_takes_it_up() {
        let function: Vec<Complex64> = (1..100).map(resonance).collect();
        let of = |change: fn(&Complex64) -> Complex64| -> [bool; 2] {
            let function: Vec<Complex64> = function.iter().map(change).collect();
            [feeds_energy(&function), turns_backwards(&function)]
        };
        assert_eq!(of(|h| *h), [false, false]);
        assert_eq!(of(|h| -h), [true, false]);
        assert_eq!(of(|h| h.conj()), [true, true]);
    }
}
