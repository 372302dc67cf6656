//! An assembly: its structures and joints, what goes in and comes out, and its modes.

use bolted_joint_assembly::{AssemblyModel, Channel};
use bolted_joint_frf::receptance_unit;
use bolted_joint_report::{DrawnFunction, FunctionGroup, ShownPicture};
use bolted_joint_study::StudyText;
use serde_json::json;

use crate::kind::{FileKind, command_for};
use crate::shown::{counted, short, some};
use crate::{ShowError, Shown};

/// Points and modes that are listed at most.
const LISTED: usize = 12;
/// Lines of a drawn function.
const LINES: usize = 1000;
/// Modes that are drawn at most.
const DRAWN_MODES: usize = 10;

pub(crate) fn shown(text: &StudyText) -> Result<Shown, ShowError> {
    let model = AssemblyModel::of(text)?;
    let mut shown = Shown::of("assembly of structures and joints");
    shown.fact("name", &model.name);
    let structures = model.structures.iter().map(|own| {
        let form = &own.form;
        format!(
            "{}: {}, {} as a free body; points {}",
            own.name,
            counted(form.modes, "mode"),
            match form.rigid() {
                0 => "none".to_owned(),
                rigid => format!("{rigid} of them"),
            },
            some(&form.points, LISTED)
        )
    });
    shown.facts_of("structures", structures);
    let joints = model.joints.iter().map(|own| {
        let [a, b] = [0, 1].map(|side: usize| {
            let places = own.places[side].iter().map(|place| {
                let structure = model.structures.get(place.structure);
                format!(
                    "{}/{}",
                    structure.map_or("", |own| own.name.as_str()),
                    place.dof
                )
            });
            places.collect::<Vec<_>>().join(" ")
        });
        format!("{}: {}, between {a} and {b}", own.name, own.file.name)
    });
    shown.facts_of("joints", joints);
    let places = |channels: &[Channel]| -> Vec<String> {
        let told = channels.iter().map(|own| {
            let structure = model.structures.get(own.place.structure);
            let structure = structure.map_or("", |own| own.name.as_str());
            format!("{}: {structure}/{}", own.name, own.place.dof)
        });
        told.collect()
    };
    shown.facts_of("inputs", places(&model.inputs));
    shown.facts_of("outputs", places(&model.outputs));
    shown.fact(
        "response",
        match model.response {
            Some(_) => "stated, so `respond` can compute it",
            None => "not stated: add [response] for `respond`",
        },
    );
    let modes = model.modes()?;
    let told: Vec<String> = modes
        .iter()
        .take(LISTED)
        .map(|mode| {
            format!(
                "{} Hz, damping ratio {}",
                short(mode.frequency_hz, 5),
                short(mode.damping_ratio, 2)
            )
        })
        .collect();
    shown.facts_of(
        "modes",
        told.into_iter().chain(["all of small motion".to_owned()]),
    );
    for joint in &model.joints {
        let against = joint.file.reasons_against().iter();
        shown
            .reasons_against
            .extend(against.map(|reason| format!("{}: {reason}", joint.name)));
    }
    shown.warnings.clone_from(&model.warnings);
    for joint in &model.joints {
        let passivity = joint.file.passivity();
        let active = passivity.active();
        let told = active.map(|matrix| format!("joint {}: {}", joint.name, matrix.finding()));
        shown.warnings.extend(told);
    }
    shown.facts_of("notes", model.notes.iter().cloned());
    shown.detail("name", model.name.clone());
    shown.detail(
        "structures",
        model
            .structures
            .iter()
            .map(|own| own.name.clone())
            .collect::<Vec<_>>(),
    );
    shown.detail(
        "joints",
        model
            .joints
            .iter()
            .map(|own| own.name.clone())
            .collect::<Vec<_>>(),
    );
    shown.detail(
        "modes",
        json!(modes.iter().map(|mode| json!({ "frequency_hz": mode.frequency_hz, "damping_ratio": mode.damping_ratio })).collect::<Vec<_>>()),
    );
    let natural: Vec<f64> = modes
        .iter()
        .map(|mode| mode.frequency_hz)
        .filter(|hz| *hz > 1e-3)
        .collect();
    shown.pictures = pictures(&model, &natural);
    shown.next = command_for(FileKind::Assembly, text.path());
    Ok(shown)
}

/// Receptances of the outputs for each input, over the first modes; none where an undamped resonance is met.
fn pictures(model: &AssemblyModel, natural_hz: &[f64]) -> Vec<ShownPicture> {
    let shown = &natural_hz[..natural_hz.len().min(DRAWN_MODES)];
    let (Some(low), Some(high)) = (shown.first(), shown.last()) else {
        return Vec::new();
    };
    let (from, to) = (0.5 * low, 1.25 * high);
    let frequency_hz: Vec<f64> = (0..LINES)
        .map(|line| from + (to - from) * line as f64 / (LINES - 1) as f64)
        .collect();
    let Ok(lines) = model.receptances(&frequency_hz) else {
        return Vec::new();
    };
    let mut pictures: Vec<ShownPicture> = Vec::new();
    for (column, input) in model.inputs.iter().enumerate() {
        let mut groups: Vec<FunctionGroup> = Vec::new();
        for (row, output) in model.outputs.iter().enumerate() {
            let unit = receptance_unit(output.place.dof, input.place.dof);
            let drawn = DrawnFunction {
                label: output.name.clone(),
                values: lines.iter().map(|matrix| matrix[(row, column)]).collect(),
                coherence: None,
            };
            match groups.iter_mut().find(|group| group.unit == unit) {
                Some(group) => group.functions.push(drawn),
                None => groups.push(FunctionGroup {
                    title: format!("Computed, load on {}", input.name),
                    unit,
                    frequency_hz: frequency_hz.clone(),
                    functions: vec![drawn],
                }),
            }
        }
        pictures.extend(groups.into_iter().map(ShownPicture::Functions));
    }
    pictures
}
