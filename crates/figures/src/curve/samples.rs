//! What a curve shows of a function: magnitude, phase and residual over frequency, and a phase cut where it wraps.

use num_complex::Complex64;

use super::super::axis::PHASE_END;

/// A value over frequency (Hz).
pub type Sample = (f64, f64);

/// Magnitude over frequency. What cannot be drawn stays: it makes a gap.
pub fn magnitude(frequency_hz: &[f64], function: &[Complex64]) -> Vec<Sample> {
    let samples = frequency_hz.iter().zip(function);
    samples
        .map(|(&frequency, value)| (frequency, value.norm()))
        .collect()
}

/// Phase in degrees over frequency, NaN where the value is zero and has none.
pub fn phase(frequency_hz: &[f64], function: &[Complex64]) -> Vec<Sample> {
    let degrees = |value: &Complex64| match value.norm() {
        norm if norm > 0.0 => value.arg().to_degrees(),
        _ => f64::NAN,
    };
    let samples = frequency_hz.iter().zip(function);
    samples
        .map(|(&frequency, value)| (frequency, degrees(value)))
        .collect()
}

/// Takes a turn off the phases in `samples`, or adds one, where that brings them nearer to `reference` and they stay
/// on the axis: noise about ±180° then lies on both sides of the reference and not at both ends of the axis.
pub fn turned_towards(reference: &[Sample], mut samples: Vec<Sample>) -> Vec<Sample> {
    for (sample, reference) in samples.iter_mut().zip(reference) {
        let away = sample.1 - reference.1;
        let turned = sample.1 - 360_f64.copysign(away);
        if away.abs() > 180.0 && turned.abs() <= PHASE_END {
            sample.1 = turned;
        }
    }
    samples
}

/// |measured − regenerated| / |regenerated| in per cent over frequency.
pub fn residual(
    frequency_hz: &[f64],
    measured: &[Complex64],
    regenerated: &[Complex64],
) -> Vec<Sample> {
    let samples = frequency_hz.iter().zip(measured.iter().zip(regenerated));
    samples
        .map(|(&frequency, (measured, regenerated))| {
            (
                frequency,
                100.0 * (measured - regenerated).norm() / regenerated.norm(),
            )
        })
        .collect()
}

/// Cuts a phase where it passes ±180° and carries both ends to the edge. Samples must not be outside ±180°.
pub fn unwrapped_pieces(samples: &[Sample]) -> Vec<Vec<Sample>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<Sample> = Vec::new();
    for &(frequency, degrees) in samples {
        if let Some(&(before, degrees_before)) = piece.last() {
            let jump = degrees - degrees_before;
            if jump.abs() > 180.0 {
                let edge = 180_f64.copysign(degrees_before);
                let turn = 360_f64.copysign(jump);
                let share = (edge - degrees_before) / (jump - turn);
                let crossing = if share.is_finite() {
                    before + share * (frequency - before)
                } else {
                    before
                };
                piece.push((crossing, edge));
                pieces.push(std::mem::take(&mut piece));
                piece.push((crossing, -edge));
            }
        }
        piece.push((frequency, degrees));
    }
    pieces.push(piece);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrapping_phase_is_carried_to_the_edges() {
        let pieces = unwrapped_pieces(&[(1.0, -90.0), (2.0, -170.0), (3.0, 160.0), (4.0, 150.0)]);
        // From −170° to −200°: a third of the way down lies −180°.
        let crossing = 2.0 + 1.0 / 3.0;
        assert_eq!(pieces.len(), 2);
        assert_eq!(pieces[0][..2], [(1.0, -90.0), (2.0, -170.0)]);
        assert!((pieces[0][2].0 - crossing).abs() < 1e-12 && pieces[0][2].1 == -180.0);
        assert!((pieces[1][0].0 - crossing).abs() < 1e-12 && pieces[1][0].1 == 180.0);
        assert_eq!(pieces[1][1..], [(3.0, 160.0), (4.0, 150.0)]);
    }

    #[test]
    fn noise_about_half_a_turn_stays_together() {
        let reference = [(1.0, -179.0), (2.0, 178.0), (3.0, -100.0), (4.0, f64::NAN)];
        let samples = vec![(1.0, 179.5), (2.0, -170.0), (3.0, 120.0), (4.0, 179.0)];
        let expected = [(1.0, -180.5), (2.0, 190.0), (3.0, 120.0), (4.0, 179.0)];
        assert_eq!(turned_towards(&reference, samples), expected);
    }

    #[test]
    fn no_piece_of_a_phase_jumps() {
        let turning: Vec<Sample> = (0..500)
            .map(|k| {
                (
                    f64::from(k),
                    (f64::from(k) * 47.0 + 180.0).rem_euclid(360.0) - 180.0,
                )
            })
            .collect();
        let pieces = unwrapped_pieces(&turning);
        // The edge is passed at 180°, 540°, … up to 499 · 47°.
        assert_eq!(pieces.len(), 1 + (499 * 47 + 180) / 360);
        for piece in pieces {
            assert!(
                piece
                    .windows(2)
                    .all(|ends| (ends[1].1 - ends[0].1).abs() <= 180.0)
            );
        }
    }

    #[test]
    fn a_jump_from_edge_to_edge_is_cut_without_dividing_by_zero() {
        let pieces = unwrapped_pieces(&[(1.0, 180.0), (2.0, -180.0), (3.0, f64::NAN), (4.0, 10.0)]);
        assert_eq!(pieces[0], [(1.0, 180.0), (1.0, 180.0)]);
        assert_eq!(pieces[1][..2], [(1.0, -180.0), (2.0, -180.0)]);
        assert!(pieces[1][2].1.is_nan());
    }

    #[test]
    fn residuals_are_in_per_cent_and_zero_has_no_phase() {
        let measured = [Complex64::new(3.0, 4.0), Complex64::new(1.0, 0.0)];
        let regenerated = [Complex64::new(3.0, 3.5), Complex64::new(0.0, 0.0)];
        let residual = residual(&[1.0, 2.0], &measured, &regenerated);
        // 0.5/√(3² + 3.5²)
        assert!((residual[0].1 - 10.846_522_890_932_809).abs() < 1e-12);
        assert!(residual[1].1.is_infinite());
        let phase = phase(&[1.0, 2.0], &[Complex64::new(-2.0, 0.0), Complex64::ZERO]);
        assert_eq!(phase[0].1, 180.0);
        assert!(phase[1].1.is_nan());
    }
}
