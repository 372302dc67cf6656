//! The files of a folder that may be a part or the assembly, and what of them belongs together.

use std::collections::BTreeSet;
use std::path::Path;

use bolted_joint_frf::structure::ModalModel;
use bolted_joint_frf::{Dof, ReadOptions, read_frfs};

use crate::FileKind;

/// A file that may be a part or the assembly.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) name: String,
    /// Further files of the same responses, of other references.
    pub(super) further: Vec<String>,
    /// Its modes, where they come in a file of their own beside functions.
    pub(super) modes: Option<String>,
    pub(super) is_modal: bool,
    pub(super) responses: BTreeSet<Dof>,
    pub(super) references: BTreeSet<Dof>,
    /// Response and reference of each function; of modes none.
    pub(super) pairs: BTreeSet<(Dof, Dof)>,
    /// Lowest and highest frequency, Hz.
    pub(super) band_hz: [f64; 2],
    /// What is to be known of its functions.
    pub(super) warning: Option<String>,
}

impl Candidate {
    /// Where something responds or is excited.
    pub(super) fn points(&self) -> BTreeSet<Dof> {
        self.responses.union(&self.references).copied().collect()
    }

    /// Its file, or its files, as a study names them.
    pub(super) fn files(&self) -> String {
        if self.further.is_empty() {
            return format!("{:?}", self.name);
        }
        let all = std::iter::once(&self.name).chain(&self.further);
        let all: Vec<String> = all.map(|name| format!("{name:?}")).collect();
        format!("[{}]", all.join(", "))
    }

    /// Its file, or its files, for people.
    pub(super) fn named(&self) -> String {
        let all = std::iter::once(&self.name).chain(&self.further);
        all.map(String::as_str).collect::<Vec<_>>().join(" with ")
    }

    /// Whether both are of one measurement, which many programs write in one file for each reference.
    fn is_beside(&self, other: &Self) -> bool {
        let letters = |name: &str| name.replace(|c: char| c.is_ascii_digit(), "");
        !self.is_modal
            && !other.is_modal
            && letters(&self.name) == letters(&other.name)
            && self.responses == other.responses
            && self.references.is_disjoint(&other.references)
            && self.band_hz == other.band_hz
    }

    pub(super) fn contains(&self, other: &Self) -> bool {
        other.responses.is_subset(&self.responses) && other.references.is_subset(&self.references)
    }

    /// Whether it has this degree of freedom, counted either way round.
    pub(super) fn has(&self, dof: Dof) -> bool {
        let points = self.points();
        points.contains(&dof) || points.contains(&dof.flipped())
    }

    /// Its functions in groups that have no point in common, each as if it had a file of its own; by their first points.
    pub(super) fn groups(&self) -> Vec<Self> {
        let mut groups: Vec<BTreeSet<(Dof, Dof)>> = Vec::new();
        for &pair in &self.pairs {
            let touches = |group: &BTreeSet<(Dof, Dof)>| {
                let mut points = group.iter().flat_map(|own| [own.0.node(), own.1.node()]);
                points.any(|node| [pair.0.node(), pair.1.node()].contains(&node))
            };
            let (joined, mut apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(touches);
            apart.push(joined.into_iter().flatten().chain([pair]).collect());
            groups = apart;
        }
        groups.sort();
        let groups = groups.into_iter().map(|pairs| Self {
            responses: pairs.iter().map(|own| own.0).collect(),
            references: pairs.iter().map(|own| own.1).collect(),
            pairs,
            ..self.clone()
        });
        groups.collect()
    }
}

/// Files of one measurement as one.
pub(super) fn together(found: Vec<Candidate>) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    for own in found {
        match all.iter_mut().find(|other| other.is_beside(&own)) {
            Some(first) => {
                first.further.push(own.name);
                first.references.extend(own.references);
                first.pairs.extend(own.pairs);
            }
            None => all.push(own),
        }
    }
    all
}

/// `None` for a file of another kind.
pub(super) fn candidate(path: &Path) -> Option<Result<Candidate, String>> {
    let name = path.file_name()?.to_str()?.to_owned();
    match FileKind::of(path) {
        FileKind::Functions(_) => {
            let read = read_frfs(path, &ReadOptions::default()).and_then(|reading| {
                let warning = reading.phase_warning();
                reading.into_set().map(|set| (set, warning))
            });
            Some(
                read.map_err(|refused| refused.to_string())
                    .map(|(set, warning)| {
                        let hz = set.frequency_hz();
                        Candidate {
                            name,
                            further: Vec::new(),
                            modes: None,
                            is_modal: false,
                            responses: set.functions().map(|own| own.0).collect(),
                            references: set.functions().map(|own| own.1).collect(),
                            pairs: set.functions().map(|own| (own.0, own.1)).collect(),
                            band_hz: [hz[0], hz[hz.len() - 1]],
                            warning,
                        }
                    }),
            )
        }
        FileKind::Modes => Some(
            ModalModel::read(path)
                .map_err(|refused| refused.to_string())
                .map(|model| {
                    let last = model
                        .modes()
                        .iter()
                        .map(|mode| mode.frequency_hz)
                        .fold(0.0, f64::max);
                    let points: BTreeSet<Dof> = model.points().iter().copied().collect();
                    Candidate {
                        name,
                        further: Vec::new(),
                        modes: None,
                        is_modal: true,
                        responses: points.clone(),
                        references: points,
                        pairs: BTreeSet::new(),
                        band_hz: [0.0, last],
                        warning: None,
                    }
                }),
        ),
        _ => None,
    }
}

/// Modes of a part that was measured as well beside its functions: both are called by the part's letter.
pub(super) fn with_modes_beside(found: Vec<Candidate>) -> Vec<Candidate> {
    let (modal, mut all): (Vec<_>, Vec<_>) = found.into_iter().partition(|own| own.is_modal);
    for modes in modal {
        let letter = ["a", "b"].into_iter().find(|own| modes.is_called(own));
        let is_same = |own: &&mut Candidate| {
            letter.is_some_and(|letter| own.is_called(letter))
                && !own.is_modal
                && own.modes.is_none()
        };
        match all.iter_mut().find(is_same) {
            Some(functions) => functions.modes = Some(modes.name),
            None => all.push(modes),
        }
    }
    all.sort_by(|one, other| one.name.cmp(&other.name));
    all
}
