//! `predict` with the methods of an interface: `fractal-contact` and `virtual-material`.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};

use super::super::draws::{among, write_part};
use super::super::error::CliError;
use super::super::output::{CSV, Ending, HTML, Outputs, check_outputs, print, warn};
use super::super::progress::Progress;
use super::super::table::{Table, number};
use super::{PredictArguments, refuse};
use bolted_joint::draws::{Merged, Origin};
use bolted_joint::export::Timestamp;
use bolted_joint::predict::patch::Principal;
use bolted_joint::predict::patch::{matrix27, table};
use bolted_joint::predict::study::{CONTACT_ALONE, InterfaceStudy, Prediction, Slip, State};
use bolted_joint::predict::virtual_material::Card;
use bolted_joint::report::PredictionReport;
use bolted_joint::study::{Method, StudyError, StudyText};

const MAC: Ending = Ending::In(&["mac"], "a name that ends in .mac");
const CARD: Ending = Ending::In(
    &["csv", "inp", "mac"],
    "a name that ends in .csv, in .inp for Abaqus or in .mac for ANSYS",
);

/// Name and number of the layer's material.
const MATERIAL_NAME: &str = "bolted_joint";
const MATERIAL_NUMBER: u32 = 1;
/// Inputs that account for less of a result's scatter are not named.
const WORTH_NAMING: f64 = 0.05;

pub(super) fn run(
    arguments: &PredictArguments,
    study: &StudyText,
    method: Method,
    parts: Option<Merged>,
) -> Result<(), CliError> {
    refuse(
        &[
            ("--damping-csv", arguments.damping_csv.as_ref()),
            ("--figure", arguments.figure.as_ref()),
        ],
        "none: damping over the amplitude is of method \"layered-beam\"",
    )?;
    check_outputs(
        &arguments.study,
        &[
            ("--output", Some(&arguments.output), Ending::OfJointFile),
            ("--report", arguments.report.as_ref(), HTML),
            ("--matrix-csv", arguments.matrix_csv.as_ref(), CSV),
            ("--matrix27", arguments.matrix27.as_ref(), MAC),
            ("--field-csv", arguments.field_csv.as_ref(), CSV),
            ("--material-card", arguments.material_card.as_ref(), CARD),
        ],
    )?;
    if method == Method::FractalContact {
        refuse(
            &[("--material-card", arguments.material_card.as_ref())],
            "none: only method \"virtual-material\" has a material",
        )?;
    }
    let written = arguments.report.as_ref();
    let written = written.map(|_| Timestamp::from_environment()).transpose()?;
    let study = InterfaceStudy::of(study)?;
    let draws = study.monte_carlo.map_or(0, |monte_carlo| monte_carlo.draws);
    let draws = arguments
        .draws
        .as_ref()
        .map_or(draws, |own| own.end - own.start);
    let progress = Progress::new("predicting", draws as usize);
    let advance = || progress.advance();
    let origin_of = |found: &Prediction<'_>| {
        let all = study.monte_carlo.ok_or_else(|| {
            let expected = "a study with an uncertain value: without one there is nothing to draw";
            CliError::option("draws", arguments.study.display(), expected)
        })?;
        let files = [&found.joint_file()];
        Ok::<_, CliError>(Origin::of(&study.name, files, all.draws, all.seed)?)
    };
    if let Some(numbers) = &arguments.draws {
        let found = Prediction::without_draws(&study)?;
        let origin = origin_of(&found)?;
        let expected = "numbers below that of all draws, which the study's [uncertainty] states";
        among(numbers, origin.draws, expected)?;
        let made = found.part(numbers.clone(), &advance);
        drop(progress);
        let (output, results) = (&arguments.output, found.results());
        return write_part(output, origin, results, numbers.start, made, arguments.json);
    }
    let found = match parts {
        None => Prediction::of(&study, &advance)?,
        Some(parts) => {
            let nominal = Prediction::without_draws(&study)?;
            parts.check(&origin_of(&nominal)?, &nominal.results())?;
            Prediction::of_parts(&study, &parts.draws)?
        }
    };
    drop(progress);
    let joint_file = found.joint_file();
    let text = joint_file.to_json()?;
    let warnings = found.warnings();
    let interface = &found.nominal().interface;
    let frequency_hz = study.frequency_hz;
    // Study::read has refused every frequency that these refuse.
    let [matrix_csv, macro_text] = [
        table(&study.name, interface, frequency_hz),
        matrix27(&study.name, interface, frequency_hz),
    ]
    .map(|text| text.unwrap_or_default());
    let mut files = Outputs::new();
    files.add(Some(&arguments.output), || text);
    files.add(arguments.matrix_csv.as_ref(), || matrix_csv);
    files.add(arguments.matrix27.as_ref(), || macro_text);
    files.add(arguments.field_csv.as_ref(), || found.field_csv());
    if let Some(path) = &arguments.material_card {
        let card = material_card(path, &found)?;
        files.add(Some(path), || card);
    }
    if let Some(written) = written {
        files.add(arguments.report.as_ref(), || {
            let report = PredictionReport {
                found: &found,
                warnings: &warnings,
                written,
            };
            report.to_html()
        });
    }
    files.write()?;
    warn(&warnings);
    if arguments.json {
        let value = as_json(arguments, &found, &warnings);
        return print(&serde_json::to_string_pretty(&value)?);
    }
    print(&(summary(&found) + "\n" + &files.written()))
}

/// The layer's card, in the form that the name asks for.
fn material_card(path: &Path, found: &Prediction<'_>) -> Result<String, StudyError> {
    let card = match path.extension().and_then(|ending| ending.to_str()) {
        Some("inp") => Card::Abaqus,
        Some("mac") => Card::Ansys(MATERIAL_NUMBER),
        _ => Card::Csv,
    };
    let material = found.material()?;
    // the name is one that every program takes
    Ok(card.text(&material, MATERIAL_NAME).unwrap_or_default())
}

/// The result for people.
fn summary(found: &Prediction<'_>) -> String {
    let study = found.study;
    let [dimension, roughness_m] = found.roughness;
    let [x, y, z] = study.reference_m;
    let mut text = format!(
        "{}\n{}, D = {}, G = {} m, {}\n",
        study.name,
        study.method.name(),
        number(dimension, 5),
        number(roughness_m, 4),
        study.pressure,
    );
    let _ = writeln!(
        text,
        "{}, at x = {x} m, y = {y} m, z = {z} m; damping at {} Hz",
        study.motions.described(),
        study.frequency_hz
    );
    for state in &found.states {
        text.push('\n');
        if let Some(torque) = state.torque_n_m {
            let _ = writeln!(text, "at {torque} N·m");
        }
        text += &at_state(found, state);
    }
    let _ = writeln!(text, "\n{CONTACT_ALONE}");
    if let Some(outcome) = &found.outcome {
        let _ = writeln!(
            text,
            "\n{} draws, seed {}, {} refused",
            outcome.of.draws,
            outcome.of.seed,
            outcome.of.draws - outcome.accepted
        );
        text += &shares(found);
    }
    text
}

fn at_state(found: &Prediction<'_>, state: &State) -> String {
    let mut text = String::new();
    if let Some(balance) = &state.balance {
        let _ = writeln!(text, "  {balance}");
    }
    let _ = writeln!(
        text,
        "  pressures up to {} MPa, {:.0} % of the area under pressure; loss factors {} normal, {} tangential",
        number(1e-6 * state.largest_pressure_pa(), 4),
        100.0 * state.area_under_pressure(),
        number(state.interface.normal_loss_factor(), 3),
        number(state.interface.tangential_loss_factor(), 3),
    );
    if let Some(layer) = &state.layer {
        let _ = write!(
            text,
            "  layer {} m thick: E = {} Pa, G = {} Pa",
            layer.thickness_m,
            number(layer.moduli.youngs_modulus_pa, 4),
            number(layer.moduli.shear_modulus_pa, 4),
        );
        text += &match &layer.material {
            Ok(material) => format!(
                ", ν = {}, ρ = {} kg/m³\n",
                number(material.poissons_ratio, 4),
                number(material.density_kg_per_m3, 4)
            ),
            Err(_) => "\n".to_owned(),
        };
    }
    if let Some(own) = state.interface.own_stiffness() {
        let [x, y, z] = own.centre_m.map(|length| number(1e3 * length + 0.0, 3));
        let _ = writeln!(
            text,
            "  centre of elasticity at x = {x} mm, y = {y} mm, z = {z} mm"
        );
    }
    let mut header = vec!["", "predicted"];
    if found.outcome.is_some() {
        header.extend(["± std. dev.", "95 % interval"]);
    }
    header.push("unit");
    let mut table = Table::new(&header);
    for unknown in found.unknowns(state) {
        let mut row = vec![unknown.name.clone(), number(unknown.value, 5)];
        if let Some(estimate) = found.estimate(&unknown.name, state.torque_n_m) {
            let [low, high] = estimate.interval_95;
            row.push(number(estimate.standard_deviation, 2));
            row.push(format!("{} … {}", number(low, 4), number(high, 4)));
        } else if found.outcome.is_some() {
            row.extend([String::new(), String::new()]);
        }
        row.push(unknown.unit);
        table.row(row);
    }
    text += &table.render();
    for slip in &state.slips {
        let fitted = &slip.fitted;
        let _ = writeln!(
            text,
            "  {} slips: the law's heat is within {} % of that of {} patches from {} to {} {} ({} % r.m.s.), its load within {} %",
            slip.dof.name,
            number(100.0 * fitted.worst_heat_error, 2),
            slip.patches.count(),
            number(fitted.amplitudes.from, 2),
            number(fitted.amplitudes.to, 2),
            slip.dof.kind.displacement_unit(),
            number(100.0 * fitted.heat_error, 2),
            number(100.0 * fitted.worst_load_error, 2),
        );
    }
    text
}

/// Which inputs the scatter comes from.
fn shares(found: &Prediction<'_>) -> String {
    let mut text = String::new();
    let state = found.nominal();
    for unknown in found.unknowns(state) {
        let named = found.main_inputs(&unknown.name, state.torque_n_m, WORTH_NAMING);
        if !named.is_empty() {
            let named: Vec<String> = named
                .into_iter()
                .map(|(input, share)| format!("{input} {:.0} %", 100.0 * share))
                .collect();
            let named = named.join(", ");
            let _ = writeln!(text, "  {} scatters with {named}", unknown.name);
        }
    }
    text
}

fn principal(own: Principal) -> Value {
    json!({ "stiffness": own.stiffness, "axis": own.axis })
}

/// The friction of a DOF.
fn slip(slip: &Slip) -> Value {
    let (law, amplitudes) = (&slip.fitted.law, &slip.fitted.amplitudes);
    json!({
        "dof": slip.dof.name,
        "slip_force": law.slip_force,
        "stiffness": law.stiffness,
        "exponent": law.exponent,
        "ratio": law.ratio,
        "patches": slip.patches.count(),
        "amplitudes": [amplitudes.from, amplitudes.to],
        "heat_error": slip.fitted.heat_error,
        "worst_heat_error": slip.fitted.worst_heat_error,
        "worst_load_error": slip.fitted.worst_load_error,
    })
}

fn as_json(arguments: &PredictArguments, found: &Prediction<'_>, warnings: &[String]) -> Value {
    let path = |path: &Option<std::path::PathBuf>| path.as_ref().map(|p| p.display().to_string());
    let states: Vec<Value> = found
        .states
        .iter()
        .map(|state| {
            json!({
                "torque_n_m": state.torque_n_m,
                "preloads_n": state.bolts.iter().map(|bolt| bolt.preload_n).collect::<Vec<_>>(),
                "field_force_n": state.field.force_n(),
                "force_imbalance": state.balance.as_ref().map(|balance| balance.force_imbalance()),
                "largest_pressure_pa": state.largest_pressure_pa(),
                "largest_real_area_fraction": state.largest_real_area(),
                "layer": state.layer.as_ref().map(|layer| json!({
                    "youngs_modulus_pa": layer.moduli.youngs_modulus_pa,
                    "shear_modulus_pa": layer.moduli.shear_modulus_pa,
                    "thickness_m": layer.thickness_m,
                    "poissons_ratio": layer.material.as_ref().ok().map(|m| m.poissons_ratio),
                    "density_kg_per_m3": layer.material.as_ref().ok().map(|m| m.density_kg_per_m3),
                })),
                "normal_loss_factor": state.interface.normal_loss_factor(),
                "tangential_loss_factor": state.interface.tangential_loss_factor(),
                "reference_m": state.interface.reference_m,
                "stiffness": state.interface.stiffness,
                "hysteretic_damping": state.interface.hysteretic,
                "viscous_damping": state.interface.viscous,
                "own_stiffness": state.interface.own_stiffness().map(|own| json!({
                    "centre_m": own.centre_m,
                    "coupling": own.coupling,
                    "translational": own.translational.map(principal),
                    "rotational": own.rotational.map(principal),
                })),
                "slip": state.slips.iter().map(slip).collect::<Vec<_>>(),
            })
        })
        .collect();
    let outcome = found.outcome.as_ref().map(|outcome| {
        let estimates: serde_json::Map<String, Value> = outcome
            .estimates
            .iter()
            .map(|estimate| {
                let value = json!({
                    "mean": estimate.mean,
                    "standard_deviation": estimate.standard_deviation,
                    "interval_95": estimate.interval_95,
                    "shares": estimate.shares,
                });
                (estimate.name.clone(), value)
            })
            .collect();
        json!({
            "draws": outcome.of.draws,
            "seed": outcome.of.seed,
            "accepted": outcome.accepted,
            "refused": outcome.refused,
            "inputs": outcome.inputs,
            "estimates": estimates,
        })
    });
    json!({
        "output": arguments.output.display().to_string(),
        "report": path(&arguments.report),
        "matrix_csv": path(&arguments.matrix_csv),
        "matrix27": path(&arguments.matrix27),
        "field_csv": path(&arguments.field_csv),
        "material_card": path(&arguments.material_card),
        "joint_file": found.joint_file(),
        "fractal_dimension": found.roughness[0],
        "roughness_m": found.roughness[1],
        "states": states,
        "uncertainty": outcome,
        "warnings": warnings,
    })
}
