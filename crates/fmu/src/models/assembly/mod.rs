//! The assembly FMU: structures and the joints between them, loads in, motion out. The linear part is propagated exactly, the
//! joints' laws by an exponential Runge–Kutta scheme.

mod calculated;
mod layout;
mod lengths;
mod memory;

pub(crate) use layout::AssemblyLayout;

use bolted_joint_dynamics::{
    Dual,
    assembly::{AssemblyMotion, AssemblyState},
};

use crate::{
    assembly_file::AssemblyFile,
    input_course::InputCourse,
    interface::{FIRST_LISTED, InterfaceType, Name, Values, reference::TIME},
    models::{Model, Outcome, Step},
    refusal::{Active, Refusal},
};
use calculated::Calculated;
use lengths::Lengths;

/// Structures and the joints between them.
#[derive(Debug)]
pub(super) struct AssemblyModel {
    file: AssemblyFile,
    layout: AssemblyLayout,
    lengths: Lengths,
    /// Where a step moves the state on.
    state: AssemblyState,
}

impl AssemblyModel {
    pub(super) fn new(file: AssemblyFile) -> Self {
        Self {
            layout: AssemblyLayout::of(&file),
            state: AssemblyState::at_rest(&file.assembly),
            lengths: Lengths::default(),
            file,
        }
    }

    fn calculated(&self) -> Calculated<'_> {
        Calculated {
            file: &self.file,
            layout: &self.layout,
        }
    }

    /// Takes the state from the variables.
    fn take_state(&mut self, values: &Values) {
        let (layout, listed) = (&self.layout, values.listed());
        let states = &listed[layout.coordinates.start..layout.rates.end];
        self.state.motion.copy_from_slice(states);
        self.state.supplied_j = listed[layout.energies.start];
        self.state.dissipated_j = listed[layout.energies.start + 1];
        let laws = self.file.assembly.laws();
        for ((laws, own), memory) in laws.zip(&mut self.state.memory).zip(values.memories()) {
            laws.copy_memory(memory, own);
        }
    }

    /// Writes it to the variables.
    fn write_state(&self, values: &mut Values) {
        let layout = &self.layout;
        let listed = values.listed_mut();
        listed[layout.coordinates.start..layout.rates.end].copy_from_slice(&self.state.motion);
        listed[layout.energies.start] = self.state.supplied_j;
        listed[layout.energies.start + 1] = self.state.dissipated_j;
        self.calculated().write_inner(listed, &self.state.memory);
        let laws = self.file.assembly.laws();
        for ((laws, own), memory) in laws.zip(&self.state.memory).zip(values.memories_mut()) {
            laws.copy_memory(own, memory);
        }
    }

    /// Moves the state on by what is left over of a step: y + δ ẏ.
    fn go_on(&mut self, values: &Values, rest_s: f64) {
        let assembly = &self.file.assembly;
        let loads = &values.listed()[self.layout.loads.clone()];
        let (coordinates, rates) = self.state.motion.split_at(assembly.size());
        let motion = AssemblyMotion { coordinates, rates };
        let mut joint_loads = vec![0.0; self.layout.joint_loads.len()];
        assembly.joint_loads(motion, &self.state.memory, &mut joint_loads);
        let mut accelerations = vec![0.0; assembly.size()];
        assembly.accelerations(motion, loads, &joint_loads, &mut accelerations);
        let supplied = assembly.supplied_power(rates, loads);
        let dissipated = assembly.dissipated_power(motion, &self.state.memory);
        self.state.supplied_j += rest_s * supplied;
        self.state.dissipated_j += rest_s * dissipated;
        let (coordinates, rates) = self.state.motion.split_at_mut(assembly.size());
        for (i, acceleration) in accelerations.into_iter().enumerate() {
            coordinates[i] += rest_s * rates[i];
            rates[i] += rest_s * acceleration;
        }
    }

    /// Refuses a state of which a number is no finite one.
    fn check_finite(&self, time_s: f64) -> Result<(), Refusal> {
        let energies = [self.state.supplied_j, self.state.dissipated_j];
        let mut all = self.state.motion.iter().chain(&energies);
        let name = if let Some(place) = all.position(|number| !number.is_finite()) {
            self.state_name(place)
        } else {
            let mut laws = self.file.assembly.laws().zip(&self.state.memory);
            if laws.all(|(laws, memory)| laws.is_memory_finite(memory)) {
                return Ok(());
            }
            Name::Borrowed("of a joint")
        };
        Err(Refusal::StateNotFinite { name, time_s })
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

    fn check_states(&mut self, values: &Values) -> Outcome {
        self.take_state(values);
        self.check_finite(values[TIME])?;
        Ok(None)
    }

    fn advance(&mut self, values: &mut Values, step: Step, inputs: &InputCourse) -> Outcome {
        self.take_state(values);
        let steps = self.lengths.of(&self.file.assembly, step)?;
        let h = steps.length_s();
        let (first, listed) = (self.layout.loads.start, values.listed());
        steps.step_along(&mut self.state, |power, load| {
            let place = first + load;
            match power.checked_sub(1) {
                None => listed[place],
                // wₖ = hᵏ dᵏu/dtᵏ
                Some(order) => {
                    let derivatives = inputs.derivatives(FIRST_LISTED + place);
                    derivatives[order] * h.powi(order as i32 + 1)
                }
            }
        });
        let was_too_long = steps.was_too_long();
        if h != step.interval_s {
            self.go_on(values, step.interval_s - h);
        }
        self.check_finite(step.time_s + step.interval_s)?;
        if was_too_long {
            return Err(Refusal::TooLongForJoints {
                interval_s: step.interval_s,
                time_s: step.time_s,
            });
        }
        self.write_state(values);
        Ok(None)
    }

    fn reset(&mut self) {}

    fn calculate_parameters(&self, _: &mut Values) {}

    fn differentiate_parameters(&self, _: &Values, _: &mut Values) {}

    fn begin(&self, values: &mut Values) {
        memory::begin(self.calculated(), values);
    }

    fn commit(&self, values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        memory::commit(self.calculated(), values, time_s)
    }

    fn pass_event(&self, values: &mut Values) {
        memory::look_ahead(self.calculated(), values, true);
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let calculated = self.calculated();
        let present = memory::present(calculated, values);
        let (listed, committed) = values.listed_beside_memory();
        let memory = present.as_deref().unwrap_or(committed);
        calculated.write(listed, memory);
        calculated.write_apart(listed, memory);
        memory::write_indicators(calculated, values);
    }

    fn calculate_loads(&self, values: &mut Values, _: bool) -> bool {
        let calculated = self.calculated();
        let present = memory::present(calculated, values);
        let (listed, committed) = values.listed_beside_memory();
        calculated.write(listed, present.as_deref().unwrap_or(committed));
        false
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, rates: &mut Values) {
        let layout = &self.layout;
        let (from, to) = (values.listed(), rates.listed_mut());
        for place in layout.loads.clone() {
            to[place] = inputs.rate(FIRST_LISTED + place).unwrap_or(0.0);
        }
        to[layout.coordinates.clone()].copy_from_slice(&from[layout.rates.clone()]);
        to[layout.rates.clone()].copy_from_slice(&from[layout.accelerations.clone()]);
        to[layout.energies.clone()].copy_from_slice(&from[layout.powers.clone()]);
        to[layout.inner.clone()].copy_from_slice(&from[layout.inner_rates.clone()]);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let calculated = self.calculated();
        let pairs = values.listed().iter().zip(change.listed());
        let mut listed: Vec<Dual<1>> = pairs
            .map(|(&value, &change)| Dual::new(value, [change]))
            .collect();
        match memory::present_change(calculated, values, &listed) {
            Some(memory) => {
                if values.are_starting() {
                    calculated.write_inner(&mut listed, &memory);
                }
                calculated.write(&mut listed, &memory);
                calculated.write_apart(&mut listed, &memory);
            }
            None => {
                calculated.write(&mut listed, values.memories());
                calculated.write_apart(&mut listed, values.memories());
            }
        }
        for (change, own) in change.listed_mut().iter_mut().zip(&listed) {
            *change = own.change[0];
        }
        memory::write_indicator_changes(calculated, values, change);
    }
}
