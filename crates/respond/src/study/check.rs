//! From tables to a study: everything that can be wrong is said with its key.

use bolted_joint_dynamics::{Dof, with_dofs};
use bolted_joint_harmonic::{Harmonics, Observed, Side};
use bolted_joint_joint::{DofSet, JointFile};
use bolted_joint_study::{OneOrMore, StudyError, StudyText};

use super::super::RespondError;
use super::tables::{
    Direction, FrequencyTable, HarmonicsTable, Kind, LapTable, ResponseTable, StudyFile, TimeTable,
};
use super::{LoadPlace, Span, Start, StudyLap, Test, Times};

/// More lines or rows than anyone draws.
const MOST_ROWS: usize = 10_000_000;
const HIGHEST: usize = 7;

/// Every kind needs its tables and has no use for others.
pub(super) fn tables(study: &StudyText, file: &StudyFile) -> Result<(), StudyError> {
    use Kind::{
        Backbone, ConstantAmplitude, Dwell, FreeDecay, HarmonicBalance, Hysteresis, Linear,
        PhaseResonance, SteppedSine, Sweep,
    };
    let kind = file.kind;
    let balanced = [HarmonicBalance, ConstantAmplitude, Backbone, PhaseResonance];
    let of = |kinds: &[Kind]| kinds.contains(&kind);
    for (key, is_there, needed, useful) in [
        (
            "frequency",
            file.frequency.is_some(),
            !of(&[Backbone, PhaseResonance, FreeDecay, Hysteresis]),
            of(&[Hysteresis]),
        ),
        (
            "load",
            file.load.is_some(),
            !of(&[Backbone, FreeDecay, Hysteresis, Linear]),
            of(&[Linear]),
        ),
        (
            "response",
            file.response.is_some(),
            of(&[ConstantAmplitude, Backbone, PhaseResonance, Hysteresis]),
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
        let expected = format!("a table, for kind \"{kind}\"");
        study.ensure(is_there || !needed, key, "nothing", expected)?;
        let expected = format!("no such table: kind \"{kind}\" has no use for it");
        study.ensure(!is_there || needed || useful, key, "a table", expected)?;
    }
    Ok(())
}

/// The joints; `have_bodies` where they must have them.
pub(super) fn laps(
    study: &StudyText,
    tables: &[LapTable],
    have_bodies: bool,
) -> Result<Vec<StudyLap>, RespondError> {
    let mut laps: Vec<StudyLap> = Vec::new();
    for table in tables {
        let path = study.resolved(&table.joint);
        let file = JointFile::read(&path)?.at_preload(table.preload);
        let file = file.map_err(|source| StudyError::model(&path, None, source))?;
        let is_there = with_dofs!(file.joint.dofs.size(), D => match have_bodies {
            true => file.lap::<D>().map(drop),
            false => file.joint.law::<D>().map(drop),
        });
        is_there.map_err(|source| StudyError::model(&path, None, source))?;
        let found = file.joint.dofs;
        let first = laps.first().map_or(found, |first| first.file.joint.dofs);
        let expected = format!("{first}, as in the first lap");
        study.ensure(first == found, "lap.joint", found, expected)?;
        let name = table.name.clone().unwrap_or_else(|| file.name.clone());
        study.check_name("lap.name", &name)?;
        let is_new = laps.iter().all(|lap| lap.name != name);
        let found = format!("{name:?} twice");
        study.ensure(is_new, "lap.name", found, "different names")?;
        laps.push(StudyLap { name, path, file });
    }
    let expected = "at least one [[lap]] with its joint file";
    study.ensure(!laps.is_empty(), "lap", "none", expected)?;
    Ok(laps)
}

pub(super) fn motions(
    study: &StudyText,
    names: &[String],
    dofs: DofSet,
) -> Result<Vec<Observed>, StudyError> {
    let expected = "at least one, such as \"relative.y\"";
    study.ensure(!names.is_empty(), "motions", "none", expected)?;
    names
        .iter()
        .map(|name| motion(study, "motions", name, dofs))
        .collect()
}

fn motion(study: &StudyText, key: &str, name: &str, dofs: DofSet) -> Result<Observed, StudyError> {
    let parts = name.split_once('.');
    let found = parts.and_then(|(place, dof)| {
        let dof = dofs.position(dof)?;
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
        study.refusal(key, format!("{name:?}"), expected)
    })
}

fn positive(
    study: &StudyText,
    key: &str,
    value: Option<f64>,
    what: &str,
) -> Result<f64, StudyError> {
    let expected = format!("{what}, a positive number");
    study.positive(key, study.needed(key, value, &expected)?, expected)
}

fn positives(
    study: &StudyText,
    key: &str,
    values: Option<&OneOrMore>,
    what: &str,
) -> Result<Vec<f64>, StudyError> {
    let list = values.map(OneOrMore::list).unwrap_or_default();
    if list.is_empty() {
        let expected = format!("{what}: a positive number or a list of them");
        return study.refuse(key, "nothing", expected);
    }
    for &value in &list {
        positive(study, key, Some(value), what)?;
    }
    Ok(list)
}

fn span(study: &StudyText, table: &FrequencyTable) -> Result<Span, StudyError> {
    let from = positive(
        study,
        "frequency.from",
        table.from,
        "the lowest frequency in Hz",
    )?;
    let to = positive(
        study,
        "frequency.to",
        table.to,
        "the highest frequency in Hz",
    )?;
    let expected = "`from` and `to` alone";
    study.ensure(table.at.is_none(), "frequency.at", "a frequency", expected)?;
    let expected = format!(
        "more than `frequency.from`, {from} Hz; for a test downwards set direction = \"down\""
    );
    study.ensure(from < to, "frequency.to", format_args!("{to} Hz"), expected)?;
    let ends_hz = match table.direction {
        Direction::Up => [from, to],
        Direction::Down => [to, from],
    };
    Ok(Span { ends_hz })
}

fn lines(study: &StudyText, table: &FrequencyTable, otherwise: usize) -> Result<usize, StudyError> {
    let expected = format!("2 to {MOST_ROWS} frequencies");
    study.within(
        "frequency.lines",
        table.lines.unwrap_or(otherwise),
        2..=MOST_ROWS,
        expected,
    )
}

fn no_lines(study: &StudyText, table: &FrequencyTable) -> Result<(), StudyError> {
    let expected = "nothing: this kind chooses its own points";
    let lines = table.lines;
    study.ensure(
        lines.is_none(),
        "frequency.lines",
        lines.unwrap_or_default(),
        expected,
    )
}

/// Harmonics of the motion.
fn harmonics(study: &StudyText, table: Option<&HarmonicsTable>) -> Result<Harmonics, StudyError> {
    let highest = table.and_then(|table| table.highest).unwrap_or(HIGHEST);
    let harmonics = match table.is_some_and(|table| table.even) {
        true => Harmonics::all(highest),
        false => Harmonics::odd(highest),
    };
    harmonics.map_err(|_| {
        let expected = format!("1 to {}", Harmonics::MOST);
        study.refusal("harmonics.highest", highest, expected)
    })
}

fn times(study: &StudyText, table: Option<&TimeTable>) -> Result<Times, StudyError> {
    let duration = table.and_then(|table| table.duration);
    let duration_s = positive(study, "time.duration", duration, "a duration in s")?;
    let interval = table.and_then(|table| table.interval);
    let interval_s = positive(
        study,
        "time.interval",
        interval,
        "the time between rows in s",
    )?;
    let expected = format!("an interval that makes at most {MOST_ROWS} rows");
    let is_few = duration_s / interval_s <= MOST_ROWS as f64;
    study.ensure(is_few, "time.interval", interval_s, expected)?;
    let settles = table.is_some_and(|table| table.settle.is_some());
    let expected = "nothing: it belongs to kind SteppedSine";
    study.ensure(!settles, "time.settle", "a number", expected)?;
    Ok(Times {
        duration_s,
        interval_s,
        steps_per_period: steps(study, table)?,
    })
}

fn steps(study: &StudyText, table: Option<&TimeTable>) -> Result<Option<f64>, StudyError> {
    let steps = table.and_then(|table| table.steps_per_period);
    let check = |steps| study.within("time.steps_per_period", steps, 4.0..=1e6, "4 to 1000000");
    steps.map(check).transpose()
}

fn amplitudes(study: &StudyText, table: &ResponseTable) -> Result<[f64; 2], StudyError> {
    let from = positive(study, "response.from", table.from, "the smallest amplitude")?;
    let to = positive(study, "response.to", table.to, "the largest amplitude")?;
    let expected = "`from` and `to` alone: this kind follows the amplitude";
    let has_one = table.amplitude.is_some();
    study.ensure(!has_one, "response.amplitude", "a number", expected)?;
    let expected = format!("more than `response.from`, {from}");
    study.ensure(from < to, "response.to", to, expected)?;
    Ok([from, to])
}

fn of(study: &StudyText, table: &ResponseTable, dofs: DofSet) -> Result<Observed, StudyError> {
    match &table.of {
        Some(name) => motion(study, "response.of", name, dofs),
        None => Ok(Observed::Relative(0)),
    }
}

fn start(
    study: &StudyText,
    table: &std::collections::BTreeMap<String, f64>,
    dofs: DofSet,
) -> Result<Vec<Start>, StudyError> {
    let expected = states(dofs);
    let one = |(name, &value): (&String, &f64)| {
        let key = format!("start.{name}");
        let parts = name.split_once('.');
        let found = parts.and_then(|(side, state)| {
            let side = match side {
                "a" => Side::A,
                "b" => Side::B,
                _ => return None,
            };
            let is_of = |dof: &Dof| dof.name == state || dof.rate == state;
            let dof = dofs.rows().position(is_of)?;
            Some(Start {
                side,
                dof,
                is_velocity: dofs.row(dof).rate == state,
                value,
            })
        });
        match found {
            Some(start) if value.is_finite() => Ok(start),
            Some(_) => study.refuse(&key, value, "a finite number"),
            None => study.refuse("start", format!("{name:?}"), &expected),
        }
    };
    let start: Vec<Start> = table.iter().map(one).collect::<Result<_, _>>()?;
    let moves = start.iter().any(|start| start.value != 0.0);
    study.ensure(moves, "start", "rest", "a displacement or a velocity")?;
    Ok(start)
}

pub(super) fn test(
    study: &StudyText,
    file: &StudyFile,
    laps: &[StudyLap],
) -> Result<Test, StudyError> {
    let dofs = laps[0].file.joint.dofs;
    let load = match &file.load {
        Some(table) => {
            let name = table.dof.dof().name;
            let dof = dofs.position(name).ok_or_else(|| {
                let expected = format!("one of the joint's degrees of freedom, {dofs}");
                study.refusal("load.dof", name, expected)
            })?;
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
        positives(
            study,
            "load.amplitude",
            amplitude,
            "the load's amplitude in N or N·m",
        )
    };
    let no_level = || {
        let has_one = file
            .load
            .as_ref()
            .is_some_and(|load| load.amplitude.is_some());
        let expected = "nothing: the load follows here";
        study.ensure(!has_one, "load.amplitude", "a number", expected)
    };
    let frequency = || study.needed("frequency", file.frequency.as_ref(), "a table");
    let response = || study.needed("response", file.response.as_ref(), "a table");
    let time = file.time.as_ref();
    let harmonics = || harmonics(study, file.harmonics.as_ref());
    match file.kind {
        Kind::Linear => {
            no_level()?;
            Ok(Test::Linear {
                span: span(study, frequency()?)?,
                lines: lines(study, frequency()?, 1001)?,
                load,
            })
        }
        Kind::HarmonicBalance => {
            no_lines(study, frequency()?)?;
            Ok(Test::HarmonicBalance {
                span: span(study, frequency()?)?,
                load,
                levels: levels()?,
                harmonics: harmonics()?,
            })
        }
        Kind::ConstantAmplitude => {
            no_level()?;
            no_lines(study, frequency()?)?;
            let table = response()?;
            let is_range = table.from.or(table.to).is_some();
            let expected = "`amplitude` alone: this kind holds it";
            study.ensure(!is_range, "response.from", "a number", expected)?;
            let amplitude = table.amplitude.as_ref();
            Ok(Test::ConstantAmplitude {
                span: span(study, frequency()?)?,
                load,
                of: of(study, table, dofs)?,
                levels: positives(study, "response.amplitude", amplitude, "the amplitude")?,
                harmonics: harmonics()?,
            })
        }
        Kind::Backbone => Ok(Test::Backbone {
            of: of(study, response()?, dofs)?,
            amplitudes: amplitudes(study, response()?)?,
            is_undamped: response()?.undamped,
            harmonics: harmonics()?,
        }),
        Kind::PhaseResonance => {
            no_level()?;
            Ok(Test::PhaseResonance {
                load,
                of: of(study, response()?, dofs)?,
                amplitudes: amplitudes(study, response()?)?,
                harmonics: harmonics()?,
            })
        }
        Kind::SteppedSine => {
            let is_history = time.is_some_and(|time| time.duration.or(time.interval).is_some());
            let expected = "`settle` and `steps_per_period` alone";
            study.ensure(!is_history, "time", "`duration` or `interval`", expected)?;
            let settle = time.and_then(|time| time.settle);
            let expected = "a number of periods, a positive number";
            let check = |settle| study.positive("time.settle", settle, expected);
            let settle = settle.map(check).transpose()?;
            Ok(Test::SteppedSine {
                span: span(study, frequency()?)?,
                lines: lines(study, frequency()?, 101)?,
                load,
                levels: levels()?,
                settle,
                steps_per_period: steps(study, time)?,
            })
        }
        Kind::Sweep => {
            no_lines(study, frequency()?)?;
            Ok(Test::Sweep {
                span: span(study, frequency()?)?,
                load,
                levels: levels()?,
                times: times(study, time)?,
            })
        }
        Kind::Dwell => {
            let table = frequency()?;
            let is_range = table.from.or(table.to).is_some() || table.lines.is_some();
            let expected = "`at` alone: this kind stays at one frequency";
            study.ensure(!is_range, "frequency", "a range", expected)?;
            Ok(Test::Dwell {
                frequency_hz: positive(study, "frequency.at", table.at, "a frequency in Hz")?,
                load,
                levels: levels()?,
                times: times(study, time)?,
            })
        }
        Kind::Hysteresis => hysteresis(study, file, dofs),
        Kind::FreeDecay => Ok(Test::FreeDecay {
            start: start(
                study,
                study.needed("start", file.start.as_ref(), "a table")?,
                dofs,
            )?,
            times: times(study, time)?,
        }),
    }
}

fn hysteresis(study: &StudyText, file: &StudyFile, dofs: DofSet) -> Result<Test, StudyError> {
    let response = study.needed("response", file.response.as_ref(), "a table")?;
    let Observed::Relative(dof) = of(study, response, dofs)? else {
        let found = response.of.clone().unwrap_or_default();
        let expected = "a relative motion, such as \"relative.y\"";
        return study.refuse("response.of", format!("{found:?}"), expected);
    };
    let is_range = response.from.or(response.to).is_some();
    let expected = "`amplitude` alone: a loop has one";
    study.ensure(!is_range, "response.from", "a number", expected)?;
    let frequency = file.frequency.as_ref();
    let is_range = frequency.is_some_and(|table| table.from.or(table.to).is_some());
    let expected = "`at` alone: a loop has one frequency";
    study.ensure(!is_range, "frequency", "a range", expected)?;
    if let Some(table) = frequency {
        no_lines(study, table)?;
    }
    let at =
        |table: &FrequencyTable| positive(study, "frequency.at", table.at, "a frequency in Hz");
    let amplitude = response.amplitude.as_ref();
    Ok(Test::Hysteresis {
        dof,
        amplitudes: positives(study, "response.amplitude", amplitude, "the amplitude")?,
        frequency_hz: frequency.map(at).transpose()?,
    })
}

/// The states of a start, for people.
fn states(dofs: DofSet) -> String {
    let names: Vec<&str> = dofs
        .rows()
        .map(|dof| dof.name)
        .chain(dofs.rows().map(|dof| dof.rate))
        .collect();
    match names.as_slice() {
        [name, rate] => format!("a.{name}, a.{rate}, b.{name} or b.{rate}"),
        [others @ .., last] => format!("a or b, a point, and {} or {last}", others.join(", ")),
        [] => String::new(),
    }
}
