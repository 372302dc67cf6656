//! Matrices of a structure: how large, which coordinates have names, where it resonates.

use std::path::Path;

use bolted_joint_frf::structure::NamedMatrices;

use crate::shown::{short, some};
use crate::{ShowError, Shown};

/// Coordinates and frequencies that are listed at most.
const LISTED: usize = 12;

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    let NamedMatrices { points, spatial } = NamedMatrices::read(path)?;
    let mut shown = Shown::of("matrices of a structure");
    let named: Vec<_> = points.iter().flatten().collect();
    shown.fact(
        "coordinates",
        format!("{}, {} of them with names", spatial.size(), named.len()),
    );
    shown.fact("points", some(&named, LISTED));
    let modes = spatial.modes()?;
    let frequencies = modes.frequency_hz();
    let told: Vec<String> = frequencies
        .iter()
        .take(LISTED)
        .map(|&own| short(own, 5))
        .collect();
    shown.fact(
        "frequencies",
        format!("{} Hz, the lowest, undamped", told.join(" ")),
    );
    shown.detail("coordinates", spatial.size());
    shown.detail(
        "points",
        named.iter().map(ToString::to_string).collect::<Vec<_>>(),
    );
    shown.detail("frequencies_hz", frequencies);
    Ok(shown)
}
