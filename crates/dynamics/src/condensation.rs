//! How the other DOFs follow one that is moved, with no load on them, and what they leave of its stiffness or damping.

/// Motions of all DOFs that follow a unit motion of DOF `i` by this symmetric matrix; `None` where fewer than two others are
/// coupled to it, directly or through others, or where they are not held.
pub(crate) fn following<const D: usize>(matrix: &[[f64; D]; D], i: usize) -> Option<[f64; D]> {
    if D < 3 {
        return None;
    }
    let is_coupled = coupled(matrix, i);
    if is_coupled.iter().filter(|&&coupled| coupled).count() < 3 {
        return None;
    }
    // K_oo x_o = −k_oi by elimination; K_oo is positive definite where the others are held
    let (mut left, mut motion) = (*matrix, [0.0; D]);
    for row in 0..D {
        motion[row] = -matrix[row][i];
        if row == i || !is_coupled[row] {
            left[row] = [0.0; D];
            left[row][row] = 1.0;
            motion[row] = if row == i { 1.0 } else { 0.0 };
        } else {
            left[row][i] = 0.0;
        }
    }
    for pivot in 0..D {
        let held = matrix[pivot][pivot].abs().max(f64::MIN_POSITIVE);
        if pivot != i && is_coupled[pivot] && left[pivot][pivot] <= f64::EPSILON * held {
            return None;
        }
        for row in pivot + 1..D {
            let factor = left[row][pivot] / left[pivot][pivot];
            for column in pivot..D {
                left[row][column] -= factor * left[pivot][column];
            }
            motion[row] -= factor * motion[pivot];
        }
    }
    for row in (0..D).rev() {
        let known: f64 = (row + 1..D)
            .map(|column| left[row][column] * motion[column])
            .sum();
        motion[row] = (motion[row] - known) / left[row][row];
    }
    motion.iter().all(|x| x.is_finite()).then_some(motion)
}

/// What the matrix has against such a motion: xᵀKx, which is K_ii − k_ioᵀ K_oo⁻¹ k_io.
pub(crate) fn condensed<const D: usize>(matrix: &[[f64; D]; D], motion: &[f64; D]) -> f64 {
    let rows = matrix.iter().zip(motion);
    rows.map(|(row, x)| x * row.iter().zip(motion).map(|(k, y)| k * y).sum::<f64>())
        .sum()
}

/// The DOFs that are coupled to DOF `i`, itself among them.
fn coupled<const D: usize>(matrix: &[[f64; D]; D], i: usize) -> [bool; D] {
    let mut is_coupled = [false; D];
    is_coupled[i] = true;
    for _ in 0..D {
        for row in 0..D {
            is_coupled[row] |= (0..D).any(|other| is_coupled[other] && matrix[row][other] != 0.0);
        }
    }
    is_coupled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{DofLaws, JointLaw, Linear, Polynomial};

    const STIFFNESS: [[f64; 3]; 3] = [[4.0, 1.0, -0.5], [1.0, 3.0, 0.7], [-0.5, 0.7, 2.0]];

    fn softening(stiffness: [[f64; 3]; 3], cubic: f64) -> JointLaw<3> {
        let linear = Linear {
            stiffness,
            damping: [[0.0; 3]; 3],
        };
        linear.beside([Polynomial::cubic(cubic), Polynomial::NONE, Polynomial::NONE])
    }

    #[test]
    fn the_others_take_their_share_of_the_stiffness() {
        // Schur: 4 − [1, −0.5] [[3, 0.7], [0.7, 2]]⁻¹ [1, −0.5]ᵀ = 4 − (2·1 + 2·0.7·0.5 + 3·0.25)/(6 − 0.49)
        let expected: f64 = 4.0 - (2.0 + 0.7 + 0.75) / 5.51;
        let law = softening(STIFFNESS, -0.01);
        let [amplitude, ..] = law.escape_amplitude();
        let motion = following(&STIFFNESS, 0).unwrap();
        assert!((condensed(&STIFFNESS, &motion) / expected - 1.0).abs() < 1e-14);
        let expected = (expected / 0.01).sqrt();
        assert!(
            (amplitude.unwrap() / expected - 1.0).abs() < 1e-9,
            "{amplitude:?} {expected}"
        );
    }

    #[test]
    fn its_change_is_that_of_differences() {
        let change = softening([[0.3, -0.2, 0.1], [-0.2, 0.5, 0.4], [0.1, 0.4, -0.6]], 2e-3);
        let law = softening(STIFFNESS, -0.01);
        let at = |step: f64| {
            let law = JointLaw::each([&law, &change], |[own, change]| own + step * change);
            law.escape_amplitude()[0].unwrap()
        };
        let differences = (at(1e-5) - at(-1e-5)) / 2e-5;
        let [exact, ..] = law.escape_amplitude_tangent(&change);
        assert!(
            (exact / differences - 1.0).abs() < 1e-6,
            "{exact} {differences}"
        );
    }

    #[test]
    fn damping_that_falls_is_active_beyond_what_the_others_leave() {
        let law = JointLaw {
            on: [
                Polynomial::with(&[], &[-2.0]).into(),
                DofLaws::NONE,
                DofLaws::NONE,
            ],
            ..Linear {
                stiffness: [[0.0; 3]; 3],
                damping: STIFFNESS,
            }
            .into()
        };
        // C_condensed = 2 u
        let expected: f64 = (4.0 - (2.0 + 0.7 + 0.75) / 5.51) / 2.0;
        let [amplitude, ..] = law.active_amplitude();
        assert!((amplitude.unwrap() / expected.sqrt() - 1.0).abs() < 1e-14);
    }
}
