//! How the inputs go on from the present point: the derivatives with respect to time that the importer has given.

use crate::interface::{INPUT_REFERENCES, REFERENCE_COUNT};

/// Number of inputs of either FMU.
const INPUT_COUNT: usize = INPUT_REFERENCES.len();

/// Place of each input among them, by value reference; past the last one for what is none.
const PLACES: [usize; REFERENCE_COUNT] = {
    let mut places = [INPUT_COUNT; REFERENCE_COUNT];
    let mut place = 0;
    while place < INPUT_COUNT {
        places[INPUT_REFERENCES[place]] = place;
        place += 1;
    }
    places
};

/// Highest order of an input's derivative.
pub(crate) const ORDER_MAX: usize = 3;

/// Taylor polynomials of the inputs, without their values, which are among the values of the variables.
///
/// FMI 2.0, 4.2.1: derivatives are given for the beginning of a communication step. They hold for that step. What they
/// have become at its end is still known there, for the derivatives of outputs, but the next step begins with inputs
/// that are held, unless new derivatives are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InputCourse {
    /// Derivatives of first to third order, by the input's place in the order of value references.
    derivatives: [[f64; ORDER_MAX]; INPUT_COUNT],
    /// One bit for each input whose derivatives the importer has given, be they zero.
    given: u64,
    phase: Phase,
    /// Whether any derivative is not zero.
    moves: bool,
}

/// For which time the derivatives are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// There are none: the inputs are held.
    None,
    /// For the step that comes next.
    Next,
    /// For the step that has been taken: they are those at its end.
    Past,
}

const _: () = assert!(INPUT_COUNT < u64::BITS as usize, "an input has no bit");

impl InputCourse {
    /// All inputs held.
    pub(crate) const HELD: Self = Self {
        derivatives: [[0.0; ORDER_MAX]; INPUT_COUNT],
        given: 0,
        phase: Phase::None,
        moves: false,
    };

    /// Number of bytes of a serialised course.
    pub(crate) const SIZE: usize = 9 + 8 * ORDER_MAX * INPUT_COUNT;

    /// Whether the inputs are held over the step that comes next.
    #[inline]
    pub(crate) fn is_held(&self) -> bool {
        !self.moves || self.phase != Phase::Next
    }

    /// Whether a step leaves this course as it is: there is none.
    #[inline]
    pub(crate) fn is_none(&self) -> bool {
        self.phase == Phase::None
    }

    /// Whether a step was taken along this course.
    #[inline]
    pub(crate) fn is_past(&self) -> bool {
        self.phase == Phase::Past
    }

    /// Gives the derivative of `order` (1 to 3) of an input for the next step.
    pub(crate) fn give(&mut self, input: usize, order: usize, derivative: f64) {
        if self.is_past() {
            *self = Self::HELD;
        }
        let of_input = self.derivatives.get_mut(place(input));
        if let Some(stored) = of_input.and_then(|orders| orders.get_mut(order.checked_sub(1)?)) {
            *stored = derivative;
            self.given |= Self::bit(input);
            self.phase = Phase::Next;
            self.moves = self.any_moves();
        }
    }

    /// Lets an input go from `start` at present through `middle` and `end` after half of `interval_s` (s) and all of it.
    pub(crate) fn fit(&mut self, input: usize, [start, middle, end]: [f64; 3], interval_s: f64) {
        if let Some(derivatives) = self.derivatives.get_mut(place(input)) {
            // u̇ = (−3 u₀ + 4 u₁ − u₂)/h, ü = 4 (u₀ − 2 u₁ + u₂)/h², from the differences so that a held input stays so
            let (first, second) = (middle - start, end - middle);
            *derivatives = [
                (3.0 * first - second) / interval_s,
                4.0 * (second - first) / (interval_s * interval_s),
                0.0,
            ];
            self.phase = Phase::Next;
            self.moves = self.any_moves();
        }
    }

    /// Forgets what an input did in the step that was taken, because it has jumped since.
    pub(crate) fn forget(&mut self, input: usize) {
        if let Some(derivatives) = self.derivatives.get_mut(place(input)) {
            *derivatives = [0.0; ORDER_MAX];
            self.given &= !Self::bit(input);
        }
    }

    /// Value of an input `after_s` (s) from now, when it is `start` at present.
    #[inline]
    pub(crate) fn value(&self, input: usize, start: f64, after_s: f64) -> f64 {
        let [first, second, third] = self.of(input);
        // u(t + τ) = u + τ (u̇ + τ/2 (ü + τ/3 u⃛))
        start + after_s * (first + after_s / 2.0 * (second + after_s / 3.0 * third))
    }

    /// First derivative of an input at present, if it is known to change.
    pub(crate) fn rate(&self, input: usize) -> Option<f64> {
        let [first, ..] = self.of(input);
        let known = self.given & Self::bit(input) != 0 || first != 0.0;
        known.then_some(first)
    }

    /// Second derivative of an input at present.
    pub(crate) fn acceleration(&self, input: usize) -> f64 {
        let [_, second, _] = self.of(input);
        second
    }

    /// First derivative of an input `after_s` (s) from now.
    #[inline]
    pub(crate) fn rate_after(&self, input: usize, after_s: f64) -> f64 {
        let [first, second, third] = self.of(input);
        // u̇(t + τ) = u̇ + τ (ü + τ/2 u⃛)
        first + after_s * (second + after_s / 2.0 * third)
    }

    /// The course `after_s` (s) from now, still within the step that it is for.
    pub(crate) fn moved(&self, after_s: f64) -> Self {
        let derivatives = self.derivatives.map(|[first, second, third]| {
            [
                first + after_s * (second + after_s / 2.0 * third),
                second + after_s * third,
                third,
            ]
        });
        Self {
            derivatives,
            ..*self
        }
    }

    /// The course at the end of its step.
    pub(crate) fn ended(&self) -> Self {
        match self.phase {
            Phase::Next => Self {
                phase: Phase::Past,
                ..*self
            },
            Phase::None | Phase::Past => Self::HELD,
        }
    }

    fn of(&self, input: usize) -> [f64; ORDER_MAX] {
        self.derivatives
            .get(place(input))
            .copied()
            .unwrap_or_default()
    }

    fn bit(input: usize) -> u64 {
        match place(input) {
            place if place < INPUT_COUNT => 1 << place,
            _ => 0,
        }
    }

    fn any_moves(&self) -> bool {
        self.derivatives.iter().flatten().any(|&x| x != 0.0)
    }

    /// The course in bytes, little endian.
    pub(crate) fn to_bytes(self) -> [u8; Self::SIZE] {
        let mut bytes = [0; Self::SIZE];
        let (head, tail) = bytes.split_at_mut(9);
        let (given, phase_byte) = head.split_at_mut(8);
        given.copy_from_slice(&self.given.to_le_bytes());
        let phase = match self.phase {
            Phase::None => 0,
            Phase::Next => 1,
            Phase::Past => 2,
        };
        phase_byte.copy_from_slice(&[phase]);
        let numbers = self.derivatives.iter().flatten();
        for (field, number) in tail.chunks_exact_mut(8).zip(numbers) {
            field.copy_from_slice(&number.to_le_bytes());
        }
        bytes
    }

    /// Inverse of [`InputCourse::to_bytes`]; `None` for what no course can be.
    pub(crate) fn from_bytes(bytes: [u8; Self::SIZE]) -> Option<Self> {
        let (&given, rest) = bytes.split_first_chunk::<8>()?;
        let (&phase, rest) = rest.split_first()?;
        let mut course = Self {
            given: u64::from_le_bytes(given),
            phase: match phase {
                0 => Phase::None,
                1 => Phase::Next,
                2 => Phase::Past,
                _ => return None,
            },
            ..Self::HELD
        };
        let numbers = course.derivatives.iter_mut().flatten();
        for (number, field) in numbers.zip(rest.as_chunks::<8>().0) {
            *number = f64::from_le_bytes(*field);
        }
        course.moves = course.any_moves();
        let finite = course.derivatives.iter().flatten().all(|x| x.is_finite());
        let consistent = !course.is_none() || (course.given == 0 && !course.moves);
        let known = course.given >> INPUT_COUNT == 0;
        (finite && consistent && known).then_some(course)
    }
}

/// Place of the input with this value reference.
#[inline]
fn place(input: usize) -> usize {
    PLACES.get(input).copied().unwrap_or(INPUT_COUNT)
}
