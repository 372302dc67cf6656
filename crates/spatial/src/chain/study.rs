//! A study of method `frf-space` with any number of parts and joints, whether or not anything was measured yet.

use std::path::PathBuf;

use bolted_joint_frf::{Dof, FrfSet};
use bolted_joint_joint::InputFile;
use bolted_joint_space::Motions;
use bolted_joint_study::{Method, Paths, StudyError, StudyText, input_file};
use nalgebra::Matrix6;

use super::once::every_point_once;
use super::part::{Part, Source, files_of, joined};
use super::plan::candidates::Candidate;
use super::response::Scatter;
use crate::coherence::level_of;
use crate::functions::FileOfFunctions;
use crate::links::{Links, Numbers};
use crate::part_noise::PartNoise;
use crate::problem::{Level, Observed, Problem};
use crate::side::Side;
use crate::study::{Reader, model_name, motions};
use crate::tables::StudyFile;

/// Lines of a measured assembly, at least.
const FEWEST_LINES: usize = 2;

/// A checked study of parts in a chain with joints between them: two parts with one joint, or more.
///
/// A joint is sought or known. What is sought can be planned before an assembly is measured, and what is known answers.
#[derive(Clone, Debug)]
pub struct ChainStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Its name.
    pub name: String,
    /// Name of the model of each joint that is sought.
    pub models: Vec<String>,
    /// Remarks that go into joint files.
    pub notes: Vec<String>,
    /// The files behind the result.
    pub files: Vec<InputFile>,
    /// What is known of the noise.
    pub level: Level,
    /// The same without what coherence tells.
    pub(crate) stated: Level,
    /// Noise of the functions of a and of b.
    pub noise: [PartNoise; 2],
    pub(crate) text: StudyText,
    /// What the interfaces have.
    pub(crate) motions: Motions,
    pub(crate) parts: Vec<Part>,
    pub(crate) problem: Problem,
    /// What was measured of the assembly.
    pub(crate) assembly: Option<FrfSet>,
    /// What had to be assumed of the files.
    pub(crate) assumed: Vec<String>,
    /// What each joint that is sought is taken to be: its table, and K and C where they are stated.
    pub(crate) expected: Vec<(String, Option<[Matrix6<f64>; 2]>)>,
    /// How far each joint scatters, where its file says so number by number.
    pub(crate) scatters: Vec<Option<Scatter>>,
    /// Which DOFs of the assembly will be measured; all if `None`.
    pub(crate) planned: [Option<Vec<Dof>>; 2],
    pub(crate) candidates: Option<Vec<Candidate>>,
}

impl ChainStudy {
    /// A study of an assembly that was measured, from its text, with the files that it names.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn of_measured(study: &StudyText) -> Result<Self, StudyError> {
        let file: StudyFile = study.tables()?;
        study.ensure(
            file.assembly.frf.is_some(),
            "assembly.frf",
            "nothing",
            "functions of the assembly; what a test of it would tell says `bolted-joint respond --plan`, and what an assembly answers \
             whose joints are known `bolted-joint respond`",
        )?;
        let own = Self::of(study, None)?;
        own.ensure_lines()?;
        Ok(own)
    }

    /// A joint is valid between two frequencies.
    fn ensure_lines(&self) -> Result<(), StudyError> {
        let lines = &self.problem.frequency_hz;
        let found = match lines.as_slice() {
            [only_hz] => format!(
                "1 line that all files have, at {} Hz",
                (only_hz * 1e6).round() / 1e6
            ),
            _ => format!("{} lines that all files have", lines.len()),
        };
        self.text.ensure(
            lines.len() >= FEWEST_LINES,
            "frequency",
            found,
            format_args!(
                "at least {FEWEST_LINES} lines; widen `frequency` (from, to, every) or measure with finer lines"
            ),
        )
    }

    /// What had to be assumed of the files or is missing: units that they do not state, phases.
    #[must_use]
    pub fn assumed(&self) -> &[String] {
        &self.assumed
    }

    /// A study from its text, with the files that it names; lines `step_hz` apart where none of these has any.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn of(study: &StudyText, step_hz: Option<f64>) -> Result<Self, StudyError> {
        let file: StudyFile = study.tables()?;
        study.check_method(file.method, &[Method::FrfSpace])?;
        study.check_name("name", &file.name)?;
        let motions = motions(study, file.motions.as_deref())?;
        let reader = Reader { study, motions };
        let tables = [
            ("a", Some(&file.a)),
            ("b", Some(&file.b)),
            ("c", file.c.as_ref()),
            ("d", file.d.as_ref()),
            ("e", file.e.as_ref()),
            ("f", file.f.as_ref()),
        ];
        let tables = reader.chain(tables)?;
        study.ensure(
            file.joint.len() + 1 == tables.len(),
            "joint",
            format_args!(
                "{} for {} parts",
                counted(file.joint.len(), "joint"),
                tables.len()
            ),
            format_args!("{}, one between each part and the next", tables.len() - 1),
        )?;
        let lines = study.line_choice(&file.frequency)?;
        study.beside_functions_only(
            "assembly",
            file.assembly.frf.is_some(),
            &[
                ("quantity", "a quantity", file.assembly.quantity.is_some()),
                ("units", "units", file.assembly.units.is_some()),
                ("averages", "averages", file.assembly.averages.is_some()),
                ("coherence", "a file", file.assembly.coherence.is_some()),
            ],
        )?;
        let mut assumed = Vec::new();
        let assembly = match &file.assembly.frf {
            Some(paths) => {
                let own = FileOfFunctions {
                    paths,
                    coherence: file.assembly.coherence.as_ref(),
                    averages: file.assembly.averages,
                    quantity: file.assembly.quantity,
                    units: file.assembly.units.as_ref(),
                };
                let read = reader.functions("assembly", &own, &lines)?;
                assumed.extend(read.assumed);
                Some(read.set)
            }
            None => None,
        };
        let is_measured = assembly.is_some();
        let lines_of = |own: &FrfSet| own.frequency_hz().to_vec();
        let mut frequency_hz = assembly.as_ref().map(lines_of);
        let mut parts = Vec::new();
        for &(name, table) in &tables {
            let source = reader.source(name, table, &lines, &mut assumed)?;
            if let Source::Functions(set) = &source {
                match &frequency_hz {
                    None => frequency_hz = Some(set.frequency_hz().to_vec()),
                    Some(expected) => {
                        reader.same_lines(&format!("{name}.frf"), set.frequency_hz(), expected)?;
                    }
                }
            }
            parts.push(reader.part(name, table, source, is_measured)?);
        }
        every_point_once(study, &parts)?;
        let frequency_hz = match frequency_hz {
            Some(frequency_hz) => frequency_hz,
            None => reader.lines(&file.frequency, step_hz)?,
        };
        assumed.extend(lines.cut_back([&frequency_hz[..]], "all files"));
        let sides = sides(study, &parts, &frequency_hz)?;
        let (mut links, mut scatters) = (Vec::new(), Vec::new());
        let (mut expected, mut models) = (Vec::new(), Vec::new());
        for (n, table) in file.joint.iter().enumerate() {
            let key = match file.joint.len() {
                1 => "joint".to_owned(),
                _ => format!("joint[{n}]"),
            };
            let (link, mut scatter) = reader.link(&key, table)?;
            if let Numbers::Unknown(_) = link.numbers {
                models.push(table.model.map_or("", model_name).to_owned());
                let own = reader.expected(&key, table)?;
                let (matrices, own) = own.map(|own| (own.matrices, own.scatter)).unzip();
                expected.push((key.clone(), matrices));
                scatter = own.flatten();
            }
            scatters.push(scatter);
            links.push(link);
        }
        let stated = reader.level(&file.noise)?;
        let mut level = stated;
        if assembly.as_ref().is_some_and(|own| own.tells_noise())
            && let Ok((mut observed, _)) = reader.observed(&sides, assembly.as_ref())
        {
            let (told, remark) = level_of(stated, &mut observed);
            level = told;
            assumed.extend(remark);
        }
        // their noise takes part where two structures are joined by one joint
        let noise = reader.noise(&file.noise, level)?;
        let is_chain = file.joint.len() > 1;
        if is_chain {
            assumed.extend(parts.iter().filter_map(of_no_use));
        }
        for (key, noise) in ["noise.a", "noise.b"].into_iter().zip(&noise) {
            if is_chain && !noise.is_none() {
                let expected =
                    "none for chains: they take the noise of the assembly's functions alone";
                return study.refuse(key, noise.relative, expected);
            }
        }
        let mut files = vec![study.record()];
        let of_parts = tables.iter().map(|&(name, table)| (name, files_of(table)));
        let of_assembly = file.assembly.frf.iter().chain(&file.assembly.coherence);
        let of_assembly = of_assembly.flat_map(Paths::iter).collect();
        for (role, paths) in of_parts.chain([("assembly", of_assembly)]) {
            for path in paths {
                let path = study.resolved(path);
                files.push(input_file(role, &path, study.folder(), |_, _| {})?);
            }
        }
        for (n, table) in file.joint.iter().enumerate() {
            if let Some(path) = &table.known {
                let path = study.resolved(path);
                files.push(input_file(
                    &format!("joint {}", n + 1),
                    &path,
                    study.folder(),
                    |_, _| {},
                )?);
            }
        }
        let of = |key: &str, list: &Option<Vec<String>>| {
            let list = list
                .as_ref()
                .map(|list| reader.dofs(&format!("assembly.{key}"), list));
            list.transpose()
        };
        let planned = [
            of("responses", &file.assembly.responses)?,
            of("references", &file.assembly.references)?,
        ];
        let candidates = match &file.candidates {
            Some(table) => Some(reader.candidates(table, &parts)?),
            None => None,
        };
        let budget = reader.budget(&file.budget, &sides, &parts, &links)?;
        Ok(Self {
            path: study.path().to_owned(),
            name: file.name,
            models,
            notes: file.notes,
            files,
            level,
            stated,
            noise,
            text: study.clone(),
            motions,
            problem: Problem {
                tolerances: budget.tolerances,
                wider: Vec::new(),
                common: budget.common,
                balance: None,
                sides,
                frequency_hz,
                observed: Vec::new(),
                links: Links(links),
            }
            .with_anew(budget.anew),
            parts,
            assembly,
            assumed,
            expected,
            scatters,
            planned,
            candidates,
        })
    }

    /// What was measured of the assembly, and how many functions are left out since they are zero.
    pub(crate) fn observed(&self) -> Result<(Vec<Observed>, usize), StudyError> {
        let reader = Reader {
            study: &self.text,
            motions: self.motions,
        };
        let (mut observed, zero) = reader.observed(&self.problem.sides, self.assembly.as_ref())?;
        level_of(self.stated, &mut observed);
        Ok((observed, zero))
    }

    /// Why nothing is found where nothing is sought.
    pub(crate) fn all_known(&self) -> StudyError {
        let expected =
            "one with a model to be sought; what the assembly answers says `bolted-joint respond`";
        self.text.refusal("joint", "every one known", expected)
    }

    /// How many joints are sought.
    #[must_use]
    pub fn sought(&self) -> usize {
        self.problem.links.sought().len()
    }
}

/// How many joints of a study are sought, and not known.
///
/// # Errors
/// [`StudyError`] for what is no study of this kind.
pub fn joints_sought(study: &StudyText) -> Result<usize, StudyError> {
    let file: StudyFile = study.tables()?;
    Ok(file
        .joint
        .iter()
        .filter(|joint| joint.known.is_none())
        .count())
}

/// Both sides of the joints: every second part belongs to the one, and the others to the other.
pub(crate) fn sides(
    study: &StudyText,
    parts: &[Part],
    frequency_hz: &[f64],
) -> Result<[Side; 2], StudyError> {
    let of = |first: usize| {
        let own = parts.iter().skip(first).step_by(2);
        let sides: Result<Vec<Side>, StudyError> =
            own.map(|part| part.side(study, frequency_hz)).collect();
        sides.map(joined)
    };
    Ok([of(0)?, of(1)?])
}

/// A remark on coherence of a part in a chain.
fn of_no_use(part: &Part) -> Option<String> {
    part.is_told.then(|| {
        format!(
            "{}: its coherence is not used: chains take the noise of the assembly's functions alone",
            part.name
        )
    })
}

fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
