//! `reproduce tian`: the layers of Tian's paper beside those of the surfaces that come closest.

use std::fmt::Write as _;

use super::super::error::CliError;
use super::super::table::number;
use super::ReproduceArguments;
use super::page::{Page, Section, show};
use bolted_joint::reproduce::{TianFit, TianReproduction, tian};

const COLUMNS: [&str; 8] = [
    "fitted",
    "torque, N·m",
    "E printed, GPa",
    "E obtained",
    "over printed",
    "ν printed",
    "ν obtained",
    "A_t/A_rc",
];
const DIGITS: usize = 4;

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let found = tian()?;
    show(arguments, &found, || {
        Page {
        title: "Tian's virtual material, computed anew",
        source: "H. Tian, D. Zhu and H. Qin, *Theoretical-experimental Modeling of Bolted Joint Interface in Milling of Grey Cast Iron HT250*, 2011: \
                 E and ν of Table I beside those of the paper's equations (1) to (13), with what the paper does not print fitted."
            .to_owned(),
        command: "tian --markdown",
        figure: None,
        sections: vec![Section {
            heading: "Table I: layers that stand for a joint".to_owned(),
            columns: &COLUMNS,
            words: 1,
            rows: lines(&found),
            is_long: false,
            remarks: vec![
                ("Assumed", found.conditions.clone()),
                ("Found", remarks(&found)),
            ],
        }],
    }
    })
}

fn lines(found: &TianReproduction) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for fit in &found.fits {
        for (place, layer) in fit.layers.iter().enumerate() {
            let published = layer.published_youngs_modulus_pa;
            all.push(vec![
                if place == 0 { fit.fitted } else { "" }.to_owned(),
                layer.torque_n_m.to_string(),
                number(1e-9 * published, DIGITS),
                number(1e-9 * layer.youngs_modulus_pa, DIGITS),
                number(layer.youngs_modulus_pa / published, DIGITS),
                number(layer.published_poissons_ratio, DIGITS),
                number(layer.poissons_ratio, DIGITS),
                number(layer.area_ratio, DIGITS + 2),
            ]);
        }
    }
    all
}

fn remarks(found: &TianReproduction) -> Vec<String> {
    let mut all: Vec<String> = found.fits.iter().map(quality).collect();
    all.push(format!(
        "(6) makes E/E' = [4D/(3π²)] (E'/H) (a_L/a_c)^(D/2) (1 − (a_c/a_L)^(1/2)): the printed E, a hundredth of E', need real areas within 1 % of the \
         critical one, which loads within {:.1} % of each other would make; the torques say 3 to 1. No D, G or area has both.",
        100.0 * (found.load_ratio_of_areas - 1.0)
    ));
    all.push(format!(
        "Next to the critical area 1 + ν = E'²/(24π H G' (1 − β/f)^(1/3)) whatever D and G: by these equations there is an isotropic layer (ν < 0.5) \
         only from a hardness of {} GPa on, and ν does not grow with the torque as printed.",
        number(1e-9 * found.least_hardness_pa, 3)
    ));
    all.push(
        "Up to a factor for each modulus the table goes with the load as the equations do. The factors, some millionths, say that it was not computed \
         with (1) and (12) as printed, which are sums over contacts that are not divided by an area."
            .to_owned(),
    );
    all.push(
        "Table III, the frequencies, needs the specimen's finite-element model: its plates are hollow, their inner dimensions are in a figure only, and \
         the layer's thickness is not given. It cannot be computed anew."
            .to_owned(),
    );
    all
}

fn quality(fit: &TianFit) -> String {
    let mut text = format!(
        "{}: root mean square of ln(obtained/printed) over E and G {}, a factor of {}",
        capital(fit.fitted),
        number(fit.log_residual, 3),
        number(fit.log_residual.exp(), 3)
    );
    if let (Some(dimension), Some(roughness)) = (fit.fractal_dimension, fit.roughness_m) {
        let _ = write!(
            text,
            "; D = {}{}, G = {} m",
            number(dimension, DIGITS),
            deviation(fit.fractal_dimension_deviation),
            number(roughness, 3)
        );
        if let Some(of) = fit.log_roughness_deviation {
            let _ = write!(text, " (ln G{})", deviation(Some(of)));
        }
    }
    if fit.magnitudes != [1.0; 2] {
        let [young, shear] = fit.magnitudes;
        let _ = write!(
            text,
            "; factors {} of E and {} of G",
            number(young, 3),
            number(shear, 3)
        );
    }
    if fit.is_at_bound {
        text += "; at the edge of the search (1.05 ≤ D ≤ 1.95), so that no surface fits";
    }
    text.push('.');
    text
}

fn deviation(of: Option<f64>) -> String {
    of.map_or_else(String::new, |of| format!(" ± {}", number(of, 2)))
}

fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(characters).collect()
    })
}
