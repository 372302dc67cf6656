//! What a joint has of its own: where its centre is, along which axes it is stiff, and how stiff.

use bolted_joint_figures::html::{beside, cell, number_cell, percent, shown, spread, table};
use bolted_joint_space::{CentreOfElasticity, PrincipalAxes, PrincipalStiffness, Uncertainty};
use bolted_joint_spatial::SpatialIdentification;

use super::scaled;

/// Coupling at the centre below this share counts for nothing.
const DECOUPLED: f64 = 0.02;

/// A value below this part of its deviation is zero: nobody reads its digits.
const NOTHING: f64 = 1e-6;

pub(super) fn section(found: &SpatialIdentification) -> String {
    let [of_stiffness, of_damping] = &found.covariances;
    [
        (
            "Own axes of the stiffness",
            "elasticity",
            &found.stiffness,
            of_stiffness,
            ["N/m", "N·m/rad"],
        ),
        (
            "Own axes of the damping",
            "damping",
            &found.damping,
            of_damping,
            ["N·s/m", "N·m·s/rad"],
        ),
    ]
    .into_iter()
    .map(|(heading, what, matrix, covariance, units)| {
        let uncertainty = Uncertainty::Covariance(covariance.clone());
        let centre = CentreOfElasticity::of(matrix, &uncertainty).ok();
        let axes = PrincipalAxes::of(matrix, &uncertainty).ok();
        let centre = centre.map_or_else(String::new, |centre| of_centre(&centre, what));
        let axes = axes.map_or_else(
            || "<p>Rotations load what bears nothing, so there are no axes.</p>\n".to_owned(),
            |axes| of_axes(&axes, units),
        );
        format!("<h2>{heading}</h2>\n{centre}{axes}")
    })
    .collect()
}

fn of_centre(centre: &CentreOfElasticity, what: &str) -> String {
    let component = |axis: usize| {
        let millimetres = 1e3 * centre.offset_m[axis];
        match centre.deviation_m.map(|deviation| 1e3 * deviation[axis]) {
            Some(deviation) if deviation > 0.0 => {
                format!("{} ± {}", beside(millimetres, deviation), spread(deviation))
            }
            _ => shown(millimetres, 4),
        }
    };
    let [x, y, z] = [0, 1, 2].map(component);
    let place = match centre.is_unique() {
        true => format!(
            "The centre of {what} lies at <i>x</i> = {x} mm, <i>y</i> = {y} mm, <i>z</i> = {z} mm from the virtual point"
        ),
        false => format!(
            "The data leave the centre of {what} open along {} of three directions; one of the places is <i>x</i> = {x} mm, \
             <i>y</i> = {y} mm, <i>z</i> = {z} mm from the virtual point",
            centre.free_directions.len()
        ),
    };
    let coupling = match centre.relative_coupling < DECOUPLED {
        true => "There translations and rotations are not coupled: the axes below pass through it."
            .to_owned(),
        false => format!(
            "Even there translations and rotations stay coupled, by {} of what both would allow: the directions below hold, but no \
             point lies on all axes.",
            percent(centre.relative_coupling)
        ),
    };
    format!("<p>{place}. {coupling}</p>\n")
}

fn of_axes(axes: &PrincipalAxes, units: [&str; 2]) -> String {
    let row = |motion: &str, (power, unit): &(i32, String), principal: &PrincipalStiffness| {
        let scale = 10_f64.powi(-power);
        let deviation = scale * principal.deviation.unwrap_or(0.0);
        let stiffness = match scale * principal.stiffness {
            nothing if nothing.abs() < NOTHING * deviation => 0.0,
            stiffness => stiffness,
        };
        let value = match deviation > 0.0 {
            true => beside(stiffness, deviation),
            false => shown(stiffness, 6),
        };
        let [x, y, z, aside] = match principal.axis {
            None => [
                "<td class=\"open\" colspan=\"4\">any: another one agrees with it within its deviation</td>".to_owned(),
                String::new(),
                String::new(),
                String::new(),
            ],
            Some(axis) => {
                let part = |part: f64| number_cell(&format!("{part:.3}").replace('-', "−"));
                let nearest = axis.iamax();
                let degrees = axis[nearest].abs().min(1.0).acos().to_degrees();
                [
                    part(axis.x),
                    part(axis.y),
                    part(axis.z),
                    cell(&format!("{degrees:.1}° from {}", ["x", "y", "z"][nearest])),
                ]
            }
        };
        [
            cell(motion),
            number_cell(&value),
            number_cell(&spread(deviation)),
            cell(unit),
            x,
            y,
            z,
            aside,
        ]
        .concat()
    };
    // of values that the data leave open the deviations say how large they may be
    let largest = |all: &[PrincipalStiffness; 3]| {
        all.iter()
            .map(|one| one.stiffness.abs().max(one.deviation.unwrap_or(0.0)))
            .fold(0.0, f64::max)
    };
    let [straight, turned] = [&axes.translational, &axes.rotational].map(largest);
    let [along, about] =
        [(straight, units[0]), (turned, units[1])].map(|(size, unit)| scaled(size, unit));
    let rows: Vec<String> = axes
        .translational
        .iter()
        .map(|one| row("along", &along, one))
        .chain(axes.rotational.iter().map(|one| row("about", &about, one)))
        .collect();
    format!(
        "<p>Principal values: of translations with rotations held, of rotations with translations free. They are the same at every \
         point.</p>\n{}",
        table(
            &[
                "Motion",
                "Value",
                "Std. dev.",
                "Unit",
                "x",
                "y",
                "z",
                "Axis"
            ],
            &rows
        )
    )
}
