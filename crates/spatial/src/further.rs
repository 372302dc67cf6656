//! What a further number would explain that the model does not have: its value, and by how much χ² falls with it. By the score at the
//! estimate (Rao 1948), beside the joint and all errors of the set-up.

use nalgebra::{Cholesky, DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::{Assembled, Line};
use crate::error::SpatialError;
use crate::normal::{Deviations, Normal, add_priors};
use crate::parallel::over_lines;
use crate::problem::{Problem, Unknowns};
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

    /// What the number does to the observed functions.
    fn derivatives(
        self,
        assembled: &Assembled<'_>,
        problem: &Problem,
        unknowns: &Unknowns,
        of_all: &DMatrix<Complex64>,
        (line, at): (usize, &Line),
    ) -> Result<DVector<Complex64>, SpatialError> {
        Ok(match self {
            // ∂D/∂η = jK
            Self::LossFactor => {
                let sought = problem.only()?;
                let stiffness = sought.first..sought.first + sought.model.count();
                let values = unknowns.0.rows_range(stiffness.clone());
                of_all.columns_range(stiffness) * values.map(|k| Complex64::new(0.0, k))
            }
            Self::Mass(side) => assembled.by_mass(side, line, at),
        })
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
    let count = own + Further::ALL.len();
    let parts = over_lines(thin.frequency_hz.len(), |lines| {
        let mut sums = Normal::zeros(count);
        for line in lines {
            let found = assembled.line(line)?;
            let of_own = assembled.derivatives(line, &found);
            let mut all = of_own.clone().resize_horizontally(count, Complex64::ZERO);
            for (n, further) in Further::ALL.into_iter().enumerate() {
                let at = (line, &found);
                let by = further.derivatives(&assembled, &thin, unknowns, &of_own, at)?;
                all.set_column(own + n, &by);
            }
            let mut rows = DMatrix::zeros(2 * level.len(), count);
            let mut left = DVector::zeros(2 * level.len());
            for (n, (one, deviation)) in thin.observed.iter().zip(level).enumerate() {
                let weight = std::f64::consts::SQRT_2 / deviation;
                let error = (one.values[line] - found.functions[n]) * weight;
                for column in 0..count {
                    let value = all[(n, column)] * weight;
                    rows[(2 * n, column)] = value.re;
                    rows[(2 * n + 1, column)] = value.im;
                }
                left[2 * n] = error.re;
                left[2 * n + 1] = error.im;
            }
            sums.information += rows.tr_mul(&rows);
            sums.descent += rows.tr_mul(&left);
        }
        Ok::<Normal, SpatialError>(sums)
    })?;
    let mut sums = Normal::zeros(count);
    parts.iter().for_each(|part| sums.add(part));
    add_priors(&thin, unknowns, &mut sums);
    let of_others = sums.information.view((0, 0), (own, own)).into_owned();
    let Some(of_others) = Cholesky::new(of_others) else {
        return Ok(Vec::new());
    };
    let score = |(n, further): (usize, Further)| {
        let place = own + n;
        // of this number alone, beside all others
        let with_others = sums
            .information
            .view((0, place), (own, 1))
            .column(0)
            .into_owned();
        let beside = of_others.solve(&with_others);
        let information = sums.information[(place, place)] - beside.dot(&with_others);
        let descent = sums.descent[place] - beside.dot(&sums.descent.rows(0, own));
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
    Ok((Further::ALL.into_iter().enumerate())
        .filter_map(score)
        .collect())
}
