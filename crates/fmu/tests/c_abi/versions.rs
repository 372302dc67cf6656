//! FMI 2.0 beside FMI 3.0: the same numbers to the bit, and nothing of the one used with the other.

use bolted_joint_importer::header::{fmi2::*, fmi3::*};

use crate::{
    c,
    importer::{Folder, Kind, Make as _, Request, State, start_text, vr},
    raw::{BOTH, Fmi2, Fmi3, FmiVersion, Raw, call},
};

/// What follows from the motion of a lap.
const FOLLOWING: [u32; 9] = [
    vr::TIME,
    vr::JOINT_F,
    vr::JOINT_M,
    vr::ENERGY,
    vr::POWER,
    vr::A_ACCELERATION,
    vr::A_ALPHA,
    vr::B_ACCELERATION,
    vr::B_ALPHA,
];

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// All values of a lap, bit by bit.
fn seen(instance: Raw) -> Vec<u64> {
    let all = [&vr::MOTION[..], &FOLLOWING].concat();
    bits(&instance.try_get(&all).unwrap())
}

#[test]
fn co_simulation_is_the_same_to_the_bit() {
    for changes in [&[][..], &[("joint.k3_y", 2e12), ("joint.k3_theta", 1e5)]] {
        let of_version = |version: FmiVersion| {
            let instance = version.stepping(Kind::Lap, 2, changes);
            let mut t = 0.0;
            (0..400)
                .map(|n| {
                    // many equal steps, then others
                    let h = if n % 100 < 80 { 1.1e-4 } else { 7e-5 };
                    let loads = [
                        300.0 * (0.1 * f64::from(n)).sin(),
                        2.0 * (0.17 * f64::from(n)).cos(),
                    ];
                    c::ok(instance.set(&[vr::A_F, vr::B_M], &loads));
                    if n == 250 {
                        c::ok(instance.set(&[vr::K_YY], &[5e6]));
                    }
                    assert_eq!(instance.step_to(t, h), (c::OK, t + h));
                    t += h;
                    seen(instance.raw)
                })
                .collect::<Vec<_>>()
        };
        let found = of_version(Fmi2);
        assert_eq!(found, of_version(Fmi3));
        assert!(found.iter().any(|values| values[0] != 0));
    }
}

#[test]
fn an_element_is_the_same_to_the_bit() {
    let motion: Vec<u32> = (vr::A_Y..=vr::B_OMEGA).collect();
    let outputs: Vec<u32> = (vr::TIME..=vr::POWER).collect();
    let unknowns: Vec<u32> = (vr::A_F..=vr::POWER).collect();
    let of_version = |version: FmiVersion| {
        let instance = version.stepping(Kind::Element, 2, &[("joint.k3_y", 2e12)]);
        let at = |n: u32| {
            let position = |reference: &u32| 1e-3 * f64::from(n * reference).sin();
            let values: Vec<f64> = motion.iter().map(position).collect();
            c::ok(instance.set(&motion, &values));
            let seed = vec![0.5; motion.len()];
            [
                bits(&instance.try_get(&outputs).unwrap()),
                bits(&instance.directional(&unknowns, &motion, &seed).unwrap()),
            ]
        };
        (0..50).map(at).collect::<Vec<_>>()
    };
    assert_eq!(of_version(Fmi2), of_version(Fmi3));
}

#[test]
fn model_exchange_is_the_same_to_the_bit() {
    let of_version = |version: FmiVersion| {
        let instance = version.continuous(Kind::Lap, 2, &[("joint.k3_y", 2e12)]);
        let mut states = vec![1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0];
        (0..200)
            .map(|n| {
                c::ok(instance.set_time(1e-6 * f64::from(n)));
                c::ok(instance.set_states(&states));
                let rates = instance.derivatives(8);
                for (state, rate) in states.iter_mut().zip(&rates) {
                    *state += 1e-6 * rate;
                }
                [bits(&rates), seen(instance.raw)]
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(of_version(Fmi2), of_version(Fmi3));
}

#[test]
fn functions_of_one_version_refuse_instances_of_the_other() {
    for (own, other, names) in [
        (Fmi2, Fmi3, ["FMI 2.0", "FMI 3.0"]),
        (Fmi3, Fmi2, ["FMI 3.0", "FMI 2.0"]),
    ] {
        let mut instance = own.stepping(Kind::Lap, 1, &[]);
        // as if it were an instance of the other version
        let disguised = Raw {
            version: other,
            ..instance.raw
        };
        let (mut flag, mut time) = (7, 0.0);
        let (flag, time) = (&raw mut flag, &raw mut time);
        let step = || {
            call!(
                disguised,
                fmi2DoStep(0.0, 1e-3, 0),
                fmi3DoStep(0.0, 1e-3, 1, flag, flag, flag, time)
            )
        };
        let free = || {
            disguised.free();
            c::ERROR
        };
        let get = || disguised.try_get(&[vr::A_Y]).unwrap_err();
        let calls: [(&str, &dyn Fn() -> i32); 7] = [
            ("DoStep", &step),
            (
                if other == Fmi2 {
                    "GetReal"
                } else {
                    "GetFloat64"
                },
                &get,
            ),
            ("SetDebugLogging", &|| disguised.switch_logging(false, &[])),
            ("Terminate", &|| disguised.terminate()),
            ("Reset", &|| disguised.reset()),
            ("EnterEventMode", &|| disguised.enter_event()),
            ("FreeInstance", &free),
        ];
        for (function, call) in calls {
            let message = instance.refused(|_| call());
            assert_eq!(
                message,
                format!(
                    "fmi{}{function}: belongs to {}, but the instance was made by the functions of {}; use only one of \
                     them",
                    if other == Fmi2 { 2 } else { 3 },
                    names[1],
                    names[0]
                )
            );
        }
        c::ok(instance.step(0.0, 1e-3));
    }
}

#[test]
fn both_versions_live_side_by_side_in_threads() {
    let run = |version: FmiVersion, force: f64| {
        let instance = version.stepping(Kind::Lap, 2, &[]);
        c::ok(instance.set(&[vr::B_F], &[force]));
        for n in 0..500 {
            c::ok(instance.step(1e-4 * f64::from(n), 1e-4));
        }
        seen(instance.raw)
    };
    let alone: Vec<_> = (0..8).map(|n| run(Fmi2, f64::from(n))).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|n| scope.spawn(move || run(BOTH[n as usize % 2], f64::from(n))))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    assert_eq!(alone, together);
}

#[test]
fn one_start_file_serves_both() {
    // the same folder, the same token
    let folder = Folder::with_start(&start_text(Kind::Lap, 1, &[]));
    let stiffness = BOTH.map(|version| {
        let request = Request {
            version,
            ..Request::of(&folder)
        };
        let mut instance = request.instantiate().unwrap();
        instance.go_to(State::Step);
        instance.get([vr::K_YY])
    });
    assert_eq!(stiffness[0], stiffness[1]);
}
