//! Table I of Tian's paper: published layers beside those of the surface that comes closest by the paper's own equations.

use std::f64::consts::PI;

use serde::Serialize;

use super::ReproduceError;
use bolted_joint_predict::surface::Roughness;
use bolted_joint_predict::virtual_material::{
    Fit, LayerContact, Loading, Magnitudes, Moduli, Observation, fit,
};
use bolted_joint_predict::{Material, Pair};

/// Torque on each bolt (N·m), E (Pa) and ν of Table I.
const TABLE_1: [(f64, f64, f64); 3] = [
    (45.0, 0.352e9, 0.23),
    (90.0, 0.541e9, 0.25),
    (135.0, 0.885e9, 0.26),
];
const BOLTS: f64 = 11.0;
const DIAMETER_M: f64 = 0.024;
/// What the paper does not print.
const NUT_FACTOR: f64 = 0.2;
const YOUNGS_MODULUS_PA: f64 = 1.1e11;
const POISSONS_RATIO: f64 = 0.26;
const HARDNESS_PA: f64 = 1.96e9;
/// Fractal dimension at which real areas are found from E alone; others give nearly the same.
const DIMENSION_FOR_AREAS: f64 = 1.5;
const ANY_ROUGHNESS_M: f64 = 1e-9;

/// What is assumed beside the table.
const CONDITIONS: [&str; 3] = [
    "Both parts grey cast iron HT250, E = 110 GPa, ν = 0.26, hardness 1.96 GPa (about 200 HB).",
    "Eleven M24 bolts with nut factor 0.2: P = 11 T/(0.2 · 0.024 m), 103, 206 and 309 kN.",
    "No tangential load: β = 0.",
];

/// One torque of Table I.
#[derive(Clone, Debug, Serialize)]
pub struct TianLayer {
    /// Tightening torque of each bolt, N·m.
    pub torque_n_m: f64,
    /// Young's modulus as printed, Pa.
    pub published_youngs_modulus_pa: f64,
    /// Poisson's ratio as printed.
    pub published_poissons_ratio: f64,
    /// Young's modulus as obtained, Pa.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio E/(2G) − 1 as obtained.
    pub poissons_ratio: f64,
    /// Obtained real over critical real area, A_t/A_rc.
    pub area_ratio: f64,
}

/// All torques with what was fitted.
#[derive(Clone, Debug, Serialize)]
pub struct TianFit {
    /// What was fitted.
    pub fitted: &'static str,
    /// Fractal dimension, if it was fitted.
    pub fractal_dimension: Option<f64>,
    /// Its standard deviation, from the residual.
    pub fractal_dimension_deviation: Option<f64>,
    /// Fractal roughness, m, if it was fitted.
    pub roughness_m: Option<f64>,
    /// Standard deviation of its natural logarithm.
    pub log_roughness_deviation: Option<f64>,
    /// Whether the best lies at the edge of the search.
    pub is_at_bound: bool,
    /// Factors of E and G that were fitted, or 1.
    pub magnitudes: [f64; 2],
    /// Root mean square of ln(obtained/published) over E and G of all torques.
    pub log_residual: f64,
    /// The torques.
    pub layers: Vec<TianLayer>,
}

/// Table I computed anew.
#[derive(Clone, Debug, Serialize)]
pub struct TianReproduction {
    /// What is assumed.
    pub conditions: Vec<String>,
    /// The fits: D and G; real areas; D, G and a factor for each modulus.
    pub fits: Vec<TianFit>,
    /// Greatest load over the least that the real areas of the second fit amount to; the torques' is 3.
    pub load_ratio_of_areas: f64,
    /// Hardness below which Poisson's ratio is 0.5 or more next to the critical area, whatever D and G, Pa.
    pub least_hardness_pa: f64,
}

/// Fits Table I.
///
/// # Errors
/// None with the built-in numbers; [`ReproduceError`] should a fit fail.
pub fn tian() -> Result<TianReproduction, ReproduceError> {
    let iron = Material::new(YOUNGS_MODULUS_PA, POISSONS_RATIO)?;
    let pair = Pair { a: iron, b: iron };
    let observations = TABLE_1.map(|(torque, young, poisson)| Observation {
        // P = n T/(K d)
        loading: Loading::Force(BOLTS * torque / (NUT_FACTOR * DIAMETER_M)),
        moduli: moduli(young, poisson),
    });
    let fitted = |magnitudes| fit(&observations, &pair, HARDNESS_PA, 0.0, magnitudes);
    let (areas, load_ratio_of_areas) = from_areas(&pair)?;
    // 1 + ν → E'²/(24π H G') < 3/2 for a_L → a_c
    let least_hardness_pa = pair.equivalent_youngs_modulus_pa().powi(2)
        / (36.0 * PI * pair.equivalent_shear_modulus_pa());
    Ok(TianReproduction {
        conditions: CONDITIONS.map(str::to_owned).to_vec(),
        fits: vec![
            described("D and G", &fitted(Magnitudes::Stated)?),
            areas,
            described(
                "D, G and a factor of each modulus",
                &fitted(Magnitudes::Free)?,
            ),
        ],
        load_ratio_of_areas,
        least_hardness_pa,
    })
}

fn moduli(youngs_modulus_pa: f64, poissons_ratio: f64) -> Moduli {
    Moduli {
        youngs_modulus_pa,
        shear_modulus_pa: youngs_modulus_pa / (2.0 * (1.0 + poissons_ratio)),
    }
}

fn layer(place: usize, found: Moduli, area_ratio: f64) -> TianLayer {
    let (torque_n_m, published_youngs_modulus_pa, published_poissons_ratio) = TABLE_1[place];
    TianLayer {
        torque_n_m,
        published_youngs_modulus_pa,
        published_poissons_ratio,
        youngs_modulus_pa: found.youngs_modulus_pa,
        poissons_ratio: found.poissons_ratio(),
        area_ratio,
    }
}

fn described(fitted: &'static str, found: &Fit) -> TianFit {
    let layers = found.layers.iter().enumerate();
    TianFit {
        fitted,
        fractal_dimension: Some(found.roughness.fractal_dimension()),
        fractal_dimension_deviation: found.dimension_deviation,
        roughness_m: Some(found.roughness.roughness_m()),
        log_roughness_deviation: found.log_roughness_deviation,
        is_at_bound: found.is_at_bound,
        magnitudes: found.magnitudes,
        log_residual: found.log_residual,
        layers: layers
            .map(|(place, of)| layer(place, of.moduli, of.area_ratio))
            .collect(),
    }
}

/// The real areas that give the printed E exactly, whatever load they take, and the greatest over the least of those loads.
fn from_areas(pair: &Pair) -> Result<(TianFit, f64), ReproduceError> {
    let roughness = Roughness::new(DIMENSION_FOR_AREAS, ANY_ROUGHNESS_M)?;
    let contact = LayerContact::new(pair, roughness, HARDNESS_PA, 0.0)?;
    let critical_m2 = contact.critical_real_area_m2();
    let mut layers = Vec::new();
    let mut loads = Vec::new();
    let mut sum = 0.0;
    for (place, (_, young, poisson)) in TABLE_1.into_iter().enumerate() {
        // E grows with A_t/A_rc − 1, here by its logarithm.
        let [mut low, mut high] = [1e-9_f64.ln(), 1e3_f64.ln()];
        let loading = |log: f64| Loading::RealArea(critical_m2 * (1.0 + log.exp()));
        while high - low > 1e-13 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if contact.moduli(loading(middle))?.youngs_modulus_pa < young {
                low = middle;
            } else {
                high = middle;
            }
        }
        let found = contact.moduli(loading(low))?;
        let known = moduli(young, poisson);
        sum += (found.youngs_modulus_pa / known.youngs_modulus_pa)
            .ln()
            .powi(2)
            + (found.shear_modulus_pa / known.shear_modulus_pa)
                .ln()
                .powi(2);
        loads.push(contact.load_n(loading(low))?);
        layers.push(layer(place, found, 1.0 + low.exp()));
    }
    let least = loads.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = loads.iter().copied().fold(0.0, f64::max);
    let fitted = TianFit {
        fitted: "the real area at each torque, from E",
        fractal_dimension: None,
        fractal_dimension_deviation: None,
        roughness_m: None,
        log_roughness_deviation: None,
        is_at_bound: false,
        magnitudes: [1.0; 2],
        log_residual: (sum / (2 * TABLE_1.len()) as f64).sqrt(),
        layers,
    };
    Ok((fitted, greatest / least))
}
