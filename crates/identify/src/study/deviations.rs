//! The budget of a study's causes: the general one, and over it what stands beside single values.

use bolted_joint_frf::Dof;
use bolted_joint_systematic::{Budget, Cause, MeasuredSet, Side};

use super::set_up::{Accelerometer, Deviations, MassAtJoint};
use super::{FrfFile, Source, Study, Substructure};

impl Substructure {
    /// Standard deviations that stand beside single values.
    fn deviations(&self) -> Option<&Deviations> {
        match self {
            Self::Measured { set_up, .. } | Self::Beam { set_up, .. } => Some(&set_up.deviations),
            Self::Ground { .. } => None,
        }
    }

    /// What only the assembly has at each bolt.
    pub(in super::super) fn masses(&self) -> &[MassAtJoint] {
        match self {
            Self::Measured { set_up, .. } | Self::Beam { set_up, .. } => &set_up.masses,
            Self::Ground { .. } => &[],
        }
    }

    fn file(&self) -> Option<&FrfFile> {
        match self {
            Self::Measured {
                source: Source::Frf { file, .. },
                ..
            } => Some(file),
            _ => None,
        }
    }
}

impl Study {
    /// Whether anything of the set-up is not known exactly.
    pub(in super::super) fn has_causes(&self) -> bool {
        self.budget != Budget::none() || self.states_deviations()
    }

    fn states_deviations(&self) -> bool {
        let of = |substructure: &Substructure| {
            let own = substructure.deviations().is_some_and(Deviations::is_any);
            own || of_file(substructure.file()).is_some_and(|deviation| deviation > 0.0)
        };
        let files = (0..=self.further.len()).filter_map(|number| self.assembly_file(number));
        let mut masses_kg = files.filter_map(|file| of_file(Some(file)));
        of(&self.a) || of(&self.b) || masses_kg.any(|mass_kg| mass_kg > 0.0)
    }

    /// Standard deviation of a cause before the measurement: that beside the value itself, or the general one.
    pub(in super::super) fn deviation(&self, cause: Cause, points: &[Dof]) -> f64 {
        let own = self.own_deviation(cause, points);
        own.unwrap_or_else(|| self.budget.standard_deviation(cause))
    }

    fn assembly_file(&self, number: usize) -> Option<&FrfFile> {
        match number.checked_sub(1) {
            None => Some(&self.assembly),
            Some(further) => Some(&self.further.get(further)?.file),
        }
    }

    /// Whether a cause has no value below zero: the mass of an accelerometer that the functions are not freed of.
    pub(crate) fn is_never_negative(&self, cause: Cause) -> bool {
        let is_freed =
            |file: Option<&FrfFile>| file.is_some_and(|file| file.accelerometer.is_some());
        match cause {
            Cause::Accelerometer(MeasuredSet::Assembly(number)) => {
                !is_freed(self.assembly_file(number))
            }
            Cause::Accelerometer(MeasuredSet::Of(side)) => !is_freed(self.side(side).file()),
            _ => false,
        }
    }

    fn side(&self, side: Side) -> &Substructure {
        match side {
            Side::A => &self.a,
            Side::B => &self.b,
        }
    }

    fn own_deviation(&self, cause: Cause, points: &[Dof]) -> Option<f64> {
        let of = |side: Side| self.side(side).deviations();
        let at = |all: &[Option<f64>], bolt: usize| all.get(bolt).copied().flatten();
        match cause {
            // nothing that is added to the ground moves
            Cause::JointMass(side, _) | Cause::JointInertia(side, _)
                if matches!(self.side(side), Substructure::Ground { .. }) =>
            {
                Some(0.0)
            }
            Cause::YoungsModulus(side) => of(side)?.youngs_modulus,
            Cause::Density(side) => of(side)?.density,
            Cause::DifferenceStiffness(side) => of(side)?.difference_stiffness,
            Cause::JointPosition(side, bolt) | Cause::JointBending(side, bolt) => {
                at(&of(side)?.joints_m, bolt)
            }
            Cause::JointMass(side, bolt) => at(&of(side)?.masses_kg, bolt),
            Cause::JointInertia(side, bolt) => at(&of(side)?.inertias_kg_m2, bolt),
            Cause::Position(point) => {
                let is_on_a = point + self.points_on_a >= points.len();
                let side = if is_on_a { Side::A } else { Side::B };
                of(side)?.points_m.get(points.get(point)?).copied()
            }
            Cause::Accelerometer(MeasuredSet::Assembly(number)) => {
                of_file(self.assembly_file(number))
            }
            Cause::Accelerometer(MeasuredSet::Of(side)) => of_file(self.side(side).file()),
            Cause::Gain(_)
            | Cause::CommonGain
            | Cause::ChannelGain(..)
            | Cause::CommonDelay
            | Cause::Delay(_)
            | Cause::Phase(_)
            | Cause::Frequency(_)
            | Cause::StructureDamping(_)
            | Cause::DifferenceSpacing(_)
            | Cause::LossFactor => None,
        }
    }
}

impl Deviations {
    /// Whether anything is not exact.
    fn is_any(&self) -> bool {
        let single = [self.youngs_modulus, self.density, self.difference_stiffness];
        let lists = [&self.joints_m, &self.masses_kg, &self.inertias_kg_m2];
        let lists = lists.into_iter().flatten().copied();
        let points = self.points_m.values().map(|&point_m| Some(point_m));
        let mut all = single.into_iter().chain(lists).chain(points);
        all.any(|deviation| deviation.is_some_and(|deviation| deviation > 0.0))
    }
}

fn of_file(file: Option<&FrfFile>) -> Option<f64> {
    let accelerometer: Accelerometer = file?.accelerometer?;
    accelerometer.standard_deviation_kg
}
