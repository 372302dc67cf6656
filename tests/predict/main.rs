//! Joints from physics against quadrature, arbitrary precision, published numbers and their own limits.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod fractal;
mod tian;
mod virtual_material;
mod pressure;
mod surface;
