//! Where searches begin: the joints by what they do where the functions reach all of their motions, and stiffnesses by the
//! receptance that they see.
//!
//! The functions are bent in the joints, which gives the search other minima. The loads in the joints follow from the functions
//! without knowing the joints, and so do the motions; f = D b between them is linear in K and C. Its residuals, weighted by what
//! they do to the functions, lead near the lowest minimum from afar.

use bolted_joint_statistics::upper_median;
use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use num_complex::Complex64;

use crate::assembled::{Assembled, Open};
use crate::dyads::{Grid, Group, descent, information};
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::loose::{First, Loose};
use crate::motionless::refuse_motionless;
use crate::normal::{Deviations, Normal};
use crate::patterns::Patterns;
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;

/// Lines that are looked at.
const LINES: usize = 60;

/// Stiffnesses of the starts, in parts of what balances the structures.
const PARTS: [f64; 5] = [1.0, 0.1, 10.0, 0.01, 100.0];

/// Likewise of loads that are sought as well.
const LOOSE_PARTS: [f64; 4] = [3.0, 0.1, 10.0, 1.0];

/// The joints line by line, and in these parts of it.
const BESIDE: [f64; 5] = [1.0, 1.5, 0.7, 0.5, 0.3];

/// Rounds in which the weights of the loads follow the joints.
const ROUNDS: usize = 20;

/// Loss factor of a start.
pub(crate) const LOSS: f64 = 0.02;

/// Singular values below this part of the largest are none.
const RANK: f64 = 1e-8;

/// Parts of the lines whose loads and motions are balanced apart: every second one, every third one.
const PARTS_OF_LINES: [usize; 2] = [2, 3];

/// Starts, the likely ones first; each is made when it is asked for.
pub(crate) struct Starts<I> {
    pub(crate) all: I,
    /// How many of them have to be followed before one is the answer: where the functions do not reach all motions of the joints,
    /// they may have other joints as well.
    pub(crate) in_doubt: usize,
}

/// Starts, as they are for these functions.
pub(crate) fn starts(
    problem: &Problem,
    level: &Deviations,
) -> Result<Starts<impl Iterator<Item = Unknowns> + use<>>, SpatialError> {
    let all = problem.frequency_hz.len();
    let looked_at: Vec<usize> = (0..all).step_by(all.div_ceil(LINES).max(1)).collect();
    let problem = problem.with_lines(&looked_at);
    let open: Vec<Open> = {
        let assembled = Assembled::without_sought(&problem)?;
        let lines = 0..looked_at.len();
        lines
            .map(|line| assembled.open(line))
            .collect::<Result<_, _>>()?
    };
    refuse_motionless(&problem, &open)?;
    let mut ways = Vec::new();
    let loads = Loads::of(&problem, &open, level);
    if let Some(loads) = &loads {
        let lines = looked_at.len();
        let line_by_line = loads.line_by_line(&problem);
        let nothing = Some(vec![[Matrix6::zeros(); 2]; problem.links.sought().len()]);
        if let Some(stiff) = loads.compliant(&problem) {
            ways.push(Way::At(stiff));
        }
        for from in [&line_by_line, &nothing].into_iter().flatten() {
            ways.push(Way::Balanced(from.clone(), (0..lines).collect()));
        }
        if let Some(from) = &line_by_line {
            for part in PARTS_OF_LINES {
                for first in 0..part {
                    let own = (first..lines).step_by(part).collect();
                    ways.push(Way::Balanced(from.clone(), own));
                }
            }
            for part in BESIDE {
                let own = from.iter().map(|own| own.map(|own| part * own));
                ways.push(Way::At(own.collect()));
            }
        }
    }
    let balance = balance(&problem, &open);
    let middle = problem.omega(looked_at.len() / 2);
    let of_part = |part: f64| -> Vec<[Matrix6<f64>; 2]> {
        let of = |joint: usize| {
            let stiffness = Matrix6::from_diagonal(&Vector6::from_fn(|dof, _| {
                part * balance[MOTIONS * joint + dof]
            }));
            [stiffness, stiffness * (LOSS / middle)]
        };
        (0..problem.links.sought().len()).map(of).collect()
    };
    let loose = loads.is_none().then(|| Loose::of(&problem, &open, level));
    let mut in_doubt = 0;
    if loose.is_some() {
        for part in LOOSE_PARTS {
            let both = [First::All, First::Diagonal];
            ways.extend(both.map(|first| Way::Loose(of_part(part), first)));
        }
        in_doubt = ways.len();
    }
    ways.extend(PARTS.map(|part| Way::At(of_part(part))));
    let all = ways.into_iter().filter_map(move |way| match way {
        Way::At(matrices) => of_matrices(&problem, &matrices),
        Way::Loose(from, first) => {
            let start = of_matrices(&problem, &from)?;
            loose.as_ref()?.from(&problem, start, first)
        }
        Way::Balanced(from, lines) => {
            let start = of_matrices(&problem, &from)?;
            loads.as_ref()?.balanced(&problem, start, &lines)
        }
    });
    Ok(Starts { all, in_doubt })
}

/// 1/|H_ii| of each motion of the joints that are sought, as the middle of the lines has it: stiffnesses that are like those of the
/// structures. 0 for no motion of the study.
fn balance(problem: &Problem, open: &[Open]) -> Vec<f64> {
    let motions = 0..MOTIONS * problem.links.sought().len();
    let of = |i: usize| {
        let sizes = open.iter().map(|open| open.seen[(i, i)].norm());
        match median(sizes) {
            0.0 => 0.0,
            size => size.recip(),
        }
    };
    motions.map(of).collect()
}

impl Problem {
    /// Stiffnesses that are like those of the structures, for [`Problem::after`].
    pub(crate) fn balance(&self) -> Result<Vec<f64>, SpatialError> {
        let assembled = Assembled::without_sought(self)?;
        let lines = 0..self.frequency_hz.len();
        let open: Vec<Open> = lines
            .map(|line| assembled.open(line))
            .collect::<Result<_, _>>()?;
        Ok(balance(self, &open))
    }
}

/// To a start.
enum Way {
    /// K and C of each joint.
    At(Vec<[Matrix6<f64>; 2]>),
    /// Loads that balance loosely, from such.
    Loose(Vec<[Matrix6<f64>; 2]>, First),
    /// Loads and motions balanced at these lines, from such.
    Balanced(Vec<[Matrix6<f64>; 2]>, Vec<usize>),
}

/// Unknowns nearest to K and C of each joint that is sought, without errors of the set-up.
fn of_matrices(problem: &Problem, matrices: &[[Matrix6<f64>; 2]]) -> Option<Unknowns> {
    let mut all = DVector::zeros(problem.count());
    let joints = problem.links.nearest(matrices).ok()?;
    all.rows_mut(0, joints.len()).copy_from(&joints);
    let is_finite = all.iter().all(|x: &f64| x.is_finite());
    is_finite.then_some(Unknowns(all))
}

/// Loads in the joints that are sought, and their motions, as the functions have them.
pub(crate) struct Loads {
    /// What the functions follow from.
    pub(crate) lines: Vec<OfLine>,
    /// How much each function counts; rows × columns, or the other way round.
    pub(crate) weights: DMatrix<f64>,
    /// Columns whose rows reach all motions.
    usable: Vec<usize>,
    /// What scales each motion: rotations as lengths.
    pub(crate) scales: Vec<f64>,
    /// The motions that the study is about.
    pub(crate) own: Vec<usize>,
    patterns: Patterns,
}

/// At one line: Y − Y_C = (Y Sᵀ) f, b = S Y − H f.
pub(crate) struct OfLine {
    /// Y Sᵀ: rows × motions.
    pub(crate) by_loads: DMatrix<Complex64>,
    /// H
    pub(crate) seen: DMatrix<Complex64>,
    /// f: motions × columns.
    pub(crate) loads: DMatrix<Complex64>,
    /// b: motions × columns.
    pub(crate) motions: DMatrix<Complex64>,
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
            let own = problem.links.own_motions();
            let own_scales: Vec<f64> = own.iter().map(|&motion| scales[motion]).collect();
            let rows_of = |column: usize| -> Vec<usize> {
                let own = weights.column(column);
                (0..own.len()).filter(|&row| own[row] > 0.0).collect()
            };
            let rows: Vec<Vec<usize>> = (0..weights.ncols()).map(rows_of).collect();
            let usable: Vec<usize> = (0..rows.len())
                .filter(|&n| rows[n].len() >= own.len())
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
                for &column in &usable {
                    let rows = &rows[column];
                    let weights: Vec<f64> =
                        rows.iter().map(|&row| weights[(row, column)]).collect();
                    let part = by_loads.select_rows(rows).select_columns(&own);
                    let inverse = pseudo_inverse(&part, &weights, &own_scales)?;
                    let right = DVector::from_fn(rows.len(), |n, _| change[(rows[n], column)]);
                    for (load, &motion) in (inverse * right).iter().zip(&own) {
                        loads[(motion, column)] = *load;
                    }
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
            (usable.len() >= own.len()).then(|| Self {
                lines,
                weights,
                usable,
                scales,
                own,
                patterns: Patterns::of_joints(problem),
            })
        })
    }

    /// K and C of each joint by the medians of D(ω) = X (I − H X)⁻¹ over the lines, where f = X S Y; `None` where the motions do
    /// not determine X.
    fn line_by_line(&self, problem: &Problem) -> Option<Vec<[Matrix6<f64>; 2]>> {
        let mut found: Vec<[DMatrix<f64>; 2]> = Vec::new();
        let (motions, all) = (&self.own, self.scales.len());
        let scales: Vec<f64> = motions.iter().map(|&motion| self.scales[motion]).collect();
        for (line, own) in self.lines.iter().enumerate() {
            let of_usable = |matrix: &DMatrix<Complex64>| {
                matrix.select_columns(&self.usable).select_rows(motions)
            };
            let open = of_usable(&(&own.motions + &own.seen * &own.loads));
            let loads = of_usable(&own.loads);
            let seen = own.seen.select_rows(motions).select_columns(motions);
            // X (S Y) = f, column by column
            let weights: Vec<f64> = (self.usable.iter())
                .map(|&column| self.weights.column(column).mean())
                .collect();
            let inverse = pseudo_inverse(&open.transpose(), &weights, &scales)?;
            let x = loads * inverse.transpose();
            let unit = DMatrix::identity(x.nrows(), x.nrows());
            let d = &x * (unit - &seen * &x).try_inverse()?;
            let d = (&d + d.transpose()) * Complex64::from(0.5);
            let omega = problem.omega(line);
            let mut parts = [(); 2].map(|()| DMatrix::zeros(all, all));
            for (i, &row) in motions.iter().enumerate() {
                for (j, &column) in motions.iter().enumerate() {
                    parts[0][(row, column)] = d[(i, j)].re;
                    parts[1][(row, column)] = d[(i, j)].im / omega;
                }
            }
            found.push(parts);
        }
        let of = |joint: usize, part: usize| {
            Matrix6::from_fn(|i, j| {
                let at = (MOTIONS * joint + i, MOTIONS * joint + j);
                median(found.iter().map(|own| own[part][at]))
            })
        };
        let joints = 0..problem.links.sought().len();
        let matrices: Vec<_> = joints.map(|joint| [of(joint, 0), of(joint, 1)]).collect();
        let mut all = matrices.iter().flatten();
        let is_finite = all.all(|matrix| matrix.iter().all(|x| x.is_finite()));
        is_finite.then_some(matrices)
    }

    /// K and C for which loads and motions balance over these lines, Σ w |T (f − D b)|² with T = Y Sᵀ (I + D H)⁻¹ of the round
    /// before: to first order, T is what an error of the balance does to the functions.
    fn balanced(&self, problem: &Problem, start: Unknowns, lines: &[usize]) -> Option<Unknowns> {
        let mut unknowns = start;
        let joints = problem.joint_count();
        let grid = Grid::new(self.weights.clone());
        for _ in 0..ROUNDS {
            let values = (problem.links.sought_matrices(unknowns.0.as_slice())).ok()?;
            let mut normal = Normal::zeros(joints);
            for &line in lines {
                let (own, omega) = (&self.lines[line], problem.omega(line));
                let dynamic = values[0].zip_map(&values[1], |k, c| Complex64::new(k, omega * c));
                let count = dynamic.nrows();
                let opened = DMatrix::identity(count, count) + &dynamic * &own.seen;
                let by_balance = opened.transpose().lu().solve(&own.by_loads.transpose())?;
                let by_balance = by_balance.transpose();
                let group = |joint: usize| Group {
                    left: by_balance.columns(MOTIONS * joint, MOTIONS).into_owned(),
                    right: own.motions.rows(MOTIONS * joint, MOTIONS).into_owned(),
                };
                let groups: Vec<Group> = (0..count / MOTIONS).map(group).collect();
                let errors = -(&by_balance * &own.loads);
                let products = self
                    .patterns
                    .products(information(&grid, &groups).as_view());
                let slopes = self.patterns.slopes(&descent(&grid, &groups, &errors));
                normal.add_line(omega, &self.patterns, &products, &slopes);
            }
            let values = covariance(&normal.information)? * &normal.descent;
            unknowns.0.rows_mut(0, joints).copy_from(&values);
        }
        let is_finite = unknowns.0.iter().all(|x| x.is_finite());
        is_finite.then_some(unknowns)
    }
}

/// (√W A)⁺ √W; `None` unless its rank is that of its columns.
pub(crate) fn pseudo_inverse(
    matrix: &DMatrix<Complex64>,
    weights: &[f64],
    scales: &[f64],
) -> Option<DMatrix<Complex64>> {
    let (rows, columns) = matrix.shape();
    let factor = |n: usize, m: usize| weights[n].sqrt() * scales[m];
    let weighted = DMatrix::from_fn(rows, columns, |n, m| matrix[(n, m)] * factor(n, m));
    let svd = bolted_joint_singular::complex(weighted)?;
    if svd.singular_values.min() <= RANK * svd.singular_values.max() {
        return None;
    }
    let inverse = svd.pseudo_inverse(0.0).ok()?;
    Some(DMatrix::from_fn(columns, rows, |m, n| {
        inverse[(m, n)] * factor(n, m)
    }))
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    upper_median(values).unwrap_or(f64::NAN)
}
