//! From the joint file's lists to the fixed-size equations that are integrated.

use bolted_joint_dynamics as dynamics;
use thiserror::Error;

use super::{Body, DofSet, Joint, JointFile};

/// Why a joint file does not give the equations asked for.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LawError {
    /// The joint has another number of DOFs.
    #[error("joint.dofs: found {found}, expected {expected} degrees of freedom")]
    DofCount {
        /// DOFs of the joint.
        found: DofSet,
        /// Number asked for.
        expected: usize,
    },
    /// The joint depends on the preload: [`JointFile::at_preload`] takes it at one.
    #[error(
        "joint.over_preload: found a joint that depends on the preload, expected constant stiffness and damping; \
         take it at one preload"
    )]
    OverPreload,
    /// The table over the preload gives no joint.
    #[error("joint.over_preload: {0}")]
    Table(dynamics::TableDefect),
    /// The joint does not depend on the preload.
    #[error("joint.over_preload: not found, expected a table over the preload")]
    NoTable,
    /// The two bodies of the lap model are not there.
    #[error(
        "bodies: not found, expected the inertia, stiffness and damping of both bodies a and b; \
         add them, or export as element"
    )]
    NoBodies,
    /// A list has not as many entries as the joint has DOFs: [`JointFile::validate`] tells more.
    #[error(
        "{path}: found a list that does not fit joint.dofs, expected {expected} entries everywhere"
    )]
    Shape {
        /// Key of the list.
        path: &'static str,
        /// Number of DOFs.
        expected: usize,
    },
}

impl Joint {
    /// The load law of a joint with `D` DOFs a side.
    ///
    /// # Errors
    ///
    /// [`LawError`] where the joint has not `D` DOFs, depends on the preload, or is malformed.
    pub fn law<const D: usize>(&self) -> Result<dynamics::JointLaw<D>, LawError> {
        if self.dofs.count() != D {
            return Err(LawError::DofCount {
                found: self.dofs,
                expected: D,
            });
        }
        if self.over_preload.is_some() {
            return Err(LawError::OverPreload);
        }
        let cubic = if self.cubic.is_empty() {
            [0.0; D]
        } else {
            list("joint.cubic", &self.cubic)?
        };
        Ok(dynamics::JointLaw {
            stiffness: matrix("joint.stiffness", &self.stiffness)?,
            damping: matrix("joint.damping", &self.damping)?,
            cubic,
            higher: self.higher_terms()?,
        })
    }
}

impl Joint {
    /// Whether a term of higher order is not zero.
    #[must_use]
    pub fn has_terms_of_higher_order(&self) -> bool {
        self.higher.as_ref().is_some_and(|terms| {
            let lists = [
                &terms.quintic,
                &terms.septic,
                &terms.damping_quadratic,
                &terms.damping_quartic,
            ];
            lists.into_iter().flatten().any(|&term| term != 0.0)
        })
    }

    /// The terms of higher order, zero where they are left out.
    fn higher_terms<const D: usize>(&self) -> Result<dynamics::HigherTerms<D>, LawError> {
        let Some(terms) = &self.higher else {
            return Ok(dynamics::HigherTerms::NONE);
        };
        let or_zero = |path, entries: &[f64]| {
            if entries.is_empty() {
                Ok([0.0; D])
            } else {
                list(path, entries)
            }
        };
        Ok(dynamics::HigherTerms {
            quintic: or_zero("joint.higher.quintic", &terms.quintic)?,
            septic: or_zero("joint.higher.septic", &terms.septic)?,
            damping_quadratic: or_zero("joint.higher.damping_quadratic", &terms.damping_quadratic)?,
            damping_quartic: or_zero("joint.higher.damping_quartic", &terms.damping_quartic)?,
        })
    }
}

impl Joint {
    /// The load law over the preload of a joint with `D` DOFs a side.
    ///
    /// # Errors
    ///
    /// [`LawError`] where the joint has not `D` DOFs, does not depend on the preload, or is malformed.
    pub fn law_over_preload<const D: usize>(
        &self,
        beyond: dynamics::Beyond,
    ) -> Result<dynamics::JointOverPreload<D>, LawError> {
        let table = self.over_preload.as_ref().ok_or(LawError::NoTable)?;
        let entries = (0..table.preload.len())
            .map(|place| {
                let own = |list: &[Vec<Vec<f64>>]| list.get(place).cloned().unwrap_or_default();
                let joint = Self {
                    dofs: self.dofs,
                    stiffness: own(&table.stiffness),
                    damping: own(&table.damping),
                    cubic: table.cubic.get(place).cloned().unwrap_or_default(),
                    higher: None,
                    over_preload: None,
                };
                Ok((table.preload[place], joint.law()?))
            })
            .collect::<Result<Vec<_>, LawError>>()?;
        dynamics::JointOverPreload::new(&entries, beyond).map_err(LawError::Table)
    }
}

impl JointFile {
    /// The lap model: both bodies and the joint between them, `D` DOFs a side.
    ///
    /// # Errors
    ///
    /// [`LawError`] where there are no bodies, and as [`Joint::law`].
    pub fn lap<const D: usize>(&self) -> Result<dynamics::Lap<D>, LawError> {
        let joint = self.joint.law()?;
        let bodies = self.bodies.as_ref().ok_or(LawError::NoBodies)?;
        Ok(dynamics::Lap {
            joint,
            a: body("bodies.a", &bodies.a)?,
            b: body("bodies.b", &bodies.b)?,
        })
    }
}

impl JointFile {
    /// The linear laps of small motion about rest, and where the joint file states an amplitude, about the displacements
    /// within it at which stiffness and damping are largest or least.
    ///
    /// # Errors
    ///
    /// As [`JointFile::lap`].
    pub fn tangent_laps<const D: usize>(&self) -> Result<Vec<dynamics::Lap<D>>, LawError> {
        let lap = self.lap::<D>()?;
        let amplitude = match &self.joint.higher {
            Some(terms) if !terms.amplitude.is_empty() => {
                list("joint.higher.amplitude", &terms.amplitude)?
            }
            _ => [0.0; D],
        };
        let about = |displacement: &[f64; D]| dynamics::Lap {
            joint: lap.joint.linearised_about(displacement),
            ..lap
        };
        Ok(displacements(&lap.joint, &amplitude)
            .iter()
            .map(about)
            .collect())
    }
}

/// All combinations of the displacements at which stiffness or damping of small motion are largest or least within the
/// amplitude, rest first.
pub fn displacements<const D: usize>(
    law: &dynamics::JointLaw<D>,
    amplitude: &[f64; D],
) -> Vec<[f64; D]> {
    let mut all = vec![[0.0; D]];
    for i in 0..D {
        all = law
            .extremes(i, amplitude[i])
            .flat_map(|r| {
                all.iter().map(move |displacement| {
                    let mut displacement = *displacement;
                    displacement[i] = r;
                    displacement
                })
            })
            .collect();
    }
    all
}

fn body<const D: usize>(path: &'static str, body: &Body) -> Result<dynamics::Body<D>, LawError> {
    Ok(dynamics::Body {
        inertia: list(path, &body.inertia)?,
        stiffness: list(path, &body.stiffness)?,
        damping: list(path, &body.damping)?,
    })
}

fn list<const D: usize>(path: &'static str, entries: &[f64]) -> Result<[f64; D], LawError> {
    entries
        .try_into()
        .map_err(|_| LawError::Shape { path, expected: D })
}

fn matrix<const D: usize>(
    path: &'static str,
    rows: &[Vec<f64>],
) -> Result<[[f64; D]; D], LawError> {
    let mut matrix = [[0.0; D]; D];
    if rows.len() != D {
        return Err(LawError::Shape { path, expected: D });
    }
    for (target, row) in matrix.iter_mut().zip(rows) {
        *target = list(path, row)?;
    }
    Ok(matrix)
}
