//! Noise of the substructures' functions: errors in variables.
//!
//! What the substructures truly are is unknown beside joint and set-up: at each line the reduced functions h of both (those of the
//! virtual point, and of what is measured elsewhere), from which all functions follow ([`model`]). The squares of a line are those of
//! the assembly's functions and of the substructures' own. At any joint and set-up h follows by Gauss–Newton steps of its own, and
//! is eliminated: with U = ∂Y/∂h of all functions, W their inverse variances and M = Uᴴ W U,
//!
//! S⁻¹ = W − W U M⁻¹ Uᴴ W, F = 2 Re Σ Jᴴ S⁻¹ J, g = 2 Re Σ Jᴴ S⁻¹ e.

mod choice;
mod compare;
mod follow;
mod held;
mod model;
mod noise;
mod rows;
mod search;
mod sums;
#[cfg(test)]
mod tests;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use num_complex::Complex64;

pub(crate) use self::search::{estimated, searched_beside};

use self::model::{Computed, Hidden, Model, between_nodes};
use self::noise::{Grids, reduced_by, weights, weights_by_line};
use self::rows::Rows;
use self::sums::{Compared, Gathered};
use crate::dyads::{Group, squares};
use crate::error::SpatialError;
use crate::fit::Squares;
use crate::normal::{Deviations, Normal, add_priors, squares_of_errors};
use crate::parallel::{over_few_lines, over_lines};
use crate::part_noise::PartNoise;
use crate::patterns::Patterns;
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;

/// The squares of everything that was measured.
#[derive(Clone)]
pub(crate) struct Beside<'p> {
    problem: &'p Problem,
    nodes: Problem,
    /// 1/σ² of the assembly's functions, and of those of the substructures at each line.
    /// Of the assembly, at each line.
    weights: Vec<DMatrix<f64>>,
    own_weights: [Vec<DMatrix<f64>>; 2],
    grids: Grids,
    /// As it follows at the unknowns that were accepted last, and that were tried last.
    hidden: Vec<Hidden>,
    measured: Vec<Hidden>,
    tried: Option<(Unknowns, Vec<Hidden>)>,
}

impl<'p> Beside<'p> {
    /// With the substructures as they were measured by a set-up with the errors among `at`; their functions have this noise.
    pub(crate) fn of(
        problem: &'p Problem,
        level: &Deviations,
        noise: &[PartNoise; 2],
        at: &Unknowns,
    ) -> Result<Self, SpatialError> {
        let errors = problem.errors(at);
        let mut own_weights = [Vec::new(), Vec::new()];
        let mut reduced = [Vec::new(), Vec::new()];
        for (n, side) in problem.sides.iter().enumerate() {
            let rows = Rows::of(side, &errors[n])?;
            let own = Group {
                left: rows.reduction.rows.clone(),
                right: rows.reduction.columns.transpose(),
            };
            let parts = over_lines(side.lines.len(), |lines| {
                let of = |line: usize| {
                    let functions = &side.lines[line];
                    if let Some(told) = side.noise.get(line) {
                        let weights = weights_by_line(functions, told);
                        let reduced = reduced_by(&own, &weights, functions)?;
                        return Ok::<_, SpatialError>((weights, reduced));
                    }
                    // weights by what is measured would favour what noise has made small
                    let first = weights(functions, &noise[n]);
                    let weights = match side.points() {
                        Some(_) => {
                            let smooth = reduced_by(&own, &first, functions)?;
                            weights(&rows.reduction.expanded(&smooth), &noise[n])
                        }
                        None => first,
                    };
                    let reduced = reduced_by(&own, &weights, functions)?;
                    Ok((weights, reduced))
                };
                lines.map(of).collect::<Result<Vec<_>, _>>()
            })?;
            (own_weights[n], reduced[n]) = parts.into_iter().flatten().unzip();
        }
        let [a, b] = reduced;
        let hidden: Vec<Hidden> = a.into_iter().zip(b).map(<[_; 2]>::from).collect();
        let lines = 0..problem.frequency_hz.len();
        let weights: Vec<_> = lines.map(|line| problem.weights_at(level, line)).collect();
        Ok(Self {
            nodes: between_nodes(problem, &hidden),
            grids: Grids::of(&weights, &own_weights, 1.0),
            problem,
            weights,
            own_weights,
            measured: hidden.clone(),
            hidden,
            tried: None,
        })
    }

    /// The same at these of its lines, which are all that `problem` has; h stands where it stood.
    pub(crate) fn on<'q>(&self, problem: &'q Problem, lines: &[usize]) -> Beside<'q> {
        fn these<T: Clone>(all: &[T], lines: &[usize]) -> Vec<T> {
            lines.iter().map(|&line| all[line].clone()).collect()
        }
        let own_weights = self.own_weights.each_ref().map(|own| these(own, lines));
        let hidden = these(&self.hidden, lines);
        let weights = these(&self.weights, lines);
        Beside {
            problem,
            nodes: between_nodes(problem, &hidden),
            grids: Grids::of(&weights, &own_weights, 1.0),
            weights,
            own_weights,
            hidden,
            measured: these(&self.measured, lines),
            tried: None,
        }
    }

    /// With h as it was measured.
    pub(crate) fn begin(&mut self) {
        self.hidden = self.measured.clone();
        self.tried = None;
    }

    /// As if all noise were so many times as large.
    pub(crate) fn raise(&mut self, factor: f64) {
        self.grids = Grids::of(&self.weights, &self.own_weights, factor);
    }

    /// Real numbers that are compared, less those of h.
    pub(crate) fn numbers(&self) -> usize {
        let own = self.problem.sides.iter().zip(&self.nodes.sides);
        let beyond = own.map(|(side, reduced)| {
            side.responses.len() * side.references.len()
                - reduced.responses.len() * reduced.references.len()
        });
        let lines = self.problem.frequency_hz.len();
        self.problem.numbers() + 2 * lines * beyond.sum::<usize>()
    }

    /// The squares where the substructures are what they were measured to be.
    pub(crate) fn cost_as_measured(&self, unknowns: &Unknowns) -> Result<f64, SpatialError> {
        let model = Model::of(self.problem, &self.nodes, unknowns)?;
        let parts = over_few_lines(self.hidden.len(), |lines| {
            let of = |line: usize| {
                let computed = model.line(line, &self.measured[line])?;
                Ok::<_, SpatialError>(2.0 * self.squares(line, &computed))
            };
            lines.map(of).sum::<Result<f64, _>>()
        })?;
        Ok(squares_of_errors(self.problem, unknowns) + parts.iter().sum::<f64>())
    }

    /// What the joint leaves of these squares, over the numbers of the assembly that are free of it: 1 where noise explains it.
    ///
    /// The substructures have many more numbers than joint and h. What noise leaves of them hides what the joint does, so
    /// that it is taken away: the squares of the substructures alone, with the set-up that they were reduced with.
    pub(crate) fn left_in_assembly(
        &self,
        unknowns: &Unknowns,
        squares: f64,
    ) -> Result<f64, SpatialError> {
        let model = self.model(unknowns)?;
        let parts = over_few_lines(self.measured.len(), |lines| {
            let of = |line: usize| {
                let computed = model.line(line, &self.measured[line])?;
                Ok::<_, SpatialError>(2.0 * self.own_squares(line, &computed))
            };
            lines.map(of).sum::<Result<f64, _>>()
        })?;
        let alone = parts.iter().sum::<f64>() + squares_of_errors(self.problem, unknowns);
        let free = self.problem.free_numbers();
        Ok((squares - alone) / free as f64)
    }

    /// The substructures as they were found at these unknowns, with an exact set-up.
    pub(crate) fn found(&self, unknowns: &Unknowns) -> Result<Problem, SpatialError> {
        let model = self.model(unknowns)?;
        let mut own = self.problem.displaced(unknowns)?;
        for (n, side) in own.sides.iter_mut().enumerate() {
            let expanded = |hidden: &Hidden| model.rows[n].reduction.expanded(&hidden[n]);
            side.lines = self.hidden.iter().map(expanded).collect();
        }
        Ok(own)
    }

    fn model(&self, unknowns: &Unknowns) -> Result<Model<'_>, SpatialError> {
        Model::of(self.problem, &self.nodes, unknowns)
    }

    /// Measured less computed functions of the assembly, 0 where nothing was measured.
    fn errors(&self, line: usize, computed: &Computed) -> DMatrix<Complex64> {
        let (rows, columns) = computed.assembly.shape();
        let mut errors = DMatrix::zeros(rows, columns);
        for one in &self.problem.observed {
            let at = (one.at[0], one.at[1]);
            errors[at] = one.values[line] - computed.assembly[at];
        }
        errors
    }

    fn own_errors(&self, side: usize, line: usize, computed: &Computed) -> DMatrix<Complex64> {
        &self.problem.sides[side].lines[line] - &computed.substructures[side]
    }

    fn squares(&self, line: usize, computed: &Computed) -> f64 {
        squares(&self.grids.assembly[line], &self.errors(line, computed))
            + self.own_squares(line, computed)
    }

    fn own_squares(&self, line: usize, computed: &Computed) -> f64 {
        let own = [0, 1].map(|n| {
            squares(
                &self.grids.own[n][line],
                &self.own_errors(n, line, computed),
            )
        });
        own[0] + own[1]
    }

    /// The numbers of h of both sides.
    fn hidden_counts(&self) -> [usize; 2] {
        let count = |n: usize| self.hidden.first().map_or(0, |hidden| hidden[n].len());
        [count(0), count(1)]
    }

    /// What a line says of h, then of the joints, then of the rows of the set-up of each side.
    fn of_everything(
        &self,
        model: &Model<'_>,
        line: usize,
        hidden: &Hidden,
        computed: &Computed,
        into: &mut Gathered,
    ) {
        let [a, b] = self.hidden_counts();
        let places = [0, a];
        let mut next = a + b;
        let mut put = |group: Group| {
            let place = next;
            next += group.count();
            (place, group)
        };
        let mut groups = vec![
            (0, model.of_hidden(0, computed)),
            (a, model.of_hidden(1, computed)),
        ];
        groups.extend(model.of_joints(computed).into_iter().map(&mut put));
        let mut alone = Vec::new();
        for n in [0, 1] {
            let mut own = vec![(places[n], model.of_hidden_alone(n))];
            if self.has_set_up(n) {
                let [of_channels, of_impacts] = model.of_set_up(n, computed);
                let rows = &model.rows[n];
                let of_sensors = (!rows.of_sensors.is_empty()).then(|| of_channels.clone());
                let of_hits = (!rows.of_hits.is_empty()).then(|| of_impacts.clone());
                let in_assembly = [of_channels, of_impacts].map(&mut put);
                let of_own = model.of_set_up_alone(n, hidden);
                let firsts = in_assembly.each_ref().map(|(place, _)| *place);
                own.extend(firsts.into_iter().zip(of_own));
                groups.extend(in_assembly);
                groups.extend(of_sensors.map(&mut put));
                groups.extend(of_hits.map(&mut put));
            }
            alone.push(Compared {
                grid: &self.grids.own[n][line],
                errors: self.own_errors(n, line, computed),
                groups: own,
            });
        }
        alone.insert(
            0,
            Compared {
                grid: &self.grids.assembly[line],
                errors: self.errors(line, computed),
                groups,
            },
        );
        into.gather(next, &alone);
    }

    fn has_set_up(&self, side: usize) -> bool {
        self.problem.tolerances.is_some() && self.problem.sides[side].points().is_some()
    }

    /// The normal equations at these unknowns and this h.
    fn normal_at(&self, unknowns: &Unknowns, hidden: &[Hidden]) -> Result<Normal, SpatialError> {
        let model = self.model(unknowns)?;
        let [a, b] = self.hidden_counts();
        let of_h = a + b;
        let mut first = MOTIONS * MOTIONS * self.problem.links.sought().len();
        let mut of_set_up = Vec::new();
        for n in [0, 1] {
            if self.has_set_up(n) {
                of_set_up.extend(model.rows[n].patterns(first));
                first += model.rows[n].dyads();
            }
        }
        let patterns = Patterns::beside(self.problem, of_set_up);
        let count = self.problem.count();
        let parts = over_few_lines(hidden.len(), |lines| {
            let mut normal = Normal::zeros(count);
            let mut all = Gathered::default();
            for line in lines {
                let computed = model.line(line, &hidden[line])?;
                self.of_everything(&model, line, &hidden[line], &computed, &mut all);
                normal.cost += 2.0 * all.squares;
                let (products, slopes) = eliminated(&patterns, of_h, &all)?;
                normal.add_line(self.problem.omega(line), &patterns, &products, &slopes);
            }
            Ok::<_, SpatialError>(normal)
        })?;
        let mut normal = Normal::zeros(count);
        for part in &parts {
            normal.add(part);
        }
        add_priors(self.problem, unknowns, &mut normal);
        Ok(normal)
    }

    /// The normal equations where the substructures are what they were measured to be.
    pub(crate) fn normal_as_measured(&self, unknowns: &Unknowns) -> Result<Normal, SpatialError> {
        self.normal_at(unknowns, &self.measured)
    }
}

impl Squares for Beside<'_> {
    fn problem(&self) -> &Problem {
        self.problem
    }

    fn normal(&mut self, unknowns: &Unknowns) -> Result<Normal, SpatialError> {
        self.hidden = match self.tried.take() {
            Some((own, hidden)) if own == *unknowns => hidden,
            _ => self.all_followed(unknowns)?.0,
        };
        self.normal_at(unknowns, &self.hidden)
    }

    fn cost(&mut self, unknowns: &Unknowns) -> Result<f64, SpatialError> {
        let (hidden, cost) = self.all_followed(unknowns)?;
        self.tried = Some((unknowns.clone(), hidden));
        Ok(cost)
    }
}

/// Less XᴴX = RᵀR + QᵀQ + j (RᵀQ − QᵀR) of X = R + jQ: real products, which the library does in vectors.
fn subtract_square(all: &mut DMatrix<Complex64>, matrix: &DMatrix<Complex64>) {
    let (real, imaginary) = (matrix.map(|x| x.re), matrix.map(|x| x.im));
    let transposed = real.transpose();
    let mut even = &transposed * &real;
    even.gemm(1.0, &imaginary.transpose(), &imaginary, 1.0);
    let odd = transposed * &imaginary;
    for j in 0..all.ncols() {
        for i in 0..all.nrows() {
            all[(i, j)] -= Complex64::new(even[(i, j)], odd[(i, j)] - odd[(j, i)]);
        }
    }
}

/// Jᴴ S⁻¹ J and Jᴴ S⁻¹ e of a line, whose first dyads are those of h.
fn eliminated(
    patterns: &Patterns,
    of_h: usize,
    all: &Gathered,
) -> Result<(DMatrix<Complex64>, DVector<Complex64>), SpatialError> {
    let rest = all.slopes.len() - of_h;
    let own = all.products.view((0, 0), (of_h, of_h)).into_owned();
    let root: Cholesky<Complex64, Dyn> = Cholesky::new(own).ok_or(SpatialError::NotDetermined)?;
    let mut cross = patterns.columns(all.products.view((0, of_h), (of_h, rest)).as_view());
    let mut pull = all.slopes.rows(0, of_h).into_owned();
    let lower = root.l_dirty();
    let is_solved =
        lower.solve_lower_triangular_mut(&mut cross) && lower.solve_lower_triangular_mut(&mut pull);
    if !is_solved {
        return Err(SpatialError::NotDetermined);
    }
    let of_rest = all.products.view((of_h, of_h), (rest, rest));
    let mut products = patterns.products(of_rest.as_view());
    subtract_square(&mut products, &cross);
    let slopes = patterns.slopes(&all.slopes.rows(of_h, rest).into_owned()) - cross.ad_mul(&pull);
    Ok((products, slopes))
}
