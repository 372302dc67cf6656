//! Heat and tip of closed loops without the program's laws: closed forms, a sum over sliders, and an integration in time.

use std::f64::consts::{PI, TAU};

use bolted_joint_dynamics::law::{Iwan, Jenkins, LuGre, Valanis};

/// What a loop should have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    pub(super) force_at_tip_n: f64,
    /// Of a cycle.
    pub(super) heat_j: f64,
    /// Where it is from.
    pub(super) by: &'static str,
}

/// A rectangle.
pub(super) fn signum(force_n: f64, amplitude_m: f64) -> Reference {
    Reference {
        force_at_tip_n: force_n,
        // D = 4 F_c U
        heat_j: 4.0 * force_n * amplitude_m,
        by: "4 F_c U",
    }
}

/// A parallelogram on a spring, beyond U = h/k.
pub(super) fn elasto_slip(beside: f64, slider: &Jenkins, amplitude_m: f64) -> Reference {
    let [stiffness, slip_force] = [slider.stiffness, slider.slip_force];
    Reference {
        force_at_tip_n: beside * amplitude_m + slip_force,
        // D = 4 h (U − h/k)   (Masing 1926)
        heat_j: 4.0 * slip_force * (amplitude_m - slip_force / stiffness),
        by: "4 h (U − h/k)",
    }
}

/// Displacement at which the last slider of Iwan's law slips, φ_max in m.
pub(super) fn all_slip_m(law: &Iwan) -> f64 {
    let (chi, beta) = (law.exponent, law.ratio);
    // φ_max = F_S (1+β)/(K_T (β + (χ+1)/(χ+2)))   (Segalman 2005)
    law.slip_force * (1.0 + beta) / (law.stiffness * (beta + (chi + 1.0) / (chi + 2.0)))
}

/// The sum over the sliders of Iwan's law, each of which is a parallelogram.
pub(super) fn sliders(law: &Iwan, amplitude_m: f64) -> Reference {
    let (chi, beta) = (law.exponent, law.ratio);
    let last_m = all_slip_m(law);
    // ρ(φ) = R φ^χ + S δ(φ − φ_max): S has the part β/(1+β) of the stiffness, the others have the rest
    let at_last = law.stiffness * beta / (1.0 + beta);
    let density = (law.stiffness - at_last) * (chi + 1.0) / last_m.powf(chi + 1.0);
    let slipping_m = amplitude_m.min(last_m);
    // D = ∫ 4 φ (U − φ) ρ dφ over the sliders that slip
    let heat = |phi_m: f64| 4.0 * phi_m * (amplitude_m - phi_m);
    let among = integral(slipping_m, |phi_m| density * phi_m.powf(chi) * heat(phi_m));
    // F(U) = ∫ min(φ, U) ρ dφ
    let slipped = integral(slipping_m, |phi_m| density * phi_m.powf(chi + 1.0));
    let sticking =
        law.stiffness - at_last - integral(slipping_m, |phi_m| density * phi_m.powf(chi));
    Reference {
        force_at_tip_n: slipped + (sticking + at_last) * slipping_m,
        heat_j: among + at_last * heat(last_m).max(0.0),
        by: "∫ 4 φ (U − φ) ρ dφ over the sliders",
    }
}

/// ∫₀^end of a function that may have a weak singularity at the ends, by the double exponential rule (Takahasi and Mori 1974).
fn integral(end: f64, of: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 32.0;
    const STEPS: i32 = 112;
    let terms = (-STEPS..=STEPS).map(|step| {
        let t = STEP * f64::from(step);
        // x = 1/(1 + e^(−π sinh t)), dx/dt = π cosh t x (1 − x)
        let other = (PI * t.sinh()).exp();
        let (x, rest) = (other / (1.0 + other), 1.0 / (1.0 + other));
        of(end * x) * PI * t.cosh() * x * rest
    });
    end * STEP * terms.sum::<f64>()
}

/// Dahl's loop, which is that of LuGre's bristles where velocity has no part.
pub(super) fn slow_bristles(law: &LuGre, amplitude_m: f64) -> Reference {
    let force = law.static_force;
    // F_m = F_s tanh(σ₀ U/F_s), D = 4 F_s (U − F_m/σ₀): dF/dx = σ₀ (1 − s F/F_s) solved from tip to tip
    let force_at_tip_n = force * (law.stiffness * amplitude_m / force).tanh();
    Reference {
        force_at_tip_n,
        heat_j: 4.0 * force * (amplitude_m - force_at_tip_n / law.stiffness),
        by: "4 F_s (U − (F_s/σ_0) tanh(σ_0 U/F_s))",
    }
}

/// The bristles by Runge–Kutta's method, in steps of 1/8192 of the period, and the work of the fifth period.
pub(super) fn bristles(law: &LuGre, amplitude_m: f64, omega_rad_per_s: f64) -> Reference {
    const STEPS: u32 = 8192;
    const PERIODS: u32 = 5;
    let step_s = TAU / omega_rad_per_s / f64::from(STEPS);
    // ż = v − σ₀ |v| z/g(v) and F of Canudas de Wit, Olsson, Åström and Lischinsky (1995)
    let rate_and_force = |deflection: f64, velocity: f64| {
        let part = velocity / law.stribeck_velocity;
        let slip = law.slip_force + (law.static_force - law.slip_force) * (-part * part).exp();
        let rate = velocity - law.stiffness * velocity.abs() * deflection / slip;
        let force =
            law.stiffness * deflection + law.bristle_damping * rate + law.damping * velocity;
        (rate, force)
    };
    let velocity = |halves: u32| {
        let angle = PI * f64::from(halves) / f64::from(STEPS);
        -omega_rad_per_s * amplitude_m * angle.sin()
    };
    let (mut deflection, mut work) = (0.0, 0.0);
    for period in 0..PERIODS {
        work = if period + 1 == PERIODS { 0.0 } else { work };
        for step in 0..STEPS {
            let now = [2 * step, 2 * step + 1, 2 * step + 2].map(velocity);
            let slope = |ahead_m: f64, velocity: f64| {
                let (rate, force) = rate_and_force(deflection + ahead_m, velocity);
                [rate, force * velocity]
            };
            let first = slope(0.0, now[0]);
            let second = slope(0.5 * step_s * first[0], now[1]);
            let third = slope(0.5 * step_s * second[0], now[1]);
            let fourth = slope(step_s * third[0], now[2]);
            let of =
                |i: usize| step_s / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
            let (gone_m, gone_j) = (of(0), of(1));
            deflection += gone_m;
            work += gone_j;
        }
    }
    Reference {
        force_at_tip_n: law.stiffness * deflection,
        heat_j: work,
        by: "∮ F dx by Runge–Kutta's method, 8192 steps",
    }
}

/// Valanis' law as a spring E_t beside a load p: E_1, p_m and c.
fn slider_of(law: &Valanis) -> [f64; 3] {
    // E₁ = E₀ − E_t, p_m = σ₀ E₁/E₀, c = κ E₁/(E₀ − κ E_t): (2.3) with p = F − E_t x
    let stiffness = law.stiffness - law.slip_stiffness;
    let limit = law.slip_force * stiffness / law.stiffness;
    let sharpness = law.kappa * stiffness / (law.stiffness - law.kappa * law.slip_stiffness);
    [stiffness, limit, sharpness]
}

/// (2.3) solved from tip to tip, κ < 1.
pub(super) fn valanis(law: &Valanis, amplitude_m: f64) -> Reference {
    let [stiffness, limit, sharpness] = slider_of(law);
    // U = (p_m/E₁) (c tanh a + (1 − c) a), p(U) = p_m tanh a
    let wanted = stiffness * amplitude_m / limit;
    let [mut low, mut high] = [0.0, wanted / (1.0 - sharpness)];
    for _ in 0..200 {
        let middle: f64 = 0.5 * (low + high);
        if sharpness * middle.tanh() + (1.0 - sharpness) * middle < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    Reference {
        force_at_tip_n: law.slip_stiffness * amplitude_m + limit * low.tanh(),
        // D = 4 (p_m²/E₁) (1 − c) (a − tanh a)
        heat_j: 4.0 * limit * limit / stiffness * (1.0 - sharpness) * (low - low.tanh()),
        by: "4 (p_m²/E_1) (1 − c) (a − tanh a) with E_1 U/p_m = c tanh a + (1 − c) a, E_1 = E_0 − E_t and p_m = σ_0 E_1/E_0: (2.3) from tip to tip",
    }
}

/// The limit κ = 1 of (2.3), beyond U = p_m/E₁.
pub(super) fn without_micro_slip(law: &Valanis, amplitude_m: f64) -> Reference {
    let [stiffness, slip_force, _] = slider_of(law);
    let slider = Jenkins {
        stiffness,
        slip_force,
    };
    elasto_slip(law.slip_stiffness, &slider, amplitude_m)
}
