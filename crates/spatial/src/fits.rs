//! What the result shows of functions and of the set-up.

use bolted_joint_space::Dof;
use bolted_joint_virtual_point::{Change, Place};
use nalgebra::DMatrix;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::identification::{FunctionFit, SetUpError};
use crate::level::squares;
use crate::parallel::over_lines;
use crate::problem::{Observed, Problem, Unknowns};
use crate::side::{Placed, Side, Test};

/// Functions that are shown, of each pair of sides.
const SHOWN: usize = 2;

/// The strongest functions of each pair of sides, with the joint that was found; `kept` are the lines that took part.
pub(crate) fn strongest(
    problem: &Problem,
    unknowns: &Unknowns,
    kept: &[usize],
) -> Result<Vec<FunctionFit>, SpatialError> {
    let [rows, columns] = problem.skips();
    let strength = |one: &Observed| {
        let values = one.values.iter();
        // over all lines, and not that of the highest peak
        values.map(|value| value.norm().ln()).sum::<f64>()
    };
    let mut shown: Vec<usize> = Vec::new();
    for pair in [[false, false], [true, true], [false, true], [true, false]] {
        let mut own: Vec<(f64, usize)> = problem
            .observed
            .iter()
            .enumerate()
            .filter(|(_, one)| [one.at[0] >= rows, one.at[1] >= columns] == pair)
            .map(|(n, one)| (strength(one), n))
            .collect();
        own.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        shown.extend(own.iter().take(SHOWN).map(|(_, n)| n));
    }
    let assembled = Assembled::new(problem, unknowns)?;
    let lines: Vec<_> = over_lines(problem.frequency_hz.len(), |lines| {
        let of = |line| {
            let functions = assembled.line(line)?.functions;
            Ok(shown.iter().map(|&n| functions[n]).collect::<Vec<_>>())
        };
        lines.map(of).collect::<Result<Vec<_>, SpatialError>>()
    })?
    .concat();
    let residuals = squares(&problem.with_lines(kept), unknowns)?;
    let [a, b] = &problem.sides;
    let responses: Vec<_> = a.responses.iter().chain(&b.responses).collect();
    let references: Vec<_> = a.references.iter().chain(&b.references).collect();
    Ok(shown
        .iter()
        .enumerate()
        .map(|(place, &n)| {
            let one = &problem.observed[n];
            let [residual, computed] = residuals[n];
            FunctionFit {
                response: *responses[one.at[0]],
                reference: *references[one.at[1]],
                measured: one.values.clone(),
                computed: lines.iter().map(|line| line[place]).collect(),
                relative_rms: (residual / computed).sqrt(),
            }
        })
        .collect())
}

impl Problem {
    /// What the errors of the set-up came to; `covariance` is that of all unknowns.
    pub(crate) fn found_errors(
        &self,
        unknowns: &Unknowns,
        covariance: &DMatrix<f64>,
    ) -> Vec<SetUpError> {
        let (first, count) = (self.joint_count(), self.error_count());
        let prior = self.prior();
        let covariance = covariance.view((first, first), (count, count)).into_owned();
        let parameters = self.sides.iter().flat_map(Side::parameters);
        let alone = prior.alone(unknowns);
        let of_places = parameters
            .zip(self.budget_deviations())
            .zip(&alone)
            .zip(prior.deviations_alone(&covariance))
            .map(|(((one, expected), value), deviation)| SetUpError {
                key: match one.test {
                    Test::All => one.placed.key(one.parameter.place),
                    Test::Assembly(_) => {
                        format!("{} in the assembly", one.placed.key(one.parameter.place))
                    }
                },
                is_whole: false,
                change: one.parameter.change,
                value: *value,
                deviation,
                expected,
            });
        let of_wholes = prior.wholes(unknowns, &covariance).into_iter();
        let of_wholes = of_wholes.flat_map(|(whole, values)| {
            let each = Dof::ALL.into_iter().zip(values);
            each.map(move |(dof, [value, deviation, expected])| SetUpError {
                key: whole.to_string(),
                is_whole: true,
                change: Change::Pose(dof),
                value,
                deviation,
                expected,
            })
        });
        of_places.chain(of_wholes).collect()
    }
}

impl Placed {
    /// A sensor's or impact's key in the study.
    pub(crate) fn key(&self, place: Place) -> String {
        let name = &self.name;
        match place {
            Place::Sensor(number) => format!("{name}.sensors[{number}]"),
            Place::Impact(number) => format!("{name}.impacts[{number}]"),
            Place::Channel(row) => {
                let number = self.points().and_then(|(_, set_up)| {
                    let mut each = set_up.channels().rows_of_each().into_iter();
                    each.position(|rows| rows.contains(&row))
                });
                format!("{name}.sensors[{}]", number.unwrap_or_default())
            }
        }
    }
}
