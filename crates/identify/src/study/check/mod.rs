//! Checks of a study's tables: what passes is complete, physical and without contradiction.

mod assembly;
mod bolts;
mod rotation;
mod settings;
mod start;
mod stated;
mod substructure;
mod torque;

pub(super) use assembly::{
    MeasuredAs, every_assembly_once, frf_file, no_positions, one_noise, points, positions, torque,
};
pub(super) use bolts::bolts;
pub(super) use settings::{bands, bodies, noise};
pub(super) use start::start;
pub(super) use substructure::substructure;
pub(super) use torque::{level, torques};

/// The names of the keys that are there, or `none`.
fn names_given(none: &str, keys: &[(&str, bool)]) -> String {
    let given: Vec<&str> = keys
        .iter()
        .filter_map(|&(name, there)| there.then_some(name))
        .collect();
    if given.is_empty() {
        none.to_owned()
    } else {
        given.join(" and ")
    }
}
