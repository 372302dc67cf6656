//! What an estimate with systematic errors works on: functions of the structures and of the assembly at the same lines.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::bending_fit::Beam;
use super::bending_shape::Waves;
use super::cause::Side;
use super::measured::Measured;
use super::modal_fit::ModalFit;
use super::place::{Kind, Place};
use super::slope::{PointSlopes, slope};

/// Receptances of one line.
pub type ComplexMatrix = DMatrix<Complex64>;

/// A joint between two structures, and what was measured of all three.
pub struct Experiment<'a> {
    /// Angular frequency of each line, rad/s.
    pub omega: Vec<f64>,
    /// What of the joint is unknown.
    pub joint: JointShape,
    /// Structure A at the joint's DOFs, then its points.
    pub a: Structure<'a>,
    /// Structure B at the joint's DOFs, then its points.
    pub b: Structure<'a>,
    /// The assemblies, one or more, each at the same points: those of B, then those of A.
    pub assemblies: Vec<Assembly>,
    /// How many of these, the last ones, are on A.
    pub points_on_a: usize,
    /// Masses that only the assembly has, as far as they are known: at DOFs of the joint on A and then on B, kg or kg·m².
    pub known_masses: Vec<(usize, f64)>,
    /// Smooth fits of A and B where they are measured, made when they are first asked for.
    fits: OnceLock<[Option<ModalFit>; 2]>,
    /// At each line.
    slopes: OnceLock<Option<Vec<PointSlopes>>>,
}

/// What was measured of the two structures together.
pub struct Assembly {
    /// The functions between the points.
    pub functions: MeasuredFunctions,
    /// Number of its joint, from 0: assemblies may share one, or differ in it as at several torques.
    pub joint: usize,
}

/// The unknown entries of the joint's matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct JointShape {
    /// DOFs of the whole joint, bolt by bolt.
    pub dofs: usize,
    /// DOFs of a bolt: its translation, and then its rotation if there are two.
    pub dofs_of_a_bolt: usize,
    /// The entries above and on the diagonal that each unknown stands for.
    pub entries: Vec<Vec<(usize, usize)>>,
}

/// Functions that were measured between labelled DOFs.
#[derive(Clone, Debug, Default)]
pub struct MeasuredFunctions {
    /// For each label, whether it is a translation.
    pub is_translation: Vec<bool>,
    /// Position of each label along its structure, m, where it is known and tells a slope; empty if none is.
    pub positions_m: Vec<Option<f64>>,
    /// The functions.
    pub entries: Vec<Entry>,
}

/// One function, or the mean of two that are each other's reciprocal.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Row and column.
    pub place: (usize, usize),
    /// Response and reference of each measurement that it is the mean of; none if it is not measured and taken as exact.
    pub measurements: Vec<(usize, usize)>,
    /// Value at each line.
    pub values: Vec<Complex64>,
    /// Variance of the complex error at each line.
    pub variance: Vec<f64>,
}

/// A structure that the joint connects.
pub enum Structure<'a> {
    /// Formed from measured functions.
    Measured(Box<Measured>),
    /// Computed from dimensions and material.
    Computed(Computed<'a>),
    /// Known, with nothing to say about why.
    Exact(Vec<ComplexMatrix>),
}

/// A change of a computed structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// Of Young's modulus and the shear modulus, relative.
    pub youngs_modulus: f64,
    /// Of the density, relative.
    pub density: f64,
    /// Of the damping, relative.
    pub damping: f64,
    /// Of the position of the joint at each bolt, m; empty for none.
    pub joint_m: Vec<f64>,
    /// Of the position of each point, m; empty for none.
    pub points_m: Vec<f64>,
}

/// Computes a structure anew.
pub trait Compute: Sync {
    /// Receptances at each line, at the joint's DOFs and then the points, of the structure with a change; smooth in it. `None` where
    /// that is impossible, such as a modulus or a damping below zero. A point may be beyond its end.
    fn receptances(&self, change: &Change) -> Option<Vec<ComplexMatrix>>;
}

/// A structure computed from dimensions and material.
pub struct Computed<'a> {
    /// What computes it.
    pub compute: Box<dyn Compute + 'a>,
}

impl<'a> Experiment<'a> {
    /// Functions at the lines of `omega`, rad/s: of the structures that the joint connects and of the assemblies at B's points.
    #[must_use]
    pub fn new(
        omega: Vec<f64>,
        joint: JointShape,
        [a, b]: [Structure<'a>; 2],
        assemblies: Vec<Assembly>,
    ) -> Self {
        Self {
            omega,
            joint,
            a,
            b,
            assemblies,
            points_on_a: 0,
            known_masses: Vec::new(),
            fits: OnceLock::new(),
            slopes: OnceLock::new(),
        }
    }

    /// Fits are made anew, of functions that have changed.
    pub(crate) fn forget_fits(&mut self) {
        self.fits = OnceLock::new();
    }

    /// A smooth fit of a structure; `None` where it is not measured or no fit comes near it.
    pub(crate) fn fit(&self, side: Side) -> Option<&ModalFit> {
        let fits = self.fits.get_or_init(|| {
            [Side::A, Side::B].map(|side| match self.side(side) {
                Structure::Measured(measured) => ModalFit::of(&measured.functions, &self.omega),
                Structure::Computed(_) | Structure::Exact(_) => None,
            })
        });
        fits[side as usize].as_ref()
    }

    pub(crate) fn side(&self, side: Side) -> &Structure<'a> {
        match side {
            Side::A => &self.a,
            Side::B => &self.b,
        }
    }

    /// Points of the assemblies on a structure, by their numbers.
    pub(crate) fn points_on(&self, side: Side) -> std::ops::Range<usize> {
        let all = self.points();
        let of_b = all.saturating_sub(self.points_on_a);
        match side {
            Side::A => of_b..all,
            Side::B => 0..of_b,
        }
    }

    /// Points of the assemblies of which it can be told what a shift does.
    pub(crate) fn points_with_slopes(&self) -> Vec<usize> {
        let on = |side: Side| {
            let is_computed = matches!(self.side(side), Structure::Computed(_));
            self.points_on(side)
                .filter(move |&point| is_computed || self.position_m(point).is_some())
        };
        on(Side::B).chain(on(Side::A)).collect()
    }

    fn position_m(&self, point: usize) -> Option<f64> {
        let first = self.assemblies.first()?;
        *first.functions.positions_m.get(point)?
    }

    /// Slopes at the points of structures that are not computed anew; `None` where no position is known.
    pub(crate) fn slopes(&self) -> Option<&[PointSlopes]> {
        let slopes = self.slopes.get_or_init(|| {
            let omega = self.omega.iter();
            omega.map(|&omega| self.slopes_at(omega)).collect()
        });
        slopes.as_deref()
    }

    fn slopes_at(&self, omega: f64) -> Option<PointSlopes> {
        let (points, dofs) = (self.points(), self.joint.dofs);
        let mut weights = DMatrix::zeros(points, points + 2 * dofs);
        let mut by_loads = DMatrix::zeros(points, points);
        for (side, first) in [(Side::A, points), (Side::B, points + dofs)] {
            if matches!(self.side(side), Structure::Computed(_)) {
                continue;
            }
            let known = self.points_on(side);
            let known = known.filter_map(|point| {
                Some(Place {
                    x_m: self.position_m(point)?,
                    translation: point,
                    kind: Kind::Point,
                })
            });
            let known: Vec<Place> = known.collect();
            let mut places = known.clone();
            places.extend(self.bolts_on(side, first));
            let loads_m: Vec<f64> = known.iter().map(|place| place.x_m).collect();
            let beam = match self.side(side) {
                Structure::Measured(measured) => measured.beam(),
                Structure::Computed(_) | Structure::Exact(_) => Beam::RIGID,
            };
            let waves = Waves::new(beam.inertia, omega);
            for place in &known {
                let slope = slope(place.x_m, &places, &loads_m, waves);
                for (motion, weight) in slope.weights {
                    weights[(place.translation, motion)] += weight;
                }
                for (load, of_unit) in known.iter().zip(slope.by_loads) {
                    by_loads[(place.translation, load.translation)] = of_unit * beam.flexibility;
                }
            }
        }
        let is_known = weights.iter().any(|weight| *weight != 0.0);
        is_known.then_some(PointSlopes { weights, by_loads })
    }

    /// The bolts of a structure whose place among its points is known; its DOFs at the joint begin at `first`.
    fn bolts_on(&self, side: Side, first: usize) -> Vec<Place> {
        let Structure::Measured(measured) = self.side(side) else {
            return Vec::new();
        };
        measured.bolts_at(&self.joint, first)
    }

    /// Labelled functions of a structure that is measured.
    pub(crate) fn labelled(&self, side: Side) -> usize {
        match self.side(side) {
            Structure::Measured(measured) => measured.functions.entries.len(),
            Structure::Computed(_) | Structure::Exact(_) => 0,
        }
    }

    /// Whether several assemblies see the same errors of the structures.
    pub(crate) fn has_common_errors(&self) -> bool {
        self.assemblies.len() > 1
    }

    /// Joints of the assemblies.
    #[must_use]
    pub fn joints(&self) -> usize {
        let numbers = self.assemblies.iter().map(|assembly| assembly.joint + 1);
        numbers.max().unwrap_or(1)
    }

    /// Points of the assemblies.
    pub(crate) fn points(&self) -> usize {
        let first = self.assemblies.first();
        first.map_or(0, |first| first.functions.labels())
    }

    /// Functions of the assemblies, one after the other.
    pub(crate) fn assembled(&self) -> impl Iterator<Item = &Entry> {
        let functions = self.assemblies.iter();
        functions.flat_map(|assembly| &assembly.functions.entries)
    }
}

impl JointShape {
    pub(crate) fn bolts(&self) -> usize {
        self.dofs / self.dofs_of_a_bolt.max(1)
    }

    pub(crate) fn has_rotation(&self) -> bool {
        self.dofs_of_a_bolt == 2
    }

    /// The DOF that is a bolt's translation.
    pub(crate) fn translation(&self, bolt: usize) -> usize {
        bolt * self.dofs_of_a_bolt
    }
}

impl MeasuredFunctions {
    /// Labels, rows and columns.
    #[must_use]
    pub fn labels(&self) -> usize {
        self.is_translation.len()
    }

    /// Labels that are the response of a measurement.
    pub(crate) fn responses(&self) -> Vec<usize> {
        let measured = self.entries.iter().flat_map(|entry| &entry.measurements);
        let mut rows: Vec<usize> = measured.map(|&(row, _)| row).collect();
        rows.sort_unstable();
        rows.dedup();
        rows
    }

    /// Values at a line, entry by entry.
    pub(crate) fn at(&self, line: usize) -> Vec<Complex64> {
        self.entries
            .iter()
            .map(|entry| entry.values[line])
            .collect()
    }

    /// The symmetric matrix over the labels with these values of the entries.
    pub(crate) fn matrix(&self, values: &[Complex64]) -> ComplexMatrix {
        let mut matrix = ComplexMatrix::zeros(self.labels(), self.labels());
        for (entry, &value) in self.entries.iter().zip(values) {
            let (row, column) = entry.place;
            matrix[(row, column)] = value;
            matrix[(column, row)] = value;
        }
        matrix
    }
}
