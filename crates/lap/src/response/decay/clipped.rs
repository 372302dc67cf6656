//! Records whose peaks are cut off at the end of an instrument's range. They look like the law of a joint that hardens or
//! softens, and fit none well.

use bolted_joint_statistics::upper_median;

use super::DecayProblem;

/// Samples in a row at the end of the range that are a flat top, and such tops that are more than a sensor at rest.
const FLAT: usize = 3;
const TOPS: usize = 2;
/// Steps beside a flat top, in the smallest step of the record: rounding makes tops flat, too, but goes on by single steps.
const ROUNDING: f64 = 2.0;

/// Refuses a record that has flat tops at its largest or at its smallest value.
pub(super) fn refuse(samples: &[(f64, f64)]) -> Result<(), DecayProblem> {
    for side in [1.0, -1.0] {
        let values: Vec<f64> = samples.iter().map(|(_, value)| side * value).collect();
        let limit = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let tops = tops(&values, limit);
        let Some(&(_, last)) = tops.last() else {
            continue;
        };
        if tops.len() >= TOPS && drop_beside(&values, &tops) > ROUNDING * smallest_step(&values) {
            return Err(DecayProblem::Clipped {
                limit: side * limit,
                samples: tops.iter().map(|(from, to)| to - from + 1).sum(),
                last_s: samples[last].0,
            });
        }
    }
    Ok(())
}

/// First and last place of every flat top.
fn tops(values: &[f64], limit: f64) -> Vec<(usize, usize)> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (place, &value) in values.iter().enumerate() {
        match found.last_mut() {
            _ if value < limit => {}
            Some((_, to)) if *to + 1 == place => *to = place,
            _ => found.push((place, place)),
        }
    }
    found.retain(|(from, to)| to - from + 1 >= FLAT);
    found
}

/// The middle one of the steps from the tops to the samples beside them.
fn drop_beside(values: &[f64], tops: &[(usize, usize)]) -> f64 {
    let beside = tops.iter().flat_map(|&(from, to)| {
        let before = from.checked_sub(1).and_then(|place| values.get(place));
        let both = before.into_iter().chain(values.get(to + 1));
        both.map(move |beside| values[from] - beside)
    });
    upper_median(beside).unwrap_or(0.0)
}

/// The smallest step between neighbours that is one.
fn smallest_step(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    steps
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::super::DecayProblem;
    use super::refuse;

    /// A decay of 20 periods with 50 samples in each, rounded to steps.
    fn decay(step: f64, range: f64) -> Vec<(f64, f64)> {
        let value = |n: i32| {
            let phase = 0.04 * std::f64::consts::PI * f64::from(n);
            let own = (-0.01 * phase).exp() * phase.cos();
            ((own / step).round() * step).clamp(-range, range)
        };
        (0..1000).map(|n| (1e-3 * f64::from(n), value(n))).collect()
    }

    #[test]
    fn flat_tops_are_found_and_rounding_is_none() {
        for (step, range, is_clipped) in [
            (1e-9, 0.8, true),
            (1.0 / 2048.0, 0.8, true),
            (1e-9, 2.0, false),
            (1.0 / 2048.0, 2.0, false),
            (1.0 / 16.0, 2.0, false),
        ] {
            let found = refuse(&decay(step, range));
            assert_eq!(found.is_err(), is_clipped, "{step} {range}: {found:?}");
        }
        let Err(DecayProblem::Clipped { limit, .. }) = refuse(&decay(1e-9, 0.8)) else {
            panic!("not clipped");
        };
        assert_eq!(limit, 0.8);
    }

    /// Before a release a sensor stands still.
    #[test]
    fn a_record_that_begins_at_rest_is_not_clipped() {
        let mut samples = vec![(0.0, 1.0); 40];
        samples.extend(decay(1e-9, 2.0));
        assert!(refuse(&samples).is_ok());
    }
}
