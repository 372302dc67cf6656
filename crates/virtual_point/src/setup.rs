//! Sensors and impacts together: which functions the receptance of the interface would give.

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::{Impact, Parameter, Places, Role, Sensor, VirtualPointError};

/// Where sensors sit and the hammer hits: Y = R_u Y_qm R_fᵀ for an interface that is rigid as far as they reach. They
/// may be fewer than six.
#[derive(Clone, Debug, PartialEq)]
pub struct SetUp {
    channels: Places,
    impacts: Places,
}

impl SetUp {
    /// Sensors and impacts about one virtual point, in its axes.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] without any.
    pub fn new(sensors: &[Sensor], impacts: &[Impact]) -> Result<Self, VirtualPointError> {
        let (channels, impacts) = (Places::sensors(sensors)?, Places::impacts(impacts)?);
        Ok(Self { channels, impacts })
    }

    /// Channels, with R_u.
    #[must_use]
    pub fn channels(&self) -> &Places {
        &self.channels
    }

    /// Impacts, with R_f.
    #[must_use]
    pub fn impacts(&self) -> &Places {
        &self.impacts
    }

    /// One or the other.
    #[must_use]
    pub fn places(&self, role: Role) -> &Places {
        match role {
            Role::Channel => &self.channels,
            Role::Impact => &self.impacts,
        }
    }

    /// What may be wrong: with the sensors, then with the impacts.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut parameters = self.channels.parameters();
        parameters.extend(self.impacts.parameters());
        parameters
    }

    /// The set-up with errors η of [`Self::parameters`]; its derivatives are by further changes.
    ///
    /// # Errors
    ///
    /// As [`Places::displaced`].
    pub fn displaced(&self, errors: &[f64]) -> Result<Self, VirtualPointError> {
        let own = self.channels.parameters().len();
        let (of_channels, of_impacts) = errors.split_at(own.min(errors.len()));
        Ok(Self {
            channels: self.channels.displaced(of_channels)?,
            impacts: self.impacts.displaced(of_impacts)?,
        })
    }

    /// Y = R_u Y_qm R_fᵀ, channels × impacts, of a receptance of the virtual point. Of a change of that receptance, it
    /// is the change of Y.
    #[must_use]
    pub fn functions(&self, receptance: &Matrix6<Complex64>) -> DMatrix<Complex64> {
        between(self.channels.matrix(), receptance, self.impacts.matrix())
    }

    /// dY = dR_u Y_qm R_fᵀ + R_u Y_qm dR_fᵀ by each of [`Self::parameters`].
    #[must_use]
    pub fn derivatives(&self, receptance: &Matrix6<Complex64>) -> Vec<DMatrix<Complex64>> {
        let (r_u, r_f) = (self.channels.matrix(), self.impacts.matrix());
        let by_channels = self.channels.derivatives();
        let by_impacts = self.impacts.derivatives();
        let of_channels = by_channels
            .iter()
            .map(|change| between(change, receptance, r_f));
        let of_impacts = by_impacts
            .iter()
            .map(|change| between(r_u, receptance, change));
        of_channels.chain(of_impacts).collect()
    }
}

/// A Y Bᵀ
fn between(
    left: &DMatrix<f64>,
    receptance: &Matrix6<Complex64>,
    right: &DMatrix<f64>,
) -> DMatrix<Complex64> {
    left.map(Complex64::from) * receptance * right.map(Complex64::from).transpose()
}
