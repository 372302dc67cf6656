//! Resonances that a reader would point at: the maxima of a magnitude that stand out from their surroundings.

use num_complex::Complex64;

/// A maximum counts if it stands at least 3 dB above the higher of the two valleys beside it.
const PROMINENCE_DECADES: f64 = 0.15;

/// A maximum of a magnitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resonance {
    /// Frequency of the maximum, between the lines, Hz.
    pub frequency_hz: f64,
    /// How far it stands out, powers of ten.
    pub prominence_decades: f64,
}

/// The resonances in `function`, in ascending frequency. Zero and non-finite values are passed over.
#[must_use]
pub fn resonances(frequency_hz: &[f64], function: &[Complex64]) -> Vec<Resonance> {
    let level: Vec<(f64, f64)> = frequency_hz
        .iter()
        .zip(function)
        .map(|(&frequency, value)| (frequency, value.norm().log10()))
        .filter(|(frequency, level)| frequency.is_finite() && level.is_finite())
        .collect();
    let left = valleys(level.iter().map(|point| point.1));
    let right = valleys(level.iter().rev().map(|point| point.1));
    // height above the higher of the valleys on either side
    let prominence = |peak: usize| level[peak].1 - left[peak].max(right[level.len() - 1 - peak]);
    level
        .windows(3)
        .enumerate()
        .filter_map(|(before, window)| match *window {
            [left, peak, right] if peak.1 > left.1 && peak.1 >= right.1 => Some(Resonance {
                frequency_hz: vertex(left, peak, right),
                prominence_decades: prominence(before + 1),
            }),
            _ => None,
        })
        .filter(|resonance| resonance.prominence_decades >= PROMINENCE_DECADES)
        .collect()
}

/// Of each point the lowest one before it, as far as the next higher one.
fn valleys(levels: impl Iterator<Item = f64>) -> Vec<f64> {
    // points that no later one is as high as, each with the lowest since the one before it
    let mut higher: Vec<(f64, f64)> = Vec::new();
    let valley = |level: f64| {
        let mut lowest = level;
        while let Some((_, before)) = higher.pop_if(|(other, _)| *other <= level) {
            lowest = lowest.min(before);
        }
        higher.push((level, lowest));
        lowest
    };
    levels.map(valley).collect()
}

/// Where the parabola through three points has its vertex; the middle one is above the first and not below the last.
fn vertex((x0, y0): (f64, f64), (x1, y1): (f64, f64), (x2, y2): (f64, f64)) -> f64 {
    // x = x₁ − ½ [(x₁−x₀)²(y₁−y₂) − (x₁−x₂)²(y₁−y₀)] / [(x₁−x₀)(y₁−y₂) − (x₁−x₂)(y₁−y₀)]
    let (left, right) = (x1 - x0, x1 - x2);
    let numerator = left * left * (y1 - y2) - right * right * (y1 - y0);
    let denominator = left * (y1 - y2) - right * (y1 - y0);
    x1 - 0.5 * numerator / denominator
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(values: &[f64]) -> Vec<Complex64> {
        values
            .iter()
            .map(|&value| Complex64::new(value, 0.0))
            .collect()
    }

    #[test]
    fn a_parabola_in_decibels_is_found_between_unequal_lines() {
        let frequency_hz = [10.0, 10.3, 10.9, 11.2, 12.0];
        // log₁₀|H| = −3 − (f − 10.7)²
        let function = real(&frequency_hz.map(|f: f64| 10_f64.powf(-3.0 - (f - 10.7).powi(2))));
        let found = resonances(&frequency_hz, &function);
        assert_eq!(found.len(), 1);
        assert!((found[0].frequency_hz - 10.7).abs() < 1e-9);
        assert!((found[0].prominence_decades - (0.49 - 0.04)).abs() < 1e-9);
    }

    /// With its two sides walked through point by point.
    #[test]
    fn valleys_reach_to_the_next_higher_point() {
        let mut state = 1_u64;
        let levels: Vec<f64> = std::iter::repeat_with(|| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            // few values, so that many are equal
            (state >> 60) as f64
        })
        .take(300)
        .collect();
        let found = valleys(levels.iter().copied());
        for (peak, &top) in levels.iter().enumerate() {
            let before = levels[..peak]
                .iter()
                .rev()
                .take_while(|level| **level <= top);
            assert_eq!(found[peak], before.copied().fold(top, f64::min), "{peak}");
        }
    }

    #[test]
    fn ripples_edges_and_steps_are_no_resonances() {
        let frequency_hz = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        assert!(resonances(&frequency_hz, &real(&[9.0, 5.0, 6.0, 5.0, 1.0, 2.0, 8.0])).is_empty());
        assert!(resonances(&frequency_hz, &real(&[1.0, 3.0, 3.0, 3.0, 5.0, 7.0, 9.0])).is_empty());
        assert!(resonances(&frequency_hz, &[]).is_empty());
    }

    #[test]
    fn a_flat_top_counts_once_and_gaps_are_passed_over() {
        let frequency_hz = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
        let function = real(&[1.0, 0.0, 4.0, f64::NAN, 4.0, 1.0, 3.0, 1.0]);
        let found: Vec<f64> = resonances(&frequency_hz, &function)
            .iter()
            .map(|resonance| resonance.frequency_hz)
            .collect();
        assert_eq!(found.len(), 2);
        assert!(found[0] > 3.0 && found[0] < 5.0);
        assert!((found[1] - 7.0).abs() < 1e-9);
    }
}
