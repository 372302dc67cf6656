//! The assembly FMU: structures and the joints between them, loads in, motion out. The linear part is propagated exactly, the
//! joints' laws by an exponential Runge–Kutta scheme.

mod calculated;
mod layout;
mod lengths;
mod memory;
mod places;

pub(crate) use layout::AssemblyLayout;

use std::sync::Arc;

use bolted_joint_dynamics::{
    DofMemory, Dual, JointLaw, SPACE_COUNT,
    assembly::{AssemblyCoordinates, Underway},
};

use crate::{
    assembly_file::AssemblyFile,
    input_course::InputCourse,
    interface::{FIRST_LISTED, InterfaceType, Name, Values, memory::FIRST_ENERGY, reference::TIME},
    models::{Model, Outcome, Step, loosening::check_preload},
    refusal::{Active, Refusal},
};
use calculated::Calculated;
use lengths::Lengths;
use memory::Stayed;
use places::{Place, Places};

/// Parts of a step at whose ends it is looked whether a preload is still within its table.
const PARTS: u32 = 8;

/// Structures and the joints between them.
#[derive(Debug)]
pub(super) struct AssemblyModel {
    file: AssemblyFile,
    layout: AssemblyLayout,
    places: Places,
    lengths: Lengths,
    /// Where a step moves the state on.
    state: Underway,
}

impl AssemblyModel {
    pub(super) fn new(file: AssemblyFile) -> Self {
        crate::use_all_of_it();
        Self {
            layout: AssemblyLayout::of(&file),
            state: Underway::at_rest(&file.assembly),
            places: Places::default(),
            lengths: Lengths::default(),
            file,
        }
    }

    /// The laws of the joints over the preload at present.
    fn laws(&self, values: &Values) -> Vec<JointLaw<SPACE_COUNT>> {
        let preloads = self.layout.preloads.clone();
        self.file.assembly.laws_at(&values.listed()[preloads])
    }

    /// The same with their changes along those of the preloads.
    fn laws_along(&self, values: &Values, change: &Values) -> Vec<JointLaw<SPACE_COUNT, Dual<1>>> {
        let preloads = self.layout.preloads.clone();
        let of = |values: &'_ Values| values.listed()[preloads.clone()].to_vec();
        let pairs = of(values).into_iter().zip(of(change));
        let all = self.file.assembly.over_preload().zip(pairs);
        all.map(|(own, (preload_n_m, change_n_m))| {
            let change = own.change(preload_n_m).times(change_n_m);
            own.law(preload_n_m).with_change(&change)
        })
        .collect()
    }

    fn calculated<'a, N>(&'a self, laws: &'a [JointLaw<SPACE_COUNT, N>]) -> Calculated<'a, N> {
        Calculated {
            file: &self.file,
            layout: &self.layout,
            laws,
        }
    }

    /// Writes motions, loads in the joints, and what these remember; returns the latter where it is more than what was committed.
    fn write_outputs(
        &self,
        calculated: Calculated<'_>,
        values: &mut Values,
    ) -> Option<Vec<DofMemory>> {
        let present = memory::present(calculated, values);
        let laws = calculated.laws;
        // the same whether the states have been told or not
        let is_underway = self
            .places
            .write_outputs(&self.file, &self.layout, laws, values);
        let (listed, committed) = values.listed_beside_memory();
        let memory = present.as_deref().unwrap_or(committed);
        match is_underway {
            true => calculated.write_remembered(listed, memory),
            false => calculated.write(listed, memory),
        }
        present
    }

    /// Refuses preloads (N·m) that a step of this length (s) comes to and at which there is no joint, by `look`, which finds
    /// them after a time (s).
    fn check_preloads(&self, step: Step, look: impl Fn(usize, f64) -> f64) -> Result<(), Refusal> {
        let laws = self.file.assembly.over_preload();
        for (place, law) in self.layout.preloads.clone().zip(laws) {
            for part in 1..=PARTS {
                let after_s = step.interval_s * f64::from(part) / f64::from(PARTS);
                let time_s = step.time_s + after_s;
                check_preload(law, look(place, after_s), Some(time_s))?;
            }
        }
        Ok(())
    }

    /// Takes what the laws remember from the variables.
    fn take_memory(&mut self, values: &Values) {
        let laws = self.file.assembly.laws();
        for ((laws, own), memory) in laws.zip(&mut self.state.memory).zip(values.memories()) {
            laws.copy_memory(memory, own);
        }
    }

    /// Writes it to the variables.
    fn write_memory(&self, values: &mut Values) {
        let listed = values.listed_mut();
        self.calculated(&[]).write_inner(listed, &self.state.memory);
        let laws = self.file.assembly.laws();
        for ((laws, own), memory) in laws.zip(&self.state.memory).zip(values.memories_mut()) {
            laws.copy_memory(own, memory);
        }
    }

    /// Refuses states of which a number is no finite one: q, q̇ and the energies at `states`, and what the laws remember.
    fn check_finite(
        &self,
        states: &[f64],
        memory: &[DofMemory],
        time_s: f64,
    ) -> Result<(), Refusal> {
        let name = if let Some(place) = states.iter().position(|number| !number.is_finite()) {
            self.state_name(place)
        } else {
            let mut laws = self.file.assembly.laws().zip(memory);
            if laws.all(|(laws, memory)| laws.is_memory_finite(memory)) {
                return Ok(());
            }
            Name::Borrowed("of a joint")
        };
        Err(Refusal::StateNotFinite { name, time_s })
    }

    /// The same of where a step has come to.
    fn check_end(&self, coordinates: &AssemblyCoordinates, time_s: f64) -> Result<(), Refusal> {
        let own = &self.state;
        // where squares are finite so is all that is seen of them
        let squares: f64 = own.motion.iter().map(|z| z * z).sum();
        if (squares + own.balance_j + own.supplied_j).is_finite() {
            return self.check_finite(&[], &own.memory, time_s);
        }
        let state = coordinates.state(own);
        let mut states = state.motion;
        states.extend([state.supplied_j, state.dissipated_j]);
        self.check_finite(&states, &own.memory, time_s)?;
        Err(Refusal::StateNotFinite {
            name: self.state_name(0),
            time_s,
        })
    }

    /// Moves the state on over a step, about these preloads (N·m). Returns the place in which it goes on, and whether the step was
    /// too long for the joints.
    fn go_on(
        &mut self,
        values: &mut Values,
        step: Step,
        inputs: &InputCourse,
        about_n_m: &[f64],
    ) -> Result<(Arc<Place>, bool), Refusal> {
        self.take_memory(values);
        if !places::are_about(about_n_m, &self.layout, values) {
            // from one place to another by the states
            self.places.settle(&self.file, &self.layout, values);
        }
        let place = self.places.of(&self.file, about_n_m);
        if !place.take(&self.layout, values, &mut self.state) {
            place.enter(&self.layout, values, &mut self.state);
        }
        let steps = self.lengths.of(&place, step)?;
        let h = steps.length_s();
        let (first, listed) = (self.layout.loads.start, values.listed());
        let course = |power: usize, load: usize| {
            let place = first + load;
            match power.checked_sub(1) {
                None => listed[place],
                // wₖ = hᵏ dᵏu/dtᵏ
                Some(order) => {
                    let derivatives = inputs.derivatives(FIRST_LISTED + place);
                    derivatives[order] * h.powi(order as i32 + 1)
                }
            }
        };
        steps.step_along(&mut self.state, course);
        let was_too_long = steps.was_too_long();
        if h != step.interval_s {
            let end = |load: usize| {
                let [w0, w1, w2, w3] = [0, 1, 2, 3].map(|power| course(power, load));
                w0 + w1 + w2 / 2.0 + w3 / 6.0
            };
            steps.creep(&mut self.state, step.interval_s - h, |power, load| {
                if power == 0 { end(load) } else { 0.0 }
            });
        }
        Ok((place, was_too_long))
    }

    /// Name of the state at this place: coordinates, rates, energies.
    fn state_name(&self, place: usize) -> Name {
        let size = self.layout.coordinates.len();
        match place {
            _ if place < size => Name::Owned(format!("modal.q{}", place + 1)),
            _ if place < 2 * size => Name::Owned(format!("modal.v{}", place - size + 1)),
            _ if place == 2 * size => Name::Borrowed("energy.supplied"),
            _ => Name::Borrowed("energy.dissipated"),
        }
    }
}

impl Model for AssemblyModel {
    fn prepare(&mut self, _: &Values, _: InterfaceType) -> Result<Option<Active>, Refusal> {
        Ok(None)
    }

    fn check_input(&self, input: usize, value: f64) -> Result<(), Refusal> {
        let place = input.wrapping_sub(FIRST_LISTED + self.layout.preloads.start);
        match self.file.assembly.over_preload().nth(place) {
            Some(law) => check_preload(law, value, None),
            None => Ok(()),
        }
    }

    fn check_states(&mut self, values: &Values) -> Outcome {
        let layout = &self.layout;
        let states = &values.listed()[layout.coordinates.start..layout.energies.end];
        self.check_finite(states, values.memories(), values[TIME])?;
        Ok(None)
    }

    fn advance(&mut self, values: &mut Values, step: Step, inputs: &InputCourse) -> Outcome {
        let is_held = inputs.is_held();
        let after = |place: usize, after_s: f64| {
            inputs.value(FIRST_LISTED + place, values.listed()[place], after_s)
        };
        if !is_held {
            self.check_preloads(step, after)?;
        }
        let preloads = self.layout.preloads.clone();
        let ended_n_m: Vec<f64> = match is_held {
            true => values.listed()[preloads].to_vec(),
            false => preloads
                .map(|place| after(place, step.interval_s))
                .collect(),
        };
        let about_n_m = memory::about_n_m(self.calculated(&[]), values, is_held);
        let (mut place, mut was_too_long) = self.go_on(values, step, inputs, &about_n_m)?;
        // what is too stiff for a step beside the linear part may be no trouble in it
        let is_about_its_own = was_too_long && is_held && about_n_m != ended_n_m;
        if is_about_its_own {
            (place, was_too_long) = self.go_on(values, step, inputs, &ended_n_m)?;
        }
        self.check_end(&place.coordinates, step.time_s + step.interval_s)?;
        if was_too_long {
            return Err(Refusal::TooLongForJoints {
                interval_s: step.interval_s,
                time_s: step.time_s,
            });
        }
        place.put(&self.layout, &self.state, values);
        self.write_memory(values);
        memory::stay(self.calculated(&[]), values, &Stayed::Ended(ended_n_m));
        if is_about_its_own {
            memory::stay_for_good(self.calculated(&[]), values);
        }
        Ok(None)
    }

    fn reset(&mut self) {}

    fn calculate_parameters(&self, _: &mut Values) {}

    fn differentiate_parameters(&self, _: &Values, _: &mut Values) {}

    fn begin(&self, values: &mut Values) {
        memory::begin(self.calculated(&self.laws(values)), values);
    }

    fn commit(&self, values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        memory::commit(self.calculated(&self.laws(values)), values, time_s)
    }

    fn pass_event(&self, values: &mut Values) {
        memory::look_ahead(self.calculated(&self.laws(values)), values, true);
    }

    fn settle(&self, values: &mut Values) {
        self.places.settle(&self.file, &self.layout, values);
    }

    fn restored(&mut self, values: &Values) {
        self.places.prepare(&self.file, &self.layout, values);
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let laws = self.laws(values);
        let calculated = self.calculated(&laws);
        let first_energy = values[FIRST_ENERGY];
        let present = self.write_outputs(calculated, values);
        let (listed, committed) = values.listed_beside_memory();
        let memory = present.as_deref().unwrap_or(committed);
        calculated.write_apart(listed, memory, first_energy);
        memory::write_indicators(calculated, values);
    }

    fn calculate_loads(&self, values: &mut Values, _: bool) -> bool {
        let laws = self.laws(values);
        self.write_outputs(self.calculated(&laws), values);
        false
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, rates: &mut Values) {
        let layout = &self.layout;
        let (from, to) = (values.listed(), rates.listed_mut());
        for place in layout.loads.start..layout.preloads.end {
            to[place] = inputs.rate(FIRST_LISTED + place).unwrap_or(0.0);
        }
        to[layout.coordinates.clone()].copy_from_slice(&from[layout.rates.clone()]);
        to[layout.rates.clone()].copy_from_slice(&from[layout.accelerations.clone()]);
        to[layout.energies.clone()].copy_from_slice(&from[layout.powers.clone()]);
        to[layout.inner.clone()].copy_from_slice(&from[layout.inner_rates.clone()]);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let laws = self.laws_along(values, change);
        let calculated = self.calculated(&laws);
        let pairs = values.listed().iter().zip(change.listed());
        let mut listed: Vec<Dual<1>> = pairs
            .map(|(&value, &change)| Dual::new(value, [change]))
            .collect();
        let first_energy = Dual::from(values[FIRST_ENERGY]);
        match memory::present_change(calculated, values, &listed) {
            Some(memory) => {
                if values.are_starting() {
                    calculated.write_inner(&mut listed, &memory);
                }
                calculated.write(&mut listed, &memory);
                calculated.write_apart(&mut listed, &memory, first_energy);
            }
            None => {
                calculated.write(&mut listed, values.memories());
                calculated.write_apart(&mut listed, values.memories(), first_energy);
            }
        }
        if values.are_starting() {
            // it is counted from there
            listed[self.layout.preload_energy.clone()].fill(Dual::from(0.0));
        }
        for (change, own) in change.listed_mut().iter_mut().zip(&listed) {
            *change = own.change[0];
        }
        memory::write_indicator_changes(self.calculated(&self.laws(values)), values, change);
    }
}
