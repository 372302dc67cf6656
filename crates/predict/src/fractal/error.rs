//! Why a contact has no stiffness that this model could give.

use thiserror::Error;

/// A contact that is outside the model.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FractalError {
    /// The hardness is not a positive number.
    #[error(
        "the hardness is {0} Pa; expected a positive number, that of the softer part (about 2.8 times its yield strength)"
    )]
    Hardness(f64),
    /// The coefficient of friction is not a positive number.
    #[error("the coefficient of friction is {0}; expected a positive number")]
    FrictionCoefficient(f64),
    /// The shear stress is negative or not a number.
    #[error(
        "the shear stress in the contacts is {0} Pa; expected 0 (no tangential load) or a positive number"
    )]
    ShearStrength(f64),
    /// The nominal area is not a positive number.
    #[error("the nominal area is {0} m²; expected a positive number, that of the whole interface")]
    NominalArea(f64),
    /// The critical area is too small for a number.
    #[error(
        "the critical contact area comes out as e^{exponent:.0} m²; check the fractal dimension ({fractal_dimension}), the roughness and the \
         hardness, which is {hardness_to_modulus} of the equivalent modulus"
    )]
    CriticalArea {
        /// Its natural logarithm.
        exponent: f64,
        /// The fractal dimension.
        fractal_dimension: f64,
        /// Hardness over equivalent Young's modulus.
        hardness_to_modulus: f64,
    },
    /// The pressure is negative or not a number.
    #[error("the pressure is {0} Pa; expected a pressure of 0 Pa or more")]
    Pressure(f64),
    /// The pressure is not below the hardness.
    #[error(
        "the pressure is {pressure_pa} Pa and the hardness {hardness_pa} Pa: the parts flow as a whole, and the model of separate contacts ends"
    )]
    BeyondHardness {
        /// The pressure, in Pa.
        pressure_pa: f64,
        /// The hardness, in Pa.
        hardness_pa: f64,
    },
    /// The contacts have more area than there is.
    #[error(
        "at {pressure_pa} Pa the contacts have {fraction} of the nominal area: the model of separate contacts ends well below 1; lower the pressure \
         or check the roughness"
    )]
    RealArea {
        /// The pressure, in Pa.
        pressure_pa: f64,
        /// Real over nominal area.
        fraction: f64,
    },
    /// The tangential force comes too close to that of friction.
    #[error(
        "q = T/(μP) is {found}; expected 0 or more and less than {limit:.6}, where the tangential loss factor is infinite or all contacts slip: lower \
         the shear stress or raise the coefficient of friction"
    )]
    FrictionRatio {
        /// q as found.
        found: f64,
        /// Where the model ends.
        limit: f64,
    },
    /// An element of a pressure field is outside the model.
    #[error("element {number} of the pressure field, at x = {x_m} m, y = {y_m} m: {reason}")]
    Element {
        /// Its place in the field, counted from 1.
        number: usize,
        /// Its coordinates, in m.
        x_m: f64,
        /// The second of them.
        y_m: f64,
        /// What is wrong there.
        reason: Box<FractalError>,
    },
}
