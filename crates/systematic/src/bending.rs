//! How a structure bends beside its joint: what a joint that is not where it is said to be does to a rotation, beyond what a rigid
//! arm would do.
//!
//! Where a beam soon ends on one side of the joint, a moment bends one more piece of it for each step towards that end:
//! ∂H_θθ/∂x = ±1/EI, and 0 on the whole where it goes on to both sides. The data hardly show it, since it is a compliance in series
//! with the joint's. Which sign it has depends on where the structure goes on, which a set of functions does not say; so the
//! length that bends is a cause of its own, as likely to either side.

use num_complex::Complex64;

use super::experiment::{ComplexMatrix, JointShape, MeasuredFunctions};

/// 1/EI beside each bolt, rad/(N·m²), from the moduli at the joint's drive points; none where it has no rotation.
///
/// Over a range of resonances the geometric mean of a modulus is that of the structure without end (Skudrzyk 1980). At the free
/// end of a beam that has no other, |H_yy| = √2/EIk³ and |H_θθ| = √2/EIk, so that 1/EI = |H_θθ|^(3/2)/(√2 |H_yy|^(1/2)). In the
/// middle both moduli are 1/(2√2) EIk³ and 1/(2√2) EIk, and the same expression gives a quarter of 1/EI.
pub(crate) fn flexibility_from_drive_points(
    functions: &MeasuredFunctions,
    formed: impl Fn(&[Complex64]) -> ComplexMatrix,
    joint: &JointShape,
) -> Vec<f64> {
    if !joint.has_rotation() {
        return Vec::new();
    }
    let lines = functions
        .entries
        .first()
        .map_or(0, |entry| entry.values.len());
    let mut means = vec![[Mean::default(); 2]; joint.bolts()];
    for line in 0..lines {
        let formed = formed(&functions.at(line));
        for (bolt, means) in means.iter_mut().enumerate() {
            for (mean, dof) in means.iter_mut().zip(joint.translation(bolt)..) {
                mean.add(formed[(dof, dof)].norm());
            }
        }
    }
    let of_bolt = |[y, theta]: &[Mean; 2]| {
        let of = (1.5 * theta.logarithm() - 0.5 * y.logarithm()).exp() / std::f64::consts::SQRT_2;
        if of.is_finite() { of } else { 0.0 }
    };
    means.iter().map(of_bolt).collect()
}

/// A geometric mean.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, modulus: f64) {
        if modulus > 0.0 {
            self.sum += modulus.ln();
            self.count += 1;
        }
    }

    /// Its logarithm; NaN without any value.
    fn logarithm(self) -> f64 {
        self.sum / self.count as f64
    }
}
