//! How what a motion leaves of a record grows with the model's unknowns and with its release: by central differences.
//!
//! The release follows the unknowns, so that what is left of both is the information of the unknowns alone.

use bolted_joint_dynamics::law::Term;
use bolted_joint_identify::parallel;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::release::{self, Course};
use super::rows::Normal;
use super::search::{Run, Search};
use crate::response::decay::motion::Release;
use crate::response::model::{ResponseUnknown, Values};

/// First step of a difference: of a law's logarithms, and as part of others.
const DIFFERENCE: f64 = 1e-3;
/// Change of a residual, in standard deviations of one number, beyond which a difference is taken anew over less, what it then
/// is, and how often.
const FAR: f64 = 2.0;
const NEAR: f64 = 0.3;
const ANEW: usize = 5;

/// How the residual of a record grows with the unknowns and with its release.
pub(super) struct Slopes {
    by_unknown: DMatrix<f64>,
    pub(super) by_release: DMatrix<f64>,
    /// Information of the release, and of it (rows) with the unknowns.
    pub(super) of_release: Matrix2<f64>,
    pub(super) between: DMatrix<f64>,
    /// Of the unknowns, the release following.
    information: DMatrix<f64>,
}

/// What a difference is taken by.
#[derive(Clone, Copy)]
enum By {
    Unknown(ResponseUnknown),
    /// So much of displacement (m) or time (s).
    Release([f64; 2]),
}

impl Slopes {
    /// About a place; `None` where a motion near it is none of a decay.
    pub(super) fn about(
        search: &Search<'_>,
        values: &Values,
        run: &Run<'_>,
        course: &Course,
    ) -> Option<Self> {
        let at = |values: &Values, release: Release| {
            search.course(values, release, run).map(|own| own.residual)
        };
        let by_unknown = |unknown: ResponseUnknown| {
            let size = values
                .clone()
                .place(unknown)
                .map_or(0.0, |place| place.abs());
            let mut step = match unknown {
                ResponseUnknown::Slider(_) => DIFFERENCE,
                ResponseUnknown::Term(term) => DIFFERENCE * size_of(values, course, term).max(size),
                ResponseUnknown::JointDamping | ResponseUnknown::SupportDamping => {
                    DIFFERENCE * (1e-3 * values.mass * run.grid.omega).max(size)
                }
                _ => DIFFERENCE * size,
            };
            for _ in 0..ANEW {
                (step.is_finite() && step > 0.0).then_some(())?;
                let mut sides = [*values; 2];
                for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                    *side.place(unknown)? += sign * step;
                }
                let [above, below] = sides.map(|side| at(&side, course.release));
                let change = above? - below?;
                let size = change.norm();
                if size < FAR {
                    return Some(change / (2.0 * step));
                }
                step *= NEAR / size;
            }
            None
        };
        let by_release = |change: [f64; 2]| {
            let [above, below] = [1.0, -1.0].map(|sign| {
                let moved = release::moved(&course.release, change.map(|own| sign * own));
                at(values, moved)
            });
            Some((above? - below?) / (2.0 * (change[0] + change[1])))
        };
        let [by_displacement, by_time] = release::steps(&course.release, &run.grid);
        let of_release = [[by_displacement, 0.0], [0.0, by_time]].map(By::Release);
        let of_unknowns = search.model.unknowns.iter().copied().map(By::Unknown);
        let all: Vec<By> = of_release.into_iter().chain(of_unknowns).collect();
        let columns = parallel::map(&all, |by| match *by {
            By::Unknown(unknown) => by_unknown(unknown),
            By::Release(change) => by_release(change),
        });
        let columns: Vec<DVector<f64>> = columns.into_iter().collect::<Option<_>>()?;
        let (of_release, of_unknowns) = columns.split_at_checked(of_release.len())?;
        Self::of(
            DMatrix::from_columns(of_unknowns),
            DMatrix::from_columns(of_release),
        )
    }

    fn of(by_unknown: DMatrix<f64>, by_release: DMatrix<f64>) -> Option<Self> {
        let square = by_release.transpose() * &by_release;
        let of_release = Matrix2::from_fn(|i, j| square[(i, j)]);
        let between = by_release.transpose() * &by_unknown;
        let inverse = of_release.try_inverse()?;
        let inverse = DMatrix::from_fn(2, 2, |i, j| inverse[(i, j)]);
        // H = JᵀJ − JᵀK (KᵀK)⁻¹ KᵀJ
        let information =
            by_unknown.transpose() * &by_unknown - between.transpose() * inverse * &between;
        let is_finite = information.iter().all(|entry| entry.is_finite());
        is_finite.then_some(Self {
            by_unknown,
            by_release,
            of_release,
            between,
            information,
        })
    }

    /// With the residual of a course.
    pub(super) fn normal(&self, course: &Course) -> Normal {
        let of_release = self.by_release.transpose() * &course.residual;
        let right = Vector2::new(of_release[0], of_release[1]);
        let solved = self.of_release.lu().solve(&right).unwrap_or_default();
        let solved = DVector::from_column_slice(&[solved[0], solved[1]]);
        Normal {
            information: self.information.clone(),
            gradient: self.by_unknown.transpose() * &course.residual
                - self.between.transpose() * &solved,
            chi_squared: course.chi_squared() - of_release.dot(&solved),
        }
    }
}

/// What a term would be that makes a thousandth of the load or of the damping of the motion.
fn size_of(values: &Values, course: &Course, term: Term) -> f64 {
    let part = match term.is_damper() {
        false => values.relative_stiffness(),
        true => values.relative_stiffness().abs().sqrt() * values.mass.sqrt(),
    };
    1e-3 * part.abs()
        / course
            .release
            .displacement_m
            .abs()
            .powi(term.amplitude_power())
}
