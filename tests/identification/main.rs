//! Identification against joints that are known because the assembly was computed from them.

mod cases;
mod decoupling;
mod published;
mod refined;
