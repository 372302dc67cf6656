//! How far a step of Levenberg and Marquardt trusts the linearised model: Marquardt's damping by what the last step came to.

/// Damping of the first step, a fraction of the diagonal of JᵀJ.
pub(super) const FIRST: f64 = 1e-3;
/// Less than this changes no step.
const LEAST: f64 = 1e-15;
/// After a refused step: less than this would lead to the same place again.
const LEAST_THAT_SHORTENS: f64 = 1e-6;
/// More than this, and the step is as good as none.
const MOST: f64 = 1e12;
/// Parts of the promised gain from which on the model is trusted far, or as far as before.
const GOOD: f64 = 0.75;
const FAIR: f64 = 0.25;

/// The damping of an iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Damping(pub(super) f64);

impl Damping {
    /// After a step that was taken and gained this part of what it promised.
    pub(super) fn taken(self, part_of_promise: f64) -> Self {
        let factor = match part_of_promise {
            part if part > GOOD => 0.01,
            part if part > FAIR => 0.2,
            _ => 1.0,
        };
        Self((self.0 * factor).max(LEAST))
    }

    /// After a step that was refused; `None` where no shorter one is worth a trial.
    pub(super) fn refused(self) -> Option<Self> {
        let more = (10.0 * self.0).max(LEAST_THAT_SHORTENS);
        (more <= MOST).then_some(Self(more))
    }

    /// What the next iteration begins with.
    pub(super) fn for_the_next(self) -> Self {
        Self(self.0.min(FIRST))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_that_keeps_its_promise_is_trusted_and_one_that_does_not_is_not() {
        let damping = Damping(FIRST);
        assert!(damping.taken(1.0).0 < damping.taken(0.5).0);
        assert!(damping.taken(0.1).0 == FIRST);
        assert!(damping.refused().unwrap().0 > FIRST);
        assert!(Damping(LEAST).taken(1.0).0 == LEAST);
    }

    #[test]
    fn few_refusals_shorten_a_step_to_nothing() {
        let mut damping = Damping(LEAST);
        let mut count = 0;
        while let Some(more) = damping.refused() {
            damping = more;
            count += 1;
        }
        assert!(count < 20, "{count}");
    }
}
