//! The lap model from natural frequencies and from responses, against closed forms, SciPy and independent models.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod brake_reuss;
mod decays;
mod decays_in_time;
mod free_vibration;
mod loops;
mod masing;
mod oscillator;
mod passive;
mod published_backbone;
mod refusals;
mod residual;
mod responses;
mod runs;
mod slipping;
mod updating;
