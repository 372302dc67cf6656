//! Everything that steps of one length need, and of its halves: prepared once, so that a step allocates nothing.

use super::{
    lobatto::THETA,
    matrix::Matrix,
    modes::Frame,
    propagator::{Blocks, Going, Propagator, scale},
    stages::{Stages, relative_rows},
    system::System,
};

/// How often a step is halved where the joints are too stiff for it.
pub(super) const HALVINGS: usize = 12;
/// How often one that is short enough is halved where a joint turns or passes a corner within it.
pub(super) const HALVINGS_AT_EVENTS: usize = 8;

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
    pub(super) rungs: Vec<Rung>,
    /// The coordinates in which all blocks are, if others than q and q̇.
    pub(super) frame: Option<Frame>,
    pub(super) sight: Sight,
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
                sight: Sight::of(system),
            });
        }
        let length = |level: usize| length_s * 0.5_f64.powi(level as i32);
        let mut rungs = Vec::with_capacity(HALVINGS + 1);
        let start = |share: f64| Propagator::new(system, share * length_s, HALVINGS + 1);
        let mut propagators = [start(THETA[1])?, start(1.0)?, start(THETA[3])?];
        let [.., mut half, _] = propagators.each_ref().map(Propagator::blocks);
        for level in (0..=HALVINGS).rev() {
            propagators = doubled(&propagators)?;
            let [second, whole, fourth] = propagators.each_ref().map(Propagator::blocks);
            let to_nodes = [&second, &half, &fourth, &whole];
            rungs.push(Rung {
                length_s: length(level),
                stages: Some(Stages::of(system, to_nodes)),
                whole: whole.clone(),
            });
            half = whole;
        }
        rungs.reverse();
        let ladder = Self {
            rungs,
            frame: None,
            sight: Sight::of(system),
        };
        let frame = Frame::of(system).filter(|frame| {
            let longest = ladder.rungs.first();
            longest.is_some_and(|rung| {
                rung.whole
                    .state
                    .is_given_by(frame, length_s, &scale(system))
            })
        });
        Some(match frame {
            Some(frame) => ladder.within(frame),
            None => ladder,
        })
    }

    /// The same in the coordinates of a frame.
    fn within(self, frame: Frame) -> Self {
        let seen = |rows: &Matrix| rows.product(frame.out_of_modes());
        let transposed = frame.to_modes().transposed();
        let of_modes = |by: &Matrix| by.product(&transposed);
        let rungs = self.rungs.into_iter().map(|rung| Rung {
            length_s: rung.length_s,
            stages: rung.stages.map(|stages| Stages {
                by_state: seen(&stages.by_state),
                ..stages
            }),
            whole: Blocks {
                state: Going::Turning(frame.turns(rung.length_s)),
                by: rung.whole.by.each_ref().map(of_modes),
                moments: rung.whole.moments.each_ref().map(seen),
                moments_by: rung.whole.moments_by,
            },
        });
        Self {
            rungs: rungs.collect(),
            sight: Sight {
                relative: seen(&self.sight.relative),
                places: seen(&self.sight.places),
            },
            frame: Some(frame),
        }
    }
}

impl Sight {
    fn of(system: &System) -> Self {
        let (n, m) = (system.size, system.loads);
        let mut places = Matrix::zeros(m + system.forces(), 2 * n);
        places.set_block([0, 0], &system.load_rows);
        places.set_block([m, 0], &system.rows);
        Self {
            relative: relative_rows(system),
            places,
        }
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
