//! What the Iwan law remembers: the points at which the joint turned, and what follows from them, in a fixed number of
//! numbers.
//!
//! A loop is forgotten as soon as it closes, so that the ways between the points become shorter one by one. Where there
//! are more than [`REVERSALS_MAX`] of them, as after many cycles of a slowly decaying vibration, two neighbours are
//! forgotten before: those whose loss changes the load least.

use super::curve::Curve;
use crate::number::Number;

/// Reversal points that are kept.
///
/// With so many, forgetting two shifts the load by 2 F_S/30 at most, because 30 pairs that share no slider share a load
/// of 2 F_S, and the next shift goes the other way. In a decaying vibration, whose points lie close to each other, it
/// is a small part of that.
pub const REVERSALS_MAX: usize = 64;

/// Places of what is remembered.
const TURN: usize = 0;
/// Where the joint is.
const PLACE: usize = 1;
/// Number of reversal points.
const COUNT: usize = 2;
/// Load and stored energy at the last of them.
const LOAD: usize = 3;
const STORED: usize = 4;
/// Heat of the way from there.
const HEAT: usize = 5;
/// Energy that forgetting has put in, which later heat pays.
const OWED: usize = 6;
/// Parameters for which load, energy and heat hold.
const PARAMETERS: usize = 7;
/// By how much forgetting has changed the load since the joint was last on its first curve.
const SHIFT: usize = 11;
/// The reversal points, oldest first.
const POINTS: usize = 12;

/// Numbers that are no variables: all but the last reversal point.
pub(super) const HIDDEN: usize = POINTS + REVERSALS_MAX - 1;

/// The memory to read in.
#[derive(Clone, Copy)]
pub(super) struct Reversals<'m> {
    numbers: &'m [f64],
}

/// The branch that a motion is on: so many of the remembered reversal points are left, and perhaps the present place is
/// another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Branch {
    count: usize,
    turned: bool,
    /// Whether it goes to larger displacements; `None` before the first motion.
    pub(super) is_forward: Option<bool>,
}

/// A reversal point, with what holds there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tip<N> {
    pub(super) place: N,
    pub(super) load: N,
    pub(super) stored: N,
}

impl<N: Number> Tip<N> {
    const ORIGIN: Self = Self {
        place: N::ZERO,
        load: N::ZERO,
        stored: N::ZERO,
    };

    /// The end of the way from here to `place`.
    fn to(&self, place: f64, curve: &Curve<N>) -> Self {
        let to = N::from(place);
        let way = to - self.place;
        Self {
            place: to,
            load: self.load + curve.masing(way),
            stored: self.stored + curve.masing_stored(self.load, self.stored, way),
        }
    }

    /// The end of the way from the origin to `place`.
    fn first(place: f64, curve: &Curve<N>) -> Self {
        let place = N::from(place);
        Self {
            place,
            load: curve.along(place),
            stored: curve.stored(place),
        }
    }

    /// The end of the way over all these points.
    fn over(points: &[f64], curve: &Curve<N>) -> Option<Self> {
        let (&first, rest) = points.split_first()?;
        let start = Self::first(first, curve);
        Some(rest.iter().fold(start, |tip, &place| tip.to(place, curve)))
    }
}

impl<'m> Reversals<'m> {
    pub(super) fn of(memory: &'m [f64]) -> Self {
        Self { numbers: memory }
    }

    fn number(&self, place: usize) -> f64 {
        self.numbers.get(place).copied().unwrap_or(0.0)
    }

    fn place(&self) -> f64 {
        self.number(PLACE)
    }

    pub(super) fn owed(&self) -> f64 {
        self.number(OWED)
    }

    /// The reversal points, oldest first.
    fn points(&self) -> &'m [f64] {
        let all = self.numbers.get(POINTS..).unwrap_or_default();
        // a number that only this file writes; whatever else it is, it is no more than there are
        let count = (self.number(COUNT) as usize).min(all.len());
        &all[..count]
    }

    /// The branch on which the joint is.
    fn own_branch(&self) -> Branch {
        let (points, place) = (self.points(), self.place());
        let start = points.last().copied().unwrap_or(0.0);
        Branch {
            count: points.len(),
            turned: false,
            is_forward: (place != start).then_some(place > start),
        }
    }

    /// The branch on which a straight way to r ends.
    pub(super) fn branch(&self, r: f64) -> Branch {
        let (points, place) = (self.points(), self.place());
        let mut branch = self.own_branch();
        if r == place {
            return branch;
        }
        let is_forward = r > place;
        branch.turned = branch.is_forward.is_some_and(|it| it != is_forward);
        branch.is_forward = Some(is_forward);
        while let Some(shorter) = branch.without_closed_loop(points, place, r) {
            branch = shorter;
        }
        branch
    }

    /// Where a branch begins; `None` where it is the first way from the origin.
    pub(super) fn place_of(&self, branch: &Branch) -> Option<f64> {
        branch.last(self.points(), self.place(), 0)
    }

    /// Where a branch begins, with what holds there.
    pub(super) fn tip<N: Number>(&self, branch: &Branch, curve: &Curve<N>) -> Option<Tip<N>> {
        let points = self.points();
        let kept = &points[..branch.count.min(points.len())];
        let before = if kept.len() == points.len() && self.holds_for(curve) {
            self.known_tip()
        } else {
            Tip::over(kept, curve)
        };
        match (branch.turned, before) {
            (false, tip) => tip,
            (true, Some(tip)) => Some(tip.to(self.place(), curve)),
            (true, None) => Some(Tip::first(self.place(), curve)),
        }
    }

    /// The last reversal point, as it was committed.
    fn known_tip<N: Number>(&self) -> Option<Tip<N>> {
        self.points().last().map(|&place| Tip {
            place: N::from(place),
            load: N::from(self.number(LOAD)),
            stored: N::from(self.number(STORED)),
        })
    }

    /// Whether what was committed holds for these parameters, which do not change.
    fn holds_for<N: Number>(&self, curve: &Curve<N>) -> bool {
        let mut own = curve.parameters.iter().enumerate();
        own.all(|(k, &parameter)| {
            let known = N::from(self.number(PARAMETERS + k));
            (parameter - known).is_zero()
        })
    }
}

impl Branch {
    /// The reversal point so many before the one where the branch begins.
    fn last(&self, points: &[f64], place: f64, before: usize) -> Option<f64> {
        if self.turned && before == 0 {
            return Some(place);
        }
        let from_end = before + 1 - usize::from(self.turned);
        let index = self.count.checked_sub(from_end)?;
        points.get(index).copied()
    }

    /// Where the branch meets the one before it.
    fn closes_at(&self, points: &[f64], place: f64) -> Option<f64> {
        match self.last(points, place, 1) {
            Some(before) => Some(before),
            // the first way from the origin goes on from the mirror image of the first reversal
            None => self.last(points, place, 0).map(|first| -first),
        }
    }

    /// The branch on which a way to r goes on where this one has closed a loop; `None` where it has not.
    fn without_closed_loop(&self, points: &[f64], place: f64, r: f64) -> Option<Self> {
        let end = self.closes_at(points, place)?;
        let is_forward = self.is_forward?;
        let passes = if is_forward { r >= end } else { r <= end };
        passes.then(|| self.shortened())
    }

    /// Without its last two points, or without its only one.
    fn shortened(&self) -> Self {
        let points = self.count + usize::from(self.turned);
        Self {
            count: points.saturating_sub(2),
            turned: false,
            is_forward: self.is_forward,
        }
    }

    /// Heat of the way from the branch's begin to a point on it.
    fn heat(&self, points: &[f64], place: f64, to: f64, curve: &Curve<f64>) -> f64 {
        match self.last(points, place, 0) {
            None => curve.heat(to.abs()),
            Some(start) => curve.masing_heat((to - start).abs()),
        }
    }
}

/// Moves the memory on to r, and returns the heat of the way, J.
pub(super) fn commit(memory: &mut [f64], curve: &Curve<f64>, r: f64) -> f64 {
    if memory.len() <= HIDDEN || r == memory[PLACE] {
        return 0.0;
    }
    if memory[COUNT] >= REVERSALS_MAX as f64 {
        forget(memory, curve);
    }
    let is_forward = r > memory[PLACE];
    let reversals = Reversals::of(memory);
    let (points, place) = (reversals.points(), reversals.place());
    let known = reversals.holds_for(curve);
    let mut branch = reversals.own_branch();
    let mut before = match branch.is_forward {
        Some(it) if it != is_forward => 0.0,
        _ if known => memory[HEAT],
        _ => branch.heat(points, place, place, curve),
    };
    branch.turned = branch.is_forward.is_some_and(|it| it != is_forward);
    branch.is_forward = Some(is_forward);
    // from loop to loop, each with the heat of its own branch
    let mut heat = 0.0;
    while let (Some(end), Some(next)) = (
        branch.closes_at(points, place),
        branch.without_closed_loop(points, place, r),
    ) {
        heat += branch.heat(points, place, end, curve) - before;
        branch = next;
        before = branch.heat(points, place, end, curve);
    }
    let after = branch.heat(points, place, r, curve);
    heat += after - before;
    let tip = reversals.tip(&branch, curve);
    write(memory, curve, &branch, tip.unwrap_or(Tip::ORIGIN));
    memory[HEAT] = after;
    memory[PLACE] = r;
    if memory[COUNT] >= REVERSALS_MAX as f64 {
        // now, because the shift does no work while the joint stays, and so that there is room where it turns next
        forget(memory, curve);
    }
    // rounding apart, no way gives heat back
    pay(memory, heat.max(0.0))
}

/// What is left of this heat when what is owed is paid.
fn pay(memory: &mut [f64], heat: f64) -> f64 {
    let paid = heat.min(memory[OWED]);
    memory[OWED] -= paid;
    heat - paid
}

/// Takes over the branch on which the joint is from now on.
fn write(memory: &mut [f64], curve: &Curve<f64>, branch: &Branch, tip: Tip<f64>) {
    let mut count = branch.count;
    if branch.turned {
        memory[POINTS + count] = memory[PLACE];
        count += 1;
    }
    memory[COUNT] = count as f64;
    if count == 0 {
        memory[SHIFT] = 0.0;
    }
    memory[TURN] = tip.place;
    memory[LOAD] = tip.load;
    memory[STORED] = tip.stored;
    memory[PARAMETERS..SHIFT].copy_from_slice(&curve.parameters);
}

/// Forgets two neighbouring reversal points: of those whose loss shifts the load back from where earlier losses have
/// shifted it, those that shift it least. What the springs gain by that is owed; what they lose is taken off it, and
/// heat if it is more.
fn forget(memory: &mut [f64], curve: &Curve<f64>) {
    let place = memory[PLACE];
    let stored_at =
        |points: &[f64]| Tip::over(points, curve).map_or(0.0, |tip| tip.to(place, curve).stored);
    let points = Reversals::of(memory).points();
    let way = |k: usize| points[k + 1] - points[k];
    // over the ways a, b, c between four points: 2F((a+b+c)/2) − 2F(a/2) − 2F(b/2) − 2F(c/2), which has the sign of a
    let shift = |k: usize| {
        let ways = [way(k - 1), way(k), way(k + 1)];
        let each: f64 = ways.map(|way| curve.masing(way)).iter().sum();
        curve.masing(ways.iter().sum()) - each
    };
    let is_up = memory[SHIFT] < 0.0;
    // neither the first point, whose mirror image is one as well, nor the last, from which the present way is still
    // short
    let candidates = (1..points.len().saturating_sub(2)).filter(|&k| (way(k - 1) > 0.0) == is_up);
    let least = candidates
        .map(|k| (k, shift(k)))
        .min_by(|(_, one), (_, other)| one.abs().total_cmp(&other.abs()));
    let Some((least, shift)) = least else {
        return;
    };
    let before = stored_at(points);
    let count = points.len();
    memory.copy_within(POINTS + least + 2..POINTS + count, POINTS + least);
    memory[COUNT] = (count - 2) as f64;
    let kept = Reversals::of(memory).points();
    let after = stored_at(kept);
    let tip = Tip::over(kept, curve).unwrap_or(Tip::ORIGIN);
    memory[TURN] = tip.place;
    memory[LOAD] = tip.load;
    memory[STORED] = tip.stored;
    memory[HEAT] = curve.masing_heat((place - tip.place).abs());
    memory[PARAMETERS..SHIFT].copy_from_slice(&curve.parameters);
    memory[OWED] += after - before;
    memory[SHIFT] += shift;
}
