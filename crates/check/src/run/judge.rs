//! What the values of a run say about the FMU: energy balance, load law, derivatives.

use bolted_joint_dynamics::{DOF_AT_REST, JointLaw, JointMemory, Motion, with_dofs};

use super::balance::{BalanceReport, Integral};
use super::excitation::Excitation;
use super::names::{References, Sample};
use bolted_joint_export::Interface;
use bolted_joint_joint::Joint;

/// Agreement that is asked of loads and derivatives, by the sum of the magnitudes of their terms.
const SAME: f64 = 1e-12;
/// The same where a lap's joint remembers: between two points it turns where the lap's own steps find it, and the cubic through
/// the points only nearly so.
const NEARLY_SAME: f64 = 1e-6;
/// Rounding errors in the balance, by its largest energy.
const ROUNDING: f64 = 1e-12;

/// How many times what is found of errors they may be where a load has corners.
const MARGIN_OF_CORNERS: f64 = 4.0;

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
    let uncertainty_j = heat.error + work.error + ROUNDING * scale_j;
    Some(BalanceReport {
        work_j: work.value,
        stored_j: last.energy_j - first.energy_j,
        dissipated_j: heat.value,
        scale_j,
        uncertainty_j,
        tolerance_j: uncertainty_j,
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

/// The finer run's balance; the difference from the coarser one tells what the FMU's own integration is off. Where its load has
/// corners, neither that nor the quadrature's error falls evenly with the step, and what is found of them may be chance.
pub(super) fn refined(
    coarse: &BalanceReport,
    fine: &BalanceReport,
    has_corners: bool,
) -> BalanceReport {
    let margin = if has_corners { MARGIN_OF_CORNERS } else { 1.0 };
    let difference = (coarse.work_j - fine.work_j).abs()
        + (coarse.stored_j - fine.stored_j).abs()
        + (coarse.dissipated_j - fine.dissipated_j).abs();
    let uncertainty_j = fine.uncertainty_j + difference;
    BalanceReport {
        uncertainty_j,
        tolerance_j: margin * uncertainty_j,
        ..*fine
    }
}

/// The first sample that is not finite or whose loads are not those of the joint file.
pub(super) fn load_finding(
    joint: &Joint,
    interface: Interface,
    samples: &[Sample<'_>],
    step_s: f64,
) -> Option<String> {
    with_dofs!(joint.dofs.size(), D => {
        load_finding_of::<D>(joint, interface, samples, step_s)
    })
}

fn load_finding_of<const D: usize>(
    joint: &Joint,
    interface: Interface,
    samples: &[Sample<'_>],
    step_s: f64,
) -> Option<String> {
    let expected = Expected::<D>::of(joint)?;
    let mut memory = [DOF_AT_REST; D];
    let mut before: Option<Motion<D>> = None;
    let same = match interface {
        Interface::Lap if expected.law.has_memory() => NEARLY_SAME,
        Interface::Lap | Interface::Element => SAME,
    };
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
        let relative = relative(sample.displacements, sample.velocities);
        if let (Interface::Lap, Some(before)) = (interface, &before) {
            expected
                .law
                .follow(&mut memory, [before, &relative], step_s);
        }
        let (loads, sizes) = expected.loads(&memory, &relative);
        // a step ends at each communication point
        expected.law.commit(&mut memory, &relative);
        before = Some(relative);
        for (i, dof) in joint.dofs.rows().enumerate() {
            let (name, expected) = (dof.load, loads[i]);
            let mut found = vec![("joint", sample.joint[i])];
            if interface == Interface::Element {
                found.extend([("b", sample.loads[D + i]), ("-a", -sample.loads[i])]);
            }
            for (side, found) in found {
                if (found - expected).abs() > same * sizes[i] {
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

/// What the joint file's law says of a run.
struct Expected<const D: usize> {
    law: JointLaw<D>,
    /// The law with all of its coefficients positive: what it gives at a motion that is so, too, is the sum of the magnitudes
    /// of the law's terms.
    magnitude: JointLaw<D>,
}

impl<const D: usize> Expected<D> {
    /// `None` where the joint file gives no law, which the inspection tells of.
    fn of(joint: &Joint) -> Option<Self> {
        let law = joint.law().ok()?;
        let magnitude = JointLaw::each([&law], |[coefficient]| coefficient.abs());
        Some(Self { law, magnitude })
    }

    /// Load on b, and the sum of the magnitudes of its terms.
    fn loads(&self, memory: &JointMemory<D>, relative: &Motion<D>) -> ([f64; D], [f64; D]) {
        (
            self.law.load_on_b_after(memory, relative),
            self.magnitude.load_on_b(&magnitude(relative)),
        )
    }

    /// Change of the load on b of a joint that has not moved yet along a change of the relative motion, and the sum of the
    /// magnitudes of its terms.
    fn changes(&self, relative: &Motion<D>, seed: &Motion<D>) -> ([f64; D], [f64; D]) {
        let change = |law: &JointLaw<D>, relative: &Motion<D>, seed: &Motion<D>| {
            let loads = law
                .with_change(&JointLaw::NONE)
                .load_on_b(&relative.with_change(seed));
            loads.map(|load| load.change[0])
        };
        (
            change(&self.law, relative, seed),
            change(&self.magnitude, &magnitude(relative), &magnitude(seed)),
        )
    }
}

/// x_a − x_b of lists that hold the DOFs of a, then those of b.
fn relative<const D: usize>(displacements: &[f64], velocities: &[f64]) -> Motion<D> {
    let apart = |list: &[f64]| std::array::from_fn(|i| list[i] - list[D + i]);
    Motion {
        displacement: apart(displacements),
        velocity: apart(velocities),
    }
}

fn magnitude<const D: usize>(motion: &Motion<D>) -> Motion<D> {
    Motion {
        displacement: motion.displacement.map(f64::abs),
        velocity: motion.velocity.map(f64::abs),
    }
}

/// Where the directional derivative of the joint's load is not that of the joint file's law.
pub(super) fn derivative_finding(
    joint: &Joint,
    sample: &Sample<'_>,
    seed: &[f64],
    found: &[f64],
) -> Option<String> {
    let (expected, sizes) = with_dofs!(joint.dofs.size(), D => {
        let (of_displacements, of_velocities) = seed.split_at_checked(2 * D)?;
        let (expected, sizes) = Expected::<D>::of(joint)?.changes(
            &relative(sample.displacements, sample.velocities),
            &relative(of_displacements, of_velocities),
        );
        (expected.to_vec(), sizes.to_vec())
    });
    for (i, (found, dof)) in found.iter().zip(joint.dofs.rows()).enumerate() {
        let expected = expected[i];
        if (found - expected).abs() > SAME * sizes[i] || !found.is_finite() {
            return Some(format!(
                "run: found the directional derivative of joint.{} to be {found:?}, expected {expected:?} from \
                 resources/joint.json",
                dof.load
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
                load_finding(&file.joint, Interface::Element, &samples, 1e-3),
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
        let finding = load_finding(&other, Interface::Element, &samples, 1e-3).unwrap();
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
