//! From tables to a study: everything that can be wrong is said with its key.

use bolted_joint_study::{BeamNumber, StudyError, StudyText};

use super::super::super::pressure::Tightening;
use super::super::super::uncertain::{MonteCarlo, Uncertain};
use super::super::beam::{Layer, LayeredBeam};
use super::super::beam_mode::HIGHEST_MODE;
use super::super::dry_friction::AmplitudeRange;
use super::super::error::{LayeredBeamError, positive};
use super::super::fasteners::{FastenerKind, Fasteners, RIVET_STRESS_PA};
use super::super::lap::EquivalentDamping;
use super::super::scatter::{Scatter, TensionFrom, UncertainValues};
use super::tables::{
    AmplitudeTable, BeamTable, CalibrationTable, DampingName, FastenersTable, StudyFile,
};
use super::{Calibration, Friction, LayeredBeamStudy};

/// Modes that are listed if the study does not say.
const MODES: usize = 5;

/// Amplitudes if the study does not say how many.
const AMPLITUDES: usize = 21;

/// More amplitudes than anyone draws.
const MOST_AMPLITUDES: usize = 100_000;

/// More fasteners than any beam has.
const MOST_FASTENERS: usize = 10_000;

/// T/(P d) of dry steel threads as bought.
const NUT_FACTOR: f64 = 0.2;

/// The fasteners of a table: at the nominal torque, and at each where there are several.
struct Tightened {
    nominal: Fasteners,
    nominal_torque_n_m: Option<f64>,
    over_torque: Vec<(f64, Fasteners)>,
}

pub(super) fn checked(study: &StudyText, file: StudyFile) -> Result<LayeredBeamStudy, StudyError> {
    let beam = layered(study, &file.beam)?;
    let motion = &file.motion;
    let mode = mode_number(study, "motion.mode", motion.mode.unwrap_or(1))?;
    let modes = mode_number(
        study,
        "motion.modes",
        motion.modes.unwrap_or(MODES.max(mode)),
    )?;
    let expected = format!("at least mode {mode}");
    study.ensure(modes >= mode, "motion.modes", modes, expected)?;
    let tightened = tightened(study, &file.fasteners, &beam, file.joint.nominal_torque)?;
    let amplitudes_m = amplitudes(study, &motion.amplitude)?;
    let damping = damping(study, &file, &tightened)?;
    let friction = match (file.friction.alpha_mu, &file.friction.calibration) {
        (Some(alpha_mu), None) => {
            model(study, positive("friction.alpha_mu", alpha_mu.value, ""))?;
            Friction::Known(alpha_mu.value)
        }
        (None, Some(table)) => {
            Friction::Calibrated(Box::new(calibration(study, table, &file, &beam, mode)?))
        }
        (found, _) => {
            let found = if found.is_some() { "both" } else { "neither" };
            let expected = "either alpha_mu or [friction.calibration] with a measured damping_ratio and its amplitude";
            return study.refuse("friction", found, expected);
        }
    };
    let scatter = scatter(study, &file)?;
    Ok(LayeredBeamStudy {
        path: study.path().to_owned(),
        record: study.record(),
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

fn model<T>(study: &StudyText, result: Result<T, LayeredBeamError>) -> Result<T, StudyError> {
    result.map_err(|source| StudyError::model(study.path(), None, source))
}

fn mode_number(study: &StudyText, key: &str, found: usize) -> Result<usize, StudyError> {
    study.within(
        key,
        found,
        1..=HIGHEST_MODE,
        format_args!("1 to {HIGHEST_MODE}"),
    )
}

fn layered(study: &StudyText, table: &BeamTable) -> Result<LayeredBeam, StudyError> {
    study.plausible_in_beam("beam", BeamNumber::Length, table.length)?;
    study.plausible_in_beam("beam", BeamNumber::Width, table.width)?;
    for (place, layer) in table.layer.iter().enumerate() {
        for (number, found) in [
            (BeamNumber::YoungsModulus, layer.youngs_modulus),
            (BeamNumber::Density, layer.density),
        ] {
            study.plausible_in_beam(format_args!("beam.layer[{place}]"), number, found)?;
        }
    }
    let layers = table.layer.iter().map(|layer| Layer {
        thickness_m: layer.thickness,
        youngs_modulus_pa: layer.youngs_modulus,
        density_kg_per_m3: layer.density,
    });
    model(
        study,
        LayeredBeam::new(
            table.length,
            table.width,
            layers.collect(),
            table.boundary,
            table.stiffness_ratio.map_or(1.0, |ratio| ratio.value),
        ),
    )
}

fn positions(
    study: &StudyText,
    table: &FastenersTable,
    length_m: f64,
) -> Result<Vec<f64>, StudyError> {
    let count = || {
        let key = "fasteners.count";
        let count = study.needed(key, table.count, "how many there are, or their positions")?;
        study.within(
            key,
            count,
            1..=MOST_FASTENERS,
            format_args!("1 to {MOST_FASTENERS}"),
        )
    };
    match (&table.positions, table.count, table.pitch) {
        (Some(positions), None, None) => Ok(positions.clone()),
        (Some(_), _, _) => {
            let found = "positions beside count or pitch";
            study.refuse("fasteners.positions", found, "one of them")
        }
        (None, _, None) => Ok(Fasteners::equispaced(count()?, length_m)),
        (None, _, Some(pitch)) => {
            model(study, positive("fasteners.pitch", pitch, "m"))?;
            Ok(Fasteners::about_the_middle(count()?, pitch, length_m))
        }
    }
}

fn tightened(
    study: &StudyText,
    table: &FastenersTable,
    beam: &LayeredBeam,
    nominal: Option<f64>,
) -> Result<Tightened, StudyError> {
    let positions = positions(study, table, beam.length_m())?;
    let alone = |fasteners: Fasteners| Tightened {
        nominal: fasteners,
        nominal_torque_n_m: None,
        over_torque: Vec::new(),
    };
    let tightened = match table.kind {
        FastenerKind::Rivet => {
            let has_one = table.preload.or(table.nut_factor).is_some() || table.torque.is_some();
            let expected = "none: rivets have a stress";
            study.ensure(!has_one, "fasteners.torque", "a value", expected)?;
            let stress = table.stress.map_or(RIVET_STRESS_PA, |stress| stress.value);
            alone(model(
                study,
                Fasteners::rivets(table.diameter, stress, positions),
            )?)
        }
        FastenerKind::Bolt => {
            let has_one = table.stress.is_some();
            let expected = "none: bolts have a preload or a torque";
            study.ensure(!has_one, "fasteners.stress", "a value", expected)?;
            let bolts = |preload: f64| {
                model(
                    study,
                    Fasteners::bolts(table.diameter, preload, positions.clone()),
                )
            };
            match (table.preload, &table.torque) {
                (Some(preload), None) if table.nut_factor.is_none() => alone(bolts(preload.value)?),
                (None, Some(torque)) => {
                    let torques = torque.list();
                    let expected = "positive torques (N·m), ascending";
                    study.ascending("fasteners.torque", &torques, 1, expected)?;
                    let factor = table.nut_factor.map_or(NUT_FACTOR, |factor| factor.value);
                    model(study, positive("fasteners.nut_factor", factor, ""))?;
                    model(study, positive("fasteners.diameter", table.diameter, "m"))?;
                    let tightening = Tightening::NutFactor {
                        factor,
                        diameter_m: table.diameter,
                    };
                    let at = |torque: f64| {
                        let preload = tightening.preload_n(torque);
                        bolts(preload.map_err(|error| {
                            let found = format!("{error}");
                            study.refusal("fasteners.torque", found, "what a bolt can have")
                        })?)
                    };
                    // Both are there: `ascending` has refused an empty list.
                    let lowest = torques.first().copied().unwrap_or(f64::NAN);
                    let highest = torques.last().copied().unwrap_or(f64::NAN);
                    let expected = format!("{lowest} to {highest} N·m, within fasteners.torque");
                    let nominal = nominal.unwrap_or(highest);
                    let key = "joint.nominal_torque";
                    study.within(key, nominal, lowest..=highest, expected)?;
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
                    return study.refuse(
                        "fasteners",
                        "no preload and no torque, or both",
                        "for bolts, a preload (N) or a torque (N·m) with its nut_factor",
                    );
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
    model(study, tightened.nominal.check_on(beam))?;
    model(study, tightened.nominal.slip_moment_n_m(beam))?;
    Ok(tightened)
}

fn amplitudes(study: &StudyText, table: &AmplitudeTable) -> Result<Vec<f64>, StudyError> {
    let range = AmplitudeRange::new("motion.amplitude", table.from, table.to);
    let range = model(study, range)?;
    let count = table.count.unwrap_or(AMPLITUDES);
    let expected = format!("2 to {MOST_AMPLITUDES}");
    study.within(
        "motion.amplitude.count",
        count,
        2..=MOST_AMPLITUDES,
        expected,
    )?;
    let span = range.to_m() - range.from_m();
    let at = |k: usize| range.from_m() + span * k as f64 / (count - 1) as f64;
    Ok((0..count).map(at).collect())
}

fn damping(
    study: &StudyText,
    file: &StudyFile,
    tightened: &Tightened,
) -> Result<EquivalentDamping, StudyError> {
    let table = &file.joint;
    let over_torque = !tightened.over_torque.is_empty();
    let linear = table.damping == Some(DampingName::Linear);
    study.ensure(
        table.nominal_torque.is_none() || over_torque,
        "joint.nominal_torque",
        "a value",
        "none without a list in fasteners.torque",
    )?;
    let (from, to) = (file.motion.amplitude.from, file.motion.amplitude.to);
    if linear {
        let amplitude = table.amplitude.unwrap_or_else(|| (from * to).sqrt());
        model(study, positive("joint.amplitude", amplitude, "m"))?;
        return Ok(EquivalentDamping::AtAmplitude(amplitude));
    }
    study.ensure(
        table.amplitude.is_none(),
        "joint.amplitude",
        "a value",
        "none, or joint.damping = \"linear\": otherwise damping follows motion.amplitude",
    )?;
    let range = model(study, AmplitudeRange::new("motion.amplitude", from, to))?;
    Ok(EquivalentDamping::Over(range))
}

fn scatter(study: &StudyText, file: &StudyFile) -> Result<Option<Scatter>, StudyError> {
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
            return study.refuse(
                "friction.calibration",
                found,
                "no standard deviations on the beam of the calibration: let damping_ratio have it",
            );
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
    let (draws, seed) = study.draws(file.uncertainty.as_ref())?;
    let scatter = Scatter::of(&values, MonteCarlo { draws, seed });
    study.ensure(
        scatter.is_some() || file.uncertainty.is_none(),
        "uncertainty",
        "no value with a standard deviation",
        "one at least, such as alpha_mu = \"0.002 ± 0.0003\"",
    )?;
    Ok(scatter)
}

fn calibration(
    study: &StudyText,
    table: &CalibrationTable,
    file: &StudyFile,
    beam: &LayeredBeam,
    mode: usize,
) -> Result<Calibration, StudyError> {
    model(
        study,
        positive(
            "friction.calibration.damping_ratio",
            table.damping_ratio.value,
            "",
        ),
    )?;
    model(
        study,
        positive("friction.calibration.amplitude", table.amplitude, "m"),
    )?;
    let own_beam = table.beam.as_ref();
    let beam = own_beam.map_or_else(|| Ok(beam.clone()), |table| layered(study, table))?;
    let fasteners = table.fasteners.as_ref().unwrap_or(&file.fasteners);
    let nominal = match table.fasteners {
        Some(_) => None,
        None => file.joint.nominal_torque,
    };
    let tightened = tightened(study, fasteners, &beam, nominal)?;
    study.ensure(
        table.fasteners.is_none() || tightened.over_torque.is_empty(),
        "friction.calibration.fasteners.torque",
        "several",
        "the one at which damping was measured",
    )?;
    Ok(Calibration {
        damping_ratio: table.damping_ratio.value,
        amplitude_m: table.amplitude,
        mode: mode_number(
            study,
            "friction.calibration.mode",
            table.mode.unwrap_or(mode),
        )?,
        drive_point_m: table.drive_point.or(if own_beam.is_none() {
            file.motion.drive_point
        } else {
            None
        }),
        beam,
        fasteners: tightened.nominal,
    })
}
