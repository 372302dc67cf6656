//! The laws of a joint.

mod declaration;

pub use declaration::{
    ActsOn, Declaration, Parameter, Quantity, Range, Remembered, RememberedAs, Span, UnitRule,
};
