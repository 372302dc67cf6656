//! Starts where the functions do not reach all motions of the joints: the loads in the joints are sought as well.
//!
//! With fewer responses than motions, loads do not follow from the functions. So loads f are sought that explain the functions
//! and move the interfaces as the joints would, both to a part of their sizes at each line:
//!
//!   Σ |(Y₀ − Y − U f)/|Y||² + λ² |H (f − X b₀)/|b₀||²,  X = (I + D H)⁻¹ D
//!
//! With a small λ, K and C go with the motions that the functions themselves say, in which they are linear: all of them lead the
//! same way where the resonances of an assembly stand between. λ grows until little is left loose. The way is that of waves in
//! a model of the earth (van Leeuwen and Herrmann, 2013, doi:10.1093/gji/ggt258).

mod lines;
mod steps;

use crate::assembled::Open;
use crate::normal::Deviations;
use crate::patterns::Patterns;
use crate::problem::{Problem, Unknowns};

/// λ of each round.
const TIGHTNESS: [f64; 6] = [0.03, 0.1, 0.3, 1.0, 3.0, 10.0];

/// Lines count alike down to these parts of the functions' r.m.s.: each has minima of its own.
const FLOORS: [f64; 2] = [0.1, 0.01];

/// Which numbers of the joints are found first.
#[derive(Clone, Copy, Debug)]
pub(crate) enum First {
    /// Those on the diagonals.
    Diagonal,
    /// All at once.
    All,
}

/// Loads that balance loosely.
pub(crate) struct Loose {
    by_floor: [Loosened; 2],
    /// The unknowns on the diagonals of the joints, and all.
    diagonal: Vec<usize>,
    all: Vec<usize>,
}

/// Lines, functions and motions, in parts of their sizes.
struct Loosened {
    lines: Vec<lines::Line>,
    /// The motions that the study is about, and what scales them: rotations as lengths.
    own: Vec<usize>,
    scales: Vec<f64>,
    patterns: Patterns,
}

impl Loose {
    /// Of an assembly without the joints that are sought.
    pub(crate) fn of(problem: &Problem, open: &[Open], level: &Deviations) -> Self {
        let sought = problem.links.sought();
        let on_diagonal = sought.iter().flat_map(|joint| {
            let entries = joint.model.entries();
            let count = entries.len();
            let own = (0..2 * count).filter(move |n| {
                let entry = &entries[n % count];
                entry.row == entry.column
            });
            own.map(|n| joint.first + n)
        });
        Self {
            by_floor: FLOORS.map(|floor| Loosened::of(problem, open, level, floor)),
            diagonal: on_diagonal.collect(),
            all: (0..problem.joint_count()).collect(),
        }
    }

    /// From these joints.
    pub(crate) fn from(
        &self,
        problem: &Problem,
        start: Unknowns,
        first: First,
    ) -> Option<Unknowns> {
        let [rough, fine] = &self.by_floor;
        let rounds: &[_] = match first {
            First::Diagonal => &[
                (rough, &self.diagonal),
                (rough, &self.all),
                (fine, &self.all),
            ],
            First::All => &[(rough, &self.all)],
        };
        let mut unknowns = start;
        for (loosened, open) in rounds {
            for tightness in TIGHTNESS {
                unknowns = loosened.settled(problem, unknowns, open, tightness)?;
            }
        }
        Some(unknowns)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;
    use crate::assembled::Assembled;
    use crate::samples::{chain, unknowns};

    /// What the functions of joints leave is nothing beside these joints, and shrinks towards them from afar.
    #[test]
    fn joints_that_make_the_functions_leave_nothing() {
        let mut problem = chain();
        problem.tolerances = None;
        let count = problem.joint_count();
        let at = Unknowns(unknowns(&problem).0.rows(0, count).into_owned());
        let assembled = Assembled::new(&problem, &at).unwrap();
        let lines = 0..problem.frequency_hz.len();
        let found: Vec<_> = lines
            .clone()
            .map(|line| assembled.line(line).unwrap())
            .collect();
        for (n, one) in problem.observed.iter_mut().enumerate() {
            one.values = found.iter().map(|line| line.functions[n]).collect();
        }
        let open = Assembled::without_sought(&problem).unwrap();
        let open: Vec<_> = lines.map(|line| open.open(line).unwrap()).collect();
        let level = vec![1e-9; problem.observed.len()];
        let loose = Loose::of(&problem, &open, &level);
        for (loosened, tightness) in loose.by_floor.iter().zip(TIGHTNESS) {
            let [truth, beside] = [&at, &Unknowns(1.3 * &at.0)]
                .map(|at| loosened.squares(&problem, at, tightness).unwrap());
            assert!(truth < 1e-16 * beside, "{truth} {beside}");
        }
        let away = DVector::from_fn(count, |n, _| at.0[n] * [1.2, 0.8, 1.1][n % 3]);
        for first in [First::All, First::Diagonal] {
            let back = loose.from(&problem, Unknowns(away.clone()), first);
            assert!((&back.unwrap().0 - &at.0).norm() < 1e-6 * at.0.norm());
        }
    }
}
