//! `[a]` and `[b]`: one source of receptances, and where the joint is on it.

use std::collections::BTreeMap;

use super::super::super::layout::Bolts;
use super::super::super::model::JointModel;
use super::super::set_up::{Deviations, MassAtJoint, SetUp};
use super::super::tables::{
    BeamTable, JointPlaceTable, SectionTable, SubstructureTable, TheoryName,
};
use super::super::{MeasuredJoint, Rotation, Source, Substructure};
use super::assembly::{MeasuredAs, frf_file};
use super::bolts::{apart, apart_on_beam, places_of_bolts};
use super::names_given;
use super::rotation::rotation;
use super::stated::{not_negative, without_deviation};
use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Beam, Damping, Difference, Section, Theory};
use bolted_joint_study::{BeamNumber, Stated, StudyError, StudyText};

/// More than that is no bolt, and a slip of the unit.
const MOST_MASS_KG: f64 = 100.0;
const MOST_INERTIA_KG_M2: f64 = 100.0;

pub(crate) fn substructure(
    study: &StudyText,
    key: &str,
    table: SubstructureTable,
    model: JointModel,
    bolts: &Bolts,
) -> Result<Substructure, StudyError> {
    study.beside_functions_only(
        key,
        table.frf.is_some(),
        &[
            ("quantity", "a quantity", table.quantity.is_some()),
            ("units", "units", table.units.is_some()),
            ("averages", "averages", table.averages.is_some()),
            ("coherence", "a file", table.coherence.is_some()),
            (
                "accelerometer_mass",
                "a mass",
                table.accelerometer_mass.is_some(),
            ),
        ],
    )?;
    if table.ground {
        return ground(study, key, &table, bolts);
    }
    let places = study.needed(
        format_args!("{key}.joint"),
        table.joint,
        "the joint's place on this structure, such as { y = \"2:+Y\", theta = \"2:+RZ\" }",
    )?;
    let source = match (table.frf, table.modal, table.beam) {
        (Some(paths), modes, None) => Source::Frf {
            file: frf_file(
                study,
                key,
                &paths,
                &MeasuredAs {
                    coherence: table.coherence.as_ref(),
                    quantity: table.quantity,
                    units: table.units.as_ref(),
                    averages: table.averages,
                    accelerometer_mass: table.accelerometer_mass.as_ref(),
                },
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
            let mut set_up = SetUp::default();
            set_up.deviations.youngs_modulus = beam.youngs_modulus.relative_deviation();
            set_up.deviations.density = beam.density.relative_deviation();
            let beam = computed(study, key, beam)?;
            let mut joints_m = Vec::new();
            for (key, place) in places_of_bolts(study, key, places, bolts)? {
                let x = position(study, &key, &place)?;
                on_the_beam(study, &format!("{key}.x"), x.value, beam.length_m)?;
                joints_m.push(x.value);
                set_up.deviations.joints_m.push(x.standard_deviation());
                add_mass(study, &key, &place, model, &mut set_up)?;
            }
            apart_on_beam(study, key, &joints_m, bolts)?;
            for (point, x) in &table.points {
                let key = format!("{key}.points.\"{point}\"");
                on_the_beam(study, &key, x.value, beam.length_m)?;
            }
            let positions_m = positions(&table.points, &mut set_up.deviations);
            return Ok(Substructure::Beam {
                beam,
                joints_m,
                positions_m,
                set_up,
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
    for (point, x) in &table.points {
        let key = format!("{key}.points.\"{point}\"");
        study.ensure(
            x.value.is_finite(),
            key,
            x.value,
            "a position along the structure in m",
        )?;
    }
    let mut set_up = SetUp::default();
    let positions_m = positions(&table.points, &mut set_up.deviations);
    let mut joints = Vec::new();
    for (key, place) in places_of_bolts(study, key, places, bolts)? {
        add_mass(study, &key, &place, model, &mut set_up)?;
        let Some(y) = place.y else {
            return study.refuse(
                key,
                keys_given(&place),
                "{ y = \"node:+Y\", theta = … } with the labels of the measured points",
            );
        };
        let theta = rotation(study, &key, y, place.theta, model)?;
        let x_m = place.x.map(|x| x.value);
        study.ensure(
            x_m.is_none_or(f64::is_finite),
            format_args!("{key}.x"),
            x_m.unwrap_or_default(),
            "the bolt's position along the structure in m",
        )?;
        let x_deviation = place.x.and_then(|x| x.standard_deviation());
        set_up.deviations.joints_m.push(x_deviation);
        joints.push(MeasuredJoint { y, theta, x_m });
    }
    apart(study, key, &joints, bolts)?;
    let section = match &table.section {
        None => None,
        Some(table) => {
            let section = section(study, key, table)?;
            check_section(study, key, &section, &joints)?;
            // What it loses follows a moment of inertia on the structure itself, not one that is added.
            let turned = set_up.masses.iter().find(|mass| mass.inertia_kg_m2 > 0.0);
            if let Some(mass) = turned {
                return study.refuse(
                    format_args!("{key}.joint.inertia"),
                    mass.inertia_kg_m2,
                    "none beside a `section`: a rotation by differences carries no known moment of inertia; leave it to \
                     `budget.joint_inertia`",
                );
            }
            set_up.deviations.difference_stiffness = table.youngs_modulus.relative_deviation();
            Some(section)
        }
    };
    Ok(Substructure::Measured {
        source,
        joints,
        section,
        positions_m,
        set_up,
    })
}

/// A structure that does not move: nothing is measured of it, and the joint is wherever the other structure has it.
fn ground(
    study: &StudyText,
    key: &str,
    table: &SubstructureTable,
    bolts: &Bolts,
) -> Result<Substructure, StudyError> {
    study.ensure(
        key.ends_with('a'),
        format_args!("{key}.ground"),
        "true",
        "the ground as `a`: the assembly's points are on `b`, which moves",
    )?;
    let others = [
        ("frf", table.frf.is_some()),
        ("modal", table.modal.is_some()),
        ("beam", table.beam.is_some()),
        ("section", table.section.is_some()),
        ("joint", table.joint.is_some()),
        ("points", !table.points.is_empty()),
    ];
    let is_alone = others.iter().all(|(_, there)| !there);
    let found = format!("ground = true and {}", names_given("", &others));
    study.ensure(
        is_alone,
        key,
        found,
        "ground = true alone: it does not move, and `b.joint` says where the joint is",
    )?;
    Ok(Substructure::Ground {
        bolts: bolts.count(),
    })
}

/// Positions of points; their deviations go to those of the set-up.
fn positions(points: &BTreeMap<Dof, Stated>, deviations: &mut Deviations) -> BTreeMap<Dof, f64> {
    let stated = points.iter();
    let stated = stated.filter_map(|(&point, x)| Some((point, x.standard_deviation()?)));
    deviations.points_m = stated.collect();
    points.iter().map(|(&point, x)| (point, x.value)).collect()
}

/// What is known of a mass at the joint.
fn add_mass(
    study: &StudyText,
    key: &str,
    place: &JointPlaceTable,
    model: JointModel,
    set_up: &mut SetUp,
) -> Result<(), StudyError> {
    let mut mass = MassAtJoint::default();
    let mut deviations = [None, None];
    if let Some(stated) = &place.mass {
        not_negative(study, &format!("{key}.mass"), stated, "kg", MOST_MASS_KG)?;
        mass.mass_kg = stated.value;
        deviations[0] = stated.standard_deviation();
    }
    if let Some(stated) = &place.inertia {
        let key = format!("{key}.inertia");
        not_negative(study, &key, stated, "kg·m²", MOST_INERTIA_KG_M2)?;
        study.ensure(
            model.dofs() == 2,
            &key,
            stated,
            "it only where the joint has a rotation: model \"diagonal\" or \"full\"",
        )?;
        mass.inertia_kg_m2 = stated.value;
        deviations[1] = stated.standard_deviation();
    }
    set_up.masses.push(mass);
    set_up.deviations.masses_kg.push(deviations[0]);
    set_up.deviations.inertias_kg_m2.push(deviations[1]);
    Ok(())
}

fn section(study: &StudyText, key: &str, table: &SectionTable) -> Result<Section, StudyError> {
    let of = |name: &str, stated: &Stated| {
        without_deviation(study, &format!("{key}.section.{name}"), stated)
    };
    let ratio = table.poissons_ratio.as_ref();
    let ratio = ratio.map(|ratio| of("poissons_ratio", ratio)).transpose()?;
    Ok(Section {
        width_m: of("width", &table.width)?,
        height_m: of("height", &table.height)?,
        youngs_modulus_pa: table.youngs_modulus.value,
        poissons_ratio: ratio.unwrap_or(Theory::USUAL_POISSONS_RATIO),
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

fn position(study: &StudyText, key: &str, joint: &JointPlaceTable) -> Result<Stated, StudyError> {
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
    let of = |name: &str, stated: &Stated| {
        without_deviation(study, &format!("{key}.beam.{name}"), stated)
    };
    let [length_m, width_m, height_m] = [
        of("length", &table.length)?,
        of("width", &table.width)?,
        of("height", &table.height)?,
    ];
    let loss_factor = table.loss_factor.as_ref();
    let loss_factor = loss_factor.map(|eta| of("loss_factor", eta)).transpose()?;
    plausible(study, key, &table)?;
    let theory = theory(study, key, &table)?;
    let damping = match (table.damping_ratio, loss_factor) {
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
        length_m,
        width_m,
        height_m,
        youngs_modulus_pa: table.youngs_modulus.value,
        density_kg_per_m3: table.density.value,
        theory,
        boundary: table.boundary,
        damping,
    })
}

fn theory(study: &StudyText, key: &str, table: &BeamTable) -> Result<Theory, StudyError> {
    let ratio = table.poissons_ratio.as_ref();
    let name = format!("{key}.beam.poissons_ratio");
    let ratio = ratio.map(|ratio| without_deviation(study, &name, ratio));
    match (table.theory, ratio.transpose()?) {
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

fn plausible(study: &StudyText, key: &str, table: &BeamTable) -> Result<(), StudyError> {
    for (number, found) in [
        (BeamNumber::Length, table.length.value),
        (BeamNumber::Width, table.width.value),
        (BeamNumber::Height, table.height.value),
        (BeamNumber::YoungsModulus, table.youngs_modulus.value),
        (BeamNumber::Density, table.density.value),
    ] {
        study.plausible_in_beam(format_args!("{key}.beam"), number, found)?;
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
                _ => panic!("no beam"),
            }
        }
    }
}
