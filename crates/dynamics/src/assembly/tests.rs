//! The check case of one elastic mode, a rigid body and a cubic joint between them. Its numbers come from NumPy and SciPy
//! (DOP853 at 1e-13 where the reference is in time).

use std::sync::Arc;

use super::{coordinates::Parts, modal, system::System, *};
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

fn started(steps: &AssemblySteps) -> Underway {
    let mut state = steps.coordinates().state(&steps.at_rest());
    state.motion[1] = 1e-3 / 2.0_f64.sqrt();
    steps.coordinates().underway(&state)
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
fn a_step_is_that_of_collocation_in_all_coordinates() {
    // SciPy: the exponential of the whole system with its forces, and these by iteration
    let short = [
        8.287234349138508e-6,
        6.973951759758307e-4,
        0.16379396030080273,
        -0.19214072792258785,
    ];
    let long = [
        1.658170110655824e-4,
        5.093404513379738e-4,
        0.5320295567709594,
        -0.6489514484134727,
    ];
    for (length_s, expected, digits) in [(1e-4, short, 1e-13), (5e-4, long, 1e-8)] {
        let mut steps = without_halves(&cubic(), length_s);
        let mut underway = started(&steps);
        assert_eq!(steps.step(&mut underway, &[10.0], &[0.0]), 1);
        let state = steps.coordinates().state(&underway);
        // where steps are long the forces are iterated to nine digits
        assert_near(&state.motion, &expected, digits);
    }
}

/// After 1 ms; mpmath to 20 digits.
const AFTER_A_MILLISECOND: [f64; 4] = [
    4.2566380198772553e-4,
    1.672_845_600_867_275e-4,
    0.450_393_629_236_601_7,
    -0.668_370_580_820_914_7,
];

#[test]
fn the_error_is_of_eighth_order() {
    // after 4 ms; mpmath to 20 digits
    let exact = [
        -3.1601605925632135e-4,
        -1.248_314_614_437_041e-4,
        0.393_672_824_956_792_8,
        -0.618_439_359_135_262_5,
    ];
    let error = |count: u32| {
        let (state, ..) = after(&cubic(), 4e-3, count, 0.0, f64::INFINITY);
        let off = |(found, exact): (&f64, f64)| (found - exact).abs();
        state.motion.iter().zip(exact).map(off).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(12), error(24));
    let order = (coarse / fine).log2();
    assert!((7.0..10.0).contains(&order), "{coarse} {fine}");
    assert!(error(100) < 1e-12, "{}", error(100));
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
    let started = started(&steps);
    let (reached, balance, parts) = followed(&mut steps, started, count, [10.0, slope]);
    (steps.coordinates().state(&reached), balance, parts)
}

fn followed(
    steps: &mut AssemblySteps,
    mut underway: Underway,
    count: u32,
    [first, slope]: [f64; 2],
) -> (Underway, f64, usize) {
    let length_s = steps.length_s();
    let begun = steps.stored_energy_j(&steps.coordinates().state(&underway));
    let mut parts = 0;
    for step in 0..count {
        let load = first + slope * length_s * f64::from(step);
        parts += steps.step(&mut underway, &[load], &[slope * length_s]);
    }
    let state = steps.coordinates().state(&underway);
    let stored = steps.stored_energy_j(&state) - begun;
    let balance = state.supplied_j - state.dissipated_j - stored;
    (underway, balance, parts)
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
fn dampers_of_the_joint_s_own_keep_the_digits() {
    let laws = Polynomial::with(&[1e12], &[3e7]);
    let assembly = check_case(laws.into(), [4e5, 20.0]);
    let motion = [
        0.0004205695796005307,
        0.0001785199860787754,
        0.4470154054327644,
        -0.6484305944935513,
    ];
    let [supplied, dissipated] = [-0.01631592624841526, 0.05320588319268768];
    // loads that go along with time, and dampers, leave what SciPy has
    for (count, digits) in [(4, 1e-5), (10, 1e-9), (50, 1e-12)] {
        let (state, balance, _) = after(&assembly, 1e-3, count, 2e4, f64::INFINITY);
        assert_near(&state.motion, &motion, digits);
        assert_near(
            &[state.supplied_j, state.dissipated_j],
            &[supplied, dissipated],
            digits,
        );
        assert!(balance.abs() < digits * dissipated, "{count} {balance}");
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
        let (reached, balance, parts) = followed(&mut steps, rest, count, [200.0, 0.0]);
        let state = steps.coordinates().state(&reached);
        assert_near(&state.motion, &motion, tolerance);
        assert!(balance.abs() < 0.1 * tolerance, "{balance}");
        // beside the first steps, that suit the slider's own stiffness, only six events ask for halves
        assert!(parts < most, "{parts}");
    }
}

#[test]
fn steps_are_halved_until_they_suit_the_joint() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let (state, _, parts) = after(&cubic(), 1e-3, 1, 0.0, tolerance);
        assert_near(&state.motion, &AFTER_A_MILLISECOND, tolerance);
        assert!((2..40).contains(&parts), "{parts}");
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
    // propagated at another preload as well
    for about in [8.0, 5.0] {
        let mut steps = AssemblySteps::new(&loosening().about(&[about]), 1e-4, 1e-7).unwrap();
        let mut underway = started(&steps);
        for _ in 0..10 {
            steps.step(&mut underway, &[10.0, 8.0], &[0.0, 0.0]);
        }
        let state = steps.coordinates().state(&underway);
        assert_near(&state.motion, &AFTER_A_MILLISECOND, 1e-8);
    }
}

#[test]
fn a_small_part_of_a_step_is_of_first_order() {
    let laws = Polynomial::with(&[1e12], &[3e7]);
    let assembly = check_case(laws.into(), [4e5, 20.0]);
    let of = |power: usize, _: usize| if power == 0 { 10.0 } else { 0.0 };
    let off = |rest_s: f64| {
        let mut steps = AssemblySteps::new(&assembly, rest_s, 1e-9).unwrap();
        let mut exact = started(&steps);
        // where velocities are not zero
        for _ in 0..(1e-4 / rest_s).round() as u32 {
            steps.step_along(&mut exact, of);
        }
        let mut found = exact.clone();
        steps.step_along(&mut exact, of);
        steps.creep(&mut found, rest_s, of);
        let [exact, found] = [exact, found].map(|own| steps.coordinates().state(&own));
        let of_motion = found.motion.iter().zip(&exact.motion);
        let motion = of_motion.map(|(found, exact)| (found / exact - 1.0).abs());
        let energies = [
            found.supplied_j - exact.supplied_j,
            found.dissipated_j - exact.dissipated_j,
        ];
        [
            motion.fold(0.0, f64::max),
            energies[0].abs(),
            energies[1].abs(),
        ]
    };
    let [coarse, fine] = [off(1e-6), off(1e-7)];
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!((50.0..200.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }
}

#[test]
fn modes_go_on_as_the_coordinates_do() {
    let assembly = modal::tests::assembly(8.0);
    let in_modes = AssemblyCoordinates::of(&assembly);
    // by exponentials of the whole matrix
    let whole = AssemblyCoordinates(Arc::new(Parts::within(System::of(&assembly), None)));
    assert!(in_modes.0.frame.is_some());
    let load = |power: usize, _: usize| [40.0, 3.0, -2.0, 1.0][power];
    let [found, expected] = [in_modes, whole].map(|coordinates| {
        let mut steps = AssemblySteps::within(&coordinates, 1e-4, 1e-9).unwrap();
        let mut state = AssemblyState::at_rest(&assembly);
        for (i, own) in state.motion.iter_mut().enumerate() {
            *own = 1e-5 * (i as f64 - 7.0);
        }
        state.dissipated_j = 0.25;
        let mut underway = coordinates.underway(&state);
        for _ in 0..200 {
            steps.step_along(&mut underway, load);
        }
        steps.creep(&mut underway, 1e-9, load);
        (coordinates.state(&underway), coordinates.underway(&state))
    });
    let largest = |own: &[f64]| own.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let size = assembly.size();
    for part in [0..size, size..2 * size] {
        let (own, other) = (&found.0.motion[part.clone()], &expected.0.motion[part]);
        let off: Vec<f64> = own.iter().zip(other).map(|(a, b)| a - b).collect();
        assert!(largest(&off) < 1e-9 * largest(other), "{off:?} {other:?}");
    }
    let energies = |own: &AssemblyState| [own.supplied_j, own.dissipated_j];
    assert_near(&energies(&found.0), &energies(&expected.0), 1e-9);
    // what is entered is what is told
    assert_near(&[found.1.balance_j], &[expected.1.balance_j], 1e-15);
}
