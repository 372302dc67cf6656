//! What was measured, what was computed, and what the identification takes for granted.

use std::path::Path;

use super::{Assembly, IdentificationReport, beside, counted, files};
use bolted_joint_figures::html::{cell, escaped, number, percent, shown, table};
use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{Beam, Boundary, Damping, Theory};
use bolted_joint_identify::{
    Bolts, FrfFile, JointModel, Level, Lines, NoiseLevel, Receptances, Rotation, Source,
    StatedFloor, Substructure,
};
use bolted_joint_study::LineChoice;

pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let study = report.study;
    let mut rows = vec![
        row("Study", &format!("<code>{}</code>", file_name(&study.path))),
        row("Joint model", &joint(study.model, &study.bolts)),
        row("Substructure A", &substructure(&study.a, &study.bolts)),
        row("Substructure B", &substructure(&study.b, &study.bolts)),
    ];
    let assemblies = report.assemblies();
    let further = study.further.iter();
    let further = further.map(|own| (&own.file, own.repeats.len(), own.torque_n_m, own.level));
    let repeats = study.repeats.len();
    let first = (&study.assembly, repeats, study.torque_n_m, study.level);
    let sources = std::iter::once(first);
    for (number, (source, measured)) in sources.chain(further).zip(&assemblies).enumerate() {
        let name = match assemblies.len() {
            1 => "Assembly".to_owned(),
            _ => format!("Assembly {}", number + 1),
        };
        rows.push(row(&name, &assembly(source, measured)));
    }
    for (number, further) in study.further.iter().enumerate() {
        for (name, own, common) in [("A", &further.a, &study.a), ("B", &further.b, &study.b)] {
            let [own, common] = [own, common].map(|of| substructure(of, &study.bolts));
            if own != common {
                let name = format!("Substructure {name} of assembly {}", number + 2);
                rows.push(row(&name, &own));
            }
        }
    }
    for found in &report.found.from_modes {
        let name = format!(
            "From modes, substructure {}",
            found.substructure.to_uppercase()
        );
        rows.push(row(&name, &beside::from_modes(found)));
    }
    if let Some(start) = &study.start {
        let name = "Presumed joint, a start of the search";
        rows.push(row(name, &beside::start(start)));
    }
    let every = match study.lines.every {
        1 => String::new(),
        every => format!(", one line of {every}"),
    };
    let bands = study.lines.bands_hz.iter();
    let bands = bands.map(|band| {
        let [from, to] = band.map(number);
        format!("{from} to {to} Hz")
    });
    let range = match bands.collect::<Vec<_>>() {
        bands if bands.is_empty() => stated_range(&study.lines),
        bands => bands.join(", "),
    };
    rows.push(row("Frequency range", &format!("{range}{every}")));
    rows.push(row("Bands of the average", &beside::bands(report)));
    rows.push(row("Noise", &noise(report)));
    for note in &study.notes {
        rows.push(row("Note", &escaped(note)));
    }
    format!(
        "<h2>What was measured and assumed</h2>\n{}{}{}",
        table(&[], &rows).replace("<thead><tr></tr></thead>\n", ""),
        files::section(report),
        assumptions(report)
    )
}

/// The range that a study states.
fn stated_range(lines: &LineChoice) -> String {
    match lines.stated_range_hz().map(|end| end.map(number)) {
        [Some(from), Some(to)] => format!("{from} to {to} Hz"),
        [Some(from), None] => format!("from {from} Hz"),
        [None, Some(to)] => format!("to {to} Hz"),
        [None, None] => "all that was measured".to_owned(),
    }
}

fn row(name: &str, html: &str) -> String {
    format!("<th scope=\"row\">{name}</th>{}", cell(html))
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    escaped(&name.to_string_lossy())
}

fn model(model: JointModel) -> &'static str {
    match model {
        JointModel::Translation => "1, translation: <i>k</i><sub>yy</sub>, <i>c</i><sub>yy</sub>",
        JointModel::Diagonal => {
            "2, diagonal: translation and rotation without coupling between them"
        }
        JointModel::Full => "3, full: translation, rotation and the coupling between them",
    }
}

fn joint(joint_model: JointModel, bolts: &Bolts) -> String {
    let names: Vec<String> = bolts.names().iter().map(|name| escaped(name)).collect();
    let names = names.join(", ");
    let model = model(joint_model);
    match bolts {
        Bolts::One => model.to_owned(),
        Bolts::Alike(_) => format!("{model}; the same joint at the bolts {names}"),
        Bolts::Different(_) => format!("{model}; a joint of its own at each of the bolts {names}"),
    }
}

fn dofs(dofs: &[Dof]) -> String {
    let names: Vec<String> = dofs.iter().map(|dof| escaped(&dof.to_string())).collect();
    names.join(", ")
}

/// The places of the joint, with the names of the bolts where there are several.
fn at_bolts(places: Vec<String>, bolts: &Bolts) -> String {
    let mut named = bolts.names().iter();
    let places = places.into_iter().map(|place| match named.next() {
        Some(name) => format!("{} {place}", escaped(name)),
        None => place,
    });
    format!("joint {}", places.collect::<Vec<_>>().join("; "))
}

fn substructure(substructure: &Substructure, bolts: &Bolts) -> String {
    match substructure {
        Substructure::Ground { .. } => "ground: it does not move".to_owned(),
        Substructure::Measured { source, joints, .. } => {
            let origin = match source {
                Source::Frf { file, modes } => {
                    let modes = modes.as_deref().map(file_name).map(|name| {
                        format!(", those not measured from the modes in <code>{name}</code>")
                    });
                    let files = file_names(file);
                    format!("FRFs in {files}{}", modes.unwrap_or_default())
                }
                Source::Modal(path) => {
                    format!("FRFs from the modes in <code>{}</code>", file_name(path))
                }
            };
            let rotation = |theta: &Option<Rotation>| match theta {
                None => String::new(),
                Some(Rotation::Measured(theta)) => {
                    format!(", <i>θ</i> measured as {}", escaped(&theta.to_string()))
                }
                Some(rotation) => format!(", <i>θ</i> by {}", difference(rotation)),
            };
            let places = joints.iter().map(|joint| {
                let y = escaped(&joint.y.to_string());
                format!("<i>y</i> at {y}{}", rotation(&joint.theta))
            });
            format!("measured: {origin}; {}", at_bolts(places.collect(), bolts))
        }
        Substructure::Beam {
            beam,
            joints_m,
            positions_m,
            ..
        } => {
            let points: Vec<String> = positions_m
                .iter()
                .map(|(dof, position_m)| {
                    format!("{} at {} m", escaped(&dof.to_string()), number(*position_m))
                })
                .collect();
            let places = joints_m.iter().map(|x_m| format!("at {} m", number(*x_m)));
            format!(
                "computed: {}; {}{}",
                self::beam(beam),
                at_bolts(places.collect(), bolts),
                match points.as_slice() {
                    [] => String::new(),
                    points => format!(", points {}", points.join(", ")),
                }
            )
        }
    }
}

fn difference(rotation: &Rotation) -> String {
    match rotation {
        Rotation::Measured(theta) => escaped(&theta.to_string()),
        Rotation::Difference { points, difference } => {
            format!("{difference}: {}", dofs(points))
        }
    }
}

fn beam(beam: &Beam) -> String {
    let boundary = match beam.boundary {
        Boundary::FreeFree => "free at both ends",
        Boundary::FixedFree => "fixed at 0, free at the other end",
        Boundary::FreeFixed => "free at 0, fixed at the other end",
        Boundary::FixedFixed => "fixed at both ends",
        Boundary::PinnedPinned => "pinned at both ends",
        Boundary::FixedPinned => "fixed at 0, pinned at the other end",
    };
    let theory = match beam.theory {
        Theory::EulerBernoulli => "by Euler–Bernoulli theory".to_owned(),
        Theory::Timoshenko { poissons_ratio } => format!(
            "by Timoshenko theory with <i>ν</i> = {}",
            number(poissons_ratio)
        ),
    };
    let damping = match &beam.damping {
        Damping::Ratios(ratios) => {
            let ratios: Vec<String> = ratios.iter().map(|ratio| number(*ratio)).collect();
            format!("damping ratios {}", ratios.join(", "))
        }
        Damping::LossFactor(loss) => format!("loss factor {}", number(*loss)),
    };
    format!(
        "uniform beam {} × {} × {} m, <i>E</i> = {} Pa, <i>ρ</i> = {} kg/m³, {theory}, {boundary}, {damping}",
        number(beam.length_m),
        number(beam.width_m),
        number(beam.height_m),
        number(beam.youngs_modulus_pa),
        number(beam.density_kg_per_m3)
    )
}

/// Names of the files of one measurement.
fn file_names(file: &FrfFile) -> String {
    let names = file.files();
    let names = names.map(|path| format!("<code>{}</code>", file_name(path)));
    names.collect::<Vec<_>>().join(", ")
}

fn assembly(
    (file, repeats, torque_n_m, level): (&FrfFile, usize, Option<f64>, Option<Level>),
    measured: &Assembly<'_>,
) -> String {
    let frequency_hz = &measured.lines.frequency_hz;
    let independent = measured.lines.independent().len();
    let copies = match measured.fits.len() - independent {
        0 => String::new(),
        copies => format!(
            " ({} of them copied from the transpose)",
            counted(copies, "entry").replace("entrys", "entries")
        ),
    };
    let mut html = format!(
        "{}; points {}; {}{copies}, {}",
        file_names(file),
        dofs(&measured.lines.points),
        counted(measured.fits.len(), "function"),
        counted(frequency_hz.len(), "line")
    );
    if let (Some(first), Some(last)) = (frequency_hz.first(), frequency_hz.last()) {
        html += &format!(" from {} to {} Hz", number(*first), number(*last));
        let spacing = (last - first) / (frequency_hz.len().max(2) - 1) as f64;
        let pairs = frequency_hz.windows(2);
        let even = pairs.fold(0.0, |most, pair| {
            f64::max(most, (pair[1] - pair[0] - spacing).abs())
        });
        if even < 1e-3 * spacing {
            html += &format!(", {} Hz apart", shown(spacing, 4));
        }
    }
    if repeats > 0 {
        html += &format!("; mean of {}", counted(repeats + 1, "measurement"));
    }
    if let Some(torque) = torque_n_m {
        html += &format!("; tightened to {} N·m", number(torque));
    }
    if let Some(level) = level {
        html += &format!("; {}", escaped(&level.to_string()));
    }
    html
}

fn noise(report: &IdentificationReport<'_>) -> String {
    let found = report.found;
    let noise = &report.study.noise;
    let level = |level: NoiseLevel| {
        let mut parts = Vec::new();
        if level.relative > 0.0 || level.floor == 0.0 {
            parts.push(format!("{} of the receptance", percent(level.relative)));
        }
        if level.floor > 0.0 {
            parts.push(format!(
                "{} m/N everywhere (r.m.s. over functions)",
                shown(level.floor, 3)
            ));
        }
        parts.join(" and ")
    };
    let assemblies = report.assemblies();
    let all = |has: fn(&Lines) -> bool| assemblies.iter().all(|assembly| has(assembly.lines));
    let origin = if noise.is_stated() {
        "stated"
    } else if all(|lines| lines.repeats.is_some()) {
        "from the scatter of the repeats and the residual"
    } else {
        "estimated from the residual"
    };
    let mut sentences = Vec::new();
    if all(|lines| lines.relative_variance.is_some()) {
        sentences.push(
            "of the assembly: from coherence, line by line, <i>σ</i>²/|<i>H</i>|² = (1 − <i>γ</i>²)/(<i>n</i> <i>γ</i>²)".to_owned(),
        );
    } else {
        match found.estimate.noise_level {
            Some(found) => sentences.push(format!("of the assembly: {}, {origin}", level(found))),
            None => sentences.push("unknown: as many unknowns as measured values".to_owned()),
        }
        let coherent: Vec<String> = (1..)
            .zip(&assemblies)
            .filter(|(_, assembly)| assembly.lines.relative_variance.is_some())
            .map(|(number, _)| number.to_string())
            .collect();
        if !coherent.is_empty() {
            let numbers = coherent.join(", ");
            sentences.push(format!(
                "but of assembly {numbers} from coherence, line by line"
            ));
        }
    }
    let measured = |of: &Receptances| {
        let measured = of.measured();
        measured.map(|measured| measured.relative_variance().is_some())
    };
    for (name, measured, stated) in [
        ("A", measured(&found.lines.a), noise.a),
        ("B", measured(&found.lines.b), noise.b),
    ] {
        let words = match (measured, (stated.relative, stated.floor)) {
            (None, _) => "taken as exact".to_owned(),
            (Some(_), (Some(0.0), StatedFloor { yy: Some(0.0), .. })) => {
                "stated to be exact".to_owned()
            }
            (Some(true), _) => "from coherence, line by line".to_owned(),
            (Some(false), (None, StatedFloor { yy: None, .. })) => "as the assembly's".to_owned(),
            (Some(false), (relative, floor)) => {
                let part = |value: Option<f64>, unit: &str| match value {
                    Some(value) => format!("{}{unit}", shown(value, 3)),
                    None => "as the assembly's".to_owned(),
                };
                format!(
                    "stated: fraction of the receptance {}, floor {}",
                    part(relative, ""),
                    part(floor.yy, " m/N")
                )
            }
        };
        sentences.push(format!("of {name}: {words}"));
    }
    sentences.join("; ")
}

fn assumptions(report: &IdentificationReport<'_>) -> String {
    let study = report.study;
    let mass = match report.found.systematic {
        Some(_) => "no mass beyond the error budget",
        None => "no mass",
    };
    let mut list = vec![
        format!(
            "The joint is linear and has {mass}; its matrices are symmetric and do not depend on frequency or amplitude."
        ),
        "Both substructures are linear and reciprocal, and the same coupled as uncoupled.".to_owned(),
        "Errors of measured functions are independent from line to line and from function to function, and circular in the \
         complex plane. Standard deviations are those of the complex error."
            .to_owned(),
    ];
    for (name, substructure) in [("A", &study.a), ("B", &study.b)] {
        match substructure {
            Substructure::Ground { .. } => list.push(format!("{name} is the ground: it does not move at the joint.")),
            Substructure::Beam { .. } if report.found.systematic.is_some() => list.push(format!(
                "Substructure {name} is computed: errors of its material and positions are in the intervals, within the error \
                 budget; those of beam theory are not."
            )),
            Substructure::Beam { .. } => list.push(format!(
                "Substructure {name} is computed: errors of its model are not in the intervals."
            )),
            Substructure::Measured {
                source: Source::Modal(_),
                ..
            } => list.push(format!(
                "Substructure {name} comes from modes: their errors are not in the intervals."
            )),
            Substructure::Measured {
                source: Source::Frf { modes: Some(_), .. },
                ..
            } => list.push(format!(
                "Functions of substructure {name} that come from modes are taken as exact: their errors are not in the intervals."
            )),
            Substructure::Measured {
                source: Source::Frf { modes: None, .. },
                ..
            } => {}
        }
        let Substructure::Measured {
            joints, section, ..
        } = substructure
        else {
            continue;
        };
        let rotations = joints.iter().filter_map(|joint| joint.theta.as_ref());
        for rotation in rotations.filter(|r| matches!(r, Rotation::Difference { .. })) {
            let error = match section {
                Some(_) => "what the difference loses is added from the cross-section",
                None => "the error of that difference is not in the intervals",
            };
            list.push(format!(
                "Rotations of {name} follow from translations by {}; {error}.",
                difference(rotation)
            ));
        }
    }
    let items: String = list
        .iter()
        .map(|item| format!("<li>{item}</li>\n"))
        .collect();
    format!("<h3>Assumed</h3>\n<ul>\n{items}</ul>\n")
}
