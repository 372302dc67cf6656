//! The joint file of a layered beam: the equivalent lap of its mode, with what it rests on.

use bolted_joint_joint::{
    Bodies, DofSet, Format, Friction, Joint, JointFile, OverPreload, Validity,
};
use bolted_joint_study::{Method, provenance};

use super::damping::SlipDamping;
use super::dry_friction::DrySlider;
use super::error::{LayeredBeamError, value};
use super::lap::{EquivalentDamping, EquivalentLap};
use super::scatter::Scattered;
use super::study::LayeredBeamStudy;

/// How far slip forces may be from being in proportion to the torque, as a part of the nominal one.
const IN_PROPORTION: f64 = 1e-6;

/// The joint file, and what is to be said about it.
#[derive(Clone, Debug)]
pub(super) struct LapFile {
    pub(super) file: JointFile,
    lap: EquivalentLap,
    damper: Damper,
    /// Largest |damping ratio of the joint/damping ratio of the beam − 1| in the range of amplitudes.
    pub(super) worst_error: f64,
}

/// Stiffness of the joint (N/m) for a mode with this damping, and its damper.
pub(super) fn terms(
    damping: &SlipDamping,
    how: &EquivalentDamping,
) -> Result<(f64, Damper), LayeredBeamError> {
    let lap = EquivalentLap::of(damping);
    let damper = match how {
        EquivalentDamping::AtAmplitude(amplitude) => Damper::Viscous(
            lap.joint_damping_n_s_per_m(damping.viscous_damping_n_s_per_m(*amplitude)),
        ),
        EquivalentDamping::Over(range) => Damper::Dry(lap.slider_over(damping, range)?),
    };
    Ok((lap.stiffness_n_per_m, damper))
}

/// The joint's damping at the nominal torque.
#[derive(Clone, Copy, Debug)]
pub(super) enum Damper {
    /// N·s/m.
    Viscous(f64),
    /// Friction.
    Dry(DrySlider),
}

impl Damper {
    /// Its size: N·s/m, or the slip force, N.
    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Viscous(damping) => *damping,
            Self::Dry(slider) => slider.law.slip_force,
        }
    }
}

/// The file of a study whose mode has `nominal` damping, and that at each torque.
pub(super) fn lap_file(
    study: &LayeredBeamStudy,
    nominal: &SlipDamping,
    over_torque: &[(f64, SlipDamping)],
    scattered: Option<&Scattered>,
) -> Result<LapFile, LayeredBeamError> {
    let lap = EquivalentLap::of(nominal);
    let stiffness = vec![vec![lap.stiffness_n_per_m]];
    let mut joint = Joint::linear(DofSet::TRANSLATION, stiffness.clone(), Vec::new());
    let mut notes = vec![
        format!(
            "lap equivalent of mode {} of a layered beam: body a is the beam's deflection at {:.6} m from its first end, body b its mount",
            nominal.mode.number, nominal.mode.drive_point_m
        ),
        format!("alpha' mu = {:.6e}", nominal.alpha_mu),
    ];
    let (damper, worst_error, level) = match &study.damping {
        EquivalentDamping::AtAmplitude(amplitude) => {
            let at = |damping: &SlipDamping| {
                let wanted = damping.viscous_damping_n_s_per_m(*amplitude);
                lap.joint_damping_n_s_per_m(wanted)
            };
            if over_torque.is_empty() {
                joint.damping = vec![vec![at(nominal)]];
            } else {
                joint.stiffness = Vec::new();
                joint.over_preload = Some(OverPreload {
                    preload: over_torque.iter().map(|(torque, _)| *torque).collect(),
                    nominal: study.nominal_torque_n_m.unwrap_or(over_torque[0].0),
                    stiffness: vec![stiffness; over_torque.len()],
                    damping: over_torque
                        .iter()
                        .map(|(_, damping)| vec![vec![at(damping)]])
                        .collect(),
                    cubic: Vec::new(),
                    friction: Vec::new(),
                });
            }
            // ζ of the beam is amplitude₀/amplitude times that of the joint
            let (first, last) = ends(&study.amplitudes_m);
            let worst = (last / amplitude - 1.0).max(1.0 - first / amplitude);
            notes.push(format!(
                "damping is viscous and right at an amplitude of {amplitude:.4e} m: friction's ratio falls as 1/amplitude, this one does not"
            ));
            (
                Damper::Viscous(at(nominal)),
                worst,
                format!("damping at an amplitude of {amplitude:.4e} m"),
            )
        }
        EquivalentDamping::Over(range) => {
            let found = lap.slider_over(nominal, range)?;
            let none = vec![vec![0.0]];
            if over_torque.is_empty() {
                joint.damping = none;
            } else {
                let nominal_n_m = study.nominal_torque_n_m.unwrap_or(over_torque[0].0);
                for (torque, damping) in over_torque {
                    let slip_force = lap.slider_over(damping, range)?.law.slip_force;
                    in_proportion([*torque, nominal_n_m], [slip_force, found.law.slip_force])?;
                }
                joint.stiffness = Vec::new();
                joint.over_preload = Some(OverPreload {
                    preload: over_torque.iter().map(|(torque, _)| *torque).collect(),
                    nominal: nominal_n_m,
                    stiffness: vec![stiffness; over_torque.len()],
                    damping: vec![none; over_torque.len()],
                    cubic: Vec::new(),
                    friction: Vec::new(),
                });
                notes.push("the slip force is in proportion to the torque".to_owned());
            }
            joint
                .friction
                .extend(Friction::of(DofSet::TRANSLATION.row(0), &found.law));
            let smallest = lap.relative(range.from_m());
            notes.push(format!(
                "dry friction is a slider whose spring bears its slip force of {:.5e} N at {:.1} % of the smallest amplitude, {:.4e} m: so \
                 much of the heat is missing there, and less beyond; the spring makes the lap stiffer by {:.2} % there",
                found.law.slip_force,
                100.0 * found.worst_error,
                range.from_m(),
                100.0 * found.secant_n_per_m(smallest) / lap.stiffness_n_per_m
            ));
            let level = format!(
                "amplitudes from {:.4e} to {:.4e} m",
                range.from_m(),
                range.to_m()
            );
            (Damper::Dry(found), found.worst_error, level)
        }
    };
    notes.extend(study.notes.iter().cloned());
    let mode = nominal.mode.number;
    let frequency = |number: usize| study.beam.natural_frequency_hz(number);
    // a single mode stands for the beam between its neighbours; the middles of the gaps on a logarithmic axis
    let below = match mode {
        1 => 0.0,
        _ => (frequency(mode - 1) * frequency(mode)).sqrt(),
    };
    let above = (frequency(mode) * frequency(mode + 1)).sqrt();
    let file = JointFile {
        about: None,
        format: Format::V1,
        name: study.name.clone(),
        status: None,
        joint,
        bodies: Some(Bodies {
            a: lap.a.clone(),
            b: lap.b.clone(),
        }),
        uncertainty: scattered.map(Scattered::uncertainty),
        validity: Some(Validity {
            frequency_hz: [below, above],
            torque_n_m: torques(over_torque),
            level: Some(level),
        }),
        residual: None,
        provenance: Some(provenance(
            Method::LayeredBeam,
            "lap",
            vec![study.record.clone()],
            notes,
        )),
    };
    Ok(LapFile {
        file,
        lap,
        damper,
        worst_error,
    })
}

impl LapFile {
    /// ζ of the lap at an amplitude of the drive point, at the nominal torque.
    pub(super) fn damping_ratio(&self, damping: &SlipDamping, amplitude_m: f64) -> f64 {
        let c = match &self.damper {
            Damper::Viscous(c) => *c,
            Damper::Dry(slider) => slider.equivalent_n_s_per_m(self.lap.relative(amplitude_m)),
        };
        self.lap.damping_ratio(damping, c)
    }
}

fn torques(over_torque: &[(f64, SlipDamping)]) -> Option<[f64; 2]> {
    match over_torque {
        [(first, _), .., (last, _)] => Some([*first, *last]),
        _ => None,
    }
}

/// Refuses slip forces that are not in proportion to their torques, as the joint file has them.
fn in_proportion(torques_n_m: [f64; 2], slip_forces_n: [f64; 2]) -> Result<(), LayeredBeamError> {
    let [torque, nominal] = torques_n_m;
    let [slip_force, at_nominal] = slip_forces_n;
    let expected = at_nominal * torque / nominal;
    match (slip_force - expected).abs() <= IN_PROPORTION * at_nominal {
        true => Ok(()),
        false => Err(value(
            "fasteners.torque",
            format_args!("a slip force of {slip_force:.6e} N at {torque} N·m"),
            format_args!(
                "{expected:.6e} N, in proportion to the torque, or joint.damping = \"linear\""
            ),
        )),
    }
}

/// First and last of ascending amplitudes.
fn ends(amplitudes_m: &[f64]) -> (f64, f64) {
    let first = amplitudes_m.first().copied().unwrap_or(f64::NAN);
    (first, amplitudes_m.last().copied().unwrap_or(f64::NAN))
}
