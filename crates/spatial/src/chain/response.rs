//! What an assembly whose joints are known answers: the functions at a tool's point, of a chain of spindle, holder and tool, and how
//! far the joints' deviations let them be off.

use bolted_joint_frf::{Dof, Frf, FrfError, FrfSet};
use bolted_joint_joint::Uncertainty;
use bolted_joint_space::{Coupled, Entry, Part as Matrix};
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::chain::part::Part;
use crate::chain::study::ChainStudy;
use crate::error::SpatialError;
use crate::links::{Link, Links, Numbers};
use crate::prior::Common;
use crate::problem::{Problem, Unknowns};

/// One function of an assembly.
#[derive(Clone, Debug)]
pub struct Answer {
    /// What moves.
    pub response: Dof,
    /// What is loaded.
    pub reference: Dof,
    /// Receptance at each line, SI units.
    pub values: Vec<Complex64>,
    /// Standard deviation of its magnitude at each line, by the joints' deviations; `None` where these are not told for every
    /// joint.
    pub deviation: Option<Vec<f64>>,
}

/// Functions of an assembly.
#[derive(Clone, Debug)]
pub struct Answers {
    /// Lines, Hz.
    pub frequency_hz: Vec<f64>,
    /// By response, then by reference.
    pub functions: Vec<Answer>,
    /// The joints whose deviations are not known number by number.
    pub without_deviations: Vec<String>,
}

/// Numbers of a joint that scatter, and their covariance.
#[derive(Clone, Debug)]
pub(crate) struct Scatter {
    numbers: Vec<(Entry, Matrix)>,
    covariance: DMatrix<f64>,
}

impl Scatter {
    /// Of a joint file, where every number of its matrices is an unknown of its own. Where some follow from others, as those of a
    /// bolt do, the file does not say how.
    pub(crate) fn of(uncertainty: &Uncertainty, names: &[&str]) -> Option<Self> {
        let correlation = uncertainty.correlation.as_ref()?;
        let all = [Matrix::Stiffness, Matrix::Damping];
        let named = |name: &String| {
            let mut pairs = all
                .into_iter()
                .flat_map(|part| Entry::ALL.map(|entry| (entry, part)));
            pairs.find(|(entry, part)| entry.name(*part) == *name)
        };
        let numbers: Vec<(Entry, Matrix)> = correlation
            .unknowns
            .iter()
            .map(named)
            .collect::<Option<_>>()?;
        let own = &uncertainty.standard_deviation;
        let deviation = |(entry, part): &(Entry, Matrix)| {
            let rows = if *part == Matrix::Stiffness {
                &own.stiffness
            } else {
                &own.damping
            };
            let place =
                |dof: bolted_joint_space::Dof| names.iter().position(|name| *name == dof.symbol());
            rows.get(place(entry.row)?)?
                .get(place(entry.column)?)
                .copied()
        };
        let deviations: Vec<f64> = numbers.iter().map(deviation).collect::<Option<_>>()?;
        let scattering = [&own.stiffness, &own.damping].into_iter().flat_map(|rows| {
            let upper = rows
                .iter()
                .enumerate()
                .flat_map(|(i, row)| row.iter().skip(i));
            upper.filter(|&&deviation| deviation > 0.0)
        });
        if scattering.count() != numbers.len() {
            return None;
        }
        let covariance = DMatrix::from_fn(numbers.len(), numbers.len(), |i, j| {
            correlation
                .matrix
                .get(i)
                .and_then(|row| row.get(j))
                .copied()
                .unwrap_or(0.0)
                * deviations[i]
                * deviations[j]
        });
        Some(Self {
            numbers,
            covariance,
        })
    }
}

impl ChainStudy {
    /// The functions of the assembly between the responses and references that the study names elsewhere on its parts, or
    /// between all sensors and impacts where it names none.
    ///
    /// # Errors
    /// [`SpatialError`] where a joint is neither known nor expected, or the assembly resonates without damping.
    pub fn answers(&self) -> Result<Answers, SpatialError> {
        let mut expected = self.expected.iter();
        let mut links = Vec::new();
        for link in &self.problem.links.0 {
            let matrices = match &link.numbers {
                Numbers::Known(matrices) => **matrices,
                Numbers::Unknown(_) => {
                    let own = expected.next().and_then(|(_, matrices)| *matrices);
                    own.ok_or_else(|| SpatialError::NotExpected {
                        joint: link.key.clone(),
                    })?
                }
            };
            links.push(Link {
                numbers: Numbers::Known(Box::new(matrices)),
                ..link.clone()
            });
        }
        let problem = Problem {
            links: Links(links),
            tolerances: None,
            wider: Vec::new(),
            common: Common::default(),
            balance: None,
            observed: Vec::new(),
            ..self.problem.clone()
        };
        let places = self.places(&problem);
        let assembled = Assembled::new(&problem, &Unknowns(nalgebra::DVector::zeros(0)))?;
        let scatters: Option<Vec<&Scatter>> = self.scatters.iter().map(Option::as_ref).collect();
        let mut functions: Vec<Answer> = places
            .iter()
            .map(|&(response, reference, _)| Answer {
                response,
                reference,
                values: Vec::new(),
                deviation: scatters.is_some().then(Vec::new),
            })
            .collect();
        for line in 0..problem.frequency_hz.len() {
            let whole = assembled.whole(line)?;
            for (function, &(_, _, at)) in functions.iter_mut().zip(&places) {
                let value = whole.receptance()[(at[0], at[1])];
                function.values.push(value);
                if let (Some(own), Some(scatters)) = (&mut function.deviation, &scatters) {
                    own.push(deviation(&whole, at, value, problem.omega(line), scatters));
                }
            }
        }
        let keys = problem.links.0.iter().zip(&self.scatters);
        Ok(Answers {
            frequency_hz: problem.frequency_hz.clone(),
            functions,
            without_deviations: keys
                .filter(|(_, scatter)| scatter.is_none())
                .map(|(link, _)| link.key.clone())
                .collect(),
        })
    }

    /// Response, reference, and row and column of each function.
    fn places(&self, problem: &Problem) -> Vec<(Dof, Dof, [usize; 2])> {
        let [a, b] = &problem.sides;
        let elsewhere = |of: fn(&Part) -> &Vec<Dof>| -> Vec<Dof> {
            self.parts.iter().flat_map(of).copied().collect()
        };
        let of = |own: &[Dof], other: &[Dof], wanted: &[Dof]| -> Vec<(Dof, usize)> {
            let is_wanted = |dof: &Dof| wanted.is_empty() || wanted.contains(dof);
            let all = own.iter().chain(other).copied().enumerate();
            all.map(|(n, dof)| (dof, n))
                .filter(|(dof, _)| is_wanted(dof))
                .collect()
        };
        let rows = of(
            &a.responses,
            &b.responses,
            &elsewhere(|part| &part.responses),
        );
        let columns = of(
            &a.references,
            &b.references,
            &elsewhere(|part| &part.references),
        );
        let pairs = rows.iter().flat_map(|&(response, row)| {
            columns
                .iter()
                .map(move |&(reference, column)| (response, reference, [row, column]))
        });
        pairs.collect()
    }
}

impl Answers {
    /// As functions that can be written to a file.
    ///
    /// # Errors
    /// [`FrfError`] where a DOF stands twice.
    pub fn set(&self) -> Result<FrfSet, FrfError> {
        let of = |one: &Answer| {
            let frequency_hz = self.frequency_hz.clone();
            Frf::new(
                one.response,
                one.reference,
                frequency_hz,
                one.values.clone(),
            )
        };
        FrfSet::new(self.functions.iter().map(of).collect::<Result<_, _>>()?)
    }
}

/// √(gᵀ Σ g), g = Re(Ȳ dY)/|Y|: how far the magnitude scatters, to first order.
fn deviation(
    whole: &Coupled,
    at: [usize; 2],
    value: Complex64,
    omega: f64,
    scatters: &[&Scatter],
) -> f64 {
    let direction = value.conj() / value.norm().max(f64::MIN_POSITIVE);
    let mut variance = 0.0;
    for (joint, scatter) in scatters.iter().enumerate() {
        let gradient: Vec<f64> = scatter
            .numbers
            .iter()
            .map(|(entry, part)| {
                let [p, q] = [entry.row, entry.column].map(|dof| 6 * joint + dof.index());
                let change = whole.by_entry(at, [p, q]).unwrap_or_default();
                let factor = match part {
                    Matrix::Damping => Complex64::new(0.0, omega),
                    _ => Complex64::from(1.0),
                };
                (direction * factor * change).re
            })
            .collect();
        for (i, one) in gradient.iter().enumerate() {
            for (j, other) in gradient.iter().enumerate() {
                variance += one * scatter.covariance[(i, j)] * other;
            }
        }
    }
    variance.max(0.0).sqrt()
}
