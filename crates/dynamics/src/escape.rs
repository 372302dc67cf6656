//! How far a softening joint may open before nothing holds it any more.

mod balance;

use crate::{
    condensation::following,
    lap::{Body, Lap},
    law::JointLaw,
};
use balance::{Balance, Spring};

impl<const D: usize> JointLaw<D> {
    /// Relative displacement (m, rad) of each DOF at which the load of the joint's own springs has fallen to zero, as
    /// [`Lap::escape_amplitude`] has it for a lap without supports.
    #[must_use]
    pub fn escape_amplitude(&self) -> [Option<f64>; D] {
        std::array::from_fn(|i| Some(Balance::of(self, &[0.0; D], i)?.escape()?.amplitude()))
    }

    /// Change of [`JointLaw::escape_amplitude`] with the law; zero where there is no such amplitude.
    #[must_use]
    pub fn escape_amplitude_tangent(&self, law_change: &Self) -> [f64; D] {
        tangent([self, law_change], [&[0.0; D]; 2])
    }
}

impl<const D: usize> Lap<D> {
    /// Relative displacement (m, rad) of each DOF at which the softening joint's force, together with the
    /// supports', has fallen to zero for the first time; beyond it the solution runs away, or to another place of rest
    /// where terms of higher order catch it. `None` where the joint does not soften or always holds, zero where even small
    /// motion is not held.
    ///
    /// For the symmetric lap with a cubic spring this is √((k + 2 k12)/(−2 kN)). With rotation the other DOF follows as its
    /// own force balance asks, all its terms included, and as long as there is such a balance; several others that are coupled to
    /// it follow by their stiffness at rest.
    #[must_use]
    pub fn escape_amplitude(&self) -> [Option<f64>; D] {
        let supports = self.supports_in_series();
        std::array::from_fn(|i| {
            Some(
                Balance::of(&self.joint, &supports, i)?
                    .escape()?
                    .amplitude(),
            )
        })
    }

    /// Change of [`Lap::escape_amplitude`] with the parameters; zero where there is no such amplitude.
    #[must_use]
    pub fn escape_amplitude_tangent(&self, lap_change: &Self) -> [f64; D] {
        // d(k_a k_b/(k_a + k_b)) = (k_b² dk_a + k_a² dk_b)/(k_a + k_b)²
        let change = std::array::from_fn(|i| {
            let (k_a, k_b) = (self.a.stiffness[i], self.b.stiffness[i]);
            if !(k_a > 0.0 && k_b > 0.0) {
                return 0.0;
            }
            let part = |other: f64| (other / (k_a + k_b)) * (other / (k_a + k_b));
            part(k_b) * lap_change.a.stiffness[i] + part(k_a) * lap_change.b.stiffness[i]
        });
        tangent(
            [&self.joint, &lap_change.joint],
            [&self.supports_in_series(), &change],
        )
    }

    /// Stiffness by which the supports hold the relative motion of each DOF.
    fn supports_in_series(&self) -> [f64; D] {
        let stiffness = |body: &Body<D>, i: usize| body.stiffness[i];
        std::array::from_fn(|i| {
            // k_s = k_a k_b / (k_a + k_b)
            let (k_a, k_b) = (stiffness(&self.a, i), stiffness(&self.b, i));
            if k_a > 0.0 && k_b > 0.0 {
                k_a * k_b / (k_a + k_b)
            } else {
                0.0
            }
        })
    }
}

/// Change of the amplitudes with law and supports.
fn tangent<const D: usize>(laws: [&JointLaw<D>; 2], supports: [&[f64; D]; 2]) -> [f64; D] {
    std::array::from_fn(|i| {
        let Some(balance) = Balance::of(laws[0], supports[0], i) else {
            return 0.0;
        };
        balance.escape().map_or(0.0, |escape| {
            let change = match following(&held(laws[0], supports[0]), i) {
                Some(motion) => Spring::change_of_following(laws[1], supports[1], i, &motion),
                None => Spring::of(laws[1], supports[1], i),
            };
            let other_change = balance
                .other_dof()
                .map(|j| (Spring::of(laws[1], supports[1], j), coupling(laws[1], i, j)));
            balance.tangent(&escape, &change, other_change)
        })
    })
}

/// K + S, symmetric: what holds the relative motion about rest.
fn held<const D: usize>(law: &JointLaw<D>, supports: &[f64; D]) -> [[f64; D]; D] {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let support = if row == column { supports[row] } else { 0.0 };
            coupling(law, row, column) + support
        })
    })
}

/// Coupling stiffness of two DOFs.
fn coupling<const D: usize>(law: &JointLaw<D>, i: usize, j: usize) -> f64 {
    let stiffness = &law.linear.stiffness;
    0.5 * (stiffness[i][j] + stiffness[j][i])
}

#[cfg(test)]
mod tests;
