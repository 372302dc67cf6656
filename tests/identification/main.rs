//! Identification against joints that are known because the assembly was computed from them.

#![expect(
    clippy::unwrap_used,
    reason = "a test whose preparation fails has nothing better to do than panic"
)]

mod bands;
mod beams;
mod bolts;
mod bound;
mod cases;
mod decoupling;
mod global;
mod measured;
mod monte_carlo;
mod published;
mod refined;
mod torque;
mod two_step;
