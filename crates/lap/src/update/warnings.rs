//! What the reader of an updated lap model should know before using it.

use super::super::parameter::LapParameter;
use super::identifiability::Knowledge;
use super::{LapUpdate, TorqueUpdate};

/// Relative error of a frequency that is more than rounding.
const MISSED: f64 = 1e-6;

impl LapUpdate {
    /// The warnings.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for torque in &self.torques {
            let place = torque
                .data
                .torque_n_m
                .map(|torque| format!("at {torque} N·m: "))
                .unwrap_or_default();
            if let Some(missed) = torque.missed() {
                warnings.push(format!("{place}{missed}"));
            }
        }
        let open = |parameter: &LapParameter| {
            let mut torques = self.torques.iter();
            torques.any(|torque| !torque.knowledge(*parameter).is_known())
        };
        let unseen = [
            LapParameter::SupportDamping,
            LapParameter::JointDamping,
            LapParameter::JointCubic,
        ];
        let unseen = unseen.iter().filter(|parameter| open(parameter));
        let unseen: Vec<&str> = unseen.map(|parameter| parameter.symbol()).collect();
        if !unseen.is_empty() {
            warnings.push(format!(
                "{} cannot be identified from natural frequencies, which do not depend on them; method \"lap-response\" identifies them from responses at several levels",
                unseen.join(", ")
            ));
        }
        let masses = open(&LapParameter::Mass) || open(&LapParameter::SupportStiffness);
        if masses {
            warnings.push(
                "natural frequencies give only ratios such as k/m and k12/m: state a mass in [known] to identify the stiffnesses".to_owned(),
            );
        }
        warnings
    }
}

impl TorqueUpdate {
    /// Why the measured frequencies cannot be had within the bounds, if they cannot.
    #[must_use]
    pub fn missed(&self) -> Option<String> {
        let errors = self.problem.errors(&self.solution);
        let worst = errors.iter().map(|error| error.abs()).fold(0.0, f64::max);
        if worst < MISSED {
            return None;
        }
        let held = LapParameter::ALL.into_iter();
        let held = held.filter(|parameter| self.knowledge(*parameter) == Knowledge::AtBound);
        let held: Vec<&str> = held.map(LapParameter::symbol).collect();
        Some(format!(
            "no parameters within the bounds have the measured frequencies: the best miss them by up to {:.1} %, with {} at a bound",
            100.0 * worst,
            if held.is_empty() {
                "none".to_owned()
            } else {
                held.join(", ")
            }
        ))
    }
}
