//! A chain with one joint that is sought, as two sides: the known joints are coupled into them.
//!
//! Y_C = Y − Y Sᵀ D (I + S Y Sᵀ D)⁻¹ S Y with S and D of the known joints of a side. Errors of sensors and impacts at these are not
//! carried on; those at the joint that is sought are.

use bolted_joint_frf::Dof;
use bolted_joint_study::StudyError;
use nalgebra::DVector;

use super::part::{Part, PartInterface};
use super::study::{ChainStudy, sides};
use crate::assembled::Assembled;
use crate::links::{Link, Links};
use crate::prior::Common;
use crate::problem::{Problem, Unknowns};
use crate::side::{Anew, Interface, Placed, Side};

impl ChainStudy {
    /// What is before the joint that is sought, what is behind it, and the joint.
    pub(crate) fn two_sides(&self) -> Result<([Side; 2], Link), StudyError> {
        let sought = self.problem.links.sought();
        let [joint] = sought.as_slice() else {
            return self.text.refuse(
                "joint",
                format_args!("{} joints that are sought", sought.len()),
                "one with a model; the others are known",
            );
        };
        let at = joint.number;
        let before = self.side(&self.parts[..=at], &self.problem.links.0[..at], at, false)?;
        let behind = self.side(
            &self.parts[at + 1..],
            &self.problem.links.0[at + 1..],
            at,
            true,
        )?;
        Ok(([before, behind], joint.link.clone()))
    }

    /// A remark on interfaces at known joints with sensors or impacts, where set-ups have errors: those of these take no part.
    pub(crate) fn at_known_joints(&self) -> Option<String> {
        self.problem.tolerances.as_ref()?;
        let sought: Vec<usize> = (self.problem.links.sought().iter())
            .map(|joint| joint.number)
            .collect();
        let known = (0..self.problem.links.0.len()).filter(|number| !sought.contains(number));
        let both = known.flat_map(|number| {
            [
                interface_at(&self.parts[number], number, false),
                interface_at(&self.parts[number + 1], number, true),
            ]
        });
        let names: Vec<&str> = both
            .filter(|one| !(one.sensors.is_empty() && one.impacts.is_empty()))
            .map(|one| one.name.as_str())
            .collect();
        (!names.is_empty()).then(|| {
            format!(
                "{}: errors of sensors and impacts at a known joint take no part in the estimate, which takes these as exact: deviations \
                 are too small by what they do, and one that is a millimetre off can spoil the result; best are functions of its six \
                 motions there (interface = NODE)",
                names.join(", ")
            )
        })
    }

    /// Parts with known joints between them, the channels and impacts of one interface first.
    fn side(
        &self,
        parts: &[Part],
        links: &[Link],
        at: usize,
        is_behind: bool,
    ) -> Result<Side, StudyError> {
        // the end at the joint that is sought
        let place = if is_behind { 0 } else { parts.len() - 1 };
        let end = &parts[place];
        let own = interface_at(end, at, is_behind);
        let interface = own
            .checked(&self.text)?
            .map_or(Interface::Node(own.motions), Interface::Points);
        let frequency_hz = &self.problem.frequency_hz;
        if parts.len() == 1 {
            return end.side(&self.text, frequency_hz);
        }
        // the other interfaces are at known joints
        let mut parts = parts.to_vec();
        parts[place]
            .interfaces
            .retain(|interface| interface.name != own.name);
        parts[place].beside = Some(own.clone());
        let problem = Problem {
            sides: sides(&self.text, &parts, frequency_hz)?,
            frequency_hz: frequency_hz.clone(),
            observed: Vec::new(),
            links: Links(links.to_vec()),
            tolerances: None,
            wider: Vec::new(),
            common: Common::default(),
            balance: None,
        };
        let [a, b] = &problem.sides;
        // the end part is the first of its side, or the last one
        let first_of = |which: usize| {
            let [own_side, skip] = match (place % 2, which) {
                (0, 0) => [a.responses.len(), 0],
                (0, _) => [a.references.len(), 0],
                (_, 0) => [b.responses.len(), a.responses.len()],
                (_, _) => [b.references.len(), a.references.len()],
            };
            match is_behind {
                true => skip,
                false => skip + own_side - parts[place].counts()[which],
            }
        };
        let order = |which: usize, count: usize| -> Vec<usize> {
            let near = first_of(which)..first_of(which) + own.counts()[which];
            let rest = (0..count).filter(|row| !near.contains(row));
            near.clone().chain(rest).collect()
        };
        let responses = [&a.responses[..], &b.responses].concat();
        let references = [&a.references[..], &b.references].concat();
        let rows = order(0, responses.len());
        let columns = order(1, references.len());
        let refused = |source| StudyError::model(self.text.path(), Some("joint"), source);
        let none = Unknowns(DVector::zeros(0));
        let assembled = Assembled::new(&problem, &none).map_err(refused)?;
        let mut lines = Vec::new();
        for line in 0..frequency_hz.len() {
            let whole = assembled.whole(line).map_err(refused)?;
            let all = whole.receptance();
            lines.push(all.select_rows(&rows).select_columns(&columns));
        }
        let dofs = |all: &[Dof], order: &[usize]| order.iter().map(|&n| all[n]).collect();
        Ok(Side {
            responses: dofs(&responses, &rows),
            references: dofs(&references, &columns),
            lines,
            noise: Vec::new(),
            interfaces: vec![Placed {
                name: own.name.clone(),
                first: [0, 0],
                interface,
                seen: None,
                struck: None,
            }],
            anew: Anew::default(),
        })
    }
}

/// The interface of a part at the joint that is sought.
fn interface_at(part: &Part, at: usize, is_behind: bool) -> &PartInterface {
    match (is_behind, at) {
        // behind the joint, and on the first part, it is the one interface that is not far
        (true, _) | (false, 0) => &part.interfaces[0],
        (false, _) => &part.interfaces[part.interfaces.len() - 1],
    }
}
