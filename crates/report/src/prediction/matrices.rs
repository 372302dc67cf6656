//! Pressure and preloads, and the interface as a whole: its 6×6 matrices and loss factors.

use super::super::PressureFigure;
use bolted_joint_figures::html::still;
use bolted_joint_figures::html::{cell, columns, escaped, number, number_cell, shown, table};
use bolted_joint_predict::patch::{DOFS, InterfaceJoint, Matrix6, Principal};
use bolted_joint_predict::study::Prediction;

/// Digits of an entry of a matrix.
const DIGITS: usize = 4;

pub(super) fn pressure(found: &Prediction<'_>) -> String {
    let rows: Vec<String> = found
        .states
        .iter()
        .map(|state| {
            let balance = state.balance.as_ref();
            let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
            let kilo = |newton: f64| number(1e-3 * newton);
            [
                number_cell(&or_dash(state.torque_n_m.map(number))),
                number_cell(&or_dash(balance.map(|balance| kilo(balance.preload_n)))),
                number_cell(&kilo(state.field.force_n())),
                number_cell(&or_dash(balance.map(|balance| {
                    format!("{:+.2} %", 100.0 * balance.force_imbalance() + 0.0).replace('-', "−")
                }))),
                number_cell(&shown(1e-6 * state.largest_pressure_pa(), DIGITS)),
                number_cell(&format!("{:.0} %", 100.0 * state.area_under_pressure())),
                number_cell(&format!(
                    "{} %",
                    shown(100.0 * state.largest_real_area(), 3)
                )),
                number_cell(&shown(state.interface.normal_loss_factor(), 3)),
                number_cell(&shown(state.interface.tangential_loss_factor(), 3)),
            ]
            .concat()
        })
        .collect();
    let bolts: Vec<String> = (1..)
        .zip(&found.nominal().bolts)
        .map(|(number_of_bolt, bolt): (usize, _)| {
            [
                number_cell(&number_of_bolt.to_string()),
                number_cell(&number(1e3 * bolt.x_m)),
                number_cell(&number(1e3 * bolt.y_m)),
                number_cell(&number(1e3 * bolt.diameter_m)),
                number_cell(&number(1e-3 * bolt.preload_n)),
            ]
            .concat()
        })
        .collect();
    let bolts = match bolts.is_empty() {
        true => String::new(),
        false => table(
            &["Bolt", "x, mm", "y, mm", "Diameter, mm", "Preload, kN"],
            &bolts,
        ),
    };
    format!(
        "<h2>Pressure</h2>\n<p>{}.</p>\n{}{}{bolts}{}",
        escaped(&bolted_joint_figures::html::capitalised(
            &found.study.pressure
        )),
        drawing(found),
        table(
            &columns(
                "Torque, N·m|Preloads, kN|Field, kN|Imbalance|Largest pressure, MPa|Area under pressure|Real area, at most|η normal|η tangential"
            ),
            &rows
        ),
        layer(found)
    )
}

/// The field under the nominal preloads.
fn drawing(found: &Prediction<'_>) -> String {
    let state = found.nominal();
    let plate = found.study.plate();
    let at = state
        .torque_n_m
        .map(|torque| format!(" at {} N·m", number(torque)))
        .unwrap_or_default();
    let drawn = PressureFigure {
        title: "Pressure on the interface",
        field: &state.field,
        cell_m: plate.map(|plate| plate.cell_m),
        outline: plate.map(|plate| plate.outline),
        bolts: &state.bolts,
        clearance_m: plate.map_or(0.0, |plate| plate.clearance_m),
    };
    drawn.to_svg().map_or_else(String::new, |svg| {
        still(
            "pressure",
            &format!("<b>Pressure on the interface</b>{at}, with the bolts and their preloads."),
            &svg,
        )
    })
}

/// The virtual layer at each torque.
fn layer(found: &Prediction<'_>) -> String {
    let rows: Vec<String> = found
        .states
        .iter()
        .filter_map(|state| {
            let layer = state.layer.as_ref()?;
            let material = layer.material.as_ref().ok();
            let or_dash = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), number);
            let torque = state.torque_n_m.map_or_else(|| "–".to_owned(), number);
            Some(
                [
                    number_cell(&torque),
                    number_cell(&number(layer.moduli.youngs_modulus_pa)),
                    number_cell(&number(layer.moduli.shear_modulus_pa)),
                    number_cell(&or_dash(material.map(|material| material.poissons_ratio))),
                    number_cell(&or_dash(
                        material.map(|material| material.density_kg_per_m3),
                    )),
                    number_cell(&number(layer.thickness_m)),
                ]
                .concat(),
            )
        })
        .collect();
    match rows.is_empty() {
        true => String::new(),
        false => format!(
            "<h3>Virtual layer</h3>\n{}",
            table(
                &columns("Torque, N·m|E, Pa|G, Pa|ν|ρ, kg/m³|Thickness, m"),
                &rows
            )
        ),
    }
}

pub(super) fn section(found: &Prediction<'_>) -> String {
    let interface = &found.nominal().interface;
    let at = found
        .nominal()
        .torque_n_m
        .map(|torque| format!(" at {} N·m", number(torque)))
        .unwrap_or_default();
    format!(
        "<h2>The whole interface</h2>\n<p>Stiffness <i>K</i>, hysteretic damping <i>D</i> and viscous damping <i>C</i> for the relative motion of two \
         nodes at the reference point{at}, in N, m, rad and s. <i>D</i> and <i>C</i> are kept apart: at one frequency <i>C</i> + <i>D</i>/ω is all \
         of it.</p>\n<h3>Stiffness</h3>\n{}<h3>Hysteretic damping</h3>\n{}<h3>Viscous damping</h3>\n{}",
        matrix(&interface.stiffness),
        matrix(&interface.hysteretic),
        matrix(&interface.viscous),
    ) + &own(interface)
}

/// Centre of elasticity and principal stiffnesses.
fn own(interface: &InterfaceJoint) -> String {
    let Some(own) = interface.own_stiffness() else {
        return String::new();
    };
    let row = |motion: &str, unit: &str, principal: &Principal| {
        let axis = principal.axis.map_or_else(
            || "any, another one is as large".to_owned(),
            |axis| {
                axis.map(|part| format!("{part:.3}").replace('-', "−"))
                    .join(", ")
            },
        );
        [
            cell(motion),
            number_cell(&shown(principal.stiffness, DIGITS)),
            cell(unit),
            cell(&axis),
        ]
        .concat()
    };
    let translations = own
        .translational
        .iter()
        .map(|of| row("translation", "N/m", of));
    let rotations = own
        .rotational
        .iter()
        .map(|of| row("rotation", "N·m/rad", of));
    let rows: Vec<String> = translations.chain(rotations).collect();
    let [x, y, z] = own.centre_m.map(|length| number(1e3 * length));
    format!(
        "<h3>Its own axes</h3>\n<p>The centre of elasticity lies at <i>x</i> = {x} mm, <i>y</i> = {y} mm, <i>z</i> = {z} mm: a force through it \
         turns nothing, but for the part {} of the stiffnesses that stays coupled. Principal stiffnesses there:</p>\n{}",
        shown(own.coupling, 2),
        table(&["Motion", "Stiffness", "Unit", "Axis: x, y, z"], &rows)
    )
}

fn matrix(matrix: &Matrix6) -> String {
    if matrix.iter().flatten().all(|value| *value == 0.0) {
        return "<p>None.</p>\n".to_owned();
    }
    let rows: Vec<String> = (0..6)
        .map(|i| {
            let cells = matrix[i].map(|value| match value {
                0.0 => number_cell("0"),
                value => number_cell(&shown(value, DIGITS)),
            });
            format!("{}{}", cell(DOFS[i]), cells.concat())
        })
        .collect();
    let headings: Vec<&str> = std::iter::once("").chain(DOFS).collect();
    table(&headings, &rows)
}
