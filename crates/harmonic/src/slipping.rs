//! The laws of a joint that slip, as harmonic balance takes them.

use bolted_joint_dynamics::{
    JointLaw,
    law::{DofLaws, Law, LuGre},
};

use super::HarmonicError;
use super::branches::Remembering;

/// The laws that remember, on each relative DOF.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slipping<const D: usize> {
    on: [Option<Remembering>; D],
}

impl<const D: usize> Slipping<D> {
    /// Those of a joint, `None` where nothing slips.
    ///
    /// # Errors
    /// [`HarmonicError::Rate`] where the load of a law depends on how fast the joint moves.
    pub(super) fn of(joint: &JointLaw<D>) -> Result<Option<Self>, HarmonicError> {
        if !joint.has_memory() {
            return Ok(None);
        }
        let rate_dependent = <LuGre as Law<f64>>::DECLARATION.name;
        let mut laws = joint.on.iter().flat_map(DofLaws::present);
        if laws.any(|law| law.name == rate_dependent) {
            return Err(HarmonicError::Rate);
        }
        Ok(Some(Self {
            on: joint.on.each_ref().map(Remembering::of),
        }))
    }

    /// Those on a DOF, if there are any.
    pub(super) fn on(&self, dof: usize) -> Option<&Remembering> {
        self.on[dof].as_ref()
    }
}
