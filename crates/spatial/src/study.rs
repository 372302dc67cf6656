//! A study of method `frf-space`, checked, with its functions read.

use std::path::{Path, PathBuf};
use std::str::FromStr as _;

use bolted_joint_frf::{Direction, Dof, FrfSet, ReadOptions, Sign, read_frfs};
use bolted_joint_joint::InputFile;
use bolted_joint_space::{Axes, JointModel, Mirrors};
use bolted_joint_study::{Method, StudyError, StudyText, input_file};
use bolted_joint_virtual_point::{Impact, Sensor, SetUp, Tolerance, Tolerances};
use nalgebra::{DMatrix, Matrix3, Vector3};
use num_complex::Complex64;

use crate::problem::{Level, Observed, Problem};
use crate::side::{Interface, MOTIONS, Side};
use crate::tables::{
    BudgetTable, DeviationsTable, ImpactTable, JointTable, ModelName, NoBudget, NoiseTable,
    SensorTable, SideTable, StudyFile,
};

/// Frequencies that are the same, in parts.
const SAME: f64 = 1e-6;

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
    /// Noise of the functions of a and of b in parts of each value; 0 where they are exact.
    pub noise: [f64; 2],
    pub(crate) problem: Problem,
}

/// Directions along an axis or about it, in the order of an interface's motions.
const DIRECTIONS: [Direction; MOTIONS] = [
    Direction::X,
    Direction::Y,
    Direction::Z,
    Direction::RX,
    Direction::RY,
    Direction::RZ,
];

impl SpatialStudy {
    /// A study from its text, with the files that it names.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, StudyError> {
        let file: StudyFile = study.tables()?;
        study.check_method(file.method, &[Method::FrfSpace])?;
        study.check_name("name", &file.name)?;
        let reader = Reader { study };
        let [from_hz, to_hz] = study.frequency_range_hz(&file.frequency)?;
        let read = |key: &str, path: &Path| reader.functions(key, path, [from_hz, to_hz]);
        let [a, b, assembly] = [
            ("a.frf", &file.a.frf),
            ("b.frf", &file.b.frf),
            ("assembly.frf", &file.assembly.frf),
        ]
        .map(|(key, path)| read(key, path));
        let (a, b, assembly) = (a?, b?, assembly?);
        let frequency_hz = assembly.frequency_hz().to_vec();
        for (key, set) in [("a.frf", &a), ("b.frf", &b)] {
            reader.same_lines(key, set.frequency_hz(), &frequency_hz)?;
        }
        let sides = [
            reader.side("a", &file.a, &a)?,
            reader.side("b", &file.b, &b)?,
        ];
        let observed = reader.observed(&sides, &assembly)?;
        let model = reader.model(&file.joint)?;
        let length_m = study.positive(
            "joint.length",
            file.joint.length,
            "about the size of the interface in m, such as 0.03",
        )?;
        let level = match file.noise.relative {
            None => Level::OfResiduals,
            Some(part) => Level::Relative(study.positive(
                "noise.relative",
                part,
                "noise in parts of each function's r.m.s., such as 0.01",
            )?),
        };
        let noise = reader.noise(&file.noise)?;
        let mut files = vec![study.record()];
        for (role, path) in [
            ("a", &file.a.frf),
            ("b", &file.b.frf),
            ("assembly", &file.assembly.frf),
        ] {
            let path = study.resolved(path);
            files.push(input_file(role, &path, study.folder(), |_, _| {})?);
        }
        Ok(Self {
            path: study.path().to_owned(),
            name: file.name,
            model: name(file.joint.model).to_owned(),
            notes: file.notes,
            files,
            level,
            noise,
            problem: Problem {
                tolerances: reader.tolerances(&file.budget, &sides)?,
                sides,
                frequency_hz,
                observed,
                model,
                length_m,
            },
        })
    }

    /// Functions of the assembly that are compared.
    #[must_use]
    pub fn functions(&self) -> usize {
        self.problem.observed.len()
    }
}

struct Reader<'s> {
    study: &'s StudyText,
}

impl Reader<'_> {
    fn functions(
        &self,
        key: &str,
        path: &Path,
        [from_hz, to_hz]: [f64; 2],
    ) -> Result<FrfSet, StudyError> {
        let path = self.study.resolved(path);
        let reading = read_frfs(&path, &ReadOptions::default()).map_err(StudyError::of_file)?;
        let set = reading.into_set().map_err(StudyError::of_file)?;
        set.restricted_to(from_hz, to_hz)
            .map_err(|source| StudyError::model(self.study.path(), Some(key), source))
    }

    /// Noise of the substructures.
    fn noise(&self, table: &NoiseTable) -> Result<[f64; 2], StudyError> {
        let of = |key: &str, given: Option<f64>| {
            let Some(part) = given else {
                return Ok(0.0);
            };
            self.study.ensure(
                table.relative.is_some(),
                key,
                format_args!("{part} without noise.relative"),
                "the noise of the assembly's functions beside that of the substructures",
            )?;
            let expected =
                "noise in parts of each value, such as 0.01; without the key there is none";
            self.study.positive(key, part, expected)
        };
        Ok([of("noise.a", table.a)?, of("noise.b", table.b)?])
    }

    fn same_lines(&self, key: &str, found: &[f64], expected: &[f64]) -> Result<(), StudyError> {
        let are_same = found.len() == expected.len()
            && found
                .iter()
                .zip(expected)
                .all(|(one, other)| (one - other).abs() <= SAME * other.abs());
        let ends = |all: &[f64]| match (all.first(), all.last()) {
            (Some(first), Some(last)) => format!("{} lines from {first} to {last} Hz", all.len()),
            _ => "no lines".to_owned(),
        };
        self.study.ensure(
            are_same,
            key,
            ends(found),
            format_args!("the lines of assembly.frf, {}", ends(expected)),
        )
    }

    fn side(&self, name: &str, table: &SideTable, set: &FrfSet) -> Result<Side, StudyError> {
        let (mut responses, mut references, interface) = match table.interface {
            Some(node) => {
                let has_places = !(table.sensors.is_empty() && table.impacts.is_empty());
                self.study.ensure(
                    !has_places,
                    format_args!("{name}.interface"),
                    format_args!("{node} beside sensors or impacts"),
                    "either the node whose six motions are the interface's, or sensors and impacts near it",
                )?;
                let dofs = DIRECTIONS.map(|direction| Dof::new(node, direction, Sign::Plus));
                (dofs.to_vec(), dofs.to_vec(), Interface::Node)
            }
            None => self.points(name, table)?,
        };
        for (key, own, more) in [
            ("responses", &mut responses, &table.responses),
            ("references", &mut references, &table.references),
        ] {
            for (place, text) in more.iter().enumerate() {
                own.push(self.dof(format_args!("{name}.{key}[{place}]"), text)?);
            }
        }
        let functions: Vec<Vec<Vec<Complex64>>> = responses
            .iter()
            .map(|&response| {
                let row = references.iter().map(|&reference| {
                    let function = set.receptance(response, reference);
                    function.map(|function| function.values().to_vec())
                });
                row.collect::<Result<Vec<_>, _>>()
            })
            .collect::<Result<_, _>>()
            .map_err(|source| {
                StudyError::model(self.study.path(), Some(&format!("{name}.frf")), source)
            })?;
        let lines = (0..set.line_count())
            .map(|line| {
                DMatrix::from_fn(responses.len(), references.len(), |i, j| {
                    functions[i][j][line]
                })
            })
            .collect();
        Ok(Side {
            responses,
            references,
            lines,
            interface,
        })
    }

    fn points(
        &self,
        name: &str,
        table: &SideTable,
    ) -> Result<(Vec<Dof>, Vec<Dof>, Interface), StudyError> {
        let refused =
            |key: String, source| StudyError::model(self.study.path(), Some(&key), source);
        let (mut responses, mut references) = (Vec::new(), Vec::new());
        let (mut sensors, mut impacts) = (Vec::new(), Vec::new());
        for (place, sensor) in table.sensors.iter().enumerate() {
            let key = format!("{name}.sensors[{place}]");
            let (dofs, sensor) = self.sensor(&key, sensor)?;
            responses.extend(dofs);
            sensors.push(sensor);
        }
        for (place, impact) in table.impacts.iter().enumerate() {
            let key = format!("{name}.impacts[{place}]");
            let ImpactTable {
                dof,
                position,
                direction,
            } = impact;
            let dof = self.dof(format_args!("{key}.dof"), dof)?;
            let direction = self.direction(&key, dof, *direction)?;
            references.push(dof);
            let impact = Impact::new(Vector3::from(*position), direction, 1.0);
            impacts.push(impact.map_err(|source| refused(key, source))?);
        }
        let set_up = SetUp::new(&sensors, &impacts).map_err(|source| {
            let key = match sensors.is_empty() {
                true => format!("{name}.sensors"),
                false => format!("{name}.impacts"),
            };
            refused(key, source)
        })?;
        let side = Side {
            responses,
            references,
            lines: Vec::new(),
            interface: Interface::Points(set_up),
        };
        // what the places do not see is told at once
        let none = vec![0.0; side.parameters().len()];
        side.transformations(&none)
            .map_err(|source| refused(name.to_owned(), source))?;
        Ok((side.responses, side.references, side.interface))
    }

    fn sensor(&self, key: &str, table: &SensorTable) -> Result<(Vec<Dof>, Sensor), StudyError> {
        let position = Vector3::from(table.position);
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

    /// The direction that is given, or that of a DOF in the interface's axes.
    fn direction(
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

    fn dof(&self, key: impl std::fmt::Display, text: &str) -> Result<Dof, StudyError> {
        Dof::from_str(text).map_err(|refused| {
            self.study.refusal(
                key,
                format_args!("{text:?}"),
                format_args!("a DOF such as \"2:+Y\": {refused}"),
            )
        })
    }

    /// Every function of the assembly between rows and columns of the substructures.
    fn observed(&self, sides: &[Side; 2], assembly: &FrfSet) -> Result<Vec<Observed>, StudyError> {
        let mut observed = Vec::new();
        let [a, b] = sides;
        let places = |first: &[Dof], second: &[Dof]| -> Vec<(usize, Dof)> {
            first.iter().chain(second).copied().enumerate().collect()
        };
        let rows = places(&a.responses, &b.responses);
        let columns = places(&a.references, &b.references);
        for &(row, response) in &rows {
            for &(column, reference) in &columns {
                let Ok(function) = assembly.receptance(response, reference) else {
                    continue;
                };
                // the transposed function is another datum only where it was measured
                if function.is_reciprocal() {
                    continue;
                }
                observed.push(Observed {
                    at: [row, column],
                    values: function.values().to_vec(),
                });
            }
        }
        self.study.ensure(
            !observed.is_empty(),
            "assembly.frf",
            "no function between DOFs of a and b",
            "functions between the sensors, impacts, responses and references of [a] and [b]; points have one number in all files",
        )?;
        Ok(observed)
    }

    fn model(&self, table: &JointTable) -> Result<bolted_joint_space::Parametrisation, StudyError> {
        let axis = table.axis.map_or(Vector3::z(), Vector3::from);
        let mirrors = match table.twisted {
            true => Mirrors::Lost,
            false => Mirrors::Kept,
        };
        let model = match table.model {
            ModelName::Translations => JointModel::Translations,
            ModelName::Diagonal => JointModel::Diagonal,
            ModelName::Bolt => JointModel::Bolt { axis, mirrors },
            ModelName::TwoBolts => JointModel::TwoBolts {
                axis,
                line: self
                    .study
                    .needed(
                        "joint.line",
                        table.line,
                        "the direction from one bolt to the other",
                    )?
                    .into(),
                mirrors,
            },
            ModelName::BoltCircle => JointModel::BoltCircle {
                bolts: self
                    .study
                    .needed("joint.bolts", table.bolts, "how many bolts there are")?,
                axis,
                mirrors,
            },
            ModelName::Bolts => JointModel::Bolts {
                axis,
                positions_m: self
                    .study
                    .needed(
                        "joint.positions",
                        table.positions.as_ref(),
                        "a place [x, y, z] in m for each bolt",
                    )?
                    .iter()
                    .map(|&position| Vector3::from(position))
                    .collect(),
            },
            ModelName::Blocks => JointModel::Blocks,
            ModelName::Full => JointModel::Full,
        };
        model
            .parametrisation()
            .map_err(|source| StudyError::model(self.study.path(), Some("joint"), source))
    }

    fn tolerances(
        &self,
        table: &BudgetTable,
        sides: &[Side; 2],
    ) -> Result<Option<Tolerances>, StudyError> {
        let DeviationsTable {
            position,
            rotation,
            gain,
        } = match table {
            BudgetTable::Word(NoBudget::None) => return Ok(None),
            BudgetTable::Deviations(own) => *own,
        };
        let value = |key: &str, given: Option<f64>, typical: f64| {
            let expected =
                "a standard deviation above 0, or budget = \"none\" for a set-up that is exact";
            self.study.positive(
                format_args!("budget.{key}"),
                given.unwrap_or(typical),
                expected,
            )
        };
        let tolerance = Tolerance {
            position_m: value("position", position, Tolerance::TYPICAL.position_m)?,
            rotation_rad: value("rotation", rotation, Tolerance::TYPICAL.rotation_rad)?,
            gain: value("gain", gain, Tolerance::TYPICAL.gain)?,
        };
        let has_places = sides.iter().any(|side| !side.parameters().is_empty());
        Ok(has_places.then_some(Tolerances {
            sensors: tolerance,
            impacts: tolerance,
        }))
    }
}

/// As the study has it.
fn name(model: ModelName) -> &'static str {
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
