//! Bands for the averages, chosen by what the data say about the joint and where the substructures' own resonances spoil it.

use num_complex::Complex64;

use crate::frf::resonances;
use crate::structure::CouplingError;

use super::bands::{BandChoice, BandChoices, BandOrigin, Bands, UsedBands, median, name};
use super::block::Block;
use super::kernel::{Kernel, complex_stiffness};
use super::layout::{Layout, Place};
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};

/// Lines closer than this part of the frequency to a resonance of a substructure are avoided; the thesis stays off its
/// resonance at 336 Hz by 11 %.
const DISTANCE: f64 = 0.1;
/// The part of the other lines, those most sensitive to an entry, that its bands hold.
const MOST_SENSITIVE: f64 = 0.25;
/// A band has so many lines at least.
const SHORTEST_BAND: usize = 3;

/// Bands from sensitivity and distance (Tol 4.2.2): for each entry of `model` the quarter of the lines on which the
/// assembly's receptances depend on it most, among those 10 % or more away from the substructures' own resonances.
///
/// An entry for which `given` has bands keeps them. The measure of a line is the largest |∂H^C/∂k|/|H^C| of the measured
/// receptances; at an antiresonance the median of |H^C| over the lines takes its place. Of several bolts in
/// `joint` the bands are those of the first.
///
/// # Errors
/// [`CouplingError::Singular`] at an undamped resonance, or if the joint's DOFs are not those of the lines.
pub fn choose_bands(
    lines: &Lines,
    model: JointModel,
    joint: &JointMatrices,
    given: &Bands,
) -> Result<Bands, CouplingError> {
    let dofs = joint.stiffness.nrows();
    let layout = Layout::of_different(model, dofs / model.dofs());
    let chosen = for_joints(lines, &layout, &joint.bolts(model.dofs()), given)?;
    chosen.into_iter().next().ok_or(CouplingError::Singular)
}

/// The same for each joint of a layout.
pub(super) fn for_joints(
    lines: &Lines,
    layout: &Layout,
    joints: &[JointMatrices],
    given: &Bands,
) -> Result<Vec<Bands>, CouplingError> {
    let choose = match lines.a_joint.first().map_or(0, |h| h.nrows()) {
        1 => with_dofs::<1>,
        2 => with_dofs::<2>,
        3 => with_dofs::<3>,
        4 => with_dofs::<4>,
        6 => with_dofs::<6>,
        8 => with_dofs::<8>,
        _ => return Err(CouplingError::Singular),
    };
    choose(lines, layout, joints, given)
}

fn with_dofs<const N: usize>(
    lines: &Lines,
    layout: &Layout,
    joints: &[JointMatrices],
    given: &Bands,
) -> Result<Vec<Bands>, CouplingError> {
    let unknowns = layout.unknowns_of(joints).ok_or(CouplingError::Singular)?;
    let block = Block::<N>::new(lines, 0, 1);
    let own_hz = own_resonances(std::iter::once(lines));
    chosen(
        &block,
        &lines.frequency_hz,
        &own_hz,
        layout,
        &unknowns,
        given,
    )
    .ok_or(CouplingError::Singular)
}

/// The bands that each entry of each joint is averaged over. `chosen` are the automatic ones, `None` if there is no
/// preliminary estimate to choose them at.
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
    let mut own: Vec<f64> = Vec::new();
    for lines in all {
        let hz = &lines.frequency_hz;
        for dof in 0..lines.a_joint.first().map_or(0, |h| h.nrows()) {
            let a: Vec<Complex64> = lines.a_joint.iter().map(|h| h[(dof, dof)]).collect();
            let b: Vec<Complex64> = lines.b.iter().map(|b| b.joint[(dof, dof)]).collect();
            let found = [resonances(hz, &a), resonances(hz, &b)].concat();
            own.extend(found.iter().map(|resonance| resonance.frequency_hz));
        }
    }
    own
}

/// The bands of each joint; `None` where the assembly cannot be computed.
pub(super) fn chosen<const N: usize>(
    block: &Block<N>,
    frequency_hz: &[f64],
    own_hz: &[f64],
    layout: &Layout,
    unknowns: &[f64],
    given: &Bands,
) -> Option<Vec<Bands>> {
    let is_far = |hz: f64| own_hz.iter().all(|own| (hz - own).abs() >= DISTANCE * own);
    let far: Vec<bool> = frequency_hz.iter().map(|&hz| is_far(hz)).collect();
    let measures = measures(block, &layout.places(), unknowns)?;
    let entries = layout.model().entries();
    let bands_of = |joint: usize| {
        let mut bands = given.clone();
        for (index, &entry) in entries.iter().enumerate() {
            let bands = bands.of_entry_mut(entry);
            if bands.is_empty() {
                let measure = &measures[joint * entries.len() + index];
                *bands = most_sensitive(frequency_hz, &far, measure);
            }
        }
        bands
    };
    Some((0..layout.joints()).map(bands_of).collect())
}

/// For each unknown entry the largest |∂H^C/∂k|/|H^C| of the measured receptances, line by line.
fn measures<const N: usize>(
    block: &Block<N>,
    places: &[Place],
    unknowns: &[f64],
) -> Option<Vec<Vec<f64>>> {
    let (lines, entries) = (block.lines(), block.entries.len());
    let mut sizes = vec![Vec::with_capacity(lines); entries];
    let mut derivatives = vec![vec![Vec::with_capacity(lines); entries]; places.len()];
    let mut kernel = Kernel::new();
    for line in 0..lines {
        let stiffness = complex_stiffness::<N>(places, unknowns, block.omega[line]);
        let transfer = &block.transfer[line * block.points..(line + 1) * block.points];
        kernel.solve(&block.free[line], transfer, &stiffness)?;
        for (e, &entry) in block.entries.iter().enumerate() {
            let own = block.own[line * entries + e];
            sizes[e].push(kernel.receptance(own, entry).norm());
            for (derivatives, &place) in derivatives.iter_mut().zip(places) {
                derivatives[e].push(kernel.by_stiffness(entry, place).norm());
            }
        }
    }
    let usual: Vec<f64> = sizes
        .iter()
        .map(|sizes| median(sizes.clone()).unwrap_or(0.0))
        .collect();
    let measure = |derivatives: &Vec<Vec<f64>>| {
        (0..lines)
            .map(|line| {
                let relative =
                    (0..entries).map(|e| derivatives[e][line] / sizes[e][line].max(usual[e]));
                relative.fold(0.0, f64::max)
            })
            .collect()
    };
    Some(derivatives.iter().map(measure).collect())
}

/// The bands in which the measure is highest among the lines that are `far` from resonances.
fn most_sensitive(frequency_hz: &[f64], far: &[bool], measure: &[f64]) -> Vec<[f64; 2]> {
    let mut ranked: Vec<f64> = (0..measure.len())
        .filter(|&line| far[line])
        .map(|line| measure[line])
        .collect();
    ranked.sort_by(|a, b| b.total_cmp(a));
    let Some(&threshold) = ranked.get((MOST_SENSITIVE * ranked.len() as f64) as usize) else {
        return Vec::new();
    };
    let holds = |line: usize| far[line] && measure[line] > threshold;
    let mut bands = Vec::new();
    let mut start = None;
    for line in 0..=measure.len() {
        let inside = line < measure.len() && holds(line);
        match (start, inside) {
            (None, true) => start = Some(line),
            (Some(first), false) => {
                if line - first >= SHORTEST_BAND {
                    bands.push([frequency_hz[first], frequency_hz[line - 1]]);
                }
                start = None;
            }
            _ => {}
        }
    }
    bands
}
