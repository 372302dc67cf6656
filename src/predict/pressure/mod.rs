//! The pressure between two parts that bolts hold together.

mod field;

pub use field::{Element, FieldError, PressureField};
