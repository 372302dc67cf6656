//! Checks of what a study says of torques and levels.

use super::super::super::level::{Level, LevelQuantity};
use super::super::super::torque::{TorqueDependence, Torques};
use super::super::FurtherAssembly;
use super::super::tables::ExcitationTable;
use bolted_joint_study::{StudyError, StudyText};

/// Joints over the torque need a torque of every assembly, and two different ones.
pub(crate) fn torques(
    study: &StudyText,
    dependence: TorqueDependence,
    assemblies: &[FurtherAssembly],
) -> Result<(), StudyError> {
    if dependence == TorqueDependence::Common {
        return Ok(());
    }
    let known = assemblies.iter().filter_map(|assembly| assembly.torque_n_m);
    let known: Vec<f64> = known.collect();
    let count = assemblies.len();
    let found = match count - known.len() {
        0 => "\"separate\" and one torque".to_owned(),
        without => format!("\"separate\" and no torque in {without} of {count} [[assembly]]"),
    };
    study.ensure(
        Torques::of(&known, count).is_some(),
        "joint.torques",
        found,
        "a torque in every [[assembly]], at least two different ones; or \"common\"",
    )
}

pub(crate) fn level(
    study: &StudyText,
    table: Option<&ExcitationTable>,
) -> Result<Option<Level>, StudyError> {
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
        [] => study.refuse("assembly.level", "no level", EXPECTED),
        given => {
            let given: Vec<String> = given
                .iter()
                .map(|(quantity, value)| format!("{} = {value}", quantity.name()))
                .collect();
            study.refuse("assembly.level", given.join(", "), EXPECTED)
        }
    }
}
