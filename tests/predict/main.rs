//! Joints from physics.

mod layered_beam;
