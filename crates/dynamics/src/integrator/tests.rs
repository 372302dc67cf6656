//! The integrator against closed forms and the textbook.

use super::*;
use crate::alike::alike;
use crate::law::{Linear, Polynomial};

fn decoupled(support_stiffness: f64, support_damping: f64) -> Lap<1> {
    let bodies = [[2.0], [support_stiffness], [support_damping]];
    alike(bodies, [[[0.0]], [[0.0]]], [0.0])
}

/// Two such bodies with a joint of these terms of higher order between them.
fn coupled(support_damping: f64, terms: Polynomial) -> Lap<1> {
    let mut lap = decoupled(2e4, support_damping);
    lap.joint = Linear {
        stiffness: [[7e3]],
        damping: [[0.3]],
    }
    .beside([terms]);
    lap
}

#[test]
fn a_damped_oscillator_follows_its_closed_form() {
    // x(t) = e^{−ζωt} (x₀ cos ω_d t + (ζω x₀/ω_d) sin ω_d t)
    let (omega, zeta): (f64, f64) = (50.0, 0.05);
    let lap = decoupled(2.0 * omega * omega, 2.0 * 2.0 * zeta * omega);
    let start = LapState {
        a: Motion {
            displacement: [1e-3],
            velocity: [0.0],
        },
        b: Motion::REST,
    };
    let loads = LapLoads { a: [0.0], b: [0.0] };
    let (duration_s, substeps) = (0.2, NonZeroU32::new(2000).unwrap());
    let end = LapIntegrator::new(&lap).advance(&start, &loads, duration_s, substeps);
    let omega_d = omega * (1.0 - zeta * zeta).sqrt();
    let (sin, cos) = (omega_d * duration_s).sin_cos();
    let expected = 1e-3 * (-zeta * omega * duration_s).exp() * (cos + zeta * omega / omega_d * sin);
    assert!(
        (end.a.displacement[0] - expected).abs() < 5e-14,
        "{} {expected}",
        end.a.displacement[0]
    );
    assert_eq!(end.b, Motion::REST);
}

#[test]
fn halving_the_step_divides_the_error_by_sixteen() {
    let omega: f64 = 50.0;
    let lap = decoupled(2.0 * omega * omega, 0.0);
    let start = LapState {
        a: Motion {
            displacement: [1.0],
            velocity: [0.0],
        },
        b: Motion::REST,
    };
    let loads = LapLoads { a: [0.0], b: [0.0] };
    let error = |count| {
        let end =
            LapIntegrator::new(&lap).advance(&start, &loads, 0.1, NonZeroU32::new(count).unwrap());
        (end.a.displacement[0] - (omega * 0.1).cos()).abs()
    };
    let ratio = error(50) / error(100);
    assert!((15.0..17.0).contains(&ratio), "{ratio}");
}

/// Loads on body a alone at the start, the middle and the end of a step.
fn on_a(load: impl Fn(f64) -> f64, time_s: f64, step_s: f64) -> [LapLoads<1>; 3] {
    [0.0, 0.5, 1.0].map(|part| LapLoads {
        a: [load(time_s + part * step_s)],
        b: [0.0],
    })
}

#[test]
fn one_step_integrates_a_quadratic_load_on_a_free_body_exactly() {
    // m ẍ = 3 − 4t + 5t²: RK4's weights are Simpson's rule for ẋ, and ∫(h − s) ẍ ds is exact to this degree too
    let integrator = LapIntegrator::new(&decoupled(0.0, 0.0));
    let (m, h): (f64, f64) = (2.0, 0.7);
    let loads = on_a(|t| 3.0 - 4.0 * t + 5.0 * t * t, 0.0, h);
    let end = integrator.step_with_loads(&LapState::REST, &loads, h);
    let velocity = (3.0 * h - 2.0 * h * h + 5.0 / 3.0 * h.powi(3)) / m;
    let displacement = (1.5 * h * h - 2.0 / 3.0 * h.powi(3) + 5.0 / 12.0 * h.powi(4)) / m;
    assert!((end.a.velocity[0] - velocity).abs() < 1e-15);
    assert!((end.a.displacement[0] - displacement).abs() < 1e-15);
    assert_eq!(end.b, Motion::REST);
}

#[test]
fn the_response_to_a_harmonic_load_converges_with_fourth_order() {
    // From rest, m ẍ + k x = F sin Ωt:  x = F/(m (ω² − Ω²)) (sin Ωt − Ω/ω sin ωt)
    let (omega, forcing, duration_s): (f64, f64, f64) = (50.0, 80.0, 0.1);
    let lap = decoupled(2.0 * omega * omega, 0.0);
    let integrator = LapIntegrator::new(&lap);
    let amplitude = 1e3 / (2.0 * (omega * omega - forcing * forcing));
    let expected =
        amplitude * ((forcing * duration_s).sin() - forcing / omega * (omega * duration_s).sin());
    let error = |count: u32| {
        let step_s = duration_s / f64::from(count);
        let mut state = LapState::REST;
        for n in 0..count {
            let loads = on_a(|t| 1e3 * (forcing * t).sin(), f64::from(n) * step_s, step_s);
            state = integrator.step_with_loads(&state, &loads, step_s);
        }
        ((state.a.displacement[0] - expected) / amplitude).abs()
    };
    for count in [200, 400, 800] {
        let order = (error(count) / error(2 * count)).log2();
        assert!((order - 4.0).abs() < 0.02, "{count} steps: order {order}");
    }
    assert!(error(3200) < 1e-11, "{:e}", error(3200));
}

#[test]
fn equal_loads_at_all_stages_are_held_loads() {
    let lap = coupled(3.0, Polynomial::cubic(1e9));
    let integrator = LapIntegrator::new(&lap);
    let loads = LapLoads {
        a: [12.0],
        b: [-5.0],
    };
    let held = integrator.advance(&LapState::REST, &loads, 4e-3, NonZeroU32::MIN);
    let stepped = integrator.step_with_loads(&LapState::REST, &[loads; 3], 4e-3);
    assert_eq!(held, stepped);
}

/// ẋ of the full lap as the equations of motion stand in the textbook, with divisions: `x` has the displacements
/// of a and b, then their velocities.
fn textbook_rate(lap: &Lap<2>, x: &[f64; 8], loads: &LapLoads<2>) -> [f64; 8] {
    let r: [f64; 2] = from_fn(|i| x[i] - x[2 + i]);
    let s: [f64; 2] = from_fn(|i| x[4 + i] - x[6 + i]);
    let Linear { stiffness, damping } = &lap.joint.linear;
    let mut rate = [0.0; 8];
    rate[..4].copy_from_slice(&x[4..]);
    for i in 0..2 {
        let Polynomial {
            springs: [k3, k5, k7],
            dampers: [c2, c4],
        } = lap.joint.on[i].polynomial();
        let mut joint = k3 * r[i].powi(3)
            + k5 * r[i].powi(5)
            + k7 * r[i].powi(7)
            + c2 * r[i].powi(2) * s[i]
            + c4 * r[i].powi(4) * s[i];
        for j in 0..2 {
            joint += stiffness[i][j] * r[j] + damping[i][j] * s[j];
        }
        let bodies = [(&lap.a, loads.a[i], -joint), (&lap.b, loads.b[i], joint)];
        for (n, (body, load, joint)) in bodies.into_iter().enumerate() {
            let at = 2 * n + i;
            let support = body.stiffness[i] * x[at] + body.damping[i] * x[4 + at];
            rate[4 + at] = (load - support + joint) / body.inertia[i];
        }
    }
    rate
}

#[test]
fn a_step_is_the_textbook_s_four_stages() {
    follows_the_textbook([[0.0; 2]; 4]);
}

#[test]
fn terms_of_higher_order_are_part_of_every_stage() {
    // at r = 1 mm, 0.1 rad each is some per cent of the linear stiffness or damping
    let terms = [[1e17, -8e5], [-3e22, 3e7], [4e7, 0.5], [-6e12, 9.0]];
    follows_the_textbook(terms);
    for (index, alone) in [[1e17, 0.0], [0.0, 3e7], [4e7, 0.0], [0.0, 9.0]]
        .into_iter()
        .enumerate()
    {
        let mut terms = [[0.0; 2]; 4];
        terms[index] = alone;
        follows_the_textbook(terms);
    }
}

/// Two hundred steps with these terms of higher order: k5, k7, c2, c4.
fn follows_the_textbook([quintic, septic, quadratic, quartic]: [[f64; 2]; 4]) {
    let body = |scale: f64| Body {
        inertia: [1.41 * scale, 1e-3 / scale],
        stiffness: [8.24e5, 1e3 * scale],
        damping: [200.0 * scale, 0.05],
    };
    let lap = Lap {
        joint: Linear {
            stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
            damping: [[108.3, -0.83], [-0.83, 0.083]],
        }
        .beside(Polynomial::on_each(
            &[[5e12, 1e6], quintic, septic],
            &[quadratic, quartic],
        )),
        a: body(1.0),
        b: body(2.5),
    };
    let integrator = LapIntegrator::new(&lap);
    let step_s = 1e-4;
    let loads: [LapLoads<2>; 3] = from_fn(|n| {
        let n = n as f64;
        LapLoads {
            a: [300.0 - 200.0 * n, 2.0 + n],
            b: [-100.0 + 50.0 * n * n, 3.0 - 2.0 * n],
        }
    });
    let mut state = LapState::REST;
    let mut x = [0.0; 8];
    let mut largest = [0.0_f64; 8];
    for _ in 0..200 {
        state = integrator.step_with_loads(&state, &loads, step_s);
        let plus = |factor: f64, rate: &[f64; 8]| from_fn(|i| x[i] + factor * rate[i]);
        let k1 = textbook_rate(&lap, &x, &loads[0]);
        let k2 = textbook_rate(&lap, &plus(step_s / 2.0, &k1), &loads[1]);
        let k3 = textbook_rate(&lap, &plus(step_s / 2.0, &k2), &loads[1]);
        let k4 = textbook_rate(&lap, &plus(step_s, &k3), &loads[2]);
        x = from_fn(|i| x[i] + step_s / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        let LapState { a, b } = state;
        let [found, other] = [a, b].map(|side| [side.displacement, side.velocity]);
        for i in 0..2 {
            for (at, value) in [
                (i, found[0][i]),
                (2 + i, other[0][i]),
                (4 + i, found[1][i]),
                (6 + i, other[1][i]),
            ] {
                largest[at] = largest[at].max(x[at].abs());
                let error = (value - x[at]).abs();
                assert!(error < 1e-13 * largest[at], "{at}: {value:e}, {:e}", x[at]);
            }
        }
    }
    // the cubic springs had a share in it
    assert!(5e12 * (x[0] - x[2]).powi(2) > 0.01 * lap.joint.linear.stiffness[0][0]);
}

#[test]
fn many_steps_at_once_are_as_many_single_steps() {
    agree_with_single_steps(Polynomial::cubic(1e9));
    agree_with_single_steps(Polynomial::with(&[1e9, -3e12, 2e18], &[1e4, -1e8]));
}

fn agree_with_single_steps(terms: Polynomial) {
    let lap = coupled(3.0, terms);
    let integrator = LapIntegrator::new(&lap);
    let loads = LapLoads {
        a: [12.0],
        b: [-5.0],
    };
    let count = NonZeroU32::new(64).unwrap();
    let at_once = integrator.advance(&LapState::REST, &loads, 64e-3, count);
    let mut state = LapState::REST;
    for _ in 0..64 {
        state = integrator.advance(&state, &loads, 64e-3 / 64.0, NonZeroU32::MIN);
    }
    assert_eq!(at_once, state);
    let stepped = (0..64).fold(LapState::REST, |state, _| {
        integrator.step_with_loads(&state, &[loads; 3], 64e-3 / 64.0)
    });
    assert_eq!(at_once, stepped);
    assert!(at_once.a.displacement[0] > 0.0);
}

/// ẍ = −ω² x with damping that depends on the amplitude: the energy that is lost is the power dissipated.
#[test]
fn what_the_dampers_take_is_missing_from_the_energy() {
    let lap = coupled(0.0, Polynomial::with(&[-1e8, 4e12, 2e17], &[2e5, 1e10]));
    let integrator = LapIntegrator::new(&lap);
    let loads = LapLoads { a: [0.0], b: [0.0] };
    let mut state = LapState::REST;
    state.a.displacement[0] = 5e-3;
    let start_j = lap.stored_energy(&[crate::law::DOF_AT_REST; 1], &state);
    let step_s = 1e-5;
    let mut lost_j = 0.0;
    for _ in 0..20_000 {
        // Boole's rule over one step, from five states
        let mut power = [0.0; 5];
        power[0] = lap.dissipated_power(&[crate::law::DOF_AT_REST; 1], &state);
        for watt in &mut power[1..] {
            state = integrator.advance(&state, &loads, step_s / 4.0, NonZeroU32::MIN);
            *watt = lap.dissipated_power(&[crate::law::DOF_AT_REST; 1], &state);
        }
        let weighted = 7.0 * (power[0] + power[4]) + 32.0 * (power[1] + power[3]) + 12.0 * power[2];
        lost_j += step_s * weighted / 90.0;
    }
    let end_j = lap.stored_energy(&[crate::law::DOF_AT_REST; 1], &state);
    assert!(lost_j > 0.1 * start_j, "{lost_j} of {start_j}");
    let balance = (start_j - end_j - lost_j) / start_j;
    assert!(balance.abs() < 1e-11, "{balance:e}");
}
