//! Whether a joint can only store and take energy, or can feed it into a simulation.

mod amplitude;

use std::fmt;

use bolted_joint_dynamics::{DofCount, is_positive_semidefinite, with_dofs};
use nalgebra::{DMatrix, SymmetricEigen};

use super::{Joint, JointFile};

/// Judgement on each stiffness and damping matrix of a joint.
///
/// A joint is passive if its K and C are positive semidefinite (theory: a massless joint that is not can make a
/// time-domain model blow up), C also with the damping that depends on the amplitude, at every amplitude that the joint
/// file states it for. An active joint can be read, but is exported only if the user insists.
#[derive(Debug, Clone, PartialEq)]
pub struct Passivity {
    /// K and C, or those at every preload where the joint depends on it; C with the damping that depends on the amplitude.
    pub matrices: Vec<MatrixPassivity>,
}

/// Judgement on one matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixPassivity {
    /// Key of the matrix, such as `joint.damping`, with what else is in it.
    pub path: String,
    /// Its eigenvalues, ascending, as the numbers stand in SI units.
    pub eigenvalues: Vec<f64>,
    /// Eigenvalues of A_ij/√(|A_ii| |A_jj|), ascending: the same in every system of units. `None` where the diagonal has
    /// a zero.
    pub scaled_eigenvalues: Option<Vec<f64>>,
    /// Whether the matrix is positive semidefinite, judged on the scaled matrix.
    pub passive: bool,
}

impl Passivity {
    /// Whether every matrix is positive semidefinite.
    #[must_use]
    pub fn is_passive(&self) -> bool {
        self.active().next().is_none()
    }

    /// The matrices that are not positive semidefinite.
    pub fn active(&self) -> impl Iterator<Item = &MatrixPassivity> {
        self.matrices.iter().filter(|matrix| !matrix.passive)
    }
}

impl JointFile {
    /// Whether the joint's matrices are positive semidefinite.
    #[must_use]
    pub fn passivity(&self) -> Passivity {
        self.joint.passivity()
    }
}

impl Joint {
    /// Whether the matrices that are in force are positive semidefinite: those over the preload, where there are any.
    ///
    /// Only the upper triangles are looked at, and rows that are too short count as zero: [`JointFile::validate`] first.
    #[must_use]
    pub fn passivity(&self) -> Passivity {
        let mut matrices = Vec::new();
        match &self.over_preload {
            None => {
                matrices.push(MatrixPassivity::new(
                    "joint.stiffness".into(),
                    &self.stiffness,
                ));
                matrices.push(MatrixPassivity::new("joint.damping".into(), &self.damping));
                matrices.extend(amplitude::passivity(self));
            }
            Some(table) => {
                for (key, list) in [("stiffness", &table.stiffness), ("damping", &table.damping)] {
                    for (i, matrix) in list.iter().enumerate() {
                        let path = format!("joint.over_preload.{key}[{i}]");
                        matrices.push(MatrixPassivity::new(path, matrix));
                    }
                }
            }
        }
        Passivity { matrices }
    }
}

impl MatrixPassivity {
    /// What is said of a matrix that is not positive semidefinite, wherever a joint with it is met.
    #[must_use]
    pub fn finding(&self) -> String {
        format!(
            "{self}; expected it positive semidefinite: this joint can feed energy into a simulation"
        )
    }

    fn new(path: String, rows: &[Vec<f64>]) -> Self {
        let order = rows.len();
        let entry = |i: usize, j: usize| rows[i.min(j)].get(i.max(j)).copied().unwrap_or(0.0);
        let matrix = DMatrix::from_fn(order, order, entry);
        let diagonal: Vec<f64> = (0..order).map(|i| entry(i, i).abs()).collect();
        // S_ij = A_ij / √(|A_ii| |A_jj|)
        let scaled = diagonal.iter().all(|entry| *entry > 0.0).then(|| {
            DMatrix::from_fn(order, order, |i, j| {
                entry(i, j) / (diagonal[i] * diagonal[j]).sqrt()
            })
        });
        let passive = match DofCount::of(order) {
            Some(count) => with_dofs!(count, D => {
                let entries: [[f64; D]; D] =
                    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
                is_positive_semidefinite(&entries)
            }),
            // The format has no larger joints.
            None => order == 0,
        };
        Self {
            path,
            eigenvalues: ascending_eigenvalues(matrix),
            scaled_eigenvalues: scaled.map(ascending_eigenvalues),
            passive,
        }
    }
}

fn ascending_eigenvalues(matrix: DMatrix<f64>) -> Vec<f64> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return vec![f64::NAN; matrix.nrows()];
    }
    let mut eigenvalues: Vec<f64> = SymmetricEigen::new(matrix)
        .eigenvalues
        .iter()
        .copied()
        .collect();
    eigenvalues.sort_by(f64::total_cmp);
    eigenvalues
}

/// One line, such as `joint.damping is active: smallest eigenvalue -7.65e-2 …`.
impl fmt::Display for MatrixPassivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let judgement = if self.passive { "passive" } else { "active" };
        write!(f, "{} is {judgement}", self.path)?;
        if let Some(smallest) = self.eigenvalues.first() {
            write!(f, ": smallest eigenvalue {smallest:.4e} in SI units")?;
        }
        match &self.scaled_eigenvalues {
            Some(scaled) => match scaled.first() {
                Some(smallest) => write!(f, ", {smallest:.4e} scaled to a unit diagonal"),
                None => Ok(()),
            },
            None => write!(f, ", and a zero on its diagonal"),
        }
    }
}

/// One line for each matrix.
impl fmt::Display for Passivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self
            .matrices
            .iter()
            .map(MatrixPassivity::to_string)
            .collect();
        f.write_str(&lines.join("\n"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DofSet;

    fn joint(stiffness: [[f64; 2]; 2], damping: [[f64; 2]; 2]) -> Joint {
        let rows = |matrix: [[f64; 2]; 2]| matrix.map(|row| row.to_vec()).to_vec();
        Joint::linear(DofSet::TRANSLATION_ROTATION, rows(stiffness), rows(damping))
    }

    /// Eigenvalues of a symmetric 2×2 matrix in closed form, ascending.
    fn closed_form([[a, b], [_, d]]: [[f64; 2]; 2]) -> [f64; 2] {
        let (mean, radius) = (0.5 * (a + d), f64::hypot(0.5 * (a - d), b));
        [mean - radius, mean + radius]
    }

    #[test]
    fn the_published_active_joint_is_found_by_its_damping() {
        // Tol Table 5.4: c_Mθ = 0 with c_Fθ = 1.20
        let damping = [[18.75, 1.20], [1.20, 0.0]];
        let passivity = joint([[5.73e5, 5.82e3], [5.82e3, 1.29e3]], damping).passivity();
        assert!(!passivity.is_passive());
        let active: Vec<&MatrixPassivity> = passivity.active().collect();
        assert_eq!(active.len(), 1);
        assert_eq!(active[0].path, "joint.damping");
        for (found, expected) in active[0].eigenvalues.iter().zip(closed_form(damping)) {
            assert!(
                (found - expected).abs() < 1e-14 * 18.75,
                "{found} {expected}"
            );
        }
        assert_eq!(active[0].scaled_eigenvalues, None);
        assert_eq!(
            active[0].to_string(),
            "joint.damping is active: smallest eigenvalue -7.6488e-2 in SI units, and a zero on its diagonal"
        );
    }

    #[test]
    fn scaled_eigenvalues_do_not_depend_on_units() {
        // scaled: 1 ± k_12/√(k_11 k_22)
        let ratio = 5.82e3 / f64::sqrt(5.73e5 * 1.29e3);
        let passivity = joint(
            [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
            [[1.0, 0.0], [0.0, 1.0]],
        );
        let millimetres = joint(
            [[5.73e2, 5.82e3], [5.82e3, 1.29e6]],
            [[1.0, 0.0], [0.0, 1.0]],
        );
        for passivity in [passivity.passivity(), millimetres.passivity()] {
            assert!(passivity.is_passive());
            let scaled = passivity.matrices[0].scaled_eigenvalues.clone().unwrap();
            assert!((scaled[0] - (1.0 - ratio)).abs() < 1e-14);
            assert!((scaled[1] - (1.0 + ratio)).abs() < 1e-14);
        }
    }
}
