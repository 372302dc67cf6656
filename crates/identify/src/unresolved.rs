//! Resonances that the lines are too far apart for: there good values stand out from their neighbours as bad ones do.

use num_complex::Complex64;

/// Lines that a resonance needs within its half-power bandwidth for a curve through its neighbours to follow it.
pub(super) const FEWEST_LINES: usize = 3;

/// Lines at which a function has a peak of fewer lines than that within its half-power bandwidth.
pub(super) fn peaks(values: &[Complex64]) -> Vec<usize> {
    let sizes: Vec<f64> = values.iter().map(|value| value.norm()).collect();
    let is_peak = |&line: &usize| {
        let own = sizes[line];
        let high = own * std::f64::consts::FRAC_1_SQRT_2;
        let below = sizes[..line].iter().rev().take(FEWEST_LINES);
        let above = sizes[line + 1..].iter().take(FEWEST_LINES);
        let (mut nearest_below, mut nearest_above) = (below.clone(), above.clone());
        let is_highest = [nearest_below.next(), nearest_above.next()]
            .into_iter()
            .all(|beside| beside.is_some_and(|beside| *beside < own));
        let beside = below.take_while(|size| **size >= high).count()
            + above.take_while(|size| **size >= high).count();
        is_highest && 1 + beside < FEWEST_LINES
    };
    (0..sizes.len()).filter(is_peak).collect()
}

/// Lines at which most of a set's functions have such a peak, or beside which they do: that of most functions for each resonance,
/// and all of its lines. `peaks` are those of each function.
pub(super) fn resonances(peaks: &[&[usize]]) -> Vec<(usize, Vec<usize>)> {
    let last = peaks.iter().filter_map(|own| own.last()).max();
    let lines = last.map_or(0, |last| last + 2);
    let near = |line: usize| {
        let has = |own: &&&[usize]| own.iter().any(|&peak| peak.abs_diff(line) <= 1);
        peaks.iter().filter(has).count()
    };
    let at = |line: usize| peaks.iter().filter(|own| own.contains(&line)).count();
    let mut found: Vec<(usize, Vec<usize>)> = Vec::new();
    for line in (0..lines).filter(|&line| 2 * near(line) >= peaks.len()) {
        match found.last_mut() {
            Some((highest, all)) if all.last().is_some_and(|last| last + 1 == line) => {
                all.push(line);
                if at(line) > at(*highest) {
                    *highest = line;
                }
            }
            _ => found.push((line, vec![line])),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Modes at 400 and 1003 Hz, lines 10 Hz apart; half-power bandwidths of 80 and 4 Hz.
    fn function(parts: [f64; 2]) -> Vec<Complex64> {
        let mode = |hz: f64, natural: f64, bandwidth: f64| {
            Complex64::new(natural * natural - hz * hz, bandwidth * hz).inv()
        };
        let hz = (1..150).map(|line| 10.0 * f64::from(line));
        hz.map(|hz| mode(hz, 400.0, 80.0) * parts[0] + mode(hz, 1003.0, 4.0) * parts[1])
            .collect()
    }

    #[test]
    fn a_resonance_between_the_lines_is_one_where_most_functions_have_it() {
        let all = [[1.0, 1.0], [1.0, -0.7], [0.5, 0.3]].map(function);
        let all = all.each_ref().map(|own| peaks(own));
        let of =
            |all: &[Vec<usize>]| resonances(&all.iter().map(Vec::as_slice).collect::<Vec<_>>());
        // 1000 Hz is line 99, from 0
        assert_eq!(of(&all), [(99, vec![98, 99, 100])]);
        // one function alone has a single bad value
        let mut bad = [[1.0, 0.0]; 3].map(function);
        bad[1][60] *= 5.0;
        assert_eq!(peaks(&bad[1]), [60]);
        assert_eq!(of(&bad.each_ref().map(|own| peaks(own))), []);
    }
}
