//! Everything that an instance holds as numbers: its variables, what it remembers beside them, and what its joint
//! remembers.

use std::ops::{Index, IndexMut};

use bolted_joint_dynamics::{
    DOF_AT_REST, DofMemory, JointLaw, JointMemory, Motion,
    law::{FIRST_REMEMBERED_COUNT, REMEMBERED_PLACES},
};

use crate::interface::{FURTHER, VALUE_COUNT, Variables, first_row, reference::LAW_MEMORY};

/// Number of values that every FMU has room for.
const COMMON_COUNT: usize = VALUE_COUNT - FURTHER_COUNT;

/// Number of values of laws that stand beside another of their kind.
const FURTHER_COUNT: usize = FURTHER.end - FURTHER.start;

/// Values of all variables of an FMU by value reference, and after them what it remembers beside them.
///
/// What few joints need is long, and stands apart where the joint needs it: the variables of laws that stand beside another of
/// their kind, and what the laws remember.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    numbers: [f64; COMMON_COUNT],
    /// Of the references [`FURTHER`], or nothing.
    further: Vec<f64>,
    /// Of each DOF of a joint with memory.
    joint: Vec<DofMemory>,
}

impl Index<usize> for Values {
    type Output = f64;

    #[inline]
    fn index(&self, index: usize) -> &f64 {
        match index {
            _ if index < FURTHER.start => &self.numbers[index],
            _ if index < FURTHER.end => &self.further[index - FURTHER.start],
            _ => &self.numbers[index - FURTHER_COUNT],
        }
    }
}

impl IndexMut<usize> for Values {
    #[inline]
    fn index_mut(&mut self, index: usize) -> &mut f64 {
        match index {
            _ if index < FURTHER.start => &mut self.numbers[index],
            _ if index < FURTHER.end => &mut self.further[index - FURTHER.start],
            _ => &mut self.numbers[index - FURTHER_COUNT],
        }
    }
}

impl Values {
    /// A direction of change of such values: all zero, and no joint that remembers.
    #[inline]
    pub(crate) fn change(&self) -> Self {
        Self {
            numbers: [0.0; COMMON_COUNT],
            further: vec![0.0; self.further.len()],
            joint: Vec::new(),
        }
    }

    /// Zero, of an FMU with these variables, whose joint has not moved yet.
    pub(crate) fn at_rest(variables: Variables) -> Self {
        let has_further = FURTHER
            .into_iter()
            .any(|index| variables.get(index).is_some());
        Self {
            numbers: [0.0; COMMON_COUNT],
            further: vec![0.0; if has_further { FURTHER_COUNT } else { 0 }],
            joint: vec![DOF_AT_REST; remembering_dofs(variables)],
        }
    }

    /// Whether there are laws that stand beside another of their kind.
    #[inline]
    pub(crate) fn has_further(&self) -> bool {
        !self.further.is_empty()
    }

    /// The indices of all values that there are.
    pub(crate) fn indices(&self) -> impl Iterator<Item = usize> + use<> {
        let further = FURTHER.start..FURTHER.start + self.further.len();
        (0..FURTHER.start)
            .chain(further)
            .chain(FURTHER.end..VALUE_COUNT)
    }

    /// The value of this index, if there is one.
    #[inline]
    pub(crate) fn get_mut(&mut self, index: usize) -> Option<&mut f64> {
        match index {
            _ if index < FURTHER.start => self.numbers.get_mut(index),
            _ if index < FURTHER.end => self.further.get_mut(index - FURTHER.start),
            _ => self.numbers.get_mut(index - FURTHER_COUNT),
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
            let mut shown = references.iter().zip(REMEMBERED_PLACES);
            for (&reference, place) in shown.by_ref().take(FIRST_REMEMBERED_COUNT) {
                self.numbers[reference] = own[place];
            }
            if self.further.is_empty() {
                continue;
            }
            for (&reference, place) in shown {
                self.further[reference - FURTHER.start] = own[place];
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
        let numbers = values.indices().map(|index| (index as u32, values[index]));
        // what is not all zero bits, so that −0 stays what it is
        Self(
            numbers
                .filter(|(_, number)| number.to_bits() != 0)
                .collect(),
        )
    }

    /// Puts them in the place of `values`, which are of the same FMU.
    pub(crate) fn restore(&self, values: &mut Values) {
        values.numbers.fill(0.0);
        values.further.fill(0.0);
        for &(place, number) in &self.0 {
            values[place as usize] = number;
        }
        values.joint.fill(DOF_AT_REST);
    }
}

fn remembering_dofs(variables: Variables) -> usize {
    match variables.dependence.remembers() {
        true => variables.dofs.of_model(),
        false => 0,
    }
}
