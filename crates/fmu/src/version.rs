//! The two versions of FMI that the library speaks, and the words in which they differ.

/// Which functions an instance was made by, and is used through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Abi {
    /// FMI 2.0.
    Fmi2,
    /// FMI 3.0.
    Fmi3,
}

impl Abi {
    /// Name for messages.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Fmi2 => "FMI 2.0",
            Self::Fmi3 => "FMI 3.0",
        }
    }

    /// The importer's name of the type that all variables have.
    pub(crate) const fn real(self) -> &'static str {
        match self {
            Self::Fmi2 => "Real",
            Self::Fmi3 => "Float64",
        }
    }

    /// Argument that holds the token.
    pub(crate) const fn token_argument(self) -> &'static str {
        match self {
            Self::Fmi2 => "fmuGUID",
            Self::Fmi3 => "instantiationToken",
        }
    }

    /// Argument that tells where the resources are.
    pub(crate) const fn resource_argument(self) -> &'static str {
        match self {
            Self::Fmi2 => "fmuResourceLocation",
            Self::Fmi3 => "resourcePath",
        }
    }

    /// Argument that counts continuous states.
    pub(crate) const fn state_count_argument(self) -> &'static str {
        match self {
            Self::Fmi2 => "nx",
            Self::Fmi3 => "nContinuousStates",
        }
    }

    /// The other one.
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Fmi2 => Self::Fmi3,
            Self::Fmi3 => Self::Fmi2,
        }
    }
}
