//! What a study says of the surfaces: typed in, or from profiles.

use super::{Checked, Checker, SurfaceInput, SurfaceInputs};
use crate::study::tables::{OneSurfaceTable, SurfaceTable};
use crate::surface::{FitSettings, Profile, ProfileFit};
use crate::uncertain::{Distribution, Spread, Uncertain};
use bolted_joint_study::{StudyError, input_file};
use std::path::PathBuf;

impl Checker<'_> {
    pub(super) fn surfaces(&mut self, table: &SurfaceTable) -> Checked<SurfaceInputs> {
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
                    return self.study.refuse(
                        "surface",
                        "values of both surfaces together beside [surface.a] and [surface.b]",
                        "the one or the other",
                    );
                }
                let expected = "{ from = …, to = … }, the wavelengths in m over which the spectra of both surfaces are added";
                let band = self.study.needed("surface.band", table.band, expected)?;
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
            _ => self.study.refuse(
                "surface",
                "one of [surface.a] and [surface.b]",
                "both, or values of the two together in [surface]",
            ),
        }
    }

    fn check_band(&self, key: &str, from: f64, to: f64) -> Checked<()> {
        self.study.ensure(
            from > 0.0 && to > from && to.is_finite(),
            key,
            format_args!("from {from} to {to} m"),
            "wavelengths in m, the first above zero and less than the second",
        )
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
        let stated = (&table.profiles, table.fractal_dimension, table.roughness);
        let (of_dimension, of_roughness, correlation, origin) = match stated {
            (Some(paths), None, None) => {
                if let Some(correlation) = table.correlation {
                    return self.study.refuse(
                        place("correlation"),
                        correlation,
                        "none beside profiles, from which it follows",
                    );
                }
                let fit = self.profiles(key, paths, table)?;
                let of_dimension = Uncertain {
                    value: fit.roughness.fractal_dimension(),
                    standard_deviation: fit.dimension_standard_deviation(),
                };
                let of_roughness = Distribution::of_logarithm(
                    fit.roughness.roughness_m(),
                    fit.log_roughness_standard_deviation(),
                );
                let correlation = fit.correlation();
                self.fits.push((whose, fit));
                (of_dimension, of_roughness, correlation, "profiles")
            }
            (None, Some(dimension), Some(roughness)) => {
                self.study.ensure(
                    dimension.value > 1.0 && dimension.value < 2.0,
                    place("fractal_dimension"),
                    dimension,
                    "more than 1 and less than 2, as a profile has (a surface's dimension is one more: subtract 1)",
                )?;
                self.study.ensure(
                    roughness.value > 0.0,
                    place("roughness"),
                    roughness,
                    "a length in m above zero, about 1e-13 to 1e-7 for machined metal",
                )?;
                let of_roughness = Distribution::new(Spread::Lognormal, roughness);
                let correlation = table.correlation.unwrap_or(0.0);
                (dimension, of_roughness, correlation, "correlation")
            }
            (Some(_), _, _) => {
                return self.study.refuse(
                    key,
                    "profiles beside fractal_dimension or roughness",
                    "the one or the other",
                );
            }
            (None, _, _) => {
                return self.study.refuse(
                    key,
                    "neither profiles nor both of fractal_dimension and roughness",
                    "profiles = [\"profile-1.csv\", …] with a band, or fractal_dimension and roughness",
                );
            }
        };
        let of_dimension = Distribution::new(within, of_dimension);
        let fractal_dimension = self.inputs.add(dimension_name, of_dimension);
        let roughness = self.inputs.add_correlated(
            roughness_name,
            of_roughness,
            fractal_dimension,
            correlation,
        );
        let roughness = self.model(&place(origin), roughness)?;
        if let (None, Some(band)) = (&table.profiles, table.band) {
            return self.study.refuse(
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

    /// The fit of a surface's profiles.
    fn profiles(
        &mut self,
        key: &str,
        paths: &[PathBuf],
        table: &OneSurfaceTable,
    ) -> Checked<ProfileFit> {
        let found_any = !paths.is_empty();
        let key_of_them = format!("{key}.profiles");
        self.study
            .ensure(found_any, &key_of_them, "none", "one file or more")?;
        let files = paths.iter().map(PathBuf::as_path);
        self.study.every_file_once(&key_of_them, files)?;
        if let Some(band) = table.band {
            self.check_band(&format!("{key}.band"), band.from, band.to)?;
        }
        let mut profiles = Vec::with_capacity(paths.len());
        for path in paths {
            let path = self.study.resolved(path);
            let record = input_file("profile", &path, self.study.folder(), |_, _| {})?;
            self.files.push(record);
            profiles.push(Profile::read(&path).map_err(StudyError::of_file)?);
        }
        let settings = FitSettings {
            wavelength_band_m: table.band.map(|band| [band.from, band.to]),
            ..FitSettings::default()
        };
        let fit = ProfileFit::new(&profiles, &settings);
        self.model(&key_of_them, fit)
    }
}
