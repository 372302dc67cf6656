//! Single values that noise cannot have made: found before any fit, in each function by itself, and left out with their lines.
//!
//! Errors of the set-up and a joint model that is too simple leave each function smooth, so they are never taken for outliers.

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

use bolted_joint_frf::Dof;

use super::lines::Lines;
use super::receptances::Receptances;
use super::roughness::Roughness;

/// Of so large a part of the lines nothing is left out: then it is not single values that are bad.
const MOST: f64 = 0.2;
/// Values that are named one by one.
const MOST_NAMED: usize = 12;

/// A value that stands out.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlier {
    /// Whose function it is of, such as `A` or `assembly 2`.
    pub set: String,
    /// Response.
    pub response: Dof,
    /// Reference.
    pub reference: Dof,
    /// Its line, Hz.
    pub frequency_hz: f64,
}

impl fmt::Display for Outlier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            set,
            response,
            reference,
            frequency_hz,
        } = self;
        write!(f, "{set} {response} by {reference} at {frequency_hz:.6} Hz")
    }
}

/// What stands out, and whether its lines were left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outliers {
    /// The values, by set and frequency.
    pub values: Vec<Outlier>,
    /// Lines that were left out for them, those of all assemblies together.
    pub lines_left_out: usize,
}

impl Outliers {
    /// Finds them and leaves their lines out. `labels` are those of A's and B's measured functions.
    pub(super) fn leave_out(all: &mut [Lines], labels: [&[Dof]; 2]) -> Self {
        let mut found = Self::default();
        let several = all.len() > 1;
        let mut bad: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); all.len()];
        for (number, lines) in all.iter().enumerate() {
            let assembly = match several {
                true => format!("assembly {}", number + 1),
                false => "assembly".to_owned(),
            };
            let places = lines.measured.iter();
            let rough = lines.roughness();
            lines
                .floors
                .get_or_init(|| rough.iter().map(|rough| rough.floor).collect());
            let functions = places.zip(rough);
            let own = functions.map(|(&(p, q), rough)| ((lines.points[p], lines.points[q]), rough));
            let mut sets = vec![(assembly, own.collect::<Vec<_>>())];
            for (name, receptances, labels) in
                [("A", &lines.a, labels[0]), ("B", &lines.b, labels[1])]
            {
                let Some(measured) = receptances.measured() else {
                    continue;
                };
                let functions = measured.measured_functions().into_iter();
                let own = functions.filter_map(|((p, q), rough)| {
                    Some(((*labels.get(p)?, *labels.get(q)?), rough))
                });
                sets.push((name.to_owned(), own.collect()));
            }
            for (set, functions) in sets {
                // Where most functions stand out a resonance lies between the lines.
                let at = |line: usize| {
                    let suspicious = |rough: &Roughness| rough.suspicious.contains(&line);
                    functions
                        .iter()
                        .filter(|(_, rough)| suspicious(rough))
                        .count()
                };
                let is_single = |line: usize| functions.len() < 3 || 2 * at(line) < functions.len();
                for ((response, reference), rough) in &functions {
                    let (response, reference) = (*response, *reference);
                    for &line in rough.outliers.iter().filter(|line| is_single(**line)) {
                        bad[number].insert(line);
                        let outlier = Outlier {
                            set: set.clone(),
                            response,
                            reference,
                            frequency_hz: lines.frequency_hz[line],
                        };
                        if !found.values.contains(&outlier) {
                            found.values.push(outlier);
                        }
                    }
                }
            }
        }
        let order = |one: &Outlier, other: &Outlier| {
            (one.set.cmp(&other.set)).then(one.frequency_hz.total_cmp(&other.frequency_hz))
        };
        found.values.sort_by(order);
        // Assemblies that share what was measured keep the same lines.
        let together = share_lines(all);
        if together {
            let union: BTreeSet<usize> = bad.iter().flatten().copied().collect();
            bad.fill(union);
        }
        let counts = bad.iter().zip(all.iter());
        if counts
            .into_iter()
            .any(|(bad, lines)| bad.len() as f64 > MOST * lines.frequency_hz.len() as f64)
        {
            return found;
        }
        let mut kept: Vec<(Receptances, Receptances)> = Vec::new();
        for (lines, bad) in all.iter_mut().zip(&bad) {
            if bad.is_empty() {
                continue;
            }
            let good: Vec<usize> = (0..lines.frequency_hz.len())
                .filter(|line| !bad.contains(line))
                .collect();
            let mut of = |receptances: &Receptances| match known(&kept, receptances) {
                Some(known) => known,
                None => {
                    let own = receptances.at_lines(&good);
                    kept.push((receptances.clone(), own.clone()));
                    own
                }
            };
            let (a, b) = (of(&lines.a), of(&lines.b));
            *lines = Lines {
                a,
                b,
                ..lines.at_lines(&good)
            };
            found.lines_left_out += bad.len();
        }
        found
    }

    /// What the user should know of them.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        if self.values.is_empty() {
            return None;
        }
        let named = self.values.iter().take(MOST_NAMED).map(Outlier::to_string);
        let mut named = named.collect::<Vec<_>>().join(", ");
        if self.values.len() > MOST_NAMED {
            named += &format!(" and {} more", self.values.len() - MOST_NAMED);
        }
        let (count, lines) = (self.values.len(), self.lines_left_out);
        let values = if count == 1 { "value is" } else { "values are" };
        Some(match lines {
            0 => format!(
                "{count} {values} far off what their neighbours and the noise allow, too many to leave their lines out: {named}; \
                 see whether the functions were measured with enough averages, and whether the lines lie close enough"
            ),
            lines => format!(
                "{count} {values} far off what their neighbours and the noise allow: {named}; {lines} {} left out of the estimate",
                if lines == 1 { "line is" } else { "lines are" }
            ),
        })
    }
}

/// Whether some assemblies have a measured substructure in common.
fn share_lines(all: &[Lines]) -> bool {
    let is_same = |one: &Receptances, other: &Receptances| match (one.measured(), other.measured())
    {
        (Some(one), Some(other)) => Arc::ptr_eq(one, other),
        _ => false,
    };
    let pairs = all.iter().zip(all.iter().skip(1));
    let mut pairs =
        pairs.map(|(one, other)| is_same(&one.a, &other.a) || is_same(&one.b, &other.b));
    pairs.any(|shares| shares)
}

/// What was made of a substructure that assemblies share.
fn known(kept: &[(Receptances, Receptances)], receptances: &Receptances) -> Option<Receptances> {
    let measured = receptances.measured()?;
    let found = kept.iter().find(|(before, _)| {
        before
            .measured()
            .is_some_and(|before| Arc::ptr_eq(before, measured))
    });
    found.map(|(_, kept)| kept.clone())
}
