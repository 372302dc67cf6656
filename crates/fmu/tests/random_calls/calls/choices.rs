//! Where random decisions come from: a seed, or the bytes that a fuzzer gives.

/// A stream of decisions; the same seed or the same bytes give the same decisions.
pub(crate) struct Choices<'a>(Source<'a>);

enum Source<'a> {
    /// State of xorshift64*.
    Seed(u64),
    /// What is left of the fuzzer's bytes.
    Bytes(&'a [u8]),
}

impl<'a> Choices<'a> {
    /// Endless decisions from a seed.
    pub(crate) fn seeded(seed: u64) -> Self {
        // xorshift64* stays at zero, and seeds that differ in a few bits give sequences that begin alike: the
        // finalizer of splitmix64 spreads them
        let mut mixed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Self(Source::Seed((mixed ^ (mixed >> 31)).max(1)))
    }

    /// Decisions from bytes, until they are used up.
    pub(crate) fn from_bytes(bytes: &'a [u8]) -> Self {
        Self(Source::Bytes(bytes))
    }

    /// Whether nothing is left to decide from.
    pub(crate) fn ended(&self) -> bool {
        matches!(self.0, Source::Bytes([]))
    }

    /// Any 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        match &mut self.0 {
            Source::Seed(state) => {
                *state ^= *state >> 12;
                *state ^= *state << 25;
                *state ^= *state >> 27;
                state.wrapping_mul(0x2545_f491_4f6c_dd1d)
            }
            Source::Bytes(_) => (0..8).fold(0, |bits, _| bits << 8 | u64::from(self.byte())),
        }
    }

    fn byte(&mut self) -> u8 {
        match &mut self.0 {
            Source::Seed(_) => (self.bits() >> 56) as u8,
            Source::Bytes(bytes) => match bytes.split_first() {
                Some((&first, rest)) => {
                    *bytes = rest;
                    first
                }
                None => 0,
            },
        }
    }

    /// A number from zero to below `limit`, which is at most 65,536.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        assert!((1..=65_536).contains(&limit));
        if limit > 256 {
            let both = u16::from_le_bytes([self.byte(), self.byte()]);
            return usize::from(both) * limit / 65_536;
        }
        usize::from(self.byte()) * limit / 256
    }

    /// True once in `n` times.
    pub(crate) fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// One of the values.
    pub(crate) fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// Any double, mostly one at which something could go wrong.
    pub(crate) fn any_number(&mut self) -> f64 {
        match self.below(22) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3 => f64::MAX,
            4 => -f64::MAX,
            5 => f64::MIN_POSITIVE,
            6 => 5e-324,
            7 => -5e-324,
            8 => 0.0,
            9 => -0.0,
            10 => 1.0,
            11 => -1.0,
            12 => 1e10,
            13 => -1e10,
            14 => 1e300,
            15 => 1e-300,
            16 => f64::EPSILON,
            17 => f64::from_bits(0x7ff0_0000_0000_0001), // signalling
            // as a longest internal step these would ask for up to 4e9 steps, which take minutes
            _ => match f64::from_bits(self.bits()) {
                tiny if (1e-15..1e-7).contains(&tiny.abs()) => 1e-300,
                any => any,
            },
        }
    }

    /// A number from −1 to 1.
    pub(crate) fn moderate_number(&mut self) -> f64 {
        (self.below(201) as f64 - 100.0) / 100.0
    }
}
