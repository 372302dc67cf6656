//! Averages of the decoupled values over bands, and which bands these are.

use bolted_joint_frf::structure::ComplexMatrix;

use super::band_choice;
use super::bands::{self, BandChoices, Bands, UsedBands};
use super::layout::Layout;
use super::lines::Lines;
use super::model::JointMatrices;

/// An assembly with its decoupled values.
#[derive(Clone, Copy)]
pub(super) struct Decoupled<'a> {
    pub(super) lines: &'a Lines,
    pub(super) values: &'a [Option<ComplexMatrix>],
}

/// The average of the decoupled values of each joint over bands, from all lines of the assemblies and all bolts that have it.
pub(super) fn band_averages(
    all: &[Decoupled<'_>],
    layout: &Layout,
    bands: &[Vec<UsedBands>],
) -> Option<Vec<JointMatrices>> {
    let lines: Vec<(&[f64], &[Option<ComplexMatrix>])> = all
        .iter()
        .map(|assembly| (assembly.lines.frequency_hz.as_slice(), assembly.values))
        .collect();
    let dofs = layout.model().dofs();
    let average = |joint: usize| {
        let bolts = layout.bolts_with(joint);
        let starts: Vec<usize> = bolts.map(|bolt| bolt * dofs).collect();
        let bands = Bands::of_used(&bands[joint]);
        bands::average_of_blocks(layout.model(), &lines, &starts, &bands)
    };
    (0..layout.joints()).map(average).collect()
}

/// The bands before there is an estimate to choose them at: those that are given, else none, for the median over all lines.
pub(super) fn first_bands(layout: &Layout, choices: &BandChoices) -> Vec<Vec<UsedBands>> {
    band_choice::used(layout, choices, None)
}

/// Resonances of the substructures of all assemblies, Hz, where bands are to be chosen.
pub(super) fn own_resonances(all: &[Decoupled<'_>], choices: &BandChoices) -> Option<Vec<f64>> {
    let mut values = all.iter().flat_map(|assembly| assembly.values);
    let is_asked = choices.any_is_automatic() && values.any(Option::is_some);
    let lines = all.iter().map(|assembly| assembly.lines);
    is_asked.then(|| band_choice::own_resonances(lines))
}

/// The bands of each entry of each joint; automatic ones are chosen on the first assembly's lines at the estimate, away from
/// the substructures' own resonances.
pub(super) fn used_bands(
    all: &[Decoupled<'_>],
    layout: &Layout,
    choices: &BandChoices,
    (unknowns, own_hz): (&[f64], Option<&[f64]>),
) -> Vec<Vec<UsedBands>> {
    let chosen = || {
        let first = all.first()?.lines;
        band_choice::chosen(first, own_hz?, layout, unknowns, &choices.given())
    };
    band_choice::used(layout, choices, chosen().as_deref())
}
