//! Sensitivities against differences between solutions of changed models.

use bolted_joint::harmonic::{
    Derivative, HarmonicBalance, HarmonicLoads, Harmonics, Observed, Parameter, Side, Solution,
    Target,
};
use bolted_joint_dynamics::{Lap, law::Term};
use num_complex::Complex64;

use super::laps::with_rotation;

/// The lap with a parameter changed by a fraction of `size`.
fn changed(lap: &Lap<2>, parameter: Parameter, by: f64) -> Lap<2> {
    let mut lap = *lap;
    let joint = &mut lap.joint;
    match parameter {
        Parameter::Inertia(Side::A, dof) => lap.a.inertia[dof] += by,
        Parameter::Inertia(Side::B, dof) => lap.b.inertia[dof] += by,
        Parameter::SupportStiffness(Side::A, dof) => lap.a.stiffness[dof] += by,
        Parameter::SupportStiffness(Side::B, dof) => lap.b.stiffness[dof] += by,
        Parameter::SupportDamping(Side::A, dof) => lap.a.damping[dof] += by,
        Parameter::SupportDamping(Side::B, dof) => lap.b.damping[dof] += by,
        Parameter::JointStiffness(i, j) => {
            joint.linear.stiffness[i][j] += by;
            if i != j {
                joint.linear.stiffness[j][i] += by;
            }
        }
        Parameter::JointDamping(i, j) => {
            joint.linear.damping[i][j] += by;
            if i != j {
                joint.linear.damping[j][i] += by;
            }
        }
        Parameter::Term(term, dof) => {
            let mut polynomials = joint.polynomials();
            *polynomials[dof].coefficient_mut(term) += by;
            *joint = joint.linear.beside(polynomials);
        }
        _ => {}
    }
    lap
}

fn parameters() -> Vec<(Parameter, f64)> {
    let mut all = vec![
        (Parameter::JointStiffness(0, 0), 5.73e5),
        (Parameter::JointStiffness(0, 1), 5.82e3),
        (Parameter::JointStiffness(1, 1), 1.29e3),
        (Parameter::JointDamping(0, 0), 30.0),
        (Parameter::JointDamping(1, 0), -2.0),
        (Parameter::JointDamping(1, 1), 0.4),
        (Parameter::LoadFactor, 1.0),
        (Parameter::AngularFrequency, 1000.0),
    ];
    for side in [Side::A, Side::B] {
        for (dof, [m, k, c]) in [[1.0, 5e5, 10.0], [2e-3, 800.0, 0.04]]
            .into_iter()
            .enumerate()
        {
            all.push((Parameter::Inertia(side, dof), m));
            all.push((Parameter::SupportStiffness(side, dof), k));
            all.push((Parameter::SupportDamping(side, dof), c));
        }
    }
    for (dof, polynomial) in with_rotation().joint.polynomials().iter().enumerate() {
        for term in Term::ALL {
            let size = polynomial.coefficient(term).abs();
            assert!(size > 0.0, "the lap has every term");
            all.push((Parameter::Term(term, dof), size));
        }
    }
    all
}

const SEEN: [(Observed, usize); 7] = [
    (Observed::Relative(0), 1),
    (Observed::Relative(1), 3),
    (Observed::Relative(0), 0),
    (Observed::Body(Side::A, 0), 1),
    (Observed::Body(Side::B, 1), 1),
    (Observed::Body(Side::A, 1), 2),
    (Observed::Body(Side::B, 0), 3),
];

/// All that a solution tells.
fn told(balance: &HarmonicBalance<2>, solution: &Solution<2>) -> Vec<Complex64> {
    let mut all: Vec<Complex64> = SEEN
        .iter()
        .map(|&(observed, order)| balance.amplitude_of(solution, observed, order))
        .collect();
    all.push(solution.omega_rad_s().into());
    all.push(solution.load_factor().into());
    all.push(solution.damping_ratio().into());
    all
}

fn loads() -> HarmonicLoads<2> {
    let mut loads = HarmonicLoads::on_a(40.0);
    loads.a[1] = Complex64::new(0.2, 0.3);
    loads.b[0] = Complex64::new(-10.0, 15.0);
    loads.constant.a = [30.0, 0.1];
    loads.constant.b = [-20.0, 0.2];
    loads
}

/// Compares sensitivities with central differences of solutions; `solve` at a changed frequency and load.
fn compare(
    solve: impl Fn(&HarmonicBalance<2>, f64, &HarmonicLoads<2>, Option<&Solution<2>>) -> Solution<2>,
) {
    let lap = with_rotation();
    let balance = |lap: &Lap<2>| HarmonicBalance::new(lap, Harmonics::all(5).unwrap()).unwrap();
    let omega = 1400.0;
    let at = balance(&lap);
    let solution = solve(&at, omega, &loads(), None);
    let sizes = told(&at, &solution);
    let all = parameters();
    let names: Vec<Parameter> = all.iter().map(|(parameter, _)| *parameter).collect();
    let changes = at.sensitivities(&solution, &names).unwrap();
    for ((parameter, size), change) in all.into_iter().zip(&changes) {
        let moved = |by: f64| {
            let balance = balance(&changed(&lap, parameter, by));
            let omega = match parameter {
                Parameter::AngularFrequency => omega + by,
                _ => omega,
            };
            let loads = match parameter {
                Parameter::LoadFactor => loads().scaled(1.0 + by),
                _ => loads(),
            };
            told(&balance, &solve(&balance, omega, &loads, Some(&solution)))
        };
        let mut exact: Vec<Complex64> = SEEN
            .iter()
            .map(|&(observed, order)| at.amplitude_change(&solution, change, observed, order))
            .collect();
        exact.push(change.omega_rad_s.into());
        exact.push(change.load_factor.into());
        exact.push(change.damping_ratio.into());
        // Central differences with two steps, extrapolated: error of fourth order.
        let difference = |h: f64| -> Vec<Complex64> {
            let (up, down) = (moved(h * size), moved(-h * size));
            let pairs = up.iter().zip(down);
            pairs.map(|(up, down)| (up - down) / (2.0 * h)).collect()
        };
        let (coarse, fine) = (difference(4e-4), difference(2e-4));
        for (n, (coarse, fine)) in coarse.iter().zip(&fine).enumerate() {
            let numeric = (4.0 * fine - coarse) / 3.0;
            let error = (exact[n] * size - numeric).norm();
            let tolerance = 3e-7 * (numeric.norm() + 1e-3 * sizes[n].norm()) + 1e-14;
            assert!(
                error < tolerance,
                "{parameter:?} {n}: {} {numeric}",
                exact[n] * size
            );
        }
    }
}

#[test]
fn of_a_response_under_given_loads() {
    compare(|balance, omega, loads, start| balance.forced(omega, loads, start).unwrap());
}

#[test]
fn of_a_response_of_given_amplitude() {
    let target = Target {
        observed: Observed::Body(Side::B, 0),
        derivative: Derivative::Acceleration,
        amplitude: 200.0,
    };
    compare(|balance, omega, loads, start| {
        balance.controlled(omega, loads, target, start).unwrap()
    });
}

#[test]
fn of_a_phase_resonance() {
    for observed in [Observed::Relative(0), Observed::Body(Side::A, 0)] {
        let target = Target {
            observed,
            derivative: Derivative::Displacement,
            amplitude: 1.5e-4,
        };
        compare(|balance, omega, loads, start| {
            // the frequency is not given here
            let _ = omega;
            balance.resonance(loads, target, start).unwrap()
        });
    }
}

#[test]
fn of_a_free_motion() {
    compare(|balance, omega, _, start| {
        let _ = omega;
        balance.free(Target::relative(0, 2e-4), start).unwrap()
    });
}
