//! Reads the parts of a chain, and what a plan may add to its test.

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::ModalModel;
use bolted_joint_study::{FrequencyTable, LineChoice, StudyError};
use bolted_joint_virtual_point::Impact;

use super::beam::computed;
use super::part::{Part, PartInterface, Source};
use super::plan::candidates::{Candidate, Thing};
use crate::functions::FileOfFunctions;
use crate::study::Reader;
use crate::tables::{CandidatesTable, ImpactTable, PartTable, SensorTable};

/// Lines of a study where no file of functions has any, at most.
const MOST_LINES: f64 = 1e5;

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
    ) -> Result<Source, StudyError> {
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
                Ok(Source::Functions(read.set))
            }
            (None, Some(path), None) => {
                let model = ModalModel::read(&self.study.resolved(path));
                Ok(Source::Modes(model.map_err(StudyError::of_file)?))
            }
            (None, None, Some(beam)) => {
                self.plausible(name, beam)?;
                let model = computed(beam).modal();
                let refused = |source| StudyError::model(self.study.path(), Some(name), source);
                Ok(Source::Modes(model.map_err(refused)?))
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
        source: Source,
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
            // a plan goes by the noise that is to be expected
            is_told: is_measured && source.tells_noise(),
            source,
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
}
