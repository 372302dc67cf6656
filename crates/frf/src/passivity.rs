//! What a function of a drive point must be whatever the structure: a force and the motion that it causes take up energy.
//!
//! The phase of a structure that hardly dissipates is noise but at its resonances, so that only lines count at which it is more.

use bolted_joint_statistics::upper_median;
use num_complex::Complex64;

/// A drive point whose imaginary parts are positive on balance, by this part of their sum, feeds energy instead of taking it up.
const ACTIVE: f64 = 0.5;
/// Standard deviations that noise reaches at one of two million lines.
const BEYOND_NOISE: f64 = 5.0;
/// Lines that noise may have made by chance.
const FEWEST: usize = 2;
/// Fewer lines do not tell their noise, which then is at least this part of each value.
const ENOUGH_FOR_NOISE: usize = 10;
const USUAL_NOISE: f64 = 0.02;
/// The part of the lines, those of the smallest values, at which noise that does not follow the values shows.
const SMALLEST: f64 = 0.25;

/// Why functions tell nothing by their phases, if none of them has any: an energy that a drive point takes up, or a damping.
#[must_use]
pub fn without_phase<'a>(
    functions: impl IntoIterator<Item = &'a [Complex64]>,
) -> Option<&'static str> {
    let (mut count, mut first) = (0, None);
    let (mut are_real, mut are_behind, mut have_one_sign) = (true, true, true);
    for h in functions.into_iter().flatten().filter(|h| h.norm() > 0.0) {
        count += 1;
        are_real &= h.im == 0.0;
        // magnitudes of mobilities are receptances along −j
        are_behind &= h.re == 0.0 && h.im < 0.0;
        have_one_sign &= h.re * *first.get_or_insert(h.re) >= 0.0;
        if !are_real && !are_behind {
            return None;
        }
    }
    if count < FEWEST {
        return None;
    }
    Some(match have_one_sign {
        true => {
            "no function has an imaginary part as measured, and all have one sign: magnitudes alone? Save complex numbers, or phases \
             beside the magnitudes: nothing tells damping or the energy that drive points take"
        }
        false => {
            "no function has an imaginary part: real parts alone, or a model without damping? Save complex numbers: nothing tells \
             damping or the energy that drive points take"
        }
    })
}

/// Which lines of a function are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// All, also those at which the phase of this function is noise: where many functions decide together.
    Every,
    /// Those at which it is more.
    BeyondNoise,
}

/// Whether the receptance of a drive point is that of a structure that feeds energy: Im H ≤ 0 where it dissipates, e^{jωt} taken.
/// Each line that is asked counts the same.
#[must_use]
pub fn feeds_energy(drive_point: &[Complex64], asked: Asked) -> bool {
    let lines: Vec<bool> = match asked {
        Asked::Every => drive_point.iter().map(|h| h.norm() > 0.0).collect(),
        Asked::BeyondNoise => beyond_noise(drive_point),
    };
    let lines = drive_point.iter().zip(lines);
    let parts: Vec<f64> = lines
        .filter(|(_, is_asked)| *is_asked)
        .map(|(h, _)| h.im / h.norm())
        .collect();
    let sizes: f64 = parts.iter().map(|part| part.abs()).sum();
    parts.len() >= FEWEST && parts.iter().sum::<f64>() > ACTIVE * sizes
}

/// The lines at which the imaginary part of a function is more than its noise.
#[must_use]
pub fn beyond_noise(function: &[Complex64]) -> Vec<bool> {
    let noise = Noise::of(function);
    let is_beyond = |h: &Complex64| h.im.abs() > BEYOND_NOISE * noise.of_a_part(h.norm());
    function.iter().map(is_beyond).collect()
}

/// Whether the phase rises through the resonances, as it does with e^{−jωt}, whatever the function's sign.
#[must_use]
pub fn turns_backwards(function: &[Complex64], asked: Asked) -> bool {
    let noise = match asked {
        Asked::Every => Noise::NONE,
        Asked::BeyondNoise => Noise::of(function),
    };
    // Im(H_{k+1} H_k*) < 0 where the phase falls
    let turns = function.windows(2).map(|pair| {
        let turn = (pair[1] * pair[0].conj()).im;
        let [one, other] = [pair[0].norm(), pair[1].norm()];
        let error = (other * noise.of_a_part(one)).hypot(one * noise.of_a_part(other));
        if turn.abs() > BEYOND_NOISE * error {
            turn
        } else {
            0.0
        }
    });
    turns.sum::<f64>() > 0.0
}

/// Noise of a function by itself: σ² = (relative·|H|)² + floor².
struct Noise {
    relative: f64,
    floor: f64,
}

impl Noise {
    const NONE: Self = Self {
        relative: 0.0,
        floor: 0.0,
    };

    /// As second differences show it, which are small where H is smooth. They have the variance (1 + 4 + 1) σ²; the median of a
    /// squared modulus is ln 2 of its mean.
    fn of(function: &[Complex64]) -> Self {
        let all = function.windows(3).filter_map(|of| {
            let difference = of[0] - of[1] * 2.0 + of[2];
            let deviation = difference.norm() / (6.0 * std::f64::consts::LN_2).sqrt();
            let size = of[1].norm();
            (size > 0.0 && deviation.is_finite()).then_some([size, deviation])
        });
        let mut all: Vec<[f64; 2]> = all.collect();
        all.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let relative = median_or_zero(all.iter().map(|[size, deviation]| deviation / size));
        let smallest = (SMALLEST * all.len() as f64) as usize;
        let floor = median_or_zero(all[..smallest].iter().map(|[_, deviation]| *deviation));
        let least = match all.len() < ENOUGH_FOR_NOISE {
            true => USUAL_NOISE,
            false => 0.0,
        };
        Self {
            relative: relative.max(least),
            floor,
        }
    }

    /// σ/√2 of a value of this size: that of its real and of its imaginary part.
    fn of_a_part(&self, size: f64) -> f64 {
        (self.relative * size).hypot(self.floor) * std::f64::consts::FRAC_1_SQRT_2
    }
}

fn median_or_zero(values: impl Iterator<Item = f64>) -> f64 {
    upper_median(values).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frf, FrfSet, polluted};

    fn resonance(line: usize) -> Complex64 {
        let ratio = line as f64 / 50.0;
        Complex64::new(1.0 - ratio * ratio, 0.02 * ratio).inv()
    }

    #[test]
    fn functions_without_any_phase_are_told() {
        let function: Vec<Complex64> = (1..100).map(resonance).collect();
        let of = |change: fn(f64, Complex64) -> Complex64| {
            let own: Vec<Complex64> = (1..)
                .zip(&function)
                .map(|(line, h)| change(f64::from(line), *h))
                .collect();
            without_phase([own.as_slice(), own.as_slice()])
        };
        let is = |found: Option<&str>, word: &str| found.is_some_and(|found| found.contains(word));
        assert_eq!(of(|_, h| h), None);
        assert_eq!(of(|_, h| -h), None);
        assert!(is(of(|_, h| h.norm().into()), "magnitudes alone?"));
        // as Quantity::to_receptance makes it of magnitudes of mobilities and of accelerances
        assert!(is(
            of(|line, h| h.norm() / Complex64::new(0.0, line)),
            "magnitudes alone?"
        ));
        assert!(is(
            of(|line, h| (-h.norm() / line).into()),
            "magnitudes alone?"
        ));
        assert!(is(of(|_, h| h.re.into()), "real parts alone"));
        assert_eq!(without_phase([]), None);
        assert_eq!(without_phase([[Complex64::new(1.0, 0.0)].as_slice()]), None);
        let one_has = [
            [Complex64::new(1.0, 0.0); 3],
            [Complex64::new(1.0, -0.1); 3],
        ];
        assert_eq!(
            without_phase(one_has.iter().map(|own| own.as_slice())),
            None
        );
    }

    fn both(function: &[Complex64]) -> [bool; 2] {
        [
            feeds_energy(function, Asked::BeyondNoise),
            turns_backwards(function, Asked::BeyondNoise),
        ]
    }

    #[test]
    fn a_drive_point_that_feeds_energy_is_told_from_one_that_takes_it_up() {
        let function: Vec<Complex64> = (1..100).map(resonance).collect();
        let of = |change: fn(&Complex64) -> Complex64| -> [bool; 2] {
            both(&function.iter().map(change).collect::<Vec<_>>())
        };
        assert_eq!(of(|h| *h), [false, false]);
        assert_eq!(of(|h| -h), [true, false]);
        assert_eq!(of(|h| h.conj()), [true, true]);
    }

    /// A free body that bends: −1/mω² and a mode of 0.1 % damping, noise of 1 % on every value.
    fn free(
        seed: u64,
        lines: std::ops::Range<i32>,
        change: fn(Complex64) -> Complex64,
    ) -> Vec<Complex64> {
        let hz: Vec<f64> = lines.map(|line| 10.0 * f64::from(line)).collect();
        let own = hz.iter().map(|hz| {
            let mode = Complex64::new(1234.0 * 1234.0 - hz * hz, 0.002 * 1234.0 * hz);
            change(2.0 * mode.inv() - (hz * hz).recip())
        });
        let dof = "1:+Y".parse().unwrap();
        let frf = Frf::new(dof, dof, hz.clone(), own.collect()).unwrap();
        let noisy = polluted(&FrfSet::new(vec![frf]).unwrap(), 0.01, seed).unwrap();
        noisy.receptance(dof, dof).unwrap().values().to_vec()
    }

    #[test]
    fn noise_on_large_values_of_a_free_body_is_no_energy() {
        for seed in 0..50 {
            for lines in [4..300, 4..7] {
                let own = free(seed, lines, |h| h);
                assert!(
                    !feeds_energy(&own, Asked::BeyondNoise),
                    "{seed} {}",
                    own.len()
                );
            }
            let turned = both(&free(seed, 4..300, |h| -h));
            assert_eq!(turned, [true, false], "{seed}");
            let conjugated = both(&free(seed, 4..300, |h| h.conj()));
            assert_eq!(conjugated, [true, true], "{seed}");
        }
    }
}
