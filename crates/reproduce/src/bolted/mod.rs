//! Chapter 5: bolts identified on one assembly, regenerated at other points, used in other assemblies.

mod bolts;
mod chain;
mod longer_beam;
mod qualities;
mod single_line;
mod sizes;
mod structures;
mod torques;
mod two_bolts;
mod update;

pub(crate) use chain::{m6x30_chain, m8x16_chain, m8x35_chain, m10x16_chain, m10x35_chain};
pub(crate) use longer_beam::long_m8x35;
pub(crate) use qualities::table_5_10;
pub(crate) use single_line::table_5_2;
pub(crate) use sizes::{table_5_11, table_5_12};
pub(crate) use torques::torques;
pub(crate) use two_bolts::two_m6x30;
