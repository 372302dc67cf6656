//! A beam of the study as a structure that is computed anew where its material or the places on it are not known exactly.

use std::collections::BTreeMap;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Beam, BeamPoint, ComplexMatrix, Damping, ModalBeam, Motion};
use bolted_joint_systematic::{Change, Computation, Compute};

use super::super::study::Substructure;
use super::substructure::{beam_dofs, signed};

/// Part of the length below which a joint that has moved gets no node beside another one: an element so short leaves rounding in the
/// low modes.
const CLOSE: f64 = 1e-2;

/// A beam with its joint and points as the study has them.
pub(in super::super) struct BeamAnew<'a> {
    beam: &'a Beam,
    joints_m: &'a [f64],
    positions_m: &'a BTreeMap<Dof, f64>,
    dofs_of_a_bolt: usize,
    points: &'a [Dof],
    frequency_hz: &'a [f64],
}

impl<'a> BeamAnew<'a> {
    /// `None` where the substructure is no beam.
    pub(in super::super) fn new(
        substructure: &'a Substructure,
        dofs_of_a_bolt: usize,
        points: &'a [Dof],
        frequency_hz: &'a [f64],
    ) -> Option<Self> {
        match substructure {
            Substructure::Beam {
                beam,
                joints_m,
                positions_m,
                ..
            } => Some(Self {
                beam,
                joints_m,
                positions_m,
                dofs_of_a_bolt,
                points,
                frequency_hz,
            }),
            Substructure::Measured { .. } | Substructure::Ground { .. } => None,
        }
    }

    /// Young's modulus (Pa) and density (kg/m³).
    fn material(&self, change: &Change) -> [f64; 2] {
        [
            self.beam.youngs_modulus_pa * (1.0 + change.youngs_modulus),
            self.beam.density_kg_per_m3 * (1.0 + change.density),
        ]
    }

    fn damping(&self, change: &Change) -> Damping {
        self.beam.damping.times(1.0 + change.damping)
    }

    /// The joint's DOFs and the points where the change puts them.
    fn dofs(&self, change: &Change) -> Option<Vec<(BeamPoint, f64)>> {
        let by = change.joint_m.iter().copied().chain(std::iter::repeat(0.0));
        let moved = self.joints_m.iter().zip(by);
        let joints_m: Vec<f64> = moved.map(|(position_m, by)| position_m + by).collect();
        let mut positions_m = self.positions_m.clone();
        for (point, by) in self.points.iter().zip(&change.points_m) {
            *positions_m.get_mut(point)? += by;
        }
        Some(beam_dofs(
            self.dofs_of_a_bolt,
            &joints_m,
            self.points,
            &positions_m,
        ))
    }

    fn on_the_beam(&self, point: BeamPoint) -> BeamPoint {
        BeamPoint {
            position_m: point.position_m.clamp(0.0, self.beam.length_m),
            ..point
        }
    }

    /// Nodes for these DOFs: the joints where they have moved to, since a moment beside a node lacks the deflection of its own
    /// element, and the points where the study has them. A joint that comes close to another node stays where the study has it.
    fn nodes(&self, dofs: &[(BeamPoint, f64)]) -> Option<Vec<BeamPoint>> {
        let stated = self.dofs(&Change::default())?;
        let of_joints = self.dofs_of_a_bolt * self.joints_m.len();
        let ends = [0.0, self.beam.length_m];
        let others = stated.iter().skip(of_joints);
        let others: Vec<f64> = others
            .map(|(point, _)| point.position_m)
            .chain(ends)
            .collect();
        let pairs = dofs.iter().zip(&stated).enumerate();
        let node = |(number, (&(moved, _), &(stated, _))): (usize, (&(BeamPoint, f64), _))| {
            let is_close =
                |other: &f64| (other - moved.position_m).abs() < CLOSE * self.beam.length_m;
            match number < of_joints && !others.iter().any(is_close) {
                true => self.on_the_beam(moved),
                false => stated,
            }
        };
        Some(pairs.map(node).collect())
    }

    /// Beyond an end, where an error of a place can put a sensor that is at the end, the beam goes on straight: at a free end nothing
    /// bends it, so that the first two derivatives by the place have no jump there.
    fn receptances(
        &self,
        modal: &ModalBeam,
        dofs: &[(BeamPoint, f64)],
    ) -> Option<Vec<ComplexMatrix>> {
        let mut points: Vec<BeamPoint> = Vec::with_capacity(dofs.len());
        let mut arms_m: Vec<(usize, f64)> = Vec::new();
        for (number, &(point, _)) in dofs.iter().enumerate() {
            let on = self.on_the_beam(point);
            let arm_m = point.position_m - on.position_m;
            if arm_m != 0.0 && point.motion == Motion::Translation {
                arms_m.push((number, arm_m));
            }
            points.push(on);
        }
        let rotations = arms_m.iter().map(|&(number, _)| BeamPoint {
            motion: Motion::Rotation,
            ..points[number]
        });
        let rotations: Vec<BeamPoint> = rotations.collect();
        points.extend(rotations);
        let mut receptances = modal.receptances(&points, self.frequency_hz).ok()?;
        if !arms_m.is_empty() {
            // w(L + d) = w(L) + d θ(L)
            let mut arm = ComplexMatrix::identity(dofs.len(), points.len());
            for (extra, &(number, arm_m)) in arms_m.iter().enumerate() {
                arm[(number, dofs.len() + extra)] = arm_m.into();
            }
            let transposed = arm.transpose();
            for receptance in &mut receptances {
                *receptance = &arm * &*receptance * &transposed;
            }
        }
        Some(signed(receptances, dofs))
    }
}

impl Compute for BeamAnew<'_> {
    fn changed(&self, change: &Change) -> Option<Box<dyn Computation + '_>> {
        let [youngs_modulus_pa, density_kg_per_m3] = self.material(change);
        let beam = Beam {
            youngs_modulus_pa,
            density_kg_per_m3,
            damping: self.damping(change),
            ..self.beam.clone()
        };
        let dofs = self.dofs(change)?;
        let nodes = self.nodes(&dofs)?;
        Some(Box::new(ChangedBeam {
            of: self,
            modal: beam.modal(&nodes).ok()?,
            dofs,
        }))
    }
}

/// The beam with one change, and the modes that have its points as nodes.
struct ChangedBeam<'a> {
    of: &'a BeamAnew<'a>,
    modal: ModalBeam,
    dofs: Vec<(BeamPoint, f64)>,
}

impl Computation for ChangedBeam<'_> {
    fn receptances(&self) -> Option<Vec<ComplexMatrix>> {
        self.of.receptances(&self.modal, &self.dofs)
    }

    /// On the same mesh: what a point beside a node lacks is the same on both sides of it.
    fn nearby(&self, change: &Change) -> Option<Vec<ComplexMatrix>> {
        let [youngs_modulus_pa, density_kg_per_m3] = self.of.material(change);
        let modal = self.modal.of_material(youngs_modulus_pa, density_kg_per_m3);
        let modal = modal.with_damping(self.of.damping(change));
        self.of.receptances(&modal, &self.of.dofs(change)?)
    }
}
