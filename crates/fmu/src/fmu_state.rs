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
//! | 1 | kind: 0 element, 1 lap, 2 assembly |
//! | 1 | degrees of freedom: 1 and 2 in a plane; 128 and a bit for each of those in space; 0 of an assembly |
//! | 4 | joint: a bit each for constant, over the preload, and the laws that remember; 0 of an assembly |
//! | 1 | interface type: 0 Co-Simulation, 1 Model Exchange |
//! | 1 | state of the state machine |
//! | 1 + 8 | whether there is a stop time, and the stop time |
//! | 8 + 1 | length of the latest communication step, and how often it came in a row |
//! | 4 + 8 n | number of values, and all of them: by value reference, but for further laws of a kind where the joint has none; then
//!   what is remembered beside them |
//! | 4 + 8 l | number of numbers that the joint remembers, with those for event indicators and those from which an assembly goes
//!   on, and these |
//! | 9 + k + 8 m | which inputs have derivatives, for which step, of k inputs of an assembly which have, and the derivatives of
//!   first to third order by input |
//! | 8 | FNV-1a hash of all bytes before |

use std::{fmt, sync::Arc};

use crate::{
    input_course::InputCourse,
    interface::{
        BuiltVariables, Dependence, Dofs, InterfaceType, Kind, ListedVariables, Name,
        REFERENCE_COUNT, VALUE_COUNT, Values, Variables, is_beside,
    },
    mode::Mode,
    pace::Pace,
    values::Inner,
    version::Abi,
};

const MAGIC: [u8; 8] = *b"bjstate\0";
const VERSION: u32 = 9;
/// Number of an assembly, beside those of [`Kind`].
const ASSEMBLY: u8 = 2;

/// An enumeration of which one byte is written.
trait Numbered: Copy + 'static {
    const ALL: &'static [Self];

    fn number(self) -> u8;
}

macro_rules! numbered {
    ($($type:ident { $($variant:ident = $number:literal),* })*) => {$(
        impl Numbered for $type {
            const ALL: &'static [Self] = &[$(Self::$variant),*];

            fn number(self) -> u8 {
                match self {
                    $(Self::$variant => $number),*
                }
            }
        }
    )*};
}

numbered! {
    Abi { Fmi2 = 2, Fmi3 = 3 }
    Kind { Element = 0, Lap = 1 }
    InterfaceType { CoSimulation = 0, ModelExchange = 1 }
    Mode {
        Instantiated = 0, Initialization = 1, Step = 2, Terminated = 3, Event = 4, ContinuousTime = 5, SetUp = 6,
        IntermediateUpdate = 7
    }
}

/// What makes two FMUs the same one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Identity {
    /// Its variables, and what they depend on.
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
        match &self.variables {
            Variables::Built(BuiltVariables {
                kind,
                dofs,
                dependence,
            }) => {
                let preload = match dependence {
                    Dependence::OverPreload(0) => " over the preload",
                    Dependence::OverPreload(_) => " over the preload with memory",
                    Dependence::Constant => "",
                    Dependence::Memory(_) => " with memory",
                };
                write!(f, "{} with {dofs} a side{preload}", kind.name())?;
            }
            Variables::Listed(_) => f.write_str("assembly")?,
        }
        write!(
            f,
            " for {} of {}, token {}",
            self.interface_type.name(),
            self.abi.words().version,
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
    /// Values of all variables, time among them, and what is remembered beside them.
    pub(crate) values: Values,
    /// How the inputs go on.
    pub(crate) inputs: InputCourse,
}

/// Why a state is not taken up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum StateError {
    /// It is one of another FMU.
    OtherFmu { found: String, expected: String },
    /// The bytes do not begin like a state.
    Magic,
    /// They have another layout.
    Version { found: u32 },
    /// They are too many or too few.
    Length { found: usize, expected: usize },
    /// They are not those that were written.
    Checksum,
    /// They hold more or fewer values than an instance remembers: another build of the library wrote them.
    Values { found: u32, expected: u32 },
    /// A field has a value that it cannot have.
    Field { name: &'static str },
    /// A variable is NaN or infinite.
    Value { name: Name },
    /// A number that is remembered beside the variables is NaN or infinite.
    Remembered { index: usize },
}

impl StateError {
    /// Refuses a state of another FMU.
    pub(crate) fn unless_same(found: &Identity, expected: &Identity) -> Result<(), Self> {
        if found == expected {
            return Ok(());
        }
        Err(Self::OtherFmu {
            found: found.to_string(),
            expected: expected.to_string(),
        })
    }
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !matches!(self, Self::OtherFmu { .. }) {
            f.write_str("the serialised FMU state cannot be used: ")?;
        }
        match self {
            Self::OtherFmu { found, expected } => write!(
                f,
                "the FMU state is that of \"{found}\", but this is \"{expected}\"; states fit only the FMU that they come from"
            ),
            Self::Magic => f.write_str("the bytes were not written by this library"),
            Self::Version { found } => write!(
                f,
                "it has layout {found}, this library reads layout {VERSION}"
            ),
            Self::Length { found, expected } => {
                write!(f, "it has {found} bytes, expected {expected}")
            }
            Self::Checksum => f.write_str("its checksum is wrong, the bytes were changed"),
            Self::Values { found, expected } => write!(
                f,
                "it has {found} values, this library remembers {expected}: another build of the library wrote it"
            ),
            Self::Field { name } => write!(f, "its {name} is impossible"),
            Self::Value { name } => write!(f, "its value of {name} is impossible"),
            Self::Remembered { index } => write!(
                f,
                "number {index} of what it remembers beside the variables is impossible"
            ),
        }
    }
}

impl Snapshot {
    /// The state in bytes.
    pub(crate) fn serialize(&self) -> Vec<u8> {
        let Identity {
            variables,
            abi,
            interface_type,
            token,
        } = &*self.identity;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((token.len() as u32).to_le_bytes());
        bytes.extend(token.as_bytes());
        bytes.push(abi.number());
        let (kind, joint) = match variables {
            Variables::Built(own) => (
                [own.kind.number(), own.dofs.number()],
                own.dependence.number(),
            ),
            Variables::Listed(_) => ([ASSEMBLY, 0], 0),
        };
        bytes.extend(kind);
        bytes.extend(joint.to_le_bytes());
        bytes.extend([interface_type.number(), self.mode.number()]);
        bytes.push(u8::from(self.stop_s.is_some()));
        bytes.extend(self.stop_s.unwrap_or(0.0).to_le_bytes());
        bytes.extend(self.pace.to_bytes());
        bytes.extend((self.values.indices().count() as u32).to_le_bytes());
        for index in self.values.indices() {
            bytes.extend(self.values[index].to_le_bytes());
        }
        bytes.extend((self.values.remembered_count() as u32).to_le_bytes());
        bytes.extend(self.values.remembered().flat_map(f64::to_le_bytes));
        bytes.extend(self.inputs.to_bytes());
        bytes.extend(fnv1a(&bytes).to_le_bytes());
        bytes
    }

    /// The state that was serialised, if it is one of the FMU `identity`.
    pub(crate) fn deserialize(bytes: &[u8], identity: &Arc<Identity>) -> Result<Self, StateError> {
        let mut reader = Reader {
            rest: bytes,
            total: bytes.len(),
        };
        if reader.array::<8>()? != MAGIC {
            return Err(StateError::Magic);
        }
        let version = reader.u32()?;
        if version != VERSION {
            return Err(StateError::Version { found: version });
        }
        let (content, checksum) = bytes.split_last_chunk::<8>().ok_or(StateError::Length {
            found: bytes.len(),
            expected: 8,
        })?;
        if fnv1a(content) != u64::from_le_bytes(*checksum) {
            return Err(StateError::Checksum);
        }
        let length = reader.u32()? as usize;
        let token = String::from_utf8(reader.take(length)?.to_vec())
            .map_err(|_| StateError::Field { name: "token" })?;
        let abi = reader.one_of("FMI version")?;
        let variables = reader.variables(&identity.variables)?;
        let found = Identity {
            variables,
            abi,
            interface_type: reader.one_of("interface type")?,
            token,
        };
        StateError::unless_same(&found, identity)?;
        let mode: Mode = reader.one_of("mode")?;
        if !mode.belongs_to(abi, found.interface_type) {
            return Err(StateError::Field { name: "mode" });
        }
        let has_stop = reader.u8()? != 0;
        let stop_s = reader.f64()?;
        if !stop_s.is_finite() {
            return Err(StateError::Field { name: "stop time" });
        }
        let pace = Pace::from_bytes(reader.array()?).ok_or(StateError::Field {
            name: "communication step",
        })?;
        let values = reader.values(&found.variables, found.interface_type)?;
        let listed = found.variables.listed_inputs();
        let inputs = InputCourse::from_bytes(reader.take(InputCourse::size(listed))?, listed);
        let inputs = inputs.ok_or(StateError::Field {
            name: "course of the inputs",
        })?;
        reader.array::<8>()?;
        if !reader.rest.is_empty() {
            return Err(StateError::Length {
                found: bytes.len(),
                expected: bytes.len() - reader.rest.len(),
            });
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
    fn take(&mut self, length: usize) -> Result<&'a [u8], StateError> {
        let (field, rest) = self
            .rest
            .split_at_checked(length)
            .ok_or(StateError::Length {
                found: self.total,
                expected: (self.total - self.rest.len()).saturating_add(length),
            })?;
        self.rest = rest;
        Ok(field)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], StateError> {
        let field = self.take(N)?;
        let mut array = [0; N];
        array.copy_from_slice(field);
        Ok(array)
    }

    fn u8(&mut self) -> Result<u8, StateError> {
        self.array().map(u8::from_le_bytes)
    }

    fn u32(&mut self) -> Result<u32, StateError> {
        self.array().map(u32::from_le_bytes)
    }

    fn f64(&mut self) -> Result<f64, StateError> {
        self.array().map(f64::from_le_bytes)
    }

    fn one_of<T: Numbered>(&mut self, name: &'static str) -> Result<T, StateError> {
        let found = self.u8()?;
        let mut all = T::ALL.iter().copied();
        all.find(|value| value.number() == found)
            .ok_or(StateError::Field { name })
    }

    /// The variables of the FMU that a state is of; `own` are those of this FMU.
    fn variables(&mut self, own: &Variables) -> Result<Variables, StateError> {
        if self.rest.first() == Some(&ASSEMBLY) {
            self.take(6)?;
            return Ok(match own {
                Variables::Listed(_) => own.clone(),
                // of another FMU, whose list is not known here
                Variables::Built(_) => Variables::Listed(Arc::new(ListedVariables::default())),
            });
        }
        let kind = self.one_of("kind")?;
        let dofs = Dofs::from_number(self.u8()?).ok_or(StateError::Field {
            name: "degrees of freedom",
        })?;
        let dependence =
            Dependence::from_number(self.u32()?).ok_or(StateError::Field { name: "joint" })?;
        Ok(Variables::Built(BuiltVariables {
            kind,
            dofs,
            dependence,
        }))
    }

    /// The number of numbers that come next.
    fn count(&mut self, expected: usize) -> Result<(), StateError> {
        let found = self.u32()?;
        if found as usize == expected {
            return Ok(());
        }
        Err(StateError::Values {
            found,
            expected: expected as u32,
        })
    }

    /// Everything that an instance remembers as numbers: as many as this build of the library has.
    fn values(
        &mut self,
        variables: &Variables,
        interface_type: InterfaceType,
    ) -> Result<Values, StateError> {
        let mut values = Values::at_rest(variables);
        values.set_inner(Inner::of(interface_type));
        self.count(values.indices().count())?;
        for place in values.indices() {
            values[place] = self.f64()?;
            if !values[place].is_finite() {
                return Err(match is_beside(place) {
                    true => StateError::Remembered {
                        index: place - REFERENCE_COUNT,
                    },
                    false => StateError::Value {
                        name: variables.name(place),
                    },
                });
            }
        }
        self.count(values.remembered_count())?;
        for (place, number) in values.remembered_mut().enumerate() {
            *number = self.f64()?;
            if !number.is_finite() {
                let index = VALUE_COUNT - REFERENCE_COUNT + place;
                return Err(StateError::Remembered { index });
            }
        }
        Ok(values)
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
