//! A lap model of its own: both bodies' complex amplitudes by Newton's method with numerical derivatives, one harmonic. It shares
//! nothing with the program under test.

use num_complex::Complex64;

/// m, k, c, k12, c12, k3
pub(crate) type Truth = [f64; 6];

/// Complex amplitudes of both bodies (m) with a force (N) on b, continued from a small force.
pub(crate) fn response(truth: &Truth, omega: f64, force: f64) -> [Complex64; 2] {
    const STEPS: u32 = 20;
    let mut x = [0.0; 4];
    for step in 1..=STEPS {
        let force = force * f64::from(step) / f64::from(STEPS);
        for _ in 0..50 {
            let rest = balance(truth, omega, force, &x);
            let scale = 1e-7 * (x.iter().map(|v| v.abs()).fold(0.0, f64::max) + 1e-9);
            let mut jacobian = nalgebra::Matrix4::zeros();
            for column in 0..4 {
                let mut sides = [x, x];
                sides[0][column] += scale;
                sides[1][column] -= scale;
                let [plus, minus] = sides.map(|x| balance(truth, omega, force, &x));
                for row in 0..4 {
                    jacobian[(row, column)] = (plus[row] - minus[row]) / (2.0 * scale);
                }
            }
            let change = jacobian.lu().solve(&nalgebra::Vector4::from(rest)).unwrap();
            for (value, change) in x.iter_mut().zip(change.iter()) {
                *value -= change;
            }
            if change.amax() < 1e-16 {
                break;
            }
        }
    }
    [Complex64::new(x[0], x[1]), Complex64::new(x[2], x[3])]
}

fn balance([m, k, c, k12, c12, k3]: &Truth, omega: f64, force: f64, x: &[f64; 4]) -> [f64; 4] {
    let (one, two) = (Complex64::new(x[0], x[1]), Complex64::new(x[2], x[3]));
    let r = one - two;
    let own = Complex64::new(k - m * omega * omega, c * omega);
    // (x₁ − x₂)³ has the fundamental ¾ |r|² r
    let joint = (Complex64::new(*k12, c12 * omega) + 0.75 * k3 * r.norm_sqr()) * r;
    let (first, second) = (own * one + joint, own * two - joint - force);
    [first.re, first.im, second.re, second.im]
}
