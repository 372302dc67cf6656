//! Why a number of the joint will not be determined.

use std::fmt;

use bolted_joint_space::{Dof, Entry};

/// Why a number of the joint will not be determined.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Neither sensors nor impacts have to do with these motions of the joint.
    NoMotion(Vec<Dof>),
    /// No sensor moves with them.
    NoSensor(Vec<Dof>),
    /// No impact moves them.
    NoImpact(Vec<Dof>),
    /// What it does to the functions is less than their noise, even with every other number known.
    Faint,
    /// Others do the same to the functions; those that are most alike.
    Alike(Vec<String>),
    /// Errors of these sensors or impacts do the same.
    SetUp(String),
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |dofs: &[Dof]| {
            let names: Vec<String> = dofs.iter().map(ToString::to_string).collect();
            names.join(" and ")
        };
        match self {
            Self::NoMotion(dofs) => write!(
                f,
                "no motion: no impact moves the joint in {}, and no sensor sees it",
                list(dofs)
            ),
            Self::NoSensor(dofs) => write!(f, "no sensor moves with the joint's {}", list(dofs)),
            Self::NoImpact(dofs) => write!(f, "no impact moves the joint in {}", list(dofs)),
            Self::Faint => f.write_str("it changes the functions less than their noise"),
            Self::Alike(names) => write!(f, "it looks like {}", names.join(", ")),
            Self::SetUp(group) => write!(f, "errors of the {group} look like it"),
        }
    }
}

/// What sensors see of each motion of a joint, and impacts make of it, in parts of the largest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) by_sensors: [f64; 6],
    pub(super) by_impacts: [f64; 6],
}

/// Motions below this part of the largest are none.
const NOTHING: f64 = 1e-6;

impl Seen {
    /// What is missing for a number that couples these motions: it changes functions by a_p b_q + a_q b_p.
    pub(super) fn missing(&self, entry: &Entry) -> Option<Reason> {
        let mut dofs = vec![entry.row, entry.column];
        dofs.dedup();
        let without = |seen: &[f64; 6]| -> Vec<Dof> {
            let own = dofs.iter().copied();
            own.filter(|dof| seen[dof.index()] <= NOTHING).collect()
        };
        let (sensors, impacts) = (without(&self.by_sensors), without(&self.by_impacts));
        let both: Vec<Dof> = sensors
            .iter()
            .copied()
            .filter(|dof| impacts.contains(dof))
            .collect();
        // a_p b_q is there where one of both is seen and the other one moved
        let has_all = |missing: &[Dof]| missing.len() == dofs.len();
        if !both.is_empty() {
            Some(Reason::NoMotion(both))
        } else if has_all(&sensors) {
            Some(Reason::NoSensor(sensors))
        } else if has_all(&impacts) {
            Some(Reason::NoImpact(impacts))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coupling_needs_one_motion_seen_and_the_other_made() {
        let mut seen = Seen {
            by_sensors: [1.0; 6],
            by_impacts: [1.0; 6],
        };
        let entry = Entry::new(Dof::X, Dof::Ry);
        assert_eq!(seen.missing(&entry), None);
        seen.by_sensors[0] = 0.0;
        assert_eq!(seen.missing(&entry), None);
        let own = Entry::new(Dof::X, Dof::X);
        assert_eq!(seen.missing(&own), Some(Reason::NoSensor(vec![Dof::X])));
        seen.by_sensors[4] = 1e-9;
        assert_eq!(
            seen.missing(&entry),
            Some(Reason::NoSensor(vec![Dof::X, Dof::Ry]))
        );
        seen.by_impacts[4] = 0.0;
        assert_eq!(seen.missing(&entry), Some(Reason::NoMotion(vec![Dof::Ry])));
    }
}
