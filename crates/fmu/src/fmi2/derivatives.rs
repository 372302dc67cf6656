//! Derivatives: directional ones, those of inputs and those of outputs with respect to time.

use crate::{
    fmi2::{
        Done, Integer, Opaque, ValueReference,
        arguments::{array, array_mut},
        call, call_for,
    },
    interface::InterfaceType,
    logging::Status,
};

/// Change of the unknowns when the knowns change along the seed.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the lengths that are told, seeds as many as knowns and results as
/// many as unknowns.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetDirectionalDerivative(
    instance: Opaque,
    unknowns: *const ValueReference,
    unknown_count: usize,
    knowns: *const ValueReference,
    known_count: usize,
    seed: *const f64,
    sensitivity: *mut f64,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2GetDirectionalDerivative", instance, |instance| {
            let unknowns = array(unknowns, unknown_count, "vUnknown_ref")?;
            let knowns = array(knowns, known_count, "vKnown_ref")?;
            let seed = array(seed, known_count, "dvKnown")?;
            let sensitivity = array_mut(sensitivity, unknown_count, "dvUnknown")?;
            instance.directional_derivative([unknowns, knowns], seed, sensitivity)?;
            Ok(Done::Silently)
        })
    }
}

/// Gives derivatives of inputs with respect to time for the next communication step, all or none.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetRealInputDerivatives(
    instance: Opaque,
    value_references: *const ValueReference,
    count: usize,
    orders: *const Integer,
    values: *const f64,
) -> Status {
    let function = "fmi2SetRealInputDerivatives";
    // SAFETY: the importer's promise
    unsafe {
        call_for(
            InterfaceType::CoSimulation,
            function,
            instance,
            |instance| {
                let references = array(value_references, count, "vr")?;
                let orders = array(orders, count, "order")?;
                let values = array(values, count, "value")?;
                instance.set_input_derivatives(references, orders, values)?;
                Ok(Done::Silently)
            },
        )
    }
}

/// Reads derivatives of outputs with respect to time, at the present time.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    instance: Opaque,
    value_references: *const ValueReference,
    count: usize,
    orders: *const Integer,
    values: *mut f64,
) -> Status {
    let function = "fmi2GetRealOutputDerivatives";
    // SAFETY: the importer's promise
    unsafe {
        call_for(
            InterfaceType::CoSimulation,
            function,
            instance,
            |instance| {
                let references = array(value_references, count, "vr")?;
                let orders = array(orders, count, "order")?;
                let values = array_mut(values, count, "value")?;
                // FMI 2.0, 4.2.1: what is of higher order than the FMU knows is zero
                let known_orders: Vec<i32> = orders.iter().map(|&order| order.min(1)).collect();
                instance.output_derivatives(references, &known_orders, values)?;
                for (value, _) in values
                    .iter_mut()
                    .zip(orders)
                    .filter(|(_, order)| **order > 1)
                {
                    value.write(0.0);
                }
                Ok(Done::Silently)
            },
        )
    }
}
