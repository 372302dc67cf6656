//! How well a laboratory knows its set-up: a prior standard deviation for each kind of cause.

use super::cause::{Cause, MeasuredSet, Side};
use super::experiment::{Experiment, Structure};

/// Prior standard deviations; 0 says that a quantity is known exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Gain of each set, relative.
    pub gain: f64,
    /// Gain that all sets have in common, relative.
    pub common_gain: f64,
    /// Gain of each response channel, relative.
    pub channel_gain: f64,
    /// Delay that all sets have in common, s.
    pub common_delay_s: f64,
    /// Delay of each set, s.
    pub delay_s: f64,
    /// Constant phase of each set, rad.
    pub phase_rad: f64,
    /// Mass of the moving accelerometer beyond what the data are corrected for, kg.
    pub accelerometer_mass_kg: f64,
    /// Position of each point and of the joint, m.
    pub position_m: f64,
    /// Frequencies of a measured structure in the assembly over those in its own test, relative.
    pub frequency: f64,
    /// Young's modulus of a computed structure, relative.
    pub youngs_modulus: f64,
    /// Density of a computed structure, relative.
    pub density: f64,
    /// Damping of a computed structure, relative.
    pub structure_damping: f64,
    /// Mass at the joint that only the assembly has, kg.
    pub joint_mass_kg: f64,
    /// Moment of inertia at the joint that only the assembly has, kg·m².
    pub joint_inertia_kg_m2: f64,
    /// Loss factor of the joint.
    pub loss_factor: f64,
    /// Bending stiffness behind the correction of rotations by differences, relative.
    pub difference_stiffness: f64,
    /// Distance between the points that rotations are differences of, relative.
    pub difference_spacing: f64,
}

impl Default for Budget {
    /// A careful laboratory.
    fn default() -> Self {
        Self {
            gain: 0.01,
            common_gain: 0.01,
            channel_gain: 0.005,
            common_delay_s: 5e-6,
            delay_s: 5e-6,
            phase_rad: 0.0,
            accelerometer_mass_kg: 3e-4,
            position_m: 5e-4,
            frequency: 0.002,
            youngs_modulus: 0.01,
            density: 0.005,
            structure_damping: 0.3,
            joint_mass_kg: 0.010,
            joint_inertia_kg_m2: 0.0,
            loss_factor: 0.02,
            difference_stiffness: 0.05,
            difference_spacing: 0.01,
        }
    }
}

/// A cause that takes part in an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// The cause.
    pub cause: Cause,
    /// Standard deviation before the measurement, in the unit of the cause.
    pub standard_deviation: f64,
    /// Most likely value before the measurement, in the unit of the cause: zero, unless the set-up is drawn anew.
    pub centre: f64,
}

impl Prior {
    /// How far a value is from the centre, in standard deviations.
    #[must_use]
    pub fn pull(&self, value: f64) -> f64 {
        (value - self.centre) / self.standard_deviation
    }
}

impl Budget {
    /// Everything is exact.
    #[must_use]
    pub fn none() -> Self {
        Self {
            gain: 0.0,
            common_gain: 0.0,
            channel_gain: 0.0,
            common_delay_s: 0.0,
            delay_s: 0.0,
            phase_rad: 0.0,
            accelerometer_mass_kg: 0.0,
            position_m: 0.0,
            frequency: 0.0,
            youngs_modulus: 0.0,
            density: 0.0,
            structure_damping: 0.0,
            joint_mass_kg: 0.0,
            joint_inertia_kg_m2: 0.0,
            loss_factor: 0.0,
            difference_stiffness: 0.0,
            difference_spacing: 0.0,
        }
    }

    /// The causes of an experiment that are not exact.
    #[must_use]
    pub fn priors(&self, experiment: &Experiment<'_>) -> Vec<Prior> {
        priors(experiment, |cause| self.standard_deviation(cause))
    }

    /// Prior standard deviation of a cause, in its unit.
    #[must_use]
    pub fn standard_deviation(&self, cause: Cause) -> f64 {
        match cause {
            Cause::Gain(_) => self.gain,
            Cause::CommonGain => self.common_gain,
            Cause::ChannelGain(..) => self.channel_gain,
            Cause::CommonDelay => self.common_delay_s,
            Cause::Delay(_) => self.delay_s,
            Cause::Phase(_) => self.phase_rad,
            Cause::Accelerometer(_) => self.accelerometer_mass_kg,
            Cause::Position(_) | Cause::JointPosition(..) | Cause::JointBending(..) => {
                self.position_m
            }
            Cause::Frequency(_) => self.frequency,
            Cause::YoungsModulus(_) => self.youngs_modulus,
            Cause::Density(_) => self.density,
            Cause::StructureDamping(_) => self.structure_damping,
            Cause::JointMass(..) => self.joint_mass_kg,
            Cause::JointInertia(..) => self.joint_inertia_kg_m2,
            Cause::LossFactor => self.loss_factor,
            Cause::DifferenceStiffness(_) => self.difference_stiffness,
            Cause::DifferenceSpacing(_) => self.difference_spacing,
        }
    }
}

/// The causes of an experiment that are not exact by these standard deviations.
#[must_use]
pub fn priors(experiment: &Experiment<'_>, deviation: impl Fn(Cause) -> f64) -> Vec<Prior> {
    causes(experiment)
        .into_iter()
        .map(|cause| Prior {
            cause,
            standard_deviation: deviation(cause),
            centre: 0.0,
        })
        .filter(|prior| prior.standard_deviation > 0.0)
        .collect()
}

/// Every cause that can act on an experiment.
pub(crate) fn causes(experiment: &Experiment<'_>) -> Vec<Cause> {
    let mut causes = vec![Cause::CommonGain, Cause::LossFactor];
    let assemblies = experiment.assemblies.iter().enumerate();
    let assemblies = assemblies.map(|(number, of)| (MeasuredSet::Assembly(number), &of.functions));
    let mut measured: Vec<_> = assemblies.collect();
    let mut all_are_measured = true;
    for side in [Side::A, Side::B] {
        let bolts = 0..experiment.joint.bolts();
        match experiment.side(side) {
            Structure::Measured(structure) => {
                measured.push((MeasuredSet::Of(side), &structure.functions));
                causes.push(Cause::Frequency(side));
                if structure.correction.is_some() {
                    causes.push(Cause::DifferenceStiffness(side));
                }
                if !structure.differences.is_empty() {
                    causes.push(Cause::DifferenceSpacing(side));
                }
                if experiment.joint.has_rotation() {
                    causes.extend(bolts.clone().flat_map(|bolt| {
                        [
                            Cause::JointPosition(side, bolt),
                            Cause::JointBending(side, bolt),
                        ]
                    }));
                }
            }
            Structure::Computed(_) => {
                causes.extend([
                    Cause::YoungsModulus(side),
                    Cause::Density(side),
                    Cause::StructureDamping(side),
                ]);
                all_are_measured = false;
                causes.extend(bolts.clone().map(|bolt| Cause::JointPosition(side, bolt)));
            }
            Structure::Exact(_) => {}
        }
        causes.extend(bolts.clone().map(|bolt| Cause::JointMass(side, bolt)));
        if experiment.joint.has_rotation() {
            causes.extend(bolts.map(|bolt| Cause::JointInertia(side, bolt)));
        }
    }
    // beside a computed structure it is that of each set
    if all_are_measured {
        causes.push(Cause::CommonDelay);
    }
    for (set, functions) in measured {
        causes.extend([Cause::Gain(set), Cause::Delay(set), Cause::Phase(set)]);
        if functions.is_translation.iter().any(|&is| is) {
            causes.push(Cause::Accelerometer(set));
        }
        let rows = functions.responses().into_iter();
        causes.extend(rows.map(|row| Cause::ChannelGain(set, row)));
    }
    let points = experiment.points_with_slopes();
    causes.extend(points.into_iter().map(Cause::Position));
    causes
}
