//! The same pressure everywhere.

use super::bolted::check_cells;
use super::{Element, PressureError, PressureField, Rectangle};
use crate::number::not_negative;

impl PressureField {
    /// A force (N) spread evenly over a rectangle of `cells` along x and along y.
    ///
    /// # Errors
    /// [`PressureError::Cells`] without cells, [`PressureError::Number`] for a force that is negative or not finite.
    pub fn uniform(
        outline: &Rectangle,
        cells: [usize; 2],
        force_n: f64,
    ) -> Result<Self, PressureError> {
        check_cells(cells)?;
        check_force(force_n)?;
        // p = N/A
        let pressure_pa = force_n / outline.area_m2();
        let element = |cell: Rectangle| {
            let [x_m, y_m] = cell.centre_m();
            Element {
                x_m,
                y_m,
                area_m2: cell.area_m2(),
                pressure_pa,
            }
        };
        Self::new(outline.cells(cells).map(element).collect())
    }
}

pub(super) fn check_force(force_n: f64) -> Result<(), PressureError> {
    Ok(not_negative(
        "the normal force in N",
        force_n,
        "",
        "0 or more",
    )?)
}
