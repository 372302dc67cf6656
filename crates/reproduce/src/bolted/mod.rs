//! Chapter 5: bolts identified on one assembly, regenerated at other points, used in other assemblies.

mod bolts;
mod chain;
mod longer_beam;
mod rotation;
mod single_line;
mod sizes;
mod states;
mod structures;
mod two_bolts;
mod update;

pub(crate) use bolts::Bolts;
pub(crate) use longer_beam::long_m8x35;
pub(crate) use rotation::with_section;
pub(crate) use single_line::table_5_2;
pub(crate) use sizes::{table_5_11, table_5_12};
pub(crate) use states::{table_5_10, torques};
pub(crate) use two_bolts::two_m6x30;
