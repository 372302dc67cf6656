//! What the data tell of the unknowns: their covariance, and which of them nothing in the data depends on.
//!
//! A law that slips has unknowns that matter from some amplitude on. Below it the data say nothing of them, and all of the
//! others as if they were known.

use bolted_joint_identify::unit_covariance;
use nalgebra::DMatrix;

use super::fit::Fit;
use super::model::{Model, ResponseUnknown, Values};

/// Information of the logarithm of a law's number below which there is none: that number could be any power of ten.
const SILENT: f64 = 1e-12;
/// Part of itself by which a number has to follow an unknown that nothing is told of to be as little known.
const FOLLOWS: f64 = 1e-6;

/// Covariance of the unknowns as they are searched; those that the data say nothing of are taken as known, and are named.
pub(super) struct Searched {
    pub(super) covariance: DMatrix<f64>,
    is_silent: Vec<bool>,
}

impl Searched {
    /// With variances `factor` times those of the information.
    pub(super) fn of(model: &Model, fit: &Fit, factor: f64) -> Self {
        let size = model.unknowns.len();
        let own = fit.information.diagonal();
        let is_silent = |(place, unknown): (usize, &ResponseUnknown)| match unknown {
            ResponseUnknown::Slider(_) => own[place] < SILENT,
            _ => own[place] <= 0.0,
        };
        let unknowns = model.unknowns.iter().enumerate();
        let is_silent: Vec<bool> = unknowns.map(is_silent).collect();
        let told: Vec<usize> = (0..size).filter(|&place| !is_silent[place]).collect();
        let count = told.len();
        let information =
            DMatrix::from_fn(count, count, |i, j| fit.information[(told[i], told[j])]);
        let mut covariance = DMatrix::zeros(size, size);
        if count > 0 {
            // The covariance of χ²'s information is its inverse; the function gives half of it.
            let of_told = 2.0 * factor * unit_covariance(&information);
            for (i, &row) in told.iter().enumerate() {
                for (j, &column) in told.iter().enumerate() {
                    covariance[(row, column)] = of_told[(i, j)];
                }
            }
        }
        Self {
            covariance,
            is_silent,
        }
    }

    /// With deviations so many times as large.
    pub(super) fn raised(mut self, by: &[f64]) -> Self {
        for (i, row) in by.iter().enumerate() {
            for (j, column) in by.iter().enumerate() {
                self.covariance[(i, j)] *= row * column;
            }
        }
        self
    }

    /// Whether a number that is told depends on nothing but what the data say something of; `by` are the derivatives of all
    /// (rows) by what is searched. What is searched in the place of a law's number is not that number, but one of its logarithms.
    pub(super) fn tells(
        &self,
        (place, unknown): (usize, ResponseUnknown),
        by: &DMatrix<f64>,
        value: f64,
    ) -> bool {
        if !matches!(unknown, ResponseUnknown::Slider(_)) {
            return !self.is_silent[place];
        }
        // a number that is above zero by its nature and yet zero is an exponential of something
        let least = FOLLOWS * value.abs();
        let follows = |column: usize| by[(place, column)].abs() > least || value == 0.0;
        let mut silent = (0..self.is_silent.len()).filter(|&column| self.is_silent[column]);
        silent.all(|column| !follows(column))
    }
}

/// Derivatives of the unknowns as they are told (rows) by those that are searched, which are logarithms of a law that slips.
pub(super) fn by_searched(model: &Model, values: &Values) -> DMatrix<f64> {
    let size = model.unknowns.len();
    let mut by = DMatrix::identity(size, size);
    let Some(slider) = &values.slider else {
        return by;
    };
    let own = slider.parameters();
    let index = |unknown: &ResponseUnknown| match unknown {
        ResponseUnknown::Slider(parameter) => slider.index(*parameter),
        _ => None,
    };
    for (row, unknown) in model.unknowns.iter().enumerate() {
        let Some(told) = index(unknown) else {
            continue;
        };
        for (column, searched) in model.unknowns.iter().enumerate() {
            if let Some(searched) = index(searched) {
                by[(row, column)] = own[told].1[searched];
            }
        }
    }
    by
}
