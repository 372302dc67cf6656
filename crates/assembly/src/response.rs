//! What `respond` computes of an assembly: receptances, modes, a history under loads, or periodic motion.

use std::f64::consts::TAU;

use bolted_joint_dynamics::assembly::{AssemblySteps, TOLERANCE};
use bolted_joint_study::{StudyError, StudyText};
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::error::AssemblyError;
use crate::model::AssemblyModel;
use crate::place::Channel;
use crate::reached::Reached;
use crate::tables::{ResponseKind, ResponseTable};

/// Lines where nothing is said, and more than anybody draws.
const LINES: usize = 1000;
const MOST_LINES: usize = 1_000_000;
/// The highest harmonic where nothing is said, and at most.
const HARMONICS: usize = 7;
const MOST_HARMONICS: usize = 99;
/// More steps than anybody waits for.
const MOST_STEPS: f64 = 1e7;
/// Rows in a period of a load, at least.
const LEAST_ROWS_A_PERIOD: f64 = 4.0;

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
    /// Periodic responses to loads of one frequency, by harmonic balance.
    HarmonicBalance {
        /// First and last frequency, Hz.
        ends_hz: [f64; 2],
        /// Each input as a phasor, N or N·m.
        loads: Vec<Complex64>,
        /// The highest harmonic.
        harmonics: usize,
    },
    /// A mode over its amplitude, by harmonic balance.
    Backbone {
        /// Which mode, from 0.
        mode: usize,
        /// The output whose amplitude it is.
        output: usize,
        /// First and last amplitude, m or rad.
        ends: [f64; 2],
        /// The highest harmonic.
        harmonics: usize,
    },
}

impl Response {
    pub(crate) fn of(
        text: &StudyText,
        table: ResponseTable,
        inputs: &[Channel],
        outputs: &[Channel],
    ) -> Result<Self, StudyError> {
        use ResponseKind::{Backbone, HarmonicBalance, History, Linear};
        let of = |kinds: &[ResponseKind]| kinds.contains(&table.kind);
        let [linear, history, backbone] = ["\"linear\"", "\"history\"", "\"backbone\""];
        let swept = "\"linear\" or \"harmonic-balance\"";
        let loaded = "\"history\" or \"harmonic-balance\"";
        let balanced = "\"harmonic-balance\" or \"backbone\"";
        for (key, there, belongs, to) in [
            (
                "from",
                table.from.is_some(),
                of(&[Linear, HarmonicBalance]),
                swept,
            ),
            (
                "to",
                table.to.is_some(),
                of(&[Linear, HarmonicBalance]),
                swept,
            ),
            ("lines", table.lines.is_some(), of(&[Linear]), linear),
            (
                "duration",
                table.duration.is_some(),
                of(&[History]),
                history,
            ),
            ("step", table.step.is_some(), of(&[History]), history),
            (
                "loads",
                !table.loads.is_empty(),
                of(&[History, HarmonicBalance]),
                loaded,
            ),
            (
                "harmonics",
                table.harmonics.is_some(),
                of(&[HarmonicBalance, Backbone]),
                balanced,
            ),
            ("mode", table.mode.is_some(), of(&[Backbone]), backbone),
            ("of", table.of.is_some(), of(&[Backbone]), backbone),
            (
                "amplitude",
                table.amplitude.is_some(),
                of(&[Backbone]),
                backbone,
            ),
        ] {
            let expected = format_args!("it with kind = {to} only");
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
            ResponseKind::HarmonicBalance => Self::harmonic_balance(text, table, inputs),
            ResponseKind::Backbone => Self::backbone(text, table, outputs),
        }
    }

    fn harmonics(text: &StudyText, table: &ResponseTable) -> Result<usize, StudyError> {
        let harmonics = table.harmonics.unwrap_or(HARMONICS);
        let expected = format_args!("1 to {MOST_HARMONICS}, the highest harmonic");
        text.within(
            "response.harmonics",
            harmonics,
            1..=MOST_HARMONICS,
            expected,
        )?;
        Ok(harmonics)
    }

    fn harmonic_balance(
        text: &StudyText,
        table: ResponseTable,
        inputs: &[Channel],
    ) -> Result<Self, StudyError> {
        let needed = "a frequency in Hz";
        let from = text.needed("response.from", table.from, needed)?;
        let to = text.needed("response.to", table.to, needed)?;
        let ends_hz = [
            text.positive("response.from", from, needed)?,
            text.positive("response.to", to, needed)?,
        ];
        let expected = format_args!("another frequency than `from`, {from} Hz");
        text.ensure(from != to, "response.to", to, expected)?;
        let harmonics = Self::harmonics(text, &table)?;
        let mut loads = vec![Complex64::ZERO; inputs.len()];
        for (name, load) in &table.loads {
            let (key, place) = load_place(text, name, inputs)?;
            for (other, there) in [("frequency", load.frequency), ("until", load.until)] {
                let expected = "it with kind = \"history\" only";
                text.ensure(
                    there.is_none(),
                    format_args!("{key}.{other}"),
                    "it",
                    expected,
                )?;
            }
            let phase = load.phase.unwrap_or(0.0);
            let is_finite = load.amplitude.is_finite() && phase.is_finite();
            text.ensure(
                is_finite,
                &key,
                load.amplitude,
                "a load in N or N·m, and a phase in degrees",
            )?;
            loads[place] = Complex64::from_polar(1.0, phase.to_radians()) * load.amplitude;
        }
        text.ensure(
            loads.iter().any(|load| load.norm() > 0.0),
            "response.loads",
            "none",
            "a table for an input, such as loads.push = { amplitude = 10 }",
        )?;
        Ok(Self::HarmonicBalance {
            ends_hz,
            loads,
            harmonics,
        })
    }

    fn backbone(
        text: &StudyText,
        table: ResponseTable,
        outputs: &[Channel],
    ) -> Result<Self, StudyError> {
        let harmonics = Self::harmonics(text, &table)?;
        let mode = table.mode.unwrap_or(1);
        text.ensure(
            mode > 0,
            "response.mode",
            mode,
            "the number of a mode, from 1",
        )?;
        let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
        let expected = format_args!("one of the outputs: {}", names.join(", "));
        let of = text.needed("response.of", table.of, expected)?;
        let output = outputs.iter().position(|output| output.name == of);
        let output = text.needed("response.of", output, expected)?;
        let expected = "two amplitudes in m or rad, such as amplitude = [1e-6, 1e-4]";
        let ends = text.needed("response.amplitude", table.amplitude, expected)?;
        let [from, to] = ends;
        let are_good = from > 0.0 && to > 0.0 && from != to && from.is_finite() && to.is_finite();
        text.ensure(
            are_good,
            "response.amplitude",
            format_args!("{ends:?}"),
            expected,
        )?;
        Ok(Self::Backbone {
            mode: mode - 1,
            output,
            ends,
            harmonics,
        })
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
        text.ensure(
            step_s <= duration_s,
            "response.step",
            step_s,
            format_args!("no more than response.duration, {duration_s} s"),
        )?;
        let mut loads = vec![None; inputs.len()];
        for (name, load) in table.loads {
            let (key, place) = load_place(text, &name, inputs)?;
            text.ensure(
                load.phase.is_none(),
                format_args!("{key}.phase"),
                "it",
                "it with kind = \"harmonic-balance\" only",
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
                // between rows loads are straight: less than four rows a period are no sine
                let highest = 1.0 / (LEAST_ROWS_A_PERIOD * step_s);
                text.ensure(
                    frequency <= highest,
                    format_args!("{key}.frequency"),
                    frequency,
                    format_args!(
                        "at most {highest} Hz, which has {LEAST_ROWS_A_PERIOD} rows of response.step = {step_s} s in a period; \
                         make the step shorter"
                    ),
                )?;
            }
            if let Some(until) = load.until {
                text.positive(format_args!("{key}.until"), until, "a time in s")?;
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

/// Key and place of the input that a load is of.
fn load_place(
    text: &StudyText,
    name: &str,
    inputs: &[Channel],
) -> Result<(String, usize), StudyError> {
    let key = format!("response.loads.{name}");
    let place = inputs.iter().position(|input| input.name == name);
    let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
    let expected = format_args!("one of the inputs: {}", names.join(", "));
    let place = text.needed(&key, place, expected)?;
    Ok((key, place))
}

impl AssemblyModel {
    /// Motions under loads, from rest: rows of time (s), loads, displacement and velocity of each output, energy stored, supplied
    /// and dissipated (J), and how far the joints move at the rows. Between the rows the loads are straight.
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
    ) -> Result<(Vec<Vec<f64>>, Reached), AssemblyError> {
        let equations = self.equations()?;
        let mut steps = AssemblySteps::new(&equations, step_s, TOLERANCE)
            .ok_or(AssemblyError::Grows { time_s: step_s })?;
        let mut underway = steps.at_rest();
        let outputs = self.output_rows();
        let joints = self.joints.iter().map(|joint| self.relative_rows(joint));
        let joints: Vec<DMatrix<f64>> = joints.collect();
        let mut reached = Reached::default();
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
            let state = steps.coordinates().state(&underway);
            let [displacement, velocity] = [0, size].map(|part| &state.motion[part..part + size]);
            for output in outputs.row_iter() {
                row.extend([displacement, velocity].map(|motion| along(output.iter(), motion)));
            }
            let relative = joints.iter().flat_map(|joint| joint.row_iter());
            for (place, shape) in relative.enumerate() {
                reached.include(place, along(shape.iter(), displacement));
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
                steps.step(&mut underway, &now, &change);
                if steps.was_too_long() {
                    return Err(AssemblyError::TooLong { time_s, step_s });
                }
            }
            progress(step as f64 / count as f64);
        }
        Ok((rows, reached))
    }
}

/// The motion of a shape.
fn along<'s>(shape: impl Iterator<Item = &'s f64>, motion: &[f64]) -> f64 {
    shape.zip(motion).map(|(own, q)| own * q).sum()
}
