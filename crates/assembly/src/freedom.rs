//! In which motions nothing holds an assembly: the whole, which may well be meant, or its parts against each other.
//!
//! A motion without any strain has no part in the elastic coordinates of the structures, and none in the joints' degrees of
//! freedom that have stiffness: it is in the null space of R = (√K S) on the free coordinates. Where some such motion moves a
//! structure while its neighbour stands still, the two are a mechanism.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, RowDVector, SymmetricEigen};

use crate::error::AssemblyError;
use crate::model::{AssemblyModel, PlacedJoint};

/// Part of a row of unit length below which it is rounding.
const ROUNDING: f64 = 1e-8;
/// Eigenvalues of a stiffness of unit diagonal below which it holds nothing.
const SOFT: f64 = 1e-10;
/// Displacement (m, rad) at which a spring that only hardens holds.
const HARDENED: f64 = 1e-4;
/// Points that are told at most.
const TOLD: usize = 4;

/// What nothing holds.
pub(crate) struct Freedom {
    /// Places of joints whose structures move freely against each other, and how.
    pub(crate) mechanisms: Vec<(usize, String)>,
    /// What may well be meant.
    pub(crate) notes: Vec<String>,
}

impl Freedom {
    pub(crate) fn of(model: &AssemblyModel) -> Result<Self, AssemblyError> {
        let free = Free::of(model, Springs::OfAnyMotion)?;
        let joints = model.joints.iter().enumerate();
        let mechanisms = joints
            .filter_map(|(place, joint)| Some((place, free.mechanism(joint)?)))
            .collect();
        Ok(Self {
            notes: free.notes(),
            mechanisms,
        })
    }
}

/// Which springs hold.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Springs {
    /// Those that hold against a motion of whatever size.
    OfSmallMotion,
    /// Those that only harden too.
    OfAnyMotion,
}

impl AssemblyModel {
    /// Motions that no spring holds while they are small: orthogonal columns over all coordinates.
    pub(crate) fn unstrained_motions(&self) -> Result<DMatrix<f64>, AssemblyError> {
        Ok(Free::of(self, Springs::OfSmallMotion)?.motions)
    }
}

/// Motions without strain.
struct Free<'m> {
    model: &'m AssemblyModel,
    /// Where each structure's coordinates begin, and where the last one's end.
    first: Vec<usize>,
    /// One motion of all coordinates a column, orthogonal.
    motions: DMatrix<f64>,
}

impl<'m> Free<'m> {
    fn of(model: &'m AssemblyModel, springs: Springs) -> Result<Self, AssemblyError> {
        let mut first = vec![0];
        let mut rigid = Vec::new();
        for own in &model.structures {
            let before = first.last().copied().unwrap_or_default();
            let frequencies = own.form.frequency_rad_per_s.iter().enumerate();
            rigid.extend(
                frequencies
                    .filter(|(_, omega)| **omega == 0.0)
                    .map(|(i, _)| before + i),
            );
            first.push(before + own.form.size());
        }
        let mut motions = DMatrix::zeros(model.size(), rigid.len());
        for (column, &coordinate) in rigid.iter().enumerate() {
            motions[(coordinate, column)] = 1.0;
        }
        for joint in &model.joints {
            let rows = held(joint, springs)? * model.relative_rows(joint);
            let units = rows.row_iter().filter_map(|row| {
                let size = row.norm();
                (size > 0.0).then(|| row / size)
            });
            let units: Vec<_> = units.collect();
            motions = without(motions, &units);
        }
        Ok(Self {
            model,
            first,
            motions,
        })
    }

    /// The free motions of one structure.
    fn of_structure(&self, structure: usize) -> DMatrix<f64> {
        let [from, to] = [self.first[structure], self.first[structure + 1]];
        self.motions.rows(from, to - from).into_owned()
    }

    /// Those in which a structure stands still.
    fn with_still(&self, structure: usize) -> DMatrix<f64> {
        let own = self.of_structure(structure);
        let rows: Vec<_> = own.row_iter().map(|row| row.into_owned()).collect();
        let count = self.motions.ncols();
        &self.motions * without(DMatrix::identity(count, count), &rows)
    }

    /// How the structures of this joint move against each other, if they can.
    fn mechanism(&self, joint: &PlacedJoint) -> Option<String> {
        let [a, b] = joint.places.each_ref().map(|own| own.first());
        let [a, b] = [a?.structure, b?.structure];
        if a == b {
            return None;
        }
        let found = [(a, b), (b, a)].into_iter().find_map(|(still, moving)| {
            let motions = self.with_still(still);
            let [from, to] = [self.first[moving], self.first[moving + 1]];
            let own = motions.rows(from, to - from).into_owned();
            (own.norm() > ROUNDING).then_some((still, moving, motions, own))
        });
        let (still, moving, motions, own) = found?;
        let name = |structure: usize| &self.model.structures[structure].name;
        let dofs = joint.file.joint.dofs.rows();
        let relative = self.model.relative_rows(joint);
        let moved = relative.row_iter().zip(dofs).filter_map(|(row, dof)| {
            let moves = (row * &motions).norm() > ROUNDING * row.norm();
            moves.then_some(dof.name)
        });
        let moved: Vec<&str> = moved.collect();
        let reason = if moved.is_empty() {
            format!(
                "the joint has no degree of freedom for that ({})",
                joint.file.joint.dofs.names().join(", ")
            )
        } else {
            format!("the joint has no stiffness in {}", moved.join(", "))
        };
        Some(format!(
            "structure {} moves freely{} while {} stands still: {reason}",
            name(moving),
            self.told(moving, &own),
            name(still)
        ))
    }

    /// The points that move most, told by these motions of a structure.
    fn told(&self, structure: usize, motions: &DMatrix<f64>) -> String {
        let form = &self.model.structures[structure].form;
        let sizes: Vec<f64> = form
            .shapes
            .row_iter()
            .map(|row| (row * motions).norm() / row.norm().max(f64::MIN_POSITIVE))
            .collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let points = form.points.iter().zip(&sizes);
        let moving: Vec<String> = points
            .filter(|(_, size)| **size > 0.1 * largest && **size > ROUNDING)
            .map(|(point, _)| point.to_string())
            .collect();
        match moving.len() {
            0 => String::new(),
            count if count > TOLD => {
                format!(
                    " (at {} and {} more)",
                    moving[..TOLD].join(", "),
                    count - TOLD
                )
            }
            _ => format!(" (at {})", moving.join(", ")),
        }
    }

    fn notes(&self) -> Vec<String> {
        let groups = self.groups();
        let several = groups.len() > 1;
        let mut notes = Vec::new();
        for group in groups {
            let names: Vec<&str> = group
                .iter()
                .map(|&own| self.model.structures[own].name.as_str())
                .collect();
            let names = match names.as_slice() {
                [one] => format!("structure {one}"),
                _ => format!("structures {}", names.join(", ")),
            };
            if several {
                notes.push(format!("no joint connects {names} to the others"));
            }
            let own = group.iter().flat_map(|&own| {
                let rows = self.of_structure(own);
                (0..rows.nrows()).map(move |row| rows.row(row).into_owned())
            });
            let own: Vec<_> = own.collect();
            let count = self.motions.ncols();
            let still = without(DMatrix::identity(count, count), &own).ncols();
            match count - still {
                0 => {}
                free => notes.push(format!(
                    "nothing holds {names}: free in {free} {}, so a load that does not end moves it away",
                    if free == 1 { "motion" } else { "motions" }
                )),
            }
        }
        notes
    }

    /// Structures that joints connect, with each other.
    fn groups(&self) -> Vec<BTreeSet<usize>> {
        let mut groups: Vec<BTreeSet<usize>> = (0..self.model.structures.len())
            .map(|own| BTreeSet::from([own]))
            .collect();
        for joint in &self.model.joints {
            let all = joint.places.iter().flatten();
            let of_joint: BTreeSet<usize> = all.map(|place| place.structure).collect();
            let (touched, mut others): (Vec<_>, Vec<_>) = groups
                .into_iter()
                .partition(|group| !group.is_disjoint(&of_joint));
            others.push(touched.into_iter().flatten().collect());
            groups = others;
        }
        groups.sort();
        groups
    }
}

/// Rows of the relative motions in which a joint has stiffness: of √K, or what has the same null space.
fn held(joint: &PlacedJoint, springs: Springs) -> Result<DMatrix<f64>, AssemblyError> {
    let (mut stiffness, _) = joint.of_small_motion_about(0.0)?;
    if springs == Springs::OfAnyMotion {
        let (hardened, _) = joint.of_small_motion_about(HARDENED)?;
        for i in 0..stiffness.nrows() {
            if stiffness[(i, i)] == 0.0 {
                stiffness[(i, i)] = hardened[(i, i)];
            }
        }
    }
    // of unit diagonal: translations and rotations have units of their own
    let scale: Vec<f64> = stiffness
        .diagonal()
        .iter()
        .map(|k| k.abs().sqrt())
        .collect();
    let part = |i: usize| if scale[i] > 0.0 { 1.0 / scale[i] } else { 0.0 };
    let size = scale.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| stiffness[(i, j)] * part(i) * part(j));
    let eigen = SymmetricEigen::new(scaled);
    let rows: Vec<RowDVector<f64>> = (0..size)
        .filter(|&k| eigen.eigenvalues[k].abs() > SOFT)
        .map(|k| RowDVector::from_fn(size, |_, j| eigen.eigenvectors[(j, k)] * scale[j]))
        .collect();
    Ok(match rows.is_empty() {
        true => DMatrix::zeros(0, size),
        false => DMatrix::from_rows(&rows),
    })
}

/// The combinations of these columns in which the rows, of unit length at most, do not move.
fn without(mut basis: DMatrix<f64>, rows: &[RowDVector<f64>]) -> DMatrix<f64> {
    let mut left: Vec<&RowDVector<f64>> = rows.iter().collect();
    while basis.ncols() > 0 {
        // the row that these columns move most
        let sizes = left.iter().map(|row| (*row * &basis).norm()).enumerate();
        let Some((place, size)) = sizes.max_by(|one, other| one.1.total_cmp(&other.1)) else {
            break;
        };
        if size < ROUNDING {
            break;
        }
        let mut mirror = (left.swap_remove(place) * &basis).transpose() / size;
        // H = 1 − 2 v vᵀ/vᵀv turns the row into the first column's: v = x ± e₁
        mirror[0] += if mirror[0] < 0.0 { -1.0 } else { 1.0 };
        let moved = &basis * &mirror * (2.0 / mirror.norm_squared());
        basis -= moved * mirror.transpose();
        basis = basis.remove_column(0);
    }
    basis
}
