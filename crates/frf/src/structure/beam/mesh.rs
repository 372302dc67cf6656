//! The beam's finite elements: nodes, matrices, supports, and the motion between nodes.

use nalgebra::DMatrix;

use crate::structure::spatial::{Modes, SpatialModel};

use super::{Beam, BeamPoint, Boundary, Motion};
use crate::structure::StructureError;

/// Elements over the length of a beam. A frequency with root λ = βL is then too high by (λ/60)⁴/1440 of itself:
/// 8·10⁻⁷ for the third bending mode of a free beam, 6·10⁻⁵ for the tenth.
pub(super) const ELEMENTS: f64 = 60.0;

/// Points closer to a node than this part of the length get no node of their own: an element so short (l⁻⁴ in the
/// eigenvalues) would drown the low modes in rounding. Within it the deflection is the element's own cubic.
const SHORTEST_ELEMENT: f64 = 1e-4;
impl Beam {
    /// Node positions: both ends, every point that is not too close to another, and equal elements between them, of which
    /// `elements` would fill the length.
    pub(super) fn mesh(
        &self,
        points: &[BeamPoint],
        elements: f64,
    ) -> Result<Vec<f64>, StructureError> {
        self.check()?;
        let rounding = 1e-9 * self.length_m;
        let mut marks = vec![0.0, self.length_m];
        for point in points {
            let position_m = point.position_m;
            if !(position_m >= -rounding && position_m <= self.length_m + rounding) {
                return Err(StructureError::OffTheBeam {
                    position_m,
                    length_m: self.length_m,
                });
            }
            marks.push(position_m.clamp(0.0, self.length_m));
        }
        marks.sort_by(f64::total_cmp);
        let shortest = SHORTEST_ELEMENT * self.length_m;
        marks.dedup_by(|later, earlier| *later - *earlier < shortest);
        // The end stays a node, rather than a point just before it.
        if let [.., last] = marks.as_mut_slice() {
            *last = self.length_m;
        }
        let mut nodes = vec![0.0];
        for pair in marks.windows(2) {
            let span = pair[1] - pair[0];
            let count = (elements * span / self.length_m - 1e-9).ceil().max(1.0);
            for step in 1..=count as usize {
                nodes.push(pair[0] + span * step as f64 / count);
            }
        }
        Ok(nodes)
    }

    pub(super) fn modes_on(&self, nodes: &[f64]) -> Result<Modes, StructureError> {
        let size = 2 * nodes.len();
        let mut mass = DMatrix::zeros(size, size);
        let mut stiffness = DMatrix::zeros(size, size);
        let mass_per_length = self.density_kg_per_m3 * self.width_m * self.height_m;
        let bending = self.youngs_modulus_pa * self.width_m * self.height_m.powi(3) / 12.0;
        for (element, ends) in nodes.windows(2).enumerate() {
            let l = ends[1] - ends[0];
            // [m_e] = (m l/420) [156 22l 54 −13l; …]   (Tol 4.3, Kavi 4.11)
            let m = mass_per_length * l / 420.0;
            let element_mass = [
                [156.0, 22.0 * l, 54.0, -13.0 * l],
                [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
                [54.0, 13.0 * l, 156.0, -22.0 * l],
                [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
            ];
            // [k_e] = (EI/l³) [12 6l −12 6l; …]   (Tol 4.4, Kavi 4.10)
            let k = bending / l.powi(3);
            let element_stiffness = [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
            ];
            for i in 0..4 {
                for j in 0..4 {
                    let place = (2 * element + i, 2 * element + j);
                    mass[place] += m * element_mass[i][j];
                    stiffness[place] += k * element_stiffness[i][j];
                }
            }
        }
        let free = self.free_dofs(nodes.len());
        let mass = mass.select_rows(&free).select_columns(&free);
        let stiffness = stiffness.select_rows(&free).select_columns(&free);
        let damping = DMatrix::zeros(free.len(), free.len());
        let modes = SpatialModel::new(mass, damping, stiffness).and_then(|model| model.modes());
        modes.map_err(|error| StructureError::NoModes(Box::new(error)))
    }

    /// Degrees of freedom (2 a node: w, ∂w/∂x) that the supports leave free.
    pub(super) fn free_dofs(&self, node_count: usize) -> Vec<usize> {
        let last = 2 * (node_count - 1);
        let held: &[usize] = match self.boundary {
            Boundary::FreeFree => &[],
            Boundary::FixedFree => &[0, 1],
            Boundary::FreeFixed => &[last, last + 1],
            Boundary::FixedFixed => &[0, 1, last, last + 1],
            Boundary::PinnedPinned => &[0, last],
            Boundary::FixedPinned => &[0, 1, last],
        };
        (0..2 * node_count)
            .filter(|dof| !held.contains(dof))
            .collect()
    }

    pub(super) fn rigid_body_modes(&self) -> usize {
        match self.boundary {
            Boundary::FreeFree => 2,
            _ => 0,
        }
    }
}

/// The element's DOFs (2 a node: w, ∂w/∂x) and their weights in the motion of a point: a node's own, or cubic Hermite.
pub(super) fn interpolation(nodes: &[f64], point: &BeamPoint) -> [(usize, f64); 4] {
    let after = nodes.partition_point(|&node| node <= point.position_m);
    let right = after.clamp(1, nodes.len() - 1);
    let l = nodes[right] - nodes[right - 1];
    let x = ((point.position_m - nodes[right - 1]) / l).clamp(0.0, 1.0);
    let weights = match point.motion {
        // w = (1 − 3x² + 2x³) w₁ + l(x − 2x² + x³) θ₁ + (3x² − 2x³) w₂ + l(x³ − x²) θ₂
        Motion::Translation => [
            1.0 - 3.0 * x * x + 2.0 * x.powi(3),
            l * (x - 2.0 * x * x + x.powi(3)),
            3.0 * x * x - 2.0 * x.powi(3),
            l * (x.powi(3) - x * x),
        ],
        // its derivative by the position
        Motion::Rotation => [
            (6.0 * x * x - 6.0 * x) / l,
            1.0 - 4.0 * x + 3.0 * x * x,
            (6.0 * x - 6.0 * x * x) / l,
            3.0 * x * x - 2.0 * x,
        ],
    };
    std::array::from_fn(|i| (2 * (right - 1) + i, weights[i]))
}
