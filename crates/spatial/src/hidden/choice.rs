//! At which lines the assembly's functions follow linearly from noise of the substructures.

use nalgebra::{Cholesky, DMatrix};

use super::Beside;
use crate::dyads::{information, squares};
use crate::error::SpatialError;
use crate::normal::Deviations;
use crate::normal::Normal;
use crate::parallel::over_few_lines;
use crate::part_noise::PartNoise;
use crate::problem::{Problem, Unknowns};
use crate::together::LINES_MAX;

/// Lines are left out where the substructures' noise moves the functions of the assembly by more than this part of them,
/// r.m.s.: there they do not follow linearly.
pub(crate) const MOVED_MAX: f64 = 0.15;

impl Beside<'_> {
    /// What noise of the substructures moves at each line, in parts of the functions, r.m.s. with the functions' weights.
    pub(crate) fn moved(&self, unknowns: &Unknowns) -> Result<Vec<f64>, SpatialError> {
        let model = self.model(unknowns)?;
        let parts = over_few_lines(self.measured.len(), |lines| {
            let of = |line: usize| {
                let computed = model.line(line, &self.measured[line])?;
                let mut moved = 0.0;
                for n in [0, 1] {
                    let own = [model.of_hidden_alone(n)];
                    let root = Cholesky::new(information(&self.grids.own[n][line], &own))
                        .ok_or(SpatialError::NotDetermined)?;
                    let sums =
                        information(&self.grids.assembly[line], &[model.of_hidden(n, &computed)]);
                    // Σ w var = tr(Λ Uᴴ W U)
                    moved += root.solve(&sums).trace().re;
                }
                let (rows, columns) = computed.assembly.shape();
                let mut values = DMatrix::zeros(rows, columns);
                for one in &self.problem.observed {
                    values[(one.at[0], one.at[1])] = one.values[line];
                }
                Ok((moved / squares(&self.grids.assembly[line], &values)).sqrt())
            };
            lines.map(of).collect::<Result<Vec<f64>, SpatialError>>()
        })?;
        Ok(parts.concat())
    }

    /// The lines that take part.
    pub(crate) fn kept(&self, unknowns: &Unknowns) -> Result<Vec<usize>, SpatialError> {
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

    /// The half of the lines at which that noise moves the functions least.
    pub(crate) fn steadiest(&self, unknowns: &Unknowns) -> Result<Vec<usize>, SpatialError> {
        let moved = self.moved(unknowns)?;
        let mut lines: Vec<usize> = (0..moved.len()).collect();
        lines.sort_by(|&one, &other| moved[one].total_cmp(&moved[other]));
        lines.truncate(moved.len().div_ceil(2));
        lines.sort_unstable();
        Ok(lines)
    }
}

impl Problem {
    /// With the functions of a rigid interface in place of the measured ones, which have more noise.
    pub(crate) fn smoothed(&self) -> Result<Self, SpatialError> {
        let mut own = self.clone();
        for side in &mut own.sides {
            let reduction = side.reduction()?;
            for line in &mut side.lines {
                *line = reduction.expanded(&reduction.reduced(line));
            }
        }
        Ok(own)
    }

    /// What a test will tell whose functions are these, with noise of the substructures: the information, and how many lines will
    /// take part.
    pub(crate) fn told_beside_noise(
        &self,
        truth: &Unknowns,
        level: &Deviations,
        noise: &[PartNoise; 2],
    ) -> Result<(Normal, usize), SpatialError> {
        let kept = Beside::of(self, level, noise, truth)?.kept(truth)?;
        let mut own = self.with_lines(&kept);
        if self.error_count() > 0 {
            own = own.thinned(LINES_MAX);
        }
        let normal = Beside::of(&own, level, noise, truth)?.normal_as_measured(truth)?;
        Ok((normal, kept.len()))
    }
}
