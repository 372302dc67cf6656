//! The elements of an interface and what presses on them, computed once: every draw only scales it.

use crate::pressure::{
    Balance, Bolt, BoltShare, BoltedField, BoltedInterface, Element, PressureField, Reach,
    Rectangle, ThicknessRatio, Zone, ZoneForce, with_preloads,
};

use super::error::ModelError;

/// The rectangle that a field was computed on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Where the two parts could touch.
    pub outline: Rectangle,
    /// Width and height of an element, m.
    pub cell_m: [f64; 2],
    /// How much wider than its bolt each hole is, m.
    pub clearance_m: f64,
}

impl Plate {
    fn of(found: &BoltedField, outline: Rectangle, clearance_m: f64) -> Self {
        Self {
            outline,
            cell_m: found.cell_m,
            clearance_m,
        }
    }
}

/// Elements, and their pressures as a linear function of the preloads.
#[derive(Debug, Clone)]
pub(super) struct Geometry {
    /// All without pressure.
    elements: Vec<Element>,
    /// None of a field from elsewhere.
    plate: Option<Plate>,
    loading: Loading,
}

#[derive(Debug, Clone)]
enum Loading {
    /// Σ preloads over the area.
    Even { area_m2: f64 },
    /// Pressure of each element per preload of each bolt, Pa/N, bolt by bolt; and what the plate cuts off each zone.
    Zones {
        per_preload: Vec<Vec<f64>>,
        shares: Vec<BoltShare>,
    },
    /// A field from elsewhere under the nominal preloads, Pa; their sum, N, where there are bolts.
    Given {
        pressures_pa: Vec<f64>,
        preload_n: Option<f64>,
    },
}

impl Geometry {
    /// The same pressure everywhere on a rectangle, but for the bolts' holes.
    pub(super) fn even(
        outline: Rectangle,
        cells: [usize; 2],
        bolts: &[Bolt],
        clearance_m: f64,
    ) -> Result<Self, ModelError> {
        // Any zone gives the cells outside the holes.
        let zone = Zone::Polynomial {
            thickness_ratio: ThicknessRatio::One,
            reach: Reach::Rivets,
            force: ZoneForce::Preload,
        };
        let found = BoltedInterface {
            outline,
            cells,
            bolts,
            clearance_m,
            zone,
        }
        .field()?;
        let field = found.field.scaled(0.0).map_err(ModelError::Field)?;
        Ok(Self {
            elements: field.elements().to_vec(),
            plate: Some(Plate::of(&found, outline, clearance_m)),
            loading: Loading::Even {
                area_m2: field.area_m2(),
            },
        })
    }

    /// A zone around each bolt.
    pub(super) fn zones(
        outline: Rectangle,
        cells: [usize; 2],
        bolts: &[Bolt],
        clearance_m: f64,
        zone: Zone,
    ) -> Result<Self, ModelError> {
        let mut elements = Vec::new();
        let mut plate = None;
        let mut per_preload = Vec::with_capacity(bolts.len());
        let mut shares = Vec::with_capacity(bolts.len());
        for place in 0..bolts.len() {
            // The field of this bolt alone under a unit load: the zones superpose.
            let alone: Vec<f64> = (0..bolts.len())
                .map(|other| f64::from(u8::from(other == place)))
                .collect();
            let bolts = with_preloads(bolts, &alone)?;
            let found = BoltedInterface {
                outline,
                cells,
                bolts: &bolts,
                clearance_m,
                zone,
            }
            .field()?;
            shares.extend(found.shares.get(place).copied());
            let field = &found.field;
            per_preload.push(field.elements().iter().map(|e| e.pressure_pa).collect());
            if place == 0 {
                elements = field
                    .scaled(0.0)
                    .map_err(ModelError::Field)?
                    .elements()
                    .to_vec();
                plate = Some(Plate::of(&found, outline, clearance_m));
            }
        }
        Ok(Self {
            elements,
            plate,
            loading: Loading::Zones {
                per_preload,
                shares,
            },
        })
    }

    /// A field under the nominal preloads, which add up to `preload_n`.
    pub(super) fn given(field: &PressureField, preload_n: Option<f64>) -> Result<Self, ModelError> {
        Ok(Self {
            elements: field
                .scaled(0.0)
                .map_err(ModelError::Field)?
                .elements()
                .to_vec(),
            plate: None,
            loading: Loading::Given {
                pressures_pa: field.elements().iter().map(|e| e.pressure_pa).collect(),
                preload_n,
            },
        })
    }

    /// The elements, without pressure.
    pub(super) fn elements(&self) -> &[Element] {
        &self.elements
    }

    pub(super) fn plate(&self) -> Option<Plate> {
        self.plate
    }

    pub(super) fn area_m2(&self) -> f64 {
        self.elements.iter().map(|element| element.area_m2).sum()
    }

    /// Centroid of the area, m.
    pub(super) fn centroid_m(&self) -> [f64; 2] {
        let area_m2 = self.area_m2();
        let first = self.elements.iter().fold([0.0; 2], |[x, y], element| {
            [
                x + element.x_m * element.area_m2,
                y + element.y_m * element.area_m2,
            ]
        });
        first.map(|moment| moment / area_m2)
    }

    /// What the plate's edge and other holes cut off the bolts' zones.
    pub(super) fn shares(&self) -> &[BoltShare] {
        match &self.loading {
            Loading::Zones { shares, .. } => shares,
            Loading::Even { .. } | Loading::Given { .. } => &[],
        }
    }

    /// Pressure of each element under these bolts, Pa, into `pressures_pa`.
    pub(super) fn pressures(&self, bolts: &[Bolt], pressures_pa: &mut Vec<f64>) {
        pressures_pa.clear();
        let total_n: f64 = bolts.iter().map(|bolt| bolt.preload_n).sum();
        match &self.loading {
            Loading::Even { area_m2 } => {
                pressures_pa.resize(self.elements.len(), total_n / area_m2);
            }
            Loading::Zones { per_preload, .. } => {
                pressures_pa.resize(self.elements.len(), 0.0);
                for (bolt, per_preload) in bolts.iter().zip(per_preload) {
                    for (pressure, per_preload) in pressures_pa.iter_mut().zip(per_preload) {
                        *pressure += bolt.preload_n * per_preload;
                    }
                }
            }
            Loading::Given {
                pressures_pa: given,
                preload_n,
            } => {
                let factor = preload_n.map_or(1.0, |nominal_n| total_n / nominal_n);
                pressures_pa.extend(given.iter().map(|pressure| pressure * factor));
            }
        }
    }

    /// Force of these pressures (Pa) on the elements, N.
    pub(super) fn force_n(&self, pressures_pa: &[f64]) -> f64 {
        let elements = self.elements.iter().zip(pressures_pa);
        elements
            .map(|(element, pressure_pa)| element.area_m2 * pressure_pa)
            .sum()
    }

    /// The field under these bolts, and what it carries of their preloads where there are any.
    pub(super) fn field(
        &self,
        bolts: &[Bolt],
    ) -> Result<(PressureField, Option<Balance>), ModelError> {
        let mut pressures_pa = Vec::new();
        self.pressures(bolts, &mut pressures_pa);
        let elements = self.elements.iter().zip(pressures_pa);
        let elements = elements.map(|(element, pressure_pa)| Element {
            pressure_pa,
            ..*element
        });
        let field = PressureField::new(elements.collect()).map_err(ModelError::Field)?;
        let balance = (!bolts.is_empty()).then(|| Balance::of(&field, bolts));
        Ok((field, balance))
    }
}
