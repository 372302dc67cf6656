//! Patches side by side that slip, each by Mindlin's law.

/// A patch of an interface as it resists one relative motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Stiffness of the patch before anything slips: N/m, N·m/rad.
    pub stiffness: f64,
    /// Load at which all of it slips: N, N·m.
    pub slip_force: f64,
}

/// All patches that resist one relative motion of an interface, each with a stiffness and a slip force above zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Patches {
    all: Vec<Patch>,
    stiffness: f64,
    slip_force: f64,
}

impl Patches {
    /// Those of these patches that resist; `None` where none does.
    #[must_use]
    pub fn new(patches: impl Iterator<Item = Patch>) -> Option<Self> {
        let resists = |patch: &Patch| patch.stiffness > 0.0 && patch.slip_force > 0.0;
        let all: Vec<Patch> = patches.filter(resists).collect();
        (!all.is_empty()).then(|| Self {
            stiffness: all.iter().map(|patch| patch.stiffness).sum(),
            slip_force: all.iter().map(|patch| patch.slip_force).sum(),
            all,
        })
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// Stiffness while all stick: N/m, N·m/rad.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Load at which all slip, μ times the load that presses the interface together where it translates: N, N·m.
    #[must_use]
    pub fn slip_force(&self) -> f64 {
        self.slip_force
    }

    /// Largest displacement at which a patch begins to slip through: m, rad.
    #[must_use]
    pub fn slips_through_at(&self) -> f64 {
        let ends = self.all.iter().map(Patch::slips_through_at);
        ends.fold(0.0, f64::max)
    }

    /// Load of the first loading to a displacement of zero or more: N, N·m.
    #[must_use]
    pub fn load(&self, displacement: f64) -> f64 {
        self.all.iter().map(|patch| patch.load(displacement)).sum()
    }

    /// Heat of a cycle between ± an amplitude, J.
    #[must_use]
    pub fn cycle_heat(&self, amplitude: f64) -> f64 {
        let patches = self.all.iter();
        patches.map(|patch| patch.cycle_heat(amplitude)).sum()
    }
}

impl Patch {
    /// Displacement from which it slips as a whole: m, rad.
    fn slips_through_at(&self) -> f64 {
        // δ = 3μP/(2k), where dT/du = k (1 − T/(μP))^(1/3) (Zhao (22)) has come to T = μP
        1.5 * self.slip_force / self.stiffness
    }

    /// c = √(1 − u/δ), what of its displacement is left before it slips through.
    fn rest(&self, displacement: f64) -> f64 {
        (1.0 - displacement / self.slips_through_at())
            .max(0.0)
            .sqrt()
    }

    fn load(&self, displacement: f64) -> f64 {
        // T = μP (1 − (1 − u/δ)^(3/2)), with 1 − c³ = (1 − c²)(1 + c + c²)/(1 + c)
        let c = self.rest(displacement);
        let slipped = (displacement / self.slips_through_at()).min(1.0);
        self.slip_force * slipped * (1.0 + c + c * c) / (1.0 + c)
    }

    fn cycle_heat(&self, amplitude: f64) -> f64 {
        // By Masing's rule D = 8∫₀^U T du − 4 U T(U) = (4/5) μP δ (1 − c)³ (1 + 3c + c²), and 4μP more for each length beyond δ;
        // 1 − c = (u/δ)/(1 + c)
        let end = self.slips_through_at();
        let c = self.rest(amplitude);
        let gone = (amplitude / end).min(1.0) / (1.0 + c);
        let microslip = 0.8 * end * gone.powi(3) * (1.0 + c * (3.0 + c));
        self.slip_force * (microslip + 4.0 * (amplitude - end).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fractal::StoredEnergy;

    const PATCH: Patch = Patch {
        stiffness: 3e8,
        slip_force: 250.0,
    };

    fn one() -> Patches {
        Patches::new([PATCH].into_iter()).unwrap()
    }

    /// The slope of the load is k (1 − T/(μP))^(1/3), from k to zero.
    #[test]
    fn the_tangent_is_mindlins() {
        let (patch, end) = (one(), PATCH.slips_through_at());
        let step = 1e-6 * end;
        for part in [0.01, 0.2, 0.5, 0.9, 0.99] {
            let u = part * end;
            let slope = (patch.load(u + step) - patch.load(u - step)) / (2.0 * step);
            let expected = 3e8 * (1.0 - patch.load(u) / 250.0).cbrt();
            assert!((slope / expected - 1.0).abs() < 1e-6, "{part}");
        }
        assert_eq!(patch.load(3.0 * end), 250.0);
        assert!((patch.load(1e-9 * end) / (3e-1 * end) - 1.0).abs() < 1e-8);
    }

    /// The heat is Masing's, by quadrature of the load, before and after it slips through.
    #[test]
    fn the_heat_is_that_of_the_loop() {
        let (patch, end) = (one(), PATCH.slips_through_at());
        for part in [0.1, 0.7, 1.0, 1.8] {
            let amplitude = part * end;
            let count = 200_000;
            let width = amplitude / f64::from(count);
            let middle = |k: i32| patch.load((f64::from(k) + 0.5) * width);
            let area: f64 = (0..count).map(middle).sum::<f64>() * width;
            let expected = 8.0 * area - 4.0 * amplitude * patch.load(amplitude);
            let found = patch.cycle_heat(amplitude);
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{part}: {found} {expected}"
            );
        }
    }

    /// The published loss of a cycle between ±T over the energy of one loading, by its loss factor with m = 1:
    /// η = W_d/(W − W_d). A loading takes up ∫ T du.
    #[test]
    fn heat_over_energy_is_the_published_ratio() {
        let (patch, end) = (one(), PATCH.slips_through_at());
        for q in [0.05_f64, 0.3, 0.8] {
            // u/δ = 1 − (1 − q)^(2/3)
            let part = 1.0 - (1.0 - q).powf(2.0 / 3.0);
            let amplitude = part * end;
            assert!((patch.load(amplitude) / 250.0 - q).abs() < 1e-12);
            // ∫ T du = μPδ (s − (2/5)(1 − (1 − s)^(5/2)))
            let energy = 250.0 * end * (part - 0.4 * (1.0 - (1.0 - part).powf(2.5)));
            let ratio = patch.cycle_heat(amplitude) / energy;
            let expected = StoredEnergy::OneLoading.loss_factor(q).unwrap();
            let found = ratio / (1.0 - ratio);
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{q}: {found} {expected}"
            );
        }
    }

    #[test]
    fn what_does_not_resist_is_no_patch() {
        let nothing = Patch {
            stiffness: 0.0,
            slip_force: 3.0,
        };
        assert_eq!(Patches::new([nothing].into_iter()), None);
        assert_eq!(Patches::new([nothing, PATCH].into_iter()), Some(one()));
    }
}
