//! Everything that an instance holds as numbers: its variables, what it remembers beside them, and what its joint
//! remembers.

use std::{
    borrow::Cow,
    ops::{Index, IndexMut},
};

use bolted_joint_dynamics::{
    DOF_AT_REST, DofMemory, Dual, JointLaw, JointMemory, Motion,
    law::{
        FIRST_INNER_COUNT, FIRST_REMEMBERED_COUNT, INNER_COUNT, INNER_PLACES, REMEMBERED_PLACES,
    },
};

use crate::interface::{
    FIRST_LISTED, FURTHER, InterfaceType, REFERENCE_COUNT, VALUE_COUNT, Variables, first_row,
    reference::{INNER_RATES, INNER_STATES, LAW_MEMORY, TIME},
};
use crate::underway::Underway;

/// Number of values that every FMU has room for.
const COMMON_COUNT: usize = VALUE_COUNT - FURTHER_COUNT;

/// Number of values of laws that stand beside another of their kind.
const FURTHER_COUNT: usize = FURTHER.end - FURTHER.start;

/// Values of all variables of an FMU by value reference, and after them what it remembers beside them.
///
/// What few joints need is long, and stands apart where the joint needs it: the variables of laws that stand beside another of
/// their kind, and what the laws remember. So does what the start-value file lists.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    numbers: [f64; COMMON_COUNT],
    /// Of the references [`FURTHER`], or nothing.
    further: Vec<f64>,
    /// Of the references from [`FIRST_LISTED`] on.
    listed: Vec<f64>,
    /// Of each DOF of a joint with memory; of an assembly, of each on which a joint has laws.
    joint: Vec<DofMemory>,
    /// Of each DOF of a joint with event indicators, for Model Exchange.
    ahead: Vec<Ahead>,
    /// Of an assembly.
    underway: Underway,
    inner: Inner,
}

/// What event indicators of a DOF follow from: the direction in which the joint has moved since it last turned (1 or -1; 0
/// before), the largest relative velocity up to now, and the next place in that direction at which the load is not smooth (the
/// largest double where there is none).
pub(crate) type Ahead = [f64; 3];

/// Where the inner states of the joint's laws come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Inner {
    /// They are what the joint remembers, and move on with it.
    #[default]
    Committed,
    /// The importer integrates them: they are among the variables.
    Integrated,
    /// The importer will integrate them from where the start values put them.
    Starting,
}

impl Inner {
    /// Where they come from once the simulation has begun.
    pub(crate) fn of(interface_type: InterfaceType) -> Self {
        match interface_type {
            InterfaceType::CoSimulation => Self::Committed,
            InterfaceType::ModelExchange => Self::Integrated,
        }
    }
}

impl Index<usize> for Values {
    type Output = f64;

    #[inline]
    fn index(&self, index: usize) -> &f64 {
        match index {
            _ if index < FURTHER.start => &self.numbers[index],
            _ if index < FURTHER.end => &self.further[index - FURTHER.start],
            _ if index < FIRST_LISTED => &self.numbers[index - FURTHER_COUNT],
            _ => &self.listed[index - FIRST_LISTED],
        }
    }
}

impl IndexMut<usize> for Values {
    #[inline]
    fn index_mut(&mut self, index: usize) -> &mut f64 {
        match index {
            _ if index < FURTHER.start => &mut self.numbers[index],
            _ if index < FURTHER.end => &mut self.further[index - FURTHER.start],
            _ if index < FIRST_LISTED => &mut self.numbers[index - FURTHER_COUNT],
            _ => &mut self.listed[index - FIRST_LISTED],
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
            listed: vec![0.0; self.listed.len()],
            joint: Vec::new(),
            ahead: Vec::new(),
            underway: Underway::default(),
            inner: Inner::Committed,
        }
    }

    /// Zero, of an FMU with these variables, whose joint has not moved yet.
    pub(crate) fn at_rest(variables: &Variables) -> Self {
        let has_further = FURTHER
            .into_iter()
            .any(|index| variables.get(index).is_some());
        let listed = match variables {
            Variables::Built(_) => 0,
            Variables::Listed(listed) => listed.len(),
        };
        Self {
            numbers: [0.0; COMMON_COUNT],
            further: vec![0.0; if has_further { FURTHER_COUNT } else { 0 }],
            listed: vec![0.0; listed],
            joint: vec![DOF_AT_REST; remembering_dofs(variables)],
            ahead: vec![[0.0; 3]; turning_dofs(variables)],
            underway: Underway::of(variables),
            inner: Inner::Committed,
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
        let listed = FIRST_LISTED..FIRST_LISTED + self.listed.len();
        let [first, second] = match self.listed.is_empty() {
            true => [0..FURTHER.start, FURTHER.end..VALUE_COUNT],
            false => [TIME..TIME + 1, REFERENCE_COUNT..VALUE_COUNT],
        };
        first.chain(further).chain(second).chain(listed)
    }

    /// The value of this index, if there is one.
    #[inline]
    pub(crate) fn get_mut(&mut self, index: usize) -> Option<&mut f64> {
        match index {
            _ if index < FURTHER.start => self.numbers.get_mut(index),
            _ if index < FURTHER.end => self.further.get_mut(index - FURTHER.start),
            _ if index < FIRST_LISTED => self.numbers.get_mut(index - FURTHER_COUNT),
            _ => self.listed.get_mut(index - FIRST_LISTED),
        }
    }

    /// How many of the inner states on a DOF this FMU can have.
    #[inline]
    fn inner_count(&self) -> usize {
        match self.has_further() {
            true => INNER_COUNT,
            false => FIRST_INNER_COUNT,
        }
    }

    /// Where inner states come from, from now on.
    pub(crate) fn set_inner(&mut self, inner: Inner) {
        self.inner = inner;
    }

    /// Whether the importer integrates.
    #[inline]
    pub(crate) fn are_integrated(&self) -> bool {
        self.inner != Inner::Committed
    }

    /// What the joint remembers where it is at this relative motion: as it was committed, but for inner states that the
    /// importer has integrated meanwhile.
    #[inline]
    pub(crate) fn joint_at<const D: usize>(
        &self,
        law: &JointLaw<D>,
        relative: &Motion<D>,
    ) -> Cow<'_, JointMemory<D>> {
        if !(self.are_integrated() && law.has_inner()) {
            return Cow::Borrowed(self.joint());
        }
        let mut memory = *self.joint();
        self.put_inner(&mut memory, law, relative);
        Cow::Owned(memory)
    }

    /// Puts the inner states that the importer has integrated into the joint's memory.
    #[cold]
    fn put_inner<const D: usize>(
        &self,
        memory: &mut JointMemory<D>,
        law: &JointLaw<D>,
        relative: &Motion<D>,
    ) {
        for (own, states) in memory.iter_mut().zip(&INNER_STATES[first_row::<D>()..]) {
            for (&state, place) in states.iter().zip(INNER_PLACES).take(self.inner_count()) {
                own[place] = self[state];
            }
        }
        law.settle(memory, relative);
    }

    /// The same with its change along the direction `change`; `None` where only the motion changes it.
    pub(crate) fn joint_change_at<const D: usize>(
        &self,
        change: &Self,
        law: &JointLaw<D, Dual<1>>,
        relative: &Motion<D, Dual<1>>,
    ) -> Option<JointMemory<D, Dual<1>>> {
        if !law.has_inner() {
            return None;
        }
        let committed = self.joint::<D>();
        let mut memory = committed.map(|own| own.map(Dual::from));
        for (row, own) in memory.iter_mut().enumerate() {
            let states = INNER_STATES[first_row::<D>() + row];
            for (state, place) in states
                .into_iter()
                .zip(INNER_PLACES)
                .take(self.inner_count())
            {
                own[place] = match self.inner {
                    Inner::Committed => Dual::new(committed[row][place], [change[state]]),
                    Inner::Integrated => Dual::new(self[state], [change[state]]),
                    Inner::Starting => Dual::from(0.0),
                };
            }
        }
        match self.inner {
            Inner::Committed => {}
            Inner::Integrated => law.settle(&mut memory, relative),
            Inner::Starting => {
                law.settle(&mut memory, &Motion::REST);
                law.commit_inner(&mut memory, relative);
            }
        }
        Some(memory)
    }

    /// Writes the rates of the inner states to the variables.
    #[inline]
    pub(crate) fn set_inner_rates<const D: usize>(
        &mut self,
        law: &JointLaw<D>,
        relative: &Motion<D>,
    ) {
        if law.has_inner() {
            let rates = law.inner_rates(&self.joint_at(law, relative), relative);
            for (own, references) in rates.iter().zip(&INNER_RATES[first_row::<D>()..]) {
                for (&rate, &reference) in own.iter().zip(references).take(self.inner_count()) {
                    self[reference] = rate;
                }
            }
        }
    }

    /// Writes the changes of inner states, where these follow from the start values, and of their rates to `change`.
    pub(crate) fn differentiate_inner<const D: usize>(
        &self,
        memory: &JointMemory<D, Dual<1>>,
        law: &JointLaw<D, Dual<1>>,
        relative: &Motion<D, Dual<1>>,
        change: &mut Self,
    ) {
        let rates = law.inner_rates(memory, relative);
        for (row, (own, rates)) in memory.iter().zip(rates).enumerate() {
            let row = first_row::<D>() + row;
            for (rate, reference) in rates
                .into_iter()
                .zip(INNER_RATES[row])
                .take(self.inner_count())
            {
                change[reference] = rate.change[0];
            }
            if self.inner == Inner::Starting {
                let states = INNER_STATES[row].into_iter().zip(INNER_PLACES);
                for (state, place) in states.take(self.inner_count()) {
                    change[state] = own[place].change[0];
                }
            }
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
        self.show_joint::<D>();
        Some(result)
    }

    /// Shows what the joint remembers in the variables.
    #[inline]
    fn show_joint<const D: usize>(&mut self) {
        for (references, own) in LAW_MEMORY[first_row::<D>()..].iter().zip(&self.joint) {
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
    }

    /// Moves what the joint remembers on to a relative motion, and returns the heat of that way, J; `None` where a number is
    /// no finite one any more: then nothing has moved.
    pub(crate) fn commit_joint<const D: usize>(
        &mut self,
        law: &JointLaw<D>,
        relative: &Motion<D>,
    ) -> Option<f64> {
        let is_integrated = self.are_integrated() && law.has_inner();
        let Some(joint) = self.joint.first_chunk_mut::<D>() else {
            return Some(0.0);
        };
        let heat = law.try_commit(joint, relative)?;
        if is_integrated {
            // their heat is that of the way, they themselves are the importer's
            let mut memory = *joint;
            self.put_inner(&mut memory, law, relative);
            self.change_joint(|joint| *joint = memory);
        } else {
            self.show_joint::<D>();
        }
        Some(heat)
    }

    /// Takes the joint straight to this relative motion from where nothing has moved yet.
    pub(crate) fn commit_from_rest<const D: usize>(
        &mut self,
        law: &JointLaw<D>,
        relative: &Motion<D>,
    ) {
        let mut memory = [DOF_AT_REST; D];
        law.commit(&mut memory, relative);
        if memory
            .as_flattened()
            .iter()
            .all(|number| number.is_finite())
        {
            self.change_joint(|joint| *joint = memory);
        } else {
            self.change_joint(|joint| *joint = [DOF_AT_REST; D]);
        }
    }

    /// Whether the importer looks for events.
    #[inline]
    pub(crate) fn have_events(&self) -> bool {
        self.are_integrated() && !self.ahead.is_empty()
    }

    /// What event indicators follow from.
    pub(crate) fn ahead<const D: usize>(&self) -> [Ahead; D] {
        self.ahead.first_chunk().copied().unwrap_or([[0.0; 3]; D])
    }

    /// The same from now on.
    pub(crate) fn set_ahead(&mut self, ahead: &[Ahead]) {
        for (own, new) in self.ahead.iter_mut().zip(ahead) {
            *own = *new;
        }
    }

    /// What the start-value file lists, from the first on.
    #[inline]
    pub(crate) fn listed(&self) -> &[f64] {
        &self.listed
    }

    /// The same, to be written.
    #[inline]
    pub(crate) fn listed_mut(&mut self) -> &mut [f64] {
        &mut self.listed
    }

    /// The same beside what laws remember, on each DOF that has any.
    #[inline]
    pub(crate) fn listed_beside_memory(&mut self) -> (&mut [f64], &[DofMemory]) {
        (&mut self.listed, &self.joint)
    }

    /// What laws remember, on each DOF that has any.
    #[inline]
    pub(crate) fn memories(&self) -> &[DofMemory] {
        &self.joint
    }

    /// The same, to be written.
    #[inline]
    pub(crate) fn memories_mut(&mut self) -> &mut [DofMemory] {
        &mut self.joint
    }

    /// What event indicators follow from, of each DOF that has some.
    pub(crate) fn all_ahead(&self) -> &[Ahead] {
        &self.ahead
    }

    /// The same to be written, beside what the start-value file lists and what laws remember.
    pub(crate) fn parts_mut(&mut self) -> (&mut [f64], &mut [DofMemory], &mut [Ahead]) {
        (&mut self.listed, &mut self.joint, &mut self.ahead)
    }

    /// Whether what the joint remembers follows from the start values.
    pub(crate) fn are_starting(&self) -> bool {
        self.inner == Inner::Starting
    }

    /// How an assembly goes on.
    #[inline]
    pub(crate) fn underway(&self) -> &Underway {
        &self.underway
    }

    /// The same, to be written.
    #[inline]
    pub(crate) fn underway_mut(&mut self) -> &mut Underway {
        &mut self.underway
    }

    /// What the start-value file lists, to be written beside how an assembly goes on.
    pub(crate) fn listed_beside_underway(&mut self) -> (&mut [f64], &Underway) {
        (&mut self.listed, &self.underway)
    }

    /// What is remembered of the joint, and how an assembly goes on, as numbers.
    pub(crate) fn remembered(&self) -> impl Iterator<Item = f64> + '_ {
        let (joint, ahead) = (self.joint.as_flattened(), self.ahead.as_flattened());
        let all = joint.iter().chain(ahead).chain(self.underway.all());
        all.copied()
    }

    /// How many numbers that are.
    pub(crate) fn remembered_count(&self) -> usize {
        let (joint, ahead) = (self.joint.as_flattened(), self.ahead.as_flattened());
        joint.len() + ahead.len() + self.underway.all().len()
    }

    /// The same, to be written.
    pub(crate) fn remembered_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let joint = self.joint.as_flattened_mut().iter_mut();
        let ahead = self.ahead.as_flattened_mut();
        joint.chain(ahead).chain(self.underway.all_mut())
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
        values.listed.fill(0.0);
        for &(place, number) in &self.0 {
            values[place as usize] = number;
        }
        values.joint.fill(DOF_AT_REST);
        values.ahead.fill([0.0; 3]);
        values.underway.end();
    }
}

fn turning_dofs(variables: &Variables) -> usize {
    match variables {
        Variables::Built(built) => match variables.event_indicators().next() {
            Some(_) => built.dofs.of_model(),
            None => 0,
        },
        // two for each
        Variables::Listed(_) => variables.event_indicators().count() / 2,
    }
}

fn remembering_dofs(variables: &Variables) -> usize {
    match variables {
        Variables::Built(built) if built.dependence.remembers() => built.dofs.of_model(),
        Variables::Built(_) => 0,
        Variables::Listed(listed) => listed.remembering(),
    }
}
