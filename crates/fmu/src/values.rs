//! Everything that an instance holds as numbers: its variables, what it remembers beside them, and what its joint
//! remembers.

use std::ops::{Deref, DerefMut};

use bolted_joint_dynamics::{
    DOF_AT_REST, DofMemory, JointLaw, JointMemory, Motion,
    law::{DOF_MEMORY_COUNT, REMEMBERED_PLACES},
};

use crate::interface::{VALUE_COUNT, Variables, first_row, reference::LAW_MEMORY};

/// Values of all variables of an FMU by value reference, and after them what it remembers beside them.
///
/// What the laws of the joint remember stands apart, and only in FMUs whose joint remembers anything: it is long.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    numbers: [f64; VALUE_COUNT],
    /// Of each DOF of a joint with memory.
    joint: Vec<DofMemory>,
}

impl Deref for Values {
    type Target = [f64; VALUE_COUNT];

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.numbers
    }
}

impl DerefMut for Values {
    #[inline]
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.numbers
    }
}

impl Values {
    /// All zero, and no joint that remembers: a direction of change.
    #[inline]
    pub(crate) fn zero() -> Self {
        Self {
            numbers: [0.0; VALUE_COUNT],
            joint: Vec::new(),
        }
    }

    /// These values of an FMU with these variables, whose joint has not moved yet.
    pub(crate) fn at_rest(numbers: [f64; VALUE_COUNT], variables: Variables) -> Self {
        Self {
            numbers,
            joint: vec![DOF_AT_REST; remembering_dofs(variables)],
        }
    }

    /// The same joint with other values of the variables.
    pub(crate) fn with(&self, numbers: [f64; VALUE_COUNT]) -> Self {
        Self {
            numbers,
            joint: self.joint.clone(),
        }
    }

    /// What the joint remembers.
    #[inline]
    pub(crate) fn joint<const D: usize>(&self) -> &JointMemory<D> {
        let at_rest = &const { [DOF_AT_REST; D] };
        self.joint.first_chunk().unwrap_or(at_rest)
    }

    /// Lets `change` change what the joint remembers, and shows it in the variables.
    pub(crate) fn change_joint<const D: usize, T>(
        &mut self,
        change: impl FnOnce(&mut JointMemory<D>) -> T,
    ) -> Option<T> {
        let joint = self.joint.first_chunk_mut::<D>()?;
        let result = change(joint);
        for (references, own) in LAW_MEMORY[first_row::<D>()..].iter().zip(joint) {
            for (&reference, place) in references.iter().zip(REMEMBERED_PLACES) {
                self.numbers[reference] = own[place];
            }
        }
        Some(result)
    }

    /// Moves what the joint remembers on to a relative motion, and returns the heat of that way, J; `None` where a number is
    /// no finite one any more: then nothing has moved.
    pub(crate) fn commit_joint<const D: usize>(
        &mut self,
        law: &JointLaw<D>,
        relative: &Motion<D>,
    ) -> Option<f64> {
        let mut moved = *self.joint();
        let heat = law.commit(&mut moved, relative);
        // without a branch for each, so that a processor looks at several at once
        let numbers = moved.as_flattened().iter();
        if !numbers.fold(heat.is_finite(), |all, number| all & number.is_finite()) {
            return None;
        }
        self.change_joint(|joint| *joint = moved);
        Some(heat)
    }

    /// What the joint remembers, as numbers.
    pub(crate) fn remembered(&self) -> &[f64] {
        self.joint.as_flattened()
    }

    /// The same, to be written.
    pub(crate) fn remembered_mut(&mut self) -> &mut [f64] {
        self.joint.as_flattened_mut()
    }
}

/// The values of an instance at its start, in short: most of those that there are belong to other joints, and are zero.
#[derive(Clone, Debug)]
pub(crate) struct StartValues(Box<[(u32, f64)]>);

impl StartValues {
    /// Those of a joint that has not moved yet.
    pub(crate) fn of(values: &Values) -> Self {
        let numbers = (0..).zip(values.iter().copied());
        // what is not all zero bits, so that −0 stays what it is
        Self(
            numbers
                .filter(|(_, number)| number.to_bits() != 0)
                .collect(),
        )
    }

    /// Puts them in the place of `values`, which are of the same FMU.
    pub(crate) fn restore(&self, values: &mut Values) {
        values.numbers = [0.0; VALUE_COUNT];
        for &(place, number) in &self.0 {
            values.numbers[place as usize] = number;
        }
        values.joint.fill(DOF_AT_REST);
    }
}

/// Number of numbers that the joint of an FMU with these variables remembers.
pub(crate) fn remembered_count(variables: Variables) -> usize {
    remembering_dofs(variables) * DOF_MEMORY_COUNT
}

fn remembering_dofs(variables: Variables) -> usize {
    match variables.dependence.remembers() {
        true => variables.dofs.of_model(),
        false => 0,
    }
}
