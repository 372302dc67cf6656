//! Where communication steps begin and end: time, the stop time, and steps that cannot be.

use crate::{
    c,
    importer::{Instance, Kind, Make as _, vr},
    raw::{BOTH, Fmi2, Fmi3, Interface::CoSimulation},
    stepping::{lap, lap_of},
};

#[test]
fn time_does_not_drift() {
    // the importer computes t0 + n·h, or adds h: both are accepted to the last step before the stop time, whatever the
    // rounding, and the FMU ends where the importer does
    const STEPS: u32 = 1_000_000;
    for (start, h) in [
        (0.0, 1e-4),
        (1.0, 1e-3),
        (-37.3, 1.0 / 3.0),
        (1e6 + 0.1, 1e-5),
    ] {
        for multiply in [true, false] {
            let mut instance = Instance::new(Kind::Element, 1, &[]);
            let stop = start + h * f64::from(STEPS);
            instance.initialize(start, Some(stop));
            let mut t = start;
            for n in 1..=STEPS {
                let (status, last) = instance.step_to(t, h);
                assert_eq!(
                    (status, last),
                    (c::OK, t + h),
                    "{n} {:?}",
                    instance.take_log()
                );
                t = if multiply {
                    start + f64::from(n) * h
                } else {
                    t + h
                };
            }
            let [time] = instance.get([vr::TIME]);
            let rounding = f64::EPSILON * time.abs().max(start.abs());
            let drift = if multiply { 2.0 } else { f64::from(STEPS) } * rounding;
            assert!((time - stop).abs() <= drift, "{start} {h}: {time} {stop}");
            if multiply {
                instance.refuses(|i| i.step(t, h), "after stopTime");
            }
        }
    }
    // a lap, with steps that are no multiple of its internal ones
    let instance = lap(3e-5);
    let mut t = 0.0;
    for n in 1..=100_000_u32 {
        assert_eq!(instance.step_to(t, 1e-4), (c::OK, t + 1e-4));
        t = f64::from(n) * 1e-4;
    }
}

#[test]
fn a_stop_time_that_rounding_has_moved_is_reached() {
    for ulps in -8_i64..=8 {
        let instance = Instance::new(Kind::Lap, 1, &[]);
        let stop = f64::from_bits((0.7_f64.to_bits() as i64 + ulps) as u64);
        instance.initialize(0.0, Some(stop));
        let mut t = 0.0;
        for n in 1..=7 {
            assert_eq!(instance.step(t, 0.1), c::OK, "{ulps}");
            t = 0.1 * f64::from(n);
        }
    }
}

#[test]
fn no_step_passes_a_late_stop_time() {
    // 10⁻⁹ of this stop time is a hundred steps long
    let (start, h, steps) = (1e6, 1e-5, 50_u32);
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    let stop = start + h * f64::from(steps);
    instance.initialize(start, Some(stop));
    let time = |n: u32| start + h * f64::from(n);
    for n in 0..steps {
        assert_eq!(instance.step(time(n), h), c::OK, "{n}");
    }
    for longer in [h, 0.1 * h] {
        instance.refuses(|i| i.step(time(steps), longer), "after stopTime");
    }
    // nor does one that begins in time
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    instance.initialize(start, Some(stop));
    c::ok(instance.step(start, h * f64::from(steps - 1)));
    instance.refuses(|i| i.step(time(steps - 1), 1.02 * h), "after stopTime");
    c::ok(instance.step(time(steps - 1), h));
}

#[test]
fn steps_that_cannot_be_are_refused_and_nothing_moves() {
    for (t, h, expected) in [
        (0.0, 0.0, "communicationStepSize is 0"),
        (0.0, -1e-3, "communicationStepSize is -0.001"),
        (0.0, f64::NAN, "communicationStepSize is NaN"),
        (0.0, f64::INFINITY, "communicationStepSize is inf"),
        (
            1e-3,
            1e-3,
            "currentCommunicationPoint is 0.001 s, but the FMU is at t = 0 s",
        ),
        (-1e-3, 1e-3, "but the FMU is at t = 0 s"),
        (f64::NAN, 1e-3, "currentCommunicationPoint is NaN"),
        (0.0, 1e5, "more than 1000000000 Runge-Kutta steps"),
        (0.0, 1e300, "more than 1000000000 Runge-Kutta steps"),
    ] {
        for (version, function) in [(Fmi2, "fmi2DoStep: "), (Fmi3, "fmi3DoStep: ")] {
            let mut instance = lap_of(version, 2e-5);
            let message = instance.refused(|i| {
                let (status, last) = i.step_to(t, h);
                assert_eq!(last, 0.0);
                status
            });
            c::tells(&message, function, expected);
            assert!(version == Fmi3 || !instance.has_terminated());
            // mended, the step is taken
            assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
        }
    }
}

#[test]
fn a_step_that_rounding_swallows_is_refused() {
    for version in BOTH {
        let mut instance = version.instance(CoSimulation, Kind::Element, 1, &[]);
        instance.initialize(1e6, None);
        instance.refuses(
            |i| i.step(1e6, 1e-12),
            "is lost to rounding at t = 1000000 s",
        );
    }
}

#[test]
fn the_stop_time_is_kept_but_for_rounding() {
    let started = || {
        let instance = Instance::new(Kind::Lap, 1, &[]);
        instance.initialize(0.0, Some(0.3));
        instance
    };
    let mut instance = started();
    // 0.1 + 0.1 + 0.1 > 0.3 by one bit
    let mut t = 0.0;
    for _ in 0..3 {
        c::ok(instance.step(t, 0.1));
        t += 0.1;
    }
    assert!(t > 0.3);
    instance.refuses(|i| i.step(t, 1e-3), "after stopTime = 0.3 s");
    c::ok(instance.terminate());
    let mut instance = started();
    instance.refuses(
        |i| i.step(0.0, 0.31),
        "the step would end at t = 0.31 s, after stopTime = 0.3 s",
    );
    assert_eq!(instance.step_to(0.0, 0.3), (c::OK, 0.3));
}

#[test]
fn communication_points_may_be_rounded() {
    // t0 + n·h as importers compute it, for steps that no binary fraction is equal to
    for version in BOTH {
        for h in [1e-3, 1e-4 / 3.0, 0.1] {
            let instance = version.instance(CoSimulation, Kind::Element, 1, &[]);
            let (start, count) = (100.0, 1000);
            let end = start + f64::from(count) * h;
            instance.initialize(start, Some(end));
            let mut last = start;
            for n in 0..count {
                let (status, reached) = instance.step_to(start + f64::from(n) * h, h);
                assert_eq!(status, c::OK, "{n}");
                last = reached;
            }
            assert!((last - end).abs() <= 4.0 * f64::EPSILON * end);
        }
    }
}
