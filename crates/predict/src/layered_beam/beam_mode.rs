//! One mode of a layered beam as seen from its drive point, from the frequency equations or from finite elements.

use std::f64::consts::TAU;
use std::num::NonZeroU16;

use serde::{Deserialize, Serialize};

use bolted_joint_frf::structure::{BeamPoint, Motion};

use super::beam::LayeredBeam;
use super::error::{LayeredBeamError, value};
use super::fasteners::Fasteners;

/// Finite elements over the length of a beam: the fifth mode's frequency is then right to 10⁻⁵.
pub const ELEMENTS: NonZeroU16 = match NonZeroU16::new(60) {
    Some(elements) => elements,
    None => NonZeroU16::MIN,
};

/// Highest mode that is computed.
pub(super) const HIGHEST_MODE: usize = 100;

/// A drive point that a mode moves by less than this part of its largest deflection is a node.
const NODE: f64 = 1e-3;

/// A sum of slopes of the exact shape of less than this over the length is rounding: every fastener is where the mode has no
/// slope. The shape by finite elements has more rounding, and is not asked.
const NO_SLOPE: f64 = 1e-9;

/// Where a mode comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Route {
    /// The frequency equation and the exact shape (Kavi chapter 3).
    #[default]
    Classical,
    /// Euler–Bernoulli elements (Kavi chapter 4).
    FiniteElements,
}

/// What the damping ratio's stored energy is taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StoredEnergy {
    /// ½ dᵀKd: the strain energy of the mode.
    #[default]
    Modal,
    /// ½ k w²: the strain energy of the deflection under a static load at the drive point (Kavi 3.39).
    Static,
}

/// A mode, with its quantities referred to the deflection at the drive point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BeamMode {
    /// Its number, counted from one, rigid-body modes left out.
    pub number: usize,
    /// The drive point, from the first end, m.
    pub drive_point_m: f64,
    /// ω, rad/s.
    pub angular_frequency: f64,
    /// Modal mass, kg.
    pub mass_kg: f64,
    /// k of the stored energy ½ k w², N/m: the modal stiffness ω² m, or the static stiffness.
    pub stiffness_n_per_m: f64,
    /// |∂w/∂x| at each fastener for a unit deflection of the drive point, 1/m.
    pub slopes_per_m: Vec<f64>,
}

impl BeamMode {
    /// Elastic mode `number` of a beam at `drive_point_m`, or where its deflection is largest.
    ///
    /// # Errors
    /// There is no such mode, the drive point is off the beam or a node, or a beam that is held nowhere should have a static
    /// stiffness.
    pub fn new(
        beam: &LayeredBeam,
        fasteners: &Fasteners,
        number: usize,
        drive_point_m: Option<f64>,
        route: Route,
        stored: StoredEnergy,
    ) -> Result<Self, LayeredBeamError> {
        if !(1..=HIGHEST_MODE).contains(&number) {
            let expected = format!("1 to {HIGHEST_MODE}");
            return Err(value("motion.mode", number, expected));
        }
        fasteners.check_on(beam)?;
        let drive_point_m = drive_point(beam, number, drive_point_m)?;
        let exact = classical(beam, fasteners, number, drive_point_m);
        let has_slope = exact.2.iter().sum::<f64>() * beam.length_m() > NO_SLOPE;
        let (angular_frequency, mass_kg, mut slopes_per_m) = match route {
            Route::Classical => exact,
            Route::FiniteElements => finite_elements(beam, fasteners, number, drive_point_m)?,
        };
        if !has_slope {
            slopes_per_m.fill(0.0);
        }
        let stiffness_n_per_m = match stored {
            // dᵀKd = ω² dᵀMd
            StoredEnergy::Modal => angular_frequency.powi(2) * mass_kg,
            StoredEnergy::Static => {
                beam.static_stiffness_n_per_m(drive_point_m)
                    .ok_or_else(|| {
                        let found = "\"static\" for a beam that is held nowhere";
                        value("motion.stored_energy", found, "\"modal\"")
                    })?
            }
        };
        Ok(Self {
            number,
            drive_point_m,
            angular_frequency,
            mass_kg,
            stiffness_n_per_m,
            slopes_per_m,
        })
    }

    /// Y/w, 1/m: sum of |∂w/∂x| over the fasteners for a unit deflection of the drive point.
    #[must_use]
    pub fn slope_sum_per_m(&self) -> f64 {
        self.slopes_per_m.iter().sum()
    }

    /// Refuses a mode without a slope at any fastener.
    ///
    /// # Errors
    /// [`LayeredBeamError::Value`]
    pub fn check_slip(&self) -> Result<(), LayeredBeamError> {
        if self.slope_sum_per_m() > 0.0 {
            Ok(())
        } else {
            Err(value(
                "fasteners.positions",
                format_args!("no fastener where mode {} has a slope", self.number),
                "one: without slip there is no damping to compute or to calibrate",
            ))
        }
    }

    /// Natural frequency, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.angular_frequency / TAU
    }

    /// Modal stiffness ω² m, N/m, whatever the stored energy is taken from.
    #[must_use]
    pub fn modal_stiffness_n_per_m(&self) -> f64 {
        self.angular_frequency.powi(2) * self.mass_kg
    }
}

fn drive_point(
    beam: &LayeredBeam,
    number: usize,
    given_m: Option<f64>,
) -> Result<f64, LayeredBeamError> {
    let length_m = beam.length_m();
    let shape = beam.shape(number);
    let antinode = shape.antinode();
    let Some(x_m) = given_m else {
        return Ok(antinode * length_m);
    };
    if !(0.0..=length_m).contains(&x_m) {
        let expected = format!("0 to {length_m} m");
        return Err(value(
            "motion.drive_point",
            format_args!("{x_m} m"),
            expected,
        ));
    }
    let share = (shape.deflection(x_m / length_m) / shape.deflection(antinode)).abs();
    if share < NODE {
        let antinode_m = antinode * length_m;
        return Err(value(
            "motion.drive_point",
            format_args!(
                "{x_m} m, where mode {number} moves by {share:.1e} of its largest deflection"
            ),
            format_args!("a point that it moves, such as {antinode_m:.4} m"),
        ));
    }
    Ok(x_m)
}

/// ω, modal mass and slopes by the exact shape.
fn classical(
    beam: &LayeredBeam,
    fasteners: &Fasteners,
    number: usize,
    drive_point_m: f64,
) -> (f64, f64, Vec<f64>) {
    let length = beam.length_m();
    let shape = beam.shape(number);
    let at_drive = shape.deflection(drive_point_m / length);
    // m = ρA ∫φ² dx/φ(x_d)² with ∫φ² dx = L
    let mass = beam.mass_per_length_kg_per_m() * length / at_drive.powi(2);
    // Y/w = Σ |φ′(x_i)|/|φ(x_d)|   (Kavi 3.31 without the absolute values: there the two halves of a symmetric mode cancel)
    let slope = |x: &f64| (shape.slope(x / length) / (length * at_drive)).abs();
    let slopes = fasteners.positions_m().iter().map(slope);
    (beam.angular_frequency(number), mass, slopes.collect())
}

/// The same by finite elements, the fasteners and the drive point being nodes (Kavi 4.28, 4.29, 4.31).
fn finite_elements(
    beam: &LayeredBeam,
    fasteners: &Fasteners,
    number: usize,
    drive_point_m: f64,
) -> Result<(f64, f64, Vec<f64>), LayeredBeamError> {
    let slopes = fasteners
        .positions_m()
        .iter()
        .map(|&x| (x, Motion::Rotation));
    let points = std::iter::once((drive_point_m, Motion::Translation)).chain(slopes);
    let points: Vec<BeamPoint> = points
        .map(|(position_m, motion)| BeamPoint { position_m, motion })
        .collect();
    let modes = beam.equivalent().modes_at(&points, elements_for(number))?;
    let rigid = modes
        .angular_frequency
        .iter()
        .filter(|&&omega| omega == 0.0);
    let column = rigid.count() + number - 1;
    let at_drive = modes.amplitudes[(0, column)];
    let shape = modes.amplitudes.column(column);
    let slopes = shape.iter().skip(1);
    let slopes = slopes.map(|slope| (slope / at_drive).abs()).collect();
    // dᵀMd = 1 for the mode itself, 1/φ(x_d)² for a unit deflection of the drive point
    let mass = at_drive.powi(-2);
    Ok((modes.angular_frequency[column], mass, slopes))
}

/// As many elements as a mode needs: twelve a half wave, and never less than [`ELEMENTS`].
fn elements_for(number: usize) -> NonZeroU16 {
    let wanted = u16::try_from(12 * number).ok().and_then(NonZeroU16::new);
    wanted.unwrap_or(ELEMENTS).max(ELEMENTS)
}
