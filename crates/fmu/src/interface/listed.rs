//! Variables that the start-value file lists, because they depend on the model: those of an assembly.
//!
//! They have the value references from [`FIRST_LISTED`] on, in the order of the list, which has the inputs first.

use super::{ContinuousState, LAP, Role, VALUE_COUNT, Variable, reference::TIME};

/// The first value reference of what a start-value file lists.
pub(crate) const FIRST_LISTED: usize = 4096;

const _: () = assert!(FIRST_LISTED >= VALUE_COUNT, "others have these references");

/// The variables that a start-value file lists.
#[derive(Clone, Debug, Default)]
pub(crate) struct ListedVariables {
    variables: Vec<Variable>,
    states: Vec<ContinuousState>,
    indicators: Vec<usize>,
    input_count: usize,
    /// The first of those that are calculated apart from other outputs; they are the last ones.
    first_apart: usize,
    /// DOFs on which laws remember.
    remembering: usize,
}

impl PartialEq for ListedVariables {
    /// The token, which is a hash of the list, tells what the numbers do not.
    fn eq(&self, other: &Self) -> bool {
        let counts = |own: &Self| (own.variables.len(), own.states.len(), own.indicators.len());
        counts(self) == counts(other)
    }
}

impl ListedVariables {
    /// The list, of which those from the place `apart` on are calculated apart from other outputs; `None` where inputs do not
    /// stand first, a state is none, or its derivative is not there.
    pub(crate) fn new(
        variables: Vec<Variable>,
        states: Vec<ContinuousState>,
        apart: usize,
        remembering: usize,
    ) -> Option<Self> {
        let is_input = |variable: &&Variable| variable.role.is_input();
        let inputs = variables.iter().take_while(is_input).count();
        let own = Self {
            input_count: inputs,
            first_apart: FIRST_LISTED + apart,
            remembering,
            indicators: (FIRST_LISTED..)
                .zip(&variables)
                .filter(|(_, variable)| variable.role == Role::Indicator)
                .map(|(reference, _)| reference)
                .collect(),
            variables,
            states,
        };
        let is_state = |state: &ContinuousState| {
            let role = own.get(state.reference).map(|variable| variable.role);
            let has_derivative = own.get(state.derivative).is_some();
            matches!(role, Some(Role::State | Role::InnerState)) && has_derivative
        };
        let inputs_are_first = !own
            .variables
            .iter()
            .skip(inputs)
            .any(|other| is_input(&other));
        (inputs_are_first && own.states.iter().all(is_state)).then_some(own)
    }

    pub(super) fn get(&self, reference: usize) -> Option<&Variable> {
        match reference.checked_sub(FIRST_LISTED) {
            Some(place) => self.variables.get(place),
            None if reference == TIME => LAP.get(TIME)?.as_ref(),
            None => None,
        }
    }

    /// Value references that there are.
    pub(super) fn references(&self) -> [std::ops::Range<usize>; 2] {
        [TIME..TIME + 1, FIRST_LISTED..FIRST_LISTED + self.len()]
    }

    pub(super) fn states(&self) -> &[ContinuousState] {
        &self.states
    }

    pub(super) fn indicators(&self) -> &[usize] {
        &self.indicators
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.variables.len()
    }

    /// How many of them are inputs.
    pub(crate) fn input_count(&self) -> usize {
        self.input_count
    }

    /// DOFs on which joints have laws that may remember.
    pub(crate) fn remembering(&self) -> usize {
        self.remembering
    }

    /// How many numbers the steps of what is listed go on from, beside what the laws remember: see [`Underway`].
    ///
    /// [`Underway`]: crate::underway::Underway
    pub(crate) fn underway(&self) -> usize {
        let count = |role| {
            let all = self.variables.iter();
            all.filter(|variable| variable.role == role).count()
        };
        count(Role::State) + count(Role::LimitedInput) + 1
    }

    /// Whether it is a state that may be told only where it is asked for.
    pub(super) fn is_carried(&self, index: usize) -> bool {
        self.get(index)
            .is_some_and(|variable| variable.role == Role::State)
    }

    pub(super) fn is_apart(&self, index: usize) -> bool {
        index >= self.first_apart
    }
}
