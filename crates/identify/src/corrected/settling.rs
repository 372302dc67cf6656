//! How the corrections of lines follow the unknowns: Gauss–Newton steps that lower the cost of each line.

use super::super::lanes::{LANES, Reals};
use super::lines::Corrected;

/// Gauss–Newton steps of one line's corrections for each step of the unknowns …
const ROUNDS: usize = 20;
/// … as long as they promise to lower its cost by more than this part of it …
const SMALL_GAIN: f64 = 1e-3;
/// … each shortened to a quarter so many times at most, until it does lower the cost: near a resonance a whole step can end beyond
/// the pole.
const QUARTERINGS: usize = 8;

impl<const N: usize> Corrected<'_, N> {
    /// Lets the corrections follow the unknowns by Gauss–Newton steps, most often one: repeated with each step of the unknowns that leads
    /// both to the minimum. The line stays linearised, and its residual whitened, where the last step began.
    pub(super) fn settle(&mut self) -> Option<()> {
        let mut is_settled = [false; LANES];
        for round in 0..=ROUNDS {
            let before = self.cost(self.penalty);
            self.whiten_residual()?;
            self.find_best();
            let after = self
                .whitened
                .iter()
                .fold(Reals::ZERO, |sum, r| sum + r.norm_sqr());
            let gain = (before - after).lanes();
            let settles =
                |lane: usize| !is_settled[lane] && gain[lane] <= SMALL_GAIN * before.lane(lane);
            let settles: [bool; LANES] = std::array::from_fn(settles);
            if settles != [false; LANES] {
                self.move_pulls(Reals::of(|lane| if settles[lane] { 1.0 } else { 0.0 }));
            }
            for (is_settled, settles) in is_settled.iter_mut().zip(settles) {
                *is_settled |= settles;
            }
            if round == ROUNDS || is_settled == [true; LANES] {
                break;
            }
            let (part, is_there) = self.part_that_lowers(before, &mut is_settled);
            self.advance(part);
            if is_there {
                self.derive_by_motion();
            } else {
                self.linearise()?;
            }
            if is_settled == [true; LANES] {
                break;
            }
        }
        Some(())
    }

    /// What part of the way to the best corrections lowers the cost of each line that is not settled; where none does, it is. Also
    /// whether that is where H^C and residual have been computed last.
    fn part_that_lowers(&mut self, before: Reals, is_settled: &mut [bool; LANES]) -> (Reals, bool) {
        let mut lowers = *is_settled;
        let mut part = Reals::of(|lane| if lowers[lane] { 0.0 } else { 1.0 });
        for _ in 0..QUARTERINGS {
            let cost = self.cost_at(part);
            for lane in 0..LANES {
                if !lowers[lane] {
                    match cost.lane(lane) < before.lane(lane) {
                        true => lowers[lane] = true,
                        false => part.set(lane, 0.25 * part.lane(lane)),
                    }
                }
            }
            if lowers == [true; LANES] {
                return (part, true);
            }
        }
        for lane in 0..LANES {
            if !lowers[lane] {
                is_settled[lane] = true;
                part.set(lane, 0.0);
            }
        }
        (part, false)
    }

    /// Σ|y − H^C|²/σ_C² and the penalty of the corrections.
    fn cost(&self, penalty: Reals) -> Reals {
        let residuals = self.residual.iter().zip(&self.variances);
        residuals.fold(penalty, |sum, (r, variance)| sum + r.norm_sqr() / *variance)
    }

    /// The same after `part` of the way to the best corrections; infinite where it cannot be computed.
    fn cost_at(&mut self, part: Reals) -> Reals {
        self.correct(Some(part));
        if self.compute().is_none() {
            return Reals::all(f64::INFINITY);
        }
        self.cost(self.penalty_at(part))
    }

    /// |(1 − t) δ + t δ'|² of the linearised and the best corrections, in units of their variances.
    fn penalty_at(&self, part: Reals) -> Reals {
        let rest = Reals::all(1.0) - part;
        let mixed = rest * part * self.best.cross;
        rest * rest * self.penalty + mixed + mixed + part * part * self.best.penalty
    }

    /// Goes this part of the way.
    fn advance(&mut self, part: Reals) {
        self.penalty = self.penalty_at(part);
        for (own, best) in self.motions.iter_mut().zip(&self.best.motions) {
            *own += (*best - *own).scaled(part);
        }
        self.move_pulls(part);
    }

    /// Moves what the corrections of each line will be this part of the way to the best ones; of a line that does not move those may
    /// be no numbers.
    fn move_pulls(&mut self, part: Reals) {
        let rest = Reals::all(1.0) - part;
        self.part_begun = rest * self.part_begun;
        for (own, best) in self.pulls.iter_mut().zip(&self.best.pulls) {
            for (own, best) in [(&mut own.re, best.re), (&mut own.im, best.im)] {
                *own = part.where_positive(rest * *own + part * best, *own);
            }
        }
    }
}
