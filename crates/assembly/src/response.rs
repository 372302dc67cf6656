//! What `respond` computes of an assembly: receptances, modes, or a history under loads.

use std::f64::consts::TAU;

use bolted_joint_dynamics::assembly::{AssemblySteps, TOLERANCE};
use bolted_joint_study::{StudyError, StudyText};

use crate::error::AssemblyError;
use crate::model::AssemblyModel;
use crate::place::Channel;
use crate::tables::{ResponseKind, ResponseTable};

/// Lines where nothing is said, and more than anybody draws.
const LINES: usize = 1000;
const MOST_LINES: usize = 1_000_000;
/// More steps than anybody waits for.
const MOST_STEPS: f64 = 1e7;

/// Frequencies, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// First and last frequency, Hz.
    pub ends_hz: [f64; 2],
    /// How many.
    pub lines: usize,
}

impl Span {
    /// The frequencies, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> Vec<f64> {
        let [from, to] = self.ends_hz;
        let last = (self.lines.max(2) - 1) as f64;
        (0..self.lines)
            .map(|line| from + (to - from) * line as f64 / last)
            .collect()
    }
}

/// What a load does over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadCourse {
    /// Amplitude, N or N·m.
    pub amplitude: f64,
    /// Frequency of its sine, Hz; `None` of a load that is constant.
    pub frequency_hz: Option<f64>,
    /// When it ends, s.
    pub until_s: f64,
}

impl LoadCourse {
    fn at(&self, time_s: f64) -> f64 {
        if time_s >= self.until_s {
            return 0.0;
        }
        let turn = |hz: f64| (TAU * hz * time_s).sin();
        self.amplitude * self.frequency_hz.map_or(1.0, turn)
    }
}

/// What is computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Response {
    /// Receptances of the linear assembly.
    Linear(Span),
    /// Its modes.
    Modes,
    /// Motions under loads, from rest.
    History {
        /// Length, s.
        duration_s: f64,
        /// Distance between the rows, and of the loads' straight pieces, s.
        step_s: f64,
        /// What each input does; `None` of one that stays zero.
        loads: Vec<Option<LoadCourse>>,
    },
}

impl Response {
    pub(crate) fn of(
        text: &StudyText,
        table: ResponseTable,
        inputs: &[Channel],
    ) -> Result<Self, StudyError> {
        let is_linear = table.kind == ResponseKind::Linear;
        let is_history = table.kind == ResponseKind::History;
        for (key, there, belongs, to) in [
            ("from", table.from.is_some(), is_linear, "linear"),
            ("to", table.to.is_some(), is_linear, "linear"),
            ("lines", table.lines.is_some(), is_linear, "linear"),
            ("duration", table.duration.is_some(), is_history, "history"),
            ("step", table.step.is_some(), is_history, "history"),
            ("loads", !table.loads.is_empty(), is_history, "history"),
        ] {
            let expected = format_args!("it with kind = \"{to}\" only");
            text.ensure(
                !there || belongs,
                format_args!("response.{key}"),
                "it",
                expected,
            )?;
        }
        match table.kind {
            ResponseKind::Modes => Ok(Self::Modes),
            ResponseKind::Linear => {
                let needed = "a frequency in Hz";
                let from = text.needed("response.from", table.from, needed)?;
                let to = text.needed("response.to", table.to, needed)?;
                let from = text.not_negative("response.from", from, needed)?;
                let expected = format_args!("a frequency above `from`, {from} Hz");
                text.ensure(to.is_finite() && to > from, "response.to", to, expected)?;
                let lines = table.lines.unwrap_or(LINES);
                let expected = format_args!("2 to {MOST_LINES}");
                text.within("response.lines", lines, 2..=MOST_LINES, expected)?;
                Ok(Self::Linear(Span {
                    ends_hz: [from, to],
                    lines,
                }))
            }
            ResponseKind::History => Self::history(text, table, inputs),
        }
    }

    fn history(
        text: &StudyText,
        table: ResponseTable,
        inputs: &[Channel],
    ) -> Result<Self, StudyError> {
        let duration = text.needed("response.duration", table.duration, "a length in s")?;
        let duration_s = text.positive("response.duration", duration, "a length in s")?;
        let step = text.needed("response.step", table.step, "the distance of rows in s")?;
        let step_s = text.positive("response.step", step, "the distance of rows in s")?;
        text.ensure(
            duration_s / step_s <= MOST_STEPS,
            "response.step",
            step_s,
            format_args!("at most {MOST_STEPS:.0e} steps in {duration_s} s"),
        )?;
        let mut loads = vec![None; inputs.len()];
        for (name, load) in table.loads {
            let key = format!("response.loads.{name}");
            let place = inputs.iter().position(|input| input.name == name);
            let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
            let place = text.needed(
                &key,
                place,
                format_args!("one of the inputs: {}", names.join(", ")),
            )?;
            text.ensure(
                load.amplitude.is_finite(),
                &key,
                load.amplitude,
                "a load in N or N·m",
            )?;
            if let Some(frequency) = load.frequency {
                text.positive(
                    format_args!("{key}.frequency"),
                    frequency,
                    "a frequency in Hz",
                )?;
            }
            loads[place] = Some(LoadCourse {
                amplitude: load.amplitude,
                frequency_hz: load.frequency,
                until_s: load.until.unwrap_or(f64::INFINITY),
            });
        }
        Ok(Self::History {
            duration_s,
            step_s,
            loads,
        })
    }
}

impl AssemblyModel {
    /// Motions under loads, from rest: rows of time (s), loads, displacement and velocity of each output, energy stored, supplied
    /// and dissipated (J). Between the rows the loads are straight.
    ///
    /// # Errors
    /// [`AssemblyError::Grows`] where the motion leaves what is finite, [`AssemblyError::TooLong`] where 4096 parts of a step are
    /// too few, [`AssemblyError::Law`] where a joint gives no law.
    pub fn history(
        &self,
        duration_s: f64,
        step_s: f64,
        loads: &[Option<LoadCourse>],
        progress: &dyn Fn(f64),
    ) -> Result<Vec<Vec<f64>>, AssemblyError> {
        let equations = self.equations()?;
        let mut steps = AssemblySteps::new(&equations, step_s, TOLERANCE)
            .ok_or(AssemblyError::Grows { time_s: step_s })?;
        let mut state = steps.at_rest();
        let outputs = self.output_rows();
        let size = self.size();
        let count = (duration_s / step_s).round().max(1.0) as u64;
        let at = |time_s: f64| -> Vec<f64> {
            let course = |load: &Option<LoadCourse>| load.map_or(0.0, |load| load.at(time_s));
            loads.iter().map(course).collect()
        };
        let mut rows = Vec::new();
        for step in 0..=count {
            let time_s = step_s * step as f64;
            let now = at(time_s);
            let mut row = vec![time_s];
            row.extend(&now);
            for output in outputs.row_iter() {
                for part in [0, size] {
                    let motion = &state.motion[part..part + size];
                    row.push(output.iter().zip(motion).map(|(own, q)| own * q).sum());
                }
            }
            row.extend([
                steps.stored_energy_j(&state),
                state.supplied_j,
                state.dissipated_j,
            ]);
            if !row.iter().all(|number| number.is_finite()) {
                return Err(AssemblyError::Grows { time_s });
            }
            rows.push(row);
            if step < count {
                let next = at(step_s * (step + 1) as f64);
                let change: Vec<f64> = next
                    .iter()
                    .zip(&now)
                    .map(|(next, now)| next - now)
                    .collect();
                steps.step(&mut state, &now, &change);
                if steps.was_too_long() {
                    return Err(AssemblyError::TooLong { time_s, step_s });
                }
            }
            progress(step as f64 / count as f64);
        }
        Ok(rows)
    }
}
