//! Whether damping that does not grow with the frequency would explain the functions better: a loss factor of the joint, as contact and
//! friction have it.
//!
//! A joint of viscous dampers C that is measured over many frequencies is then too weak at low ones and too strong at high ones, and
//! asks for a joint that feeds energy in a direction that hardly moves. By the score at the estimate, D = K (1 + jη) + jωC at η = 0
//! (Rao 1948).

use nalgebra::{Cholesky, DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::normal::{Deviations, Normal, add_priors};
use crate::parallel::over_lines;
use crate::problem::{Problem, Unknowns};
use crate::together::LINES_MAX;

/// χ² by which a loss factor explains more than noise would.
const BEYOND: f64 = 36.0;

/// A loss factor that is larger is another error.
const MOST: f64 = 1.0;

/// What a loss factor would be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loss {
    factor: f64,
    deviation: f64,
    /// By how much χ² falls with it, about.
    gain: f64,
}

impl Loss {
    /// In a sentence.
    pub(crate) fn warning(&self) -> String {
        let Self {
            factor,
            deviation,
            gain,
        } = self;
        format!(
            "damping of the joint that does not grow with the frequency would fit better: with a loss factor of about {factor:.4} ± \
             {deviation:.1e} χ² falls by {gain:.0}; C stands for such damping near one frequency alone, so identify it over a narrow range \
             ([frequency] from, to)"
        )
    }
}

/// A loss factor of the joint that is sought, where one explains more than noise does.
pub(crate) fn loss(
    problem: &Problem,
    unknowns: &Unknowns,
    level: &Deviations,
) -> Result<Option<Loss>, SpatialError> {
    let thin = problem.thinned(LINES_MAX);
    let sought = thin.only()?;
    let stiffness = sought.first..sought.first + sought.model.count();
    let assembled = Assembled::new(&thin, unknowns)?;
    let count = thin.count();
    let parts = over_lines(thin.frequency_hz.len(), |lines| {
        let mut sums = Normal::zeros(count + 1);
        for line in lines {
            let found = assembled.line(line)?;
            let derivatives = assembled.derivatives(line, &found);
            // ∂D/∂η = jK
            let by_loss = derivatives.columns_range(stiffness.clone())
                * unknowns
                    .0
                    .rows_range(stiffness.clone())
                    .map(Complex64::from)
                * Complex64::I;
            let mut rows = DMatrix::zeros(2 * level.len(), count + 1);
            let mut left = DVector::zeros(2 * level.len());
            for (n, (one, deviation)) in thin.observed.iter().zip(level).enumerate() {
                let weight = std::f64::consts::SQRT_2 / deviation;
                let error = (one.values[line] - found.functions[n]) * weight;
                for column in 0..=count {
                    let own = match column == count {
                        true => by_loss[n],
                        false => derivatives[(n, column)],
                    };
                    let value = own * weight;
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
    let mut sums = Normal::zeros(count + 1);
    parts.iter().for_each(|part| sums.add(part));
    add_priors(&thin, unknowns, &mut sums);
    // of η alone, beside all others
    let of_others = sums.information.view((0, 0), (count, count)).into_owned();
    let Some(of_others) = Cholesky::new(of_others) else {
        return Ok(None);
    };
    let beside = of_others.solve(&sums.information.view((0, count), (count, 1)).into_owned());
    let beside = beside.column(0);
    let information = sums.information[(count, count)]
        - beside.dot(&sums.information.view((0, count), (count, 1)).column(0));
    let descent = sums.descent[count] - beside.dot(&sums.descent.rows(0, count));
    if information.is_nan() || information <= 0.0 {
        return Ok(None);
    }
    let loss = Loss {
        factor: descent / information,
        deviation: information.sqrt().recip(),
        gain: descent * descent / information,
    };
    Ok(Some(loss).filter(|loss| loss.gain > BEYOND && (0.0..MOST).contains(&loss.factor)))
}
