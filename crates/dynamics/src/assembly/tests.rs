//! The check case of one elastic mode, a rigid body and a cubic joint between them. Its numbers come from NumPy and SciPy
//! (DOP853 at 1e-13 where the reference is in time).

use super::*;
use crate::law::{DofLaws, Jenkins, Polynomial};

/// A has one mode of 800 rad/s with 2 % of damping and shape 1.2 at the joint; B is a rigid body of 0.5 kg. u acts on B.
fn check_case(laws: DofLaws, [k, c]: [f64; 2]) -> Assembly {
    let of_b = 2.0_f64.sqrt();
    Assembly {
        frequencies_rad_per_s: vec![800.0, 0.0],
        damping_per_s: Matrix::from_fn(2, 2, |i, j| if i + j == 0 { 32.0 } else { 0.0 }),
        loads: Matrix::from_fn(2, 1, |i, _| if i == 1 { of_b } else { 0.0 }),
        joints: vec![AssemblyJoint {
            relative: Matrix::from_fn(1, 2, |_, j| if j == 0 { -1.2 } else { of_b }),
            stiffness: Matrix::from_fn(1, 1, |_, _| k),
            damping: Matrix::from_fn(1, 1, |_, _| c),
            laws: vec![laws],
            over_preload: None,
        }],
    }
}

fn cubic() -> Assembly {
    check_case(Polynomial::cubic(1e12).into(), [4e5, 20.0])
}

/// Steps in which nothing is halved.
fn without_halves(assembly: &Assembly, length_s: f64) -> AssemblySteps {
    AssemblySteps::new(assembly, length_s, f64::INFINITY).unwrap()
}

fn started(steps: &AssemblySteps) -> AssemblyState {
    let mut state = steps.at_rest();
    state.motion[1] = 1e-3 / 2.0_f64.sqrt();
    state
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{found} {expected}"
        );
    }
}

#[test]
fn a_step_and_a_hundred_are_those_of_the_uncondensed_scheme() {
    let one = [
        8.287012170382e-6,
        6.973954387764e-4,
        0.1637992000995,
        -0.1921468828353,
    ];
    let hundred = [
        4.256638023354e-4,
        1.672845596797e-4,
        0.4503936295305,
        -0.6683705812228,
    ];
    for (length_s, count, expected) in [(1e-4, 1, one), (1e-5, 100, hundred)] {
        let mut steps = without_halves(&cubic(), length_s);
        let mut state = started(&steps);
        for _ in 0..count {
            assert_eq!(steps.step(&mut state, &[10.0], &[0.0]), 1);
        }
        assert_near(&state.motion, &expected, 1e-11);
    }
}

#[test]
fn the_error_is_of_fourth_order() {
    let exact = [4.256638020e-4, 1.672845601e-4, 0.4503936292, -0.6683705808];
    let error = |length_s: f64, count: usize| {
        let mut steps = without_halves(&cubic(), length_s);
        let mut state = started(&steps);
        for _ in 0..count {
            steps.step(&mut state, &[10.0], &[0.0]);
        }
        (state.motion[2] - exact[2]).abs()
    };
    // the reference has ten digits
    let (coarse, fine) = (error(1e-4, 10), error(5e-5, 20));
    assert!(
        (3.6..4.4).contains(&(coarse / fine).log2()),
        "{coarse} {fine}"
    );
}

/// The state after so many steps of that length, under loads that go from 10 N on with `slope` (N/s).
fn after(
    assembly: &Assembly,
    duration_s: f64,
    count: u32,
    slope: f64,
    tolerance: f64,
) -> (AssemblyState, f64, usize) {
    let length_s = duration_s / f64::from(count);
    let mut steps = AssemblySteps::new(assembly, length_s, tolerance).unwrap();
    let state = started(&steps);
    followed(&mut steps, state, count, [10.0, slope])
}

fn followed(
    steps: &mut AssemblySteps,
    mut state: AssemblyState,
    count: u32,
    [first, slope]: [f64; 2],
) -> (AssemblyState, f64, usize) {
    let length_s = steps.length_s();
    let begun = steps.stored_energy_j(&state);
    let mut parts = 0;
    for step in 0..count {
        let load = first + slope * length_s * f64::from(step);
        parts += steps.step(&mut state, &[load], &[slope * length_s]);
    }
    let stored = steps.stored_energy_j(&state) - begun;
    let balance = state.supplied_j - state.dissipated_j - stored;
    (state, balance, parts)
}

#[test]
fn a_linear_assembly_is_exact_at_any_step_and_so_is_its_energy() {
    let linear = check_case(DofLaws::NONE, [4e5, 20.0]);
    let motion = [
        -4.7224582391438874e-05,
        -0.0001188535185308778,
        -0.07474487864903004,
        -0.14964297279763,
    ];
    let [supplied, dissipated] = [-0.014214418211695416, 0.16859937241068843];
    for count in [1, 3, 50, 5000] {
        let (state, balance, parts) = after(&linear, 0.05, count, 200.0, 1e-6);
        assert_eq!(parts, count as usize);
        // the loads are even in time, so that not even one step of forty periods is too long
        assert_near(&state.motion, &motion, 1e-10);
        assert_near(&[state.supplied_j], &[supplied], 1e-9);
        assert_near(&[state.dissipated_j], &[dissipated], 1e-9);
        assert!(balance.abs() < 1e-14, "{balance}");
    }
}

#[test]
fn dampers_of_the_joint_s_own_keep_the_order() {
    let laws = Polynomial::with(&[1e12], &[3e7]);
    let assembly = check_case(laws.into(), [4e5, 20.0]);
    let motion = [
        0.0004205695796005307,
        0.0001785199860787754,
        0.4470154054327644,
        -0.6484305944935513,
    ];
    let [supplied, dissipated] = [-0.01631592624841526, 0.05320588319268768];
    let mut errors = Vec::new();
    for count in [50, 100, 200] {
        let (state, balance, _) = after(&assembly, 1e-3, count, 2e4, f64::INFINITY);
        errors.push((state.motion[2] - motion[2]).abs());
        let finest = count == 200;
        if finest {
            assert_near(&state.motion, &motion, 1e-7);
            assert_near(
                &[state.supplied_j, state.dissipated_j],
                &[supplied, dissipated],
                1e-7,
            );
            assert!(balance.abs() < 1e-8 * dissipated, "{balance}");
        }
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.6..4.6).contains(&order), "{errors:?}");
    }
}

#[test]
fn a_slider_is_followed_into_the_halves_where_it_turns() {
    let laws = Jenkins {
        stiffness: 2e6,
        slip_force: 60.0,
    };
    let assembly = check_case(laws.into(), [4e5, 20.0]);
    // SciPy, with every stick and slip located
    let motion = [
        0.00022416363841083837,
        0.0005336525242969074,
        -0.12703346088832257,
        -0.12743636482495768,
    ];
    for (count, tolerance, most) in [(500, 1e-8, 1200), (1000, 4e-9, 2000), (4000, 1e-10, 8000)] {
        let mut steps = AssemblySteps::new(&assembly, 0.02 / f64::from(count), 1e-6).unwrap();
        let rest = steps.at_rest();
        let (state, balance, parts) = followed(&mut steps, rest, count, [200.0, 0.0]);
        assert_near(&state.motion, &motion, tolerance);
        assert!(balance.abs() < 0.1 * tolerance, "{balance}");
        // beside the first steps, that suit the slider's own stiffness, only six events ask for halves
        assert!(parts < most, "{parts}");
    }
}

#[test]
fn steps_are_halved_until_they_suit_the_joint() {
    let exact = [4.256638020e-4, 1.672845601e-4, 0.4503936292, -0.6683705808];
    for (tolerance, largest) in [(1e-4, 1e-4), (1e-6, 2e-6), (1e-8, 6e-8)] {
        let (state, _, parts) = after(&cubic(), 1e-3, 1, 0.0, tolerance);
        // some periods of the joint's own frequency
        assert_near(&state.motion, &exact, largest);
        assert!((5..200).contains(&parts), "{parts}");
    }
}

#[test]
fn a_state_that_is_kept_goes_on_as_the_other_does() {
    let assembly = check_case(
        DofLaws::from(Jenkins {
            stiffness: 2e6,
            slip_force: 60.0,
        }),
        [4e5, 20.0],
    );
    let mut steps = AssemblySteps::new(&assembly, 1e-5, 1e-6).unwrap();
    let rest = steps.at_rest();
    let (kept, ..) = followed(&mut steps, rest, 150, [200.0, 0.0]);
    let (first, ..) = followed(&mut steps, kept.clone(), 100, [200.0, 0.0]);
    // others' motions leave no trace in the scratch
    let _ = followed(&mut steps, first.clone(), 37, [-900.0, 3e4]);
    let (again, ..) = followed(&mut steps, kept, 100, [200.0, 0.0]);
    assert_eq!(first, again);
}

#[test]
fn steps_are_halved_for_motions_that_are_faster_than_the_joint_s_own() {
    // tangents of the law give 45 rad/s, the linear assembly vibrates with 1310: whole periods in few steps
    let assembly = check_case(Polynomial::cubic(2e8).into(), [4e5, 20.0]);
    let motion = [
        -7.826975139777087e-05,
        5.334932227265154e-05,
        0.3106163572558443,
        0.07965130498891876,
    ];
    let (state, _, parts) = after(&assembly, 0.02, 20, 0.0, 1e-7);
    assert_near(&state.motion, &motion, 1e-6);
    assert!(parts > 20, "{parts}");
}

#[test]
fn steps_are_halved_for_dampers_too() {
    // 3e7 N s/m³ at a millimetre, 30 N s/m, on 0.29 kg: a rate of 100 1/s
    let assembly = check_case(Polynomial::with(&[], &[3e7]).into(), [4e5, 20.0]);
    let motion = [
        0.0004201578286985261,
        5.083734071619636e-05,
        0.054510016629651964,
        -0.3511157756769604,
    ];
    let (state, _, parts) = after(&assembly, 2e-3, 2, 0.0, 1e-7);
    assert_near(&state.motion, &motion, 1e-6);
    assert!(parts > 2, "{parts}");
}

/// A table of which the last preload has the joint of [`cubic`].
fn loosening() -> Assembly {
    let law = |stiffness: f64, damping: f64, cubic: f64| {
        let mut law = crate::law::JointLaw::NONE;
        law.linear.stiffness[0][0] = stiffness;
        law.linear.damping[0][0] = damping;
        law.on[0] = Polynomial::cubic(cubic).into();
        law
    };
    let table = [(4.0, law(2e5, 40.0, 0.0)), (8.0, law(4e5, 20.0, 1e12))];
    let over = LawOverPreload::new(&table, crate::law::Beyond::Refused).unwrap();
    let mut assembly = check_case(Polynomial::cubic(1e12).into(), [4e5, 20.0]);
    assembly.joints[0].over_preload = Some(Box::new(over));
    assembly
}

#[test]
fn a_preload_that_stays_is_the_joint_at_it() {
    let exact = [4.256638020e-4, 1.672845601e-4, 0.4503936292, -0.6683705808];
    // propagated at another preload as well
    for about in [8.0, 5.0] {
        let mut steps = AssemblySteps::new(&loosening().about(&[about]), 1e-4, 1e-7).unwrap();
        let mut state = started(&steps);
        for _ in 0..10 {
            steps.step(&mut state, &[10.0, 8.0], &[0.0, 0.0]);
        }
        assert_near(&state.motion, &exact, 1e-6);
    }
}
