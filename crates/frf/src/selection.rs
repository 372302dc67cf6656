//! Which functions and lines of a file to keep: what nobody asked for is passed over while a large file is read.

use std::collections::BTreeSet;

use super::{Dof, Sign};

/// The functions and lines to keep of a file; by default all.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Selection {
    /// With the sign of their axis, whichever was asked for; `None` for all.
    dofs: Option<BTreeSet<Dof>>,
    band_hz: Option<[f64; 2]>,
}

impl Selection {
    pub(super) const ALL: Self = Self {
        dofs: None,
        band_hz: None,
    };

    /// Every function on every line.
    #[must_use]
    pub fn everything() -> Self {
        Self::ALL
    }

    /// The functions whose response and reference are both among `dofs`, either way round.
    #[must_use]
    pub fn between(dofs: impl IntoIterator<Item = Dof>) -> Self {
        Self {
            dofs: Some(dofs.into_iter().map(unsigned).collect()),
            band_hz: None,
        }
    }

    /// The same functions, from `from_hz` to `to_hz` (Hz) only, both included.
    #[must_use]
    pub fn within(self, from_hz: f64, to_hz: f64) -> Self {
        Self {
            band_hz: Some([from_hz, to_hz]),
            ..self
        }
    }

    /// Whether a function between these two is asked for.
    #[must_use]
    pub fn wants(&self, response: Dof, reference: Dof) -> bool {
        self.dofs.as_ref().is_none_or(|dofs| {
            dofs.contains(&unsigned(response)) && dofs.contains(&unsigned(reference))
        })
    }

    /// The band to keep, Hz; `None` for every line.
    #[must_use]
    pub fn band_hz(&self) -> Option<[f64; 2]> {
        self.band_hz
    }

    /// Whether a line at this frequency is asked for; one that is no number is, so that it does not go unnoticed.
    pub(super) fn wants_line(&self, hz: f64) -> bool {
        self.band_hz
            .is_none_or(|[from, to]| !(hz < from || hz > to))
    }
}

/// The degree of freedom counted along its axis.
pub(super) fn unsigned(dof: Dof) -> Dof {
    Dof::new(dof.node(), dof.direction(), Sign::Plus)
}
