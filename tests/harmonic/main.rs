//! Harmonic balance against formulas, against shooting, against time integration, and against differences of its own results.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod curves;
mod derivatives;
mod duffing;
mod in_time;
mod laps;
mod slipping;
