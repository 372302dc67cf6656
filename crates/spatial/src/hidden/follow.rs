//! h as it follows from joint and set-up, line by line: Gauss–Newton steps of its own.
//!
//! Most of a step's time goes into M = Uᴴ W U and its factors. M hardly changes on the way, so a line keeps its factors as long
//! as steps with them shrink fast: what they lead to is the same, as the slopes Uᴴ W e are always those of where h stands.

use nalgebra::{Cholesky, DVector, Dyn};
use num_complex::Complex64;

use super::Beside;
use super::model::{Computed, Hidden, Model};
use super::sums::{Compared, Gathered, slopes};
use crate::error::SpatialError;
use crate::normal::squares_of_errors;
use crate::parallel::over_few_lines;
use crate::problem::Unknowns;

/// Steps of h at most, and the squares below which one was the last.
const STEPS_MAX: usize = 40;
const SETTLED: f64 = 1e-9;

/// Damping of a step of h: near a resonance the functions are not linear in it.
const DAMPING_MIN: f64 = 1e-9;
const DAMPING_MAX: f64 = 1e6;

/// Squares that a step wins with factors from before, in parts of what the last step won, at most.
const SHRINKS: f64 = 0.1;

/// Squares of a line over its numbers that no noise explains.
const LAGGING: f64 = 2.0;

/// Where h of one line stands.
struct Place {
    hidden: Hidden,
    computed: Computed,
    squares: f64,
}

impl Beside<'_> {
    fn place(&self, model: &Model<'_>, line: usize, hidden: Hidden) -> Result<Place, SpatialError> {
        let computed = model.line(line, &hidden)?;
        Ok(Place {
            squares: self.squares(line, &computed),
            hidden,
            computed,
        })
    }

    /// h as it follows at one line, from where it is; and the line's squares.
    fn followed(
        &self,
        model: &Model<'_>,
        line: usize,
        from: &Hidden,
    ) -> Result<(Hidden, f64), SpatialError> {
        let mut here = self.place(model, line, from.clone())?;
        let mut damping = 0.0;
        let mut won = f64::INFINITY;
        let mut kept: Option<Cholesky<Complex64, Dyn>> = None;
        for _ in 0..STEPS_MAX {
            let compared = self.compared_of_hidden(model, line, &here.computed);
            let slopes = slopes(self.of_h(), &compared);
            let before = kept.take().and_then(|root| {
                let step = root.solve(&slopes);
                let gain = slopes.dotc(&step).re;
                (gain < SHRINKS * won).then_some((root, step, gain))
            });
            let is_from_before = before.is_some();
            let (root, step, gain) = match before {
                Some(own) => own,
                None => {
                    let root = damped(Gathered::of(self.of_h(), &compared), damping)?;
                    let step = root.solve(&slopes);
                    let gain = slopes.dotc(&step).re;
                    (root, step, gain)
                }
            };
            let is_last = gain < SETTLED * (1.0 + here.squares);
            let there = self.place(model, line, advanced(&here.hidden, &step, 1.0));
            match there {
                Ok(there) if there.squares < here.squares => {
                    here = there;
                    won = gain;
                    if damping == 0.0 {
                        kept = Some(root);
                    }
                    damping = if damping > DAMPING_MIN {
                        0.1 * damping
                    } else {
                        0.0
                    };
                }
                _ if is_last => break,
                // with factors of its own
                _ if is_from_before => {}
                _ => damping = (10.0 * damping).max(DAMPING_MIN),
            }
            if is_last || damping >= DAMPING_MAX {
                break;
            }
        }
        Ok((here.hidden, 2.0 * here.squares))
    }

    /// The functions of a line, with what changes of h do to them.
    fn compared_of_hidden(
        &self,
        model: &Model<'_>,
        line: usize,
        computed: &Computed,
    ) -> Vec<Compared<'_>> {
        let [a, _] = self.hidden_counts();
        let places = [0, a];
        let assembly = Compared {
            grid: &self.grids.assembly[line],
            errors: self.errors(line, computed),
            groups: [0, 1]
                .map(|n| (places[n], model.of_hidden(n, computed)))
                .into(),
        };
        let alone = [0, 1].map(|n| Compared {
            grid: &self.grids.own[n][line],
            errors: self.own_errors(n, line, computed),
            groups: vec![(places[n], model.of_hidden_alone(n))],
        });
        std::iter::once(assembly).chain(alone).collect()
    }

    fn of_h(&self) -> usize {
        self.hidden_counts().iter().sum()
    }

    /// The lines that joint and set-up explain, of those that are here, with h as it follows there: at the others h cannot be found,
    /// as near a resonance that moves by more than its width. All, where so many are not explained that it is not their fault.
    pub(crate) fn explained(&mut self, unknowns: &Unknowns) -> Result<Vec<usize>, SpatialError> {
        self.begin();
        let lines = self.measured.len();
        let numbers = (self.numbers() / lines.max(1)) as f64;
        let (hidden, squares) = self.each_followed(unknowns)?;
        self.hidden = hidden;
        let is_explained = |&line: &usize| squares[line] < LAGGING * numbers;
        let explained: Vec<usize> = (0..lines).filter(is_explained).collect();
        Ok(match 10 * explained.len() >= 9 * lines {
            true => explained,
            false => (0..lines).collect(),
        })
    }

    /// h of all lines as it follows at these unknowns, and all squares.
    pub(super) fn all_followed(
        &self,
        unknowns: &Unknowns,
    ) -> Result<(Vec<Hidden>, f64), SpatialError> {
        let (hidden, squares) = self.each_followed(unknowns)?;
        let own = squares_of_errors(self.problem, unknowns);
        Ok((hidden, own + squares.iter().sum::<f64>()))
    }

    fn each_followed(&self, unknowns: &Unknowns) -> Result<(Vec<Hidden>, Vec<f64>), SpatialError> {
        let model = self.model(unknowns)?;
        let parts = over_few_lines(self.hidden.len(), |lines| {
            let of = |line: usize| self.followed(&model, line, &self.hidden[line]);
            lines.map(of).collect::<Result<Vec<_>, SpatialError>>()
        })?;
        Ok(parts.into_iter().flatten().unzip())
    }
}

/// The factors of M, with a damped diagonal.
fn damped(
    Gathered { mut products, .. }: Gathered,
    damping: f64,
) -> Result<Cholesky<Complex64, Dyn>, SpatialError> {
    for n in 0..products.nrows() {
        products[(n, n)] *= 1.0 + damping;
    }
    Cholesky::new(products).ok_or(SpatialError::NotDetermined)
}

/// h with a part of a step, whose numbers are row by row.
pub(super) fn advanced(hidden: &Hidden, step: &DVector<Complex64>, part: f64) -> Hidden {
    let mut first = 0;
    hidden.each_ref().map(|own| {
        let (rows, columns) = own.shape();
        let values = step.rows(first, rows * columns);
        first += rows * columns;
        let step = values.reshape_generic(Dyn(columns), Dyn(rows)).transpose();
        own + step * Complex64::from(part)
    })
}
