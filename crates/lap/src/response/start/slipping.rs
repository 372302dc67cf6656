//! Where the search of a law that slips starts: it makes all or a part of the loss that is there at the largest amplitude, and slips
//! through beyond it, near it, or far below it.

use super::super::fit::Data;
use super::super::model::{Model, ResponseUnknown, Values};
use super::super::slider::{Slider, SliderValues};

/// Shares of the loss that a law makes; a damper keeps the rest.
const SHARES: [f64; 2] = [0.9, 0.4];
/// Least loss beside the stiffness.
const LEAST_LOSS: f64 = 1e-4;
/// Displacements at which one slider slips, in parts of the largest amplitude.
const SLIPS_AT: [f64; 4] = [0.5, 0.1, 0.9, 0.02];
/// Exponents of micro-slip.
const EXPONENTS: [f64; 3] = [-0.2, -0.6, 0.3];
/// Exponents of Iwan's law, and where it slips through in parts of the largest amplitude.
const PLACES: [(f64, f64); 6] = [
    (-0.3, 1.5),
    (-0.6, 1.5),
    (-0.3, 0.5),
    (0.2, 0.8),
    (-0.3, 0.15),
    (-0.3, 0.05),
];
/// β of Iwan's law.
const RATIO: f64 = 0.3;

/// The starts, each with laws beside its spring, and the place of the law among those that are tried.
pub(super) fn with_slider(
    model: &Model,
    data: Data<'_>,
    slider: Slider,
    starts: &[Values],
) -> Vec<(usize, Values)> {
    let Some((reference_m, loss)) = largest(model, data, starts) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for start in starts {
        for share in SHARES {
            for (place, law) in laws(slider, share * loss, reference_m)
                .into_iter()
                .enumerate()
            {
                let mut own = *start;
                if model.unknowns.contains(&ResponseUnknown::JointDamping) {
                    own.joint_damping *= 1.0 - share;
                }
                // the joint has at least the stiffness of the law, as long as the search has not found it
                let is_within = law.stiffness() < own.joint_stiffness;
                own.slider = Some(law);
                all.extend(is_within.then_some((place, own)));
            }
        }
    }
    all
}

/// The largest amplitude of the relative motion, m, and ω C there, N/m.
fn largest(model: &Model, data: Data<'_>, starts: &[Values]) -> Option<(f64, f64)> {
    let first = starts.first()?;
    let of_lines = data.lines.iter().map(|line| {
        let by_relative = line.displacement_m / model.relative_share().abs();
        let amplitude = match model.sees_sum() {
            true => model.relative_amplitude(first, line),
            false => by_relative,
        };
        (amplitude, line.omega, first.relative_damping())
    });
    // C = 2ζωM of the relative mode, M = m/2
    let of_backbone = data.points().map(|line| {
        let ratio = line.damping_ratio.unwrap_or(0.0);
        let damping = ratio * line.omega * first.mass;
        (
            line.amplitude_m,
            line.omega,
            damping.max(first.relative_damping()),
        )
    });
    let all = of_lines.chain(of_backbone);
    let (reference_m, omega, damping) = all.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let loss = (omega * damping).max(LEAST_LOSS * first.joint_stiffness.abs());
    Some((reference_m, loss))
}

/// Laws with this loss D/(πU²), N/m, at the amplitude.
fn laws(slider: Slider, loss: f64, reference_m: f64) -> Vec<SliderValues> {
    let unit = |exponent: f64, span: f64| {
        let rest = [span, RATIO];
        move |lost: f64| SliderValues::iwan(slider, lost, exponent, rest, reference_m)
    };
    // of a law whose loads are all in proportion to one stiffness
    let scaled = |of: &dyn Fn(f64) -> SliderValues| {
        let of_one = of(1.0).closed_loops().at(reference_m).value.im;
        of(loss / of_one)
    };
    match slider {
        Slider::Jenkins => SLIPS_AT
            .map(|part| {
                scaled(&|stiffness| {
                    SliderValues::jenkins(stiffness, part * stiffness * reference_m, reference_m)
                })
            })
            .to_vec(),
        Slider::MicroSlip => EXPONENTS.map(|own| scaled(&unit(own, 1.0))).to_vec(),
        Slider::Iwan => PLACES
            .map(|(exponent, span)| scaled(&unit(exponent, span)))
            .to_vec(),
    }
}
