//! Numbers that the thesis prints, beside those of its own equations.

use serde::Serialize;

use bolted_joint_frf::structure::Boundary;
use bolted_joint_predict::layered_beam::{LayeredBeamError, ModeShape, StoredEnergy, root};
use bolted_joint_predict::pressure::ThicknessRatio;

use super::specimens::{BOUNDARIES, Setup, Specimen};

/// A printed number beside the one that comes out here.
#[derive(Clone, Debug, Serialize)]
pub struct PrintedNumber {
    /// Where it stands.
    pub source: &'static str,
    /// What it is.
    pub quantity: String,
    /// As printed; `None` where the thesis gives the means and not the number.
    pub printed: Option<f64>,
    /// As computed.
    pub obtained: f64,
    /// Its unit, if any.
    pub unit: &'static str,
    /// What is to be said about a difference.
    pub remark: String,
}

/// As Table 3.1 prints A2 of thickness ratio 2.
const PRINTED_A2: f64 = 7.45e-4;

/// A2 of thickness ratio 2 with which the pressure ends at the rim of its zone.
const CORRECTED_A2: f64 = 7.45e-6;

pub(super) fn all() -> Result<Vec<PrintedNumber>, LayeredBeamError> {
    let mut all = Vec::new();
    let mut say = |source, quantity: String, printed, obtained, unit, remark: &str| {
        all.push(PrintedNumber {
            source,
            quantity,
            printed,
            obtained,
            unit,
            remark: remark.to_owned(),
        });
    };
    let roots = [
        (1, 3.92, "cut off, not rounded"),
        (2, 7.07, ""),
        (3, 10.1, "cut off after one decimal"),
    ];
    for (mode, printed, remark) in roots {
        let obtained = root(Boundary::FixedPinned, mode);
        let quantity = format!("λ{mode} of fixed–pinned ends");
        say("(3.24d)", quantity, Some(printed), obtained, "", remark);
    }
    let antinode = ModeShape::new(Boundary::FixedPinned, 1).antinode();
    let quantity = "l′/l, largest deflection of fixed–pinned ends".to_owned();
    say("(3.25)", quantity, Some(0.58), antinode, "", "");
    let head = 1.75_f64.powi(2) - 1.0;
    say(
        "(3.33)",
        "A′/πR_v², area under a rivet's head".to_owned(),
        Some(2.0625),
        head,
        "",
        "",
    );
    let ratios = [
        ("1", ThicknessRatio::One),
        ("1.5", ThicknessRatio::OneAndAHalf),
        ("2", ThicknessRatio::Two),
    ];
    for (name, ratio) in ratios {
        let rim = ratio.rim_over_rivet_radius();
        let pressure = ratio.pressure_over_surface_stress(rim);
        let quantity = format!("p/σ_s at the rim of the zone, thickness ratio {name}");
        let remark = match ratio {
            ThicknessRatio::One => "ends a little below zero: the last digits of Table 3.1",
            ThicknessRatio::OneAndAHalf => "",
            ThicknessRatio::Two => "with A2 = 7.45e-06",
        };
        say("Table 3.1", quantity, Some(0.0), pressure, "", remark);
    }
    let rim = ThicknessRatio::Two.rim_over_rivet_radius();
    let corrected = ThicknessRatio::Two.pressure_over_surface_stress(rim);
    let as_printed = corrected + (PRINTED_A2 - CORRECTED_A2) * rim.powi(8);
    let quantity = "p/σ_s at the rim of the zone, thickness ratio 2, A2 as printed".to_owned();
    let remark = "A2 = 7.45e-04 is a misprint of 7.45e-06";
    say("Table 3.1", quantity, Some(0.0), as_printed, "", remark);
    for (name, ratio) in ratios {
        let quantity = format!("N/P, thickness ratio {name}");
        let remark = "both lines of (3.34) divided by 2.0625, of which it prints the first alone; equilibrium asks for 1";
        say(
            "(3.34)",
            quantity,
            None,
            ratio.normal_force_over_preload(),
            "",
            remark,
        );
    }
    let peak = |ratio: ThicknessRatio| ratio.pressure_over_surface_stress(1.0);
    for (name, ratio) in ratios {
        let quantity = format!("p/σ_s at the rivet, thickness ratio {name}");
        say("(3.32)", quantity, None, peak(ratio), "", "");
    }
    let specimen = Specimen::numbered(1);
    let mut stiffness = |boundary: Boundary| -> Result<(), LayeredBeamError> {
        let (modal, fixed) = (Setup::with(boundary), StoredEnergy::Static);
        let fixed = Setup {
            stored: fixed,
            ..modal
        };
        let beam = specimen.beam(&modal)?;
        let unit = beam.bending_stiffness_n_m2() / beam.length_m().powi(3);
        let static_stiffness = specimen.mode(&fixed, 1)?.stiffness_n_per_m / unit;
        let ends = ends(boundary);
        if boundary == Boundary::FixedFixed {
            let quantity = format!("k′l³/EI, static, {ends}");
            say("5.4.2", quantity, Some(192.0), static_stiffness, "", "");
        }
        let modal_stiffness = specimen.mode(&modal, 1)?.stiffness_n_per_m / unit;
        let quantity = format!("stiffness in the stored energy, modal over static, {ends}");
        let remark = "E_n of (3.39) has the static deflection's stiffness, that of (4.31) the mode's: the classical damping ratio is the larger one by this";
        say(
            "(3.39), (4.31)",
            quantity,
            None,
            modal_stiffness / static_stiffness,
            "",
            remark,
        );
        Ok(())
    };
    for boundary in BOUNDARIES {
        stiffness(boundary)?;
    }
    let slope = "slip of (3.29), (3.30) over that of (3.27), (4.27)".to_owned();
    let remark = "(3.29) halves h1 + h2, which are half thicknesses already: the classical damping ratio as printed is half that of (4.32), \
                  and α′μ calibrated by the one (3.44) must not be used in the other";
    say("(3.29)", slope, None, 0.5, "", remark);
    let symmetric = {
        let setup = Setup::default();
        let (beam, rivets) = (specimen.beam(&setup)?, specimen.rivets(&setup)?);
        let shape = beam.shape(1);
        let positions = rivets.positions_m().iter();
        let slopes = positions.map(|x| shape.slope(x / beam.length_m()));
        let (sum, absolute) = slopes.fold((0.0_f64, 0.0_f64), |(sum, absolute), slope| {
            (sum + slope, absolute + slope.abs())
        });
        // what is left is rounding
        Some((sum / absolute).abs())
            .filter(|part| *part > 1e-12)
            .unwrap_or(0.0)
    };
    let quantity =
        "sum of slopes as printed over that of their absolute values, specimen 1".to_owned();
    let remark = "with signs, the two halves of a symmetric mode cancel and there is no damping at all; each rivet's slip counts by its size";
    say("(3.31), (4.29)", quantity, None, symmetric, "", remark);
    for (loss, which) in [(0.05_f64, "least"), (0.10, "largest")] {
        let quantity = format!(
            "frequencies fall by, with the {which} measured loss of stiffness, {:.0} %",
            100.0 * loss
        );
        say(
            "6 (6.)",
            quantity,
            None,
            100.0 * (1.0 - (1.0 - loss).sqrt()),
            "%",
            "",
        );
    }
    for (source, difference, remark) in [
        ("5.6.3", 0.045_f64, "near the measured 5 to 10 %"),
        ("5.6.4", 0.04, "near the measured 5 to 10 %"),
        (
            "7.1",
            0.30,
            "far beyond the measured 5 to 10 %, and not the 4.5 % of 5.6.3",
        ),
    ] {
        // f/f′ = √(k/k′)
        let loss = 1.0 - (1.0 - difference).powi(2);
        let quantity = format!(
            "loss of stiffness with which measured frequencies are {:.1} % below computed ones, as printed",
            100.0 * difference
        );
        say(source, quantity, None, 100.0 * loss, "%", remark);
    }
    Ok(all)
}

fn ends(boundary: Boundary) -> &'static str {
    match boundary {
        Boundary::FixedFixed => "fixed–fixed",
        Boundary::FixedPinned => "fixed–pinned",
        _ => "pinned–pinned",
    }
}
