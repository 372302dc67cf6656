//! `[a]` and `[b]`: one source of receptances, and where the joint is on it.

use std::path::Path;

use super::super::super::error::IdentifyError;
use super::super::super::layout::Bolts;
use super::super::super::model::JointModel;
use super::super::tables::{BeamTable, JointPlaceTable, OneOrMore, SubstructureTable};
use super::super::{MeasuredJoint, Source, Substructure};
use super::{Checker, names_given};
use bolted_joint_frf::structure::{Beam, Damping};

impl Checker<'_> {
    pub(in super::super) fn substructure(
        &self,
        key: &str,
        table: SubstructureTable,
        folder: &Path,
        model: JointModel,
        bolts: &Bolts,
    ) -> Result<Substructure, IdentifyError> {
        for (name, there) in [
            ("quantity", table.quantity.is_some()),
            ("units", table.units.is_some()),
            ("averages", table.averages.is_some()),
        ] {
            if there && table.frf.is_none() {
                let found = if name == "quantity" {
                    "a quantity"
                } else {
                    name
                };
                return self.refuse(format!("{key}.{name}"), found, "it beside `frf` only");
            }
        }
        let source = match (table.frf, table.modal, table.beam) {
            (Some(path), modes, None) => Source::Frf {
                file: self.frf_file(
                    key,
                    folder.join(path),
                    table.quantity,
                    table.units.as_ref(),
                    table.averages,
                )?,
                modes: modes.map(|modes| folder.join(modes)),
            },
            (None, Some(path), None) => Source::Modal(folder.join(path)),
            (None, None, Some(beam)) => {
                let beam = self.beam(key, beam)?;
                let mut joints_m = Vec::new();
                for (key, place) in self.places_of_bolts(key, table.joint.0, bolts)? {
                    let x_m = self.position(&key, &place)?;
                    self.on_the_beam(&format!("{key}.x"), x_m, beam.length_m)?;
                    joints_m.push(x_m);
                }
                self.apart_on_beam(key, &joints_m, bolts)?;
                for (point, &x_m) in &table.points {
                    let key = format!("{key}.points.\"{point}\"");
                    self.on_the_beam(&key, x_m, beam.length_m)?;
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
                return self.refuse(
                    key,
                    names_given("no source", &given),
                    "one of `frf`, `modal` and `beam`, or `frf` with `modal` for what was not measured",
                );
            }
        };
        if !table.points.is_empty() {
            return self.refuse(
                format!("{key}.points"),
                "positions",
                "them beside `beam` only; measured points have labels",
            );
        }
        let mut joints = Vec::new();
        for (key, place) in self.places_of_bolts(key, table.joint.0, bolts)? {
            let (None, Some(y)) = (place.x, place.y) else {
                return self.refuse(
                    key,
                    keys_given(&place),
                    "{ y = \"node:+Y\", theta = … } with the labels of the measured points",
                );
            };
            let theta = self.rotation(&key, y, place.theta, model)?;
            joints.push(MeasuredJoint { y, theta });
        }
        self.apart(key, &joints, bolts)?;
        Ok(Substructure::Measured { source, joints })
    }

    fn position(&self, key: &str, joint: &JointPlaceTable) -> Result<f64, IdentifyError> {
        match (joint.x, joint.y, &joint.theta) {
            (Some(x), None, None) => Ok(x),
            _ => self.refuse(
                key,
                keys_given(joint),
                "{ x = distance from the beam's first end in m }",
            ),
        }
    }

    /// A length that is none is left to the beam's own check.
    fn on_the_beam(&self, key: &str, x_m: f64, length_m: f64) -> Result<(), IdentifyError> {
        if (0.0..=length_m).contains(&x_m) || length_m.is_nan() || length_m <= 0.0 {
            return Ok(());
        }
        self.refuse(
            key,
            x_m.to_string(),
            format!("a position on the beam, from 0 to {length_m} m"),
        )
    }

    fn beam(&self, key: &str, table: BeamTable) -> Result<Beam, IdentifyError> {
        let damping = match (table.damping_ratio, table.loss_factor) {
            (Some(OneOrMore::One(ratio)), None) => Damping::Ratios(vec![ratio]),
            (Some(OneOrMore::More(ratios)), None) => Damping::Ratios(ratios),
            (None, Some(eta)) => Damping::LossFactor(eta),
            (ratio, _) => {
                return self.refuse(
                    format!("{key}.beam"),
                    if ratio.is_some() {
                        "both damping_ratio and loss_factor"
                    } else {
                        "neither damping_ratio nor loss_factor"
                    },
                    "exactly one of them",
                );
            }
        };
        Ok(Beam {
            length_m: table.length,
            width_m: table.width,
            height_m: table.height,
            youngs_modulus_pa: table.youngs_modulus,
            density_kg_per_m3: table.density,
            boundary: table.boundary,
            damping,
        })
    }
}

fn keys_given(joint: &JointPlaceTable) -> String {
    let given = [
        ("x", joint.x.is_some()),
        ("y", joint.y.is_some()),
        ("theta", joint.theta.is_some()),
    ];
    names_given("no key", &given)
}
