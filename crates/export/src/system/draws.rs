//! Parameter sets drawn from what is known of the joints: their unknowns are normally distributed with the standard deviations
//! and correlations of their files.

use bolted_joint_assembly::{AssemblyModel, PlacedJoint};
use bolted_joint_interface::{At, Filling, law_parameters};
use bolted_joint_joint::{JointFile, Uncertainty};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use super::super::ExportError;
use super::SystemOptions;
use super::parameter_set::ParameterSet;

/// How often a joint is drawn anew that would feed energy into a simulation, before its deviations are called too large.
const TRIES: usize = 1000;

/// What was drawn of a joint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DrawnJoint {
    /// Its name.
    pub joint: String,
    /// How many of its entries have a standard deviation; none: it is the same in all draws.
    pub unknowns: usize,
    /// How many draws were not passive and drawn anew.
    pub drawn_anew: usize,
}

/// The sets, and what is known of each joint.
pub(super) struct Draws {
    pub(super) sets: Vec<ParameterSet>,
    pub(super) joints: Vec<DrawnJoint>,
}

impl Draws {
    pub(super) fn of(model: &AssemblyModel, options: &SystemOptions) -> Result<Self, ExportError> {
        let mut found = Self {
            sets: Vec::new(),
            joints: Vec::new(),
        };
        if options.draws == 0 {
            return Ok(found);
        }
        let known: Vec<Option<Known>> = model.joints.iter().map(Known::of).collect();
        if known.iter().all(Option::is_none) {
            let joints = model.joints.iter().map(|joint| joint.name.clone());
            return Err(ExportError::NothingToDraw {
                joints: joints.collect(),
            });
        }
        let joints = model.joints.iter().zip(&known);
        found.joints = joints
            .map(|(joint, known)| DrawnJoint {
                joint: joint.name.clone(),
                unknowns: known.as_ref().map_or(0, |known| known.entries.len()),
                drawn_anew: 0,
            })
            .collect();
        let digits = options.draws.to_string().len();
        for number in 1..=options.draws {
            let mut generator = ChaCha8Rng::seed_from_u64(options.seed);
            generator.set_stream(u64::from(number));
            let mut parameters = Vec::new();
            for (place, joint) in model.joints.iter().enumerate() {
                let Some(known) = &known[place] else {
                    continue;
                };
                let (drawn, anew) =
                    known.draw(joint, options.parts.allow_active, &mut generator)?;
                found.joints[place].drawn_anew += anew;
                let values = known
                    .entries
                    .iter()
                    .map(|entry| (entry.variable.clone(), entry.value(&drawn)));
                parameters
                    .extend(values.map(|(variable, value)| (joint.name.clone(), variable, value)));
            }
            let name = format!("draw-{number:0digits$}");
            found.sets.push(ParameterSet::new(name, parameters));
        }
        Ok(found)
    }
}

/// An entry of K or C that is uncertain.
struct Entry {
    variable: String,
    is_damping: bool,
    at: [usize; 2],
    deviation: f64,
}

impl Entry {
    fn value(&self, file: &JointFile) -> f64 {
        let [i, j] = self.at;
        match self.is_damping {
            true => file.joint.damping[i][j],
            false => file.joint.stiffness[i][j],
        }
    }

    fn add(&self, file: &mut JointFile, change: f64) {
        let [i, j] = self.at;
        let matrix = match self.is_damping {
            true => &mut file.joint.damping,
            false => &mut file.joint.stiffness,
        };
        matrix[i][j] += change;
        if i != j {
            matrix[j][i] = matrix[i][j];
        }
    }
}

/// How well a joint is known.
struct Known {
    entries: Vec<Entry>,
    /// A root of the covariance: changes of the entries are this times independent normal numbers.
    root: DMatrix<f64>,
}

impl Known {
    /// `None` where nothing is uncertain, or the file does not say.
    fn of(joint: &PlacedJoint) -> Option<Self> {
        let uncertainty = joint.file.uncertainty.as_ref()?;
        let entries = entries(&joint.file, uncertainty);
        if entries.is_empty() {
            return None;
        }
        let correlation = correlation(&entries, uncertainty);
        let eigen = SymmetricEigen::new(correlation);
        // Σ = D V Λ Vᵀ D, and rounding may leave an eigenvalue of zero below it
        let roots = eigen.eigenvalues.map(|own| own.max(0.0).sqrt());
        let deviations =
            DVector::from_iterator(entries.len(), entries.iter().map(|own| own.deviation));
        let root = DMatrix::from_diagonal(&deviations)
            * eigen.eigenvectors
            * DMatrix::from_diagonal(&roots);
        Some(Self { entries, root })
    }

    /// A joint, and how many were drawn before it that were not passive.
    fn draw(
        &self,
        joint: &PlacedJoint,
        allow_active: bool,
        generator: &mut ChaCha8Rng,
    ) -> Result<(JointFile, usize), ExportError> {
        for anew in 0..TRIES {
            let normal =
                DVector::from_fn(self.entries.len(), |_, _| StandardNormal.sample(generator));
            let change: DVector<f64> = &self.root * normal;
            let mut drawn = joint.file.clone();
            for (entry, change) in self.entries.iter().zip(change.iter()) {
                entry.add(&mut drawn, *change);
            }
            if allow_active || drawn.passivity().is_passive() {
                return Ok((drawn, anew));
            }
        }
        Err(ExportError::NeverPassive {
            joint: joint.name.clone(),
            tries: TRIES,
        })
    }
}

/// Entries of K and C that have a standard deviation, by the variables that they are in the FMU.
fn entries(file: &JointFile, uncertainty: &Uncertainty) -> Vec<Entry> {
    let dofs = file.joint.dofs.indices();
    let place = |row: usize| dofs.iter().position(|&own| own == row);
    let deviations = &uncertainty.standard_deviation;
    let mut found: Vec<Entry> = Vec::new();
    for parameter in law_parameters(&Filling::PRESENT) {
        let At::Pair(one, other) = parameter.at else {
            continue;
        };
        let is_damping = match parameter.key {
            "stiffness" => false,
            "damping" => true,
            _ => continue,
        };
        let (Some(i), Some(j)) = (place(one), place(other)) else {
            continue;
        };
        let matrix = if is_damping {
            &deviations.damping
        } else {
            &deviations.stiffness
        };
        let deviation = matrix
            .get(i)
            .and_then(|row| row.get(j))
            .copied()
            .unwrap_or(0.0);
        if deviation > 0.0 {
            found.push(Entry {
                variable: parameter.name.clone(),
                is_damping,
                at: [i, j],
                deviation,
            });
        }
    }
    found
}

/// Correlation of the entries; what the file does not say of is independent.
fn correlation(entries: &[Entry], uncertainty: &Uncertainty) -> DMatrix<f64> {
    let size = entries.len();
    let Some(stated) = &uncertainty.correlation else {
        return DMatrix::identity(size, size);
    };
    let places: Vec<Option<usize>> = entries
        .iter()
        .map(|entry| {
            let own = entry
                .variable
                .strip_prefix("joint.")
                .unwrap_or(&entry.variable);
            stated.unknowns.iter().position(|unknown| unknown == own)
        })
        .collect();
    DMatrix::from_fn(size, size, |i, j| match (places[i], places[j]) {
        _ if i == j => 1.0,
        (Some(i), Some(j)) => stated.matrix[i][j],
        _ => 0.0,
    })
}
