//! Stiffness and damping of a contact over the pressure: computed at every element, or from a curve where thousands of
//! elements are asked for thousands of times.

use crate::ContactError;
use crate::fractal::{FractalContact, PerArea};
use crate::patch::{Contact, LossFactor};

/// Knots of a curve, evenly spaced over the logarithm of the pressure.
const KNOTS: usize = 96;
/// Pressures below this part of the largest one are computed on their own.
const LOWEST: f64 = 1e-4;
/// The curve begins so far above the pressure at which stiffness begins.
const ABOVE_CRITICAL: f64 = 1.0 + 1e-9;

/// What a contact has per area under a pressure.
#[derive(Debug, Clone)]
pub(super) struct ContactLaw {
    pub(super) contact: FractalContact,
    pub(super) loss_factor: LossFactor,
}

impl ContactLaw {
    /// At a pressure, Pa.
    pub(super) fn at(&self, pressure_pa: f64) -> Result<Contact, ContactError> {
        Ok(self.of(&self.contact.at(pressure_pa)?))
    }

    /// What a contact amounts to.
    pub(super) fn of(&self, found: &PerArea) -> Contact {
        let normal = found.normal_stiffness_n_per_m3;
        let tangential = found.tangential_stiffness_n_per_m3;
        Contact {
            normal_stiffness_n_per_m3: normal,
            tangential_stiffness_n_per_m3: tangential,
            normal_damping_n_per_m3: normal * self.loss_factor.of(found.normal_loss_factor),
            tangential_damping_n_per_m3: tangential
                * self.loss_factor.of(found.tangential_loss_factor),
        }
    }
}

/// A contact as cubics between knots over ln p, each through the four nearest knots (Lagrange).
///
/// k_n, η_N k_n and q = T/(μP) are smooth over ln p above the pressure at which stiffness begins, and the curve begins there.
/// What is singular where the friction is used up follows from q: k_t ∝ k_n (1 − q)^(1/3), and η_T. With a step of at most
/// h = ln(10⁴)/95 = 0.097 the interpolation's error, 3/128 h⁴ times the fourth derivative, is below 10⁻⁵ of the density at
/// every pressure and below 10⁻⁶ of sums over an interface.
#[derive(Debug, Clone)]
pub(super) struct ContactCurve<'l> {
    law: &'l ContactLaw,
    critical_pressure_pa: f64,
    lowest_pa: f64,
    log_lowest: f64,
    per_step: f64,
    /// k_t/k_n without tangential load.
    tangential_over_normal: f64,
    /// Coefficients of 1, t, t², t³ of k_n, η_N k_n and q between neighbouring knots.
    pieces: Vec<[[f64; 4]; 3]>,
}

/// k_n, η_N k_n and q.
type Knot = [f64; 3];

impl<'l> ContactCurve<'l> {
    /// Up to the pressure `largest_pa`.
    pub(super) fn new(law: &'l ContactLaw, largest_pa: f64) -> Result<Self, ContactError> {
        // whatever ends the model ends it here first
        let largest = law.contact.at(largest_pa)?;
        let critical_pressure_pa = law.contact.critical_pressure_pa();
        let lowest_pa = (critical_pressure_pa * ABOVE_CRITICAL).max(LOWEST * largest_pa);
        let mut curve = Self {
            law,
            critical_pressure_pa,
            lowest_pa,
            log_lowest: lowest_pa.ln(),
            per_step: 0.0,
            tangential_over_normal: largest.tangential_stiffness_n_per_m3
                / (largest.normal_stiffness_n_per_m3 * slip(largest.friction_ratio)),
            pieces: Vec::new(),
        };
        if lowest_pa >= largest_pa {
            return Ok(curve);
        }
        let step = (largest_pa / lowest_pa).ln() / (KNOTS - 1) as f64;
        curve.per_step = 1.0 / step;
        let knots = (0..KNOTS).map(|knot| {
            let pressure_pa = match knot {
                0 => lowest_pa,
                _ if knot == KNOTS - 1 => largest_pa,
                _ => (curve.log_lowest + step * knot as f64).exp(),
            };
            law.contact.at(pressure_pa).map(|found| {
                let normal = found.normal_stiffness_n_per_m3;
                let damping = normal * found.normal_loss_factor;
                [normal, damping, found.friction_ratio]
            })
        });
        let knots: Vec<Knot> = knots.collect::<Result<_, _>>()?;
        curve.pieces = (0..KNOTS - 1).map(|piece| cubic(&knots, piece)).collect();
        Ok(curve)
    }

    /// At a pressure up to the largest one, Pa.
    pub(super) fn at(&self, pressure_pa: f64) -> Result<Contact, ContactError> {
        if pressure_pa <= self.critical_pressure_pa {
            return Ok(Contact::default());
        }
        let Some(last) = self.pieces.len().checked_sub(1) else {
            return self.law.at(pressure_pa);
        };
        if pressure_pa < self.lowest_pa {
            return self.law.at(pressure_pa);
        }
        let place = (pressure_pa.ln() - self.log_lowest) * self.per_step;
        let piece = (place as usize).min(last);
        let t = place - piece as f64;
        let [normal, damping, friction_ratio] =
            self.pieces[piece].map(|[a, b, c, d]| a + t * (b + t * (c + t * d)));
        // rounding of a friction ratio of zero
        let friction_ratio = friction_ratio.max(0.0);
        let tangential = self.tangential_over_normal * normal * slip(friction_ratio);
        let loss = self.law.contact.tangential_loss_factor(friction_ratio)?;
        let loss_factor = self.law.loss_factor;
        Ok(Contact {
            normal_stiffness_n_per_m3: normal,
            tangential_stiffness_n_per_m3: tangential,
            normal_damping_n_per_m3: loss_factor.of(damping),
            tangential_damping_n_per_m3: tangential * loss_factor.of(loss),
        })
    }
}

/// (1 − q)^(1/3)
fn slip(friction_ratio: f64) -> f64 {
    (1.0 - friction_ratio).cbrt()
}

/// The cubics through four knots, as polynomials of the way t from knot `piece` to the next.
fn cubic(knots: &[Knot], piece: usize) -> [[f64; 4]; 3] {
    let first = piece.saturating_sub(1).min(knots.len() - 4);
    // t of the first of the four
    let offset = first as f64 - piece as f64;
    std::array::from_fn(|density| {
        let value = |place: usize| knots[first + place][density];
        // Newton's form: f₀ + Δ s + Δ²/2 s(s−1) + Δ³/6 s(s−1)(s−2), s = t − offset
        let d1 = value(1) - value(0);
        let d2 = 0.5 * (value(2) - 2.0 * value(1) + value(0));
        let d3 = (value(3) - 3.0 * value(2) + 3.0 * value(1) - value(0)) / 6.0;
        // in powers of s
        let [a, b, c, d] = [value(0), d1 - d2 + 2.0 * d3, d2 - 3.0 * d3, d3];
        // and of t
        let s = -offset;
        [
            a + s * (b + s * (c + s * d)),
            b + s * (2.0 * c + 3.0 * s * d),
            c + 3.0 * s * d,
            d,
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fractal::{Friction, StoredEnergy};
    use crate::surface::Roughness;
    use crate::{Material, Pair};

    fn densities(contact: Contact) -> [f64; 4] {
        [
            contact.normal_stiffness_n_per_m3,
            contact.tangential_stiffness_n_per_m3,
            contact.normal_damping_n_per_m3,
            contact.tangential_damping_n_per_m3,
        ]
    }

    const LARGEST_PA: f64 = 9e6;

    /// Surfaces whose q = T/(μP) comes up to `friction_ratio` at pressures up to the largest.
    fn law(fractal_dimension: f64, roughness_m: f64, friction_ratio: f64) -> ContactLaw {
        let iron = Material::new(1.5e11, 0.28).unwrap();
        let pair = Pair { a: iron, b: iron };
        let roughness = Roughness::new(fractal_dimension, roughness_m).unwrap();
        let with = |shear_strength_pa: f64| {
            let friction = Friction {
                coefficient: 0.3,
                shear_strength_pa,
            };
            FractalContact::new(&pair, roughness, 1.96e9, friction, 0.06).unwrap()
        };
        // q is proportional to the shear stress
        let slight = with(1.0);
        let most = (1..=1000)
            .map(|k| slight.at(LARGEST_PA * f64::from(k) / 1000.0).unwrap())
            .fold(0.0, |most, found| f64::max(most, found.friction_ratio));
        ContactLaw {
            contact: with(friction_ratio / most),
            loss_factor: LossFactor::EnergyRatio,
        }
    }

    /// Sums over a field with pressures from the largest down to none agree with those of the contact itself.
    #[test]
    fn sums_by_the_curve_are_those_of_every_element() {
        for (dimension, roughness_m) in [
            (1.42, 1.21e-8),
            (1.25, 1e-10),
            (1.5, 1e-9),
            (1.6, 3e-9),
            (5.0 / 3.0, 3e-9),
            (1.85, 2e-8),
        ] {
            let mut law = law(dimension, roughness_m, 0.6);
            if dimension > 1.55 {
                law.contact = law.contact.with_stored_energy(StoredEnergy::PiLoadings);
            }
            let curve = ContactCurve::new(&law, LARGEST_PA).unwrap();
            let (mut by_curve, mut by_element) = ([0.0; 4], [0.0; 4]);
            let mut worst: f64 = 0.0;
            for k in 0..4000 {
                // a paraboloid of pressure about a bolt, zero at its rim
                let pressure_pa = LARGEST_PA * (1.0 - f64::from(k) / 3999.0);
                let (found, expected) = (
                    densities(curve.at(pressure_pa).unwrap()),
                    densities(law.at(pressure_pa).unwrap()),
                );
                for i in 0..4 {
                    by_curve[i] += found[i];
                    by_element[i] += expected[i];
                    if expected[i] > 0.0 {
                        worst = worst.max((found[i] / expected[i] - 1.0).abs());
                    }
                }
            }
            assert!(worst < 1e-5, "D = {dimension}: {worst}");
            for i in 0..4 {
                let error = (by_curve[i] / by_element[i] - 1.0).abs();
                assert!(error < 1e-6, "D = {dimension}, {i}: {error}");
            }
        }
    }

    /// Where the friction is nearly used up, the tangential loss factor grows beyond all bounds; the curve follows.
    #[test]
    fn near_the_end_of_friction_the_curve_stays_with_the_contact() {
        let law = law(1.42, 1.21e-8, 0.95);
        let curve = ContactCurve::new(&law, LARGEST_PA).unwrap();
        let mut most: f64 = 0.0;
        for k in 0..1000 {
            let pressure_pa = LARGEST_PA * (1.0 - f64::from(k) / 1000.0);
            let (found, expected) = (
                densities(curve.at(pressure_pa).unwrap()),
                densities(law.at(pressure_pa).unwrap()),
            );
            for i in 0..4 {
                let error = (found[i] / expected[i] - 1.0).abs();
                assert!(error < 1e-3, "{pressure_pa} {i}: {error}");
            }
            most = most.max(expected[3] / expected[1]);
        }
        assert!(most > 10.0, "{most}");
    }

    #[test]
    fn where_nothing_is_elastic_there_is_nothing() {
        let law = law(1.42, 1.21e-8, 0.6);
        let below = 0.5 * law.contact.critical_pressure_pa();
        let curve = ContactCurve::new(&law, below).unwrap();
        assert_eq!(curve.at(below).unwrap(), Contact::default());
        assert_eq!(curve.at(0.0).unwrap(), Contact::default());
    }

    #[test]
    fn pressures_beyond_the_model_are_refused_as_the_contact_does() {
        let law = law(1.42, 1.21e-8, 0.6);
        let beyond = ContactCurve::new(&law, 3e9).unwrap_err();
        assert_eq!(beyond, law.at(3e9).unwrap_err());
    }
}
