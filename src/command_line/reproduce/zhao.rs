//! `reproduce zhao`: what follows from the numbers that Zhao's paper prints.

use super::super::error::CliError;
use super::super::table::number;
use super::ReproduceArguments;
use super::page::{Page, Section, percent, show};
use bolted_joint::reproduce::{Denominator, ZhaoError, ZhaoReproduction, zhao};

const DIGITS: usize = 4;

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let found = zhao()?;
    show(arguments, &found, || {
        Page {
        title: "Zhao's bolted boxes, computed anew",
        source: "Y. Zhao, C. Yang, L. Cai, W. Shi and Y. Hong, *Stiffness and Damping Model of Bolted Joints with Uneven Surface Contact Pressure \
                 Distribution*, Stroj. vestn. – J. Mech. Eng. 62 (2016) 665–677: the contact under the pressures that the paper names, its loss \
                 factors, and the errors of Table 3 ([theory](theory.md#15-from-physics-fractal-contact))."
            .to_owned(),
        command: "zhao --markdown",
        figure: None,
        sections: vec![
            frequencies(&found),
            shares(&found),
            contacts(&found),
            losses(&found),
        ],
    }
    })
}

fn frequencies(found: &ZhaoReproduction) -> Section {
    let rows = found.frequencies.iter().map(|row| {
        let load = if row.mode == 1 { row.load } else { "" };
        let mut cells = vec![
            load.to_owned(),
            format!("f{}", row.mode),
            format!("{:.2}", row.measured_hz),
        ];
        for of in [&row.even, &row.uneven] {
            let is_of_computed = of.relative_to == Denominator::Computed;
            cells.extend([
                format!("{:.2}", of.computed_hz),
                percent(of.published_percent, 2) + if is_of_computed { " c" } else { "" },
                percent(of.percent, 2),
            ]);
        }
        cells
    });
    let all = |of: fn(&ZhaoReproduction) -> Vec<&ZhaoError>| of(found);
    let even = all(|found| found.frequencies.iter().map(|row| &row.even).collect());
    let uneven = all(|found| found.frequencies.iter().map(|row| &row.uneven).collect());
    let count = |of: &[&ZhaoError], relative_to| {
        let same = of.iter().filter(|of| of.relative_to == relative_to);
        same.count()
    };
    let largest = |of: &[&ZhaoError]| of.iter().map(|of| of.percent.abs()).fold(0.0, f64::max);
    Section {
        heading: "Table 3: frequencies in Hz, and their errors".to_owned(),
        columns: &[
            "preload", "", "measured", "even pressure", "printed", "error", "uneven pressure", "printed", "error",
        ],
        words: 2,
        rows: rows.collect(),
        is_long: false,
        remarks: vec![("", vec![
            "c: the printed error is relative to the computed frequency. Errors beside are relative to the measured one.".to_owned(),
            format!(
                "Denominators are mixed. By even pressure {} of 18 printed errors are relative to the computed frequency and {} to the measured one, \
                 by uneven pressure {} and {}; the others do not tell.",
                count(&even, Denominator::Computed),
                count(&even, Denominator::Measured),
                count(&uneven, Denominator::Computed),
                count(&uneven, Denominator::Measured),
            ),
            format!(
                "The largest error is {:.2} % by even and {:.2} % by uneven pressure, {:.1} times as much; the paper says 10.07 % and 5.1 %, twice.",
                largest(&even),
                largest(&uneven),
                largest(&even) / largest(&uneven),
            ),
            "The text beside the table has -2.43 % for f3 at 9 kN, where the computed frequency is higher.".to_owned(),
            "\"The 1st to 6th order natural frequency are depressed\" by the moment: all measured ones are, but by uneven pressure f4 and f6 rise."
                .to_owned(),
            "The frequencies themselves need the boxes' finite-element model, whose dimensions are in a figure only: they cannot be computed anew."
                .to_owned(),
        ])],
    }
}

fn shares(found: &ZhaoReproduction) -> Section {
    let rows = found.joint_shares.iter().enumerate().map(|(mode, shares)| {
        let shares = shares.map(|share| percent(100.0 * share, 1));
        [vec![format!("f{}", mode + 1)], shares.to_vec()].concat()
    });
    let [first, .., fifth, _] = found.joint_shares.map(|[measured, ..]| measured);
    // ln K = 2 ln f/share, of the errors at 15 kN by uneven pressure
    let in_stiffness = |share: f64, mode: usize| {
        let mut rows = found.frequencies.iter();
        let row = rows.find(|row| row.load == "15 kN" && row.mode == mode);
        row.map_or(f64::NAN, |row| 2.0 * row.uneven.percent.abs() / share)
    };
    Section {
        heading: "From 9 to 15 kN: how much of a mode's strain energy is in the joint".to_owned(),
        columns: &["", "measured", "even pressure", "uneven pressure"],
        words: 1,
        rows: rows.collect(),
        is_long: false,
        remarks: vec![("", vec![
            format!(
                "By (14) and (22) every point is {} times as stiff at 15 kN as at 9 kN. A frequency then rises by half of the joint's share of the \
                 strain energy (Rayleigh), so that the share follows from both frequencies.",
                number(found.stiffness_gain, DIGITS)
            ),
            "No share can be negative: f3 by even pressure (840.12 to 835.20 Hz) and f6 by uneven pressure (1408.7 to 1407.5 Hz) fall although \
             nothing gets softer. They do not follow from the model."
                .to_owned(),
            format!(
                "The plates hold most of the energy: errors of frequencies of 0.80 % of f1 and 5.10 % of f5 at 15 kN would be {:.0} % and {:.0} % of \
                 the joint's stiffness.",
                in_stiffness(first, 1),
                in_stiffness(fifth, 5),
            ),
            format!(
                "4500 N·m as 20 and 10 kN on three bolts each are rows {} m apart, as (L_a/2)(F' − F'')N_b has it. The contact's stiffness as a whole \
                 falls by {:.2} % only; the measured frequencies fall by up to 4.2 %.",
                number(found.row_distance_m, 2),
                100.0 * (1.0 - found.stiffness_under_moment)
            ),
        ])],
    }
}

fn contacts(found: &ZhaoReproduction) -> Section {
    let rows = found.contacts.iter().map(|of| {
        vec![
            number(of.area_m2, DIGITS),
            format!("{:.3}", 1e-6 * of.pressure_pa),
            number(of.normal_stiffness_n_per_m3, DIGITS),
            number(of.tangential_stiffness_n_per_m3, DIGITS),
            percent_of_area(of.real_area_fraction),
            number(of.normal_energy_ratio, DIGITS),
            number(of.normal_loss_factor, DIGITS),
        ]
    });
    let [low, high] = found.area_bounds_m2.map(|area| number(area, 3));
    let [least, most] = found.friction_needed;
    Section {
        heading: "Contact under the pressures that are named".to_owned(),
        columns: &[
            "A0, m²", "p, MPa", "K_N/A0, N/m³", "K_T/A0, N/m³", "real area", "η_N printed", "η_N/(2π)",
        ],
        words: 0,
        rows: rows.collect(),
        is_long: false,
        remarks: vec![
            ("Not given in the paper", vec![
                format!(
                    "The area, which is in a figure only: 0.06 m² here. The mean of eight bolts of 9 kN is between 0.62 and 7.98 MPa for areas from \
                     {low} to {high} m², which are shown as well. Means are those of 9 and 15 kN."
                ),
                "Friction and shear strength: no tangential load here.".to_owned(),
            ]),
            ("Found", vec![
                "Real areas come to more than the \"less than 1 %\" where the pressure is highest.".to_owned(),
                format!(
                    "T = τ_b A_r with the metal's shear strength, Y/√3 with Y = H/2.8, exceeds friction at every pressure for μ below {least:.2}, and \
                     under the bolts for μ below {most:.2}: (22) and (29) have no value then. τ_b can only be the stress that acts."
                ),
                "H = 1.96 GPa means Y = 700 MPa by the paper's H = 2.8 Y; QT600-3 has 370 MPa by its standard.".to_owned(),
                "(5) and (31) define G with factors that differ: by (5), 2.9 times as large a G makes the profile that (31) measures."
                    .to_owned(),
            ]),
        ],
    }
}

fn percent_of_area(fraction: f64) -> String {
    format!("{:.3} %", 100.0 * fraction)
}

fn losses(found: &ZhaoReproduction) -> Section {
    let rows = found.losses.iter().map(|of| {
        vec![
            of.friction_ratio.to_string(),
            number(of.published, DIGITS),
            number(of.energy_ratio, DIGITS),
            number(of.loss_factor, DIGITS),
        ]
    });
    Section {
        heading: "Loss factor along the interface (29)".to_owned(),
        columns: &["T/(μP)", "5π/24, printed", "5/24", "5/24, over 2π"],
        words: 0,
        rows: rows.collect(),
        is_long: false,
        remarks: vec![("", vec![
            "(23) and (25) give 5/24, which has a pole at T/(μP) = 0.9583; the printed factor is π times that. Both are energies lost over energies \
             stored; a spring K(1 + jη) loses 2πη of what it stores. `predict` takes the last column, others with `damping.loss_factor` and \
             `damping.stored_energy`."
                .to_owned(),
        ])],
    }
}
