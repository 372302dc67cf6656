//! Table 5.1: the specimens, their frequencies and their damping ratios.

use serde::{Deserialize, Serialize};

use bolted_joint_frf::structure::Boundary;
use bolted_joint_predict::layered_beam::{
    BeamMode, Fasteners, Layer, LayeredBeam, LayeredBeamError, NormalForceRule, RIVET_STRESS_PA,
    Route, SlipDamping, StoredEnergy,
};

/// The end conditions of the thesis, in its order.
pub const BOUNDARIES: [Boundary; 3] = [
    Boundary::FixedFixed,
    Boundary::FixedPinned,
    Boundary::PinnedPinned,
];

/// Smallest amplitude of section 5.4.5, m.
pub const AMPLITUDE_M: f64 = 1e-4;

/// Width of all specimens, m.
pub(super) const WIDTH_M: f64 = 0.04125;

/// Modes that are compared.
const MODES: usize = 3;

/// What a specimen is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Material {
    /// MS of Table 5.1.
    MildSteel,
    /// Al of Table 5.1.
    Aluminium,
}

impl Material {
    /// Young's modulus of Table 5.5, Pa.
    pub(super) fn youngs_modulus_pa(self) -> f64 {
        match self {
            Self::MildSteel => 196e9,
            Self::Aluminium => 67.6e9,
        }
    }

    /// Density, kg/m³; the thesis prints none.
    fn density_kg_per_m3(self) -> f64 {
        match self {
            Self::MildSteel => 7850.0,
            Self::Aluminium => 2700.0,
        }
    }

    /// As Table 5.1 has it.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MildSteel => "MS",
            Self::Aluminium => "Al",
        }
    }
}

/// One line of Table 5.1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specimen {
    pub(super) number: usize,
    pub(super) length_mm: f64,
    pub(super) layers_mm: &'static [f64],
    pub(super) rivets: usize,
    pub(super) diameter_mm: f64,
    pub(super) material: Material,
}

const fn specimen(
    number: usize,
    length_mm: f64,
    layers_mm: &'static [f64],
    rivets: usize,
    diameter_mm: f64,
) -> Specimen {
    Specimen {
        number,
        length_mm,
        layers_mm,
        rivets,
        diameter_mm,
        material: Material::MildSteel,
    }
}

/// Specimens 1 to 11; 12 to 22 are the same in aluminium.
const MILD_STEEL: [Specimen; 11] = [
    specimen(1, 370.0, &[3.0, 3.0], 6, 8.0),
    specimen(2, 430.0, &[3.0, 3.0], 6, 8.0),
    specimen(3, 500.0, &[3.0, 3.0], 6, 8.0),
    specimen(4, 430.0, &[2.4, 3.6], 6, 8.0),
    specimen(5, 430.0, &[2.0, 4.0], 6, 8.0),
    specimen(6, 500.0, &[3.0, 3.0], 6, 6.0),
    specimen(7, 500.0, &[3.0, 3.0], 6, 10.0),
    specimen(8, 370.0, &[3.0, 3.0], 4, 8.0),
    specimen(9, 370.0, &[3.0, 3.0], 8, 8.0),
    specimen(10, 430.0, &[2.0, 2.0, 2.0], 6, 8.0),
    specimen(11, 430.0, &[1.5, 1.5, 1.5, 1.5], 6, 8.0),
];

/// Where the rivets are: the thesis says "equispaced along the length" and, of the same specimens, one zone of pressure apart.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Placement {
    /// In the middle of equal parts of the length.
    EqualParts,
    /// One zone of pressure apart about the middle.
    ZonesTouch,
}

/// What else than Table 5.1 can be varied.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Setup {
    pub(super) boundary: Boundary,
    pub(super) placement: Placement,
    pub(super) rule: NormalForceRule,
    pub(super) route: Route,
    pub(super) stored: StoredEnergy,
    pub(super) stiffness_ratio: f64,
    /// Thickness of every layer over that of the table.
    pub(super) thickness_scale: f64,
    /// α′μ.
    pub(super) alpha_mu: f64,
    /// Of the largest deflection, m.
    pub(super) amplitude_m: f64,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            boundary: Boundary::FixedFixed,
            placement: Placement::EqualParts,
            rule: NormalForceRule::Polynomial,
            route: Route::Classical,
            stored: StoredEnergy::Modal,
            stiffness_ratio: 1.0,
            thickness_scale: 1.0,
            alpha_mu: 1.0,
            amplitude_m: AMPLITUDE_M,
        }
    }
}

impl Setup {
    pub(super) fn with(boundary: Boundary) -> Self {
        Self {
            boundary,
            ..Self::default()
        }
    }
}

impl Specimen {
    /// A specimen by its number in Table 5.1, from 1 to 22.
    pub(super) fn numbered(number: usize) -> Self {
        let place = number.saturating_sub(1);
        let own = MILD_STEEL[place % MILD_STEEL.len()];
        Self {
            number,
            material: if place < MILD_STEEL.len() {
                Material::MildSteel
            } else {
                Material::Aluminium
            },
            ..own
        }
    }

    pub(super) fn beam(&self, setup: &Setup) -> Result<LayeredBeam, LayeredBeamError> {
        let layer = |thickness_mm: &f64| Layer {
            thickness_m: 1e-3 * thickness_mm * setup.thickness_scale,
            youngs_modulus_pa: self.material.youngs_modulus_pa(),
            density_kg_per_m3: self.material.density_kg_per_m3(),
        };
        LayeredBeam::new(
            1e-3 * self.length_mm,
            WIDTH_M,
            self.layers_mm.iter().map(layer).collect(),
            setup.boundary,
            setup.stiffness_ratio,
        )
    }

    pub(super) fn rivets(&self, setup: &Setup) -> Result<Fasteners, LayeredBeamError> {
        let (diameter_m, length_m) = (1e-3 * self.diameter_mm, 1e-3 * self.length_mm);
        let of = |positions_m| {
            let rivets = Fasteners::rivets(diameter_m, RIVET_STRESS_PA, positions_m)?;
            Ok::<_, LayeredBeamError>(rivets.with_rule(setup.rule))
        };
        let equal = of(Fasteners::equispaced(self.rivets, length_m))?;
        match setup.placement {
            Placement::EqualParts => Ok(equal),
            Placement::ZonesTouch => {
                let pitch_m = equal.zone_diameter_m(&self.beam(setup)?);
                of(Fasteners::about_the_middle(self.rivets, pitch_m, length_m))
            }
        }
    }

    pub(super) fn mode(&self, setup: &Setup, number: usize) -> Result<BeamMode, LayeredBeamError> {
        let (beam, rivets) = (self.beam(setup)?, self.rivets(setup)?);
        BeamMode::new(&beam, &rivets, number, None, setup.route, setup.stored)
    }

    /// ζ/α′μ of the first mode at the setup's amplitude.
    pub(super) fn damping(&self, setup: &Setup) -> Result<f64, LayeredBeamError> {
        self.damping_of(setup, self.mode(setup, 1)?)
    }

    fn damping_of(&self, setup: &Setup, mode: BeamMode) -> Result<f64, LayeredBeamError> {
        let (beam, rivets) = (self.beam(setup)?, self.rivets(setup)?);
        let damping = SlipDamping::new(&beam, &rivets, mode, setup.alpha_mu)?;
        Ok(damping.damping_ratio(setup.amplitude_m))
    }

    /// Diameter of the zone of pressure, mm.
    pub(super) fn zone_mm(&self, setup: &Setup) -> Result<f64, LayeredBeamError> {
        Ok(1e3 * self.rivets(setup)?.zone_diameter_m(&self.beam(setup)?))
    }
}

/// One specimen, computed.
#[derive(Clone, Debug, Serialize)]
pub struct SpecimenRow {
    /// Number in Table 5.1.
    pub number: usize,
    /// Length, mm.
    pub length_mm: f64,
    /// Thicknesses of the layers, mm.
    pub layers_mm: Vec<f64>,
    /// Number of rivets.
    pub rivets: usize,
    /// Their diameter, mm.
    pub diameter_mm: f64,
    /// What it is made of.
    pub material: Material,
    /// Normal force of a rivet on each interface, N.
    pub normal_force_n: f64,
    /// For fixed–fixed, fixed–pinned and pinned–pinned ends.
    pub at: Vec<AtBoundary>,
    /// Diameter of the zone of pressure, mm.
    pub zone_mm: f64,
}

/// A specimen with one kind of ends.
#[derive(Clone, Debug, Serialize)]
pub struct AtBoundary {
    /// Its ends.
    pub boundary: Boundary,
    /// First three frequencies by the frequency equation, Hz.
    pub frequency_hz: Vec<f64>,
    /// Largest deviation of those by finite elements, relative.
    pub finite_element_deviation: f64,
    /// ζ/α′μ of the first mode at [`AMPLITUDE_M`].
    pub damping: f64,
    /// The same by finite elements.
    pub finite_element_damping: f64,
}

pub(super) fn all() -> Result<Vec<SpecimenRow>, LayeredBeamError> {
    (1..=2 * MILD_STEEL.len())
        .map(|number| row(&Specimen::numbered(number)))
        .collect()
}

fn row(specimen: &Specimen) -> Result<SpecimenRow, LayeredBeamError> {
    let at = BOUNDARIES.map(|boundary| {
        let setup = Setup::with(boundary);
        let elements = Setup {
            route: Route::FiniteElements,
            ..setup
        };
        let of = |setup: &Setup| {
            let modes = (1..=MODES).map(|mode| specimen.mode(setup, mode));
            let modes = modes.collect::<Result<Vec<BeamMode>, LayeredBeamError>>()?;
            let frequencies: Vec<f64> = modes.iter().map(BeamMode::frequency_hz).collect();
            let first = modes[0].clone();
            let damping = specimen.damping_of(setup, first)?;
            Ok::<_, LayeredBeamError>((frequencies, damping))
        };
        let (frequency_hz, damping) = of(&setup)?;
        let (by_elements, finite_element_damping) = of(&elements)?;
        let deviations = by_elements.iter().zip(&frequency_hz);
        let deviations = deviations.map(|(elements, exact)| (elements / exact - 1.0).abs());
        Ok(AtBoundary {
            boundary,
            finite_element_deviation: deviations.fold(0.0, f64::max),
            frequency_hz,
            damping,
            finite_element_damping,
        })
    });
    let setup = Setup::default();
    let (beam, rivets) = (specimen.beam(&setup)?, specimen.rivets(&setup)?);
    Ok(SpecimenRow {
        number: specimen.number,
        length_mm: specimen.length_mm,
        layers_mm: specimen.layers_mm.to_vec(),
        rivets: specimen.rivets,
        diameter_mm: specimen.diameter_mm,
        material: specimen.material,
        normal_force_n: rivets
            .normal_forces_n(&beam)?
            .into_iter()
            .fold(0.0, f64::max),
        at: at.into_iter().collect::<Result<_, LayeredBeamError>>()?,
        zone_mm: specimen.zone_mm(&setup)?,
    })
}
