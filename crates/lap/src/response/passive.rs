//! What keeps an identified joint from feeding energy: limits of its unknowns, as `export` judges the joint file.
//!
//! Springs and dampers must not be negative, nor the damping c₁₂ + c₂r² + c₄r⁴ at any displacement r up to the largest that
//! was observed, nor the spring that is left beside a law that slips. Each limit is a function of the unknowns that must not
//! be negative. The damping has one at rest, one at the largest displacement, and one at each minimum between.

use std::fmt;

use bolted_joint_dynamics::law::Term;
use nalgebra::DVector;
use serde::{Serialize, Serializer};

use super::model::{Model, ResponseUnknown, Values};

/// Parts of the range of u = r² between which a minimum of the damping is sought, and steps that refine it.
const PARTS: usize = 64;
const REFINEMENTS: usize = 40;
/// Part of their size by which dampers that fall are made smaller against rounding, once the estimate is there.
const ROUNDING: f64 = 1e-9;
/// A limit is exceeded if it is negative by more than this part of its terms.
const EXCEEDED: f64 = 1e-12;

/// What would be negative if an estimate were free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// k of the supports.
    SupportStiffness,
    /// c of the supports.
    SupportDamping,
    /// k12; beside a law that slips what it leaves of k12.
    JointStiffness,
    /// The joint's damping at this displacement, m: at zero it is c12.
    JointDamping(f64),
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SupportStiffness => f.write_str("k"),
            Self::SupportDamping => f.write_str("c"),
            Self::JointStiffness => f.write_str("the joint's spring"),
            Self::JointDamping(0.0) => f.write_str("c12"),
            Self::JointDamping(at_m) => {
                write!(f, "the joint's damping at a displacement of {at_m:.3e} m")
            }
        }
    }
}

impl Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A limit at one place in the space of unknowns.
pub(super) struct Bound {
    pub(super) limit: Limit,
    /// Not negative of a passive joint.
    pub(super) value: f64,
    /// By the unknowns.
    pub(super) gradient: DVector<f64>,
    /// v with ∇²value = −v vᵀ; `None` of a limit that is taken as straight.
    pub(super) curvature: Option<DVector<f64>>,
}

/// The limits of a model's unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passive<'a> {
    pub(super) model: &'a Model,
    /// Up to which displacement the joint must take energy, m.
    pub(super) amplitude_m: f64,
}

/// The joint's damping over u = r², less the powers that it is known not to have.
struct Damping {
    /// Coefficients of u^j, with the unknowns that they are.
    terms: Vec<(ResponseUnknown, f64)>,
    /// u at the largest displacement.
    farthest: f64,
}

impl Damping {
    fn of(passive: &Passive<'_>, values: &Values) -> Self {
        let dampers = Term::ALL.into_iter().filter(|term| term.is_damper());
        let linear = (ResponseUnknown::JointDamping, values.joint_damping);
        let higher = dampers.map(|term| (ResponseUnknown::Term(term), values.term(term)));
        let is_absent = |(unknown, value): &(ResponseUnknown, f64)| {
            *value == 0.0 && !passive.model.unknowns.contains(unknown)
        };
        let mut terms: Vec<_> = std::iter::once(linear).chain(higher).collect();
        while terms.last().is_some_and(is_absent) {
            terms.pop();
        }
        let first = terms.iter().take_while(|term| is_absent(term)).count();
        Self {
            terms: terms.split_off(first),
            farthest: passive.amplitude_m * passive.amplitude_m,
        }
    }

    /// The `order`-th derivative of each u^j.
    fn powers(&self, u: f64, order: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.terms.len()).map(move |j| {
            let factor: usize = (0..order).map(|n| j.saturating_sub(n)).product();
            match factor {
                0 => 0.0,
                _ => factor as f64 * u.powi(j as i32 - order as i32),
            }
        })
    }

    fn value(&self, u: f64, order: usize) -> f64 {
        let values = self.terms.iter().map(|(_, value)| value);
        values.zip(self.powers(u, order)).map(|(c, p)| c * p).sum()
    }

    /// Sum of the moduli of its terms at the largest displacement.
    fn size(&self) -> f64 {
        let values = self.terms.iter().map(|(_, value)| value.abs());
        let powers = self.powers(self.farthest, 0);
        values.zip(powers).map(|(c, p)| c * p).sum()
    }

    /// u of the minima between rest and the largest displacement.
    fn minima(&self) -> Vec<f64> {
        if self.terms.len() < 3 {
            return Vec::new();
        }
        let place = |n: usize| self.farthest * n as f64 / PARTS as f64;
        let turns =
            |n: &usize| self.value(place(*n), 1) < 0.0 && self.value(place(n + 1), 1) >= 0.0;
        let refined = |n: usize| {
            let (mut low, mut high) = (place(n), place(n + 1));
            for _ in 0..REFINEMENTS {
                let middle = 0.5 * (low + high);
                if self.value(middle, 1) < 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            0.5 * (low + high)
        };
        (0..PARTS).filter(turns).map(refined).collect()
    }

    /// The least value, and where.
    fn least(&self) -> f64 {
        let ends = [0.0, self.farthest].into_iter();
        let all = ends.chain(self.minima()).map(|u| self.value(u, 0));
        all.fold(f64::INFINITY, f64::min)
    }
}

impl Passive<'_> {
    fn unit(&self, unknown: ResponseUnknown) -> Option<DVector<f64>> {
        let place = self.model.unknowns.iter().position(|own| *own == unknown)?;
        let mut gradient = DVector::zeros(self.model.unknowns.len());
        gradient[place] = 1.0;
        Some(gradient)
    }

    /// The limits that the unknowns can exceed.
    pub(super) fn bounds(&self, values: &Values) -> Vec<Bound> {
        let simple = [
            (Limit::SupportStiffness, ResponseUnknown::SupportStiffness),
            (Limit::SupportDamping, ResponseUnknown::SupportDamping),
        ];
        let mut bounds: Vec<Bound> = simple
            .into_iter()
            .filter_map(|(limit, unknown)| {
                Some(Bound {
                    limit,
                    value: values.of(unknown),
                    gradient: self.unit(unknown)?,
                    curvature: None,
                })
            })
            .collect();
        bounds.extend(self.spring(values));
        bounds.extend(self.damping(values));
        bounds
    }

    /// k₁₂, or k₁₂ − K_T beside a law that slips, of which the unknowns are logarithms.
    fn spring(&self, values: &Values) -> Option<Bound> {
        let size = self.model.unknowns.len();
        let own = self.unit(ResponseUnknown::JointStiffness);
        let mut gradient = own.unwrap_or_else(|| DVector::zeros(size));
        let value = values.spring();
        let mut curvature = None;
        if let Some(slider) = &values.slider {
            let by = slider.stiffness_by_unknowns();
            for (place, unknown) in self.model.unknowns.iter().enumerate() {
                if let ResponseUnknown::Slider(parameter) = unknown
                    && let Some(index) = slider.index(*parameter)
                {
                    gradient[place] = -by[index];
                }
            }
            // K_T is an exponential: ∇²K_T ≈ ∇K_T ∇K_Tᵀ/K_T
            let of_law = |unknown: &ResponseUnknown| matches!(unknown, ResponseUnknown::Slider(_));
            let mut along = gradient.clone() / slider.stiffness().sqrt();
            for (entry, unknown) in along.iter_mut().zip(&self.model.unknowns) {
                *entry *= f64::from(u8::from(of_law(unknown)));
            }
            curvature = (along.norm_squared() > 0.0).then_some(along);
        }
        (gradient.norm_squared() > 0.0).then_some(Bound {
            limit: Limit::JointStiffness,
            value,
            gradient,
            curvature,
        })
    }

    fn damping(&self, values: &Values) -> Vec<Bound> {
        let damping = Damping::of(self, values);
        let gradient = |powers: &mut dyn Iterator<Item = f64>| {
            let mut gradient = DVector::zeros(self.model.unknowns.len());
            for ((unknown, _), power) in damping.terms.iter().zip(powers) {
                if let Some(unit) = self.unit(*unknown) {
                    gradient.axpy(power, &unit, 1.0);
                }
            }
            gradient
        };
        let bound = |u: f64, is_between: bool| {
            // least(x) = min_u c(u; x): ∇² = −∇c′ ∇c′ᵀ/c″
            let curvature = || gradient(&mut damping.powers(u, 1)) / damping.value(u, 2).sqrt();
            Bound {
                limit: Limit::JointDamping(u.sqrt()),
                value: damping.value(u, 0),
                gradient: gradient(&mut damping.powers(u, 0)),
                curvature: is_between.then(curvature),
            }
        };
        let ends = match damping.terms.len() {
            0 => &[][..],
            1 => &[0.0][..],
            _ => &[0.0, damping.farthest],
        };
        let ends = ends.iter().map(|&u| bound(u, false));
        let between = damping.minima().into_iter().map(|u| bound(u, true));
        ends.chain(between)
            .filter(|bound| bound.gradient.norm_squared() > 0.0)
            .collect()
    }

    /// Values within the limits near others: what a step exceeds by its curvature, or a start altogether, is taken back.
    pub(super) fn within(&self, mut values: Values) -> Values {
        let is_unknown = |unknown| self.model.unknowns.contains(&unknown);
        if is_unknown(ResponseUnknown::SupportStiffness) {
            values.support_stiffness = values.support_stiffness.max(0.0);
        }
        if is_unknown(ResponseUnknown::SupportDamping) {
            values.support_damping = values.support_damping.max(0.0);
        }
        if is_unknown(ResponseUnknown::JointStiffness) {
            values.joint_stiffness = values.joint_stiffness.max(0.0);
        }
        // responses tell the stiffness of small motion far better than the law's part of it: the law gives way
        if let Some(slider) = &mut values.slider
            && values.joint_stiffness > 0.0
        {
            slider.soften_to(values.joint_stiffness);
        }
        let damping = Damping::of(self, &values);
        let exceeded = -damping.least();
        if exceeded.is_nan() || exceeded <= EXCEEDED * damping.size() {
            if is_unknown(ResponseUnknown::JointDamping) {
                values.joint_damping = values.joint_damping.max(0.0);
            }
            return values;
        }
        if is_unknown(ResponseUnknown::JointDamping) {
            values.joint_damping += exceeded;
            return values;
        }
        // c₁₂ is known: the dampers that fall give way
        let with = |part: f64| self.with_falling(&values, part);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..REFINEMENTS {
            let middle = 0.5 * (low + high);
            let damping = Damping::of(self, &with(middle));
            if damping.least() < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        with(low)
    }

    /// The dampers that fall with the amplitude, times a factor.
    fn with_falling(&self, values: &Values, factor: f64) -> Values {
        let mut values = *values;
        for unknown in &self.model.unknowns {
            if let ResponseUnknown::Term(term) = unknown
                && term.is_damper()
                && values.term(*term) < 0.0
            {
                *values.terms.coefficient_mut(*term) *= factor;
            }
        }
        values
    }

    /// The same values where rounding of a limit that they stand at cannot make the joint active.
    pub(super) fn clear_of_rounding(&self, values: &Values) -> Values {
        let inside = self.with_falling(values, 1.0 - ROUNDING);
        self.within(inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::study::Place;
    use crate::response::terms::TermSet;
    use bolted_joint_dynamics::Polynomial;

    fn model() -> Model {
        let dampers: Vec<Term> = Term::ALL
            .into_iter()
            .filter(|term| term.is_damper())
            .collect();
        let terms = TermSet::of(&dampers);
        let linear = [
            ResponseUnknown::JointStiffness,
            ResponseUnknown::JointDamping,
        ];
        Model {
            drive: Place::Relative,
            response: Place::Relative,
            unknowns: linear.into_iter().chain(terms.unknowns()).collect(),
            terms,
            harmonics: 1,
        }
    }

    fn values(damping: f64, dampers: [f64; 2]) -> Values {
        Values {
            mass: 2.0,
            joint_stiffness: 5e5,
            joint_damping: damping,
            terms: Polynomial::with(&[], &dampers),
            ..Values::default()
        }
    }

    #[test]
    fn a_dip_of_the_damping_is_a_limit_with_its_derivatives() {
        let model = model();
        let passive = Passive {
            model: &model,
            amplitude_m: 1e-3,
        };
        // 3 (1 − u/0.5)² over u in mm²: least at u = 0.5 mm²
        let own = values(3.0, [-12e6, 12e12]);
        let bounds = passive.bounds(&own);
        assert_eq!(bounds.len(), 4);
        let dip = bounds.last().unwrap();
        assert!(dip.value.abs() < 1e-12);
        let Limit::JointDamping(at_m) = dip.limit else {
            panic!("{:?}", dip.limit)
        };
        assert!((at_m / 0.5e-6_f64.sqrt() - 1.0).abs() < 1e-9);
        // c12 − c2²/(4 c4)
        let least = |c: f64, c2: f64, c4: f64| c - c2 * c2 / (4.0 * c4);
        let [c, c2, c4] = [3.0, -12e6, 12e12];
        let by_c2 = (least(c, c2 + 1.0, c4) - least(c, c2 - 1.0, c4)) / 2.0;
        assert!((dip.gradient[2] / by_c2 - 1.0).abs() < 1e-6, "{by_c2}");
        // ∂²/∂c2² = −1/(2 c4)
        let curvature = dip.curvature.as_ref().unwrap();
        assert!((curvature[2].powi(2) * 2.0 * c4 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn values_are_brought_within_and_stay_there() {
        let model = model();
        let passive = Passive {
            model: &model,
            amplitude_m: 1e-3,
        };
        for dampers in [[-12e6, 12e12], [-5e6, 0.0], [2e6, -9e12], [-1e6, -1e12]] {
            let within = passive.within(values(1.0, dampers));
            let damping = Damping::of(&passive, &within);
            assert!(damping.least().abs() < 1e-9, "{dampers:?}");
            assert_eq!(passive.within(within), within);
        }
        let inside = values(20.0, [-12e6, 12e12]);
        assert_eq!(passive.within(inside), inside);
    }
}
