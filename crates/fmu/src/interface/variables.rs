//! The variables of an FMU, be they in a table of the build or listed by the start-value file: all that the functions of FMI ask.

use std::sync::Arc;

use super::{
    BuiltVariables, ContinuousState, ListedVariables, Name, REFERENCE_COUNT, Roles, Values,
    Variable, reference,
};

/// The variables that an FMU has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Variables {
    /// Those of an element or a lap: tables of the build have them.
    Built(BuiltVariables),
    /// Those of an assembly: its start-value file lists them.
    Listed(Arc<ListedVariables>),
}

impl Variables {
    /// The variable with this value reference, if the FMU has one.
    pub(crate) fn get(&self, reference: usize) -> Option<&Variable> {
        match self {
            Self::Built(built) => built.get(reference),
            Self::Listed(listed) => listed.get(reference),
        }
    }

    /// All variables with their value references, in ascending order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (usize, &Variable)> {
        let [first, second] = match self {
            Self::Built(_) => [0..REFERENCE_COUNT, 0..0],
            Self::Listed(listed) => listed.references(),
        };
        let all = first.chain(second);
        all.filter_map(|reference| Some((reference, self.get(reference)?)))
    }

    /// Continuous states, in the order of the model structure.
    pub(crate) fn continuous_states(&self) -> impl Iterator<Item = &ContinuousState> {
        let states = match self {
            Self::Built(built) => built.states(),
            Self::Listed(listed) => listed.states(),
        };
        let has = |reference| self.get(reference).is_some();
        let of_joint =
            move |state: &&ContinuousState| has(state.reference) && has(state.derivative);
        states.iter().filter(of_joint)
    }

    /// Value references of the event indicators, in the order of the model structure.
    pub(crate) fn event_indicators(&self) -> impl Iterator<Item = usize> {
        let indicators = match self {
            Self::Built(built) => built.indicators(),
            Self::Listed(listed) => listed.indicators(),
        };
        let has = |reference: &usize| self.get(*reference).is_some();
        indicators.iter().copied().filter(has)
    }

    /// Name of the variable with this value reference, for messages.
    pub(crate) fn name(&self, reference: usize) -> Name {
        self.get(reference)
            .map_or(Name::Borrowed("(no variable)"), |variable| {
                variable.name.clone()
            })
    }

    /// Role of each value reference, up to the last that there is.
    pub(crate) fn roles(&self) -> Box<[Roles]> {
        let count = self.iter().last().map_or(0, |(last, _)| last + 1);
        let role = |index| {
            self.get(index).map_or(Roles::NONE, |variable| {
                let own = Roles::of(&[variable.role]);
                match index {
                    reference::ENERGY_STORED | reference::POWER_DISSIPATED => {
                        own.with(Roles::APART)
                    }
                    reference::PRELOAD => own.with(Roles::LIMITED),
                    _ if self.is_apart(index) => own.with(Roles::APART),
                    _ if self.is_carried(index) => own.with(Roles::CARRIED),
                    _ => own,
                }
            })
        };
        (0..count).map(role).collect()
    }

    /// Whether a variable of an assembly is calculated apart from other outputs.
    fn is_apart(&self, index: usize) -> bool {
        matches!(self, Self::Listed(listed) if listed.is_apart(index))
    }

    /// Whether a state of an assembly may be told only where it is asked for.
    fn is_carried(&self, index: usize) -> bool {
        matches!(self, Self::Listed(listed) if listed.is_carried(index))
    }

    /// Whether there are outputs that are calculated apart.
    pub(crate) fn has_some_apart(&self) -> bool {
        match self {
            Self::Built(built) => built.dependence.remembers(),
            Self::Listed(_) => true,
        }
    }

    /// How many inputs there are that the start-value file lists, before all else that it lists.
    pub(crate) fn listed_inputs(&self) -> usize {
        match self {
            Self::Built(_) => 0,
            Self::Listed(listed) => listed.input_count(),
        }
    }

    /// Start values of the model description.
    pub(crate) fn start(&self) -> Values {
        let mut values = Values::at_rest(self);
        for (reference, variable) in self.iter() {
            values[reference] = variable.start;
        }
        if let Self::Built(built) = self {
            // nothing moves these masses, but they are divided by
            for row in built.dofs.at_rest() {
                for side in [&reference::A_INERTIA, &reference::B_INERTIA] {
                    values[side[row]] = 1.0;
                }
            }
        }
        values
    }
}
