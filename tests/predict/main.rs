//! Joints from physics against quadrature, closed forms, statistics, published numbers and their own limits.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod fractal;
mod layered_beam;
mod patch;
mod pressure;
mod surface;
mod tian;
mod uncertain;
mod virtual_material;
