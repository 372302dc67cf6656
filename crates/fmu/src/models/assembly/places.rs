//! The coordinates in which an assembly goes on, and what is seen of them: its states, its motions and its joints.
//!
//! There the state takes a product with a full matrix, a step and its outputs do not. So states are told where somebody asks.

use std::sync::Arc;

use bolted_joint_dynamics::{
    JointLaw, SPACE_COUNT,
    assembly::{Assembly, AssemblyCoordinates, AssemblyState, Matrix, Underway},
};

use super::layout::AssemblyLayout;
use crate::{assembly_file::AssemblyFile, interface::Values, underway};

/// So many are kept: of an assembly over the preload there are some, of others one.
const KEPT: usize = 4;

/// The coordinates about some preloads.
#[derive(Debug)]
pub(super) struct Place {
    /// These preloads, N·m.
    pub(super) about_n_m: Vec<f64>,
    pub(super) coordinates: AssemblyCoordinates,
    /// Rows that see the motions that are outputs, and then their rates.
    motions: Matrix,
    /// Rows that see the relative motions of all joints' DOFs, and then their rates.
    relative: Matrix,
}

impl Place {
    fn new(file: &AssemblyFile, about_n_m: Vec<f64>) -> Self {
        let coordinates = match about_n_m.is_empty() {
            true => AssemblyCoordinates::of(&file.assembly),
            false => AssemblyCoordinates::of(&file.assembly.about(&about_n_m)),
        };
        Self {
            motions: coordinates.seen(&file.motions),
            relative: coordinates.seen(&file.assembly.relative()),
            coordinates,
            about_n_m,
        }
    }

    /// Takes motion and energies from values that are underway in this place; says whether they are.
    pub(super) fn take(
        &self,
        layout: &AssemblyLayout,
        values: &Values,
        state: &mut Underway,
    ) -> bool {
        let Some((own, [balance_j, supplied_j, about_n_m @ ..])) = parts(values, layout) else {
            return false;
        };
        if about_n_m != self.about_n_m {
            return false;
        }
        state.motion.copy_from_slice(own);
        state.balance_j = *balance_j;
        state.supplied_j = *supplied_j;
        true
    }

    /// The same from the states that are listed.
    pub(super) fn enter(&self, layout: &AssemblyLayout, values: &Values, state: &mut Underway) {
        let listed = values.listed();
        let entered = self.coordinates.underway(&AssemblyState {
            motion: listed[layout.coordinates.start..layout.rates.end].to_vec(),
            memory: Vec::new(),
            supplied_j: listed[layout.energies.start],
            dissipated_j: listed[layout.energies.start + 1],
        });
        state.motion = entered.motion;
        state.balance_j = entered.balance_j;
        state.supplied_j = entered.supplied_j;
    }

    /// Writes motion and energies to values, which are underway in this place from now on.
    pub(super) fn put(&self, layout: &AssemblyLayout, state: &Underway, values: &mut Values) {
        values.underway_mut().go_on(|numbers| {
            let (own, rest) = numbers.split_at_mut(2 * layout.coordinates.len());
            own.copy_from_slice(&state.motion);
            if let [balance_j, supplied_j, about_n_m @ ..] = rest {
                *balance_j = state.balance_j;
                *supplied_j = state.supplied_j;
                about_n_m.copy_from_slice(&self.about_n_m);
            }
        });
    }

    /// Writes motions and joint loads of values that are underway in this place.
    fn write_outputs(
        &self,
        (assembly, layout): (&Assembly, &AssemblyLayout),
        laws: &[JointLaw<SPACE_COUNT>],
        values: &mut Values,
    ) {
        let Some((own, _)) = parts(values, layout) else {
            return;
        };
        let [motions, relative] = [&self.motions, &self.relative].map(|rows| {
            let mut seen = vec![0.0; rows.rows()];
            rows.add_product_to(own, &mut seen);
            seen
        });
        let (listed, memory) = values.listed_beside_memory();
        let (displacements, velocities) = motions.split_at(motions.len() / 2);
        let pairs = displacements.iter().zip(velocities);
        for (own, (x, v)) in listed[layout.motions.clone()]
            .chunks_exact_mut(2)
            .zip(pairs)
        {
            own.copy_from_slice(&[*x, *v]);
        }
        let loads = &mut listed[layout.joint_loads.clone()];
        assembly.joint_loads_at(&relative, laws, memory, loads);
    }
}

/// The latest places.
#[derive(Debug, Default)]
pub(super) struct Places(Vec<Arc<Place>>);

impl Places {
    /// That about these preloads (N·m), made where it is not known.
    pub(super) fn of(&mut self, file: &AssemblyFile, about_n_m: &[f64]) -> Arc<Place> {
        let mut known = self.0.iter();
        let place = match known.position(|own| own.about_n_m == about_n_m) {
            Some(place) if place + 1 == self.0.len() => return Arc::clone(&self.0[place]),
            Some(place) => self.0.remove(place),
            None => Arc::new(Place::new(file, about_n_m.to_vec())),
        };
        if self.0.len() == KEPT {
            self.0.remove(0);
        }
        self.0.push(Arc::clone(&place));
        place
    }

    /// Makes that known in which `values` are underway, if they are.
    pub(super) fn prepare(
        &mut self,
        file: &AssemblyFile,
        layout: &AssemblyLayout,
        values: &Values,
    ) {
        if let Some((_, [_, _, about_n_m @ ..])) = parts(values, layout) {
            self.of(file, about_n_m);
        }
    }

    /// Calls `of` with the place in which `values` are underway, if they are, and says whether they are.
    fn with(
        &self,
        file: &AssemblyFile,
        layout: &AssemblyLayout,
        values: &mut Values,
        of: impl FnOnce(&Place, &mut Values),
    ) -> bool {
        let Some((_, [_, _, about_n_m @ ..])) = parts(values, layout) else {
            return false;
        };
        match self.0.iter().find(|own| own.about_n_m == about_n_m) {
            Some(place) => of(place, values),
            None => of(&Place::new(file, about_n_m.to_vec()), values),
        }
        true
    }

    /// Writes motions and joint loads of values that are underway; says whether they are.
    pub(super) fn write_outputs(
        &self,
        file: &AssemblyFile,
        layout: &AssemblyLayout,
        laws: &[JointLaw<SPACE_COUNT>],
        values: &mut Values,
    ) -> bool {
        self.with(file, layout, values, |place, values| {
            place.write_outputs((&file.assembly, layout), laws, values);
        })
    }

    /// Writes the states where they have not been told.
    pub(super) fn settle(&self, file: &AssemblyFile, layout: &AssemblyLayout, values: &mut Values) {
        if !values.underway().is_untold() {
            return;
        }
        self.with(file, layout, values, |place, values| {
            let (listed, underway) = values.listed_beside_underway();
            let Some((own, [balance_j, supplied_j, ..])) = parts_of(underway, layout) else {
                return;
            };
            let motion = &mut listed[layout.coordinates.start..layout.rates.end];
            place.coordinates.write_motion(own, motion);
            let dissipated_j = place.coordinates.dissipated_j(*balance_j, motion);
            let energies = &mut listed[layout.energies.clone()];
            energies.copy_from_slice(&[*supplied_j, dissipated_j]);
        });
        values.underway_mut().tell();
    }
}

/// Whether values are underway in coordinates about these preloads (N·m).
pub(super) fn are_about(about_n_m: &[f64], layout: &AssemblyLayout, values: &Values) -> bool {
    parts(values, layout).is_some_and(|(_, rest)| rest.get(2..) == Some(about_n_m))
}

/// Of values that are underway, the coordinates, and after them heat with the energy of the linear part (J), work of the loads (J)
/// and the preloads (N·m) about which the coordinates are.
fn parts<'v>(values: &'v Values, layout: &AssemblyLayout) -> Option<(&'v [f64], &'v [f64])> {
    parts_of(values.underway(), layout)
}

fn parts_of<'v>(
    underway: &'v underway::Underway,
    layout: &AssemblyLayout,
) -> Option<(&'v [f64], &'v [f64])> {
    let numbers = underway.numbers()?;
    numbers.split_at_checked(2 * layout.coordinates.len())
}
