//! The Iwan law that comes closest to an interface's patches in a range of amplitudes.

use bolted_joint_dynamics::law::{Iwan, Law};

use super::Patches;
use crate::least_squares::TwoUnknowns;

/// Amplitudes at which the laws are compared, evenly over their logarithm.
const COMPARED: usize = 60;
/// Range of amplitudes where a study gives none, as parts of slip force over stiffness: from hardly any slip to much of it.
const RANGE: [f64; 2] = [0.03, 3.0];
/// Bounds of ln(χ + 1) and of ln β.
const BOUNDS: [[f64; 2]; 2] = [[-4.0, 2.0], [-12.0, 8.0]];
/// Starts of the search in both.
const STARTS: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [-1.0, -1.0],
    [0.5, -3.0],
    [0.0, 3.0],
    [1.0, 1.0],
];

/// A range of amplitudes of the relative motion, m or rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amplitudes {
    /// Smallest; above zero.
    pub from: f64,
    /// Largest; above the smallest.
    pub to: f64,
}

impl Amplitudes {
    /// From hardly any slip of these patches to much of it.
    #[must_use]
    pub fn of(patches: &Patches) -> Self {
        let [from, to] = RANGE.map(|part| part * patches.slip_force() / patches.stiffness());
        Self { from, to }
    }

    /// `count` of them, evenly over their logarithm, both ends among them.
    pub fn points(self, count: usize) -> impl Iterator<Item = f64> {
        let ratio = (self.to / self.from).ln() / (count.max(2) - 1) as f64;
        (0..count).map(move |k| self.from * (k as f64 * ratio).exp())
    }
}

/// The law that a joint file has in place of the patches, and how far it is from them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MicroslipLaw {
    /// The law; slip force and stiffness are those of the patches.
    pub law: Iwan,
    /// Amplitudes that it was fitted in.
    pub amplitudes: Amplitudes,
    /// Root mean square of |heat of a cycle/that of the patches − 1| over them.
    pub heat_error: f64,
    /// The largest of those.
    pub worst_heat_error: f64,
    /// Largest |load at the tip/that of the patches − 1| over them.
    pub worst_load_error: f64,
}

impl MicroslipLaw {
    /// The law with the patches' slip force and stiffness, and with exponent χ and ratio β by least squares of the logarithms of
    /// heat and load over a range of amplitudes.
    #[must_use]
    pub fn of(patches: &Patches, amplitudes: Amplitudes) -> Self {
        let known: Vec<[f64; 3]> = amplitudes
            .points(COMPARED)
            .map(|u| [u, patches.cycle_heat(u), patches.load(u)])
            .collect();
        let law = |[exponent, ratio]: [f64; 2]| Iwan {
            slip_force: patches.slip_force(),
            stiffness: patches.stiffness(),
            exponent: exponent.exp() - 1.0,
            ratio: ratio.exp(),
        };
        let differences = |law: &Iwan| -> Vec<[f64; 2]> {
            let of = |&[u, heat, load]: &[f64; 3]| {
                let [own_heat, own_load] = at(law, u);
                [(own_heat / heat).ln(), (own_load / load).ln()]
            };
            known.iter().map(of).collect()
        };
        let squares = TwoUnknowns {
            residuals: |at: [f64; 2]| Some(differences(&law(at))),
            bounds: BOUNDS,
        };
        let (mut best, mut least) = (STARTS[0], f64::INFINITY);
        for start in STARTS {
            let (found, sum) = squares.refined(start);
            if sum < least {
                (best, least) = (found, sum);
            }
        }
        let law = law(best);
        let errors = differences(&law);
        let worst = |n: usize| {
            errors
                .iter()
                .fold(0.0, |worst: f64, e| worst.max(e[n].exp_m1().abs()))
        };
        let sum: f64 = errors.iter().map(|e| e[0].exp_m1().powi(2)).sum();
        Self {
            law,
            amplitudes,
            heat_error: (sum / errors.len() as f64).sqrt(),
            worst_heat_error: worst(0),
            worst_load_error: worst(1),
        }
    }

    /// Heat (J) of a cycle between ± an amplitude, and the load at its tip.
    #[must_use]
    pub fn heat_and_load(&self, amplitude: f64) -> [f64; 2] {
        at(&self.law, amplitude)
    }
}

/// Heat (J) of a cycle, and the load at its tip.
fn at(law: &Iwan, amplitude: f64) -> [f64; 2] {
    let mut memory = [0.0; <Iwan as Law<f64>>::DECLARATION.memory_count()];
    let load = law.load(&memory, amplitude, 0.0);
    // Masing: the first loading costs a quarter of a cycle
    [4.0 * law.commit(&mut memory, amplitude, 0.0), load]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microslip::Patch;

    /// Patches that are those of an Iwan law: their stiffness lies over slip displacements by its density.
    fn of_density(exponent: f64, count: usize) -> Patches {
        let patch = |k: usize| {
            let end = (k as f64 + 0.5) / count as f64;
            let stiffness = end.powf(exponent);
            Patch {
                stiffness,
                slip_force: stiffness * end / 1.5,
            }
        };
        Patches::new((0..count).map(patch)).unwrap()
    }

    /// An even pressure: all patches are alike, and the law is that of one contact of Mindlin.
    ///
    /// Reference: SciPy's `least_squares` on 40 amplitudes gives χ = 0.066, β = 0.817, 4.1 % and 13.5 %.
    #[test]
    fn one_contact_of_mindlin() {
        let patch = Patch {
            stiffness: 8.8e8,
            slip_force: 800.0,
        };
        let patches = Patches::new(std::iter::repeat_n(patch, 10)).unwrap();
        let found = MicroslipLaw::of(&patches, Amplitudes::of(&patches));
        assert!((found.law.exponent - 0.066).abs() < 0.01, "{found:?}");
        assert!((found.law.ratio - 0.817).abs() < 0.05, "{found:?}");
        assert!(
            found.heat_error < 0.045 && found.worst_heat_error < 0.15,
            "{found:?}"
        );
        assert!(found.worst_load_error < 0.025, "{found:?}");
        assert_eq!(found.law.slip_force, patches.slip_force());
        assert_eq!(found.law.stiffness, patches.stiffness());
    }

    /// Patches spread over their slip displacements: the worst heat is closer than with one contact.
    ///
    /// Reference: SciPy's `least_squares` from three starts gives χ = −0.4491, β → 0, 6.78 % r.m.s. and 9.92 % of heat, 4.07 %
    /// of load.
    #[test]
    fn a_spread_field_is_fitted_as_scipy_does() {
        let patches = of_density(-0.3, 4000);
        let found = MicroslipLaw::of(&patches, Amplitudes::of(&patches));
        let MicroslipLaw {
            law,
            heat_error,
            worst_heat_error,
            worst_load_error,
            ..
        } = &found;
        for (own, of_scipy, tolerance) in [
            (law.exponent, -0.4491, 1e-3),
            (law.ratio, 0.0, 1e-4),
            (*heat_error, 0.0678, 3e-4),
            (*worst_heat_error, 0.0992, 3e-4),
            (*worst_load_error, 0.0407, 3e-4),
        ] {
            assert!(
                (own - of_scipy).abs() < tolerance,
                "{own} {of_scipy}: {found:?}"
            );
        }
        assert!(found.law.outside().is_none());
        // the law's own curve is what its functions say
        let [heat, load] = found.heat_and_load(found.amplitudes.to);
        assert!(load <= patches.slip_force() * (1.0 + 1e-12) && heat > 0.0);
    }
}
