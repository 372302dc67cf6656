//! What a study of a layered beam gives: frequencies, damping over the amplitude, slip, and the joint file.

use std::fmt::Write as _;

use serde::Serialize;

use bolted_joint_joint::JointFile;

use super::beam_mode::{BeamMode, Route, StoredEnergy};
use super::damping::SlipDamping;
use super::error::LayeredBeamError;
use super::fasteners::Fasteners;
use super::joint_file::{LapFile, lap_file};
use super::scatter::ScatterRow;
use super::study::{Friction, LayeredBeamStudy};

/// More damping than the energies over one period, taken as equal from one to the next, are good for.
const SMALL_DAMPING: f64 = 0.1;

/// The result of a study.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// Name of the study.
    pub name: String,
    /// α′μ.
    pub alpha_mu: f64,
    /// EI of the jointed beam, N·m².
    pub bending_stiffness_n_m2: f64,
    /// ρA, kg/m.
    pub mass_per_length_kg_per_m: f64,
    /// Tension P in a fastener, N.
    pub tension_n: f64,
    /// Normal force N of a fastener on each interface, N.
    pub normal_forces_n: Vec<f64>,
    /// The modes.
    pub modes: Vec<ModeRow>,
    /// Damping over the amplitude: all amplitudes of the first mode, then those of the next.
    pub amplitudes: Vec<AmplitudeRow>,
    /// Slip at each fastener in the study's mode, at the largest amplitude.
    pub slips: Vec<SlipRow>,
    /// Number of the mode that the joint file stands for.
    pub mode: usize,
    /// Largest |ζ of the joint file/ζ of the beam − 1| over the study's amplitudes.
    pub joint_damping_worst_error: f64,
    /// Scatter of the results, where the study has values with a standard deviation.
    pub scatter: Vec<ScatterRow>,
    /// What a reader should know before using the result.
    pub warnings: Vec<String>,
    /// The lap equivalent of the study's mode.
    #[serde(skip)]
    pub joint_file: JointFile,
}

/// One mode, by both routes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeRow {
    /// Its number, counted from one.
    pub number: usize,
    /// Root λ = βL of the frequency equation.
    pub lambda: f64,
    /// Natural frequency by the frequency equation, Hz.
    pub frequency_hz: f64,
    /// Natural frequency by finite elements, Hz.
    pub finite_element_frequency_hz: f64,
    /// The point whose deflection counts, from the first end, m.
    pub drive_point_m: f64,
    /// Modal mass there, kg.
    pub mass_kg: f64,
    /// Modal stiffness there, N/m.
    pub stiffness_n_per_m: f64,
    /// Static stiffness there, N/m, where the beam is held.
    pub static_stiffness_n_per_m: Option<f64>,
    /// Y/w: sum of |∂w/∂x| over the fasteners for a unit deflection, 1/m.
    pub slope_sum_per_m: f64,
}

/// Damping of a mode at one amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AmplitudeRow {
    /// Number of the mode.
    pub mode: usize,
    /// Amplitude of its drive point, m.
    pub amplitude_m: f64,
    /// ζ by the exact shape.
    pub damping_ratio: f64,
    /// ζ by finite elements.
    pub finite_element_damping_ratio: f64,
    /// δ of the study's route.
    pub logarithmic_decrement: f64,
    /// E_f of the study's route, J.
    pub dissipated_energy_j: f64,
    /// E_n of the study's route, J.
    pub stored_energy_j: f64,
    /// ζ of the lap in the joint file, for the mode that it stands for.
    pub joint_damping_ratio: Option<f64>,
}

/// Slip at one fastener.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SlipRow {
    /// Its distance from the first end, m.
    pub position_m: f64,
    /// |∂w/∂x| at the largest amplitude.
    pub slope: f64,
    /// (h₁ + h₂)|∂w/∂x| at the largest amplitude and the interface of the thickest layers, m: slip without friction, of which
    /// the part α′ takes place.
    pub ideal_slip_m: f64,
}

impl Outcome {
    pub(super) fn of(
        study: &LayeredBeamStudy,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Self, LayeredBeamError> {
        let beam = &study.beam;
        let alpha_mu = match &study.friction {
            Friction::Known(alpha_mu) => *alpha_mu,
            Friction::Calibrated(measured) => {
                let mode = BeamMode::new(
                    &measured.beam,
                    &measured.fasteners,
                    measured.mode,
                    measured.drive_point_m,
                    study.route,
                    study.stored,
                )?;
                let (ratio, amplitude) = (measured.damping_ratio, measured.amplitude_m);
                SlipDamping::calibrated(
                    &measured.beam,
                    &measured.fasteners,
                    mode,
                    ratio,
                    amplitude,
                )?
                .alpha_mu
            }
        };
        let damping_of = |fasteners: &Fasteners, number: usize, route: Route| {
            // another mode may have a node at the study's drive point
            let drive_point = study.drive_point_m.filter(|_| number == study.mode);
            let mode = BeamMode::new(beam, fasteners, number, drive_point, route, study.stored)?;
            SlipDamping::new(beam, fasteners, mode, alpha_mu)
        };
        let nominal = damping_of(&study.fasteners, study.mode, study.route)?;
        nominal.mode.check_slip()?;
        let over_torque = study.over_torque.iter();
        let over_torque: Vec<(f64, SlipDamping)> = over_torque
            .map(|(torque, fasteners)| {
                Ok((*torque, damping_of(fasteners, study.mode, study.route)?))
            })
            .collect::<Result<_, LayeredBeamError>>()?;
        let scattered = study.scatter.as_ref();
        let scattered = scattered
            .map(|scatter| scatter.run(study, &nominal, &over_torque, progress))
            .transpose()?;
        let lap = lap_file(study, &nominal, &over_torque, scattered.as_ref())?;
        let (mut modes, mut amplitudes) = (Vec::new(), Vec::new());
        let mut without_slip = Vec::new();
        for number in 1..=study.modes {
            let classical = damping_of(&study.fasteners, number, Route::Classical)?;
            if classical.mode.check_slip().is_err() {
                without_slip.push(number.to_string());
            }
            let elements = damping_of(&study.fasteners, number, Route::FiniteElements)?;
            modes.push(mode_row(study, &classical, &elements));
            amplitudes.extend(
                study
                    .amplitudes_m
                    .iter()
                    .map(|&amplitude| amplitude_row(study, &classical, &elements, &lap, amplitude)),
            );
        }
        let mut warnings = warnings(study, &nominal)?;
        if !without_slip.is_empty() {
            warnings.push(format!(
                "mode {} has no slope at any fastener: the model gives it no damping",
                without_slip.join(", ")
            ));
        }
        Ok(Self {
            name: study.name.clone(),
            alpha_mu,
            bending_stiffness_n_m2: beam.bending_stiffness_n_m2(),
            mass_per_length_kg_per_m: beam.mass_per_length_kg_per_m(),
            tension_n: study.fasteners.tension_n(),
            normal_forces_n: study.fasteners.normal_forces_n(beam)?,
            modes,
            amplitudes,
            slips: slips(study, &nominal.mode),
            mode: study.mode,
            joint_damping_worst_error: lap.worst_error,
            scatter: scattered.map(|found| found.rows()).unwrap_or_default(),
            warnings,
            joint_file: lap.file,
        })
    }

    /// Damping over the amplitude as CSV, one line a mode and amplitude.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = "mode,frequency [Hz],finite-element frequency [Hz],drive point [m],amplitude [m],damping ratio,\
             finite-element damping ratio,logarithmic decrement,dissipated energy [J],stored energy [J],\
             damping ratio of the joint file\n"
            .to_owned();
        for row in &self.amplitudes {
            let Some(mode) = self.modes.iter().find(|mode| mode.number == row.mode) else {
                continue;
            };
            let of_joint = row.joint_damping_ratio;
            let of_joint = of_joint
                .map(|ratio| format!("{ratio:e}"))
                .unwrap_or_default();
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "{},{},{},{},{:e},{:e},{:e},{:e},{:e},{:e},{of_joint}",
                row.mode,
                mode.frequency_hz,
                mode.finite_element_frequency_hz,
                mode.drive_point_m,
                row.amplitude_m,
                row.damping_ratio,
                row.finite_element_damping_ratio,
                row.logarithmic_decrement,
                row.dissipated_energy_j,
                row.stored_energy_j,
            );
        }
        text
    }

    /// Lines for people: the beam, its modes, its damping at the first and the last amplitude.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let forces = self.normal_forces_n.iter();
        let forces: Vec<String> = forces.map(|force| format!("{force:.1}")).collect();
        let mut lines = vec![
            format!(
                "EI {:.6} N·m², ρA {:.6} kg/m",
                self.bending_stiffness_n_m2, self.mass_per_length_kg_per_m
            ),
            format!(
                "a fastener has a tension of {:.1} N and presses the interfaces with {} N",
                self.tension_n,
                forces.join(", ")
            ),
            format!("α′μ {:.6e}", self.alpha_mu),
        ];
        for mode in &self.modes {
            lines.push(format!(
                "mode {}: {:.4} Hz ({:.4} Hz by finite elements), at {:.4} m {:.5} kg and {:.5e} N/m",
                mode.number,
                mode.frequency_hz,
                mode.finite_element_frequency_hz,
                mode.drive_point_m,
                mode.mass_kg,
                mode.stiffness_n_per_m
            ));
        }
        let own = || self.amplitudes.iter().filter(|row| row.mode == self.mode);
        for row in own().next().into_iter().chain(own().next_back()) {
            let of_joint = row.joint_damping_ratio;
            let of_joint = of_joint
                .map(|ratio| format!(", {ratio:.5} in the joint file"))
                .unwrap_or_default();
            lines.push(format!(
                "mode {} at {:.3e} m: damping ratio {:.5} ({:.5} by finite elements{of_joint})",
                row.mode, row.amplitude_m, row.damping_ratio, row.finite_element_damping_ratio
            ));
        }
        lines.push(format!(
            "the joint file's damping is within {:.1} % of friction's over these amplitudes",
            100.0 * self.joint_damping_worst_error
        ));
        lines.extend(self.scatter.iter().map(ScatterRow::to_string));
        lines
    }
}

fn mode_row(study: &LayeredBeamStudy, classical: &SlipDamping, elements: &SlipDamping) -> ModeRow {
    let mode = &classical.mode;
    ModeRow {
        number: mode.number,
        lambda: study.beam.shape(mode.number).lambda(),
        frequency_hz: mode.frequency_hz(),
        finite_element_frequency_hz: elements.mode.frequency_hz(),
        drive_point_m: mode.drive_point_m,
        mass_kg: mode.mass_kg,
        stiffness_n_per_m: mode.modal_stiffness_n_per_m(),
        static_stiffness_n_per_m: study.beam.static_stiffness_n_per_m(mode.drive_point_m),
        slope_sum_per_m: mode.slope_sum_per_m(),
    }
}

fn amplitude_row(
    study: &LayeredBeamStudy,
    classical: &SlipDamping,
    elements: &SlipDamping,
    lap: &LapFile,
    amplitude_m: f64,
) -> AmplitudeRow {
    let own = match study.route {
        Route::Classical => classical,
        Route::FiniteElements => elements,
    };
    let is_in_the_file = own.mode.number == study.mode;
    AmplitudeRow {
        mode: own.mode.number,
        amplitude_m,
        damping_ratio: classical.damping_ratio(amplitude_m),
        finite_element_damping_ratio: elements.damping_ratio(amplitude_m),
        logarithmic_decrement: own.logarithmic_decrement(amplitude_m),
        dissipated_energy_j: own.dissipated_energy_j(amplitude_m),
        stored_energy_j: own.stored_energy_j(amplitude_m),
        joint_damping_ratio: is_in_the_file.then(|| lap.damping_ratio(own, amplitude_m)),
    }
}

fn slips(study: &LayeredBeamStudy, mode: &BeamMode) -> Vec<SlipRow> {
    let amplitude = study.amplitudes_m.last().copied().unwrap_or(0.0);
    let pairs = study.beam.layers().windows(2);
    let between = pairs.map(|pair| 0.5 * (pair[0].thickness_m + pair[1].thickness_m));
    let widest = between.fold(0.0, f64::max);
    let positions = study.fasteners.positions_m().iter().zip(&mode.slopes_per_m);
    let row = |(&position_m, slope): (&f64, &f64)| SlipRow {
        position_m,
        slope: slope * amplitude,
        ideal_slip_m: widest * slope * amplitude,
    };
    positions.map(row).collect()
}

fn warnings(
    study: &LayeredBeamStudy,
    nominal: &SlipDamping,
) -> Result<Vec<String>, LayeredBeamError> {
    let mut warnings = Vec::new();
    let (beam, fasteners) = (&study.beam, &study.fasteners);
    let zone = fasteners.zone_diameter_m(beam);
    if zone > beam.width_m() {
        warnings.push(format!(
            "the pressure's zone is {zone:.4} m wide and the beam {:.4} m: part of the normal force has no interface to act on",
            beam.width_m()
        ));
    }
    let mut positions = fasteners.positions_m().to_vec();
    positions.sort_by(f64::total_cmp);
    let closest = positions.windows(2).map(|pair| pair[1] - pair[0]);
    let closest = closest.fold(f64::INFINITY, f64::min);
    if closest < zone {
        warnings.push(format!(
            "fasteners are {closest:.4} m apart and their zones of pressure {zone:.4} m wide: the zones overlap, which the model does not know"
        ));
    }
    let tension = fasteners.tension_n();
    let farthest = fasteners.normal_forces_n(beam)?.into_iter();
    let farthest = farthest.map(|force| force / tension - 1.0);
    let farthest = farthest.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    if farthest.abs() > 1e-9 {
        warnings.push(format!(
            "the polynomial pressure of a fastener sums up to {:.1} % of its tension; equilibrium asks for all of it: fasteners.normal_force = \"tension\"",
            100.0 * (1.0 + farthest)
        ));
    }
    if let Some(&smallest) = study.amplitudes_m.first() {
        let ratio = nominal.damping_ratio(smallest);
        if ratio > SMALL_DAMPING {
            warnings.push(format!(
                "the damping ratio at {smallest:.3e} m is {ratio:.3}: the energies of the model belong to small damping; friction this large is likely to stick"
            ));
        }
    }
    if study.stored == StoredEnergy::Static {
        let mode = &nominal.mode;
        warnings.push(format!(
            "the stored energy is that of the static deflection; that of the mode is {:+.1} % of it more",
            100.0 * (mode.modal_stiffness_n_per_m() / mode.stiffness_n_per_m - 1.0)
        ));
    }
    if let Friction::Calibrated(measured) = &study.friction
        && measured.mode != study.mode
    {
        warnings.push(format!(
            "α′μ comes from mode {} and is used for mode {}: it is said to grow with the frequency",
            measured.mode, study.mode
        ));
    }
    Ok(warnings)
}
