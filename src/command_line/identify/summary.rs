//! What an identification found, for people: numbers with their deviations, and what they rest on.

use std::fmt::Write as _;

use bolted_joint::identify::{BootstrapResult, Identification, JointEstimate, Study};
use bolted_joint::joint::Drawn;

use super::super::identified_from::{at_bolts, averaged, from_modes, place};
use super::super::table::{Table, number};
use super::budget;

/// The whole of it.
pub(super) fn summary(found: &Identification, study: &Study) -> String {
    let mut text = format!("{}\n{}\n", found.name, basis(found));
    let joints = &found.estimate.joints;
    let bolts = found.bolts.with_own_joint();
    for joint in joints {
        if let Some(torque) = joint.torque_n_m {
            let _ = write!(text, "\nat {torque} N·m");
        }
        text += "\n";
        text += &parameters(joint, bolts);
    }
    let active: Vec<String> = joints
        .iter()
        .filter(|joint| joint.free_is_active())
        .map(place)
        .collect();
    if !active.is_empty() {
        let _ = writeln!(
            text,
            "\nThe free estimate is active{}; \"identified\" is the passive joint that fits best, and is what the file holds.",
            active.join(" and")
        );
    }
    for joint in joints {
        text += &averaged(joint, bolts);
    }
    text += &from_modes(found);
    text += &budget::budget(found);
    let _ = writeln!(text, "\n{}", fit(found));
    text += &models(found, study);
    text += &torques(found);
    if let Some(about) = found.about_the_residual() {
        let _ = writeln!(text, "{about}");
    }
    for joint in joints {
        if let Some(result) = &joint.bootstrap {
            text += &bootstrap(result, joint, bolts);
        }
    }
    text
}

/// The parameters at one torque.
fn parameters(joint: &JointEstimate, bolts: &[String]) -> String {
    let covariance = &joint.covariance;
    let active = joint.free != joint.bolts();
    let deviation = covariance.standard_deviation();
    let mut header = vec!["", "identified", "± std. dev.", "95 % interval"];
    if active {
        header.push("free estimate");
    }
    header.extend(["band average", "unit"]);
    let mut table = Table::new(&header);
    let intervals = joint.intervals();
    for (index, unknown) in covariance.unknowns.iter().enumerate() {
        let [low, high] = intervals[index];
        let mut cells = vec![unknown.label(bolts)];
        if covariance.identified[index] {
            cells.extend([
                number(unknown.value(&joint.bolts()[unknown.joint]), 5),
                number(deviation[index], 2),
                format!("{} … {}", number(low, 5), number(high, 5)),
            ]);
        } else {
            cells.extend(["not identified", "", ""].map(str::to_owned));
        }
        if active {
            cells.push(number(unknown.value(&joint.free[unknown.joint]), 5));
        }
        cells.push(joint.band_averages.as_ref().map_or_else(
            || "none".to_owned(),
            |averages| number(unknown.value(&averages[unknown.joint]), 5),
        ));
        cells.push(unknown.unit.to_owned());
        table.row(cells);
    }
    table.render()
}

/// The joint models beside each other.
fn models(found: &Identification, study: &Study) -> String {
    if let Some(reason) = study.models_not_compared() {
        return format!("joint models are not compared: {reason}\n");
    }
    let Some(choice) = found.estimate.model_choice() else {
        return String::new();
    };
    let compared: Vec<String> = choice
        .models
        .iter()
        .map(|fit| {
            let residual = leaves(fit.adequate);
            if fit.stopped_early {
                return format!(
                    "{} about +{} ({residual})",
                    fit.model,
                    number(fit.bic_difference, 1)
                );
            }
            format!("{} +{:.1} ({residual})", fit.model, fit.bic_difference)
        })
        .collect();
    let advice = if !choice.any_is_adequate {
        format!("none is adequate, \"{}\" comes closest", choice.recommended)
    } else if choice.recommended == found.model {
        format!("\"{}\" is the simplest adequate one", choice.recommended)
    } else {
        format!(
            "\"{}\" is the simplest adequate one: consider it instead of \"{}\"",
            choice.recommended, found.model
        )
    };
    format!("joint models by BIC: {}; {advice}\n", compared.join(", "))
}

/// A common joint beside one for each torque.
fn torques(found: &Identification) -> String {
    let Some(choice) = found.estimate.torque_choice() else {
        return String::new();
    };
    let compared: Vec<String> = choice
        .compared
        .iter()
        .map(|fit| {
            let residual = leaves(fit.adequate);
            format!("{} +{:.1} ({residual})", fit.dependence, fit.bic_difference)
        })
        .collect();
    let advice = match (choice.any_is_adequate, choice.recommended) {
        (true, recommended) => format!("\"{recommended}\" is the simplest adequate one"),
        (false, closest) => format!("neither is adequate, \"{closest}\" comes closest"),
    };
    let compared = compared.join(", ");
    format!("joints over the torque by BIC: {compared}; {advice}\n")
}

fn leaves(adequate: bool) -> &'static str {
    if adequate {
        "leaves noise"
    } else {
        "leaves more than noise"
    }
}

fn bootstrap(result: &BootstrapResult, joint: &JointEstimate, bolts: &[String]) -> String {
    let at = place(joint);
    let unknowns = &joint.covariance.unknowns;
    let mut text = format!(
        "\nbootstrap{at}: {} draws of {}, seed {}, {} converged\n",
        result.draws,
        match result.drawn {
            Drawn::Noise => "noise",
            Drawn::NoiseAndSetUp => "noise and of errors of the set-up",
        },
        result.seed,
        result.converged
    );
    if result.converged > 1 {
        let mut table = Table::new(&["", "± std. dev.", "95 % interval", "unit"]);
        for (index, unknown) in unknowns.iter().enumerate() {
            let [low, high] = result.intervals[index];
            table.row(vec![
                unknown.label(bolts),
                number(result.standard_deviation[index], 2),
                format!("{} … {}", number(low, 5), number(high, 5)),
                unknown.unit.to_owned(),
            ]);
        }
        text += &table.render();
    }
    text
}

/// What the result rests on, in one line.
pub(in super::super) fn basis(found: &Identification) -> String {
    let frequency_hz = &found.lines.frequency_hz;
    let counted = |count: usize, thing: &str| {
        let ending = if count == 1 { "" } else { "s" };
        format!("{count} {thing}{ending}")
    };
    let equations = found.estimate.equations_on_both_sides();
    let by = equations.map(|equations| format!(", decoupled by {equations}"));
    format!(
        "joint model \"{}\"{} from {} at {}, {} from {} to {} Hz{}",
        found.model,
        at_bolts(&found.bolts),
        counted(
            found.fits.len()
                + found
                    .further
                    .iter()
                    .map(|assembly| assembly.fits.len())
                    .sum::<usize>(),
            "function"
        ),
        counted(found.lines.points.len(), "point"),
        counted(frequency_hz.len(), "line"),
        number(frequency_hz[0], 4),
        number(frequency_hz[frequency_hz.len() - 1], 4),
        by.unwrap_or_default(),
    )
}

/// How well the result fits, in one line.
pub(in super::super) fn fit(found: &Identification) -> String {
    let chi_squared = found
        .reduced_chi_squared
        .map(|value| format!("; χ² per degree of freedom {value:.3}"))
        .unwrap_or_default();
    let typical = found
        .median_difference
        .map(|off| format!(", half of the values within {:.2} %", 100.0 * off))
        .unwrap_or_default();
    let files = found.joint_files();
    let is_passive = files.iter().all(|(_, file)| file.passivity().is_passive());
    let verdict = match (files.len(), is_passive) {
        (1, true) => "the joint is passive",
        (1, false) => "the joint is ACTIVE",
        (_, true) => "all joints are passive",
        (_, false) => "not all joints are passive: ACTIVE",
    };
    let (tried, agreeing) = found.starts;
    let lines = match found.estimate.lines_used {
        (used, measured) if used < measured => format!(
            "\nthe estimate rests on {used} of {measured} lines: at the others the noise of the structures' functions moves what is \
             computed too far"
        ),
        _ => String::new(),
    };
    format!(
        "residual {:.2} % r.m.s. of the receptance{typical}{chi_squared}; {agreeing} of {tried} starts agree; {verdict}{lines}",
        100.0 * found.relative_rms
    )
}
