//! Where the numbers of each law are among those of all laws on a DOF: parameters, memory and inner states.

use super::declaration::{Declaration, Parameter, Remembered};
use super::side_by_side::KINDS;
use crate::number::Number;

/// Where a law's numbers are among those of all laws on a DOF.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Its own bit.
    pub(super) bit: u32,
    pub(super) parameters: [usize; 2],
    pub(super) memory: [usize; 2],
    /// Whether the law there has an inner state.
    pub(super) is_inner: bool,
}

impl Place {
    /// Before all laws.
    pub(super) const FRONT: Self = Self {
        bit: 0,
        parameters: [0, 0],
        memory: [0, 0],
        is_inner: false,
    };

    /// Whether the law there remembers anything.
    pub(super) const fn has_memory(self) -> bool {
        self.memory[0] < self.memory[1]
    }

    /// The place of a law behind this one.
    pub(super) const fn then(self, declaration: &Declaration) -> Self {
        let ([_, parameters], [_, memory]) = (self.parameters, self.memory);
        Self {
            bit: if self.bit == 0 { 1 } else { self.bit << 1 },
            parameters: [parameters, parameters + declaration.parameters.len()],
            memory: [memory, memory + declaration.memory_count()],
            is_inner: declaration.inner_count() > 0,
        }
    }

    /// The law there; the linear one, which is the first, has no place.
    pub(super) const fn law(self) -> &'static Declaration {
        &DECLARATIONS[self.bit.trailing_zeros() as usize + 1]
    }
}

/// Number of laws that there can be, the linear one among them.
pub(super) const LAW_COUNT: usize = {
    let (mut count, mut kind) = (0, 0);
    while kind < KINDS.len() {
        count += KINDS[kind].at_most;
        kind += 1;
    }
    count
};

/// The laws in their order, each with its kind: first one of each kind, then the second of each that there can be two of, and so
/// on. So those of which a kind has more cost nothing where it has one.
pub(super) const LAWS: [(usize, Declaration); LAW_COUNT] = {
    let mut laws = [(0, KINDS[0]); LAW_COUNT];
    let (mut law, mut number) = (0, 1);
    while law < LAW_COUNT {
        let mut kind = 0;
        while kind < KINDS.len() {
            if KINDS[kind].at_most >= number {
                laws[law] = (kind, KINDS[kind].numbered(number));
                law += 1;
            }
            kind += 1;
        }
        number += 1;
    }
    laws
};

/// What every law of a joint says of itself: first one of each kind, the linear one before all.
pub const DECLARATIONS: &[Declaration] = &{
    let mut declarations = [KINDS[0]; LAW_COUNT];
    let mut law = 0;
    while law < LAW_COUNT {
        declarations[law] = LAWS[law].1;
        law += 1;
    }
    declarations
};

/// The places of the laws on a DOF: of all but the linear one, in their order.
pub(super) const ALL: [Place; LAW_COUNT - 1] = {
    let mut places = [Place::FRONT; LAW_COUNT - 1];
    let mut place = Place::FRONT;
    let mut law = 1;
    while law < LAW_COUNT {
        place = place.then(&LAWS[law].1);
        places[law - 1] = place;
        law += 1;
    }
    places
};

/// The places of a kind.
pub(super) const fn places_of<const COUNT: usize>(kind: usize) -> [Place; COUNT] {
    let mut places = [Place::FRONT; COUNT];
    let mut law = 1;
    while law < LAW_COUNT {
        if LAWS[law].0 == kind {
            places[LAWS[law].1.number - 1] = ALL[law - 1];
        }
        law += 1;
    }
    places
}

/// The place of the last law that is the first of its kind.
pub(super) const LAST_FIRST: Place = ALL[KINDS.len() - 2];

/// The bits of all laws that are not the first of their kind.
pub(super) const FURTHER: u32 = !((LAST_FIRST.bit << 1) - 1);

/// The bits of the laws that remember.
pub(super) const REMEMBERING: u32 = {
    let (mut bits, mut law) = (0, 0);
    while law < ALL.len() {
        if ALL[law].has_memory() {
            bits |= ALL[law].bit;
        }
        law += 1;
    }
    bits
};

/// The bits of the laws with an inner state.
pub(super) const INNER: u32 = {
    let (mut bits, mut law) = (0, 0);
    while law < ALL.len() {
        if ALL[law].is_inner {
            bits |= ALL[law].bit;
        }
        law += 1;
    }
    bits
};

/// Number of parameters that the laws have on each DOF.
pub const DOF_PARAMETER_COUNT: usize = ALL[ALL.len() - 1].parameters[1];

/// Number of the first of those, of the first law of each kind.
pub const FIRST_PARAMETER_COUNT: usize = LAST_FIRST.parameters[1];

/// Number of the first of those, of laws that remember nothing: they stand before all others.
pub const FORGETFUL_PARAMETER_COUNT: usize = {
    let mut count = 0;
    let mut law = 1;
    while law < DECLARATIONS.len() && !DECLARATIONS[law].remembers() {
        count += DECLARATIONS[law].parameters.len();
        law += 1;
    }
    while law < DECLARATIONS.len() {
        assert!(DECLARATIONS[law].remembers());
        law += 1;
    }
    count
};

/// What the laws on each DOF declare of their parameters, each with its law, in the order of
/// [`DofLaws::parameters`](super::DofLaws::parameters).
pub fn dof_parameters() -> impl Iterator<Item = (&'static Declaration, &'static Parameter)> {
    let laws = DECLARATIONS.iter().skip(1);
    laws.flat_map(|law| law.parameters.iter().map(move |parameter| (law, parameter)))
}

/// Number of numbers that the laws remember on each DOF.
pub const DOF_MEMORY_COUNT: usize = ALL[ALL.len() - 1].memory[1];

/// What the laws on one relative DOF remember, in the order of [`DECLARATIONS`]: of each law first what is a variable.
pub type DofMemory<N = f64> = [N; DOF_MEMORY_COUNT];

/// Nothing has moved yet.
pub const DOF_AT_REST: DofMemory = [0.0; DOF_MEMORY_COUNT];

/// Number of the numbers in [`DofMemory`] that are variables.
pub const REMEMBERED_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < DECLARATIONS.len() {
        count += DECLARATIONS[law].memory.len();
        law += 1;
    }
    count
};

/// Number of the first of those, of the first law of each kind.
pub const FIRST_REMEMBERED_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < KINDS.len() {
        count += KINDS[law].memory.len();
        law += 1;
    }
    count
};

/// Places in [`DofMemory`] of the numbers that are variables, in the order of [`DECLARATIONS`].
pub const REMEMBERED_PLACES: [usize; REMEMBERED_COUNT] = {
    let mut places = [0; REMEMBERED_COUNT];
    let (mut count, mut law, mut start) = (0, 0, 0);
    while law < DECLARATIONS.len() {
        let mut own = 0;
        while own < DECLARATIONS[law].memory.len() {
            places[count] = start + own;
            own += 1;
            count += 1;
        }
        start += DECLARATIONS[law].memory_count();
        law += 1;
    }
    places
};

/// Number of the inner states on each DOF.
pub const INNER_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < DECLARATIONS.len() {
        let own = DECLARATIONS[law].inner_count();
        // a law gives the rate of one
        assert!(own <= 1);
        count += own;
        law += 1;
    }
    count
};

/// Number of the first of those, of the first law of each kind.
pub const FIRST_INNER_COUNT: usize = {
    let (mut count, mut law) = (0, 0);
    while law < KINDS.len() {
        count += KINDS[law].inner_count();
        law += 1;
    }
    count
};

/// Places in [`DofMemory`] of the inner states, in the order of [`DECLARATIONS`].
pub const INNER_PLACES: [usize; INNER_COUNT] = {
    let mut places = [0; INNER_COUNT];
    let (mut count, mut law, mut start) = (0, 0, 0);
    while law < DECLARATIONS.len() {
        let mut own = 0;
        while own < DECLARATIONS[law].memory.len() {
            if DECLARATIONS[law].memory[own].rate.is_some() {
                places[count] = start + own;
                count += 1;
            }
            own += 1;
        }
        start += DECLARATIONS[law].memory_count();
        law += 1;
    }
    places
};

/// The numbers in [`DofMemory`] that are variables: the place of each, with its law and what that declares of it.
pub fn remembered() -> impl Iterator<Item = (usize, &'static Declaration, &'static Remembered)> {
    let laws = DECLARATIONS.iter();
    let declared = laws.flat_map(|law| law.memory.iter().map(move |number| (law, number)));
    let places = REMEMBERED_PLACES.into_iter().zip(declared);
    places.map(|(place, (law, number))| (place, law, number))
}

#[inline]
pub(super) fn part<N>(memory: &DofMemory<N>, place: Place) -> &[N] {
    let [start, end] = place.memory;
    &memory[start..end]
}

#[inline]
pub(super) fn part_mut<N>(memory: &mut DofMemory<N>, place: Place) -> &mut [N] {
    let [start, end] = place.memory;
    &mut memory[start..end]
}

/// The bits of those of these places at which a law is: one of its parameters is not zero.
#[inline]
pub(super) fn present<'p, N: Number>(
    places: impl Iterator<Item = &'p Place>,
    parameters: &[N; DOF_PARAMETER_COUNT],
) -> u32 {
    places.fold(0, |present, place| {
        let [start, end] = place.parameters;
        let mut own = parameters[start..end].iter();
        let is_there = own.any(|number| !number.is_zero());
        present | if is_there { place.bit } else { 0 }
    })
}
