//! The unknowns of a joint by name and unit: the names that they have in the FMU.

use super::model::{JointMatrices, JointModel};

/// One unknown of a joint, an entry of K or C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unknown {
    /// Its name in the FMU, without the prefix `joint.`.
    pub name: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Number of the joint that it belongs to: 0 unless every bolt has one of its own.
    pub joint: usize,
    matrix: Matrix,
    place: (usize, usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Matrix {
    Stiffness,
    Damping,
}

impl Unknown {
    /// The unknowns of a joint model: stiffnesses, then dampings.
    #[must_use]
    pub fn of(model: JointModel) -> Vec<Self> {
        Self::of_joints(model, 1)
    }

    /// The unknowns of several joints of one model: stiffnesses, joint by joint, then dampings.
    #[must_use]
    pub fn of_joints(model: JointModel, joints: usize) -> Vec<Self> {
        let of = |matrix| {
            (0..joints).flat_map(move |joint| {
                let entries = model.entries().iter();
                entries.map(move |&place| Self::named(matrix, place, joint))
            })
        };
        [Matrix::Stiffness, Matrix::Damping]
            .into_iter()
            .flat_map(of)
            .collect()
    }

    /// Whether it is a diagonal entry of K.
    #[must_use]
    pub fn is_direct_stiffness(&self) -> bool {
        self.matrix == Matrix::Stiffness && self.place.0 == self.place.1
    }

    /// Its name, after that of its bolt where `bolts` have joints of their own: `left k_yy`.
    #[must_use]
    pub fn label(&self, bolts: &[String]) -> String {
        match bolts.get(self.joint) {
            Some(bolt) => format!("{bolt} {}", self.name),
            None => self.name.to_owned(),
        }
    }

    fn named(matrix: Matrix, place: (usize, usize), joint: usize) -> Self {
        let (name, unit) = match (matrix, place) {
            (Matrix::Stiffness, (0, 0)) => ("k_yy", "N/m"),
            (Matrix::Stiffness, (1, 1)) => ("k_thetatheta", "N·m/rad"),
            (Matrix::Stiffness, _) => ("k_ytheta", "N/rad"),
            (Matrix::Damping, (0, 0)) => ("c_yy", "N·s/m"),
            (Matrix::Damping, (1, 1)) => ("c_thetatheta", "N·m·s/rad"),
            (Matrix::Damping, _) => ("c_ytheta", "N·s/rad"),
        };
        Self {
            name,
            unit,
            joint,
            matrix,
            place,
        }
    }

    /// Its value in the matrices of its joint.
    #[must_use]
    pub fn value(&self, joint: &JointMatrices) -> f64 {
        self.entry(joint, self.place)
    }

    /// The largest value beside which a passive joint could have it, √(A_ii A_jj): its own size on the diagonal.
    pub(super) fn passive_bound(&self, joint: &JointMatrices) -> f64 {
        let (row, column) = self.place;
        let product = self.entry(joint, (row, row)) * self.entry(joint, (column, column));
        product.max(0.0).sqrt()
    }

    fn entry(&self, joint: &JointMatrices, place: (usize, usize)) -> f64 {
        match self.matrix {
            Matrix::Stiffness => joint.stiffness[place],
            Matrix::Damping => joint.damping[place],
        }
    }
}
