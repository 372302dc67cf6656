//! Specific data types: the standard's codes of what an axis carries.

/// A specific data type, as far as it matters here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Displacement, velocity or acceleration: 0, 1 or 2 time derivatives.
    Motion(i32),
    Load,
    Unstated,
    Other,
}

pub(super) fn kind(data_type: i64) -> Kind {
    match data_type {
        8 => Kind::Motion(0),
        11 => Kind::Motion(1),
        12 => Kind::Motion(2),
        9 | 13 => Kind::Load,
        0 | 1 => Kind::Unstated,
        _ => Kind::Other,
    }
}

/// Whether a specific data type is a force or a moment.
pub(super) fn is_load(data_type: i64) -> bool {
    kind(data_type) == Kind::Load
}

pub(super) fn data_type_name(data_type: i64) -> String {
    let name = match data_type {
        0 => "unknown",
        1 => "general",
        2 => "stress",
        3 => "strain",
        5 => "temperature",
        6 => "heat flux",
        8 => "displacement",
        9 => "reaction force",
        11 => "velocity",
        12 => "acceleration",
        13 => "excitation force",
        15 => "pressure",
        16 => "mass",
        17 => "time",
        18 => "frequency",
        19 => "rotational speed",
        20 => "order",
        _ => "no known quantity",
    };
    format!("{name} (data type {data_type})")
}

pub(super) fn inverse_name(derivatives: i32) -> &'static str {
    match derivatives {
        0 => "dynamic stiffness",
        1 => "impedance",
        _ => "apparent mass",
    }
}
