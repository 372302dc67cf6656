//! A joint file: its numbers with their deviations, its laws, where it holds and where it comes from.

use std::path::Path;

use bolted_joint_dynamics::law::{DAMPING, Parameter, STIFFNESS, Term};
use bolted_joint_dynamics::{DofKind, with_dofs};
use bolted_joint_export::joint_curves;
use bolted_joint_figures::html::escaped;
use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_joint::{Friction, JointFile, MatrixPassivity, OverPreload, unit};
use bolted_joint_report::ShownPicture;
use bolted_joint_respond::HysteresisLoop;
use serde_json::json;

use crate::shown::{counted, short};
use crate::{ShowError, Shown};

/// Digits of a value, and of its deviation.
const DIGITS: (usize, usize) = (6, 2);
/// Amplitudes that are tried for the loop that is drawn, and their range (m, rad).
const AMPLITUDES: (usize, f64, f64) = (40, 1e-8, 1e-2);

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    let file = JointFile::read(path)?;
    let mut shown = Shown::of("joint file");
    tell(&file, &mut shown);
    let passivity = file.passivity();
    let active = passivity.active().map(MatrixPassivity::finding);
    shown.warnings.extend(active);
    Ok(shown)
}

/// What a joint file says, also of one in an FMU, whose inspection warns of one that is active.
pub(crate) fn tell(file: &JointFile, shown: &mut Shown) {
    let joint = &file.joint;
    shown.fact("name", &file.name);
    shown.fact("dofs", joint.dofs.to_string());
    let deviation = file.uncertainty.as_ref().map(|own| &own.standard_deviation);
    if joint.over_preload.is_none() {
        shown.facts_of(
            "stiffness",
            matrix(
                file,
                &joint.stiffness,
                deviation.map(|own| own.stiffness.as_slice()),
                STIFFNESS,
            ),
        );
        shown.facts_of(
            "damping",
            matrix(
                file,
                &joint.damping,
                deviation.map(|own| own.damping.as_slice()),
                DAMPING,
            ),
        );
    }
    shown.facts_of(
        "beyond linear",
        terms(file).into_iter().chain(friction(
            &joint.friction,
            deviation.map_or(&[], |own| own.friction.as_slice()),
        )),
    );
    if let Some(table) = &joint.over_preload {
        shown.facts_of("over preload", over_preload(file, table));
    }
    if file.bodies.is_some() {
        shown.fact("bodies", "one on each side, for an FMU of a lap");
    }
    if let Some(own) = &file.uncertainty {
        shown.fact("deviations", own.basis.clone());
        if !own.not_identified.is_empty() {
            shown.warnings.push(format!(
                "the data do not determine {}",
                own.not_identified.join(", ")
            ));
        }
    }
    if let Some(validity) = &file.validity {
        let [low, high] = validity.frequency_hz;
        let mut told = vec![format!("{} to {} Hz", short(low, 5), short(high, 5))];
        if let Some([low, high]) = validity.torque_n_m {
            told.push(format!(
                "tightened with {} to {} N·m",
                short(low, 4),
                short(high, 4)
            ));
        }
        told.extend(validity.level.clone());
        shown.facts_of("holds", told);
    }
    if let Some(own) = &file.residual {
        let chi = own.reduced_chi_squared.map_or_else(String::new, |chi| {
            format!("; χ² per degree of freedom {}", short(chi, 3))
        });
        shown.fact(
            "residual",
            format!(
                "{:.2} % r.m.s. over {}{chi}",
                100.0 * own.relative_rms,
                counted(own.lines, "line")
            ),
        );
    }
    if let Some(own) = &file.provenance {
        let mut told = vec![format!(
            "{} {}: method {}, model {}",
            own.tool, own.version, own.method, own.model
        )];
        told.extend(
            own.inputs
                .iter()
                .map(|input| format!("{}: {}", input.role, input.file)),
        );
        shown.facts_of("from", told);
        shown.facts_of("notes", own.notes.iter().cloned());
    }
    let passivity = file.passivity();
    shown.fact(
        "passive",
        match passivity.is_passive() {
            true => "yes: it cannot feed energy into a simulation",
            false => "no, it is active: it can feed energy into a simulation",
        },
    );
    shown.reasons_against = file.reasons_against().to_vec();
    shown.detail("name", file.name.clone());
    shown.detail("dofs", joint.dofs.names());
    shown.detail("passive", passivity.is_passive());
    shown.detail("stiffness", json!(joint.stiffness));
    shown.detail("damping", json!(joint.damping));
    shown.pictures = pictures(file);
}

/// A line for each entry of the upper triangle that is not zero, with its deviation.
fn matrix(
    file: &JointFile,
    entries: &[Vec<f64>],
    deviation: Option<&[Vec<f64>]>,
    parameter: &Parameter,
) -> Vec<String> {
    let dofs = file.joint.dofs;
    let at =
        |matrix: &[Vec<f64>], [i, j]: [usize; 2]| matrix.get(i).and_then(|row| row.get(j)).copied();
    let told = dofs.entries().filter_map(|place| {
        let [i, j] = place;
        let value = at(entries, place)?;
        let spread = deviation
            .and_then(|deviation| at(deviation, place))
            .filter(|own| *own > 0.0);
        if value == 0.0 && i != j && spread.is_none() {
            return None;
        }
        let spread = spread.map_or_else(String::new, |own| format!(" ± {}", short(own, DIGITS.1)));
        Some(format!(
            "{}_{}{} = {}{spread} {}",
            parameter.symbol,
            dofs.row(i).name,
            dofs.row(j).name,
            short(value, DIGITS.0),
            dofs.unit(parameter.unit, place)
        ))
    });
    told.collect()
}

fn terms(file: &JointFile) -> Vec<String> {
    let all = Term::ALL.into_iter();
    all.flat_map(|of| term(file, of, file.joint.term(of)))
        .collect()
}

/// A term of each DOF, where it is not zero.
fn term(file: &JointFile, term: Term, values: &[f64]) -> Vec<String> {
    let row = term.row();
    let list = values.iter().zip(file.joint.dofs.rows());
    list.filter(|(value, _)| **value != 0.0)
        .map(|(value, dof)| {
            format!(
                "{}_{} = {} {}",
                row.symbol,
                dof.name,
                short(*value, DIGITS.0),
                unit(row.unit, dof.kind, dof.kind)
            )
        })
        .collect()
}

/// A line for each law, with the deviations of its numbers where they are known.
fn friction(laws: &[Friction], deviations: &[Friction]) -> Vec<String> {
    let laws = laws.iter().enumerate().map(|(place, own)| {
        let values = own
            .law
            .parameters
            .iter()
            .zip(&own.parameters)
            .map(|(parameter, value)| {
                let unit = match unit(parameter.unit, own.dof.kind, own.dof.kind) {
                    one if one == "1" => String::new(),
                    unit => format!(" {unit}"),
                };
                let spread = deviations.get(place).and_then(|own| own.value(parameter));
                let spread = spread.filter(|own| *own > 0.0);
                let spread =
                    spread.map_or_else(String::new, |own| format!(" ± {}", short(own, DIGITS.1)));
                format!(
                    "{} {}{spread}{unit}",
                    parameter.key,
                    short(*value, DIGITS.0)
                )
            });
        format!(
            "{} on {}: {}",
            own.law.name,
            own.dof.name,
            values.collect::<Vec<_>>().join(", ")
        )
    });
    laws.collect()
}

fn over_preload(file: &JointFile, table: &OverPreload) -> Vec<String> {
    let mut told = vec![format!("nominal {} N·m", short(table.nominal, 4))];
    let known = file
        .uncertainty
        .as_ref()
        .and_then(|own| own.over_preload.as_ref());
    let deviations = |place: usize| {
        let own = known.and_then(|own| own.at.get(place));
        own.map_or(&[][..], |own| own.standard_deviation.friction.as_slice())
    };
    for (place, preload) in table.preload.iter().enumerate() {
        let of = |all: &[Vec<Vec<f64>>], parameter| {
            all.get(place)
                .map(|own| matrix(file, own, None, parameter))
                .unwrap_or_default()
        };
        let cubic = table.cubic.get(place).map_or(&[][..], Vec::as_slice);
        let laws = table.friction.get(place).map_or(&[][..], Vec::as_slice);
        let entries = [
            of(&table.stiffness, STIFFNESS),
            of(&table.damping, DAMPING),
            term(file, Term::CUBIC, cubic),
            friction(laws, deviations(place)),
        ]
        .concat();
        told.push(format!(
            "{} N·m: {}",
            short(*preload, 4),
            entries.join(", ")
        ));
    }
    told
}

fn pictures(file: &JointFile) -> Vec<ShownPicture> {
    let mut all = Vec::new();
    let nominal;
    let mut drawn = file;
    if let Some(table) = &file.joint.over_preload {
        all.extend(over_preload_curves(file, table));
        if let Ok(at) = file.at_preload(Some(table.nominal)) {
            nominal = at;
            drawn = &nominal;
        }
    }
    let curves = joint_curves(drawn).into_iter();
    all.extend(curves.map(|(figure, caption)| ShownPicture::Curves(figure, caption)));
    all.extend(with_dofs!(drawn.joint.dofs.size(), D => loops::<D>(drawn)));
    all
}

fn words(kind: DofKind) -> (&'static str, &'static str) {
    match kind {
        DofKind::Translation => ("relative displacement, µm", "force, N"),
        DofKind::Rotation => ("relative rotation, µrad", "moment, N·m"),
    }
}

/// A closed loop of each DOF with a law that remembers, at the amplitude that loses the largest part of what it stores.
fn loops<const D: usize>(file: &JointFile) -> Vec<ShownPicture> {
    let Ok(law) = file.joint.law::<D>() else {
        return Vec::new();
    };
    let dofs = file.joint.dofs.rows().enumerate();
    let remembers = dofs.filter(|(_, dof)| {
        let mut own = file.joint.friction.iter();
        own.any(|own| own.dof.name == dof.name && own.law.remembers())
    });
    let drawn = remembers.filter_map(|(place, dof)| {
        let at = |amplitude: f64| {
            HysteresisLoop { dof: place, amplitude, omega_rad_per_s: None }.points(&law)
        };
        let (count, low, high) = AMPLITUDES;
        let amplitudes = (0..count).map(|k| low * (high / low).powf(k as f64 / (count - 1) as f64));
        let found = amplitudes
            .map(|amplitude| (amplitude, at(amplitude)))
            .filter_map(|(amplitude, points)| {
                let heat = points.last()?.heat_j;
                let stored = points.first()?.load.abs() * amplitude;
                let loss = heat / stored;
                loss.is_finite().then_some((loss, amplitude, points))
            })
            .max_by(|one, other| one.0.total_cmp(&other.0));
        let (_, amplitude, points) = found.filter(|own| own.0 > 0.0)?;
        let (across, up) = words(dof.kind);
        let heat = points.last()?.heat_j;
        let figure = LineFigure {
            title: "Load of the joint over a cycle of its relative motion",
            across: (across, Scale::Roomy),
            up: (up, Scale::Roomy),
            lines: vec![Line::curve(dof.name, points.iter().map(|own| (1e6 * own.displacement, own.load)))],
        };
        let caption = format!(
            "Load over a slow cycle of <i>{}</i> of amplitude {}, where the largest part is lost: {} J a cycle.",
            escaped(dof.symbol),
            bolted_joint_figures::html::quantity(1e6 * amplitude, if dof.kind == DofKind::Translation { "µm" } else { "µrad" }),
            bolted_joint_figures::html::number(heat),
        );
        Some(ShownPicture::Curves(figure, caption))
    });
    drawn.collect()
}

/// K and C on the diagonal over the preload.
fn over_preload_curves(file: &JointFile, table: &OverPreload) -> Vec<ShownPicture> {
    let dofs = file.joint.dofs.rows().enumerate();
    let drawn = dofs.flat_map(|(place, dof)| {
        let line = |matrices: &[Vec<Vec<f64>>]| {
            let values = matrices
                .iter()
                .filter_map(|own| own.get(place)?.get(place).copied());
            table
                .preload
                .iter()
                .copied()
                .zip(values)
                .collect::<Vec<_>>()
        };
        let figure = |up: &'static str, title, points| {
            let figure = LineFigure {
                title,
                across: ("preload, N·m", Scale::Linear),
                up: (up, Scale::Linear),
                lines: vec![Line::curve("as in the file", points)],
            };
            ShownPicture::Curves(figure, format!("{title}, <i>{}</i>.", escaped(dof.symbol)))
        };
        let (k, c) = match dof.kind {
            DofKind::Translation => ("stiffness, N/m", "damping, N·s/m"),
            DofKind::Rotation => ("stiffness, N·m/rad", "damping, N·m·s/rad"),
        };
        [
            figure(k, "Stiffness over the preload", line(&table.stiffness)),
            figure(c, "Damping over the preload", line(&table.damping)),
        ]
    });
    drawn.collect()
}
