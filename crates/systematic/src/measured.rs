//! A structure formed from measured functions, and how it bends between the places that they were measured at.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::bending::flexibility_from_drive_points;
use super::bending_fit::{Beam, beam};
use super::bends::{AtBolt, between_bolts, with_loads_between};
use super::experiment::{JointShape, MeasuredFunctions};
use super::place::{Kind, Place};

/// A structure formed from measured functions.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The upper triangle of U, every entry of it once.
    pub functions: MeasuredFunctions,
    /// W: motion of the joint's DOFs, then of the points, by that of the labels: H = W U Wᵀ.
    pub transformation: DMatrix<f64>,
    /// What rotations by differences lack, with its derivative by ln EI: real, at the joint's DOFs, rad/(N·m) and so on.
    pub correction: Option<[DMatrix<f64>; 2]>,
    /// Rotations among the joint's DOFs that are differences of translations.
    pub(crate) differences: Vec<usize>,
    /// How the structure bends beside each bolt; empty where the joint has no rotation.
    pub(crate) at_bolts: Vec<AtBolt>,
    /// Positions of the bolts, where they are told in the direction of the points, m; empty if none is.
    bolts_m: Vec<Option<f64>>,
    /// 1/EI, rad/(N·m²), where its section is known.
    known_flexibility: Option<f64>,
    /// The beam that the functions along it tell.
    told: Option<Beam>,
}

/// Where bolts and points of a measured structure are, m, as far as that is known.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// Each bolt along the structure.
    pub bolts_m: Vec<Option<f64>>,
    /// Each bolt whose translation is along those of the points, on the points' own axis.
    pub bolts_among_points_m: Vec<Option<f64>>,
    /// Each point.
    pub points_m: Vec<Option<f64>>,
}

impl Measured {
    /// A structure formed from these functions; where its bending stiffness EI (N·m²) is not known, its functions tell it.
    #[must_use]
    pub fn new(
        functions: MeasuredFunctions,
        transformation: DMatrix<f64>,
        correction: Option<[DMatrix<f64>; 2]>,
        bending_stiffness_n_m2: Option<f64>,
        joint: &JointShape,
    ) -> Self {
        let bolts = 0..joint.bolts();
        let rotations = bolts.map(|bolt| joint.translation(bolt) + 1);
        let is_difference = |theta: &usize| {
            let labels = functions.is_translation.iter().enumerate();
            let mut translations = labels.filter(|(_, is)| **is);
            translations.any(|(label, _)| transformation[(*theta, label)] != 0.0)
        };
        let differences = match joint.has_rotation() {
            true => rotations.filter(is_difference).collect(),
            false => Vec::new(),
        };
        let mut new = Self {
            differences,
            functions,
            transformation,
            correction,
            at_bolts: Vec::new(),
            bolts_m: Vec::new(),
            known_flexibility: bending_stiffness_n_m2.map(f64::recip),
            told: None,
        };
        let flexibility = match new.known_flexibility {
            Some(flexibility) if joint.has_rotation() => vec![flexibility; joint.bolts()],
            Some(_) => Vec::new(),
            None => {
                let formed = |values: &[Complex64]| new.as_measured(values);
                flexibility_from_drive_points(&new.functions, formed, joint)
            }
        };
        new.at_bolts = flexibility.into_iter().map(AtBolt::alone).collect();
        new
    }

    /// How it bends between its places: 1/EI by the functions along it or, where these are too few, the largest beside any bolt, since
    /// what drive points tell of one that is not at the structure's end is too little.
    pub(crate) fn beam(&self) -> Beam {
        let of_bolts = self.at_bolts.iter().map(|bolt| bolt.flexibility);
        self.told.unwrap_or(Beam {
            flexibility: of_bolts.fold(0.0, f64::max),
            inertia: 0.0,
        })
    }

    /// With the places of its bolts and points; the functions are those at the lines of `omega`, rad/s.
    #[must_use]
    pub fn with_places(mut self, places: Places, omega: &[f64], joint: &JointShape) -> Self {
        self.bolts_m = places.bolts_among_points_m;
        let points = self.points_at(&places.points_m, joint);
        let all = [points, self.bolts_at(joint, 0)].concat();
        let motions = |line: usize| self.as_measured(&self.functions.at(line));
        self.told = beam(&all, omega, motions, self.known_flexibility);
        let bends = between_bolts(&places.bolts_m, self.beam(), joint);
        let bends = with_loads_between(bends, &self.bolts_m, &places.points_m, joint);
        for (bolt, bend) in self.at_bolts.iter_mut().zip(bends) {
            bolt.bend = bend;
        }
        self
    }

    /// Its points, as places among its own motions.
    fn points_at(&self, points_m: &[Option<f64>], joint: &JointShape) -> Vec<Place> {
        let points = points_m.iter().enumerate();
        let place = |(point, x_m): (usize, &Option<f64>)| {
            Some(Place {
                x_m: (*x_m)?,
                translation: joint.dofs + point,
                kind: Kind::Point,
            })
        };
        points.filter_map(place).collect()
    }

    /// Its bolts whose places among the points are known; its DOFs at the joint begin at `first`.
    pub(crate) fn bolts_at(&self, joint: &JointShape, first: usize) -> Vec<Place> {
        let positions = self.bolts_m.iter().enumerate();
        let places = positions.filter_map(|(bolt, x_m)| {
            let translation = first + joint.translation(bolt);
            let rotation = joint.has_rotation().then_some(translation + 1);
            Some(Place {
                x_m: (*x_m)?,
                translation,
                kind: Kind::Bolt { rotation },
            })
        });
        places.collect()
    }
}
