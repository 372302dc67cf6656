//! The methods: which there are, and which command each is for.

use std::fmt;

use serde::Deserialize;

/// The method that a study asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The joint from frequency response functions of substructures and assembly.
    FrfDecoupling,
    /// The joint in space from functions near its interface.
    FrfSpace,
    /// The lap model from natural frequencies.
    LapUpdate,
    /// The lap model from responses at several levels.
    LapResponse,
    /// Contact of fractal surfaces under the bolts' pressure (Zhao).
    FractalContact,
    /// An elastic layer in place of the joint (Tian).
    VirtualMaterial,
    /// A layered beam whose interfaces slip (Kavi).
    LayeredBeam,
    /// Responses of laps whose joint files are there.
    Respond,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::FrfDecoupling,
        Self::FrfSpace,
        Self::LapUpdate,
        Self::LapResponse,
        Self::FractalContact,
        Self::VirtualMaterial,
        Self::LayeredBeam,
        Self::Respond,
    ];

    /// The method of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Its name, as a study has it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::FrfDecoupling => "frf-decoupling",
            Self::FrfSpace => "frf-space",
            Self::LapUpdate => "lap-update",
            Self::LapResponse => "lap-response",
            Self::FractalContact => "fractal-contact",
            Self::VirtualMaterial => "virtual-material",
            Self::LayeredBeam => "layered-beam",
            Self::Respond => "respond",
        }
    }

    /// The command that makes of it what it is for.
    #[must_use]
    pub fn command(self) -> &'static str {
        match self {
            Self::FrfDecoupling | Self::FrfSpace | Self::LapUpdate | Self::LapResponse => {
                "identify"
            }
            Self::FractalContact | Self::VirtualMaterial | Self::LayeredBeam => "predict",
            Self::Respond => "respond",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
