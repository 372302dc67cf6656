//! Identification against joints that are known because the assembly was computed from them.

#![expect(
    clippy::unwrap_used,
    reason = "a test whose preparation fails has nothing better to do than panic"
)]

mod cases;
mod decoupling;
mod published;
mod refined;
