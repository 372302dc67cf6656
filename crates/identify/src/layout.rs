//! Where the unknowns of one or more bolts stand in the matrices of the whole joint (Tol 3.27).
//!
//! K* of several bolts is block diagonal. Bolts that are alike have one set of unknowns, which stands in every block;
//! bolts that differ have one set each.

use nalgebra::DMatrix;

use super::model::{JointMatrices, JointModel};

/// Most bolts that one joint can have.
pub const MOST_BOLTS: usize = 8;

/// The bolts between two substructures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Bolts {
    /// One.
    #[default]
    One,
    /// Several, by name, with the same joint at each.
    Alike(Vec<String>),
    /// Several, by name, each with a joint of its own.
    Different(Vec<String>),
}

impl Bolts {
    /// How many bolts there are.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::One => 1,
            Self::Alike(names) | Self::Different(names) => names.len(),
        }
    }

    /// Names of the bolts that have a joint of their own; empty where there is one joint for all.
    #[must_use]
    pub fn with_own_joint(&self) -> &[String] {
        match self {
            Self::Different(names) => names,
            Self::One | Self::Alike(_) => &[],
        }
    }

    /// Names of all bolts; empty for one.
    #[must_use]
    pub fn names(&self) -> &[String] {
        match self {
            Self::One => &[],
            Self::Alike(names) | Self::Different(names) => names,
        }
    }

    /// How many joints are unknown.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.with_own_joint().len().max(1)
    }
}

/// The entry of K* that an unknown is, above or on the diagonal, and its copies in the blocks of further bolts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    row: usize,
    column: usize,
    /// Blocks that hold it.
    copies: usize,
    /// DOFs of a bolt.
    stride: usize,
}

impl Place {
    /// Row and column in the first block that holds it.
    pub(super) fn first(self) -> (usize, usize) {
        (self.row, self.column)
    }

    /// Row and column in every block that holds it.
    pub(super) fn all(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.copies).map(move |copy| {
            let start = copy * self.stride;
            (self.row + start, self.column + start)
        })
    }

    /// Whether one block alone holds it.
    pub(super) fn is_single(self) -> bool {
        self.copies == 1
    }

    /// The DOF of a bolt whose diagonal entry this is.
    pub(super) fn diagonal_dof(self) -> Option<usize> {
        (self.row == self.column).then_some(self.row % self.stride)
    }
}

/// The unknowns of a joint model at one or more bolts: the stiffness of each entry of each joint, then the damping.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    model: JointModel,
    /// DOFs of a bolt in the data; more than the model's where it leaves the rotation free.
    dofs: usize,
    bolts: usize,
    alike: bool,
}

impl Layout {
    /// Of data whose joint has `dofs` DOFs in all; `None` where these are not those of so many bolts with this model.
    pub(super) fn new(model: JointModel, bolts: &Bolts, dofs: usize) -> Option<Self> {
        let count = bolts.count();
        let fits = (1..=MOST_BOLTS).contains(&count) && dofs.is_multiple_of(count);
        let layout = Self::of_bolts(model, bolts, dofs / count.max(1));
        let of_a_bolt = model.dofs()..=JointModel::Full.dofs();
        (fits && of_a_bolt.contains(&layout.dofs)).then_some(layout)
    }

    /// Of data whose joint has so many DOFs at each bolt.
    pub(super) fn of_bolts(model: JointModel, bolts: &Bolts, dofs_of_a_bolt: usize) -> Self {
        Self {
            model,
            dofs: dofs_of_a_bolt,
            bolts: bolts.count(),
            alike: !matches!(bolts, Bolts::Different(_)),
        }
    }

    /// Of bolts that differ, each with the DOFs of the model.
    pub(super) fn of_different(model: JointModel, bolts: usize) -> Self {
        Self {
            model,
            dofs: model.dofs(),
            bolts,
            alike: false,
        }
    }

    pub(super) fn model(&self) -> JointModel {
        self.model
    }

    /// Of another joint model at the same bolts; `None` where the data lack its rotation.
    pub(super) fn with_model(&self, model: JointModel) -> Option<Self> {
        (model.dofs() <= self.dofs).then(|| Self {
            model,
            ..self.clone()
        })
    }

    /// With the same joint at every bolt.
    pub(super) fn with_bolts_alike(&self) -> Self {
        Self {
            alike: true,
            ..self.clone()
        }
    }

    /// DOFs of a bolt in the data.
    pub(super) fn dofs_of_a_bolt(&self) -> usize {
        self.dofs
    }

    /// Bolts.
    pub(super) fn bolts(&self) -> usize {
        self.bolts
    }

    /// Joints that are unknown.
    pub(super) fn joints(&self) -> usize {
        if self.alike { 1 } else { self.bolts }
    }

    /// The bolts that have joint number `joint`.
    pub(super) fn bolts_with(&self, joint: usize) -> std::ops::Range<usize> {
        if self.alike {
            0..self.bolts
        } else {
            joint..joint + 1
        }
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.joints() * self.model.unknowns()
    }

    /// DOFs of the whole joint that the model makes use of: rows and columns of K*.
    pub(super) fn used_dofs(&self) -> Vec<usize> {
        let of_bolt = |bolt: usize| (0..self.model.dofs()).map(move |dof| bolt * self.dofs + dof);
        (0..self.bolts).flat_map(of_bolt).collect()
    }

    /// The entries of K* that are unknown, joint by joint.
    pub(super) fn places(&self) -> Vec<Place> {
        let of_joint = |joint: usize| {
            let entries = self.model.entries().iter();
            entries.map(move |&(row, column)| Place {
                row: joint * self.dofs + row,
                column: joint * self.dofs + column,
                copies: if self.alike { self.bolts } else { 1 },
                stride: self.dofs,
            })
        };
        (0..self.joints()).flat_map(of_joint).collect()
    }

    /// Every entry of K* over the DOFs that the model makes use of, above and on the diagonal, whether it is unknown or zero:
    /// what decoupling solves for.
    pub(super) fn decoupled_places(&self) -> Vec<Place> {
        let used = self.used_dofs();
        let of_column = |column: usize| {
            let place = |row: &usize| Place {
                row: *row,
                column: used[column],
                copies: 1,
                stride: self.dofs,
            };
            used[..=column].iter().map(place).collect::<Vec<_>>()
        };
        (0..used.len()).flat_map(of_column).collect()
    }

    /// The matrices of each joint from the unknowns.
    pub(super) fn matrices(&self, unknowns: &[f64]) -> Vec<JointMatrices> {
        let of = |joint| JointMatrices::from_unknowns(self.model, &self.of_joint(unknowns, joint));
        (0..self.joints()).map(of).collect()
    }

    /// The unknowns, or what belongs to them, of one joint alone.
    pub(super) fn of_joint<T: Copy>(&self, values: &[T], joint: usize) -> Vec<T> {
        let indices = self.indices_of(joint);
        indices.into_iter().map(|index| values[index]).collect()
    }

    /// Where the unknowns of one joint stand among all.
    pub(super) fn indices_of(&self, joint: usize) -> Vec<usize> {
        let (entries, all) = (self.model.entries().len(), self.places().len());
        let half = |start: usize| start + joint * entries..start + (joint + 1) * entries;
        half(0).chain(half(all)).collect()
    }

    /// The unknowns from the matrices of each joint; one joint stands for all.
    pub(super) fn unknowns_of(&self, joints: &[JointMatrices]) -> Option<Vec<f64>> {
        let own: Vec<Vec<f64>> = (0..self.joints())
            .map(|joint| {
                let matrices = joints.get(joint).or(joints.first())?;
                Some(matrices.unknowns(self.model))
            })
            .collect::<Option<_>>()?;
        let entries = self.model.entries().len();
        let stiffness = own.iter().flat_map(|unknowns| &unknowns[..entries]);
        let damping = own.iter().flat_map(|unknowns| &unknowns[entries..]);
        Some(stiffness.chain(damping).copied().collect())
    }

    /// K and C of the whole joint, block diagonal over the bolts, zero where the model has nothing.
    pub(super) fn whole(&self, joints: &[JointMatrices]) -> JointMatrices {
        let padded = |matrix: &DMatrix<f64>| matrix.clone().resize(self.dofs, self.dofs, 0.0);
        let bolts: Vec<JointMatrices> = (0..self.bolts)
            .filter_map(|bolt| joints.get(bolt).filter(|_| !self.alike).or(joints.first()))
            .map(|joint| JointMatrices {
                stiffness: padded(&joint.stiffness),
                damping: padded(&joint.damping),
            })
            .collect();
        JointMatrices::of_bolts(&bolts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    fn numbered(layout: &Layout) -> Vec<f64> {
        (1..=layout.unknowns()).map(|i| i as f64).collect()
    }

    #[test]
    fn bolts_that_are_alike_have_their_unknowns_in_every_block() {
        let bolts = Bolts::Alike(names(&["left", "right"]));
        let layout = Layout::new(JointModel::Full, &bolts, 4).unwrap();
        assert_eq!((layout.joints(), layout.unknowns()), (1, 6));
        let places: Vec<Vec<(usize, usize)>> =
            layout.places().iter().map(|p| p.all().collect()).collect();
        assert_eq!(
            places,
            [[(0, 0), (2, 2)], [(0, 1), (2, 3)], [(1, 1), (3, 3)]]
        );
        let joints = layout.matrices(&numbered(&layout));
        let whole = layout.whole(&joints);
        assert_eq!(whole.bolts(2), [joints[0].clone(), joints[0].clone()]);
        assert_eq!(layout.unknowns_of(&joints).unwrap(), numbered(&layout));
    }

    #[test]
    fn bolts_that_differ_have_unknowns_of_their_own() {
        let bolts = Bolts::Different(names(&["left", "right"]));
        let layout = Layout::new(JointModel::Diagonal, &bolts, 4).unwrap();
        assert_eq!((layout.joints(), layout.unknowns()), (2, 8));
        let places: Vec<(usize, usize)> = layout.places().iter().map(|p| p.first()).collect();
        assert_eq!(places, [(0, 0), (1, 1), (2, 2), (3, 3)]);
        // Stiffnesses 1 2 | 3 4, dampings 5 6 | 7 8.
        let joints = layout.matrices(&numbered(&layout));
        assert_eq!(joints[1].stiffness, nalgebra::dmatrix![3.0, 0.0; 0.0, 4.0]);
        assert_eq!(joints[0].damping, nalgebra::dmatrix![5.0, 0.0; 0.0, 6.0]);
        assert_eq!(layout.indices_of(1), [2, 3, 6, 7]);
        assert_eq!(layout.unknowns_of(&joints).unwrap(), numbered(&layout));
        assert_eq!(layout.whole(&joints).bolts(2), joints);
    }

    #[test]
    fn a_model_without_rotation_leaves_it_free() {
        let bolts = Bolts::Alike(names(&["left", "right"]));
        let layout = Layout::new(JointModel::Translation, &bolts, 4).unwrap();
        assert_eq!(layout.used_dofs(), [0, 2]);
        let whole = layout.whole(&layout.matrices(&[5.0, 7.0]));
        assert_eq!(whole.stiffness.diagonal().as_slice(), [5.0, 0.0, 5.0, 0.0]);
        assert!(Layout::new(JointModel::Full, &bolts, 2).is_none());
        assert!(Layout::new(JointModel::Full, &bolts, 5).is_none());
        assert!(Layout::new(JointModel::Full, &Bolts::One, 4).is_none());
    }
}
