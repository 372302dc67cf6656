//! What an assembly goes on from between steps, beside its variables.

use crate::interface::Variables;

/// How an assembly goes on from step to step: in coordinates of its own, from which its states follow where somebody asks.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Underway {
    /// Coordinates of the motion, then heat with the energy of the linear part (J), work of the loads (J), the preloads (N·m) that the
    /// coordinates belong to, and at last 1 where these numbers are the state and the states that are listed may be old; 0 where it is these.
    numbers: Vec<f64>,
    /// Whether the states that are listed have been told since.
    is_told: bool,
}

impl Underway {
    /// At the start, where an FMU with these variables goes on from its states.
    pub(crate) fn of(variables: &Variables) -> Self {
        let count = match variables {
            Variables::Built(_) => 0,
            Variables::Listed(listed) => listed.underway(),
        };
        Self {
            numbers: vec![0.0; count],
            is_told: false,
        }
    }

    /// The numbers from which the assembly goes on; `None` where it goes on from the states that are listed.
    #[inline]
    pub(crate) fn numbers(&self) -> Option<&[f64]> {
        let (last, numbers) = self.numbers.split_last()?;
        (*last != 0.0).then_some(numbers)
    }

    /// Whether the states that are listed are old.
    #[inline]
    pub(crate) fn is_untold(&self) -> bool {
        !self.is_told && self.numbers().is_some()
    }

    /// Goes on from these numbers, which `write` writes.
    pub(crate) fn go_on(&mut self, write: impl FnOnce(&mut [f64])) {
        if let Some((last, numbers)) = self.numbers.split_last_mut() {
            write(numbers);
            *last = 1.0;
        }
        self.is_told = false;
    }

    /// Takes note that the states that are listed are those of these numbers.
    pub(crate) fn tell(&mut self) {
        self.is_told = true;
    }

    /// Takes note that they are not, or need not be.
    pub(crate) fn forget(&mut self) {
        self.is_told = false;
    }

    /// All numbers, whatever they are at present.
    pub(crate) fn all(&self) -> &[f64] {
        &self.numbers
    }

    /// The same, to be written.
    pub(crate) fn all_mut(&mut self) -> &mut [f64] {
        &mut self.numbers
    }

    /// Goes on from the states that are listed.
    pub(crate) fn end(&mut self) {
        self.numbers.fill(0.0);
        self.is_told = false;
    }
}
