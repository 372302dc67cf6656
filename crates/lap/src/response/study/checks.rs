//! What single keys of a study may hold.

use bolted_joint_dynamics::law::Term;
use bolted_joint_study::{StudyError, StudyText};

use super::tables::StudyFile;
use crate::response::model::ResponseUnknown;
use crate::response::slider::Slider;
use crate::response::terms::{NamedTerm, TermSet};

/// The terms that a study names.
pub(super) fn terms_of(study: &StudyText, named: &[NamedTerm]) -> Result<TermSet, StudyError> {
    let mut terms: Vec<Term> = Vec::new();
    let mut sliders: Vec<Slider> = Vec::new();
    for name in named {
        match *name {
            NamedTerm::Term(term) => {
                let found = format!("{} twice", term.row().symbol);
                let is_new = !terms.contains(&term);
                study.ensure(is_new, "model.terms", found, "every term once")?;
                terms.push(term);
            }
            NamedTerm::Slider(slider) => sliders.push(slider),
        }
    }
    let names: Vec<&str> = sliders.iter().map(|slider| slider.name()).collect();
    let expected = "one law that slips at most";
    study.ensure(
        sliders.len() < 2,
        "model.terms",
        names.join(" and "),
        expected,
    )?;
    let set = TermSet::of(&terms);
    Ok(sliders.into_iter().fold(set, TermSet::beside))
}

pub(super) fn known(
    study: &StudyText,
    file: &StudyFile,
) -> Result<Vec<(ResponseUnknown, f64)>, StudyError> {
    let table = &file.known;
    let all = [
        (ResponseUnknown::Mass, table.m),
        (ResponseUnknown::SupportStiffness, table.k),
        (ResponseUnknown::SupportDamping, table.c),
        (ResponseUnknown::JointStiffness, table.k12),
        (ResponseUnknown::JointDamping, table.c12),
    ];
    let mut known = Vec::new();
    for (unknown, value) in all {
        let Some(value) = value else { continue };
        let is_there = unknown != ResponseUnknown::Mass || value != 0.0;
        study.ensure(
            is_there && value >= 0.0 && value.is_finite(),
            format_args!("known.{}", unknown.symbol()),
            value,
            format_args!(
                "a value in {} that is not negative, a mass above zero",
                unknown.unit()
            ),
        )?;
        known.push((unknown, value));
    }
    Ok(known)
}

pub(super) fn band_hz(study: &StudyText, [from, to]: [f64; 2]) -> Result<[f64; 2], StudyError> {
    let is_band = from >= 0.0 && to > from && to.is_finite();
    let expected = "[lowest, highest] frequency in Hz, such as [60, 100]";
    study.ensure(
        is_band,
        "decay.band",
        format_args!("[{from}, {to}]"),
        expected,
    )?;
    Ok([from, to])
}
