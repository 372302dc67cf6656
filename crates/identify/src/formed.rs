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
