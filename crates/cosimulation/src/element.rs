//! The joint element between two rigid neighbours that the importer integrates.

use bolted_joint_dynamics::{JointLaw, with_dofs};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use thiserror::Error;

use super::StepBound;
use super::stability::Search;
use bolted_joint_joint::{Joint, LawError, displacements};

/// Inertia of a neighbour in one DOF, at the joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Inertia {
    /// Free, with this mass (kg) or moment of inertia (kg·m²).
    Free(f64),
    /// Held, or so heavy that it does not move.
    Fixed,
}

impl Inertia {
    /// Acceleration per load.
    fn mobility(self) -> f64 {
        match self {
            Self::Free(inertia) => inertia.recip(),
            Self::Fixed => 0.0,
        }
    }
}

/// Inertia of both neighbours, one entry for each DOF of the joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Neighbours {
    /// Of the part at side a.
    pub a: Vec<Inertia>,
    /// Of the part at side b.
    pub b: Vec<Inertia>,
}

/// How the importer couples the element and its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Master {
    /// The joint's load is read, held over the step, and the neighbours are integrated exactly under it.
    Held,
    /// As [`Master::Held`], but the load is that of the communication point before.
    Late,
    /// The load is read; velocities are stepped with it, then displacements with the new velocities.
    SemiImplicit,
}

impl Master {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Held, Self::Late, Self::SemiImplicit];
}

/// Why there is no bound.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CouplingError {
    /// The joint has no constant matrices.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Lists that do not fit the joint.
    #[error(
        "found {found} values for the joint's {expected} degrees of freedom, expected one each"
    )]
    Shape {
        /// Entries that were found.
        found: usize,
        /// DOFs of the joint.
        expected: usize,
    },
    /// An inertia, stiffness, damping or amplitude that is none.
    #[error("found {found:?}, expected {expected}")]
    Value {
        /// What was found.
        found: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A point that a neighbour does not have.
    #[error("found {found}, expected a point of the structure: {}", there.join(", "))]
    NoPoint {
        /// The point.
        found: String,
        /// Points that there are.
        there: Vec<String>,
    },
    /// Stiffness or damping with which motion grows by itself.
    #[error(
        "the joint's tangent stiffness or its damping is not positive semidefinite at {}, so that motion grows there \
         whatever the step; give a smaller amplitude",
        at(.amplitude)
    )]
    Active {
        /// Relative displacement of each DOF, m, rad.
        amplitude: Vec<f64>,
    },
}

fn at(amplitude: &[f64]) -> String {
    if amplitude.iter().all(|&r| r == 0.0) {
        "rest".to_owned()
    } else {
        format!("the relative displacement {amplitude:?}")
    }
}

/// How long the communication step may be for the element of `joint` between `neighbours`.
///
/// Nonlinear stiffness and damping enter by the tangent: at rest, and where there is an `amplitude` of the relative
/// displacement (m, rad) also at it, in each DOF alone and in all, and at what turns on the way; the shortest bound counts.
///
/// # Errors
///
/// [`CouplingError`].
pub fn element_bound(
    joint: &Joint,
    neighbours: &Neighbours,
    master: Master,
    amplitude: Option<&[f64]>,
) -> Result<StepBound, CouplingError> {
    let dofs = joint.dofs.count();
    for found in [neighbours.a.len(), neighbours.b.len()] {
        check_count(found, dofs)?;
    }
    for inertia in neighbours.a.iter().chain(&neighbours.b) {
        match *inertia {
            Inertia::Free(found) if !(found.is_finite() && found > 0.0) => {
                let expected = "an inertia greater than zero";
                return Err(CouplingError::Value { found, expected });
            }
            _ => {}
        }
    }
    let mut bound = StepBound::Nothing;
    let tangents = with_dofs!(joint.dofs.size(), D => tangents::<D>(joint, amplitude))?;
    for tangent in tangents {
        let Some(relative) = Relative::new(&tangent.stiffness, &tangent.damping, neighbours) else {
            continue;
        };
        if !relative.is_passive() {
            return Err(CouplingError::Active {
                amplitude: tangent.at,
            });
        }
        bound = bound.min(relative.bound(master));
    }
    Ok(bound)
}

pub(super) fn check_count(found: usize, expected: usize) -> Result<(), CouplingError> {
    if found == expected {
        Ok(())
    } else {
        Err(CouplingError::Shape { found, expected })
    }
}

/// Rest, and where an amplitude is given the places within it at which stiffness or damping of small motion is largest or
/// least.
pub(super) fn places<const D: usize>(
    law: &JointLaw<D>,
    amplitude: Option<&[f64]>,
) -> Result<Vec<[f64; D]>, CouplingError> {
    let Some(amplitude) = amplitude else {
        return Ok(vec![[0.0; D]]);
    };
    check_count(amplitude.len(), D)?;
    if let Some(&found) = amplitude.iter().find(|r| !(r.is_finite() && **r >= 0.0)) {
        let expected = "an amplitude of zero or more";
        return Err(CouplingError::Value { found, expected });
    }
    Ok(displacements(law, &std::array::from_fn(|i| amplitude[i])))
}

/// Stiffness and damping of small motion about the places within the amplitude, and the places.
fn tangents<const D: usize>(
    joint: &Joint,
    amplitude: Option<&[f64]>,
) -> Result<Vec<Tangent>, CouplingError> {
    let law = joint.law::<D>()?;
    let matrix = |entries: &[[f64; D]; D]| DMatrix::from_fn(D, D, |i, j| entries[i][j]);
    Ok(places(&law, amplitude)?
        .iter()
        .map(|place| {
            let linear = law.linearised_about(place).linear;
            Tangent {
                at: place.to_vec(),
                stiffness: matrix(&linear.stiffness),
                damping: matrix(&linear.damping),
            }
        })
        .collect())
}

/// Small motion about the places within the amplitude, as [`element_bound`] takes them.
pub(super) fn all_tangents(
    joint: &Joint,
    amplitude: Option<&[f64]>,
) -> Result<Vec<Tangent>, CouplingError> {
    with_dofs!(joint.dofs.size(), D => tangents::<D>(joint, amplitude))
}

/// Small motion about a relative displacement.
pub(super) struct Tangent {
    at: Vec<f64>,
    pub(super) stiffness: DMatrix<f64>,
    pub(super) damping: DMatrix<f64>,
}

/// The relative motion q̈ + C q̇ + K q = 0 in coordinates q = W^−½ r with W = M_a⁻¹ + M_b⁻¹.
struct Relative {
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    /// Fastest rate, 1/s.
    rate: f64,
}

/// Part of the largest stiffness or damping below which a direction counts as free of the joint.
const FREE: f64 = 1e-14;

impl Relative {
    /// `None` where no neighbour moves against the joint.
    fn new(
        stiffness: &DMatrix<f64>,
        damping: &DMatrix<f64>,
        neighbours: &Neighbours,
    ) -> Option<Self> {
        let sides = neighbours.a.iter().zip(&neighbours.b);
        let root: Vec<f64> = sides
            .map(|(a, b)| (a.mobility() + b.mobility()).sqrt())
            .collect();
        let moving: Vec<usize> = (0..root.len()).filter(|&i| root[i] > 0.0).collect();
        let normalised = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(moving.len(), moving.len(), |i, j| {
                root[moving[i]] * matrix[(moving[i], moving[j])] * root[moving[j]]
            })
        };
        let (stiffness, damping) = (normalised(stiffness), normalised(damping));
        let rate = stiffness.norm().sqrt().max(damping.norm());
        if rate == 0.0 || !rate.is_finite() {
            return None;
        }
        // directions in which the joint does nothing would be double eigenvalues at 1, which rounding moves off it
        let both = &stiffness / (rate * rate) + &damping / rate;
        let eigen = SymmetricEigen::new(both);
        let kept: Vec<DVector<f64>> = (0..moving.len())
            .filter(|&i| eigen.eigenvalues[i].abs() > FREE)
            .map(|i| eigen.eigenvectors.column(i).into_owned())
            .collect();
        let basis = DMatrix::from_columns(&kept);
        let project = |matrix: DMatrix<f64>| basis.transpose() * matrix * &basis;
        Some(Self {
            stiffness: project(stiffness),
            damping: project(damping),
            rate,
        })
    }

    /// Whether motion does not grow by itself.
    fn is_passive(&self) -> bool {
        let smallest =
            |matrix: &DMatrix<f64>| SymmetricEigen::new(matrix.clone()).eigenvalues.min();
        smallest(&self.stiffness) >= -1e-12 * self.rate * self.rate
            && smallest(&self.damping) >= -1e-12 * self.rate
    }

    fn bound(&self, master: Master) -> StepBound {
        let search = Search {
            rate: self.rate,
            range: match master {
                // one entry of G is 1/H, and rounding grows with it
                Master::Late => [1e-6, 1e2],
                Master::Held | Master::SemiImplicit => [1e-9, 1e2],
            },
            slack: match master {
                Master::Late => |step| 1e-13 + 1e-14 / step,
                Master::Held | Master::SemiImplicit => |_| 1e-13,
            },
        };
        search.bound(|step_s| self.generator(master, step_s))
    }

    /// G of x ← x + H G x for x = (ρq, q̇), with the rate ρ so that all entries are of one size.
    fn generator(&self, master: Master, step_s: f64) -> DMatrix<f64> {
        let (k, c, rate) = (&self.stiffness, &self.damping, self.rate);
        let n = k.nrows();
        let one = DMatrix::<f64>::identity(n, n);
        // q ← q + H q̇ − αH² f, q̇ ← q̇ − H f, with f = K q + C q̇
        // α = ½: exact under a held load; α = 1: displacements with the new velocities
        let alpha = if master == Master::SemiImplicit {
            1.0
        } else {
            0.5
        };
        let size = if master == Master::Late { 3 * n } else { 2 * n };
        let mut g = DMatrix::zeros(size, size);
        let mut block = |row: usize, column: usize, entries: DMatrix<f64>| {
            g.view_mut((row * n, column * n), (n, n))
                .copy_from(&entries);
        };
        match master {
            Master::Held | Master::SemiImplicit => {
                block(0, 0, k * (-alpha * step_s));
                block(0, 1, (&one - c * (alpha * step_s)) * rate);
                block(1, 0, k / -rate);
                block(1, 1, -c);
            }
            Master::Late => {
                // the third part of x is f/ρ of the point before
                block(0, 1, &one * rate);
                block(0, 2, &one * (-alpha * step_s * rate * rate));
                block(1, 2, &one * -rate);
                block(2, 0, k / (rate * rate * step_s));
                block(2, 1, c / (rate * step_s));
                block(2, 2, &one / -step_s);
            }
        }
        g
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_joint::DofSet;

    fn joint(stiffness: &[&[f64]], damping: &[&[f64]], cubic: &[f64]) -> Joint {
        let rows = |rows: &[&[f64]]| rows.iter().map(|row| row.to_vec()).collect();
        let dofs = DofSet::all().find(|dofs| dofs.count() == cubic.len());
        Joint {
            cubic: cubic.to_vec(),
            ..Joint::linear(dofs.unwrap(), rows(stiffness), rows(damping))
        }
    }

    fn free(a: &[f64], b: &[f64]) -> Neighbours {
        let all = |side: &[f64]| side.iter().map(|&m| Inertia::Free(m)).collect();
        Neighbours {
            a: all(a),
            b: all(b),
        }
    }

    fn close(found: StepBound, expected_s: f64) {
        let found_s = found.seconds();
        assert!(
            (found_s / expected_s - 1.0).abs() < 1e-9,
            "{found:?}, expected {expected_s}"
        );
    }

    #[test]
    fn one_dof_has_its_closed_forms() {
        let (m_a, m_b) = (1.4, 2.0);
        let mu = m_a * m_b / (m_a + m_b);
        // from light damping, where the delay decides, to heavy, where the damper's own limit does
        for (k, c) in [(4.56e6_f64, 0.54), (4.56e6, 54.0), (1e4, 700.0), (0.0, 3.0)] {
            let joint = joint(&[&[k]], &[&[c]], &[0.0]);
            let bound =
                |master| element_bound(&joint, &free(&[m_a], &[m_b]), master, None).unwrap();
            let omega = (k / mu).sqrt();
            let zeta = if k > 0.0 {
                c / (2.0 * (k * mu).sqrt())
            } else {
                f64::INFINITY
            };
            close(bound(Master::Held), (2.0 * c / k).min(2.0 * mu / c));
            if k > 0.0 {
                // Jury's conditions on λ² − (2 − ω²H² − 2ζωH) λ + (1 − 2ζωH)
                close(
                    bound(Master::SemiImplicit),
                    2.0 / omega * ((1.0 + zeta * zeta).sqrt() - zeta),
                );
            }
        }
    }

    #[test]
    fn a_late_load_is_a_third_of_the_bound_for_light_damping() {
        let joint = joint(&[&[4.56e6]], &[&[0.54]], &[0.0]);
        let bound = element_bound(&joint, &free(&[1.0], &[1.0]), Master::Late, None).unwrap();
        let expected_s = 2.0 * 0.54 / (3.0 * 4.56e6);
        assert!(
            (bound.seconds() / expected_s - 1.0).abs() < 1e-5,
            "{bound:?}"
        );
    }

    #[test]
    fn an_undamped_joint_cannot_be_held_but_stepped_semi_implicitly() {
        let joint = joint(&[&[4e6]], &[&[0.0]], &[0.0]);
        let neighbours = Neighbours {
            a: vec![Inertia::Free(1.0)],
            b: vec![Inertia::Fixed],
        };
        let bound = |master| element_bound(&joint, &neighbours, master, None).unwrap();
        assert_eq!(bound(Master::Held), StepBound::Never);
        assert_eq!(bound(Master::Late), StepBound::Never);
        close(bound(Master::SemiImplicit), 2.0 / 2e3);
    }

    #[test]
    fn without_coupling_the_fastest_dof_decides() {
        let both = joint(
            &[&[5.73e5, 0.0], &[0.0, 1.29e3]],
            &[&[10.83, 0.0], &[0.0, 0.083]],
            &[0.0, 0.0],
        );
        let (m, j) = (0.01215, 9.477e-7);
        let bound = element_bound(&both, &free(&[m, j], &[m, j]), Master::Held, None).unwrap();
        // rotation: 2μ/c is the shortest of all four
        close(bound, 2.0 * (j / 2.0) / 0.083);
        let mut held = free(&[m, j], &[m, j]);
        held.a[1] = Inertia::Fixed;
        held.b[1] = Inertia::Fixed;
        close(
            element_bound(&both, &held, Master::Held, None).unwrap(),
            2.0 * 10.83 / 5.73e5,
        );
        held.a[0] = Inertia::Fixed;
        held.b[0] = Inertia::Fixed;
        assert_eq!(
            element_bound(&both, &held, Master::Held, None),
            Ok(StepBound::Nothing)
        );
    }

    #[test]
    fn the_amplitude_enters_by_the_tangent() {
        let (k, c, k3, r) = (4.56e6, 54.0, 3e12, 1e-3);
        let hardening = joint(&[&[k]], &[&[c]], &[k3]);
        let neighbours = free(&[1.0], &[1.0]);
        let bound = |joint: &Joint, r| element_bound(joint, &neighbours, Master::Held, Some(&[r]));
        close(
            bound(&hardening, r).unwrap(),
            2.0 * c / (k + 3.0 * k3 * r * r),
        );
        close(bound(&hardening, 0.0).unwrap(), 2.0 * c / k);
        let softening = joint(&[&[k]], &[&[c]], &[-k3]);
        // the joint at rest is the stiffer one
        close(bound(&softening, 1e-4).unwrap(), 2.0 * c / k);
        assert!(matches!(
            bound(&softening, r),
            Err(CouplingError::Active { .. })
        ));
    }

    #[test]
    fn a_direction_without_stiffness_is_left_out() {
        // K and C of rank one: the joint resists y + 2θ alone
        let outer = |s: f64| vec![vec![s, 2.0 * s], vec![2.0 * s, 4.0 * s]];
        let mut joint = joint(
            &[&[0.0, 0.0], &[0.0, 0.0]],
            &[&[0.0, 0.0], &[0.0, 0.0]],
            &[0.0; 2],
        );
        joint.stiffness = outer(1e6);
        joint.damping = outer(5.0);
        let bound = element_bound(&joint, &free(&[1.0, 1.0], &[1.0, 1.0]), Master::Held, None);
        // one mode with c/k = 5e-6; 2c/k decides
        close(bound.unwrap(), 1e-5);
    }
}
