//! What the values of a run say about the FMU: energy balance, load law, derivatives.

use super::balance::{BalanceReport, Integral};
use super::excitation::Excitation;
use super::names::{References, Sample};
use bolted_joint_export::Interface;
use bolted_joint_joint::Joint;

/// Agreement that is asked of loads and derivatives, by the sum of the magnitudes of their terms.
const SAME: f64 = 1e-12;
/// Rounding errors in the balance, by its largest energy.
const ROUNDING: f64 = 1e-12;

/// Balance of a run with `steps` steps in a span, its tolerance from the quadrature alone.
pub(super) fn balance(
    excitation: &Excitation,
    samples: &[Sample<'_>],
    steps: usize,
) -> Option<BalanceReport> {
    let (first, last) = (samples.first()?, samples.last()?);
    let step_s = excitation.span_s / steps as f64;
    let power: Vec<f64> = samples.iter().map(|sample| sample.power_w).collect();
    let heat = Integral::of(&power, step_s);
    let (work, gross) = match excitation.interface {
        Interface::Lap => work_of_held_loads(excitation, samples, steps),
        Interface::Element => {
            let power_in: Vec<f64> = samples.iter().map(power_put_in).collect();
            let magnitude: Vec<f64> = power_in.iter().map(|power| power.abs()).collect();
            (
                Integral::of(&power_in, step_s),
                Integral::of(&magnitude, step_s).value,
            )
        }
    };
    let peak_j = samples
        .iter()
        .fold(0.0_f64, |peak, sample| peak.max(sample.energy_j.abs()));
    let scale_j = peak_j.max(gross);
    Some(BalanceReport {
        work_j: work.value,
        stored_j: last.energy_j - first.energy_j,
        dissipated_j: heat.value,
        scale_j,
        tolerance_j: heat.error + work.error + ROUNDING * scale_j,
    })
}

/// W = Σ F·Δx, exact as the loads are held over each span; with the sum of the magnitudes.
fn work_of_held_loads(
    excitation: &Excitation,
    samples: &[Sample<'_>],
    steps: usize,
) -> (Integral, f64) {
    let (mut work, mut gross) = (0.0, 0.0);
    let ends: Vec<&Sample<'_>> = samples.iter().step_by(steps).collect();
    for (span, pair) in ends.windows(2).enumerate() {
        for (i, load) in excitation.loads(span).iter().enumerate() {
            let part = load * (pair[1].displacements[i] - pair[0].displacements[i]);
            work += part;
            gross += part.abs();
        }
    }
    let exact = Integral {
        value: work,
        error: 0.0,
    };
    (exact, gross)
}

/// P = −Σ F·ẋ: what the sides put in is the opposite of what the joint's loads do to them.
fn power_put_in(sample: &Sample<'_>) -> f64 {
    let each = sample.loads.iter().zip(sample.velocities);
    -each.map(|(load, velocity)| load * velocity).sum::<f64>()
}

/// The finer run's balance; the difference from the coarser one tells what the FMU's own integration is off.
pub(super) fn refined(coarse: &BalanceReport, fine: &BalanceReport) -> BalanceReport {
    let difference = (coarse.work_j - fine.work_j).abs()
        + (coarse.stored_j - fine.stored_j).abs()
        + (coarse.dissipated_j - fine.dissipated_j).abs();
    BalanceReport {
        tolerance_j: fine.tolerance_j + difference,
        ..*fine
    }
}

/// The first sample that is not finite or whose loads are not those of the joint file.
pub(super) fn load_finding(
    joint: &Joint,
    interface: Interface,
    samples: &[Sample<'_>],
) -> Option<String> {
    for (index, sample) in samples.iter().enumerate() {
        let all = [
            sample.displacements,
            sample.velocities,
            sample.loads,
            sample.joint,
            &[sample.energy_j, sample.power_w],
        ];
        if all.concat().iter().any(|value| !value.is_finite()) {
            return Some(format!(
                "run: found an output that is not finite at communication point {index}"
            ));
        }
        for (i, (expected, size)) in expected_loads(joint, sample).into_iter().enumerate() {
            let name = ["F", "M"][i.min(1)];
            let dofs = sample.joint.len();
            let mut found = vec![("joint", sample.joint[i])];
            if interface == Interface::Element {
                found.extend([("b", sample.loads[dofs + i]), ("-a", -sample.loads[i])]);
            }
            for (side, found) in found {
                if (found - expected).abs() > SAME * size {
                    return Some(format!(
                        "run: found {side}.{name} = {found:?} at communication point {index}, expected {expected:?} from \
                         resources/joint.json at that motion"
                    ));
                }
            }
        }
    }
    None
}

/// Load on b by the joint file, and the sum of the magnitudes of its terms.
fn expected_loads(joint: &Joint, sample: &Sample<'_>) -> Vec<(f64, f64)> {
    let dofs = sample.joint.len();
    let relative =
        |values: &[f64]| -> Vec<f64> { (0..dofs).map(|i| values[i] - values[dofs + i]).collect() };
    let (r, v) = (relative(sample.displacements), relative(sample.velocities));
    (0..dofs)
        .map(|i| {
            // F = K r + C ṙ + k3 r³ + k5 r⁵ + k7 r⁷ + (c2 r² + c4 r⁴) ṙ
            let [k3, k5, k7, c2, c4] = nonlinear_terms(joint, i);
            let (x, rate) = (r[i], v[i]);
            let terms = [
                k3 * x.powi(3),
                k5 * x.powi(5),
                k7 * x.powi(7),
                c2 * x.powi(2) * rate,
                c4 * x.powi(4) * rate,
            ];
            let linear =
                (0..dofs).flat_map(|j| [joint.stiffness[i][j] * r[j], joint.damping[i][j] * v[j]]);
            terms
                .into_iter()
                .chain(linear)
                .fold((0.0, 0.0), |(sum, size): (f64, f64), term| {
                    (sum + term, size + term.abs())
                })
        })
        .collect()
}

/// k3, k5, k7, c2 and c4 of a DOF.
fn nonlinear_terms(joint: &Joint, i: usize) -> [f64; 5] {
    let of = |list: &[f64]| list.get(i).copied().unwrap_or(0.0);
    let higher = joint.higher.clone().unwrap_or_default();
    [
        of(&joint.cubic),
        of(&higher.quintic),
        of(&higher.septic),
        of(&higher.damping_quadratic),
        of(&higher.damping_quartic),
    ]
}

/// Where the directional derivative of the joint's load is not that of the joint file's law.
pub(super) fn derivative_finding(
    joint: &Joint,
    sample: &Sample<'_>,
    seed: &[f64],
    found: &[f64],
) -> Option<String> {
    let dofs = sample.joint.len();
    let relative = |i: usize| seed[i] - seed[dofs + i];
    let relative_rate = |i: usize| seed[2 * dofs + i] - seed[3 * dofs + i];
    for (i, found) in found.iter().enumerate() {
        let r = sample.displacements[i] - sample.displacements[dofs + i];
        let v = sample.velocities[i] - sample.velocities[dofs + i];
        // δF = K δr + C δṙ + (3 k3 r² + 5 k5 r⁴ + 7 k7 r⁶ + (2 c2 r + 4 c4 r³) ṙ) δr + (c2 r² + c4 r⁴) δṙ
        let [k3, k5, k7, c2, c4] = nonlinear_terms(joint, i);
        let nonlinear = [
            3.0 * k3 * r.powi(2) * relative(i),
            5.0 * k5 * r.powi(4) * relative(i),
            7.0 * k7 * r.powi(6) * relative(i),
            2.0 * c2 * r * v * relative(i),
            4.0 * c4 * r.powi(3) * v * relative(i),
            c2 * r.powi(2) * relative_rate(i),
            c4 * r.powi(4) * relative_rate(i),
        ];
        let (mut expected, mut size) = (0.0, 0.0);
        for term in nonlinear {
            expected += term;
            size += term.abs();
        }
        for j in 0..dofs {
            let terms = [
                joint.stiffness[i][j] * relative(j),
                joint.damping[i][j] * relative_rate(j),
            ];
            expected += terms[0] + terms[1];
            size += terms[0].abs() + terms[1].abs();
        }
        if (found - expected).abs() > SAME * size || !found.is_finite() {
            return Some(format!(
                "run: found the directional derivative of {} to be {found:?}, expected {expected:?} from \
                 resources/joint.json",
                ["joint.F", "joint.M"][i.min(1)]
            ));
        }
    }
    None
}

/// The samples among the reported values.
pub(super) fn samples<'v>(references: &References, values: &'v [Vec<f64>]) -> Vec<Sample<'v>> {
    values
        .iter()
        .filter_map(|values| references.sample(values))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::script::Action;
    use bolted_joint_joint::JointFile;

    const JOINT: &str = r#"{ "format": "bolted-joint/1", "name": "test", "joint": {
        "dofs": ["y", "theta"], "stiffness": [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
        "damping": [[10.83, -0.83], [-0.83, 0.083]], "cubic": [3e12, -1e5] } }"#;
    const STEPS: usize = 8;

    /// What an element would give along its paths, with energy and power by these factors.
    fn values(file: &JointFile, excitation: &Excitation, factors: [f64; 2]) -> Vec<Vec<f64>> {
        let law = file.joint.law::<2>().unwrap();
        let references = references();
        (0..=excitation.step_count(STEPS))
            .map(|index| {
                let time_s = index as f64 * excitation.span_s / STEPS as f64;
                let Action::Set { values, .. } = excitation.set_motion(&references, time_s) else {
                    panic!("no motion");
                };
                let relative = bolted_joint_dynamics::Motion {
                    displacement: [values[0] - values[2], values[1] - values[3]],
                    velocity: [values[4] - values[6], values[5] - values[7]],
                };
                let on_b = law.load_on_b(&relative);
                let mut all = values;
                all.extend([-on_b[0], -on_b[1], on_b[0], on_b[1], on_b[0], on_b[1]]);
                all.push(factors[0] * law.stored_energy(&relative.displacement));
                all.push(factors[1] * law.dissipated_power(&relative));
                all
            })
            .collect()
    }

    fn references() -> References {
        References {
            displacements: vec![1, 2, 5, 6],
            velocities: vec![3, 4, 7, 8],
            loads: vec![9, 10, 11, 12],
            joint: vec![13, 14],
            energy: 15,
            power: 16,
        }
    }

    #[test]
    fn an_energy_or_a_power_that_is_a_thousandth_off_is_found() {
        let file = JointFile::from_json(JOINT, "test").unwrap();
        let excitation = Excitation::of(&file, Interface::Element, None);
        let balanced = |factors| {
            let values = values(&file, &excitation, factors);
            let samples = samples(&references(), &values);
            assert_eq!(
                load_finding(&file.joint, Interface::Element, &samples),
                None
            );
            balance(&excitation, &samples, STEPS).unwrap().is_balanced()
        };
        assert!(balanced([1.0, 1.0]));
        for factors in [
            [1.001, 1.0],
            [0.0, 1.0],
            [1.0, 0.999],
            [1.0, -1.0],
            [f64::MAX, 1.0],
        ] {
            assert!(!balanced(factors), "{factors:?}");
        }
    }

    #[test]
    fn loads_and_derivatives_of_another_joint_are_found() {
        let file = JointFile::from_json(JOINT, "test").unwrap();
        let excitation = Excitation::of(&file, Interface::Element, None);
        let values = values(&file, &excitation, [1.0, 1.0]);
        let samples = samples(&references(), &values);
        let mut other = file.joint.clone();
        other.cubic[1] *= 1.001;
        let finding = load_finding(&other, Interface::Element, &samples).unwrap();
        assert!(finding.contains("joint.M"), "{finding}");
        // δr = δy_a alone, so that δF = K₁₁ + 3 k3 r²
        let sample = &samples[3];
        let r = sample.displacements[0] - sample.displacements[2];
        let seed = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let right = [5.73e5 + 3.0 * 3e12 * r * r, 5.82e3];
        assert_eq!(derivative_finding(&file.joint, sample, &seed, &right), None);
        for wrong in [[5.73e5, 5.82e3], [right[0], -5.82e3], [f64::NAN, 5.82e3]] {
            assert!(derivative_finding(&file.joint, sample, &seed, &wrong).is_some());
        }
    }
}
