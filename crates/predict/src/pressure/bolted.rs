//! The field that several bolts make together on a rectangular interface.

use std::fmt;

use super::bolt::check_all;
use super::radial::RadialPressure;
use super::{Balance, Bolt, Element, PressureError, PressureField, Rectangle, Zone, ZoneForce};
use crate::number::not_negative;

/// Cells of a field at most.
const MOST_CELLS: usize = 10_000_000;
/// Cells of which less than this part is outside the holes are left out.
const SLIVER: f64 = 1e-6;
/// A part of a zone's force that is not worth a word.
const UNNOTICED: f64 = 1e-3;

/// A rectangular interface that bolts hold together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoltedInterface<'a> {
    /// Where the two parts could touch.
    pub outline: Rectangle,
    /// Number of cells along x and along y.
    pub cells: [usize; 2],
    /// The bolts.
    pub bolts: &'a [Bolt],
    /// How much wider than its bolt each hole is, in m; 0 for rivets, which fill theirs.
    pub clearance_m: f64,
    /// How the pressure falls off around each bolt.
    pub zone: Zone,
}

/// The field of a [`BoltedInterface`], and what became of each bolt's preload.
#[derive(Debug, Clone, PartialEq)]
pub struct BoltedField {
    /// The pressure on the cells; those within a hole are left out.
    pub field: PressureField,
    /// Width and height of a cell, in m.
    pub cell_m: [f64; 2],
    /// What each bolt's zone carries.
    pub shares: Vec<BoltShare>,
    /// The field's force and moments beside the bolts'.
    pub balance: Balance,
}

/// What a bolt's zone carries on the interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoltShare {
    /// The bolt's place in the list, from 1.
    pub number: usize,
    /// Force of its zone in the field, in N.
    pub force_n: f64,
    /// Part of its zone's force on a plate without end that lies on this one: less than 1 if the edge or another hole cuts
    /// the zone. The pressure of a zone that carries its preload is raised by the inverse.
    pub part_on_plate: f64,
    /// Whether the pressure has been raised so.
    pub raised: bool,
}

impl fmt::Display for BoltShare {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            number,
            part_on_plate,
            raised,
            ..
        } = self;
        let lost = 100.0 * (1.0 - part_on_plate);
        write!(
            formatter,
            "bolt {number}: the plate's edge or another hole cuts off {lost:.1} % of its zone's force; "
        )?;
        match raised {
            true => write!(
                formatter,
                "the rest of the zone is pressed {:.1} % harder, so that it carries the preload",
                100.0 * (1.0 / part_on_plate - 1.0)
            ),
            false => write!(formatter, "that force is missing in the field"),
        }
    }
}

impl BoltedInterface<'_> {
    /// Radius of the hole of a bolt, in m.
    #[must_use]
    pub fn hole_radius_m(&self, bolt: &Bolt) -> f64 {
        0.5 * (bolt.diameter_m + self.clearance_m)
    }

    /// The field: zones superposed, none of them under a hole, each cell with its exact area and force.
    ///
    /// # Errors
    /// Any [`PressureError`] about the cells, the bolts, their holes and the zone.
    pub fn field(&self) -> Result<BoltedField, PressureError> {
        let (holes, zones) = self.checked()?;
        let [across, up] = self.cells;
        let count = across * up;
        let mut elements = Vec::with_capacity(count);
        let mut forces_n = vec![Vec::new(); zones.len()];
        for cell in self.outline.cells(self.cells) {
            let whole_m2 = cell.area_m2();
            let hole_m2 = |(hole, bolt): (&RadialPressure, &Bolt)| {
                hole.force_on(&cell, bolt.place_m()).clamp(0.0, whole_m2)
            };
            let holes_m2: f64 = holes.iter().zip(self.bolts).map(hole_m2).sum();
            let area_m2 = whole_m2 - holes_m2;
            if area_m2 < SLIVER * whole_m2 {
                continue;
            }
            let place = elements.len();
            for ((zone, bolt), (hole, forces)) in zones
                .iter()
                .zip(self.bolts)
                .zip(holes.iter().zip(&mut forces_n))
            {
                let force_n = zone.force_on(&cell, bolt.place_m());
                if force_n > 0.0 {
                    // Other holes in the cell leave their part of the force out: exact as the cells shrink.
                    let beside_own_m2 = whole_m2 - hole_m2((hole, bolt));
                    forces.push((place, force_n * (area_m2 / beside_own_m2).min(1.0)));
                }
            }
            let [x_m, y_m] = cell.centre_m();
            elements.push(Element {
                x_m,
                y_m,
                area_m2,
                pressure_pa: 0.0,
            });
        }
        let mut shares = Vec::with_capacity(zones.len());
        for (number, ((zone, bolt), forces)) in
            (1..).zip(zones.iter().zip(self.bolts).zip(&forces_n))
        {
            let on_plate_n: f64 = forces.iter().map(|&(_, force_n)| force_n).sum();
            let part_on_plate = match zone.force_n() > 0.0 {
                true => (on_plate_n / zone.force_n()).min(1.0),
                false => 1.0,
            };
            let raised = !self.is_as_published() && part_on_plate > 0.0;
            let factor = match raised && on_plate_n > 0.0 {
                true => bolt.preload_n / on_plate_n,
                false => 1.0,
            };
            for &(place, force_n) in forces {
                let element: &mut Element = &mut elements[place];
                element.pressure_pa += factor * force_n / element.area_m2;
            }
            shares.push(BoltShare {
                number,
                force_n: factor * on_plate_n,
                part_on_plate,
                raised,
            });
        }
        let field = PressureField::new(elements)?;
        let [[x0, x1], [y0, y1]] = [self.outline.x_m(), self.outline.y_m()];
        Ok(BoltedField {
            balance: Balance::of(&field, self.bolts),
            field,
            cell_m: [(x1 - x0) / across as f64, (y1 - y0) / up as f64],
            shares,
        })
    }

    fn is_as_published(&self) -> bool {
        matches!(
            self.zone,
            Zone::Polynomial {
                force: ZoneForce::AsPublished,
                ..
            }
        )
    }

    /// Holes as discs and zones on a plate without end.
    fn checked(&self) -> Result<(Vec<RadialPressure>, Vec<RadialPressure>), PressureError> {
        check_cells(self.cells)?;
        check_all(self.bolts)?;
        self.zone.check()?;
        let expected = "a length of 0 m or more";
        not_negative("the holes' clearance", self.clearance_m, " m", expected)?;
        let mut holes: Vec<RadialPressure> = Vec::with_capacity(self.bolts.len());
        let mut zones = Vec::with_capacity(self.bolts.len());
        for (number, bolt) in (1..).zip(self.bolts) {
            let hole_m = self.hole_radius_m(bolt);
            if !self.outline.holds_disc(bolt.place_m(), hole_m) {
                return Err(PressureError::HoleAtEdge {
                    number,
                    x_m: bolt.x_m,
                    y_m: bolt.y_m,
                    hole_m,
                });
            }
            for (first, (other, hole)) in (1..).zip(self.bolts.iter().zip(&holes)) {
                let distance_m = (bolt.x_m - other.x_m).hypot(bolt.y_m - other.y_m);
                if distance_m < hole_m + hole.outer_m() {
                    return Err(PressureError::HolesOverlap {
                        first,
                        second: number,
                        distance_m,
                    });
                }
            }
            zones.push(self.zone.around(number, bolt, hole_m)?);
            holes.push(RadialPressure::disc(hole_m));
        }
        Ok((holes, zones))
    }
}

pub(super) fn check_cells(cells: [usize; 2]) -> Result<(), PressureError> {
    let count = cells[0].checked_mul(cells[1]);
    match count.is_some_and(|count| (1..=MOST_CELLS).contains(&count)) {
        true => Ok(()),
        false => Err(PressureError::Cells {
            cells,
            most: MOST_CELLS,
        }),
    }
}

impl BoltedField {
    /// Bolts whose zone the plate's edge or another hole cuts; each prints as a warning.
    pub fn cut_zones(&self) -> impl Iterator<Item = &BoltShare> {
        self.shares
            .iter()
            .filter(|share| share.part_on_plate < 1.0 - UNNOTICED)
    }
}
