//! The two versions of FMI that the library speaks, and the words in which they differ.

/// Which functions an instance was made by, and is used through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Abi {
    /// FMI 2.0.
    Fmi2,
    /// FMI 3.0.
    Fmi3,
}

/// What messages call things by: the importer's own words, which are those of the version's headers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Words {
    /// The version itself.
    pub(crate) version: &'static str,
    /// The type that all variables have.
    pub(crate) real: &'static str,
    /// Argument that holds the token.
    pub(crate) token: &'static str,
    /// Argument that tells where the resources are.
    pub(crate) resources: &'static str,
    /// Arguments for variables and their values.
    pub(crate) references: &'static str,
    pub(crate) values: &'static str,
    /// Argument for the orders of derivatives.
    pub(crate) orders: &'static str,
    /// Arguments of partial derivatives.
    pub(crate) unknowns: &'static str,
    pub(crate) knowns: &'static str,
    pub(crate) seed: &'static str,
    pub(crate) sensitivity: &'static str,
    /// Arguments for continuous states, their number and their typical magnitudes.
    pub(crate) states: &'static str,
    pub(crate) state_count: &'static str,
    pub(crate) nominals: &'static str,
    /// Argument that counts event indicators.
    pub(crate) indicator_count: &'static str,
}

impl Abi {
    /// The words of this version.
    pub(crate) const fn words(self) -> &'static Words {
        match self {
            Self::Fmi2 => &Words {
                version: "FMI 2.0",
                real: "Real",
                token: "fmuGUID",
                resources: "fmuResourceLocation",
                references: "vr",
                values: "value",
                orders: "order",
                unknowns: "vUnknown_ref",
                knowns: "vKnown_ref",
                seed: "dvKnown",
                sensitivity: "dvUnknown",
                states: "x",
                state_count: "nx",
                nominals: "x_nominal",
                indicator_count: "ni",
            },
            Self::Fmi3 => &Words {
                version: "FMI 3.0",
                real: "Float64",
                token: "instantiationToken",
                resources: "resourcePath",
                references: "valueReferences",
                values: "values",
                orders: "orders",
                unknowns: "unknowns",
                knowns: "knowns",
                seed: "seed",
                sensitivity: "sensitivity",
                states: "continuousStates",
                state_count: "nContinuousStates",
                nominals: "nominals",
                indicator_count: "nEventIndicators",
            },
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
