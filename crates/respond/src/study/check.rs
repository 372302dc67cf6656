//! From tables to a study: everything that can be wrong is said with its key.

use std::path::Path;

use bolted_joint_harmonic::{Harmonics, Observed, Side};
use bolted_joint_joint::{DofSet, JointFile};

use super::super::RespondError;
use super::tables::{
    Direction, DofName, FrequencyTable, HarmonicsTable, Kind, LapTable, OneOrMore, ResponseTable,
    StudyFile, TimeTable,
};
use super::{LoadPlace, Span, Start, StudyLap, Test, Times};

/// More lines or rows than anyone draws.
const MOST_ROWS: usize = 10_000_000;
const HIGHEST: usize = 7;

pub(super) struct Checker<'a> {
    pub(super) path: &'a Path,
}

impl Checker<'_> {
    pub(super) fn refuse(
        &self,
        key: &str,
        found: impl ToString,
        expected: impl ToString,
    ) -> RespondError {
        RespondError::Study {
            path: self.path.to_owned(),
            key: key.to_owned(),
            found: found.to_string(),
            expected: expected.to_string(),
        }
    }

    pub(super) fn name(&self, name: &str) -> Result<(), RespondError> {
        if name.trim().is_empty() || name.contains(['\n', '\r']) {
            return Err(self.refuse("name", format!("{name:?}"), "one line of text"));
        }
        Ok(())
    }

    /// Every kind needs its tables and has no use for others.
    pub(super) fn tables(&self, file: &StudyFile) -> Result<(), RespondError> {
        use Kind::{
            Backbone, ConstantAmplitude, Dwell, FreeDecay, HarmonicBalance, Linear, PhaseResonance,
            SteppedSine, Sweep,
        };
        let kind = file.kind;
        let balanced = [HarmonicBalance, ConstantAmplitude, Backbone, PhaseResonance];
        let of = |kinds: &[Kind]| kinds.contains(&kind);
        for (key, is_there, needed, useful) in [
            (
                "frequency",
                file.frequency.is_some(),
                !of(&[Backbone, PhaseResonance, FreeDecay]),
                false,
            ),
            (
                "load",
                file.load.is_some(),
                !of(&[Backbone, FreeDecay, Linear]),
                of(&[Linear]),
            ),
            (
                "response",
                file.response.is_some(),
                of(&[ConstantAmplitude, Backbone, PhaseResonance]),
                false,
            ),
            ("harmonics", file.harmonics.is_some(), false, of(&balanced)),
            (
                "time",
                file.time.is_some(),
                of(&[Sweep, Dwell, FreeDecay]),
                of(&[SteppedSine]),
            ),
            ("start", file.start.is_some(), of(&[FreeDecay]), false),
        ] {
            if needed && !is_there {
                return Err(self.refuse(key, "nothing", format!("a table, for kind {kind:?}")));
            }
            if is_there && !needed && !useful {
                let expected = format!("no such table: kind {kind:?} has no use for it");
                return Err(self.refuse(key, "a table", expected));
            }
        }
        Ok(())
    }

    pub(super) fn laps(&self, tables: &[LapTable]) -> Result<Vec<StudyLap>, RespondError> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let mut laps: Vec<StudyLap> = Vec::new();
        for table in tables {
            let path = folder.join(&table.joint);
            let file = JointFile::read(&path)?.at_preload(table.preload);
            let file = file.map_err(|source| RespondError::Preload {
                path: path.clone(),
                source,
            })?;
            let is_lap = match file.joint.dofs {
                DofSet::Translation => file.lap::<1>().map(drop),
                DofSet::TranslationRotation => file.lap::<2>().map(drop),
            };
            is_lap.map_err(|source| RespondError::Law {
                path: path.clone(),
                source,
            })?;
            if let Some(first) = laps.first()
                && first.file.joint.dofs != file.joint.dofs
            {
                let expected = format!("{}, as in the first lap", first.file.joint.dofs);
                return Err(self.refuse("lap.joint", file.joint.dofs, expected));
            }
            let name = table.name.clone().unwrap_or_else(|| file.name.clone());
            self.name(&name)?;
            if laps.iter().any(|lap| lap.name == name) {
                return Err(self.refuse("lap.name", format!("{name:?} twice"), "different names"));
            }
            laps.push(StudyLap { name, path, file });
        }
        if laps.is_empty() {
            return Err(self.refuse("lap", "none", "at least one [[lap]] with its joint file"));
        }
        Ok(laps)
    }

    pub(super) fn motions(
        &self,
        names: &[String],
        dofs: DofSet,
    ) -> Result<Vec<Observed>, RespondError> {
        if names.is_empty() {
            return Err(self.refuse("motions", "none", "at least one, such as \"relative.y\""));
        }
        names
            .iter()
            .map(|name| self.motion("motions", name, dofs))
            .collect()
    }

    fn motion(&self, key: &str, name: &str, dofs: DofSet) -> Result<Observed, RespondError> {
        let parts = name.split_once('.');
        let found = parts.and_then(|(place, dof)| {
            let dof = dofs.names().iter().position(|name| *name == dof)?;
            match place {
                "relative" => Some(Observed::Relative(dof)),
                "a" => Some(Observed::Body(Side::A, dof)),
                "b" => Some(Observed::Body(Side::B, dof)),
                _ => None,
            }
        });
        found.ok_or_else(|| {
            let dofs = dofs.names().join(" or ");
            let expected = format!("relative, a or b, a point, and {dofs}, such as \"relative.y\"");
            self.refuse(key, format!("{name:?}"), expected)
        })
    }

    fn positive(&self, key: &str, value: Option<f64>, what: &str) -> Result<f64, RespondError> {
        match value {
            Some(value) if value.is_finite() && value > 0.0 => Ok(value),
            Some(value) => Err(self.refuse(key, value, format!("{what}, a positive number"))),
            None => Err(self.refuse(key, "nothing", format!("{what}, a positive number"))),
        }
    }

    fn positives(
        &self,
        key: &str,
        values: Option<&OneOrMore>,
        what: &str,
    ) -> Result<Vec<f64>, RespondError> {
        let list = values.map(OneOrMore::list).unwrap_or_default();
        if list.is_empty() {
            let expected = format!("{what}: a positive number or a list of them");
            return Err(self.refuse(key, "nothing", expected));
        }
        for &value in &list {
            self.positive(key, Some(value), what)?;
        }
        Ok(list)
    }

    fn span(&self, table: &FrequencyTable) -> Result<Span, RespondError> {
        let from = self.positive("frequency.from", table.from, "the lowest frequency in Hz")?;
        let to = self.positive("frequency.to", table.to, "the highest frequency in Hz")?;
        if table.at.is_some() {
            return Err(self.refuse("frequency.at", "a frequency", "`from` and `to` alone"));
        }
        if from >= to {
            let expected = format!(
                "more than `frequency.from`, {from} Hz; for a test downwards set direction = \"down\""
            );
            return Err(self.refuse("frequency.to", format!("{to} Hz"), expected));
        }
        let ends_hz = match table.direction {
            Direction::Up => [from, to],
            Direction::Down => [to, from],
        };
        Ok(Span { ends_hz })
    }

    fn lines(&self, table: &FrequencyTable, otherwise: usize) -> Result<usize, RespondError> {
        match table.lines.unwrap_or(otherwise) {
            lines if (2..=MOST_ROWS).contains(&lines) => Ok(lines),
            lines => {
                let expected = format!("2 to {MOST_ROWS} frequencies");
                Err(self.refuse("frequency.lines", lines, expected))
            }
        }
    }

    fn no_lines(&self, table: &FrequencyTable) -> Result<(), RespondError> {
        match table.lines {
            None => Ok(()),
            Some(lines) => {
                let expected = "nothing: this kind chooses its own points";
                Err(self.refuse("frequency.lines", lines, expected))
            }
        }
    }

    fn harmonics(&self, table: Option<&HarmonicsTable>) -> Result<Harmonics, RespondError> {
        let highest = table.and_then(|table| table.highest).unwrap_or(HIGHEST);
        let harmonics = match table.is_some_and(|table| table.even) {
            true => Harmonics::all(highest),
            false => Harmonics::odd(highest),
        };
        harmonics.map_err(|_| {
            let expected = format!("1 to {}", Harmonics::MOST);
            self.refuse("harmonics.highest", highest, expected)
        })
    }

    fn times(&self, table: Option<&TimeTable>) -> Result<Times, RespondError> {
        let duration = table.and_then(|table| table.duration);
        let duration_s = self.positive("time.duration", duration, "a duration in s")?;
        let interval = table.and_then(|table| table.interval);
        let interval_s = self.positive("time.interval", interval, "the time between rows in s")?;
        if duration_s / interval_s > MOST_ROWS as f64 {
            let expected = format!("an interval that makes at most {MOST_ROWS} rows");
            return Err(self.refuse("time.interval", interval_s, expected));
        }
        if table.is_some_and(|table| table.settle.is_some()) {
            let expected = "nothing: it belongs to kind SteppedSine";
            return Err(self.refuse("time.settle", "a number", expected));
        }
        Ok(Times {
            duration_s,
            interval_s,
            steps_per_period: self.steps(table)?,
        })
    }

    fn steps(&self, table: Option<&TimeTable>) -> Result<Option<f64>, RespondError> {
        match table.and_then(|table| table.steps_per_period) {
            None => Ok(None),
            Some(steps) if (4.0..=1e6).contains(&steps) => Ok(Some(steps)),
            Some(steps) => Err(self.refuse("time.steps_per_period", steps, "4 to 1000000")),
        }
    }

    fn amplitudes(&self, table: &ResponseTable) -> Result<[f64; 2], RespondError> {
        let from = self.positive("response.from", table.from, "the smallest amplitude")?;
        let to = self.positive("response.to", table.to, "the largest amplitude")?;
        if table.amplitude.is_some() {
            let expected = "`from` and `to` alone: this kind follows the amplitude";
            return Err(self.refuse("response.amplitude", "a number", expected));
        }
        if from >= to {
            let expected = format!("more than `response.from`, {from}");
            return Err(self.refuse("response.to", to, expected));
        }
        Ok([from, to])
    }

    fn of(&self, table: &ResponseTable, dofs: DofSet) -> Result<Observed, RespondError> {
        match &table.of {
            Some(name) => self.motion("response.of", name, dofs),
            None => Ok(Observed::Relative(0)),
        }
    }

    fn start(
        &self,
        table: &std::collections::BTreeMap<String, f64>,
        dofs: DofSet,
    ) -> Result<Vec<Start>, RespondError> {
        let expected = match dofs {
            DofSet::Translation => "a.y, a.v, b.y or b.v",
            DofSet::TranslationRotation => "a or b, a point, and y, theta, v or omega",
        };
        let one = |(name, &value): (&String, &f64)| {
            let key = format!("start.{name}");
            let parts = name.split_once('.');
            let found = parts.and_then(|(side, state)| {
                let side = match side {
                    "a" => Side::A,
                    "b" => Side::B,
                    _ => return None,
                };
                let (dof, is_velocity) = match state {
                    "y" => (0, false),
                    "v" => (0, true),
                    "theta" => (1, false),
                    "omega" => (1, true),
                    _ => return None,
                };
                (dof < dofs.count()).then_some(Start {
                    side,
                    dof,
                    is_velocity,
                    value,
                })
            });
            match found {
                Some(start) if value.is_finite() => Ok(start),
                Some(_) => Err(self.refuse(&key, value, "a finite number")),
                None => Err(self.refuse("start", format!("{name:?}"), expected)),
            }
        };
        let start: Vec<Start> = table.iter().map(one).collect::<Result<_, _>>()?;
        if start.iter().all(|start| start.value == 0.0) {
            return Err(self.refuse("start", "rest", "a displacement or a velocity"));
        }
        Ok(start)
    }

    pub(super) fn test(&self, file: &StudyFile, dofs: DofSet) -> Result<Test, RespondError> {
        let nothing = |key: &str| self.refuse(key, "nothing", "a table");
        let load = match &file.load {
            Some(table) => {
                let dof = match table.dof {
                    DofName::Y => 0,
                    DofName::Theta => 1,
                };
                if dof >= dofs.count() {
                    let expected = format!("one of the joint's degrees of freedom, {dofs}");
                    return Err(self.refuse("load.dof", "theta", expected));
                }
                LoadPlace {
                    body: table.on.body(),
                    dof,
                }
            }
            None => LoadPlace {
                body: Some(Side::B),
                dof: 0,
            },
        };
        let levels = || {
            let amplitude = file.load.as_ref().and_then(|load| load.amplitude.as_ref());
            self.positives(
                "load.amplitude",
                amplitude,
                "the load's amplitude in N or N·m",
            )
        };
        let no_level = || match file.load.as_ref().and_then(|load| load.amplitude.as_ref()) {
            None => Ok(()),
            Some(_) => {
                let expected = "nothing: the load follows here";
                Err(self.refuse("load.amplitude", "a number", expected))
            }
        };
        let frequency = || file.frequency.as_ref().ok_or_else(|| nothing("frequency"));
        let response = || file.response.as_ref().ok_or_else(|| nothing("response"));
        let time = file.time.as_ref();
        let harmonics = || self.harmonics(file.harmonics.as_ref());
        match file.kind {
            Kind::Linear => {
                no_level()?;
                Ok(Test::Linear {
                    span: self.span(frequency()?)?,
                    lines: self.lines(frequency()?, 1001)?,
                    load,
                })
            }
            Kind::HarmonicBalance => {
                self.no_lines(frequency()?)?;
                Ok(Test::HarmonicBalance {
                    span: self.span(frequency()?)?,
                    load,
                    levels: levels()?,
                    harmonics: harmonics()?,
                })
            }
            Kind::ConstantAmplitude => {
                no_level()?;
                self.no_lines(frequency()?)?;
                let table = response()?;
                if table.from.is_some() || table.to.is_some() {
                    let expected = "`amplitude` alone: this kind holds it";
                    return Err(self.refuse("response.from", "a number", expected));
                }
                let amplitude = table.amplitude.as_ref();
                Ok(Test::ConstantAmplitude {
                    span: self.span(frequency()?)?,
                    load,
                    of: self.of(table, dofs)?,
                    levels: self.positives("response.amplitude", amplitude, "the amplitude")?,
                    harmonics: harmonics()?,
                })
            }
            Kind::Backbone => Ok(Test::Backbone {
                of: self.of(response()?, dofs)?,
                amplitudes: self.amplitudes(response()?)?,
                is_undamped: response()?.undamped,
                harmonics: harmonics()?,
            }),
            Kind::PhaseResonance => {
                no_level()?;
                Ok(Test::PhaseResonance {
                    load,
                    of: self.of(response()?, dofs)?,
                    amplitudes: self.amplitudes(response()?)?,
                    harmonics: harmonics()?,
                })
            }
            Kind::SteppedSine => {
                if time.is_some_and(|time| time.duration.is_some() || time.interval.is_some()) {
                    let expected = "`settle` and `steps_per_period` alone";
                    return Err(self.refuse("time", "`duration` or `interval`", expected));
                }
                let settle = match time.and_then(|time| time.settle) {
                    Some(settle) => {
                        Some(self.positive("time.settle", Some(settle), "a number of periods")?)
                    }
                    None => None,
                };
                Ok(Test::SteppedSine {
                    span: self.span(frequency()?)?,
                    lines: self.lines(frequency()?, 101)?,
                    load,
                    levels: levels()?,
                    settle,
                    steps_per_period: self.steps(time)?,
                })
            }
            Kind::Sweep => {
                self.no_lines(frequency()?)?;
                Ok(Test::Sweep {
                    span: self.span(frequency()?)?,
                    load,
                    levels: levels()?,
                    times: self.times(time)?,
                })
            }
            Kind::Dwell => {
                let table = frequency()?;
                if table.from.is_some() || table.to.is_some() || table.lines.is_some() {
                    let expected = "`at` alone: this kind stays at one frequency";
                    return Err(self.refuse("frequency", "a range", expected));
                }
                Ok(Test::Dwell {
                    frequency_hz: self.positive("frequency.at", table.at, "a frequency in Hz")?,
                    load,
                    levels: levels()?,
                    times: self.times(time)?,
                })
            }
            Kind::FreeDecay => Ok(Test::FreeDecay {
                start: match &file.start {
                    Some(start) => self.start(start, dofs)?,
                    None => return Err(nothing("start")),
                },
                times: self.times(time)?,
            }),
        }
    }
}
