//! Arguments that no importer should pass: null, huge and misaligned arrays, variables of other types and numbers.

use std::{
    ffi::{c_char, c_int, c_void},
    ptr,
};

use super::{
    c,
    importer::{Instance, status_of},
};
use crate::importer::{Kind, vr};

const HUGE: usize = usize::MAX / 2;

#[test]
fn bad_arrays_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let i = instance.handle;
    let (vr, order) = ([vr::A_F], [1]);
    let mut value = [0.0_f64; 2];
    let values = value.as_mut_ptr();
    let odd = values.cast::<u8>().wrapping_add(1).cast::<f64>();
    let (vr, order, null) = (vr.as_ptr(), order.as_ptr(), ptr::null_mut::<f64>());
    // SAFETY: the functions have to refuse all these before they look behind a pointer
    let calls: [(&str, &dyn Fn() -> c_int); 20] = unsafe {
        [
            ("vr is a null pointer", &|| {
                c::fmi2GetReal(i, ptr::null(), 1, values)
            }),
            ("value is a null pointer", &|| {
                c::fmi2GetReal(i, vr, 1, null)
            }),
            ("value does not point", &|| c::fmi2GetReal(i, vr, 1, odd)),
            ("vr does not point", &|| c::fmi2GetReal(i, vr, HUGE, values)),
            ("vr is a null pointer", &|| {
                c::fmi2SetReal(i, ptr::null(), 1, values)
            }),
            ("value is a null pointer", &|| {
                c::fmi2SetReal(i, vr, 1, null)
            }),
            ("value does not point", &|| c::fmi2SetReal(i, vr, 1, odd)),
            ("vr does not point", &|| c::fmi2SetReal(i, vr, HUGE, values)),
            ("vr is a null pointer", &|| {
                c::fmi2GetInteger(i, ptr::null(), 1, ptr::null_mut())
            }),
            ("vr does not point", &|| {
                c::fmi2SetString(i, vr, HUGE, ptr::null())
            }),
            ("order is a null pointer", &|| {
                c::fmi2SetRealInputDerivatives(i, vr, 1, ptr::null(), values)
            }),
            ("value is a null pointer", &|| {
                c::fmi2SetRealInputDerivatives(i, vr, 1, order, null)
            }),
            ("order is a null pointer", &|| {
                c::fmi2GetRealOutputDerivatives(i, vr, 1, ptr::null(), values)
            }),
            ("value does not point", &|| {
                c::fmi2GetRealOutputDerivatives(i, vr, 1, order, odd)
            }),
            ("vUnknown_ref is a null pointer", &|| {
                c::fmi2GetDirectionalDerivative(i, ptr::null(), 1, vr, 1, values, values.add(1))
            }),
            ("vKnown_ref does not point", &|| {
                c::fmi2GetDirectionalDerivative(i, vr, 1, vr, HUGE, values, values.add(1))
            }),
            ("dvKnown is a null pointer", &|| {
                c::fmi2GetDirectionalDerivative(i, vr, 1, vr, 1, null, values)
            }),
            ("dvUnknown is a null pointer", &|| {
                c::fmi2GetDirectionalDerivative(i, vr, 1, vr, 1, values, null)
            }),
            ("value is a null pointer", &|| {
                c::fmi2GetRealStatus(i, c::LAST_SUCCESSFUL_TIME, null)
            }),
            ("value does not point", &|| {
                c::fmi2GetBooleanStatus(i, c::TERMINATED, odd.cast::<c_int>())
            }),
        ]
    };
    for (expected, call) in calls {
        let message = instance.refused(|_| call());
        assert!(message.contains(expected), "{message} {expected}");
    }
    assert_eq!(value, [0.0; 2]);
    // nothing is behind an array of length zero
    // SAFETY: nothing is read or written
    unsafe {
        assert_eq!(c::fmi2GetReal(i, ptr::null(), 0, null), c::OK);
        assert_eq!(c::fmi2SetReal(i, ptr::null(), 0, null), c::OK);
        assert_eq!(c::fmi2GetString(i, ptr::null(), 0, ptr::null_mut()), c::OK);
        assert_eq!(c::fmi2SetBoolean(i, ptr::null(), 0, ptr::null()), c::OK);
    }
}

#[test]
fn bad_arrays_are_refused_in_model_exchange() {
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    let i = instance.handle;
    let mut value = [0.0_f64; 2];
    let odd = value
        .as_mut_ptr()
        .cast::<u8>()
        .wrapping_add(1)
        .cast::<f64>();
    let null = ptr::null_mut::<f64>();
    let mut flag = 7;
    let flag = &raw mut flag;
    // SAFETY: the functions have to refuse all these before they look behind a pointer
    let calls: [(&str, &dyn Fn() -> c_int); 10] = unsafe {
        [
            ("x is a null pointer", &|| {
                c::fmi2SetContinuousStates(i, null, 4)
            }),
            ("x does not point", &|| {
                c::fmi2GetContinuousStates(i, odd, 4)
            }),
            ("nx is 3, expected 4", &|| {
                c::fmi2SetContinuousStates(i, [0.0; 3].as_ptr(), 3)
            }),
            ("derivatives is a null pointer", &|| {
                c::fmi2GetDerivatives(i, null, 4)
            }),
            ("derivatives does not point", &|| {
                c::fmi2GetDerivatives(i, null.wrapping_add(8), HUGE)
            }),
            ("nx is 0, expected 4", &|| {
                c::fmi2GetNominalsOfContinuousStates(i, null, 0)
            }),
            ("ni is 1, expected 0", &|| {
                c::fmi2GetEventIndicators(i, null, 1)
            }),
            ("enterEventMode is a null pointer", &|| {
                c::fmi2CompletedIntegratorStep(i, 1, ptr::null_mut(), flag)
            }),
            ("terminateSimulation is a null pointer", &|| {
                c::fmi2CompletedIntegratorStep(i, 1, flag, ptr::null_mut())
            }),
            ("fmi2eventInfo is a null pointer", &|| {
                c::fmi2NewDiscreteStates(i, ptr::null_mut())
            }),
        ]
    };
    for (expected, call) in calls {
        let message = instance.refused(|_| call());
        assert!(message.contains(expected), "{message} {expected}");
    }
    let message = instance.refused(|i| {
        // SAFETY: refused before it is written to
        unsafe { c::fmi2NewDiscreteStates(i.handle, odd.cast()) }
    });
    assert!(
        message.contains("fmi2eventInfo does not point"),
        "{message}"
    );
}

#[test]
fn variables_of_other_types_are_refused_by_name() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let i = instance.handle;
    let (vr, none) = ([vr::A_F], [vr::NONE]);
    let (mut number, mut text) = (7, ptr::null::<c_char>());
    let (number, text) = (&raw mut number, &raw mut text);
    // SAFETY: all pointers are to locals
    unsafe {
        type Call<'a> = &'a dyn Fn(*const u32) -> c_int;
        let calls: [(&str, &str, Call<'_>); 6] = [
            ("fmi2GetInteger", "Integer", &|vr| {
                c::fmi2GetInteger(i, vr, 1, number)
            }),
            ("fmi2GetBoolean", "Boolean", &|vr| {
                c::fmi2GetBoolean(i, vr, 1, number)
            }),
            ("fmi2GetString", "String", &|vr| {
                c::fmi2GetString(i, vr, 1, text)
            }),
            ("fmi2SetInteger", "Integer", &|vr| {
                c::fmi2SetInteger(i, vr, 1, number)
            }),
            ("fmi2SetBoolean", "Boolean", &|vr| {
                c::fmi2SetBoolean(i, vr, 1, number)
            }),
            ("fmi2SetString", "String", &|vr| {
                c::fmi2SetString(i, vr, 1, text)
            }),
        ];
        for (function, asked, call) in calls {
            let message = instance.refused(|_| call(vr.as_ptr()));
            assert_eq!(
                message,
                format!(
                    "{function}: variable a.F is of type Real, not {asked}; use the Real function"
                )
            );
            let message = instance.refused(|_| call(none.as_ptr()));
            assert!(
                message.contains("value reference 52 does not exist"),
                "{message}"
            );
        }
    }
    // SAFETY: both are locals
    assert_eq!(unsafe { (*number, *text) }, (7, ptr::null()));
}

#[test]
fn numbers_and_references_are_checked() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    for (references, values, expected) in [
        (
            [vr::A_F, vr::B_F],
            [1.0, f64::NAN],
            "variable b.F cannot be set to NaN",
        ),
        (
            [vr::A_F, vr::B_F],
            [f64::INFINITY, 1.0],
            "variable a.F cannot be set to inf",
        ),
        (
            [vr::A_F, vr::NONE],
            [1.0, 1.0],
            "value reference 52 does not exist",
        ),
        (
            [vr::A_F, u32::MAX],
            [1.0, 1.0],
            "value reference 4294967295 does not exist",
        ),
        (
            [vr::A_F, vr::A_THETA],
            [1.0, 1.0],
            "value reference 2 does not exist",
        ),
        (
            [vr::A_F, vr::TIME],
            [1.0, 1.0],
            "time is the independent variable and cannot be set",
        ),
        (
            [vr::A_F, vr::JOINT_F],
            [1.0, 1.0],
            "joint.F is a calculated output and cannot be set",
        ),
    ] {
        let message = instance.refused(|i| i.set(&references, &values));
        assert!(message.contains(expected), "{message}");
    }
    let message = instance.refused(|i| status_of(i.try_get(&[vr::A_F, 1 << 31])));
    assert!(
        message.contains("value reference 2147483648 does not exist"),
        "{message}"
    );
    // all or none
    assert_eq!(instance.get([vr::A_F, vr::B_F]), [0.0, 0.0]);
}

#[test]
fn numbers_that_a_solver_tries_in_vain_are_discarded() {
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    let mut discarded = |call: &dyn Fn(&mut Instance) -> c_int, expected: &str| {
        let before = instance.state_bytes();
        assert_eq!(call(&mut instance), c::DISCARD);
        assert!(instance.state_bytes() == before);
        let message = instance.message(c::DISCARD);
        assert!(message.contains(expected), "{message}");
    };
    discarded(
        &|i| i.set_states(&[0.0, f64::NAN, 0.0, 0.0]),
        "fmi2SetContinuousStates: variable a.v cannot be set to NaN",
    );
    discarded(
        &|i| i.set(&[vr::A_F], &[f64::NEG_INFINITY]),
        "fmi2SetReal: variable a.F cannot be set to -inf",
    );
    // a state that is finite, and a derivative that is not
    assert_eq!(instance.set_states(&[1e305, 0.0, -1e305, 0.0]), c::OK);
    let mut discarded = |call: &dyn Fn(&mut Instance) -> c_int, expected: &str| {
        assert_eq!(call(&mut instance), c::DISCARD);
        let message = instance.message(c::DISCARD);
        assert!(message.contains(expected), "{message}");
    };
    discarded(
        &|i| status_of(i.read(c::fmi2GetDerivatives, 4)),
        "fmi2GetDerivatives: variable a.acceleration overflows",
    );
    discarded(
        &|i| status_of(i.try_get(&[vr::ENERGY])),
        "fmi2GetReal: variable energy.stored overflows",
    );
    // without logging a solver may try in silence; errors are still told
    // SAFETY: the instance lives
    unsafe { c::fmi2SetDebugLogging(instance.handle, 0, 0, ptr::null()) };
    assert_eq!(instance.read(c::fmi2GetDerivatives, 4), Err(c::DISCARD));
    assert_eq!(instance.take_log(), []);
    assert_eq!(instance.set_states(&[1e-5, 0.0, 0.0, 0.0]), c::OK);
    assert!(instance.read(c::fmi2GetDerivatives, 4).is_ok());
    // in Co-Simulation, where no solver asks, the same are errors
    let mut stepping = Instance::stepping(Kind::Lap, 1, &[]);
    stepping.refused(|i| i.set(&[vr::A_F], &[f64::NAN]));
    assert_eq!(stepping.set(&[vr::A_F], &[f64::MAX]), c::OK);
    assert_eq!(stepping.set(&[vr::A_MASS], &[1e-10]), c::OK);
    stepping.refused(|i| status_of(i.try_get(&[vr::A_ACCELERATION])));
}

#[test]
fn bad_states_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let i = instance.handle;
    let saved = instance.save();
    let size = instance.serialize(saved).len();
    let mut memory = [0_u64; 64];
    let foreign: *mut c_void = memory.as_mut_ptr().cast();
    let mut bytes = vec![0_u8; size + 1];
    let bytes = bytes.as_mut_ptr();
    let (mut number, mut variable, mut new) = (0, foreign, ptr::null_mut::<c_void>());
    let (number, variable, new) = (&raw mut number, &raw mut variable, &raw mut new);
    let null = ptr::null_mut::<c_void>();
    // SAFETY: pointers are null or to living memory of the size that is told, or a length says otherwise and is refused
    let calls: [(&str, &dyn Fn() -> c_int); 14] = unsafe {
        [
            ("FMUState is a null", &|| {
                c::fmi2GetFMUstate(i, ptr::null_mut())
            }),
            ("not made by this library", &|| {
                c::fmi2GetFMUstate(i, variable)
            }),
            ("FMUState is a null", &|| c::fmi2SetFMUstate(i, null)),
            ("not made by this library", &|| {
                c::fmi2SetFMUstate(i, foreign)
            }),
            ("not made by this library", &|| {
                c::fmi2FreeFMUstate(i, variable)
            }),
            ("FMUState is a null", &|| {
                c::fmi2SerializedFMUstateSize(i, null, number)
            }),
            ("size is a null", &|| {
                c::fmi2SerializedFMUstateSize(i, saved, ptr::null_mut())
            }),
            ("argument size is ", &|| {
                c::fmi2SerializeFMUstate(i, saved, bytes, size - 1)
            }),
            ("argument size is ", &|| {
                c::fmi2SerializeFMUstate(i, saved, bytes, size + 1)
            }),
            ("serializedState is a null", &|| {
                c::fmi2SerializeFMUstate(i, saved, ptr::null_mut(), size)
            }),
            ("serializedState is a null", &|| {
                c::fmi2DeSerializeFMUstate(i, ptr::null(), size, new)
            }),
            ("serializedState does not", &|| {
                c::fmi2DeSerializeFMUstate(i, bytes, usize::MAX, new)
            }),
            ("not written by this library", &|| {
                c::fmi2DeSerializeFMUstate(i, bytes, size, new)
            }),
            ("it has 0 bytes", &|| {
                c::fmi2DeSerializeFMUstate(i, bytes, 0, new)
            }),
        ]
    };
    for (expected, call) in calls {
        let message = instance.refused(|_| call());
        assert!(message.contains(expected), "{message} {expected}");
    }
    // SAFETY: null pointers to free are ignored
    unsafe {
        assert_eq!(c::fmi2FreeFMUstate(i, ptr::null_mut()), c::OK);
        assert_eq!(c::fmi2FreeFMUstate(i, new), c::OK);
    }
    // what was refused is still there
    assert_eq!(instance.restore(saved), c::OK);
    instance.free_state(saved);
}
