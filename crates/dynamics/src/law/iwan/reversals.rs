//! What the Iwan law remembers: the points at which the joint turned, and what follows from them, in a fixed number of
//! numbers.
//!
//! A loop is forgotten as soon as it closes, so that the ways between the points become shorter one by one. Where there
//! are more than [`REVERSALS_MAX`] of them, as after many cycles of a slowly decaying vibration, two neighbours are
//! forgotten before: those whose loss changes the load least.

use super::{
    Iwan,
    curve::{At, Curve, towards},
    elongations::Elongations,
    strength::Strength,
};
use crate::law::{Corner, Law};
use crate::number::Number;

/// Reversal points that are kept.
///
/// With so many, forgetting two shifts the load by 2 F_S/30 at most, because 30 pairs that share no slider share a load
/// of 2 F_S, and the next shift goes the other way. In a decaying vibration, whose points lie close to each other, it
/// is a small part of that.
pub const REVERSALS_MAX: usize = 64;

/// Places of what is remembered.
pub(super) const TURN: usize = 0;
/// Where the joint is.
pub(super) const PLACE: usize = 1;
/// Number of reversal points, or of the corners of the line of elongations.
pub(super) const COUNT: usize = 2;
/// Load and stored energy at the last of them.
const LOAD: usize = 3;
const STORED: usize = 4;
/// Heat of the way from there.
const HEAT: usize = 5;
/// Energy that forgetting has put in, which later heat pays.
pub(super) const OWED: usize = 6;
/// Parameters for which load, energy and heat hold.
pub(super) const PARAMETERS: usize = 7;
/// By how much forgetting has changed the load since the joint was last on its first curve.
const SHIFT: usize = 11;
/// The power of the way from the last reversal, from which all follows at the present place.
const BENT: usize = 12;
/// Whether the elongations of the sliders are remembered in the place of reversal points, because their strength has changed.
pub(super) const ELONGATED: usize = 13;
/// Load at the present place.
const LOAD_HERE: usize = 14;
/// What the parameters give.
const DERIVED: usize = 15;
/// The reversal points, oldest first.
pub(super) const POINTS: usize = 18;

/// Numbers that are no variables: all but the last reversal point.
pub(super) const HIDDEN: usize = POINTS + REVERSALS_MAX - 1;

/// The memory to read in.
#[derive(Clone, Copy)]
pub(super) struct Reversals<'m, M> {
    numbers: &'m [M],
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
    fn to(&self, place: N, curve: &Curve<N>) -> Self {
        let way = place - self.place;
        let half = curve.at(N::from(0.5) * way);
        Self {
            place,
            load: self.load + N::from(2.0) * towards(way, curve.load(&half)),
            stored: self.stored + curve.masing_stored(self.load, self.stored, way, &half),
        }
    }

    /// The end of the way from the origin to `place`.
    fn first(place: N, curve: &Curve<N>) -> Self {
        let at = curve.at(place);
        Self {
            place,
            load: towards(place, curve.load(&at)),
            stored: curve.stored(&at),
        }
    }

    /// The end of the way over all these points.
    fn over<M: Number + Into<N>>(points: &[M], curve: &Curve<N>) -> Option<Self> {
        let (&first, rest) = points.split_first()?;
        let start = Self::first(first.into(), curve);
        let to = |tip: Self, &place: &M| tip.to(place.into(), curve);
        Some(rest.iter().fold(start, to))
    }
}

impl<'m, M: Number> Reversals<'m, M> {
    pub(super) fn of(memory: &'m [M]) -> Self {
        Self { numbers: memory }
    }

    /// The sliders' elongations, where their strength or their springs have changed since the joint has moved: then points do not tell them.
    #[inline]
    pub(super) fn elongations<N: Number>(&self, law: &Iwan<N>) -> Option<Elongations<N>>
    where
        M: Into<N>,
    {
        let known: [N; 4] = std::array::from_fn(|k| self.number(PARAMETERS + k).into());
        let parameters = law.parameters();
        let is_same = |k: usize| (parameters[k] - known[k]).is_zero();
        let are_same = is_same(0) & is_same(1) & is_same(2) & is_same(3);
        if are_same && self.number(ELONGATED).is_zero() {
            return None;
        }
        self.changed_elongations(law, &known)
    }

    /// The sliders' elongations, whether their strength has changed or not; `None` where nothing has ever moved.
    pub(super) fn all_elongations<N: Number>(&self, law: &Iwan<N>) -> Option<Elongations<N>>
    where
        M: Into<N>,
    {
        let known: [N; 4] = std::array::from_fn(|k| self.number(PARAMETERS + k).into());
        let has_moved = self.number(PLACE).value() != 0.0 || !self.points().is_empty();
        match has_moved || !self.number(ELONGATED).is_zero() {
            true => self.changed_elongations(law, &known),
            false => law.is_there().then(Elongations::at_rest),
        }
    }

    #[cold]
    fn changed_elongations<N: Number>(
        &self,
        law: &Iwan<N>,
        known: &[N; 4],
    ) -> Option<Elongations<N>>
    where
        M: Into<N>,
    {
        if !self.number(ELONGATED).is_zero() {
            return Some(Elongations::remembered(self.numbers));
        }
        let has_moved = self.number(PLACE).value() != 0.0 || !self.points().is_empty();
        let span = Strength::of(&Iwan::new(known)).span;
        (has_moved && law.is_there() && span.value() > 0.0)
            .then(|| Elongations::of_points(self.points(), self.place(), span))
    }

    /// The curve of this law, if what was committed holds for its parameters, which do not change.
    #[inline]
    pub(super) fn curve<N: Number>(&self, law: &Iwan<N>) -> Option<Curve<N>>
    where
        M: Into<N>,
    {
        let known = self.known(law)?;
        let derived = [0, 1, 2].map(|k| known[DERIVED + k].into());
        Some(Curve::from_derived(law, derived))
    }

    /// The load at r, if the joint is there and that holds for this law.
    #[inline]
    pub(super) fn load_here<N: Number>(&self, law: &Iwan<N>, r: N) -> Option<N>
    where
        M: Into<N>,
    {
        let known = self.known(law)?;
        let is_here = (r - known[PLACE].into()).is_zero();
        is_here.then(|| known[LOAD_HERE].into())
    }

    /// The numbers before the points, if they hold for this law.
    #[inline]
    fn known<N: Number>(&self, law: &Iwan<N>) -> Option<&'m [M; POINTS]>
    where
        M: Into<N>,
    {
        let known: &[M; POINTS] = self.numbers.first_chunk()?;
        let parameters = law.parameters();
        let is_same = |k: usize| (parameters[k] - known[PARAMETERS + k].into()).is_zero();
        (is_same(0) & is_same(1) & is_same(2) & is_same(3)).then_some(known)
    }

    fn number(&self, place: usize) -> M {
        self.numbers.get(place).copied().unwrap_or(M::ZERO)
    }

    pub(super) fn place(&self) -> M {
        self.number(PLACE)
    }

    pub(super) fn owed(&self) -> M {
        self.number(OWED)
    }

    /// The reversal points, oldest first.
    fn points(&self) -> &'m [M] {
        let all = self.numbers.get(POINTS..).unwrap_or_default();
        // a number that only this file writes; whatever else it is, it is no more than there are
        let count = (self.number(COUNT).value() as usize).min(all.len());
        &all[..count]
    }

    /// The branch on which the joint is.
    fn own_branch(&self) -> Branch {
        let (points, place) = (self.points(), self.place().value());
        let start = points.last().map_or(0.0, |start| start.value());
        Branch {
            count: points.len(),
            turned: false,
            is_forward: (place != start).then_some(place > start),
        }
    }

    /// The branch on which a straight way to r ends.
    pub(super) fn branch(&self, r: f64) -> Branch {
        let (points, place) = (self.points(), self.place());
        if r == place.value() {
            return self.own_branch();
        }
        let mut branch = self.branch_towards(r);
        while let Some(shorter) = branch.without_closed_loop(points, place, r) {
            branch = shorter;
        }
        branch
    }

    /// The branch on which a straight way to r begins.
    fn branch_towards(&self, r: f64) -> Branch {
        let mut branch = self.own_branch();
        let is_forward = r > self.place().value();
        branch.turned = branch.is_forward.is_some_and(|it| it != is_forward);
        branch.is_forward = Some(is_forward);
        branch
    }

    /// Tells where a straight way to r closes loops, and where all slips on each of its branches: from `span` on.
    pub(super) fn corners(&self, r: f64, span: f64, tell: &mut dyn FnMut(Corner)) {
        let (points, place) = (self.points(), self.place());
        let mut branch = self.branch_towards(r);
        let sign = if r > place.value() { 1.0 } else { -1.0 };
        loop {
            let start = branch.last(points, place, 0);
            let slips = start.map_or(sign * span, |start| start.value() + 2.0 * sign * span);
            tell(Corner::Sharp(slips));
            let Some(shorter) = branch.without_closed_loop(points, place, r) else {
                break;
            };
            if let Some(end) = branch.closes_at(points, place) {
                tell(Corner::Sharp(end.value()));
            }
            branch = shorter;
        }
    }

    /// Where a branch begins; `None` where it is the first way from the origin.
    pub(super) fn place_of(&self, branch: &Branch) -> Option<M> {
        branch.last(self.points(), self.place(), 0)
    }

    /// The place on the curve at a point of a branch: of the way from the origin, or of half the way from where it begins.
    pub(super) fn at<N: Number>(&self, branch: &Branch, r: N, curve: &Curve<N>) -> At<N>
    where
        M: Into<N>,
    {
        let way = match self.place_of(branch) {
            None => r,
            Some(start) => N::from(0.5) * (r - start.into()),
        };
        let is_here = *branch == self.own_branch() && (r - self.place().into()).is_zero();
        if is_here && curve.is_known {
            curve.known(way, self.number(BENT).into())
        } else {
            curve.at(way)
        }
    }

    /// Where a branch begins, with what holds there.
    pub(super) fn tip<N: Number>(&self, branch: &Branch, curve: &Curve<N>) -> Option<Tip<N>>
    where
        M: Into<N>,
    {
        let points = self.points();
        let kept = &points[..branch.count.min(points.len())];
        let before = if kept.len() == points.len() && curve.is_known {
            self.known_tip()
        } else {
            Tip::over(kept, curve)
        };
        match (branch.turned, before) {
            (false, tip) => tip,
            (true, Some(tip)) => Some(tip.to(self.place().into(), curve)),
            (true, None) => Some(Tip::first(self.place().into(), curve)),
        }
    }

    /// The last reversal point, as it was committed.
    fn known_tip<N: Number>(&self) -> Option<Tip<N>>
    where
        M: Into<N>,
    {
        self.points().last().map(|&place| Tip {
            place: place.into(),
            load: self.number(LOAD).into(),
            stored: self.number(STORED).into(),
        })
    }
}

impl Branch {
    /// The reversal point so many before the one where the branch begins.
    fn last<M: Number>(&self, points: &[M], place: M, before: usize) -> Option<M> {
        if self.turned && before == 0 {
            return Some(place);
        }
        let from_end = before + 1 - usize::from(self.turned);
        let index = self.count.checked_sub(from_end)?;
        points.get(index).copied()
    }

    /// Where the branch meets the one before it.
    fn closes_at<M: Number>(&self, points: &[M], place: M) -> Option<M> {
        match self.last(points, place, 1) {
            Some(before) => Some(before),
            // the first way from the origin goes on from the mirror image of the first reversal
            None => self.last(points, place, 0).map(|first| -first),
        }
    }

    /// The branch on which a way to r goes on where this one has closed a loop; `None` where it has not.
    fn without_closed_loop<M: Number>(&self, points: &[M], place: M, r: f64) -> Option<Self> {
        let end = self.closes_at(points, place)?.value();
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
    fn heat<N: Number>(&self, points: &[N], place: N, to: N, curve: &Curve<N>) -> N {
        self.end(points, place, to, curve).0
    }

    /// That heat, with the place on the curve from which it follows.
    fn end<N: Number>(&self, points: &[N], place: N, to: N, curve: &Curve<N>) -> (N, At<N>) {
        match self.last(points, place, 0) {
            None => {
                let at = curve.at(to);
                (curve.heat(&at), at)
            }
            // D(x/2)/2
            Some(start) => {
                let half = curve.at(N::from(0.5) * (to - start));
                (N::from(2.0) * curve.heat(&half), half)
            }
        }
    }
}

/// How many numbers are in use, or are after one commit, which may add a point or find that the sliders' strength has changed.
pub(super) fn used<N: Number>(memory: &[N], law: &Iwan<N>) -> usize {
    let number = |place: usize| memory.get(place).map_or(0.0, |number| number.value());
    let parameters = law.parameters();
    let is_same = |k: usize| number(PARAMETERS + k) == parameters[k].value();
    let are_same = is_same(0) & is_same(1) & is_same(2) & is_same(3);
    let has_points = number(ELONGATED) == 0.0 && are_same;
    match has_points {
        true => (POINTS + number(COUNT) as usize + 1).min(memory.len()),
        false => memory.len(),
    }
}

/// Whether all that a commit has written is finite: points were places before.
pub(super) fn is_finite<N: Number>(memory: &[N]) -> bool {
    let all = |numbers: &[N]| {
        let numbers = numbers.iter();
        numbers.fold(true, |all, number| all & number.is_finite())
    };
    match memory.first_chunk::<DERIVED>() {
        // so many at once, without a loop
        Some(first) if first[ELONGATED].value() == 0.0 => all(first),
        _ => all(memory),
    }
}

/// Moves the memory on to r, and returns the heat of the way, J.
pub(super) fn commit<N: Number>(memory: &mut [N], curve: &Curve<N>, r: N) -> f64 {
    if memory.len() <= HIDDEN || r.value() == memory[PLACE].value() {
        return 0.0;
    }
    if memory[COUNT].value() >= REVERSALS_MAX as f64 {
        forget(memory, curve);
    }
    let reversals = Reversals::of(memory);
    let (points, place) = (reversals.points(), reversals.place());
    let known = curve.is_known;
    let mut branch = reversals.branch_towards(r.value());
    let mut before = match branch.turned {
        true => N::ZERO,
        false if known => memory[HEAT],
        false => branch.heat(points, place, place, curve),
    };
    // from loop to loop, each with the heat of its own branch
    let mut heat = N::ZERO;
    while let (Some(end), Some(next)) = (
        branch.closes_at(points, place),
        branch.without_closed_loop(points, place, r.value()),
    ) {
        heat = heat + (branch.heat(points, place, end, curve) - before);
        branch = next;
        before = branch.heat(points, place, end, curve);
    }
    let (after, at) = branch.end(points, place, r, curve);
    heat = heat + (after - before);
    let tip = reversals.tip(&branch, curve);
    write(memory, curve, &branch, tip.unwrap_or(Tip::ORIGIN));
    memory[HEAT] = after;
    memory[BENT] = at.bent.unwrap_or(N::ZERO);
    memory[LOAD_HERE] = load(tip.as_ref(), r, curve, &at);
    memory[PLACE] = r;
    if memory[COUNT].value() >= REVERSALS_MAX as f64 {
        // now, because the shift does no work while the joint stays, and so that there is room where it turns next
        forget(memory, curve);
    }
    // rounding apart, no way gives heat back
    let heat = if heat.value() > 0.0 { heat } else { N::ZERO };
    pay(memory, heat).value()
}

/// Load at r, `at` on the curve, on the way from a reversal point or from the origin.
#[inline]
pub(super) fn load<N: Number>(tip: Option<&Tip<N>>, r: N, curve: &Curve<N>, at: &At<N>) -> N {
    let load = curve.load(at);
    match tip {
        // f = F(r), F odd
        None => towards(r, load),
        // f = f_r + 2 F((r − u_r)/2)   (Masing)
        Some(tip) => tip.load + N::from(2.0) * towards(r - tip.place, load),
    }
}

/// What is left of this heat when what is owed is paid.
pub(super) fn pay<N: Number>(memory: &mut [N], heat: N) -> N {
    let owed = memory[OWED];
    let paid = if heat.value() < owed.value() {
        heat
    } else {
        owed
    };
    memory[OWED] = owed - paid;
    heat - paid
}

/// Takes over the branch on which the joint is from now on.
fn write<N: Number>(memory: &mut [N], curve: &Curve<N>, branch: &Branch, tip: Tip<N>) {
    let mut count = branch.count;
    if branch.turned {
        memory[POINTS + count] = memory[PLACE];
        count += 1;
    }
    memory[COUNT] = N::from(count as f64);
    if count == 0 {
        memory[SHIFT] = N::ZERO;
    }
    memory[TURN] = tip.place;
    memory[LOAD] = tip.load;
    memory[STORED] = tip.stored;
    remember(memory, curve);
}

/// Remembers for which curve the rest holds.
fn remember<N: Number>(memory: &mut [N], curve: &Curve<N>) {
    memory[PARAMETERS..SHIFT].copy_from_slice(&curve.parameters);
    memory[DERIVED..POINTS].copy_from_slice(&curve.derived());
}

/// Forgets two neighbouring reversal points: of those whose loss shifts the load back from where earlier losses have
/// shifted it, those that shift it least. What the springs gain by that is owed; what they lose is taken off it, and
/// heat if it is more.
fn forget<N: Number>(memory: &mut [N], curve: &Curve<N>) {
    let place = memory[PLACE];
    let stored_at =
        |points: &[N]| Tip::over(points, curve).map_or(N::ZERO, |tip| tip.to(place, curve).stored);
    let points = Reversals::of(memory).points();
    let way = |k: usize| points[k + 1] - points[k];
    // over the ways a, b, c between four points: 2F((a+b+c)/2) − 2F(a/2) − 2F(b/2) − 2F(c/2), which has the sign of a
    let shift = |k: usize| {
        let ways = [way(k - 1), way(k), way(k + 1)];
        let sum = |parts: [N; 3]| parts[0] + parts[1] + parts[2];
        curve.masing(sum(ways)) - sum(ways.map(|way| curve.masing(way)))
    };
    let is_up = memory[SHIFT].value() < 0.0;
    // neither the first point, whose mirror image is one as well, nor the last, from which the present way is still
    // short
    let candidates =
        (1..points.len().saturating_sub(2)).filter(|&k| (way(k - 1).value() > 0.0) == is_up);
    let least = candidates
        .map(|k| (k, shift(k)))
        .min_by(|(_, one), (_, other)| one.value().abs().total_cmp(&other.value().abs()));
    let Some((least, shift)) = least else {
        return;
    };
    let before = stored_at(points);
    let count = points.len();
    memory.copy_within(POINTS + least + 2..POINTS + count, POINTS + least);
    memory[COUNT] = N::from((count - 2) as f64);
    let kept = Reversals::of(memory).points();
    let after = stored_at(kept);
    let tip = Tip::over(kept, curve).unwrap_or(Tip::ORIGIN);
    memory[TURN] = tip.place;
    memory[LOAD] = tip.load;
    memory[STORED] = tip.stored;
    let half = curve.at(N::from(0.5) * (place - tip.place));
    memory[HEAT] = N::from(2.0) * curve.heat(&half);
    memory[BENT] = half.bent.unwrap_or(N::ZERO);
    memory[LOAD_HERE] = load(
        (memory[COUNT].value() > 0.0).then_some(&tip),
        place,
        curve,
        &half,
    );
    remember(memory, curve);
    memory[OWED] = memory[OWED] + (after - before);
    memory[SHIFT] = memory[SHIFT] + shift;
}
