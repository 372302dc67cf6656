//! The lap joint that stands for one mode of the beam: body a is the mode, body b its mount, the joint between them bends and
//! slips.

use bolted_joint_joint::Body;

use super::damping::SlipDamping;
use super::dry_friction::{AmplitudeRange, DrySlider};
use super::error::LayeredBeamError;

/// Mass of the mount over the mode's: large, so that the mount stays where it is.
const MOUNT_MASS: f64 = 1000.0;

/// Natural frequency of the mount over the mode's: well above, and not so far that steps in time get short.
const MOUNT_FREQUENCY: f64 = 3.0;

/// Damping ratio of the mount, so that it comes to rest by itself.
const MOUNT_DAMPING: f64 = 0.01;

/// How the damping goes into the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EquivalentDamping {
    /// A viscous damper that is right at one amplitude of the drive point, m.
    AtAmplitude(f64),
    /// A slider, over a range of amplitudes of the drive point.
    Over(AmplitudeRange),
}

/// A lap whose second body hardly moves, and one of whose modes is that of the beam: same frequency, same modal mass and
/// stiffness at the drive point (body a), same damping.
#[derive(Clone, Debug, PartialEq)]
pub struct EquivalentLap {
    /// Body a: kg, N/m, N·s/m. The joint alone holds it.
    pub a: Body,
    /// Body b.
    pub b: Body,
    /// Stiffness of the joint, N/m.
    pub stiffness_n_per_m: f64,
    /// x_b/x_a in the mode.
    pub mount_share: f64,
    /// What the mount's damper adds to that of the mode at body a, N·s/m.
    mount_damping_n_s_per_m: f64,
}

impl EquivalentLap {
    /// The lap of a mode.
    #[must_use]
    pub fn of(damping: &SlipDamping) -> Self {
        let mode = &damping.mode;
        let squared = mode.angular_frequency.powi(2);
        let mount_mass = MOUNT_MASS * mode.mass_kg;
        let mount_omega = MOUNT_FREQUENCY * mode.angular_frequency;
        let mount_stiffness = mount_mass * mount_omega.powi(2);
        // With r = x_b/x_a the mode asks for
        //   k₁₂(1 − r) = ω² m_a,  k₁₂(1 − r) = (k_b − ω² m_b) r,  m_a + m_b r² = m,
        // so that ω² m_b r² + (k_b − ω² m_b) r − ω² m = 0; the smaller root, without cancellation
        let (quadratic, linear) = (squared * mount_mass, mount_stiffness - squared * mount_mass);
        let constant = squared * mode.mass_kg;
        let root = (linear * linear + 4.0 * quadratic * constant).sqrt();
        let share = 2.0 * constant / (linear + root);
        let mass = mode.mass_kg - mount_mass * share * share;
        let mount_damping = 2.0 * MOUNT_DAMPING * mount_omega * mount_mass;
        let body = |inertia: f64, stiffness: f64, damping: f64| Body {
            inertia: vec![inertia],
            stiffness: vec![stiffness],
            damping: vec![damping],
        };
        Self {
            a: body(mass, 0.0, 0.0),
            b: body(mount_mass, mount_stiffness, mount_damping),
            stiffness_n_per_m: squared * mass / (1.0 - share),
            mount_share: share,
            mount_damping_n_s_per_m: mount_damping * share * share,
        }
    }

    /// Damper of the joint with which the mode has the damper `at_drive_point` (N·s/m) at body a; not less than none.
    #[must_use]
    pub fn joint_damping_n_s_per_m(&self, at_drive_point: f64) -> f64 {
        // c = c₁₂ (1 − r)² + c_b r²
        let own = (at_drive_point - self.mount_damping_n_s_per_m).max(0.0);
        own / (1.0 - self.mount_share).powi(2)
    }

    /// The joint's slider, with which the mode has the heat of dry friction over `range`, amplitudes of the drive point.
    ///
    /// # Errors
    /// None of a valid range.
    pub fn slider_over(
        &self,
        damping: &SlipDamping,
        range: &AmplitudeRange,
    ) -> Result<DrySlider, LayeredBeamError> {
        let (from, to) = (self.relative(range.from_m()), self.relative(range.to_m()));
        let relative = AmplitudeRange::new("motion.amplitude", from, to)?;
        // c_eq R is the same at every amplitude; all of it is the joint's, or else it would not be in proportion to the torque
        let at_largest = damping.viscous_damping_n_s_per_m(range.to_m());
        let coulomb = at_largest / (1.0 - self.mount_share).powi(2) * to;
        let omega = damping.mode.angular_frequency;
        Ok(DrySlider::following(coulomb, omega, &relative))
    }

    /// Relative motion of the joint for a motion of the drive point.
    #[must_use]
    pub fn relative(&self, at_drive_point: f64) -> f64 {
        // r = x_a − x_b = (1 − x_b/x_a) x_a
        (1.0 - self.mount_share) * at_drive_point
    }

    /// Damping ratio of the mode where the joint's damper is `c` (N·s/m).
    #[must_use]
    pub fn damping_ratio(&self, damping: &SlipDamping, c: f64) -> f64 {
        let mode = &damping.mode;
        let at_drive_point = c * (1.0 - self.mount_share).powi(2) + self.mount_damping_n_s_per_m;
        0.5 * at_drive_point / (mode.angular_frequency * mode.mass_kg)
    }
}
