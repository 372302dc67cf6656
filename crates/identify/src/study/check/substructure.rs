//! `[a]` and `[b]`: one source of receptances, and where the joint is on it.

use super::super::super::layout::Bolts;
use super::super::super::model::JointModel;
use super::super::tables::{BeamTable, JointPlaceTable, SubstructureTable, TheoryName};
use super::super::{MeasuredJoint, Rotation, Source, Substructure};
use super::assembly::frf_file;
use super::bolts::{apart, apart_on_beam, places_of_bolts};
use super::names_given;
use super::rotation::rotation;
use bolted_joint_frf::structure::{Beam, Damping, Difference, Section, Theory};
use bolted_joint_study::{StudyError, StudyText};

pub(crate) fn substructure(
    study: &StudyText,
    key: &str,
    table: SubstructureTable,
    model: JointModel,
    bolts: &Bolts,
) -> Result<Substructure, StudyError> {
    for (name, found, there) in [
        ("quantity", "a quantity", table.quantity.is_some()),
        ("units", "units", table.units.is_some()),
        ("averages", "averages", table.averages.is_some()),
    ] {
        let good = !there || table.frf.is_some();
        study.ensure(
            good,
            format_args!("{key}.{name}"),
            found,
            "it beside `frf` only",
        )?;
    }
    let source = match (table.frf, table.modal, table.beam) {
        (Some(path), modes, None) => Source::Frf {
            file: frf_file(
                study,
                key,
                &path,
                table.quantity,
                table.units.as_ref(),
                table.averages,
            )?,
            modes: modes.map(|modes| study.resolved(&modes)),
        },
        (None, Some(path), None) => Source::Modal(study.resolved(&path)),
        (None, None, Some(beam)) => {
            let expected = "it beside measured data only: a beam has one";
            let found = "a section";
            study.ensure(
                table.section.is_none(),
                format_args!("{key}.section"),
                found,
                expected,
            )?;
            let beam = computed(study, key, beam)?;
            let mut joints_m = Vec::new();
            for (key, place) in places_of_bolts(study, key, table.joint, bolts)? {
                let x_m = position(study, &key, &place)?;
                on_the_beam(study, &format!("{key}.x"), x_m, beam.length_m)?;
                joints_m.push(x_m);
            }
            apart_on_beam(study, key, &joints_m, bolts)?;
            for (point, &x_m) in &table.points {
                let key = format!("{key}.points.\"{point}\"");
                on_the_beam(study, &key, x_m, beam.length_m)?;
            }
            return Ok(Substructure::Beam {
                beam,
                joints_m,
                positions_m: table.points,
            });
        }
        (frf, modal, beam) => {
            let given = [
                ("frf", frf.is_some()),
                ("modal", modal.is_some()),
                ("beam", beam.is_some()),
            ];
            return study.refuse(
                key,
                names_given("no source", &given),
                "one of `frf`, `modal` and `beam`, or `frf` with `modal` for what was not measured",
            );
        }
    };
    study.ensure(
        table.points.is_empty() || !key.ends_with('a'),
        format_args!("{key}.points"),
        "positions",
        "those of the assembly's points, which are on B",
    )?;
    for (point, &x_m) in &table.points {
        let key = format!("{key}.points.\"{point}\"");
        study.ensure(
            x_m.is_finite(),
            key,
            x_m,
            "a position along the structure in m",
        )?;
    }
    let mut joints = Vec::new();
    for (key, place) in places_of_bolts(study, key, table.joint, bolts)? {
        let (None, Some(y)) = (place.x, place.y) else {
            return study.refuse(
                key,
                keys_given(&place),
                "{ y = \"node:+Y\", theta = … } with the labels of the measured points",
            );
        };
        let theta = rotation(study, &key, y, place.theta, model)?;
        joints.push(MeasuredJoint { y, theta });
    }
    apart(study, key, &joints, bolts)?;
    if let Some(section) = &table.section {
        check_section(study, key, section, &joints)?;
    }
    Ok(Substructure::Measured {
        source,
        joints,
        section: table.section,
        positions_m: table.points,
    })
}

/// A cross-section is that of a beam. It says what a difference to both sides loses, and how the beam bends beside the joint.
fn check_section(
    study: &StudyText,
    key: &str,
    section: &Section,
    joints: &[MeasuredJoint],
) -> Result<(), StudyError> {
    for (name, value, unit) in [
        ("width", section.width_m, "m"),
        ("height", section.height_m, "m"),
        ("youngs_modulus", section.youngs_modulus_pa, "Pa"),
    ] {
        let expected = format!("a number above zero, {unit}");
        study.positive(format_args!("{key}.section.{name}"), value, expected)?;
    }
    let nu = section.poissons_ratio;
    let expected = "from 0 to below 0.5";
    study.ensure(
        (0.0..0.5).contains(&nu),
        format_args!("{key}.section.poissons_ratio"),
        nu,
        expected,
    )?;
    let differences = joints.iter().filter_map(|joint| match &joint.theta {
        Some(Rotation::Difference { difference, .. }) => Some(difference),
        _ => None,
    });
    for difference in differences {
        study.ensure(
            difference.side() == Difference::Central,
            format_args!("{key}.section"),
            format_args!("it beside a {difference}"),
            "a central difference: what a difference to one side loses depends on how the beam goes on",
        )?;
    }
    study.ensure(
        joints.iter().any(|joint| joint.theta.is_some()),
        format_args!("{key}.section"),
        "it without a rotation",
        "it only where `joint` has a `theta`",
    )
}

fn position(study: &StudyText, key: &str, joint: &JointPlaceTable) -> Result<f64, StudyError> {
    match (joint.x, joint.y, &joint.theta) {
        (Some(x), None, None) => Ok(x),
        _ => study.refuse(
            key,
            keys_given(joint),
            "{ x = distance from the beam's first end in m }",
        ),
    }
}

/// A length that is none is left to the beam's own check.
fn on_the_beam(study: &StudyText, key: &str, x_m: f64, length_m: f64) -> Result<(), StudyError> {
    let is_on_it = (0.0..=length_m).contains(&x_m) || length_m.is_nan() || length_m <= 0.0;
    let expected = format!("a position on the beam, from 0 to {length_m} m");
    study.ensure(is_on_it, key, x_m, expected)
}

fn computed(study: &StudyText, key: &str, table: BeamTable) -> Result<Beam, StudyError> {
    plausible(study, key, &table)?;
    let theory = theory(study, key, &table)?;
    let damping = match (table.damping_ratio, table.loss_factor) {
        (Some(ratio), None) => Damping::Ratios(ratio.list()),
        (None, Some(eta)) => Damping::LossFactor(eta),
        (ratio, _) => {
            let found = match ratio {
                Some(_) => "both damping_ratio and loss_factor",
                None => "neither damping_ratio nor loss_factor",
            };
            return study.refuse(format_args!("{key}.beam"), found, "exactly one of them");
        }
    };
    Ok(Beam {
        length_m: table.length,
        width_m: table.width,
        height_m: table.height,
        youngs_modulus_pa: table.youngs_modulus,
        density_kg_per_m3: table.density,
        theory,
        boundary: table.boundary,
        damping,
    })
}

fn theory(study: &StudyText, key: &str, table: &BeamTable) -> Result<Theory, StudyError> {
    match (table.theory, table.poissons_ratio) {
        (TheoryName::Timoshenko, None) => Ok(Theory::default()),
        (TheoryName::Timoshenko, Some(poissons_ratio)) => Ok(Theory::Timoshenko { poissons_ratio }),
        (TheoryName::EulerBernoulli, None) => Ok(Theory::EulerBernoulli),
        (TheoryName::EulerBernoulli, Some(found)) => study.refuse(
            format_args!("{key}.beam.poissons_ratio"),
            found,
            "it with theory = \"timoshenko\" only; \"euler-bernoulli\" has no shear",
        ),
    }
}

/// Refuses numbers that no joint's test has, and names the slip that they look like. What is no number at all is left to the
/// beam's own check.
fn plausible(study: &StudyText, key: &str, table: &BeamTable) -> Result<(), StudyError> {
    for (name, found, [least, most], expected) in [
        (
            "length",
            table.length,
            [1e-3, 20.0],
            "a length in m, from 0.001 to 20 (is it in millimetres?)",
        ),
        (
            "width",
            table.width,
            [1e-4, 2.0],
            "a width in m, from 0.0001 to 2 (is it in millimetres?)",
        ),
        (
            "height",
            table.height,
            [1e-4, 2.0],
            "a height in m, from 0.0001 to 2 (is it in millimetres?)",
        ),
        (
            "youngs_modulus",
            table.youngs_modulus,
            [1e8, 2e12],
            "Young's modulus in Pa, from 1e8 to 2e12 (is it in GPa or MPa?)",
        ),
        (
            "density",
            table.density,
            [50.0, 30e3],
            "a density in kg/m³, from 50 to 30000 (is it in g/cm³ or t/mm³?)",
        ),
    ] {
        let is_plausible = (least..=most).contains(&found) || !found.is_finite() || found <= 0.0;
        study.ensure(
            is_plausible,
            format_args!("{key}.beam.{name}"),
            found,
            expected,
        )?;
    }
    Ok(())
}

fn keys_given(joint: &JointPlaceTable) -> String {
    let given = [
        ("x", joint.x.is_some()),
        ("y", joint.y.is_some()),
        ("theta", joint.theta.is_some()),
    ];
    names_given("no key", &given)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use bolted_joint_frf::structure::Theory;

    use crate::study::{Study, Substructure};

    const BEAMS: &str = include_str!("../../../../../tests/data/studies/beams.toml");

    #[test]
    fn a_beam_has_shear_where_nothing_is_said() {
        for (said, expected) in [
            ("theory = \"euler-bernoulli\", ", Theory::EulerBernoulli),
            ("", Theory::default()),
            ("theory = \"timoshenko\", ", Theory::default()),
            (
                "poissons_ratio = 0.33, ",
                Theory::Timoshenko {
                    poissons_ratio: 0.33,
                },
            ),
        ] {
            let text = BEAMS.replace("theory = \"euler-bernoulli\", ", said);
            let study = Study::from_toml(&text, Path::new("study.toml")).unwrap();
            match study.b {
                Substructure::Beam { beam, .. } => assert_eq!(beam.theory, expected, "{said}"),
                Substructure::Measured { .. } => panic!("no beam"),
            }
        }
    }
}
