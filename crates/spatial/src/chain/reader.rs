//! Reads the parts and joints of a chain, and what a plan may add to its test.

use std::path::Path;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::ModalModel;
use bolted_joint_joint::JointFile;
use bolted_joint_space::{Dof as Motion, Motions};
use bolted_joint_study::{FrequencyTable, LineChoice, StudyError};
use bolted_joint_virtual_point::Impact;
use nalgebra::Matrix6;

use super::beam::computed;
use super::part::{Part, PartInterface, Source};
use super::plan::candidates::{Candidate, Thing};
use super::response::Scatter;
use crate::coherence::Told;
use crate::functions::{FileOfFunctions, Measured};
use crate::links::{Link, Numbers};
use crate::study::{FARTHEST_M, Reader};
use crate::tables::{
    CandidatesTable, ExpectedTable, ImpactTable, JointTable, MatricesTable, PartTable, SensorTable,
};

/// Lines of a study where no file of functions has any, at most.
const MOST_LINES: f64 = 1e5;

/// Coupling of a known joint between the motions of a study and others, in parts of what it holds, that is none.
const UNCOUPLED: f64 = 1e-6;

/// Length of a joint that is known and has no rotations: it scales nothing.
const ANY_LENGTH_M: f64 = 1.0;

/// K and C of a joint file, and how far they scatter.
pub(super) struct Known {
    pub(super) matrices: [Matrix6<f64>; 2],
    pub(super) scatter: Option<Scatter>,
}

impl Reader<'_> {
    /// The parts, without a gap.
    pub(super) fn chain<'t>(
        &self,
        tables: [(&'static str, Option<&'t PartTable>); 6],
    ) -> Result<Vec<(&'static str, &'t PartTable)>, StudyError> {
        let there: Vec<_> = tables
            .iter()
            .filter_map(|&(name, table)| Some((name, table?)))
            .collect();
        for (n, (name, table)) in there.iter().enumerate() {
            self.study.ensure(
                *name == tables[n].0,
                name,
                format_args!("it without [{}]", tables[n].0),
                "parts that are named a, b, c and so on along the chain",
            )?;
            let is_inner = n > 0 && n + 1 < there.len();
            let (found, expected) = match is_inner {
                true => (
                    "nothing",
                    "the interface to the next part: interface, or sensors and impacts",
                ),
                false => (
                    "an interface",
                    "none: the first and the last part of a chain have one interface",
                ),
            };
            let key = format_args!("{name}.far").to_string();
            self.study
                .ensure(table.far.is_some() == is_inner, key, found, expected)?;
        }
        Ok(there)
    }

    pub(super) fn source(
        &self,
        name: &str,
        table: &PartTable,
        lines: &LineChoice,
        assumed: &mut Vec<String>,
    ) -> Result<(Source, Option<Told>), StudyError> {
        self.study.beside_functions_only(
            name,
            table.frf.is_some(),
            &[
                ("quantity", "a quantity", table.quantity.is_some()),
                ("units", "units", table.units.is_some()),
                ("averages", "averages", table.averages.is_some()),
                ("coherence", "a file", table.coherence.is_some()),
            ],
        )?;
        match (&table.frf, &table.modal, &table.beam) {
            (Some(paths), None, None) => {
                let file = FileOfFunctions {
                    paths,
                    coherence: table.coherence.as_ref(),
                    averages: table.averages,
                    quantity: table.quantity,
                    units: table.units.as_ref(),
                };
                let read = self.functions(name, &file, lines)?;
                assumed.extend(read.assumed);
                let Measured { set, told } = read.measured;
                Ok((Source::Functions(set), told))
            }
            (None, Some(path), None) => {
                let model = ModalModel::read(&self.study.resolved(path));
                Ok((Source::Modes(model.map_err(StudyError::of_file)?), None))
            }
            (None, None, Some(beam)) => {
                self.plausible(name, beam)?;
                let model = computed(beam).modal();
                let refused = |source| StudyError::model(self.study.path(), Some(name), source);
                Ok((Source::Modes(model.map_err(refused)?), None))
            }
            (None, None, None) => self.study.refuse(
                name,
                "none of frf, modal and beam",
                "one of them: a file of functions, one of modes, or a beam to be computed",
            ),
            _ => self.study.refuse(
                name,
                "several of frf, modal and beam",
                "one of them: a file of functions, one of modes, or a beam to be computed",
            ),
        }
    }

    /// Lines of a study without functions.
    pub(super) fn lines(
        &self,
        table: &FrequencyTable,
        step_hz: Option<f64>,
    ) -> Result<Vec<f64>, StudyError> {
        let what = "no part has a file of functions, whose lines would be used";
        let (Some(from_hz), Some(to_hz)) = (table.from, table.to) else {
            return self.study.refuse(
                "frequency",
                format_args!("no lines: {what}"),
                "`from` and `to` in Hz",
            );
        };
        let Some(step_hz) = step_hz else {
            return self.study.refuse(
                "frequency",
                format_args!("from {from_hz} to {to_hz} Hz alone, and {what}"),
                "the distance between lines in Hz as well: `--step` at the command line, such as `--step 1`",
            );
        };
        let count = ((to_hz - from_hz) / step_hz + 1e-9).floor() + 1.0;
        self.study.ensure(
            step_hz.is_finite() && step_hz > 0.0 && (2.0..MOST_LINES).contains(&count),
            "frequency",
            format_args!("{from_hz} to {to_hz} Hz in steps of {step_hz} Hz"),
            "two lines or more, and at most a hundred thousand",
        )?;
        Ok((0..count as u64)
            .map(|line| from_hz + step_hz * line as f64)
            .collect())
    }

    pub(super) fn part(
        &self,
        name: &str,
        table: &PartTable,
        (source, told): (Source, Option<Told>),
        is_measured: bool,
    ) -> Result<Part, StudyError> {
        // of the first part towards the second one, of the others towards the one before
        let mut interfaces = vec![self.interface(
            name,
            table.interface,
            &table.sensors,
            &table.impacts,
            is_measured,
        )?];
        if let Some(far) = &table.far {
            let name = format!("{name}.far");
            interfaces.push(self.interface(
                &name,
                far.interface,
                &far.sensors,
                &far.impacts,
                is_measured,
            )?);
        }
        Ok(Part {
            name: name.to_owned(),
            source,
            // a plan goes by the noise that is to be expected
            told: told.filter(|_| is_measured),
            interfaces,
            beside: None,
            responses: self.dofs(&format!("{name}.responses"), &table.responses)?,
            references: self.dofs(&format!("{name}.references"), &table.references)?,
        })
    }

    pub(super) fn dofs(&self, key: &str, list: &[String]) -> Result<Vec<Dof>, StudyError> {
        let of = |(place, text): (usize, &String)| self.dof(format_args!("{key}[{place}]"), text);
        list.iter().enumerate().map(of).collect()
    }

    pub(super) fn interface(
        &self,
        name: &str,
        node: Option<u32>,
        sensors: &[SensorTable],
        impacts: &[ImpactTable],
        is_measured: bool,
    ) -> Result<PartInterface, StudyError> {
        let has_places = !(sensors.is_empty() && impacts.is_empty());
        if let Some(node) = node.filter(|_| is_measured && has_places) {
            return self.study.refuse(
                format_args!("{name}.interface"),
                format_args!("{node} beside sensors or impacts"),
                "either the node whose motions are the interface's, or sensors and impacts near it",
            );
        }
        let sensors = sensors
            .iter()
            .enumerate()
            .map(|(place, sensor)| self.sensor(&format!("{name}.sensors[{place}]"), sensor));
        let impacts = impacts
            .iter()
            .enumerate()
            .map(|(place, impact)| self.impact(&format!("{name}.impacts[{place}]"), impact));
        Ok(PartInterface {
            name: name.to_owned(),
            node,
            motions: self.motions,
            sensors: sensors.collect::<Result<_, _>>()?,
            impacts: impacts.collect::<Result<_, _>>()?,
        })
    }

    pub(super) fn impact(
        &self,
        key: &str,
        table: &ImpactTable,
    ) -> Result<(Dof, Impact), StudyError> {
        let dof = self.dof(format_args!("{key}.dof"), &table.dof)?;
        let direction = self.direction(key, dof, table.direction)?;
        let impact = Impact::new(self.near(key, table.position)?, direction, 1.0);
        let refused = |source| StudyError::model(self.study.path(), Some(key), source);
        Ok((dof, impact.map_err(refused)?))
    }

    pub(super) fn candidates(
        &self,
        table: &CandidatesTable,
        parts: &[Part],
    ) -> Result<Vec<Candidate>, StudyError> {
        let names: Vec<&str> = parts
            .iter()
            .flat_map(|part| part.interfaces.iter().map(|own| own.name.as_str()))
            .collect();
        let check = |key: &str, to: &str| {
            self.study.ensure(
                names.contains(&to),
                format_args!("{key}.to"),
                format_args!("{to:?}"),
                format_args!("an interface of the study: {}", names.join(", ")),
            )
        };
        let mut all = Vec::new();
        for (n, one) in table.sensors.iter().enumerate() {
            let key = format!("candidates.sensors[{n}]");
            check(&key, &one.to)?;
            let own = SensorTable {
                node: one.node,
                dof: one.dof.clone(),
                position: one.position,
                axes: one.axes,
                direction: one.direction,
            };
            let (dofs, sensor) = self.sensor(&key, &own)?;
            all.push(Candidate {
                to: one.to.clone(),
                position_m: one.position,
                key: Some(key),
                thing: Thing::Sensor(dofs, sensor),
            });
        }
        for (n, one) in table.impacts.iter().enumerate() {
            let key = format!("candidates.impacts[{n}]");
            check(&key, &one.to)?;
            let own = ImpactTable {
                dof: one.dof.clone(),
                position: one.position,
                direction: one.direction,
            };
            let (dof, impact) = self.impact(&key, &own)?;
            all.push(Candidate {
                to: one.to.clone(),
                position_m: one.position,
                key: Some(key),
                thing: Thing::Impact(dof, impact),
            });
        }
        self.study.ensure(
            !all.is_empty(),
            "candidates",
            "none",
            "sensors or impacts, or no such table: then some are proposed",
        )?;
        Ok(all)
    }

    /// A joint, sought or known.
    pub(super) fn link(
        &self,
        key: &str,
        table: &JointTable,
    ) -> Result<(Link, Option<Scatter>), StudyError> {
        let mut scatter = None;
        let length = table.length.map(|length| {
            let key = format_args!("{key}.length");
            let expected = "about the size of the interface in m, such as 0.03";
            let length = self.study.positive(key, length, expected)?;
            self.study.ensure(
                length <= FARTHEST_M,
                key,
                length,
                format_args!("{expected}, at most {FARTHEST_M} m (is it in millimetres?)"),
            )?;
            Ok::<f64, StudyError>(length)
        });
        let length_m = length.transpose()?;
        let numbers = match (&table.known, table.model) {
            (Some(path), None) => {
                let known = self.joint_file(&format!("{key}.known"), path)?;
                scatter = known.scatter;
                Numbers::Known(Box::new(known.matrices))
            }
            (None, Some(model)) => Numbers::Unknown(self.model(key, model, table)?),
            (known, _) => {
                let found = if known.is_some() {
                    "known beside model"
                } else {
                    "neither model nor known"
                };
                return self.study.refuse(
                    key,
                    found,
                    "model of a joint that is sought, or known = \"NAME.joint.json\"",
                );
            }
        };
        let length_m = match (&numbers, length_m) {
            (_, Some(length_m)) => length_m,
            // √(rotations/translations)
            (Numbers::Known(matrices), None) => {
                let [stiffness, _] = matrices.as_ref();
                let trace = |from: usize| (from..from + 3).map(|i| stiffness[(i, i)]).sum::<f64>();
                let length_m = (trace(3) / trace(0)).sqrt();
                if length_m.is_finite() && length_m > 0.0 {
                    length_m
                } else {
                    ANY_LENGTH_M
                }
            }
            (Numbers::Unknown(_), None) => self.study.needed(
                format_args!("{key}.length"),
                None,
                "about the size of the interface in m, such as 0.03",
            )?,
        };
        let link = Link {
            key: key.to_owned(),
            length_m,
            motions: self.motions,
            is_placed: numbers.are_placed(self.motions),
            numbers,
        };
        Ok((link, scatter))
    }

    /// What a joint that is sought is taken to be.
    pub(super) fn expected(
        &self,
        key: &str,
        table: &JointTable,
    ) -> Result<Option<Known>, StudyError> {
        let key = format!("{key}.expected");
        Ok(match &table.expected {
            None => None,
            Some(ExpectedTable::File(path)) => Some(self.joint_file(&key, path)?),
            Some(ExpectedTable::Matrices(own)) => {
                let MatricesTable { stiffness, damping } = own;
                let matrices = [
                    self.stated(&format!("{key}.stiffness"), stiffness)?,
                    self.stated(&format!("{key}.damping"), damping)?,
                ];
                Some(Known {
                    matrices: self.between_motions(&key, matrices)?,
                    scatter: None,
                })
            }
        })
    }

    /// A matrix with a row and a column for each motion of the study, or for all six.
    fn stated(&self, key: &str, rows: &[Vec<f64>]) -> Result<Matrix6<f64>, StudyError> {
        let own = match rows.len() {
            6 => Motions::ALL,
            _ => self.motions,
        };
        let count = own.count();
        self.study.ensure(
            rows.len() == count && rows.iter().all(|row| row.len() == count),
            key,
            format_args!("{} rows", rows.len()),
            format_args!("{count} rows of {count} numbers each, for the motions {own}"),
        )?;
        let mut matrix = Matrix6::zeros();
        for (row, i) in rows.iter().zip(own.rows()) {
            for (number, j) in row.iter().zip(own.rows()) {
                matrix[(i, j)] = *number;
            }
        }
        Ok(matrix)
    }

    /// K and C of a joint file, in six motions.
    pub(super) fn joint_file(&self, key: &str, path: &Path) -> Result<Known, StudyError> {
        let file = JointFile::read(&self.study.resolved(path)).map_err(StudyError::of_file)?;
        let file = file
            .at_preload(None)
            .map_err(|source| StudyError::model(self.study.path(), Some(key), source))?;
        let dofs = file.joint.dofs;
        self.study.ensure(
            dofs.is_in_space() || self.are_of_a_beam_along_x(),
            key,
            format_args!("a joint with {dofs}"),
            "one in space, with some of x, y, z, rx, ry, rz; one in a plane is for motions = [\"y\", \"rz\"]",
        )?;
        // the slope of a beam along x is its rotation about z
        let name = |name| match name {
            "theta" => Motion::Rz.symbol(),
            name => name,
        };
        let names: Vec<&str> = dofs.names().into_iter().map(name).collect();
        let place = |dof: Motion| names.iter().position(|name| *name == dof.symbol());
        let of = |rows: &[Vec<f64>]| {
            Matrix6::from_fn(|i, j| {
                let at = place(Motion::ALL[i]).zip(place(Motion::ALL[j]));
                at.map_or(0.0, |(row, column)| rows[row][column])
            })
        };
        Ok(Known {
            matrices: self
                .between_motions(key, [of(&file.joint.stiffness), of(&file.joint.damping)])?,
            scatter: file
                .uncertainty
                .as_ref()
                .and_then(|own| Scatter::of(own, &names)),
        })
    }
    /// Whether the interfaces move as the end of a beam along x that bends along y, and no further but along it.
    fn are_of_a_beam_along_x(&self) -> bool {
        let has = |dof| self.motions.has(dof);
        let has_others = [Motion::Z, Motion::Rx, Motion::Ry].into_iter().any(has);
        has(Motion::Y) && has(Motion::Rz) && !has_others
    }

    /// What of a known joint's K and C is between the motions of the study, where it couples these to no others.
    fn between_motions(
        &self,
        key: &str,
        matrices: [Matrix6<f64>; 2],
    ) -> Result<[Matrix6<f64>; 2], StudyError> {
        for matrix in &matrices {
            let coupling = self.motions.coupling_to_others(matrix);
            self.study.ensure(
                coupling <= UNCOUPLED,
                key,
                format_args!(
                    "a joint that couples {} to other motions, by {:.2} % of what it holds",
                    self.motions,
                    100.0 * coupling
                ),
                "one with the plane as a mirror plane, or a study with all motions that it couples",
            )?;
        }
        Ok(matrices.map(|matrix| self.motions.part(&matrix)))
    }
}
