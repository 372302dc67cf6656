//! Pressure fields.
