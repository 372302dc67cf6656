//! Derivatives: partial ones, and those of inputs and outputs with respect to time.

use super::{Fmi2Integer, functions};
use crate::{
    abi::{
        ValueReference,
        arguments::{array, array_mut, same_count},
    },
    instance::Instance,
    refusal::Refusal,
};

functions! {
    /// Change of the unknowns when the knowns change along the seed: as many seeds as knowns, as many results as unknowns.
    fmi2GetDirectionalDerivative(
        unknowns: *const ValueReference, unknown_count: usize, knowns: *const ValueReference, known_count: usize,
        seed: *const f64, sensitivity: *mut f64,
    ) => |instance| {
        let of = [(unknowns, unknown_count), (knowns, known_count)];
        partial(instance, Partial::Directional, of, (seed, known_count), (sensitivity, unknown_count))
    };

    /// Change of the unknowns when the knowns change along the seed.
    fmi3GetDirectionalDerivative(
        unknowns: *const ValueReference, unknown_count: usize, knowns: *const ValueReference, known_count: usize,
        seed: *const f64, seed_count: usize, sensitivity: *mut f64, sensitivity_count: usize,
    ) => |instance| {
        let of = [(unknowns, unknown_count), (knowns, known_count)];
        partial(instance, Partial::Directional, of, (seed, seed_count), (sensitivity, sensitivity_count))
    };

    /// For each known, the sum over the unknowns of seed times partial derivative.
    fmi3GetAdjointDerivative(
        unknowns: *const ValueReference, unknown_count: usize, knowns: *const ValueReference, known_count: usize,
        seed: *const f64, seed_count: usize, sensitivity: *mut f64, sensitivity_count: usize,
    ) => |instance| {
        let of = [(unknowns, unknown_count), (knowns, known_count)];
        partial(instance, Partial::Adjoint, of, (seed, seed_count), (sensitivity, sensitivity_count))
    };

    /// Gives derivatives of inputs with respect to time for the next communication step, all or none.
    fmi2SetRealInputDerivatives(
        references: *const ValueReference, count: usize, orders: *const Fmi2Integer, values: *const f64,
    ) for STEPPING => |instance| {
        let words = instance.words();
        let references = array(references, count, words.references)?;
        let orders = array(orders, count, words.orders)?;
        instance.set_input_derivatives(references, orders, array(values, count, words.values)?)
    };

    /// Reads derivatives of outputs with respect to time, at the present time.
    fmi2GetRealOutputDerivatives(
        references: *const ValueReference, count: usize, orders: *const Fmi2Integer, values: *mut f64,
    ) for STEPPING => |instance| {
        let words = instance.words();
        let references = array(references, count, words.references)?;
        let orders = array(orders, count, words.orders)?;
        let values = array_mut(values, count, words.values)?;
        // FMI 2.0, 4.2.1: what is of higher order than the FMU knows is zero
        let known_orders: Vec<i32> = orders.iter().map(|&order| order.min(1)).collect();
        instance.output_derivatives(references, &known_orders, values)?;
        for (value, _) in values.iter_mut().zip(orders).filter(|(_, order)| **order > 1) {
            value.write(0.0);
        }
        Ok(())
    };

    /// Reads first derivatives of outputs with respect to time.
    fmi3GetOutputDerivatives(
        references: *const ValueReference, count: usize, orders: *const i32, values: *mut f64, value_count: usize,
    ) for INSIDE => |instance| {
        let words = instance.words();
        same_count("nValues", value_count, count)?;
        let references = array(references, count, words.references)?;
        let orders = array(orders, count, words.orders)?;
        instance.output_derivatives(references, orders, array_mut(values, count, words.values)?)
    };
}

/// Which product with the matrix of partial derivatives.
#[derive(Clone, Copy)]
enum Partial {
    /// Of the matrix: a seed for each known, a result for each unknown.
    Directional,
    /// Of its transpose: a seed for each unknown, a result for each known.
    Adjoint,
}

/// Takes the arrays of a partial derivative apart, each a pointer with the length that is told.
///
/// # Safety
///
/// As for [`array()`] and [`array_mut`].
unsafe fn partial(
    instance: &Instance,
    partial: Partial,
    [unknowns, knowns]: [(*const ValueReference, usize); 2],
    seed: (*const f64, usize),
    sensitivity: (*mut f64, usize),
) -> Result<(), Refusal> {
    let words = instance.words();
    let [seeds, results] = match partial {
        Partial::Directional => [knowns.1, unknowns.1],
        Partial::Adjoint => [unknowns.1, knowns.1],
    };
    same_count("nSeed", seed.1, seeds)?;
    same_count("nSensitivity", sensitivity.1, results)?;
    // SAFETY: the caller's promise
    let (references, seed, sensitivity) = unsafe {
        let unknowns = array(unknowns.0, unknowns.1, words.unknowns)?;
        let knowns = array(knowns.0, knowns.1, words.knowns)?;
        let seed = array(seed.0, seed.1, words.seed)?;
        let sensitivity = array_mut(sensitivity.0, sensitivity.1, words.sensitivity)?;
        ([unknowns, knowns], seed, sensitivity)
    };
    match partial {
        Partial::Directional => instance.directional_derivative(references, seed, sensitivity),
        Partial::Adjoint => instance.adjoint_derivative(references, seed, sensitivity),
    }
}
