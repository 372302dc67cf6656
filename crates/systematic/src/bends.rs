//! What the bending between two bolts does to a rotation that was measured beside one of them.
//!
//! A sensor δ beside the bolt reads θ + δ w″. Near a free end w″ is small, and a rigid arm says all; a bolt in the middle of a beam
//! has the curvature of the piece to the next bolt beside it. That of the cubic through translations and rotations at both
//! ends of a piece of length L, the next bolt lying in the direction of x for L > 0, is at the bolt itself
//!
//! w″ = 6 (w′ − w)/L² − (4θ + 2θ′)/L.
//!
//! A moment on the bolt makes w″ jump there by 1/EI. Where it acts and the rotation is measured at the same place δ beside the
//! bolt, half of what is measured is on either side of it: ∂H_θθ/∂δ = 2w″ ± 1/EI.

use num_complex::Complex64;

use super::experiment::{ComplexMatrix, JointShape};

/// How a structure bends beside a bolt.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AtBolt {
    /// 1/EI, rad/(N·m²)
    pub(crate) flexibility: f64,
    /// Between this bolt and the next, where that is known.
    pub(crate) bend: Option<Bend>,
}

impl AtBolt {
    /// Without another bolt.
    pub(crate) fn alone(flexibility: f64) -> Self {
        Self {
            flexibility,
            bend: None,
        }
    }
}

/// What a sensor beside a bolt reads, for each metre.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bend {
    /// w″ as a sum over the joint's DOFs, with their weights.
    curvature: Vec<(usize, f64)>,
    /// ±1/EI, rad/(N·m²)
    jump: f64,
}

/// That of each bolt whose position, and that of another one, is known.
pub(crate) fn between_bolts(
    positions_m: &[Option<f64>],
    flexibility: f64,
    joint: &JointShape,
) -> Vec<Option<Bend>> {
    if !joint.has_rotation() {
        return Vec::new();
    }
    let of_bolt = |bolt: usize, x: f64| -> Option<Bend> {
        let others = positions_m.iter().enumerate();
        let others = others.filter_map(|(other, place)| Some((other, (*place)? - x)));
        let others = others.filter(|(other, length)| *other != bolt && *length != 0.0);
        let (next, length) = others.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let (y, next_y) = (joint.translation(bolt), joint.translation(next));
        let by_translation = 6.0 / (length * length);
        Some(Bend {
            curvature: vec![
                (y, -by_translation),
                (y + 1, -4.0 / length),
                (next_y, by_translation),
                (next_y + 1, -2.0 / length),
            ],
            jump: flexibility * length.signum(),
        })
    };
    let bolts = positions_m.iter().enumerate();
    bolts.map(|(bolt, x)| of_bolt(bolt, (*x)?)).collect()
}

/// Motions at and beside a bolt whose DOFs are its translation `y` and the rotation after it.
pub(crate) struct Beside<'b> {
    pub(crate) y: usize,
    pub(crate) bend: Option<&'b Bend>,
}

impl Beside<'_> {
    /// T H, T having the bolt's rotation in the row of its translation, and the curvature in the row of its rotation: these two
    /// rows.
    fn turned(&self, formed: &ComplexMatrix) -> [Vec<Complex64>; 2] {
        let columns = 0..formed.ncols();
        let rotation = columns.clone().map(|other| formed[(self.y + 1, other)]);
        let curvature = columns.map(|other| {
            let weights = self.bend.iter().flat_map(|bend| &bend.curvature);
            weights
                .map(|&(dof, weight)| formed[(dof, other)] * weight)
                .sum()
        });
        [rotation.collect(), curvature.collect()]
    }

    fn jump(&self) -> f64 {
        self.bend.map_or(0.0, |bend| bend.jump)
    }

    /// (1 − δT) H (1 − δT)ᵀ, and the jump: what was measured δ away from the bolt, carried to it.
    pub(crate) fn shift(&self, formed: &mut ComplexMatrix, by_m: f64) {
        for _ in 0..2 {
            for (row, turned) in (self.y..).zip(self.turned(formed)) {
                for (other, turned) in turned.into_iter().enumerate() {
                    formed[(row, other)] -= turned * by_m;
                }
            }
            formed.transpose_mut();
        }
        let theta = self.y + 1;
        formed[(theta, theta)] -= self.jump() * by_m;
    }

    /// T H + H Tᵀ, and the jump: what was measured a unit away from the bolt.
    pub(crate) fn displaced(&self, formed: &ComplexMatrix) -> ComplexMatrix {
        let mut change = ComplexMatrix::zeros(formed.nrows(), formed.ncols());
        for (row, turned) in (self.y..).zip(self.turned(formed)) {
            for (other, turned) in turned.into_iter().enumerate() {
                change[(row, other)] += turned;
                change[(other, row)] += turned;
            }
        }
        let theta = self.y + 1;
        change[(theta, theta)] += self.jump();
        change
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint() -> JointShape {
        JointShape {
            dofs: 4,
            dofs_of_a_bolt: 2,
            entries: vec![vec![(0, 0)], vec![(1, 1)], vec![(2, 2)], vec![(3, 3)]],
        }
    }

    /// A cantilever of unit EI, bolts at a and b: w(x) at x ≤ s by a force at s is (3s − x) x²/6, by a moment x²/2.
    fn cantilever(places: [f64; 2]) -> ComplexMatrix {
        let by_force = |x: f64, s: f64| {
            let (x, s) = (x.min(s), x.max(s));
            (3.0 * s - x) * x * x / 6.0
        };
        let slope_by_force = |x: f64, s: f64| match x < s {
            true => s * x - x * x / 2.0,
            false => s * s / 2.0,
        };
        ComplexMatrix::from_fn(4, 4, |i, j| {
            let (x, s) = (places[i / 2], places[j / 2]);
            let value = match (i % 2, j % 2) {
                (0, 0) => by_force(x, s),
                (1, 0) => slope_by_force(x, s),
                (0, _) => slope_by_force(s, x),
                _ => x.min(s),
            };
            Complex64::from(value)
        })
    }

    #[test]
    fn what_is_measured_beside_a_bolt_of_a_cantilever_is_carried_to_it() {
        let (places, by) = ([0.5, 0.8], 1e-6);
        let bends = between_bolts(&places.map(Some), 1.0, &joint());
        for bolt in 0..2 {
            let beside = Beside {
                y: 2 * bolt,
                bend: bends[bolt].as_ref(),
            };
            let mut moved = [places; 2];
            moved[0][bolt] += by;
            moved[1][bolt] -= by;
            let [above, below] = moved.map(cantilever);
            let slope = (&above - below) / Complex64::from(2.0 * by);
            let exact = cantilever(places);
            let apart = (&slope - beside.displaced(&exact)).camax();
            assert!(apart < 1e-6, "{bolt}: {apart}");
            let mut carried = above;
            beside.shift(&mut carried, by);
            assert!((carried - exact).camax() < 1e-10);
        }
    }

    #[test]
    fn a_bolt_alone_has_a_rigid_arm() {
        let alone = between_bolts(&[Some(0.5), None], 1.0, &joint());
        assert_eq!(alone, [None, None]);
    }
}
