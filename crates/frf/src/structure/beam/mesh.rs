//! The beam's finite elements: nodes, matrices, supports, and the motion between nodes.

use nalgebra::DMatrix;

use crate::structure::spatial::{Modes, SpatialModel};

use super::element::Element;
use super::{Beam, BeamPoint, Boundary};
use crate::structure::StructureError;

/// Elements over the length of a beam. Without shear and rotary inertia a frequency with root λ = βL is then too high by
/// (λ/60)⁴/1440 of itself: 8·10⁻⁷ for the third bending mode of a free beam, 6·10⁻⁵ for the tenth.
pub(super) const ELEMENTS: f64 = 60.0;

/// Points closer to a node than this part of the length get no node of their own: an element so short (l⁻⁴ in the
/// eigenvalues) would drown the low modes in rounding: of 1e-4 the frequencies err by 80 %, of 1e-3 by 3e-5. Within it the motion is
/// the element's own.
const SHORTEST_ELEMENT: f64 = 1e-3;

impl Beam {
    /// Node positions: both ends, every point that is not too close to another, and equal elements between them, of which
    /// `elements` would fill the length.
    pub(super) fn mesh(
        &self,
        points: &[BeamPoint],
        elements: f64,
    ) -> Result<Vec<f64>, StructureError> {
        self.check()?;
        let mut marks = vec![0.0, self.length_m];
        for point in points {
            self.check_is_on(point)?;
            marks.push(point.position_m.clamp(0.0, self.length_m));
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

    pub(super) fn check_is_on(&self, point: &BeamPoint) -> Result<(), StructureError> {
        let rounding = 1e-9 * self.length_m;
        let position_m = point.position_m;
        if position_m >= -rounding && position_m <= self.length_m + rounding {
            return Ok(());
        }
        Err(StructureError::OffTheBeam {
            position_m,
            length_m: self.length_m,
        })
    }

    pub(super) fn modes_on(&self, nodes: &[f64]) -> Result<Modes, StructureError> {
        let size = 2 * nodes.len();
        let mut mass = DMatrix::zeros(size, size);
        let mut stiffness = DMatrix::zeros(size, size);
        for (element, ends) in nodes.windows(2).enumerate() {
            let of_element = Element::new(self, ends[1] - ends[0]);
            let element_mass = of_element.mass();
            let element_stiffness = of_element.stiffness();
            for i in 0..4 {
                for j in 0..4 {
                    let place = (2 * element + i, 2 * element + j);
                    mass[place] += element_mass[i][j];
                    stiffness[place] += element_stiffness[i][j];
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

    /// Degrees of freedom (2 a node: w, θ) that the supports leave free.
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

/// The element's DOFs (2 a node: w, θ) and their weights in the motion of a point: a node's own, or those of the element's
/// static shape.
pub(super) fn interpolation(beam: &Beam, nodes: &[f64], point: &BeamPoint) -> [(usize, f64); 4] {
    let after = nodes.partition_point(|&node| node <= point.position_m);
    let right = after.clamp(1, nodes.len() - 1);
    let l = nodes[right] - nodes[right - 1];
    let x = ((point.position_m - nodes[right - 1]) / l).clamp(0.0, 1.0);
    let weights = Element::new(beam, l).shape(point.motion, x);
    std::array::from_fn(|i| (2 * (right - 1) + i, weights[i]))
}
