//! Everything that steps of one length need, and of its halves: prepared once, so that a step allocates nothing.

use super::{
    lobatto::THETA,
    matrix::Matrix,
    modal::Modal,
    modes::Frame,
    propagator::{Blocks, Going, Propagator, scale},
    stages::Stages,
    system::System,
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

/// The lengths h, h/2, h/4 …
#[derive(Clone, Debug)]
pub(super) struct Ladder {
    /// The longest one in q and q̇, the halves in the frame's coordinates if there is one.
    pub(super) rungs: Vec<Rung>,
    pub(super) frame: Option<Frame>,
    /// What is seen of q and q̇, and of the coordinates of the halves.
    sights: [Sight; 2],
}

/// What joints and loads see of the state, in the coordinates of the ladder.
#[derive(Clone, Debug)]
pub(super) struct Sight {
    /// Relative displacements of the DOFs with laws, and then their rates: 2d × 2n.
    pub(super) relative: Matrix,
    /// Displacements at the loads and of these DOFs: (m + d) × 2n.
    pub(super) places: Matrix,
}

impl Ladder {
    /// What is seen of a state at a level.
    pub(super) fn sight(&self, level: usize) -> &Sight {
        let [longest, halves] = &self.sights;
        if level == 0 { longest } else { halves }
    }

    /// For steps of `length_s` (s); `None` where the exponential is not finite.
    pub(super) fn new(system: &System, length_s: f64) -> Option<Self> {
        if system.forces() == 0 {
            let rung = Rung {
                length_s,
                whole: Propagator::new(system, length_s, 0)?.blocks(),
                stages: None,
            };
            return Some(Self {
                rungs: vec![rung],
                frame: None,
                sights: [Sight::of(system), Sight::of(system)],
            });
        }
        let frame = Frame::of(system).filter(|frame| frame.is_whole(system, &scale(system)));
        match frame {
            Some(frame) => Self::in_modes(system, frame, length_s),
            None => Self::by_exponentials(system, length_s),
        }
    }

    /// Mode by mode.
    fn in_modes(system: &System, frame: Frame, length_s: f64) -> Option<Self> {
        let plain = Sight::of(system);
        let modal = Modal::of(system, &frame, &plain);
        let seen = |rows: &Matrix| rows.product(frame.out_of_modes());
        let sight = Sight {
            relative: seen(&plain.relative),
            places: seen(&plain.places),
        };
        let outside = |rung: &Rung| {
            let seen = |rows: &Matrix| rows.product(frame.to_modes());
            let by = |rows: &Matrix| rows.product(&frame.out_of_modes().transposed());
            let stages = rung.stages.as_ref().map(|stages| Stages {
                by_state: seen(&stages.by_state),
                ..stages.clone()
            });
            Rung {
                length_s: rung.length_s,
                stages,
                whole: Blocks {
                    state: Going::Whole(seen(&rung.whole.state.seen_by(frame.out_of_modes()))),
                    by: rung.whole.by.each_ref().map(by),
                    moments: rung.whole.moments.each_ref().map(seen),
                    moments_by: rung.whole.moments_by.clone(),
                },
            }
        };
        let whole = |level: i32| modal.blocks(length_s * 0.5_f64.powi(level));
        let mut rungs = Vec::with_capacity(HALVINGS + 1);
        let mut longer = whole(0);
        for level in 0..=HALVINGS as i32 {
            let length_s = length_s * 0.5_f64.powi(level);
            let half = whole(level + 1);
            let [second, fourth] = [THETA[1], THETA[3]].map(|theta| modal.blocks(theta * length_s));
            let to_nodes = [&second, &half, &fourth, &longer];
            rungs.push(Rung {
                length_s,
                stages: Some(Stages::of(system, &sight.relative, to_nodes)),
                whole: longer,
            });
            longer = half;
        }
        if !rungs.iter().all(|rung| rung.whole.state.is_finite()) {
            return None;
        }
        if let Some(longest) = rungs.first_mut() {
            *longest = outside(longest);
        }
        Some(Self {
            rungs,
            sights: [plain, sight],
            frame: Some(frame),
        })
    }

    /// By the exponentials of the shortest lengths, squared again and again: of whatever has no modes of its own.
    fn by_exponentials(system: &System, length_s: f64) -> Option<Self> {
        let sight = Sight::of(system);
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
                stages: Some(Stages::of(system, &sight.relative, to_nodes)),
                whole: whole.clone(),
            });
            half = whole;
        }
        rungs.reverse();
        Some(Self {
            rungs,
            sights: [sight.clone(), sight],
            frame: None,
        })
    }
}

impl Sight {
    pub(super) fn of(system: &System) -> Self {
        let (n, m, d) = (system.size, system.loads, system.forces());
        let mut relative = Matrix::zeros(2 * d, 2 * n);
        relative.set_block([0, 0], &system.rows);
        relative.set_block([d, n], &system.rows);
        let mut places = Matrix::zeros(m + d, 2 * n);
        places.set_block([0, 0], &system.load_rows);
        places.set_block([m, 0], &system.rows);
        Self { relative, places }
    }

    /// Relative displacements and their rates at a state.
    pub(super) fn relative(&self, state: &[f64], relative: &mut [f64]) {
        relative.fill(0.0);
        self.relative.add_product_to(state, relative);
    }
}

fn doubled<'s>([first, second, third]: &[Propagator<'s>; 3]) -> Option<[Propagator<'s>; 3]> {
    Some([first.doubled()?, second.doubled()?, third.doubled()?])
}
