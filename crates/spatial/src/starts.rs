//! Where searches begin: the joints by what they do where the functions reach all of their motions, and stiffnesses by the
//! receptance that they see.
//!
//! The functions are bent in the joints, which gives the search other minima. The loads in the joints follow from the functions
//! without knowing the joints, and so do the motions; f = D b between them is linear in K and C. Its residuals, weighted by what
//! they do to the functions, lead near the lowest minimum from afar.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use num_complex::Complex64;

use crate::assembled::{Assembled, Open};
use crate::dyads::{Grid, Group, descent, information};
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::normal::{Deviations, Normal, Patterns};
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;

/// Lines that are looked at.
const LINES: usize = 60;

/// Stiffnesses of the starts, in parts of what balances the structures.
const PARTS: [f64; 5] = [1.0, 0.1, 10.0, 0.01, 100.0];

/// The joints line by line, and in these parts of it.
const BESIDE: [f64; 5] = [1.0, 1.5, 0.7, 0.5, 0.3];

/// Rounds in which the weights of the loads follow the joints.
const ROUNDS: usize = 10;

/// Loss factor of a start.
const LOSS: f64 = 0.02;

/// Singular values below this part of the largest are none.
const RANK: f64 = 1e-8;

/// Starts, the likely ones first.
pub(crate) fn starts(problem: &Problem, level: &Deviations) -> Result<Vec<Unknowns>, SpatialError> {
    let all = problem.frequency_hz.len();
    let looked_at: Vec<usize> = (0..all).step_by(all.div_ceil(LINES).max(1)).collect();
    let problem = &problem.with_lines(&looked_at);
    let assembled = Assembled::without_sought(problem)?;
    let lines = 0..looked_at.len();
    let open: Vec<Open> = lines
        .map(|line| assembled.open(line))
        .collect::<Result<_, _>>()?;
    let mut starts = Vec::new();
    if let Some(loads) = Loads::of(problem, &open, level) {
        let line_by_line = loads.line_by_line(problem);
        let nothing = Some(vec![[Matrix6::zeros(); 2]; problem.links.sought().len()]);
        for own in [&line_by_line, &nothing].into_iter().flatten() {
            if let Some(start) = of_matrices(problem, own)? {
                starts.extend(loads.balanced(problem, start)?);
            }
        }
        for part in BESIDE {
            if let Some(own) = &line_by_line {
                let own: Vec<_> = own.iter().map(|own| own.map(|own| part * own)).collect();
                starts.extend(of_matrices(problem, &own)?);
            }
        }
    }
    // k = 1/|H_ii|, where joints and structures are alike
    let middle = problem.omega(looked_at.len() / 2);
    for part in PARTS {
        let of = |joint: usize| {
            let stiffness = Matrix6::from_diagonal(&Vector6::from_fn(|dof, _| {
                let i = MOTIONS * joint + dof;
                let sizes = open.iter().map(|open| open.seen[(i, i)].norm());
                part / median(sizes.collect())
            }));
            [stiffness, stiffness * (LOSS / middle)]
        };
        let own: Vec<_> = (0..problem.links.sought().len()).map(of).collect();
        if is_finite(&own) {
            starts.extend(of_matrices(problem, &own)?);
        }
    }
    Ok(starts)
}

/// Unknowns nearest to K and C of each joint that is sought, without errors of the set-up.
fn of_matrices(
    problem: &Problem,
    matrices: &[[Matrix6<f64>; 2]],
) -> Result<Option<Unknowns>, SpatialError> {
    let mut all = DVector::zeros(problem.count());
    let joints = problem.links.nearest(matrices)?;
    all.rows_mut(0, joints.len()).copy_from(&joints);
    let is_finite = all.iter().all(|x: &f64| x.is_finite());
    Ok(is_finite.then_some(Unknowns(all)))
}

/// Loads in the joints that are sought, and their motions, as the functions have them.
struct Loads {
    /// What the functions follow from.
    lines: Vec<OfLine>,
    /// How much each function counts; rows × columns, or the other way round.
    grid: Grid,
    patterns: Patterns,
}

/// At one line: Y − Y_C = (Y Sᵀ) f, b = S Y − H f.
struct OfLine {
    /// Y Sᵀ: rows × motions.
    by_loads: DMatrix<Complex64>,
    /// H
    seen: DMatrix<Complex64>,
    /// f: motions × columns.
    loads: DMatrix<Complex64>,
    /// b: motions × columns.
    motions: DMatrix<Complex64>,
}

impl Loads {
    /// From the rows of each column, or where these do not reach all motions, from the columns of each row: K and C are
    /// symmetric.
    fn of(problem: &Problem, open: &[Open], level: &Deviations) -> Option<Self> {
        let weights = problem.weights(level);
        [false, true].into_iter().find_map(|is_transposed| {
            let turned = |matrix: &DMatrix<Complex64>| match is_transposed {
                true => matrix.transpose(),
                false => matrix.clone(),
            };
            let mut weights = match is_transposed {
                true => weights.transpose(),
                false => weights.clone(),
            };
            let sought = problem.links.sought();
            let scales = problem.links.scales();
            let scales: Vec<f64> = (sought.iter())
                .flat_map(|joint| scales[joint.motions()].to_vec())
                .collect();
            let rows_of = |column: usize| -> Vec<usize> {
                let own = weights.column(column);
                (0..own.len()).filter(|&row| own[row] > 0.0).collect()
            };
            let rows: Vec<Vec<usize>> = (0..weights.ncols()).map(rows_of).collect();
            let usable: Vec<usize> = (0..rows.len())
                .filter(|&n| rows[n].len() >= scales.len())
                .collect();
            let mut lines = Vec::new();
            for (line, open) in open.iter().enumerate() {
                let (by_loads, motions) = match is_transposed {
                    true => (turned(&open.motions), turned(&open.by_loads)),
                    false => (open.by_loads.clone(), open.motions.clone()),
                };
                let mut change = DMatrix::zeros(open.by_loads.nrows(), open.motions.ncols());
                for (one, function) in problem.observed.iter().zip(&open.functions) {
                    change[(one.at[0], one.at[1])] = function - one.values[line];
                }
                let change = turned(&change);
                let mut loads = DMatrix::zeros(scales.len(), motions.ncols());
                let mut inverse: Option<(&Vec<usize>, DMatrix<Complex64>)> = None;
                for &column in &usable {
                    let own = &rows[column];
                    if inverse.as_ref().is_none_or(|(rows, _)| *rows != own) {
                        inverse = Some((own, pseudo_inverse(&by_loads, own, &weights, &scales)?));
                    }
                    let right = DVector::from_fn(own.len(), |n, _| change[(own[n], column)]);
                    let (_, inverse) = inverse.as_ref()?;
                    loads.column_mut(column).copy_from(&(inverse * right));
                }
                let seen = turned(&open.seen);
                lines.push(OfLine {
                    motions: motions - &seen * &loads,
                    by_loads,
                    seen,
                    loads,
                });
            }
            for column in (0..rows.len()).filter(|column| !usable.contains(column)) {
                weights.column_mut(column).fill(0.0);
            }
            (usable.len() >= scales.len()).then(|| Self {
                lines,
                grid: Grid::new(weights),
                patterns: Patterns::of(problem),
            })
        })
    }

    /// K and C of each joint by the medians of D = f b⁺ over the lines; `None` where the motions do not determine it.
    fn line_by_line(&self, problem: &Problem) -> Option<Vec<[Matrix6<f64>; 2]>> {
        let mut found: Vec<[DMatrix<f64>; 2]> = Vec::new();
        for (line, own) in self.lines.iter().enumerate() {
            let svd = own.motions.clone().svd(true, true);
            let inverse = svd
                .pseudo_inverse(f64::MIN_POSITIVE)
                .ok()
                .filter(|inverse| inverse.iter().all(|x| x.is_finite()))?;
            let d = &own.loads * inverse;
            let d = (&d + d.transpose()) * Complex64::from(0.5);
            let omega = problem.omega(line);
            found.push([d.map(|x| x.re), d.map(|x| x.im / omega)]);
        }
        let of = |joint: usize, part: usize| {
            Matrix6::from_fn(|i, j| {
                let at = (MOTIONS * joint + i, MOTIONS * joint + j);
                median(found.iter().map(|own| own[part][at]).collect())
            })
        };
        let joints = 0..problem.links.sought().len();
        let matrices: Vec<_> = joints.map(|joint| [of(joint, 0), of(joint, 1)]).collect();
        is_finite(&matrices).then_some(matrices)
    }

    /// K and C for which loads and motions balance over all lines, Σ w |T (f − D b)|² with T = Y Sᵀ (I + D H)⁻¹ of the round
    /// before: to first order, T is what an error of the balance does to the functions.
    fn balanced(
        &self,
        problem: &Problem,
        start: Unknowns,
    ) -> Result<Option<Unknowns>, SpatialError> {
        let mut unknowns = start;
        let joints = problem.joint_count();
        for _ in 0..ROUNDS {
            let values = problem.links.sought_matrices(unknowns.0.as_slice())?;
            let mut normal = Normal::zeros(joints);
            for (line, own) in self.lines.iter().enumerate() {
                let omega = problem.omega(line);
                let dynamic = values[0].zip_map(&values[1], |k, c| Complex64::new(k, omega * c));
                let count = dynamic.nrows();
                let opened = DMatrix::identity(count, count) + &dynamic * &own.seen;
                let by_balance = opened.transpose().lu().solve(&own.by_loads.transpose());
                let Some(by_balance) = by_balance.map(|own| own.transpose()) else {
                    return Ok(None);
                };
                let group = |joint: usize| Group {
                    left: by_balance.columns(MOTIONS * joint, MOTIONS).into_owned(),
                    right: own.motions.rows(MOTIONS * joint, MOTIONS).into_owned(),
                };
                let groups: Vec<Group> = (0..count / MOTIONS).map(group).collect();
                let errors = -(&by_balance * &own.loads);
                let products = self.patterns.products(&information(&self.grid, &groups));
                let slopes = self.patterns.slopes(&descent(&self.grid, &groups, &errors));
                normal.add_line(omega, &self.patterns, &products, &slopes);
            }
            let Some(inverse) = covariance(&normal.information) else {
                return Ok(None);
            };
            unknowns
                .0
                .rows_mut(0, joints)
                .copy_from(&(inverse * &normal.descent));
        }
        let is_finite = unknowns.0.iter().all(|x| x.is_finite());
        Ok(is_finite.then_some(unknowns))
    }
}

/// (W A)⁺ W of some rows, each with its mean weight; `None` unless they reach all motions.
fn pseudo_inverse(
    matrix: &DMatrix<Complex64>,
    rows: &[usize],
    weights: &DMatrix<f64>,
    scales: &[f64],
) -> Option<DMatrix<Complex64>> {
    // as lengths: K = ℓ K′ ℓ
    let weight = |row: usize| weights.row(rows[row]).mean().sqrt();
    let weighted = DMatrix::from_fn(rows.len(), scales.len(), |n, m| {
        matrix[(rows[n], m)] * (weight(n) * scales[m])
    });
    let svd = weighted.svd(true, true);
    if svd.singular_values.min() <= RANK * svd.singular_values.max() {
        return None;
    }
    let inverse = svd.pseudo_inverse(0.0).ok()?;
    Some(DMatrix::from_fn(scales.len(), rows.len(), |m, n| {
        inverse[(m, n)] * (weight(n) * scales[m])
    }))
}

fn is_finite(matrices: &[[Matrix6<f64>; 2]]) -> bool {
    let mut all = matrices.iter().flatten();
    all.all(|matrix| matrix.iter().all(|x| x.is_finite()))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
