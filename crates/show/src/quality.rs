//! What measured functions must be, whatever the structure: passive at a drive point, reciprocal between two points.

use bolted_joint_frf::{Asked, Dof, FrfSet, Sign, beyond_noise, turns_backwards};
use num_complex::Complex64;

/// How a function behaves whose load and response are in one place and direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivePoint {
    /// Where.
    pub dof: Dof,
    /// Σ over lines with Im H > 0 of |Im H|, over that of all lines where Im H is more than noise: a structure that takes energy has
    /// none, e^{jωt} taken.
    pub active_share: f64,
    /// Whether the phase rises through the resonances, as it does with e^{−jωt}.
    pub turns_backwards: bool,
}

/// How far two functions are from being each other's transposes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reciprocity {
    /// The two degrees of freedom.
    pub between: [Dof; 2],
    /// Half of the lines differ by less than this part of their mean magnitude.
    pub median: f64,
    /// The largest difference over the lines, in the same measure, and its frequency, Hz.
    pub worst: (f64, f64),
    /// Whether one has the other's sign turned.
    pub is_opposite: bool,
}

/// The functions with both degrees of freedom along their axes, as they would be then.
fn along_axes(set: &FrfSet) -> impl Iterator<Item = ([Dof; 2], f64, &[Complex64])> {
    set.functions().map(|(response, reference, values)| {
        let sign = response.sign().factor() * reference.sign().factor();
        let along = |dof: Dof| match dof.sign() {
            Sign::Plus => dof,
            Sign::Minus => dof.flipped(),
        };
        ([along(response), along(reference)], sign, values)
    })
}

/// The drive points among the functions, in their order.
#[must_use]
pub fn drive_points(set: &FrfSet) -> Vec<DrivePoint> {
    along_axes(set)
        .filter(|([response, reference], ..)| response == reference)
        .map(|([dof, _], sign, values)| {
            let beyond = beyond_noise(values);
            let parts = values.iter().zip(beyond);
            let parts: Vec<f64> = parts
                .filter(|(_, is_beyond)| *is_beyond)
                .map(|(value, _)| sign * value.im)
                .collect();
            let all: f64 = parts.iter().map(|part| part.abs()).sum();
            let active = parts.iter().map(|part| part.max(0.0));
            DrivePoint {
                dof,
                active_share: if all > 0.0 {
                    active.sum::<f64>() / all
                } else {
                    0.0
                },
                turns_backwards: turns_backwards(values, Asked::BeyondNoise),
            }
        })
        .collect()
}

/// The pairs that were measured both ways, in the functions' order.
#[must_use]
pub fn reciprocities(set: &FrfSet) -> Vec<Reciprocity> {
    let all: Vec<_> = along_axes(set).collect();
    let mut found = Vec::new();
    for (place, &([response, reference], sign, values)) in all.iter().enumerate() {
        let back = all[place + 1..]
            .iter()
            .find(|(between, ..)| *between == [reference, response]);
        let Some(&(_, other_sign, others)) = back else {
            continue;
        };
        if response == reference {
            continue;
        }
        let turned = sign * other_sign;
        let part = |of: &dyn Fn(Complex64, Complex64) -> f64| -> Vec<f64> {
            std::iter::zip(values, others)
                .map(|(&one, &other)| of(one, other * turned))
                .collect()
        };
        // |H_pq − H_qp| over the mean of both magnitudes
        let differ = part(&|one, other| {
            let mean = 0.5 * (one.norm() + other.norm());
            if mean > 0.0 {
                (one - other).norm() / mean
            } else {
                0.0
            }
        });
        let minus: f64 = part(&|one, other| (one - other).norm_sqr()).iter().sum();
        let plus: f64 = part(&|one, other| (one + other).norm_sqr()).iter().sum();
        let worst = differ
            .iter()
            .copied()
            .zip(set.frequency_hz().iter().copied());
        let worst = worst.max_by(|one, other| one.0.total_cmp(&other.0));
        let mut sorted = differ.clone();
        sorted.sort_by(f64::total_cmp);
        found.push(Reciprocity {
            between: [response, reference],
            median: sorted.get(sorted.len() / 2).copied().unwrap_or(0.0),
            worst: worst.unwrap_or((0.0, 0.0)),
            is_opposite: plus < 0.1 * minus,
        });
    }
    found
}

/// How many lines a resonance has within its half-power bandwidth, by |H|² about its highest line.
#[must_use]
pub fn half_power_lines(frequency_hz: &[f64], function: &[f64], resonance_hz: f64) -> usize {
    let distance = |line: usize| (frequency_hz[line] - resonance_hz).abs();
    let lines = 0..frequency_hz.len().min(function.len());
    let Some(nearest) = lines.min_by(|&one, &other| distance(one).total_cmp(&distance(other)))
    else {
        return 0;
    };
    let high = function[nearest] / std::f64::consts::SQRT_2;
    let below = function[..nearest].iter().rev();
    let above = function[nearest + 1..].iter();
    1 + below.take_while(|&&own| own >= high).count()
        + above.take_while(|&&own| own >= high).count()
}

#[cfg(test)]
mod tests {
    use bolted_joint_frf::{Frf, polluted};

    use super::*;

    /// H of a beam-like structure of two modes at two points; both along +Y.
    fn function(between: [&str; 2], shapes: [[f64; 2]; 2]) -> Frf {
        let frequency_hz: Vec<f64> = (1..400).map(|line| 0.25 * f64::from(line)).collect();
        let mode = |hz: f64, natural: f64| {
            1.0 / Complex64::new(natural.powi(2) - hz * hz, 0.04 * natural * hz)
        };
        let value = |&hz: &f64| {
            let [one, two] = shapes;
            mode(hz, 21.0) * one[0] * one[1] + mode(hz, 60.0) * two[0] * two[1]
        };
        let values = frequency_hz.iter().map(value).collect();
        let [response, reference] = between.map(|dof| dof.parse().unwrap());
        Frf::new(response, reference, frequency_hz, values).unwrap()
    }

    fn changed(own: &Frf, change: impl Fn(Complex64) -> Complex64) -> Frf {
        let values = own
            .receptance()
            .iter()
            .map(|&value| change(value))
            .collect();
        Frf::new(
            own.response(),
            own.reference(),
            own.frequency_hz().to_vec(),
            values,
        )
        .unwrap()
    }

    #[test]
    fn drive_points_are_passive_unless_turned_or_conjugated() {
        let good = function(["1:+Y", "1:+Y"], [[1.0, 1.0], [0.7, 0.7]]);
        let only = |own: Frf| drive_points(&FrfSet::new(vec![own]).unwrap())[0];
        assert_eq!(only(good.clone()).active_share, 0.0);
        assert!(!only(good.clone()).turns_backwards);
        let turned = only(changed(&good, |value| -value));
        assert!(turned.active_share == 1.0 && !turned.turns_backwards);
        let conjugated = only(changed(&good, |value| value.conj()));
        assert!(conjugated.active_share == 1.0 && conjugated.turns_backwards);
        // a sensor that is turned round and says so
        let said = function(["1:-Y", "1:+Y"], [[-1.0, 1.0], [-0.7, 0.7]]);
        assert_eq!(only(said).active_share, 0.0);
    }

    /// Noise of 1 % on a free body that bends, −1/mω² and a mode of 0.1 % damping, of which every exact Im H is negative.
    #[test]
    fn noise_on_the_large_values_of_a_free_body_is_no_energy() {
        let frequency_hz: Vec<f64> = (4..300).map(|line| 10.0 * f64::from(line)).collect();
        let own = frequency_hz.iter().map(|hz| {
            let mode = Complex64::new(1234.0 * 1234.0 - hz * hz, 0.002 * 1234.0 * hz);
            2.0 * mode.inv() - (hz * hz).recip()
        });
        let dof = "1:+Y".parse().unwrap();
        let exact = Frf::new(dof, dof, frequency_hz.clone(), own.collect()).unwrap();
        for seed in 0..30 {
            let exact = FrfSet::new(vec![exact.clone()]).unwrap();
            let noisy = polluted(&exact, 0.01, seed).unwrap();
            let found = drive_points(&noisy)[0];
            assert!(found.active_share < 0.05, "{seed} {found:?}");
        }
    }

    #[test]
    fn transposed_functions_are_the_same() {
        let there = function(["1:+Y", "2:+Y"], [[1.0, 0.5], [0.7, -0.9]]);
        let back = function(["2:-Y", "1:+Y"], [[-0.5, 1.0], [0.9, 0.7]]);
        let both = |back: Frf| reciprocities(&FrfSet::new(vec![there.clone(), back]).unwrap())[0];
        let good = both(back.clone());
        assert!(good.worst.0 < 1e-12 && !good.is_opposite);
        let off = both(changed(&back, |value| 1.1 * value));
        // |1 − 1.1| over the mean of 1 and 1.1
        assert!((off.median - 0.1 / 1.05).abs() < 1e-12);
        assert!(both(changed(&back, |value| -value)).is_opposite);
        assert!(reciprocities(&FrfSet::new(vec![there.clone()]).unwrap()).is_empty());
    }

    #[test]
    fn half_power_bandwidths_have_their_lines() {
        // ζ = 0.02 at 21 Hz: 2ζf = 0.84 Hz, and lines 0.25 Hz apart
        let own = function(["1:+Y", "1:+Y"], [[1.0, 1.0], [0.0, 0.0]]);
        let magnitude: Vec<f64> = own.receptance().iter().map(|value| value.norm()).collect();
        assert_eq!(half_power_lines(own.frequency_hz(), &magnitude, 21.0), 3);
    }
}
