//! Whether an interface's places are written in mirrored coordinates: then no sensor or impact by itself is wrong, and the search
//! for the joint would blame one after the other.

use bolted_joint_virtual_point::{Role, SetUp, VirtualPoint, VirtualPointError, Weights};
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::side::{Placed, Side};

/// Part of the functions' squares that a rigid interface may leave before mirrors are tried.
const NOTABLE: f64 = 1e-4;
/// By how much less a mirrored set-up leaves of them where the places were mirrored.
const DECISIVE: f64 = 30.0;
const AXES: [&str; 3] = ["x", "y", "z"];
/// Which places may be mirrored together.
const WHICH: [(&[Role], &str); 3] = [
    (&[Role::Channel, Role::Impact], "sensors and impacts"),
    (&[Role::Channel], "sensors"),
    (&[Role::Impact], "impacts"),
];

/// Refuses an interface whose functions a rigid interface explains much better with all its places mirrored.
pub(crate) fn refuse_mirrored(
    placed: &Placed,
    side: &Side,
    set_up: &SetUp,
) -> Result<(), SpatialError> {
    let near = [set_up.channels().count(), set_up.impacts().count()];
    let lines: Vec<_> = side
        .lines
        .iter()
        .map(|line| line.view((0, 0), (near[0], near[1])).into_owned())
        .collect();
    let refused = |source: VirtualPointError| placed.refused(source);
    let left = left_over(set_up, &lines).map_err(refused)?;
    if left < NOTABLE {
        return Ok(());
    }
    for (roles, names) in WHICH {
        for (axis, name) in AXES.into_iter().enumerate() {
            let mut mirrored = set_up.clone();
            for &role in roles {
                mirrored = mirrored.mirrored(role, axis).map_err(refused)?;
            }
            // places that are mirrored need not tell all motions, as those that are written may
            let Ok(other) = left_over(&mirrored, &lines) else {
                continue;
            };
            if other * DECISIVE < left {
                return Err(SpatialError::Mirrored {
                    name: placed.name.clone(),
                    places: names,
                    axis: name,
                    percent: [left, other].map(|part| 100.0 * part.sqrt()),
                });
            }
        }
    }
    Ok(())
}

/// Σ |Y − R_u Ỹ R_fᵀ|² over Σ |Y|²
fn left_over(set_up: &SetUp, lines: &[DMatrix<Complex64>]) -> Result<f64, VirtualPointError> {
    let point = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal)?;
    let (mut left, mut all) = (0.0, 0.0);
    for (line, receptance) in lines.iter().zip(point.receptances(lines)?) {
        left += (line - set_up.functions(&receptance)).norm_squared();
        all += line.norm_squared();
    }
    Ok(if all > 0.0 { left / all } else { 0.0 })
}
