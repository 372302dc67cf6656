//! How tight each bolt is: its preload, or a torque and what becomes of it.

use crate::pressure::{Bolt, ThreadFriction, Tightening, bolts_under_moment};
use crate::uncertain::{Drawn, InputPlace};

use super::error::ModelError;

/// The bolts of a study, with their uncertain preloads.
#[derive(Debug, Clone)]
pub(super) struct Clamping {
    pub(super) bolts: Vec<BoltInput>,
    /// Moments about x and y that change the preloads, N·m.
    pub(super) moments: Option<[InputPlace; 2]>,
}

/// A bolt.
#[derive(Debug, Clone)]
pub(super) struct BoltInput {
    pub(super) x_m: f64,
    pub(super) y_m: f64,
    pub(super) diameter_m: f64,
    pub(super) tightness: Tightness,
}

/// What its preload follows from.
#[derive(Debug, Clone)]
pub(super) enum Tightness {
    /// It is given, N.
    Preload(InputPlace),
    /// A torque of its own, N·m.
    Torque(InputPlace, Wrench),
    /// The torques of the table.
    OfTable(Wrench),
}

/// What becomes of a torque.
#[derive(Debug, Clone)]
pub(super) enum Wrench {
    NutFactor(InputPlace),
    Friction {
        /// Diameters and pitch; the coefficients are those of the inputs.
        thread: ThreadFriction,
        thread_coefficient: InputPlace,
        head_coefficient: InputPlace,
    },
}

impl Wrench {
    fn preload_n(
        &self,
        torque_n_m: f64,
        diameter_m: f64,
        values: &Drawn,
    ) -> Result<f64, ModelError> {
        let tightening = match self {
            Self::NutFactor(factor) => Tightening::NutFactor {
                factor: values.of(*factor),
                diameter_m,
            },
            Self::Friction {
                thread,
                thread_coefficient,
                head_coefficient,
            } => Tightening::Friction(ThreadFriction {
                thread_coefficient: values.of(*thread_coefficient),
                head_coefficient: values.of(*head_coefficient),
                ..*thread
            }),
        };
        let preload_n = tightening.preload_n(torque_n_m);
        preload_n.map_err(ModelError::Tightening)
    }
}

impl Clamping {
    /// The bolts with their preloads, at a torque of the table where there is one; moments included.
    pub(super) fn bolts(
        &self,
        values: &Drawn,
        torque_n_m: Option<f64>,
    ) -> Result<Vec<Bolt>, ModelError> {
        let bolts = self.bolts.iter().map(|bolt| {
            let preload_n = match &bolt.tightness {
                Tightness::Preload(preload) => values.of(*preload),
                Tightness::Torque(torque, wrench) => {
                    wrench.preload_n(values.of(*torque), bolt.diameter_m, values)?
                }
                Tightness::OfTable(wrench) => {
                    wrench.preload_n(torque_n_m.unwrap_or(0.0), bolt.diameter_m, values)?
                }
            };
            Ok(Bolt {
                x_m: bolt.x_m,
                y_m: bolt.y_m,
                diameter_m: bolt.diameter_m,
                preload_n,
            })
        });
        let bolts: Vec<Bolt> = bolts.collect::<Result<_, ModelError>>()?;
        Ok(match self.moments {
            Some(moments) => bolts_under_moment(&bolts, moments.map(|place| values.of(place)))?,
            None => bolts,
        })
    }
}
