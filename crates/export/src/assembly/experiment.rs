//! What a simulation of an assembly should start with.

use std::f64::consts::TAU;

use bolted_joint_assembly::AssemblyModel;
use bolted_joint_dynamics::assembly::Assembly;

use super::super::step::Experiment;

/// Communication steps in a period of the highest mode: the steps are right at any length, but the loads are held over them.
const STEPS_A_PERIOD: f64 = 10.0;
/// Periods of the slowest mode, and the most steps.
const PERIODS: f64 = 20.0;
const MOST_STEPS: f64 = 1e5;
/// Frequency (Hz) of what has no modes.
const WITHOUT_MODES_HZ: f64 = 100.0;

/// Steps and stop time as decimal numbers of which one divides the other.
pub(super) fn suggested(model: &AssemblyModel, assembly: &Assembly) -> Experiment {
    let mut kept = Vec::new();
    let mut first = 0;
    for structure in &model.structures {
        let modes = first..first + structure.form.modes;
        let own = modes.filter_map(|mode| assembly.frequencies_rad_per_s.get(mode).copied());
        kept.extend(own.filter(|&omega| omega > 0.0).map(|omega| omega / TAU));
        first += structure.form.size();
    }
    let fastest = kept
        .iter()
        .copied()
        .reduce(f64::max)
        .unwrap_or(WITHOUT_MODES_HZ);
    let slowest = kept
        .iter()
        .copied()
        .reduce(f64::min)
        .unwrap_or(WITHOUT_MODES_HZ);
    let step_s = round(1.0 / (STEPS_A_PERIOD * fastest));
    let stop_s = round((PERIODS / slowest).min(MOST_STEPS * step_s));
    Experiment {
        // of 1, 2 and 5 times powers of ten the larger is a multiple of the smaller, unless they are 5 and 2 times the same one
        stop_s: if stop_s / step_s < 10.0 {
            10.0 * step_s
        } else {
            stop_s
        },
        communication_step_s: step_s,
    }
}

/// 1, 2 or 5 times a power of ten, not above `value`.
fn round(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let mantissa = value / 10.0_f64.powi(exponent) * (1.0 + 1e-12);
    let digit = if mantissa >= 5.0 {
        5
    } else if mantissa >= 2.0 {
        2
    } else {
        1
    };
    format!("{digit}e{exponent}").parse().unwrap_or(value)
}
