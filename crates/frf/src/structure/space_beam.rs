//! Beams in space as substructures: they bend in two planes, turn about their axis and grow longer.
//!
//! A line of points, each joined to the next by a straight uniform beam, so that a frame with corners is one too. Bending is that
//! of the beam in a plane ([`super::beam`]); torsion is that of Saint-Venant, without warping.

use std::f64::consts::PI;

use nalgebra::{DMatrix, Matrix3, Vector3};

use super::beam::{Beam, Boundary, Damping, Element, Theory};
use super::{ModalModel, Mode, SpatialModel, StructureError};
use crate::{Direction, Dof, Sign};

/// Motions of a node.
const MOTIONS: usize = 6;

/// Elements over the length of all beams, and of each at least.
const ELEMENTS: f64 = 40.0;
const LEAST: f64 = 4.0;

/// A point with six motions.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacePoint {
    /// Its number in the names of degrees of freedom.
    pub node: u32,
    /// m.
    pub position_m: [f64; 3],
}

/// Beams of one rectangular cross-section through a line of points.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceBeam {
    /// From the first end to the last one.
    pub points: Vec<SpacePoint>,
    /// Width of the cross-section, m.
    pub width_m: f64,
    /// Height of the cross-section, m.
    pub height_m: f64,
    /// Direction of the height; what of it is along a beam does not count.
    pub height_along: [f64; 3],
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
    /// ν, from which the shear modulus follows: G = E/(2(1 + ν)).
    pub poissons_ratio: f64,
    /// Whether shear and rotary inertia count in bending.
    pub has_shear: bool,
    /// Nodes that are held in all motions.
    pub held: Vec<u32>,
    /// ζ of the elastic modes in ascending order; the last one holds for all higher ones.
    pub damping_ratio: Vec<f64>,
}

impl SpaceBeam {
    /// All modes of its finite elements, at all motions of its points. Held nodes have none.
    ///
    /// # Errors
    /// [`StructureError`] if the beam is not physical.
    pub fn modal(&self) -> Result<ModalModel, StructureError> {
        self.check()?;
        let (nodes, places) = self.mesh();
        let size = MOTIONS * nodes.len();
        let [mut mass, mut stiffness] = [(); 2].map(|()| DMatrix::zeros(size, size));
        for (element, ends) in nodes.windows(2).enumerate() {
            let [own_stiffness, own_mass] = self.element(&ends[0], &ends[1])?;
            let at = (MOTIONS * element, MOTIONS * element);
            let count = (2 * MOTIONS, 2 * MOTIONS);
            let mut block = stiffness.view_mut(at, count);
            block += own_stiffness;
            let mut block = mass.view_mut(at, count);
            block += own_mass;
        }
        let is_held = |dof: usize| {
            let points = self.points.iter().zip(&places);
            let mut held = points.filter(|(point, _)| self.held.contains(&point.node));
            held.any(|(_, place)| dof / MOTIONS == *place)
        };
        let free: Vec<usize> = (0..size).filter(|&dof| !is_held(dof)).collect();
        let [mass, stiffness] =
            [mass, stiffness].map(|all| all.select_rows(&free).select_columns(&free));
        let damping = DMatrix::zeros(free.len(), free.len());
        let modes = SpatialModel::new(mass, damping, stiffness).and_then(|model| model.modes());
        let modes = modes.map_err(|error| StructureError::NoModes(Box::new(error)))?;
        let rigid = if self.held.is_empty() { MOTIONS } else { 0 };
        let mut points = Vec::new();
        let mut rows = Vec::new();
        for (point, place) in self.points.iter().zip(&places) {
            for (motion, direction) in DIRECTIONS.into_iter().enumerate() {
                points.push(Dof::new(point.node, direction, Sign::Plus));
                let dof = MOTIONS * place + motion;
                rows.push(free.iter().position(|&own| own == dof));
            }
        }
        let all = modes.frequency_hz().into_iter().enumerate();
        let modes = all.map(|(n, frequency_hz)| {
            let shape = rows.iter().map(|row| {
                let value = row.map_or(0.0, |row| modes.shapes[(row, n)]);
                [value, 0.0]
            });
            let ratio = n.checked_sub(rigid).and_then(|elastic| {
                let own = self.damping_ratio.get(elastic);
                own.or(self.damping_ratio.last()).copied()
            });
            Mode {
                frequency_hz: if n < rigid { 0.0 } else { frequency_hz },
                damping_ratio: ratio.unwrap_or(0.0),
                shape: shape.collect(),
            }
        });
        Ok(ModalModel::computed(points, modes.collect()))
    }

    /// Nodes along the line, and the places of the points among them.
    fn mesh(&self) -> (Vec<Vector3<f64>>, Vec<usize>) {
        let points: Vec<Vector3<f64>> = (self.points.iter())
            .map(|point| Vector3::from(point.position_m))
            .collect();
        let total: f64 = points
            .windows(2)
            .map(|ends| (ends[1] - ends[0]).norm())
            .sum();
        let mut nodes = vec![points[0]];
        let mut places = vec![0];
        for ends in points.windows(2) {
            let along = ends[1] - ends[0];
            let count = (ELEMENTS * along.norm() / total).ceil().max(LEAST);
            for n in 1..=count as usize {
                nodes.push(ends[0] + along * (n as f64 / count));
            }
            places.push(nodes.len() - 1);
        }
        (nodes, places)
    }

    /// K and M of a beam between two nodes, 12 × 12, in the axes of space.
    fn element(
        &self,
        start: &Vector3<f64>,
        end: &Vector3<f64>,
    ) -> Result<[DMatrix<f64>; 2], StructureError> {
        let axes = self.axes(&(end - start))?;
        let length_m = (end - start).norm();
        let (e, rho) = (self.youngs_modulus_pa, self.density_kg_per_m3);
        let (width, height) = (self.width_m, self.height_m);
        let area = width * height;
        // about y the height bends, about z the width
        let polar = area * (width * width + height * height) / 12.0;
        let shear_modulus = e / (2.0 * (1.0 + self.poissons_ratio));
        let mut own = [(); 2].map(|()| DMatrix::zeros(2 * MOTIONS, 2 * MOTIONS));
        for (dof, k, m) in [
            (0, e * area, rho * area),
            (
                3,
                shear_modulus * torsion_constant(width, height),
                rho * polar,
            ),
        ] {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let place = (dof + MOTIONS * i, dof + MOTIONS * j);
                let is_same = i == j;
                own[0][place] += k / length_m * if is_same { 1.0 } else { -1.0 };
                own[1][place] += m * length_m / if is_same { 3.0 } else { 6.0 };
            }
        }
        // y with rz = ∂y/∂x; z with ry = −∂z/∂x
        for (dofs, [across, along], sign) in [
            ([1, 5, 7, 11], [height, width], 1.0),
            ([2, 4, 8, 10], [width, height], -1.0),
        ] {
            let planar = Element::new(&self.planar(across, along), length_m);
            let signs = [1.0, sign, 1.0, sign];
            for (own, block) in own.iter_mut().zip([planar.stiffness(), planar.mass()]) {
                for i in 0..4 {
                    for j in 0..4 {
                        own[(dofs[i], dofs[j])] += block[i][j] * signs[i] * signs[j];
                    }
                }
            }
        }
        let turned = DMatrix::from_fn(2 * MOTIONS, 2 * MOTIONS, |i, j| match i / 3 == j / 3 {
            true => axes[(i % 3, j % 3)],
            false => 0.0,
        });
        Ok(own.map(|own| turned.transpose() * own * &turned))
    }

    /// x along the beam, z along its height: rows.
    fn axes(&self, along: &Vector3<f64>) -> Result<Matrix3<f64>, StructureError> {
        let x = along.normalize();
        let height = Vector3::from(self.height_along);
        let across = height.cross(&x);
        if across.norm() <= 1e-6 * height.norm() || !across.norm().is_finite() {
            return Err(StructureError::Beam {
                key: "height_along",
                found: format!("{:?}", self.height_along),
                expected: "a direction across every beam, such as [0, 0, 1] for beams in the plane of x and y",
            });
        }
        let y = across.normalize();
        let z = x.cross(&y);
        Ok(Matrix3::from_rows(&[
            x.transpose(),
            y.transpose(),
            z.transpose(),
        ]))
    }

    /// A beam that bends about its width.
    fn planar(&self, width_m: f64, height_m: f64) -> Beam {
        Beam {
            length_m: 1.0,
            width_m,
            height_m,
            youngs_modulus_pa: self.youngs_modulus_pa,
            density_kg_per_m3: self.density_kg_per_m3,
            theory: match self.has_shear {
                true => Theory::Timoshenko {
                    poissons_ratio: self.poissons_ratio,
                },
                false => Theory::EulerBernoulli,
            },
            boundary: Boundary::FreeFree,
            damping: Damping::Ratios(self.damping_ratio.clone()),
        }
    }

    fn check(&self) -> Result<(), StructureError> {
        let refuse = |key, found: String, expected| {
            Err(StructureError::Beam {
                key,
                found,
                expected,
            })
        };
        for (key, found) in [
            ("width", self.width_m),
            ("height", self.height_m),
            ("youngs_modulus", self.youngs_modulus_pa),
            ("density", self.density_kg_per_m3),
        ] {
            if !(found.is_finite() && found > 0.0) {
                return refuse(key, found.to_string(), "a positive number in SI units");
            }
        }
        if !(0.0..0.5).contains(&self.poissons_ratio) {
            let found = self.poissons_ratio.to_string();
            return refuse("poissons_ratio", found, "a number from 0 and below 0.5");
        }
        let is_ratio = |own: &f64| own.is_finite() && (0.0..1.0).contains(own);
        if self.damping_ratio.is_empty() || !self.damping_ratio.iter().all(is_ratio) {
            let found = format!("{:?}", self.damping_ratio);
            let expected =
                "a ratio from 0 to below 1 (not per cent) for each elastic mode, one at least";
            return refuse("damping_ratio", found, expected);
        }
        if self.points.len() < 2 {
            let found = format!("{} points", self.points.len());
            return refuse("points", found, "two at least: the ends");
        }
        for ends in self.points.windows(2) {
            let [start, end] = [&ends[0], &ends[1]].map(|point| Vector3::from(point.position_m));
            let apart = (end - start).norm();
            if !(apart.is_finite() && apart > 0.0) {
                let found = format!("node {} where node {} is", ends[1].node, ends[0].node);
                return refuse(
                    "points",
                    found,
                    "positions in m, each apart from the one before",
                );
            }
        }
        for (n, point) in self.points.iter().enumerate() {
            if self.points[..n]
                .iter()
                .any(|other| other.node == point.node)
            {
                let found = format!("node {} twice", point.node);
                return refuse("points", found, "another number for each node");
            }
        }
        for node in &self.held {
            if !self.points.iter().any(|point| point.node == *node) {
                return refuse("held", format!("node {node}"), "nodes among points");
            }
        }
        Ok(())
    }
}

const DIRECTIONS: [Direction; MOTIONS] = [
    Direction::X,
    Direction::Y,
    Direction::Z,
    Direction::RX,
    Direction::RY,
    Direction::RZ,
];

/// J of a rectangle: a b³/3 (1 − 192 b/(π⁵ a) Σ tanh(nπa/2b)/n⁵) over odd n, a ≥ b (Timoshenko and Goodier 1951, art. 109).
fn torsion_constant(width_m: f64, height_m: f64) -> f64 {
    let (a, b) = (width_m.max(height_m), width_m.min(height_m));
    let term = |n: i32| {
        let n = f64::from(n);
        (n * PI * a / (2.0 * b)).tanh() / n.powi(5)
    };
    let sum: f64 = (1..40).step_by(2).map(term).sum();
    a * b.powi(3) / 3.0 * (1.0 - 192.0 * b / (PI.powi(5) * a) * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(points: &[(u32, [f64; 3])], held: &[u32]) -> SpaceBeam {
        SpaceBeam {
            points: (points.iter())
                .map(|&(node, position_m)| SpacePoint { node, position_m })
                .collect(),
            width_m: 0.03,
            height_m: 0.02,
            height_along: [0.0, 0.0, 1.0],
            youngs_modulus_pa: 2.1e11,
            density_kg_per_m3: 7850.0,
            poissons_ratio: 0.3,
            has_shear: true,
            held: held.to_vec(),
            damping_ratio: vec![1e-3],
        }
    }

    fn receptance(beam: &SpaceBeam, pair: [(u32, Direction); 2], frequency_hz: f64) -> f64 {
        let [response, reference] = pair.map(|(node, own)| Dof::new(node, own, Sign::Plus));
        let model = beam.modal().unwrap();
        model
            .receptance(response, reference, &[frequency_hz])
            .unwrap()[0]
            .re
    }

    /// A cantilever at rest: L/EA, L/GJ, L³/3EI + 1.2 L/GA in both planes and L²/2EI between, with the signs of space.
    #[test]
    fn a_cantilever_yields_as_the_formulas_say() {
        let beam = straight(&[(1, [0.0; 3]), (2, [0.4, 0.0, 0.0])], &[1]);
        let (e, l, w, h) = (2.1e11_f64, 0.4_f64, 0.03_f64, 0.02_f64);
        let g = e / 2.6;
        let [i_z, i_y] = [h * w.powi(3) / 12.0, w * h.powi(3) / 12.0];
        // J = 0.196 a b³ at a/b = 1.5 (Timoshenko and Goodier's table)
        let j = torsion_constant(w, h);
        assert!((j / (w * h.powi(3)) - 0.196).abs() < 5e-4);
        let shear = 1.2 * l / (g * w * h);
        use Direction::{RX, RY, RZ, X, Y, Z};
        for (pair, expected) in [
            ([X, X], l / (e * w * h)),
            ([RX, RX], l / (g * j)),
            ([Y, Y], l.powi(3) / (3.0 * e * i_z) + shear),
            ([Z, Z], l.powi(3) / (3.0 * e * i_y) + shear),
            ([Y, RZ], l * l / (2.0 * e * i_z)),
            ([Z, RY], -l * l / (2.0 * e * i_y)),
            ([RY, RY], l / (e * i_y)),
            ([Y, Z], 0.0),
        ] {
            let found = receptance(&beam, pair.map(|own| (2, own)), 1e-3);
            assert!(
                (found - expected).abs() < 1e-6 * expected.abs().max(1e-7),
                "{pair:?}: {found} {expected}"
            );
        }
    }

    /// Of the same beam in the plane, in both planes.
    #[test]
    fn bending_is_that_of_the_beam_in_the_plane() {
        let space = straight(&[(1, [0.0; 3]), (2, [0.3, 0.0, 0.0])], &[]);
        for (direction, width_m, height_m) in
            [(Direction::Y, 0.02, 0.03), (Direction::Z, 0.03, 0.02)]
        {
            let planar = Beam {
                length_m: 0.3,
                ..space.planar(width_m, height_m)
            };
            let tip = super::super::BeamPoint {
                position_m: 0.3,
                motion: super::super::Motion::Translation,
            };
            for frequency_hz in [150.0, 700.0] {
                let expected = planar.receptances(&[tip], &[frequency_hz]).unwrap()[0][(0, 0)].re;
                let found = receptance(&space, [(2, direction); 2], frequency_hz);
                assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
            }
        }
    }

    /// Torsion and extension of a free bar: f = n c/2L with c = √(GJ/ρI_p) and √(E/ρ).
    #[test]
    fn torsion_and_extension_have_their_frequencies() {
        let beam = straight(&[(1, [0.0; 3]), (2, [0.0, 0.5, 0.0])], &[]);
        let found: Vec<f64> = beam
            .modal()
            .unwrap()
            .modes()
            .iter()
            .map(|mode| mode.frequency_hz)
            .collect();
        assert!(found[..6].iter().all(|&own| own == 0.0) && found[6] > 1.0);
        let polar = 0.03 * 0.02 * (0.03_f64.powi(2) + 0.02_f64.powi(2)) / 12.0;
        let torsion = (2.1e11 / 2.6 * torsion_constant(0.03, 0.02) / (7850.0 * polar)).sqrt();
        for speed in [torsion, (2.1e11_f64 / 7850.0).sqrt()] {
            let expected = speed / (2.0 * 0.5);
            let nearest = found
                .iter()
                .map(|own| (own / expected - 1.0).abs())
                .fold(1.0, f64::min);
            assert!(nearest < 5e-4, "{expected}: {nearest}");
        }
    }

    /// An angle: its far end moves as a rigid lever on the first beam says, and by its own bending.
    #[test]
    fn a_corner_turns_torsion_into_motion() {
        let points = [(1, [0.0; 3]), (2, [0.4, 0.0, 0.0]), (3, [0.4, 0.2, 0.0])];
        let beam = straight(&points, &[1]);
        let (e, g) = (2.1e11_f64, 2.1e11 / 2.6);
        let (i_y, j) = (0.03 * 0.02_f64.powi(3) / 12.0, torsion_constant(0.03, 0.02));
        let area = 0.03 * 0.02;
        let expected = 0.4_f64.powi(3) / (3.0 * e * i_y)
            + 0.2_f64.powi(3) / (3.0 * e * i_y)
            + 0.2 * 0.2 * 0.4 / (g * j)
            + 1.2 * 0.6 / (g * area);
        let found = receptance(&beam, [(3, Direction::Z); 2], 1e-3);
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }

    #[test]
    fn what_is_no_beam_is_refused() {
        let good = straight(&[(1, [0.0; 3]), (2, [0.4, 0.0, 0.0])], &[]);
        let held = SpaceBeam {
            held: vec![7],
            ..good.clone()
        };
        let along = SpaceBeam {
            height_along: [1.0, 0.0, 0.0],
            ..good.clone()
        };
        let mut twice = good.clone();
        twice.points[1].position_m = [0.0; 3];
        for (bad, key) in [(held, "held"), (along, "height_along"), (twice, "points")] {
            let refused = bad.modal().unwrap_err().to_string();
            assert!(
                refused.starts_with(&format!("beam.{key}: found ")),
                "{refused}"
            );
        }
    }
}
