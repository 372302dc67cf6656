//! Errors of the set-ups as each structure tells them by itself: its interface moves as a rigid body.
//!
//! Beside sensors a millimetre off, a joint that is looked for with the places of the drawing comes out many times too soft. What
//! all channels of an interface do together says most of their errors before any joint is known.

use bolted_joint_virtual_point::{
    Role, SetUp, Tolerance, VirtualPoint, VirtualPointError, Weights,
};
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::problem::Problem;
use crate::side::{Interface, Placed, Side};

impl Problem {
    /// The likely errors of a and of b: 0 of what nothing is told, such as hits of the assembly. None, where the set-up is exact.
    pub(crate) fn likely_errors(&self) -> Result<[Vec<f64>; 2], SpatialError> {
        let mut all = [const { Vec::new() }; 2];
        let Some(tolerances) = &self.tolerances else {
            return Ok(all);
        };
        for (all, side) in all.iter_mut().zip(&self.sides) {
            for (role, tolerance) in [
                (Role::Channel, &tolerances.sensors),
                (Role::Impact, &tolerances.impacts),
            ] {
                for placed in &side.interfaces {
                    let found = match &placed.interface {
                        Interface::Node(_) => None,
                        Interface::Points(set_up) => {
                            likely(side, placed, set_up, (role, tolerance))
                                .map_err(|source| placed.refused(source))?
                        }
                    };
                    let count = placed.parameters(role).len();
                    all.extend(found.unwrap_or_else(|| vec![0.0; count]));
                }
            }
            all.resize(side.parameters().len(), 0.0);
        }
        Ok(all)
    }
}

/// By the functions between the channels and the impacts of an interface.
fn likely(
    side: &Side,
    placed: &Placed,
    set_up: &SetUp,
    (role, tolerance): (Role, &Tolerance),
) -> Result<Option<Vec<f64>>, VirtualPointError> {
    let first = (placed.first[0], placed.first[1]);
    let near = (set_up.channels().count(), set_up.impacts().count());
    let lines: Vec<DMatrix<Complex64>> = (side.lines.iter())
        .map(|line| line.view(first, near).into_owned())
        .collect();
    VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal)?
        .likely_errors(role, &lines, tolerance)
}
