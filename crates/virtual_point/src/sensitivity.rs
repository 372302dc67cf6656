//! What errors of the set-up make of the receptance of the virtual point.

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::{Role, VirtualPoint, VirtualPointError};

impl VirtualPoint {
    /// dT_u by each parameter of the channels, 6 × channels; or dT_fᵀ by each of the impacts, 6 × impacts. The weights
    /// stay.
    ///
    /// dT_u = (R_uᵀ W R_u)⁻¹ dR_uᵀ W (I − R_u T_u) − T_u dR_u T_u, and the same of R_f and W_f.
    #[must_use]
    pub fn transformation_derivatives(&self, role: Role) -> Vec<DMatrix<f64>> {
        let changes = self.set_up().places(role).derivatives();
        let projection = self.projection(role);
        changes
            .iter()
            .map(|change| projection.change(change))
            .collect()
    }

    /// dY_qm = dT_u Y T_f + T_u Y dT_f by each parameter of the set-up: of the channels, then of the impacts. On exact
    /// functions of a rigid interface it is −T_u dR_u Y_qm − Y_qm dR_fᵀ T_f.
    ///
    /// # Errors
    ///
    /// Those of [`Self::receptance`].
    pub fn derivatives(
        &self,
        functions: &DMatrix<Complex64>,
    ) -> Result<Vec<Matrix6<Complex64>>, VirtualPointError> {
        let responses = self.responses_checked(functions)?;
        let motions = self.motions(functions)?;
        let by_channels = self.transformation_derivatives(Role::Channel).into_iter();
        let by_impacts = self.transformation_derivatives(Role::Impact).into_iter();
        let of_channels = by_channels.map(|change| {
            let product = change.map(Complex64::from) * &responses;
            Matrix6::from_fn(|i, j| product[(i, j)])
        });
        let of_impacts = by_impacts.map(|change| {
            let product = &motions * change.map(Complex64::from).transpose();
            Matrix6::from_fn(|i, j| product[(i, j)])
        });
        Ok(of_channels.chain(of_impacts).collect())
    }
}

#[cfg(test)]
mod tests {
    use bolted_joint_space::{Axes, Dof};
    use nalgebra::{Rotation3, Vector3};

    use super::*;
    use crate::samples::*;
    use crate::{Change, Impact, Parameter, Place, Sensor, SetUp, Weights};

    /// The NumPy program of the check values moves and turns one channel by itself.
    #[test]
    fn check_values() {
        let set_up = SetUp::new(&uniaxials(CHECK_GAINS), &impacts()).unwrap();
        let parameters = set_up.parameters();
        let derivatives = equal(set_up).derivatives(&check_functions()).unwrap();
        let place = Place::Sensor(4);
        for (dof, re, im) in [
            (Dof::X, 4.198_325_403_6e-7, -1.253_559_374_4e-7),
            (Dof::Rz, 4.030_380_815_2e-7, -1.203_413_544_1e-7),
        ] {
            let change = Change::Pose(dof);
            let at = parameters
                .iter()
                .position(|p| *p == Parameter { place, change });
            let found = derivatives[at.unwrap()][(0, 0)];
            same(found, Complex64::new(re, im), 1e-10);
        }
    }

    /// The pose of a triaxial sensor moves its three channels.
    #[test]
    fn a_triaxial_sensor_is_its_channels_together() {
        let one = equal(check_set_up());
        let apart = equal(SetUp::new(&uniaxials(CHECK_GAINS), &impacts()).unwrap());
        let together = one.derivatives(&check_functions()).unwrap();
        let single = apart.derivatives(&check_functions()).unwrap();
        for pose in 0..6 {
            // nine parameters of a triaxial sensor, seven of each channel
            let sum = (3..6).map(|channel| single[7 * channel + pose]);
            let sum: Matrix6<Complex64> = sum.sum();
            let error = (together[9 + pose] - sum).norm();
            assert!(error < 1e-14 * sum.norm(), "{pose}: {error:e}");
        }
        assert_eq!(together.len(), 3 * 9 + 7 * 7);
        for gain in 0..3 {
            let own = single[7 * (3 + gain) + 6];
            assert!((together[9 + 6 + gain] - own).norm() < 1e-14 * own.norm());
        }
    }

    /// Triaxial sensors turned by any angle, one sensor with one channel, impacts in any direction, full weights.
    fn mixed_point() -> (SetUp, [Weights; 2]) {
        let mut mixed = Mixed(40_000);
        let mut sensors: Vec<_> = SENSORS
            .iter()
            .map(|&position| {
                let turn = Vector3::from_fn(|_, _| mixed.next());
                let axes = Axes::from(Rotation3::from_scaled_axis(turn));
                let gains = [1.0, 1.05, -0.9];
                Sensor::triaxial(Vector3::from(position), &axes, gains).unwrap()
            })
            .collect();
        let mut any = || {
            let position = Vector3::from_fn(|_, _| 0.03 * mixed.next());
            (position, Vector3::from_fn(|_, _| mixed.next()).normalize())
        };
        let (position, direction) = any();
        sensors.push(Sensor::uniaxial(position, direction, 0.97).unwrap());
        let impacts: Vec<_> = (0..9)
            .map(|_| {
                let (position, direction) = any();
                Impact::new(position, direction, 1.1).unwrap()
            })
            .collect();
        let weights = [mixed.definite(10), mixed.definite(9)].map(Weights::Full);
        (SetUp::new(&sensors, &impacts).unwrap(), weights)
    }

    /// Against central differences of exact rotations, on functions that are not rigid.
    #[test]
    fn derivatives_are_differences() {
        let (set_up, [channels, impacts]) = mixed_point();
        let count = set_up.parameters().len();
        assert_eq!(count, 3 * 9 + 7 + 9 * 7);
        let functions = Mixed(77).noise(10, 9);
        let receptance = full_receptance(3);
        let point = VirtualPoint::new(set_up.clone(), &channels, &impacts).unwrap();
        let derivatives = point.derivatives(&functions).unwrap();
        let of_functions = set_up.derivatives(&receptance);
        let by_channels = point.transformation_derivatives(Role::Channel);
        let by_impacts = point.transformation_derivatives(Role::Impact);
        let step = 1e-6;
        for p in 0..count {
            let displaced = [step, -step].map(|error| {
                let mut errors = vec![0.0; count];
                errors[p] = error;
                let displaced = set_up.displaced(&errors).unwrap();
                VirtualPoint::new(displaced, &channels, &impacts).unwrap()
            });
            let receptances = displaced.each_ref().map(|point| {
                let receptance = point.receptance(&functions).unwrap();
                DMatrix::from_fn(6, 6, |i, j| receptance[(i, j)])
            });
            let own = DMatrix::from_fn(6, 6, |i, j| derivatives[p][(i, j)]);
            agree(p, &own, &receptances, step);
            let models = displaced
                .each_ref()
                .map(|point| point.set_up().functions(&receptance));
            agree(p, &of_functions[p], &models, step);
            if let Some(own) = by_channels.get(p) {
                let each = displaced
                    .each_ref()
                    .map(|at| complex(at.motions_of_channels()));
                agree(p, &complex(own), &each, step);
            } else {
                let each = displaced
                    .each_ref()
                    .map(|at| complex(&at.forces_of_loads()));
                agree(
                    p,
                    &complex(&by_impacts[p - by_channels.len()].transpose()),
                    &each,
                    step,
                );
            }
        }
    }

    fn complex(matrix: &DMatrix<f64>) -> DMatrix<Complex64> {
        matrix.map(Complex64::from)
    }

    #[track_caller]
    fn agree(p: usize, own: &DMatrix<Complex64>, [up, down]: &[DMatrix<Complex64>; 2], step: f64) {
        let difference = (up - down) / Complex64::from(2.0 * step);
        let error = (own - &difference).norm() / (difference.norm() + 1e-3 * up.norm());
        assert!(error < 1e-7, "parameter {p}: {error:e}");
    }

    /// dY_qm = −T_u dR_u Y_qm − Y_qm dR_fᵀ T_f where there is no residual.
    #[test]
    fn on_rigid_functions_the_derivatives_are_short() {
        let (set_up, [channels, impacts]) = mixed_point();
        let receptance = full_receptance(4);
        let y = DMatrix::from_fn(6, 6, |i, j| receptance[(i, j)]);
        let functions = set_up.functions(&receptance);
        let of_channels = set_up.channels().derivatives().into_iter();
        let of_impacts = set_up.impacts().derivatives().into_iter();
        let point = VirtualPoint::new(set_up.clone(), &channels, &impacts).unwrap();
        let (t_u, t_f) = (
            complex(point.motions_of_channels()),
            complex(&point.forces_of_loads()),
        );
        let short = of_channels
            .map(|change| -&t_u * complex(&change) * &y)
            .chain(of_impacts.map(|change| -&y * complex(&change).transpose() * &t_f));
        for (found, expected) in point.derivatives(&functions).unwrap().iter().zip(short) {
            let found = DMatrix::from_fn(6, 6, |i, j| found[(i, j)]);
            assert!((found - &expected).norm() < 1e-9 * (y.norm() * 100.0));
        }
    }
}
