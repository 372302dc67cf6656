//! The interface joint, uncertain values and studies of predictions, against closed forms and statistics.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod patch;
mod uncertain;
