//! An elastic layer that stands for the joint in a finite-element model (Tian).
//!
//! A layer of the interface's area and of some thickness, glued to both parts, gets moduli from the contacts of the rough surfaces:
//! [`LayerContact`] gives its [`Moduli`] under a load, [`VirtualMaterial`] is the material, with cards for finite-element codes,
//! and [`JointStiffness`] is what the layer amounts to between the parts.
//! H. Tian, D. Zhu, H. Qin, *Theoretical-experimental Modeling of Bolted Joint Interface in Milling of Grey Cast Iron HT250*, 2011.

mod cards;
mod contact;
mod fit;
mod interface;
mod material;

pub use cards::{Card, CardError};
pub use contact::{LayerContact, Loading, Moduli};
pub use fit::{Fit, FittedLayer, Magnitudes, Observation, fit};
pub use interface::{Interface, JointStiffness};
pub use material::{Layers, VirtualMaterial};
