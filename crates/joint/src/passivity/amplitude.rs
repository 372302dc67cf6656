//! Damping that depends on the amplitude: whether it only takes energy, and up to where.

use bolted_joint_dynamics::{JointLaw, Polynomial, with_dofs};

use super::MatrixPassivity;
use crate::{DofSet, Joint};

/// Judgement on the damping matrix at the worst amplitude; none where the damping does not depend on it.
pub(super) fn passivity(joint: &Joint) -> Vec<MatrixPassivity> {
    let Some(terms) = &joint.higher else {
        return Vec::new();
    };
    let found = with_dofs!(joint.dofs.size(), D => {
        joint.law::<D>().map(|law| judge(&law, joint.dofs, &terms.amplitude))
    });
    // a malformed joint is told by `JointFile::validate`
    found.unwrap_or_default()
}

fn judge<const D: usize>(
    law: &JointLaw<D>,
    dofs: DofSet,
    amplitude: &[f64],
) -> Vec<MatrixPassivity> {
    let terms = law.polynomials();
    if !terms.iter().any(Polynomial::has_damping) {
        return Vec::new();
    }
    let farthest: [f64; D] =
        std::array::from_fn(|i| amplitude.get(i).copied().unwrap_or(f64::INFINITY));
    let least: [f64; D] = std::array::from_fn(|i| terms[i].least_damping(farthest[i]));
    let limits = law.active_amplitude();
    let alone: Vec<MatrixPassivity> = (0..D)
        .filter_map(|i| {
            let limit = limits[i].filter(|limit| *limit < farthest[i])?;
            let mut added = [0.0; D];
            added[i] = if least[i].is_finite() {
                least[i]
            } else {
                // it falls without end: what it is twice as far out
                lost_at(law, i, 2.0 * limit)
            };
            let (name, unit) = displacement(dofs, i);
            let path =
                format!("joint.damping with joint.higher beyond {name} = {limit:.4e} {unit}");
            Some(MatrixPassivity {
                passive: false,
                ..matrix(path, law, &added)
            })
        })
        .collect();
    if !alone.is_empty() {
        return alone;
    }
    // neither DOF alone makes the joint active, but both together may
    let mut path = "joint.damping with joint.higher".to_owned();
    for (i, limit) in limits.iter().enumerate() {
        let (name, unit) = displacement(dofs, i);
        if farthest[i].is_finite() {
            path += &format!(" up to {name} = {:.4e} {unit}", farthest[i]);
        }
        if let Some(limit) = limit {
            path += &format!(" (active beyond {limit:.4e} {unit})");
        }
    }
    vec![matrix(path, law, &least)]
}

/// Name and unit of a relative displacement.
fn displacement(dofs: DofSet, i: usize) -> (&'static str, &'static str) {
    let dof = dofs.row(i);
    (dof.name, dof.kind.displacement_unit())
}

/// Damping that the amplitude adds at this displacement, which is past where it turns negative.
fn lost_at<const D: usize>(law: &JointLaw<D>, i: usize, displacement: f64) -> f64 {
    let mut at = [0.0; D];
    // at rest at once: some small displacement
    at[i] = if displacement > 0.0 {
        displacement
    } else {
        1e-3
    };
    law.linearised_about(&at).linear.damping[i][i] - law.linear.damping[i][i]
}

/// C with so much added to its diagonal.
fn matrix<const D: usize>(path: String, law: &JointLaw<D>, added: &[f64; D]) -> MatrixPassivity {
    let mut damping = law.linear.damping;
    for (i, added) in added.iter().enumerate() {
        damping[i][i] += added;
    }
    let rows: Vec<Vec<f64>> = damping.iter().map(|row| row.to_vec()).collect();
    MatrixPassivity::new(path, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::HigherTerms;

    fn joint(c2: f64, c4: f64, amplitude: Option<f64>) -> Joint {
        let damper = Polynomial::with(&[], &[c2, c4]);
        let amplitude = amplitude.into_iter().collect();
        Joint {
            higher: Some(HigherTerms::of(&[damper], amplitude)),
            ..Joint::linear(DofSet::TRANSLATION, vec![vec![1e6]], vec![vec![10.0]])
        }
    }

    #[test]
    fn damping_that_turns_negative_within_the_stated_amplitude_is_active() {
        // 10 (1 − u/10⁻⁶): negative past 1 mm
        for amplitude in [None, Some(1.1e-3)] {
            let passivity = joint(-1e7, 0.0, amplitude).passivity();
            let active: Vec<String> = passivity.active().map(ToString::to_string).collect();
            assert_eq!(active.len(), 1);
            assert!(
                active[0].starts_with(
                    "joint.damping with joint.higher beyond y = 1.0000e-3 m is active: smallest eigenvalue -"
                ),
                "{active:?}"
            );
        }
        let passivity = joint(-1e7, 0.0, Some(0.9e-3)).passivity();
        assert!(passivity.is_passive());
        let line = passivity.matrices[2].to_string();
        // 10 − 1e7 · 0.81e-6
        assert!(
            line.contains("up to y = 9.0000e-4 m (active beyond 1.0000e-3 m) is passive: smallest eigenvalue 1.9000e0"),
            "{line}"
        );
    }

    #[test]
    fn a_dip_that_recovers_counts_too() {
        // 10 (1 − u/10⁻⁶)(1 − u/4·10⁻⁶), and the same lifted by its depth
        let (c2, c4) = (-1e7 - 2.5e6, 2.5e12);
        assert!(!joint(c2, c4, None).passivity().is_passive());
        assert!(!joint(c2, c4, Some(5e-3)).passivity().is_passive());
        // the deepest point is 10 − c2²/(4 c4) = 10 − 15.625
        assert!(joint(c2, 1.57 * c4, None).passivity().is_passive());
    }

    #[test]
    fn both_degrees_of_freedom_together_may_be_active() {
        let mut both = joint(-8e6, 0.0, Some(1e-3));
        both.dofs = DofSet::TRANSLATION_ROTATION;
        both.stiffness = vec![vec![1e6, 0.0], vec![0.0, 1e3]];
        both.damping = vec![vec![10.0, 2.0], vec![2.0, 5.0]];
        let dampers = [-8e6, -3e4].map(|c2| Polynomial::with(&[], &[c2]));
        both.higher = Some(HigherTerms::of(&dampers, vec![1e-3, 1e-2]));
        // alone [[2, 2], [2, 5]] and [[10, 2], [2, 2]], together [[2, 2], [2, 2]]: on the boundary
        assert!(both.passivity().is_passive());
        both.higher.as_mut().unwrap().amplitude[1] = 1.01e-2;
        let passivity = both.passivity();
        assert!(!passivity.is_passive());
        let line = passivity.active().next().unwrap().to_string();
        assert!(line.contains("up to y = 1.0000e-3 m"), "{line}");
    }

    #[test]
    fn a_joint_without_such_damping_is_judged_by_its_matrices() {
        let mut springs = joint(0.0, 0.0, None);
        let quintic = Polynomial::with(&[0.0, -1e18], &[]);
        springs.higher = Some(HigherTerms::of(&[quintic], Vec::new()));
        assert_eq!(springs.passivity().matrices.len(), 2);
    }
}
