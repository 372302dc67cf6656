//! What a law with Masing's rule answers to a sinusoidal motion: the fundamental of its load in closed loops.
//!
//! Masing's rule: after each turn the load follows the curve of first loading F, at twice its size. The loop of the motion
//! U cos θ therefore follows from F alone.

use std::f64::consts::PI;

use bolted_joint_dynamics::Number;

use super::quadrature::nodes;

/// The fundamental of a load: f ≈ a₁ cos θ + b₁ sin θ while u = U cos θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fundamental<N> {
    /// a₁, in phase with the displacement: N, N·m. The equivalent stiffness is a₁/U.
    pub in_phase: N,
    /// b₁: N, N·m. The heat of a cycle is −πUb₁.
    pub quadrature: N,
}

/// The fundamental of the load of a law with Masing's rule, in the steady loop of `amplitude` U > 0 (m, rad).
///
/// `first_loading` is F(u), the load of a first motion to u ≥ 0, of which `knee` is where it has a corner (infinite where it has
/// none). Derivatives follow with the kind of number.
///
/// ```
/// use bolted_joint_harmonic::masing_fundamental;
///
/// // a spring k and a slider h in series: F = k u up to h/k
/// let (k, h, amplitude) = (2.0, 3.0, 5.0);
/// let found = masing_fundamental(|u: f64| (k * u).min(h), h / k, amplitude);
/// // b₁ = −(4h/π)(1 − h/(kU))
/// assert!((found.quadrature + 4.0 * h / std::f64::consts::PI * (1.0 - h / (k * amplitude))).abs() < 1e-12);
/// ```
pub fn masing_fundamental<N: Number>(
    first_loading: impl Fn(N) -> N,
    knee: f64,
    amplitude: N,
) -> Fundamental<N> {
    let top = first_loading(amplitude);
    let two = N::from(2.0);
    // way back from the turn at U: f(θ) = F(U) − 2 F((U − u)/2), (U − u)/2 = U sin²(θ/2)
    let load = |theta: f64| {
        let sine = (0.5 * theta).sin();
        top - two * first_loading(amplitude * N::from(sine * sine))
    };
    // the corner is where U sin²(θ/2) = φ
    let part = (knee / amplitude.value()).sqrt();
    let corner = if part < 1.0 { 2.0 * part.asin() } else { PI };
    let mut sums = [N::ZERO; 2];
    for [from, to] in [[0.0, corner], [corner, PI]] {
        if to <= from {
            continue;
        }
        for &(place, weight) in nodes(0.0) {
            let theta = from + (to - from) * place;
            let f = load(theta) * N::from((to - from) * weight);
            sums = [
                sums[0] + f * N::from(theta.cos()),
                sums[1] + f * N::from(theta.sin()),
            ];
        }
    }
    // the way forth is the same with the opposite sign: a₁, b₁ = (2/π) ∫₀^π f (cos θ, sin θ) dθ
    let [in_phase, quadrature] = sums.map(|sum| sum * N::from(2.0 / PI));
    Fundamental {
        in_phase,
        quadrature,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_dynamics::{
        Dual,
        law::{Jenkins, Law},
    };

    /// θ_s = arccos(1 − 2h/(kU)), a₁ = (kU/π)(θ_s − ½ sin 2θ_s), by mpmath with 30 digits.
    #[test]
    fn a_slider_has_its_closed_form() {
        for (stiffness, slip_force, amplitude, a1, b1) in [
            (2.0, 3.0, 5.0, 2.52315787734, -2.67380304394),
            (1.5e7, 4000.0, 6e-4, 3864.69258139, -2829.42121052),
        ] {
            let law = Jenkins {
                stiffness,
                slip_force,
            };
            let knee = slip_force / stiffness;
            let found = masing_fundamental(|u| law.load(&[0.0], u, 0.0), knee, amplitude);
            assert!((found.in_phase / a1 - 1.0_f64).abs() < 1e-11, "{found:?}");
            assert!((found.quadrature / b1 - 1.0).abs() < 1e-11, "{found:?}");
            // while it sticks it is a spring
            let stuck = masing_fundamental(|u| law.load(&[0.0], u, 0.0), knee, 0.9 * knee);
            assert!((stuck.in_phase / (0.9 * slip_force) - 1.0_f64).abs() < 1e-12);
            assert!(stuck.quadrature.abs() < 1e-12 * slip_force);
        }
    }

    /// Up to a knee F = K u − C u^p; with ∫₀^π sin^{2p}(θ/2) cos θ dθ = −√π Γ(p + ½)/Γ(p + 1) · p/(p + 1).
    #[test]
    fn a_power_has_its_closed_form_and_derivative() {
        // Γ(p + ½)/Γ(p + 1) for p = 1.7
        let (k, c, p, ratio) = (1.5, 0.4, 1.7, 0.713_285_807_492_458_8);
        let amplitude = 0.8_f64;
        let power = c * amplitude.powf(p);
        let a1 = k * amplitude - 4.0 / PI * power * PI.sqrt() * ratio * p / (p + 1.0);
        let of = |u: f64| masing_fundamental(|x: f64| k * x - c * x.powf(p), f64::INFINITY, u);
        let found = of(amplitude);
        assert!(
            (found.in_phase / a1 - 1.0).abs() < 1e-12,
            "{} {a1}",
            found.in_phase
        );
        // D = 8 ∫F − 4 U F = −πUb₁
        let heat = 4.0 * power * amplitude * (p - 1.0) / (p + 1.0);
        assert!((-PI * amplitude * found.quadrature / heat - 1.0).abs() < 1e-12);
    }

    #[test]
    fn derivatives_by_amplitude_and_parameters_are_those_of_differences() {
        let at = |k: f64, h: f64, u: f64| {
            let law = Jenkins {
                stiffness: k,
                slip_force: h,
            };
            masing_fundamental(|u| law.load(&[0.0], u, 0.0), h / k, u)
        };
        let values = [2e6, 300.0, 4e-4];
        let [k, h, u] = std::array::from_fn(|i| Dual::<3>::along(values[i], i));
        let law = Jenkins {
            stiffness: k,
            slip_force: h,
        };
        let knee = values[1] / values[0];
        let found = masing_fundamental(|u| law.load(&[0.0], u, Dual::ZERO), knee, u);
        for i in 0..3 {
            let moved = |sign: f64| {
                let mut moved = values;
                moved[i] *= 1.0 + sign * 1e-6;
                at(moved[0], moved[1], moved[2])
            };
            let (above, below) = (moved(1.0), moved(-1.0));
            let width = 2e-6 * values[i];
            for (change, difference) in [
                (found.in_phase.change[i], above.in_phase - below.in_phase),
                (
                    found.quadrature.change[i],
                    above.quadrature - below.quadrature,
                ),
            ] {
                let expected = difference / width;
                assert!(
                    (change - expected).abs() < 1e-7 * expected.abs(),
                    "{i}: {change} {expected}"
                );
            }
        }
    }
}
