//! The complete state of an instance, and its form in bytes.
//!
//! All integers and floats are little endian:
//!
//! | bytes | content |
//! |---|---|
//! | 8 | `bjstate` and a zero |
//! | 4 | version of this layout |
//! | 4 + n | length of the instantiation token, and the token |
//! | 1 | FMI version: 2 or 3 |
//! | 1 | kind: 0 element, 1 lap |
//! | 1 | degrees of freedom |
//! | 1 | joint: 0 constant, 1 over the preload |
//! | 1 | interface type: 0 Co-Simulation, 1 Model Exchange |
//! | 1 | state of the state machine |
//! | 1 + 8 | whether there is a stop time, and the stop time |
//! | 8 + 1 | length of the latest communication step, and how often it came in a row |
//! | 4 + 8 n | number of values, and the values by value reference, then what is remembered beside the variables |
//! | 3 + 8 m | which inputs have derivatives, for which step, and the derivatives of first to third order by input |
//! | 8 | FNV-1a hash of all bytes before |

use std::{fmt, sync::Arc};

use crate::{
    abi::Abi,
    input_course::InputCourse,
    interface::{Dependence, Dofs, InterfaceType, Kind, VALUE_COUNT, Values, Variables},
    mode::Mode,
    pace::Pace,
    refusal::Refusal,
};

const MAGIC: [u8; 8] = *b"bjstate\0";
const VERSION: u32 = 4;

/// What makes two FMUs the same one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Identity {
    /// Kind, degrees of freedom, and whether the joint is one over the preload.
    pub(crate) variables: Variables,
    /// FMI version.
    pub(crate) abi: Abi,
    /// Who integrates.
    pub(crate) interface_type: InterfaceType,
    /// Instantiation token.
    pub(crate) token: String,
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Variables {
            kind,
            dofs,
            dependence,
        } = self.variables;
        let preload = match dependence {
            Dependence::OverPreload => " over the preload",
            Dependence::Constant => "",
            Dependence::Memory(_) => " with memory",
        };
        write!(
            f,
            "{} with {} DOF a side{preload} for {} of {}, token {}",
            kind.name(),
            dofs.count(),
            self.interface_type.name(),
            self.abi.name(),
            self.token
        )
    }
}

/// Everything that an instance has to remember to go on from here, bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Snapshot {
    /// FMU that it belongs to.
    pub(crate) identity: Arc<Identity>,
    /// State of the state machine.
    pub(crate) mode: Mode,
    /// Stop time, s.
    pub(crate) stop_s: Option<f64>,
    /// How regular the communication steps were.
    pub(crate) pace: Pace,
    /// Values of all variables, time among them.
    pub(crate) values: Values,
    /// How the inputs go on.
    pub(crate) inputs: InputCourse,
}

/// Why bytes are no FMU state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Damage {
    /// They do not begin like one.
    Magic,
    /// They have another layout.
    Version { found: u32 },
    /// They are too many or too few.
    Length { found: usize, expected: usize },
    /// They are not those that were written.
    Checksum,
    /// A field has a value that it cannot have.
    Field { name: &'static str },
    /// A variable is NaN or infinite.
    Value { name: &'static str },
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Magic => f.write_str("the bytes were not written by this library"),
            Self::Version { found } => {
                write!(
                    f,
                    "it has layout {found}, this library reads layout {VERSION}"
                )
            }
            Self::Length { found, expected } => {
                write!(f, "it has {found} bytes, expected {expected}")
            }
            Self::Checksum => f.write_str("its checksum is wrong, the bytes were changed"),
            Self::Field { name } => write!(f, "its {name} is impossible"),
            Self::Value { name } => write!(f, "its value of {name} is impossible"),
        }
    }
}

impl Snapshot {
    /// Number of bytes of the serialised state.
    pub(crate) fn serialized_size(&self) -> usize {
        let header = MAGIC.len() + 4 + 4 + self.identity.token.len() + 9;
        header + 1 + 8 + Pace::SIZE + 4 + 8 * VALUE_COUNT + InputCourse::SIZE + 8
    }

    /// The state in bytes.
    pub(crate) fn serialize(&self) -> Vec<u8> {
        let Identity {
            variables,
            abi,
            interface_type,
            token,
        } = &*self.identity;
        let mut bytes = Vec::with_capacity(self.serialized_size());
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((token.len() as u32).to_le_bytes());
        bytes.extend(token.as_bytes());
        bytes.push(match abi {
            Abi::Fmi2 => 2,
            Abi::Fmi3 => 3,
        });
        bytes.push(kind_number(variables.kind));
        bytes.push(variables.dofs.count());
        bytes.extend(variables.dependence.number().to_le_bytes());
        bytes.push(match interface_type {
            InterfaceType::CoSimulation => 0,
            InterfaceType::ModelExchange => 1,
        });
        bytes.push(self.mode.number());
        bytes.push(u8::from(self.stop_s.is_some()));
        bytes.extend(self.stop_s.unwrap_or(0.0).to_le_bytes());
        bytes.extend(self.pace.to_bytes());
        bytes.extend((VALUE_COUNT as u32).to_le_bytes());
        for value in self.values {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend(self.inputs.to_bytes());
        bytes.extend(fnv1a(&bytes).to_le_bytes());
        bytes
    }

    /// The state that was serialised, if it is one of the FMU `identity`.
    pub(crate) fn deserialize(bytes: &[u8], identity: &Arc<Identity>) -> Result<Self, Refusal> {
        let mut reader = Reader {
            rest: bytes,
            total: bytes.len(),
        };
        if reader.array::<8>()? != MAGIC {
            return Err(Damage::Magic.into());
        }
        let version = reader.u32()?;
        if version != VERSION {
            return Err(Damage::Version { found: version }.into());
        }
        let (content, checksum) = bytes.split_last_chunk::<8>().ok_or(Damage::Length {
            found: bytes.len(),
            expected: 8,
        })?;
        if fnv1a(content) != u64::from_le_bytes(*checksum) {
            return Err(Damage::Checksum.into());
        }
        let length = reader.u32()? as usize;
        let token = String::from_utf8(reader.take(length)?.to_vec())
            .map_err(|_| Damage::Field { name: "token" })?;
        let abi = match reader.u8()? {
            2 => Abi::Fmi2,
            3 => Abi::Fmi3,
            _ => {
                return Err(Damage::Field {
                    name: "FMI version",
                }
                .into());
            }
        };
        let kind = match reader.u8()? {
            0 => Kind::Element,
            1 => Kind::Lap,
            _ => return Err(Damage::Field { name: "kind" }.into()),
        };
        let dofs = match reader.u8()? {
            1 => Dofs::One,
            2 => Dofs::Two,
            _ => {
                return Err(Damage::Field {
                    name: "number of degrees of freedom",
                }
                .into());
            }
        };
        let dependence =
            Dependence::from_number(reader.u32()?).ok_or(Damage::Field { name: "joint" })?;
        let interface_type = match reader.u8()? {
            0 => InterfaceType::CoSimulation,
            1 => InterfaceType::ModelExchange,
            _ => {
                return Err(Damage::Field {
                    name: "interface type",
                }
                .into());
            }
        };
        let found = Identity {
            variables: Variables {
                kind,
                dofs,
                dependence,
            },
            abi,
            interface_type,
            token,
        };
        if found != **identity {
            return Err(Refusal::OtherFmu {
                found: found.to_string(),
                expected: identity.to_string(),
            });
        }
        let mode = Mode::from_number(reader.u8()?)
            .filter(|mode| mode.belongs_to(identity.abi, interface_type))
            .ok_or(Damage::Field { name: "mode" })?;
        let has_stop = reader.u8()? != 0;
        let stop_s = reader.f64()?;
        if !stop_s.is_finite() {
            return Err(Damage::Field { name: "stop time" }.into());
        }
        let pace = Pace::from_bytes(reader.array()?).ok_or(Damage::Field {
            name: "communication step",
        })?;
        if reader.u32()? as usize != VALUE_COUNT {
            return Err(Damage::Field {
                name: "number of variables",
            }
            .into());
        }
        let mut values = [0.0; VALUE_COUNT];
        for (reference, value) in values.iter_mut().enumerate() {
            *value = reader.f64()?;
            if !value.is_finite() {
                return Err(Damage::Value {
                    name: identity.variables.name(reference),
                }
                .into());
            }
        }
        let inputs = InputCourse::from_bytes(reader.array()?).ok_or(Damage::Field {
            name: "course of the inputs",
        })?;
        reader.array::<8>()?;
        if !reader.rest.is_empty() {
            let expected = bytes.len() - reader.rest.len();
            return Err(Damage::Length {
                found: bytes.len(),
                expected,
            }
            .into());
        }
        Ok(Self {
            identity: Arc::clone(identity),
            mode,
            stop_s: has_stop.then_some(stop_s),
            pace,
            values,
            inputs,
        })
    }
}

/// Takes fields from the front of the bytes.
struct Reader<'a> {
    rest: &'a [u8],
    total: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], Damage> {
        let (field, rest) = self.rest.split_at_checked(length).ok_or(Damage::Length {
            found: self.total,
            expected: (self.total - self.rest.len()).saturating_add(length),
        })?;
        self.rest = rest;
        Ok(field)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Damage> {
        let field = self.take(N)?;
        let mut array = [0; N];
        array.copy_from_slice(field);
        Ok(array)
    }

    fn u8(&mut self) -> Result<u8, Damage> {
        self.array().map(u8::from_le_bytes)
    }

    fn u32(&mut self) -> Result<u32, Damage> {
        self.array().map(u32::from_le_bytes)
    }

    fn f64(&mut self) -> Result<f64, Damage> {
        self.array().map(f64::from_le_bytes)
    }
}

const fn kind_number(kind: Kind) -> u8 {
    match kind {
        Kind::Element => 0,
        Kind::Lap => 1,
    }
}

/// 64-bit FNV-1a hash.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::fnv1a;

    #[test]
    fn the_hash_is_fnv1a() {
        // published test vectors of the FNV reference code
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }
}
