//! The coordinates in which an assembly goes on from step to step: two for each mode where it has modes, else q and q̇.
//!
//! Mode by mode a step takes a rotation for each, and a product with a full matrix nowhere. So a motion is told in q and q̇ where
//! somebody asks for it, and not at every step.

use std::sync::Arc;

use super::{
    matrix::Matrix,
    modes::Frame,
    propagator::scale,
    state::{AssemblyState, Underway},
    system::{Assembly, System},
};

/// The coordinates of an assembly's steps. Steps of any length have the same ones.
#[derive(Clone, Debug)]
pub struct AssemblyCoordinates(pub(super) Arc<Parts>);

/// What steps of all lengths share.
#[derive(Debug)]
pub(super) struct Parts {
    pub(super) system: System,
    /// The modes; nothing where the coordinates are q and q̇.
    pub(super) frame: Option<Frame>,
    pub(super) sight: Sight,
    /// What loads, and then forces of laws, do to the rates of the coordinates: (m + d) × 2n.
    pub(super) acting: Matrix,
}

/// What joints and loads see of a motion.
#[derive(Clone, Debug)]
pub(super) struct Sight {
    /// Relative displacements of the DOFs with laws, and then their rates: 2d × 2n.
    pub(super) relative: Matrix,
    /// The same, and after them displacements at the loads: (2d + m) × 2n.
    pub(super) ends: Matrix,
    /// Displacements at the loads and of these DOFs: (m + d) × 2n.
    pub(super) places: Matrix,
    /// Velocities at the loads: m × 2n.
    pub(super) velocities: Matrix,
}

impl AssemblyCoordinates {
    /// Those of an assembly.
    #[must_use]
    pub fn of(assembly: &Assembly) -> Self {
        Self(Arc::new(Parts::of(System::of(assembly))))
    }

    /// The motion (q, q̇) of coordinates z, 2n numbers each.
    pub fn write_motion(&self, own: &[f64], motion: &mut [f64]) {
        match &self.0.frame {
            Some(frame) => {
                motion.fill(0.0);
                frame.out_of_modes().add_product_to(own, motion);
            }
            None => motion.copy_from_slice(own),
        }
    }

    /// Goes underway from a state.
    #[must_use]
    pub fn underway(&self, state: &AssemblyState) -> Underway {
        let mut motion = vec![0.0; state.motion.len()];
        match &self.0.frame {
            Some(frame) => frame.to_modes().add_product_to(&state.motion, &mut motion),
            None => motion.copy_from_slice(&state.motion),
        }
        Underway {
            motion,
            memory: state.memory.clone(),
            supplied_j: state.supplied_j,
            balance_j: state.dissipated_j + self.0.system.linear_energy(&state.motion),
        }
    }

    /// The state that has been reached.
    #[must_use]
    pub fn state(&self, underway: &Underway) -> AssemblyState {
        let mut motion = vec![0.0; underway.motion.len()];
        self.write_motion(&underway.motion, &mut motion);
        AssemblyState {
            dissipated_j: self.dissipated_j(underway.balance_j, &motion),
            motion,
            memory: underway.memory.clone(),
            supplied_j: underway.supplied_j,
        }
    }

    /// Heat (J) where heat and energy of the linear part come to `balance_j` (J) at a motion (q, q̇).
    #[must_use]
    pub fn dissipated_j(&self, balance_j: f64, motion: &[f64]) -> f64 {
        balance_j - self.0.system.linear_energy(motion)
    }

    /// Rows that see something of the coordinates q, and then the same of q̇, as rows for z: 2k × 2n of k × n.
    #[must_use]
    pub fn seen(&self, rows: &Matrix) -> Matrix {
        seen_in(self.0.frame.as_ref(), &twice(rows))
    }
}

impl Parts {
    pub(super) fn of(system: System) -> Self {
        let frame = Frame::of(&system).filter(|frame| frame.is_whole(&system, &scale(&system)));
        Self::within(system, frame)
    }

    /// In these modes, or in q and q̇.
    pub(super) fn within(system: System, frame: Option<Frame>) -> Self {
        let (n, m, d) = (system.size, system.loads, system.forces());
        let mut acting = Matrix::zeros(m + d, 2 * n);
        acting.set_block([0, n], &system.load_rows);
        acting.set_block([m, n], &system.rows.times(-1.0));
        let mut places = Matrix::zeros(m + d, 2 * n);
        places.set_block([0, 0], &system.load_rows);
        places.set_block([m, 0], &system.rows);
        let mut velocities = Matrix::zeros(m, 2 * n);
        velocities.set_block([0, n], &system.load_rows);
        let seen = |rows: &Matrix| seen_in(frame.as_ref(), rows);
        let (relative, places) = (seen(&twice(&system.rows)), seen(&places));
        let at_loads = places.block([0, 0], m, 2 * n);
        let sight = Sight {
            ends: Matrix::stacked([relative.clone(), at_loads].into_iter()),
            relative,
            places,
            velocities: seen(&velocities),
        };
        if let Some(frame) = &frame {
            acting = acting.product(&frame.to_modes().transposed());
        }
        Self {
            system,
            frame,
            sight,
            acting,
        }
    }

    /// ż of a motion that nothing acts on but the linear part.
    pub(super) fn rates(&self, own: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(own);
        match &self.frame {
            Some(frame) => frame.take_rates(rates),
            None => self.system.rates(own, rates),
        }
    }
}

impl Sight {
    /// Relative displacements and their rates.
    pub(super) fn relative(&self, own: &[f64], relative: &mut [f64]) {
        relative.fill(0.0);
        self.relative.add_product_to(own, relative);
    }
}

/// What rows for (q, q̇) are for z.
fn seen_in(frame: Option<&Frame>, rows: &Matrix) -> Matrix {
    match frame {
        Some(frame) => rows.product(frame.out_of_modes()),
        None => rows.clone(),
    }
}

/// Rows for q, and the same for q̇ under them: 2k × 2n of k × n.
fn twice(rows: &Matrix) -> Matrix {
    let (k, n) = (rows.rows(), rows.columns());
    let mut both = Matrix::zeros(2 * k, 2 * n);
    both.set_block([0, 0], rows);
    both.set_block([k, n], rows);
    both
}
