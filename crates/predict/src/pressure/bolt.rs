//! Bolts: where they are, how thick, how tight, and the patterns that they usually come in.

use std::f64::consts::TAU;

use super::PressureError;
use crate::number::{check, not_negative, positive};

/// A bolt through the interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bolt {
    /// Coordinate of its axis along the first in-plane axis, in m.
    pub x_m: f64,
    /// Coordinate of its axis along the second in-plane axis, in m.
    pub y_m: f64,
    /// Nominal diameter, in m.
    pub diameter_m: f64,
    /// Preload, in N; not negative.
    pub preload_n: f64,
}

impl Bolt {
    /// Its place, x and y, in m.
    #[must_use]
    pub fn place_m(&self) -> [f64; 2] {
        [self.x_m, self.y_m]
    }

    /// Refuses numbers that no bolt has; `number` counts the bolts from 1.
    pub(super) fn check(&self, number: usize) -> Result<(), PressureError> {
        let of = |quantity| format!("bolt {number}: {quantity}");
        let expected = "a finite length in m";
        check(self.x_m.is_finite(), of("x"), self.x_m, "", expected)?;
        check(self.y_m.is_finite(), of("y"), self.y_m, "", expected)?;
        positive(
            of("diameter"),
            self.diameter_m,
            "",
            "a positive length in m",
        )?;
        not_negative(of("preload"), self.preload_n, "", "a force of 0 N or more")?;
        Ok(())
    }
}

/// Refuses a list that is empty or has a bolt that cannot be.
pub(super) fn check_all(bolts: &[Bolt]) -> Result<(), PressureError> {
    if bolts.is_empty() {
        return Err(PressureError::NoBolts);
    }
    (1..)
        .zip(bolts)
        .try_for_each(|(number, bolt)| bolt.check(number))
}

/// Bolts in rows about the origin: `count[0]` along x and `count[1]` along y, `pitch_m` apart (m).
///
/// Row by row from the lowest x and y, each with the diameter (m) and the preload (N) given.
///
/// # Errors
/// [`PressureError::NoBolts`] without any, [`PressureError::Number`] for numbers that no bolt has.
pub fn bolts_in_rows(
    count: [usize; 2],
    pitch_m: [f64; 2],
    diameter_m: f64,
    preload_n: f64,
) -> Result<Vec<Bolt>, PressureError> {
    let place = |place: usize, axis: usize| {
        (place as f64 - 0.5 * (count[axis].saturating_sub(1)) as f64) * pitch_m[axis]
    };
    let bolts: Vec<Bolt> = (0..count[1])
        .flat_map(|row| (0..count[0]).map(move |column| (column, row)))
        .map(|(column, row)| Bolt {
            x_m: place(column, 0),
            y_m: place(row, 1),
            diameter_m,
            preload_n,
        })
        .collect();
    check_all(&bolts)?;
    Ok(bolts)
}

/// Bolts on a circle of `radius_m` (m) about the origin, the first on the x axis, the others evenly spaced towards y.
///
/// # Errors
/// [`PressureError::NoBolts`] without any, [`PressureError::Number`] for numbers that no bolt has.
pub fn bolts_on_circle(
    count: usize,
    radius_m: f64,
    diameter_m: f64,
    preload_n: f64,
) -> Result<Vec<Bolt>, PressureError> {
    let bolts: Vec<Bolt> = (0..count)
        .map(|place| {
            let angle = TAU * place as f64 / count as f64;
            Bolt {
                x_m: radius_m * angle.cos(),
                y_m: radius_m * angle.sin(),
                diameter_m,
                preload_n,
            }
        })
        .collect();
    check_all(&bolts)?;
    Ok(bolts)
}

/// The same bolts with a preload (N) each.
///
/// # Errors
/// [`PressureError::Preloads`] if there are not as many preloads as bolts, [`PressureError::Number`] for a negative one.
pub fn with_preloads(bolts: &[Bolt], preloads_n: &[f64]) -> Result<Vec<Bolt>, PressureError> {
    if bolts.len() != preloads_n.len() {
        return Err(PressureError::Preloads {
            found: preloads_n.len(),
            bolts: bolts.len(),
        });
    }
    let bolts: Vec<Bolt> = bolts
        .iter()
        .zip(preloads_n)
        .map(|(bolt, &preload_n)| Bolt { preload_n, ..*bolt })
        .collect();
    check_all(&bolts)?;
    Ok(bolts)
}

/// The same bolts as a bending moment changes their preloads: the equivalent model of Zhao, bolts tightened unequally.
///
/// `moments_n_m` are the moments about the x and the y axis, as [`PressureField::moments_n_m`](super::PressureField::moments_n_m)
/// counts them (N·m). The changes are linear over the plane, sum to zero and have exactly these moments.
///
/// # Errors
/// [`PressureError::CannotBend`] if all bolts lie on a line about which a moment is asked for,
/// [`PressureError::BoltSlack`] if a bolt would have to push.
pub fn bolts_under_moment(
    bolts: &[Bolt],
    moments_n_m: [f64; 2],
) -> Result<Vec<Bolt>, PressureError> {
    check_all(bolts)?;
    let count = bolts.len() as f64;
    let centre = [0, 1].map(|axis| bolts.iter().map(|b| b.place_m()[axis]).sum::<f64>() / count);
    let offset = |bolt: &Bolt| [bolt.x_m - centre[0], bolt.y_m - centre[1]];
    let second = |a: usize, b: usize| {
        let products = bolts.iter().map(|bolt| offset(bolt)[a] * offset(bolt)[b]);
        products.sum::<f64>()
    };
    let (xx, xy, yy) = (second(0, 0), second(0, 1), second(1, 1));
    // ΔF_i = a ξ_i + b η_i with Σ ΔF_i ξ_i = −M_y and Σ ΔF_i η_i = M_x. For rows L_a apart with N_b bolts on each side
    // and none or others on the axis between, this is M = (L_a/2)(F' − F'') N_b of Zhao (section 3).
    let [about_x, about_y] = moments_n_m;
    let determinant = xx * yy - xy * xy;
    let [a, b] = if determinant > 1e-12 * (xx + yy).powi(2) {
        [
            (-about_y * yy - about_x * xy) / determinant,
            (about_x * xx + about_y * xy) / determinant,
        ]
    } else {
        // All bolts on one line: along it there is the only lever arm.
        let length = (xx + yy).sqrt();
        let mut direction = match xx >= yy {
            true => [xx, xy],
            false => [xy, yy],
        };
        let norm = direction[0].hypot(direction[1]);
        if norm > 0.0 {
            direction = direction.map(|part| part / norm);
        }
        let along = -about_y * direction[0] + about_x * direction[1];
        let across = about_y * direction[1] + about_x * direction[0];
        let size = about_x.hypot(about_y);
        if size > 0.0 && (norm == 0.0 || across.abs() > 1e-9 * size) {
            return Err(PressureError::CannotBend { moments_n_m });
        }
        match size > 0.0 {
            true => direction.map(|part| part * along / (length * length)),
            false => [0.0; 2],
        }
    };
    (1..)
        .zip(bolts)
        .map(|(number, bolt)| {
            let [x_m, y_m] = offset(bolt);
            let preload_n = bolt.preload_n + a * x_m + b * y_m;
            match preload_n.is_finite() && preload_n >= 0.0 {
                true => Ok(Bolt { preload_n, ..*bolt }),
                false => Err(PressureError::BoltSlack {
                    number,
                    preload_n: bolt.preload_n,
                    found_n: preload_n,
                }),
            }
        })
        .collect()
}
