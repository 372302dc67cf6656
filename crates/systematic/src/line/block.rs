//! The linearised line, assembly by assembly: what they have in common, and what each adds.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::super::cause::{Cause, Side};
use super::super::experiment::{Assembly, ComplexMatrix, Structure};
use super::super::structures::Recomputations;
use super::{Labelled, Point, Task, Terms};

/// What the assemblies have in common at a line.
struct Linearised<'l> {
    line: usize,
    point: &'l Point,
    recomputed: &'l Recomputations,
    /// Labelled receptances as measured, without the causes, less those at which is linearised.
    shift: DVector<Complex64>,
    /// A and B.
    own: [ComplexMatrix; 2],
    /// The same without noise, where causes take part.
    of_smooth: Option<[ComplexMatrix; 2]>,
    measured_by_cause: [Vec<Option<Vec<Complex64>>>; 2],
}

/// What one assembly adds to a linearised line.
struct Block {
    residual: Vec<Complex64>,
    rows: DMatrix<Complex64>,
    by_labelled: DMatrix<Complex64>,
    magnitude: Vec<f64>,
    apart: Vec<f64>,
}

fn listed(blocks: &[Block], part: fn(&Block) -> &Vec<f64>) -> Vec<f64> {
    blocks.iter().flat_map(part).copied().collect()
}

/// Matrices with equally many columns, one below the other.
fn stacked<'m>(
    matrices: impl Iterator<Item = &'m DMatrix<Complex64>> + Clone,
) -> DMatrix<Complex64> {
    let rows = matrices.clone().map(|matrix| matrix.nrows()).sum();
    let columns = matrices.clone().next().map_or(0, |matrix| matrix.ncols());
    let mut all = DMatrix::zeros(rows, columns);
    let mut first = 0;
    for matrix in matrices {
        all.rows_mut(first, matrix.nrows()).copy_from(matrix);
        first += matrix.nrows();
    }
    all
}

/// The product with a matrix that is zero nearly everywhere.
fn times(chain: &ComplexMatrix, changes: &DMatrix<Complex64>) -> DMatrix<Complex64> {
    let mut product = DMatrix::zeros(chain.nrows(), changes.ncols());
    for column in 0..chain.ncols() {
        for row in 0..chain.nrows() {
            let factor = chain[(row, column)];
            if factor == Complex64::ZERO {
                continue;
            }
            for (sum, change) in product
                .row_mut(row)
                .iter_mut()
                .zip(changes.row(column).iter())
            {
                *sum += factor * change;
            }
        }
    }
    product
}

impl Task<'_> {
    /// Linearises a line; `None` where an assembly is singular.
    pub(crate) fn terms(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<Terms> {
        let own = self.structures(line, point, labelled, recomputed)?;
        let measured = [Side::A, Side::B]
            .map(|side| self.without_causes(side, line, point, &labelled[side as usize]));
        // Derivatives by the causes come from smooth receptances: from noisy ones the noise would be read as information.
        let smooth = self.smooth(line, point, labelled);
        let of_smooth = match self.priors {
            [] => None,
            _ => Some(self.structures(line, point, &smooth, recomputed)?),
        };
        let shift = (0..2).flat_map(|side| {
            let pairs = measured[side].iter().zip(&labelled[side]);
            pairs.map(|(clean, now)| clean - now).collect::<Vec<_>>()
        });
        let at = Linearised {
            line,
            point,
            recomputed,
            shift: DVector::from_iterator(labelled.iter().map(Vec::len).sum(), shift),
            own,
            of_smooth,
            measured_by_cause: [Side::A, Side::B]
                .map(|side| self.by_causes(side, line, point, &smooth[side as usize])),
        };
        let assemblies = self.experiment.assemblies.iter().enumerate();
        let blocks: Vec<Block> = assemblies
            .map(|(number, assembly)| self.block((number, assembly), &at))
            .collect::<Option<_>>()?;
        let of = |part: fn(&Block) -> &DMatrix<Complex64>| stacked(blocks.iter().map(part));
        let residuals = blocks
            .iter()
            .flat_map(|block| block.residual.iter().copied());
        Some(Terms {
            residual: DVector::from_vec(residuals.collect()),
            rows: of(|block| &block.rows),
            by_labelled: of(|block| &block.by_labelled),
            labelled_variance: self.labelled_variance(line, point, &smooth),
            measured,
            measured_by_cause: at.measured_by_cause,
            magnitude: listed(&blocks, |block| &block.magnitude),
            apart: listed(&blocks, |block| &block.apart),
        })
    }

    /// Linearises an assembly at a line.
    fn block(
        &self,
        (number, assembly): (usize, &Assembly),
        line: &Linearised<'_>,
    ) -> Option<Block> {
        let experiment = self.experiment;
        let point = line.point;
        let omega = experiment.omega[line.line];
        let coupled = &self.coupled(assembly, line.line, point, &line.own)?;
        let of_smooth = match &line.of_smooth {
            None => None,
            Some(structures) => Some(self.coupled(assembly, line.line, point, structures)?),
        };
        let smooth_coupled = of_smooth.as_ref().unwrap_or(coupled);
        let smooth_structures = line.of_smooth.as_ref().unwrap_or(&line.own);
        let entries = &assembly.functions.entries;
        let smooth_at = self.at_assembly(number, smooth_coupled, line.line);
        let chain = smooth_at.by_truth(self.priors, &point.causes);
        let mut places: Vec<(usize, usize)> = entries.iter().map(|entry| entry.place).collect();
        if chain.is_some() {
            places.extend((0..experiment.points()).map(|label| (label, label)));
        }
        let chained = |changes: DMatrix<Complex64>| match &chain {
            Some(chain) => times(chain, &changes),
            None => changes,
        };
        let smooth_by_labelled = chained(self.by_labelled(smooth_coupled, &places));
        let by_labelled = chained(self.by_labelled(coupled, &places));
        let at = self.at_assembly(number, coupled, line.line);
        let beside = at.beside(self.priors, &point.causes);
        let moved = &by_labelled * &line.shift;
        let factors = at.factors(self.priors, &point.causes);
        let residual = (0..entries.len()).map(|e| {
            let entry = &entries[e];
            let clean = entry.values[line.line] / factors[e] - beside[e];
            clean - coupled.receptance[entry.place] - moved[e]
        });
        let residual = residual.collect();
        let count = experiment.joint.entries.len();
        let first = self.first_unknown(assembly);
        let unknowns = self.unknowns();
        let mut rows = DMatrix::zeros(places.len(), unknowns + self.priors.len());
        for (t, of) in experiment.joint.entries.iter().enumerate() {
            for (e, place) in places.iter().enumerate() {
                let by = smooth_coupled.by_stiffness(of, *place);
                // K* = K (1 + jη) + jωC
                rows[(e, first + t)] = by * Complex64::new(1.0, self.loss_factor(point));
                rows[(e, first + count + t)] = by * Complex64::new(0.0, omega);
            }
        }
        for (cause, prior) in self.priors.iter().enumerate() {
            let column = unknowns + cause;
            let mut add = |change: &ComplexMatrix| {
                for (e, place) in places.iter().enumerate() {
                    rows[(e, column)] += change[*place];
                }
            };
            match prior.cause {
                Cause::LossFactor => add(&smooth_coupled.by_loss_factor()),
                Cause::JointMass(side, bolt) => {
                    add(&smooth_coupled.by_mass(self.mass_dof(side, bolt), omega))
                }
                Cause::JointInertia(side, bolt) => {
                    add(&smooth_coupled.by_mass(self.mass_dof(side, bolt) + 1, omega))
                }
                _ => {}
            }
            for side in [Side::A, Side::B] {
                let direct = match experiment.side(side) {
                    Structure::Measured(measured) => measured.formed_by_cause(
                        experiment.joint.dofs_of_a_bolt,
                        side,
                        (&smooth_structures[side as usize], omega),
                        (prior.cause, point.causes[cause]),
                    ),
                    Structure::Computed(_) => {
                        let all = line
                            .recomputed
                            .side(side)
                            .map(|side| side.by_cause.as_slice())
                            .unwrap_or_default();
                        all.iter()
                            .find(|(of, _)| *of == cause)
                            .map(|(_, slope)| slope[line.line].clone())
                    }
                    Structure::Exact(_) => None,
                };
                if let Some(direct) = direct {
                    add(&smooth_coupled.by_structure(side == Side::A, &direct));
                }
            }
        }
        let mut rows = chained(rows);
        for (cause, prior) in self.priors.iter().enumerate() {
            let column = unknowns + cause;
            if let Some(by) = smooth_at.by_cause(prior.cause, point.causes[cause]) {
                for (e, by) in by.into_iter().enumerate() {
                    rows[(e, column)] += by;
                }
            }
            let mut first = 0;
            for (side, structure) in line.measured_by_cause.iter().enumerate() {
                if let Some(by) = &structure[cause] {
                    for (s, by) in by.iter().enumerate() {
                        for e in 0..entries.len() {
                            rows[(e, column)] += smooth_by_labelled[(e, first + s)] * by;
                        }
                    }
                }
                first += experiment.labelled(if side == 0 { Side::A } else { Side::B });
            }
        }
        let apart = entries.iter().map(|entry| {
            let smooth = smooth_coupled.receptance[entry.place];
            (smooth - coupled.receptance[entry.place]).norm()
        });
        Some(Block {
            residual,
            rows,
            apart: apart.collect(),
            by_labelled,
            magnitude: std::iter::zip(entries, beside)
                .map(|(entry, beside)| (coupled.receptance[entry.place] + beside).norm())
                .collect(),
        })
    }
}
