//! Modes of a universal file (data sets 55 and 2414), made into those of a substructure: SI, unit modal masses, names of points.

use std::io::{BufRead, BufReader, Read as _};
use std::path::Path;

use bolted_joint_files::inputs;
use num_complex::Complex64;

use std::f64::consts::TAU;

use super::{ModalModel, Mode};
use crate::structure::StructureError;
use crate::uff::{ShapeFile, Vibration, read_shapes};
use crate::{Container, Direction, Dof, FrfError, Sign, UnitSystem};

/// How much of a file is looked at to tell what it is.
const LOOKED_AT: u64 = 4096;
/// Damping by loss factor and by ratio are the same damping within this part.
const SAME_DAMPING: f64 = 1e-2;

const DIRECTIONS: [Direction; 6] = [
    Direction::X,
    Direction::Y,
    Direction::Z,
    Direction::RX,
    Direction::RY,
    Direction::RZ,
];

/// Whether the file at `path` is a universal file.
pub(super) fn is_one(path: &Path) -> bool {
    let mut beginning = Vec::new();
    let is_read = inputs::open(path)
        .and_then(|file| file.take(LOOKED_AT).read_to_end(&mut beginning))
        .is_ok();
    is_read && Container::told_by(path, &beginning) == Some(Container::Universal)
}

/// Reads the modes of a universal file.
pub(super) fn read(path: &Path) -> Result<ModalModel, StructureError> {
    let file = inputs::open(path).map_err(|source| {
        Box::new(FrfError::Read {
            path: path.to_owned(),
            source,
        })
    })?;
    read_from(BufReader::new(file), path)
}

/// As [`read`], from any reader.
pub(super) fn read_from(reader: impl BufRead, path: &Path) -> Result<ModalModel, StructureError> {
    let shapes = read_shapes(reader, path).map_err(Box::new)?;
    model(path, &shapes)
}

/// What was found in a mode, and what the shape of unit modal mass is multiplied by.
struct Scaled {
    frequency_hz: f64,
    damping_ratio: f64,
    factor: Complex64,
    /// The modal mass that the file states, in its own unit; none for a complex mode.
    mass: Option<f64>,
    from_loss_factor: bool,
}

fn model(path: &Path, file: &ShapeFile) -> Result<ModalModel, StructureError> {
    let refuse = |found: String, expected: &str| StructureError::Modes {
        path: path.to_owned(),
        found: format!("found {found}"),
        expected: expected.to_owned(),
    };
    let Some(first) = file.modes.first() else {
        let others = match file.passed_over {
            0 => String::new(),
            count => format!(", and {count} of other data at nodes"),
        };
        return Err(refuse(
            format!("no mode shapes (data sets 55 and 2414){others}"),
            "data sets 55 or 2414 of normal modes; export the modes as UFF 55",
        ));
    };
    let units = file.units.unwrap_or(UnitSystem::SI);
    // H = U U/m: of translations in length/force, of rotations in 1/(length·force), so that u_SI = U √(length/force) and
    // U/√(length·force)
    let to_si = |motion: usize| match motion {
        0..3 => units.to_si(1, -1).sqrt(),
        _ => units.to_si(-1, -1).sqrt(),
    };
    let mut points = Vec::new();
    for &node in first.nodes.keys() {
        for (motion, &direction) in DIRECTIONS.iter().enumerate() {
            let moves = file.modes.iter().any(|mode| {
                mode.nodes
                    .get(&node)
                    .is_some_and(|motions| motions[motion] != Complex64::default())
            });
            if moves {
                points.push((node, motion, Dof::new(node, direction, Sign::Plus)));
            }
        }
    }
    let mut modes = Vec::new();
    let mut scales = Vec::new();
    for (index, mode) in file.modes.iter().enumerate() {
        let which = format!("mode {} (line {})", index + 1, mode.line);
        if !mode.nodes.keys().eq(first.nodes.keys()) {
            return Err(refuse(
                format!(
                    "{which} at {} nodes, which are not the {} of the first mode",
                    mode.nodes.len(),
                    first.nodes.len()
                ),
                "every mode at the same nodes; export them together",
            ));
        }
        let scaled = scaled(mode.vibration)
            .map_err(|(found, expected)| refuse(format!("{which} with {found}"), expected))?;
        let shape = points.iter().map(|&(node, motion, _)| {
            let value = mode.nodes[&node][motion] * scaled.factor * to_si(motion);
            [value.re, value.im]
        });
        modes.push(Mode {
            frequency_hz: scaled.frequency_hz,
            damping_ratio: scaled.damping_ratio,
            shape: shape.collect(),
        });
        scales.push(scaled);
    }
    let mut warnings = Vec::new();
    if file.units.is_none() {
        warnings.push(format!(
            "{}: states no units (data set 164), so shapes and modal masses are taken as SI",
            path.display()
        ));
    }
    let model = ModalModel {
        path: path.to_owned(),
        points: points.into_iter().map(|(_, _, dof)| dof).collect(),
        modes,
        residuals: Vec::new(),
        understood: understood(file, &scales),
        warnings,
    };
    model.check()?;
    Ok(model)
}

/// Frequency, damping and what makes the modal mass 1; else what was found and what was expected.
fn scaled(vibration: Vibration) -> Result<Scaled, (String, &'static str)> {
    match vibration {
        Vibration::Normal {
            frequency_hz,
            mass,
            viscous,
            hysteretic,
        } => {
            if mass <= 0.0 {
                return Err((
                    format!("the modal mass {mass}"),
                    "a modal mass above zero, which gives the shape its scale; export scaled shapes (1 where they have unit modal mass)",
                ));
            }
            // at resonance a loss factor η does what ζ = η/2 does
            let from_loss_factor = viscous == 0.0 && hysteretic > 0.0;
            let is_one = from_loss_factor
                || hysteretic == 0.0
                || (hysteretic / 2.0 - viscous).abs() <= SAME_DAMPING * viscous;
            if !is_one {
                return Err((
                    format!("damping ratio {viscous} and loss factor {hysteretic}"),
                    "one of them, the other 0, or the loss factor twice the ratio",
                ));
            }
            Ok(Scaled {
                frequency_hz,
                damping_ratio: if from_loss_factor {
                    hysteretic / 2.0
                } else {
                    viscous
                },
                // u = U/√m
                factor: Complex64::from(1.0 / mass.sqrt()),
                mass: Some(mass),
                from_loss_factor,
            })
        }
        Vibration::Complex { pole, modal_a } => {
            let size = pole.norm();
            if pole.re > 0.0 || pole.im <= 0.0 || modal_a == Complex64::default() {
                return Err((
                    format!("pole {pole} and modal A {modal_a}"),
                    "a pole with a real part that is not positive and an imaginary part above zero, and modal A other than zero",
                ));
            }
            // H = Σ U U/(a (jω − λ)) + …: u = U √(2j ω_d/a)
            Ok(Scaled {
                frequency_hz: size / TAU,
                damping_ratio: -pole.re / size,
                factor: (Complex64::new(0.0, 2.0 * pole.im) / modal_a).sqrt(),
                mass: None,
                from_loss_factor: false,
            })
        }
    }
}

/// What a reader of the file should know of how it was read.
fn understood(file: &ShapeFile, scales: &[Scaled]) -> Vec<(&'static str, String)> {
    let units = match file.units {
        Some(units) => format!("data set 164: {units}"),
        None => "none stated, taken as SI".to_owned(),
    };
    let masses: Vec<f64> = scales.iter().filter_map(|own| own.mass).collect();
    let (least, most) = masses
        .iter()
        .fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), &own| {
            (least.min(own), most.max(own))
        });
    let scale = match masses.len() {
        0 => "complex modes, scaled by modal A".to_owned(),
        _ if least == 1.0 && most == 1.0 => "unit modal masses".to_owned(),
        _ if least == most => format!("modal masses {least}, brought to 1"),
        _ => format!("modal masses {least} to {most}, brought to 1"),
    };
    let mut all = vec![("units", units), ("scale", scale)];
    let from_loss_factor = scales.iter().filter(|own| own.from_loss_factor).count();
    if from_loss_factor > 0 {
        all.push((
            "damping",
            format!("of {from_loss_factor} modes by half the loss factor"),
        ));
    }
    if !file.modes.iter().any(|mode| mode.has_rotations) {
        all.push((
            "motions",
            "translations; the file has no rotations".to_owned(),
        ));
    }
    if file.passed_over > 0 {
        all.push((
            "passed over",
            format!(
                "{} data sets 55 and 2414 that are no mode shapes",
                file.passed_over
            ),
        ));
    }
    all
}
