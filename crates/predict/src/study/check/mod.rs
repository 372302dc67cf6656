//! From the tables of a study's file to values that make sense.

mod contact;
mod interface;
mod microslip;
mod surfaces;
mod tightening;

use crate::fractal::StoredEnergy;
use crate::patch::{LossFactor, Motions, NormalDamping};
use crate::study::clamping::Clamping;
use crate::study::geometry::Geometry;
use crate::study::slip::Microslip;
use crate::study::tables::{MaterialTable, NormalWord, StudyFile};
use crate::surface::ProfileFit;
use crate::uncertain::{Distribution, InputPlace, Inputs, MonteCarlo, Spread, Uncertain};
use crate::virtual_material::Layers;
use bolted_joint_joint::InputFile;
use bolted_joint_study::{BeamNumber, Method, StudyError, StudyText, UncertaintyTable, schema};
use interface::pressure_in_words;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Elements along x and y where a study does not say.
const ELEMENTS: [usize; 2] = [60, 60];

/// A validated study of an interface: method `fractal-contact` or `virtual-material`.
#[derive(Debug, Clone)]
pub struct InterfaceStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Which model it asks for.
    pub method: Method,
    /// Name of the joint.
    pub name: String,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
    /// Every number that may be uncertain.
    pub inputs: Inputs,
    /// The files behind it.
    pub files: Vec<InputFile>,
    /// Profiles' fits, with the surface they are of.
    pub fits: Vec<(&'static str, ProfileFit)>,
    /// Tightening torques, N·m, ascending; empty for one joint.
    pub torques_n_m: Vec<f64>,
    /// The torque at the start of a simulation, N·m: one of the torques.
    pub nominal_n_m: Option<f64>,
    /// Which motions become the joint file's.
    pub motions: Motions,
    /// Where they are taken, m.
    pub reference_m: [f64; 3],
    /// Frequency at which hysteretic damping is converted, Hz.
    pub frequency_hz: f64,
    /// What the fractal contact's energy ratios are taken for.
    pub loss_factor: LossFactor,
    /// What its energy lost along the interface is compared with.
    pub stored_energy: StoredEnergy,
    /// How the interface dissipates along its normal.
    pub normal_damping: NormalDamping,
    /// Whether it slips under the joint's motion, and how that is fitted.
    pub microslip: Option<Microslip>,
    /// Draws, where a value is uncertain.
    pub monte_carlo: Option<MonteCarlo>,
    /// How the pressure is spread, in words.
    pub pressure: String,
    pub(super) materials: [MaterialInputs; 2],
    pub(super) surfaces: SurfaceInputs,
    pub(super) contact: ContactInputs,
    pub(super) clamping: Clamping,
    pub(super) geometry: Geometry,
}

/// Elastic constants of a part.
#[derive(Debug, Clone, Copy)]
pub(super) struct MaterialInputs {
    pub(super) youngs_modulus: InputPlace,
    pub(super) poissons_ratio: InputPlace,
}

/// Fractal dimension and roughness of a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceInput {
    pub(super) fractal_dimension: InputPlace,
    pub(super) roughness: InputPlace,
}

/// What is known of the surfaces.
#[derive(Debug, Clone, Copy)]
pub(super) enum SurfaceInputs {
    /// Of the two together.
    Together(SurfaceInput),
    /// Of each, and the wavelengths, m, over which their sum is taken.
    Each([SurfaceInput; 2], [f64; 2]),
}

/// Which contact model, and its numbers.
#[derive(Debug, Clone, Copy)]
pub(super) enum ContactInputs {
    /// Zhao's.
    Fractal {
        hardness: InputPlace,
        friction: InputPlace,
        shear_strength: InputPlace,
    },
    /// Tian's layer.
    Layer {
        hardness: InputPlace,
        friction_ratio: InputPlace,
        layers: Layers,
        loss_factor: InputPlace,
    },
}

impl InterfaceStudy {
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<StudyFile>()
    }

    /// Reads and checks a study, and the profiles and the field that it names.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::of(&StudyText::read(path)?)
    }

    /// A study from its text, with the profiles and the field that it names.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, StudyError> {
        let file: StudyFile = study.tables()?;
        study.check_name("name", &file.name)?;
        let methods = [Method::FractalContact, Method::VirtualMaterial];
        study.check_method(file.method, &methods)?;
        Checker {
            study,
            inputs: Inputs::default(),
            files: vec![study.record()],
            fits: Vec::new(),
        }
        .checked(file)
    }
}

struct Checker<'s> {
    study: &'s StudyText,
    inputs: Inputs,
    files: Vec<InputFile>,
    fits: Vec<(&'static str, ProfileFit)>,
}

type Checked<T> = Result<T, StudyError>;

impl Checker<'_> {
    fn checked(mut self, file: StudyFile) -> Checked<InterfaceStudy> {
        let study = self.study;
        let method = file.method;
        let materials = [
            self.material("a", &file.materials.a)?,
            self.material("b", &file.materials.b)?,
        ];
        let surfaces = self.surfaces(&file.surface)?;
        let contact = self.contact(&file)?;
        let (torques_n_m, nominal_n_m) = self.torques(file.tightening.as_ref())?;
        let clamping = self.clamping(&file, !torques_n_m.is_empty())?;
        let geometry = self.geometry(&file, &clamping, nominal_n_m)?;
        let (motions, reference_m) = self.joint(&file.joint, &geometry)?;
        let frequency_hz = study.positive(
            "damping.frequency",
            file.damping.frequency,
            "the frequency in Hz, above zero, at which hysteretic damping becomes viscous",
        )?;
        let normal_damping = match (file.damping.normal, file.damping.mass) {
            (NormalWord::Viscous, Some(mass_kg)) if mass_kg.is_finite() && mass_kg > 0.0 => {
                NormalDamping::Viscous { mass_kg }
            }
            (NormalWord::Viscous, found) => {
                let found = found.map_or("nothing".to_owned(), |found| found.to_string());
                return study.refuse(
                    "damping.mass",
                    found,
                    "the mass of the structure in kg, above zero, for C_N = η_N √(M K_N)",
                );
            }
            (NormalWord::Hysteretic, None) => NormalDamping::Hysteretic,
            (NormalWord::Hysteretic, Some(mass)) => {
                let expected = "a mass only beside normal = \"viscous\", which takes it";
                return study.refuse("damping.mass", mass, expected);
            }
        };
        let microslip = self.microslip(&file, motions, reference_m)?;
        let monte_carlo = self.monte_carlo(file.uncertainty.as_ref())?;
        Ok(InterfaceStudy {
            path: study.path().to_owned(),
            method,
            pressure: pressure_in_words(&file),
            name: file.name,
            notes: file.notes,
            inputs: self.inputs,
            files: self.files,
            fits: self.fits,
            torques_n_m,
            nominal_n_m,
            motions,
            reference_m,
            frequency_hz,
            loss_factor: file.damping.loss_factor.unwrap_or_default(),
            stored_energy: file.damping.stored_energy.unwrap_or_default(),
            normal_damping,
            microslip,
            monte_carlo,
            materials,
            surfaces,
            contact,
            clamping,
            geometry,
        })
    }

    fn model<T, E: Error + Send + Sync + 'static>(
        &self,
        key: &str,
        result: Result<T, E>,
    ) -> Checked<T> {
        result.map_err(|reason| StudyError::model(self.study.path(), Some(key), reason))
    }

    /// A quantity above zero, drawn from a lognormal distribution.
    fn positive(
        &mut self,
        key: &str,
        name: impl Into<String>,
        of: Uncertain,
    ) -> Checked<InputPlace> {
        self.study
            .ensure(of.value > 0.0, key, of, "a number above zero")?;
        let distribution = Distribution::new(Spread::Lognormal, of);
        Ok(self.inputs.add(name, distribution))
    }

    /// The same, or zero without doubt.
    fn not_negative(
        &mut self,
        key: &str,
        name: impl Into<String>,
        of: Uncertain,
    ) -> Checked<InputPlace> {
        let valid = of.value > 0.0 || of.value == 0.0 && of.is_exact();
        let expected = "a number above zero, or 0 without a standard deviation";
        self.study.ensure(valid, key, of, expected)?;
        let distribution = Distribution::new(Spread::Lognormal, of);
        Ok(self.inputs.add(name, distribution))
    }

    fn material(&mut self, side: &str, table: &MaterialTable) -> Checked<MaterialInputs> {
        let key = |name: &str| format!("materials.{side}.{name}");
        let youngs_modulus = self.positive(
            &key("youngs_modulus"),
            format!("Young's modulus of {side}"),
            table.youngs_modulus,
        )?;
        self.study.plausible_in_beam(
            format_args!("materials.{side}"),
            BeamNumber::YoungsModulus,
            table.youngs_modulus.value,
        )?;
        let (low, high) = (-1.0, 0.5);
        let ratio = table.poissons_ratio;
        self.study.ensure(
            ratio.value > low && ratio.value < high,
            key("poissons_ratio"),
            ratio,
            "more than −1 and less than 0.5 (0.5 is incompressible: contact formulas divide by its compliance)",
        )?;
        if let Some(density) = table.density {
            self.study
                .positive(key("density"), density, "kg/m³ above zero")?;
        }
        let distribution = Distribution::new(Spread::NormalWithin { low, high }, ratio);
        Ok(MaterialInputs {
            youngs_modulus,
            poissons_ratio: self
                .inputs
                .add(format!("Poisson's ratio of {side}"), distribution),
        })
    }

    fn monte_carlo(&self, table: Option<&UncertaintyTable>) -> Checked<Option<MonteCarlo>> {
        let (draws, seed) = self.study.draws(table)?;
        let is_exact = self.inputs.are_exact();
        self.study.ensure(
            !is_exact || table.is_none(),
            "uncertainty",
            "no value with a standard deviation",
            "one at least, such as fractal_dimension = \"1.42 ± 0.02\"",
        )?;
        Ok((!is_exact).then_some(MonteCarlo { draws, seed }))
    }
}
