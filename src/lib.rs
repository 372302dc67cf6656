//! Turns measurements of a bolted joint into an FMU that any FMI tool can run.
//!
//! The way of the data: [`frf`] and [`structure`] give receptances, [`identify`] finds the joint that couples them,
//! [`predict`] finds one from physics alone, [`joint`] is the file that holds it, [`export`] packs it into an FMU, [`check`] tries that FMU, [`report`] draws
//! what was found. [`respond`] computes what a test would measure, [`reproduce`] repeats the published case studies.
#![forbid(unsafe_code)]

pub mod check;
pub mod cli;
pub mod cosimulation;
pub mod export;
pub mod frf;
pub mod harmonic;
mod html;
pub mod identify;
pub mod joint;
pub mod predict;
pub mod report;
pub mod reproduce;
pub mod respond;
pub mod structure;
mod text_file;
mod text_table;
pub(crate) mod whole_file;

pub use text_file::TextFileError;
