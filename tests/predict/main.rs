//! Joints from physics: surfaces and pressure.

mod pressure;
mod surface;
