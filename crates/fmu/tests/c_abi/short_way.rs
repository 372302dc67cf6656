//! The short way through the calls of every step gives what the long way gives, to the last bit.

use crate::{
    c,
    importer::{Instance, Kind, vr},
};

const STATES: [u32; 8] = vr::MOTION;
const LOADS: [u32; 4] = [vr::A_F, vr::A_M, vr::B_F, vr::B_M];
const STEP_S: f64 = 2e-5;

fn stepping_from(start_s: f64, k3: f64) -> Instance {
    let instance = Instance::new(Kind::Lap, 2, &[("joint.k3_y", k3)]);
    instance.initialize(start_s, None);
    instance
}

#[test]
fn short_and_long_way_give_the_same_bits() {
    for k3 in [0.0, 5e12] {
        // so late that the rounding of communication points is no longer small beside a step: the long way accepts it
        let late_s = 1e6;
        let short = stepping_from(0.0, k3);
        let long = stepping_from(late_s, k3);
        let [stiffness] = long.get([vr::K_YY]);
        let (mut time_s, mut late_time_s) = (0.0, late_s);
        for n in 0..300 {
            let (sin, cos) = (0.1 * f64::from(n)).sin_cos();
            let loads = [100.0 * sin, cos, -50.0 * cos, 2.0 * sin];
            c::ok(short.set(&LOADS, &loads));
            // a parameter in the list, although it stays as it is, is no matter for the short way
            let [a, b, c, d] = loads;
            let references = [LOADS.as_slice(), &[vr::K_YY]].concat();
            c::ok(long.set(&references, &[a, b, c, d, stiffness]));

            let (status, last) = short.step_to(time_s, STEP_S);
            c::ok(status);
            time_s = last;
            let (status, last) = long.step_to(late_time_s + 2e-10, STEP_S);
            c::ok(status);
            late_time_s = last;

            // nor is an output that has to be calculated
            let [force, ..] = long.get([vr::JOINT_F, vr::A_Y]);
            assert!(force.is_finite());
            let bits = |states: [f64; 8]| states.map(f64::to_bits);
            assert_eq!(
                bits(short.get(STATES)),
                bits(long.get(STATES)),
                "step {n}, k3 = {k3:e}"
            );
        }
        assert!(short.get(STATES).iter().all(|&state| state != 0.0));
    }
}
