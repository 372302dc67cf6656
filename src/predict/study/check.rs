//! From the tables of a study's file to values that make sense.

use std::path::{Path, PathBuf};

use super::clamping::{BoltInput, Clamping, Tightness, Wrench};
use super::error::{ModelError, PredictError};
use super::geometry::Geometry;
use super::method::PredictionMethod;
use super::origin;
use super::tables::{
    BoltTable, DistributionWord, ForceWord, InterfaceTable, JointTable, MaterialTable, NormalWord,
    OneSurfaceTable, PressureModel, PressureTable, ReachWord, ScatterWord, StudyFile, SurfaceTable,
    ThreadTable, TighteningTable, UncertaintyTable,
};
use crate::joint::InputFile;
use crate::predict::patch::{LossFactor, NormalDamping, Planar};
use crate::predict::pressure::{
    Cone, ConePressure, PressureField, Reach, Rectangle, ThicknessRatio, ThreadFriction, Zone,
    ZoneForce, coarse_pitch_m,
};
use crate::predict::surface::{FitSettings, Profile, ProfileFit};
use crate::predict::uncertain::{Distribution, InputPlace, Inputs, MonteCarlo, Spread, Uncertain};
use crate::predict::virtual_material::Layers;
use crate::text_file;

/// Draws where a study has uncertain values and does not say how many.
const DRAWS: u64 = 2000;
/// More than anybody waits for.
const MOST_DRAWS: u64 = 1_000_000;
/// Elements along x and y where a study does not say.
const ELEMENTS: [usize; 2] = [60, 60];

/// A validated study of an interface: method `fractal-contact` or `virtual-material`.
#[derive(Debug, Clone)]
pub struct InterfaceStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Which model it asks for.
    pub method: PredictionMethod,
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
    pub planar: Planar,
    /// Where they are taken, m.
    pub reference_m: [f64; 3],
    /// Frequency at which hysteretic damping is converted, Hz.
    pub frequency_hz: f64,
    /// What the model's energy ratios are taken for.
    pub loss_factor: LossFactor,
    /// How the interface dissipates along its normal.
    pub normal_damping: NormalDamping,
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
    /// Reads and checks a study, and the profiles and the field that it names.
    ///
    /// # Errors
    /// [`PredictError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, PredictError> {
        let text = text_file::read(path, "a study (TOML)")?;
        Self::from_toml(&text, path)
    }

    /// A study from the text of its file; `path` tells where that lies.
    ///
    /// # Errors
    /// [`PredictError`] that names the file and the key or line.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, PredictError> {
        let file: StudyFile = toml::from_str(text).map_err(|error| PredictError::Syntax {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Checker {
            path,
            folder,
            inputs: Inputs::default(),
            files: vec![origin::of_text("study", path, folder, text)],
            fits: Vec::new(),
        }
        .study(file)
    }
}

struct Checker<'p> {
    path: &'p Path,
    folder: &'p Path,
    inputs: Inputs,
    files: Vec<InputFile>,
    fits: Vec<(&'static str, ProfileFit)>,
}

type Checked<T> = Result<T, PredictError>;

impl Checker<'_> {
    fn study(mut self, file: StudyFile) -> Checked<InterfaceStudy> {
        let name = &file.name;
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            return self.refuse("name", format!("{name:?}"), "one line of text");
        }
        let method = file.method;
        if method == PredictionMethod::LayeredBeam {
            return self.refuse("method", "\"layered-beam\"", "the method of an interface");
        }
        let materials = [
            self.material("a", &file.materials.a)?,
            self.material("b", &file.materials.b)?,
        ];
        let surfaces = self.surfaces(&file.surface)?;
        let contact = self.contact(&file)?;
        let (torques_n_m, nominal_n_m) = self.torques(file.tightening.as_ref())?;
        let clamping = self.clamping(&file, !torques_n_m.is_empty())?;
        let geometry = self.geometry(&file, &clamping, nominal_n_m)?;
        let (planar, reference_m) = self.joint(&file.joint, &geometry)?;
        let frequency_hz = file.damping.frequency;
        if !(frequency_hz.is_finite() && frequency_hz > 0.0) {
            return self.refuse(
                "damping.frequency",
                frequency_hz,
                "the frequency in Hz, above zero, at which hysteretic damping becomes viscous",
            );
        }
        let normal_damping = match (file.damping.normal, file.damping.mass) {
            (NormalWord::Viscous, Some(mass_kg)) if mass_kg.is_finite() && mass_kg > 0.0 => {
                NormalDamping::Viscous { mass_kg }
            }
            (NormalWord::Viscous, found) => {
                let found = found.map_or("nothing".to_owned(), |found| found.to_string());
                return self.refuse(
                    "damping.mass",
                    found,
                    "the mass of the structure in kg, above zero, for C_N = η_N √(M K_N)",
                );
            }
            (NormalWord::Hysteretic, None) => NormalDamping::Hysteretic,
            (NormalWord::Hysteretic, Some(mass)) => {
                return self.refuse(
                    "damping.mass",
                    mass,
                    "a mass only beside normal = \"viscous\", which takes it",
                );
            }
        };
        let monte_carlo = self.monte_carlo(file.uncertainty.as_ref())?;
        Ok(InterfaceStudy {
            path: self.path.to_owned(),
            method,
            pressure: pressure_in_words(&file),
            name: file.name,
            notes: file.notes,
            inputs: self.inputs,
            files: self.files,
            fits: self.fits,
            torques_n_m,
            nominal_n_m,
            planar,
            reference_m,
            frequency_hz,
            loss_factor: file.damping.loss_factor,
            normal_damping,
            monte_carlo,
            materials,
            surfaces,
            contact,
            clamping,
            geometry,
        })
    }

    fn refuse<T>(
        &self,
        key: impl Into<String>,
        found: impl ToString,
        expected: impl Into<String>,
    ) -> Checked<T> {
        Err(PredictError::Study {
            path: self.path.to_owned(),
            key: key.into(),
            found: found.to_string(),
            expected: expected.into(),
        })
    }

    fn model<T, E: Into<ModelError>>(
        &self,
        key: impl Into<String>,
        result: Result<T, E>,
    ) -> Checked<T> {
        result.map_err(|reason| PredictError::Model {
            path: self.path.to_owned(),
            key: key.into(),
            reason: Box::new(reason.into()),
        })
    }

    /// A quantity above zero, drawn from a lognormal distribution.
    fn positive(
        &mut self,
        key: &str,
        name: impl Into<String>,
        of: Uncertain,
    ) -> Checked<InputPlace> {
        if of.value <= 0.0 {
            return self.refuse(key, of, "a number above zero");
        }
        Ok(self
            .inputs
            .add(name, Distribution::new(Spread::Lognormal, of)))
    }

    /// The same, or zero without doubt.
    fn not_negative(
        &mut self,
        key: &str,
        name: impl Into<String>,
        of: Uncertain,
    ) -> Checked<InputPlace> {
        if of.value < 0.0 || of.value == 0.0 && !of.is_exact() {
            return self.refuse(
                key,
                of,
                "a number above zero, or 0 without a standard deviation",
            );
        }
        Ok(self
            .inputs
            .add(name, Distribution::new(Spread::Lognormal, of)))
    }

    fn material(&mut self, side: &str, table: &MaterialTable) -> Checked<MaterialInputs> {
        let key = |name: &str| format!("materials.{side}.{name}");
        let youngs_modulus = self.positive(
            &key("youngs_modulus"),
            format!("Young's modulus of {side}"),
            table.youngs_modulus,
        )?;
        let (low, high) = (-1.0, 0.5);
        let ratio = table.poissons_ratio;
        if !(ratio.value > low && ratio.value < high) {
            return self.refuse(
                key("poissons_ratio"),
                ratio,
                "more than −1 and less than 0.5 (0.5 is incompressible: contact formulas divide by its compliance)",
            );
        }
        if let Some(density) = table.density
            && !(density.is_finite() && density > 0.0)
        {
            return self.refuse(key("density"), density, "kg/m³ above zero");
        }
        let distribution = Distribution::new(Spread::NormalWithin { low, high }, ratio);
        Ok(MaterialInputs {
            youngs_modulus,
            poissons_ratio: self
                .inputs
                .add(format!("Poisson's ratio of {side}"), distribution),
        })
    }

    fn surfaces(&mut self, table: &SurfaceTable) -> Checked<SurfaceInputs> {
        let together = OneSurfaceTable {
            profiles: table.profiles.clone(),
            band: table.band,
            fractal_dimension: table.fractal_dimension,
            roughness: table.roughness,
            correlation: table.correlation,
        };
        match (&table.a, &table.b) {
            (None, None) => Ok(SurfaceInputs::Together(self.surface(
                "surface",
                "",
                "both surfaces together",
                &together,
            )?)),
            (Some(a), Some(b)) => {
                if together.profiles.is_some()
                    || together.fractal_dimension.is_some()
                    || together.roughness.is_some()
                    || together.correlation.is_some()
                {
                    return self.refuse(
                        "surface",
                        "values of both surfaces together beside [surface.a] and [surface.b]",
                        "the one or the other",
                    );
                }
                let Some(band) = table.band else {
                    return self.refuse(
                        "surface.band",
                        "nothing",
                        "{ from = …, to = … }, the wavelengths in m over which the spectra of both surfaces are added",
                    );
                };
                self.check_band("surface.band", band.from, band.to)?;
                // what was measured on each is fitted over the same band unless it has its own
                let with_band = |one: &OneSurfaceTable| OneSurfaceTable {
                    band: one.band.or(one.profiles.as_ref().and(Some(band))),
                    ..one.clone()
                };
                let (a, b) = (with_band(a), with_band(b));
                let of_a = self.surface("surface.a", " of a", "surface a", &a)?;
                let of_b = self.surface("surface.b", " of b", "surface b", &b)?;
                Ok(SurfaceInputs::Each([of_a, of_b], [band.from, band.to]))
            }
            _ => self.refuse(
                "surface",
                "one of [surface.a] and [surface.b]",
                "both, or values of the two together in [surface]",
            ),
        }
    }

    /// The numbers of the method's contact; those of the other method are refused.
    fn contact(&mut self, file: &StudyFile) -> Checked<ContactInputs> {
        let table = &file.contact;
        let hardness = self.positive("contact.hardness", "hardness", table.hardness)?;
        match file.method {
            PredictionMethod::VirtualMaterial => {
                for (key, found) in [
                    ("contact.friction", table.friction),
                    ("contact.shear_strength", table.shear_strength),
                ] {
                    if let Some(found) = found {
                        let expected = "none of method \"virtual-material\", which takes contact.friction_ratio";
                        return self.refuse(key, found, expected);
                    }
                }
                self.layer(file, hardness)
            }
            PredictionMethod::FractalContact | PredictionMethod::LayeredBeam => {
                if let Some(found) = table.friction_ratio {
                    let expected = "none of method \"fractal-contact\", where it follows from friction and shear_strength";
                    return self.refuse("contact.friction_ratio", found, expected);
                }
                if file.layer.is_some() {
                    let expected = "none: only method \"virtual-material\" has a layer";
                    return self.refuse("layer", "a table", expected);
                }
                let Some(friction) = table.friction else {
                    let expected = "the coefficient of static friction";
                    return self.refuse("contact.friction", "nothing", expected);
                };
                let Some(shear_strength) = table.shear_strength else {
                    let expected = "the shear strength of the softer part in Pa, or 0 for a joint without tangential load";
                    return self.refuse("contact.shear_strength", "nothing", expected);
                };
                Ok(ContactInputs::Fractal {
                    hardness,
                    friction: self.positive("contact.friction", "friction", friction)?,
                    shear_strength: self.not_negative(
                        "contact.shear_strength",
                        "shear strength",
                        shear_strength,
                    )?,
                })
            }
        }
    }

    fn layer(&mut self, file: &StudyFile, hardness: InputPlace) -> Checked<ContactInputs> {
        let Some(layer) = &file.layer else {
            let expected =
                "thickness = [a, b], of the part of each side that the layer takes the place of, m";
            return self.refuse("layer.thickness", "nothing", expected);
        };
        let is_thick = |thickness: &f64| thickness.is_finite() && *thickness > 0.0;
        if !layer.thickness.iter().all(is_thick) {
            let expected = "two lengths in m above zero";
            return self.refuse(
                "layer.thickness",
                format!("{:?}", layer.thickness),
                expected,
            );
        }
        let [a, b] = [&file.materials.a, &file.materials.b].map(|part| part.density);
        let (Some(a), Some(b)) = (a, b) else {
            let side = if a.is_none() { "a" } else { "b" };
            let expected = "kg/m³, for the density of the layer";
            return self.refuse(format!("materials.{side}.density"), "nothing", expected);
        };
        let friction_ratio = file.contact.friction_ratio.unwrap_or(Uncertain::exact(0.0));
        Ok(ContactInputs::Layer {
            hardness,
            friction_ratio: self.not_negative(
                "contact.friction_ratio",
                "friction ratio",
                friction_ratio,
            )?,
            layers: Layers {
                thickness_m: layer.thickness,
                density_kg_per_m3: [a, b],
            },
            loss_factor: self.not_negative(
                "layer.loss_factor",
                "loss factor",
                layer.loss_factor.unwrap_or(Uncertain::exact(0.0)),
            )?,
        })
    }

    fn check_band(&self, key: &str, from: f64, to: f64) -> Checked<()> {
        match from.is_finite() && to.is_finite() && from > 0.0 && to > from {
            true => Ok(()),
            false => self.refuse(
                key,
                format!("from {from} to {to} m"),
                "wavelengths in m, the first above zero and less than the second",
            ),
        }
    }

    fn surface(
        &mut self,
        key: &str,
        suffix: &str,
        whose: &'static str,
        table: &OneSurfaceTable,
    ) -> Checked<SurfaceInput> {
        let within = Spread::NormalWithin {
            low: 1.0,
            high: 2.0,
        };
        let (names, place) = (
            [format!("D{suffix}"), format!("G{suffix}")],
            |name: &str| format!("{key}.{name}"),
        );
        let [dimension_name, roughness_name] = names;
        match (&table.profiles, table.fractal_dimension, table.roughness) {
            (Some(paths), None, None) => {
                if let Some(correlation) = table.correlation {
                    return self.refuse(
                        place("correlation"),
                        correlation,
                        "none beside profiles, from which it follows",
                    );
                }
                let fit = self.profiles(key, paths, table)?;
                let found = fit.roughness();
                let of_dimension = Uncertain {
                    value: found.fractal_dimension(),
                    standard_deviation: fit.dimension_standard_deviation(),
                };
                let fractal_dimension = self
                    .inputs
                    .add(dimension_name, Distribution::new(within, of_dimension));
                let of_roughness = Distribution::of_logarithm(
                    found.roughness_m(),
                    fit.log_roughness_standard_deviation(),
                );
                let roughness = self.inputs.add_correlated(
                    roughness_name,
                    of_roughness,
                    fractal_dimension,
                    fit.correlation(),
                );
                let roughness = self.model(place("profiles"), roughness)?;
                self.fits.push((whose, fit));
                Ok(SurfaceInput {
                    fractal_dimension,
                    roughness,
                })
            }
            (None, Some(dimension), Some(roughness)) => {
                if !(dimension.value > 1.0 && dimension.value < 2.0) {
                    return self.refuse(
                        place("fractal_dimension"),
                        dimension,
                        "more than 1 and less than 2, as a profile has (a surface's dimension is one more: subtract 1)",
                    );
                }
                if roughness.value <= 0.0 {
                    return self.refuse(
                        place("roughness"),
                        roughness,
                        "a length in m above zero, about 1e-13 to 1e-7 for machined metal",
                    );
                }
                let fractal_dimension = self
                    .inputs
                    .add(dimension_name, Distribution::new(within, dimension));
                let of_roughness = Distribution::new(Spread::Lognormal, roughness);
                let correlation = table.correlation.unwrap_or(0.0);
                let roughness = self.inputs.add_correlated(
                    roughness_name,
                    of_roughness,
                    fractal_dimension,
                    correlation,
                );
                let roughness = self.model(place("correlation"), roughness)?;
                if let Some(band) = table.band {
                    return self.refuse(
                        place("band"),
                        format!("from {} to {} m", band.from, band.to),
                        "a band only beside profiles, which are fitted over it",
                    );
                }
                Ok(SurfaceInput {
                    fractal_dimension,
                    roughness,
                })
            }
            (Some(_), _, _) => self.refuse(
                key,
                "profiles beside fractal_dimension or roughness",
                "the one or the other",
            ),
            (None, _, _) => self.refuse(
                key,
                "neither profiles nor both of fractal_dimension and roughness",
                "profiles = [\"profile-1.csv\", …] with a band, or fractal_dimension and roughness",
            ),
        }
    }

    /// The fit of a surface's profiles.
    fn profiles(
        &mut self,
        key: &str,
        paths: &[PathBuf],
        table: &OneSurfaceTable,
    ) -> Checked<ProfileFit> {
        if paths.is_empty() {
            return self.refuse(format!("{key}.profiles"), "none", "one file or more");
        }
        let wavelength_band_m = match table.band {
            Some(band) => {
                self.check_band(&format!("{key}.band"), band.from, band.to)?;
                Some([band.from, band.to])
            }
            None => None,
        };
        let mut profiles = Vec::with_capacity(paths.len());
        for path in paths {
            let path = origin::resolved(self.folder, path);
            let expected = "a profile (CSV of height over distance)";
            let record = origin::of_file("profile", &path, self.folder, expected)?;
            self.files.push(record);
            profiles.push(Profile::read(&path)?);
        }
        let settings = FitSettings {
            wavelength_band_m,
            ..FitSettings::default()
        };
        let fit = ProfileFit::new(&profiles, &settings);
        self.model(format!("{key}.profiles"), fit)
    }

    fn torques(&self, table: Option<&TighteningTable>) -> Checked<(Vec<f64>, Option<f64>)> {
        let key = "tightening.torques";
        let Some(table) = table else {
            return Ok((Vec::new(), None));
        };
        let Some(torques) = &table.torques else {
            return match table.nominal {
                None => Ok((Vec::new(), None)),
                Some(nominal) => self.refuse(
                    "tightening.nominal",
                    nominal,
                    "a nominal torque only beside torques",
                ),
            };
        };
        let ascends = torques.windows(2).all(|pair| pair[0] < pair[1]);
        let is_positive = torques.iter().all(|t| t.is_finite() && *t > 0.0);
        if torques.len() < 2 || !ascends || !is_positive {
            return self.refuse(
                key,
                format!("{torques:?}"),
                "two torques or more in N·m, above zero and ascending",
            );
        }
        let nominal = table.nominal.or(torques.last().copied());
        match nominal {
            Some(nominal) if !torques.contains(&nominal) => {
                self.refuse("tightening.nominal", nominal, format!("one of {torques:?}"))
            }
            nominal => Ok((torques.clone(), nominal)),
        }
    }

    fn clamping(&mut self, file: &StudyFile, has_table: bool) -> Checked<Clamping> {
        let common = match file.tightening.as_ref() {
            Some(table) if table.scatter == Some(ScatterWord::Common) => self.wrench(table, "")?,
            _ => None,
        };
        let mut bolts = Vec::with_capacity(file.bolts.len());
        for (number, bolt) in (1..).zip(&file.bolts) {
            let tightness =
                self.tightness(number, bolt, file.tightening.as_ref(), &common, has_table)?;
            bolts.push(BoltInput {
                x_m: bolt.x,
                y_m: bolt.y,
                diameter_m: bolt.diameter,
                tightness,
            });
        }
        if bolts.is_empty() && has_table {
            return self.refuse(
                "bolts",
                "none",
                "[[bolts]], which the torques of [tightening] are for",
            );
        }
        let moment = file.pressure.as_ref().and_then(|p| p.bending_moment);
        let moments = match moment {
            Some(_) if bolts.is_empty() => {
                return self.refuse(
                    "pressure.bending_moment",
                    "a moment without bolts",
                    "[[bolts]], whose preloads it changes",
                );
            }
            Some([about_x, about_y]) => {
                let mut add =
                    |name: &str, of| self.inputs.add(name, Distribution::new(Spread::Normal, of));
                Some([
                    add("bending moment about x", about_x),
                    add("bending moment about y", about_y),
                ])
            }
            None => None,
        };
        Ok(Clamping { bolts, moments })
    }

    fn tightness(
        &mut self,
        number: usize,
        bolt: &BoltTable,
        tightening: Option<&TighteningTable>,
        common: &Option<Wrench>,
        has_table: bool,
    ) -> Checked<Tightness> {
        let key = |name: &str| format!("bolts[{number}].{name}");
        match (bolt.preload, bolt.torque) {
            (Some(_), Some(_)) => {
                self.refuse(key("preload"), "a torque beside it", "the one or the other")
            }
            (Some(preload), None) => match has_table {
                true => self.refuse(
                    key("preload"),
                    preload,
                    "no preload: it follows from the torques of [tightening]",
                ),
                false => Ok(Tightness::Preload(self.positive(
                    &key("preload"),
                    format!("preload of bolt {number}"),
                    preload,
                )?)),
            },
            (None, torque) => {
                let own = match (common, tightening) {
                    (Some(common), _) => Some(common.clone()),
                    (None, Some(table)) => self.wrench(table, &format!(" of bolt {number}"))?,
                    (None, None) => None,
                };
                match (torque, has_table, own) {
                    (Some(torque), true, _) => self.refuse(
                        key("torque"),
                        torque,
                        "no torque: that of each bolt is in tightening.torques",
                    ),
                    (_, _, None) if torque.is_some() || has_table => self.refuse(
                        "tightening.nut_factor",
                        "nothing",
                        "nut_factor, about 0.2 for dry steel, or thread = { friction = …, head_friction = …, head_diameter = …, hole_diameter = … }: \
                         without it no preload follows from a torque",
                    ),
                    (Some(torque), false, Some(wrench)) => Ok(Tightness::Torque(
                        self.positive(&key("torque"), format!("torque of bolt {number}"), torque)?,
                        wrench.with_diameter(bolt.diameter),
                    )),
                    (None, true, Some(wrench)) => {
                        Ok(Tightness::OfTable(wrench.with_diameter(bolt.diameter)))
                    }
                    (None, false, _) | (Some(_), false, None) | (None, true, None) => self.refuse(
                        key("preload"),
                        "nothing",
                        "a preload in N, or a torque in N·m with [tightening]",
                    ),
                }
            }
        }
    }

    /// What becomes of a torque; `suffix` tells whose inputs they are.
    fn wrench(&mut self, table: &TighteningTable, suffix: &str) -> Checked<Option<Wrench>> {
        match (table.nut_factor, &table.thread) {
            (Some(_), Some(_)) => self.refuse(
                "tightening.nut_factor",
                "thread beside it",
                "the one or the other",
            ),
            (Some(factor), None) => {
                let name = format!("nut factor{suffix}");
                let place = self.positive("tightening.nut_factor", name, factor)?;
                Ok(Some(Wrench::NutFactor(place)))
            }
            (None, Some(thread)) => self.thread(thread, suffix).map(Some),
            (None, None) => Ok(None),
        }
    }

    fn thread(&mut self, table: &ThreadTable, suffix: &str) -> Checked<Wrench> {
        let key = |name: &str| format!("tightening.thread.{name}");
        for (name, value) in [
            ("pitch", table.pitch.unwrap_or(1.0)),
            ("head_diameter", table.head_diameter),
            ("hole_diameter", table.hole_diameter),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return self.refuse(key(name), value, "a length in m above zero");
            }
        }
        Ok(Wrench::Friction {
            thread: ThreadFriction {
                // of the bolt that it turns: Wrench::with_diameter
                diameter_m: f64::NAN,
                pitch_m: table.pitch.unwrap_or(f64::NAN),
                thread_coefficient: table.friction.value,
                head_coefficient: table.head_friction.value,
                bearing_outer_diameter_m: table.head_diameter,
                bearing_inner_diameter_m: table.hole_diameter,
            },
            thread_coefficient: self.positive(
                &key("friction"),
                format!("thread friction{suffix}"),
                table.friction,
            )?,
            head_coefficient: self.positive(
                &key("head_friction"),
                format!("head friction{suffix}"),
                table.head_friction,
            )?,
        })
    }

    fn geometry(
        &mut self,
        file: &StudyFile,
        clamping: &Clamping,
        nominal_n_m: Option<f64>,
    ) -> Checked<Geometry> {
        let nominal = self.inputs.nominal();
        let bolts = clamping.bolts(&nominal, nominal_n_m);
        let bolts = self.model("bolts", bolts)?;
        let table = &file.interface;
        if let Some(field) = &table.field {
            let preload_n = bolts.iter().map(|bolt| bolt.preload_n).sum();
            return self.given(
                table,
                file.pressure.as_ref(),
                field,
                (!bolts.is_empty()).then_some(preload_n),
            );
        }
        let (Some(x_m), Some(y_m)) = (table.x, table.y) else {
            return self.refuse(
                "interface",
                "neither field nor both of x and y",
                "x = [from, to] and y = [from, to] in m with [pressure] and [[bolts]], or field = \"field.csv\"",
            );
        };
        if let Some(area) = table.area {
            return self.refuse(
                "interface.area",
                area,
                "an area only beside a field, which it is compared with",
            );
        }
        let Some(pressure) = &file.pressure else {
            return self.refuse(
                "pressure.model",
                "nothing",
                "\"uniform\", \"kavi\" or \"cone\"",
            );
        };
        if bolts.is_empty() {
            return self.refuse("bolts", "none", "[[bolts]], which press the parts together");
        }
        let outline = self.model("interface", Rectangle::new(x_m, y_m))?;
        let cells = table.elements.unwrap_or(ELEMENTS);
        let clearance_m = pressure.clearance.unwrap_or(0.0);
        let geometry = match self.zone(pressure)? {
            Some(zone) => Geometry::zones(outline, cells, &bolts, clearance_m, zone),
            None => Geometry::even(outline, cells, &bolts, clearance_m),
        };
        self.model("interface", geometry)
    }

    /// A field from elsewhere.
    fn given(
        &mut self,
        table: &InterfaceTable,
        pressure: Option<&PressureTable>,
        path: &Path,
        preload_n: Option<f64>,
    ) -> Checked<Geometry> {
        if table.x.is_some() || table.y.is_some() || table.elements.is_some() {
            return self.refuse(
                "interface.field",
                "x, y or elements beside it",
                "the one or the other: the field has its own elements",
            );
        }
        if let Some(pressure) = pressure {
            if pressure.model.is_some() {
                return self.refuse(
                    "pressure.model",
                    "a model beside interface.field",
                    "the one or the other: the field has its own pressures",
                );
            }
            if pressure.bending_moment.is_some() {
                return self.refuse(
                    "pressure.bending_moment",
                    "a moment beside interface.field",
                    "a field that was computed with the moment",
                );
            }
        }
        let path = origin::resolved(self.folder, path);
        if let Some(area_m2) = table.area
            && !(area_m2.is_finite() && area_m2 > 0.0)
        {
            return self.refuse("interface.area", area_m2, "m² above zero");
        }
        let record = origin::of_file(
            "pressure field",
            &path,
            self.folder,
            "a pressure field (CSV with the columns x, y, area, pressure)",
        )?;
        let field = PressureField::read(&path, table.area)?;
        self.files.push(record);
        self.model("interface.field", Geometry::given(&field, preload_n))
    }

    /// `None` for an even pressure.
    fn zone(&self, table: &PressureTable) -> Checked<Option<Zone>> {
        match table.model {
            None => self.refuse(
                "pressure.model",
                "nothing",
                "\"uniform\", \"kavi\" or \"cone\"",
            ),
            Some(PressureModel::Uniform) => Ok(None),
            Some(PressureModel::Kavi) => {
                let Some([a_m, b_m]) = table.thickness else {
                    return self.refuse(
                        "pressure.thickness",
                        "nothing",
                        "[a, b], the thicknesses of both parts in m: the polynomial depends on their ratio",
                    );
                };
                let ratio = self.model("pressure.thickness", ThicknessRatio::of(a_m, b_m))?;
                Ok(Some(Zone::Polynomial {
                    thickness_ratio: ratio,
                    reach: match table.reach {
                        Some(ReachWord::Rivets) => Reach::Rivets,
                        Some(ReachWord::Bolts) | None => Reach::Bolts,
                    },
                    force: match table.force {
                        Some(ForceWord::AsPublished) => ZoneForce::AsPublished,
                        Some(ForceWord::Preload) | None => ZoneForce::Preload,
                    },
                }))
            }
            Some(PressureModel::Cone) => {
                let given = |key: &str, value: Option<f64>, what: &str| match value {
                    Some(value) => Ok(value),
                    None => self.refuse(format!("pressure.{key}"), "nothing", what),
                };
                Ok(Some(Zone::Cone(Cone {
                    half_angle_rad: given(
                        "half_angle",
                        table.half_angle,
                        "the cone's half angle in degrees, about 30 for steel",
                    )?
                    .to_radians(),
                    head_diameter_m: given(
                        "head_diameter",
                        table.head_diameter,
                        "the diameter in m of the head or washer",
                    )?,
                    depth_m: given(
                        "depth",
                        table.depth,
                        "the thickness in m between head and interface",
                    )?,
                    distribution: match table.distribution {
                        Some(DistributionWord::Uniform) => ConePressure::Uniform,
                        Some(DistributionWord::Parabolic) | None => ConePressure::Parabolic,
                    },
                })))
            }
        }
    }

    fn joint(&self, table: &JointTable, geometry: &Geometry) -> Checked<(Planar, [f64; 3])> {
        let planar = self.model(
            "joint.rotation",
            Planar::new(table.translation, table.rotation),
        )?;
        let reference_m = match table.reference.as_deref() {
            None => {
                let [x_m, y_m] = geometry.centroid_m();
                // a centroid at 1e-18 m is one at zero
                let size_m = geometry.area_m2().sqrt();
                let clean = |length: f64| match length.abs() < 1e-12 * size_m {
                    true => 0.0,
                    false => length,
                };
                [clean(x_m), clean(y_m), 0.0]
            }
            Some([x_m, y_m]) => [*x_m, *y_m, 0.0],
            Some([x_m, y_m, z_m]) => [*x_m, *y_m, *z_m],
            Some(other) => {
                return self.refuse(
                    "joint.reference",
                    format!("{other:?}"),
                    "[x, y] or [x, y, z] in m, z along the normal from the interface",
                );
            }
        };
        match reference_m.iter().all(|length| length.is_finite()) {
            true => Ok((planar, reference_m)),
            false => self.refuse(
                "joint.reference",
                format!("{reference_m:?}"),
                "finite lengths in m",
            ),
        }
    }

    fn monte_carlo(&self, table: Option<&UncertaintyTable>) -> Checked<Option<MonteCarlo>> {
        let (draws, seed) = match table {
            Some(table) => (table.draws, table.seed.unwrap_or(1)),
            None => (DRAWS, 1),
        };
        if !(2..=MOST_DRAWS).contains(&draws) {
            return self.refuse(
                "uncertainty.draws",
                draws,
                format!("a number from 2 to {MOST_DRAWS}"),
            );
        }
        match (self.inputs.are_exact(), table) {
            (true, Some(_)) => self.refuse(
                "uncertainty",
                "no value with a standard deviation",
                "one at least, such as fractal_dimension = \"1.42 ± 0.02\"",
            ),
            (true, None) => Ok(None),
            (false, _) => Ok(Some(MonteCarlo { draws, seed })),
        }
    }
}

impl Wrench {
    /// For a bolt of this diameter, m.
    fn with_diameter(mut self, diameter: f64) -> Self {
        if let Self::Friction { thread, .. } = &mut self {
            thread.diameter_m = diameter;
            if thread.pitch_m.is_nan() {
                // an unknown one stays no number, which the preload is refused for
                thread.pitch_m = coarse_pitch_m(diameter).unwrap_or(f64::NAN);
            }
        }
        self
    }
}

fn pressure_in_words(file: &StudyFile) -> String {
    if let Some(field) = &file.interface.field {
        return format!("field of {}", field.display());
    }
    match file.pressure.as_ref().and_then(|table| table.model) {
        Some(PressureModel::Uniform) => "even pressure".to_owned(),
        Some(PressureModel::Kavi) => "polynomial zones around the bolts (Kavi)".to_owned(),
        Some(PressureModel::Cone) => "cones under the bolts' heads".to_owned(),
        None => String::new(),
    }
}
