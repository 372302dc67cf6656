//! Laws that slip, in balance with one harmonic, against values by mpmath with 30 digits (closed forms of Segalman's law).

use bolted_joint::harmonic::{
    CurveOptions, HarmonicBalance, HarmonicError, HarmonicLoads, Harmonics, Observed, Target,
};
use bolted_joint_dynamics::law::{DofLaws, Iwan, Jenkins, LuGre};
use bolted_joint_dynamics::{Body, JointLaw, Lap, Linear};

const SPAN: f64 = 1.316_129_032_258_1;

/// Relative motion of mass 1 on a spring of 0.75 and a damper, beside a law that slips.
fn oscillator(law: DofLaws, damping: f64) -> Lap<1> {
    let body = Body {
        inertia: [2.0],
        stiffness: [0.0],
        damping: [0.0],
    };
    let linear = Linear {
        stiffness: [[0.75]],
        damping: [[damping]],
    };
    Lap {
        joint: JointLaw { linear, on: [law] },
        a: body,
        b: body,
    }
}

fn iwan() -> DofLaws {
    DofLaws::from(Iwan {
        slip_force: 0.2,
        stiffness: 0.25,
        exponent: -0.3,
        ratio: 0.5,
    })
}

fn balance(lap: &Lap<1>) -> HarmonicBalance<1> {
    HarmonicBalance::new(lap, Harmonics::odd(1).unwrap()).unwrap()
}

#[test]
fn the_backbone_of_iwan_s_law_is_that_of_its_closed_forms() {
    let balance = balance(&oscillator(iwan(), 0.0));
    for (part, omega, ratio) in [
        (0.001, 0.999_605_279_803_4, 1.286_344_056_91e-4),
        (0.01, 0.998_020_143_284_9, 6.467_487_728_72e-4),
        (0.1, 0.990_037_407_121_6, 3.293_904_616_345e-3),
        (0.5, 0.968_934_281_279_1, 1.060_973_622_354e-2),
        (1.0, 0.949_017_890_960_5, 1.796_658_048_863e-2),
        (1.5, 0.922_218_680_490_5, 3.373_331_491_15e-2),
        (3.0, 0.889_038_730_481_5, 2.947_403_550_247e-2),
    ] {
        let found = balance
            .free(Target::relative(0, part * SPAN), None)
            .unwrap();
        let error = (found.omega_rad_s() / omega - 1.0).abs();
        assert!(error < 1e-10, "{part}: {} {omega}", found.omega_rad_s());
        let error = (found.damping_ratio() / ratio - 1.0).abs();
        assert!(error < 1e-8, "{part}: {} {ratio}", found.damping_ratio());
    }
}

#[test]
fn forced_responses_are_those_of_the_closed_forms() {
    let iwan = oscillator(iwan(), 0.002);
    let slider = DofLaws::from(Jenkins {
        stiffness: 0.25,
        slip_force: 0.06,
    });
    let jenkins = oscillator(slider, 0.01);
    for (lap, load, omega, amplitude) in [
        (&iwan, 0.02, 0.97, 0.771_529_062_046_8),
        (&iwan, 0.02, 0.93, 0.180_482_393_089_2),
        (&iwan, 0.2, 0.9, 3.814_635_338_624),
        (&jenkins, 0.1, 0.8, 0.307_069_589_340_1),
        (&jenkins, 0.1, 0.9, 1.627_318_291_414_8),
        (&jenkins, 0.1, 0.95, 0.837_231_193_699_5),
        (&jenkins, 0.1, 1.0, 0.573_524_611_062_6),
    ] {
        let balance = balance(lap);
        let loads = HarmonicLoads::opposed(load);
        let found = balance
            .forced(omega, &loads, None)
            .unwrap_or_else(|error| panic!("{load} {omega}: {error}"));
        let found = balance
            .amplitude_of(&found, Observed::Relative(0), 1)
            .norm();
        assert!(
            (found / amplitude - 1.0).abs() < 1e-9,
            "{omega}: {found} {amplitude}"
        );
    }
}

#[test]
fn curves_go_through_where_all_slips() {
    let balance = balance(&oscillator(iwan(), 0.002));
    let target = Target::relative(0, SPAN);
    let options = CurveOptions::default();
    let curve = balance
        .backbone([0.01 * SPAN, 3.0 * SPAN], target, &options)
        .unwrap();
    assert!(curve.len() > 10);
    let falls = |pair: &[_]| {
        let [before, after]: &[bolted_joint::harmonic::CurvePoint<1>; 2] = pair.try_into().unwrap();
        after.solution.omega_rad_s() < before.solution.omega_rad_s()
    };
    assert!(curve.windows(2).all(falls));
    let stable = CurveOptions {
        with_stability: true,
        ..options
    };
    let loads = HarmonicLoads::opposed(0.05);
    let forced = balance.forced_curve([0.9, 1.05], &loads, &stable).unwrap();
    assert!(forced.iter().all(|point| point.stability.is_none()));
    let refused = balance.stability(&forced[0].solution).unwrap_err();
    assert_eq!(refused, HarmonicError::SlippingStability);
}

#[test]
fn friction_that_knows_time_is_refused() {
    let lugre = DofLaws::from(LuGre {
        stiffness: 1.0,
        bristle_damping: 0.0,
        damping: 0.0,
        slip_force: 1.0,
        static_force: 1.0,
        stribeck_velocity: 1.0,
    });
    let refused = HarmonicBalance::new(&oscillator(lugre, 0.0), Harmonics::odd(1).unwrap());
    assert_eq!(refused.unwrap_err(), HarmonicError::Rate);
}
