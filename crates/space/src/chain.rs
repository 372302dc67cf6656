//! Whether measurements tell two joints of a chain apart.
//!
//! Two joints with a light and stiff part between them are springs in series: only the sum of their compliances is
//! seen, and a change of one is undone by a change of the other. What counts is by how much the deviations of one
//! joint's numbers grow since the other's are unknown too.

use nalgebra::{DMatrix, DVector};

use crate::SpaceError;

/// What the Jacobians of two joints say of each other.
#[derive(Clone, Debug, PartialEq)]
pub struct ToldApart {
    /// Rank of each joint's Jacobian.
    pub ranks: [usize; 2],
    /// How many unknowns each joint has.
    pub unknowns: [usize; 2],
    /// c: largest canonical correlation of what changes of the joints do. 1 if some change of one joint looks like one
    /// of the other.
    pub correlation: f64,
    /// 1 − c², the square of the sine of the smallest angle between both, with all its digits.
    pub apart: f64,
    /// By how much the other joint's unknowns make each deviation grow; None if the joints are not told apart.
    pub growth: Option<[Vec<f64>; 2]>,
}

impl ToldApart {
    /// From the derivatives of the same residuals by the unknowns of joint 1 and of joint 2: a row for each residual,
    /// real and imaginary parts apart, divided by its deviation. What is known beforehand stands in rows of its own.
    ///
    /// The unit of an unknown is of no account.
    ///
    /// # Errors
    ///
    /// [`SpaceError::TooFew`] without unknowns, [`SpaceError::Size`] for Jacobians with different rows,
    /// [`SpaceError::NotFinite`].
    pub fn of(first: &DMatrix<f64>, second: &DMatrix<f64>) -> Result<Self, SpaceError> {
        let rows = first.nrows();
        if second.nrows() != rows {
            let what = "rows of the second joint's Jacobian";
            return Err(SpaceError::Size {
                what,
                found: second.nrows(),
                expected: rows,
            });
        }
        for jacobian in [first, second] {
            if jacobian.is_empty() {
                return Err(SpaceError::TooFew {
                    what: "derivatives of a joint's Jacobian",
                    found: 0,
                    least: 1,
                });
            }
            if !jacobian.iter().all(|number| number.is_finite()) {
                return Err(SpaceError::NotFinite {
                    what: "a joint's Jacobian",
                });
            }
        }
        let scaled = compressed(&normalised(first), &normalised(second));
        let [one, other] = [range(&scaled[0]), range(&scaled[1])];
        let unknowns = [first.ncols(), second.ncols()];
        let ranks = [one.ncols(), other.ncols()];
        let [correlation, sine] = angle(&one, &other);
        // A direction whose sine is no more than rounding is common to both.
        let is_told =
            ranks == unknowns && rows >= unknowns[0] + unknowns[1] && sine > rounding(rows);
        let growth = is_told.then(|| {
            let [a, b] = [
                growth(&scaled[0], &scaled[1]),
                growth(&scaled[1], &scaled[0]),
            ];
            a.zip(b).map(|(a, b)| [a, b])
        });
        Ok(Self {
            ranks,
            unknowns,
            correlation,
            apart: sine * sine,
            growth: growth.flatten(),
        })
    }

    /// Whether all numbers of both joints can be found at all. How well says [`Self::median_growth`].
    #[must_use]
    pub fn is_told(&self) -> bool {
        self.growth.is_some()
    }

    /// Median growth of the deviations of each joint; infinite if the joints are not told apart.
    #[must_use]
    pub fn median_growth(&self) -> [f64; 2] {
        self.summary(|ascending| {
            let (low, high) = (
                ascending[(ascending.len() - 1) / 2],
                ascending[ascending.len() / 2],
            );
            0.5 * (low + high)
        })
    }

    /// Largest growth of the deviations of each joint; infinite if the joints are not told apart.
    #[must_use]
    pub fn largest_growth(&self) -> [f64; 2] {
        self.summary(|ascending| ascending[ascending.len() - 1])
    }

    fn summary(&self, of: impl Fn(&[f64]) -> f64) -> [f64; 2] {
        let Some(growth) = &self.growth else {
            return [f64::INFINITY; 2];
        };
        [0, 1].map(|joint| {
            let mut ascending = growth[joint].clone();
            ascending.sort_by(f64::total_cmp);
            of(&ascending)
        })
    }
}

/// Sines and singular values below this are rounding.
fn rounding(rows: usize) -> f64 {
    rows as f64 * 4.0 * f64::EPSILON
}

/// The same with columns of length one; columns of zeros stay.
fn normalised(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let sizes: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |i, j| {
        if sizes[j] > 0.0 {
            jacobian[(i, j)] / sizes[j]
        } else {
            0.0
        }
    })
}

/// Both in the basis of the Q of their QR: angles and lengths are the same, and rows that only repeat others are gone.
fn compressed(one: &DMatrix<f64>, other: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
    let (before, count) = (one.ncols(), other.ncols());
    let mut both = DMatrix::zeros(one.nrows(), before + count);
    both.columns_mut(0, before).copy_from(one);
    both.columns_mut(before, count).copy_from(other);
    let r = both.qr().r();
    [
        r.columns(0, before).into_owned(),
        r.columns(before, count).into_owned(),
    ]
}

/// Orthonormal columns that span what the columns span.
fn range(scaled: &DMatrix<f64>) -> DMatrix<f64> {
    let Some(svd) = bolted_joint_singular::real(scaled.clone()) else {
        return DMatrix::zeros(scaled.nrows(), 0);
    };
    let least = rounding(scaled.nrows().max(scaled.ncols())) * svd.singular_values.max();
    let used: Vec<usize> = (0..svd.singular_values.len())
        .filter(|&n| svd.singular_values[n] > least)
        .collect();
    svd.u.map_or_else(
        || DMatrix::zeros(scaled.nrows(), 0),
        |u| u.select_columns(&used),
    )
}

/// Cosine and sine of the smallest angle between two spaces, each with all its digits (Björck and Golub 1973).
fn angle(one: &DMatrix<f64>, other: &DMatrix<f64>) -> [f64; 2] {
    if one.ncols() == 0 || other.ncols() == 0 {
        return [0.0, 1.0];
    }
    // The sine is that of the space of fewer dimensions: its part outside of the other one.
    let (less, more) = if one.ncols() < other.ncols() {
        (one, other)
    } else {
        (other, one)
    };
    let mut outside = less - more * (more.transpose() * less);
    outside -= more * (more.transpose() * &outside);
    let values = |matrix| bolted_joint_singular::real(matrix).map(|svd| svd.singular_values);
    let Some((cosines, sines)) = values(one.transpose() * other).zip(values(outside)) else {
        return [0.0, 1.0];
    };
    [cosines.max().min(1.0), sines.min().min(1.0)]
}

/// √([(JᵀJ)⁻¹]_kk of both joints' J over that of the one joint's J alone), by R of QR.
fn growth(scaled: &DMatrix<f64>, other: &DMatrix<f64>) -> Option<Vec<f64>> {
    let (count, before) = (scaled.ncols(), other.ncols());
    let mut both = DMatrix::zeros(scaled.nrows(), before + count);
    both.columns_mut(0, before).copy_from(other);
    both.columns_mut(before, count).copy_from(scaled);
    let alone = deviations(scaled.clone().qr().r())?;
    // The last block of R belongs to what the other joint's columns leave of this one's.
    let beside = deviations(
        both.qr()
            .r()
            .view((before, before), (count, count))
            .into_owned(),
    )?;
    Some(beside.component_div(&alone).iter().copied().collect())
}

/// Lengths of the rows of R⁻¹.
fn deviations(r: DMatrix<f64>) -> Option<DVector<f64>> {
    let count = r.ncols();
    let inverse = r.solve_upper_triangular(&DMatrix::identity(count, count))?;
    let lengths = DVector::from_iterator(count, inverse.row_iter().map(|row| row.norm()));
    lengths
        .iter()
        .all(|length| length.is_finite())
        .then_some(lengths)
}

#[cfg(test)]
mod tests;
