//! From tables to a study: everything that can be wrong is said with its key.

use std::path::Path;

use sha2::{Digest as _, Sha256};

use super::super::super::pressure::Tightening;
use super::super::super::uncertain::{MonteCarlo, Uncertain};
use super::super::amplitude_damping::AmplitudeRange;
use super::super::beam::{Layer, LayeredBeam};
use super::super::beam_mode::HIGHEST_MODE;
use super::super::error::{LayeredBeamError, positive};
use super::super::fasteners::{FastenerKind, Fasteners, RIVET_STRESS_PA};
use super::super::lap::EquivalentDamping;
use super::super::scatter::{Scatter, TensionFrom, UncertainValues};
use super::tables::{
    AmplitudeTable, BeamTable, CalibrationTable, DampingName, FastenersTable, StudyFile,
};
use super::{Calibration, Friction, Study, StudyError};

/// Modes that are listed if the study does not say.
const MODES: usize = 5;

/// Amplitudes if the study does not say how many.
const AMPLITUDES: usize = 21;

/// More amplitudes than anyone draws.
const MOST_AMPLITUDES: usize = 100_000;

/// More fasteners than any beam has.
const MOST_FASTENERS: usize = 10_000;

/// Draws if the study does not say, and the most of them.
const DRAWS: u64 = 2000;
const MOST_DRAWS: u64 = 1_000_000;

/// T/(P d) of dry steel threads as bought.
const NUT_FACTOR: f64 = 0.2;

pub(super) struct Checker<'a> {
    pub(super) path: &'a Path,
    pub(super) text: &'a str,
}

/// The fasteners of a table: at the nominal torque, and at each where there are several.
struct Tightened {
    nominal: Fasteners,
    nominal_torque_n_m: Option<f64>,
    over_torque: Vec<(f64, Fasteners)>,
}

impl Checker<'_> {
    pub(super) fn study(&self, file: StudyFile) -> Result<Study, StudyError> {
        if file.name.trim().is_empty() || file.name.contains(['\n', '\r']) {
            return Err(self.refuse("name", format!("{:?}", file.name), "one line of text"));
        }
        let beam = self.beam(&file.beam)?;
        let motion = &file.motion;
        let mode = self.mode("motion.mode", motion.mode.unwrap_or(1))?;
        let modes = self.mode("motion.modes", motion.modes.unwrap_or(MODES.max(mode)))?;
        if modes < mode {
            return Err(self.refuse("motion.modes", modes, format!("at least mode {mode}")));
        }
        let tightened = self.tightened(&file.fasteners, &beam, file.joint.nominal_torque)?;
        let amplitudes_m = self.amplitudes(&motion.amplitude)?;
        let damping = self.damping(&file, &tightened)?;
        let friction = match (file.friction.alpha_mu, &file.friction.calibration) {
            (Some(alpha_mu), None) => {
                self.model(positive("friction.alpha_mu", alpha_mu.value, ""))?;
                Friction::Known(alpha_mu.value)
            }
            (None, Some(table)) => {
                Friction::Calibrated(Box::new(self.calibration(table, &file, &beam, mode)?))
            }
            (found, _) => {
                let found = if found.is_some() { "both" } else { "neither" };
                let expected = "either alpha_mu or [friction.calibration] with a measured damping_ratio and its amplitude";
                return Err(self.refuse("friction", found, expected));
            }
        };
        let scatter = self.scatter(&file)?;
        Ok(Study {
            path: self.path.to_owned(),
            sha256: hexadecimal(&Sha256::digest(self.text.as_bytes())),
            name: file.name,
            notes: file.notes,
            beam,
            fasteners: tightened.nominal,
            over_torque: tightened.over_torque,
            nominal_torque_n_m: tightened.nominal_torque_n_m,
            friction,
            mode,
            modes,
            drive_point_m: motion.drive_point,
            amplitudes_m,
            route: motion.route,
            stored: motion.stored_energy,
            damping,
            scatter,
        })
    }

    fn refuse(&self, key: &str, found: impl ToString, expected: impl ToString) -> StudyError {
        StudyError::Value {
            path: self.path.to_owned(),
            key: key.to_owned(),
            found: found.to_string(),
            expected: expected.to_string(),
        }
    }

    fn model<T>(&self, result: Result<T, LayeredBeamError>) -> Result<T, StudyError> {
        result.map_err(|source| StudyError::Model {
            path: self.path.to_owned(),
            source,
        })
    }

    fn mode(&self, key: &str, found: usize) -> Result<usize, StudyError> {
        if (1..=HIGHEST_MODE).contains(&found) {
            Ok(found)
        } else {
            Err(self.refuse(key, found, format!("1 to {HIGHEST_MODE}")))
        }
    }

    fn beam(&self, table: &BeamTable) -> Result<LayeredBeam, StudyError> {
        let layers = table.layer.iter().map(|layer| Layer {
            thickness_m: layer.thickness,
            youngs_modulus_pa: layer.youngs_modulus,
            density_kg_per_m3: layer.density,
        });
        self.model(LayeredBeam::new(
            table.length,
            table.width,
            layers.collect(),
            table.boundary,
            table.stiffness_ratio.map_or(1.0, |ratio| ratio.value),
        ))
    }

    fn positions(&self, table: &FastenersTable, length_m: f64) -> Result<Vec<f64>, StudyError> {
        let count = || match table.count {
            Some(count) if (1..=MOST_FASTENERS).contains(&count) => Ok(count),
            Some(count) => {
                Err(self.refuse("fasteners.count", count, format!("1 to {MOST_FASTENERS}")))
            }
            None => Err(self.refuse(
                "fasteners.count",
                "nothing",
                "how many there are, or their positions",
            )),
        };
        match (&table.positions, table.count, table.pitch) {
            (Some(positions), None, None) => Ok(positions.clone()),
            (Some(_), _, _) => Err(self.refuse(
                "fasteners.positions",
                "positions beside count or pitch",
                "one of them",
            )),
            (None, _, None) => Ok(Fasteners::equispaced(count()?, length_m)),
            (None, _, Some(pitch)) => {
                self.model(positive("fasteners.pitch", pitch, "m"))?;
                Ok(Fasteners::about_the_middle(count()?, pitch, length_m))
            }
        }
    }

    fn tightened(
        &self,
        table: &FastenersTable,
        beam: &LayeredBeam,
        nominal: Option<f64>,
    ) -> Result<Tightened, StudyError> {
        let positions = self.positions(table, beam.length_m())?;
        let of = |key: &str, what: &str| self.refuse(&format!("fasteners.{key}"), "a value", what);
        let alone = |fasteners: Fasteners| Tightened {
            nominal: fasteners,
            nominal_torque_n_m: None,
            over_torque: Vec::new(),
        };
        let tightened = match table.kind {
            FastenerKind::Rivet => {
                if table.preload.is_some() || table.torque.is_some() || table.nut_factor.is_some() {
                    return Err(of("torque", "none: rivets have a stress"));
                }
                let stress = table.stress.map_or(RIVET_STRESS_PA, |stress| stress.value);
                alone(self.model(Fasteners::rivets(table.diameter, stress, positions))?)
            }
            FastenerKind::Bolt => {
                if table.stress.is_some() {
                    return Err(of("stress", "none: bolts have a preload or a torque"));
                }
                let bolts = |preload: f64| {
                    self.model(Fasteners::bolts(table.diameter, preload, positions.clone()))
                };
                match (table.preload, &table.torque) {
                    (Some(preload), None) if table.nut_factor.is_none() => {
                        alone(bolts(preload.value)?)
                    }
                    (None, Some(torque)) => {
                        let torques = torque.list();
                        self.torques(&torques)?;
                        let factor = table.nut_factor.map_or(NUT_FACTOR, |factor| factor.value);
                        self.model(positive("fasteners.nut_factor", factor, ""))?;
                        self.model(positive("fasteners.diameter", table.diameter, "m"))?;
                        let tightening = Tightening::NutFactor {
                            factor,
                            diameter_m: table.diameter,
                        };
                        let at = |torque: f64| {
                            let preload = tightening.preload_n(torque);
                            bolts(preload.map_err(|error| {
                                let found = format!("{error}");
                                self.refuse("fasteners.torque", found, "what a bolt can have")
                            })?)
                        };
                        let highest = torques.last().copied().unwrap_or(0.0);
                        let nominal = nominal.unwrap_or(highest);
                        let [lowest, ..] = torques.as_slice() else {
                            return Err(self.refuse("fasteners.torque", "none", "at least one"));
                        };
                        if !(nominal >= *lowest && nominal <= highest) {
                            return Err(self.refuse(
                                "joint.nominal_torque",
                                nominal,
                                format!("{lowest} to {highest} N·m, within fasteners.torque"),
                            ));
                        }
                        let each = torques.iter().map(|&torque| Ok((torque, at(torque)?)));
                        let over_torque = if torques.len() > 1 {
                            each.collect::<Result<_, StudyError>>()?
                        } else {
                            Vec::new()
                        };
                        Tightened {
                            nominal: at(nominal)?,
                            nominal_torque_n_m: Some(nominal),
                            over_torque,
                        }
                    }
                    _ => {
                        return Err(self.refuse(
                            "fasteners",
                            "no preload and no torque, or both",
                            "for bolts, a preload (N) or a torque (N·m) with its nut_factor",
                        ));
                    }
                }
            }
        };
        let with_rule = |fasteners: Fasteners| fasteners.with_rule(table.normal_force);
        let tightened = Tightened {
            nominal: with_rule(tightened.nominal),
            nominal_torque_n_m: tightened.nominal_torque_n_m,
            over_torque: tightened
                .over_torque
                .into_iter()
                .map(|(torque, fasteners)| (torque, with_rule(fasteners)))
                .collect(),
        };
        self.model(tightened.nominal.check_on(beam))?;
        self.model(tightened.nominal.slip_moment_n_m(beam))?;
        Ok(tightened)
    }

    fn torques(&self, torques: &[f64]) -> Result<(), StudyError> {
        let positive = torques
            .iter()
            .all(|torque| torque.is_finite() && *torque > 0.0);
        if !positive || !torques.is_sorted_by(|a, b| a < b) || torques.is_empty() {
            return Err(self.refuse(
                "fasteners.torque",
                format!("{torques:?}"),
                "positive torques (N·m), ascending",
            ));
        }
        Ok(())
    }

    fn amplitudes(&self, table: &AmplitudeTable) -> Result<Vec<f64>, StudyError> {
        let range = AmplitudeRange::new("motion.amplitude", table.from, table.to);
        let range = self.model(range)?;
        let count = table.count.unwrap_or(AMPLITUDES);
        if !(2..=MOST_AMPLITUDES).contains(&count) {
            let expected = format!("2 to {MOST_AMPLITUDES}");
            return Err(self.refuse("motion.amplitude.count", count, expected));
        }
        let span = range.to_m() - range.from_m();
        let at = |k: usize| range.from_m() + span * k as f64 / (count - 1) as f64;
        Ok((0..count).map(at).collect())
    }

    fn damping(
        &self,
        file: &StudyFile,
        tightened: &Tightened,
    ) -> Result<EquivalentDamping, StudyError> {
        let table = &file.joint;
        let over_torque = !tightened.over_torque.is_empty();
        let linear = table.damping == Some(DampingName::Linear);
        if over_torque && !linear {
            return Err(self.refuse(
                "joint.damping",
                if table.damping.is_some() { "\"over-amplitude\"" } else { "nothing" },
                "\"linear\": a joint file over the torque has no damping that depends on the amplitude",
            ));
        }
        if table.nominal_torque.is_some() && !over_torque {
            return Err(self.refuse(
                "joint.nominal_torque",
                "a value",
                "none without a list in fasteners.torque",
            ));
        }
        let (from, to) = (file.motion.amplitude.from, file.motion.amplitude.to);
        if linear {
            let amplitude = table.amplitude.unwrap_or_else(|| (from * to).sqrt());
            self.model(positive("joint.amplitude", amplitude, "m"))?;
            return Ok(EquivalentDamping::AtAmplitude(amplitude));
        }
        if table.amplitude.is_some() {
            return Err(self.refuse(
                "joint.amplitude",
                "a value",
                "none, or joint.damping = \"linear\": otherwise damping follows motion.amplitude",
            ));
        }
        let range = self.model(AmplitudeRange::new("motion.amplitude", from, to))?;
        Ok(EquivalentDamping::Over(range))
    }

    fn scatter(&self, file: &StudyFile) -> Result<Option<Scatter>, StudyError> {
        let exact = Uncertain::exact;
        let own = &file.fasteners;
        let tension = match (own.kind, own.preload) {
            (FastenerKind::Rivet, _) => (
                TensionFrom::Stress,
                own.stress.unwrap_or(exact(RIVET_STRESS_PA)),
            ),
            (FastenerKind::Bolt, Some(preload)) => (TensionFrom::Preload, preload),
            (FastenerKind::Bolt, None) => (
                TensionFrom::NutFactor,
                own.nut_factor.unwrap_or(exact(NUT_FACTOR)),
            ),
        };
        let calibration = file.friction.calibration.as_ref();
        if let Some(table) = calibration {
            let ratio = table.beam.as_ref().and_then(|beam| beam.stiffness_ratio);
            let fasteners = table.fasteners.iter();
            let values = fasteners.flat_map(|own| [own.stress, own.preload, own.nut_factor]);
            let mut values = values.flatten().chain(ratio);
            if let Some(found) = values.find(|value| !value.is_exact()) {
                return Err(self.refuse(
                    "friction.calibration",
                    found,
                    "no standard deviations on the beam of the calibration: let damping_ratio have it",
                ));
            }
        }
        let friction = match calibration {
            Some(table) => table.damping_ratio,
            None => file.friction.alpha_mu.unwrap_or(exact(1.0)),
        };
        let values = UncertainValues {
            stiffness_ratio: file.beam.stiffness_ratio.unwrap_or(exact(1.0)),
            tension,
            friction,
            calibrated_on_own: calibration
                .map(|table| [table.beam.is_none(), table.fasteners.is_none()]),
        };
        let (draws, seed) = match &file.uncertainty {
            Some(table) => (table.draws, table.seed.unwrap_or(1)),
            None => (DRAWS, 1),
        };
        if !(2..=MOST_DRAWS).contains(&draws) {
            let expected = format!("a number from 2 to {MOST_DRAWS}");
            return Err(self.refuse("uncertainty.draws", draws, expected));
        }
        let scatter = Scatter::of(&values, MonteCarlo { draws, seed });
        if scatter.is_none() && file.uncertainty.is_some() {
            return Err(self.refuse(
                "uncertainty",
                "no value with a standard deviation",
                "one at least, such as alpha_mu = \"0.002 ± 0.0003\"",
            ));
        }
        Ok(scatter)
    }

    fn calibration(
        &self,
        table: &CalibrationTable,
        file: &StudyFile,
        beam: &LayeredBeam,
        mode: usize,
    ) -> Result<Calibration, StudyError> {
        self.model(positive(
            "friction.calibration.damping_ratio",
            table.damping_ratio.value,
            "",
        ))?;
        self.model(positive(
            "friction.calibration.amplitude",
            table.amplitude,
            "m",
        ))?;
        let own_beam = table.beam.as_ref();
        let beam = own_beam.map_or_else(|| Ok(beam.clone()), |table| self.beam(table))?;
        let fasteners = table.fasteners.as_ref().unwrap_or(&file.fasteners);
        let nominal = match table.fasteners {
            Some(_) => None,
            None => file.joint.nominal_torque,
        };
        let tightened = self.tightened(fasteners, &beam, nominal)?;
        if table.fasteners.is_some() && !tightened.over_torque.is_empty() {
            return Err(self.refuse(
                "friction.calibration.fasteners.torque",
                "several",
                "the one at which damping was measured",
            ));
        }
        Ok(Calibration {
            damping_ratio: table.damping_ratio.value,
            amplitude_m: table.amplitude,
            mode: self.mode("friction.calibration.mode", table.mode.unwrap_or(mode))?,
            drive_point_m: table.drive_point.or(if own_beam.is_none() {
                file.motion.drive_point
            } else {
                None
            }),
            beam,
            fasteners: tightened.nominal,
        })
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
