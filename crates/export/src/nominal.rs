//! Typical magnitudes of an FMU's variables, from the joint that it is made of: what is 1 kN in one joint is 1 N in another.

use std::collections::BTreeMap;

use bolted_joint_dynamics::{DofKind, with_dofs};
use bolted_joint_joint::{JointFile, LawError};

use super::reference_run::stimulus;

/// Typical magnitude by the name of a type; what is not there keeps that of the frame.
pub(super) type Magnitudes = BTreeMap<&'static str, f64>;

/// Rates of the frame's types, m/s and rad/s: of the states of a lap, too.
const VELOCITY: f64 = 0.1;
const ANGULAR_VELOCITY: f64 = 1.0;

/// Relative motions at which the joint is used, and what it gives and stores there.
pub(super) fn magnitudes(file: &JointFile) -> Result<Magnitudes, LawError> {
    let dofs = file.joint.dofs;
    let mut found = Magnitudes::new();
    with_dofs!(dofs.size(), D => {
        let law = file.joint.law::<D>()?;
        let motion = stimulus::relative_motion(&law, dofs);
        for (i, dof) in dofs.rows().enumerate() {
            let (r, k, c) = (motion[i], law.linear.stiffness[i][i], law.linear.damping[i][i]);
            let (displacement, load, rate) = match dof.kind {
                DofKind::Translation => ("Displacement", "Force", VELOCITY),
                DofKind::Rotation => ("Rotation", "Moment", ANGULAR_VELOCITY),
            };
            for (name, size) in [
                (displacement, r),
                (load, k * r),
                ("Energy", 0.5 * k * r * r),
                ("Power", c * rate * rate),
            ] {
                let largest = found.entry(name).or_insert(0.0);
                *largest = largest.max(size);
            }
        }
    });
    found.retain(|_, size| *size > 0.0 && size.is_finite());
    Ok(found)
}

/// The power of ten that is not above it.
pub(super) fn power_of_ten(size: f64) -> Option<f64> {
    let exponent = size.log10().floor();
    let is_normal = (-300.0..300.0).contains(&exponent);
    // written as text, so that it is the very number
    is_normal
        .then(|| format!("1e{exponent}").parse().ok())
        .flatten()
}
