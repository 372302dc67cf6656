//! The two bodies as the joint feels them: linear, so that all that is left of them is a dynamic stiffness and a load on the
//! relative motion.
//!
//! With z = k + jΩc − Ω²m of each body and DOF, z_a x_a + f = F_a and z_b x_b − f = F_b give for r = x_a − x_b
//!
//!   z r + f = p,  z = z_a z_b/(z_a + z_b),  p = (z_b F_a − z_a F_b)/(z_a + z_b),
//!
//! and back x_a = (F_a + F_b + z_b r)/(z_a + z_b), x_b = x_a − r.

use bolted_joint_dynamics::{Body, Lap};
use num_complex::Complex64;

use super::{HarmonicLoads, Side};

/// At which frequency, under how much of the harmonic loads and with how much damping taken away a lap vibrates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Circumstances {
    /// rad/s
    pub(super) omega: f64,
    /// Factor of the harmonic loads.
    pub(super) load_factor: f64,
    /// ζ of the force 2ζω M ẋ that replaces what the dampers take.
    pub(super) released: f64,
}

/// A number of one body that its dynamic stiffness depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BodyNumber {
    Inertia,
    Stiffness,
    Damping,
}

/// A quantity with its derivatives with respect to ω and to ζ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Varying {
    pub(super) value: Complex64,
    pub(super) by_omega: Complex64,
    pub(super) by_released: Complex64,
}

/// Both bodies in one DOF at one harmonic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Condensed {
    z: [Varying; 2],
    sum: Complex64,
    loads: [Complex64; 2],
    /// Share of each body's inertia, for bodies that nothing holds.
    share: [f64; 2],
    order: f64,
    at: Circumstances,
}

impl Condensed {
    pub(super) fn new<const D: usize>(
        lap: &Lap<D>,
        loads: &HarmonicLoads<D>,
        dof: usize,
        order: usize,
        at: Circumstances,
    ) -> Self {
        let loads = match order {
            0 => [loads.constant.a[dof], loads.constant.b[dof]].map(Complex64::from),
            1 => [loads.a[dof], loads.b[dof]].map(|load| load * at.load_factor),
            _ => [Complex64::ZERO; 2],
        };
        let z = [&lap.a, &lap.b].map(|body| stiffness(body, dof, order, at));
        let inertia = lap.a.inertia[dof] + lap.b.inertia[dof];
        Self {
            z,
            sum: z[0].value + z[1].value,
            loads,
            share: [lap.a.inertia[dof], lap.b.inertia[dof]].map(|own| own / inertia),
            order: order as f64,
            at,
        }
    }

    /// Whether nothing holds the pair in this DOF: at rest, without supports.
    fn is_free(&self) -> bool {
        self.order == 0.0 && self.sum == Complex64::ZERO
    }

    /// Whether a constant load would carry the pair away.
    pub(super) fn is_carried_away(&self) -> bool {
        self.is_free() && self.loads[0] + self.loads[1] != Complex64::ZERO
    }

    /// z
    pub(super) fn stiffness(&self) -> Varying {
        if self.is_free() {
            return Varying::ZERO;
        }
        let [a, b] = &self.z;
        // dz = (z_b² dz_a + z_a² dz_b)/(z_a + z_b)²
        let (of_a, of_b) = (b.value / self.sum, a.value / self.sum);
        let change = |da: Complex64, db: Complex64| of_a * of_a * da + of_b * of_b * db;
        Varying {
            value: a.value * of_a,
            by_omega: change(a.by_omega, b.by_omega),
            by_released: change(a.by_released, b.by_released),
        }
    }

    /// p
    pub(super) fn load(&self) -> Varying {
        let [of_a, of_b] = self.loads;
        if self.is_free() {
            let value = of_a * self.share[1] - of_b * self.share[0];
            return Varying {
                value,
                ..Varying::ZERO
            };
        }
        if of_a == Complex64::ZERO && of_b == Complex64::ZERO {
            return Varying::ZERO;
        }
        let [a, b] = &self.z;
        let value = (b.value * of_a - a.value * of_b) / self.sum;
        // dp = (dz_b (F_a − p) − dz_a (F_b + p))/(z_a + z_b)
        let change =
            |da: Complex64, db: Complex64| (db * (of_a - value) - da * (of_b + value)) / self.sum;
        Varying {
            value,
            by_omega: change(a.by_omega, b.by_omega),
            by_released: change(a.by_released, b.by_released),
        }
    }

    /// Derivatives of z and of p with respect to a number of one body.
    pub(super) fn by_number(&self, side: Side, number: BodyNumber) -> [Complex64; 2] {
        if self.is_free() {
            // A body that nothing holds has no support to be changed without another state of rest.
            return [Complex64::ZERO; 2];
        }
        let d = self.own_by_number(number);
        let [a, b] = [self.z[0].value, self.z[1].value];
        let p = self.load().value;
        match side {
            Side::A => {
                let share = b / self.sum;
                [share * share * d, -d * (self.loads[1] + p) / self.sum]
            }
            Side::B => {
                let share = a / self.sum;
                [share * share * d, d * (self.loads[0] - p) / self.sum]
            }
        }
    }

    /// Derivative of one body's z with respect to a number of its own.
    fn own_by_number(&self, number: BodyNumber) -> Complex64 {
        let omega = self.order * self.at.omega;
        match number {
            BodyNumber::Stiffness => Complex64::ONE,
            BodyNumber::Damping => Complex64::new(0.0, omega),
            // −Ω² − jΩ 2ζω
            BodyNumber::Inertia => -Complex64::new(
                omega * omega,
                omega * 2.0 * self.at.released * self.at.omega,
            ),
        }
    }

    /// x of a body at the relative motion r.
    pub(super) fn body(&self, side: Side, r: Complex64) -> Complex64 {
        let of_a = if self.is_free() {
            // about the resting centre of mass
            r * self.share[1]
        } else {
            (self.loads[0] + self.loads[1] + self.z[1].value * r) / self.sum
        };
        match side {
            Side::A => of_a,
            Side::B => of_a - r,
        }
    }

    /// How x of a body follows a change of r, all else as it is.
    pub(super) fn body_by_r(&self, side: Side) -> Complex64 {
        let of_a = if self.is_free() {
            self.share[1].into()
        } else {
            self.z[1].value / self.sum
        };
        match side {
            Side::A => of_a,
            Side::B => of_a - 1.0,
        }
    }

    /// How x of both bodies changes with ω at fixed r.
    pub(super) fn body_by_omega(&self, r: Complex64) -> Complex64 {
        self.body_change(self.z[0].by_omega, self.z[1].by_omega, r)
    }

    /// How x of both bodies changes with ζ at fixed r.
    pub(super) fn body_by_released(&self, r: Complex64) -> Complex64 {
        self.body_change(self.z[0].by_released, self.z[1].by_released, r)
    }

    /// How x of both bodies changes with the factor of the harmonic loads at fixed r.
    pub(super) fn body_by_factor<const D: usize>(
        &self,
        loads: &HarmonicLoads<D>,
        dof: usize,
    ) -> Complex64 {
        if self.order == 1.0 {
            (loads.a[dof] + loads.b[dof]) / self.sum
        } else {
            Complex64::ZERO
        }
    }

    /// How x of both bodies changes with a number of body `of` at fixed r.
    pub(super) fn body_by_number(&self, of: Side, number: BodyNumber, r: Complex64) -> Complex64 {
        let d = self.own_by_number(number);
        match of {
            Side::A => self.body_change(d, Complex64::ZERO, r),
            Side::B => self.body_change(Complex64::ZERO, d, r),
        }
    }

    fn body_change(&self, da: Complex64, db: Complex64, r: Complex64) -> Complex64 {
        if self.is_free() {
            return Complex64::ZERO;
        }
        // (z_a + z_b) dx_a = dz_b r − (dz_a + dz_b) x_a
        (db * r - (da + db) * self.body(Side::A, r)) / self.sum
    }
}

impl Varying {
    pub(super) const ZERO: Self = Self {
        value: Complex64::ZERO,
        by_omega: Complex64::ZERO,
        by_released: Complex64::ZERO,
    };
}

fn stiffness<const D: usize>(
    body: &Body<D>,
    dof: usize,
    order: usize,
    at: Circumstances,
) -> Varying {
    let (m, c, k) = (body.inertia[dof], body.damping[dof], body.stiffness[dof]);
    let h = order as f64;
    let omega = h * at.omega;
    // z = k + jΩ (c − 2ζω m) − Ω² m,  Ω = hω
    let damping = c - 2.0 * at.released * at.omega * m;
    Varying {
        value: Complex64::new(k - omega * omega * m, omega * damping),
        by_omega: Complex64::new(
            -2.0 * h * omega * m,
            h * damping - 2.0 * omega * at.released * m,
        ),
        by_released: Complex64::new(0.0, -2.0 * omega * at.omega * m),
    }
}
