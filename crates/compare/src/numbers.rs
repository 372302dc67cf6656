//! The numbers of joints, a row each: entries of K and C, terms and laws, at each preload where there are several.

use bolted_joint_dynamics::law::{DAMPING, Parameter, STIFFNESS, Term};
use bolted_joint_joint::{Friction, JointFile, LawError, unit};

/// Half an interval of 95 % in standard deviations.
pub const HALF: f64 = 1.959_963_984_540_054;
/// Of a difference a value without a deviation is at least this part, if the difference is to be told as a part of the value.
const LEAST_PART: f64 = 0.01;

/// One number of all joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its name, such as `k_yy`; at one of several preloads with the preload, `k_yy@10`.
    pub name: String,
    /// Its unit as people write it; `1` for none.
    pub unit: String,
    /// Its value in each joint.
    pub values: Vec<Measured>,
    /// Of each joint but the first, how far it is from that of the first; `None` where both are zero and known as such.
    pub differences: Vec<Option<Difference>>,
}

/// A value with its standard deviation, where the file has one above zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// SI.
    pub value: f64,
    /// SI.
    pub deviation: Option<f64>,
}

impl Measured {
    /// Whether zero is outside of the interval of 95 %: parts of a value that may as well be zero say nothing.
    #[must_use]
    pub fn is_told_from_zero(&self) -> bool {
        self.value.abs() > HALF * self.deviation.unwrap_or(0.0)
    }

    /// The difference of another value as a part of this one; `None` where this one may as well be zero: by its deviation, by that
    /// of the other where it has none, or where neither has one because it is next to nothing beside the difference.
    fn part_of(&self, other: &Self) -> Option<f64> {
        let by = other.value - self.value;
        let own = Self {
            deviation: self.deviation.or(other.deviation),
            ..*self
        };
        let is_much = own.deviation.is_some() || own.value.abs() >= LEAST_PART * by.abs();
        (own.is_told_from_zero() && is_much).then(|| by / own.value.abs())
    }
}

/// How far a value is from the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Part of the first value; `None` where that may as well be zero.
    pub relative: Option<f64>,
    /// Standard deviations of the difference, √(σ₁² + σ₂²); `None` unless both files have one.
    pub deviations: Option<f64>,
}

impl Row {
    fn new(name: String, unit: String, values: Vec<Measured>) -> Self {
        let (first, others) = match values.as_slice() {
            [first, others @ ..] => (*first, others),
            [] => (
                Measured {
                    value: 0.0,
                    deviation: None,
                },
                &[][..],
            ),
        };
        let difference = |own: &Measured| {
            let by = own.value - first.value;
            let sum = first
                .deviation
                .zip(own.deviation)
                .map(|(one, other)| one.hypot(other));
            (first != *own || first.value != 0.0).then(|| Difference {
                relative: first.part_of(own),
                deviations: sum.map(|sum| by / sum),
            })
        };
        let differences = others.iter().map(difference).collect();
        Self {
            name,
            unit,
            values,
            differences,
        }
    }

    fn is_nothing(&self) -> bool {
        self.values
            .iter()
            .all(|own| own.value == 0.0 && own.deviation.is_none())
    }
}

type Matrix = [Vec<f64>];

/// All rows; those whose numbers are zero everywhere are left out.
pub(crate) fn rows(files: &[&JointFile]) -> Result<Vec<Row>, LawError> {
    let over_preload = files
        .first()
        .and_then(|file| file.joint.over_preload.as_ref());
    let mut rows = Vec::new();
    match over_preload {
        None => rows = all(files),
        Some(table) => {
            for preload_n_m in &table.preload {
                let at = |file: &&JointFile| file.at_preload(Some(*preload_n_m));
                let at = files.iter().map(at).collect::<Result<Vec<_>, _>>()?;
                let mut own = all(&at.iter().collect::<Vec<_>>());
                for row in &mut own {
                    row.name = format!("{}@{preload_n_m}", row.name);
                }
                rows.append(&mut own);
            }
        }
    }
    rows.retain(|row| !row.is_nothing());
    Ok(rows)
}

/// Of joints that do not depend on the preload.
fn all(files: &[&JointFile]) -> Vec<Row> {
    let mut rows = Vec::new();
    matrices(files, &mut rows);
    terms(files, &mut rows);
    friction(files, &mut rows);
    rows
}

fn matrices(files: &[&JointFile], rows: &mut Vec<Row>) {
    let Some(first) = files.first() else { return };
    let dofs = first.joint.dofs;
    let entry = |matrix: &Matrix, [i, j]: [usize; 2]| matrix.get(i)?.get(j).copied();
    let kinds: [(&Parameter, Of); 2] = [
        (STIFFNESS, |file| {
            let deviation = file.uncertainty.as_ref();
            let deviation = deviation.map(|own| own.standard_deviation.stiffness.as_slice());
            (&file.joint.stiffness, deviation)
        }),
        (DAMPING, |file| {
            let deviation = file.uncertainty.as_ref();
            let deviation = deviation.map(|own| own.standard_deviation.damping.as_slice());
            (&file.joint.damping, deviation)
        }),
    ];
    for (parameter, of) in kinds {
        for place in dofs.entries() {
            let values = files.iter().map(|file| {
                let (value, deviation) = of(file);
                let deviation = deviation.and_then(|own| entry(own, place));
                Measured {
                    value: entry(value, place).unwrap_or(0.0),
                    deviation: deviation.filter(|own| *own > 0.0),
                }
            });
            let [i, j] = place;
            let [row, column] = [dofs.row(i).name, dofs.row(j).name];
            rows.push(Row::new(
                format!("{}_{row}{column}", parameter.symbol),
                dofs.unit(parameter.unit, place),
                values.collect(),
            ));
        }
    }
}

/// A matrix, and its deviations.
type Of = for<'f> fn(&'f JointFile) -> (&'f Matrix, Option<&'f Matrix>);

fn terms(files: &[&JointFile], rows: &mut Vec<Row>) {
    let Some(first) = files.first() else { return };
    for term in Term::ALL {
        for (place, dof) in first.joint.dofs.rows().enumerate() {
            let values = files.iter().map(|file| Measured {
                value: file.joint.term(term).get(place).copied().unwrap_or(0.0),
                deviation: None,
            });
            let row = term.row();
            let name = format!("{}_{}", row.symbol, dof.name);
            rows.push(Row::new(
                name,
                unit(row.unit, dof.kind, dof.kind),
                values.collect(),
            ));
        }
    }
}

/// Laws that stand on one DOF several times are compared in the files' order.
fn friction(files: &[&JointFile], rows: &mut Vec<Row>) {
    let Some(first) = files.first() else { return };
    for (place, law) in first.joint.friction.iter().enumerate() {
        let is_same = |own: &&Friction| own.law == law.law && own.dof == law.dof;
        let number = first.joint.friction[..place].iter().filter(is_same).count();
        for (parameter, _) in law.law.parameters.iter().zip(&law.parameters) {
            let values = files.iter().map(|file| {
                let own = |laws: &[Friction]| {
                    let own = laws.iter().filter(is_same).nth(number)?;
                    own.value(parameter)
                };
                let deviations = file.uncertainty.as_ref();
                let deviation =
                    deviations.and_then(|known| own(&known.standard_deviation.friction));
                Measured {
                    value: own(&file.joint.friction).unwrap_or(0.0),
                    deviation: deviation.filter(|own| *own > 0.0),
                }
            });
            let behind = if number == 0 {
                String::new()
            } else {
                format!(" {}", number + 1)
            };
            let name = format!(
                "{}{behind}.{}_{}",
                law.law.name, parameter.key, law.dof.name
            );
            rows.push(Row::new(
                name,
                unit(parameter.unit, law.dof.kind, law.dof.kind),
                values.collect(),
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_zero_has_no_parts() {
        let of = |value: f64, deviation: Option<f64>| Measured { value, deviation };
        #[rustfmt::skip]
        let cases = [
            (of(100.0, Some(1.0)), of(110.0, Some(1.0)), Some(0.1)),
            (of(-100.0, None), of(-110.0, None), Some(-0.1)),
            (of(1.0, Some(1.0)), of(2.0, Some(1.0)), None),
            // the first one's deviation is not known
            (of(0.1, None), of(60.0, Some(10.0)), None),
            (of(0.1, None), of(-60.0, None), None),
            (of(0.0, None), of(5.0, None), None),
        ];
        for (first, second, expected) in cases {
            let row = Row::new("k".to_owned(), "N/m".to_owned(), vec![first, second]);
            let relative = row.differences[0].unwrap().relative;
            let is_same = match (relative, expected) {
                (Some(found), Some(expected)) => f64::abs(found - expected) < 1e-12,
                (found, expected) => found == expected,
            };
            assert!(is_same, "{first:?} {second:?}: {relative:?}");
        }
    }
}
