//! The motion beside a record, and where it began: at a turn just before the first sample. Displacement and time of that are
//! unknown beside the model's numbers, and so is the sensor's offset.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2, Vector3};
use num_complex::Complex64;

use crate::response::decay::motion::{self, Direction, Grid, Release, sampled};
use crate::response::decay::recorded::Recorded;
use crate::response::model::Values;

/// Periods that the first guess is taken from.
const GUESSED_FROM: f64 = 2.0;
/// Periods that it is improved by, one after the other, and how often.
const IMPROVED_BY: [f64; 2] = [3.0, 12.0];
const IMPROVEMENTS: usize = 4;
/// Part of a sample's distance by which a release may lie behind the first sample at first.
const BEHIND: f64 = 0.25;

/// A motion beside a record.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Course {
    pub(super) release: Release,
    /// What the record has beyond it, less its mean, in standard deviations of the noise.
    pub(super) residual: DVector<f64>,
}

impl Course {
    /// Of a lap with these values, without what is in the span of `beside`, which has an offset; `None` where that moves as no decay
    /// does.
    pub(super) fn of(
        values: &Values,
        release: Release,
        (record, beside): (&Recorded, Option<&DMatrix<f64>>),
        grid: &Grid,
    ) -> Option<Self> {
        let own = sampled(values, &release, record, grid)?;
        let pairs = record.values.iter().zip(&own);
        let beyond = pairs.map(|(measured, own)| (measured - own) / record.noise);
        let mut residual = DMatrix::from_iterator(own.len(), 1, beyond);
        project(&mut residual, beside);
        let residual = residual.column(0).into_owned();
        let is_finite = residual.iter().all(|entry| entry.is_finite());
        is_finite.then_some(Self { release, residual })
    }

    pub(super) fn chi_squared(&self) -> f64 {
        self.residual.norm_squared()
    }
}

/// How that residual changes along each direction, a column for each.
pub(super) fn changes(
    values: &Values,
    release: Release,
    (record, beside): (&Recorded, Option<&DMatrix<f64>>),
    grid: &Grid,
    directions: &[Direction],
) -> Option<DMatrix<f64>> {
    let mut columns = motion::changes(values, &release, record, grid, directions)?;
    columns /= -record.noise;
    project(&mut columns, beside);
    columns
        .iter()
        .all(|entry| entry.is_finite())
        .then_some(columns)
}

/// Takes from each column what is in the span of `beside`, or the offset that fits best.
fn project(columns: &mut DMatrix<f64>, beside: Option<&DMatrix<f64>>) {
    match beside {
        None => {
            for mut column in columns.column_iter_mut() {
                let mean = column.mean();
                column.add_scalar_mut(-mean);
            }
        }
        Some(beside) => {
            let within = beside.tr_mul(columns);
            columns.gemm(-1.0, beside, &within, 1.0);
        }
    }
}

/// The release moved by so much.
pub(super) fn moved(release: &Release, change: [f64; 2]) -> Release {
    Release {
        displacement_m: release.displacement_m + change[0],
        time_s: release.time_s + change[1],
    }
}

/// Where a record began that falls at this rate (1/s) at first: `None` where that is not found.
pub(super) fn found(values: &Values, record: &Recorded, grid: &Grid, rate: f64) -> Option<Release> {
    let mut release = guessed(record, grid.omega, rate)?;
    for periods in IMPROVED_BY {
        let samples = (periods * TAU / grid.omega / record.interval_s) as usize;
        let part = grid.up_to(samples);
        for _ in 0..IMPROVEMENTS {
            release = improved(values, record, &part, &release)?;
        }
    }
    Some(release)
}

/// From x = e^(−δt) (a cos ωt + b sin ωt) + c over the first periods.
fn guessed(record: &Recorded, omega: f64, rate: f64) -> Option<Release> {
    let count = (GUESSED_FROM * TAU / omega / record.interval_s) as usize;
    let first = record.values.get(..count)?;
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (n, value) in first.iter().enumerate() {
        let time_s = record.interval_s * n as f64;
        let (sine, cosine) = (omega * time_s).sin_cos();
        let falls = (-rate * time_s).exp();
        let row = Vector3::new(falls * cosine, falls * sine, 1.0);
        normal += row * row.transpose();
        right += row * *value;
    }
    let found = normal.lu().solve(&right)?;
    // x = Re X e^(jωt), of which the displacement is (jω)^(−order) X over the share
    let order = record.quantity.order();
    let derived = Complex64::new(0.0, omega).powi(order) * record.share;
    let displacement = Complex64::new(found[0], -found[1]) / derived;
    // it turns where ωt + arg is a multiple of π: the last one before the first sample, or just behind it
    let latest = BEHIND * omega * record.interval_s;
    let half_turns = ((latest + displacement.arg()) / PI).floor();
    let angle = half_turns * PI - displacement.arg();
    let time_s = angle / omega;
    let sign = if half_turns.rem_euclid(2.0) < 0.5 {
        1.0
    } else {
        -1.0
    };
    Some(Release {
        displacement_m: sign * displacement.norm() * (-rate * time_s).exp(),
        time_s,
    })
}

/// One step of Gauss and Newton.
fn improved(values: &Values, record: &Recorded, grid: &Grid, from: &Release) -> Option<Release> {
    let own = Course::of(values, *from, (record, None), grid)?;
    let directions = [Direction::Displacement, Direction::Time];
    let both = changes(values, *from, (record, None), grid, &directions)?;
    let both = [both.column(0), both.column(1)];
    let normal = Matrix2::from_fn(|i, j| both[i].dot(&both[j]));
    let right = Vector2::from_fn(|i, _| -both[i].dot(&own.residual));
    let change = normal.lu().solve(&right)?;
    let release = moved(from, [change[0], change[1]]);
    let is_finite = release.displacement_m.is_finite() && release.time_s.is_finite();
    is_finite.then_some(release)
}
