//! `theta`: a rotation measured as such, or a finite difference over translations.

use super::super::super::error::IdentifyError;
use super::super::super::model::JointModel;
use super::super::Rotation;
use super::super::tables::{DifferenceTable, ThetaTable};
use super::Checker;
use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Difference, FiniteDifference, Order};

impl Checker<'_> {
    pub(super) fn rotation(
        &self,
        key: &str,
        y: Dof,
        theta: Option<ThetaTable>,
        model: JointModel,
    ) -> Result<Option<Rotation>, IdentifyError> {
        let key = format!("{key}.theta");
        match theta {
            None if model.dofs() == 1 => Ok(None),
            None => self.refuse(
                key,
                "nothing",
                format!("a rotation, which joint model \"{model}\" needs: a measured one or {{ points = […], spacing = … }}"),
            ),
            Some(ThetaTable::Measured(dof)) if dof.direction().is_rotation() => {
                Ok(Some(Rotation::Measured(dof)))
            }
            Some(ThetaTable::Measured(dof)) => {
                self.refuse(key, dof.to_string(), "a rotation such as \"2:+RZ\"")
            }
            Some(ThetaTable::Difference(table)) => self.difference(&key, y, table).map(Some),
        }
    }

    fn difference(
        &self,
        key: &str,
        y: Dof,
        table: DifferenceTable,
    ) -> Result<Rotation, IdentifyError> {
        let DifferenceTable {
            points,
            spacing,
            difference,
        } = table;
        if !(spacing.is_finite() && spacing > 0.0) {
            return self.refuse(
                format!("{key}.spacing"),
                spacing.to_string(),
                "the distance between neighbouring points in m",
            );
        }
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
            return self.refuse(format!("{key}.points"), format!("{count} points"), expected);
        };
        let joint = points[found.joint_point()];
        if joint != y {
            let (place, what) = match difference {
                Difference::Central => ("in the middle", "central"),
                Difference::Forward => ("at the end", "forward"),
                Difference::Backward => ("at the end", "backward"),
            };
            return self.refuse(
                format!("{key}.points"),
                format!("{joint} {place}"),
                format!("the joint's own translation {y} there: the difference is {what}"),
            );
        }
        Ok(Rotation::Difference {
            points,
            difference: found,
        })
    }
}
