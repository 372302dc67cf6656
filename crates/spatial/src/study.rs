//! A study of method `frf-space`, checked, with its functions read.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::str::FromStr as _;

use bolted_joint_frf::{Direction, Dof, FrfSet, Sign};
use bolted_joint_joint::InputFile;
use bolted_joint_space::{Axes, Dof as Motion, JointModel, Mirrors, Motions, Parametrisation};
use bolted_joint_study::{StudyError, StudyText, schema};
use bolted_joint_virtual_point::Sensor;
use nalgebra::{Matrix3, Vector3};

use crate::chain::ChainStudy;
use crate::coherence::level_of;
use crate::level::size;
use crate::links::Links;
use crate::part_noise::{PartNoise, SaidBy, Shown};
use crate::problem::{Level, Observed, Problem};
use crate::side::{MOTIONS, Side};
use crate::tables::{JointTable, ModelName, NoiseTable, SensorTable, StudyFile};
use crate::uneven::Uneven;

/// How far from an interface a sensor, an impact or a bolt of it is at most, m.
pub(crate) const FARTHEST_M: f64 = 3.0;

/// Size of a function in parts of the largest one that is rounding.
const ROUNDING: f64 = 1e-9;

/// A checked study, with its functions.
#[derive(Clone, Debug)]
pub struct SpatialStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Name of the joint.
    pub name: String,
    /// Name of the joint's model.
    pub model: String,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
    /// The files behind the result.
    pub files: Vec<InputFile>,
    /// What is known of the noise.
    pub level: Level,
    /// Noise of the functions of a and of b.
    pub noise: [PartNoise; 2],
    /// Functions of the assembly that are left out since they are zero.
    pub(crate) zero_functions: usize,
    /// What had to be assumed of the files.
    pub(crate) assumed: Vec<String>,
    pub(crate) problem: Problem,
    /// The same with noise that goes with the values of the assembly's functions, where they seem to show that.
    pub(crate) uneven: Option<Uneven>,
    /// What the interfaces have.
    pub(crate) motions: Motions,
}

/// Directions along an axis or about it, in the order of an interface's motions.
pub(crate) const DIRECTIONS: [Direction; MOTIONS] = [
    Direction::X,
    Direction::Y,
    Direction::Z,
    Direction::RX,
    Direction::RY,
    Direction::RZ,
];

impl SpatialStudy {
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<StudyFile>()
    }

    /// A study from its text, with the files that it names.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, StudyError> {
        let file: StudyFile = study.tables()?;
        let chain = ChainStudy::of_measured(study)?;
        let reader = Reader {
            study,
            motions: chain.motions,
        };
        let (sides, link) = chain.two_sides()?;
        let (mut observed, zero_functions) = reader.observed(&sides, chain.assembly.as_ref())?;
        let (level, _) = level_of(chain.stated, &mut observed);
        let frequency_hz = chain.problem.frequency_hz.clone();
        let mut assumed = chain.assumed.clone();
        assumed.extend(chain.at_known_joints());
        assumed.extend(
            chain
                .assembly
                .as_ref()
                .and_then(|assembly| unmatched(&sides, &observed, assembly)),
        );
        let budget = reader.budget(
            &file.budget,
            &sides,
            &chain.parts,
            std::slice::from_ref(&link),
        )?;
        let may_show = [(&file.a, file.noise.a), (&file.b, file.noise.b)]
            .map(|(part, stated)| part.frf.is_some() && stated.is_none());
        let is_stated = matches!(chain.stated, Level::Relative(_));
        let of_parts = chain.parts.iter().map(|part| part.is_told);
        let has_coherence: Vec<bool> = of_parts.collect();
        let own = Self {
            motions: chain.motions,
            path: study.path().to_owned(),
            name: file.name,
            model: chain.models[0].clone(),
            notes: file.notes,
            files: chain.files,
            level,
            noise: chain.noise,
            zero_functions,
            assumed,
            uneven: None,
            problem: Problem {
                tolerances: budget.tolerances,
                wider: Vec::new(),
                common: budget.common,
                balance: None,
                sides,
                frequency_hz,
                observed,
                links: Links(vec![link]),
            }
            .with_anew(budget.anew),
        };
        // a chain takes the noise of the assembly's functions alone
        Ok(match file.joint.len() {
            1 => own
                .with_noise_by_coherence(&has_coherence, [file.noise.a, file.noise.b])
                .with_shown_noise(may_show, is_stated),
            _ => own,
        })
    }

    /// With noise that the functions of substructures show, where these `may_show` it since the study states none.
    /// A level of the assembly that `is_stated` is that over all lines.
    fn with_shown_noise(mut self, may_show: [bool; 2], is_stated: bool) -> Self {
        let is_told = |n: usize| self.noise[n].by == SaidBy::Coherence;
        let may_show = [0, 1].map(|n| may_show[n] && !is_told(n));
        if let Some(shown) = Shown::of(&self.problem, self.level, may_show) {
            self.level = shown.level;
            for (own, shown) in self.noise.iter_mut().zip(shown.noise) {
                if own.is_none() {
                    *own = shown;
                }
            }
            self.assumed.push(shown.note);
        }
        if self.has_noise() && self.level != Level::OfCoherence {
            self.uneven = Uneven::shown(&self.problem, is_stated);
        }
        self
    }

    /// The motions that the interfaces have.
    #[must_use]
    pub fn motions(&self) -> Motions {
        self.motions
    }

    /// Where the joint moves, in words: in space, or in the motions of a plane.
    #[must_use]
    pub fn whereabouts(&self) -> String {
        match self.motions.are_all() {
            true => "in space".to_owned(),
            false => format!("in {}", self.motions),
        }
    }

    /// Functions of the assembly that are compared.
    #[must_use]
    pub fn functions(&self) -> usize {
        self.problem.observed.len()
    }
}

pub(crate) struct Reader<'s> {
    pub(crate) study: &'s StudyText,
    /// What the interfaces have.
    pub(crate) motions: Motions,
}

/// The motions that a study is about.
pub(crate) fn motions(study: &StudyText, list: Option<&[String]>) -> Result<Motions, StudyError> {
    let Some(list) = list else {
        return Ok(Motions::ALL);
    };
    study.ensure(
        !list.is_empty(),
        "motions",
        "an empty list",
        "1 or more of x, y, z, rx, ry, rz",
    )?;
    let mut dofs = Vec::new();
    for (place, name) in list.iter().enumerate() {
        let key = format_args!("motions[{place}]").to_string();
        let Some(dof) = Motion::ALL.into_iter().find(|dof| dof.symbol() == name) else {
            let expected =
                "one of x, y, z, rx, ry, rz; θ of a beam along x that bends along y is rz";
            return study.refuse(key, format_args!("{name:?}"), expected);
        };
        study.ensure(
            !dofs.contains(&dof),
            key,
            format_args!("{name:?} once more"),
            "each motion once",
        )?;
        dofs.push(dof);
    }
    Motions::of(&dofs).map_err(|source| StudyError::model(study.path(), Some("motions"), source))
}

impl Reader<'_> {
    /// Noise of the substructures.
    pub(crate) fn noise(
        &self,
        table: &NoiseTable,
        level: Level,
    ) -> Result<[PartNoise; 2], StudyError> {
        let of = |key: &str, given: Option<f64>| {
            let Some(part) = given.filter(|&part| part != 0.0) else {
                return Ok(PartNoise::NONE);
            };
            self.study.ensure(
                level.is_known(),
                key,
                format_args!("{part} without noise.relative"),
                "the noise of the assembly's functions beside that of the substructures",
            )?;
            let expected = "noise in parts of each value, such as 0.01, or 0 for exact functions";
            self.study.positive(key, part, expected)?;
            self.study.part_of_whole(key, part)?;
            Ok::<_, StudyError>(PartNoise::of_values(part))
        };
        Ok([of("noise.a", table.a)?, of("noise.b", table.b)?])
    }

    /// The noise of the assembly's functions.
    pub(crate) fn level(&self, table: &NoiseTable) -> Result<Level, StudyError> {
        let Some(part) = table.relative else {
            return Ok(Level::OfResiduals);
        };
        let key = "noise.relative";
        let expected = "noise in parts of each function's r.m.s., such as 0.01";
        self.study.positive(key, part, expected)?;
        self.study.part_of_whole(key, part)?;
        Ok(Level::Relative(part))
    }

    pub(crate) fn sensor(
        &self,
        key: &str,
        table: &SensorTable,
    ) -> Result<(Vec<Dof>, Sensor), StudyError> {
        let position = self.near(key, table.position)?;
        let refused = |source| StudyError::model(self.study.path(), Some(key), source);
        match (table.node, &table.dof) {
            (Some(node), None) if table.direction.is_none() => {
                let rows =
                    table
                        .axes
                        .unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
                let matrix = Matrix3::from_fn(|i, j| rows[i][j]);
                let axes = Axes::new(matrix)
                    .map_err(|source| StudyError::model(self.study.path(), Some(key), source))?;
                let dofs = DIRECTIONS[..3]
                    .iter()
                    .map(|&direction| Dof::new(node, direction, Sign::Plus))
                    .collect();
                let sensor = Sensor::triaxial(position, &axes, [1.0; 3]).map_err(refused)?;
                Ok((dofs, sensor))
            }
            (None, Some(text)) if table.axes.is_none() => {
                let dof = self.dof(format_args!("{key}.dof"), text)?;
                let direction = self.direction(key, dof, table.direction)?;
                let sensor = Sensor::uniaxial(position, direction, 1.0).map_err(refused)?;
                Ok((vec![dof], sensor))
            }
            _ => self.study.refuse(
                key,
                "keys of both kinds of sensors, or of none",
                "node (and axes) for three channels, or dof (and direction) for one",
            ),
        }
    }

    /// A place near the interface, m.
    pub(crate) fn near(
        &self,
        key: impl std::fmt::Display,
        position: [f64; 3],
    ) -> Result<Vector3<f64>, StudyError> {
        let is_near = |own: &f64| !own.is_finite() || own.abs() <= FARTHEST_M;
        self.study.ensure(
            position.iter().all(is_near),
            key,
            format_args!("the place {position:?}"),
            format_args!(
                "a place near the interface, at most {FARTHEST_M} m from it (is it in millimetres?)"
            ),
        )?;
        Ok(Vector3::from(position))
    }

    /// The direction that is given, or that of a DOF in the interface's axes.
    pub(crate) fn direction(
        &self,
        key: &str,
        dof: Dof,
        given: Option<[f64; 3]>,
    ) -> Result<Vector3<f64>, StudyError> {
        if let Some(direction) = given {
            return Ok(Vector3::from(direction));
        }
        let axis = DIRECTIONS[..3]
            .iter()
            .position(|&direction| direction == dof.direction());
        let Some(axis) = axis else {
            return self.study.refuse(
                format_args!("{key}.dof"),
                dof,
                "a translation along x, y or z, or its direction = [x, y, z]",
            );
        };
        let mut direction = Vector3::zeros();
        direction[axis] = dof.sign().factor();
        Ok(direction)
    }

    pub(crate) fn dof(&self, key: impl std::fmt::Display, text: &str) -> Result<Dof, StudyError> {
        Dof::from_str(text).map_err(|refused| {
            self.study.refusal(
                key,
                format_args!("{text:?}"),
                format_args!("a DOF such as \"2:+Y\": {refused}"),
            )
        })
    }

    /// Every function of the assembly between rows and columns of the parts, and how many are left out since they are zero: these
    /// tell nothing.
    pub(crate) fn observed(
        &self,
        sides: &[Side; 2],
        assembly: Option<&FrfSet>,
    ) -> Result<(Vec<Observed>, usize), StudyError> {
        let [a, b] = sides;
        let places = |first: &[Dof], second: &[Dof]| -> Vec<(usize, Dof)> {
            first.iter().chain(second).copied().enumerate().collect()
        };
        let rows = places(&a.responses, &b.responses);
        let columns = places(&a.references, &b.references);
        let mut observed = Vec::new();
        for &(row, response) in &rows {
            for &(column, reference) in &columns {
                let found = assembly.map(|all| all.receptance(response, reference));
                // the transposed function is another datum only where it was measured
                let Some(Ok(function)) = found else { continue };
                if !function.is_reciprocal() {
                    let one = Observed::new([row, column], function.values().to_vec());
                    let noise = assembly.and_then(|all| all.noise_deviations(response, reference));
                    observed.push(match noise {
                        Some(noise) => one.with_noise(&noise),
                        None => one,
                    });
                }
            }
        }
        self.study.ensure(
            !observed.is_empty(),
            "assembly.frf",
            "no function between DOFs of the parts",
            "functions between sensors, impacts, responses and references of the parts; points have one number in all files",
        )?;
        let all = observed.len();
        let sizes = observed.iter().map(|one| size(&one.values));
        let largest = sizes.fold(0.0, f64::max);
        observed.retain(|one| size(&one.values) > ROUNDING * largest);
        self.study.ensure(
            !observed.is_empty(),
            "assembly.frf",
            "functions that are zero at every line",
            "functions of an assembly that moves",
        )?;
        let left_out = all - observed.len();
        Ok((observed, left_out))
    }

    /// Refuses what another model needs: its user takes it for said.
    fn ensure_of_model(
        &self,
        key: &str,
        model: ModelName,
        table: &JointTable,
    ) -> Result<(), StudyError> {
        for (own, is_there, models) in keys_of_models(table) {
            let names: Vec<String> = models
                .iter()
                .map(|&model| format!("\"{}\"", model_name(model)))
                .collect();
            self.study.ensure(
                !is_there || models.contains(&model),
                format_args!("{key}.{own}"),
                format_args!("it beside model = \"{}\"", model_name(model)),
                format_args!(
                    "it beside {} alone; remove it, or state that model",
                    names.join(" or ")
                ),
            )?;
        }
        Ok(())
    }

    pub(crate) fn model(
        &self,
        key: &str,
        model: ModelName,
        table: &JointTable,
    ) -> Result<Parametrisation, StudyError> {
        self.ensure_of_model(key, model, table)?;
        let axis = table.axis.map_or(Vector3::z(), Vector3::from);
        let mirrors = match table.twisted {
            true => Mirrors::Lost,
            false => Mirrors::Kept,
        };
        let model = match model {
            ModelName::Translations => JointModel::Translations,
            ModelName::Diagonal => JointModel::Diagonal,
            ModelName::Bolt => JointModel::Bolt { axis, mirrors },
            ModelName::TwoBolts => JointModel::TwoBolts {
                axis,
                line: self
                    .study
                    .needed(
                        format_args!("{key}.line"),
                        table.line,
                        "the direction from one bolt to the other",
                    )?
                    .into(),
                mirrors,
            },
            ModelName::BoltCircle => JointModel::BoltCircle {
                bolts: self.study.needed(
                    format_args!("{key}.bolts"),
                    table.bolts,
                    "how many bolts there are",
                )?,
                axis,
                mirrors,
            },
            ModelName::Bolts => JointModel::Bolts {
                axis,
                positions_m: self
                    .study
                    .needed(
                        format_args!("{key}.positions"),
                        table.positions.as_ref(),
                        "a place [x, y, z] in m for each bolt",
                    )?
                    .iter()
                    .map(|&position| self.near(format_args!("{key}.positions"), position))
                    .collect::<Result<_, _>>()?,
            },
            ModelName::Blocks => JointModel::Blocks,
            ModelName::Full => JointModel::Full,
        };
        let parametrisation = model.parametrisation();
        parametrisation
            .and_then(|all| match self.motions.are_all() {
                true => Ok(all),
                false => all.within(self.motions),
            })
            .map_err(|source| StudyError::model(self.study.path(), Some(key), source))
    }
}

/// A remark on DOFs of the parts of which the assembly has no function: channels that were renamed or forgotten; with the nodes of the
/// assembly that no part has.
fn unmatched(sides: &[Side; 2], observed: &[Observed], assembly: &FrfSet) -> Option<String> {
    let [a, b] = sides;
    let listed = |all: &[&Dof]| {
        let names: Vec<String> = all.iter().map(|dof| dof.to_string()).collect();
        names.join(", ")
    };
    let mut missing = Vec::new();
    let kinds = [
        (0, "responses", [&a.responses, &b.responses]),
        (1, "references", [&a.references, &b.references]),
    ];
    let mut nodes: Vec<_> = Vec::new();
    for (which, kind, dofs) in kinds {
        let all: Vec<&Dof> = dofs.into_iter().flatten().collect();
        nodes.extend(all.iter().map(|dof| dof.node()));
        let without: Vec<&Dof> = (0..all.len())
            .filter(|&place| observed.iter().all(|one| one.at[which] != place))
            .map(|place| all[place])
            .collect();
        if !without.is_empty() {
            missing.push(format!("{kind} {}", listed(&without)));
        }
    }
    if missing.is_empty() {
        return None;
    }
    let foreign: BTreeSet<_> = assembly
        .functions()
        .flat_map(|(response, reference, _)| [response.node(), reference.node()])
        .filter(|node| !nodes.contains(node))
        .collect();
    let foreign: Vec<String> = foreign.iter().map(ToString::to_string).collect();
    let of_others = match foreign.is_empty() {
        true => String::new(),
        false => format!("; its nodes {} are of no part", foreign.join(", ")),
    };
    Some(format!(
        "assembly.frf: no function with the {} of the parts{of_others}: points have one number in all files",
        missing.join(", nor with the ")
    ))
}

/// Keys of a joint that only some models have: the key, whether it is there, and the models.
fn keys_of_models(table: &JointTable) -> [(&'static str, bool, &'static [ModelName]); 5] {
    use ModelName::{Bolt, BoltCircle, Bolts, TwoBolts};
    [
        (
            "axis",
            table.axis.is_some(),
            &[Bolt, TwoBolts, BoltCircle, Bolts],
        ),
        ("line", table.line.is_some(), &[TwoBolts]),
        ("bolts", table.bolts.is_some(), &[BoltCircle]),
        ("positions", table.positions.is_some(), &[Bolts]),
        ("twisted", table.twisted, &[Bolt, TwoBolts, BoltCircle]),
    ]
}

/// As the study has it.
pub(crate) fn model_name(model: ModelName) -> &'static str {
    match model {
        ModelName::Translations => "translations",
        ModelName::Diagonal => "diagonal",
        ModelName::Bolt => "bolt",
        ModelName::TwoBolts => "two-bolts",
        ModelName::BoltCircle => "bolt-circle",
        ModelName::Bolts => "bolts",
        ModelName::Blocks => "blocks",
        ModelName::Full => "full",
    }
}
