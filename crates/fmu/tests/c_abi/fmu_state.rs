//! Saved states: bit-exact continuation, exchange between instances, damaged bytes.

use std::{ffi::c_void, ptr};

use crate::{
    c,
    importer::{Folder, Instance, Kind, Request, TOKEN, start_text, text, vr},
};

const ALL: [u32; 8] = [
    vr::TIME,
    vr::A_Y,
    vr::A_V,
    vr::B_Y,
    vr::B_V,
    vr::A_F,
    vr::JOINT_F,
    vr::ENERGY,
];

/// Ten steps under changing load, with a parameter that is tuned on the way.
fn run(instance: &mut Instance, mut t: f64) -> Vec<[u64; 8]> {
    (0..10)
        .map(|n| {
            assert_eq!(
                instance.set(&[vr::A_F], &[100.0 * f64::from(n).sin()]),
                c::OK
            );
            if n == 5 {
                assert_eq!(instance.set(&[vr::K_YY], &[4.4e6]), c::OK);
            }
            assert_eq!(instance.step(t, 3e-4).0, c::OK);
            t += 3e-4;
            instance.get(ALL).map(f64::to_bits)
        })
        .collect()
}

#[test]
fn continuation_is_exact_to_the_bit() {
    let mut instance = Instance::stepping(Kind::Lap, 2, &[("joint.k3_y", 1e12)]);
    run(&mut instance, 0.0);
    let [t] = instance.get([vr::TIME]);
    // with a tuned parameter that has not yet taken effect
    assert_eq!(instance.set(&[vr::K3_Y], &[2e12]), c::OK);
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    let expected = run(&mut instance, t);
    // the same instance, several times
    for _ in 0..3 {
        assert_eq!(instance.restore(saved), c::OK);
        assert_eq!(run(&mut instance, t), expected);
    }
    // another instance, in another state, through bytes
    let mut other = Instance::new(Kind::Lap, 2, &[("joint.k_yy", 1.0)]);
    let loaded = other.deserialize(&bytes).unwrap();
    assert_eq!(
        other.get([vr::TIME, vr::K_YY]),
        [0.0, 1.0],
        "deserialising changes nothing"
    );
    assert_eq!(other.restore(loaded), c::OK);
    assert_eq!(run(&mut other, t), expected);
    // and by the handle itself
    assert_eq!(other.restore(saved), c::OK);
    assert_eq!(run(&mut other, t), expected);
    instance.free_state(saved);
    other.free_state(loaded);
}

#[test]
fn a_linear_lap_goes_on_to_the_bit_from_every_point() {
    // after some equal steps the library takes one product in their place: a restored state must do so at once
    for dofs in [1, 2] {
        let mut instance = Instance::stepping(Kind::Lap, dofs, &[]);
        let intervals = |n: u32| if n % 30 < 25 { 3e-4 } else { 1e-4 };
        let step = |instance: &mut Instance, n: u32| {
            let load = 100.0 * f64::from(n).sin();
            assert_eq!(instance.set(&[vr::A_F], &[load]), c::OK);
            let [t] = instance.get([vr::TIME]);
            assert_eq!(instance.step(t, intervals(n)).0, c::OK);
            instance.get(ALL).map(f64::to_bits)
        };
        let mut points = Vec::new();
        for n in 0..60 {
            points.push((instance.state_bytes(), step(&mut instance, n)));
        }
        for first in 0..60 {
            let mut other = Instance::new(Kind::Lap, dofs, &[]);
            let state = other.deserialize(&points[first].0).unwrap();
            assert_eq!(other.restore(state), c::OK);
            other.free_state(state);
            for (n, (_, expected)) in points.iter().enumerate().skip(first) {
                assert_eq!(step(&mut other, n as u32), *expected, "{first} {n}");
            }
        }
    }
}

#[test]
fn a_state_handle_is_used_again() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let mut state = instance.save();
    let first = state;
    assert_eq!(instance.set(&[vr::A_F], &[7.0]), c::OK);
    // SAFETY: the instance and the state live
    let status = unsafe { c::fmi3GetFMUState(instance.handle, &raw mut state) };
    assert_eq!(status, c::OK);
    assert_eq!(state, first);
    let bytes = instance.serialize(state);
    assert_eq!(instance.set(&[vr::A_F], &[8.0]), c::OK);
    assert_eq!(instance.restore(state), c::OK);
    assert_eq!(instance.get([vr::A_F]), [7.0]);
    // SAFETY: the instance and the state live, the bytes are a slice
    let status = unsafe {
        c::fmi3DeserializeFMUState(instance.handle, bytes.as_ptr(), bytes.len(), &raw mut state)
    };
    assert_eq!((status, state), (c::OK, first));
    instance.free_state(state);
}

#[test]
fn the_stop_time_belongs_to_the_state() {
    let mut instance = Instance::new(Kind::Lap, 1, &[]);
    assert_eq!(instance.enter_initialization(0.0, Some(0.1)), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    instance.free_state(saved);
    let mut other = Instance::new(Kind::Lap, 1, &[]);
    let loaded = other.deserialize(&bytes).unwrap();
    assert_eq!(other.restore(loaded), c::OK);
    let message = other.refused(|i| i.step(0.0, 0.2).0);
    assert!(message.contains("after stopTime = 0.1 s"), "{message}");
    other.free_state(loaded);
}

#[test]
fn a_state_whose_outputs_overflow_can_be_saved() {
    let mut instance = Instance::stepping(Kind::Element, 1, &[("joint.k3_y", 1.0)]);
    assert_eq!(instance.set(&[vr::A_Y], &[1e200]), c::OK);
    assert_eq!(instance.try_get(&[vr::JOINT_F]), Err(c::ERROR));
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    let loaded = instance.deserialize(&bytes).unwrap();
    assert_eq!(instance.restore(loaded), c::OK);
    assert_eq!(instance.get([vr::A_Y]), [1e200]);
    instance.free_state(saved);
    instance.free_state(loaded);
}

#[test]
fn states_of_another_fmu_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    for (kind, dofs) in [(Kind::Lap, 2), (Kind::Element, 1)] {
        let mut other = Instance::new(kind, dofs, &[]);
        let message = other.refused(|i| i.restore(saved));
        assert!(
            message.contains("is that of \"lap with 1 DOF a side"),
            "{message}"
        );
        let message = other.refused(|i| i.deserialize(&bytes).err().unwrap_or(c::OK));
        assert!(
            message.contains("is that of \"lap with 1 DOF a side"),
            "{message}"
        );
    }
    // same interface, another token
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]).replace(TOKEN, "another"));
    let path = text(&folder.0);
    let request = Request {
        token: Some("another"),
        resources: Some(&path),
        ..Request::default()
    };
    let mut other = request.instantiate().unwrap();
    assert_eq!(other.restore(saved), c::ERROR);
    assert!(other.error().contains("token another"));
    assert_eq!(other.deserialize(&bytes), Err(c::ERROR));
    instance.free_state(saved);
}

#[test]
fn every_damaged_byte_is_noticed() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    instance.free_state(saved);
    for position in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[position] ^= 0x10;
        let message = instance.refused(|i| i.deserialize(&damaged).err().unwrap_or(c::OK));
        assert!(
            message.contains("the serialised FMU state cannot be used"),
            "byte {position}: {message}"
        );
    }
    for length in 0..bytes.len() {
        assert_eq!(
            instance.deserialize(&bytes[..length]),
            Err(c::ERROR),
            "{length} bytes"
        );
        instance.error();
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(instance.deserialize(&longer), Err(c::ERROR));
    instance.error();
    let mut newer = bytes.clone();
    newer[8] = 5;
    assert_eq!(instance.deserialize(&newer), Err(c::ERROR));
    assert!(
        instance
            .error()
            .contains("it has layout 5, this library reads layout 4")
    );
    assert_eq!(
        instance.deserialize(b"something else altogether, and long enough"),
        Err(c::ERROR)
    );
    assert!(
        instance
            .error()
            .contains("were not written by this library")
    );
}

#[test]
fn impossible_values_are_refused_even_with_a_right_checksum() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    instance.free_state(saved);
    // before the checksum there are the derivatives of 13 inputs, before them the values; step_size_max comes before
    // 24 others
    let forge = |position: usize, content: &[u8]| {
        let mut forged = bytes.clone();
        forged[position..position + content.len()].copy_from_slice(content);
        let end = forged.len() - 8;
        let hash = forged[..end]
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            });
        forged[end..].copy_from_slice(&hash.to_le_bytes());
        forged
    };
    let inputs = bytes.len() - 8 - (3 + 8 * 3 * 13);
    let step_size_max = inputs - 8 * 25;
    assert!(
        instance
            .deserialize(&forge(step_size_max, &1e-6_f64.to_le_bytes()))
            .map(|state| instance.free_state(state))
            .is_ok()
    );
    assert_eq!(
        instance.deserialize(&forge(step_size_max, &f64::NAN.to_le_bytes())),
        Err(c::ERROR)
    );
    assert!(
        instance
            .error()
            .contains("its value of step_size_max is impossible")
    );
    let mode = 8 + 4 + 4 + TOKEN.len() + 5;
    assert_eq!(instance.deserialize(&forge(mode, &[9])), Err(c::ERROR));
    assert!(instance.error().contains("its mode is impossible"));
    let steps_in_a_row = mode + 1 + 1 + 8 + 8;
    let forged = forge(steps_in_a_row, &[u8::MAX]);
    assert_eq!(instance.deserialize(&forged), Err(c::ERROR));
    let message = instance.error();
    assert!(
        message.contains("its communication step is impossible"),
        "{message}"
    );
    // more or fewer numbers than this build remembers, as another build would write
    let count = steps_in_a_row + 1;
    let values = (inputs - count - 4) / 8;
    for found in [values + 1, values - 1, 0, u32::MAX as usize] {
        let forged = forge(count, &(found as u32).to_le_bytes());
        assert_eq!(instance.deserialize(&forged), Err(c::ERROR));
        let message = instance.error();
        let expected = format!(
            "it has {found} values, this library remembers {values}: another build of the library wrote it"
        );
        assert!(message.contains(&expected), "{message}");
    }
    // what is remembered beside the variables is a finite number, too
    let forged = forge(inputs - 8, &f64::INFINITY.to_le_bytes());
    assert_eq!(instance.deserialize(&forged), Err(c::ERROR));
    let message = instance.error();
    assert!(
        message.contains("of what it remembers beside the variables is impossible"),
        "{message}"
    );
    // derivatives of what is no input, for no known step, of inputs that are held, or that are no numbers
    for (position, content) in [
        (inputs, &[0x00, 0x80][..]),
        (inputs + 2, &[3]),
        (inputs + 3 + 8, &1.0_f64.to_le_bytes()),
        (inputs, &[&[0, 0, 1], &f64::NAN.to_le_bytes()[..]].concat()),
    ] {
        let forged = forge(position, content);
        assert_eq!(instance.deserialize(&forged), Err(c::ERROR));
        let message = instance.error();
        assert!(
            message.contains("its course of the inputs is impossible"),
            "{message}"
        );
    }
    let forged = forge(mode, &[7]);
    assert_eq!(instance.deserialize(&forged), Err(c::ERROR));
    assert!(instance.error().contains("its mode is impossible"));
}

#[test]
fn bad_state_arguments_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let saved = instance.save();
    let before = instance.serialize(saved);
    let size = before.len();
    let mut memory = [0_u64; 64];
    let foreign: *mut c_void = memory.as_mut_ptr().cast();
    let i = instance.handle;
    // SAFETY: all pointers are null or to living memory of the size that is told
    unsafe {
        let null = ptr::null_mut::<c_void>();
        let mut bytes = vec![0_u8; size + 1];
        let mut number = 0;
        let mut foreign_variable = foreign;
        for (status, expected) in [
            (
                c::fmi3GetFMUState(i, ptr::null_mut()),
                "argument FMUState is a null pointer",
            ),
            (
                c::fmi3GetFMUState(i, &raw mut foreign_variable),
                "was not made by this library",
            ),
            (
                c::fmi3SetFMUState(i, null),
                "argument FMUState is a null pointer",
            ),
            (
                c::fmi3SetFMUState(i, foreign),
                "was not made by this library",
            ),
            (
                c::fmi3FreeFMUState(i, &raw mut foreign_variable),
                "was not made by this library",
            ),
            (
                c::fmi3SerializedFMUStateSize(i, null, &raw mut number),
                "argument FMUState is a null pointer",
            ),
            (
                c::fmi3SerializedFMUStateSize(i, saved, ptr::null_mut()),
                "argument size is a null pointer",
            ),
            (
                c::fmi3SerializeFMUState(i, saved, bytes.as_mut_ptr(), size - 1),
                "argument size is ",
            ),
            (
                c::fmi3SerializeFMUState(i, saved, bytes.as_mut_ptr(), size + 1),
                "argument size is ",
            ),
            (
                c::fmi3SerializeFMUState(i, saved, ptr::null_mut(), size),
                "argument serializedState is a null pointer",
            ),
            (
                c::fmi3DeserializeFMUState(i, ptr::null(), size, &raw mut foreign_variable),
                "argument serializedState is a null pointer",
            ),
            (
                c::fmi3DeserializeFMUState(i, bytes.as_ptr(), 0, ptr::null_mut()),
                "has 0 bytes",
            ),
        ]
        .into_iter()
        .zip(
            instance
                .take_log()
                .into_iter()
                .filter(|message| message.status == c::ERROR),
        )
        .map(|((status, expected), message)| (status, (expected, message.text)))
        {
            assert_eq!(status, c::ERROR);
            let (expected, message) = expected;
            assert!(message.contains(expected), "{message}, not {expected}");
        }
        assert!(bytes.iter().all(|&byte| byte == 0));
        assert_eq!(instance.state_bytes(), before);
        // nothing to free is fine
        let mut none = null;
        assert_eq!(c::fmi3FreeFMUState(i, &raw mut none), c::OK);
        assert_eq!(c::fmi3FreeFMUState(i, ptr::null_mut()), c::OK);
    }
    instance.free_state(saved);
}
