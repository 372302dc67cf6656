//! What the functions of both versions are called with: arguments drawn, the call made, and what it does to the instance
//! followed. One drawing serves the two functions that do the same.

use std::{
    ffi::{c_int, c_void},
    ptr,
};

use bolted_joint_importer::header::{DISCARD, OK, fmi2::*, fmi3::*};

use super::{
    choices::Choices,
    turn::{Interface, Mode, Outcome, Subject, Turn},
};
use crate::raw::{Fmi2, Fmi3, call};

/// Value references for functions that refuse them all.
pub(super) const ANY: [u32; 5] = [0, 1, 9, 13, 17];

/// Functions of the instance alone; the mode after success.
macro_rules! plain {
    ($function:ident $(, $after:expr)?) => {
        |turn| {
            let i = turn.instance();
            let status = call!(@one i, $function());
            $(if status < DISCARD {
                let after: fn(&Subject) -> Mode = $after;
                turn.subject.mode = Some(after(turn.subject));
            })?
            status.into()
        }
    };
}

/// Reads numbers into an array with one element for each continuous state.
macro_rules! state_numbers {
    ($function:ident) => {
        |turn| {
            let i = turn.instance();
            let count = turn.subject.model().states();
            let values = turn.a.array(vec![0.0; count]);
            let status = call!(@one i, $function(values.pointer(), values.count()));
            Outcome::with(status, values.content())
        }
    };
}

/// Value references and arrays of as many elements, which nobody looks at, and perhaps the length of the last one.
macro_rules! arrays {
    ($function:ident, $($array:ident = $zero:expr),+ $(; $last:ident)?) => {
        |turn| {
            let i = turn.instance();
            let references = turn.references(&ANY);
            let count = references.len();
            let references = turn.a.array(references);
            $(let $array = turn.a.array(vec![$zero; count]);)+
            let (of, count) = (references.pointer(), references.count());
            call!(@one i, $function(of, count, $($array.pointer()),+ $(, $last.count())?)).into()
        }
    };
}

pub(super) use {arrays, plain, state_numbers};

pub(super) fn set_debug_logging(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let drawn = turn.categories();
    let names: Vec<_> = drawn
        .iter()
        .map(|category| turn.a.text(category.name()))
        .collect();
    let names = turn.a.array(names);
    let on = turn.a.flag();
    let (count, pointer) = (names.count(), names.pointer());
    let status = call!(
        i,
        fmi2SetDebugLogging(on.into(), count, pointer),
        fmi3SetDebugLogging(on, count, pointer)
    );
    if status == OK && turn.reached {
        // of an array that is told too short, the rest does not count
        let told = &drawn[..names.count()];
        turn.subject.switch_logging(told, on != 0);
    }
    status.into()
}

/// Tells the time span; with FMI 3.0 that starts the initialisation.
pub(super) fn set_time_span(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let (defined, stop_defined) = (turn.a.flag(), turn.a.flag());
    let tolerance = turn.a.choices.any_number();
    let start = turn.a.number();
    let stop = if turn.a.wrong(4) {
        turn.a.choices.any_number()
    } else {
        start + 1.0
    };
    let status = call!(
        i,
        fmi2SetupExperiment(defined.into(), tolerance, start, stop_defined.into(), stop),
        fmi3EnterInitializationMode(defined, tolerance, start, stop_defined, stop)
    );
    if status < DISCARD {
        turn.subject.mode = Some(match i.version {
            Fmi2 => Mode::SetUp,
            Fmi3 => Mode::Initialization,
        });
        turn.subject.time_s = start;
    }
    status.into()
}

pub(super) fn reset(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let status = i.reset();
    if status < DISCARD {
        turn.subject.mode = Some(Mode::Instantiated);
        turn.subject.time_s = 0.0;
    }
    status.into()
}

pub(super) fn get_values(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let pool = turn.subject.model().references();
    let references = turn.references(&pool);
    let values = turn.a.array(vec![0.0; references.len()]);
    let references = turn.a.array(references);
    let (of, count, v) = (references.pointer(), references.count(), values.pointer());
    let status = call!(
        i,
        fmi2GetReal(of, count, v),
        fmi3GetFloat64(of, count, v, values.count())
    );
    Outcome::with(status, values.content())
}

pub(super) fn set_values(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let model = turn.subject.model();
    let mut references = turn.references(model.inputs());
    if references.is_empty() {
        // an empty list may be accepted in any mode
        references.push(model.inputs()[0]);
    }
    if turn.a.wild && turn.a.choices.one_in(4) {
        // a parameter or a start value
        turn.a.right = false;
        let all = model.references();
        references.push(all[turn.a.choices.below(all.len())]);
    }
    let values: Vec<f64> = references.iter().map(|_| turn.a.number()).collect();
    let references = turn.a.array(references);
    let values = turn.a.array(values);
    let (of, count, v) = (references.pointer(), references.count(), values.pointer());
    call!(
        i,
        fmi2SetReal(of, count, v),
        fmi3SetFloat64(of, count, v, values.count())
    )
    .into()
}

/// A variable for a state, with a null pointer in it, or with a state to write over.
fn state_variable(turn: &mut Turn<'_, '_>) -> State {
    if turn.a.choices.one_in(3) {
        turn.state()
    } else {
        ptr::null_mut()
    }
}

/// A saved state, as C knows it.
type State = *mut c_void;

/// Follows a call that was to make a state, in the variable that held `before`.
fn follow(turn: &mut Turn<'_, '_>, status: c_int, [before, state]: [State; 2]) {
    if status < DISCARD {
        turn.saved.retain(|saved| saved.handle != state);
        let (mode, time_s) = (turn.subject.mode, turn.subject.time_s);
        turn.keep(state, mode, time_s);
    } else {
        assert_eq!(state, before);
    }
}

pub(super) fn get_state(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let before = state_variable(turn);
    let variable = turn.a.output(before);
    let status = call!(i, fmi2GetFMUstate | fmi3GetFMUState(variable.pointer()));
    follow(turn, status, [before, variable.content()[0]]);
    status.into()
}

pub(super) fn set_state(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let state = turn.state();
    let status = i.restore(state);
    if status < DISCARD {
        let saved = turn.saved.iter().find(|saved| saved.handle == state);
        let saved = saved.expect("only what was saved is restored");
        turn.subject.mode = saved.mode;
        turn.subject.time_s = saved.time_s;
    }
    status.into()
}

pub(super) fn free_state(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let state = turn.state();
    let variable = turn.a.output(state);
    let status = call!(i, fmi2FreeFMUstate | fmi3FreeFMUState(variable.pointer()));
    if status < DISCARD && !variable.pointer().is_null() {
        assert_eq!(variable.content()[0], ptr::null_mut());
        turn.saved.retain(|saved| saved.handle != state);
    } else {
        assert_eq!(variable.content()[0], state);
    }
    status.into()
}

pub(super) fn serialized_size(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let state = turn.state();
    let size = turn.a.output(0_usize);
    call!(
        i,
        fmi2SerializedFMUstateSize | fmi3SerializedFMUStateSize(state, size.pointer())
    )
    .into()
}

pub(super) fn serialize(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let state = turn.state();
    let size = if turn.a.right {
        turn.subject.raw.serialized_size(state)
    } else {
        0
    };
    let bytes = turn.a.array(vec![0_u8; size]);
    let (pointer, count) = (bytes.pointer(), bytes.count());
    call!(
        i,
        fmi2SerializeFMUstate | fmi3SerializeFMUState(state, pointer, count)
    )
    .into()
}

pub(super) fn deserialize(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let whole = turn.subject.raw.state_bytes();
    let mut bytes = whole.clone();
    if turn.a.wrong(3) {
        damage(&mut bytes, turn.a.choices);
    }
    let before = state_variable(turn);
    let bytes = turn.a.array(bytes);
    let variable = turn.a.output(before);
    let (pointer, count, state) = (bytes.pointer(), bytes.count(), variable.pointer());
    let status = call!(
        i,
        fmi2DeSerializeFMUstate | fmi3DeserializeFMUState(pointer, count, state)
    );
    if status < DISCARD {
        let told = bytes.content().get(..bytes.count());
        assert_eq!(told, Some(whole.as_slice()), "damaged bytes are accepted");
    }
    follow(turn, status, [before, variable.content()[0]]);
    status.into()
}

/// Changes bytes, adds some, or takes some away.
fn damage(bytes: &mut Vec<u8>, choices: &mut Choices<'_>) {
    let position = choices.bits() as usize % bytes.len();
    match choices.below(4) {
        0 => bytes.truncate(position),
        1 => bytes.push(choices.below(256) as u8),
        2 => {
            let before = bytes.clone();
            bytes[position..].fill(choices.below(256) as u8);
            if *bytes == before {
                bytes[position] ^= 1;
            }
        }
        _ => bytes[position] ^= 1 << choices.below(8),
    }
}

pub(super) fn directional(turn: &mut Turn<'_, '_>) -> Outcome {
    partial(turn, fmi3GetDirectionalDerivative, false)
}

pub(super) fn adjoint(turn: &mut Turn<'_, '_>) -> Outcome {
    partial(turn, fmi3GetAdjointDerivative, true)
}

/// `of_fmi3` is what is called with FMI 3.0; FMI 2.0 has directional derivatives alone.
fn partial(turn: &mut Turn<'_, '_>, of_fmi3: fmi3GetAdjointDerivative, adjoint: bool) -> Outcome {
    let i = turn.instance();
    let model = turn.subject.model();
    let unknowns = turn.references(model.outputs());
    let knowns = turn.references(model.inputs());
    let (seeds, results) = if adjoint {
        (unknowns.len(), knowns.len())
    } else {
        (knowns.len(), unknowns.len())
    };
    let seed: Vec<f64> = (0..seeds).map(|_| turn.a.number()).collect();
    let unknowns = turn.a.array(unknowns);
    let knowns = turn.a.array(knowns);
    let seed = turn.a.array(seed);
    let change = turn.a.array(vec![0.0; results]);
    let (u, nu) = (unknowns.pointer(), unknowns.count());
    let (k, nk) = (knowns.pointer(), knowns.count());
    let (s, ns) = (seed.pointer(), seed.count());
    let (c, nc) = (change.pointer(), change.count());
    let status = call!(
        i,
        fmi2GetDirectionalDerivative(u, nu, k, nk, s, c),
        of_fmi3(u, nu, k, nk, s, ns, c, nc)
    );
    Outcome::with(status, change.content())
}

pub(super) fn output_derivatives(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let references = turn.references(turn.subject.model().outputs());
    let orders = orders(turn, references.len());
    let values = vec![0.0; references.len()];
    let references = turn.a.array(references);
    let orders = turn.a.array(orders);
    let values = turn.a.array(values);
    let (of, count) = (references.pointer(), references.count());
    let (o, v) = (orders.pointer(), values.pointer());
    let status = call!(
        i,
        fmi2GetRealOutputDerivatives(of, count, o, v),
        fmi3GetOutputDerivatives(of, count, o, v, values.count())
    );
    Outcome::with(status, values.content())
}

/// Orders of derivatives: 1, of a wild call also others.
pub(super) fn orders(turn: &mut Turn<'_, '_>, count: usize) -> Vec<c_int> {
    let mut order = |_| {
        if turn.a.wrong(6) {
            turn.a.choices.pick(&[0, -1, 2, c_int::MAX, c_int::MIN])
        } else {
            1
        }
    };
    (0..count).map(&mut order).collect()
}

pub(super) fn completed_integrator_step(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let flags: [_; 2] = std::array::from_fn(|_| turn.a.output([2_u8; 4]));
    let no_set = turn.a.flag();
    let [enter, end] = [flags[0].pointer(), flags[1].pointer()];
    // four bytes each: a C int, or one byte and three that are left alone
    let status = call!(
        i,
        fmi2CompletedIntegratorStep(no_set.into(), enter.cast(), end.cast()),
        fmi3CompletedIntegratorStep(no_set, enter.cast(), end.cast())
    );
    if status < DISCARD {
        for flag in &flags {
            let [first, rest @ ..] = flag.content()[0];
            assert!(first <= 1 && (rest == [0; 3] || i.version == Fmi3 && rest == [2; 3]));
        }
    }
    status.into()
}

pub(super) fn set_time(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let time = turn.subject.time_s + turn.step_size();
    let status = i.set_time(time);
    if status < DISCARD {
        turn.subject.time_s = time;
    }
    status.into()
}

pub(super) fn set_continuous_states(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let count = turn.subject.model().states();
    let scale = turn.a.choices.pick(&[1e-6, 1e-4, 1e-2, 1.0]);
    let states: Vec<f64> = (0..count).map(|_| scale * turn.a.number()).collect();
    let states = turn.a.array(states);
    let (x, count) = (states.pointer(), states.count());
    call!(
        i,
        fmi2SetContinuousStates | fmi3SetContinuousStates(x, count)
    )
    .into()
}

pub(super) fn event_indicators(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let right = turn.subject.model().indicators();
    let count = if turn.a.wrong(4) { 3 } else { right };
    let values = turn.a.array(vec![0.0; count]);
    let (z, count) = (values.pointer(), values.count());
    let status = call!(i, fmi2GetEventIndicators | fmi3GetEventIndicators(z, count));
    Outcome::with(status, values.content())
}

pub(super) fn do_step(turn: &mut Turn<'_, '_>) -> Outcome {
    let i = turn.instance();
    let time = if turn.a.wrong(8) {
        turn.a.choices.any_number()
    } else {
        turn.subject.time_s
    };
    let size = turn.step_size();
    let no_set = turn.a.flag();
    let (status, reached) = match i.version {
        Fmi2 => {
            let status = call!(@one i, fmi2DoStep(time, size, no_set.into()));
            let asked = (status < DISCARD)
                .then(|| i.status(fmi2GetRealStatus, LAST_SUCCESSFUL_TIME, f64::NAN));
            (status, asked.and_then(Result::ok))
        }
        Fmi3 => {
            let flags: [_; 3] = std::array::from_fn(|_| turn.a.output(2_u8));
            let last = turn.a.output(f64::NAN);
            let [event, end, early] = [0, 1, 2].map(|n| flags[n].pointer());
            let time_reached = last.pointer();
            let status =
                call!(@one i, fmi3DoStep(time, size, no_set, event, end, early, time_reached));
            assert!(status >= DISCARD || flags.iter().all(|flag| flag.content()[0] <= 1));
            (status, (status < DISCARD).then_some(last.content()[0]))
        }
    };
    if status < DISCARD {
        turn.subject.time_s = reached.unwrap_or(time + size);
    } else if turn.reached {
        turn.subject.mode = None;
    }
    Outcome::with(status, reached.as_slice())
}

/// Mode after the end of initialisation.
pub(super) fn after_initialization(subject: &Subject) -> Mode {
    match (subject.interface, subject.event_mode) {
        (Interface::ModelExchange, _) => Mode::Event,
        (Interface::CoSimulation, true) => Mode::StepEvent,
        (Interface::CoSimulation, false) => Mode::Step,
    }
}
