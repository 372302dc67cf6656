//! Joints from physics, before anything is built: surfaces, materials, bolts and preload give a joint by contact mechanics.
//!
//! Three models: [`fractal`] contact under an uneven pressure (Zhao), the [`virtual_material`] of the layer between two
//! parts (Tian), and [`layered_beam`]s whose interfaces slip (Kavi). [`microslip`] is what a loaded interface does. [`surface`] gives the roughness, [`pressure`] the
//! field that the fasteners make, [`patch`] integrates over the interface, [`uncertain`] carries what is not known well.
#![forbid(unsafe_code)]

mod columns;
mod contact_error;
pub mod fractal;
mod growth;
pub mod layered_beam;
mod least_squares;
mod material;
pub mod microslip;
mod number;
pub mod patch;
pub mod pressure;
pub mod study;
pub mod surface;
pub mod uncertain;
pub mod virtual_material;

pub use contact_error::ContactError;
pub use material::{Material, Pair};
pub use number::NumberError;
