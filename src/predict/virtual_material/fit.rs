//! Which surface would give moduli that are known of a layer.

use thiserror::Error;

use super::{LayerContact, Loading, Moduli, VirtualMaterialError};
use crate::predict::Pair;
use crate::predict::surface::{Roughness, RoughnessError};

/// Range of the fractal dimension that is searched.
const DIMENSIONS: [f64; 2] = [1.05, 1.95];
/// Range of how far, as a logarithm of lengths, the roughness stays below that with which the least loaded layer has no elastic contact.
const MARGINS: [f64; 2] = [1e-7, 60.0];
/// Points of the search along either.
const GRID: usize = 120;
/// Minima of the grid that are refined.
const STARTS: usize = 4;
const MOST_STEPS: usize = 500;
/// A change of the unknowns that is none.
const SMALL_STEP: f64 = 1e-13;
const DIFFERENCE: f64 = 1e-6;

/// A layer whose moduli are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Its load, or its real area.
    pub loading: Loading,
    /// Its moduli.
    pub moduli: Moduli,
}

/// What is taken from the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Magnitudes {
    /// Both moduli as they are.
    Stated,
    /// Only how they go with the load: each modulus is multiplied by a factor, the same for all layers, that is found too.
    Free,
}

/// The surface that comes closest.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Fractal dimension and roughness.
    pub roughness: Roughness,
    /// Standard deviation of D, from the residual and the curvature there; `None` if the moduli do not determine it or there is no residual to tell.
    pub dimension_deviation: Option<f64>,
    /// The same of ln G.
    pub log_roughness_deviation: Option<f64>,
    /// Factors of E and G_x; 1 with [`Magnitudes::Stated`].
    pub magnitudes: [f64; 2],
    /// Root mean square of ln(fitted/known) over both moduli of all layers.
    pub log_residual: f64,
    /// Whether the best is at the edge of what was searched: the moduli then follow from no surface inside.
    pub is_at_bound: bool,
    /// The layers, in their order.
    pub layers: Vec<FittedLayer>,
}

/// A layer of the fitted surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedLayer {
    /// Fitted moduli, factors included.
    pub moduli: Moduli,
    /// Real over critical real area, A_t/A_rc; more than 1.
    pub area_ratio: f64,
}

/// A fit that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FitError {
    /// There are not enough layers.
    #[error(
        "{found} layers for {unknowns} unknowns; expected {expected} or more, with two moduli each"
    )]
    TooFew {
        /// How many there are.
        found: usize,
        /// How many unknowns.
        unknowns: usize,
        /// How many are needed.
        expected: usize,
    },
    /// A load, area or modulus is not a positive number.
    #[error("layer {number}: the {quantity} is {found}; expected a positive number")]
    Observation {
        /// Its place, counted from 1.
        number: usize,
        /// "load or area", "Young's modulus" or "shear modulus".
        quantity: &'static str,
        /// What was found.
        found: f64,
    },
    /// No surface of the search has elastic contacts in all layers.
    #[error("no surface between the bounds of the search has elastic contacts under all loads")]
    Nothing,
    /// The contact cannot be made.
    #[error(transparent)]
    Contact(#[from] VirtualMaterialError),
    /// The roughness cannot be made.
    #[error(transparent)]
    Roughness(#[from] RoughnessError),
}

/// Finds D and G by least squares on the logarithms of both moduli, for a pair of materials of a hardness (Pa) under β/f times the friction force.
///
/// All surfaces with elastic contacts in every layer are searched on a grid; the best minima of it are refined by the method of
/// Levenberg and Marquardt.
///
/// # Errors
/// Too few layers, or numbers that are not positive.
pub fn fit(
    observations: &[Observation],
    pair: &Pair,
    hardness_pa: f64,
    friction_ratio: f64,
    magnitudes: Magnitudes,
) -> Result<Fit, FitError> {
    let problem = Problem {
        observations,
        pair,
        hardness_pa,
        friction_ratio,
        magnitudes,
    };
    problem.check()?;
    let best = problem
        .starts()
        .into_iter()
        .map(|start| problem.refined(start))
        .min_by(|one, other| one.1.total_cmp(&other.1))
        .ok_or(FitError::Nothing)?;
    problem.result(best.0)
}

/// D, and the logarithm of the margin of ln G.
type Unknowns = [f64; 2];

struct Problem<'a> {
    observations: &'a [Observation],
    pair: &'a Pair,
    hardness_pa: f64,
    friction_ratio: f64,
    magnitudes: Magnitudes,
}

impl Problem<'_> {
    fn check(&self) -> Result<(), FitError> {
        let unknowns = self.unknowns();
        let found = self.observations.len();
        if 2 * found < unknowns {
            return Err(FitError::TooFew {
                found,
                unknowns,
                expected: unknowns / 2,
            });
        }
        for (index, observation) in self.observations.iter().enumerate() {
            let quantities = [
                ("load or area", observation.loading.value()),
                ("Young's modulus", observation.moduli.youngs_modulus_pa),
                ("shear modulus", observation.moduli.shear_modulus_pa),
            ];
            for (quantity, found) in quantities {
                if !(found.is_finite() && found > 0.0) {
                    return Err(FitError::Observation {
                        number: index + 1,
                        quantity,
                        found,
                    });
                }
            }
        }
        // Whether hardness and friction make sense does not depend on the roughness.
        LayerContact::new(
            self.pair,
            Roughness::new(1.5, 1e-9)?,
            self.hardness_pa,
            self.friction_ratio,
        )?;
        Ok(())
    }

    fn unknowns(&self) -> usize {
        match self.magnitudes {
            Magnitudes::Stated => 2,
            Magnitudes::Free => 4,
        }
    }

    fn contact(&self, d: f64, roughness_m: f64) -> Option<LayerContact> {
        let roughness = Roughness::new(d, roughness_m).ok()?;
        LayerContact::new(self.pair, roughness, self.hardness_pa, self.friction_ratio).ok()
    }

    /// The roughness with which the least loaded layer is critical.
    fn greatest_roughness(&self, d: f64) -> Option<f64> {
        // Critical loads and areas go with G².
        let reference_m = 1e-9;
        let contact = self.contact(d, reference_m)?;
        let least = self
            .observations
            .iter()
            .map(|observation| match observation.loading {
                Loading::Force(load) => load / contact.critical_load_n(),
                Loading::RealArea(area) => area / contact.critical_real_area_m2(),
            })
            .fold(f64::INFINITY, f64::min);
        Some(reference_m * least.sqrt())
    }

    fn roughness_at(&self, [d, margin]: Unknowns) -> Option<f64> {
        Some(self.greatest_roughness(d)? * (-margin.exp()).exp())
    }

    /// ln(computed/known) of E and G_x, layer by layer, without their means where magnitudes are free.
    fn residuals(&self, at: Unknowns) -> Option<Vec<[f64; 2]>> {
        let (mut all, means) = self.differences(self.contact(at[0], self.roughness_at(at)?)?)?;
        if self.magnitudes == Magnitudes::Free {
            for differences in &mut all {
                differences[0] -= means[0];
                differences[1] -= means[1];
            }
        }
        Some(all)
    }

    /// ln(computed/known) of E and G_x, and their means over the layers.
    fn differences(&self, contact: LayerContact) -> Option<(Vec<[f64; 2]>, [f64; 2])> {
        let mut all = Vec::with_capacity(self.observations.len());
        let mut means = [0.0; 2];
        for observation in self.observations {
            let computed = contact.moduli(observation.loading).ok()?;
            let known = observation.moduli;
            let differences = [
                (computed.youngs_modulus_pa / known.youngs_modulus_pa).ln(),
                (computed.shear_modulus_pa / known.shear_modulus_pa).ln(),
            ];
            for (mean, difference) in means.iter_mut().zip(differences) {
                *mean += difference / self.observations.len() as f64;
            }
            all.push(differences);
        }
        Some((all, means))
    }

    fn objective(&self, at: Unknowns) -> f64 {
        let sum = self.residuals(at).map(|all| squares(&all));
        sum.filter(|sum| sum.is_finite()).unwrap_or(f64::INFINITY)
    }

    /// The best minima of a grid.
    fn starts(&self) -> Vec<Unknowns> {
        let margins = MARGINS.map(f64::ln);
        let place =
            |[low, high]: [f64; 2], n: usize| low + (high - low) * n as f64 / (GRID - 1) as f64;
        let at = |row: usize, column: usize| [place(DIMENSIONS, row), place(margins, column)];
        let values: Vec<f64> = (0..GRID * GRID)
            .map(|n| self.objective(at(n / GRID, n % GRID)))
            .collect();
        let is_least = |n: usize| {
            let (row, column) = (n / GRID, n % GRID);
            let rows = row.saturating_sub(1)..=(row + 1).min(GRID - 1);
            let columns = column.saturating_sub(1)..=(column + 1).min(GRID - 1);
            values[n].is_finite()
                && rows.into_iter().all(|row| {
                    columns
                        .clone()
                        .all(|column| values[n] <= values[row * GRID + column])
                })
        };
        let mut minima: Vec<usize> = (0..GRID * GRID).filter(|&n| is_least(n)).collect();
        minima.sort_by(|&one, &other| values[one].total_cmp(&values[other]));
        minima.truncate(STARTS);
        minima.into_iter().map(|n| at(n / GRID, n % GRID)).collect()
    }

    /// The minimum near a start, and its sum of squares.
    fn refined(&self, start: Unknowns) -> (Unknowns, f64) {
        let mut at = start;
        let mut least = self.objective(at);
        let mut damping = 1e-3;
        for _ in 0..MOST_STEPS {
            let Some((matrix, gradient)) =
                self.normal_equations(|shift| self.residuals([at[0] + shift[0], at[1] + shift[1]]))
            else {
                break;
            };
            let Some(trial) = within(at, step(matrix, gradient, damping), |held| {
                gradient[1 - held] / (matrix[1 - held][1 - held] * (1.0 + damping))
            }) else {
                break;
            };
            let value = self.objective(trial);
            let change = (trial[0] - at[0]).abs().max((trial[1] - at[1]).abs());
            if value < least {
                (at, least) = (trial, value);
                damping = (0.2 * damping).max(1e-12);
            } else {
                damping *= 5.0;
            }
            if change < SMALL_STEP {
                break;
            }
        }
        (at, least)
    }

    /// JᵀJ and Jᵀr by central differences.
    fn normal_equations(
        &self,
        residuals: impl Fn([f64; 2]) -> Option<Vec<[f64; 2]>>,
    ) -> Option<([[f64; 2]; 2], [f64; 2])> {
        let here = residuals([0.0; 2])?;
        let mut columns = Vec::new();
        for unknown in 0..2 {
            let shifted = |sign: f64| {
                let mut shift = [0.0; 2];
                shift[unknown] = sign * DIFFERENCE;
                residuals(shift)
            };
            let (above, below) = (shifted(1.0)?, shifted(-1.0)?);
            let slopes = above
                .iter()
                .zip(&below)
                .map(|(above, below)| [0, 1].map(|n| (above[n] - below[n]) / (2.0 * DIFFERENCE)));
            columns.push(slopes.collect::<Vec<[f64; 2]>>());
        }
        let product = |one: &[[f64; 2]], other: &[[f64; 2]]| -> f64 {
            let pairs = one.iter().zip(other);
            pairs.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum()
        };
        let matrix =
            [0, 1].map(|row| [0, 1].map(|column| product(&columns[row], &columns[column])));
        let gradient = [0, 1].map(|row| product(&columns[row], &here));
        Some((matrix, gradient))
    }

    fn result(&self, at: Unknowns) -> Result<Fit, FitError> {
        let roughness_m = self.roughness_at(at).ok_or(FitError::Nothing)?;
        let roughness = Roughness::new(at[0], roughness_m)?;
        let contact =
            LayerContact::new(self.pair, roughness, self.hardness_pa, self.friction_ratio)?;
        let (_, means) = self.differences(contact).ok_or(FitError::Nothing)?;
        let magnitudes = match self.magnitudes {
            Magnitudes::Stated => [1.0; 2],
            Magnitudes::Free => means.map(|mean| (-mean).exp()),
        };
        let layers = self.observations.iter().map(|observation| {
            let moduli = contact.moduli(observation.loading)?;
            Ok(FittedLayer {
                moduli: Moduli {
                    youngs_modulus_pa: magnitudes[0] * moduli.youngs_modulus_pa,
                    shear_modulus_pa: magnitudes[1] * moduli.shear_modulus_pa,
                },
                area_ratio: contact.real_area_m2(observation.loading)?
                    / contact.critical_real_area_m2(),
            })
        });
        let layers = layers.collect::<Result<Vec<_>, VirtualMaterialError>>()?;
        let count = 2 * self.observations.len();
        let sum = self.objective(at);
        let is_at_bound = (0..2).any(|n| bounds()[n].contains(&at[n]));
        let deviations = self.deviations(at, roughness_m, sum, is_at_bound);
        Ok(Fit {
            roughness,
            dimension_deviation: deviations.map(|of| of[0]),
            log_roughness_deviation: deviations.map(|of| of[1]),
            magnitudes,
            log_residual: (sum / count as f64).sqrt(),
            is_at_bound,
            layers,
        })
    }

    /// Standard deviations of D and ln G: the diagonal of s² (JᵀJ)⁻¹.
    fn deviations(
        &self,
        at: Unknowns,
        roughness_m: f64,
        sum: f64,
        is_at_bound: bool,
    ) -> Option<[f64; 2]> {
        let freedom = (2 * self.observations.len()).checked_sub(self.unknowns())?;
        if freedom == 0 || is_at_bound {
            return None;
        }
        let (matrix, _) = self.normal_equations(|[d, log_roughness]| {
            let contact = self.contact(at[0] + d, roughness_m * log_roughness.exp())?;
            let (mut all, means) = self.differences(contact)?;
            if self.magnitudes == Magnitudes::Free {
                for differences in &mut all {
                    differences[0] -= means[0];
                    differences[1] -= means[1];
                }
            }
            Some(all)
        })?;
        let variance = sum / freedom as f64;
        let first = solved(matrix, [1.0, 0.0])?;
        let second = solved(matrix, [0.0, 1.0])?;
        let variances = [variance * first[0], variance * second[1]];
        variances
            .iter()
            .all(|value| value.is_finite() && *value >= 0.0)
            .then(|| variances.map(f64::sqrt))
    }
}

/// Bounds of the unknowns.
fn bounds() -> [[f64; 2]; 2] {
    [DIMENSIONS, MARGINS.map(f64::ln)]
}

/// The step of Levenberg and Marquardt, to be subtracted.
fn step(matrix: [[f64; 2]; 2], gradient: [f64; 2], damping: f64) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    solved(
        [[a * (1.0 + damping), b], [c, d * (1.0 + damping)]],
        gradient,
    )
}

/// Where a step leads within the bounds. An unknown that would leave them is held at its bound; the other one then takes the step `alone`.
fn within(at: Unknowns, step: Option<[f64; 2]>, alone: impl Fn(usize) -> f64) -> Option<Unknowns> {
    let bounds = bounds();
    let clamped = |n: usize, value: f64| value.clamp(bounds[n][0], bounds[n][1]);
    let step = step?;
    let mut trial = [0, 1].map(|n| clamped(n, at[n] - step[n]));
    for held in [0, 1] {
        let other = 1 - held;
        if trial[held] == at[held] && step[held] != 0.0 && bounds[held].contains(&at[held]) {
            trial[other] = clamped(other, at[other] - alone(held));
        }
    }
    Some(trial)
}

fn squares(all: &[[f64; 2]]) -> f64 {
    all.iter().map(|[a, b]| a * a + b * b).sum()
}

/// Solution of two equations, if they are independent.
fn solved(matrix: [[f64; 2]; 2], right: [f64; 2]) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    if !(determinant.abs() > 1e-13 * (a * d).abs()) {
        return None;
    }
    Some([
        (right[0] * d - right[1] * b) / determinant,
        (right[1] * a - right[0] * c) / determinant,
    ])
}
