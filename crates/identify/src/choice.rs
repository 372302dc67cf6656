//! Joint models beside each other: the simplest one that explains the data, by likelihood and number of unknowns.

use bolted_joint_wanted::{Pieces, step};
use nalgebra::DVector;

use super::estimator::Estimate;
use super::layout::Layout;
use super::model::JointModel;
use super::passive::CHANCE;
use super::search::{Effort, Found};
use super::torque::{Problem, tested_chi_squared};

/// The joint models that the data allow, compared.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelChoice {
    /// Each model, from the simplest.
    pub models: Vec<ModelFit>,
    /// The adequate model with the lowest BIC; without an adequate one, the model with the lowest.
    pub recommended: JointModel,
    /// Whether any model leaves nothing but noise.
    pub any_is_adequate: bool,
}

/// How one joint model fits.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelFit {
    /// The model.
    pub model: JointModel,
    /// How many unknowns it has: those of every bolt with a joint of its own, at every torque.
    pub unknowns: usize,
    /// −2 ln L + p ln n, less that of the best model: Schwarz's criterion with p unknowns and n real numbers.
    pub bic_difference: f64,
    /// χ² over degrees of freedom where the noise is stated, else the residual's mean square beside that of the best model.
    pub reduced_chi_squared: Option<f64>,
    /// Whether it leaves nothing but noise.
    pub adequate: bool,
    /// Whether its search was stopped early, since it was too far from the data: `bic_difference` is a coarse value then.
    pub stopped_early: bool,
}

/// A model that was compared.
struct Compared {
    layout: Layout,
    unknowns: usize,
    /// −2 ln L
    misfit: f64,
    /// Schwarz's criterion.
    bic: f64,
    /// `None` where the search was stopped early.
    found: Option<Found>,
}

impl Compared {
    fn of(layout: Layout, found: Found) -> Self {
        Self {
            layout,
            unknowns: found.estimate.unknowns.len(),
            misfit: found.estimate.misfit,
            bic: bayesian_criterion(&found.estimate),
            found: Some(found),
        }
    }
}

/// Schwarz's criterion of an estimate, −2 ln L + p ln n with p unknowns and n real numbers.
pub(super) fn bayesian_criterion(estimate: &Estimate) -> f64 {
    let numbers = 2.0 * estimate.measurements as f64;
    estimate.misfit + estimate.unknowns.len() as f64 * numbers.ln()
}

/// Compares the models; `found` is the estimate of `layout`. All bolts have the same model, at every torque.
pub(super) fn compare(problem: &Problem<'_>, layout: &Layout, found: &Found) -> ModelChoice {
    let all = [
        JointModel::Translation,
        JointModel::Diagonal,
        JointModel::Full,
    ];
    let all = all.into_iter().filter_map(|other| layout.with_model(other));
    let all: Vec<Layout> = all.collect();
    let others = all.iter().filter(|other| *other != layout).count();
    let step = step("other joint models", Pieces::Exactly(others));
    let compared = |other: Layout| {
        let torques = found.estimate.unknowns.as_slice();
        let starts: Vec<_> = torques
            .chunks_exact(layout.unknowns())
            .map(|unknowns| vec![embedded(layout, unknowns, &other)])
            .collect();
        let start = &starts.first()?[0];
        if let Some(excess) = problem.hopeless_excess(layout, &found.estimate, &other, start) {
            let numbers = 2.0 * found.estimate.measurements as f64;
            let misfit = found.estimate.misfit + excess;
            return Some(Compared {
                unknowns: other.unknowns(),
                misfit,
                bic: misfit + other.unknowns() as f64 * numbers.ln(),
                layout: other,
                found: None,
            });
        }
        let found = problem
            .best(&other, &starts, Effort::Related, Some(&found.used))
            .ok()?;
        Some(Compared::of(other, found.without_corrections()))
    };
    let fits: Vec<Compared> = all
        .into_iter()
        .filter_map(|other| {
            if other == *layout {
                return Some(Compared::of(other, found.clone()));
            }
            let fit = compared(other);
            step.done();
            fit
        })
        .collect();
    drop(step);
    let lowest = fits.iter().map(|fit| fit.bic).fold(f64::INFINITY, f64::min);
    let best = fits
        .iter()
        .map(|fit| fit.misfit)
        .fold(f64::INFINITY, f64::min);
    // A model that is too simple can pass for one with much noise. Of exact data rounding is left, which is no likelihood.
    let is_as_likely =
        |found: &Found| found.assessment.is_exact || found.estimate.misfit <= best + CHANCE;
    let is_adequate = |found: &Found| found.assessment.fits() && is_as_likely(found);
    let models: Vec<ModelFit> = fits
        .iter()
        .map(|fit| ModelFit {
            model: fit.layout.model(),
            unknowns: fit.unknowns,
            bic_difference: fit.bic - lowest,
            reduced_chi_squared: fit.found.as_ref().and_then(tested_chi_squared),
            adequate: fit.found.as_ref().is_some_and(is_adequate),
            stopped_early: fit.found.is_none(),
        })
        .collect();
    let any_is_adequate = models.iter().any(|fit| fit.adequate);
    let recommended = models
        .iter()
        .filter(|fit| fit.adequate || !any_is_adequate)
        .min_by(|a, b| a.bic_difference.total_cmp(&b.bic_difference))
        .map_or(layout.model(), |fit| fit.model);
    ModelChoice {
        models,
        recommended,
        any_is_adequate,
    }
}

/// The unknowns of one model as those of another: what it has not is zero.
fn embedded(from: &Layout, unknowns: &[f64], to: &Layout) -> DVector<f64> {
    let (own, others) = (from.places(), to.places());
    let mut values = Vec::with_capacity(to.unknowns());
    for matrix in 0..2 {
        for place in &others {
            let index = own.iter().position(|other| other == place);
            values.push(index.map_or(0.0, |index| unknowns[matrix * own.len() + index]));
        }
    }
    DVector::from_vec(values)
}
