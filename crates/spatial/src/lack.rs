//! Whether what is left is noise: noise of a channel knows nothing of the others, while all that a model leaves out moves the interface
//! as the rigid body that it is.
//!
//! Where no noise is stated its level is that of the residuals, and χ² cannot tell. So residuals over the channels of an interface are
//! split into what a rigid motion explains and what none does, and those over its impacts likewise: for noise both are alike by their
//! degrees of freedom. Where coherence tells the noise of each value, values count by it: one that is known worst would stand for all.
//! Hits beside those of the other test, masses of bolts or noise of the parts are in the first alone (a test of
//! lack of fit, with the second as pure error).

use bolted_joint_virtual_point::Role;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::level::sizes;
use crate::normal::Deviations;
use crate::problem::{Problem, Unknowns};

/// Lines that are looked at.
const LINES: usize = 200;

/// Ratio of both, above which what is left is no noise: values of noise that is not alike at all lines leave it near 1.
pub(crate) const LACKING: f64 = 1.4;

/// Residuals of this part of the functions are rounding, or nearly so.
pub(crate) const ROUNDING: f64 = 1e-5;

/// Likewise, above which deviations say nothing any more: they may be too small by a factor of three.
const HOPELESS: f64 = 9.0;

/// What is said where residuals are no noise.
pub(crate) enum Told {
    /// Beside a result.
    Warning(String),
    /// Against it.
    Reason(String),
}

/// What is said of these.
pub(crate) fn told(problem: &Problem, unknowns: &Unknowns) -> Result<Option<Told>, SpatialError> {
    let ratio = of(problem, unknowns)?;
    Ok((ratio > LACKING).then(|| {
        let text = format!(
            "what is left is no noise: the interface moves in it as a rigid body, {ratio:.1} times as much as noise would make it; something \
             is left out (hits or sensors beside their places in the other tests, masses of bolts, noise of a and b), and deviations \
             are too small, by a factor of up to {:.1}",
            ratio.sqrt()
        );
        match ratio > HOPELESS {
            true => Told::Reason(text),
            false => Told::Warning(text),
        }
    }))
}

/// How much more the interface moves as a rigid body in what is left than noise would make it.
pub(crate) fn of(problem: &Problem, unknowns: &Unknowns) -> Result<f64, SpatialError> {
    let [over_channels, over_impacts] = of_each(problem, unknowns)?;
    Ok(over_channels.max(over_impacts))
}

/// Likewise over channels and over impacts: what hits do wrong is rigid over channels, and what sensors do over impacts.
pub(crate) fn of_each(problem: &Problem, unknowns: &Unknowns) -> Result<[f64; 2], SpatialError> {
    ratios(&problem.thinned(LINES), unknowns, &sizes(problem))
}

/// 0 where no interface has more channels, or impacts, than motions.
fn ratios(
    problem: &Problem,
    unknowns: &Unknowns,
    rms: &Deviations,
) -> Result<[f64; 2], SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let [a, b] = &problem.sides;
    let size = [
        a.responses.len() + b.responses.len(),
        a.references.len() + b.references.len(),
    ];
    // residuals in parts of each function's r.m.s., or of its noise at a line where that is told; none where nothing was measured
    let is_told = problem.is_told();
    let sizes_at = |line: usize| {
        let mut sizes = DMatrix::from_element(size[0], size[1], f64::NAN);
        for (one, rms) in problem.observed.iter().zip(rms) {
            let told = one.told.filter(|_| is_told);
            let own = told.map_or(*rms, |level| level * one.uneven(line));
            sizes[(one.at[0], one.at[1])] = own;
        }
        sizes
    };
    let splits_of = |sizes: &DMatrix<f64>| {
        [Role::Channel, Role::Impact].map(|role| splits(problem, role, sizes))
    };
    let mut of_size = sizes_at(0);
    let mut splits = splits_of(&of_size);
    let mut sums = [[0.0; 2]; 2];
    let mut squares = 0.0;
    for line in 0..problem.frequency_hz.len() {
        if is_told && line > 0 {
            of_size = sizes_at(line);
            splits = splits_of(&of_size);
        }
        let computed = assembled.line(line)?.functions;
        let mut left = DMatrix::from_element(size[0], size[1], Complex64::ZERO);
        for ((one, computed), rms) in problem.observed.iter().zip(computed).zip(rms) {
            let at = (one.at[0], one.at[1]);
            let residual = one.values[line] - computed;
            left[at] = residual / of_size[at];
            squares += (residual / *rms).norm_sqr();
        }
        for (role, splits) in splits.iter().enumerate() {
            for split in splits {
                let own = match role {
                    0 => left
                        .column(split.other)
                        .rows(split.first, split.count())
                        .into_owned(),
                    _ => left
                        .row(split.other)
                        .columns(split.first, split.count())
                        .transpose(),
                };
                let rigid = split.basis.tr_mul(&own).norm_squared();
                sums[role][0] += rigid / split.basis.ncols() as f64;
                sums[role][1] +=
                    (own.norm_squared() - rigid) / (split.count() - split.basis.ncols()) as f64;
            }
        }
    }
    if squares < ROUNDING * ROUNDING * (problem.numbers() / 2) as f64 {
        return Ok([0.0; 2]);
    }
    Ok(sums.map(|[rigid, other]| if other > 0.0 { rigid / other } else { 0.0 }))
}

/// Channels of an interface for one impact, or the other way round.
struct Split {
    /// Its row or column.
    other: usize,
    /// The first of the channels, or of the impacts.
    first: usize,
    /// What rigid motions make of them, orthonormal.
    basis: DMatrix<Complex64>,
}

impl Split {
    fn count(&self) -> usize {
        self.basis.nrows()
    }
}

fn splits(problem: &Problem, role: Role, rms: &DMatrix<f64>) -> Vec<Split> {
    let skips = problem.skips();
    let mut all = Vec::new();
    for (side, skip) in problem.sides.iter().zip([[0, 0], skips]) {
        let Some((placed, set_up)) = side.points() else {
            continue;
        };
        let of = match role {
            Role::Channel => 0,
            Role::Impact => 1,
        };
        // of a plane some columns are empty
        let rigid = set_up.places(role).matrix();
        let moved: Vec<usize> = (0..rigid.ncols())
            .filter(|&motion| rigid.column(motion).amax() > 0.0)
            .collect();
        let rigid = rigid.select_columns(&moved);
        let (count, motions) = rigid.shape();
        let first = skip[of] + placed.first[of];
        let others = if of == 0 { rms.ncols() } else { rms.nrows() };
        for other in (0..others).filter(|_| count > motions) {
            let sizes: DVector<f64> = match of {
                0 => rms.column(other).rows(first, count).into_owned(),
                _ => rms.row(other).columns(first, count).transpose(),
            };
            if sizes.iter().any(|size| size.is_nan() || *size <= 0.0) {
                continue;
            }
            let scaled = DMatrix::from_fn(count, motions, |i, j| rigid[(i, j)] / sizes[i]);
            all.push(Split {
                other,
                first,
                basis: scaled.qr().q().map(Complex64::from),
            });
        }
    }
    all
}
