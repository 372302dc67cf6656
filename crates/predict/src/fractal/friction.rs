//! Friction in the contacts.

/// How the surfaces resist sliding, and how hard they are pulled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient μ of static friction; positive.
    pub coefficient: f64,
    /// Shear stress τ_b that acts on the real area of contact, in Pa: the tangential force is T = τ_b A_r. Zhao takes the shear
    /// strength of the softer material. Zero is a joint without tangential load, which has no microslip.
    pub shear_strength_pa: f64,
}
