//! The joint of one torque, or of all, with how sure it is.

use bolted_joint_draws::Draw;
use bolted_joint_joint::Drawn;
use bolted_joint_statistics::{quantile, student_975};
use nalgebra::DMatrix;

use super::assessment;
use super::bands::UsedBands;
use super::bootstrap::Bootstrap;
use super::budget::Systematic;
use super::layout::Layout;
use super::model::{JointMatrices, JointModel, is_positive_semidefinite};
use super::noise::Noise;
use super::objective::Objective;
use super::observed::Observed;
use super::passive;
use super::search::Found;
use super::uncertainty::{self, Covariance};
use super::unknown::Unknown;

/// A standard deviation beyond this fraction of the value makes the value unreliable.
pub(super) const UNRELIABLE: f64 = 0.5;
/// The same of a direct stiffness of several joints, which is then within two and a half deviations of none: where one is known so
/// badly, no straight line leads from it to the others, and their deviations do not hold.
pub(super) const UNRELIABLE_OF_SEVERAL: f64 = 0.4;

/// The estimate of the joint at one torque, or of the one that all assemblies have in common: of one bolt, of several that are
/// alike, or of each of several.
#[derive(Clone, Debug)]
pub struct JointEstimate {
    /// Tightening torque at which it holds, N·m; `None` where it is common to all assemblies.
    pub torque_n_m: Option<f64>,
    /// The bands that each entry of each bolt's joint is averaged over.
    pub bands: Vec<Vec<UsedBands>>,
    /// Averages of the decoupled values, one of the starts; of each bolt with a joint of its own.
    pub band_averages: Option<Vec<JointMatrices>>,
    /// The estimates that are free to be active; of each bolt with a joint of its own.
    pub free: Vec<JointMatrices>,
    /// The passive ones, which are the free ones where these are passive; `None` if there are none.
    pub passive: Option<Vec<JointMatrices>>,
    /// Covariance of the unknowns, and which of them are identified.
    pub covariance: Covariance,
    /// The bootstrap, where one was asked for.
    pub bootstrap: Option<BootstrapResult>,
    /// K and C over the DOFs of all bolts, as [`Lines::regenerated`](super::Lines::regenerated) takes them.
    pub whole: JointMatrices,
    pub(super) layout: Layout,
}

/// Scatter of the estimates over bootstrap draws.
#[derive(Clone, Debug, PartialEq)]
pub struct BootstrapResult {
    /// What differs from draw to draw.
    pub drawn: Drawn,
    /// Draws asked for.
    pub draws: usize,
    /// Seed.
    pub seed: u64,
    /// Draws whose estimate converged.
    pub converged: usize,
    /// Standard deviation of each unknown over them.
    pub standard_deviation: Vec<f64>,
    /// From the 2.5th to the 97.5th percentile of each unknown.
    pub intervals: Vec<[f64; 2]>,
}

impl JointEstimate {
    /// The joint of each bolt that has one of its own, or the one for all: the passive estimate where there is one.
    #[must_use]
    pub fn bolts(&self) -> &[JointMatrices] {
        self.passive.as_ref().unwrap_or(&self.free)
    }

    /// The joint, at the first bolt where every bolt has its own.
    #[must_use]
    pub fn joint(&self) -> &JointMatrices {
        &self.bolts()[0]
    }

    /// The average of the decoupled values, at the first bolt where every bolt has its own.
    #[must_use]
    pub fn band_average(&self) -> Option<&JointMatrices> {
        self.band_averages.as_ref()?.first()
    }

    /// One standard deviation of each entry, at the first bolt where every bolt has its own.
    #[must_use]
    pub fn standard_deviation(&self, model: JointModel) -> JointMatrices {
        let deviation = self.covariance.standard_deviation();
        JointMatrices::from_unknowns(model, &self.layout.of_joint(&deviation, 0))
    }

    /// The same with the joint, the one with this number, and the deviations of an estimate in which the set-up's errors take
    /// part.
    pub(super) fn with_systematic_errors(
        self,
        found: &Systematic,
        number: usize,
        bolts: &[String],
    ) -> Self {
        let layout = &self.layout;
        let (unknowns, own) = found.of_joint(number, layout.unknowns());
        let free = layout.matrices(unknowns);
        let passive = passive::nearest(layout, unknowns, &own);
        let passive = passive.map(|unknowns| layout.matrices(&unknowns));
        let covariance = self
            .covariance
            .with_systematic_errors(layout, unknowns, own, bolts);
        Self {
            whole: layout.whole(passive.as_ref().unwrap_or(&free)),
            free,
            passive,
            covariance,
            ..self
        }
    }

    /// The interval of 95 % of each unknown: that of the free estimate, extended to the passive one where that lies beyond it. The
    /// constraint only ever moves the estimate, it does not say how sure it is; so the interval stays as wide as without it.
    #[must_use]
    pub fn intervals(&self) -> Vec<[f64; 2]> {
        let intervals = self.covariance.intervals().into_iter();
        intervals
            .zip(&self.covariance.unknowns)
            .map(|([low, high], unknown)| {
                let estimate = unknown.value(&self.bolts()[unknown.joint]);
                [low.min(estimate), high.max(estimate)]
            })
            .collect()
    }

    /// Where the unknowns of one bolt's joint stand among those of the covariance.
    #[must_use]
    pub fn unknowns_of(&self, bolt: usize) -> Vec<usize> {
        self.layout.indices_of(bolt)
    }

    /// Whether the free estimate can feed energy into a structure. Of several joints one that is not may have a passive estimate
    /// of its own all the same, beside another that is.
    #[must_use]
    pub fn free_is_active(&self) -> bool {
        let mut matrices = self.free.iter().flat_map(|j| [&j.stiffness, &j.damping]);
        !matrices.all(is_positive_semidefinite)
    }

    /// What follows its numbers in a message: the torque at which they hold, where they are those of one torque.
    pub(super) fn place(&self) -> String {
        self.torque_n_m
            .map(|torque| format!(" at {torque} N·m"))
            .unwrap_or_default()
    }

    /// The stiffnesses on the diagonal that are hardly known, joint by joint: of several joints any, as the others' numbers hang on
    /// it, but for one that is known to have no effect; and of a single one those of which none is known to half of its size.
    pub(super) fn hardly_determined(&self) -> Vec<&Unknown> {
        let covariance = &self.covariance;
        let deviations = covariance.standard_deviation();
        let direct = |index: &usize| covariance.unknowns[*index].is_direct_stiffness();
        let direct: Vec<usize> = (0..deviations.len()).filter(direct).collect();
        let are_several = self.free.len() > 1;
        let is_open = |index: &usize| {
            let unknown = &covariance.unknowns[*index];
            let size = unknown.value(&self.free[unknown.joint]).abs();
            let (part, least) = match are_several {
                true => (UNRELIABLE_OF_SEVERAL, covariance.negligible[*index]),
                false => (UNRELIABLE, 0.0),
            };
            deviations[*index] > part * size.max(least)
        };
        let open: Vec<usize> = direct.iter().copied().filter(is_open).collect();
        match are_several || open.len() == direct.len() {
            true => open
                .iter()
                .map(|&index| &covariance.unknowns[index])
                .collect(),
            false => Vec::new(),
        }
    }

    /// What the data do not determine, or hardly; `bolts` are the names of those that have joints of their own.
    pub(super) fn warnings(&self, bolts: &[String]) -> Vec<String> {
        let covariance = &self.covariance;
        let deviations = covariance.standard_deviation();
        let at = self.place();
        let mut warnings = Vec::new();
        let unknowns = || covariance.unknowns.iter().zip(&covariance.identified);
        let open: Vec<String> = unknowns()
            .filter(|(_, identified)| !**identified)
            .map(|(unknown, _)| unknown.label(bolts))
            .collect();
        if !open.is_empty() {
            let mut text = format!(
                "not identified{at}: {}; the data do not determine {}, so do not use the value{}",
                open.join(", "),
                if open.len() == 1 { "it" } else { "them" },
                if open.len() == 1 { "" } else { "s" },
            );
            for combination in &covariance.determined_together {
                text += &format!("; determined together: {combination}");
            }
            warnings.push(text);
        }
        for ((unknown, &identified), deviation) in unknowns().zip(deviations) {
            let joint = &self.free[unknown.joint];
            let value = unknown.value(joint);
            // A coupling may be zero: it counts beside the largest that a passive joint has.
            let size = value.abs().max(unknown.passive_bound(joint));
            if identified && deviation > UNRELIABLE * size {
                // as tables and joint file have it
                let value = unknown.value(&self.bolts()[unknown.joint]);
                warnings.push(format!(
                    "{} = {value:.3e} {unit}{at} has a standard deviation of {deviation:.1e} {unit}: the data hardly determine it",
                    unknown.label(bolts),
                    unit = unknown.unit
                ));
            }
        }
        warnings
    }
}

/// Covariance of the unknowns of all torques together, with what the residual says about the noise and about the model.
pub(super) struct CovarianceOfAll {
    /// Of the unknowns of one torque after the other.
    pub(super) matrix: DMatrix<f64>,
    coverage_factor: f64,
    inflation: Vec<f64>,
}

impl CovarianceOfAll {
    pub(super) fn of(
        objective: &Objective<'_>,
        noise: &Noise,
        found: &Found,
        observed: Option<&Observed>,
    ) -> Self {
        let estimate = &found.estimate;
        let mut unit = uncertainty::unit_covariance(&estimate.information);
        if let Some(observed) = observed {
            unit += &observed.added;
        }
        let reduced = estimate.reduced_chi_squared();
        let is_known = found.assessment.noise_is_known;
        // Stated noise is believed as long as χ² does not contradict it; otherwise the residual tells the level. What coherence
        // tells is the least that the noise can be.
        let (scale, freedom) = match reduced {
            Some(chi) if is_known => (chi.max(1.0), usize::MAX),
            Some(chi) if !noise.is_stated() => (chi, estimate.degrees_of_freedom),
            Some(chi) if found.assessment.chi_squared_excess > assessment::SIGNIFICANT => {
                (chi, usize::MAX)
            }
            None if !noise.is_stated() => (f64::INFINITY, usize::MAX),
            _ => (1.0, usize::MAX),
        };
        let mut matrix = &unit * scale;
        let mut inflation = vec![scale.max(1.0).sqrt(); unit.nrows()];
        if !noise.is_stated() && !is_known {
            inflation.fill(1.0);
        }
        if found.assessment.line_correlation_excess > assessment::SIGNIFICANT
            && !found.assessment.is_exact
            && scale.is_finite()
            && let Some(more) = assessment::inflation(objective, estimate, &unit, scale)
        {
            matrix = super::normal::scaled_by(&matrix, &more);
            for (total, more) in inflation.iter_mut().zip(more.iter()) {
                *total *= more;
            }
        }
        Self {
            matrix,
            coverage_factor: student_975(freedom),
            inflation,
        }
    }

    /// The part of torque number `joint`; `bolts` are the names of those that have joints of their own.
    pub(super) fn of_torque(
        &self,
        objective: &Objective<'_>,
        layout: &Layout,
        bolts: &[String],
        found: &Found,
        joint: usize,
    ) -> Covariance {
        let size = layout.unknowns();
        let own = joint * size..(joint + 1) * size;
        let values = found.estimate.unknowns.as_slice()[own.clone()].to_vec();
        let matrix = self
            .matrix
            .view((own.start, own.start), (size, size))
            .into_owned();
        let deviation: Vec<f64> = matrix.diagonal().iter().map(|v| v.sqrt()).collect();
        let (dynamic, omega) = objective.substructures(joint);
        let unknowns = Unknown::of_joints(layout.model(), layout.joints());
        let names: Vec<String> = unknowns
            .iter()
            .map(|unknown| unknown.label(bolts))
            .collect();
        let negligible = uncertainty::negligible(layout, dynamic, omega);
        let sizes = uncertainty::sizes(layout, &values, &negligible);
        let identified = uncertainty::identified(&deviation, &sizes);
        Covariance {
            determined_together: uncertainty::determined_together(
                &names,
                &identified,
                &sizes,
                &matrix,
            ),
            unknowns,
            values,
            coverage_factor: self.coverage_factor,
            inflation: self.inflation[own].to_vec(),
            negligible,
            identified,
            matrix,
        }
    }
}

impl BootstrapResult {
    /// What the draws show of those unknowns that they hold.
    pub(super) fn of(
        bootstrap: &Bootstrap,
        drawn: Drawn,
        draws: &[Draw],
        own: std::ops::Range<usize>,
    ) -> Self {
        let draws: Vec<&[f64]> = draws
            .iter()
            .filter_map(Draw::values)
            .filter(|values| own.end <= values.len())
            .collect();
        let sorted = |unknown: usize| {
            let mut values: Vec<f64> = draws.iter().map(|draw| draw[unknown]).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let deviation = |values: &[f64]| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            (squares / (values.len() as f64 - 1.0)).sqrt()
        };
        let own = if draws.is_empty() { 0..0 } else { own };
        let unknowns: Vec<Vec<f64>> = own.map(sorted).collect();
        Self {
            drawn,
            draws: bootstrap.draws,
            seed: bootstrap.seed,
            converged: draws.len(),
            standard_deviation: unknowns.iter().map(|values| deviation(values)).collect(),
            intervals: unknowns
                .iter()
                .map(|values| [quantile(values, 0.025), quantile(values, 0.975)])
                .collect(),
        }
    }
}
