//! Whether a stiffness or damping matrix can only store or take energy.

/// Relative size below which a negative pivot is taken for rounding of a singular matrix.
const ROUNDING: f64 = 1e-12;

/// Whether the symmetric `matrix` is positive semidefinite: a joint with such K and C is passive.
///
/// The test does not depend on the units of the DOFs: it eliminates on the matrix scaled to a unit diagonal.
#[must_use]
pub fn is_positive_semidefinite<const D: usize>(matrix: &[[f64; D]; D]) -> bool {
    let diagonal: [f64; D] = std::array::from_fn(|i| matrix[i][i]);
    let finite = matrix.iter().flatten().all(|entry| entry.is_finite());
    if !finite || diagonal.iter().any(|entry| *entry < 0.0) {
        return false;
    }
    // S_ij = A_ij / √(A_ii A_jj); a row whose diagonal is zero must be zero altogether.
    let mut scaled = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..D {
            let scale = (diagonal[i] * diagonal[j]).sqrt();
            if scale > 0.0 {
                scaled[i][j] = matrix[i][j] / scale;
            } else if matrix[i][j] != 0.0 {
                return false;
            }
        }
    }
    // L D Lᵀ by elimination: semidefinite if no pivot is negative and a zero pivot has a zero column.
    for pivot in 0..D {
        let value = scaled[pivot][pivot];
        if value < -ROUNDING {
            return false;
        }
        for row in pivot + 1..D {
            if value <= ROUNDING {
                if scaled[row][pivot].abs() > ROUNDING.sqrt() {
                    return false;
                }
                continue;
            }
            let factor = scaled[row][pivot] / value;
            for column in pivot + 1..D {
                scaled[row][column] -= factor * scaled[pivot][column];
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::is_positive_semidefinite;

    #[test]
    fn published_joints() {
        // Tol Table 5.3, updated: both matrices are passive.
        assert!(is_positive_semidefinite(&[
            [5.73e5, 5.82e3],
            [5.82e3, 1.29e3]
        ]));
        assert!(is_positive_semidefinite(&[[10.83, -0.83], [-0.83, 0.083]]));
        // Tol Table 5.4: c_Mθ = 0 with c_Fθ = 1.20 is active.
        assert!(!is_positive_semidefinite(&[[18.75, 1.20], [1.20, 0.0]]));
    }

    #[test]
    fn the_boundary_of_the_cone_belongs_to_it() {
        assert!(is_positive_semidefinite(&[[0.0]]));
        assert!(is_positive_semidefinite(&[[4.0, 2e-3], [2e-3, 1e-6]]));
        assert!(!is_positive_semidefinite(&[
            [4.0, 2.001e-3],
            [2.001e-3, 1e-6]
        ]));
        assert!(!is_positive_semidefinite(&[[-1e-9]]));
        assert!(!is_positive_semidefinite(&[[f64::NAN]]));
        assert!(!is_positive_semidefinite(&[
            [1.0, f64::NAN],
            [f64::NAN, 1.0]
        ]));
        assert!(!is_positive_semidefinite(&[
            [f64::INFINITY, 1.0],
            [1.0, 1.0]
        ]));
    }
}
