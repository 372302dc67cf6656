//! A beam of the study as a structure that is computed anew where its material or the places on it are not known exactly.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Beam, BeamPoint, ComplexMatrix, Damping, ModalBeam, Motion};
use bolted_joint_systematic::{Change, Compute};

use super::super::study::Substructure;
use super::substructure::{beam_dofs, signed};

/// A beam with its joint and points as the study has them.
pub(in super::super) struct BeamAnew<'a> {
    beam: &'a Beam,
    joints_m: &'a [f64],
    positions_m: &'a BTreeMap<Dof, f64>,
    dofs_of_a_bolt: usize,
    points: &'a [Dof],
    frequency_hz: &'a [f64],
    stated: OnceLock<Option<ModalBeam>>,
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
                stated: OnceLock::new(),
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

    /// Modes with the study's own places as nodes, of the study's own material; `None` where it has none. Every change is one of
    /// what they are scaled by, or of the places that are looked at.
    fn stated(&self) -> Option<&ModalBeam> {
        let modal = self.stated.get_or_init(|| {
            let dofs = self.dofs(&Change::default())?;
            let nodes: Vec<BeamPoint> = dofs.into_iter().map(|(point, _)| point).collect();
            self.beam.modal(&nodes).ok()
        });
        modal.as_ref()
    }

    /// Beyond an end, where an error of a place can put a sensor that is at the end, the beam goes on straight: at a free end nothing
    /// bends it, so that the first two derivatives by the place have no jump there.
    fn between(&self, modal: &ModalBeam, dofs: &[(BeamPoint, f64)]) -> Option<Vec<ComplexMatrix>> {
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
    fn receptances(&self, change: &Change) -> Option<Vec<ComplexMatrix>> {
        let [youngs_modulus_pa, density_kg_per_m3] = self.material(change);
        let modal = self
            .stated()?
            .of_material(youngs_modulus_pa, density_kg_per_m3);
        let modal = modal.with_damping(self.damping(change));
        self.between(&modal, &self.dofs(change)?)
    }
}
