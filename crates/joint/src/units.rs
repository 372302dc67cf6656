//! Units and names of the numbers of a joint, as people write them.

use bolted_joint_dynamics::{
    DOFS, DofKind,
    law::{Parameter, UnitRule},
};

/// The unit of a parameter between the load on a DOF of one kind and the motion of one of the other, such as `N·m·s/rad³`; `1`
/// for a number without one.
#[must_use]
pub fn unit(rule: UnitRule, load: DofKind, motion: DofKind) -> String {
    let (displacement, seconds) = match rule {
        UnitRule::LoadPer {
            displacement,
            seconds,
        } => (displacement, seconds),
        UnitRule::Rate => return format!("{}/s", motion.displacement_unit()),
        UnitRule::One => return "1".to_owned(),
    };
    let mut unit = unit_for_people(load.load_unit());
    if seconds > 0 {
        unit += "·s";
        unit += &superscript(seconds);
    }
    if displacement > 0 {
        unit += "/";
        unit += motion.displacement_unit();
        unit += &superscript(displacement);
    }
    unit
}

/// A unit as FMI writes it, such as `kg.m2`, as people do: `kg·m²`.
#[must_use]
pub fn unit_for_people(unit: &str) -> String {
    let of = |c: char| match c {
        '.' => '·',
        '0'..='9' => raised(c as u8),
        other => other,
    };
    unit.chars().map(of).collect()
}

/// A name of a variable with the symbols of the DOFs for their names: `ytheta` becomes `yθ`.
#[must_use]
pub fn with_symbols(name: &str) -> String {
    let differ = DOFS.iter().filter(|dof| dof.name != dof.symbol);
    differ.fold(name.to_owned(), |name, dof| {
        name.replace(dof.name, dof.symbol)
    })
}

/// What a parameter is on a DOF of one of these kinds.
#[must_use]
pub fn description(parameter: &Parameter, kinds: &[DofKind]) -> String {
    let words = |of: fn(DofKind) -> &'static str| {
        let words: Vec<&str> = kinds.iter().map(|&kind| of(kind)).collect();
        words.join(" or ")
    };
    parameter
        .description
        .replace("{load}", &words(DofKind::load))
        .replace("{motion}", &words(DofKind::motion))
        .replace("{rate}", &words(DofKind::rate))
}

/// A power, none where it is 1.
#[must_use]
pub fn superscript(power: u8) -> String {
    match power {
        1 => String::new(),
        _ => power.to_string().bytes().map(raised).collect(),
    }
}

/// A digit of a power.
fn raised(digit: u8) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    DIGITS[usize::from(digit.wrapping_sub(b'0') % 10)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use DofKind::{Rotation, Translation};

    #[test]
    fn units_are_written_as_people_do() {
        let of = |displacement, seconds, load, motion| {
            let rule = UnitRule::LoadPer {
                displacement,
                seconds,
            };
            unit(rule, load, motion)
        };
        assert_eq!(of(1, 0, Translation, Rotation), "N/rad");
        assert_eq!(of(1, 1, Rotation, Translation), "N·m·s/m");
        assert_eq!(of(5, 1, Rotation, Rotation), "N·m·s/rad⁵");
        assert_eq!(of(11, 0, Translation, Translation), "N/m¹¹");
        assert_eq!(of(0, 0, Translation, Translation), "N");
        assert_eq!(unit(UnitRule::Rate, Rotation, Rotation), "rad/s");
        assert_eq!(unit(UnitRule::One, Rotation, Rotation), "1");
        assert_eq!(unit_for_people("kg.m2"), "kg·m²");
        assert_eq!(with_symbols("k_ytheta"), "k_yθ");
    }
}
