//! From a study to lines: reads the files, computes the beams, forms rotations, and puts all on one frequency axis.

mod axis;
mod beam_anew;
mod belonging;
mod both_sides;
mod known_mass;
mod labelled;
mod measured_lines;
mod mistaken;
mod named_bands;
mod prediction;
mod reader;
mod repeats;
mod soundness;
mod stiffer;
mod substructure;

use std::sync::Arc;

pub use prediction::{predict_assembly, predict_lines};

use super::error::IdentifyError;
use super::from_modes::FromModes;
use super::lines::Lines;
use super::receptances::Receptances;
use super::study::{Study, Substructure};
use super::watch::Watch;
use axis::Axis;
pub(super) use beam_anew::BeamAnew;
use bolted_joint_frf::FileSummary;
pub(super) use known_mass::masses_at;
use labelled::{Completeness, labelled_functions};
use reader::{Reader, in_file};
use repeats::repeated;
pub(super) use substructure::measured_labels;
use substructure::substructures;

/// What the files of a study hold.
pub(super) struct Assembled {
    /// Everything that the study names, line by line for each assembly.
    pub(super) lines: Vec<Lines>,
    /// What each file of functions states.
    pub(super) files: Vec<FileSummary>,
    /// What the user should know about the files.
    pub(super) warnings: Vec<String>,
    /// What makes a result of no use, whatever a fit leaves.
    pub(super) reasons_against: Vec<String>,
    /// What modes supplied beside measured functions.
    pub(super) from_modes: Vec<FromModes>,
}

/// Reads and computes everything that the study names.
pub(super) fn lines(study: &Study, watch: &dyn Watch) -> Result<Assembled, IdentifyError> {
    let mut reader = Reader {
        watch: Some(watch),
        lines: Some(study.lines.clone()),
        ..Reader::default()
    };
    let first = assembly_lines(study, &mut reader);
    let mut all = vec![first.map_err(|error| mistaken::explained(study, error))?];
    for further in &study.further {
        let its_study = Study {
            a: further.a.clone(),
            b: further.b.clone(),
            assembly: further.file.clone(),
            points: further.points.clone(),
            points_on_a: further.points_on_a,
            repeats: further.repeats.clone(),
            further: Vec::new(),
            ..study.clone()
        };
        let mut lines = assembly_lines(&its_study, &mut reader)
            .map_err(|error| mistaken::explained(&its_study, error))?;
        // The same measurement of a substructure has the same errors in every assembly.
        for (earlier, earlier_study) in all.iter().zip(studies_before(study, all.len())) {
            let same_axis = earlier.frequency_hz.len() == lines.frequency_hz.len();
            if same_axis && earlier_study.0.is_same_measurement(&its_study.a) {
                share(&mut lines.a, &earlier.a);
            }
            let same_points = earlier.points == lines.points;
            let same_b = earlier_study.1.is_same_measurement(&its_study.b);
            // with points on A both structures are one
            let same_a = earlier_study.0.is_same_measurement(&its_study.a);
            let is_one = its_study.points_on_a > 0;
            if same_axis && same_points && same_b && (same_a || !is_one) {
                share(&mut lines.b, &earlier.b);
            }
        }
        all.push(lines);
    }
    reader.warnings.extend(named_bands::warnings(study, &all)?);
    reader.warnings.sort();
    reader.warnings.dedup();
    reader.reasons_against.sort();
    reader.reasons_against.dedup();
    let mut from_modes: Vec<FromModes> = Vec::new();
    for one in reader.from_modes {
        if !from_modes.contains(&one) {
            from_modes.push(one);
        }
    }
    Ok(Assembled {
        lines: all,
        files: reader.files,
        warnings: reader.warnings,
        reasons_against: reader.reasons_against,
        from_modes,
    })
}

/// Takes what was measured once from where it is already.
fn share(receptances: &mut Receptances, earlier: &Receptances) {
    if let Receptances::Measured(measured) = earlier {
        *receptances = Receptances::Measured(Arc::clone(measured));
    }
}

/// A and B of the first `count` assemblies.
fn studies_before(study: &Study, count: usize) -> Vec<(&Substructure, &Substructure)> {
    let further = study.further.iter().map(|further| (&further.a, &further.b));
    std::iter::once((&study.a, &study.b))
        .chain(further)
        .take(count)
        .collect()
}

fn assembly_lines(study: &Study, reader: &mut Reader) -> Result<Lines, IdentifyError> {
    let [from_hz, to_hz] = study.frequency_range_hz;
    let path = &study.assembly.path;
    let in_file = |source| in_file(path, source);
    let assembly = reader
        .read(&study.assembly, &study.points, [from_hz, to_hz])?
        .restricted_to(from_hz, to_hz)
        .map_err(in_file)?;
    let axis = Axis {
        path,
        frequency_hz: assembly.frequency_hz(),
    };
    let cut_back = study.lines.cut_back([axis.frequency_hz], path.display());
    reader.warnings.extend(cut_back);
    let points = &study.points;
    let labelled = labelled_functions(&assembly, points, Completeness::Any, &study.assembly)?;
    reader.note(soundness::unsound(&labelled, points, path));
    let mean = repeated(study, labelled, &axis, reader)?;
    let measured = mean.measured;
    // Each function gives two real equations on each line; the joint file's band of validity needs two lines.
    let needed = study
        .layout()
        .unknowns()
        .div_ceil(2 * measured.len())
        .max(2);
    if axis.frequency_hz.len() < needed {
        return Err(IdentifyError::TooFewLines {
            path: path.clone(),
            found: axis.frequency_hz.len(),
            from_hz: axis.first_hz(),
            to_hz: axis.last_hz(),
            needed,
            model: study.model,
            functions: measured.len(),
        });
    }
    let lines = Lines {
        assembly: mean.receptances,
        measured,
        relative_variance: mean.relative_variance,
        repeats: mean.repeats,
        ..substructures(study, &axis, reader)?
    };
    mistaken::refused(study, &lines)?;
    let errors = stiffer::Errors {
        noise: &study.noise,
        budget: &study.budget,
    };
    let foreign = belonging::warnings(&lines, errors, path);
    reader.warnings.extend(foreign);
    Ok(lines)
}
