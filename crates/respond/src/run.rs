//! From a study to its table: every lap at every level.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{Body, Lap, with_dofs};

use bolted_joint_harmonic::{Derivative, HarmonicError, Observed, Target};
use bolted_joint_joint::{DofSet, JointFile, LawError};
use bolted_joint_study::StudyError;

use super::RespondError;
use super::answer::Answer;
use super::histories::{Drive, Ended, MOST_STEPS, SteppedSine, history};
use super::hysteresis::HysteresisLoop;
use super::periodic::{
    Curve, column, curve_columns, frequencies, load_unit, name, receptances, unit,
};
use super::study::{LoadPlace, RespondStudy, StudyLap, Test, Times};
use super::table::{Column, ResponseTable, Role, Series};

enum Failure {
    Harmonic(HarmonicError),
    Time(Ended),
}

impl From<HarmonicError> for Failure {
    fn from(error: HarmonicError) -> Self {
        Self::Harmonic(error)
    }
}

impl From<Ended> for Failure {
    fn from(ended: Ended) -> Self {
        Self::Time(ended)
    }
}

impl RespondStudy {
    /// Computes the response. `progress` is told again and again which part of the work is done, from 0 to 1.
    ///
    /// # Errors
    /// [`RespondError`] that names lap and level.
    pub fn run(&self, progress: &dyn Fn(f64)) -> Result<ResponseTable, RespondError> {
        with_dofs!(self.dofs().size(), D => self.run_with::<D>(progress))
    }

    fn dofs(&self) -> DofSet {
        self.laps[0].file.joint.dofs
    }

    fn run_with<const D: usize>(
        &self,
        progress: &dyn Fn(f64),
    ) -> Result<ResponseTable, RespondError> {
        let motions = self.seen();
        let (columns, level_unit) = self.columns(&motions);
        let levels: Vec<Option<f64>> = match self.levels() {
            Some(levels) => levels.iter().map(|&level| Some(level)).collect(),
            None => vec![None],
        };
        let all = (self.laps.len() * levels.len()) as f64;
        let mut series = Vec::new();
        for lap in &self.laps {
            let model = self.model::<D>(&lap.file);
            let model = model.map_err(|source| StudyError::model(&lap.path, None, source))?;
            for &level in &levels {
                let done = series.len() as f64;
                let of_series = |share: f64| progress((done + share) / all);
                let answer = self.answer(&model, &motions, level.unwrap_or(0.0), &of_series);
                of_series(1.0);
                let answer =
                    answer.map_err(|failure| self.failed(lap, level, level_unit, failure))?;
                series.push(Series {
                    lap: lap.name.clone(),
                    level,
                    rows: answer.rows,
                    largest: answer.largest.to_vec(),
                });
            }
        }
        Ok(ResponseTable {
            level_unit,
            columns,
            series,
        })
    }

    /// The lap of a file; where the joint alone is moved, with bodies that are nothing.
    fn model<const D: usize>(&self, file: &JointFile) -> Result<Lap<D>, LawError> {
        if !matches!(self.test, Test::Hysteresis { .. }) {
            return file.lap();
        }
        let nothing = Body {
            inertia: [0.0; D],
            stiffness: [0.0; D],
            damping: [0.0; D],
        };
        Ok(Lap {
            joint: file.joint.law()?,
            a: nothing,
            b: nothing,
        })
    }

    /// The motions that are written; the one whose amplitude is followed first.
    fn seen(&self) -> Vec<Observed> {
        let mut motions = self.motions.clone();
        if let Test::Backbone { of, .. } | Test::PhaseResonance { of, .. } = &self.test {
            motions.retain(|motion| motion != of);
            motions.insert(0, *of);
        }
        motions
    }

    fn levels(&self) -> Option<&[f64]> {
        match &self.test {
            Test::HarmonicBalance { levels, .. }
            | Test::ConstantAmplitude { levels, .. }
            | Test::SteppedSine { levels, .. }
            | Test::Sweep { levels, .. }
            | Test::Dwell { levels, .. } => Some(levels),
            Test::Hysteresis { amplitudes, .. } => Some(amplitudes),
            Test::Linear { .. }
            | Test::Backbone { .. }
            | Test::PhaseResonance { .. }
            | Test::FreeDecay { .. } => None,
        }
    }

    fn columns(&self, motions: &[Observed]) -> (Vec<Column>, &'static str) {
        let dofs = self.dofs();
        let (name, load_unit) = (
            |observed| name(dofs, observed),
            |place| load_unit(dofs, place),
        );
        let unit = |observed, quantity| unit(dofs, observed, quantity);
        let curve =
            |is_over_frequency| curve_columns(dofs, motions, self.quantity, is_over_frequency);
        let with = |mut columns: Vec<Column>, more: Vec<Column>| {
            columns.extend(more);
            columns
        };
        let histories = |is_loaded: Option<&'static str>| {
            let mut columns = vec![column("time", "s", Role::Across)];
            if let Some(unit) = is_loaded {
                columns.push(column("frequency", "Hz", Role::Aside));
                columns.push(column("load", unit, Role::Aside));
            }
            for &observed in motions {
                let unit = |quantity| unit(observed, quantity);
                let name = name(observed);
                columns.push(column(&name, unit(Derivative::Displacement), Role::Up));
                let rate = column(
                    format!("{name} rate"),
                    unit(Derivative::Velocity),
                    Role::Aside,
                );
                columns.push(rate);
            }
            columns
        };
        match &self.test {
            Test::Linear { load, .. } => {
                let mut columns = vec![column("frequency", "Hz", Role::Across)];
                for &observed in motions {
                    let unit = per(unit(observed, self.quantity), load_unit(*load));
                    for (part, role) in [
                        ("modulus", Role::Up),
                        ("real", Role::Aside),
                        ("imaginary", Role::Aside),
                    ] {
                        columns.push(column(format!("{} {part}", name(observed)), unit, role));
                    }
                }
                (columns, "")
            }
            Test::HarmonicBalance { load, .. } => {
                let flags = vec![
                    column("stable", "", Role::Stable),
                    column("fold", "", Role::Aside),
                ];
                (with(curve(true), flags), load_unit(*load))
            }
            Test::ConstantAmplitude { load, of, .. } => {
                // The amplitude is held: the load is what there is to see.
                let mut columns = curve(true);
                for column in &mut columns {
                    if matches!(column.role, Role::Up | Role::Phase) {
                        column.role = Role::Aside;
                    }
                }
                let load = vec![column("load", load_unit(*load), Role::Up)];
                (with(columns, load), unit(*of, self.quantity))
            }
            Test::Backbone { .. } => {
                let ratio = vec![column("damping ratio", "", Role::Up)];
                (with(curve(false), ratio), "")
            }
            Test::PhaseResonance { load, .. } => {
                let load = vec![column("load", load_unit(*load), Role::Up)];
                (with(curve(false), load), "")
            }
            Test::SteppedSine { load, .. } => {
                let mut columns = vec![column("frequency", "Hz", Role::Across)];
                for &observed in motions {
                    let (name, unit) = (name(observed), unit(observed, self.quantity));
                    columns.push(column(format!("{name} amplitude"), unit, Role::Up));
                    columns.push(column(format!("{name} phase"), "°", Role::Phase));
                }
                (columns, load_unit(*load))
            }
            Test::Sweep { load, .. } | Test::Dwell { load, .. } => {
                let unit = load_unit(*load);
                (histories(Some(unit)), unit)
            }
            Test::FreeDecay { .. } => (histories(None), ""),
            Test::Hysteresis { dof, .. } => {
                let (observed, load) = (
                    Observed::Relative(*dof),
                    LoadPlace {
                        body: None,
                        dof: *dof,
                    },
                );
                let displacement = unit(observed, Derivative::Displacement);
                let columns = vec![
                    column(name(observed), displacement, Role::Across),
                    column("load", load_unit(load), Role::Up),
                    column("heat", "J", Role::Total),
                ];
                (columns, displacement)
            }
        }
    }

    fn answer<const D: usize>(
        &self,
        lap: &Lap<D>,
        motions: &[Observed],
        level: f64,
        progress: &dyn Fn(f64),
    ) -> Result<Answer<D>, Failure> {
        let target = |of: Observed, amplitude: f64| Target {
            observed: of,
            derivative: self.quantity,
            amplitude,
        };
        let curve = |harmonics| Curve {
            harmonics,
            motions,
            quantity: self.quantity,
        };
        let driven = |place, [from_hz, to_hz]: [f64; 2], times: Times| {
            let drive = Drive {
                place,
                level,
                from_hz,
                to_hz,
                duration_s: times.duration_s,
            };
            history(lap, &[], Some(drive), times, motions, progress)
        };
        Ok(match &self.test {
            Test::Linear { span, lines, load } => Answer::linear(receptances(
                lap,
                frequencies(*span, *lines),
                *load,
                motions,
                self.quantity,
            )?),
            Test::HarmonicBalance {
                span,
                load,
                harmonics,
                ..
            } => curve(harmonics).forced(lap, *span, *load, level)?,
            Test::ConstantAmplitude {
                span,
                load,
                of,
                harmonics,
                ..
            } => curve(harmonics).controlled(lap, *span, *load, target(*of, level))?,
            Test::Backbone {
                of,
                amplitudes,
                is_undamped,
                harmonics,
            } => {
                let target = target(*of, amplitudes[0]);
                curve(harmonics).backbone(lap, *amplitudes, target, *is_undamped)?
            }
            Test::PhaseResonance {
                load,
                of,
                amplitudes,
                harmonics,
            } => {
                let target = target(*of, amplitudes[0]);
                curve(harmonics).resonance(lap, *amplitudes, *load, target)?
            }
            Test::SteppedSine {
                span,
                lines,
                load,
                settle,
                steps_per_period,
                ..
            } => SteppedSine {
                span: *span,
                lines: *lines,
                place: *load,
                level,
                settle: *settle,
                steps_per_period: *steps_per_period,
                motions,
                quantity: self.quantity,
            }
            .answer(lap, progress)?,
            Test::Sweep {
                span, load, times, ..
            } => driven(*load, span.ends_hz, *times)?,
            Test::Dwell {
                frequency_hz,
                load,
                times,
                ..
            } => driven(*load, [*frequency_hz; 2], *times)?,
            Test::FreeDecay { start, times } => {
                history(lap, start, None, *times, motions, progress)?
            }
            Test::Hysteresis {
                dof, frequency_hz, ..
            } => Answer::of_loop(
                HysteresisLoop {
                    dof: *dof,
                    amplitude: level,
                    omega_rad_per_s: frequency_hz.map(|hz| TAU * hz),
                },
                &lap.joint,
            ),
        })
    }

    /// Where joints move further than they were observed at, which their files may say: what is told there is extrapolated.
    #[must_use]
    pub fn warnings(&self, table: &ResponseTable) -> Vec<String> {
        let mut warnings = Vec::new();
        for series in &table.series {
            let lap = self.laps.iter().find(|lap| lap.name == series.lap);
            let higher = lap.and_then(|lap| lap.file.joint.higher.as_ref());
            let observed = higher.map_or(&[][..], |higher| &higher.amplitude);
            for (dof, (&largest, &observed)) in series.largest.iter().zip(observed).enumerate() {
                if largest <= observed {
                    continue;
                }
                let row = self.dofs().row(dof);
                let unit = row.kind.displacement_unit();
                let level = series.level.map_or_else(String::new, |level| {
                    format!(" at {level} {}", table.level_unit)
                });
                let motion = format!("{}{level}: relative.{}", series.lap, row.name);
                warnings.push(beyond_observed(&motion, unit, [largest, observed]));
            }
        }
        warnings
    }

    fn failed(
        &self,
        lap: &StudyLap,
        level: Option<f64>,
        unit: &str,
        failure: Failure,
    ) -> RespondError {
        let level = level.map_or_else(String::new, |level| format!(", {level} {unit}"));
        let lap = lap.name.clone();
        match failure {
            Failure::Harmonic(source) => RespondError::Harmonic { lap, level, source },
            Failure::Time(Ended::Escaped(time_s)) => RespondError::Escaped { lap, level, time_s },
            Failure::Time(Ended::Undamped) => {
                let expected = format!(
                    "the number of periods to wait: the lap `{lap}` has a mode that does not decay"
                );
                StudyError::value(&self.path, "time.settle", "nothing", expected).into()
            }
            Failure::Time(Ended::TooMany(steps)) => {
                let found = format!("{steps:.1e} Runge–Kutta steps");
                let expected =
                    format!("at most {MOST_STEPS:.0e}; shorten it or lengthen the steps");
                StudyError::value(&self.path, "time", found, expected).into()
            }
        }
    }
}

/// That a joint moves further than it was observed at.
pub(super) fn beyond_observed(motion: &str, unit: &str, [largest, observed]: [f64; 2]) -> String {
    format!(
        "{motion} reaches {largest:.3e} {unit}, beyond the {observed:.3e} {unit} that the joint was observed at"
    )
}

/// A unit over that of a load.
fn per(motion: &str, load: &str) -> &'static str {
    match (motion, load) {
        ("m", "N") => "m/N",
        ("m/s", "N") => "m/s/N",
        ("m/s²", "N") => "m/s²/N",
        ("rad", "N") => "rad/N",
        ("rad/s", "N") => "rad/s/N",
        ("rad/s²", "N") => "rad/s²/N",
        ("m", _) => "m/(N·m)",
        ("m/s", _) => "m/s/(N·m)",
        ("m/s²", _) => "m/s²/(N·m)",
        ("rad", _) => "rad/(N·m)",
        ("rad/s", _) => "rad/s/(N·m)",
        _ => "rad/s²/(N·m)",
    }
}
