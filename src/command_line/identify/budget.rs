//! What errors of the set-up do to an estimate, for people and as JSON.

use std::fmt::Write as _;

use bolted_joint::identify::{Identification, Systematic, Unknown};
use serde_json::{Value, json};

use super::super::table::{Table, number};

/// Causes that are named at most where the data speak against the set-up.
const NAMED: usize = 3;
/// Shares of a variance below this are left out.
const WORTH_NAMING: f64 = 0.02;

/// Deviations without and with the budget, what contributes to them, and what speaks against the data.
pub(super) fn budget(found: &Identification) -> String {
    let Some(systematic) = &found.systematic else {
        return String::new();
    };
    let bolts = found.bolts.with_own_joint();
    let (groups, others): (Vec<_>, Vec<_>) = (systematic.shares.groups.iter())
        .partition(|(_, parts)| parts.iter().any(|part| *part > WORTH_NAMING));
    let mut header = vec!["", "± noise alone", "± with the budget"];
    header.extend(groups.iter().map(|(group, _)| group.name()));
    header.push("unit");
    let mut table = Table::new(&header);
    let percent = |part: f64| format!("{:.0} %", 100.0 * part);
    for (index, (at, unknown)) in unknowns(found).enumerate() {
        let deviation = |matrix: &nalgebra::DMatrix<f64>| number(matrix[(index, index)].sqrt(), 2);
        let mut cells = vec![
            unknown.label(bolts) + &at,
            deviation(&systematic.noise_covariance),
            deviation(&systematic.covariance),
        ];
        cells.extend(groups.iter().map(|(_, parts)| percent(parts[index])));
        cells.push(unknown.unit.to_owned());
        table.row(cells);
    }
    let (used, all) = systematic.lines;
    let mut text = format!(
        "\nerror budget: {} causes take part; {used} of {all} lines used; percentages are what a variance would fall by if a group were exact\n{}",
        systematic.causes.len(),
        table.render()
    );
    if let [_, ..] = others[..] {
        let names: Vec<&str> = others.iter().map(|(group, _)| group.name()).collect();
        let _ = writeln!(
            text,
            "less than {} of every variance: {}",
            percent(WORTH_NAMING),
            names.join(", ")
        );
    }
    if let Some((group, part)) = systematic.largest_groups().first() {
        let _ = writeln!(
            text,
            "what matters most: {} ({} of a variance); {}",
            group.name(),
            percent(*part),
            group.remedy()
        );
    }
    text + &suspects(systematic)
}

/// The unknowns of every torque's joint, each with what tells it from those of the others.
fn unknowns(found: &Identification) -> impl Iterator<Item = (String, &Unknown)> {
    let joints = found.estimate.joints.iter();
    joints.flat_map(|joint| {
        let at = joint.torque_n_m.map(|torque| format!("@{torque}"));
        let own = joint.covariance.unknowns.iter();
        own.map(move |unknown| (at.clone().unwrap_or_default(), unknown))
    })
}

/// What speaks against the data if the set-up is taken as exact.
fn suspects(systematic: &Systematic) -> String {
    let mut text = String::new();
    for (consistency, p) in &systematic.consistency {
        let _ = writeln!(
            text,
            "chance that {} bands differ as much if they have the same joint: p = {}",
            consistency.bands.len(),
            number(*p, 2)
        );
    }
    if systematic.suspects.is_empty() {
        text += "no single cause stands out from the noise\n";
        return text;
    }
    let mut table = Table::new(&[
        "with an exact set-up, what stands out",
        "size",
        "± std. dev.",
        "unit",
        "χ² drops by",
    ]);
    for (name, suspect) in systematic.suspects.iter().take(NAMED) {
        let (value, unit) = suspect.cause.shown(suspect.value);
        let (deviation, _) = suspect.cause.shown(suspect.standard_deviation);
        table.row(vec![
            name.clone(),
            number(value, 3),
            number(deviation, 2),
            unit.to_owned(),
            format!("{:.0}", suspect.drop),
        ]);
    }
    text += &table.render();
    text
}

/// The same as JSON.
pub(super) fn json(found: &Identification) -> Value {
    let Some(systematic) = &found.systematic else {
        return Value::Null;
    };
    let deviations = |matrix: &nalgebra::DMatrix<f64>| -> Vec<f64> {
        matrix.diagonal().iter().map(|v| v.sqrt()).collect()
    };
    let bolts = found.bolts.with_own_joint();
    let names = unknowns(found).map(|(at, unknown)| unknown.label(bolts) + &at);
    json!({
        "unknowns": names.collect::<Vec<_>>(),
        "standard_deviation": deviations(&systematic.covariance),
        "standard_deviation_of_noise": deviations(&systematic.noise_covariance),
        "shares": {
            "groups": systematic.shares.groups.iter().map(|(group, parts)| json!({
                "group": group.name(),
                "parts": parts,
            })).collect::<Vec<_>>(),
        },
        "causes": systematic.causes.iter().map(|(name, cause)| json!({
            "cause": name,
            "value": cause.value,
            "standard_deviation": cause.standard_deviation,
            "prior": cause.prior.standard_deviation,
            "contradicted": cause.contradicted,
        })).collect::<Vec<_>>(),
        "suspects": systematic.suspects.iter().map(|(name, suspect)| json!({
            "cause": name,
            "value": suspect.value,
            "standard_deviation": suspect.standard_deviation,
            "chi_squared_drop": suspect.drop,
        })).collect::<Vec<_>>(),
        "scores": systematic.scores.iter().map(|(name, score)| json!({
            "cause": name,
            "value": score.value,
            "standard_deviation": score.standard_deviation,
            "chi_squared_drop": score.drop,
        })).collect::<Vec<_>>(),
        "consistency": systematic.consistency.iter().map(|(found, p)| json!({
            "bands": found.bands.len(),
            "q": found.q,
            "degrees_of_freedom": found.freedom,
            "p": p,
        })).collect::<Vec<_>>(),
        "reduced_chi_squared": systematic.reduced_chi_squared,
        "lines": { "used": systematic.lines.0, "all": systematic.lines.1 },
        "converged": systematic.converged,
    })
}
