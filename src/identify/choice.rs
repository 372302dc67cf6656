//! Joint models beside each other: the simplest one that explains the data, by likelihood and number of unknowns.

use nalgebra::DVector;

use super::model::JointModel;
use super::noise::Noise;
use super::search::{self, Data, Effort, Found};

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
    /// −2 ln L + p ln n, less that of the best model: Schwarz's criterion with p unknowns and n real numbers.
    pub bic_difference: f64,
    /// χ² over degrees of freedom where the noise is stated, else the residual's mean square beside that of the best model.
    pub reduced_chi_squared: Option<f64>,
    /// Whether it leaves nothing but noise.
    pub adequate: bool,
}

/// Compares the models; `found` is the estimate of `model`.
pub(super) fn compare<const N: usize>(
    data: &Data<N>,
    model: JointModel,
    noise: &Noise,
    found: &Found,
) -> ModelChoice {
    let all = [
        JointModel::Translation,
        JointModel::Diagonal,
        JointModel::Full,
    ];
    let fits: Vec<(JointModel, Found)> = all
        .into_iter()
        .filter(|other| other.dofs() <= N)
        .filter_map(|other| {
            if other == model {
                return Some((other, found.clone()));
            }
            let start = embedded(model, &found.estimate.unknowns, other);
            let effort = Effort::Related;
            let found = search::best(data, other.entries(), noise, vec![start], effort).ok()?;
            Some((other, found))
        })
        .collect();
    let bic = |(model, found): &(JointModel, Found)| {
        let numbers = 2.0 * found.estimate.measurements as f64;
        found.estimate.misfit + model.unknowns() as f64 * numbers.ln()
    };
    let lowest = fits.iter().map(bic).fold(f64::INFINITY, f64::min);
    let models: Vec<ModelFit> = fits
        .iter()
        .map(|fit| ModelFit {
            model: fit.0,
            bic_difference: bic(fit) - lowest,
            reduced_chi_squared: (fit.1.assessment.noise_is_stated
                || fit.1.assessment.noise_is_known)
                .then(|| fit.1.estimate.reduced_chi_squared())
                .flatten(),
            adequate: fit.1.assessment.fits(),
        })
        .collect();
    let any_is_adequate = models.iter().any(|fit| fit.adequate);
    let recommended = models
        .iter()
        .filter(|fit| fit.adequate || !any_is_adequate)
        .min_by(|a, b| a.bic_difference.total_cmp(&b.bic_difference))
        .map_or(model, |fit| fit.model);
    ModelChoice {
        models,
        recommended,
        any_is_adequate,
    }
}

/// The unknowns of one model as those of another: what it has not is zero.
fn embedded(from: JointModel, unknowns: &DVector<f64>, to: JointModel) -> DVector<f64> {
    let count = from.entries().len();
    let mut values = Vec::with_capacity(to.unknowns());
    for matrix in 0..2 {
        for entry in to.entries() {
            let place = from.entries().iter().position(|other| other == entry);
            values.push(place.map_or(0.0, |place| unknowns[matrix * count + place]));
        }
    }
    DVector::from_vec(values)
}
