//! Bands for the averages, chosen by what the data say about the joint and where the substructures' own resonances spoil it.

use num_complex::Complex64;

use bolted_joint_frf::resonances;
use bolted_joint_frf::structure::SingularAssembly;
use bolted_joint_statistics::median;

use super::bands::{BandChoice, BandChoices, BandOrigin, Bands, UsedBands, name};
use super::block::Block;
use super::independent_parts::IndependentParts;
use super::kernel::Kernel;
use super::layout::{Layout, Place};
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::noise::Noise;
use super::parallel;
use super::receptances::Receptances;
use super::used::Chosen;

/// Lines closer than this part of the frequency to a resonance of a substructure are avoided; the thesis stays off its
/// resonance at 336 Hz by 11 %.
const DISTANCE: f64 = 0.1;
/// A band holds the lines whose sensitivity is at least this part of the highest; of the next part where no band has it.
const SHARES: [f64; 3] = [1.0 / 3.0, 0.1, 0.03];
/// A band has so many lines at least.
const SHORTEST_BAND: usize = 3;
/// Lines that one processor goes through at a time.
const LINES_OF_A_PART: usize = 256;

/// Bands from sensitivity and distance (Tol 4.2.2): for each entry of `model` the lines that determine it best, among those
/// 10 % or more away from the substructures' own resonances.
///
/// An entry for which `given` has bands keeps them. The measure of a line is 1/√[(JᴴΣ⁻¹J)⁻¹]_ii with J = ∂H^C/∂K* and
/// Σ = diag |H^C|²: the sensitivity |∂H^C/∂K*|/|H^C| as far as no other entry could have the same effect. At an antiresonance the
/// median of |H^C| over the lines takes the place of |H^C|. Of several bolts in `joint` the bands are those of the first.
///
/// # Errors
/// [`SingularAssembly`] at an undamped resonance, or if the joint's DOFs are not those of the lines.
pub fn choose_bands(
    lines: &Lines,
    model: JointModel,
    joint: &JointMatrices,
    given: &Bands,
) -> Result<Bands, SingularAssembly> {
    let dofs = joint.stiffness.nrows();
    let layout = Layout::of_different(model, dofs / model.dofs());
    let chosen = for_joints(lines, &layout, &joint.bolts(model.dofs()), given)?;
    chosen.into_iter().next().ok_or(SingularAssembly)
}

/// The same for each joint of a layout.
pub(super) fn for_joints(
    lines: &Lines,
    layout: &Layout,
    joints: &[JointMatrices],
    given: &Bands,
) -> Result<Vec<Bands>, SingularAssembly> {
    let unknowns = layout.unknowns_of(joints).ok_or(SingularAssembly)?;
    let own_hz = own_resonances(std::iter::once(lines));
    chosen(lines, &own_hz, layout, &unknowns, given).ok_or(SingularAssembly)
}

/// The bands that each entry of each joint is averaged over. `chosen` are the automatic ones, `None` if there is no
/// estimate to choose them at.
pub(super) fn used(
    layout: &Layout,
    choices: &BandChoices,
    chosen: Option<&[Bands]>,
) -> Vec<Vec<UsedBands>> {
    let entries = layout.model().entries();
    let of_joint = |joint: usize| {
        let of_entry = |&entry: &(usize, usize)| {
            let automatic = chosen.map_or(&[][..], |chosen| chosen[joint].of_entry(entry));
            let (bands, origin) = match choices.of_entry(entry) {
                BandChoice::Given(bands) => (bands.clone(), BandOrigin::Given),
                BandChoice::Median => (Vec::new(), BandOrigin::Median),
                BandChoice::Automatic if automatic.is_empty() => {
                    (Vec::new(), BandOrigin::NoneQualifies)
                }
                BandChoice::Automatic => (automatic.to_vec(), BandOrigin::Automatic),
            };
            UsedBands {
                name: name(entry),
                bands,
                origin,
            }
        };
        entries.iter().map(of_entry).collect()
    };
    (0..layout.joints()).map(of_joint).collect()
}

/// Resonances of the substructures of all assemblies at the joint's DOFs, Hz.
pub(super) fn own_resonances<'a>(all: impl Iterator<Item = &'a Lines>) -> Vec<f64> {
    let of_substructure = |&(lines, substructure): &(&Lines, &Receptances)| -> Vec<f64> {
        let hz = &lines.frequency_hz;
        let every: Vec<usize> = (0..hz.len()).collect();
        let found = (0..lines.joint_dofs()).flat_map(|dof| {
            let function = substructure.function(dof, dof);
            let values = function.over(&every);
            resonances(hz, &values)
        });
        found.map(|resonance| resonance.frequency_hz).collect()
    };
    let substructures: Vec<(&Lines, &Receptances)> = all
        .flat_map(|lines| [(lines, &lines.a), (lines, &lines.b)])
        .collect();
    parallel::map(&substructures, of_substructure).concat()
}

/// The bands of each joint; `None` where the assembly cannot be computed.
pub(super) fn chosen(
    lines: &Lines,
    own_hz: &[f64],
    layout: &Layout,
    unknowns: &[f64],
    given: &Bands,
) -> Option<Vec<Bands>> {
    let frequency_hz = &lines.frequency_hz;
    let is_far = |hz: f64| own_hz.iter().all(|own| (hz - own).abs() >= DISTANCE * own);
    let far: Vec<bool> = frequency_hz.iter().map(|&hz| is_far(hz)).collect();
    let decoupled = layout.decoupled_places();
    let measures = measures(lines, &layout.places(), unknowns, &decoupled)?;
    let measure_at = |place: (usize, usize)| {
        let index = decoupled.iter().position(|other| other.first() == place)?;
        measures.get(index)
    };
    let places = layout.places();
    let entries = layout.model().entries();
    let bands_of = |joint: usize| {
        let mut bands = given.clone();
        for (index, &entry) in entries.iter().enumerate() {
            let bands = bands.of_entry_mut(entry);
            if !bands.is_empty() {
                continue;
            }
            // An average over several bolts is as good as its worst value.
            let own = places[joint * entries.len() + index].all();
            let own: Vec<&Vec<f64>> = own.filter_map(measure_at).collect();
            let worst = |line: usize| {
                own.iter()
                    .map(|own| own[line])
                    .fold(f64::INFINITY, f64::min)
            };
            let measure: Vec<f64> = (0..frequency_hz.len()).map(worst).collect();
            *bands = most_sensitive(frequency_hz, &far, &measure);
        }
        bands
    };
    Some((0..layout.joints()).map(bands_of).collect())
}

/// For each of `decoupled` and each line, how well the line determines that entry of K* while the others are unknown, too:
/// 1/√[(JᴴΣ⁻¹J)⁻¹]_ii with J = ∂H^C/∂K* and Σ = diag |H^C|², at the joint with these `unknowns`.
fn measures(
    lines: &Lines,
    places: &[Place],
    unknowns: &[f64],
    decoupled: &[Place],
) -> Option<Vec<Vec<f64>>> {
    let pieces = parallel::pieces(lines.frequency_hz.len(), LINES_OF_A_PART);
    let parts = parallel::map(&pieces, |piece| {
        let block = Block::new(lines, 0, &Chosen::of(piece.clone()), &Noise::none());
        Part::of(&block, places, unknowns, decoupled)
    });
    let parts: Vec<Part> = parts.into_iter().collect::<Option<_>>()?;
    let entries = parts.first().map_or(0, |part| part.entries);
    let usual: Vec<f64> = (0..entries)
        .map(|e| {
            let sizes = parts
                .iter()
                .flat_map(|part| part.sizes.iter().skip(e).step_by(entries));
            median(sizes.copied()).unwrap_or(0.0)
        })
        .collect();
    let found = parallel::map_each(parts, |part| part.measures(&usual, decoupled.len()));
    let of = |t: usize| found.iter().flat_map(move |part| &part[t]).copied();
    Some((0..decoupled.len()).map(|t| of(t).collect()).collect())
}

/// |H^C| and ∂H^C/∂K* of some lines.
struct Part {
    /// Entries of the assembly.
    entries: usize,
    /// Of each entry, line by line.
    sizes: Vec<f64>,
    /// The rows of each line's Jacobian one after the other.
    jacobians: Vec<Complex64>,
}

impl Part {
    fn of(block: &Block, places: &[Place], unknowns: &[f64], decoupled: &[Place]) -> Option<Self> {
        let (lines, entries) = (0..block.lines(), block.entries.len());
        let mut part = Self {
            entries,
            sizes: Vec::with_capacity(lines.len() * entries),
            jacobians: Vec::with_capacity(lines.len() * entries * decoupled.len()),
        };
        let mut kernel = Kernel::new(block.dofs);
        for line in lines {
            let joint = (places, unknowns, block.omega[line]);
            kernel.solve(block.free_at(line), block.transfer_at(line), joint)?;
            for (e, &entry) in block.entries.iter().enumerate() {
                let own = block.own[line * entries + e];
                let size = kernel.receptance(own, entry).norm_sqr().sqrt();
                part.sizes.push(size);
                let row = decoupled.iter().map(|&at| kernel.by_stiffness(entry, at));
                part.jacobians.extend(row);
            }
        }
        Some(part)
    }

    /// The measure of each of `columns` entries of K* at each line.
    fn measures(mut self, usual: &[f64], columns: usize) -> Vec<Vec<f64>> {
        let mut independent = IndependentParts::new(columns);
        let mut measures = vec![Vec::with_capacity(self.sizes.len() / usual.len()); columns];
        let jacobians = self.jacobians.chunks_exact_mut(columns * usual.len());
        for (jacobian, sizes) in jacobians.zip(self.sizes.chunks_exact(usual.len())) {
            let rows = jacobian.chunks_exact_mut(columns).zip(sizes).zip(usual);
            for ((row, &size), &usual) in rows {
                let weight = size.max(usual).recip();
                for value in row {
                    *value *= weight;
                }
            }
            let found = independent.lengths(jacobian);
            for (t, measures) in measures.iter_mut().enumerate() {
                measures.push(found.map_or(0.0, |found| found[t]));
            }
        }
        measures
    }
}

/// The bands in which the measure is highest among the lines that are `far` from resonances.
fn most_sensitive(frequency_hz: &[f64], far: &[bool], measure: &[f64]) -> Vec<[f64; 2]> {
    let away = (0..measure.len()).filter(|&line| far[line]);
    let highest = away.map(|line| measure[line]).fold(0.0, f64::max);
    if highest == 0.0 {
        return Vec::new();
    }
    let found = SHARES.iter().map(|share| {
        let holds = |line: usize| far[line] && measure[line] >= share * highest;
        stretches(measure.len(), holds)
    });
    let lines = found.into_iter().find(|found| !found.is_empty());
    let hz = |[first, last]: [usize; 2]| [frequency_hz[first], frequency_hz[last]];
    lines.unwrap_or_default().into_iter().map(hz).collect()
}

/// First and last line of each stretch of lines that is long enough for a band.
fn stretches(lines: usize, holds: impl Fn(usize) -> bool) -> Vec<[usize; 2]> {
    let mut found = Vec::new();
    let mut start = None;
    for line in 0..=lines {
        match (start, line < lines && holds(line)) {
            (None, true) => start = Some(line),
            (Some(first), false) => {
                if line - first >= SHORTEST_BAND {
                    found.push([first, line - 1]);
                }
                start = None;
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_where_the_measure_is_high_and_lines_are_far_from_resonances() {
        let hz: Vec<f64> = (0..12).map(f64::from).collect();
        let measure = [0.0, 3.0, 3.0, 3.0, 0.1, 9.0, 9.0, 9.0, 9.0, 1.0, 1.0, 1.0];
        let mut far = [true; 12];
        assert_eq!(
            most_sensitive(&hz, &far, &measure),
            [[1.0, 3.0], [5.0, 8.0]]
        );
        // A resonance among the best lines leaves too few of them beside it.
        far[6] = false;
        assert_eq!(most_sensitive(&hz, &far, &measure), [[1.0, 3.0]]);
        // No three lines with a third of the best: the next best will do.
        far[2] = false;
        assert_eq!(most_sensitive(&hz, &far, &measure), [[7.0, 11.0]]);
        assert!(most_sensitive(&hz, &far, &[0.0; 12]).is_empty());
    }
}
