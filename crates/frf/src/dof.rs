//! Degrees of freedom, so that every response and every load says where and along what it acts.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Along or about which axis a degree of freedom moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// No direction at all: a scalar point (universal file code 0).
    Scalar,
    /// Translation along x, m.
    X,
    /// Translation along y, m.
    Y,
    /// Translation along z, m.
    Z,
    /// Rotation about x, rad.
    RX,
    /// Rotation about y, rad.
    RY,
    /// Rotation about z, rad.
    RZ,
}

/// The directions in the order of their universal file codes 0 to 6.
const BY_UFF_CODE: [(Direction, &str); 7] = [
    (Direction::Scalar, "0"),
    (Direction::X, "X"),
    (Direction::Y, "Y"),
    (Direction::Z, "Z"),
    (Direction::RX, "RX"),
    (Direction::RY, "RY"),
    (Direction::RZ, "RZ"),
];

impl Direction {
    /// Whether the motion is a rotation (rad), and the load therefore a moment (N·m).
    #[must_use]
    pub fn is_rotation(self) -> bool {
        matches!(self, Self::RX | Self::RY | Self::RZ)
    }

    /// Whether the motion is a translation (m), and the load therefore a force (N).
    #[must_use]
    pub fn is_translation(self) -> bool {
        matches!(self, Self::X | Self::Y | Self::Z)
    }

    fn symbol(self) -> &'static str {
        BY_UFF_CODE[self.uff_code() as usize].1
    }

    fn uff_code(self) -> u8 {
        match self {
            Self::Scalar => 0,
            Self::X => 1,
            Self::Y => 2,
            Self::Z => 3,
            Self::RX => 4,
            Self::RY => 5,
            Self::RZ => 6,
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

/// Whether a degree of freedom counts positive along its axis or against it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Along the axis.
    Plus,
    /// Against the axis.
    Minus,
}

impl Sign {
    /// +1 or −1.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Self::Plus => 1.0,
            Self::Minus => -1.0,
        }
    }

    /// The other sign.
    #[must_use]
    pub fn flipped(self) -> Self {
        match self {
            Self::Plus => Self::Minus,
            Self::Minus => Self::Plus,
        }
    }
}

/// One degree of freedom of a measured structure: a node and a signed direction.
///
/// Written as `11:+Y` or `2:-RZ`; `2:Y` is read as `2:+Y`, and a scalar point is `7:0`.
/// Serde reads and writes the same text. The order is by node, direction, sign.
///
/// ```
/// use bolted_joint_frf::Dof;
/// let tip: Dof = "11:Y".parse()?;
/// assert_eq!(tip.to_string(), "11:+Y");
/// # Ok::<(), bolted_joint_frf::DofError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Dof {
    node: u32,
    direction: Direction,
    sign: Sign,
}

impl Dof {
    /// The degree of freedom of `node` along `direction`; a scalar point has no sign and is always `Plus`.
    #[must_use]
    pub fn new(node: u32, direction: Direction, sign: Sign) -> Self {
        let sign = match direction {
            Direction::Scalar => Sign::Plus,
            _ => sign,
        };
        Self {
            node,
            direction,
            sign,
        }
    }

    /// From a universal file's node number and direction code: 0 scalar, ±1 to ±3 translations, ±4 to ±6 rotations.
    ///
    /// # Errors
    /// [`DofError::UffDirection`] for any other code.
    pub fn from_uff(node: u32, direction_code: i32) -> Result<Self, DofError> {
        let direction = usize::try_from(direction_code.unsigned_abs())
            .ok()
            .and_then(|code| BY_UFF_CODE.get(code))
            .map(|(direction, _)| *direction)
            .ok_or(DofError::UffDirection {
                found: direction_code,
            })?;
        let sign = if direction_code < 0 {
            Sign::Minus
        } else {
            Sign::Plus
        };
        Ok(Self::new(node, direction, sign))
    }

    /// The node's number.
    #[must_use]
    pub fn node(self) -> u32 {
        self.node
    }

    /// The axis.
    #[must_use]
    pub fn direction(self) -> Direction {
        self.direction
    }

    /// Along or against the axis.
    #[must_use]
    pub fn sign(self) -> Sign {
        self.sign
    }

    /// The direction code of universal files, −6 to 6.
    #[must_use]
    pub fn uff_direction_code(self) -> i32 {
        let code = i32::from(self.direction.uff_code());
        match self.sign {
            Sign::Plus => code,
            Sign::Minus => -code,
        }
    }

    /// The same degree of freedom counted the other way round; a scalar point stays what it is.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self::new(self.node, self.direction, self.sign.flipped())
    }
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = match (self.direction, self.sign) {
            (Direction::Scalar, _) => "",
            (_, Sign::Plus) => "+",
            (_, Sign::Minus) => "-",
        };
        write!(f, "{}:{sign}{}", self.node, self.direction)
    }
}

/// Why a text or a code does not name a degree of freedom.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum DofError {
    /// No colon between node and direction.
    #[error(
        "found \"{found}\" as a degree of freedom, expected NODE:DIRECTION such as \"11:+Y\" or \"2:-RZ\""
    )]
    MissingColon {
        /// The whole text.
        found: String,
    },
    /// The part before the colon is no node number.
    #[error(
        "found node \"{node}\" in the degree of freedom \"{found}\", expected a whole number from 0 to {max}",
        max = u32::MAX
    )]
    Node {
        /// The whole text.
        found: String,
        /// The part before the colon.
        node: String,
    },
    /// The part after the colon is no direction.
    #[error(
        "found direction \"{direction}\" in the degree of freedom \"{found}\", \
         expected X, Y, Z, RX, RY or RZ with + or - before it (or 0 for a scalar point)"
    )]
    Direction {
        /// The whole text.
        found: String,
        /// The part after the colon.
        direction: String,
    },
    /// A universal file's direction code that the format does not know.
    #[error(
        "found direction code {found}, expected 0 (scalar), ±1 to ±3 (x, y, z) or ±4 to ±6 (rotations)"
    )]
    UffDirection {
        /// The code.
        found: i32,
    },
}

impl FromStr for Dof {
    type Err = DofError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let found = || text.to_owned();
        let (node, signed) = text
            .trim()
            .split_once(':')
            .ok_or_else(|| DofError::MissingColon { found: found() })?;
        // `u32::from_str` takes a leading plus; a node number has none.
        let number = match node.bytes().all(|byte| byte.is_ascii_digit()) {
            true => node.parse().ok(),
            false => None,
        };
        let number = number.ok_or_else(|| DofError::Node {
            found: found(),
            node: node.to_owned(),
        })?;
        let (sign, symbol) = match (signed.strip_prefix('+'), signed.strip_prefix('-')) {
            (Some(symbol), _) => (Some(Sign::Plus), symbol),
            (_, Some(symbol)) => (Some(Sign::Minus), symbol),
            _ => (None, signed),
        };
        BY_UFF_CODE
            .iter()
            .find(|(_, known)| known.eq_ignore_ascii_case(symbol))
            .map(|(direction, _)| *direction)
            .filter(|direction| *direction != Direction::Scalar || sign.is_none())
            .map(|direction| Self::new(number, direction, sign.unwrap_or(Sign::Plus)))
            .ok_or_else(|| DofError::Direction {
                found: found(),
                direction: signed.to_owned(),
            })
    }
}

impl TryFrom<String> for Dof {
    type Error = DofError;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

impl From<Dof> for String {
    fn from(dof: Dof) -> Self {
        dof.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_degree_of_freedom_are_the_same_thing() {
        for (text, node, code) in [
            ("11:+Y", 11, 2),
            ("2:-RZ", 2, -6),
            ("4294967295:+RX", u32::MAX, 4),
            ("0:-Z", 0, -3),
            ("7:0", 7, 0),
        ] {
            let dof: Dof = text.parse().unwrap();
            assert_eq!(
                (dof.node(), dof.uff_direction_code()),
                (node, code),
                "{text}"
            );
            assert_eq!(Dof::from_uff(node, code).unwrap(), dof);
            assert_eq!(dof.to_string(), text);
        }
        assert_eq!("2:Y".parse::<Dof>().unwrap().to_string(), "2:+Y");
        assert_eq!(" 2:-ry ".parse::<Dof>().unwrap().to_string(), "2:-RY");
    }

    #[test]
    fn each_mistake_has_its_own_error() {
        let error = |text: &str| text.parse::<Dof>().unwrap_err();
        assert!(matches!(error("11Y"), DofError::MissingColon { .. }));
        assert!(matches!(error(""), DofError::MissingColon { .. }));
        for text in ["-1:Y", "+1:Y", ":Y", "a:Y", "4294967296:Y", "1 :Y"] {
            assert!(matches!(error(text), DofError::Node { .. }), "{text}");
        }
        for text in ["1:", "1:+", "1:W", "1:++Y", "1:Y+", "1:-0", "1:+ Y"] {
            assert!(matches!(error(text), DofError::Direction { .. }), "{text}");
        }
        let message = error("3:+YZ").to_string();
        assert!(
            message.contains("\"+YZ\"") && message.contains("\"3:+YZ\"") && message.contains("RX")
        );
        for code in [7, -7, i32::MIN] {
            assert_eq!(
                Dof::from_uff(1, code).unwrap_err(),
                DofError::UffDirection { found: code }
            );
        }
    }

    #[test]
    fn flipping_changes_the_sign_and_nothing_else() {
        let dof: Dof = "3:+RZ".parse().unwrap();
        assert_eq!(dof.flipped().to_string(), "3:-RZ");
        assert_eq!(dof.flipped().flipped(), dof);
        let scalar: Dof = "3:0".parse().unwrap();
        assert_eq!(scalar.flipped(), scalar);
    }

    #[test]
    fn order_is_by_node_then_direction_then_sign() {
        let mut dofs: Vec<Dof> = ["10:+X", "2:-Z", "2:+Z", "2:+RX", "2:+X"]
            .iter()
            .map(|text| text.parse().unwrap())
            .collect();
        dofs.sort();
        let sorted: Vec<String> = dofs.iter().map(Dof::to_string).collect();
        assert_eq!(sorted, ["2:+X", "2:+Z", "2:-Z", "2:+RX", "10:+X"]);
    }

    #[test]
    fn serde_uses_the_text() {
        let dof: Dof = serde_json::from_str("\"2:Y\"").unwrap();
        assert_eq!(serde_json::to_string(&dof).unwrap(), "\"2:+Y\"");
        let error = serde_json::from_str::<Dof>("\"2-Y\"").unwrap_err();
        assert!(error.to_string().contains("expected NODE:DIRECTION"));
    }
}
