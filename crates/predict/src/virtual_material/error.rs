//! Why there is no layer that stands for a joint.

use thiserror::Error;

/// A contact or a layer outside the model.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum VirtualMaterialError {
    /// The hardness is not a positive number.
    #[error(
        "the hardness is {0} Pa; expected a positive number, that of the softer part (about 2.8 times its yield strength)"
    )]
    Hardness(f64),
    /// The tangential load uses up the friction, or is no number.
    #[error(
        "β/f, the tangential load over the friction force, is {0}; expected 0 or more and less than 1: at 1 all contacts slip and there is no shear \
         modulus"
    )]
    FrictionRatio(f64),
    /// The critical area is no ordinary number.
    #[error(
        "the critical contact area comes out as e^{exponent:.0} m²; check the fractal dimension ({fractal_dimension}), the roughness and the \
         hardness"
    )]
    CriticalArea {
        /// Its natural logarithm.
        exponent: f64,
        /// The fractal dimension.
        fractal_dimension: f64,
    },
    /// The load or the real area is not a positive number.
    #[error("the {quantity} is {found} {unit}; expected a positive number")]
    Loading {
        /// "normal load" or "real contact area".
        quantity: &'static str,
        /// What was found.
        found: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// No contact is elastic.
    #[error(
        "the {quantity} is {found} {unit}, and contacts become elastic above {critical} {unit} (A_t > A_rc): there are no moduli below; raise the preload \
         or check the roughness"
    )]
    NoElasticContact {
        /// "normal load" or "real contact area".
        quantity: &'static str,
        /// What was found.
        found: f64,
        /// Where elastic contacts begin.
        critical: f64,
        /// The unit of both.
        unit: &'static str,
    },
    /// The load is so far from the critical one that the moduli are no ordinary numbers.
    #[error(
        "the largest contact is e^{0:.0} times the critical one: the moduli are no ordinary numbers; check the roughness"
    )]
    Overflow(f64),
    /// No isotropic material has such moduli.
    #[error(
        "E = {youngs_modulus_pa} Pa and G = {shear_modulus_pa} Pa make Poisson's ratio {found}; an isotropic material has more than −1 and less than 0.5. \
         Use the two moduli as those of an orthotropic layer or as joint stiffnesses, which need no Poisson's ratio, or a greater hardness"
    )]
    PoissonsRatio {
        /// E/(2G) − 1.
        found: f64,
        /// E, in Pa.
        youngs_modulus_pa: f64,
        /// G, in Pa.
        shear_modulus_pa: f64,
    },
    /// A thickness or a density of the layers is not a positive number.
    #[error("the {quantity} of side {side} is {found}; expected a positive number")]
    Layer {
        /// "thickness (m)" or "density (kg/m³)".
        quantity: &'static str,
        /// "a" or "b".
        side: char,
        /// What was found.
        found: f64,
    },
}
