//! How well the places tell six motions, or those of a plane, apart, in a number that does not depend on units.

use std::fmt;

use bolted_joint_space::Motions;
use nalgebra::{DMatrix, Vector6};

use crate::unseen::{UnseenMotion, plain};
use crate::words::short;
use crate::{Places, Role, VirtualPointError};

/// Above this, errors of positions and noise grow much in the motion that is seen least.
const POOR: f64 = 10.0;

/// Fewer channels or impacts than so many beyond the motions leave little to judge them by.
const FEW: usize = 3;

/// Singular values below this share of the largest one are none: no position is known to a part in a million.
const NOTHING: f64 = 1e-6;

/// What the singular values of R s say, s = diag(1, 1, 1, 1/ℓ, 1/ℓ, 1/ℓ).
#[derive(Clone, Debug, PartialEq)]
pub struct Conditioning {
    /// Channels or impacts.
    pub role: Role,
    /// How many there are.
    pub count: usize,
    /// How many motions they tell apart.
    pub motions: usize,
    /// ℓ: root mean square of the distances from the virtual point, m.
    pub length_m: f64,
    /// Largest over smallest singular value.
    pub condition: f64,
    /// The motion with the smallest one.
    pub least_seen: UnseenMotion,
}

/// What would make an estimate better.
#[derive(Clone, Debug, PartialEq)]
pub enum Advice {
    /// The places are in a poor arrangement.
    Poor {
        /// Channels or impacts.
        role: Role,
        /// Largest over smallest singular value.
        condition: f64,
        /// The motion that they tell least of.
        least_seen: UnseenMotion,
    },
    /// There are few of them.
    Few {
        /// Channels or impacts.
        role: Role,
        /// How many there are.
        count: usize,
        /// How many motions they tell apart.
        motions: usize,
    },
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Poor {
                role,
                condition,
                least_seen,
            } => write!(
                f,
                "{role}s: found a condition number of {}, expected {POOR} or less: they tell little of the \
                 {least_seen}; spread them, or add one that moves with it",
                short(*condition)
            ),
            Self::Few {
                role,
                count,
                motions,
            } => write!(
                f,
                "{role}s: found {count}, {} to {} are better: the more there are beyond {motions}, the more errors show",
                motions + FEW,
                motions + 2 * FEW
            ),
        }
    }
}

impl Conditioning {
    /// Judges places.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] for fewer than motions, [`VirtualPointError::Unseen`] if they leave a motion open.
    pub fn of(places: &Places) -> Result<Self, VirtualPointError> {
        let (role, count) = (places.role(), places.count());
        let own = places.motions().count();
        if count < own {
            let (found, least) = (count, own);
            return Err(VirtualPointError::TooFew { role, found, least });
        }
        let length_m = places.length_m();
        let (values, motions) = spectrum(places.matrix(), length_m, places.motions());
        let largest = values.max();
        let open: Vec<usize> = (0..own)
            .filter(|&i| values[i] <= NOTHING * largest)
            .collect();
        if !open.is_empty() {
            let rank = own - open.len();
            let basis = DMatrix::from_fn(open.len(), 6, |i, j| motions[(open[i], j)]);
            let motions = plain(&basis, length_m);
            return Err(VirtualPointError::Unseen {
                role,
                rank,
                motions,
            });
        }
        let least = values.imin();
        let motion = Vector6::from_fn(|j, _| motions[(least, j)]);
        Ok(Self {
            role,
            count,
            motions: own,
            length_m,
            condition: largest / values[least],
            least_seen: UnseenMotion::of(&motion, length_m),
        })
    }

    /// What would make it better: nothing for nine places or more in a good arrangement.
    #[must_use]
    pub fn advice(&self) -> Vec<Advice> {
        let (role, count, condition) = (self.role, self.count, self.condition);
        let mut advice = Vec::new();
        if condition > POOR {
            let least_seen = self.least_seen;
            advice.push(Advice::Poor {
                role,
                condition,
                least_seen,
            });
        }
        if count < self.motions + FEW {
            let motions = self.motions;
            advice.push(Advice::Few {
                role,
                count,
                motions,
            });
        }
        advice
    }
}

/// Whether rows determine these motions.
pub(crate) fn is_complete(matrix: &DMatrix<f64>, length_m: f64, motions: Motions) -> bool {
    matrix.nrows() >= motions.count() && {
        let (values, _) = spectrum(matrix, length_m, motions);
        values.min() > NOTHING * values.max()
    }
}

/// Singular values of R s, and the motion (u, θ) of each as a row.
fn spectrum(
    matrix: &DMatrix<f64>,
    length_m: f64,
    motions: Motions,
) -> (nalgebra::DVector<f64>, DMatrix<f64>) {
    let own = motions.rows();
    let count = own.len();
    let scale = |j: usize| if j < 3 { 1.0 } else { 1.0 / length_m };
    let scaled = DMatrix::from_fn(matrix.nrows(), count, |i, j| {
        matrix[(i, own[j])] * scale(own[j])
    });
    // square, so that the decomposition has all motions; R s = Q (upper triangle)
    let triangle = scaled.qr().r();
    let mut shapes = DMatrix::zeros(count, 6);
    let found = bolted_joint_singular::real(triangle);
    let Some((values, rows)) = found.and_then(|svd| Some((svd.singular_values, svd.v_t?))) else {
        return (nalgebra::DVector::zeros(count), shapes);
    };
    for (at, &j) in own.iter().enumerate() {
        shapes.set_column(j, &(rows.column(at) * scale(j)));
    }
    (values, shapes)
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::{close, has};
    use nalgebra::Vector3;

    use super::*;
    use crate::samples::*;
    use crate::{Impact, Sensor, SetUp};

    fn of_sensors(sensors: &[Sensor]) -> Result<Conditioning, VirtualPointError> {
        Conditioning::of(&Places::sensors(sensors).unwrap())
    }

    fn of_impacts(impacts: &[([f64; 3], [f64; 3])]) -> Result<Conditioning, VirtualPointError> {
        let impacts: Vec<_> = impacts
            .iter()
            .map(|(position, direction)| {
                let direction = Vector3::from(*direction).normalize();
                Impact::new(Vector3::from(*position), direction, 1.0).unwrap()
            })
            .collect();
        Conditioning::of(&Places::impacts(&impacts).unwrap())
    }

    fn unseen(found: Result<Conditioning, VirtualPointError>) -> (usize, Vec<UnseenMotion>) {
        match found {
            Err(VirtualPointError::Unseen { rank, motions, .. }) => (rank, motions),
            other => panic!("{other:?}"),
        }
    }

    fn triaxial(position: [f64; 3]) -> Sensor {
        let axes = bolted_joint_space::Axes::identity();
        Sensor::triaxial(Vector3::from(position), &axes, [1.0; 3]).unwrap()
    }

    /// Two triaxial sensors do not see a rotation about the line between them; a channel that moves with it does.
    #[test]
    fn two_triaxial_sensors_miss_a_rotation() {
        let mut sensors = vec![triaxial([0.02, 0.01, 0.03]), triaxial([0.02, -0.03, 0.03])];
        let error = of_sensors(&sensors).unwrap_err();
        has(
            &error.to_string(),
            &[
                "channels: found rank 5, expected 6: no channel sees the rotation about the line through (0.02, 0, \
                 0.03) m along (0, 1, 0)",
                "add one that moves with it",
            ],
        );
        let position = Vector3::new(-0.01, 0.01, 0.01);
        // d · (a × (r − r₁)) is zero, and then is not
        for (direction, seen) in [(Vector3::y(), false), (Vector3::z(), true)] {
            sensors.push(Sensor::uniaxial(position, direction, 1.0).unwrap());
            assert_eq!(of_sensors(&sensors).is_ok(), seen);
            sensors.pop();
        }
        // in line with the others a third one is none; beside them it is
        sensors.push(triaxial([0.02, 0.05, 0.03]));
        assert_eq!(unseen(of_sensors(&sensors)).0, 5);
        sensors[2] = triaxial([0.0, 0.05, 0.03]);
        assert!(of_sensors(&sensors).is_ok());
    }

    /// Sensors at one point miss three rotations about it, told about the axes; all at the virtual point too.
    #[test]
    fn sensors_at_one_point_miss_rotations_about_it() {
        let found = of_sensors(&[triaxial([0.02, 0.01, 0.03]), triaxial([0.02, 0.01, 0.03])]);
        let (rank, motions) = unseen(found);
        assert_eq!(rank, 3);
        let words: Vec<_> = motions.iter().map(ToString::to_string).collect();
        assert_eq!(
            words,
            [
                "rotation about the line through (0, 0.01, 0.03) m along (1, 0, 0)",
                "rotation about the line through (0.02, 0, 0.03) m along (0, 1, 0)",
                "rotation about the line through (0.02, 0.01, 0) m along (0, 0, 1)",
            ]
        );
        let (rank, motions) = unseen(of_sensors(&[triaxial([0.0; 3]), triaxial([0.0; 3])]));
        assert_eq!(rank, 3);
        has(
            &motions[2].to_string(),
            &["through (0, 0, 0) m along (0, 0, 1)"],
        );
    }

    /// Hits along z alone: no way along x or y, and no rotation about z.
    #[test]
    fn parallel_impacts_drive_three_motions() {
        let hits = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [2.0, 1.0],
            [-1.0, 3.0],
        ];
        let hits = hits.map(|[x, y]| ([0.01 * x, 0.01 * y, 0.02], [0.0, 0.0, 1.0]));
        let error = of_impacts(&hits).unwrap_err();
        has(
            &error.to_string(),
            &[
                "impacts: found rank 3, expected 6: no impact drives the ",
                "rotation about the line through (0, 0, 0) m along (0, 0, 1), nor the translation along (1, 0, 0), nor \
                 the translation along (0, 1, 0)",
            ],
        );
    }

    /// Lines of action in one linear complex: d · (h z + z × r) = 0 is a screw of pitch h about z, and nothing drives
    /// it.
    #[test]
    fn impacts_of_one_linear_complex_do_not_drive_its_screw() {
        let pitch_m = 0.013;
        let mut mixed = Mixed(4_000);
        let hits: Vec<_> = (0..8)
            .map(|_| {
                let r = Vector3::from_fn(|_, _| 0.03 * mixed.next());
                let way = Vector3::z() * pitch_m + Vector3::z().cross(&r);
                let aside = Vector3::from_fn(|_, _| mixed.next());
                let d = way.cross(&aside).normalize();
                (r.into(), d.into())
            })
            .collect();
        let (rank, motions) = unseen(of_impacts(&hits));
        assert_eq!(rank, 5);
        let [
            UnseenMotion::Screw {
                axis,
                pitch_m: found,
                ..
            },
        ] = motions[..]
        else {
            panic!("{motions:?}");
        };
        close(found, pitch_m, 1e-9);
        close(axis[2], 1.0, 1e-12);
        has(
            &motions[0].to_string(),
            &["screw about the line through (0, 0, 0) m along (0, 0, 1) with 0.013 m/rad"],
        );
    }

    #[test]
    fn a_poor_arrangement_and_few_places_get_advice() {
        let good = disordered(1);
        assert_eq!(Conditioning::of(good.channels()).unwrap().advice(), []);
        let set_up = SetUp::new(&triaxials([[1.0; 3]; 3]), &impacts()).unwrap();
        let few = Conditioning::of(set_up.impacts()).unwrap().advice();
        assert_eq!(
            few,
            [Advice::Few {
                role: Role::Impact,
                count: 7,
                motions: 6
            }]
        );
        has(
            &few[0].to_string(),
            &["impacts: found 7, 9 to 12 are better"],
        );
        // nearly in line: the rotation about it is seen by 1 mm
        let sensors = [[0.0, 0.0, 0.0], [0.04, 0.0, 0.0], [0.02, 0.001, 0.0]].map(triaxial);
        let poor = of_sensors(&sensors).unwrap();
        assert!(
            poor.condition > 20.0 && poor.condition < 100.0,
            "{}",
            poor.condition
        );
        let advice = poor.advice();
        assert_eq!(advice.len(), 1);
        has(
            &advice[0].to_string(),
            &[
                "channels: found a condition number of ",
                "expected 10 or less",
                "rotation about the line through",
            ],
        );
        let UnseenMotion::Rotation { axis, .. } = poor.least_seen else {
            panic!("{:?}", poor.least_seen);
        };
        close(axis[0], 1.0, 1e-3);
    }

    /// Lengths in millimetres or metres are the same arrangement.
    #[test]
    fn units_do_not_matter() {
        let scaled = |by: f64| {
            let hits = IMPACTS.map(|(position, direction)| (position.map(|x| by * x), direction));
            of_impacts(&hits).unwrap().condition
        };
        close(scaled(1000.0), scaled(1.0), 1e-9);
    }

    #[test]
    fn five_are_too_few() {
        let error = of_impacts(&IMPACTS[..5]).unwrap_err();
        let (found, least) = (5, 6);
        let role = Role::Impact;
        assert_eq!(error, VirtualPointError::TooFew { role, found, least });
        assert_eq!(
            error.to_string(),
            "impacts: found 5, expected 6 or more: add some, 9 to 12 are good"
        );
    }
}
