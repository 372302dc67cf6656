//! From the joint file's lists to the fixed-size equations that are integrated.

use bolted_joint_dynamics::{
    self as dynamics, Dof,
    law::{
        DOF_PARAMETER_COUNT, Declaration, DofLaws, Parameter, RememberedAs, Term, dof_parameters,
    },
};
use thiserror::Error;

use super::{Body, DofSet, Friction, HigherTerms, Joint, JointFile, JointProblem};

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
    /// A law whose load is what an importer integrates, with springs that change with the preload.
    #[error(
        "joint.over_preload.friction: found \"{law}\" with a stiffness that depends on the preload, expected the same at all \
         preloads: its load is a state that follows no preload while it moves; take the joint at one preload (`export --preload`, \
         or `preload` in the joint's table of an assembly file)"
    )]
    StateOverPreload {
        /// Name of the law.
        law: &'static str,
    },
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
        path: String,
        /// Number of DOFs.
        expected: usize,
    },
    /// A preload is given, but the joint does not depend on it.
    #[error(
        "preload: found {found_n_m:?} N·m for a joint that does not depend on the preload, expected none; leave it out, or add \
         joint.over_preload"
    )]
    ConstantJoint {
        /// The preload asked for, N·m.
        found_n_m: f64,
    },
    /// The preload is beyond those of the table.
    #[error(
        "preload: found {found_n_m:?} N·m, expected {first_n_m:?} to {last_n_m:?} N·m, the range of joint.over_preload.preload: \
         beyond it nothing is known of the joint"
    )]
    OutsideTable {
        /// The preload asked for, N·m.
        found_n_m: f64,
        /// Lowest preload of the table, N·m.
        first_n_m: f64,
        /// Highest preload of the table, N·m.
        last_n_m: f64,
    },
    /// The joint file contradicts itself.
    #[error("the joint file is not valid: {}", JointProblem::list(problems))]
    Invalid {
        /// Everything that is wrong, at least one.
        problems: Vec<JointProblem>,
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
        let linear = dynamics::Linear {
            stiffness: matrix("joint.stiffness", &self.stiffness)?,
            damping: matrix("joint.damping", &self.damping)?,
        };
        let mut parameters = [[0.0; DOF_PARAMETER_COUNT]; D];
        for (place, (law, parameter)) in dof_parameters().enumerate() {
            for (i, own) in self.on_each::<D>(law, parameter)?.into_iter().enumerate() {
                parameters[i][place] = own;
            }
        }
        Ok(dynamics::JointLaw {
            linear,
            on: parameters.map(DofLaws::new),
        })
    }

    /// A parameter of a law on each DOF, zero where it is left out.
    fn on_each<const D: usize>(
        &self,
        law: &Declaration,
        parameter: &Parameter,
    ) -> Result<[f64; D], LawError> {
        match Term::ALL.into_iter().find(|term| term.row() == parameter) {
            Some(term) if self.term(term).is_empty() => Ok([0.0; D]),
            Some(term) => list(&term_path(term), self.term(term)),
            None => Ok(std::array::from_fn(|i| {
                self.friction_on(self.dofs.row(i), law)
                    .and_then(|own| own.value(parameter))
                    .unwrap_or(0.0)
            })),
        }
    }

    /// The coefficients of a term of the polynomial law on each DOF; empty where it is left out, and zero.
    #[must_use]
    pub fn term(&self, term: Term) -> &[f64] {
        match &self.higher {
            _ if term == Term::CUBIC => &self.cubic,
            Some(higher) => higher.list(term),
            None => &[],
        }
    }

    /// The law that is this one of its kind on a DOF, where `friction` has so many, in its order.
    #[must_use]
    pub fn friction_on(&self, dof: &Dof, law: &Declaration) -> Option<&Friction> {
        friction_on(&self.friction, dof, law)
    }

    /// The joint's laws that remember the motion, in the order in which laws are declared: as many of each kind as the DOF has that
    /// has most of them.
    pub fn laws_with_memory(&self) -> impl Iterator<Item = &'static Declaration> {
        Friction::all_laws()
            .filter(|law| law.remembers())
            .filter(|law| {
                let mut dofs = self.dofs.rows();
                dofs.any(|dof| friction_on(self.friction_at_first(), dof, law).is_some())
            })
    }

    /// The laws that remember: those of the first preload where they have a table of their own.
    fn friction_at_first(&self) -> &[Friction] {
        let table = self.over_preload.as_ref();
        let first = table.and_then(|table| table.friction.first());
        first.unwrap_or(&self.friction)
    }

    /// Whether there is nothing beside stiffness and damping, each constant.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        let mut terms = Term::ALL.into_iter().flat_map(|term| self.term(term));
        self.friction.is_empty() && terms.all(|&term| term == 0.0)
    }

    /// Whether a term of higher order is not zero.
    #[must_use]
    pub fn has_terms_of_higher_order(&self) -> bool {
        let mut all = HigherTerms::terms().flat_map(|term| self.term(term));
        all.any(|&term| term != 0.0)
    }
}

/// The law that is this one of its kind on a DOF, among these in their order.
fn friction_on<'f>(all: &'f [Friction], dof: &Dof, law: &Declaration) -> Option<&'f Friction> {
    let own = |own: &&Friction| own.dof.name == dof.name && own.law.name == law.name;
    all.iter().filter(own).nth(law.number.checked_sub(1)?)
}

/// Path of a term of the polynomial law.
pub(super) fn term_path(term: Term) -> String {
    let key = term.row().key;
    if term == Term::CUBIC {
        format!("joint.{key}")
    } else {
        format!("joint.higher.{key}")
    }
}

impl Joint {
    /// The load law over the preload of a joint with `D` DOFs a side, for a preload that moves.
    ///
    /// # Errors
    ///
    /// [`LawError`] where the joint has not `D` DOFs, does not depend on the preload, has a law whose state cannot follow it, or
    /// is malformed.
    pub fn law_over_preload<const D: usize>(
        &self,
        beyond: dynamics::Beyond,
    ) -> Result<dynamics::JointOverPreload<D>, LawError> {
        let table = self.over_preload.as_ref().ok_or(LawError::NoTable)?;
        let law = self.springs_over_preload(beyond)?;
        let zero = vec![vec![0.0; D]; D];
        let alone = |friction: &[Friction]| Self {
            friction: friction.to_vec(),
            ..Self::linear(self.dofs, zero.clone(), zero.clone())
        };
        let Some(first) = table.friction.first() else {
            return Ok(law.with_friction(alone(&self.friction).law()?.on, table.nominal));
        };
        for own in table.friction.iter().skip(1) {
            let mut pairs = first.iter().zip(own);
            let changes = |(one, other): &(&Friction, &Friction)| {
                let is_load =
                    one.law.memory.iter().any(|number| {
                        number.rate.is_some() && number.quantity == RememberedAs::Load
                    });
                let stiffness = |own: &Friction| {
                    let mut keyed = own.keyed();
                    keyed.find(|(key, _)| *key == "stiffness")
                };
                is_load && stiffness(one) != stiffness(other)
            };
            if let Some((one, _)) = pairs.find(changes) {
                let law = one.law.name;
                return Err(LawError::StateOverPreload { law });
            }
        }
        let entries = table.friction.iter().map(|own| Ok(alone(own).law()?.on));
        let entries = entries.collect::<Result<Vec<_>, LawError>>()?;
        law.with_friction_table(&entries).map_err(LawError::Table)
    }

    /// The same without laws that remember.
    pub(super) fn springs_over_preload<const D: usize>(
        &self,
        beyond: dynamics::Beyond,
    ) -> Result<dynamics::JointOverPreload<D>, LawError> {
        let table = self.over_preload.as_ref().ok_or(LawError::NoTable)?;
        let entries = (0..table.preload.len())
            .map(|place| {
                let own = |list: &[Vec<Vec<f64>>]| list.get(place).cloned().unwrap_or_default();
                let linear = Self::linear(self.dofs, own(&table.stiffness), own(&table.damping));
                let joint = Self {
                    cubic: table.cubic.get(place).cloned().unwrap_or_default(),
                    ..linear
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

fn body<const D: usize>(path: &str, body: &Body) -> Result<dynamics::Body<D>, LawError> {
    Ok(dynamics::Body {
        inertia: list(path, &body.inertia)?,
        stiffness: list(path, &body.stiffness)?,
        damping: list(path, &body.damping)?,
    })
}

fn list<const D: usize>(path: &str, entries: &[f64]) -> Result<[f64; D], LawError> {
    entries.try_into().map_err(|_| shape(path, D))
}

fn shape(path: &str, expected: usize) -> LawError {
    LawError::Shape {
        path: path.to_owned(),
        expected,
    }
}

fn matrix<const D: usize>(path: &str, rows: &[Vec<f64>]) -> Result<[[f64; D]; D], LawError> {
    let mut matrix = [[0.0; D]; D];
    if rows.len() != D {
        return Err(shape(path, D));
    }
    for (target, row) in matrix.iter_mut().zip(rows) {
        *target = list(path, row)?;
    }
    Ok(matrix)
}
