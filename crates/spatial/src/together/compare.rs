//! Searches where the functions do not reach all motions of the joint.
//!
//! They may have other joints as well then, and several searches agree on a wrong one. Only χ² tells them apart, so that all of the
//! first starts are followed unless noise clearly explains one.

use super::{Searches, Start, Way};
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::Normal;
use crate::parallel::over_each;
use crate::problem::Unknowns;
use crate::rivals::{DECISIVE, as_good, rivals};
use crate::search::{AS_LOW_BESIDE_ERRORS, CLEARLY, NOTHING, by_chance};
use crate::valley::{self, LOWER};

/// Starts that are compared: beside errors of the set-up, and alone.
const COMPARED: [usize; 2] = [5, 2];

/// What is compared where the functions may have other joints: from each start in one way.
pub(super) fn compared(beside: &[Start], alone: &[Start]) -> Vec<(Way, Start)> {
    let ways = [Way::Curved, Way::Straight].into_iter().cycle();
    let beside = ways.zip(beside.iter().cloned()).take(COMPARED[0]);
    let alone = alone.iter().cloned().map(|start| (Way::Straight, start));
    beside.chain(alone.take(COMPARED[1])).collect()
}

impl Searches<'_> {
    /// Follows all, unless noise clearly explains the first and nothing else is beside it; says whether noise explains the lowest, or
    /// several agree where its level is not stated.
    pub(super) fn compare(&mut self, tries: Vec<(Way, Start)>) -> Result<bool, SpatialError> {
        let (first, others) = tries.split_at(tries.len().min(1));
        for tries in [first, others] {
            let ended = over_each(tries, |(way, (residual, start))| {
                let fit = self.let_down(*way, *residual, start.clone());
                self.step.done();
                fit
            });
            self.tried += tries.len();
            let ended: Vec<Fit> = ended.into_iter().flatten().collect();
            for fit in &ended {
                if fit.cost < self.came_to(fit) {
                    self.best = Some(fit.clone());
                }
            }
            let others = self.others_among(&ended);
            let at_more = over_each(&others, |fit| {
                Fit::of(&self.lines, fit.unknowns.clone(), self.level, Effort::Near)
            });
            self.checked.extend(at_more.into_iter().flatten());
            if self.is_clear() {
                self.look_beside()?;
                if self.rivals()? == 0 {
                    return Ok(true);
                }
            }
        }
        if !self.is_clear() {
            self.look_beside()?;
        }
        Ok(self.is_confirmed())
    }

    /// Follows searches from beside the lowest of them.
    fn look_beside(&mut self) -> Result<(), SpatialError> {
        let Some(lowest) = self.lowest_checked() else {
            return Ok(());
        };
        let information = |at: &Unknowns| Ok(Normal::of(&self.lines, at, self.level)?.information);
        let beside = valley::beside(lowest, information, |start| {
            Fit::of(&self.lines, start.clone(), self.level, Effort::Near)
        })?;
        // one that the others did not see
        if beside.iter().any(|fit| fit.cost < lowest.cost - LOWER) {
            self.tried += 1;
            self.agreeing = 1;
        }
        self.checked.extend(beside);
        Ok(())
    }

    /// Those that are not far above the lowest, and of which none came to where another one did.
    fn others_among<'f>(&mut self, ended: &'f [Fit]) -> Vec<&'f Fit> {
        let Some(lowest) = self.best.as_ref().map(|best| best.cost) else {
            return Vec::new();
        };
        let most = as_good(lowest, self.thin.numbers() as f64);
        let mut others = Vec::new();
        for fit in ended.iter().filter(|fit| fit.cost <= most) {
            if !self.compared.iter().any(|&cost| is_same(cost, fit.cost)) {
                self.compared.push(fit.cost);
                others.push(fit);
            }
        }
        others
    }

    /// Whether noise clearly explains the lowest of them, or nothing is left.
    pub(super) fn is_clear(&self) -> bool {
        let leaves_nothing = |fit: &Fit| fit.cost < NOTHING * self.lines.numbers() as f64;
        self.lowest_checked().is_some_and(|fit| {
            leaves_nothing(fit) || self.is_stated && self.is_left_by(fit, CLEARLY)
        })
    }

    /// Whether chance explains what this one of them leaves, beside what its unknowns took.
    pub(super) fn is_left_by(&self, fit: &Fit, deviations: f64) -> bool {
        let free = self.lines.free_numbers();
        fit.cost < by_chance(free, deviations) && !self.is_rigid(fit)
    }

    /// Whether most searches came to the lowest, and none to another one that is as good: noise that is stated too small leaves
    /// more than it should.
    pub(super) fn is_the_only_one(&self) -> bool {
        self.compared.len() == 1 && 2 * self.agreeing > self.tried
    }

    pub(super) fn rivals(&self) -> Result<usize, SpatialError> {
        if !self.is_in_doubt {
            return Ok(0);
        }
        let lowest = self.lowest_checked().map_or(0.0, |fit| fit.cost);
        let most = match self.is_clear() && self.is_stated {
            true => lowest + DECISIVE,
            false => as_good(lowest, self.lines.numbers() as f64),
        };
        // one that creeps may be on its way to the lowest
        let ended = self.checked.iter().filter(|fit| fit.has_converged);
        let ended: Vec<Fit> = ended.cloned().collect();
        rivals(&self.lines, &ended, most, |best| {
            Ok(Normal::of(&self.lines, &best.unknowns, self.level)?.information)
        })
    }
}

/// Whether two searches beside errors of the set-up came to the same minimum.
fn is_same(one: f64, other: f64) -> bool {
    (one - other).abs() <= AS_LOW_BESIDE_ERRORS * one.min(other)
}
