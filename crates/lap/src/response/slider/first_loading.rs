//! The curve of first loading of a law that slips, in real numbers and in those that change with its unknowns.

use bolted_joint_dynamics::Number;
use bolted_joint_dynamics::law::Jenkins;

use super::{MOST, SliderValues, Valued};

/// Load over displacement from rest: F = K_T u − K_l (u/φ_max)^(χ+1) u/(χ+2) up to φ_max, and F_S from there on.
#[derive(Clone, Copy, Debug)]
pub(in crate::response) struct FirstLoading<N> {
    stiffness: N,
    slip_force: N,
    /// φ_max, m.
    span: N,
    /// How it softens; one slider is straight up to its slip.
    softens: Option<Softens<N>>,
}

/// K_l (u/φ_max)^(χ+1)/(χ+2), stiffness that is lost at u, as e^(a + (χ+1) ln u).
#[derive(Clone, Copy, Debug)]
struct Softens<N> {
    /// χ + 1
    power: N,
    /// a = ln(K_l/(χ+2)) − (χ+1) ln φ_max
    shift: N,
}

impl<N: Number> FirstLoading<N> {
    /// Load at a displacement u ≥ 0 (m), N.
    #[inline]
    pub(in crate::response) fn at(&self, u: N) -> N {
        self.on_branch(u, u.value() >= self.span.value())
    }

    /// The same where all slips, or where not all does; each branch goes on smoothly beyond its end.
    #[inline]
    pub(in crate::response) fn on_branch(&self, u: N, slips: bool) -> N {
        if slips {
            return self.slip_force;
        }
        match &self.softens {
            Some(softens) if u.value() > 0.0 => (self.stiffness - softens.lost(u)) * u,
            _ => self.stiffness * u,
        }
    }
}

impl<N: Number> Softens<N> {
    #[inline]
    fn lost(&self, u: N) -> N {
        let (u_m, power) = (u.value(), self.power.value());
        let logarithm = u_m.ln();
        // d((χ+1) ln u) = ln u d(χ+1) + (χ+1)/u du; the second term has changes alone
        let exponent =
            self.shift + self.power.chain(power * logarithm, logarithm) + u.chain(0.0, power / u_m);
        let lost = exponent.value().exp();
        exponent.chain(lost, lost)
    }
}

/// ln x
fn logarithm<N: Number>(x: N) -> N {
    x.chain(x.value().ln(), x.value().recip())
}

impl SliderValues {
    /// Its curve of first loading.
    pub(in crate::response) fn first_loading(&self) -> FirstLoading<f64> {
        self.first_loading_of(self.logs)
    }

    /// The same with these unknowns in place of its own.
    pub(in crate::response) fn first_loading_of<N: Number>(
        &self,
        logs: [N; MOST],
    ) -> FirstLoading<N> {
        let law = match self.law(logs) {
            Valued::Jenkins(Jenkins {
                stiffness,
                slip_force,
            }) => {
                return FirstLoading {
                    stiffness,
                    slip_force,
                    span: slip_force / stiffness,
                    softens: None,
                };
            }
            Valued::Iwan(law) => law,
        };
        let one = N::from(1.0);
        let power = law.exponent + one;
        // φ_max = (F_S/K_T) (1 + β)/(β + (χ+1)/(χ+2)),  K_l = K_T/(1 + β)
        let through = law.ratio + power / (power + one);
        let span = law.slip_force / law.stiffness * (one + law.ratio) / through;
        let part = law.stiffness / (one + law.ratio) / (power + one);
        FirstLoading {
            stiffness: law.stiffness,
            slip_force: law.slip_force,
            span,
            softens: Some(Softens {
                power,
                shift: logarithm(part) - power * logarithm(span),
            }),
        }
    }
}
