//! The cross-section of a beam, and what a rotation by finite differences loses on it.

use serde::Deserialize;

use super::beam::{SHEAR_COEFFICIENT, Theory};
use super::rotation::{Difference, FiniteDifference};

/// A rectangular cross-section that bends about its width.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Width, m.
    #[serde(rename = "width")]
    pub width_m: f64,
    /// Height in the direction of bending, m.
    #[serde(rename = "height")]
    pub height_m: f64,
    /// Young's modulus, Pa.
    #[serde(rename = "youngs_modulus")]
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    #[serde(default = "usual_poissons_ratio")]
    pub poissons_ratio: f64,
}

fn usual_poissons_ratio() -> f64 {
    Theory::USUAL_POISSONS_RATIO
}

impl Section {
    /// The rotation by a moment that a central difference does not see, rad/(N·m), with its derivative by ln EI. `None` for
    /// differences to one side: what those lose depends on how the beam goes on.
    ///
    /// A receptance of a beam has the local part |x_a − x_b|³/12EI − |x_a − x_b|/2κGA, which no difference over smooth functions
    /// gets right: ΔH_θθ = s/3EI − 1/(2s κGA) for points s apart.
    ///
    /// ```
    /// use bolted_joint_frf::structure::{FiniteDifference, Section};
    ///
    /// let section = Section { width_m: 0.025, height_m: 0.006, youngs_modulus_pa: 70e9, poissons_ratio: 0.33 };
    /// let [lost, _] = section.rotation_lost(&FiniteDifference::central(0.015)).ok_or("one-sided")?;
    /// // 0.312 s/EI on this section
    /// assert!((lost / (0.015 / 31.5) - 0.312).abs() < 1e-3);
    /// # Ok::<(), &str>(())
    /// ```
    #[must_use]
    pub fn rotation_lost(&self, difference: &FiniteDifference) -> Option<[f64; 2]> {
        if difference.side() != Difference::Central {
            return None;
        }
        let area = self.width_m * self.height_m;
        let bending = self.bending_stiffness_n_m2();
        let shear =
            SHEAR_COEFFICIENT * area * self.youngs_modulus_pa / (2.0 * (1.0 + self.poissons_ratio));
        let s = difference.spacing_m();
        let by_bending = s / (3.0 * bending);
        Some([by_bending - 1.0 / (2.0 * s * shear), -by_bending])
    }

    /// EI, N·m².
    #[must_use]
    pub fn bending_stiffness_n_m2(&self) -> f64 {
        self.youngs_modulus_pa * self.width_m * self.height_m.powi(3) / 12.0
    }
}
