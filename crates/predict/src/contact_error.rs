//! Why a contact of rough surfaces is outside the models of it: [`crate::fractal`] and [`crate::virtual_material`].

use thiserror::Error;

use super::NumberError;

/// A contact, or a layer in place of one, that is outside the model.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContactError {
    /// A number that the contact cannot be computed with.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// The critical area is too small or too large for a number.
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
    /// The tangential load on a layer uses up the friction, or is no number.
    #[error(
        "β/f, the tangential load over the friction force, is {0}; expected 0 or more and less than 1: at 1 all contacts slip and there is no shear \
         modulus"
    )]
    LayerSlips(f64),
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
        reason: Box<ContactError>,
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
         Use the two moduli as those of an orthotropic layer or as joint stiffnesses, which need no Poisson's ratio"
    )]
    PoissonsRatio {
        /// E/(2G) − 1.
        found: f64,
        /// E, in Pa.
        youngs_modulus_pa: f64,
        /// G, in Pa.
        shear_modulus_pa: f64,
    },
    /// There are not enough layers to fit a surface to.
    #[error(
        "{found} layers for {unknowns} unknowns; expected {expected} or more, with two moduli each"
    )]
    TooFewLayers {
        /// How many there are.
        found: usize,
        /// How many unknowns.
        unknowns: usize,
        /// How many are needed.
        expected: usize,
    },
    /// No surface of the search has elastic contacts in all layers.
    #[error("no surface between the bounds of the search has elastic contacts under all loads")]
    NothingFits,
}
