//! What the FMUs simulate, behind one interface: each model reads and writes the variables by value reference.

mod assembly;
mod element;
mod events;
mod lap;
mod loosening;
mod remembering;
mod sides;
mod watch;

pub(crate) use assembly::AssemblyLayout;
use assembly::AssemblyModel;
use element::Element;
use lap::{LapModel, prepared::Prepared};
use loosening::{LooseningElement, LooseningLap};
use remembering::RememberingLap;

use std::num::NonZeroU32;

use bolted_joint_dynamics::SPACE_COUNT;

use crate::{
    input_course::InputCourse,
    interface::{BuiltVariables, Dependence, Dofs, InterfaceType, Kind, Name, Values},
    preload_table::PreloadTable,
    refusal::{Active, Reached, Refusal},
    start_file::Equations,
};

/// A model behind the FMI functions.
///
/// Parameters, inputs and states live in the table of values. A model keeps only what it derives from the parameters.
pub(crate) trait Model: Send {
    /// Takes the parameters in `values` into use, or refuses them and keeps those in use before.
    ///
    /// Where the importer integrates, how long its steps may be is its own affair.
    fn prepare(
        &mut self,
        values: &Values,
        interface_type: InterfaceType,
    ) -> Result<Option<Active>, Refusal>;

    /// Begins to keep account of the energy at the present point, where initialisation ends.
    fn begin(&self, _: &mut Values) {}

    /// Whether an input that is limited can have this value.
    fn check_input(&self, _: usize, _: f64) -> Result<(), Refusal> {
        Ok(())
    }

    /// Whether the states in `values` are such that the simulation can go on, and whether they have reached what the user
    /// should know of.
    fn check_states(&mut self, values: &Values) -> Outcome;

    /// Number of equal internal steps that a communication step of `interval_s` (s) takes.
    fn internal_steps(&self, _interval_s: f64) -> Result<NonZeroU32, Refusal> {
        Ok(NonZeroU32::MIN)
    }

    /// Advances the states over `step`, in which the inputs take the course `inputs`; on refusal `values` are untouched.
    ///
    /// The result depends on parameters, inputs, states and `step` alone, not on earlier calls, but for what the user was
    /// told already. The inputs in `values` stay those at the step's beginning.
    fn advance(&mut self, values: &mut Values, step: Step, inputs: &InputCourse) -> Outcome;

    /// Does what [`Model::advance`] does, for one of many steps with the inputs held, if nothing has to be prepared for it
    /// and nothing goes wrong in it: from a time (s), by an interval (s). Otherwise it says no, and `values` are untouched.
    fn advance_steadily(&self, _values: &mut Values, _time_s: f64, _interval_s: f64) -> bool {
        false
    }

    /// Forgets what the user was told.
    fn reset(&mut self);

    /// Writes the states that are listed, where these follow from how an assembly goes on and have not been told.
    fn settle(&self, _values: &mut Values) {}

    /// Prepares what [`Model::settle`] needs at values that another instance, or this one earlier, has come to.
    fn restored(&mut self, _values: &Values) {}

    /// Calculates the calculated parameters from the parameters, whether these are in use or not.
    fn calculate_parameters(&self, values: &mut Values);

    /// Writes the first-order change of the calculated parameters along the direction `change` to it.
    fn differentiate_parameters(&self, values: &Values, change: &mut Values);

    /// Calculates outputs and derivatives of states from parameters, inputs and states.
    fn calculate_outputs(&self, values: &mut Values);

    /// Calculates outputs, or all of them but energies and powers; tells whether it was all. `_is_prepared` says that the
    /// parameters are those in use.
    fn calculate_loads(&self, values: &mut Values, _is_prepared: bool) -> bool {
        self.calculate_outputs(values);
        true
    }

    /// Moves what the joint remembers on to the present point, where a step is completed at `_time_s` (s); on refusal `values`
    /// are untouched.
    fn commit(&self, _values: &mut Values, _time_s: f64) -> Result<(), Refusal> {
        Ok(())
    }

    /// Takes note of an event at the present point, where a step was completed: the joint may have turned.
    fn pass_event(&self, _values: &mut Values) {}

    /// Writes the derivatives of inputs and states with respect to time to `rates`, at the point `values`, of which the
    /// outputs are up to date.
    fn rates(&self, values: &Values, inputs: &InputCourse, rates: &mut Values);

    /// Turns a direction of change, given for parameters, inputs and states, into the first-order change of all
    /// variables at the point `values` but calculated parameters: writes those of outputs and derivatives to `change`, exactly.
    fn differentiate_outputs(&self, values: &Values, change: &mut Values);

    /// Takes out of `change` what has one value wherever the simulation starts.
    fn hold_at_start(&self, _change: &mut Values) {}
}

/// Why a step is refused whose heat overflows.
fn heat_not_finite(time_s: f64) -> Refusal {
    Refusal::StateNotFinite {
        name: Name::Borrowed("energy.dissipated"),
        time_s,
    }
}

/// What a step, or a look at the states, has come to: what there is to tell the user, or why nothing has moved.
pub(crate) type Outcome = Result<Option<Reached>, Refusal>;

/// One communication step, or one internal step of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Time at its start, s.
    pub(crate) time_s: f64,
    /// Its length, s.
    pub(crate) interval_s: f64,
    /// Whether many steps of this length came in a row, so that preparing for more of them pays.
    pub(crate) is_steady: bool,
}

/// Most bytes that a model takes, whatever is prepared for it.
pub(crate) const MODEL_SIZE_MAX: usize = 2048;

const _: () = assert!(size_of::<LapModel<2, Prepared<2>>>() <= MODEL_SIZE_MAX);

/// The model of an FMU, with what gives its equations.
pub(crate) fn model(equations: Equations) -> Box<dyn Model> {
    match equations {
        Equations::Parameters(variables) => built_model(variables, None),
        Equations::OverPreload(variables, table) => built_model(variables, Some(table)),
        Equations::Assembly(file) => Box::new(AssemblyModel::new(*file)),
    }
}

/// The model of an element or a lap, with the table that it has if its joint is one over the preload.
fn built_model(variables: BuiltVariables, table: Option<PreloadTable>) -> Box<dyn Model> {
    match (variables.kind, table) {
        (Kind::Element, Some(PreloadTable::One(table))) => Box::new(LooseningElement::new(*table)),
        (Kind::Element, Some(PreloadTable::Two(table))) => Box::new(LooseningElement::new(*table)),
        (Kind::Lap, Some(PreloadTable::One(table))) => Box::new(LooseningLap::new(*table)),
        (Kind::Lap, Some(PreloadTable::Two(table))) => Box::new(LooseningLap::new(*table)),
        (Kind::Element, Some(PreloadTable::Six(table))) => Box::new(LooseningElement::new(*table)),
        (Kind::Lap, Some(PreloadTable::Six(table))) => Box::new(LooseningLap::new(*table)),
        (kind, None) => match variables.dofs {
            Dofs::One => model_of::<1>(kind, variables.dependence),
            Dofs::Two => model_of::<2>(kind, variables.dependence),
            Dofs::Space(_) => model_of::<SPACE_COUNT>(kind, variables.dependence),
        },
    }
}

/// The model of a joint with `D` degrees of freedom whose law is given by parameters.
fn model_of<const D: usize>(kind: Kind, dependence: Dependence) -> Box<dyn Model> {
    let remembers = dependence.remembers();
    match (kind, remembers) {
        (Kind::Element, false) => Box::new(Element::<D, false>::default()),
        (Kind::Element, true) => Box::new(Element::<D, true>::default()),
        (Kind::Lap, false) => Box::new(LapModel::<D, Prepared<D>>::default()),
        (Kind::Lap, true) => Box::new(LapModel::<D, RememberingLap<D>>::default()),
    }
}
