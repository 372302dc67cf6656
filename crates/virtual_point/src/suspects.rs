//! Which channel, sensor or impact is bad. Least squares spread an error over all of them, so that a bad one makes
//! others look bad; without it they agree again.

use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::conditioning::is_complete;
use crate::diagnosis::diagnosed;
use crate::projection::Projection;
use crate::{Diagnosis, Place, Role, VirtualPoint, VirtualPointError};

/// What is left beside this share of the whole is rounding: the shares are of squares.
const ROUNDING: f64 = 1e-13;

/// From this ratio on a place is bad: with noise alone it is near to 1, and above 5 in less than one case of a hundred
/// thousand for 7 functions at 3 lines that leave one degree of freedom (F distribution, 42 and 42).
const BAD: f64 = 5.0;
/// Channels or impacts beyond the motions that it takes to name one.
const BEYOND: usize = 2;

/// Another place that is suspected by more than this share of the first leaves it open which one it is.
const BESIDE: f64 = 0.5;

/// A channel, a sensor with all of its channels, or an impact; and what of the misfit goes with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspect {
    /// What would be left out.
    pub place: Place,
    /// Misfit that goes with it over misfit that stays, each by its degrees of freedom: about 1 for noise. The ratio of
    /// Fisher's F.
    pub ratio: f64,
    /// Share of the functions' square that is not rigid without it.
    pub misfit: f64,
    /// What the others say of it.
    pub diagnosis: Diagnosis,
}

/// All that can be left out, the most suspect first.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspects {
    /// Share of the functions' square that is not rigid, weighted; mean over the lines.
    pub misfit: f64,
    /// What can be judged: without it there is a degree of freedom left, and all six motions.
    pub ranked: Vec<Suspect>,
    /// The bad one: its ratio is above 5, and twice that of any other place.
    pub bad: Option<Place>,
}

/// Functions of places, as far as misfits need them: Σ Re(S Sᴴ) over lines, each with S of square 1 in the weights.
pub(crate) struct Spread {
    pub(crate) matrix: DMatrix<f64>,
    lines: f64,
}

impl Spread {
    fn of(weights: &DMatrix<f64>, lines: impl Iterator<Item = DMatrix<Complex64>>) -> Self {
        let count = weights.nrows();
        let mut spread = Self {
            matrix: DMatrix::zeros(count, count),
            lines: 0.0,
        };
        for line in lines {
            let (re, im) = (line.map(|value| value.re), line.map(|value| value.im));
            let own = &re * re.transpose() + &im * im.transpose();
            let square = weights.dot(&own);
            if square > 0.0 {
                spread.matrix += own / square;
                spread.lines += 1.0;
            }
        }
        spread
    }

    /// Lines that are not zero.
    pub(crate) fn lines(&self) -> f64 {
        self.lines
    }

    /// Σ tr(Eᵀ W E) of E = (I − R T) S over the rows that a projection keeps, as a mean over the lines.
    fn misfit(&self, projection: &Projection, kept: &[usize]) -> f64 {
        let own = self.matrix.select_rows(kept).select_columns(kept);
        let rest = projection.rest();
        let left = &rest * own * rest.transpose();
        projection.weights().dot(&left).max(0.0) / self.lines
    }
}

impl VirtualPoint {
    /// Leaves out each channel, each sensor of three channels, or each impact in turn, and ranks them by how much of
    /// the misfit goes with them. Each line counts the same. None for fewer than eight places, of which any can be left
    /// out with the same success, or for functions that are zero.
    ///
    /// # Errors
    ///
    /// Those of [`Self::consistency`].
    pub fn suspects(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
    ) -> Result<Option<Suspects>, VirtualPointError> {
        let count = self.count(role);
        let projection = self.projection(role);
        let spread = self.spread(role, lines)?;
        if count < self.motion_count() + BEYOND || spread.lines == 0.0 {
            return Ok(None);
        }
        let all: Vec<usize> = (0..count).collect();
        let misfit = spread.misfit(projection, &all);
        let mut ranked: Vec<(Suspect, Vec<usize>)> = Vec::new();
        for (place, dropped) in self.candidates(role) {
            let Some((remaining, kept)) = self.without(role, &dropped) else {
                continue;
            };
            let left = spread.misfit(&remaining, &kept);
            let (k, degrees) = (
                dropped.len() as f64,
                (kept.len() - self.motion_count()) as f64,
            );
            let (goes, stays) = ((misfit - left).max(0.0), left.max(ROUNDING));
            let ratio = (goes / k) / (stays / degrees);
            let bodies = self.set_up().places(role);
            let diagnosis = diagnosed(bodies, &dropped, &remaining, &kept, &spread);
            let suspect = Suspect {
                place,
                ratio,
                misfit: left,
                diagnosis,
            };
            ranked.push((suspect, dropped));
        }
        ranked.sort_by(|(one, _), (other, _)| other.ratio.total_cmp(&one.ratio));
        let bad = bad(&ranked);
        let ranked = ranked.into_iter().map(|(suspect, _)| suspect).collect();
        Ok(Some(Suspects {
            misfit,
            ranked,
            bad,
        }))
    }

    /// Of the channels' functions, or of the impacts'.
    pub(crate) fn spread(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
    ) -> Result<Spread, VirtualPointError> {
        self.all_checked(lines)?;
        let what = "lines";
        if lines.is_empty() {
            return Err(VirtualPointError::Nothing { what });
        }
        let seen = lines.iter().map(|line| match role {
            Role::Channel => line.clone(),
            Role::Impact => line.transpose(),
        });
        Ok(Spread::of(self.projection(role).weights(), seen))
    }

    /// What can be left out, with its rows.
    fn candidates(&self, role: Role) -> Vec<(Place, Vec<usize>)> {
        let places = self.set_up().places(role);
        let single = |row: usize| match role {
            Role::Channel => Place::Channel(row),
            Role::Impact => Place::Impact(row),
        };
        let rows = (0..places.count()).map(|row| (single(row), vec![row]));
        let each = places.rows_of_each().into_iter().enumerate();
        let whole = each
            .filter(|(_, rows)| rows.len() > 1)
            .map(|(number, rows)| (places.place(number), rows.collect()));
        rows.chain(whole).collect()
    }

    /// Least squares without some rows, and the rows that are kept; none if they leave a motion or no misfit. Weights
    /// are inverse covariances: W of the rest is the inverse of what is left of W⁻¹.
    pub(crate) fn without(
        &self,
        role: Role,
        dropped: &[usize],
    ) -> Option<(Projection, Vec<usize>)> {
        let projection = self.projection(role);
        let kept: Vec<usize> = (0..self.count(role))
            .filter(|row| !dropped.contains(row))
            .collect();
        let length_m = self.conditioning(role).length_m;
        let rows = projection.rows().select_rows(&kept);
        let motions = projection.motions();
        if kept.len() <= motions.count() || !is_complete(&rows, length_m, motions) {
            return None;
        }
        let covariance = projection.weights().clone().cholesky()?.inverse();
        let of_kept = covariance.select_rows(&kept).select_columns(&kept);
        let weights = of_kept.cholesky()?.inverse();
        let symmetric = (&weights + weights.transpose()) * 0.5;
        Some((Projection::new(rows, symmetric, length_m, motions)?, kept))
    }
}

/// The first, if it is bad and no place beside it nearly as bad.
fn bad(ranked: &[(Suspect, Vec<usize>)]) -> Option<Place> {
    let ((first, rows), others) = ranked.split_first()?;
    let overlaps = |own: &[usize]| own.iter().any(|row| rows.contains(row));
    let beside = others.iter().filter(|(_, own)| !overlaps(own));
    let next = beside.map(|(suspect, _)| suspect.ratio).fold(0.0, f64::max);
    (first.ratio > BAD && next < BESIDE * first.ratio).then_some(first.place)
}

#[cfg(test)]
mod tests {
    use bolted_joint_space::{Axes, Dof};
    use bolted_joint_testing::{close, has, near};
    use nalgebra::Vector3;

    use super::*;
    use crate::samples::*;
    use crate::{Change, Impact, Parameter, Sensor, SetUp, Tolerance, Weights};

    /// Four triaxial sensors and twelve impacts.
    fn good() -> SetUp {
        let mut mixed = Mixed(123_000);
        let mut place = || Vector3::from_fn(|_, _| 0.03 * mixed.next());
        let sensors: Vec<_> = (0..4)
            .map(|_| Sensor::triaxial(place(), &Axes::identity(), [1.0; 3]).unwrap())
            .collect();
        let impacts: Vec<_> = (0..12)
            .map(|_| Impact::new(place(), place().normalize(), 1.0).unwrap())
            .collect();
        SetUp::new(&sensors, &impacts).unwrap()
    }

    /// Functions of a set-up with errors, with 1 % noise of their root mean square.
    fn measured(errors: &[(Place, Change, f64)]) -> Vec<DMatrix<Complex64>> {
        let set_up = good();
        let eta: Vec<_> = set_up
            .parameters()
            .iter()
            .map(|&Parameter { place, change }| {
                let own = errors
                    .iter()
                    .filter(|error| (error.0, error.1) == (place, change));
                own.map(|error| error.2).sum()
            })
            .collect();
        let true_one = set_up.displaced(&eta).unwrap();
        let mut mixed = Mixed(321_000);
        (0..20)
            .map(|line| {
                let functions = true_one.functions(&full_receptance(line));
                let deviation = 0.01 * functions.norm() / 12.0;
                functions + mixed.noise(12, 12) * Complex64::from(deviation)
            })
            .collect()
    }

    fn suspects(role: Role, lines: &[DMatrix<Complex64>]) -> Suspects {
        equal(good()).suspects(role, lines).unwrap().unwrap()
    }

    #[test]
    fn nobody_is_bad_without_an_error() {
        for role in [Role::Channel, Role::Impact] {
            let found = suspects(role, &measured(&[]));
            assert_eq!(found.bad, None);
            near(found.ranked[0].ratio, 1.0, 0.5);
            // six of twelve degrees of freedom of 1 % noise
            close(found.misfit, 0.5e-4, 0.2);
            let exact = [good().functions(&full_receptance(1))];
            assert_eq!(suspects(role, &exact).bad, None);
        }
    }

    /// The sign of channel 4 lowers the consistency of others as well, and it alone is named.
    #[test]
    fn a_turned_sign_is_named() {
        let sensor = Place::Sensor(1);
        let lines = measured(&[(sensor, Change::Gain(1), -2.0)]);
        let found = suspects(Role::Channel, &lines);
        assert_eq!(found.bad, Some(Place::Channel(4)));
        near(found.ranked[0].diagnosis.gains[0], -1.0, 0.01);
        has(
            &found.ranked[0].diagnosis.to_string(),
            &["as if the gain were -"],
        );
        let consistency = equal(good())
            .consistency(Role::Channel, &lines)
            .unwrap()
            .unwrap();
        let lowered = consistency
            .specific
            .iter()
            .filter(|&&own| own < 0.9)
            .count();
        assert!(lowered > 1, "{:?}", consistency.specific);
        // what is wrong with a channel is not held against an impact
        assert_eq!(suspects(Role::Impact, &lines).bad, None);
        for impact in 0..12 {
            let lines = measured(&[(Place::Impact(impact), Change::Gain(0), -2.0)]);
            let found = suspects(Role::Impact, &lines);
            assert_eq!(found.bad, Some(Place::Impact(impact)));
            assert_eq!(suspects(Role::Channel, &lines).bad, None);
        }
    }

    #[test]
    fn a_wrong_gain_is_named() {
        for channel in 0..12 {
            let sensor = Place::Sensor(channel / 3);
            let lines = measured(&[(sensor, Change::Gain(channel % 3), 0.2)]);
            let found = suspects(Role::Channel, &lines);
            assert_eq!(found.bad, Some(Place::Channel(channel)));
            near(found.ranked[0].diagnosis.gains[0], 1.2, 0.02);
        }
    }

    #[test]
    fn a_misplaced_sensor_is_named() {
        for sensor in 0..4 {
            for (dof, axis) in [(Dof::X, 0), (Dof::Y, 1), (Dof::Z, 2)] {
                let place = Place::Sensor(sensor);
                let lines = measured(&[(place, Change::Pose(dof), 0.005)]);
                let found = suspects(Role::Channel, &lines);
                assert_eq!(found.bad, Some(place));
                let shift = found.ranked[0].diagnosis.shift_m;
                for k in 0..3 {
                    near(shift[k], if k == axis { 0.005 } else { 0.0 }, 5e-4);
                }
                has(
                    &found.ranked[0].diagnosis.to_string(),
                    &["as if it were shifted by"],
                );
                // 5 mm where 1 mm is expected
                let deviations = found.ranked[0].diagnosis.deviations(&Tolerance::TYPICAL);
                near(deviations, 5.0, 0.5);
            }
        }
    }

    #[test]
    fn a_misplaced_impact_is_named() {
        for impact in 0..12 {
            // 5 mm beside its place; along its own direction it would do nothing
            let place = Place::Impact(impact);
            let row = good().impacts().matrix().row(impact).into_owned();
            let direction = Vector3::new(row[0], row[1], row[2]);
            let aside = direction.cross(&Vector3::z()).normalize() * 0.005;
            let shift = [(Dof::X, aside.x), (Dof::Y, aside.y), (Dof::Z, aside.z)];
            let lines = measured(&shift.map(|(dof, by)| (place, Change::Pose(dof), by)));
            assert_eq!(suspects(Role::Impact, &lines).bad, Some(place));
        }
    }

    #[test]
    fn a_turned_sensor_is_named() {
        let place = Place::Sensor(2);
        let lines = measured(&[(place, Change::Pose(Dof::Ry), 0.1)]);
        let found = suspects(Role::Channel, &lines);
        assert_eq!(found.bad, Some(place));
        near(found.ranked[0].diagnosis.rotation_rad[1], 0.1, 0.01);
        has(
            &found.ranked[0].diagnosis.to_string(),
            &["as if it were rotated by"],
        );
    }

    /// By hand: the misfit without a channel is that of a virtual point without it, with weights as well.
    #[test]
    fn leaving_out_is_measuring_less() {
        let functions = Mixed(11).noise(12, 12);
        let weights = Weights::Diagonal((1..=12).map(f64::from).collect());
        let point = VirtualPoint::new(disordered(7), &weights, &Weights::Equal).unwrap();
        let found = point.suspects(Role::Channel, std::slice::from_ref(&functions));
        let found = found.unwrap().unwrap();
        assert_eq!(found.ranked.len(), 12);
        let suspect = found
            .ranked
            .iter()
            .find(|s| s.place == Place::Channel(3))
            .unwrap();
        let kept: Vec<_> = (0..12).filter(|&row| row != 3).collect();
        let r = point.set_up().channels().matrix().select_rows(&kept);
        let w = DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(
            11,
            kept.iter().map(|&row| row as f64 + 1.0),
        ));
        let t = (r.transpose() * &w * &r).try_inverse().unwrap() * r.transpose() * &w;
        let s = functions.select_rows(&kept);
        let e = &s - (r * t).map(Complex64::from) * &s;
        let weighted = |matrix: &DMatrix<Complex64>, w: &[f64]| -> f64 {
            let rows = matrix.row_iter().zip(w);
            rows.map(|(row, w)| w * row.norm_squared()).sum()
        };
        let all: Vec<_> = (1..=12).map(f64::from).collect();
        let own: Vec<_> = kept.iter().map(|&row| row as f64 + 1.0).collect();
        close(
            suspect.misfit,
            weighted(&e, &own) / weighted(&functions, &all),
            1e-9,
        );
    }

    #[test]
    fn too_few_places_suspect_nobody() {
        let point = equal(check_set_up());
        let lines = [check_functions()];
        assert_eq!(point.suspects(Role::Impact, &lines), Ok(None));
        // three triaxial sensors: without one of them a rotation is unseen
        let found = point.suspects(Role::Channel, &lines).unwrap().unwrap();
        assert_eq!(found.ranked.len(), 9);
        assert_eq!(found.bad, Some(Place::Channel(0)));
        near(found.ranked[0].diagnosis.gains[0], 1.1, 1e-6);
        let nothing = [DMatrix::zeros(9, 7)];
        assert_eq!(point.suspects(Role::Channel, &nothing), Ok(None));
    }
}
