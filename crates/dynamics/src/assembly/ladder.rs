//! Everything that steps of one length need, and of its halves: prepared once, so that a step allocates nothing.

use super::{
    coordinates::Parts,
    lobatto::THETA,
    modal,
    modes::Frame,
    propagator::{Blocks, Propagator},
    stages::Stages,
};

/// How often a step is halved where the joints are too stiff for it.
pub(super) const HALVINGS: usize = 12;
/// How often one that is short enough is halved where a joint turns or passes a corner within it.
pub(super) const HALVINGS_AT_EVENTS: usize = 10;

/// One length of step.
#[derive(Clone, Debug)]
pub(super) struct Rung {
    pub(super) length_s: f64,
    /// Over the whole step.
    pub(super) whole: Blocks,
    /// What the joints' forces are found by; nothing where no joint has a law beside the linear one.
    pub(super) stages: Option<Stages>,
}

/// The lengths h, h/2, h/4 …; of an assembly whose joints have no law beside the linear one, the first alone.
#[derive(Clone, Debug)]
pub(super) struct Ladder {
    pub(super) rungs: Vec<Rung>,
}

impl Ladder {
    /// For steps of `length_s` (s); `None` where the exponential is not finite.
    pub(super) fn new(parts: &Parts, length_s: f64) -> Option<Self> {
        let rungs = match (&parts.frame, parts.system.forces()) {
            (Some(frame), forces) => Self::in_modes(parts, frame, length_s, forces > 0)?,
            (None, 0) => vec![Rung {
                length_s,
                whole: Propagator::new(&parts.system, length_s, 0)?.blocks(),
                stages: None,
            }],
            (None, _) => Self::by_exponentials(parts, length_s)?,
        };
        Some(Self { rungs })
    }

    /// Mode by mode.
    fn in_modes(parts: &Parts, frame: &Frame, length_s: f64, has_laws: bool) -> Option<Vec<Rung>> {
        let blocks = |length_s: f64| modal::blocks(parts, frame, length_s);
        let halvings = if has_laws { HALVINGS } else { 0 };
        let mut rungs = Vec::with_capacity(halvings + 1);
        let mut longer = blocks(length_s);
        for level in 0..=halvings as i32 {
            let length_s = length_s * 0.5_f64.powi(level);
            let half = blocks(0.5 * length_s);
            let stages = has_laws.then(|| {
                let [second, fourth] = [THETA[1], THETA[3]].map(|theta| blocks(theta * length_s));
                let to_nodes = [&second, &half, &fourth, &longer];
                Stages::of(&parts.system, &parts.sight.relative, to_nodes)
            });
            rungs.push(Rung {
                length_s,
                stages,
                whole: longer,
            });
            longer = half;
        }
        let are_finite = rungs.iter().all(|rung| rung.whole.state.is_finite());
        are_finite.then_some(rungs)
    }

    /// By the exponentials of the shortest lengths, squared again and again: of whatever has no modes of its own.
    fn by_exponentials(parts: &Parts, length_s: f64) -> Option<Vec<Rung>> {
        let system = &parts.system;
        let mut rungs = Vec::with_capacity(HALVINGS + 1);
        let start = |share: f64| Propagator::new(system, share * length_s, HALVINGS + 1);
        let mut propagators = [start(THETA[1])?, start(1.0)?, start(THETA[3])?];
        let [.., mut half, _] = propagators.each_ref().map(Propagator::blocks);
        for level in (0..=HALVINGS as i32).rev() {
            propagators = doubled(&propagators)?;
            let [second, whole, fourth] = propagators.each_ref().map(Propagator::blocks);
            let to_nodes = [&second, &half, &fourth, &whole];
            rungs.push(Rung {
                length_s: length_s * 0.5_f64.powi(level),
                stages: Some(Stages::of(system, &parts.sight.relative, to_nodes)),
                whole: whole.clone(),
            });
            half = whole;
        }
        rungs.reverse();
        Some(rungs)
    }
}

fn doubled<'s>([first, second, third]: &[Propagator<'s>; 3]) -> Option<[Propagator<'s>; 3]> {
    Some([first.doubled()?, second.doubled()?, third.doubled()?])
}
