//! A study: what the user's TOML file asks for, checked before anything is read or computed.

mod budget;
mod check;
mod deviations;
mod set_up;
mod tables;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bolted_joint_frf::structure::{Beam, Difference, FiniteDifference, Section};
use bolted_joint_frf::{Dof, Quantity, UnitSystem};
use bolted_joint_joint::Bodies;
use bolted_joint_study::{LineChoice, Method, Paths, StudyText, schema};
use bolted_joint_systematic::Budget;
use nalgebra::DMatrix;

use super::band_choice;
use super::bands::{BandChoices, Bands};
use super::error::IdentifyError;
use super::layout::{Bolts, Layout};
use super::level::Level;
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::noise::Noise;
use super::torque::TorqueDependence;
pub use set_up::{Accelerometer, Deviations, MassAtJoint, SetUp};
use tables::StudyFile;

/// A validated study of method `frf-decoupling`.
#[derive(Clone, Debug)]
pub struct Study {
    /// The study's own file.
    pub path: PathBuf,
    /// Name of the joint.
    pub name: String,
    /// Substructure A.
    pub a: Substructure,
    /// Substructure B.
    pub b: Substructure,
    /// File with the first assembly's FRFs.
    pub assembly: FrfFile,
    /// Points at which the first assembly was measured: those of B, then those of A.
    pub points: Vec<Dof>,
    /// How many of them, the last ones, are points of A.
    pub points_on_a: usize,
    /// Further measurements of the first assembly's functions.
    pub repeats: Vec<FrfFile>,
    /// Tightening torque of the first assembly, N·m.
    pub torque_n_m: Option<f64>,
    /// Level at which the first assembly was measured.
    pub level: Option<Level>,
    /// Further assemblies with the same joint.
    pub further: Vec<FurtherAssembly>,
    /// Joint model to identify.
    pub model: JointModel,
    /// Whether assemblies with different torques have one joint.
    pub torques: TorqueDependence,
    /// The bolts that the substructures' joints belong to, in their order.
    pub bolts: Bolts,
    /// Lowest and highest frequency to use, Hz.
    pub frequency_range_hz: [f64; 2],
    /// Which lines within this range are used.
    pub lines: LineChoice,
    /// Bands of the averages.
    pub bands: BandChoices,
    /// Noise of the measured receptances, as far as the study states it.
    pub noise: Noise,
    /// How well the set-up of the test is known, but for what the substructures state of themselves.
    pub budget: Budget,
    /// Whether the joint model is compared with the others, and a common joint with one for each torque.
    pub compares_rivals: bool,
    /// A presumed joint, one of the starts of the search at every bolt.
    pub start: Option<JointMatrices>,
    /// Bodies of a lap model, which go into the joint file.
    pub bodies: Option<Bodies>,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
}

/// An assembly beside the first one, with the same joint in it.
#[derive(Clone, Debug)]
pub struct FurtherAssembly {
    /// File with its FRFs.
    pub file: FrfFile,
    /// Points at which it was measured: those of B, then those of A.
    pub points: Vec<Dof>,
    /// How many of them, the last ones, are points of A.
    pub points_on_a: usize,
    /// Further measurements of the same functions.
    pub repeats: Vec<FrfFile>,
    /// Tightening torque, N·m.
    pub torque_n_m: Option<f64>,
    /// Level at which it was measured.
    pub level: Option<Level>,
    /// Its substructure A.
    pub a: Substructure,
    /// Its substructure B.
    pub b: Substructure,
}

/// One substructure: where its receptances come from, and where its joint is.
#[derive(Clone, Debug, PartialEq)]
pub enum Substructure {
    /// Measured at labelled points.
    Measured {
        /// The data.
        source: Source,
        /// The joint's DOFs at each bolt.
        joints: Vec<MeasuredJoint>,
        /// The cross-section at the joint, where the study states it.
        section: Option<Section>,
        /// Positions of labelled points along the structure, m, where the study states them.
        positions_m: BTreeMap<Dof, f64>,
        /// Masses that are known, and how well single values are.
        set_up: SetUp,
    },
    /// A computed beam.
    Beam {
        /// The beam.
        beam: Beam,
        /// Distance of the joint at each bolt from the beam's first end, m.
        joints_m: Vec<f64>,
        /// Distance of labelled points from the beam's first end, m.
        positions_m: BTreeMap<Dof, f64>,
        /// Masses that are known, and how well single values are.
        set_up: SetUp,
    },
    /// What does not move.
    Ground {
        /// Bolts that hold the other structure to it.
        bolts: usize,
    },
}

/// The joint's DOFs at one bolt of a measured substructure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredJoint {
    /// Its translation.
    pub y: Dof,
    /// Its rotation, where the study names one.
    pub theta: Option<Rotation>,
    /// Its position along the structure, m, where the study states it.
    pub x_m: Option<f64>,
}

impl Substructure {
    /// Positions of the bolts of a measured structure along it, m, where the study states them.
    pub(super) fn bolts_m(&self) -> Vec<Option<f64>> {
        match self {
            Self::Measured { joints, .. } => joints.iter().map(|joint| joint.x_m).collect(),
            Self::Beam { .. } | Self::Ground { .. } => Vec::new(),
        }
    }

    /// The cross-section at the joint, where the study states it.
    pub(super) fn section(&self) -> Option<&Section> {
        match self {
            Self::Measured { section, .. } => section.as_ref(),
            Self::Beam { .. } | Self::Ground { .. } => None,
        }
    }

    /// What rotations by differences lose at the joint's DOFs, with its derivative by ln EI, rad/(N·m); `None` where nothing is
    /// known of it or nothing is lost.
    pub(super) fn rotation_lost(&self, dofs_of_a_bolt: usize) -> Option<[DMatrix<f64>; 2]> {
        let Self::Measured {
            joints,
            section: Some(section),
            ..
        } = self
        else {
            return None;
        };
        let size = joints.len() * dofs_of_a_bolt;
        let mut lost = [DMatrix::zeros(size, size), DMatrix::zeros(size, size)];
        let mut is_any = false;
        for (bolt, joint) in joints.iter().enumerate() {
            let Some(Rotation::Difference { difference, .. }) = &joint.theta else {
                continue;
            };
            if dofs_of_a_bolt < 2 {
                continue;
            }
            let of_bolt = section.rotation_lost(difference)?;
            let theta = bolt * dofs_of_a_bolt + 1;
            for (matrix, value) in lost.iter_mut().zip(of_bolt) {
                matrix[(theta, theta)] = value;
            }
            is_any = true;
        }
        is_any.then_some(lost)
    }
}

impl MeasuredJoint {
    /// The DOFs that can be those of this bolt alone: points of a difference may serve a neighbour, too.
    pub(super) fn own_dofs(&self) -> Vec<Dof> {
        let measured = match self.theta {
            Some(Rotation::Measured(theta)) => Some(theta),
            _ => None,
        };
        std::iter::once(self.y).chain(measured).collect()
    }
}

/// Where a measured substructure's receptances come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// FRFs, and a file with modes that supplies those that were not measured.
    Frf {
        /// The FRFs.
        file: FrfFile,
        /// The modes.
        modes: Option<PathBuf>,
    },
    /// File with modes.
    Modal(PathBuf),
}

/// A file of functions, and what the study says about it.
#[derive(Clone, Debug, PartialEq)]
pub struct FrfFile {
    /// The file, or the first of several.
    pub path: PathBuf,
    /// Further files with functions of the same measurement, such as those of other references.
    pub further: Vec<PathBuf>,
    /// Files with the coherences of the functions, where they are not in the same ones.
    pub coherence: Vec<PathBuf>,
    /// What was measured, where the file contradicts itself or does not say.
    pub quantity: Option<Quantity>,
    /// Its units, where the file contradicts itself or does not say.
    pub units: Option<UnitSystem>,
    /// Averages behind every function, which its coherence needs to become a variance.
    pub averages: Option<f64>,
    /// The accelerometer that its functions are to be freed of.
    pub accelerometer: Option<Accelerometer>,
}

impl FrfFile {
    /// Files with functions.
    pub fn function_files(&self) -> impl Iterator<Item = &PathBuf> {
        std::iter::once(&self.path).chain(&self.further)
    }

    /// All files, those with coherences last.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.function_files().chain(&self.coherence)
    }
}

/// Where rotational receptances come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Rotation {
    /// Measured as such.
    Measured(Dof),
    /// A finite difference over neighbouring translations.
    Difference {
        /// The points, one of which is the joint's.
        points: Vec<Dof>,
        /// The difference over them.
        difference: FiniteDifference,
    },
}

impl Substructure {
    /// Whether both are the same functions of the same file at the same joint.
    pub(super) fn is_same_measurement(&self, other: &Self) -> bool {
        let key = |substructure: &Self| match substructure {
            Self::Measured { source, joints, .. } => match source {
                Source::Frf { file, modes } => {
                    let files: Vec<PathBuf> = file.function_files().cloned().collect();
                    Some((files, modes.clone(), joints.clone()))
                }
                Source::Modal(_) => None,
            },
            Self::Beam { .. } | Self::Ground { .. } => None,
        };
        key(self).is_some() && key(self) == key(other)
    }

    /// Whether the joint's rotation is known at every bolt: measured or computed.
    fn has_rotation(&self) -> bool {
        match self {
            Self::Measured { joints, .. } => joints.iter().all(|joint| joint.theta.is_some()),
            Self::Beam { .. } | Self::Ground { .. } => true,
        }
    }
}

/// The points of B, and those of A.
fn by_side(points: &[Dof], on_a: usize) -> (&[Dof], &[Dof]) {
    points.split_at(points.len().saturating_sub(on_a))
}

impl Study {
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<StudyFile>()
    }

    /// The points of B at which the first assembly was measured, and those of A.
    pub(super) fn points_by_side(&self) -> (&[Dof], &[Dof]) {
        by_side(&self.points, self.points_on_a)
    }

    /// The substructures whose rotation at the joint is not given, by their keys: without it a joint model with rotation
    /// can neither be identified nor compared.
    #[must_use]
    pub fn without_rotation(&self) -> Vec<&'static str> {
        let further = || self.further.iter();
        [
            (
                "a",
                self.a.has_rotation() && further().all(|further| further.a.has_rotation()),
            ),
            (
                "b",
                self.b.has_rotation() && further().all(|further| further.b.has_rotation()),
            ),
        ]
        .into_iter()
        .filter_map(|(key, has_rotation)| (!has_rotation).then_some(key))
        .collect()
    }

    /// What rotations by differences lose, where nothing corrects them. A set-up that is exact loses as much.
    pub(super) fn rotations_not_corrected(&self) -> Vec<String> {
        if self.model.dofs() < 2 {
            return Vec::new();
        }
        let of = |(key, substructure): (&str, &Substructure)| {
            let Substructure::Measured {
                joints, section, ..
            } = substructure
            else {
                return None;
            };
            let difference = joints.iter().find_map(|joint| match &joint.theta {
                Some(Rotation::Difference { difference, .. }) => Some(difference),
                _ => None,
            })?;
            if section.is_some() {
                return None;
            }
            let remedy = match difference.side() {
                Difference::Central => {
                    format!(
                        "state `section` of `{key}` (width, height, youngs_modulus), which corrects it"
                    )
                }
                Difference::Forward | Difference::Backward => {
                    "measure points on both sides of the joint, which `section` then corrects"
                        .to_owned()
                }
            };
            Some(format!(
                "the rotation of {} is a {difference}: it misses what the structure bends right at the joint, about a third of \
                 the spacing over EI, so that the joint seems softer in rotation; no data show that; {remedy}",
                key.to_uppercase()
            ))
        };
        [("a", &self.a), ("b", &self.b)]
            .into_iter()
            .filter_map(of)
            .collect()
    }

    /// Bands for the averages by sensitivity and distance, for a test whose assembly has these joints: those of each joint.
    /// Bands that the study gives stay.
    ///
    /// # Errors
    /// [`IdentifyError::Singular`] at an undamped resonance.
    pub fn choose_bands(
        &self,
        lines: &Lines,
        joints: &[JointMatrices],
    ) -> Result<Vec<Bands>, IdentifyError> {
        let given = self.bands.given();
        Ok(band_choice::for_joints(
            lines,
            &self.layout(),
            joints,
            &given,
        )?)
    }

    /// Why the joint models cannot be compared, if they cannot.
    #[must_use]
    pub fn models_not_compared(&self) -> Option<String> {
        if !self.compares_rivals {
            return Some("the study or the command line says so".to_owned());
        }
        let keys: Vec<String> = self
            .without_rotation()
            .iter()
            .map(|key| format!("{key}.joint.theta"))
            .collect();
        (!keys.is_empty()).then(|| {
            format!(
                "{} {} not given, and without the rotation only \"translation\" can be identified",
                keys.join(" and "),
                if keys.len() == 1 { "is" } else { "are" }
            )
        })
    }

    /// Where the unknowns stand in the matrices of all bolts.
    pub(super) fn layout(&self) -> Layout {
        Layout::of_bolts(self.model, &self.bolts, self.dofs_of_a_bolt())
    }

    /// DOFs of each bolt in the data: the joint model's, and the rotation wherever it is given.
    pub(super) fn dofs_of_a_bolt(&self) -> usize {
        if self.without_rotation().is_empty() {
            2
        } else {
            self.model.dofs()
        }
    }

    /// Reads and checks a study. Paths in it are relative to its own folder.
    ///
    /// # Errors
    /// [`IdentifyError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, IdentifyError> {
        Self::of(&StudyText::read(path)?)
    }

    /// A study from the text of its file; `path` tells where that lies.
    ///
    /// # Errors
    /// [`IdentifyError`] that names the file and the key or line.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, IdentifyError> {
        Self::of(&StudyText::new(text, path))
    }

    /// A study from its text.
    ///
    /// # Errors
    /// [`IdentifyError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, IdentifyError> {
        let file: StudyFile = study.tables()?;
        study.check_method(file.method, &[Method::FrfDecoupling])?;
        let model = file.joint.model;
        let (key, places) = match file.a.ground {
            true => ("b.joint", &file.b.joint),
            false => ("a.joint", &file.a.joint),
        };
        let bolts = check::bolts(study, key, places.as_deref(), file.joint.bolts)?;
        let a = check::substructure(study, "a", file.a, model, &bolts)?;
        let b = check::substructure(study, "b", file.b, model, &bolts)?;
        study.check_name("name", &file.name)?;
        study.ensure(
            !file.assembly.is_empty(),
            "assembly",
            "an empty list",
            "one [[assembly]] or more",
        )?;
        let mut assemblies = Vec::new();
        for table in file.assembly {
            let measured = std::iter::once(&table.frf).chain(&table.repeats);
            let files = measured.map(|paths| paths.first.as_path());
            study.every_file_once("assembly", files)?;
            let own = |key, table: Option<_>, otherwise: &Substructure| match table {
                Some(table) => check::substructure(study, key, table, model, &bolts),
                None => Ok(otherwise.clone()),
            };
            let measured_in = |paths: Paths, coherence: Option<&Paths>| {
                let stated = check::MeasuredAs {
                    coherence,
                    quantity: table.quantity,
                    units: table.units.as_ref(),
                    averages: table.averages,
                    accelerometer_mass: table.accelerometer_mass.as_ref(),
                };
                check::frf_file(study, "assembly", &paths, &stated)
            };
            let assembly = FurtherAssembly {
                file: measured_in(table.frf, table.coherence.as_ref())?,
                points_on_a: table.points_on_a.len(),
                points: check::points(study, table.points, table.points_on_a)?,
                repeats: table
                    .repeats
                    .into_iter()
                    .map(|paths| measured_in(paths, None))
                    .collect::<Result<_, _>>()?,
                torque_n_m: check::torque(study, table.torque)?,
                level: check::level(study, table.level.as_ref())?,
                a: own("assembly.a", table.a, &a)?,
                b: own("assembly.b", table.b, &b)?,
            };
            let (of_b, of_a) = by_side(&assembly.points, assembly.points_on_a);
            check::positions(study, "b", of_b, &assembly.b)?;
            check::positions(study, "a", of_a, &assembly.a)?;
            assemblies.push(assembly);
        }
        check::every_assembly_once(study, &assemblies)?;
        check::torques(study, file.joint.torques, &assemblies)?;
        if assemblies.iter().any(|assembly| assembly.points_on_a > 0) {
            check::one_noise(study, file.noise.as_ref())?;
        } else {
            for assembly in &assemblies {
                check::no_positions(study, &assembly.a)?;
            }
        }
        let first = assemblies.remove(0);
        let lines = study.line_choice(&file.frequency)?;
        check::bands(study, &file.bands.0)?;
        let noise = file
            .noise
            .map(|table| check::noise(study, &table))
            .transpose()?
            .unwrap_or_default();
        let budget = budget::budget(study, file.budget)?;
        let start = file
            .start
            .map(|table| check::start(study, &table, model))
            .transpose()?;
        if let Some(bodies) = &file.bodies {
            check::bodies(study, bodies, model.dofs(), &bolts)?;
        }
        Ok(Self {
            path: study.path().to_owned(),
            name: file.name,
            a: first.a,
            b: first.b,
            assembly: first.file,
            points: first.points,
            points_on_a: first.points_on_a,
            repeats: first.repeats,
            torque_n_m: first.torque_n_m,
            level: first.level,
            further: assemblies,
            model,
            torques: file.joint.torques,
            bolts,
            frequency_range_hz: lines.range_hz,
            lines,
            bands: file.bands.0,
            noise,
            budget,
            compares_rivals: file.joint.rivals.unwrap_or(true),
            start,
            bodies: file.bodies,
            notes: file.notes,
        })
    }
}
