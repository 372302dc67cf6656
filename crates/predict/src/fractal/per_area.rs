//! What a contact under a pressure amounts to, for a unit of nominal area.

/// What the contacts do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// No pressure, no contact.
    Apart,
    /// Even the largest contact is smaller than the critical one: all flow, and none is elastic.
    Plastic,
    /// Contacts larger than the critical one are elastic, smaller ones flow.
    ElasticPlastic,
}

/// A contact under a pressure, for a unit of nominal area.
///
/// Without elastic contacts ([`Regime::Apart`], [`Regime::Plastic`]) there is no stiffness and no elastic energy. The loss factors, shares of
/// that energy, are given as 0 then: weighted with the stiffness they count for nothing in any case.
///
/// Loss factors do not add up. That of an interface is the mean weighted by the energy stored, for a common motion of all points
/// η = Σ η k ΔA / Σ k ΔA.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerArea {
    /// The pressure p, in Pa.
    pub pressure_pa: f64,
    /// What the contacts do.
    pub regime: Regime,
    /// Normal stiffness K_N/A₀, in N/m³.
    pub normal_stiffness_n_per_m3: f64,
    /// Tangential stiffness K_T/A₀ in any in-plane direction, in N/m³.
    pub tangential_stiffness_n_per_m3: f64,
    /// Normal loss factor η_N = W_NP/W_NE. A viscous damper that stands for it is C_N = η_N √(M K_N), M the mass of the structure.
    pub normal_loss_factor: f64,
    /// Tangential loss factor η_T. The damping is hysteretic: C_T = η_T K_T, in N/m.
    pub tangential_loss_factor: f64,
    /// Real over nominal area, A_r/A₀.
    pub real_area_fraction: f64,
    /// Truncated area a'_L of the largest contact of the whole nominal area, in m²; its real area is half of it where it is elastic.
    pub largest_contact_area_m2: f64,
    /// Part of the pressure that elastic contacts carry, 0 to 1.
    pub elastic_load_fraction: f64,
    /// q = T/(μP): how much of the friction force is used.
    pub friction_ratio: f64,
    /// Elastic energy W_NE/A₀, in J/m².
    pub elastic_energy_j_per_m2: f64,
    /// Energy W_NP/A₀ spent on plastic flow, in J/m².
    pub plastic_energy_j_per_m2: f64,
}

impl PerArea {
    /// Nothing at all.
    pub(super) const APART: Self = Self {
        pressure_pa: 0.0,
        regime: Regime::Apart,
        normal_stiffness_n_per_m3: 0.0,
        tangential_stiffness_n_per_m3: 0.0,
        normal_loss_factor: 0.0,
        tangential_loss_factor: 0.0,
        real_area_fraction: 0.0,
        largest_contact_area_m2: 0.0,
        elastic_load_fraction: 0.0,
        friction_ratio: 0.0,
        elastic_energy_j_per_m2: 0.0,
        plastic_energy_j_per_m2: 0.0,
    };
}
