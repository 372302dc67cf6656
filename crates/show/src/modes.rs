//! Modes of a structure: points, frequencies, damping, and the functions that they add up to.

use std::path::Path;

use bolted_joint_frf::receptance_unit;
use bolted_joint_frf::structure::ModalModel;
use bolted_joint_report::{DrawnFunction, FunctionGroup, ShownPicture};
use serde_json::json;

use crate::shown::{counted, short, some};
use crate::{ShowError, Shown};

/// Points and modes that are listed at most.
const LISTED: usize = 12;
/// Functions that are drawn at most.
const DRAWN: usize = 49;
/// Lines of a drawn function.
const LINES: usize = 1500;

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    let model = ModalModel::read(path)?;
    let mut shown = Shown::of("modes of a structure");
    let (points, modes) = (model.points(), model.modes());
    for (label, line) in model.understood() {
        shown.fact(label, line.clone());
    }
    shown.warnings.extend_from_slice(model.warnings());
    shown.fact(
        "points",
        format!("{}: {}", points.len(), some(points, LISTED)),
    );
    let told = modes.iter().take(LISTED).map(|mode| {
        format!(
            "{} Hz, damping ratio {}",
            short(mode.frequency_hz, 5),
            short(mode.damping_ratio, 3)
        )
    });
    let more = modes.len().saturating_sub(LISTED);
    let more = (more > 0).then(|| format!("and {more} more"));
    shown.facts_of("modes", told.chain(more));
    let pairs = |has: bool| {
        let all = (0..points.len()).flat_map(|p| (p..points.len()).map(move |q| (p, q)));
        all.filter(|&(p, q)| model.residual(p, q).is_some() == has)
            .count()
    };
    let (with, without) = (pairs(true), pairs(false));
    shown.fact(
        "residuals",
        match with {
            0 => "none: what lies outside these modes is missing from the functions".to_owned(),
            with => format!("of {} of {} pairs", with, with + without),
        },
    );
    if modes
        .iter()
        .any(|mode| mode.shape.iter().any(|own| own[1] != 0.0))
    {
        shown.fact("shapes", "complex");
    }
    shown.detail(
        "points",
        points.iter().map(ToString::to_string).collect::<Vec<_>>(),
    );
    shown.detail(
        "modes",
        modes
            .iter()
            .map(|mode| json!({ "frequency_hz": mode.frequency_hz, "damping_ratio": mode.damping_ratio }))
            .collect::<Vec<_>>(),
    );
    shown.pictures = pictures(&model)?;
    Ok(shown)
}

/// Functions for a load at each point, over the modes and somewhat more.
fn pictures(model: &ModalModel) -> Result<Vec<ShownPicture>, ShowError> {
    let natural = model.modes().iter().map(|mode| mode.frequency_hz);
    let natural = natural.filter(|&frequency_hz| frequency_hz > 0.0);
    let (low, high) = natural.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), own| {
        (low.min(own), high.max(own))
    });
    let (from, to) = match high > 0.0 {
        true => (0.5 * low, 1.25 * high),
        // of a rigid body alone any lines tell the same
        false => (1.0, 100.0),
    };
    let frequency_hz: Vec<f64> = (0..LINES)
        .map(|line| from + (to - from) * line as f64 / (LINES - 1) as f64)
        .collect();
    let points = model.points();
    let references = points.iter().take((DRAWN / points.len()).max(1));
    let mut pictures = Vec::new();
    for &reference in references {
        let mut by_unit: Vec<(&'static str, Vec<DrawnFunction>)> = Vec::new();
        for &response in points.iter().take(DRAWN) {
            let drawn = DrawnFunction {
                label: response.to_string(),
                values: model.receptance(response, reference, &frequency_hz)?,
                coherence: None,
            };
            let unit = receptance_unit(response, reference);
            match by_unit.iter_mut().find(|own| own.0 == unit) {
                Some((_, all)) => all.push(drawn),
                None => by_unit.push((unit, vec![drawn])),
            }
        }
        pictures.extend(by_unit.into_iter().map(|(unit, functions)| {
            ShownPicture::Functions(FunctionGroup {
                title: format!(
                    "Computed of {}, load at {reference}",
                    counted(model.modes().len(), "mode")
                ),
                unit,
                frequency_hz: frequency_hz.clone(),
                functions,
            })
        }));
    }
    Ok(pictures)
}
