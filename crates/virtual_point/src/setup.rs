//! Sensors and impacts together: which functions the receptance of the interface would give.

use bolted_joint_space::Motions;
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

    /// The same where the virtual point has these motions alone, as in a test in a plane.
    #[must_use]
    pub fn in_motions(self, motions: Motions) -> Self {
        Self {
            channels: self.channels.in_motions(motions),
            impacts: self.impacts.in_motions(motions),
        }
    }

    /// The motions that the virtual point has.
    #[must_use]
    pub fn motions(&self) -> Motions {
        self.channels.motions()
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

    /// The set-up as it would be if the coordinate along one of the axes x, y and z had the other sign at all sensors, or at all
    /// impacts: what becomes of one that is written in mirrored coordinates.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`], which the set-up itself would have.
    pub fn mirrored(&self, role: Role, axis: usize) -> Result<Self, VirtualPointError> {
        let mut mirrored = self.clone();
        let places = match role {
            Role::Channel => &mut mirrored.channels,
            Role::Impact => &mut mirrored.impacts,
        };
        *places = places.mirrored(axis)?;
        Ok(mirrored)
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

#[cfg(test)]
mod tests {
    use bolted_joint_space::{Axes, Dof, Selection, SpaceError};
    use bolted_joint_testing::near;
    use nalgebra::{Matrix3, Rotation3, Vector3, Vector6};

    use super::*;
    use crate::samples::*;
    use crate::{Change, Place};

    /// A small rotation about a line moves a point of the body, and a channel reads its way along the channel: told
    /// without R.
    #[test]
    fn a_channel_reads_the_way_of_its_point() {
        let (position, direction) = (Vector3::new(0.02, -0.01, 0.03), Vector3::new(0.0, 0.6, 0.8));
        let sensor = Sensor::uniaxial(position, direction, 1.25).unwrap();
        let places = Places::sensors(&[sensor]).unwrap();
        let (through, axis) = (
            Vector3::new(0.1, 0.2, -0.1),
            Vector3::new(2.0, -1.0, 2.0) / 3.0,
        );
        let angle = 1e-7;
        let turn = Rotation3::from_scaled_axis(axis * angle);
        let way = |point: Vector3<f64>| turn * (point - through) + through - point;
        let u = way(Vector3::zeros());
        let theta = axis * angle;
        let q = Vector6::new(u.x, u.y, u.z, theta.x, theta.y, theta.z);
        let read = (places.matrix() * q)[0];
        near(read, 1.25 * direction.dot(&way(position)), 1e-13);
        // the check values' rows: channel 4 with its gain, and the last impact
        let set_up = check_set_up();
        let expected = [0.0, 1.05, 0.0, -0.0315, 0.0, -0.021];
        for (j, expected) in expected.into_iter().enumerate() {
            near(set_up.channels().matrix()[(4, j)], expected, 1e-16);
        }
        let expected = [0.6, 0.0, 0.8, -0.016, 0.01, 0.012];
        for (j, expected) in expected.into_iter().enumerate() {
            near(set_up.impacts().matrix()[(6, j)], expected, 1e-16);
        }
    }

    /// A force at a point is that force and a moment r × f at the virtual point.
    #[test]
    fn an_impact_is_a_force_and_its_moment() {
        let set_up = check_set_up();
        for (row, (position, direction)) in IMPACTS.iter().enumerate() {
            let moment = Vector3::from(*position).cross(&Vector3::from(*direction));
            let own = set_up.impacts().matrix().row(row);
            for k in 0..3 {
                near(own[k], direction[k], 1e-16);
                near(own[3 + k], moment[k], 1e-16);
            }
        }
    }

    /// Axes are the rows of the sensor's matrix; a quarter turn about z has its x along y.
    #[test]
    fn a_triaxial_sensor_reads_along_its_axes() {
        let quarter = Axes::from(Rotation3::from_axis_angle(
            &Vector3::z_axis(),
            std::f64::consts::FRAC_PI_2,
        ));
        let sensor = Sensor::triaxial(Vector3::zeros(), &quarter, [1.0, 1.0, -2.0]).unwrap();
        assert_eq!(sensor.channels(), 3);
        let places = Places::sensors(&[sensor]).unwrap();
        for (row, expected) in [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -2.0]]
            .iter()
            .enumerate()
        {
            for k in 0..3 {
                near(places.matrix()[(row, k)], expected[k], 1e-15);
            }
        }
        let mirrored = Axes::new(Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0)));
        let error = VirtualPointError::from(mirrored.unwrap_err());
        assert!(matches!(
            error,
            VirtualPointError::Axes(SpaceError::Mirrored { .. })
        ));
        assert!(
            error
                .to_string()
                .starts_with("triaxial sensor, axes: found a left-handed")
        );
    }

    #[test]
    fn parameters_come_place_by_place() {
        let set_up = SetUp::new(
            &[
                triaxials([[1.0; 3]; 3])[0].clone(),
                uniaxials([[1.0; 3]; 3])[5].clone(),
            ],
            &impacts()[..1],
        )
        .unwrap();
        let parameters = set_up.parameters();
        assert_eq!(parameters.len(), 9 + 7 + 7);
        let last = |place, change| Some(Parameter { place, change });
        assert_eq!(
            parameters.first().copied(),
            last(Place::Sensor(0), Change::Pose(Dof::X))
        );
        assert_eq!(
            parameters.get(8).copied(),
            last(Place::Sensor(0), Change::Gain(2))
        );
        assert_eq!(
            parameters.get(15).copied(),
            last(Place::Sensor(1), Change::Gain(0))
        );
        assert_eq!(
            parameters.last().copied(),
            last(Place::Impact(0), Change::Gain(0))
        );
        assert_eq!(set_up.channels().rows_of_each(), [0..3, 3..4]);
        assert_eq!(
            set_up.derivatives(&full_receptance(0)).len(),
            parameters.len()
        );
        // R is a selection of the receptance's rows as well
        let matrix = set_up.channels().matrix().clone();
        assert!(Selection::new(matrix, vec![Dof::X; 4]).is_ok());
    }

    #[test]
    fn errors_of_a_set_up_are_refused_if_they_make_no_sense() {
        let set_up = check_set_up();
        let count = set_up.parameters().len();
        let what = "errors of the set-up";
        let none = set_up.displaced(&vec![0.0; count]).unwrap();
        assert_eq!(none, set_up);
        for found in [0, 5, 30] {
            assert!(matches!(
                set_up.displaced(&vec![0.0; found]),
                Err(VirtualPointError::Size { .. })
            ));
        }
        assert!(matches!(
            set_up.displaced(&vec![0.0; count + 1]),
            Err(VirtualPointError::Size {
                found: 50,
                expected: 49,
                ..
            })
        ));
        let mut errors = vec![0.0; count];
        errors[3] = f64::NAN;
        assert_eq!(
            set_up.displaced(&errors),
            Err(VirtualPointError::NotFinite { what })
        );
        errors[3] = 0.0;
        errors[9 + 7] = -1.05;
        let error = set_up.displaced(&errors).unwrap_err();
        assert_eq!(
            error.to_string(),
            "sensor 2: the errors of the set-up leave it a gain of 0, expected a number other than 0"
        );
        assert!(matches!(
            SetUp::new(&[], &impacts()),
            Err(VirtualPointError::TooFew { .. })
        ));
    }
}
