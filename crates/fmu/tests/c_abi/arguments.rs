//! Arguments that no importer should pass: null, huge and misaligned arrays, variables of other types and numbers.

use std::{
    ffi::{c_char, c_int, c_void},
    ptr,
};

use bolted_joint_importer::header::{fmi2::*, fmi3::*};

use crate::{
    c,
    importer::{Instance, Kind, Make as _, State, vr},
    raw::{BOTH, Fmi2, Fmi3, Interface::CoSimulation, Raw, call, status_of},
    rows::{number, reference, rows},
};

const HUGE: usize = usize::MAX / 2;

#[test]
fn bad_arrays_are_refused() {
    for version in BOTH {
        let mut instance = version.stepping(Kind::Lap, 1, &[]);
        let (vr, order) = ([vr::A_F; 2], [1]);
        let mut value = [0.0_f64; 2];
        let values = value.as_mut_ptr();
        let odd = values.wrapping_byte_add(1);
        let (vr, order, null) = (vr.as_ptr(), order.as_ptr(), ptr::null_mut::<f64>());
        let get = |i: Raw, vr, n, v| call!(i, fmi2GetReal(vr, n, v), fmi3GetFloat64(vr, n, v, n));
        let set = |i: Raw, vr, n, v: *mut f64| {
            call!(i, fmi2SetReal(vr, n, v), fmi3SetFloat64(vr, n, v, n))
        };
        let rates = |i: Raw, vr, order, v| {
            call!(
                i,
                fmi2GetRealOutputDerivatives(vr, 1, order, v),
                fmi3GetOutputDerivatives(vr, 1, order, v, 1)
            )
        };
        // unknowns and knowns with their number, seed, sensitivity
        let slope = |i: Raw, u, k, n, s: *mut f64, v| {
            call!(
                i,
                fmi2GetDirectionalDerivative(u, 1, k, n, s, v),
                fmi3GetDirectionalDerivative(u, 1, k, n, s, n, v, 1)
            )
        };
        let [of_references, of_values, of_orders] = match version {
            Fmi2 => ["vr", "value", "order"],
            Fmi3 => ["valueReferences", "values", "orders"],
        };
        let [of_unknowns, of_knowns, of_seed, of_sensitivity] = match version {
            Fmi2 => ["vUnknown_ref", "vKnown_ref", "dvKnown", "dvUnknown"],
            Fmi3 => ["unknowns", "knowns", "seed", "sensitivity"],
        };
        let is_null = |argument| format!("argument {argument} is a null pointer");
        let is_none = |argument| format!("argument {argument} does not point to an array");
        let (no_references, no_values) = (is_null(of_references), is_null(of_values));
        let (bad_references, bad_values) = (is_none(of_references), is_none(of_values));
        type Access<'a> = &'a dyn Fn(Raw, *const u32, usize, *mut f64) -> c_int;
        for access in [&get as Access<'_>, &set] {
            instance.refused_all(&[
                (&no_references, &|i| access(i, ptr::null(), 1, values)),
                (&no_values, &|i| access(i, vr, 1, null)),
                (&bad_values, &|i| access(i, vr, 1, odd)),
                (&bad_references, &|i| access(i, vr, HUGE, values)),
                (&bad_references, &|i| access(i, vr, usize::MAX, values)),
                (&bad_references, &|i| access(i, vr, usize::MAX / 6, values)),
            ]);
            // nothing is behind an array of length zero
            c::ok(access(instance.raw, ptr::null(), 0, null));
        }
        instance.refused_all(&[
            (&no_references, &|i| {
                let (none, v) = (ptr::null(), ptr::null_mut());
                call!(i, fmi2GetInteger(none, 1, v), fmi3GetInt32(none, 1, v, 1))
            }),
            (&bad_references, &|i| {
                let none = ptr::null();
                call!(
                    i,
                    fmi2SetString(vr, HUGE, none),
                    fmi3SetString(vr, HUGE, none, HUGE)
                )
            }),
            (&is_null(of_orders), &|i| rates(i, vr, ptr::null(), values)),
            (&no_references, &|i| rates(i, ptr::null(), order, values)),
            (&no_values, &|i| rates(i, vr, order, null)),
            (&bad_values, &|i| rates(i, vr, order, odd)),
            (&is_null(of_unknowns), &|i| {
                slope(i, ptr::null(), vr, 1, values, values)
            }),
            (&is_none(of_knowns), &|i| {
                slope(i, vr, vr, HUGE, values, values)
            }),
            (&is_null(of_seed), &|i| slope(i, vr, vr, 1, null, values)),
            (&is_null(of_sensitivity), &|i| {
                slope(i, vr, vr, 1, values, null)
            }),
        ]);
        match version {
            Fmi2 => instance.refused_all(&[
                (
                    &is_null(of_orders),
                    &|i| call!(@one i, fmi2SetRealInputDerivatives(vr, 1, ptr::null(), values)),
                ),
                (
                    &no_values,
                    &|i| call!(@one i, fmi2SetRealInputDerivatives(vr, 1, order, null)),
                ),
                (
                    &no_values,
                    &|i| call!(@one i, fmi2GetRealStatus(LAST_SUCCESSFUL_TIME, null)),
                ),
                (
                    &bad_values,
                    &|i| call!(@one i, fmi2GetBooleanStatus(TERMINATED, odd.cast())),
                ),
            ]),
            Fmi3 => {
                for (count, of_values) in [(2, 1), (1, 2), (0, 1)] {
                    let expected = format!("argument nValues is {of_values}, expected {count}");
                    instance.refused_all(&[
                        (
                            &expected,
                            &|i| call!(@one i, fmi3GetFloat64(vr, count, values, of_values)),
                        ),
                        (
                            &expected,
                            &|i| call!(@one i, fmi3SetFloat64(vr, count, values, of_values)),
                        ),
                    ]);
                }
                instance.refused_all(&[
                    ("argument nValues is 0, expected 1", &|i| {
                        call!(@one i, fmi3GetOutputDerivatives(vr, 1, order, values, 0))
                    }),
                    ("argument nSensitivity is 2, expected 1", &|i| {
                        call!(@one i, fmi3GetDirectionalDerivative(vr, 1, vr, 2, values, 2, values, 2))
                    }),
                    ("argument nSensitivity is 1, expected 2", &|i| {
                        call!(@one i, fmi3GetAdjointDerivative(vr, 1, vr, 2, values, 1, values, 1))
                    }),
                    (&is_null(of_unknowns), &|i| {
                        let none = ptr::null();
                        call!(@one i, fmi3GetAdjointDerivative(none, 1, vr, 1, values, 1, values, 1))
                    }),
                ]);
            }
        }
        assert_eq!(value, [0.0; 2]);
        let (none, nothing) = (ptr::null(), ptr::null_mut());
        c::ok(call!(
            instance,
            fmi2GetString(none, 0, nothing),
            fmi3GetString(none, 0, nothing, 0)
        ));
        let nothing = ptr::null();
        c::ok(call!(
            instance,
            fmi2SetBoolean(none, 0, nothing),
            fmi3SetBoolean(none, 0, nothing.cast(), 0)
        ));
    }
}

#[test]
fn bad_arrays_are_refused_in_model_exchange() {
    for version in BOTH {
        let mut instance = version.continuous(Kind::Lap, 1, &[]);
        let mut value = [0.0_f64; 5];
        let (three, odd) = (value.as_mut_ptr(), value.as_mut_ptr().wrapping_byte_add(1));
        let null = ptr::null_mut::<f64>();
        let (mut flag2, mut flag3) = (7, 7);
        let (flag2, flag3) = (&raw mut flag2, &raw mut flag3);
        let [of_states, of_count, of_nominals] = match version {
            Fmi2 => ["x", "nx", "x_nominal"],
            Fmi3 => ["continuousStates", "nContinuousStates", "nominals"],
        };
        let is_null = |argument| format!("argument {argument} is a null pointer");
        let is_none = |argument| format!("argument {argument} does not point to an array");
        let set = |i: Raw, x: *mut f64, n| {
            call!(i, fmi2SetContinuousStates | fmi3SetContinuousStates(x, n))
        };
        let states =
            |i: Raw, x, n| call!(i, fmi2GetContinuousStates | fmi3GetContinuousStates(x, n));
        let rates = |i: Raw, x, n| {
            call!(
                i,
                fmi2GetDerivatives | fmi3GetContinuousStateDerivatives(x, n)
            )
        };
        let nominals = |i: Raw, x, n| {
            call!(
                i,
                fmi2GetNominalsOfContinuousStates | fmi3GetNominalsOfContinuousStates(x, n)
            )
        };
        let complete = |i: Raw, event: bool, end: bool| {
            let pick2 = |given| if given { flag2 } else { ptr::null_mut() };
            let pick3 = |given| if given { flag3 } else { ptr::null_mut() };
            call!(
                i,
                fmi2CompletedIntegratorStep(1, pick2(event), pick2(end)),
                fmi3CompletedIntegratorStep(1, pick3(event), pick3(end))
            )
        };
        let count = |found| format!("argument {of_count} is {found}, expected 4");
        instance.refused_all(&[
            (&is_null(of_states), &|i| set(i, null, 4)),
            (&count(3), &|i| set(i, three, 3)),
            (&count(5), &|i| set(i, three, 5)),
            (&is_none(of_states), &|i| states(i, odd, 4)),
            (&is_null(of_states), &|i| states(i, null, 4)),
            (&count(8), &|i| status_of(i.try_states(8))),
            (&is_null("derivatives"), &|i| rates(i, null, 4)),
            (&is_none("derivatives"), &|i| {
                rates(i, null.wrapping_add(8), HUGE)
            }),
            (&count(8), &|i| status_of(i.try_derivatives(8))),
            (&is_null(of_nominals), &|i| nominals(i, null, 4)),
            (&count(0), &|i| nominals(i, null, 0)),
            (&count(8), &|i| status_of(i.try_nominals(8))),
            ("is 1, expected 0: there are no event indicators", &|i| {
                call!(i, fmi2GetEventIndicators | fmi3GetEventIndicators(null, 1))
            }),
            (&is_null("enterEventMode"), &|i| complete(i, false, true)),
            (&is_null("terminateSimulation"), &|i| {
                complete(i, true, false)
            }),
        ]);
        match version {
            Fmi2 => instance.refused_all(&[
                (
                    &is_null("fmi2eventInfo"),
                    &|i| call!(@one i, fmi2NewDiscreteStates(ptr::null_mut())),
                ),
                (
                    &is_none("fmi2eventInfo"),
                    &|i| call!(@one i, fmi2NewDiscreteStates(odd.cast())),
                ),
            ]),
            Fmi3 => instance.refused_all(&[
                (
                    &is_null(of_count),
                    &|i| call!(@one i, fmi3GetNumberOfContinuousStates(ptr::null_mut())),
                ),
                (
                    &is_null("nEventIndicators"),
                    &|i| call!(@one i, fmi3GetNumberOfEventIndicators(ptr::null_mut())),
                ),
            ]),
        }
        instance.refuses(|i| i.set_time(f64::INFINITY), "time is inf");
    }
}

#[test]
fn null_results_of_a_step_are_refused() {
    let (mut flag, mut time) = (7, 0.0);
    let (flag, time) = (&raw mut flag, &raw mut time);
    let none = ptr::null_mut();
    for (event, end, early, last, expected) in [
        (none, flag, flag, time, "eventHandlingNeeded"),
        (flag, none, flag, time, "terminateSimulation"),
        (flag, flag, none, time, "earlyReturn"),
        (flag, flag, flag, ptr::null_mut(), "lastSuccessfulTime"),
    ] {
        let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
        let expected = format!("argument {expected} is a null pointer");
        instance.refused_all(&[(
            &expected,
            &|i| call!(@one i, fmi3DoStep(0.0, 1e-3, 1, event, end, early, last)),
        )]);
    }
}

#[test]
fn variables_of_other_types_are_refused_by_name() {
    for version in BOTH {
        let mut instance = version.stepping(Kind::Lap, 1, &[]);
        let (mut number, mut text, mut byte) = (7, ptr::null::<c_char>(), 7_u8);
        let (number, text, byte) = (&raw mut number, &raw mut text, &raw mut byte);
        let (sizes, values) = (ptr::null_mut::<usize>(), ptr::null_mut());
        let own = match version {
            Fmi2 => "Real",
            Fmi3 => "Float64",
        };
        macro_rules! refuse {
            ($($function:ident as $asked:literal: $($argument:expr),*;)*) => {{$(
                let get = |i: Raw, vr: *const u32| call!(@one i, $function(vr, 1, $($argument),*));
                let message = instance.refused(|i| get(i, [vr::A_F].as_ptr()));
                let function = stringify!($function);
                assert_eq!(
                    message,
                    format!("{function}: variable a.F is of type {own}, not {}; use the {own} function", $asked)
                );
                instance.refuses(|i| get(i, [vr::NONE].as_ptr()), "value reference 52 does not exist");
            )*}};
        }
        match version {
            Fmi2 => refuse! {
                fmi2GetInteger as "Integer": number;
                fmi2GetBoolean as "Boolean": number;
                fmi2GetString as "String": text;
                fmi2SetInteger as "Integer": number;
                fmi2SetBoolean as "Boolean": number;
                fmi2SetString as "String": text;
            },
            Fmi3 => refuse! {
                fmi3GetInt32 as "Int32": number, 1;
                fmi3SetBoolean as "Boolean": byte, 1;
                fmi3GetString as "String": text, 1;
                fmi3GetBinary as "Binary": sizes, values, 1;
                fmi3GetClock as "Clock": byte;
            },
        }
        // SAFETY: all are locals
        assert_eq!(unsafe { (*number, *text, *byte) }, (7, ptr::null(), 7));
        let (none, nothing) = (ptr::null(), ptr::null_mut());
        c::ok(call!(
            instance,
            fmi2GetInteger(none, 0, nothing),
            fmi3GetInt32(none, 0, nothing, 0)
        ));
        if version == Fmi3 {
            let nothing = ptr::null_mut();
            c::ok(call!(@one instance, fmi3GetClock(none, 0, nothing)));
        }
        assert_eq!(instance.take_log(), []);
    }
}

#[test]
fn setting_is_all_or_nothing() {
    const REFUSED: &str = "
        b.F        | NaN  | variable b.F cannot be set to NaN
        b.F        | inf  | variable b.F cannot be set to inf
        b.F        | -inf | variable b.F cannot be set to -inf
        52         | 1    | value reference 52 does not exist
        4294967295 | 1    | value reference 4294967295 does not exist
        time       | 1    | variable time is the independent variable and cannot be set in state Initialization Mode
        joint.F    | 1    | variable joint.F is a calculated output and cannot be set
    ";
    for version in BOTH {
        for [name, value, expected] in rows(REFUSED) {
            let mut instance = version.instance(CoSimulation, Kind::Lap, 2, &[]);
            instance.go_to(State::Initialization);
            let all: Vec<u32> = (0..vr::NONE).collect();
            let before = instance.try_get(&all).unwrap();
            let references = [vr::A_F, vr::K_YY, reference(name)];
            let values = [5.0, 6.0, number(value)];
            instance.refuses(|i| i.set(&references, &values), expected);
            assert_eq!(instance.try_get(&all).unwrap(), before);
        }
        // states are set before and in initialisation only
        let mut instance = version.stepping(Kind::Lap, 1, &[]);
        instance.refuses(
            |i| i.set(&[vr::A_F, vr::A_Y], &[5.0, 1e-3]),
            "variable a.y is a state and cannot be set in state Step Mode",
        );
        // nor is a rotation of a joint that has none
        instance.refuses(
            |i| i.set(&[vr::A_F, vr::A_THETA], &[1.0, 1.0]),
            "value reference 2 does not exist",
        );
        assert_eq!(instance.get([vr::A_F, vr::A_Y]), [0.0, 0.0]);
    }
}

#[test]
fn numbers_that_a_solver_tries_in_vain_are_discarded() {
    let mut instance = Fmi2.continuous(Kind::Lap, 1, &[]);
    let mut discarded = |stays: bool, call: &dyn Fn(Raw) -> c_int, expected: &str| {
        let before = stays.then(|| instance.state_bytes());
        assert_eq!(call(instance.raw), c::DISCARD);
        assert!(before.is_none_or(|before| instance.state_bytes() == before));
        let message = instance.message(c::DISCARD);
        assert!(message.contains(expected), "{message}");
    };
    discarded(
        true,
        &|i| i.set_states(&[0.0, f64::NAN, 0.0, 0.0]),
        "fmi2SetContinuousStates: variable a.v cannot be set to NaN",
    );
    discarded(
        true,
        &|i| i.set(&[vr::A_F], &[f64::NEG_INFINITY]),
        "fmi2SetReal: variable a.F cannot be set to -inf",
    );
    // a state that is finite, and a derivative that is not
    discarded(
        false,
        &|i| {
            c::ok(i.set_states(&[1e305, 0.0, -1e305, 0.0]));
            status_of(i.try_derivatives(4))
        },
        "fmi2GetDerivatives: variable a.acceleration overflows",
    );
    discarded(
        false,
        &|i| status_of(i.try_get(&[vr::ENERGY])),
        "fmi2GetReal: variable energy.stored overflows",
    );
    // without logging a solver may try in silence; errors are still told
    c::ok(instance.switch_logging(false, &[]));
    assert_eq!(instance.try_derivatives(4), Err(c::DISCARD));
    assert_eq!(instance.take_log(), []);
    c::ok(instance.set_states(&[1e-5, 0.0, 0.0, 0.0]));
    assert!(instance.try_derivatives(4).is_ok());
    // in Co-Simulation, where no solver asks, the same are errors
    let mut stepping = Fmi2.stepping(Kind::Lap, 1, &[]);
    stepping.refused(|i| i.set(&[vr::A_F], &[f64::NAN]));
    c::ok(stepping.set(&[vr::A_F], &[f64::MAX]));
    c::ok(stepping.set(&[vr::A_MASS], &[1e-10]));
    stepping.refused(|i| status_of(i.try_get(&[vr::A_ACCELERATION])));
    // and with FMI 3.0, which has no such answer
    let mut exchanging = Fmi3.continuous(Kind::Lap, 1, &[]);
    exchanging.refuses(
        |i| i.set_states(&[0.0, f64::NAN, 0.0, 0.0]),
        "variable a.v cannot be set to NaN",
    );
}

#[test]
fn bad_states_are_refused() {
    for version in BOTH {
        let mut instance = version.stepping(Kind::Lap, 1, &[]);
        let saved = instance.save();
        let before = instance.serialize(saved);
        let size = before.len();
        let mut memory = [0_u64; 64];
        let foreign: *mut c_void = memory.as_mut_ptr().cast();
        // no memory can be read there
        let nowhere: *mut c_void = ptr::without_provenance_mut(64);
        let freed = instance.save();
        instance.free_state(freed);
        let mut content = vec![0_u8; size + 1];
        let bytes = content.as_mut_ptr();
        let (mut number, mut variable, mut new) = (0, foreign, ptr::null_mut::<c_void>());
        let (number, variable, new) = (&raw mut number, &raw mut variable, &raw mut new);
        let (null, none) = (ptr::null_mut::<c_void>(), ptr::null_mut());
        let get = |i: Raw, state| call!(i, fmi2GetFMUstate | fmi3GetFMUState(state));
        let free = |i: Raw, state| call!(i, fmi2FreeFMUstate | fmi3FreeFMUState(state));
        let measure = |i: Raw, state, size| {
            call!(
                i,
                fmi2SerializedFMUstateSize | fmi3SerializedFMUStateSize(state, size)
            )
        };
        let write = |i: Raw, bytes, size| {
            call!(
                i,
                fmi2SerializeFMUstate | fmi3SerializeFMUState(saved, bytes, size)
            )
        };
        let read = |i: Raw, bytes: *mut u8, size, state| {
            call!(
                i,
                fmi2DeSerializeFMUstate | fmi3DeserializeFMUState(bytes, size, state)
            )
        };
        instance.refused_all(&[
            ("argument FMUState is a null pointer", &|i| get(i, none)),
            ("was not made by this library", &|i| get(i, variable)),
            ("argument FMUState is a null pointer", &|i| i.restore(null)),
            ("was not made by this library", &|i| i.restore(foreign)),
            ("was not made by this library", &|i| i.restore(nowhere)),
            ("or is already freed", &|i| i.restore(freed)),
            ("or is already freed", &|i| measure(i, freed, number)),
            ("was not made by this library", &|i| free(i, variable)),
            ("argument FMUState is a null pointer", &|i| {
                measure(i, null, number)
            }),
            ("argument size is a null pointer", &|i| {
                measure(i, saved, ptr::null_mut())
            }),
            ("argument size is ", &|i| write(i, bytes, size - 1)),
            ("argument size is ", &|i| write(i, bytes, size + 1)),
            ("argument serializedState is a null pointer", &|i| {
                write(i, ptr::null_mut(), size)
            }),
            ("argument serializedState is a null pointer", &|i| {
                read(i, ptr::null_mut(), size, new)
            }),
            ("argument serializedState does not point", &|i| {
                read(i, bytes, usize::MAX, new)
            }),
            ("not written by this library", &|i| {
                read(i, bytes, size, new)
            }),
            ("it has 0 bytes", &|i| read(i, bytes, 0, new)),
            ("it has 0 bytes", &|i| read(i, bytes, 0, none)),
        ]);
        assert!(content.iter().all(|&byte| byte == 0));
        assert_eq!(instance.state_bytes(), before);
        // nothing to free is fine
        c::ok(free(instance.raw, none));
        c::ok(free(instance.raw, new));
        // what was refused is still there
        c::ok(instance.restore(saved));
        instance.free_state(saved);
    }
}
