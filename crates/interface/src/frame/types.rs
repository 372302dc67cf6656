//! Types and units of what the laws bring: found in the frame where it defines them, else added to it.

use bolted_joint_dynamics::{
    DofKind,
    law::{Parameter, Range, UnitRule},
};

use super::{laws::Place, line::Line, words};
use crate::error::InterfaceProblem;

/// A type that a law needs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Type {
    pub(super) name: String,
    unit: Unit,
    nominal: f64,
    not_negative: bool,
}

/// A coherent unit of SI: its name, and its exponents of kg, m, s and rad.
#[derive(Clone, Debug, PartialEq)]
struct Unit {
    name: String,
    exponents: [i8; 4],
}

/// Names of the base units, in the order of their exponents.
const BASE_UNITS: [&str; 4] = ["kg", "m", "s", "rad"];
const SECOND: usize = 2;

/// Type of a parameter at a place of this kind.
pub(super) fn of_parameter(declared: &Parameter, place: Place) -> Type {
    let rule = declared.unit;
    let (prefix, load, displacement) = match place {
        Place::Translation => ("", DofKind::Translation, DofKind::Translation),
        // force per rotation, which is moment per displacement but for the name
        Place::Between => ("Coupling", DofKind::Translation, DofKind::Rotation),
        Place::Rotation => ("Rotational", DofKind::Rotation, DofKind::Rotation),
    };
    let unit = match rule {
        UnitRule::LoadPer {
            displacement: over,
            seconds,
        } => load_per(load, displacement, over, seconds),
        UnitRule::Rate => {
            let mut unit = displacement_unit(displacement);
            unit.exponents[SECOND] -= 1;
            unit.name += "/s";
            unit
        }
        UnitRule::One => Unit {
            name: "1".to_owned(),
            exponents: [0; 4],
        },
    };
    Type {
        name: format!("{prefix}{}", declared.quantity.name),
        unit,
        nominal: declared.quantity.nominal[place as usize],
        not_negative: declared.range == Range::NotNegative,
    }
}

/// load · s^`seconds` / displacement^`power`
fn load_per(load: DofKind, displacement: DofKind, over: u8, seconds: u8) -> Unit {
    let mut unit = load_unit(load);
    for _ in 0..seconds {
        unit.exponents[SECOND] += 1;
    }
    if seconds > 0 {
        unit.name += ".s";
        unit.name += &power(seconds);
    }
    let base = match displacement {
        DofKind::Translation => 1,
        DofKind::Rotation => 3,
    };
    for _ in 0..over {
        unit.exponents[base] -= 1;
    }
    if over > 0 {
        unit.name += "/";
        unit.name += displacement.displacement_unit();
        unit.name += &power(over);
    }
    unit
}

/// Type of what is remembered of this quantity: the DOF's own, which every frame defines.
pub(super) fn of_memory(quantity: words::Quantity, kind: DofKind) -> Type {
    let unit = match quantity {
        words::Quantity::Load => load_unit(kind),
        _ => displacement_unit(kind),
    };
    Type {
        name: words::type_name(quantity.word(kind)),
        unit,
        nominal: 1.0,
        not_negative: false,
    }
}

/// Type of the rate of what is remembered of this quantity: a displacement's is the DOF's own.
pub(super) fn of_rate(quantity: words::Quantity, kind: DofKind) -> Type {
    let (name, nominal) = match quantity {
        words::Quantity::Load => (
            format!("{}Rate", words::type_name(quantity.word(kind))),
            RATE_OF_LOAD,
        ),
        _ => (words::type_name(words::Quantity::Rate.word(kind)), [1.0; 2]),
    };
    let mut unit = of_memory(quantity, kind).unit;
    unit.exponents[SECOND] -= 1;
    unit.name += "/s";
    Type {
        name,
        unit,
        nominal: nominal[usize::from(kind == DofKind::Rotation)],
        not_negative: false,
    }
}

/// Typical rates of a force and of a moment, N/s and N·m/s.
const RATE_OF_LOAD: [f64; 2] = [1e5, 1e3];

fn load_unit(kind: DofKind) -> Unit {
    Unit {
        name: kind.load_unit().to_owned(),
        exponents: match kind {
            DofKind::Translation => [1, 1, -2, 0],
            DofKind::Rotation => [1, 2, -2, 0],
        },
    }
}

fn displacement_unit(kind: DofKind) -> Unit {
    Unit {
        name: kind.displacement_unit().to_owned(),
        exponents: match kind {
            DofKind::Translation => [0, 1, 0, 0],
            DofKind::Rotation => [0, 0, 0, 1],
        },
    }
}

/// An exponent of a unit's name; 1 is not written.
fn power(exponent: u8) -> String {
    match exponent {
        1 => String::new(),
        exponent => exponent.to_string(),
    }
}

/// Lines to put at the end of the frame's list of units and at the end of that of types, for those of `types` that `frame`
/// does not define.
pub(super) fn missing(frame: &str, types: &[&Type]) -> Result<[Vec<String>; 2], InterfaceProblem> {
    let mut defined = Defined::of(frame);
    let [mut units, mut definitions] = [Vec::new(), Vec::new()];
    for of_law in types {
        let unit = &of_law.unit;
        match defined.types.iter().find(|(name, _)| *name == of_law.name) {
            Some((_, found)) if *found == unit.name => continue,
            Some((name, found)) => {
                return Err(InterfaceProblem::TypeUnit {
                    declared_type: name.clone(),
                    unit: found.clone(),
                    of_law: unit.name.clone(),
                });
            }
            None => {}
        }
        if !defined.units.contains(&unit.name) {
            units.extend(unit_lines(unit));
            defined.units.push(unit.name.clone());
        }
        definitions.push(type_line(of_law));
        defined.types.push((of_law.name.clone(), unit.name.clone()));
    }
    Ok([units, definitions])
}

/// What a frame defines.
struct Defined {
    units: Vec<String>,
    /// Names of types and their units.
    types: Vec<(String, String)>,
}

impl Defined {
    fn of(frame: &str) -> Self {
        let attribute = |text: &str, name: &str| {
            let (_, after) = text.split_once(&format!(" {name}=\""))?;
            Some(after.split_once('"')?.0.to_owned())
        };
        let with = |tag: &'static str| {
            frame
                .lines()
                .map(str::trim_start)
                .filter(move |line| line.starts_with(tag))
        };
        Self {
            units: with("<Unit ")
                .filter_map(|line| attribute(line, "name"))
                .collect(),
            types: with("<Float64Type ")
                .filter_map(|line| {
                    Some((
                        attribute(line, "name")?,
                        attribute(line, "unit").unwrap_or_default(),
                    ))
                })
                .collect(),
        }
    }
}

fn unit_lines(unit: &Unit) -> [String; 3] {
    let exponents: String = BASE_UNITS
        .iter()
        .zip(unit.exponents)
        .filter(|(_, exponent)| *exponent != 0)
        .map(|(base, exponent)| format!(" {base}=\"{exponent}\""))
        .collect();
    [
        format!("    <Unit name=\"{}\">", unit.name),
        format!("      <BaseUnit{exponents}/>"),
        "    </Unit>".to_owned(),
    ]
}

fn type_line(of_law: &Type) -> String {
    let mut line = Line::new("Float64Type");
    line.push("name", of_law.name.clone());
    line.push("quantity", of_law.name.clone());
    line.push("unit", of_law.unit.name.clone());
    if of_law.not_negative {
        line.push("min", "0".to_owned());
    }
    line.push("nominal", number(of_law.nominal));
    line.to_string()
}

/// The shortest decimal that reads back to `value`.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_owned(),
        None => text,
    }
}
