//! Where a joint comes from: the files it was identified from, by their hashes.

use std::path::{Path, PathBuf};

use bolted_joint_joint::{BandOriginRecord, BandRecord, BandsRecord, FromModesRecord, Provenance};
use bolted_joint_study::{Method, input_file, name_in, provenance};

use super::bands::{BandOrigin, UsedBands};
use super::error::IdentifyError;
use super::from_modes::FromModes;
use super::lines_estimate::LinesEstimate;
use super::study::{FrfFile, Source, Study, Substructure};
use super::watch::Watch;

/// Provenance of each bolt's joint that is identified from this study.
pub(super) fn of(
    study: &Study,
    estimate: &LinesEstimate,
    from_modes: &[FromModes],
    watch: &dyn Watch,
) -> Result<Vec<Provenance>, IdentifyError> {
    let folder = study.path.parent().unwrap_or(Path::new(""));
    let files_of = |substructure: &Substructure| match substructure {
        Substructure::Measured { source, .. } => match source {
            Source::Frf { file, .. } => file.files().cloned().collect(),
            Source::Modal(path) => vec![path.clone()],
        },
        Substructure::Beam { .. } | Substructure::Ground { .. } => Vec::new(),
    };
    let modes_of = |substructure: &Substructure| match substructure {
        Substructure::Measured {
            source: Source::Frf { modes, .. },
            ..
        } => modes.iter().cloned().collect(),
        _ => Vec::new(),
    };
    let of_assembly = |a: &Substructure, b: &Substructure, file: &FrfFile| {
        [
            ("substructure a", files_of(a)),
            ("substructure a, modes", modes_of(a)),
            ("substructure b", files_of(b)),
            ("substructure b, modes", modes_of(b)),
            ("assembly", file.files().cloned().collect()),
        ]
    };
    let further = study.further.iter();
    let further = further.map(|own| of_assembly(&own.a, &own.b, &own.file));
    let first = of_assembly(&study.a, &study.b, &study.assembly);
    let mut named = vec![("study", study.path.clone())];
    for (role, path) in std::iter::once(first).chain(further).flatten().flat_map(
        |(role, paths): (&str, Vec<PathBuf>)| paths.into_iter().map(move |path| (role, path)),
    ) {
        if !named.contains(&(role, path.clone())) {
            named.push((role, path));
        }
    }
    let repeats = study.further.iter().flat_map(|further| &further.repeats);
    let repeats = study.repeats.iter().chain(repeats).flat_map(FrfFile::files);
    named.extend(repeats.map(|path| ("assembly, repeated", path.clone())));
    let inputs = named
        .into_iter()
        .map(|(role, path)| input_file(role, &path, folder, |read, of| watch.read(&path, read, of)))
        .collect::<Result<Vec<_>, _>>()?;
    let method = Method::FrfDecoupling;
    let model = study.model.to_string();
    let common = provenance(method, model, inputs, study.notes.clone());
    let of_joint = |(joint, bands): (usize, &Vec<UsedBands>)| Provenance {
        bolts: match study.bolts.with_own_joint().get(joint) {
            Some(bolt) => vec![bolt.clone()],
            None => study.bolts.names().to_vec(),
        },
        bands: estimate.band_average().map(|_| record(bands)),
        from_modes: from_modes
            .iter()
            .map(|found| of_modes(found, folder))
            .collect(),
        ..common.clone()
    };
    Ok(estimate.bands().iter().enumerate().map(of_joint).collect())
}

fn record(bands: &[UsedBands]) -> BandsRecord {
    let of = |name: &str| {
        let used = bands.iter().find(|used| used.name == name)?;
        Some(BandRecord {
            origin: match used.origin {
                BandOrigin::Given => BandOriginRecord::Study,
                BandOrigin::Automatic => BandOriginRecord::Automatic,
                BandOrigin::NoneQualifies | BandOrigin::Median => BandOriginRecord::Median,
            },
            frequency_hz: used.bands.clone(),
        })
    };
    BandsRecord {
        yy: of("yy"),
        ytheta: of("ytheta"),
        thetatheta: of("thetatheta"),
    }
}

fn of_modes(found: &FromModes, folder: &Path) -> FromModesRecord {
    let functions = found.functions.iter();
    FromModesRecord {
        substructure: found.substructure.to_owned(),
        file: name_in(folder, &found.path),
        functions: functions
            .map(|(response, reference)| [response.to_string(), reference.to_string()])
            .collect(),
    }
}
