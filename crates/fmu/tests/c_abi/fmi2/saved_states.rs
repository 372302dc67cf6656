//! Saved states: bit-exact continuation in Co-Simulation and Model Exchange, bytes, states of other FMUs.

use super::{
    c,
    importer::{Instance, Request, State},
};
use crate::importer::{Folder, Kind, TOKEN, start_text, text, vr};

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

/// Ten steps under a load with derivatives, with a parameter that is tuned on the way.
fn run(instance: &mut Instance, mut t: f64) -> Vec<[u64; 8]> {
    (0..10)
        .map(|n| {
            if n % 3 == 1 {
                assert_eq!(
                    instance.set(&[vr::A_F], &[100.0 * f64::from(n).sin()]),
                    c::OK
                );
                assert_eq!(
                    instance.set_input_derivatives(&[vr::A_F, vr::B_F], &[1, 2], &[1e4, -1e8]),
                    c::OK
                );
            }
            if n == 5 {
                assert_eq!(instance.set(&[vr::K_YY], &[4.4e6]), c::OK);
            }
            assert_eq!(instance.step(t, 3e-4), c::OK);
            t += 3e-4;
            instance.get(SEEN).map(f64::to_bits)
        })
        .collect()
}

#[test]
fn co_simulation_goes_on_to_the_bit() {
    let mut instance = Instance::stepping(Kind::Lap, 2, &[("joint.k3_y", 1e12)]);
    run(&mut instance, 0.0);
    let [t] = instance.get([vr::TIME]);
    // with a parameter and derivatives that have not yet taken effect
    assert_eq!(instance.set(&[vr::K3_Y], &[2e12]), c::OK);
    assert_eq!(
        instance.set_input_derivatives(&[vr::B_M], &[1], &[5e3]),
        c::OK
    );
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    let expected = run(&mut instance, t);
    for _ in 0..2 {
        assert_eq!(instance.restore(saved), c::OK);
        assert_eq!(run(&mut instance, t), expected);
    }
    let mut other = Instance::new(c::CO_SIMULATION, Kind::Lap, 2, &[("joint.k_yy", 1.0)]);
    let loaded = other.deserialize(&bytes).unwrap();
    assert_eq!(other.restore(loaded), c::OK);
    assert_eq!(run(&mut other, t), expected);
    instance.free_state(saved);
    other.free_state(loaded);
}

#[test]
fn model_exchange_goes_on_to_the_bit() {
    // semi-implicit Euler steps are enough: the same arithmetic outside, the same numbers from the FMU
    let run = |instance: &mut Instance, mut t: f64| -> Vec<u64> {
        let mut seen = Vec::new();
        for n in 0..20 {
            if n == 10 {
                assert_eq!(instance.enter_event(), c::OK);
                assert_eq!(instance.set(&[vr::K_YY], &[5e6]), c::OK);
                assert_eq!(instance.new_discrete_states(), c::OK);
                assert_eq!(instance.enter_continuous_time(), c::OK);
            }
            let rates = instance.read(c::fmi2GetDerivatives, 8).unwrap();
            let mut states = instance.read(c::fmi2GetContinuousStates, 8).unwrap();
            for (state, rate) in states.iter_mut().zip(rates) {
                *state += 1e-6 * rate;
            }
            t += 1e-6;
            assert_eq!(instance.set_time(t), c::OK);
            assert_eq!(instance.set_states(&states), c::OK);
            assert_eq!(instance.complete_step(), c::OK);
            seen.extend(instance.get(SEEN).map(f64::to_bits));
        }
        seen
    };
    let mut instance = Instance::continuous(Kind::Lap, 2, &[("joint.k3_y", 1e12)]);
    let start = [1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0];
    assert_eq!(instance.set_states(&start), c::OK);
    assert_eq!(instance.set(&[vr::B_M], &[3.0]), c::OK);
    let bytes = instance.state_bytes();
    let expected = run(&mut instance, 0.0);
    let mut other = Instance::new(c::MODEL_EXCHANGE, Kind::Lap, 2, &[]);
    let loaded = other.deserialize(&bytes).unwrap();
    for instance in [&mut other, &mut instance] {
        assert_eq!(instance.restore(loaded), c::OK);
        assert_eq!(run(instance, 0.0), expected);
    }
    other.free_state(loaded);
}

#[test]
fn the_experiment_belongs_to_the_state() {
    let mut instance = Instance::new(c::CO_SIMULATION, Kind::Element, 1, &[]);
    assert_eq!(instance.set_up(2.0, Some(3.0)), c::OK);
    let saved = instance.save();
    assert_eq!(instance.reset(), c::OK);
    assert_eq!(instance.restore(saved), c::OK);
    instance.free_state(saved);
    assert_eq!(instance.enter_initialization(), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    instance.take_log();
    assert_eq!(instance.step(2.0, 1.0), c::OK);
    assert_eq!(instance.step(3.0, 1.0), c::ERROR);
    assert!(instance.message(c::ERROR).contains("after stopTime = 3 s"));
}

#[test]
fn a_state_is_overwritten_in_place() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let saved = instance.save();
    assert_eq!(instance.step(0.0, 1e-3), c::OK);
    let mut same = saved;
    // SAFETY: the instance and the state live
    let status = unsafe { c::fmi2GetFMUstate(instance.handle, &raw mut same) };
    assert_eq!(status, c::OK);
    assert_eq!(same, saved);
    assert_eq!(instance.reset(), c::OK);
    assert_eq!(instance.restore(saved), c::OK);
    assert_eq!(instance.get([vr::TIME]), [1e-3]);
    instance.free_state(saved);
}

#[test]
fn states_of_other_fmus_and_damaged_bytes_are_refused() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let saved = instance.save();
    let bytes = instance.serialize(saved);
    let mut others = vec![
        Instance::stepping(Kind::Lap, 2, &[]),
        Instance::stepping(Kind::Element, 1, &[]),
        Instance::continuous(Kind::Lap, 1, &[]),
    ];
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]).replace(TOKEN, "another"));
    let path = text(&folder.0);
    let request = Request {
        guid: Some("another"),
        resources: Some(&path),
        ..Request::default()
    };
    others.push(request.instantiate().unwrap());
    for other in &mut others {
        let expected =
            "the FMU state is that of \"lap with 1 DOF a side for Co-Simulation of FMI 2.0, token";
        let message = other.refused(|i| i.restore(saved));
        assert!(message.contains(expected), "{message}");
        let message = other.refused(|i| super::importer::status_of(i.deserialize(&bytes)));
        assert!(message.contains(expected), "{message}");
    }
    for position in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[position] ^= 0x10;
        assert_eq!(
            instance.deserialize(&damaged),
            Err(c::ERROR),
            "byte {position}"
        );
        let message = instance.message(c::ERROR);
        assert!(
            message.contains("the serialised FMU state cannot be used"),
            "{message}"
        );
    }
    instance.free_state(saved);
}

#[test]
fn states_move_instances_between_all_states() {
    for from in State::MODEL_EXCHANGE {
        let mut instance = Instance::new(c::MODEL_EXCHANGE, Kind::Lap, 1, &[]);
        instance.go_to(from);
        let saved = instance.save();
        let bytes = instance.serialize(saved);
        for to in State::MODEL_EXCHANGE {
            let mut other = Instance::new(c::MODEL_EXCHANGE, Kind::Lap, 1, &[]);
            other.go_to(to);
            assert_eq!(other.restore(saved), c::OK);
            assert!(other.state_bytes() == bytes, "{from:?} {to:?}");
        }
        instance.free_state(saved);
    }
}
