//! What is known of the errors of the set-up before anything is measured.
//!
//! Each sensor and each impact is off by itself, by ε. Those of an interface may be off together as well, by the six numbers u of a
//! rigid body: their places were measured from another point, or a bolt is not in the middle of its hole. So η = ε + V u. With D for
//! the variances of ε and S for those of u:
//!
//! P = (D + V S Vᵀ)⁻¹ = D⁻¹ − W (S⁻¹ + Vᵀ W)⁻¹ Wᵀ, W = D⁻¹ V,
//!
//! and what η says of both is ε = D P η, u = S Vᵀ P η.

use std::fmt;

use bolted_joint_space::Dof;
use bolted_joint_virtual_point::{Change, Place, Role, Tolerance};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Vector3};

use crate::normal::Normal;
use crate::problem::{Problem, Unknowns};
use crate::side::{MOTIONS, MayErr, Placed, Side, Test};

/// Variance of an error that is known by itself, in parts of what it is.
const KNOWN: f64 = 1e-4;

/// How far what belongs together may be off as a whole; `None` where it is not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Common {
    /// All places of an interface of a part.
    pub(crate) origin: Option<Tolerance>,
    /// The joint itself between both, where its model says where it is.
    pub(crate) joint: Option<Tolerance>,
}

/// What may be off as a whole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Whole {
    /// All places of this table of the study.
    Origin(String),
    /// The joint of this table.
    Joint(String),
}

impl fmt::Display for Whole {
    /// As what is off is listed.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Origin(table) => write!(f, "{table} as a whole"),
            Self::Joint(table) => write!(f, "{table} itself"),
        }
    }
}

/// The errors before anything is measured.
pub(crate) struct Prior {
    /// The place of the first among all unknowns.
    first: usize,
    /// D
    variances: DVector<f64>,
    wholes: Option<Wholes>,
}

/// What is off as a whole.
struct Wholes {
    /// Six numbers each.
    all: Vec<Whole>,
    /// V, and W.
    shares: DMatrix<f64>,
    weighted: DMatrix<f64>,
    /// S
    variances: DVector<f64>,
    /// S⁻¹ + Vᵀ W
    inner: Cholesky<f64, Dyn>,
}

impl Problem {
    /// What the budget says of the errors.
    pub(crate) fn prior(&self) -> Prior {
        let deviations = self.own_deviations();
        let variances = DVector::from_iterator(
            deviations.len(),
            deviations.into_iter().map(|own| own * own),
        );
        let wholes = match variances.is_empty() {
            true => None,
            false => Wholes::of(self, &variances),
        };
        Prior {
            first: self.joint_count(),
            variances,
            wholes,
        }
    }
}

impl Wholes {
    fn of(problem: &Problem, variances: &DVector<f64>) -> Option<Self> {
        let Common { origin, joint } = problem.common;
        let parameters: Vec<MayErr<'_>> = problem.sides.iter().flat_map(Side::parameters).collect();
        let (mut all, mut deviations, mut members) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(tolerance) = &origin {
            let interfaces = problem.sides.iter().flat_map(|side| &side.interfaces);
            for placed in interfaces.filter(|placed| placed.points().is_some()) {
                all.push(Whole::Origin(placed.name.clone()));
                deviations.push(tolerance);
                members.push(vec![placed]);
            }
        }
        if let Some(tolerance) = &joint {
            let sought = problem.links.sought().into_iter();
            for sought in sought.filter(|sought| sought.link.is_placed) {
                all.push(Whole::Joint(sought.link.key.clone()));
                deviations.push(tolerance);
                let sides = problem.sides.iter();
                let own = sides.filter_map(|side| side.interfaces.get(sought.number));
                members.push(own.collect());
            }
        }
        if all.is_empty() {
            return None;
        }
        let mut shares = DMatrix::zeros(parameters.len(), MOTIONS * all.len());
        for (row, one) in parameters.iter().enumerate() {
            for (number, members) in members.iter().enumerate() {
                if members.iter().any(|own| std::ptr::eq(*own, one.placed)) {
                    let mut own = shares.view_mut((row, MOTIONS * number), (1, MOTIONS));
                    own.copy_from_slice(&share(one));
                }
            }
        }
        let of_dof = |tolerance: &Tolerance| Dof::ALL.map(|dof| tolerance.of(Change::Pose(dof)));
        let each = deviations.into_iter().flat_map(of_dof);
        let own = DVector::from_iterator(MOTIONS * all.len(), each.map(|own| own * own));
        Self::new(all, shares, own, variances)
    }

    /// From V, S and D.
    fn new(
        all: Vec<Whole>,
        shares: DMatrix<f64>,
        variances: DVector<f64>,
        of_errors: &DVector<f64>,
    ) -> Option<Self> {
        let mut weighted = shares.clone();
        for (mut row, variance) in weighted.row_iter_mut().zip(of_errors) {
            row /= *variance;
        }
        let mut inner = shares.tr_mul(&weighted);
        for (n, variance) in variances.iter().enumerate() {
            inner[(n, n)] += variance.recip();
        }
        Some(Self {
            all,
            shares,
            weighted,
            variances,
            inner: Cholesky::new(inner)?,
        })
    }

    /// The same beside errors with these variances.
    fn beside(&self, of_errors: &DVector<f64>) -> Option<Self> {
        let (shares, variances) = (self.shares.clone(), self.variances.clone());
        Self::new(self.all.clone(), shares, variances, of_errors)
    }
}

/// What a shift along each axis and a turn about each of all places of an interface do to an error of one of them.
fn share(one: &MayErr<'_>) -> [f64; MOTIONS] {
    let (Test::All, Change::Pose(dof)) = (one.test, one.parameter.change) else {
        return [0.0; MOTIONS];
    };
    let position = position(one.placed, one.parameter.place);
    Dof::ALL.map(|whole| match (dof.is_rotation(), whole.is_rotation()) {
        (false, true) => {
            let axis = Vector3::ith(whole.index() - 3, 1.0);
            axis.cross(&position)[dof.index()]
        }
        _ => f64::from(u8::from(dof == whole)),
    })
}

fn position(placed: &Placed, place: Place) -> Vector3<f64> {
    let of = |role: Role, number: usize| {
        let (_, set_up) = placed.points()?;
        set_up.places(role).positions_m().nth(number)
    };
    let found = match place {
        Place::Sensor(number) => of(Role::Channel, number),
        Place::Impact(number) => of(Role::Impact, number),
        Place::Channel(_) => None,
    };
    found.unwrap_or_else(Vector3::zeros)
}

impl Prior {
    /// η among all unknowns.
    fn errors(&self, unknowns: &Unknowns) -> DVector<f64> {
        let count = self.variances.len();
        unknowns.0.rows(self.first, count).into_owned()
    }

    /// P A
    fn times(&self, all: &DMatrix<f64>) -> DMatrix<f64> {
        let mut own = all.clone();
        for (mut row, variance) in own.row_iter_mut().zip(&self.variances) {
            row /= *variance;
        }
        if let Some(wholes) = &self.wholes {
            let inner = wholes.inner.solve(&wholes.weighted.tr_mul(all));
            own.gemm(-1.0, &wholes.weighted, &inner, 1.0);
        }
        own
    }

    /// P η
    fn pull(&self, unknowns: &Unknowns) -> DVector<f64> {
        let errors = self.errors(unknowns);
        let mut own = errors.component_div(&self.variances);
        if let Some(wholes) = &self.wholes {
            own -= &wholes.weighted * wholes.inner.solve(&wholes.weighted.tr_mul(&errors));
        }
        own
    }

    /// ηᵀ P η: about as many as there are, or fewer, where the budget holds.
    pub(crate) fn squares(&self, unknowns: &Unknowns) -> f64 {
        self.errors(unknowns).dot(&self.pull(unknowns))
    }

    /// The squares of the errors of the set-up join the others.
    pub(crate) fn add_to(&self, unknowns: &Unknowns, normal: &mut Normal) {
        let (first, count) = (self.first, self.variances.len());
        let pull = self.pull(unknowns);
        normal.cost += self.errors(unknowns).dot(&pull);
        let mut descent = normal.descent.rows_mut(first, count);
        descent -= pull;
        for (n, variance) in self.variances.iter().enumerate() {
            normal.information[(first + n, first + n)] += variance.recip();
        }
        if let Some(wholes) = self.without_wholes() {
            let mut own = normal.information.view_mut((first, first), (count, count));
            own -= wholes;
        }
    }

    /// P
    fn information(&self) -> DMatrix<f64> {
        let own = DMatrix::from_diagonal(&self.variances.map(f64::recip));
        match self.without_wholes() {
            Some(wholes) => own - wholes,
            None => own,
        }
    }

    /// D⁻¹ − P: what is known more where nothing is off as a whole; `None` where nothing may be.
    pub(crate) fn without_wholes(&self) -> Option<DMatrix<f64>> {
        let wholes = self.wholes.as_ref()?;
        let inner = wholes.inner.solve(&wholes.weighted.transpose());
        Some(&wholes.weighted * inner)
    }

    /// Numbers of what may be off as a whole, as far as any place has a share in them: in a plane not all have.
    pub(crate) fn whole_count(&self) -> usize {
        let Some(wholes) = &self.wholes else {
            return 0;
        };
        let shares = wholes.shares.column_iter();
        shares
            .filter(|own| own.iter().any(|share| *share != 0.0))
            .count()
    }

    /// P with D of these errors in parts of what it is, less P: what is known more where they are known by themselves. What they are off
    /// by as part of a whole stays unknown.
    pub(crate) fn known_alone(&self, errors: &[usize]) -> Option<DMatrix<f64>> {
        let wholes = self.wholes.as_ref()?;
        let mut variances = self.variances.clone();
        for &error in errors {
            variances[error] *= KNOWN;
        }
        let known = Self {
            first: self.first,
            wholes: wholes.beside(&variances),
            variances,
        };
        Some(known.information() - self.information())
    }

    /// Variance of w η for weights w of all errors: wᵀ (D + V S Vᵀ) w.
    pub(crate) fn variance(&self, weights: &DVector<f64>) -> f64 {
        let own = weights.component_mul(weights).dot(&self.variances);
        own + self.wholes.as_ref().map_or(0.0, |wholes| {
            let shares = wholes.shares.tr_mul(weights);
            shares.component_mul(&shares).dot(&wholes.variances)
        })
    }

    /// Standard deviation of each error, with what it is off by as part of a whole.
    pub(crate) fn deviations(&self) -> Vec<f64> {
        let of_whole = |n: usize| {
            self.wholes.as_ref().map_or(0.0, |wholes| {
                let own = wholes.shares.row(n).transpose();
                own.component_mul(&own).dot(&wholes.variances)
            })
        };
        let own = self.variances.iter().enumerate();
        own.map(|(n, own)| (own + of_whole(n)).sqrt()).collect()
    }

    /// ε: what each error is by itself.
    pub(crate) fn alone(&self, unknowns: &Unknowns) -> DVector<f64> {
        self.pull(unknowns).component_mul(&self.variances)
    }

    /// Standard deviations of ε, where `covariance` is that of η with all data: D P Σ P D + D − D P D.
    pub(crate) fn deviations_alone(&self, covariance: &DMatrix<f64>) -> Vec<f64> {
        if self.wholes.is_none() {
            return covariance.diagonal().map(f64::sqrt).as_slice().to_vec();
        }
        let (own, information) = (self.times(covariance), self.information());
        let all = self.times(&own.transpose());
        (0..self.variances.len())
            .map(|n| {
                let variance = self.variances[n];
                let spread = all[(n, n)] - information[(n, n)];
                (variance + variance * variance * spread).max(0.0).sqrt()
            })
            .collect()
    }

    /// What is off as a whole, by how much in each of six motions, with the standard deviation and that of the budget: S Vᵀ P η,
    /// S Vᵀ P Σ P V S + S − S Vᵀ P V S.
    pub(crate) fn wholes(
        &self,
        unknowns: &Unknowns,
        covariance: &DMatrix<f64>,
    ) -> Vec<(Whole, [[f64; 3]; MOTIONS])> {
        let Some(wholes) = &self.wholes else {
            return Vec::new();
        };
        let values = wholes.shares.tr_mul(&self.pull(unknowns));
        let pulled = self.times(&wholes.shares);
        let told = pulled.tr_mul(&(covariance * &pulled)) - wholes.shares.tr_mul(&pulled);
        let of = |n: usize| {
            let variance = wholes.variances[n];
            let left = variance + variance * variance * told[(n, n)];
            [variance * values[n], left.max(0.0).sqrt(), variance.sqrt()]
        };
        let all = wholes.all.iter().cloned().enumerate();
        all.map(|(number, whole)| {
            let own = std::array::from_fn(|dof| {
                let [value, deviation, budget] = of(MOTIONS * number + dof);
                match whole {
                    Whole::Origin(_) => [value, deviation, budget],
                    // all places are beside the joint by the opposite
                    Whole::Joint(_) => [-value, deviation, budget],
                }
            });
            (whole, own)
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{problem, unknowns};

    const OFF: Tolerance = Tolerance {
        position_m: 7e-4,
        rotation_rad: 4e-3,
        gain: 0.0,
    };

    fn with_wholes() -> Problem {
        Problem {
            common: Common {
                origin: Some(OFF),
                joint: None,
            },
            ..problem()
        }
    }

    /// D + V S Vᵀ, entry by entry.
    fn covariance(problem: &Problem) -> DMatrix<f64> {
        let parameters: Vec<_> = problem.sides.iter().flat_map(Side::parameters).collect();
        let own = problem.own_deviations();
        let count = own.len();
        DMatrix::from_fn(count, count, |i, j| {
            let (one, other) = (&parameters[i], &parameters[j]);
            let mut sum = if i == j { own[i] * own[i] } else { 0.0 };
            if std::ptr::eq(one.placed, other.placed) {
                let (left, right) = (share(one), share(other));
                for dof in Dof::ALL {
                    let by = OFF.of(Change::Pose(dof)).powi(2);
                    sum += by * left[dof.index()] * right[dof.index()];
                }
            }
            sum
        })
    }

    #[test]
    fn its_squares_are_those_of_the_covariance() {
        let problem = with_wholes();
        let at = unknowns(&problem);
        let prior = problem.prior();
        let root = Cholesky::new(covariance(&problem)).unwrap();
        let errors = prior.errors(&at);
        let expected = errors.dot(&root.solve(&errors));
        assert!((prior.squares(&at) - expected).abs() < 1e-9 * expected);
        let mut normal = Normal::zeros(problem.count());
        prior.add_to(&at, &mut normal);
        assert!((normal.cost - expected).abs() < 1e-9 * expected);
        let first = problem.joint_count();
        let own = normal
            .information
            .view((first, first), (errors.len(), errors.len()));
        assert!((own - root.inverse()).norm() < 1e-9 * root.inverse().norm());
        let weights = DVector::from_fn(errors.len(), |n, _| 1.0 + n as f64);
        let variance = weights.dot(&(covariance(&problem) * &weights));
        assert!((prior.variance(&weights) - variance).abs() < 1e-9 * variance);
        for (own, variance) in prior
            .deviations()
            .iter()
            .zip(covariance(&problem).diagonal().iter())
        {
            assert!((own * own - variance).abs() < 1e-12 * variance);
        }
    }

    /// Places of b that are moved and turned together, and nothing else: that is told, and no place by itself.
    #[test]
    fn what_is_off_as_a_whole_is_told_as_that() {
        let problem = with_wholes();
        let first = problem.joint_count();
        let mut at = unknowns(&problem);
        let moved = [4e-4, -6e-4, 2e-4, 2e-3, 1e-3, -3e-3];
        let parameters: Vec<_> = problem.sides.iter().flat_map(Side::parameters).collect();
        for (n, one) in parameters.iter().enumerate() {
            let is_of_b = std::ptr::eq(one.placed, &problem.sides[1].interfaces[0]);
            let shares = share(one);
            let own = shares.iter().zip(moved).map(|(share, own)| share * own);
            at.0[first + n] = if is_of_b { own.sum() } else { 0.0 };
        }
        // a place of b as a rigid body moves its points: v = t + θ × r
        let turn = Vector3::new(moved[3], moved[4], moved[5]);
        let (_, set_up) = problem.sides[1].interfaces[0].points().unwrap();
        let r = set_up.places(Role::Impact).positions_m().nth(2).unwrap();
        let expected = Vector3::new(moved[0], moved[1], moved[2]) + turn.cross(&r);
        for (n, one) in parameters.iter().enumerate() {
            let is_it = std::ptr::eq(one.placed, &problem.sides[1].interfaces[0])
                && one.parameter.place == Place::Impact(2);
            if let (true, Change::Pose(dof)) = (is_it, one.parameter.change)
                && !dof.is_rotation()
            {
                assert!((at.0[first + n] - expected[dof.index()]).abs() < 1e-15);
            }
        }
        let prior = problem.prior();
        let count = problem.error_count();
        // as if the functions told all errors
        let wholes = prior.wholes(&at, &DMatrix::zeros(count, count));
        for (own, moved) in wholes[1].1.iter().zip(moved) {
            let [value, deviation, budget] = *own;
            assert!((value - moved).abs() < 3.0 * deviation && deviation < 0.6 * budget);
        }
        for own in &wholes[0].1 {
            assert_eq!(own[0], 0.0);
        }
        let own = problem.own_deviations();
        let alone = prior.alone(&at);
        assert!(
            alone
                .iter()
                .zip(&own)
                .all(|(alone, own)| alone.abs() < own.abs())
        );
        let told = prior.deviations_alone(&DMatrix::zeros(count, count));
        assert!(told.iter().zip(own).all(|(told, own)| *told <= own));
    }
}
