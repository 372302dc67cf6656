//! A study: what the user's TOML file asks for, checked before anything is read or computed.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::frf::{Dof, Quantity};
use crate::joint::Bodies;
use crate::structure::{Beam, Boundary, Damping};
use crate::text_file;

use super::bands::Bands;
use super::error::IdentifyError;
use super::estimator::NoiseLevel;
use super::model::JointModel;

/// A validated study of method `frf-decoupling`.
#[derive(Clone, Debug)]
pub struct Study {
    /// The study's own file.
    pub path: PathBuf,
    /// Name of the joint.
    pub name: String,
    /// Substructure A.
    pub a: Substructure,
    /// Substructure B.
    pub b: Substructure,
    /// File with the assembly's FRFs.
    pub assembly: FrfFile,
    /// Points of B at which the assembly was measured.
    pub points: Vec<Dof>,
    /// Joint model to identify.
    pub model: JointModel,
    /// Lowest and highest frequency to use, Hz.
    pub frequency_range_hz: [f64; 2],
    /// Bands of the averages.
    pub bands: Bands,
    /// Noise of the assembly's receptances, if known.
    pub noise: Option<NoiseLevel>,
    /// Bodies of a lap model, which go into the joint file.
    pub bodies: Option<Bodies>,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
}

/// One substructure: where its receptances come from, and where its joint is.
#[derive(Clone, Debug)]
pub struct Substructure {
    /// Where its receptances come from.
    pub source: Source,
    /// The joint's DOFs on it.
    pub joint: JointPlace,
    /// Positions (m) of labelled points on a beam.
    pub positions_m: BTreeMap<Dof, f64>,
}

/// Where a substructure's receptances come from.
#[derive(Clone, Debug)]
pub enum Source {
    /// Measured FRFs.
    Frf(FrfFile),
    /// Measured modes.
    Modal(PathBuf),
    /// A computed beam.
    Beam(Beam),
}

/// A universal file, and what the study says about it.
#[derive(Clone, Debug)]
pub struct FrfFile {
    /// The file.
    pub path: PathBuf,
    /// What was measured, where the file contradicts itself or does not say.
    pub quantity: Option<Quantity>,
}

/// The joint's DOFs on a substructure.
#[derive(Clone, Debug, PartialEq)]
pub enum JointPlace {
    /// Measured at labelled points.
    Labels {
        /// Translation.
        y: Dof,
        /// Rotation, where the joint model has one.
        theta: Option<Rotation>,
    },
    /// On a beam, at this distance from its first end, m.
    Position(f64),
}

/// Where rotational receptances come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Rotation {
    /// Measured as such.
    Measured(Dof),
    /// Second-order central difference over three translations; θ is positive towards the last point.
    Difference {
        /// The three points; the middle one is the joint's.
        points: [Dof; 3],
        /// Distance between neighbouring points, m.
        spacing_m: f64,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyFile {
    #[expect(
        dead_code,
        reason = "the only method there is so far; others are refused when it is read"
    )]
    method: Method,
    name: String,
    a: SubstructureTable,
    b: SubstructureTable,
    assembly: AssemblyTable,
    joint: JointTable,
    #[serde(default)]
    frequency: FrequencyTable,
    #[serde(default)]
    bands: Bands,
    noise: Option<NoiseTable>,
    bodies: Option<Bodies>,
    #[serde(default)]
    notes: Vec<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Method {
    FrfDecoupling,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SubstructureTable {
    frf: Option<PathBuf>,
    quantity: Option<Quantity>,
    modal: Option<PathBuf>,
    beam: Option<BeamTable>,
    joint: JointPlaceTable,
    #[serde(default)]
    points: BTreeMap<Dof, f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BeamTable {
    length: f64,
    width: f64,
    height: f64,
    youngs_modulus: f64,
    density: f64,
    boundary: Boundary,
    damping_ratio: Option<OneOrMore>,
    loss_factor: Option<f64>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number or a list of numbers")]
enum OneOrMore {
    One(f64),
    More(Vec<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JointPlaceTable {
    y: Option<Dof>,
    theta: Option<ThetaTable>,
    x: Option<f64>,
}

enum ThetaTable {
    Measured(Dof),
    Difference(DifferenceTable),
}

/// By hand, since an untagged enum would not say which key of the table is wrong.
impl<'de> Deserialize<'de> for ThetaTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ThetaVisitor;
        impl<'de> Visitor<'de> for ThetaVisitor {
            type Value = ThetaTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a rotation such as \"2:+RZ\", or { points = [three points], spacing = metres }",
                )
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ThetaTable, E> {
                text.parse().map(ThetaTable::Measured).map_err(E::custom)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ThetaTable, A::Error> {
                DifferenceTable::deserialize(MapAccessDeserializer::new(map))
                    .map(ThetaTable::Difference)
            }
        }
        deserializer.deserialize_any(ThetaVisitor)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DifferenceTable {
    points: [Dof; 3],
    spacing: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AssemblyTable {
    frf: PathBuf,
    quantity: Option<Quantity>,
    points: Vec<Dof>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JointTable {
    model: JointModel,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrequencyTable {
    from: Option<f64>,
    to: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NoiseTable {
    #[serde(default)]
    relative: f64,
    #[serde(default)]
    floor: f64,
}

/// The names of the keys that are there, or `none`.
fn names_given(none: &str, keys: &[(&str, bool)]) -> String {
    let given: Vec<&str> = keys
        .iter()
        .filter_map(|&(name, there)| there.then_some(name))
        .collect();
    if given.is_empty() {
        none.to_owned()
    } else {
        given.join(" and ")
    }
}

/// Makes errors that name the study's file.
struct Checker<'a> {
    path: &'a Path,
}

impl Checker<'_> {
    fn refuse<T>(
        &self,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Result<T, IdentifyError> {
        Err(IdentifyError::Study {
            path: self.path.to_owned(),
            key: key.into(),
            found: found.into(),
            expected: expected.into(),
        })
    }
}

impl Study {
    /// Reads and checks a study. Paths in it are relative to its own folder.
    ///
    /// # Errors
    /// [`IdentifyError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, IdentifyError> {
        let text = text_file::read(path, "a study (TOML)")?;
        Self::from_toml(&text, path)
    }

    /// A study from the text of its file; `path` tells where that lies.
    ///
    /// # Errors
    /// [`IdentifyError`] that names the file and the key or line.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, IdentifyError> {
        let file: StudyFile = toml::from_str(text).map_err(|error| IdentifyError::Syntax {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        let check = Checker { path };
        let folder = path.parent().unwrap_or(Path::new(""));
        let model = file.joint.model;
        let a = check.substructure("a", file.a, folder, model)?;
        let b = check.substructure("b", file.b, folder, model)?;
        if file.name.trim().is_empty() || file.name.chars().any(char::is_control) {
            return check.refuse("name", format!("{:?}", file.name), "one line of text");
        }
        let points = check.points(file.assembly.points)?;
        if let Source::Beam(_) = b.source {
            for point in &points {
                if !(point.direction().is_translation() || point.direction().is_rotation()) {
                    return check.refuse(
                        "assembly.points",
                        point.to_string(),
                        "a direction such as \"11:+Y\" on a beam",
                    );
                }
                if !b.positions_m.contains_key(point) {
                    return check.refuse(
                        "b.points",
                        format!("no position of {point}"),
                        format!("\"{point}\" = its distance from the beam's first end in m"),
                    );
                }
            }
        }
        let from = file.frequency.from.unwrap_or(f64::MIN_POSITIVE);
        let to = file.frequency.to.unwrap_or(f64::MAX);
        if !(from > 0.0 && from < to) {
            return check.refuse(
                "frequency",
                match (file.frequency.from, file.frequency.to) {
                    (Some(from), None) => format!("from {from}"),
                    (None, Some(to)) => format!("to {to}"),
                    _ => format!("from {from} to {to}"),
                },
                "frequencies in Hz with 0 < from < to",
            );
        }
        for (name, bands) in file.bands.named() {
            if let Some([from, to]) = bands.iter().find(|[from, to]| !(*from > 0.0 && from < to)) {
                return check.refuse(
                    format!("bands.{name}"),
                    format!("[{from}, {to}]"),
                    "bands [from, to] in Hz with 0 < from < to",
                );
            }
        }
        let noise = match file.noise {
            None => None,
            Some(NoiseTable { relative, floor }) => {
                let usable = |value: f64| value.is_finite() && value >= 0.0;
                if !(usable(relative) && usable(floor) && relative + floor > 0.0) {
                    return check.refuse(
                        "noise",
                        format!("relative = {relative}, floor = {floor}"),
                        "standard deviations that are not negative, at least one of them above zero",
                    );
                }
                Some(NoiseLevel { relative, floor })
            }
        };
        if let Some(bodies) = &file.bodies {
            check.bodies(bodies, model.dofs())?;
        }
        Ok(Self {
            path: path.to_owned(),
            name: file.name,
            a,
            b,
            assembly: FrfFile {
                path: folder.join(file.assembly.frf),
                quantity: file.assembly.quantity,
            },
            points,
            model,
            frequency_range_hz: [from, to],
            bands: file.bands,
            noise,
            bodies: file.bodies,
            notes: file.notes,
        })
    }
}

impl Checker<'_> {
    fn substructure(
        &self,
        key: &str,
        table: SubstructureTable,
        folder: &Path,
        model: JointModel,
    ) -> Result<Substructure, IdentifyError> {
        let source = match (table.frf, table.modal, table.beam) {
            (Some(path), None, None) => Source::Frf(FrfFile {
                path: folder.join(path),
                quantity: table.quantity,
            }),
            (None, Some(path), None) => Source::Modal(folder.join(path)),
            (None, None, Some(beam)) => Source::Beam(self.beam(key, beam)?),
            (frf, modal, beam) => {
                return self.refuse(
                    key,
                    names_given(
                        "no source",
                        &[
                            ("frf", frf.is_some()),
                            ("modal", modal.is_some()),
                            ("beam", beam.is_some()),
                        ],
                    ),
                    "exactly one of `frf`, `modal` and `beam`",
                );
            }
        };
        if table.quantity.is_some() && !matches!(source, Source::Frf(_)) {
            return self.refuse(
                format!("{key}.quantity"),
                "a quantity",
                "it beside `frf` only",
            );
        }
        let on_a_beam = matches!(source, Source::Beam(_));
        if !on_a_beam && !table.points.is_empty() {
            return self.refuse(
                format!("{key}.points"),
                "positions",
                "them beside `beam` only; measured points have labels",
            );
        }
        let place_key = format!("{key}.joint");
        let given = names_given(
            "no key",
            &[
                ("x", table.joint.x.is_some()),
                ("y", table.joint.y.is_some()),
                ("theta", table.joint.theta.is_some()),
            ],
        );
        let joint = match (table.joint.x, table.joint.y, table.joint.theta) {
            (Some(x), None, None) if on_a_beam => JointPlace::Position(x),
            (None, Some(y), theta) if !on_a_beam => JointPlace::Labels {
                y,
                theta: self.rotation(&place_key, y, theta, model)?,
            },
            _ if on_a_beam => {
                return self.refuse(
                    place_key,
                    given,
                    "{ x = distance from the beam's first end in m }",
                );
            }
            _ => {
                return self.refuse(
                    place_key,
                    given,
                    "{ y = \"node:+Y\", theta = … } with the labels of the measured points",
                );
            }
        };
        let substructure = Substructure {
            source,
            joint,
            positions_m: table.points,
        };
        self.positions(key, &substructure)?;
        Ok(substructure)
    }

    /// Every position on a beam lies on it. A length that is none is left to the beam's own check.
    fn positions(&self, key: &str, substructure: &Substructure) -> Result<(), IdentifyError> {
        let Source::Beam(beam) = &substructure.source else {
            return Ok(());
        };
        let joint = match substructure.joint {
            JointPlace::Position(x_m) => Some((format!("{key}.joint.x"), x_m)),
            JointPlace::Labels { .. } => None,
        };
        let labelled = substructure
            .positions_m
            .iter()
            .map(|(point, &x_m)| (format!("{key}.points.\"{point}\""), x_m));
        let length_m = beam.length_m;
        for (key, x_m) in joint.into_iter().chain(labelled) {
            if !(0.0..=length_m).contains(&x_m) && length_m > 0.0 {
                return self.refuse(
                    key,
                    format!("{x_m}"),
                    format!("a position on the beam, from 0 to {length_m} m"),
                );
            }
        }
        Ok(())
    }

    fn rotation(
        &self,
        key: &str,
        y: Dof,
        theta: Option<ThetaTable>,
        model: JointModel,
    ) -> Result<Option<Rotation>, IdentifyError> {
        let key = format!("{key}.theta");
        match theta {
            None if model.dofs() == 1 => Ok(None),
            None => self.refuse(
                key,
                "nothing",
                format!("a rotation, which joint model \"{model}\" needs: a measured one or {{ points = […], spacing = … }}"),
            ),
            Some(_) if model.dofs() == 1 => Ok(None),
            Some(ThetaTable::Measured(dof)) if dof.direction().is_rotation() => {
                Ok(Some(Rotation::Measured(dof)))
            }
            Some(ThetaTable::Measured(dof)) => {
                self.refuse(key, dof.to_string(), "a rotation such as \"2:+RZ\"")
            }
            Some(ThetaTable::Difference(DifferenceTable { points, spacing })) => {
                if !(spacing.is_finite() && spacing > 0.0) {
                    return self.refuse(
                        format!("{key}.spacing"),
                        spacing.to_string(),
                        "the distance between neighbouring points in m",
                    );
                }
                if points[1] != y {
                    return self.refuse(
                        format!("{key}.points"),
                        format!("{} in the middle", points[1]),
                        format!("the joint's own translation {y} there: the difference is central"),
                    );
                }
                Ok(Some(Rotation::Difference {
                    points,
                    spacing_m: spacing,
                }))
            }
        }
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

    fn points(&self, points: Vec<Dof>) -> Result<Vec<Dof>, IdentifyError> {
        if points.is_empty() {
            return self.refuse(
                "assembly.points",
                "an empty list",
                "one or more measured points of B, three for the best result",
            );
        }
        for (index, point) in points.iter().enumerate() {
            let before = &points[..index];
            if let Some(same) = before.iter().find(|&p| p == point || *p == point.flipped()) {
                return self.refuse(
                    "assembly.points",
                    if same == point {
                        format!("{point} twice")
                    } else {
                        format!("both {same} and {point}, which are one point")
                    },
                    "every point once",
                );
            }
        }
        Ok(points)
    }

    fn bodies(&self, bodies: &Bodies, dofs: usize) -> Result<(), IdentifyError> {
        for (side, body) in [("a", &bodies.a), ("b", &bodies.b)] {
            for (name, values) in [
                ("inertia", &body.inertia),
                ("stiffness", &body.stiffness),
                ("damping", &body.damping),
            ] {
                let key = format!("bodies.{side}.{name}");
                if values.len() != dofs {
                    return self.refuse(
                        key,
                        format!("{} entries", values.len()),
                        format!("{dofs}, one for each DOF of the joint"),
                    );
                }
                let usable = |value: f64| {
                    value.is_finite() && (value > 0.0 || value == 0.0 && name != "inertia")
                };
                if let Some(value) = values.iter().find(|&&value| !usable(value)) {
                    let expected = if name == "inertia" {
                        "a mass in kg or moment of inertia in kg·m² above zero"
                    } else {
                        "a finite number that is not negative"
                    };
                    return self.refuse(key, value.to_string(), expected);
                }
            }
        }
        Ok(())
    }
}
