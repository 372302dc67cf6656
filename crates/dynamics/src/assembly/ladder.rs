//! Everything that steps of one length need, and of its halves: prepared once, so that a step allocates nothing.

use super::{
    matrix::Matrix,
    modes::Frame,
    propagator::{Blocks, Going, POWERS, Propagator, scale},
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
    /// What Krogstad's scheme has in its middle; nothing where no joint has a law beside the linear one.
    pub(super) middle: Option<Middle>,
}

/// The condensed scheme: its stages need relative motions alone. With j_k = hφ_kJ at the end and i_k the same at half the length:
/// r at half the step, and how the forces of the stages before act on the relative motion of each stage.
#[derive(Clone, Debug)]
pub(super) struct Middle {
    /// Relative motion at half the step by the state at its beginning, 2d × 2n.
    pub(super) by_state: Matrix,
    /// … by the loads' powers of time over that half, 2d × m.
    pub(super) by_loads: [Matrix; POWERS],
    /// i₁, i₁ − 2 i₂ and 2 i₂ as relative motions, 2d × d.
    pub(super) of_half: [Matrix; 3],
    /// j₁ − 2 j₂ and 2 j₂ as relative motions, 2d × d.
    pub(super) of_whole: [Matrix; 2],
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
                middle: None,
            };
            return Some(Self {
                rungs: vec![rung],
                frame: None,
                sight: Sight::of(system),
            });
        }
        let length = |level: usize| length_s * 0.5_f64.powi(level as i32);
        let mut rungs = Vec::with_capacity(HALVINGS + 1);
        let mut propagator = Propagator::new(system, length_s, HALVINGS + 1)?;
        let mut half = propagator.blocks();
        for level in (0..=HALVINGS).rev() {
            propagator = propagator.doubled()?;
            let whole = propagator.blocks();
            rungs.push(Rung {
                length_s: length(level),
                middle: Some(Middle::of(system, &whole, &half)),
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
            middle: rung.middle.map(|middle| Middle {
                by_state: seen(&middle.by_state),
                ..middle
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

impl Middle {
    fn of(system: &System, whole: &Blocks, half: &Blocks) -> Self {
        let (m, d) = (system.loads, system.forces());
        let rows = relative_rows(system);
        let size = 2 * system.size;
        let of_loads = |block: &Matrix| rows.product(&block.block([0, 0], m, size).transposed());
        let of_forces = |blocks: &Blocks, power: usize| {
            rows.product(&blocks.by[power].block([m, 0], d, size).transposed())
        };
        let [i1, i2] = [0, 1].map(|power| of_forces(half, power));
        let [j1, j2] = [0, 1].map(|power| of_forces(whole, power));
        Self {
            by_state: half.state.seen_by(&rows),
            by_loads: half.by.each_ref().map(of_loads),
            of_half: [i1.clone(), i1.plus(-2.0, &i2), i2.times(2.0)],
            of_whole: [j1.plus(-2.0, &j2), j2.times(2.0)],
        }
    }
}

/// (S, 0; 0, S): relative displacements and their rates by q and q̇.
fn relative_rows(system: &System) -> Matrix {
    let (n, d) = (system.size, system.forces());
    let mut rows = Matrix::zeros(2 * d, 2 * n);
    rows.set_block([0, 0], &system.rows);
    rows.set_block([d, n], &system.rows);
    rows
}
