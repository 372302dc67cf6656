//! Harmonics of the loads of laws that remember, against their own ways in many small steps, closed forms and differences.

use std::f64::consts::TAU;

use bolted_joint_dynamics::law::{BoucWen, Dahl, Iwan, Jenkins, Valanis, dof_parameters};

use super::super::{Harmonics, masing_fundamental};
use super::*;

fn laws() -> Vec<DofLaws> {
    let iwan = Iwan {
        slip_force: 3.0,
        stiffness: 2.0,
        exponent: -0.4,
        ratio: 0.3,
    };
    let jenkins = Jenkins {
        stiffness: 2.0,
        slip_force: 1.1,
    };
    let valanis = Valanis {
        stiffness: 3.0,
        slip_stiffness: 0.4,
        slip_force: 1.3,
        kappa: 0.6,
    };
    let dahl = Dahl {
        stiffness: 2.0,
        slip_force: 0.9,
    };
    let bouc_wen = BoucWen {
        stiffness: 2.0,
        slip_force: 1.2,
        exponent: 1.4,
        beta: 0.7,
        gamma: -0.2,
    };
    let all: [DofLaws; 5] = [
        iwan.into(),
        jenkins.into(),
        valanis.into(),
        dahl.into(),
        bouc_wen.into(),
    ];
    let mut together = [0.0; DofLaws::<f64>::NONE.parameters().len()];
    for laws in &all {
        for (sum, parameter) in together.iter_mut().zip(laws.parameters()) {
            *sum += parameter;
        }
    }
    let mut list = all.to_vec();
    list.push(DofLaws::new(together));
    list.push(side_by_side());
    list
}

/// As many sliders as there can be on one DOF and two of Dahl's laws, each with numbers of its own.
fn side_by_side() -> DofLaws {
    let mut parameters = *DofLaws::<f64>::NONE.parameters();
    for (own, (law, parameter)) in parameters.iter_mut().zip(dof_parameters()) {
        let number = law.number as f64;
        *own = match (law.name, parameter.key) {
            ("jenkins" | "dahl", "stiffness") => 2.0 / number,
            ("jenkins", _) => 0.35 * number,
            ("dahl", _) => 0.8 / number,
            _ => 0.0,
        };
    }
    let laws = DofLaws::new(parameters);
    assert_eq!(laws.present().count(), 6);
    laws
}

/// Motions with two and with many turns.
fn motions() -> Vec<(Harmonics, Vec<f64>)> {
    let odd = Harmonics::odd(5).unwrap();
    let all = Harmonics::all(4).unwrap();
    let high = Harmonics::odd(31).unwrap();
    let wave = |n: usize| (1.0 + n as f64).powi(-2) * if n.is_multiple_of(3) { 0.8 } else { -0.3 };
    let of_high = (0..high.slots()).map(wave).collect();
    vec![
        (Harmonics::odd(1).unwrap(), vec![0.8, 0.6]),
        (odd.clone(), vec![1.0, 0.4, 0.06, -0.04, 0.01, 0.02]),
        (odd, vec![0.9, -0.2, -0.5, 0.3, 0.3, 0.35]),
        (
            all.clone(),
            vec![0.3, 1.0, 0.2, 0.05, -0.1, 0.02, 0.03, 0.01, 0.0],
        ),
        (high, of_high),
        (all, vec![-0.4, 0.5, 0.2, 0.6, -0.1, 0.3, 0.7, -0.4, 0.5]),
    ]
}

fn harmonics_of(laws: DofLaws, harmonics: &Harmonics, motion: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
    let slots = harmonics.slots();
    let (mut load, mut jacobian) = (vec![0.0; slots], DMatrix::zeros(slots, slots));
    let remembering = Remembering::new(laws);
    remembering.add(Course::new(harmonics, motion), 0, &mut load, &mut jacobian);
    for (n, coefficient) in motion.iter().enumerate() {
        load[n] += remembering.stuck() * coefficient;
        jacobian[(n, n)] += remembering.stuck();
    }
    (load, jacobian)
}

#[test]
fn the_harmonics_are_those_of_the_way_in_small_steps() {
    let count = 40_000;
    for laws in laws() {
        for (harmonics, motion) in motions() {
            let course = Course::new(&harmonics, &motion);
            let mut waves = vec![0.0; harmonics.slots()];
            let mut memory = DOF_AT_REST;
            let mut expected = vec![0.0; waves.len()];
            // what relaxes has done so after some periods
            for n in 0..8 * count {
                course.waves(TAU * (n % count) as f64 / count as f64, &mut waves);
                let r = course.place(&waves);
                laws.commit(&mut memory, r, 0.0);
                if n < 7 * count {
                    continue;
                }
                let load = laws.load(&memory, r, 0.0);
                for (slot, wave) in waves.iter().enumerate() {
                    expected[slot] += course.norm(slot) * load * wave / count as f64;
                }
            }
            let (found, _) = harmonics_of(laws, &harmonics, &motion);
            for (found, expected) in found.iter().zip(&expected) {
                let error = (found - expected).abs();
                assert!(error < 2e-7, "{laws:?} {motion:?}: {found} {expected}");
            }
        }
    }
}

#[test]
fn one_harmonic_is_that_of_masing_s_loop() {
    let law = Iwan {
        slip_force: 3.0,
        stiffness: 2.0,
        exponent: -0.4,
        ratio: 0.3,
    };
    let span = bolted_joint_dynamics::law::Law::<f64>::nonlinear_amplitude(&law, 0.0, 0.0);
    for part in [1e-3, 0.3, 1.0, 2.5] {
        let amplitude = part * span;
        let along = |u| bolted_joint_dynamics::law::Law::load::<f64>(&law, &[], u, 0.0);
        let expected = masing_fundamental(along, span, amplitude);
        let one = Harmonics::odd(1).unwrap();
        let (found, _) = harmonics_of(law.into(), &one, &[amplitude, 0.0]);
        for (found, expected) in found.iter().zip([expected.in_phase, expected.quadrature]) {
            let error = (found - expected).abs() / (2.0 * amplitude);
            assert!(error < 1e-12, "{part}: {found} {expected}");
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    for laws in laws() {
        for (harmonics, motion) in motions() {
            let (_, jacobian) = harmonics_of(laws, &harmonics, &motion);
            let step = 1e-5;
            for column in 0..motion.len() {
                let with = |times: f64| {
                    let mut motion = motion.clone();
                    motion[column] += times * step;
                    harmonics_of(laws, &harmonics, &motion).0
                };
                let [far_below, below, above, far_above] = [-2.0, -1.0, 1.0, 2.0].map(with);
                for row in 0..motion.len() {
                    // of fourth order
                    let expected = (far_below[row] - 8.0 * below[row] + 8.0 * above[row]
                        - far_above[row])
                        / (12.0 * step);
                    let found = jacobian[(row, column)];
                    assert!(
                        (found - expected).abs() < 1e-8 * jacobian.amax(),
                        "{laws:?} {motion:?} {row} {column}: {found} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_rests_bears_nothing() {
    let harmonics = Harmonics::all(2).unwrap();
    for laws in laws() {
        let (load, jacobian) = harmonics_of(laws, &harmonics, &[0.0; 5]);
        assert!(load.iter().all(|&load| load == 0.0));
        assert!(jacobian.iter().all(|entry| entry.is_finite()));
    }
}
