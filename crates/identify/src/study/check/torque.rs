//! Checks of what a study says of torques and levels.

use super::super::super::error::IdentifyError;
use super::super::super::level::{Level, LevelQuantity};
use super::super::super::torque::{TorqueDependence, Torques};
use super::super::FurtherAssembly;
use super::super::tables::ExcitationTable;
use super::Checker;

impl Checker<'_> {
    /// Joints over the torque need a torque of every assembly, and two different ones.
    pub(in super::super) fn torques(
        &self,
        dependence: TorqueDependence,
        assemblies: &[FurtherAssembly],
    ) -> Result<(), IdentifyError> {
        if dependence == TorqueDependence::Common {
            return Ok(());
        }
        let known: Vec<f64> = assemblies
            .iter()
            .filter_map(|assembly| assembly.torque_n_m)
            .collect();
        if Torques::of(&known, assemblies.len()).is_some() {
            return Ok(());
        }
        let without = assemblies.len() - known.len();
        let found = if without > 0 {
            format!(
                "\"separate\" and no torque in {without} of {} [[assembly]]",
                assemblies.len()
            )
        } else {
            "\"separate\" and one torque".to_owned()
        };
        self.refuse(
            "joint.torques",
            found,
            "a torque in every [[assembly]], at least two different ones; or \"common\"",
        )
    }

    pub(in super::super) fn level(
        &self,
        table: Option<&ExcitationTable>,
    ) -> Result<Option<Level>, IdentifyError> {
        const EXPECTED: &str = "exactly one of `force` (N), `displacement` (m), `velocity` (m/s) and `acceleration` (m/s²) above zero, such \
                                as { force = 0.5 }";
        let Some(table) = table else { return Ok(None) };
        let given: Vec<(LevelQuantity, f64)> = [
            (LevelQuantity::Force, table.force),
            (LevelQuantity::Displacement, table.displacement),
            (LevelQuantity::Velocity, table.velocity),
            (LevelQuantity::Acceleration, table.acceleration),
        ]
        .into_iter()
        .filter_map(|(quantity, value)| Some((quantity, value?)))
        .collect();
        match given.as_slice() {
            &[(quantity, value)] if value.is_finite() && value > 0.0 => Ok(Some(Level {
                quantity,
                value,
                measure: table.measure,
            })),
            [] => self.refuse("assembly.level", "no level", EXPECTED),
            given => {
                let given: Vec<String> = given
                    .iter()
                    .map(|(quantity, value)| format!("{} = {value}", quantity.name()))
                    .collect();
                self.refuse("assembly.level", given.join(", "), EXPECTED)
            }
        }
    }
}
