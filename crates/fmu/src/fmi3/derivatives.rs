//! Derivatives of outputs with respect to time, and partial derivatives: directional and adjoint.

use crate::{
    fmi3::{
        Done, Opaque, ValueReference,
        arguments::{array, array_mut, same_count},
        call, call_inside,
    },
    logging::Status,
};

/// Reads first derivatives of outputs with respect to time.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the lengths that are told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: Opaque,
    value_references: *const ValueReference,
    value_reference_count: usize,
    orders: *const i32,
    values: *mut f64,
    value_count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call_inside("fmi3GetOutputDerivatives", instance, |instance| {
            same_count("nValues", value_count, value_reference_count)?;
            let references = array(value_references, value_reference_count, "valueReferences")?;
            let orders = array(orders, value_reference_count, "orders")?;
            let values = array_mut(values, value_count, "values")?;
            instance.output_derivatives(references, orders, values)?;
            Ok(Done::Silently)
        })
    }
}

/// Defines the two functions, which differ in whether the seed belongs to the knowns or to the unknowns.
macro_rules! partial_derivative {
    ($(#[$doc:meta])* $function:ident, $method:ident, lengths: $lengths:expr) => {
        $(#[$doc])*
        ///
        /// # Safety
        ///
        /// `instance` as for every function; the arrays have the lengths that are told.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $function(
            instance: Opaque,
            unknowns: *const ValueReference,
            unknown_count: usize,
            knowns: *const ValueReference,
            known_count: usize,
            seed: *const f64,
            seed_count: usize,
            sensitivity: *mut f64,
            sensitivity_count: usize,
        ) -> Status {
            // SAFETY: the importer's promise
            unsafe {
                call(stringify!($function), instance, |instance| {
                    let [seeds, sensitivities] = $lengths([unknown_count, known_count]);
                    same_count("nSeed", seed_count, seeds)?;
                    same_count("nSensitivity", sensitivity_count, sensitivities)?;
                    let unknowns = array(unknowns, unknown_count, "unknowns")?;
                    let knowns = array(knowns, known_count, "knowns")?;
                    let seed = array(seed, seed_count, "seed")?;
                    let sensitivity = array_mut(sensitivity, sensitivity_count, "sensitivity")?;
                    instance.$method([unknowns, knowns], seed, sensitivity)?;
                    Ok(Done::Silently)
                })
            }
        }
    };
}

partial_derivative! {
    /// Change of the unknowns when the knowns change along the seed.
    fmi3GetDirectionalDerivative, directional_derivative, lengths: |[unknowns, knowns]: [usize; 2]| [knowns, unknowns]
}

partial_derivative! {
    /// For each known, the sum over the unknowns of seed times partial derivative.
    fmi3GetAdjointDerivative, adjoint_derivative, lengths: |[unknowns, knowns]: [usize; 2]| [unknowns, knowns]
}
