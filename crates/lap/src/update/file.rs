//! Joint files of an updated lap model: what the frequencies do not determine stands there at its prior and is named as such.

use super::super::parameter::{LapParameter, LapParameters};
use super::identifiability::Knowledge;
use super::problem::Range;
use super::{LapUpdate, TorqueUpdate};
use bolted_joint_joint::{
    Bodies, Body, DofSet, Format, Joint, JointFile, OverPreload, Residual, StandardDeviation,
    Status, Uncertainty, UncertaintyAtPreload, UncertaintyOverPreload, Validity,
};

impl LapUpdate {
    /// The joint files with their torques. The file's bodies do not depend on the preload, so torques at which the bodies came
    /// out different have a file each; where the bodies are known, and so the same, there is one file over the preload.
    #[must_use]
    pub fn joint_files(&self) -> Vec<(Option<f64>, JointFile)> {
        let bodies_known = [
            LapParameter::SupportStiffness,
            LapParameter::Mass,
            LapParameter::SupportDamping,
        ]
        .iter()
        .all(|parameter| {
            let first = self.torques.first();
            let values = self
                .torques
                .iter()
                .map(|torque| torque.file_value(*parameter));
            let first = first.map(|torque| torque.file_value(*parameter));
            values.into_iter().all(|value| Some(value) == first)
        });
        if self.torques.len() > 1 && bodies_known {
            return self
                .over_preload()
                .map(|file| (None, file))
                .into_iter()
                .collect();
        }
        let files = self
            .torques
            .iter()
            .map(|torque| (torque.data.torque_n_m, self.file(torque)));
        files.collect()
    }

    fn file(&self, torque: &TorqueUpdate) -> JointFile {
        let name = match torque.data.torque_n_m {
            Some(torque) if self.torques.len() > 1 => format!("{}, {torque} N·m", self.name),
            _ => self.name.clone(),
        };
        let at = torque.uncertainty();
        JointFile {
            about: None,
            format: Format::V1,
            name,
            status: Status::against(torque.reason_against().as_slice()),
            joint: Joint {
                cubic: vec![torque.file_value(LapParameter::JointCubic)],
                ..Joint::linear(
                    DofSet::TRANSLATION,
                    vec![vec![torque.file_value(LapParameter::JointStiffness)]],
                    vec![vec![torque.file_value(LapParameter::JointDamping)]],
                )
            },
            bodies: Some(torque.bodies()),
            uncertainty: Some(Uncertainty {
                standard_deviation: at.standard_deviation,
                basis: basis(),
                not_identified: at.not_identified,
                ..Uncertainty::default()
            }),
            validity: Some(validity(&[torque])),
            residual: Some(residual(&[torque])),
            provenance: Some(self.provenance.clone()),
        }
    }

    fn over_preload(&self) -> Option<JointFile> {
        let nominal = self.torques.last()?;
        let each = |of: fn(&TorqueUpdate) -> f64| self.torques.iter().map(of);
        let all: Vec<&TorqueUpdate> = self.torques.iter().collect();
        let mut file = self.file(nominal);
        file.name.clone_from(&self.name);
        file.status = Status::against(&self.reasons_against());
        file.joint = Joint {
            stiffness: Vec::new(),
            damping: Vec::new(),
            cubic: Vec::new(),
            over_preload: Some(OverPreload {
                preload: each(|torque| torque.data.torque_n_m.unwrap_or(0.0)).collect(),
                nominal: nominal.data.torque_n_m.unwrap_or(0.0),
                stiffness: each(|torque| torque.file_value(LapParameter::JointStiffness))
                    .map(|value| vec![vec![value]])
                    .collect(),
                damping: each(|torque| torque.file_value(LapParameter::JointDamping))
                    .map(|value| vec![vec![value]])
                    .collect(),
                cubic: each(|torque| torque.file_value(LapParameter::JointCubic))
                    .map(|value| vec![value])
                    .collect(),
                friction: Vec::new(),
            }),
            ..file.joint
        };
        file.validity = Some(validity(&all));
        file.residual = Some(residual(&all));
        if let Some(uncertainty) = &mut file.uncertainty {
            uncertainty.over_preload = Some(UncertaintyOverPreload {
                at: all.iter().map(|torque| torque.uncertainty()).collect(),
                correlation: None,
            });
        }
        Some(file)
    }
}

impl TorqueUpdate {
    /// The value that goes into a file: the solution's; of a cubic spring, which frequencies cannot see, only one that the study
    /// states, otherwise none.
    #[must_use]
    pub fn file_value(&self, parameter: LapParameter) -> f64 {
        match (parameter, self.problem.ranges[parameter as usize]) {
            (LapParameter::JointCubic, Range::Known(value)) => value,
            (LapParameter::JointCubic, Range::Between { prior, .. }) => prior.unwrap_or(0.0),
            _ => self.solution.of(parameter),
        }
    }

    /// The symbols of the parameters that the frequencies do not determine by themselves.
    #[must_use]
    pub fn not_identified(&self) -> Vec<&'static str> {
        let of = LapParameter::ALL.into_iter();
        let open =
            of.filter(|parameter| !self.identifiability.parameters[*parameter as usize].is_known());
        open.map(LapParameter::symbol).collect()
    }

    fn bodies(&self) -> Bodies {
        let body = Body {
            inertia: vec![self.file_value(LapParameter::Mass)],
            stiffness: vec![self.file_value(LapParameter::SupportStiffness)],
            damping: vec![self.file_value(LapParameter::SupportDamping)],
        };
        Bodies {
            a: body.clone(),
            b: body,
        }
    }

    fn uncertainty(&self) -> UncertaintyAtPreload {
        UncertaintyAtPreload {
            preload: self.data.torque_n_m.unwrap_or(0.0),
            standard_deviation: StandardDeviation {
                stiffness: vec![vec![self.deviation(LapParameter::JointStiffness)]],
                damping: vec![vec![self.deviation(LapParameter::JointDamping)]],
                ..StandardDeviation::default()
            },
            not_identified: self
                .not_identified()
                .into_iter()
                .map(str::to_owned)
                .collect(),
            ..UncertaintyAtPreload::default()
        }
    }

    /// That of the estimate, or of an even distribution between the bounds.
    fn deviation(&self, parameter: LapParameter) -> f64 {
        let place = parameter as usize;
        let stated = self.identifiability.standard_deviation[place];
        match (stated, self.problem.ranges[place]) {
            (Some(deviation), _) => deviation,
            // (b − a)/√12
            (None, Range::Between { low, high, .. }) => (high - low) / 12_f64.sqrt(),
            (None, _) => 0.0,
        }
    }

    /// Whether a parameter is known.
    #[must_use]
    pub fn knowledge(&self, parameter: LapParameter) -> Knowledge {
        self.identifiability.parameters[parameter as usize]
    }

    /// The frequencies of some parameters, as many as were measured, rad/s.
    #[must_use]
    pub fn frequencies(&self, parameters: &LapParameters) -> Vec<f64> {
        let count = self.data.omega_rad_per_s.len();
        parameters.natural_frequencies()[..count].to_vec()
    }
}

fn basis() -> String {
    "parameters that the frequencies determine: their stated deviation; the others, listed as not identified: an even distribution between their bounds"
        .to_owned()
}

fn validity(torques: &[&TorqueUpdate]) -> Validity {
    let ends = |values: &mut dyn Iterator<Item = f64>| {
        values.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], value| {
            [low.min(value), high.max(value)]
        })
    };
    let omega = torques
        .iter()
        .flat_map(|torque| &torque.data.omega_rad_per_s);
    let mut hz = omega.map(|omega| omega / std::f64::consts::TAU);
    let frequency_hz = ends(&mut hz);
    let stated = torques
        .iter()
        .all(|torque| torque.data.torque_n_m.is_some());
    let mut known = torques.iter().filter_map(|torque| torque.data.torque_n_m);
    Validity {
        frequency_hz,
        torque_n_m: stated.then(|| ends(&mut known)),
        level: Some("natural frequencies of small vibration".to_owned()),
    }
}

fn residual(torques: &[&TorqueUpdate]) -> Residual {
    let errors = torques
        .iter()
        .flat_map(|torque| torque.problem.errors(&torque.solution));
    let errors: Vec<f64> = errors.collect();
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    Residual {
        relative_rms: (squares / errors.len().max(1) as f64).sqrt(),
        lines: errors.len(),
        ..Residual::default()
    }
}
