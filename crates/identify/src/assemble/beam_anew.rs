//! A beam of the study as a structure that is computed anew where its material or the places on it are not known exactly.

use std::collections::BTreeMap;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Beam, BeamPoint, ComplexMatrix, ModalBeam};
use bolted_joint_systematic::{Change, Computation, Compute};

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

    /// The joint's DOFs and the points where the change puts them.
    fn dofs(&self, change: &Change) -> Option<Vec<(BeamPoint, f64)>> {
        let moved = self.joints_m.iter().zip(&change.joint_m);
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

    fn receptances(
        &self,
        modal: &ModalBeam,
        dofs: &[(BeamPoint, f64)],
    ) -> Option<Vec<ComplexMatrix>> {
        let points: Vec<BeamPoint> = dofs.iter().map(|&(point, _)| point).collect();
        let receptances = modal.receptances(&points, self.frequency_hz).ok()?;
        Some(signed(receptances, dofs))
    }
}

impl Compute for BeamAnew<'_> {
    fn changed(&self, change: &Change) -> Option<Box<dyn Computation + '_>> {
        let [youngs_modulus_pa, density_kg_per_m3] = self.material(change);
        let beam = Beam {
            youngs_modulus_pa,
            density_kg_per_m3,
            ..self.beam.clone()
        };
        let dofs = self.dofs(change)?;
        let points: Vec<BeamPoint> = dofs.iter().map(|&(point, _)| point).collect();
        Some(Box::new(ChangedBeam {
            of: self,
            modal: beam.modal(&points).ok()?,
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
        self.of.receptances(&modal, &self.of.dofs(change)?)
    }
}
