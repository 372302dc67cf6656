//! Receptances of a substructure at lines side by side, each formed from few measured functions and not as a product of matrices.

use super::lanes::{Complexes, LANES};
use super::receptances::{Function, Receptances};

/// What the receptances of any lines are formed from.
pub(super) struct Formed<'r> {
    of: &'r Receptances,
    /// Rows and columns.
    size: usize,
    /// The upper triangle of what was measured, column by column.
    upper: Vec<Function<'r>>,
}

impl<'r> Formed<'r> {
    pub(super) fn of(receptances: &'r Receptances) -> Self {
        let size = receptances.size();
        let columns = 0..if receptances.measured().is_some() {
            size
        } else {
            0
        };
        let places = columns.flat_map(|j| (0..=j).map(move |i| (i, j)));
        Self {
            of: receptances,
            size,
            upper: places.map(|(i, j)| receptances.function(i, j)).collect(),
        }
    }

    /// Whether H = Hᵀ to the last bit.
    pub(super) fn is_symmetric(&self) -> bool {
        !self.upper.is_empty()
    }

    /// H of these lines, row by row.
    pub(super) fn at(&self, lines: [usize; LANES], into: &mut Vec<Complexes>) {
        let size = self.size;
        into.clear();
        if let Receptances::Exact(matrices) = self.of {
            let matrices = lines.map(|line| &matrices[line]);
            let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
            into.extend(places.map(|place| Complexes::of(|lane| matrices[lane][place])));
            return;
        }
        into.resize(size * size, Complexes::of(|_| 0.0.into()));
        let mut functions = self.upper.iter();
        for j in 0..size {
            for (i, function) in (0..=j).zip(&mut functions) {
                let value = Complexes::of(|lane| function.at(lines[lane]));
                into[i * size + j] = value;
                into[j * size + i] = value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::DMatrix;
    use num_complex::Complex64;

    use super::*;
    use crate::MeasuredSubstructure;

    /// Both kinds agree with the matrix of each line, W U Wᵀ with what is lost.
    #[test]
    fn lines_side_by_side_are_those_one_by_one() {
        let w = DMatrix::from_row_slice(2, 3, &[0.0, 1.0, 0.0, -20.0, 0.0, 20.0]);
        let value = |f: usize, line: usize| Complex64::new((f + 3 * line) as f64, 1.5 - f as f64);
        let functions = (0..6).map(|f| (0..5).map(|line| value(f, line)).collect());
        let measured = MeasuredSubstructure::new(w, functions.collect(), Vec::new(), None);
        let lost = DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, 0.25]);
        let measured = Receptances::Measured(Arc::new(measured.with_lost(Some(lost))));
        let mut exact: Vec<_> = (0..5).map(|line| measured.at(line).into_owned()).collect();
        exact[3][(0, 1)] += 1.0;
        for receptances in [measured, Receptances::Exact(exact)] {
            let formed = Formed::of(&receptances);
            assert_eq!(formed.is_symmetric(), receptances.measured().is_some());
            let lines = [1, 2, 3, 3];
            let mut values = Vec::new();
            formed.at(lines, &mut values);
            for (place, value) in values.iter().enumerate() {
                for (lane, &line) in lines.iter().enumerate() {
                    let expected = receptances.at(line)[(place / 2, place % 2)];
                    let error = (value.lane(lane) - expected).norm();
                    assert!(error <= 1e-14 * expected.norm(), "{place} {line}");
                }
            }
        }
    }
}
