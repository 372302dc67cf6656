//! Assemblies tightened to different torques: one joint for all of them, or one for each torque, and which of the two the
//! data call for.
//!
//! Joints of different torques are estimated together, because the errors of a measured substructure are the same in every
//! assembly that uses it: the unknowns of one joint after the other are one vector, and each assembly has its own part of it.

use std::fmt;
use std::sync::Arc;

use bolted_joint_wanted::{Pieces, step};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use super::assessment::assess;
use super::bolt_starts::bolt_starts;
use super::choice::bayesian_criterion;
use super::data::{Data, Used};
use super::estimator::{Estimate, Free, estimate};
use super::layout::{Layout, Place};
use super::lines::Lines;
use super::noise::Noise;
use super::search::{self, Effort, Found};
use super::trials::rough;

/// Whether the joint depends on the tightening torque.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TorqueDependence {
    /// One joint in all assemblies, whatever their torques.
    #[default]
    Common,
    /// A joint for each torque, common to the assemblies tightened to it.
    Separate,
}

/// As in a study.
impl fmt::Display for TorqueDependence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Common => "common",
            Self::Separate => "separate",
        })
    }
}

/// A common joint beside one for each torque.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueChoice {
    /// The common joint, then the separate ones.
    pub compared: [DependenceFit; 2],
    /// The simplest adequate one by Schwarz's criterion; without an adequate one, that with the lowest.
    pub recommended: TorqueDependence,
    /// Whether either leaves nothing but noise.
    pub any_is_adequate: bool,
}

impl TorqueChoice {
    /// What speaks against the dependence that was `used`, in words.
    #[must_use]
    pub fn complaint(&self, used: TorqueDependence) -> Option<String> {
        if self.recommended == used {
            return None;
        }
        let [common, separate] = self.compared;
        let lower = (common.bic_difference - separate.bic_difference).abs();
        Some(match used {
            TorqueDependence::Common => format!(
                "the joint depends on the torque: a joint for each torque has a BIC lower by {lower:.1} than the common one; \
                 state torques = \"separate\" in [joint]"
            ),
            TorqueDependence::Separate => format!(
                "the data do not show that the joint depends on the torque: a common joint has a BIC lower by {lower:.1} than one for \
                 each torque; consider torques = \"common\" in [joint]"
            ),
        })
    }
}

/// How joints with one dependence on the torque fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DependenceFit {
    /// The dependence.
    pub dependence: TorqueDependence,
    /// Unknowns of all joints together.
    pub unknowns: usize,
    /// −2 ln L + p ln n, less that of the other if it is lower.
    pub bic_difference: f64,
    /// χ² over degrees of freedom, where the noise is stated.
    pub reduced_chi_squared: Option<f64>,
    /// Whether they leave nothing but noise.
    pub adequate: bool,
}

/// The different torques of a study's assemblies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Torques {
    /// Each torque once, in the order in which the assemblies have them, N·m.
    pub(super) values_n_m: Vec<f64>,
    /// Which of them each assembly has.
    pub(super) of_assembly: Vec<usize>,
}

impl Torques {
    /// `None` where not every one of `assemblies` has a torque, or all have the same.
    pub(super) fn of(torques_n_m: &[f64], assemblies: usize) -> Option<Self> {
        let mut values_n_m: Vec<f64> = Vec::new();
        let mut of_assembly = Vec::with_capacity(assemblies);
        for &torque in torques_n_m {
            let known = values_n_m.iter().position(|&other| other == torque);
            of_assembly.push(known.unwrap_or(values_n_m.len()));
            if known.is_none() {
                values_n_m.push(torque);
            }
        }
        (torques_n_m.len() == assemblies && values_n_m.len() > 1).then_some(Self {
            values_n_m,
            of_assembly,
        })
    }
}

/// Which joints are sought in which assemblies.
pub(super) struct Assignment<'a> {
    /// Every assembly with the number of its joint.
    pub(super) all: Vec<(&'a Lines, usize)>,
    /// How many joints there are.
    pub(super) joints: usize,
}

impl<'a> Assignment<'a> {
    /// One joint in all assemblies.
    pub(super) fn common(all: &'a [Lines]) -> Self {
        Self {
            all: all.iter().map(|lines| (lines, 0)).collect(),
            joints: 1,
        }
    }

    /// A joint for each torque.
    pub(super) fn separate(all: &'a [Lines], torques: &Torques) -> Self {
        Self {
            all: all
                .iter()
                .zip(torques.of_assembly.iter().copied())
                .collect(),
            joints: torques.values_n_m.len(),
        }
    }

    /// The assemblies of one joint alone.
    fn only(&self, joint: usize) -> Vec<(&'a Lines, usize)> {
        let own = self.all.iter().filter(|(_, own)| *own == joint);
        own.map(|&(lines, _)| (lines, 0)).collect()
    }
}

/// What joints are sought in: the data of all assemblies, each with its own joint.
pub(super) struct Problem<'a> {
    assignment: Assignment<'a>,
    pub(super) noise: &'a Noise,
    pub(super) data: Data<'a>,
}

impl<'a> Problem<'a> {
    /// `None` if there is no assembly, or none of a joint with so many DOFs.
    pub(super) fn new(assignment: Assignment<'a>, noise: &'a Noise) -> Option<Self> {
        Some(Self {
            data: Data::of(assignment.all.clone(), noise)?,
            assignment,
            noise,
        })
    }

    /// How many joints are sought.
    pub(super) fn joints(&self) -> usize {
        self.assignment.joints
    }

    /// The best estimate of all joints together, on the lines that are `used` if they are given; `Err` with the number of starts if
    /// there is none. `starts` are those of each joint.
    ///
    /// Several joints are first sought one by one, as if each torque had been a study of its own, and what that finds is
    /// the start of the estimate of all.
    pub(super) fn best(
        &self,
        layout: &Layout,
        starts: &[Vec<DVector<f64>>],
        effort: Effort,
        used: Option<&Arc<Used>>,
    ) -> Result<Found, usize> {
        let (entries, noise) = (&layout.places(), self.noise);
        let own_starts = |joint: usize| starts.get(joint).cloned().unwrap_or_default();
        if self.joints() == 1 {
            let starts = bolt_starts(&self.data, layout, noise, own_starts(0), effort);
            return search::best(&self.data, entries, noise, starts, effort, used);
        }
        let mut joints = Vec::with_capacity(self.joints());
        let (mut tried, mut agreeing) = (0, 0);
        for joint in 0..self.joints() {
            let data = Data::of(self.assignment.only(joint), noise).ok_or(tried)?;
            let starts = bolt_starts(&data, layout, noise, own_starts(joint), effort);
            let found = search::best(&data, entries, noise, starts, effort, None)
                .map_err(|more| tried + more)?;
            tried += found.tried;
            agreeing += found.agreeing;
            joints.push(found.estimate.unknowns);
        }
        let found = self.together(layout, &joints, effort, used).ok_or(tried)?;
        Ok(Found {
            tried,
            agreeing,
            ..found
        })
    }

    /// The estimate of all joints together from what was found of each by itself; where that does not lead to one that fits,
    /// from each of them at all torques.
    fn together(
        &self,
        layout: &Layout,
        joints: &[DVector<f64>],
        effort: Effort,
        used: Option<&Arc<Used>>,
    ) -> Option<Found> {
        let entries = &layout.places();
        let concatenated = |joints: &mut dyn Iterator<Item = &DVector<f64>>| {
            let values: Vec<f64> = joints.flat_map(|joint| joint.iter().copied()).collect();
            DVector::from_vec(values)
        };
        let everywhere = joints
            .iter()
            .map(|joint| concatenated(&mut joints.iter().map(|_| joint)));
        let starts = std::iter::once(concatenated(&mut joints.iter())).chain(everywhere);
        let mut best: Option<Found> = None;
        for start in starts {
            let Some(found) = self.starting_at(entries, &start, used) else {
                continue;
            };
            let fits = found.estimate.converged && found.assessment.fits();
            let lower = |best: &Found| {
                let of_each = |found: &Found| found.estimate.misfit_of_each();
                of_each(&found) < of_each(best)
            };
            if best.as_ref().is_none_or(lower) {
                best = Some(found);
            }
            if fits || effort == Effort::Related && best.is_some() {
                break;
            }
        }
        best
    }

    /// The estimate that a start of all joints leads to, on the lines that are `used` or else on those that it can use itself.
    fn starting_at(
        &self,
        entries: &[Place],
        start: &DVector<f64>,
        used: Option<&Arc<Used>>,
    ) -> Option<Found> {
        let noise = self.noise;
        let on = |used: Arc<Used>, near: &Estimate| {
            let objective = used.assemblies.objective(entries);
            let start = &near.unknowns;
            let estimate = estimate(&objective, noise, None, &Free, start, None)?;
            let assessment = assess(&objective, &estimate, noise)?;
            Some(Found {
                estimate,
                assessment,
                tried: 0,
                agreeing: 0,
                used,
            })
        };
        // Each joint by itself has been moved by other corrections of the same substructures.
        let near = rough(&self.data, entries, noise, start)?;
        if let Some(used) = used {
            return on(Arc::clone(used), &near);
        }
        let found = on(self.data.used_near(entries, near.place()), &near)?;
        if !self.data.has_errors() {
            return Some(found);
        }
        // Which lines can be used shows best at the estimate itself.
        let near = found.estimate;
        on(self.data.used_near(entries, near.place()), &near)
    }
}

/// Compares the `found` estimate of `problem`, whose joints are `used`, with that of the other dependence on the torque;
/// `None` if that has none.
pub(super) fn compare(
    all: &[Lines],
    torques: &Torques,
    noise: &Noise,
    layout: &Layout,
    used: TorqueDependence,
    found: &Found,
) -> Option<TorqueChoice> {
    let size = layout.unknowns();
    let joints = found.estimate.unknowns.as_slice().chunks_exact(size);
    let joints: Vec<DVector<f64>> = joints.map(DVector::from_column_slice).collect();
    let (assignment, starts) = match used {
        TorqueDependence::Common => (
            Assignment::separate(all, torques),
            vec![joints; torques.values_n_m.len()],
        ),
        TorqueDependence::Separate => (Assignment::common(all), vec![joints]),
    };
    let other = Problem::new(assignment, noise)?;
    let _step = step("the other dependence on the torque", Pieces::Unknown);
    let lines = other.data.used(found.used.chosen.clone());
    let other = other
        .best(layout, &starts, Effort::Related, Some(&lines))
        .ok()?;
    let (common, separate) = match used {
        TorqueDependence::Common => (found, &other),
        TorqueDependence::Separate => (&other, found),
    };
    let criterion = |found: &Found| bayesian_criterion(&found.estimate);
    let lowest = criterion(common).min(criterion(separate));
    let fit = |dependence, found: &Found| DependenceFit {
        dependence,
        unknowns: found.estimate.unknowns.len(),
        bic_difference: criterion(found) - lowest,
        reduced_chi_squared: tested_chi_squared(found),
        adequate: found.assessment.fits(),
    };
    let compared = [
        fit(TorqueDependence::Common, common),
        fit(TorqueDependence::Separate, separate),
    ];
    let any_is_adequate = compared.iter().any(|fit| fit.adequate);
    let recommended = compared
        .iter()
        .filter(|fit| fit.adequate || !any_is_adequate)
        .min_by(|a, b| a.bic_difference.total_cmp(&b.bic_difference))
        .map_or(used, |fit| fit.dependence);
    // Of exact data a common joint leaves rounding, which is no likelihood: nothing is better than that.
    let recommended = if common.assessment.is_exact {
        TorqueDependence::Common
    } else {
        recommended
    };
    Some(TorqueChoice {
        compared,
        recommended,
        any_is_adequate,
    })
}

/// χ² over degrees of freedom as a test, which it is where the noise is stated or known.
pub(super) fn tested_chi_squared(found: &Found) -> Option<f64> {
    (found.assessment.noise_is_stated || found.assessment.noise_is_known)
        .then(|| found.estimate.reduced_chi_squared())
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assemblies_of_the_same_torque_belong_together() {
        let torques = Torques::of(&[25.0, 10.0, 25.0, 15.0], 4).unwrap();
        assert_eq!(torques.values_n_m, [25.0, 10.0, 15.0]);
        assert_eq!(torques.of_assembly, [0, 1, 0, 2]);
        assert_eq!(Torques::of(&[10.0, 10.0], 2), None);
        assert_eq!(Torques::of(&[10.0, 20.0], 3), None);
        assert_eq!(Torques::of(&[], 0), None);
    }
}
