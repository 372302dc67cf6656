//! Which version of the FMI standard an FMU follows, and what the versions call things.

use std::fmt;

/// Version of the FMI standard.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum FmiVersion {
    /// FMI 2.0.
    V2,
    /// FMI 3.0.
    #[default]
    V3,
}

impl FmiVersion {
    /// The attribute `fmiVersion`.
    #[must_use]
    pub fn number(self) -> &'static str {
        match self {
            Self::V2 => "2.0",
            Self::V3 => "3.0",
        }
    }

    /// Folder below `binaries` for a `platform` of FMI 3.0.
    ///
    /// FMI 2.0 has names of its own for x86 alone and takes those of FMI 3.0 for everything else
    /// (FMI 2.0.5, section 2.3; FMI 3.0.2, section 2.5.1.4.2).
    #[must_use]
    pub fn platform_folder(self, platform: &str) -> &str {
        match (self, platform) {
            (Self::V2, "x86-darwin") => "darwin32",
            (Self::V2, "x86_64-darwin") => "darwin64",
            (Self::V2, "x86-linux") => "linux32",
            (Self::V2, "x86_64-linux") => "linux64",
            (Self::V2, "x86-windows") => "win32",
            (Self::V2, "x86_64-windows") => "win64",
            (Self::V2 | Self::V3, other) => other,
        }
    }
}

/// `FMI 3.0`
impl fmt::Display for FmiVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FMI {}", self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::FmiVersion;

    #[test]
    fn platforms_without_a_name_in_fmi_2_keep_that_of_fmi_3() {
        // The table in section 2.5.1.4.2 of FMI 3.0.2 and the list of names in section 2.3 of FMI 2.0.5.
        for (platform, folder) in [
            ("x86_64-darwin", "darwin64"),
            ("x86-linux", "linux32"),
            ("x86_64-linux", "linux64"),
            ("x86-windows", "win32"),
            ("x86_64-windows", "win64"),
            ("aarch64-linux", "aarch64-linux"),
            ("aarch64-darwin", "aarch64-darwin"),
            ("aarch64-windows", "aarch64-windows"),
        ] {
            assert_eq!(FmiVersion::V2.platform_folder(platform), folder);
            assert_eq!(FmiVersion::V3.platform_folder(platform), platform);
        }
    }
}
