//! What the finite difference of A's rotation does to the joints of chapter 5.

use nalgebra::DMatrix;

use bolted_joint_frf::structure::{FiniteDifference, Section, Theory};
use bolted_joint_identify::{JointMatrices, JointModel, Lines, Receptances, Unknown};

use crate::draws::rows;
use crate::error::ReproduceError;
use crate::outcome::{Row, Spread};

use super::bolts::{Bolt, Bolts};
use super::structures::{self, SPACING_M, joint};

/// The published joints without the piece of beam that the central difference puts into them.
pub(crate) fn with_section() -> Result<Vec<Row>, ReproduceError> {
    let bolts = Bolts::published()?;
    let mut found = Vec::new();
    for (name, bolt) in [
        ("M10x16", &bolts.m10x16),
        ("M8x16", &bolts.m8x16),
        ("M10x35", &bolts.m10x35),
        ("M8x35", &bolts.m8x35),
        ("M6x30", &bolts.m6x30),
    ] {
        let published = joint(bolt.updated);
        let lost = bolt.rotation_lost();
        let alone = [without(&published, lost)].into_iter().flatten();
        let alone: Vec<JointMatrices> = alone.collect();
        found.extend(rows(name, JointModel::Full, None, &bolt.updated, &alone));
        let [.., k_rotation, _, _, c_rotation] = Unknown::of(JointModel::Full)[..] else {
            continue;
        };
        for (of, quantity) in [
            (k_rotation, "k_thetatheta, change"),
            (c_rotation, "c_thetatheta, change"),
        ] {
            let change = alone
                .first()
                .map(|alone| 100.0 * (of.value(alone) / of.value(&published) - 1.0));
            let change = change.filter(|change| change.is_finite());
            found.push(Row::computed(
                name,
                quantity,
                "%",
                change.map(Spread::exact),
            ));
        }
        let [_, at_2s, _] = structures::deviations_percent(&bolt.with_rotation(lost)?, &published)?;
        let case = format!("{name}, published joint, r.m.s. deviation");
        found.push(Row::computed(&case, "2s", "%", Some(Spread::exact(at_2s))));
    }
    Ok(found)
}

/// A joint without a rotation (rad/(N·m)) that lies in series with it.
///
/// K*'⁻¹ = K*⁻¹ − ΔH of K* = K + jωC, to first order in C: K'⁻¹ = K⁻¹ − ΔH and C' = M C Mᵀ with M = K'K⁻¹.
fn without(joint: &JointMatrices, lost: f64) -> Option<JointMatrices> {
    let flexibility = joint.stiffness.clone().try_inverse()?;
    let mut alone: DMatrix<f64> = flexibility.clone();
    alone[(1, 1)] -= lost;
    let stiffness = alone.try_inverse()?;
    let carried = &stiffness * flexibility;
    Some(JointMatrices {
        damping: &carried * &joint.damping * carried.transpose(),
        stiffness,
    })
}

impl Bolt {
    /// The assembly of the published joint, and an A with the rotation that the difference loses.
    fn with_rotation(&self, lost: f64) -> Result<Lines, ReproduceError> {
        let lines = self.lines()?;
        let a = (0..lines.frequency_hz.len()).map(|line| {
            let mut h = lines.a.at(line).into_owned();
            h[(1, 1)] += lost;
            h
        });
        Ok(Lines {
            a: Receptances::Exact(a.collect()),
            ..lines
        })
    }

    /// Of A, which has the cross-section and the material of B, rad/(N·m).
    fn rotation_lost(&self) -> f64 {
        let section = Section {
            width_m: self.beam.width_m,
            height_m: self.beam.height_m,
            youngs_modulus_pa: self.beam.youngs_modulus_pa,
            poissons_ratio: Theory::USUAL_POISSONS_RATIO,
        };
        let difference = FiniteDifference::central(SPACING_M);
        section
            .rotation_lost(&difference)
            .map_or(0.0, |[lost, _]| lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With all of A's rotation the joint without it returns the assembly, and the published one does not.
    #[test]
    fn what_is_lost_is_in_series_with_the_joint() {
        let Bolts { m10x16, m6x30, .. } = Bolts::published().unwrap();
        // s/3EI − 1/(2s κGA) of 25 mm × 6 mm aluminium, EI = 31.5 N·m², κGA = 5/6 · 26.92 GPa · 150 mm²
        let lost = 0.015 / 94.5 - 1.0 / (0.03 * 5.0 / 6.0 * 26.923e9 * 1.5e-4);
        assert!((m10x16.rotation_lost() / lost - 1.0).abs() < 1e-4);
        for bolt in [m10x16, m6x30] {
            let published = joint(bolt.updated);
            let lost = bolt.rotation_lost();
            let lines = bolt.with_rotation(lost).unwrap();
            let deviations =
                |joint: &JointMatrices| structures::deviations_percent(&lines, joint).unwrap();
            let alone = without(&published, lost).unwrap();
            assert!(
                deviations(&alone).iter().all(|percent| *percent < 0.5),
                "{:?}",
                deviations(&alone)
            );
            assert!(
                deviations(&published).iter().all(|percent| *percent > 5.0),
                "{:?}",
                deviations(&published)
            );
        }
    }
}
