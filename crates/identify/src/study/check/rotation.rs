//! `theta`: a rotation measured as such, or a finite difference over translations.

use super::super::super::model::JointModel;
use super::super::Rotation;
use super::super::tables::{DifferenceTable, ThetaTable};
use super::stated::without_deviation;
use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Difference, FiniteDifference, Order};
use bolted_joint_study::{StudyError, StudyText};

/// Sensors that are farther apart than this tell no rotation of a joint, m.
const MOST_SPACING_M: f64 = 2.0;

pub(super) fn rotation(
    study: &StudyText,
    key: &str,
    y: Dof,
    theta: Option<ThetaTable>,
    model: JointModel,
) -> Result<Option<Rotation>, StudyError> {
    let key = format!("{key}.theta");
    match theta {
        None if model.dofs() == 1 => Ok(None),
        None => {
            let expected = format!(
                "a rotation, which joint model \"{model}\" needs: a measured one or {{ points = […], spacing = … }}"
            );
            study.refuse(key, "nothing", expected)
        }
        Some(ThetaTable::Measured(dof)) => {
            let is_rotation = dof.direction().is_rotation();
            study.ensure(is_rotation, key, dof, "a rotation such as \"2:+RZ\"")?;
            Ok(Some(Rotation::Measured(dof)))
        }
        Some(ThetaTable::Difference(table)) => difference(study, &key, y, table).map(Some),
    }
}

fn difference(
    study: &StudyText,
    key: &str,
    y: Dof,
    table: DifferenceTable,
) -> Result<Rotation, StudyError> {
    let DifferenceTable {
        points,
        spacing,
        difference,
    } = table;
    let spacing = without_deviation(study, &format!("{key}.spacing"), &spacing)?;
    let expected = "the distance between neighbouring points in m";
    study.positive(format_args!("{key}.spacing"), spacing, expected)?;
    study.ensure(
        spacing <= MOST_SPACING_M,
        format_args!("{key}.spacing"),
        spacing,
        "a distance in m, at most 2 (is it in millimetres?)",
    )?;
    let order = match points.len() {
        2 => Some(Order::First),
        3 => Some(Order::Second),
        _ => None,
    };
    let found = order.and_then(|order| FiniteDifference::new(difference, order, spacing));
    let Some(found) = found else {
        let expected = match difference {
            Difference::Central => "three points, the joint's in the middle",
            Difference::Forward | Difference::Backward => {
                "two or three points, the joint's last and the farthest first"
            }
        };
        let count = points.len();
        return study.refuse(format!("{key}.points"), format!("{count} points"), expected);
    };
    let joint = points[found.joint_point()];
    let (place, what) = match difference {
        Difference::Central => ("in the middle", "central"),
        Difference::Forward => ("at the end", "forward"),
        Difference::Backward => ("at the end", "backward"),
    };
    study.ensure(
        joint == y,
        format_args!("{key}.points"),
        format_args!("{joint} {place}"),
        format_args!("the joint's own translation {y} there: the difference is {what}"),
    )?;
    Ok(Rotation::Difference {
        points,
        difference: found,
    })
}
