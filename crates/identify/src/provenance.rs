//! Where a joint comes from: the files it was identified from, by their hashes.

use std::fs::File;
use std::io::{self, ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use bolted_joint_files::text_file::TextFileError;
use bolted_joint_joint::{
    BandOriginRecord, BandRecord, BandsRecord, FromModesRecord, InputFile, Provenance,
};

use super::bands::{BandOrigin, UsedBands};
use super::error::IdentifyError;
use super::from_modes::FromModes;
use super::lines_estimate::LinesEstimate;
use super::study::{Source, Study, Substructure};
use super::watch::Watch;

/// Bytes of a file that are read at a time.
const PIECE: usize = 1 << 16;

/// Provenance of each bolt's joint that is identified from this study.
pub(super) fn of(
    study: &Study,
    estimate: &LinesEstimate,
    from_modes: &[FromModes],
    watch: &dyn Watch,
) -> Result<Vec<Provenance>, IdentifyError> {
    let folder = study.path.parent().unwrap_or(Path::new(""));
    let file_of = |substructure: &Substructure| match substructure {
        Substructure::Measured { source, .. } => Some(match source {
            Source::Frf { file, .. } => file.path.clone(),
            Source::Modal(path) => path.clone(),
        }),
        Substructure::Beam { .. } => None,
    };
    let modes_of = |substructure: &Substructure| match substructure {
        Substructure::Measured {
            source: Source::Frf { modes, .. },
            ..
        } => modes.clone(),
        Substructure::Measured { .. } | Substructure::Beam { .. } => None,
    };
    let mut named = vec![
        ("study", Some(study.path.clone())),
        ("substructure a", file_of(&study.a)),
        ("substructure a, modes", modes_of(&study.a)),
        ("substructure b", file_of(&study.b)),
        ("substructure b, modes", modes_of(&study.b)),
        ("assembly", Some(study.assembly.path.clone())),
    ];
    for further in &study.further {
        let its_own = |role, path: Option<PathBuf>, named: &[(&str, Option<PathBuf>)]| {
            let known = named.contains(&(role, path.clone()));
            (!known).then_some((role, path))
        };
        for (role, path) in [
            ("substructure a", file_of(&further.a)),
            ("substructure a, modes", modes_of(&further.a)),
            ("substructure b", file_of(&further.b)),
            ("substructure b, modes", modes_of(&further.b)),
            ("assembly", Some(further.file.path.clone())),
        ] {
            let entry = its_own(role, path, &named);
            named.extend(entry);
        }
    }
    let repeats = study.further.iter().flat_map(|further| &further.repeats);
    let repeats = study.repeats.iter().chain(repeats);
    named.extend(repeats.map(|file| ("assembly, repeated", Some(file.path.clone()))));
    let inputs = named
        .into_iter()
        .filter_map(|(role, path)| Some((role, path?)))
        .map(|(role, path)| input_file(role, &path, folder, watch))
        .collect::<Result<Vec<_>, _>>()?;
    let of_joint = |(joint, bands): (usize, &Vec<UsedBands>)| Provenance {
        tool: bolted_joint_files::TOOL.to_owned(),
        version: bolted_joint_files::VERSION.to_owned(),
        method: "frf-decoupling".to_owned(),
        model: study.model.to_string(),
        inputs: inputs.clone(),
        bolts: match study.bolts.with_own_joint().get(joint) {
            Some(bolt) => vec![bolt.clone()],
            None => study.bolts.names().to_vec(),
        },
        bands: estimate.band_average().map(|_| record(bands)),
        from_modes: from_modes
            .iter()
            .map(|found| of_modes(found, folder))
            .collect(),
        notes: study.notes.clone(),
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

/// A path as the study gives it.
fn name_in(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder)
        .unwrap_or(path)
        .display()
        .to_string()
}

/// An input of `role`: its path as seen from `folder`, and its hash.
///
/// # Errors
/// [`IdentifyError::File`] if it cannot be read.
pub fn input_file(
    role: &str,
    path: &Path,
    folder: &Path,
    watch: &dyn Watch,
) -> Result<InputFile, IdentifyError> {
    let digest = digest(path, watch).map_err(|source| TextFileError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    Ok(InputFile {
        role: role.to_owned(),
        file: name_in(folder, path),
        sha256: digest
            .as_ref()
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect(),
    })
}

/// SHA-256 of a file, which may be larger than the memory.
fn digest(path: &Path, watch: &dyn Watch) -> io::Result<impl AsRef<[u8]> + use<>> {
    let mut file = File::open(path)?;
    let of = file.metadata()?.len();
    let mut digest = Sha256::new();
    let mut piece = vec![0; PIECE];
    let mut read = 0;
    loop {
        let count = match file.read(&mut piece) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        digest.update(&piece[..count]);
        read += count as u64;
        watch.read(path, read.min(of), of);
    }
    watch.read(path, of, of);
    Ok(digest.finalize())
}
