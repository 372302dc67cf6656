//! Saved states: bit-exact continuation, exchange between instances, states of other FMUs, damaged bytes.

use crate::{
    c,
    importer::{Folder, Instance, Kind, Make as _, Request, State, TOKEN, start_text, vr},
    raw::{
        BOTH, Fmi2, Fmi3, FmiVersion,
        Interface::{self, CoSimulation, ModelExchange},
        Raw, seal, status_of,
    },
};

const SEEN: [u32; 8] = [
    vr::TIME,
    vr::A_Y,
    vr::A_V,
    vr::B_Y,
    vr::B_V,
    vr::A_F,
    vr::JOINT_F,
    vr::ENERGY,
];

/// Versions and interface types.
const MACHINES: [(FmiVersion, Interface); 4] = [
    (Fmi2, CoSimulation),
    (Fmi2, ModelExchange),
    (Fmi3, CoSimulation),
    (Fmi3, ModelExchange),
];

/// Ten steps under a changing load, with FMI 2.0 along its derivatives, and with a parameter that is tuned on the way.
fn step_on(instance: Raw) -> Vec<[u64; 8]> {
    let [mut t] = instance.get([vr::TIME]);
    (0..10)
        .map(|n| {
            let load = 100.0 * f64::from(n).sin();
            match instance.version {
                Fmi3 => c::ok(instance.set(&[vr::A_F], &[load])),
                Fmi2 if n % 3 == 1 => {
                    c::ok(instance.set(&[vr::A_F], &[load]));
                    let inputs = [vr::A_F, vr::B_F];
                    let given = instance.set_input_derivatives(&inputs, &[1, 2], &[1e4, -1e8]);
                    c::ok(given);
                }
                Fmi2 => {}
            }
            if n == 5 {
                c::ok(instance.set(&[vr::K_YY], &[4.4e6]));
            }
            c::ok(instance.step(t, 3e-4));
            t += 3e-4;
            instance.get(SEEN).map(f64::to_bits)
        })
        .collect()
}

/// Semi-implicit Euler steps are enough: the same arithmetic outside, the same numbers from the FMU.
fn integrate_on(instance: Raw) -> Vec<[u64; 8]> {
    let [mut t] = instance.get([vr::TIME]);
    (0..20)
        .map(|n| {
            if n == 10 {
                c::ok(instance.enter_event());
                c::ok(instance.set(&[vr::K_YY], &[5e6]));
                c::ok(instance.update());
                c::ok(instance.enter_continuous());
            }
            let mut states = instance.states(8);
            for (state, rate) in states.iter_mut().zip(instance.derivatives(8)) {
                *state += 1e-6 * rate;
            }
            t += 1e-6;
            c::ok(instance.set_time(t));
            c::ok(instance.set_states(&states));
            c::ok(instance.complete_step());
            instance.get(SEEN).map(f64::to_bits)
        })
        .collect()
}

/// From its present point the instance goes the same way again and again, and so does another one.
fn goes_on_to_the_bit(instance: &Instance, interface: Interface, go_on: fn(Raw) -> Vec<[u64; 8]>) {
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    let expected = go_on(instance.raw);
    // the same instance, several times
    for _ in 0..3 {
        c::ok(instance.restore(saved));
        assert_eq!(go_on(instance.raw), expected);
    }
    // another instance, in another state, through bytes
    let changes = [("joint.k_yy", 1.0)];
    let mut other = instance.version.instance(interface, Kind::Lap, 2, &changes);
    let fresh = other.state_bytes();
    let loaded = other.deserialize(&bytes).unwrap();
    assert!(
        other.state_bytes() == fresh,
        "deserialising changes nothing"
    );
    c::ok(other.restore(loaded));
    assert_eq!(go_on(other.raw), expected);
    // and by the handle itself
    c::ok(other.restore(saved));
    assert_eq!(go_on(other.raw), expected);
    other.take_log();
    instance.free_state(saved);
    other.free_state(loaded);
}

#[test]
fn co_simulation_goes_on_to_the_bit() {
    for version in BOTH {
        let instance = version.stepping(Kind::Lap, 2, &[("joint.k3_y", 1e12)]);
        step_on(instance.raw);
        // with a parameter and derivatives that have not yet taken effect
        c::ok(instance.set(&[vr::K3_Y], &[2e12]));
        if version == Fmi2 {
            let given = instance.set_input_derivatives(&[vr::B_M], &[1], &[5e3]);
            c::ok(given);
        }
        goes_on_to_the_bit(&instance, CoSimulation, step_on);
    }
}

#[test]
fn model_exchange_goes_on_to_the_bit() {
    for version in BOTH {
        let instance = version.continuous(Kind::Lap, 2, &[("joint.k3_y", 1e12)]);
        let start = [1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0];
        c::ok(instance.set_time(0.25));
        c::ok(instance.set_states(&start));
        c::ok(instance.set(&[vr::B_M], &[3.0]));
        let point = (instance.states(8), instance.derivatives(8));
        let bytes = instance.state_bytes();
        goes_on_to_the_bit(&instance, ModelExchange, integrate_on);
        let other = version.instance(ModelExchange, Kind::Lap, 2, &[]);
        let loaded = other.deserialize(&bytes).unwrap();
        c::ok(other.restore(loaded));
        other.free_state(loaded);
        assert_eq!(other.get([vr::TIME, vr::B_M]), [0.25, 3.0]);
        assert_eq!((other.states(8), other.derivatives(8)), point);
        // in the same mode, ready to go on
        c::ok(other.complete_step());
        c::ok(other.set_states(&[0.0; 8]));
    }
}

#[test]
fn a_linear_lap_goes_on_to_the_bit_from_every_point() {
    // after some equal steps the library takes one product in their place: a restored state must do so at once
    for dofs in [1, 2] {
        let instance = Instance::stepping(Kind::Lap, dofs, &[]);
        let intervals = |n: u32| if n % 30 < 25 { 3e-4 } else { 1e-4 };
        let step = |instance: &Instance, n: u32| {
            let load = 100.0 * f64::from(n).sin();
            c::ok(instance.set(&[vr::A_F], &[load]));
            let [t] = instance.get([vr::TIME]);
            c::ok(instance.step(t, intervals(n)));
            instance.get(SEEN).map(f64::to_bits)
        };
        let mut points = Vec::new();
        for n in 0..60 {
            points.push((instance.state_bytes(), step(&instance, n)));
        }
        for first in 0..60 {
            let other = Instance::new(Kind::Lap, dofs, &[]);
            let state = other.deserialize(&points[first].0).unwrap();
            c::ok(other.restore(state));
            other.free_state(state);
            for (n, (_, expected)) in points.iter().enumerate().skip(first) {
                assert_eq!(step(&other, n as u32), *expected, "{first} {n}");
            }
        }
    }
}

#[test]
fn a_state_handle_is_used_again() {
    for version in BOTH {
        let instance = version.stepping(Kind::Lap, 1, &[]);
        let mut state = instance.save();
        let first = state;
        c::ok(instance.set(&[vr::A_F], &[7.0]));
        c::ok(instance.step(0.0, 1e-3));
        assert_eq!((instance.save_in(&mut state), state), (c::OK, first));
        let bytes = instance.serialize(state);
        c::ok(instance.set(&[vr::A_F], &[8.0]));
        c::ok(instance.reset());
        c::ok(instance.restore(state));
        assert_eq!(instance.get([vr::A_F, vr::TIME]), [7.0, 1e-3]);
        let read = instance.deserialize_in(&bytes, &mut state);
        assert_eq!((read, state), (c::OK, first));
        instance.free_state(state);
    }
}

#[test]
fn the_time_span_belongs_to_the_state() {
    for version in BOTH {
        let instance = version.instance(CoSimulation, Kind::Lap, 1, &[]);
        match version {
            Fmi2 => c::ok(instance.set_up(2.0, Some(3.0))),
            Fmi3 => c::ok(instance.enter_initialization(2.0, Some(3.0))),
        }
        let bytes = instance.state_bytes();
        let mut other = version.instance(CoSimulation, Kind::Lap, 1, &[]);
        let loaded = other.deserialize(&bytes).unwrap();
        c::ok(other.restore(loaded));
        other.free_state(loaded);
        if version == Fmi2 {
            c::ok(other.enter_set_up());
        }
        c::ok(other.exit_initialization());
        assert_eq!(other.get([vr::TIME]), [2.0]);
        c::ok(other.step(2.0, 1.0));
        other.refuses(|i| i.step(3.0, 1.0), "after stopTime = 3 s");
    }
}

#[test]
fn a_state_whose_outputs_overflow_can_be_saved() {
    let instance = Instance::stepping(Kind::Element, 1, &[("joint.k3_y", 1.0)]);
    c::ok(instance.set(&[vr::A_Y], &[1e200]));
    assert_eq!(instance.try_get(&[vr::JOINT_F]), Err(c::ERROR));
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    let loaded = instance.deserialize(&bytes).unwrap();
    c::ok(instance.restore(loaded));
    assert_eq!(instance.get([vr::A_Y]), [1e200]);
    instance.free_state(saved);
    instance.free_state(loaded);
}

#[test]
fn states_of_another_fmu_are_refused() {
    for (version, interface) in MACHINES {
        let (name, other_interface) = match interface {
            CoSimulation => ("Co-Simulation", ModelExchange),
            ModelExchange => ("Model Exchange", CoSimulation),
        };
        let instance = version.instance(interface, Kind::Lap, 1, &[]);
        let saved = instance.save();
        let bytes = instance.serialize(saved);
        // same interface, another token
        let start = start_text(Kind::Lap, 1, &[]).replace(TOKEN, "another");
        let folder = Folder::with_start(&start);
        let request = Request {
            version,
            interface,
            token: Some("another"),
            ..Request::of(&folder)
        };
        let expected = format!(
            "the FMU state is that of \"lap with 1 DOF a side for {name} of FMI {}.0, token",
            if version == Fmi2 { 2 } else { 3 }
        );
        for mut other in [
            version.instance(interface, Kind::Lap, 2, &[]),
            version.instance(interface, Kind::Element, 1, &[]),
            version.instance(other_interface, Kind::Lap, 1, &[]),
            request.instantiate().unwrap(),
        ] {
            other.refused_all(&[
                (&expected, &|i| i.restore(saved)),
                (&expected, &|i| status_of(i.deserialize(&bytes))),
            ]);
        }
        let mut other = request.instantiate().unwrap();
        other.refuses(|i| i.restore(saved), "token another");
        instance.free_state(saved);
    }
}

#[test]
fn every_damaged_byte_is_noticed() {
    for version in BOTH {
        let mut instance = version.stepping(Kind::Lap, 1, &[]);
        let bytes = instance.state_bytes();
        let mut refuses = |damaged: &[u8], expected: &str| {
            let message = instance.refused(|i| status_of(i.deserialize(damaged)));
            let told = message.split_once("the serialised FMU state cannot be used");
            assert!(
                told.is_some_and(|(_, rest)| rest.contains(expected)),
                "{message}"
            );
        };
        for position in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[position] ^= 0x10;
            refuses(&damaged, "");
            refuses(&bytes[..position], "");
        }
        refuses(&[&bytes[..], &[0]].concat(), "");
        let mut newer = bytes.clone();
        newer[8] += 1;
        let expected = format!(
            "it has layout {}, this library reads layout {}",
            newer[8], bytes[8]
        );
        refuses(&newer, &expected);
        refuses(
            b"something else altogether, and long enough",
            "were not written by this library",
        );
    }
}

#[test]
fn impossible_values_are_refused_even_with_a_right_checksum() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let bytes = instance.state_bytes();
    let forge = |position: usize, content: &[u8]| {
        let mut forged = bytes.clone();
        forged[position..position + content.len()].copy_from_slice(content);
        seal(&mut forged);
        forged
    };
    // mark, layout, length of the token, token, and what makes an FMU; mode, stop time, pace, values, what the
    // joint remembers, inputs, checksum
    let mode = 8 + 4 + 4 + TOKEN.len() + 8;
    let steps_in_a_row = mode + 1 + 1 + 8 + 8;
    let count = steps_in_a_row + 1;
    let first_value = count + 4;
    let values = u32::from_le_bytes(bytes[count..first_value].try_into().unwrap());
    let joint = first_value + 8 * values as usize;
    // this joint remembers nothing
    let inputs = joint + 4;
    assert_eq!(inputs + 9 + 8 * 3 * 47 + 8, bytes.len());
    let step_size_max = first_value + 8 * vr::STEP_SIZE_MAX as usize;
    let loaded = instance.deserialize(&forge(step_size_max, &1e-6_f64.to_le_bytes()));
    instance.free_state(loaded.unwrap());
    let nan = f64::NAN.to_le_bytes();
    let mut refused = |position, content: &[u8], expected: &str| {
        let forged = forge(position, content);
        instance.refuses(|i| status_of(i.deserialize(&forged)), expected);
    };
    let value = "its value of step_size_max is impossible";
    refused(step_size_max, &nan, value);
    let beside = "of what it remembers beside the variables is impossible";
    refused(joint - 8, &f64::INFINITY.to_le_bytes(), beside);
    refused(mode, &[9], "its mode is impossible");
    refused(mode, &[7], "its mode is impossible");
    let step = "its communication step is impossible";
    refused(steps_in_a_row, &[u8::MAX], step);
    // derivatives of what is no input, for no known step, of inputs that are held, or that are no numbers
    let course = "its course of the inputs is impossible";
    refused(inputs + 6, &[0x00, 0x80], course);
    refused(inputs + 8, &[3], course);
    refused(inputs + 9 + 8, &1.0_f64.to_le_bytes(), course);
    refused(
        inputs,
        &[&[0, 0, 0, 0, 0, 0, 0, 0, 1], &nan[..]].concat(),
        course,
    );
    // more or fewer numbers than this build remembers
    for found in [values + 1, values - 1, 0, u32::MAX] {
        let expected = format!(
            "it has {found} values, this library remembers {values}: another build of the library wrote it"
        );
        refused(count, &found.to_le_bytes(), &expected);
    }
}

#[test]
fn states_move_instances_between_all_states() {
    for (version, interface) in MACHINES {
        let states = || {
            State::ALL
                .iter()
                .filter(|state| state.is_of(version, interface))
        };
        let instance_in = |state| {
            let mut instance = version.instance(interface, Kind::Lap, 1, &[]);
            instance.go_to(state);
            instance
        };
        for &from in states() {
            let instance = instance_in(from);
            let saved = instance.save();
            let bytes = instance.serialize(saved);
            for &to in states() {
                let other = instance_in(to);
                c::ok(other.restore(saved));
                assert!(other.state_bytes() == bytes, "{from:?} {to:?}");
            }
            instance.free_state(saved);
        }
    }
}

#[test]
fn states_of_one_version_are_refused_by_the_other() {
    for (own, other, name) in [(Fmi2, Fmi3, "FMI 3.0"), (Fmi3, Fmi2, "FMI 2.0")] {
        let mut instance = own.stepping(Kind::Lap, 1, &[]);
        let foreign = other.stepping(Kind::Lap, 1, &[]);
        let saved = foreign.save();
        let bytes = foreign.serialize(saved);
        let expected = format!("for Co-Simulation of {name}, token");
        instance.refused_all(&[
            (&expected, &|i| i.restore(saved)),
            (&expected, &|i| status_of(i.deserialize(&bytes))),
        ]);
        foreign.free_state(saved);
    }
}
