//! What a load between two nodes does within its own element, beside what it does through them.

use nalgebra::DMatrix;

use super::element::Element;
use super::{Beam, BeamPoint, Motion};

/// Places that are nearer to each other, or to a node, than this part of the element are one.
const SAME: f64 = 1e-6;

/// DOFs of a place: w and θ.
const OF_A_PLACE: usize = 2;

/// How far each point (row) moves, beyond what the nodes' motion says, under a unit load at each point (column): zero unless
/// both are within one element. That is the static compliance of the element with its ends clamped; its inertia shows only near
/// its own resonances, which are thousands of times above the beam's.
pub(super) fn inner_compliance(beam: &Beam, nodes: &[f64], points: &[BeamPoint]) -> DMatrix<f64> {
    let mut compliance = DMatrix::zeros(points.len(), points.len());
    for ends in nodes.windows(2) {
        let l = ends[1] - ends[0];
        let inside: Vec<(usize, f64)> = points
            .iter()
            .map(|point| point.position_m - ends[0])
            .enumerate()
            .filter(|(_, x)| (SAME * l..(1.0 - SAME) * l).contains(x))
            .collect();
        if inside.is_empty() {
            continue;
        }
        let mut places: Vec<f64> = inside.iter().map(|&(_, x)| x).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|later, earlier| *later - *earlier < SAME * l);
        let Some(within) = clamped(beam, l, &places) else {
            continue;
        };
        let dof = |&(point, x): &(usize, f64)| {
            let place = places.partition_point(|place| *place <= x).max(1) - 1;
            let motion = match points[point].motion {
                Motion::Translation => 0,
                Motion::Rotation => 1,
            };
            (point, OF_A_PLACE * place + motion)
        };
        let dofs: Vec<(usize, usize)> = inside.iter().map(dof).collect();
        for &(p, row) in &dofs {
            for &(q, column) in &dofs {
                compliance[(p, q)] = within[(row, column)];
            }
        }
    }
    compliance
}

/// The compliance of a piece of the beam of length `l` (m), clamped at its ends, at these distances from its first one: w and θ of
/// each. `None` where it is singular.
fn clamped(beam: &Beam, l: f64, places: &[f64]) -> Option<DMatrix<f64>> {
    let size = OF_A_PLACE * places.len();
    let mut stiffness = DMatrix::zeros(size + 2 * OF_A_PLACE, size + 2 * OF_A_PLACE);
    let mut from = 0.0;
    for (piece, to) in places.iter().copied().chain([l]).enumerate() {
        let own = Element::new(beam, to - from).stiffness();
        for (i, row) in own.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                stiffness[(OF_A_PLACE * piece + i, OF_A_PLACE * piece + j)] += entry;
            }
        }
        from = to;
    }
    let inner = stiffness.view((OF_A_PLACE, OF_A_PLACE), (size, size));
    inner.into_owned().try_inverse()
}

#[cfg(test)]
mod tests {
    use super::super::{Boundary, Damping, Theory};
    use super::*;

    fn beam(theory: Theory) -> Beam {
        Beam {
            length_m: 0.3,
            width_m: 0.03,
            height_m: 0.006,
            youngs_modulus_pa: 70e9,
            density_kg_per_m3: 2700.0,
            theory,
            boundary: Boundary::FreeFree,
            damping: Damping::LossFactor(0.01),
        }
    }

    fn at(position_m: f64) -> [BeamPoint; 2] {
        [Motion::Translation, Motion::Rotation].map(|motion| BeamPoint { position_m, motion })
    }

    /// Euler–Bernoulli, clamped at both ends, loaded at a: w = F a³b³/(3EI l³), θ = M a b (a² − ab + b²)/(EI l³).
    #[test]
    fn a_clamped_element_yields_as_textbooks_say() {
        let beam = beam(Theory::EulerBernoulli);
        let bending = 70e9 * 0.03 * 0.006_f64.powi(3) / 12.0;
        let (a, b) = (0.002, 0.003);
        let l = a + b;
        let found = inner_compliance(&beam, &[0.0, 0.1, 0.1 + l, 0.3], &at(0.1 + a));
        let translation = (a * b / l).powi(3) / (3.0 * bending);
        let rotation = a * b * (a * a - a * b + b * b) / (bending * l.powi(3));
        assert!((found[(0, 0)] / translation - 1.0).abs() < 1e-9, "{found}");
        assert!((found[(1, 1)] / rotation - 1.0).abs() < 1e-9, "{found}");
        assert!((found[(0, 1)] - found[(1, 0)]).abs() < 1e-9 * (translation * rotation).sqrt());
    }

    /// Points between the nodes of one mesh, and the same points as nodes of another: as near as the meshes are, where rotations would
    /// be off by 1e-2 without what this adds.
    #[test]
    fn points_beside_nodes_move_as_if_they_were_nodes() {
        for theory in [Theory::EulerBernoulli, Theory::default()] {
            let beam = beam(theory);
            // the second place is in the same element as the first one
            let points: Vec<BeamPoint> =
                [0.1021, 0.1037, 0.2993].into_iter().flat_map(at).collect();
            let hz: Vec<f64> = (1..20).map(|line| 61.0 * f64::from(line)).collect();
            let beside = beam.modal(&[]).unwrap().receptances(&points, &hz).unwrap();
            let nodes = beam.receptances(&points, &hz).unwrap();
            // over all lines, as antiresonances make small what a size is
            let size = |p: usize| {
                nodes.iter().map(|own| own[(p, p)].norm()).sum::<f64>() / hz.len() as f64
            };
            for (beside, nodes) in beside.iter().zip(&nodes) {
                for p in 0..points.len() {
                    for q in 0..points.len() {
                        let off =
                            (beside[(p, q)] - nodes[(p, q)]).norm() / (size(p) * size(q)).sqrt();
                        assert!(off < 2e-4, "{off:.1e} at {p}, {q}");
                    }
                }
            }
        }
    }
}
