//! What natural frequencies say of the parameters of a lap model: which of them, and otherwise which combinations.

use nalgebra::DMatrix;

use super::super::parameter::{LapParameter, LapParameters};
use super::problem::{Range, UpdateProblem};

/// Singular values below this fraction of the largest are none.
const RANK: f64 = 1e-10;
/// How near to a bound a parameter counts as lying on it, as a fraction of the range.
const AT_BOUND: f64 = 1e-9;

/// What the frequencies say of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knowledge {
    /// It was stated beforehand.
    Stated,
    /// The frequencies determine it.
    Determined,
    /// The frequencies determine it only together with others: its value is one of many, the one nearest to the prior.
    Together,
    /// It was driven to a bound of its range, which its value is.
    AtBound,
    /// It follows from the frequencies and from the bounds that others are held at.
    FromBounds,
    /// The frequencies do not depend on it: its value is its prior.
    NoInfluence,
}

impl Knowledge {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Stated => "stated beforehand",
            Self::Determined => "determined",
            Self::Together => "not determined by itself, nearest to its prior",
            Self::AtBound => "at its bound",
            Self::FromBounds => "follows from the others' bounds",
            Self::NoInfluence => "not identifiable, at its prior",
        }
    }

    /// Whether the value is more than a prior or a bound.
    #[must_use]
    pub fn is_known(self) -> bool {
        matches!(self, Self::Stated | Self::Determined)
    }
}

/// A combination of parameters that the frequencies determine by themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Its formula.
    pub formula: &'static str,
    /// Its value, 1/s².
    pub value: f64,
    /// One standard deviation, 1/s², where that of the frequencies is stated.
    pub standard_deviation: Option<f64>,
}

/// What the frequencies at one torque say.
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// Of each parameter, in the order of [`LapParameter::ALL`].
    pub parameters: [Knowledge; 6],
    /// Combinations that they determine, straight from the measured frequencies.
    pub combinations: Vec<Combination>,
    /// The same combinations with the updated parameters: another value means that the bounds do not admit the measured one.
    pub updated: Vec<f64>,
    /// One standard deviation of the free parameters that are determined, zero of those stated.
    pub standard_deviation: [Option<f64>; 6],
}

impl Identifiability {
    pub(super) fn of(
        problem: &UpdateProblem,
        solution: &LapParameters,
        relative_deviation: Option<f64>,
    ) -> Self {
        let free = problem.free();
        // Bounds that hold a parameter take it out of the search.
        let at_bound = |parameter: LapParameter| match problem.ranges[parameter.index()] {
            Range::Between { low, high, .. } => {
                let place = (solution.of(parameter) / low).ln() / (high / low).ln();
                parameter.moves_frequencies() && !(AT_BOUND..=1.0 - AT_BOUND).contains(&place)
            }
            _ => false,
        };
        let inner: Vec<usize> = (0..free.len()).filter(|&j| !at_bound(free[j])).collect();
        let sensitivity = problem.sensitivity(solution);
        let jacobian = DMatrix::from_fn(sensitivity.len(), inner.len(), |i, j| {
            sensitivity[i][inner[j]]
        });
        let known = known_share(&jacobian);
        let any_bound = inner.len() < free.len();
        let of = |parameter: LapParameter| {
            if let Range::Known(_) = problem.ranges[parameter.index()] {
                return Knowledge::Stated;
            }
            if at_bound(parameter) {
                return Knowledge::AtBound;
            }
            let place = inner.iter().position(|&j| free[j] == parameter);
            match place.map(|place| known[place]) {
                None | Some(0.0) => Knowledge::NoInfluence,
                Some(share) if share > 1.0 - 1e-9 && any_bound => Knowledge::FromBounds,
                Some(share) if share > 1.0 - 1e-9 => Knowledge::Determined,
                Some(_) => Knowledge::Together,
            }
        };
        let parameters = LapParameter::ALL.map(of);
        let deviation = relative_deviation
            .filter(|_| !any_bound)
            .and_then(|relative| deviations(&jacobian, relative));
        let standard_deviation =
            LapParameter::ALL.map(|parameter| match parameters[parameter.index()] {
                Knowledge::Stated => Some(0.0),
                Knowledge::Determined => {
                    let place = inner.iter().position(|&j| free[j] == parameter)?;
                    Some(deviation.as_ref()?[place] * solution.of(parameter))
                }
                _ => None,
            });
        Self {
            parameters,
            combinations: combinations(&problem.omega_rad_per_s, relative_deviation),
            updated: combinations(
                &solution.natural_frequencies()[..problem.omega_rad_per_s.len()],
                None,
            )
            .into_iter()
            .map(|combination| combination.value)
            .collect(),
            standard_deviation,
        }
    }
}

/// How much of each unknown lies in the space that the rows of the Jacobian span: 1 if it is determined, 0 if it has no influence.
fn known_share(jacobian: &DMatrix<f64>) -> Vec<f64> {
    if jacobian.ncols() == 0 {
        return Vec::new();
    }
    let found = bolted_joint_singular::real(jacobian.clone());
    let Some((values, rows)) = found.and_then(|svd| Some((svd.singular_values, svd.v_t?))) else {
        return vec![0.0; jacobian.ncols()];
    };
    let largest = values.max();
    (0..jacobian.ncols())
        .map(|j| {
            let spanned = values.iter().enumerate();
            let spanned = spanned.filter(|(_, value)| **value > RANK * largest && largest > 0.0);
            let share: f64 = spanned.map(|(i, _)| rows[(i, j)].powi(2)).sum();
            // Rounding is no influence.
            if share < RANK { 0.0 } else { share }
        })
        .collect()
}

/// Relative standard deviations of the unknowns, by the pseudo-inverse; of use for those that are determined.
fn deviations(jacobian: &DMatrix<f64>, relative: f64) -> Option<Vec<f64>> {
    let inverse = bolted_joint_singular::pseudo_inverse(jacobian.clone(), RANK)?;
    let rows = inverse.row_iter().map(|row| relative * row.norm());
    Some(rows.collect())
}

fn combinations(omega: &[f64], relative_deviation: Option<f64>) -> Vec<Combination> {
    let squares: Vec<f64> = omega.iter().map(|omega| omega * omega).collect();
    let mut found = Vec::new();
    if let Some(&first) = squares.first() {
        // k/m = ω₁²
        found.push(Combination {
            formula: "k/m",
            value: first,
            standard_deviation: relative_deviation.map(|relative| 2.0 * relative * first),
        });
    }
    if let [first, second] = squares[..] {
        // k₁₂/m = ½(ω₂² − ω₁²)
        found.push(Combination {
            formula: "k12/m",
            value: 0.5 * (second - first),
            standard_deviation: relative_deviation.map(|relative| relative * first.hypot(second)),
        });
    }
    found
}
