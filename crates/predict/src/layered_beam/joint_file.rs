//! The joint file of a layered beam: the equivalent lap of its mode, with what it rests on.

use bolted_joint_joint::{
    Bodies, DofSet, Format, HigherTerms, Joint, JointFile, OverPreload, Validity,
};
use bolted_joint_study::{Method, provenance};

use super::amplitude_damping::AmplitudeDamping;
use super::damping::SlipDamping;
use super::error::LayeredBeamError;
use super::lap::{EquivalentDamping, EquivalentLap};
use super::scatter::Scattered;
use super::study::LayeredBeamStudy;

/// The joint file, and what is to be said about it.
#[derive(Clone, Debug)]
pub(super) struct LapFile {
    pub(super) file: JointFile,
    lap: EquivalentLap,
    damper: Damper,
    /// Largest |damping ratio of the joint/damping ratio of the beam − 1| in the range of amplitudes.
    pub(super) worst_error: f64,
}

/// Stiffness (N/m) and constant damping (N·s/m) of the joint for a mode with this damping.
pub(super) fn terms(
    damping: &SlipDamping,
    how: &EquivalentDamping,
) -> Result<(f64, f64), LayeredBeamError> {
    let lap = EquivalentLap::of(damping);
    let constant = match how {
        EquivalentDamping::AtAmplitude(amplitude) => {
            lap.joint_damping_n_s_per_m(damping.viscous_damping_n_s_per_m(*amplitude))
        }
        EquivalentDamping::Over(range) => {
            lap.joint_damping_over(damping, range)?.constant_n_s_per_m
        }
    };
    Ok((lap.stiffness_n_per_m, constant))
}

/// The joint's damping at the nominal torque.
#[derive(Clone, Copy, Debug)]
enum Damper {
    /// N·s/m.
    Viscous(f64),
    /// Over the amplitude.
    OverAmplitude(AmplitudeDamping),
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
            let found = lap.joint_damping_over(nominal, range)?;
            joint.damping = vec![vec![found.constant_n_s_per_m]];
            let amplitude = vec![lap.relative(range.to_m())];
            joint.higher = Some(HigherTerms::of(&[found.terms()], amplitude));
            notes.push(format!(
                "c + c2 r^2 + c4 r^4 in place of dry friction: its loss over a period is within {:.1} % of friction's for amplitudes from {:.4e} to {:.4e} m; below, it is less, beyond, more",
                100.0 * found.worst_error,
                range.from_m(),
                range.to_m()
            ));
            let level = format!(
                "amplitudes from {:.4e} to {:.4e} m",
                range.from_m(),
                range.to_m()
            );
            (Damper::OverAmplitude(found), found.worst_error, level)
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
            Damper::OverAmplitude(terms) => {
                terms.equivalent_n_s_per_m(self.lap.relative(amplitude_m))
            }
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

/// First and last of ascending amplitudes.
fn ends(amplitudes_m: &[f64]) -> (f64, f64) {
    let first = amplitudes_m.first().copied().unwrap_or(f64::NAN);
    (first, amplitudes_m.last().copied().unwrap_or(f64::NAN))
}
