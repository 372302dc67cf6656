//! Noise of the substructures' functions: errors in variables in marginal form.
//!
//! What the substructures truly are is unknown beside the joint, thousands of numbers that are linear in the functions of the
//! assembly as far as noise goes. They are eliminated line by line: with h the reduced functions of the substructures (those
//! of the virtual point, and of what is measured elsewhere), U = ∂Y_C/∂h and Λ the covariance of h,
//!
//! r = y − Y_C(h, θ) − U (h₀ − h), S = Σ + U Λ Uᴴ, F = 2 Re Σ Jᴴ S⁻¹ J, h ← h₀ + Λ Uᴴ S⁻¹ r,
//!
//! with S⁻¹ = W − W U M⁻¹ Uᴴ W, M = Λ⁻¹ + Uᴴ W U, W = Σ⁻¹. Both U and J are dyads, which [`crate::dyads`] sums up.

use nalgebra::{Cholesky, DMatrix, DVector};
use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::dyads::{Grid, Group, descent, information, squares};
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::normal::{Deviations, Normal, residuals};
use crate::parallel::over_lines;
use crate::patterns::Patterns;
use crate::problem::{Problem, Unknowns};
use crate::search::SEARCHED;
use crate::side::{MOTIONS, Reduction};

/// Lines are left out where the substructures' noise moves the functions of the assembly by more than this part of them,
/// r.m.s.: there they do not follow linearly.
const MOVED_MAX: f64 = 0.15;

/// Steps of the search at most, with few lines and with all.
const STEPS_MAX: [usize; 2] = [30, 8];

/// A step below this part of the deviations was the last one.
const SETTLED: f64 = 0.1;

/// A step below this many deviations, after which the reduced functions follow.
const NEAR: f64 = 5.0;

/// Lines of the search before all take part.
const FEW: usize = 200;

/// Longest step of a stiffness, in parts of what couples two motions at most.
const LONGEST: f64 = 0.5;

/// Parts of a step that the reduced functions of a line try.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

/// Damping that bounds any step.
const DAMPING_MAX: f64 = 1e20;

/// The joint that fits best, beside noise of the substructures.
pub(crate) struct Refined {
    /// Of the joint alone.
    pub(crate) unknowns: Unknowns,
    /// Covariance of these.
    pub(crate) covariance: DMatrix<f64>,
    /// χ², of all real numbers of the lines that took part.
    pub(crate) squares: f64,
    /// Lines that took part.
    pub(crate) kept: Vec<usize>,
    /// R.m.s. over these lines of what the substructures' noise moves, in parts of the functions.
    pub(crate) moved: f64,
    pub(crate) has_converged: bool,
}

/// A set-up without errors, whose substructures have noise.
struct Marginal<'p> {
    problem: &'p Problem,
    grid: Grid,
    patterns: Patterns,
    reductions: [Reduction; 2],
    noisy: Vec<Noisy>,
    /// h₀ at each line.
    measured: Vec<Hidden>,
}

/// Reduced functions of both sides.
type Hidden = [DMatrix<Complex64>; 2];

/// A side whose functions have noise in this part of each value.
#[derive(Clone, Copy)]
struct Noisy {
    side: usize,
    part: f64,
}

/// What one line comes to.
struct AtLine {
    products: DMatrix<Complex64>,
    slopes: DVector<Complex64>,
    squares: f64,
    hidden: Hidden,
}

impl Problem {
    /// From unknowns near the best ones; the substructures have noise in these parts of each value. Errors of the set-up do
    /// not take part.
    pub(crate) fn refined(
        &self,
        start: Unknowns,
        level: &Deviations,
        noise: [f64; 2],
    ) -> Result<Refined, SpatialError> {
        let all = Marginal::of(self, level, noise)?;
        let kept = all.kept(&start)?;
        let own = self.with_lines(&kept);
        let few = own.thinned(FEW);
        let mut unknowns = start;
        let mut search = None;
        for (problem, steps) in [&few, &own].into_iter().zip(STEPS_MAX) {
            let found = Marginal::of(problem, level, noise)?.searched(unknowns, steps)?;
            unknowns = found.0.clone();
            search = Some(found);
        }
        let (unknowns, normal, has_converged) = search.ok_or(SpatialError::NoStart)?;
        let moved = all.moved(&unknowns)?;
        let squares: f64 = kept.iter().map(|&line| moved[line].powi(2)).sum();
        Ok(Refined {
            covariance: covariance(&normal.information).ok_or(SpatialError::NotDetermined)?,
            squares: normal.cost,
            moved: (squares / kept.len().max(1) as f64).sqrt(),
            unknowns,
            kept,
            has_converged,
        })
    }

    /// What a test will tell of the joint whose functions are these, with noise of the substructures: the information, and how
    /// many lines will take part.
    pub(crate) fn told_beside_noise(
        &self,
        truth: &Unknowns,
        level: &Deviations,
        noise: [f64; 2],
    ) -> Result<(Normal, usize), SpatialError> {
        let kept = Marginal::of(self, level, noise)?.kept(truth)?;
        let own = self.with_lines(&kept);
        let marginal = Marginal::of(&own, level, noise)?;
        let (normal, _) = marginal.normal(truth, &marginal.measured)?;
        Ok((normal, kept.len()))
    }

    /// The lines at which the substructures' noise moves the assembly's functions least: a half of all, and not too many.
    pub(crate) fn steadiest(
        &self,
        unknowns: &Unknowns,
        level: &Deviations,
        noise: [f64; 2],
    ) -> Result<Vec<usize>, SpatialError> {
        let marginal = Marginal::of(self, level, noise)?;
        let moved = marginal.moved(unknowns)?;
        let mut lines: Vec<usize> = (0..moved.len()).collect();
        lines.sort_by(|&one, &other| moved[one].total_cmp(&moved[other]));
        lines.truncate(moved.len().div_ceil(2));
        // spread over frequency
        lines.sort_unstable();
        let step = lines.len().div_ceil(SEARCHED).max(1);
        Ok(lines.into_iter().step_by(step).collect())
    }

    /// With the functions of a rigid interface in place of the measured ones, which have more noise.
    pub(crate) fn smoothed(&self) -> Result<Self, SpatialError> {
        let reductions = reductions(self)?;
        let mut own = self.clone();
        for (side, reduction) in own.sides.iter_mut().zip(&reductions) {
            for line in &mut side.lines {
                *line = reduction.expanded(&reduction.reduced(line));
            }
        }
        Ok(own)
    }
}

fn reductions(problem: &Problem) -> Result<[Reduction; 2], SpatialError> {
    let of = |n: usize| {
        let reduction = problem.sides[n].reduction();
        reduction.map_err(SpatialError::from)
    };
    Ok([of(0)?, of(1)?])
}

impl<'p> Marginal<'p> {
    fn of(problem: &'p Problem, level: &Deviations, noise: [f64; 2]) -> Result<Self, SpatialError> {
        let reductions = reductions(problem)?;
        let mut noisy = Vec::new();
        for (side, part) in noise.into_iter().enumerate() {
            if part > 0.0 {
                noisy.push(Noisy { side, part });
            }
        }
        Ok(Self {
            problem,
            grid: Grid::new(problem.weights(level)),
            patterns: Patterns::of(problem, None),
            noisy,
            measured: Self::reduced(problem, &reductions),
            reductions,
        })
    }

    fn reduced(problem: &Problem, reductions: &[Reduction; 2]) -> Vec<Hidden> {
        (0..problem.frequency_hz.len())
            .map(|line| [0, 1].map(|n| reductions[n].reduced(&problem.sides[n].lines[line])))
            .collect()
    }

    /// What noise of the substructures moves at each line, in parts of the functions, r.m.s. with the functions' weights.
    fn moved(&self, unknowns: &Unknowns) -> Result<Vec<f64>, SpatialError> {
        let assembled = Assembled::new(self.problem, unknowns)?;
        let parts = over_lines(self.problem.frequency_hz.len(), |lines| {
            let of = |line: usize| {
                let (_, groups) = self.dyads(&assembled, line, &self.measured[line])?;
                let sums = information(&self.grid, &groups[..self.noisy.len()]);
                // Σ w var = tr(Λ Uᴴ W U)
                let mut first = 0;
                let mut moved = 0.0;
                for own in &self.noisy {
                    let own = own.covariance(self, line);
                    let count = own.nrows();
                    let block = sums.view((first, first), (count, count));
                    let terms = block.iter().zip(&own);
                    moved += terms
                        .map(|(sum, covariance)| sum.re * covariance)
                        .sum::<f64>();
                    first += count;
                }
                let mut values = DMatrix::zeros(groups[0].left.nrows(), groups[0].right.ncols());
                for one in &self.problem.observed {
                    values[(one.at[0], one.at[1])] = one.values[line];
                }
                Ok((moved / squares(&self.grid, &values)).sqrt())
            };
            lines.map(of).collect::<Result<Vec<f64>, SpatialError>>()
        })?;
        Ok(parts.concat())
    }

    fn kept(&self, unknowns: &Unknowns) -> Result<Vec<usize>, SpatialError> {
        let moved = self.moved(unknowns)?;
        let kept: Vec<usize> = (0..moved.len())
            .filter(|&line| moved[line] < MOVED_MAX)
            .collect();
        if kept.len() * self.problem.observed.len() <= self.problem.joint_count() {
            return Err(SpatialError::TooMuchNoise {
                lines: moved.len(),
                kept: kept.len(),
                percent: 100.0 * MOVED_MAX,
            });
        }
        Ok(kept)
    }

    /// Gauss–Newton steps, with h following at each.
    fn searched(
        &self,
        start: Unknowns,
        steps: usize,
    ) -> Result<(Unknowns, Normal, bool), SpatialError> {
        let mut unknowns = start;
        let mut hidden = self.measured.clone();
        let mut last = None;
        for _ in 0..steps {
            let (normal, followed) = self.normal(&unknowns, &hidden)?;
            let covariance = covariance(&normal.information).ok_or(SpatialError::NotDetermined)?;
            let step = self.step(&unknowns, &normal)?;
            let in_deviations = step
                .iter()
                .zip(&covariance.diagonal())
                .map(|(step, variance)| step.abs() / variance.sqrt())
                .fold(0.0, f64::max);
            unknowns = Unknowns(&unknowns.0 + step);
            // far from the bottom they would follow the wrong joint
            if in_deviations < NEAR {
                hidden = followed;
            }
            let has_settled = in_deviations < SETTLED;
            last = Some((normal, has_settled));
            if has_settled {
                break;
            }
        }
        let (normal, has_settled) = last.ok_or(SpatialError::NoStart)?;
        Ok((unknowns, normal, has_settled))
    }

    /// (F + λ E)⁻¹ g with the least λ that bounds the step of the stiffness, E by what couples two motions at most.
    fn step(&self, unknowns: &Unknowns, normal: &Normal) -> Result<DVector<f64>, SpatialError> {
        let expected = self.problem.expected(unknowns)?;
        let stiffness = self.problem.joint_count() / 2;
        let mut damping = 0.0;
        loop {
            let mut information = normal.information.clone();
            for place in 0..expected.len() {
                information[(place, place)] += damping / expected[place].powi(2);
            }
            let inverse = covariance(&information).ok_or(SpatialError::NotDetermined)?;
            let step = inverse * &normal.descent;
            let longest = (0..stiffness)
                .map(|place| (step[place] / expected[place]).abs())
                .fold(0.0, f64::max);
            if longest <= LONGEST {
                return Ok(step);
            }
            if damping > DAMPING_MAX {
                return Err(SpatialError::NotDetermined);
            }
            damping = if damping == 0.0 { 1.0 } else { 4.0 * damping };
        }
    }

    /// The normal equations at these unknowns and reduced functions, and to what the latter go.
    fn normal(
        &self,
        unknowns: &Unknowns,
        hidden: &[Hidden],
    ) -> Result<(Normal, Vec<Hidden>), SpatialError> {
        let assembled = Assembled::new(self.problem, unknowns)?;
        let parts = over_lines(self.problem.frequency_hz.len(), |lines| {
            let mut normal = Normal::zeros(self.problem.count());
            let mut followed = Vec::new();
            for line in lines {
                let found = self.at_line(&assembled, line, &hidden[line])?;
                let omega = self.problem.omega(line);
                normal.add_line(omega, &self.patterns, &found.products, &found.slopes);
                normal.cost += found.squares;
                followed.push(found.hidden);
            }
            Ok::<_, SpatialError>((normal, followed))
        })?;
        let mut normal = Normal::zeros(self.problem.count());
        let mut followed = Vec::new();
        for (part, own) in parts {
            normal.add(&part);
            followed.extend(own);
        }
        Ok((normal, followed))
    }

    /// The assembly with these substructures; x and y of each side with noise, then those of the joint.
    fn dyads(
        &self,
        assembled: &Assembled<'_>,
        line: usize,
        hidden: &Hidden,
    ) -> Result<(crate::assembled::Line, Vec<Group>), SpatialError> {
        let functions = [0, 1].map(|n| self.reductions[n].expanded(&hidden[n]));
        let found = assembled.line_of(line, functions.each_ref())?;
        let (a, b) = (&found.by_joint_loads, &found.joint_motions);
        let (a_d, d_b) = (a * &found.dynamic, &found.dynamic * b);
        let skips = self.problem.skips();
        let mut groups = Vec::new();
        for own in &self.noisy {
            // dY_C = L dY R, L = I − a D S, R = I − Sᵀ D b
            let sign = Complex64::from(if own.side == 0 { 1.0 } else { -1.0 });
            let [rows, columns] = skips.map(|skip| skip * own.side);
            let Reduction {
                rows: r_u,
                columns: r_f,
                ..
            } = &self.reductions[own.side];
            let mut left = DMatrix::zeros(a.nrows(), r_u.ncols());
            left.view_mut((rows, 0), r_u.shape()).copy_from(r_u);
            let mut of_interface = left.columns_mut(0, MOTIONS);
            of_interface -= &a_d * sign;
            let mut right = DMatrix::zeros(r_f.ncols(), b.ncols());
            right
                .view_mut((0, columns), (r_f.ncols(), r_f.nrows()))
                .copy_from(&r_f.transpose());
            let mut of_interface = right.rows_mut(0, MOTIONS);
            of_interface -= &d_b * sign;
            groups.push(Group { left, right });
        }
        groups.extend(found.dyads(self.problem));
        Ok((found, groups))
    }

    /// As far towards the target as the line's own squares fall: near a resonance the functions are not linear in h, and full
    /// steps would not end.
    fn followed(
        &self,
        assembled: &Assembled<'_>,
        line: usize,
        hidden: &Hidden,
        target: &Hidden,
        inverses: &[DMatrix<f64>],
    ) -> Result<Hidden, SpatialError> {
        let of = |hidden: &Hidden| {
            let functions = [0, 1].map(|n| self.reductions[n].expanded(&hidden[n]));
            let found = assembled.line_of(line, functions.each_ref())?;
            let errors = residuals(self.problem, line, &found);
            let mut sum = squares(&self.grid, &errors);
            for (own, inverse) in self.noisy.iter().zip(inverses) {
                let moved = &hidden[own.side] - &self.measured[line][own.side];
                // in the order of the dyads: row by row
                let moved = moved.transpose();
                let own = DVector::from_column_slice(moved.as_slice());
                let [re, im] = [own.map(|x| x.re), own.map(|x| x.im)];
                sum += re.dot(&(inverse * &re)) + im.dot(&(inverse * &im));
            }
            Ok::<f64, SpatialError>(sum)
        };
        let before = of(hidden)?;
        for part in PARTS {
            let trial: Hidden = std::array::from_fn(|n| {
                let step = &target[n] - &hidden[n];
                &hidden[n] + step * Complex64::from(part)
            });
            if of(&trial).is_ok_and(|squares| squares <= before) {
                return Ok(trial);
            }
        }
        Ok(hidden.clone())
    }

    fn at_line(
        &self,
        assembled: &Assembled<'_>,
        line: usize,
        hidden: &Hidden,
    ) -> Result<AtLine, SpatialError> {
        let (found, groups) = self.dyads(assembled, line, hidden)?;
        let measured = &self.measured[line];
        let mut errors = residuals(self.problem, line, &found);
        for (own, group) in self.noisy.iter().zip(&groups) {
            let moved = &measured[own.side] - &hidden[own.side];
            errors -= &group.left * moved * &group.right;
        }
        let sums = information(&self.grid, &groups);
        let slopes = descent(&self.grid, &groups, &errors);
        let all = sums.nrows() - MOTIONS * MOTIONS;
        let joint = MOTIONS * MOTIONS;
        let mut m = sums.view((0, 0), (all, all)).into_owned();
        let mut inverses = Vec::new();
        let mut first = 0;
        for own in &self.noisy {
            let inverse =
                covariance(&own.covariance(self, line)).ok_or(SpatialError::NotDetermined)?;
            let count = inverse.nrows();
            let mut block = m.view_mut((first, first), (count, count));
            block += inverse.map(Complex64::from);
            first += count;
            inverses.push(inverse);
        }
        let root = Cholesky::new(m).ok_or(SpatialError::NotDetermined)?;
        let own = sums.view((all, all), (joint, joint)).into_owned();
        let mut cross = self
            .patterns
            .columns(&sums.view((0, all), (all, joint)).into_owned());
        let mut pull = slopes.rows(0, all).into_owned();
        let lower = root.l_dirty();
        let is_solved = lower.solve_lower_triangular_mut(&mut cross)
            && lower.solve_lower_triangular_mut(&mut pull);
        if !is_solved {
            return Err(SpatialError::NotDetermined);
        }
        let products = self.patterns.products(&own) - cross.adjoint() * &cross;
        let slopes =
            self.patterns.slopes(&slopes.rows(all, joint).into_owned()) - cross.adjoint() * &pull;
        let squares = 2.0 * (squares(&self.grid, &errors) - pull.norm_squared());
        lower.ad_solve_lower_triangular_mut(&mut pull);
        let mut target = measured.clone();
        let mut first = 0;
        for own in &self.noisy {
            let values = &mut target[own.side];
            let (height, width) = values.shape();
            for p in 0..height {
                for q in 0..width {
                    values[(p, q)] += pull[first + p * width + q];
                }
            }
            first += height * width;
        }
        let followed = self.followed(assembled, line, hidden, &target, &inverses)?;
        Ok(AtLine {
            products,
            slopes,
            squares,
            hidden: followed,
        })
    }
}

impl Noisy {
    /// Λ = Σ σ_ij² (t_j t_jᵀ) ⊗ (t_i t_iᵀ) at one line.
    fn covariance(self, marginal: &Marginal<'_>, line: usize) -> DMatrix<f64> {
        let variances = marginal.problem.sides[self.side].lines[line]
            .map(|value| self.part * self.part * value.norm_sqr());
        let Reduction { motions, loads, .. } = &marginal.reductions[self.side];
        let group = Group {
            left: motions.transpose(),
            right: loads.transpose(),
        };
        information(&Grid::new(variances), &[group]).map(|sum| sum.re)
    }
}
