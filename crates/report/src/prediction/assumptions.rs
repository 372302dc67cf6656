//! What went into a prediction: every number with its distribution, and what the model takes for granted.

use bolted_joint_figures::html::{cell, escaped, number, number_cell, spread, table};
use bolted_joint_predict::fractal::StoredEnergy;
use bolted_joint_predict::patch::{LossFactor, NormalDamping};
use bolted_joint_predict::study::{CONTACT_ALONE, Prediction};
use bolted_joint_study::Method;

pub(super) fn section(found: &Prediction<'_>) -> String {
    let study = found.study;
    let rows: Vec<String> = study
        .inputs
        .iter()
        .map(|(name, distribution)| {
            let deviation = match distribution.is_exact() {
                true => "–".to_owned(),
                false => spread(distribution.standard_deviation()),
            };
            [
                cell(&escaped(name)),
                number_cell(&number(distribution.nominal())),
                number_cell(&deviation),
                cell(distribution.words()),
            ]
            .concat()
        })
        .collect();
    let mut taken = vec![
        format!("<b>{CONTACT_ALONE}</b>"),
        "The parts are flat between their holes; the pressure is what the bolts make of them, and vibration does not change it.".to_owned(),
        match study.microslip {
            None => "Motion is small: the interface neither opens nor slides as a whole.",
            Some(_) => "The interface does not open. What it is pressed with stays the same while it slips.",
        }
        .to_owned(),
    ];
    match study.method {
        Method::FractalContact => taken.extend([
            "Each point of the interface has the stiffness of two fractal surfaces under the pressure there (Zhao et al., 2016)."
                .to_owned(),
            energy_ratio(study.loss_factor, study.stored_energy),
        ]),
        Method::VirtualMaterial => taken.push(
            "A layer of even elasticity stands for the interface (Tian et al., 2011).".to_owned(),
        ),
        _ => {}
    }
    taken.push(match study.normal_damping {
        NormalDamping::Hysteretic => {
            "Damping along the normal is hysteretic, <i>D</i> = ηK, as along the interface."
                .to_owned()
        }
        NormalDamping::Viscous { mass_kg } => format!(
            "Damping along the normal is viscous, <i>C</i> = η√(<i>MK</i>) with <i>M</i> = {} kg.",
            number(mass_kg)
        ),
    });
    let taken: String = taken
        .iter()
        .map(|sentence| format!("<li>{sentence}</li>\n"))
        .collect();
    format!(
        "<h2>What was put in</h2>\n{}<h2>What is taken for granted</h2>\n<ul>\n{taken}</ul>\n",
        table(
            &["Quantity (SI)", "Value", "Std. dev.", "Distribution"],
            &rows
        )
    )
}

/// What a ratio of energies is taken for.
fn energy_ratio(loss_factor: LossFactor, stored_energy: StoredEnergy) -> String {
    let of = match loss_factor {
        LossFactor::EnergyRatioOverTwoPi => {
            "The loss factor is the ratio of the energies lost and stored over 2π, as a cycle of a spring K(1 + jη) has it"
        }
        LossFactor::EnergyRatio => {
            "The ratio of the energies lost and stored is the loss factor itself, as published; by the energies of a cycle it would be 2π times \
             less"
        }
    };
    let stored = match stored_energy {
        StoredEnergy::OneLoading => "one loading takes up",
        StoredEnergy::PiLoadings => "π loadings take up, as published",
    };
    format!("{of}. Along the interface the energy stored is what {stored}, less what is lost.")
}
