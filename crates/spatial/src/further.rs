//! What a further number would explain that the model does not have: its value, and by how much χ² falls with it. By the score at the
//! estimate (Rao 1948), beside the joint and all errors of the set-up.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::{Assembled, Line};
use crate::dyads::{Lines, descent, product, squares};
use crate::error::SpatialError;
use crate::normal::{Deviations, Normal, residuals};
use crate::parallel::over_lines;
use crate::patterns::Patterns;
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;
use crate::sums::Slopes;
use crate::together::LINES_MAX;

/// A number that the model does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Further {
    /// η of D = K (1 + jη) + jωC.
    LossFactor,
    /// A mass at the joint, kg, on side a or b of the assembly and not of the structure alone.
    Mass(usize),
}

/// What a further number would be.
#[derive(Clone, Debug)]
pub(crate) struct Score {
    pub(crate) value: f64,
    pub(crate) deviation: f64,
    /// By how much χ² falls with it, about.
    pub(crate) gain: f64,
    /// What it does to the joint's unknowns.
    pub(crate) shifts: DVector<f64>,
}

impl Further {
    const ALL: [Self; 3] = [Self::LossFactor, Self::Mass(0), Self::Mass(1)];

    /// What the number does to the functions, rows × columns.
    fn derivatives(
        self,
        assembled: &Assembled<'_>,
        stiffness: &DMatrix<Complex64>,
        (line, at): (usize, &Line),
        motions: Range<usize>,
    ) -> DMatrix<Complex64> {
        match self {
            // ∂D/∂η = jK, ∂Y_C = −a ∂D b
            Self::LossFactor => {
                let left = at.by_joint_loads.columns_range(motions.clone());
                left * stiffness * at.joint_motions.rows_range(motions) * -Complex64::i()
            }
            Self::Mass(side) => assembled.by_mass(side, line, at),
        }
    }
}

/// Sums over lines.
#[derive(Default)]
struct Sums {
    /// 2 Σ w |∂f/∂θ|² of the further number θ.
    information: f64,
    /// 2 Σ w Re conj(∂f/∂θ) e.
    descent: f64,
    /// Likewise of ∂f/∂θ and the derivatives by all other numbers.
    with_others: Slopes,
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.information += other.information;
        self.descent += other.descent;
        self.with_others.add(&other.with_others);
    }
}

/// Each of [`Further::ALL`] that the data say anything of.
pub(crate) fn scores(
    problem: &Problem,
    unknowns: &Unknowns,
    level: &Deviations,
) -> Result<Vec<(Further, Score)>, SpatialError> {
    let thin = problem.thinned(LINES_MAX);
    let assembled = Assembled::new(&thin, unknowns)?;
    let own = thin.count();
    let grids = Lines::of(&thin, level);
    let sought = thin.only()?;
    let [stiffness, _] = sought.matrices(unknowns.0.as_slice())?;
    let stiffness = DMatrix::from_fn(MOTIONS, MOTIONS, |i, j| Complex64::from(stiffness[(i, j)]));
    let parts = over_lines(thin.frequency_hz.len(), |lines| {
        let mut sums = Further::ALL.map(|_| Sums::default());
        for line in lines {
            let found = assembled.line(line)?;
            let groups = assembled.dyads(line, &found);
            let errors = residuals(&thin, line, &found);
            let grid = &*grids.at(line);
            for (further, sums) in Further::ALL.into_iter().zip(&mut sums) {
                let at = (line, &found);
                let by = further.derivatives(&assembled, &stiffness, at, sought.motions());
                sums.information += 2.0 * squares(grid, &by);
                sums.descent += 2.0 * product(grid, &by, &errors);
                let slopes = descent(grid, &groups, &by);
                sums.with_others
                    .add_line(thin.omega(line), MOTIONS * MOTIONS, &slopes);
            }
        }
        Ok::<_, SpatialError>(sums)
    })?;
    let mut sums = Further::ALL.map(|_| Sums::default());
    for part in &parts {
        sums.iter_mut()
            .zip(part)
            .for_each(|(all, own)| all.add(own));
    }
    let patterns = Patterns::of(&thin, &assembled)?;
    let normal = Normal::of(&thin, unknowns, level)?;
    let Some(of_others) = Cholesky::new(normal.information) else {
        return Ok(Vec::new());
    };
    // of each number alone, beside all others
    let score = |(further, sums): (Further, &Sums)| {
        let with_others = patterns.descent(own, &sums.with_others);
        let beside = of_others.solve(&with_others);
        let information = sums.information - beside.dot(&with_others);
        let descent = sums.descent - beside.dot(&normal.descent);
        (information > 0.0).then(|| {
            let value = descent / information;
            let score = Score {
                value,
                deviation: information.sqrt().recip(),
                gain: descent * descent / information,
                shifts: -beside.rows(0, thin.joint_count()) * value,
            };
            (further, score)
        })
    };
    Ok((Further::ALL.into_iter().zip(&sums))
        .filter_map(score)
        .collect())
}
