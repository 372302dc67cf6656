//! Single values that noise cannot have made: found before any fit, in each function by itself, and left out with their lines.
//!
//! Errors of the set-up and a joint model that is too simple leave each function smooth, so they are never taken for outliers.

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

use bolted_joint_frf::Dof;

use super::lines::Lines;
use super::model::JointMatrices;
use super::receptances::Receptances;
use super::roughness::Roughness;
use super::unresolved;

/// Of so large a part of the lines nothing is left out: then it is not single values that are bad.
const MOST: f64 = 0.2;
/// A value that a joint explains up to this part of how far its neighbours are from it is none …
/// … and neither is a substructure's where everything that was measured of the assembly is explained up to this part of itself.
const EXPLAINED: f64 = 0.3;
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

/// A value that stands out from its neighbours, before any fit.
struct Candidate {
    assembly: usize,
    line: usize,
    /// Row and column in the assembly's matrix; `None` for a substructure's function.
    place: Option<(usize, usize)>,
    /// How far it is from what its neighbours predict.
    deviation: f64,
    outlier: Outlier,
}

/// Values that stand out from their neighbours.
pub(super) struct Candidates {
    found: Vec<Candidate>,
    /// Resonances too sharp for the lines, at which good values stand out, too.
    unresolved: BTreeSet<String>,
}

impl Candidates {
    /// Those of all assemblies and their substructures. `labels` are those of A's and B's measured functions.
    pub(super) fn of(all: &[Lines], labels: [&[Dof]; 2]) -> Self {
        let mut found: Vec<Candidate> = Vec::new();
        let mut unresolved = BTreeSet::new();
        for (number, lines) in all.iter().enumerate() {
            for (set, functions) in functions(lines, labels, (all.len() > 1).then_some(number)) {
                // Where most functions stand out a resonance lies between the lines.
                let at = |line: usize| {
                    let suspicious = |rough: &Roughness| rough.suspicious.contains(&line);
                    let functions = functions.iter();
                    functions.filter(|of| suspicious(of.rough)).count()
                };
                let is_single = |line: usize| functions.len() < 3 || 2 * at(line) < functions.len();
                let peaks: Vec<&[usize]> = functions.iter().map(|of| of.peaks.as_slice()).collect();
                let resonances = match functions.len() < 3 {
                    true => Vec::new(),
                    false => unresolved::resonances(&peaks),
                };
                for of in &functions {
                    let lines_of = of.rough.outliers.iter();
                    for &(line, deviation) in lines_of.filter(|(line, _)| is_single(*line)) {
                        if let Some((peak, _)) =
                            resonances.iter().find(|(_, lines)| lines.contains(&line))
                        {
                            let hz = lines.frequency_hz[*peak];
                            unresolved.insert(format!("{set} at {hz:.1} Hz"));
                        }
                        let outlier = Outlier {
                            set: set.clone(),
                            response: of.response,
                            reference: of.reference,
                            frequency_hz: lines.frequency_hz[line],
                        };
                        found.push(Candidate {
                            assembly: number,
                            line,
                            place: of.place,
                            deviation,
                            outlier,
                        });
                    }
                }
            }
        }
        Self { found, unresolved }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// What the user should know of the distance between lines.
    pub(super) fn warning(&self) -> Option<String> {
        let all: Vec<&str> = self.unresolved.iter().map(String::as_str).collect();
        (!all.is_empty()).then(|| {
            format!(
                "fewer than {} lines lie within the half-power bandwidth of a resonance of {}: a bad value there is not told from a good \
                 one, and damping is hardly measured; zoom in, or measure longer",
                unresolved::FEWEST_LINES,
                all.join(", of ")
            )
        })
    }

    /// Those that a joint which was found without their lines does not explain, and whether these are fewer: beside a resonance
    /// that is too sharp for the lines a good value stands out from its neighbours, too. `joint` is that of an assembly.
    pub(super) fn beside<'j>(
        self,
        all: &[Lines],
        joint: impl Fn(usize) -> &'j JointMatrices,
    ) -> (Self, bool) {
        let before = self.found.len();
        let is_explained = |of: &Candidate| {
            let lines = all[of.assembly].at_lines(&[of.line]);
            let Ok(computed) = lines.regenerated(joint(of.assembly)) else {
                return false;
            };
            let differs = |&place: &(usize, usize)| {
                let (measured, computed) = (lines.assembly[0][place], computed[0][place]);
                match of.place {
                    Some(_) => (measured - computed).norm() > EXPLAINED * of.deviation,
                    None => (measured - computed).norm() > EXPLAINED * measured.norm(),
                }
            };
            match of.place {
                Some(place) => !differs(&place),
                None => !lines.measured.iter().any(differs),
            }
        };
        let candidates = self.found.into_iter();
        let found: Vec<Candidate> = candidates.filter(|of| !is_explained(of)).collect();
        let is_fewer = found.len() < before;
        let unresolved = self.unresolved;
        (Self { found, unresolved }, is_fewer)
    }

    /// What is left of the lines, and what was left out.
    pub(super) fn leave_out(&self, all: &[Lines]) -> (Vec<Lines>, Outliers) {
        let mut found = Outliers::default();
        let mut bad: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); all.len()];
        for of in &self.found {
            bad[of.assembly].insert(of.line);
            if !found.values.contains(&of.outlier) {
                found.values.push(of.outlier.clone());
            }
        }
        found.values.sort_by(|one, other| {
            (one.set.cmp(&other.set)).then(one.frequency_hz.total_cmp(&other.frequency_hz))
        });
        // Assemblies that share what was measured keep the same lines.
        if share_lines(all) {
            let union: BTreeSet<usize> = bad.iter().flatten().copied().collect();
            bad.fill(union);
        }
        let is_too_many = |(bad, lines): (&BTreeSet<usize>, &Lines)| {
            bad.len() as f64 > MOST * lines.frequency_hz.len() as f64
        };
        if bad.iter().zip(all).any(is_too_many) {
            return (all.to_vec(), found);
        }
        let mut kept: Vec<(Receptances, Receptances)> = Vec::new();
        let mut without = |(lines, bad): (&Lines, &BTreeSet<usize>)| {
            if bad.is_empty() {
                return lines.clone();
            }
            found.lines_left_out += bad.len();
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
            Lines {
                a,
                b,
                ..lines.at_lines(&good)
            }
        };
        let left = all.iter().zip(&bad).map(&mut without).collect();
        (left, found)
    }
}

/// A measured function and its noise.
struct Function<'l> {
    response: Dof,
    reference: Dof,
    /// Row and column in the assembly's matrix.
    place: Option<(usize, usize)>,
    rough: &'l Roughness,
    /// Lines of peaks that are too sharp for the lines.
    peaks: Vec<usize>,
}

/// The measured functions of an assembly, with its number if there are several, and of its substructures, by set.
fn functions<'l>(
    lines: &'l Lines,
    labels: [&[Dof]; 2],
    number: Option<usize>,
) -> Vec<(String, Vec<Function<'l>>)> {
    let assembly = match number {
        Some(number) => format!("assembly {}", number + 1),
        None => "assembly".to_owned(),
    };
    let own = lines.measured.iter().zip(lines.roughness());
    let own = own.map(|(&(p, q), rough)| Function {
        response: lines.points[p],
        reference: lines.points[q],
        place: Some((p, q)),
        rough,
        peaks: {
            let values = lines.assembly.iter().map(|matrix| matrix[(p, q)]);
            unresolved::peaks(&values.collect::<Vec<_>>())
        },
    });
    let mut sets = vec![(assembly, own.collect::<Vec<_>>())];
    for (name, receptances, labels) in [("A", &lines.a, labels[0]), ("B", &lines.b, labels[1])] {
        let Some(measured) = receptances.measured() else {
            continue;
        };
        let own = measured.measured_functions().into_iter();
        let own = own.filter_map(|((p, q), rough)| {
            Some(Function {
                response: *labels.get(p)?,
                reference: *labels.get(q)?,
                place: None,
                rough,
                peaks: unresolved::peaks(measured.function(p, q)),
            })
        });
        sets.push((name.to_owned(), own.collect()));
    }
    sets
}

impl Outliers {
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

#[cfg(test)]
mod tests {
    use bolted_joint_frf::structure::ComplexMatrix;
    use nalgebra::DMatrix;
    use num_complex::Complex64;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::ShownNoise;
    use crate::receptances::MeasuredSubstructure;

    /// Shapes of B's modes at four places, and the frequency of the first, Hz. The loss factor is 0.002.
    const SHAPES: [[f64; 4]; 2] = [[1.0, 0.4, -0.5, -0.9], [1.0, -0.3, -0.2, 2.0]];
    const FIRST_HZ: f64 = 870.0;

    /// B, free, measured from 40 to 3000 Hz every 10 Hz with noise of 1 %, and one bad value where it is asked for.
    fn lines(second_hz: f64, seed: u64, bad: Option<usize>) -> Lines {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
        let frequency_hz: Vec<f64> = (4..=300).map(|line| 10.0 * f64::from(line)).collect();
        let columns = (0..4).flat_map(|column| (0..=column).map(move |row| (row, column)));
        let places: Vec<(usize, usize)> = columns.collect();
        let mut function = |&(p, q): &(usize, usize)| -> Vec<Complex64> {
            let of_mode = |hz: f64| {
                let modes = SHAPES.iter().zip([FIRST_HZ, second_hz]);
                let modes = modes.map(|(shape, natural)| {
                    let square = natural * natural;
                    shape[p] * shape[q] * Complex64::new(square - hz * hz, 0.002 * square).inv()
                });
                modes.sum::<Complex64>() - (1.0 + 0.2 * (p + q) as f64) / (hz * hz)
            };
            let part = 0.01 * std::f64::consts::FRAC_1_SQRT_2;
            let values = frequency_hz
                .iter()
                .map(|&hz| of_mode(hz) * Complex64::new(1.0 + part * normal(), part * normal()));
            values.collect()
        };
        let mut functions: Vec<Vec<Complex64>> = places.iter().map(&mut function).collect();
        if let Some(line) = bad {
            functions[4][line] *= 3.0;
        }
        let measured = MeasuredSubstructure::new(DMatrix::identity(4, 4), functions, places, None);
        let measured = measured.with_axis(&frequency_hz, vec![false; 4]);
        let still = |size| vec![ComplexMatrix::zeros(size, size); frequency_hz.len()];
        Lines {
            a: Receptances::Exact(still(1)),
            b: Receptances::Measured(Arc::new(measured)),
            apart: None,
            assembly: still(3),
            points: ["2:+Y", "3:+Y", "4:+Y"]
                .map(|dof| dof.parse().unwrap())
                .to_vec(),
            measured: Vec::new(),
            relative_variance: None,
            repeats: None,
            shown: ShownNoise::default(),
            frequency_hz,
        }
    }

    fn found(second_hz: f64, seed: u64, bad: Option<usize>) -> Candidates {
        let labels: Vec<Dof> = (1..5)
            .map(|node| format!("{node}:+Y").parse().unwrap())
            .collect();
        Candidates::of(&[lines(second_hz, seed, bad)], [&[], &labels])
    }

    #[test]
    fn a_peak_of_most_functions_is_no_outlier_and_a_bad_value_is_one() {
        let mut told = Vec::new();
        for second_hz in [2962.0, 2965.0, 2972.0, 2974.0, 2975.0, 2977.0] {
            for seed in 0..12 {
                let own = found(second_hz, seed, None);
                assert!(own.is_empty(), "{second_hz} {seed}");
                told.extend(own.warning());
            }
        }
        let is_there = |told: &String| told.contains("a resonance of B at 29");
        assert!(told.iter().all(is_there), "{told:?}");
        // a bad value elsewhere stays one
        let bad = found(2975.0, 0, Some(120));
        assert_eq!(bad.found.len(), 1);
        assert_eq!(bad.found[0].line, 120);
    }
}
