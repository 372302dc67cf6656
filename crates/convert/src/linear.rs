//! Stiffness and viscous damping of a joint in the six motions of a node.

use bolted_joint_dynamics::law::Term;
use bolted_joint_dynamics::{Dof, DofKind, with_dofs};
use bolted_joint_joint::JointFile;

use crate::{ConvertError, Options, Target};

/// A matrix over x, y, z, rx, ry, rz.
pub(crate) type Matrix6 = [[f64; 6]; 6];

/// The joint as matrices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Linear {
    pub(crate) stiffness: Matrix6,
    pub(crate) damping: Matrix6,
    /// Motions that the joint resists, from 0.
    pub(crate) axes: Vec<usize>,
}

/// Which of a node's six motions a DOF is, from 0; of a joint in a plane y is along y and theta about z.
pub(crate) fn axis_of(dof: &Dof) -> usize {
    match (dof.kind, dof.name) {
        (DofKind::Translation, "x") => 0,
        (DofKind::Translation, "z") => 2,
        (DofKind::Translation, _) => 1,
        (DofKind::Rotation, "rx") => 3,
        (DofKind::Rotation, "ry") => 4,
        (DofKind::Rotation, _) => 5,
    }
}

/// Terms and laws beside stiffness and damping, as messages name them.
pub(crate) fn beyond_linear(file: &JointFile) -> Vec<String> {
    terms(file).into_iter().chain(laws(file)).collect()
}

pub(crate) fn terms(file: &JointFile) -> Vec<String> {
    let dofs = file.joint.dofs;
    let all = Term::ALL.into_iter().flat_map(|term| {
        let list = file.joint.term(term).iter().zip(dofs.rows());
        list.filter(|(value, _)| **value != 0.0)
            .map(move |(_, dof)| format!("{} on {}", term.row().symbol, dof.name))
    });
    all.collect()
}

pub(crate) fn laws(file: &JointFile) -> Vec<String> {
    let mut named: Vec<(String, usize)> = Vec::new();
    for own in &file.joint.friction {
        let name = format!("{} on {}", own.law.name, own.dof.name);
        match named.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => named.push((name, 1)),
        }
    }
    let all = named.into_iter().map(|(name, count)| match count {
        1 => name,
        count => format!("{count} times {name}"),
    });
    all.collect()
}

/// Stiffness and damping on the joint's own DOFs: as in the file, or of small motion about rest.
pub(crate) fn matrices(
    file: &JointFile,
    at_rest: bool,
) -> Result<[Vec<Vec<f64>>; 2], ConvertError> {
    with_dofs!(file.joint.dofs.size(), D => {
        let law = file.joint.law::<D>().map_err(|error| ConvertError::Law(error.to_string()))?;
        let linear = if at_rest { law.linearised_about(&[0.0; D]).linear } else { law.linear };
        Ok([linear.stiffness, linear.damping].map(|own| own.map(|row| row.to_vec()).to_vec()))
    })
}

impl Linear {
    /// # Errors
    /// [`ConvertError::NotExpressible`] of a joint that is not linear, unless it is taken at rest.
    pub(crate) fn of(
        file: &JointFile,
        target: Target,
        options: &Options,
    ) -> Result<Self, ConvertError> {
        let found = beyond_linear(file);
        if !found.is_empty() && !options.at_rest {
            return Err(ConvertError::NotExpressible {
                found,
                tool: target.name(),
                instead: "springs and dampers",
            });
        }
        let [stiffness, damping] = matrices(file, options.at_rest)?;
        let axes: Vec<usize> = file.joint.dofs.rows().map(axis_of).collect();
        let spread = |own: Vec<Vec<f64>>| {
            let mut matrix = [[0.0; 6]; 6];
            for (&i, row) in axes.iter().zip(own) {
                for (&j, value) in axes.iter().zip(row) {
                    matrix[i][j] = value * options.units.factor(i, j);
                }
            }
            matrix
        };
        Ok(Self {
            stiffness: spread(stiffness),
            damping: spread(damping),
            axes,
        })
    }

    /// Whether a motion gives a load on another.
    pub(crate) fn is_coupled(&self) -> bool {
        let entries = [&self.stiffness, &self.damping].into_iter();
        entries
            .flat_map(|matrix| (0..6).flat_map(move |i| (0..i).map(move |j| matrix[i][j])))
            .any(|value| value != 0.0)
    }

    /// Pairs of motions with each matrix' entry, each pair once, where one of them is not zero.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64, f64)> {
        let pairs = (0..6).flat_map(|i| (i + 1..6).map(move |j| (i, j)));
        pairs
            .map(|(i, j)| (i, j, self.stiffness[i][j], self.damping[i][j]))
            .filter(|(.., k, c)| *k != 0.0 || *c != 0.0)
    }
}
