//! The joint that the decoupling equation returns at a single line: Table 5.2, and the initial estimates of the update.

use num_complex::Complex64;

use crate::draws::{Repetition, rows};
use crate::error::ReproduceError;
use crate::outcome::Row;
use bolted_joint_frf::structure::{ComplexMatrix, Partition};
use bolted_joint_identify::{
    Equation, Inverse, JointMatrices, JointModel, Lines, Receptances, decouple,
};
use bolted_joint_respond::Pollution;

use super::bolts::{Bolt, Bolts, LEVEL};
use super::structures;
use super::update::noisy;

/// An error of phase that a measurement may well have near a resonance.
const LATE_DEG: f64 = 5.0;

/// Table 5.2: what the decoupling equation returns at 112.5 and 344 Hz.
pub(crate) fn table_5_2(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let lines = Bolts::published()?.m10x16.lines()?;
    let noise = Pollution::Frf { level: LEVEL }.checked()?;
    let mut found = Vec::new();
    for (hz, published) in [
        (112.5, [2.48e4, 4.24e3, 1.31e3, 0.0, 0.43, 0.28]),
        (344.0, [1.71e5, -7.68e3, 7.91e2, 10.8, -0.84, 0.05]),
    ] {
        let line = nearest(&lines.frequency_hz, hz);
        let middle: Vec<_> = at_line(&structures::measured_at(&lines, &[1]), line)
            .into_iter()
            .collect();
        let case = format!("{hz} Hz, no noise, 2s");
        found.extend(rows(&case, JointModel::Full, None, &published, &middle));
        let middle: Vec<_> = at_line(&with_late_a(&structures::measured_at(&lines, &[1])), line)
            .into_iter()
            .collect();
        let case = format!("{hz} Hz, no noise, 2s, phase of A 5° late");
        found.extend(rows(&case, JointModel::Full, None, &published, &middle));
        let joints = draws.joints(|generator| at_line(&noisy(&lines, &noise, generator), line));
        let case = format!("{hz} Hz, 1 % noise, 1s–3s");
        found.extend(rows(&case, JointModel::Full, None, &published, &joints));
    }
    Ok(found)
}

impl Bolt {
    pub(super) fn initial_estimates(
        &self,
        lines: &Lines,
        used: &Lines,
        modes: &[f64],
        draws: Repetition<'_>,
    ) -> Result<Vec<Row>, ReproduceError> {
        let [Some(second), Some(third)] = [1, 2].map(|mode| {
            let hz = modes.get(mode)?;
            Some(nearest(&lines.frequency_hz, *hz))
        }) else {
            return Ok(Vec::new());
        };
        let estimate = |lines: &Lines| -> Option<JointMatrices> {
            let second = at_line(lines, second)?;
            let mut joint = at_line(lines, third)?;
            joint.stiffness[(1, 1)] = second.stiffness[(1, 1)];
            joint.damping[(1, 1)] = second.damping[(1, 1)];
            Some(joint)
        };
        let middle: Vec<JointMatrices> = estimate(&structures::measured_at(lines, &[1]))
            .into_iter()
            .collect();
        let mut found = rows(
            "initial, no noise, 2s",
            JointModel::Full,
            None,
            &self.initial,
            &middle,
        );
        let noise = Pollution::Frf { level: LEVEL }.checked()?;
        let joints = draws.joints(|generator| estimate(&noisy(used, &noise, generator)));
        let case = if self.used.len() == 3 {
            "initial, 1 % noise, 1s–3s"
        } else {
            "initial, 1 % noise, 2s"
        };
        found.extend(rows(case, JointModel::Full, None, &self.initial, &joints));
        Ok(found)
    }
}

/// The same lines with the receptances of A later in phase.
fn with_late_a(lines: &Lines) -> Lines {
    let late = Complex64::from_polar(1.0, -LATE_DEG.to_radians());
    let a = (0..lines.frequency_hz.len())
        .map(|line| &*lines.a.at(line) * late)
        .collect();
    Lines {
        a: Receptances::Exact(a),
        ..lines.clone()
    }
}

/// The joint that (3.21) with the inverse as printed returns at one line.
fn at_line(lines: &Lines, line: usize) -> Option<JointMatrices> {
    let a = Partition {
        joint: lines.a.at(line).into_owned(),
        joint_points: ComplexMatrix::zeros(2, 0),
        points_joint: ComplexMatrix::zeros(0, 2),
        points: ComplexMatrix::zeros(0, 0),
    };
    let stiffness = decouple(
        Equation::Ss,
        Inverse::AsPrinted,
        &a,
        &lines.b_at(line),
        &lines.assembly[line],
    )?;
    let omega = std::f64::consts::TAU * lines.frequency_hz[line];
    let symmetric = (&stiffness + stiffness.transpose()).map(|value| 0.5 * value);
    Some(JointMatrices {
        stiffness: symmetric.map(|value| value.re),
        damping: symmetric.map(|value| value.im / omega),
    })
}

fn nearest(frequency_hz: &[f64], hz: f64) -> usize {
    let distance = |line: &usize| (frequency_hz[*line] - hz).abs();
    (0..frequency_hz.len())
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0)
}
