//! Layered beams whose interfaces slip.

mod damping;
mod free_decay;
mod lap;
mod modes;
mod refusals;
mod study;

use bolted_joint::predict::layered_beam::{
    BeamMode, Fasteners, Layer, LayeredBeam, Route, StoredEnergy,
};
use bolted_joint::structure::Boundary;
use serde::Deserialize;

pub(crate) const BOUNDARIES: [Boundary; 6] = [
    Boundary::FixedFixed,
    Boundary::FixedPinned,
    Boundary::PinnedPinned,
    Boundary::FixedFree,
    Boundary::FreeFixed,
    Boundary::FreeFree,
];

/// What `layered_beam_references.py` computed by mpmath and SciPy.
#[derive(Deserialize)]
pub(crate) struct References {
    pub(crate) points: Vec<f64>,
    pub(crate) shapes: std::collections::BTreeMap<String, Vec<ShapeReference>>,
    pub(crate) normal_forces: Vec<[f64; 2]>,
    pub(crate) elements: Vec<ElementReference>,
}

#[derive(Deserialize)]
pub(crate) struct ShapeReference {
    pub(crate) mode: usize,
    pub(crate) lambda: f64,
    pub(crate) deflection: Vec<f64>,
    pub(crate) slope: Vec<f64>,
}

#[derive(Deserialize)]
pub(crate) struct ElementReference {
    pub(crate) length: f64,
    pub(crate) width: f64,
    pub(crate) layers: Vec<[f64; 3]>,
    pub(crate) ratio: f64,
    pub(crate) diameter: f64,
    pub(crate) boundary: Boundary,
    pub(crate) positions: Vec<f64>,
    pub(crate) drive_point: f64,
    pub(crate) bending: f64,
    pub(crate) mass_per_length: f64,
    pub(crate) modes: Vec<ModeReference>,
    pub(crate) static_stiffness: Option<f64>,
    pub(crate) amplitude: f64,
    pub(crate) alpha_mu: f64,
}

#[derive(Deserialize)]
pub(crate) struct ModeReference {
    pub(crate) frequency_hz: f64,
    pub(crate) mass_kg: f64,
    pub(crate) damping_ratio: f64,
}

pub(crate) fn references() -> References {
    serde_json::from_str(include_str!("../data/layered_beam.json")).unwrap()
}

impl ElementReference {
    pub(crate) fn beam(&self) -> LayeredBeam {
        let layer = |&[thickness_m, youngs_modulus_pa, density_kg_per_m3]: &[f64; 3]| Layer {
            thickness_m,
            youngs_modulus_pa,
            density_kg_per_m3,
        };
        let layers = self.layers.iter().map(layer).collect();
        LayeredBeam::new(self.length, self.width, layers, self.boundary, self.ratio).unwrap()
    }

    pub(crate) fn rivets(&self) -> Fasteners {
        Fasteners::rivets(self.diameter, 100e6, self.positions.clone()).unwrap()
    }
}

/// Kavi's specimen 1 with other ends.
pub(crate) fn specimen(boundary: Boundary) -> LayeredBeam {
    let layer = Layer {
        thickness_m: 0.003,
        youngs_modulus_pa: 196e9,
        density_kg_per_m3: 7850.0,
    };
    LayeredBeam::new(0.37, 0.04125, vec![layer; 2], boundary, 1.0).unwrap()
}

pub(crate) fn rivets(count: usize) -> Fasteners {
    Fasteners::rivets(0.008, 100e6, Fasteners::equispaced(count, 0.37)).unwrap()
}

/// Mode `number` of a beam, driven where it moves most, by its modal energy.
pub(crate) fn mode(
    beam: &LayeredBeam,
    rivets: &Fasteners,
    number: usize,
    route: Route,
) -> BeamMode {
    BeamMode::new(beam, rivets, number, None, route, StoredEnergy::Modal).unwrap()
}
