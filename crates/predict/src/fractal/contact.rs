//! The contact of two rough surfaces.

use std::f64::consts::{LN_2, PI, TAU};

use super::domain::weight_of_contacts;
use super::{Friction, PerArea, Regime, StoredEnergy};
use crate::ContactError;
use crate::Pair;
use crate::growth::{Growth, power_integral};
use crate::number::{HARDNESS, not_negative, positive};
use crate::pressure::PressureField;
use crate::surface::Roughness;

/// Ratio γ of successive frequencies of the surface's profile.
const FREQUENCY_RATIO: f64 = 1.5;
/// Smallest natural logarithm of the critical area in m² with which powers of it are ordinary numbers.
const SMALLEST_LOG_AREA: f64 = -300.0;

/// Two rough surfaces in contact: what all points of an interface have in common.
///
/// All sums over contacts are integrals over t = ln(a'/a'_c) from 0 to x = ln(a'_L/a'_c), in the form φ(s, x) = (e^(sx) − 1)/s.
#[derive(Debug, Clone)]
pub struct FractalContact {
    fractal_dimension: f64,
    hardness_pa: f64,
    critical_area_m2: f64,
    critical_pressure_pa: f64,
    growth: Growth,
    /// Exponents s of stiffness, (1 − D)/2, and of elastic energy, (5 − 3D)/2.
    exponents: [f64; 2],
    factors: Factors,
    stored: StoredEnergy,
    /// τ_b/μ, in Pa.
    slip_stress_pa: f64,
}

/// What multiplies the integrals.
#[derive(Debug, Clone, Copy)]
struct Factors {
    /// Of K_N/A₀, in N/m³.
    normal: f64,
    /// Of K_T/A₀ without tangential force, in N/m³.
    tangential: f64,
    /// A_r/A₀ over a'_L + a'_c^((2−D)/2) a'_L^(D/2), in 1/m².
    area_per_contact_area: f64,
    /// Of both energies over A₀, in J/m² over area to 2 − D/2.
    energy: f64,
    /// The same times the critical area to 2 − D/2, in J/m².
    energy_of_critical: f64,
}

impl FractalContact {
    /// The contact of a pair of materials.
    ///
    /// The roughness is that of the surfaces together, the hardness (Pa) that of the softer part. The nominal area (m²) is that of the
    /// whole interface: it bounds the sizes of contacts, and stiffness is not proportional to it.
    ///
    /// # Errors
    /// A number that is not positive (the shear stress may be 0), or a critical area that is no ordinary number.
    pub fn new(
        pair: &Pair,
        roughness: Roughness,
        hardness_pa: f64,
        friction: Friction,
        nominal_area_m2: f64,
    ) -> Result<Self, ContactError> {
        let Friction {
            coefficient,
            shear_strength_pa,
        } = friction;
        let expected = "0 (no tangential load) or a positive number";
        positive("the hardness", hardness_pa, " Pa", HARDNESS)?;
        positive(
            "the coefficient of friction",
            coefficient,
            "",
            "a positive number",
        )?;
        not_negative(
            "the shear stress in the contacts",
            shear_strength_pa,
            " Pa",
            expected,
        )?;
        let expected = "a positive number, that of the whole interface";
        positive("the nominal area", nominal_area_m2, " m²", expected)?;
        let d = roughness.fractal_dimension();
        let modulus = pair.equivalent_youngs_modulus_pa();
        let log_critical = log_critical_area(d, roughness.roughness_m(), modulus / hardness_pa);
        if log_critical < SMALLEST_LOG_AREA {
            return Err(ContactError::CriticalArea {
                exponent: log_critical,
                fractal_dimension: d,
                hardness_to_modulus: hardness_pa / modulus,
            });
        }
        // Infinite where D nears 1: no contact is then elastic under any pressure.
        let critical_area_m2 = log_critical.exp();
        let weight = weight_of_contacts(d);
        // p_c = [D/(2−D)] H ψ^((2−D)/2) a'_c/A₀, (12) with a'_L = a'_c
        let critical_pressure_pa =
            d / (2.0 - d) * hardness_pa * weight * critical_area_m2 / nominal_area_m2;
        // (D/2) ψ^((2−D)/2)/A₀ of n(a') da' in all sums
        let common = 0.5 * d * weight / nominal_area_m2;
        // (13): k_n = 4E*(3−D)/(3√(2π)(2−D)) a'^(1/2)
        let normal = 4.0 * modulus * (3.0 - d) / (3.0 * TAU.sqrt() * (2.0 - d));
        // (22): k_t = 8G'/√(2π) (1 − T/(μP))^(1/3) a'^(1/2)
        let tangential = 8.0 * pair.equivalent_shear_modulus_pa() / TAU.sqrt();
        let root = critical_area_m2.sqrt();
        // (15), (17): H a' δ and (2/5) f_e δ with δ of (5); integrated, both have the factor (2/5) H δ/a'^((2−D)/2)
        let energy = common * 0.4 * hardness_pa * deformation_factor(d, roughness.roughness_m());
        Ok(Self {
            fractal_dimension: d,
            hardness_pa,
            critical_area_m2,
            critical_pressure_pa,
            // (12): p/p_c = e^(Dx/2) (1 + [(2−D)/2] φ(3/2 − D, x))
            growth: Growth::new(d, 0.5 * (2.0 - d)),
            exponents: [0.5 * (1.0 - d), 0.5 * (5.0 - 3.0 * d)],
            factors: Factors {
                normal: common * normal * root,
                tangential: common * tangential * root,
                area_per_contact_area: common / (2.0 - d),
                energy,
                energy_of_critical: energy * ((2.0 - 0.5 * d) * log_critical).exp(),
            },
            stored: StoredEnergy::default(),
            slip_stress_pa: friction.shear_strength_pa / friction.coefficient,
        })
    }

    /// The same with another definition of the tangential loss factor.
    #[must_use]
    pub fn with_stored_energy(self, stored: StoredEnergy) -> Self {
        Self { stored, ..self }
    }

    /// Fractal dimension D of the profile.
    #[must_use]
    pub fn fractal_dimension(&self) -> f64 {
        self.fractal_dimension
    }

    /// Truncated area a'_c between plastic contacts and the larger, elastic ones, in m²; infinite where D is close to 1.
    #[must_use]
    pub fn critical_area_m2(&self) -> f64 {
        self.critical_area_m2
    }

    /// Pressure above which there are elastic contacts, in Pa: there is no stiffness up to it.
    #[must_use]
    pub fn critical_pressure_pa(&self) -> f64 {
        self.critical_pressure_pa
    }

    /// Loss factor η_T of the tangential direction at the friction ratio q = T/(μP), as this contact defines it.
    ///
    /// # Errors
    /// As [`StoredEnergy::loss_factor`].
    pub fn tangential_loss_factor(&self, friction_ratio: f64) -> Result<f64, ContactError> {
        self.stored.loss_factor(friction_ratio)
    }

    /// What the contact amounts to under a pressure (Pa).
    ///
    /// # Errors
    /// The pressure is negative or not below the hardness, the real area is more than the nominal one, or the tangential force is too
    /// close to that of friction.
    pub fn at(&self, pressure_pa: f64) -> Result<PerArea, ContactError> {
        not_negative(
            "the pressure",
            pressure_pa,
            " Pa",
            "a pressure of 0 Pa or more",
        )?;
        if pressure_pa >= self.hardness_pa {
            return Err(ContactError::BeyondHardness {
                pressure_pa,
                hardness_pa: self.hardness_pa,
            });
        }
        if pressure_pa == 0.0 {
            return Ok(PerArea::APART);
        }
        if pressure_pa <= self.critical_pressure_pa {
            return self.plastic(pressure_pa);
        }
        let x = self
            .growth
            .solve((pressure_pa / self.critical_pressure_pa).ln());
        self.elastic_plastic(pressure_pa, x)
    }

    /// What the contact amounts to at each element of a field, in its order.
    ///
    /// # Errors
    /// As [`FractalContact::at`], with the element.
    pub fn over(&self, field: &PressureField) -> Result<Vec<PerArea>, ContactError> {
        let elements = field.elements().iter().enumerate();
        elements
            .map(|(index, element)| {
                self.at(element.pressure_pa)
                    .map_err(|reason| ContactError::Element {
                        number: index + 1,
                        x_m: element.x_m,
                        y_m: element.y_m,
                        reason: Box::new(reason),
                    })
            })
            .collect()
    }

    fn plastic(&self, pressure_pa: f64) -> Result<PerArea, ContactError> {
        // F = ∫ H a' n da' = H A_r
        let real_area_fraction = pressure_pa / self.hardness_pa;
        let friction_ratio = self.friction_ratio(pressure_pa, real_area_fraction)?;
        let d = self.fractal_dimension;
        // p A₀ = F_p = [D/(2−D)] H ψ^((2−D)/2) a'_L
        let largest_contact_area_m2 = 0.5 * real_area_fraction / self.factors.area_per_contact_area;
        // (16) with a'_L for a'_c: W_NP = ∫ H a' δ n da' up to a'_L
        let plastic_energy_j_per_m2 = self.plastic_over_elastic()
            * self.factors.energy
            * largest_contact_area_m2.powf(2.0 - 0.5 * d);
        Ok(PerArea {
            pressure_pa,
            regime: Regime::Plastic,
            real_area_fraction,
            largest_contact_area_m2,
            friction_ratio,
            plastic_energy_j_per_m2,
            ..PerArea::APART
        })
    }

    fn elastic_plastic(&self, pressure_pa: f64, x: f64) -> Result<PerArea, ContactError> {
        let Factors {
            normal,
            tangential,
            area_per_contact_area,
            energy_of_critical,
            ..
        } = self.factors;
        let [stiffness_exponent, energy_exponent] = self.exponents;
        // (a'_L/a'_c)^(D/2), and a'_L itself
        let contacts = (0.5 * self.fractal_dimension * x).exp();
        let largest_contact_area_m2 = self.critical_area_m2 * x.exp();
        // (11): A_r = [D/(4−2D)] ψ^((2−D)/2) a'_L^(D/2) (a'_L^((2−D)/2) + a'_c^((2−D)/2))
        let real_area_fraction =
            area_per_contact_area * (largest_contact_area_m2 + self.critical_area_m2 * contacts);
        if real_area_fraction > 1.0 {
            return Err(ContactError::RealArea {
                pressure_pa,
                fraction: real_area_fraction,
            });
        }
        let friction_ratio = self.friction_ratio(pressure_pa, real_area_fraction)?;
        let slip = (1.0 - friction_ratio).cbrt();
        // (14): K_N = ∫ k_n n da' from a'_c to a'_L; (22) the same with k_t
        let springs = contacts * power_integral(stiffness_exponent, x);
        // (18): W_NE = ∫ (2/5) f_e δ n da' from a'_c to a'_L
        let elastic_energy = power_integral(energy_exponent, x);
        Ok(PerArea {
            pressure_pa,
            regime: Regime::ElasticPlastic,
            normal_stiffness_n_per_m3: normal * springs,
            tangential_stiffness_n_per_m3: tangential * slip * springs,
            // (19): η_N = W_NP/W_NE
            normal_loss_factor: self.plastic_over_elastic() / elastic_energy,
            tangential_loss_factor: self.stored.loss_of(slip, friction_ratio),
            real_area_fraction,
            largest_contact_area_m2,
            elastic_load_fraction: self.growth.elastic_share(x),
            friction_ratio,
            elastic_energy_j_per_m2: energy_of_critical * contacts * elastic_energy,
            plastic_energy_j_per_m2: energy_of_critical * contacts * self.plastic_over_elastic(),
        })
    }

    /// W_NP over W_NE, but for the latter's integral: 5/(2(2 − D)).
    fn plastic_over_elastic(&self) -> f64 {
        2.5 / (2.0 - self.fractal_dimension)
    }

    /// q = T/(μP) with T = τ_b A_r and P = p A₀, if the model holds for it.
    fn friction_ratio(
        &self,
        pressure_pa: f64,
        real_area_fraction: f64,
    ) -> Result<f64, ContactError> {
        let friction_ratio = self.slip_stress_pa * real_area_fraction / pressure_pa;
        self.stored.check(friction_ratio)?;
        Ok(friction_ratio)
    }
}

/// ln a'_c, where an elastic and a plastic contact carry the same load.
fn log_critical_area(d: f64, roughness_m: f64, modulus_to_hardness: f64) -> f64 {
    // (4): a'_c = [2^(9−2D) (E*/H)² ln γ / (9 π^(3−D))]^(1/(D−1)) G²
    let base = (9.0 - 2.0 * d) * LN_2 + 2.0 * modulus_to_hardness.ln() + FREQUENCY_RATIO.ln().ln()
        - 2.0 * 3.0_f64.ln()
        - (3.0 - d) * PI.ln();
    base / (d - 1.0) + 2.0 * roughness_m.ln()
}

/// δ/a'^((2−D)/2) of (5), in m to the power D − 1.
fn deformation_factor(d: f64, roughness_m: f64) -> f64 {
    // δ = 2^(3−D) G^(D−1) √(ln γ) π^((D−2)/2) a'^((2−D)/2)
    (3.0 - d).exp2()
        * roughness_m.powf(d - 1.0)
        * FREQUENCY_RATIO.ln().sqrt()
        * PI.powf(0.5 * (d - 2.0))
}
