//! What the bending between two bolts does to a rotation that was measured beside one of them.
//!
//! A sensor δ beside the bolt reads θ + δ w″. Near a free end w″ is small, and a rigid arm says all; a bolt in the middle of a beam
//! has the curvature of the piece to the next bolt beside it. That of the cubic through translations and rotations at both
//! ends of a piece of length L, the next bolt lying in the direction of x for L > 0, is at the bolt itself
//!
//! w″ = 6 (w′ − w)/L² − (4θ + 2θ′)/L.
//!
//! So it is where nothing moves. With the inertia of the piece it is the second derivative of the sum of Krylov's functions
//! C₀ to C₃ that has these translations and rotations at both ends.
//!
//! A moment on the bolt makes w″ jump there by 1/EI. Where it acts and the rotation is measured at the same place δ beside the
//! bolt, half of what is measured is on either side of it: ∂H_θθ/∂δ = 2w″ ± 1/EI.

use num_complex::Complex64;

use super::bending_fit::Beam;
use super::bending_shape::{Waves, shape};
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
    /// The bolt's translation and the next one's, among the joint's DOFs; a rotation follows each.
    translations: [usize; 2],
    /// L: where the next bolt is beside this one, m
    length_m: f64,
    /// ρA/EI, s²/m⁴
    inertia: f64,
    /// ±1/EI, rad/(N·m²)
    jump: f64,
    /// Points between this bolt and the next: which of all motions each is, and how far from this bolt, m.
    loads: Vec<(usize, f64)>,
}

/// That of each bolt whose position, and that of another one, is known.
pub(crate) fn between_bolts(
    positions_m: &[Option<f64>],
    beam: Beam,
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
        Some(Bend {
            translations: [bolt, next].map(|bolt| joint.translation(bolt)),
            length_m: length,
            inertia: beam.inertia,
            jump: beam.flexibility * length.signum(),
            loads: Vec::new(),
        })
    };
    let bolts = positions_m.iter().enumerate();
    bolts.map(|(bolt, x)| of_bolt(bolt, (*x)?)).collect()
}

impl Bend {
    /// With the points that lie between this bolt and the next, all on one axis; the motion of point number `n` is `first + n`.
    fn with_loads(mut self, bolts_m: &[f64; 2], points_m: &[Option<f64>], first: usize) -> Self {
        let [own, next] = bolts_m;
        let away = |(number, point_m): (usize, &Option<f64>)| {
            // as a part of the way to the next bolt
            let part = ((*point_m)? - own) / (next - own);
            let is_between = part > 0.0 && part < 1.0;
            is_between.then(|| (first + number, part * self.length_m.abs()))
        };
        self.loads = points_m.iter().enumerate().filter_map(away).collect();
        self
    }

    /// w″ at the bolt by a unit force at each point between the bolts, which these hold, rad/(N·m).
    fn by_loads(&self, omega: f64) -> impl Iterator<Item = (usize, f64)> {
        let length = self.length_m.abs();
        let bending = Waves::new(self.inertia, omega).over(length);
        let [c1, c2, c3] = [1, 2, 3].map(|n| shape(n, length, bending));
        let determinant = c2 * c2 - c1 * c3;
        let flexibility = self.jump.abs();
        self.loads.iter().map(move |&(motion, away_m)| {
            // beyond the force w has C₃(x − ξ)/EI more
            let [g2, g3] = [2, 3].map(|n| shape(n, length - away_m, bending));
            (motion, flexibility * (c3 * g2 - c2 * g3) / determinant)
        })
    }

    /// w″ as a sum over the joint's DOFs, with their weights.
    fn curvature(&self, omega: f64) -> [(usize, f64); 4] {
        let length = self.length_m;
        let bending = Waves::new(self.inertia, omega).over(length.abs());
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|n| shape(n, length, bending));
        // w and θ at L: C₀ w + C₁ θ + C₂ w″ + C₃ w‴ and κ⁴ C₃ w + C₀ θ + C₁ w″ + C₂ w‴
        let determinant = c2 * c2 - c1 * c3;
        let [y, next_y] = self.translations;
        [
            (y, (bending * c3 * c3 - c0 * c2) / determinant),
            (y + 1, (c0 * c3 - c1 * c2) / determinant),
            (next_y, c2 / determinant),
            (next_y + 1, -c3 / determinant),
        ]
    }
}

/// These, with the points that lie between bolts of which both are on the axis of the points.
pub(crate) fn with_loads_between(
    bends: Vec<Option<Bend>>,
    bolts_m: &[Option<f64>],
    points_m: &[Option<f64>],
    joint: &JointShape,
) -> Vec<Option<Bend>> {
    let place =
        |translation: usize| -> Option<f64> { *bolts_m.get(translation / joint.dofs_of_a_bolt)? };
    let with_loads = |bend: Bend| match bend.translations.map(place) {
        [Some(own), Some(next)] => bend.with_loads(&[own, next], points_m, joint.dofs),
        _ => bend,
    };
    bends.into_iter().map(|bend| bend.map(with_loads)).collect()
}

/// Motions at and beside a bolt whose DOFs are its translation `y` and the rotation after it.
pub(crate) struct Beside {
    y: usize,
    /// w″ as a sum over the motions, with their weights.
    curvature: Vec<(usize, f64)>,
    /// w″ by a unit force at points between the bolts, rad/(N·m).
    by_loads: Vec<(usize, f64)>,
    /// ±1/EI, rad/(N·m²)
    jump: f64,
}

impl Beside {
    /// At an angular frequency, rad/s; without a bend no curvature is known.
    pub(crate) fn new(y: usize, bend: Option<&Bend>, omega: f64) -> Self {
        Self {
            y,
            curvature: bend.map_or_else(Vec::new, |bend| bend.curvature(omega).to_vec()),
            by_loads: bend.map_or_else(Vec::new, |bend| bend.by_loads(omega).collect()),
            jump: bend.map_or(0.0, |bend| bend.jump),
        }
    }

    /// T H, T having the bolt's rotation in the row of its translation, and the curvature in the row of its rotation: these two
    /// rows.
    fn turned(&self, formed: &ComplexMatrix) -> [Vec<Complex64>; 2] {
        let columns = 0..formed.ncols();
        let rotation = columns.clone().map(|other| formed[(self.y + 1, other)]);
        let curvature = columns.map(|other| {
            let weights = self.curvature.iter();
            weights
                .map(|&(dof, weight)| formed[(dof, other)] * weight)
                .sum()
        });
        let mut curvature: Vec<Complex64> = curvature.collect();
        for &(motion, by_load) in &self.by_loads {
            curvature[motion] += by_load;
        }
        [rotation.collect(), curvature]
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
        formed[(theta, theta)] -= self.jump * by_m;
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
        change[(theta, theta)] += self.jump;
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

    /// Of unit EI.
    fn beam(inertia: f64) -> Beam {
        Beam {
            flexibility: 1.0,
            inertia,
        }
    }

    /// A cantilever of unit EI, translations and rotations at both bolts and the translation of a point: w(x) at x ≤ s by a force
    /// at s is (3s − x) x²/6, by a moment x²/2.
    fn cantilever(bolts: [f64; 2], point: f64) -> ComplexMatrix {
        let by_force = |x: f64, s: f64| {
            let (x, s) = (x.min(s), x.max(s));
            (3.0 * s - x) * x * x / 6.0
        };
        let slope_by_force = |x: f64, s: f64| match x < s {
            true => s * x - x * x / 2.0,
            false => s * s / 2.0,
        };
        let places = [bolts[0], bolts[1], point];
        ComplexMatrix::from_fn(5, 5, |i, j| {
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

    /// The point before the bolts, between them and beyond.
    #[test]
    fn what_is_measured_beside_a_bolt_of_a_cantilever_is_carried_to_it() {
        let (bolts, by) = ([0.5, 0.8], 1e-6);
        for point in [0.3, 0.6, 0.72, 0.9] {
            let positions = bolts.map(Some);
            let bends = between_bolts(&positions, beam(0.0), &joint());
            let bends = with_loads_between(bends, &positions, &[Some(point)], &joint());
            for bolt in 0..2 {
                let beside = Beside::new(2 * bolt, bends[bolt].as_ref(), 1.0);
                let mut moved = [bolts; 2];
                moved[0][bolt] += by;
                moved[1][bolt] -= by;
                let [above, below] = moved.map(|bolts| cantilever(bolts, point));
                let slope = (&above - below) / Complex64::from(2.0 * by);
                let exact = cantilever(bolts, point);
                let apart = (&slope - beside.displaced(&exact)).camax();
                assert!(apart < 1e-6, "{point}, {bolt}: {apart}");
                let mut carried = above;
                beside.shift(&mut carried, by);
                assert!((carried - exact).camax() < 1e-10);
            }
        }
    }

    /// A free wave between the bolts, seen from either of them.
    #[test]
    fn the_curvature_of_a_beam_that_vibrates_is_its_own() {
        let kappa: f64 = 4.0;
        let w = |x: f64| (kappa * x).sin() + 0.2 * (-kappa * x).exp();
        let slope = |x: f64| kappa * ((kappa * x).cos() - 0.2 * (-kappa * x).exp());
        let curvature = |x: f64| kappa * kappa * (-(kappa * x).sin() + 0.2 * (-kappa * x).exp());
        let bolts = [0.1, 0.5];
        let motions: Vec<f64> = bolts.iter().flat_map(|&x| [w(x), slope(x)]).collect();
        let bends = between_bolts(&bolts.map(Some), beam(kappa.powi(4) / 9.0), &joint());
        for (bend, x) in bends.iter().flatten().zip(bolts) {
            let found: f64 = bend
                .curvature(3.0)
                .iter()
                .map(|&(dof, weight)| weight * motions[dof])
                .sum();
            assert!((found - curvature(x)).abs() < 1e-10, "{x}: {found}");
        }
    }

    #[test]
    fn a_bolt_alone_has_a_rigid_arm() {
        let alone = between_bolts(&[Some(0.5), None], beam(0.0), &joint());
        assert_eq!(alone, [None, None]);
    }
}
