//! FMI 2.0 beside FMI 3.0: the same numbers to the bit, and nothing of the one used with the other.

use std::{ffi::c_int, ptr};

use super::{c, importer};
use crate::{
    c as fmi3,
    importer::{Instance as Fmi3, Kind, Request as Fmi3Request, TOKEN, vr},
};

type Fmi2 = importer::Instance;

const LAP: &[u32] = &[
    vr::TIME,
    vr::A_Y,
    vr::A_THETA,
    vr::A_V,
    vr::A_OMEGA,
    vr::B_Y,
    vr::B_THETA,
    vr::B_V,
    vr::B_OMEGA,
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

#[test]
fn co_simulation_is_the_same_to_the_bit() {
    for changes in [&[][..], &[("joint.k3_y", 2e12), ("joint.k3_theta", 1e5)]] {
        let mut fmi2 = Fmi2::stepping(Kind::Lap, 2, changes);
        let mut fmi3 = Fmi3::stepping(Kind::Lap, 2, changes);
        let mut t = 0.0;
        let mut moved = false;
        for n in 0..400 {
            // many equal steps, then others
            let h = if n % 100 < 80 { 1.1e-4 } else { 7e-5 };
            let loads = [
                300.0 * (0.1 * f64::from(n)).sin(),
                2.0 * (0.17 * f64::from(n)).cos(),
            ];
            assert_eq!(fmi2.set(&[vr::A_F, vr::B_M], &loads), c::OK);
            assert_eq!(fmi3.set(&[vr::A_F, vr::B_M], &loads), fmi3::OK);
            if n == 250 {
                assert_eq!(fmi2.set(&[vr::K_YY], &[5e6]), c::OK);
                assert_eq!(fmi3.set(&[vr::K_YY], &[5e6]), fmi3::OK);
            }
            assert_eq!(fmi2.step(t, h), c::OK);
            assert_eq!(fmi3.step(t, h), (fmi3::OK, t + h));
            let found = fmi2.try_get(LAP).unwrap();
            assert_eq!(bits(&found), bits(&fmi3.try_get(LAP).unwrap()), "{n}");
            moved |= found[1] != 0.0;
            t += h;
        }
        assert!(moved);
    }
}

#[test]
fn an_element_is_the_same_to_the_bit() {
    let mut fmi2 = Fmi2::stepping(Kind::Element, 2, &[("joint.k3_y", 2e12)]);
    let mut fmi3 = Fmi3::stepping(Kind::Element, 2, &[("joint.k3_y", 2e12)]);
    let motion: Vec<u32> = (vr::A_Y..=vr::B_OMEGA).collect();
    let outputs: Vec<u32> = (vr::TIME..=vr::POWER).collect();
    for n in 0..50_u32 {
        let values: Vec<f64> = motion
            .iter()
            .map(|reference| 1e-3 * f64::from(n * reference).sin())
            .collect();
        assert_eq!(fmi2.set(&motion, &values), c::OK);
        assert_eq!(fmi3.set(&motion, &values), fmi3::OK);
        let found = fmi2.try_get(&outputs).unwrap();
        assert_eq!(bits(&found), bits(&fmi3.try_get(&outputs).unwrap()));
        let seed = vec![0.5; motion.len()];
        let unknowns: Vec<u32> = (vr::A_F..=vr::POWER).collect();
        let derivative = fmi2.directional(&unknowns, &motion, &seed).unwrap();
        assert_eq!(
            bits(&derivative),
            bits(&fmi3.directional(&unknowns, &motion, &seed).unwrap())
        );
    }
}

#[test]
fn model_exchange_is_the_same_to_the_bit() {
    let changes = [("joint.k3_y", 2e12)];
    let mut fmi2 = Fmi2::continuous(Kind::Lap, 2, &changes);
    let mut fmi3 = Fmi3::exchanging(Kind::Lap, 2, &changes);
    assert_eq!(fmi3.enter_initialization(0.0, None), fmi3::OK);
    assert_eq!(fmi3.exit_initialization(), fmi3::OK);
    // SAFETY: the instance lives
    let status = unsafe { fmi3::fmi3EnterContinuousTimeMode(fmi3.handle) };
    assert_eq!(status, fmi3::OK);
    let mut states = vec![1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0];
    for n in 0..200 {
        let t = 1e-6 * f64::from(n);
        assert_eq!(fmi2.set_time(t), c::OK);
        assert_eq!(fmi2.set_states(&states), c::OK);
        let rates = fmi2.read(c::fmi2GetDerivatives, 8).unwrap();
        let mut of_fmi3 = vec![f64::NAN; 8];
        // SAFETY: the instance lives, pointers and lengths are those of lists
        unsafe {
            assert_eq!(fmi3::fmi3SetTime(fmi3.handle, t), fmi3::OK);
            assert_eq!(
                fmi3::fmi3SetContinuousStates(fmi3.handle, states.as_ptr(), 8),
                fmi3::OK
            );
            assert_eq!(
                fmi3::fmi3GetContinuousStateDerivatives(fmi3.handle, of_fmi3.as_mut_ptr(), 8),
                fmi3::OK
            );
        }
        assert_eq!(bits(&rates), bits(&of_fmi3));
        assert_eq!(
            bits(&fmi2.try_get(LAP).unwrap()),
            bits(&fmi3.try_get(LAP).unwrap())
        );
        for (state, rate) in states.iter_mut().zip(rates) {
            *state += 1e-6 * rate;
        }
    }
}

#[test]
fn functions_of_one_version_refuse_instances_of_the_other() {
    let mut fmi2 = Fmi2::stepping(Kind::Lap, 1, &[]);
    let mut fmi3 = Fmi3::stepping(Kind::Lap, 1, &[]);
    let handle = fmi3.handle;
    // SAFETY: the instances live, all pointers are to locals or null where nothing is read
    let calls: [(&str, &dyn Fn() -> c_int); 6] = unsafe {
        [
            ("fmi2DoStep", &|| c::fmi2DoStep(handle, 0.0, 1e-3, 0)),
            ("fmi2GetReal", &|| {
                c::fmi2GetReal(handle, [vr::A_Y].as_ptr(), 1, &mut 0.0)
            }),
            ("fmi2SetDebugLogging", &|| {
                c::fmi2SetDebugLogging(handle, 0, 0, ptr::null())
            }),
            ("fmi2Terminate", &|| c::fmi2Terminate(handle)),
            ("fmi2EnterEventMode", &|| c::fmi2EnterEventMode(handle)),
            ("fmi2FreeInstance", &|| {
                c::fmi2FreeInstance(handle);
                c::ERROR
            }),
        ]
    };
    for (function, call) in calls {
        let message = fmi3.refused(|_| call());
        assert_eq!(
            message,
            format!(
                "{function}: belongs to FMI 2.0, but the instance was made by the functions of FMI 3.0; use only one \
                 of them"
            )
        );
    }
    let handle = fmi2.handle;
    let (mut flag, mut time) = (false, 0.0);
    let (flag, time) = (&raw mut flag, &raw mut time);
    // SAFETY: as above
    let calls: [(&str, &dyn Fn() -> c_int); 4] = unsafe {
        [
            ("fmi3DoStep", &|| {
                fmi3::fmi3DoStep(handle, 0.0, 1e-3, true, flag, flag, flag, time)
            }),
            ("fmi3Reset", &|| fmi3::fmi3Reset(handle)),
            ("fmi3SetDebugLogging", &|| {
                fmi3::fmi3SetDebugLogging(handle, false, 0, ptr::null())
            }),
            ("fmi3FreeInstance", &|| {
                fmi3::fmi3FreeInstance(handle);
                c::ERROR
            }),
        ]
    };
    for (function, call) in calls {
        let message = fmi2.refused(|_| call());
        assert_eq!(
            message,
            format!(
                "{function}: belongs to FMI 3.0, but the instance was made by the functions of FMI 2.0; use only one \
                 of them"
            )
        );
    }
    assert_eq!(fmi2.step(0.0, 1e-3), c::OK);
    assert_eq!(fmi3.step(0.0, 1e-3).0, fmi3::OK);
}

#[test]
fn states_of_one_version_are_refused_by_the_other() {
    let mut fmi2 = Fmi2::stepping(Kind::Lap, 1, &[]);
    let mut fmi3 = Fmi3::stepping(Kind::Lap, 1, &[]);
    let (of_fmi2, of_fmi3) = (fmi2.save(), fmi3.save());
    let (bytes2, bytes3) = (fmi2.serialize(of_fmi2), fmi3.serialize(of_fmi3));
    for message in [
        fmi2.refused(|i| i.restore(of_fmi3)),
        fmi2.refused(|i| importer::status_of(i.deserialize(&bytes3))),
    ] {
        assert!(
            message.contains("for Co-Simulation of FMI 3.0, token"),
            "{message}"
        );
    }
    for message in [
        fmi3.refused(|i| i.restore(of_fmi2)),
        fmi3.refused(|i| i.deserialize(&bytes2).err().unwrap_or(fmi3::OK)),
    ] {
        assert!(
            message.contains("for Co-Simulation of FMI 2.0, token"),
            "{message}"
        );
    }
    fmi2.free_state(of_fmi2);
    fmi3.free_state(of_fmi3);
}

#[test]
fn both_versions_live_side_by_side_in_threads() {
    let run2 = |force: f64| {
        let mut instance = Fmi2::stepping(Kind::Lap, 2, &[]);
        assert_eq!(instance.set(&[vr::B_F], &[force]), c::OK);
        for n in 0..300 {
            assert_eq!(instance.step(1e-4 * f64::from(n), 1e-4), c::OK);
        }
        bits(&instance.try_get(LAP).unwrap())
    };
    let run3 = |force: f64| {
        let mut instance = Fmi3::stepping(Kind::Lap, 2, &[]);
        assert_eq!(instance.set(&[vr::B_F], &[force]), fmi3::OK);
        for n in 0..300 {
            assert_eq!(instance.step(1e-4 * f64::from(n), 1e-4).0, fmi3::OK);
        }
        bits(&instance.try_get(LAP).unwrap())
    };
    let alone: Vec<_> = (0..8).map(|n| run2(f64::from(n))).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|n| {
                scope.spawn(move || {
                    if n % 2 == 0 {
                        run2(f64::from(n))
                    } else {
                        run3(f64::from(n))
                    }
                })
            })
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
    let folder =
        crate::importer::Folder::with_start(&crate::importer::start_text(Kind::Lap, 1, &[]));
    let resources = folder.0.to_str();
    let mut of_fmi2 = importer::Request {
        guid: Some(TOKEN),
        resources,
        ..Default::default()
    }
    .instantiate()
    .unwrap();
    let mut of_fmi3 = Fmi3Request {
        token: Some(TOKEN),
        resources,
        ..Default::default()
    }
    .instantiate()
    .unwrap();
    of_fmi2.go_to(importer::State::Step);
    assert_eq!(of_fmi3.enter_initialization(0.0, None), fmi3::OK);
    assert_eq!(of_fmi3.exit_initialization(), fmi3::OK);
    assert_eq!(of_fmi2.get([vr::K_YY]), of_fmi3.get([vr::K_YY]));
}
