//! The reference run of an assembly: steps of its loads, then free vibration.

use bolted_joint_assembly::{AssemblyModel, PlacedJoint};
use bolted_joint_dynamics::{
    DofMemory,
    assembly::{Assembly, AssemblyMotion, AssemblyState, AssemblySteps, TOLERANCE},
    with_dofs,
};

use super::super::ExportError;
use super::super::reference_run::{ReferenceRun, Rows, stimulus};
use super::variables::{List, Listed, Role};

const STEPS: usize = 200;
/// Communication steps at each level of load.
const STEPS_A_LEVEL: usize = 5;
/// Levels of load; the structures are free for the rest of the run.
const LOADED_LEVELS: usize = 32;
/// Tolerances of the joints' laws in the reference, of which the first one is taken that the shortest parts of a step can keep.
const FINER: [f64; 3] = [1e-3 * TOLERANCE, 1e-2 * TOLERANCE, 1e-1 * TOLERANCE];
/// The FMU may differ by this many times what its own tolerance makes it differ …
const MARGIN: f64 = 10.0;
/// … and by what rounding does.
const ROUNDING: f64 = 1e-9;
/// Part of its table that a preload goes through to either side.
const PART_OF_TABLE: f64 = 0.3;
/// Load (N, N·m) of an assembly without joints, or whose joints no load moves.
const USUAL_LOAD: f64 = 10.0;

/// The run at communication steps of `step_s` (s); `None` if its outputs do not stay finite, or there is nothing to see.
pub(super) fn run(
    model: &AssemblyModel,
    assembly: &Assembly,
    list: &List,
    step_s: f64,
) -> Result<Option<ReferenceRun>, ExportError> {
    let Some(steps) = AssemblySteps::new(assembly, step_s, TOLERANCE) else {
        return Ok(None);
    };
    let nominal = |joint: &PlacedJoint| joint.table().map(|table| table.nominal);
    let course = Course {
        assembly,
        nominal_n_m: model.joints.iter().filter_map(nominal).collect(),
        amplitude: 1.0,
    };
    let Some(unit) = course.history(steps.clone()) else {
        return Ok(None);
    };
    let amplitude = amplitude(model, assembly, &unit)?;
    let course = Course {
        amplitude: stimulus::rounded(amplitude),
        ..course
    };
    let finer = |tolerance: &f64| course.history(steps.with_tolerance(*tolerance));
    let reference = FINER.iter().find_map(finer);
    let Some((found, reference)) = course.history(steps.clone()).zip(reference) else {
        return Ok(None);
    };
    let outputs: Vec<usize> = (0..list.variables.len())
        .filter(|&place| list.variables[place].is_output)
        .collect();
    let rows = |states: &[AssemblyState]| -> Rows {
        let row = |(step, state): (usize, &AssemblyState)| {
            let all =
                Values::new(model, assembly, list).at(state, &course.at(step.saturating_sub(1)));
            let values = outputs.iter().map(|&place| all[place]).collect();
            (step as f64 * step_s, values)
        };
        states.iter().enumerate().map(row).collect()
    };
    let (found, reference) = (rows(&found), rows(&reference));
    let is_finite = |rows: &Rows| {
        rows.iter()
            .flat_map(|(_, values)| values)
            .all(|value| value.is_finite())
    };
    if !(is_finite(&found) && is_finite(&reference)) {
        return Ok(None);
    }
    let deviation = (0..outputs.len())
        .map(|column| {
            let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
            let both = || found.iter().zip(&reference);
            let off = largest(&mut both().map(|(f, r)| (f.1[column] - r.1[column]).abs()));
            match largest(&mut both().map(|(_, r)| r.1[column].abs())) {
                0.0 => 0.0,
                magnitude => off / magnitude,
            }
        })
        .fold(0.0, f64::max);
    let name = |place: &usize| list.variables[*place].name.clone();
    let inputs: Vec<String> = (0..course.inputs()).map(|place| name(&place)).collect();
    let levels = (0..=STEPS / STEPS_A_LEVEL).flat_map(|level| {
        let edge_s = (level * STEPS_A_LEVEL) as f64 * step_s;
        // constant from one level's beginning to the next
        let before = level
            .checked_sub(1)
            .map(|before| (edge_s, course.level(before)));
        let after = (level < STEPS / STEPS_A_LEVEL).then(|| (edge_s, course.level(level)));
        before.into_iter().chain(after)
    });
    let tolerance = (MARGIN * deviation).max(ROUNDING);
    Ok(Some(ReferenceRun::of_rows(
        step_s,
        STEPS,
        (inputs, levels.collect()),
        (outputs.iter().map(name).collect(), reference),
        format!("{tolerance:.0e}")
            .parse::<f64>()
            .unwrap_or(tolerance)
            .max(tolerance),
    )))
}

/// Loads and preloads of the run.
struct Course<'a> {
    assembly: &'a Assembly,
    /// Of the joints over the preload.
    nominal_n_m: Vec<f64>,
    /// N and N·m.
    amplitude: f64,
}

impl Course<'_> {
    fn inputs(&self) -> usize {
        self.assembly.loads.columns() + self.nominal_n_m.len()
    }

    fn level(&self, level: usize) -> Vec<f64> {
        let share = |place: usize| match level < LOADED_LEVELS {
            true => stimulus::shape(place, place % 4 > 1, (level + 1) as f64).0,
            false => 0.0,
        };
        let loads = self.assembly.loads.columns();
        let mut all: Vec<f64> = (0..loads)
            .map(|place| stimulus::rounded(self.amplitude * share(place)))
            .collect();
        let preloads = self.assembly.over_preload().zip(&self.nominal_n_m);
        for (place, (law, nominal_n_m)) in (loads..).zip(preloads) {
            let [first, last] = law.range_n_m();
            let way = PART_OF_TABLE * (last - first) * share(place);
            all.push(stimulus::rounded(nominal_n_m + way).clamp(first, last));
        }
        all
    }

    fn at(&self, step: usize) -> Vec<f64> {
        self.level(step / STEPS_A_LEVEL)
    }

    /// States at the communication points; `None` where the shortest parts of a step are too long for the tolerance.
    fn history(&self, mut steps: AssemblySteps) -> Option<Vec<AssemblyState>> {
        let mut underway = steps.at_rest();
        let held = vec![0.0; self.inputs()];
        let mut all = vec![AssemblyState::at_rest(self.assembly)];
        for step in 0..STEPS {
            steps.step(&mut underway, &self.at(step), &held);
            if steps.was_too_long() {
                return None;
            }
            all.push(steps.coordinates().state(&underway));
        }
        Some(all)
    }
}

/// Loads that open the joints as far as their laws show, as far as a linear assembly would.
fn amplitude(
    model: &AssemblyModel,
    assembly: &Assembly,
    unit: &[AssemblyState],
) -> Result<f64, ExportError> {
    let mut least = f64::INFINITY;
    for (joint, own) in model.joints.iter().zip(&assembly.joints) {
        let dofs = joint.file.joint.dofs;
        let wanted = with_dofs!(dofs.size(), D => {
            let law = joint.file.joint.law::<D>()?;
            stimulus::relative_motion(&law, dofs).to_vec()
        });
        for (dof, wanted) in wanted.into_iter().enumerate() {
            let row = own.relative.row(dof);
            let moved = unit.iter().map(|state| {
                let pairs = row.iter().zip(&state.motion);
                pairs.map(|(own, q)| own * q).sum::<f64>().abs()
            });
            let moved = moved.fold(0.0, f64::max);
            if moved > 0.0 && moved.is_finite() {
                least = least.min(wanted / moved);
            }
        }
    }
    Ok(if least.is_finite() { least } else { USUAL_LOAD })
}

/// Values of all variables of the list.
struct Values<'a> {
    model: &'a AssemblyModel,
    assembly: &'a Assembly,
    list: &'a List,
}

impl<'a> Values<'a> {
    fn new(model: &'a AssemblyModel, assembly: &'a Assembly, list: &'a List) -> Self {
        Self {
            model,
            assembly,
            list,
        }
    }

    fn at(&self, state: &AssemblyState, inputs: &[f64]) -> Vec<f64> {
        let (assembly, memory): (_, &[DofMemory]) = (self.assembly, &state.memory);
        let (coordinates, rates) = state.motion.split_at(assembly.size());
        let (loads, preloads) = inputs.split_at(assembly.loads.columns());
        let laws = assembly.laws_at(preloads);
        let motion = AssemblyMotion {
            coordinates,
            rates,
            laws: &laws,
        };
        let rows = self.model.output_rows();
        let product = |row: usize, numbers: &[f64]| -> f64 {
            numbers
                .iter()
                .enumerate()
                .map(|(i, number)| rows[(row, i)] * number)
                .sum()
        };
        let motions =
            (0..rows.nrows()).flat_map(|row| [product(row, coordinates), product(row, rates)]);
        let dofs: usize = assembly.joints.iter().map(|joint| joint.laws.len()).sum();
        let mut joint_loads = vec![0.0; dofs];
        assembly.joint_loads(motion, memory, &mut joint_loads);
        let shown = super::variables::shown_places(assembly);
        let of_kind = |inner: bool| {
            let all = shown.iter().filter(move |shown| shown.is_inner == inner);
            all.map(|shown| {
                memory[shown.law]
                    .get(shown.place)
                    .copied()
                    .unwrap_or_default()
            })
        };
        let mut all = inputs.to_vec();
        all.extend(coordinates.iter().chain(rates));
        all.extend([state.supplied_j, state.dissipated_j]);
        all.extend(of_kind(true));
        all.extend(motions);
        all.extend(joint_loads);
        all.extend(of_kind(false));
        let stored = assembly.stored_energy(motion, memory);
        all.extend([
            stored,
            assembly.supplied_power(rates, loads),
            assembly.dissipated_power(motion, memory),
        ]);
        if !preloads.is_empty() {
            // what is left of the balance, from rest on
            all.push(stored - state.supplied_j + state.dissipated_j);
        }
        // derivatives and indicators are no outputs
        let is_none = |own: &&Listed| matches!(own.role, Role::Derivative | Role::Indicator);
        let rest = self.list.variables.iter().filter(is_none).count();
        all.extend(std::iter::repeat_n(0.0, rest));
        all
    }
}
