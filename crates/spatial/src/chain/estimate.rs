//! Several joints of a chain at once, and whether the functions tell them apart.

use bolted_joint_wanted::{Pieces, step};
use nalgebra::{DMatrix, DVector, Matrix6};

use super::apart::{Apart, apart};
use super::study::ChainStudy;
use crate::advice::{of_noise, of_zero_functions};
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::identification::Unknown;
use crate::level::{first, relative_rms, sizes};
use crate::links::Sought;
use crate::normal::Normal;
use crate::numbers::{Numbers, deviations};
use crate::problem::{Level, Problem};
use crate::reasons;
use crate::search::{Searched, searched};
use crate::settled::Settled;
use crate::uneven;

/// Lines that are searched from several starts; all are used from where these lead.
const SEARCHED: usize = 40;

/// Growth of the deviations of one joint by the unknowns of another, in the median, beyond which the functions hardly tell them
/// apart.
const GROWTH_MAX: f64 = 100.0;
/// The same where the search goes astray: at what it found the growth is not that at the joints.
const GROWTH_MAX_ASTRAY: f64 = 10.0;

/// One of the joints that were sought.
#[derive(Clone, Debug)]
pub struct FoundJoint {
    /// Its table in the study.
    pub key: String,
    /// Its place in the chain, from 1.
    pub number: usize,
    /// The unknowns of stiffness, then those of damping.
    pub unknowns: Vec<Unknown>,
    /// K, N/m, N/rad, N·m/rad.
    pub stiffness: Matrix6<f64>,
    /// C, in the units of K times s.
    pub damping: Matrix6<f64>,
    /// Standard deviations of the entries of K and of C.
    pub deviations: [Matrix6<f64>; 2],
    /// Correlation of its unknowns.
    pub correlation: DMatrix<f64>,
    /// Name of its model.
    pub(crate) model: String,
    /// K and C without the constraint that the joint be passive, where that is another estimate.
    pub(crate) free: Option<[Matrix6<f64>; 2]>,
}

/// What was found of a chain.
#[derive(Clone, Debug)]
pub struct ChainIdentification {
    /// The joints that were sought, in the order of the chain.
    pub joints: Vec<FoundJoint>,
    /// Whether they are told apart.
    pub apart: Vec<Apart>,
    /// Root mean square of |measured − computed|/|computed|'s r.m.s. of each function.
    pub relative_rms: f64,
    /// Functions of the assembly that were compared.
    pub functions: usize,
    /// Lines.
    pub lines: usize,
    /// χ² over degrees of freedom where the noise is stated.
    pub reduced_chi_squared: Option<f64>,
    /// Starts of the search, and how many came to the same minimum.
    pub starts: [usize; 2],
    /// What else should be known.
    pub warnings: Vec<String>,
    /// Why the result is not to be relied on.
    pub reasons_against: Vec<String>,
}

impl ChainStudy {
    /// The joints that are sought, all at once, from sensors and impacts whose places are exact.
    ///
    /// # Errors
    /// [`SpatialError`] where the functions do not determine them, or do not tell them apart.
    pub fn identify(&self) -> Result<ChainIdentification, SpatialError> {
        let (problem, zero_functions) = self.measured()?;
        let (functions, lines) = (problem.observed.len(), problem.frequency_hz.len());
        let count = problem.joint_count();
        if 2 * functions * lines <= count {
            return Err(SpatialError::TooFewFunctions {
                found: functions,
                lines,
                unknowns: count,
            });
        }
        let rms = sizes(&problem);
        let first = first(&problem, self.level, &rms);
        let is_stated = self.level.is_known();
        let Searched {
            fit,
            starts,
            rivals,
        } = searched(&problem.thinned(SEARCHED), &first, is_stated)?;
        let _step = step("the estimate at all lines", Pieces::Unknown);
        let fit = fit.on(&problem, &first)?;
        let Settled {
            problem,
            best,
            level,
            of_values,
            ..
        } = Settled::of(&problem, fit, (&first, is_stated), &rms)?;
        let apart = apart(&problem, &best.unknowns, &level)?;
        let freedom = (2 * functions * lines - count) as f64;
        let reduced_chi_squared = is_stated.then_some(best.cost / freedom);
        // of a joint that does not explain the functions nothing is said about the part between
        let explains = reasons::of_noise(self.level, reduced_chi_squared).is_none();
        if explains && let Some(alike) = apart.iter().find(|pair| !pair.told.is_told()) {
            return Err(SpatialError::NotToldApart {
                joints: alike.joints.clone(),
                correlation: alike.told.correlation,
            });
        }
        let normal = Normal::of(&problem, &best.unknowns, &level)?;
        let all = covariance(&normal.information).ok_or(match explains && best.has_converged {
            true => SpatialError::NotDetermined,
            false => SpatialError::NothingFound { tried: starts[0] },
        })?;
        let (joints, of_energy): (Vec<FoundJoint>, Vec<Option<String>>) = problem
            .links
            .sought()
            .iter()
            .zip(&self.models)
            .map(|(joint, model)| found(joint, model, &best.unknowns.0, &all))
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .unzip();
        let mut found = ChainIdentification {
            joints,
            apart,
            relative_rms: relative_rms(&problem, &best.unknowns)?,
            functions,
            lines,
            reduced_chi_squared,
            starts,
            warnings: (self.assumed.iter().cloned())
                .chain(of_zero_functions(zero_functions, functions))
                .chain(of_noise(self.level, reduced_chi_squared))
                .chain(uneven::told(of_values))
                .collect(),
            reasons_against: Vec::new(),
        };
        found.reasons_against = found.reasons(self.level, best.has_converged);
        let more = reasons::of_rivals(rivals).into_iter();
        let more = more.chain(of_energy.into_iter().flatten());
        found.reasons_against.extend(more);
        Ok(found)
    }

    /// The problem with what was measured, and how many functions are left out since they are zero.
    fn measured(&self) -> Result<(Problem, usize), SpatialError> {
        let sought = self.sought();
        if sought == 0 {
            return Err(self.all_known().into());
        }
        if sought > 1 && self.problem.tolerances.is_some() {
            return Err(SpatialError::BudgetOfSeveral { sought });
        }
        let mut problem = self.problem.clone();
        problem.tolerances = None;
        let (observed, zero_functions) = self.observed()?;
        problem.observed = observed;
        Ok((problem, zero_functions))
    }
}

impl ChainIdentification {
    fn reasons(&self, level: Level, has_converged: bool) -> Vec<String> {
        let mut reasons = reasons::of_search(has_converged, self.relative_rms);
        reasons.extend(reasons::of_noise(level, self.reduced_chi_squared));
        for pair in &self.apart {
            let growth = pair.told.median_growth().into_iter().fold(0.0, f64::max);
            let most = if has_converged {
                GROWTH_MAX
            } else {
                GROWTH_MAX_ASTRAY
            };
            if growth > most {
                let [one, other] = &pair.joints;
                reasons.push(format!(
                    "the functions hardly tell {one} and {other} apart: with both unknown, deviations are {growth:.0} times as large as \
                     with one of them known; measure on the part between them, at frequencies where it bends, or state one of the joints \
                     (known)"
                ));
            }
        }
        reasons
    }
}

/// One joint of all unknowns and their covariance, and why it is not to be relied on if it feeds energy.
fn found(
    joint: &Sought<'_>,
    name: &str,
    values: &DVector<f64>,
    all: &DMatrix<f64>,
) -> Result<(FoundJoint, Option<String>), SpatialError> {
    let count = 2 * joint.model.count();
    let own = all
        .view((joint.first, joint.first), (count, count))
        .into_owned();
    let free = DVector::from_column_slice(joint.of(values.as_slice()));
    let Numbers {
        unknowns,
        matrices: [stiffness, damping],
        free,
        correlation,
        squares_from_free,
        ..
    } = Numbers::of(joint, free, &own, &own, true)?;
    let key = joint.link.key.clone();
    let of_energy = reasons::of_energy(squares_from_free, count);
    let of_energy = of_energy.map(|reason| format!("{key}: {reason}"));
    let found = FoundJoint {
        key,
        number: joint.number + 1,
        unknowns,
        stiffness,
        damping,
        deviations: deviations(joint.model, &own),
        correlation,
        model: name.to_owned(),
        free,
    };
    Ok((found, of_energy))
}
