//! Units of the numbers of a joint, as people write them.

use bolted_joint_dynamics::{DofKind, law::UnitRule};

/// The unit of a parameter between the load on a DOF of one kind and the motion of one of the other, such as `N·m·s/rad³`.
#[must_use]
pub fn unit(rule: UnitRule, load: DofKind, motion: DofKind) -> String {
    let mut unit = load.load_unit().replace('.', "·");
    if rule.seconds > 0 {
        unit += "·s";
        unit += &superscript(rule.seconds);
    }
    if rule.displacement > 0 {
        unit += "/";
        unit += motion.displacement_unit();
        unit += &superscript(rule.displacement);
    }
    unit
}

/// A power, none where it is 1.
#[must_use]
pub fn superscript(power: u8) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    if power == 1 {
        return String::new();
    }
    let digits = power.to_string();
    let raised = digits
        .bytes()
        .map(|digit| DIGITS[usize::from(digit - b'0')]);
    raised.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use DofKind::{Rotation, Translation};

    #[test]
    fn units_are_written_as_people_do() {
        let of = |displacement, seconds, load, motion| {
            let rule = UnitRule {
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
    }
}
