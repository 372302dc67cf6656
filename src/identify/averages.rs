//! Averages of the decoupled values over bands, and which bands these are.

use nalgebra::DVector;

use crate::structure::ComplexMatrix;

use super::band_choice;
use super::bands::{self, BandChoice, BandChoices, Bands, UsedBands};
use super::block::Block;
use super::decoupling;
use super::estimator::{self, Free};
use super::group::Group;
use super::layout::Layout;
use super::lines::Lines;
use super::model::JointMatrices;
use super::noise::Noise;
use super::objective::Objective;
use super::search;
use super::starts::Linear;

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
    let average = |joint: usize| {
        let (mut frequency_hz, mut values) = (Vec::new(), Vec::new());
        for bolt in layout.bolts_with(joint) {
            for assembly in all {
                frequency_hz.extend(&assembly.lines.frequency_hz);
                values.extend(decoupling::of_bolt(
                    assembly.values,
                    bolt,
                    layout.model().dofs(),
                ));
            }
        }
        let bands = Bands::of_used(&bands[joint]);
        bands::band_average(layout.model(), &frequency_hz, &values, &bands)
    };
    (0..layout.joints()).map(average).collect()
}

/// The bands of each entry of each joint; automatic ones are chosen on the first assembly's lines at a preliminary
/// estimate.
pub(super) fn used_bands<const N: usize>(
    all: &[Decoupled<'_>],
    layout: &Layout,
    choices: &BandChoices,
    noise: &Noise,
) -> Vec<Vec<UsedBands>> {
    let medians = || {
        let medians = BandChoices::all(BandChoice::Median);
        let bands = band_choice::used(layout, &medians, None);
        layout.unknowns_of(&band_averages(all, layout, &bands)?)
    };
    let chosen = || {
        let mut values = all.iter().flat_map(|assembly| assembly.values);
        if !choices.any_is_automatic() || !values.any(Option::is_some) {
            return None;
        }
        let places = layout.places();
        let lines: Vec<(&Lines, usize)> = all.iter().map(|a| (a.lines, 0)).collect();
        let thinned = Group::<N>::all(&lines, search::stride(&lines), |_| false);
        let start = Linear::of(&thinned).from(&places, None);
        let start = start.or_else(|| medians().map(DVector::from_vec))?;
        // Noise biases both: a fit to a few lines, which takes the substructures as exact, is nearer.
        let thinned = Objective {
            groups: &thinned,
            entries: &places,
        };
        let levels = Some(estimator::first_levels(&thinned, noise));
        let fitted = estimator::estimate(&thinned, noise, levels, &Free, &start, None);
        let preliminary = fitted.map_or(start, |fitted| fitted.unknowns);
        let first = all.first()?.lines;
        let block = Block::<N>::new(first, 0, 1);
        let own_hz = band_choice::own_resonances(all.iter().map(|assembly| assembly.lines));
        let (hz, given) = (&first.frequency_hz, choices.given());
        band_choice::chosen(&block, hz, &own_hz, layout, preliminary.as_slice(), &given)
    };
    band_choice::used(layout, choices, chosen().as_deref())
}
