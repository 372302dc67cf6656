//! Whether a joint from natural frequencies may be relied on: its stiffness has to be more than a prior or a bound.

use super::super::parameter::LapParameter;
use super::identifiability::Knowledge;
use super::{LapUpdate, TorqueUpdate};

impl LapUpdate {
    /// What speaks against the joints, a line for each torque; empty if nothing does.
    #[must_use]
    pub fn reasons_against(&self) -> Vec<String> {
        let of = |torque: &TorqueUpdate| {
            let reason = torque.reason_against()?;
            Some(match torque.data.torque_n_m {
                Some(torque) => format!("at {torque} N·m: {reason}"),
                None => reason,
            })
        };
        self.torques.iter().filter_map(of).collect()
    }
}

impl TorqueUpdate {
    /// Why the joint at this torque is not to be relied on, if it is not.
    #[must_use]
    pub fn reason_against(&self) -> Option<String> {
        let joint = LapParameter::JointStiffness;
        let knowledge = self.knowledge(joint);
        if knowledge.is_known() {
            return None;
        }
        let advice = match knowledge {
            Knowledge::AtBound | Knowledge::FromBounds => {
                "correct the frequencies or widen [bounds], and state m in [known]"
            }
            _ if self.data.omega_rad_per_s.len() < 2 => {
                "give both frequencies, and state m in [known]"
            }
            _ => "state m in [known]",
        };
        Some(format!(
            "the frequencies do not determine {} ({}); {advice}",
            joint.symbol(),
            knowledge.words()
        ))
    }
}
