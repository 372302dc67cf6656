//! The amplitude against closed forms, and against a walk along the balance.

use crate::alike::alike;
use crate::lap::{Body, Lap};
use crate::law::{JointLaw, Linear, Polynomial};

#[test]
fn the_symmetric_lap_escapes_where_the_theory_says() {
    let (k, k12, cubic): (f64, f64, f64) = (10.56e5, 4.56e6, -3e12);
    let lap = alike([[2.35], [k], [1.39]], [[[k12]], [[0.54]]], [cubic]);
    let expected = ((k + 2.0 * k12) / (-2.0 * cubic)).sqrt();
    let [escape] = lap.escape_amplitude();
    assert!((escape.unwrap() / expected - 1.0).abs() < 1e-14);
}

#[test]
fn a_hardening_joint_never_escapes() {
    let lap = alike([[1.0], [0.0], [0.0]], [[[1e6]], [[0.0]]], [1e9]);
    assert_eq!(lap.escape_amplitude(), [None]);
}

/// Tol Table 5.3's joint without supports, softening on each DOF as told.
fn with_rotation(cubic: [f64; 2]) -> Lap<2> {
    let stiffness = [[5.73e5, 5.82e3], [5.82e3, 1.29e3]];
    let bodies = [[1.0, 1e-3], [0.0; 2], [0.0; 2]];
    alike(bodies, [stiffness, [[0.0; 2]; 2]], cubic)
}

/// The largest held displacement of DOF `i` and how finely it is known, by walking along the other DOF's balance.
fn walked(lap: &Lap<2>, i: usize) -> (f64, f64) {
    let (k, j) = (&lap.joint.linear.stiffness, 1 - i);
    let load = |of: usize, x: f64| {
        let [k3, k5, k7] = lap.joint.on[of].polynomial().springs;
        k[of][of] * x + k3 * x.powi(3) + k5 * x.powi(5) + k7 * x.powi(7)
    };
    let tangent = |of: usize, x: f64| {
        let [k3, k5, k7] = lap.joint.on[of].polynomial().springs;
        k[of][of] + 3.0 * k3 * x.powi(2) + 5.0 * k5 * x.powi(4) + 7.0 * k7 * x.powi(6)
    };
    let (mut r, mut s): (f64, f64) = (0.0, 0.0);
    let step = 1e-5 * lap.escape_amplitude()[i].unwrap();
    loop {
        r += step;
        // Newton's method from the last balance; without one the other DOF runs away.
        for _ in 0..50 {
            s -= (k[j][i] * r + load(j, s)) / tangent(j, s);
        }
        let balance = k[j][i] * r + load(j, s);
        let stable = tangent(j, s) > 0.0;
        let force = load(i, r) + k[i][j] * s;
        if balance.abs() > 1e-9 * (k[j][i] * r).abs() || !stable || force <= 0.0 {
            return (r - step, step);
        }
    }
}

#[test]
fn with_rotation_the_other_degree_of_freedom_follows_its_own_cubic_too() {
    for cubic in [
        [-1e11, 0.0],
        [-1e11, 1e9],
        [-1e11, -1e6],
        [-1e11, -3e8],
        [-1e11, -1e9],
    ] {
        let lap = with_rotation(cubic);
        let escape = lap.escape_amplitude();
        for i in 0..2 {
            if cubic[i] < 0.0 {
                let (held, step) = walked(&lap, i);
                let beyond = (escape[i].unwrap() - held) / step;
                assert!(
                    (-0.01..1.01).contains(&beyond),
                    "{cubic:?} {i}: {beyond} steps"
                );
            } else {
                assert_eq!(escape[i], None);
            }
        }
    }
}

#[test]
fn what_is_not_held_at_rest_escapes_at_once() {
    let mut lap = with_rotation([-1e11, -1e9]);
    lap.joint.linear.stiffness[1][1] = 50.0; // k_yy k_θθ < k_yθ²
    assert_eq!(lap.escape_amplitude(), [Some(0.0); 2]);
}

/// One DOF whose secant stiffness, supports included, is the product of (1 − u/uₙ) times the linear one.
fn with_roots(roots: [f64; 3]) -> Lap<1> {
    let (k, supports) = (4e6, [3e5, 6e5]);
    let linear = k + supports[0] * supports[1] / (supports[0] + supports[1]);
    let [a, b, c] = roots.map(|root| 1.0 / root);
    let body = |stiffness: f64| Body {
        inertia: [2.0],
        stiffness: [stiffness],
        damping: [0.0],
    };
    Lap {
        joint: Linear {
            stiffness: [[k]],
            damping: [[0.0]],
        }
        .beside([Polynomial::with(
            &[
                -linear * (a + b + c),
                linear * (a * b + b * c + c * a),
                -linear * a * b * c,
            ],
            &[],
        )]),
        a: body(supports[0]),
        b: body(supports[1]),
    }
}

#[test]
fn the_first_of_several_unstable_equilibria_counts() {
    for (roots, expected) in [
        ([1e-6, 2e-6, 3e-6], 1e-6),
        ([5e-6, 2e-9, 3e-6], 2e-9),
        ([-1e-6, 4e-8, 5e-8], 4e-8),
        ([-1e-6, -4e-8, 5e-4], 5e-4),
        ([f64::INFINITY, 7e-7, 6e-7], 6e-7),
        // two that all but touch
        ([1.000_001e-6, 1e-6, 5e-6], 1e-6),
    ] {
        let [escape] = with_roots(roots).escape_amplitude();
        let relative = escape.unwrap() / f64::sqrt(expected) - 1.0;
        // a root's condition is by its distance from the next
        let tolerance = if roots[0] == 1.000_001e-6 {
            1e-9
        } else {
            1e-13
        };
        assert!(relative.abs() < tolerance, "{roots:?}: {relative:e}");
    }
}

#[test]
fn a_fifth_order_term_that_stiffens_in_time_prevents_the_escape() {
    // k + k3 u + k5 u² > 0 everywhere for k5 > k3²/(4 k)
    let mut lap = with_roots([f64::INFINITY, 1e-6, 1e-6]);
    let critical = lap.joint.on[0].polynomial();
    let mut with_quintic = |part: f64| {
        let mut terms = critical;
        terms.springs[1] *= part;
        lap.joint.on = [terms.into()];
        lap.escape_amplitude()
    };
    assert_eq!(with_quintic(1.000_001), [None]);
    let [escape] = with_quintic(0.999_999);
    // u = u₀ (1 − √(1 − q))/q with q = 1 − 10⁻⁶
    let q: f64 = 0.999_999;
    let expected = (1e-6 * (1.0 - (1.0 - q).sqrt()) / q).sqrt();
    assert!((escape.unwrap() / expected - 1.0).abs() < 1e-10);
    // and every law without a term that softens is held
    let mut terms = critical;
    terms.springs[0] = 0.0;
    lap.joint.on = [terms.into()];
    assert_eq!(lap.escape_amplitude(), [None]);
}

#[test]
fn the_joint_alone_escapes_where_the_lap_without_supports_does() {
    let mut lap = with_rotation([-1e11, -3e8]);
    assert_eq!(lap.joint.escape_amplitude(), lap.escape_amplitude());
    let springs = [[-1e11, -3e8], [2e17, -1e12], [-1e23, 3e14]];
    lap.joint = lap.joint.linear.beside(Polynomial::on_each(&springs, &[]));
    assert_eq!(lap.joint.escape_amplitude(), lap.escape_amplitude());
}

#[test]
fn with_rotation_all_terms_of_the_other_degree_of_freedom_count() {
    for (cubic, quintic, septic) in [
        ([-1e11, -1e6], [1e16, -1e10], [0.0, 0.0]),
        ([-1e11, 1e9], [-1e16, -1e12], [-1e21, 0.0]),
        ([-1e11, -1e9], [-1e16, 1e13], [1e21, -1e17]),
        ([3e10, -3e8], [-1e17, 0.0], [0.0, 1e16]),
        ([-1e11, -3e8], [5e15, 1e13], [-3e20, 0.0]),
    ] {
        let mut lap = with_rotation(cubic);
        let terms = Polynomial::on_each(&[cubic, quintic, septic], &[]);
        lap.joint = lap.joint.linear.beside(terms);
        let escape = lap.escape_amplitude();
        for i in 0..2 {
            let softens = cubic[i] < 0.0 || quintic[i] < 0.0 || septic[i] < 0.0;
            match escape[i] {
                Some(escape) => {
                    let (held, step) = walked(&lap, i);
                    let beyond = (escape - held) / step;
                    assert!(
                        (-0.01..1.01).contains(&beyond),
                        "{cubic:?} {quintic:?} {septic:?} {i}: {beyond} steps"
                    );
                }
                None => assert!(!softens, "{cubic:?} {quintic:?} {septic:?} {i}"),
            }
        }
    }
}

#[test]
fn the_change_of_the_amplitude_is_its_difference_quotient() {
    let plus = |lap: &Lap<2>, change: &Lap<2>, factor: f64| {
        let sum = |of: f64, by: f64| of + factor * by;
        let list = |of: &[f64; 2], by: &[f64; 2]| std::array::from_fn(|i| sum(of[i], by[i]));
        let body = |of: &Body<2>, by: &Body<2>| Body {
            stiffness: list(&of.stiffness, &by.stiffness),
            ..*of
        };
        Lap {
            joint: JointLaw::each([&lap.joint, &change.joint], |[of, by]| sum(of, by)),
            a: body(&lap.a, &change.a),
            b: body(&lap.b, &change.b),
        }
    };
    // by the load that holds it, by the fold of the other, by the closed form, and of the joint's other side
    for (cubic, quintic, septic) in [
        ([-1e11, 1e9], [0.0; 2], [0.0; 2]),
        ([-1e11, -1e9], [-1e16, 1e13], [1e21, -1e17]),
        ([-1e9, -1e9], [0.0; 2], [0.0; 2]),
        ([-1e11, 0.0], [0.0; 2], [0.0; 2]),
        ([-1e11, -3e8], [5e15, 1e13], [-3e20, 0.0]),
    ] {
        let mut lap = with_rotation(cubic);
        let terms = Polynomial::on_each(&[cubic, quintic, septic], &[]);
        lap.joint = lap.joint.linear.beside(terms);
        lap.a.stiffness = [2e5, 300.0];
        lap.b.stiffness = [1e5, 100.0];
        // something of every parameter, by its magnitude
        let mut change = lap;
        let springs = [
            [-0.3 * cubic[0], 0.7 * cubic[1]],
            [0.4 * quintic[0], -0.6 * quintic[1]],
            [0.2 * septic[0], 0.5 * septic[1]],
        ];
        change.joint = Linear {
            stiffness: [[3e5, -2e3], [-2e3, 500.0]],
            damping: [[0.0; 2]; 2],
        }
        .beside(Polynomial::on_each(&springs, &[]));
        change.a.stiffness = [1e5, -50.0];
        change.b.stiffness = [-3e4, 80.0];
        let step = 1e-5;
        let [above, below] = [step, -step].map(|factor| plus(&lap, &change, factor));
        let [above, below] = [above, below].map(|lap| lap.escape_amplitude());
        let tangent = lap.escape_amplitude_tangent(&change);
        for i in 0..2 {
            let (Some(above), Some(below)) = (above[i], below[i]) else {
                assert_eq!(tangent[i], 0.0);
                continue;
            };
            let quotient = (above - below) / (2.0 * step);
            assert!(quotient != 0.0);
            let error = tangent[i] / quotient - 1.0;
            assert!(error.abs() < 1e-7, "{cubic:?} {quintic:?} {i}: {error:e}");
        }
    }
}
