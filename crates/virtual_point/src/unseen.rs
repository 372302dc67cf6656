//! Motions that channels do not see or impacts do not drive, in words: a rank alone does not say where to put one more.

use std::fmt;

use nalgebra::{DMatrix, Vector3, Vector6};

use crate::Role;
use crate::words::{short, triple};

/// Pitch per distance of the places, below which a screw is a rotation.
const NO_PITCH: f64 = 1e-6;

/// A rigid motion by what it is geometrically; every one is a screw (Chasles).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnseenMotion {
    /// Translation along a unit vector.
    Translation {
        /// Where it goes.
        direction: [f64; 3],
    },
    /// Rotation about a line.
    Rotation {
        /// Unit vector along the line.
        axis: [f64; 3],
        /// The point of the line that is nearest to the virtual point, m.
        through_m: [f64; 3],
    },
    /// Rotation about a line with a translation along it.
    Screw {
        /// Unit vector along the line.
        axis: [f64; 3],
        /// The point of the line that is nearest to the virtual point, m.
        through_m: [f64; 3],
        /// Translation per rotation, m/rad.
        pitch_m: f64,
    },
}

impl UnseenMotion {
    /// The screw of a motion (u, θ) of the virtual point: θ is along the line, θ × u/θ² on it, and θ · u/θ² the pitch.
    pub(crate) fn of(motion: &Vector6<f64>, length_m: f64) -> Self {
        let u: Vector3<f64> = motion.fixed_rows::<3>(0).into();
        let theta: Vector3<f64> = motion.fixed_rows::<3>(3).into();
        let (way, turn) = (u.norm(), theta.norm() * length_m);
        if turn <= NO_PITCH * way {
            let direction = forward(&(u / way)).into();
            return Self::Translation { direction };
        }
        let square = theta.norm_squared();
        let axis = forward(&theta.normalize()).into();
        let through = theta.cross(&u) / square;
        let through_m = through
            .map(|component| {
                if component.abs() < NO_PITCH * length_m {
                    0.0
                } else {
                    component
                }
            })
            .into();
        let pitch_m = theta.dot(&u) / square;
        if pitch_m.abs() < NO_PITCH * length_m {
            Self::Rotation { axis, through_m }
        } else {
            Self::Screw {
                axis,
                through_m,
                pitch_m,
            }
        }
    }
}

impl fmt::Display for UnseenMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Translation { direction } => write!(f, "translation along {}", triple(direction)),
            Self::Rotation { axis, through_m } => write!(
                f,
                "rotation about the line through {} m along {}",
                triple(through_m),
                triple(axis)
            ),
            Self::Screw {
                axis,
                through_m,
                pitch_m,
            } => write!(
                f,
                "screw about the line through {} m along {} with {} m/rad",
                triple(through_m),
                triple(axis),
                short(*pitch_m)
            ),
        }
    }
}

/// Turned so that the largest component is positive: a line has no sense.
fn forward(direction: &Vector3<f64>) -> Vector3<f64> {
    let largest = direction[direction.iamax()];
    direction.map(|component| {
        let component = if largest < 0.0 { -component } else { component };
        if component.abs() < 1e-9 {
            0.0
        } else {
            component
        }
    })
}

/// What is unseen, and what would help.
pub(crate) fn listed(role: Role, motions: &[UnseenMotion]) -> String {
    let words: Vec<String> = motions.iter().map(ToString::to_string).collect();
    let words = words.join(", nor the ");
    match role {
        Role::Channel => {
            format!("no channel sees the {words}; add one that moves with it, along its direction")
        }
        Role::Impact => format!(
            "no impact drives the {words}; add one whose point moves with it, along its direction"
        ),
    }
}

/// Motions of a space (a row of `basis` for each, k × 6), combined so that as many rotations as can be are about the
/// axes, and what are translations alone stand apart: reduced echelon form with rotations first.
pub(crate) fn plain(basis: &DMatrix<f64>, length_m: f64) -> Vec<UnseenMotion> {
    let order = [3, 4, 5, 0, 1, 2];
    let mut rows = basis.clone();
    let count = rows.nrows();
    for row in 0..count {
        // rotations in scaled units are of the size of translations
        rows.row_mut(row).columns_mut(3, 3).scale_mut(length_m);
    }
    let mut done = 0;
    for &column in &order {
        if done == count {
            break;
        }
        let pivot = (done..count).fold(done, |best, row| {
            if rows[(row, column)].abs() > rows[(best, column)].abs() {
                row
            } else {
                best
            }
        });
        if rows[(pivot, column)].abs() < 1e-6 {
            continue;
        }
        rows.swap_rows(done, pivot);
        let scale = rows[(done, column)];
        for j in 0..6 {
            rows[(done, j)] /= scale;
        }
        for row in (0..count).filter(|&row| row != done) {
            let factor = rows[(row, column)];
            for j in 0..6 {
                let change = factor * rows[(done, j)];
                rows[(row, j)] -= change;
            }
        }
        done += 1;
    }
    let unscaled = |row: usize| {
        Vector6::from_fn(|j, _| {
            if j < 3 {
                rows[(row, j)]
            } else {
                rows[(row, j)] / length_m
            }
        })
    };
    (0..count)
        .map(|row| UnseenMotion::of(&unscaled(row), length_m))
        .collect()
}
