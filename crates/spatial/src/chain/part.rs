//! A structure as a study has it: where its functions come from, and what will be or was measured on it.

use std::fmt::Display;
use std::path::PathBuf;

use bolted_joint_frf::structure::ModalModel;
use bolted_joint_frf::{Dof, FrfSet, Sign};
use bolted_joint_space::Motions;
use bolted_joint_study::{Paths, StudyError, StudyText};
use bolted_joint_virtual_point::{Impact, Places, Role, Sensor, SetUp, VirtualPointError};
use nalgebra::{DMatrix, Vector3};
use num_complex::Complex64;

use crate::side::{Anew, Interface, Placed, Side};
use crate::study::DIRECTIONS;

/// A function below this part of the largest one of its kind is none: nothing moves.
const NOTHING: f64 = 1e-12;

/// Where the functions of a structure come from.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// From a file.
    Functions(FrfSet),
    /// From modes.
    Modes(ModalModel),
}

impl Source {
    pub(crate) fn tells_noise(&self) -> bool {
        matches!(self, Self::Functions(set) if set.tells_noise())
    }
}

/// A structure.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Its table in the study: `a`.
    pub(crate) name: String,
    pub(crate) source: Source,
    /// Whether the coherence of its functions tells their noise, and is used.
    pub(crate) is_told: bool,
    /// In the order of the joints.
    pub(crate) interfaces: Vec<PartInterface>,
    /// Channels and impacts of an interface that is not coupled: they come first among what is measured.
    pub(crate) beside: Option<PartInterface>,
    /// Elsewhere.
    pub(crate) responses: Vec<Dof>,
    pub(crate) references: Vec<Dof>,
}

/// An interface of a structure.
#[derive(Clone, Debug)]
pub(crate) struct PartInterface {
    /// Its table in the study: `b`, `b.far`.
    pub(crate) name: String,
    /// Its node in the functions. With sensors and impacts beside it, these are where a test will have them, and move as the rigid
    /// interface does.
    pub(crate) node: Option<u32>,
    /// The motions that it has.
    pub(crate) motions: Motions,
    pub(crate) sensors: Vec<(Vec<Dof>, Sensor)>,
    pub(crate) impacts: Vec<(Dof, Impact)>,
}

/// A motion or load as a sum of those in the functions, with what it is called.
struct Row {
    dof: Dof,
    of: Vec<(Dof, f64)>,
}

impl Row {
    fn own(dof: Dof) -> Self {
        Self {
            dof,
            of: vec![(dof, 1.0)],
        }
    }

    /// The DOF of the functions that it is.
    fn as_own(&self) -> Option<Dof> {
        match self.of.as_slice() {
            [(dof, 1.0)] => Some(*dof),
            _ => None,
        }
    }
}

impl PartInterface {
    /// The motions of its node.
    fn node_dofs(&self, node: u32) -> Vec<Dof> {
        let directions = self.motions.rows().into_iter().map(|row| DIRECTIONS[row]);
        directions
            .map(|direction| Dof::new(node, direction, Sign::Plus))
            .collect()
    }

    /// From one of its sensors or impacts to another, at most, m.
    pub(crate) fn size_m(&self) -> f64 {
        let sensors = self.sensors.iter().map(|(_, own)| own.position_m());
        let impacts = self.impacts.iter().map(|(_, own)| own.position_m());
        let places: Vec<_> = sensors.chain(impacts).collect();
        let farthest = |one: &Vector3<f64>| {
            let distances = places.iter().map(|other| (other - one).norm());
            distances.fold(0.0, f64::max)
        };
        places.iter().map(farthest).fold(0.0, f64::max)
    }

    /// Its sensors and impacts.
    pub(crate) fn set_up(&self) -> Result<Option<SetUp>, VirtualPointError> {
        if self.sensors.is_empty() && self.impacts.is_empty() && self.node.is_some() {
            return Ok(None);
        }
        let sensors: Vec<_> = self
            .sensors
            .iter()
            .map(|(_, sensor)| sensor.clone())
            .collect();
        let impacts: Vec<_> = self
            .impacts
            .iter()
            .map(|(_, impact)| impact.clone())
            .collect();
        let set_up = SetUp::new(&sensors, &impacts)?;
        Ok(Some(set_up.in_motions(self.motions)))
    }

    /// The same, refused by its key.
    pub(crate) fn checked(&self, study: &StudyText) -> Result<Option<SetUp>, StudyError> {
        let set_up = self.set_up().map_err(|source| {
            let list = if self.sensors.is_empty() {
                "sensors"
            } else {
                "impacts"
            };
            study_model(study, format_args!("{}.{list}", self.name), source)
        })?;
        if let Some(set_up) = &set_up {
            for (role, list) in [(Role::Channel, "sensors"), (Role::Impact, "impacts")] {
                self.ensure_all_see(study, set_up.places(role), list)?;
            }
        }
        Ok(set_up)
    }

    /// What has to do with no motion of the interface tells nothing.
    fn ensure_all_see(
        &self,
        study: &StudyText,
        places: &Places,
        list: &str,
    ) -> Result<(), StudyError> {
        for (place, mut rows) in places.rows_of_each().into_iter().enumerate() {
            let sees = |row: usize| places.matrix().row(row).iter().any(|own| *own != 0.0);
            let expected = format_args!(
                "sensors and impacts that have to do with {}; of a triaxial sensor state these channels as sensors with a dof",
                self.motions
            )
            .to_string();
            let key = format_args!("{}.{list}[{place}]", self.name).to_string();
            study.ensure(
                rows.all(sees),
                key,
                "a direction that none of the motions has",
                expected,
            )?;
        }
        Ok(())
    }

    /// Whether an impact has to do with any of its motions.
    pub(crate) fn is_moved(&self, impact: &Impact) -> Result<bool, VirtualPointError> {
        let places = Places::impacts(std::slice::from_ref(impact))?;
        let places = places.in_motions(self.motions);
        Ok(places.matrix().iter().any(|own| *own != 0.0))
    }

    /// Its responses and its references.
    pub(crate) fn counts(&self) -> [usize; 2] {
        match (&self.sensors[..], &self.impacts[..]) {
            ([], []) => [self.motions.count(); 2],
            (sensors, impacts) => [
                sensors.iter().map(|(dofs, _)| dofs.len()).sum(),
                impacts.len(),
            ],
        }
    }

    fn rows(&self, set_up: Option<&SetUp>, role: Role) -> Vec<Row> {
        let Some(set_up) = set_up else {
            let dofs = self.node.map(|node| self.node_dofs(node));
            return dofs.into_iter().flatten().map(Row::own).collect();
        };
        let dofs: Vec<Dof> = match role {
            Role::Channel => self
                .sensors
                .iter()
                .flat_map(|(dofs, _)| dofs.clone())
                .collect(),
            Role::Impact => self.impacts.iter().map(|(dof, _)| *dof).collect(),
        };
        let Some(node) = self.node else {
            return dofs.into_iter().map(Row::own).collect();
        };
        // as the rigid interface moves
        let matrix = set_up.places(role).matrix();
        let row = |(n, dof): (usize, Dof)| Row {
            dof,
            of: self
                .node_dofs(node)
                .into_iter()
                .zip(self.motions.rows())
                .map(|(own, motion)| (own, matrix[(n, motion)]))
                .collect(),
        };
        dofs.into_iter().enumerate().map(row).collect()
    }

    /// A node whose functions are zero in some motion is one of a structure in a plane.
    fn ensure_moves(
        &self,
        study: &StudyText,
        responses: &[Dof],
        references: &[Dof],
        functions: &[Vec<Vec<Complex64>>],
    ) -> Result<(), StudyError> {
        let Some(node) = self.node else {
            return Ok(());
        };
        let own: Vec<(Dof, f64)> = (self.node_dofs(node).into_iter())
            .map(|dof| {
                let place = |all: &[Dof]| all.iter().position(|one| *one == dof);
                let largest = place(responses)
                    .zip(place(references))
                    .map(|(row, column)| {
                        let sizes = functions[row][column].iter().map(|value| value.norm());
                        sizes.fold(0.0, f64::max)
                    });
                (dof, largest.unwrap_or(0.0))
            })
            .collect();
        let largest_like = |dof: &Dof| {
            let alike = own.iter().filter(|(other, _)| {
                other.direction().is_translation() == dof.direction().is_translation()
            });
            alike.fold(0.0, |largest, (_, size)| f64::max(largest, *size))
        };
        let held: Vec<String> = own
            .iter()
            .filter(|(dof, size)| *size <= NOTHING * largest_like(dof))
            .map(|(dof, _)| dof.to_string())
            .collect();
        study.ensure(
            held.is_empty(),
            format_args!("{}.interface", self.name),
            format_args!("functions of {} that are zero", held.join(", ")),
            "a structure that moves in space; a test in a plane says motions = [\"y\", \"rz\"], or takes method \"frf-decoupling\"",
        )
    }
}

impl Part {
    /// Its responses and its references.
    pub(crate) fn counts(&self) -> [usize; 2] {
        let elsewhere = [self.responses.len(), self.references.len()];
        let interfaces = self.interfaces.iter().chain(&self.beside);
        interfaces.fold(elsewhere, |sum, own| {
            let own = own.counts();
            [0, 1].map(|n| sum[n] + own[n])
        })
    }

    /// The structure as a side of its own.
    pub(crate) fn side(&self, study: &StudyText, frequency_hz: &[f64]) -> Result<Side, StudyError> {
        let (mut rows, mut columns, mut interfaces) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(own) = &self.beside {
            let set_up = own.checked(study)?;
            rows.extend(own.rows(set_up.as_ref(), Role::Channel));
            columns.extend(own.rows(set_up.as_ref(), Role::Impact));
        }
        for own in &self.interfaces {
            let set_up = own.checked(study)?;
            let first = [rows.len(), columns.len()];
            rows.extend(own.rows(set_up.as_ref(), Role::Channel));
            columns.extend(own.rows(set_up.as_ref(), Role::Impact));
            interfaces.push(Placed {
                name: own.name.clone(),
                first,
                interface: set_up.map_or(Interface::Node(own.motions), Interface::Points),
                seen: None,
                struck: None,
            });
        }
        rows.extend(self.responses.iter().copied().map(Row::own));
        columns.extend(self.references.iter().copied().map(Row::own));
        let side = Side {
            responses: rows.iter().map(|row| row.dof).collect(),
            references: columns.iter().map(|row| row.dof).collect(),
            lines: self.lines(study, &rows, &columns, frequency_hz)?,
            noise: self.noise(&rows, &columns).unwrap_or_default(),
            interfaces,
            anew: Anew::default(),
        };
        // what the places do not see is told at once
        let none = vec![0.0; side.parameters().len()];
        side.transformations(&none)
            .map_err(|refused| study_model(study, refused.name, refused.source))?;
        Ok(side)
    }

    /// Deviation of the noise of each function at each line, where coherence tells that of all.
    fn noise(&self, rows: &[Row], columns: &[Row]) -> Option<Vec<DMatrix<f64>>> {
        let Source::Functions(set) = &self.source else {
            return None;
        };
        if !self.is_told {
            return None;
        }
        let own = |rows: &[Row]| rows.iter().map(Row::as_own).collect::<Option<Vec<Dof>>>();
        let (responses, references) = (own(rows)?, own(columns)?);
        let functions = references.iter().flat_map(|&reference| {
            let of = move |&response: &Dof| set.noise_deviations(response, reference);
            responses.iter().map(of)
        });
        let functions = functions.collect::<Option<Vec<_>>>()?;
        let lines = functions.first().map_or(0, Vec::len);
        let at = |line: usize| {
            let of_line = functions.iter().map(|own| own[line]);
            DMatrix::from_iterator(responses.len(), references.len(), of_line)
        };
        Some((0..lines).map(at).collect())
    }

    fn lines(
        &self,
        study: &StudyText,
        rows: &[Row],
        columns: &[Row],
        frequency_hz: &[f64],
    ) -> Result<Vec<DMatrix<Complex64>>, StudyError> {
        let [(responses, r_u), (references, r_f)] = [rows, columns].map(by_dofs);
        let mut functions = Vec::new();
        for &response in &responses {
            let mut row = Vec::new();
            for &reference in &references {
                row.push(self.receptance(study, response, reference, frequency_hz)?);
            }
            functions.push(row);
        }
        let lines: Vec<DMatrix<Complex64>> = (0..frequency_hz.len())
            .map(|line| {
                let base = DMatrix::from_fn(responses.len(), references.len(), |i, j| {
                    functions[i][j][line]
                });
                &r_u * base * r_f.transpose()
            })
            .collect();
        for own in self.interfaces.iter().chain(&self.beside) {
            own.ensure_moves(study, &responses, &references, &functions)?;
        }
        Ok(lines)
    }

    fn receptance(
        &self,
        study: &StudyText,
        response: Dof,
        reference: Dof,
        frequency_hz: &[f64],
    ) -> Result<Vec<Complex64>, StudyError> {
        let node = self.interfaces.iter().chain(&self.beside).find(|own| {
            let of_node = |dof: Dof| own.node == Some(dof.node());
            of_node(response) || of_node(reference)
        });
        let explained = |source: &dyn Display| {
            match node {
            Some(own) => study.refusal(
                format_args!("{}.interface", own.name),
                source,
                format_args!(
                    "functions between its motions {}; a test in a plane says motions = [\"y\", \"rz\"], or takes method \"frf-decoupling\"",
                    own.motions
                ),
            ),
            None => study.refusal(&self.name, source, "functions between all sensors and impacts"),
        }
        };
        match &self.source {
            Source::Functions(set) => match set.receptance(response, reference) {
                Ok(found) => Ok(at_lines(found.values(), set.frequency_hz(), frequency_hz)),
                Err(source) if node.is_some() => Err(explained(&source)),
                Err(source) => Err(study_model(
                    study,
                    format_args!("{}.frf", self.name),
                    source,
                )),
            },
            Source::Modes(modes) => match modes.receptance(response, reference, frequency_hz) {
                Ok(values) => Ok(values),
                Err(source) if node.is_some() => Err(explained(&source)),
                Err(source) => Err(study_model(
                    study,
                    format_args!("{}.modal", self.name),
                    source,
                )),
            },
        }
    }
}

/// The values at some of the lines.
fn at_lines(values: &[Complex64], all_hz: &[f64], frequency_hz: &[f64]) -> Vec<Complex64> {
    if all_hz.len() == frequency_hz.len() {
        return values.to_vec();
    }
    let nearest = |&wanted: &f64| {
        let after = all_hz.partition_point(|&own| own < wanted);
        let distance = |line: &usize| {
            all_hz
                .get(*line)
                .map_or(f64::INFINITY, |own| (own - wanted).abs())
        };
        let lines = [after.saturating_sub(1), after];
        let best = lines
            .into_iter()
            .min_by(|one, other| distance(one).total_cmp(&distance(other)));
        values[best.unwrap_or_default()]
    };
    frequency_hz.iter().map(nearest).collect()
}

/// The DOFs of which rows are sums, and the factors.
fn by_dofs(rows: &[Row]) -> (Vec<Dof>, DMatrix<Complex64>) {
    let mut dofs: Vec<Dof> = Vec::new();
    for (dof, _) in rows.iter().flat_map(|row| &row.of) {
        if !dofs.contains(dof) {
            dofs.push(*dof);
        }
    }
    let mut matrix = DMatrix::zeros(rows.len(), dofs.len());
    for (n, row) in rows.iter().enumerate() {
        for (dof, factor) in &row.of {
            if let Some(place) = dofs.iter().position(|own| own == dof) {
                matrix[(n, place)] += Complex64::from(*factor);
            }
        }
    }
    (dofs, matrix)
}

/// Structures that do not touch each other, as one side.
pub(crate) fn joined(sides: Vec<Side>) -> Side {
    let mut sides = sides.into_iter();
    let none = Side {
        responses: Vec::new(),
        references: Vec::new(),
        lines: Vec::new(),
        noise: Vec::new(),
        interfaces: Vec::new(),
        anew: Anew::default(),
    };
    let mut all = sides.next().unwrap_or(none);
    for mut own in sides {
        let before = [all.responses.len(), all.references.len()];
        for placed in &mut own.interfaces {
            placed.first = [0, 1].map(|n| placed.first[n] + before[n]);
        }
        for (line, own) in all.lines.iter_mut().zip(&own.lines) {
            *line = crate::problem::block_diagonal([line, own]);
        }
        // of a chain's parts it takes no part
        all.noise.clear();
        all.responses.append(&mut own.responses);
        all.references.append(&mut own.references);
        all.interfaces.append(&mut own.interfaces);
    }
    all
}

fn study_model(
    study: &StudyText,
    key: impl Display,
    source: impl std::error::Error + Send + Sync + 'static,
) -> StudyError {
    StudyError::model(study.path(), Some(&key.to_string()), source)
}

/// The files behind the functions of a structure.
pub(crate) fn files_of(table: &crate::tables::PartTable) -> Vec<&PathBuf> {
    let functions = table.frf.iter().flat_map(Paths::iter);
    let coherences = table.coherence.iter().flat_map(Paths::iter);
    functions.chain(coherences).chain(&table.modal).collect()
}
