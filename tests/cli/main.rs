//! The program as its user meets it: what it makes of good files, and what it says about every kind of wrong one.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod assembly;
mod bench;
mod bolted;
mod check;
mod check_run;
mod coherence;
mod communication_step;
mod compare;
mod convert;
mod demo;
mod estimator;
mod examples;
mod export;
mod identified;
mod init;
mod joint_file;
mod kept;
mod lap_data;
mod lap_response;
mod merge;
mod modal_file;
mod model_choice;
mod modes_beside;
mod output;
mod predict;
mod reliability;
mod report;
mod reproduce;
mod respond;
mod rig;
mod show;
mod slips;
mod study;
mod systems;
mod table_file;
mod torque;
mod universal_file;
mod usage;
