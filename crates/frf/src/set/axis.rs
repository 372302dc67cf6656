//! Whether two frequency axes are the same.

/// Two axes agree where the standard's six printed digits cannot tell them apart …
const AXIS_PRINT_RESOLUTION: f64 = 6e-6;

/// … but never if they differ by more than this part of the distance between lines.
const AXIS_SPACING_SHARE: f64 = 0.05;

/// Rounding of `minimum + i · increment`, always allowed.
const AXIS_ROUNDING: f64 = 1e-12;

/// The index of the first line at which two frequency axes (Hz) differ, over the shorter of the two.
pub(super) fn first_difference(first_hz: &[f64], second_hz: &[f64]) -> Option<usize> {
    let lines = first_hz.len().min(second_hz.len());
    (0..lines).find(|&index| {
        let (hz, other_hz) = (first_hz[index], second_hz[index]);
        let spacing_hz = match first_hz.get(index + 1) {
            Some(next_hz) => next_hz - hz,
            None => match index.checked_sub(1) {
                Some(before) => hz - first_hz[before],
                None => hz,
            },
        };
        let printed_hz = (AXIS_PRINT_RESOLUTION * hz).min(AXIS_SPACING_SHARE * spacing_hz);
        (hz - other_hz).abs() > printed_hz.max(AXIS_ROUNDING * hz)
    })
}

#[cfg(test)]
mod tests {
    use super::first_difference;

    #[test]
    fn axes_agree_within_printed_digits_but_not_within_a_line() {
        let agree = |first: &[f64], second: &[f64]| first_difference(first, second).is_none();
        assert!(agree(&[100.123456, 101.0], &[100.123, 101.0]));
        assert!(!agree(&[100.123456, 101.0], &[100.12, 101.0]));
        // At 12 kHz the sixth digit is 0.1 Hz, far more than the distance between these lines.
        assert!(!agree(&[12_000.0, 12_000.03], &[12_000.02, 12_000.05]));
        assert!(agree(&[0.1 + 0.2], &[0.3]));
        assert!(!agree(&[0.0, 1.0], &[1e-6, 1.0]));
    }
}
